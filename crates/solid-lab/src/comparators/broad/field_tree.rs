use std::cell::Cell;
use std::collections::HashMap;

use solid3d::Aabb;
use solid3d::glam::{DVec3, IVec3};

use super::BroadTest;
use super::filing::{Filing, pairs_by_query};

/// A fieldtree in three dimensions: a hierarchy of grids, each with half the cells' side of the one above it and shifted by half of its
/// own, so that no two levels have a boundary in common (thesis, section 5.1.4). Each box is in the smallest cell, or field, that
/// encloses it, so that it is listed once.
///
/// Source: Frank and Barrera, *The fieldtree: a data structure for geographic information systems*, 1989, generalised from the plane: a
/// field has up to 27 children in place of nine, and up to eight parents.
///
/// # Why small boxes stay low
/// With the space as the unit, the boundaries of level `l` are the odd multiples of 2^-(l+1). Those of two levels are at least half a cell
/// of the finer one apart, so a box smaller than that lies across the boundaries of at most one of them on each axis: of four levels in
/// a row one has it in a single field.
#[derive(Clone, Debug)]
pub struct FieldTree {
    /// Corner and side of the root's field.
    corner: DVec3,
    side: f64,
    boxes: Vec<Aabb>,
    fields: HashMap<FieldKey, Field>,
    /// Where each box is.
    field_of: Vec<FieldKey>,
    visits: Cell<u64>,
    box_tests: Cell<u64>,
}

/// The level, with the root at 0, and the number of the cell on each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct FieldKey {
    level: u32,
    place: IVec3,
}

#[derive(Clone, Debug, Default)]
struct Field {
    members: Vec<u32>,
    /// Those that overlap this field and have members or children.
    children: Vec<FieldKey>,
}

/// The finest level: its fields have a millionth of the side of the space.
const LEVEL_MAX: u32 = 20;

const ROOT: FieldKey = FieldKey { level: 0, place: IVec3::ZERO };

impl FieldTree {
    /// Over boxes numbered from 0. What later leaves the space around them is kept at the root.
    pub fn new(boxes: &[Aabb]) -> Self {
        let space = boxes.iter().fold(Aabb::EMPTY, |space, b| space.union(b));
        let side = (space.max - space.min).max_element();
        let mut tree = FieldTree {
            corner: if boxes.is_empty() { DVec3::ZERO } else { space.min },
            side: if side > 0.0 { side } else { 1.0 },
            boxes: boxes.to_vec(),
            fields: HashMap::from([(ROOT, Field::default())]),
            field_of: vec![ROOT; boxes.len()],
            visits: Cell::new(0),
            box_tests: Cell::new(0),
        };
        for index in 0..boxes.len() as u32 {
            tree.enter(index);
        }
        tree
    }

    /// The corners of a box in sides of the space. Rounding keeps their order, so boxes that overlap still do.
    fn local(&self, bounds: &Aabb) -> [DVec3; 2] {
        [bounds.min, bounds.max].map(|p| (p - self.corner) / self.side)
    }

    /// The smallest field that encloses a box.
    fn smallest(&self, bounds: &Aabb) -> FieldKey {
        let [min, max] = self.local(bounds);
        if min.min_element() < 0.0 || max.max_element() > 1.0 {
            return ROOT;
        }
        // The finest level with fields as large as the box: minus infinity for a point, which `as` turns into the greatest level.
        let finest = ((-(max - min).max_element().log2()).floor() as u32).min(LEVEL_MAX);
        (1..=finest)
            .rev()
            .map(|level| (level, [min, max].map(|p| place(level, p))))
            .find(|(_, [lower, upper])| lower == upper)
            .map_or(ROOT, |(level, [place, _])| FieldKey { level, place })
    }

    fn visit(&self) {
        self.visits.set(self.visits.get() + 1);
    }

    /// Makes a field and all above it that overlap it: at most eight on each level.
    fn make(&mut self, key: FieldKey) {
        self.visit();
        if self.fields.contains_key(&key) {
            return;
        }
        self.fields.insert(key, Field::default());
        for parent in key.parents() {
            self.make(parent);
            self.fields.get_mut(&parent).expect("it was made").children.push(key);
        }
    }

    /// Removes a field with nothing in or below it, and then those above it for which the same holds.
    fn prune(&mut self, key: FieldKey) {
        self.visit();
        let field = &self.fields[&key];
        if key == ROOT || !field.members.is_empty() || !field.children.is_empty() {
            return;
        }
        self.fields.remove(&key);
        for parent in key.parents() {
            self.fields.get_mut(&parent).expect("a field's parents are there").children.retain(|&k| k != key);
            self.prune(parent);
        }
    }

    /// The boxes of smaller number that overlap one, by a range query. A child is entered from the first of its parents that overlap
    /// the range, so each field is visited once.
    fn partners(&self, index: u32) -> Vec<u32> {
        let bounds = self.boxes[index as usize];
        let range = self.local(&bounds);
        let mut partners = Vec::new();
        let mut open = vec![ROOT];
        while let Some(key) = open.pop() {
            self.visit();
            let field = &self.fields[&key];
            self.box_tests.set(self.box_tests.get() + field.members.len() as u64);
            let overlapping = |&&i: &&u32| i < index && self.boxes[i as usize].overlaps(&bounds);
            partners.extend(field.members.iter().filter(overlapping));
            let below = range.map(|p| place(key.level + 1, p));
            let first = place(key.level, range[0]);
            open.extend(field.children.iter().filter(|child| {
                let inside = child.place.cmpge(below[0]).all() && child.place.cmple(below[1]).all();
                inside && (key == ROOT || child.parent_places()[0].max(first) == key.place)
            }));
        }
        partners
    }
}

impl FieldKey {
    /// The first and the last of the places of the fields one level up that overlap this one: on each axis an odd cell lies in the middle
    /// of one, an even one across a boundary.
    fn parent_places(&self) -> [IVec3; 2] {
        // Shifting right rounds down, below zero too.
        [(self.place - 1) >> 1, self.place >> 1]
    }

    fn parents(self) -> Vec<FieldKey> {
        match self.level {
            0 => Vec::new(),
            1 => vec![ROOT],
            level => {
                let [first, last] = self.parent_places();
                let at = |x, y, z| FieldKey { level: level - 1, place: IVec3::new(x, y, z) };
                (first.x..=last.x)
                    .flat_map(|x| {
                        (first.y..=last.y).flat_map(move |y| (first.z..=last.z).map(move |z| at(x, y, z)))
                    })
                    .collect()
            }
        }
    }
}

/// The cell of a level that a point of the space lies in. Exact: the product by a power of two, and the sum where it decides.
fn place(level: u32, p: DVec3) -> IVec3 {
    if level == 0 {
        return IVec3::ZERO;
    }
    (p * f64::from(1u32 << level) - 0.5).floor().as_ivec3()
}

impl Filing for FieldTree {
    fn boxes(&mut self) -> &mut [Aabb] {
        &mut self.boxes
    }

    fn enter(&mut self, index: u32) {
        let key = self.smallest(&self.boxes[index as usize]);
        self.make(key);
        self.fields.get_mut(&key).expect("it was made").members.push(index);
        self.field_of[index as usize] = key;
    }

    fn leave(&mut self, index: u32) {
        let key = self.field_of[index as usize];
        self.fields.get_mut(&key).expect("the box entered this field").members.retain(|&i| i != index);
        self.prune(key);
    }
}

impl BroadTest for FieldTree {
    fn name(&self) -> &'static str {
        "fieldtree"
    }

    fn update(&mut self, moved: &[(u32, Aabb)]) {
        self.refile(moved);
    }

    fn pairs(&self) -> Vec<(u32, u32)> {
        pairs_by_query(self.boxes.len(), |j| self.partners(j))
    }

    fn steps(&self) -> u64 {
        self.visits.get()
    }

    fn box_tests(&self) -> u64 {
        self.box_tests.get()
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Boxes of sizes from a thousandth of the space to a tenth.
    fn boxes_of_many_sizes(count: usize) -> Vec<Aabb> {
        let mut rng = seeded(34);
        (0..count)
            .map(|_| {
                let side = 10f64.powf(rng.random_range(-3.0..-1.0));
                let min = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..1.0 - side)));
                Aabb::new(min, min + side)
            })
            .collect()
    }

    #[test]
    fn a_field_is_at_most_so_many_times_as_large_as_a_box_in_it() {
        // A side more than twice that of the box, and less than four times; then three levels up.
        const RATIO_MAX: f64 = 4.0 * 8.0;
        let boxes = boxes_of_many_sizes(2_000);
        let tree = FieldTree::new(&boxes);
        let mut largest = 0.0f64;
        for (b, key) in boxes.iter().zip(&tree.field_of) {
            let field = tree.side / f64::from(1u32 << key.level);
            largest = largest.max(field / (b.max - b.min).max_element());
        }
        assert!((RATIO_MAX / 8.0..=RATIO_MAX).contains(&largest), "{largest}");
    }

    #[test]
    fn a_query_visits_a_field_once() {
        let tree = FieldTree::new(&boxes_of_many_sizes(2_000));
        let whole = tree.boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(b));
        let tree = FieldTree { boxes: vec![whole; 2_001], ..tree };
        let before = tree.steps();
        assert_eq!(tree.partners(2_000).len(), 2_000);
        assert_eq!(tree.steps() - before, tree.fields.len() as u64);
    }

    #[test]
    fn nothing_is_left_of_fields_that_are_empty() {
        let boxes = boxes_of_many_sizes(200);
        let mut tree = FieldTree::new(&boxes);
        assert!(tree.fields.len() > 200, "{}", tree.fields.len());
        let far = Aabb::new(DVec3::splat(5.0), DVec3::splat(6.0));
        let moved: Vec<_> = (0..200).map(|i| (i, far)).collect();
        tree.update(&moved);
        assert_eq!(tree.fields.keys().copied().collect::<Vec<_>>(), [ROOT]);
        assert_eq!(tree.pairs().len(), 200 * 199 / 2);
    }
}
