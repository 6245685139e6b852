use std::cell::Cell;

use solid3d::Aabb;
use solid3d::glam::DVec3;

use super::BroadTest;
use super::filing::{Filing, pairs_by_query};

/// How a cell of a [`SpaceTree`] is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Into eight halves of each side: an octree.
    Octree,
    /// Into two across its longest side: a k-d tree.
    KdTree,
}

/// A hierarchy of cells of space, each box in the smallest cell that encloses it, so that it is listed once (thesis, sections 5.1.2 and
/// 5.1.4). A box across a cut stays high up, however small it is.
#[derive(Clone, Debug)]
pub struct SpaceTree {
    cut: Cut,
    boxes: Vec<Aabb>,
    cells: Vec<SpaceCell>,
    /// Where each box is.
    cell_of: Vec<u32>,
    visits: Cell<u64>,
    box_tests: Cell<u64>,
}

#[derive(Clone, Debug)]
struct SpaceCell {
    bounds: Aabb,
    members: Vec<u32>,
    /// Made when something falls into them.
    children: Vec<Option<u32>>,
}

/// Cells are not cut deeper: by then a side is a thousandth of the space's, or less.
const DEPTH_MAX: u32 = 30;

impl SpaceTree {
    /// Over boxes numbered from 0. What later leaves the space around them is kept at the root.
    pub fn new(boxes: &[Aabb], cut: Cut) -> Self {
        let space = boxes.iter().fold(Aabb::EMPTY, |space, b| space.union(b));
        let mut tree = SpaceTree {
            cut,
            boxes: boxes.to_vec(),
            cells: vec![SpaceCell::new(space, cut)],
            cell_of: vec![0; boxes.len()],
            visits: Cell::new(0),
            box_tests: Cell::new(0),
        };
        for index in 0..boxes.len() as u32 {
            tree.enter(index);
        }
        tree
    }

    /// The boxes of smaller number that overlap one, by a range query.
    fn partners(&self, index: u32) -> Vec<u32> {
        let bounds = self.boxes[index as usize];
        let mut partners = Vec::new();
        let mut open = vec![0];
        while let Some(cell) = open.pop() {
            self.visits.set(self.visits.get() + 1);
            let cell = &self.cells[cell as usize];
            self.box_tests.set(self.box_tests.get() + cell.members.len() as u64);
            let overlapping = |&&i: &&u32| i < index && self.boxes[i as usize].overlaps(&bounds);
            partners.extend(cell.members.iter().filter(overlapping));
            let children = cell.children.iter().flatten();
            open.extend(children.filter(|&&child| self.cells[child as usize].bounds.overlaps(&bounds)));
        }
        partners
    }
}

impl SpaceCell {
    fn new(bounds: Aabb, cut: Cut) -> Self {
        let count = match cut {
            Cut::Octree => 8,
            Cut::KdTree => 2,
        };
        SpaceCell { bounds, members: Vec::new(), children: vec![None; count] }
    }

    fn parts(&self, cut: Cut) -> Vec<Aabb> {
        let Aabb { min, max } = self.bounds;
        let center = self.bounds.center();
        match cut {
            Cut::Octree => (0..8u8)
                .map(|k| {
                    let upper = DVec3::from_array([k & 1, k >> 1 & 1, k >> 2].map(f64::from));
                    let part = |low: DVec3, high: DVec3| low + (high - low) * upper;
                    Aabb::new(part(min, center), part(center, max))
                })
                .collect(),
            Cut::KdTree => {
                let axis = (max - min).max_position();
                let (mut below, mut above) = (self.bounds, self.bounds);
                below.max[axis] = center[axis];
                above.min[axis] = center[axis];
                vec![below, above]
            }
        }
    }
}

impl Filing for SpaceTree {
    fn boxes(&mut self) -> &mut [Aabb] {
        &mut self.boxes
    }

    fn enter(&mut self, index: u32) {
        let bounds = self.boxes[index as usize];
        let mut cell = 0;
        for _ in 0..DEPTH_MAX {
            self.visits.set(self.visits.get() + 1);
            let parts = self.cells[cell].parts(self.cut);
            let Some(k) = parts.iter().position(|part| part.contains(&bounds)) else { break };
            cell = match self.cells[cell].children[k] {
                Some(child) => child as usize,
                None => {
                    let child = self.cells.len();
                    self.cells.push(SpaceCell::new(parts[k], self.cut));
                    self.cells[cell].children[k] = Some(child as u32);
                    child
                }
            };
        }
        self.cells[cell].members.push(index);
        self.cell_of[index as usize] = cell as u32;
    }

    fn leave(&mut self, index: u32) {
        let members = &mut self.cells[self.cell_of[index as usize] as usize].members;
        members.retain(|&i| i != index);
    }
}

impl BroadTest for SpaceTree {
    fn name(&self) -> &'static str {
        match self.cut {
            Cut::Octree => "octree",
            Cut::KdTree => "k-d tree",
        }
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
