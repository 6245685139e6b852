//! Signposts: for each cell of a grid over the box of a tree a leaf that is near to its middle.
//!
//! A walk whose first find will do looks there before it begins at the root: a small shape that meets a large mesh mostly meets that leaf, and is
//! spared the nodes above it. What is seen there is as true as if the walk had come to it, so that no answer depends on which leaf is named.

use glam::Vec3;

use super::packed::PackedBox;
use super::{Place, Tree};

/// A tree of fewer leaves is walked as soon.
const LEAVES_MIN: usize = 64;

/// Cells are made smaller by this factor while they are no more than the leaves.
const FINER: f32 = 0.8;

/// A leaf for each cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Signposts {
    grid: Grid,
    leaves: Box<[Place]>,
}

/// A box cut into as many cells along each axis as there are, x first.
#[derive(Clone, Debug, PartialEq)]
struct Grid {
    min: Vec3,
    cells: [usize; 3],
    /// Of length one along each axis.
    cells_per_unit: Vec3,
}

/// A leaf, and the middle of its box.
#[derive(Clone, Copy)]
struct Found {
    leaf: Place,
    middle: Vec3,
}

impl Signposts {
    /// Of a tree of many leaves. Cost: `O(n)`.
    pub fn new(tree: &Tree) -> Option<Signposts> {
        let leaves: Vec<Found> = tree
            .placed_leaves()
            .map(|(leaf, _)| Found { leaf, middle: middle(&tree.box_at(leaf)) })
            .collect();
        if leaves.len() < LEAVES_MIN {
            return None;
        }
        let grid = Grid::new(&tree.root, leaves.len());
        let mut found = vec![None; grid.count()];
        for leaf in leaves {
            grid.tell(&mut found, grid.cell(leaf.middle), Some(leaf));
        }
        grid.spread(&mut found);
        let leaves = found.into_iter().flatten().map(|found| found.leaf).collect();
        Some(Signposts { grid, leaves })
    }

    /// The leaf that is named in the cell where the middle of a box is, or in that nearest to it.
    #[inline(always)]
    pub(super) fn at(&self, bounds: &PackedBox) -> Place {
        self.leaves[self.grid.cell(middle(bounds))]
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.leaves)
    }
}

#[inline(always)]
fn middle(bounds: &PackedBox) -> Vec3 {
    0.5 * Vec3::new(bounds.center_doubled(0), bounds.center_doubled(1), bounds.center_doubled(2))
}

impl Grid {
    /// Over a box, of at most so many cells, about as long as wide.
    fn new(bounds: &PackedBox, cells_max: usize) -> Grid {
        let min = Vec3::from_array(bounds.min());
        let size = Vec3::from_array(bounds.max()) - min;
        let cells = |edge: f32| (size / edge).ceil().max(Vec3::ONE).to_array().map(|count| count as usize);
        let mut edge = size.max_element();
        while cells(FINER * edge).iter().product::<usize>() <= cells_max {
            edge *= FINER;
        }
        let cells = cells(edge);
        Grid { min, cells, cells_per_unit: Vec3::from_array(cells.map(|count| count as f32)) / size }
    }

    fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// The cell of a point, or that nearest to it.
    #[inline(always)]
    fn cell(&self, point: Vec3) -> usize {
        let at = (point - self.min) * self.cells_per_unit;
        // What is below zero becomes zero.
        let [x, y, z] = [at.x as usize, at.y as usize, at.z as usize];
        let [cells_x, cells_y, cells_z] = self.cells;
        x.min(cells_x - 1) + cells_x * (y.min(cells_y - 1) + cells_y * z.min(cells_z - 1))
    }

    /// Where a cell is along each axis.
    fn position(&self, cell: usize) -> [usize; 3] {
        let [x, y, _] = self.cells;
        [cell % x, cell / x % y, cell / (x * y)]
    }

    /// The middle of a cell.
    fn middle(&self, cell: usize) -> Vec3 {
        let position = self.position(cell).map(|index| index as f32 + 0.5);
        self.min + Vec3::from_array(position) / self.cells_per_unit
    }

    /// Tells a cell of a leaf, which it keeps if none that it was told of is nearer to its middle.
    fn tell(&self, found: &mut [Option<Found>], cell: usize, leaf: Option<Found>) {
        let middle = self.middle(cell);
        let distance =
            |found: Option<Found>| found.map_or(f32::INFINITY, |it| it.middle.distance_squared(middle));
        if distance(leaf) < distance(found[cell]) {
            found[cell] = leaf;
        }
    }

    /// Lets each cell tell its neighbours, forward and then backward: what one found, all hear of.
    fn spread(&self, found: &mut [Option<Found>]) {
        for cell in 0..found.len() {
            for next in self.next(cell) {
                self.tell(found, next, found[cell]);
            }
        }
        for cell in (0..found.len()).rev() {
            for next in self.next(cell) {
                self.tell(found, cell, found[next]);
            }
        }
    }

    /// The cells that come next along each axis.
    fn next(&self, cell: usize) -> impl Iterator<Item = usize> {
        let ([x, y, _], position) = (self.cells, self.position(cell));
        let next = [cell + 1, cell + x, cell + x * y];
        (0..3).filter(move |&axis| position[axis] + 1 < self.cells[axis]).map(move |axis| next[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::scenes::{point, rng};
    use super::*;
    use crate::Aabb;
    use glam::DVec3;
    use rand::Rng;

    /// Law: each cell names a leaf, and where leaves have their middles in one, a leaf that is no farther from its middle than any of them; of all leaves
    /// the named one is mostly among the nearest. Whether what they are of is flat, long or all at one place; and of a few leaves there are none.
    #[test]
    fn a_signpost_names_a_leaf_that_is_near() {
        let mut rng = rng(131);
        assert_eq!(Signposts::new(&tree_of(&[DVec3::ONE; 20])), None);
        let (mut cells, mut strays) = (0, 0);
        for case in 0..20 {
            let stretch =
                [DVec3::ONE, DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::new(1.0, 1e-3, 1e-6), DVec3::ZERO]
                    [case % 5];
            let size = 10f64.powi(rng.random_range(-40..40));
            let points: Vec<DVec3> = (0..2000).map(|_| stretch * point(&mut rng, size)).collect();
            let tree = tree_of(&points);
            let Signposts { grid, leaves } = Signposts::new(&tree).expect("there are many leaves");
            let found: Vec<Vec3> = tree.placed_leaves().map(|(leaf, _)| middle(&tree.box_at(leaf))).collect();
            assert!(
                leaves.len() == grid.count() && (found.len() / 4..=found.len()).contains(&leaves.len()),
                "case {case}"
            );
            for (cell, &leaf) in leaves.iter().enumerate() {
                assert!(tree.leaf_if_any(leaf).is_some());
                let distance = |middle: Vec3| middle.distance_squared(grid.middle(cell));
                let named = distance(middle(&tree.box_at(leaf)));
                assert!(
                    found.iter().all(|&it| grid.cell(it) != cell || named <= distance(it)),
                    "case {case}"
                );
                strays += usize::from(found.iter().filter(|&&it| distance(it) < named).count() > 3);
            }
            cells += leaves.len();
        }
        println!("{strays} of {cells} are not near");
        assert!(20 * strays < cells);
    }

    fn tree_of(points: &[DVec3]) -> Tree {
        Tree::build(&points.iter().map(|&p| Aabb::new(p, p)).collect::<Vec<_>>())
    }
}
