use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};

use solid3d::Aabb;
use solid3d::glam::{DVec3, IVec3};

use super::BroadTest;
use super::filing::Filing;
use super::order::ordered;

/// A voxel grid: each box is listed in all cells that it touches (thesis, section 5.1.1). Cells are kept in a hash table, so the space
/// has no bounds.
#[derive(Clone, Debug)]
pub struct VoxelGrid {
    boxes: Vec<Aabb>,
    cell: f64,
    cells: HashMap<IVec3, Vec<u32>>,
    visits: u64,
    box_tests: Cell<u64>,
}

/// A box that spans more cells than this on a side is cut short: cells are as large as the largest box, so none does.
const SPAN_MAX: i32 = 64;

impl VoxelGrid {
    /// Over boxes numbered from 0; cells have the size of the largest box.
    pub fn new(boxes: &[Aabb]) -> Self {
        let largest = boxes.iter().map(|b| (b.max - b.min).max_element()).fold(0.0, f64::max);
        let cell = if largest > 0.0 { largest } else { 1.0 };
        let mut grid = VoxelGrid {
            boxes: boxes.to_vec(),
            cell,
            cells: HashMap::new(),
            visits: 0,
            box_tests: Cell::new(0),
        };
        for index in 0..boxes.len() as u32 {
            grid.enter(index);
        }
        grid
    }

    fn span(&self, bounds: &Aabb) -> impl Iterator<Item = IVec3> + use<> {
        let at = |p: DVec3| (p / self.cell).floor().as_ivec3();
        let (from, to) = (at(bounds.min), at(bounds.max));
        assert!((to - from).max_element() <= SPAN_MAX, "a box has grown far beyond the size of a cell");
        (from.x..=to.x).flat_map(move |x| {
            (from.y..=to.y).flat_map(move |y| (from.z..=to.z).map(move |z| IVec3::new(x, y, z)))
        })
    }
}

impl Filing for VoxelGrid {
    fn boxes(&mut self) -> &mut [Aabb] {
        &mut self.boxes
    }

    fn enter(&mut self, index: u32) {
        for cell in self.span(&self.boxes[index as usize]) {
            self.visits += 1;
            self.cells.entry(cell).or_default().push(index);
        }
    }

    fn leave(&mut self, index: u32) {
        for cell in self.span(&self.boxes[index as usize]) {
            self.visits += 1;
            let list = self.cells.get_mut(&cell).expect("the box entered this cell");
            list.retain(|&i| i != index);
            if list.is_empty() {
                self.cells.remove(&cell);
            }
        }
    }
}

impl BroadTest for VoxelGrid {
    fn name(&self) -> &'static str {
        "voxel grid"
    }

    fn update(&mut self, moved: &[(u32, Aabb)]) {
        self.refile(moved);
    }

    /// Two boxes may share many cells: the pairs go through a set, which is the drawback that the thesis names.
    fn pairs(&self) -> Vec<(u32, u32)> {
        let mut pairs = BTreeSet::new();
        for list in self.cells.values() {
            for (k, &i) in list.iter().enumerate() {
                self.box_tests.set(self.box_tests.get() + k as u64);
                let overlapping = |j: &&u32| self.boxes[i as usize].overlaps(&self.boxes[**j as usize]);
                pairs.extend(list[..k].iter().filter(overlapping).map(|&j| ordered(i, j)));
            }
        }
        pairs.into_iter().collect()
    }

    fn steps(&self) -> u64 {
        self.visits
    }

    fn box_tests(&self) -> u64 {
        self.box_tests.get()
    }
}
