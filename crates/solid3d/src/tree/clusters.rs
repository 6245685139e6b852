//! Clusters: a first order of many primitives, by the cells of a grid.
//!
//! To bin all primitives again at each level of the tree is most of the work of a build. So those of a cell are taken together, and the
//! upper levels are found by the same heuristic on boxes of cells, of which there are few; only what is within a cell is binned by itself.
//! (Garanzha, Pantaleoni and McAllister, *Simpler and faster HLBVH with work queues*, 2011, do the same with cells along a Morton curve.)
//! The boxes of cells are tight, so a plane that is found is as good as one of 16 bins, but where cells are larger than bins.

#[cfg(feature = "rayon")]
use rayon::prelude::*;
use solid_convex::simd::{dispatch, level};

use super::packed::PackedBox;
use super::split::{Item, Set, Spare};
use crate::threads::for_each_part;
#[cfg(feature = "rayon")]
use crate::threads::share;

/// Fewer primitives have no clusters: a tree of 5,000 triangles is built fast enough, and with clusters a pair of them takes 5 % more box
/// tests. Of 100,000 it is 2 %, and as many tests of primitives.
const PRIMITIVES_MIN: usize = 1 << 13;

/// Primitives for each cell of the grid. A surface goes through some of the cells only, and has several times as many in each.
const PRIMITIVES_PER_CELL: usize = 32;

/// Items that are gathered in one piece.
const GATHERED: usize = 1 << 11;

/// So many primitives are worth another thread.
const PRIMITIVES_MANY: usize = 1 << 13;

/// Equal cells that divide a box.
struct Grid {
    origin: [f32; 3],
    per_unit: f32,
    cells: [usize; 3],
}

impl Grid {
    /// So many cells at most, about as wide on every axis.
    fn new(root: &PackedBox, cells_max: usize) -> Self {
        /// The sides of cells are tried that are so much smaller each time.
        const SHRINK: f32 = 0.875;
        /// 2^-28 of the root, with no more than 2^28 primitives in a row.
        const TRIALS_MAX: usize = 146;
        let sizes = [0, 1, 2].map(|axis| root.size(axis));
        let longest = sizes[0].max(sizes[1]).max(sizes[2]);
        let cells_of = |side: f32| sizes.map(|size| ((size / side) as usize).max(1));
        let mut side = longest;
        let mut cells = cells_of(side);
        for _ in 0..TRIALS_MAX {
            let next = cells_of(side * SHRINK);
            if next[0].saturating_mul(next[1]).saturating_mul(next[2]) > cells_max {
                break;
            }
            (side, cells) = (side * SHRINK, next);
        }
        Grid { origin: root.min(), per_unit: 1.0 / side, cells }
    }

    fn len(&self) -> usize {
        self.cells[0] * self.cells[1] * self.cells[2]
    }

    /// The cell in which the centre of a box is.
    #[inline(always)]
    fn cell(&self, bounds: &PackedBox) -> usize {
        let along = |axis: usize| {
            let offset = (0.5 * bounds.center_doubled(axis) - self.origin[axis]) * self.per_unit;
            (offset as i32 as usize).min(self.cells[axis] - 1)
        };
        along(0) + self.cells[0] * (along(1) + self.cells[1] * along(2))
    }
}

/// A union of clusters in the tree that is cut along cells.
#[derive(Clone, Copy, Debug)]
struct Joint {
    /// Of primitives.
    set: Set,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// One cluster: that of a cell.
    Cell(u32),
    /// Cut into two joints: the first of them, which the second follows.
    Cut(JointIndex),
}

/// The tree above the clusters: binary, cut by the surface-area heuristic.
#[derive(Debug, Default)]
pub(super) struct Clusters {
    /// The root first, if there are clusters; children after their parent.
    joints: Vec<Joint>,
}

/// The number of a joint.
pub(super) type JointIndex = u32;

impl Clusters {
    /// The root, if there are clusters.
    pub fn root(&self) -> Option<(JointIndex, Set)> {
        self.joints.first().map(|joint| (0, joint.set))
    }

    /// What a joint is cut into; nothing if it is one cluster.
    pub fn below(&self, joint: JointIndex) -> Option<[(JointIndex, Set); 2]> {
        match self.joints[joint as usize].kind {
            Kind::Cell(_) => None,
            Kind::Cut(first) => {
                Some([first, first + 1].map(|index| (index, self.joints[index as usize].set)))
            }
        }
    }
}

/// The items of primitives `0..count` in an order in which each joint is consecutive, and the joints.
///
/// `pack` gives the box of a primitive, and `root` that of all.
pub(super) fn arrange(
    count: usize,
    root: &PackedBox,
    pack: impl Fn(u32) -> PackedBox + Sync + Send,
) -> (Vec<Item>, Clusters) {
    let item = |index: u32| Item { bounds: pack(index), index };
    if count < PRIMITIVES_MIN {
        let order: Vec<u32> = (0..count as u32).collect();
        return (gather(&order, item), Clusters::default());
    }
    let grid = Grid::new(root, count / PRIMITIVES_PER_CELL);
    let mut cells = vec![0; count];
    let (mut clusters, mut weights) = (Vec::new(), vec![0; grid.len()]);
    for (cell, Cell { bounds, count }) in (0..).zip(fill(&grid, &mut cells, &pack)) {
        if count > 0 {
            clusters.push(Item { bounds, index: cell });
            weights[cell as usize] = count;
        }
    }
    let mut joints = cut(&mut clusters, &weights);
    // Where the next primitive of each cell goes.
    let mut next = weights;
    place(&mut joints, &mut next);
    let mut order = vec![0; count];
    for (primitive, &cell) in (0..).zip(&cells) {
        let place = &mut next[cell as usize];
        order[*place as usize] = primitive;
        *place += 1;
    }
    (gather(&order, item), Clusters { joints })
}

/// What is in a cell.
#[derive(Clone, Copy)]
struct Cell {
    bounds: PackedBox,
    count: u32,
}

/// Finds the cell of each primitive, and what is in each cell.
fn fill(grid: &Grid, cells: &mut [u32], pack: &(impl Fn(u32) -> PackedBox + Sync)) -> Vec<Cell> {
    let fill_part = |first: usize, cells: &mut [u32]| {
        let mut table = vec![Cell { bounds: PackedBox::EMPTY, count: 0 }; grid.len()];
        dispatch!(level(), simd => {
            for (index, cell) in (first as u32..).zip(cells) {
                let bounds = pack(index);
                let at = grid.cell(&bounds);
                *cell = at as u32;
                table[at].bounds.grow_on(simd, &bounds);
                table[at].count += 1;
            }
        });
        table
    };
    #[cfg(feature = "rayon")]
    if share(cells.len(), PRIMITIVES_MANY) {
        // A table for each thread. What is in a cell does not depend on who found it.
        let part = cells.len().div_ceil(rayon::current_num_threads());
        let parts = cells.par_chunks_mut(part).enumerate();
        let tables: Vec<Vec<Cell>> = parts.map(|(i, cells)| fill_part(i * part, cells)).collect();
        let joined = tables.into_iter().reduce(|mut sum, table| {
            for (cell, other) in sum.iter_mut().zip(table) {
                cell.bounds.grow(&other.bounds);
                cell.count += other.count;
            }
            sum
        });
        return joined.unwrap_or_default();
    }
    fill_part(0, cells)
}

/// Cuts clusters, of cells with so many primitives, by the surface-area heuristic until each is alone. Sets are of clusters.
fn cut(clusters: &mut [Item], weights: &[u32]) -> Vec<Joint> {
    let mut joints = Vec::with_capacity(2 * clusters.len());
    let mut spare = Spare::default();
    dispatch!(level(), simd => {
        let joint = |set: Set, clusters: &[Item]| Joint { set, kind: Kind::Cell(clusters[set.start].index) };
        joints.push(joint(Set::new(simd, 0, clusters), clusters));
        let mut index = 0;
        // Ends, because a cut makes two of fewer clusters.
        while index < joints.len() {
            let set = joints[index].set;
            if set.len > 1 {
                joints[index].kind = Kind::Cut(joints.len() as JointIndex);
                let items = &mut clusters[set.start..set.start + set.len];
                for half in set.split(simd, items, &mut spare, |item| weights[item.index as usize]) {
                    joints.push(joint(half, clusters));
                }
            }
            index += 1;
        }
    });
    joints
}

/// Makes the sets of joints sets of primitives; of each cell it takes how many there are, and gives where the first goes.
fn place(joints: &mut [Joint], cells: &mut [u32]) {
    for index in (0..joints.len()).rev() {
        joints[index].set.len = match joints[index].kind {
            Kind::Cell(cell) => cells[cell as usize] as usize,
            Kind::Cut(first) => joints[first as usize].set.len + joints[first as usize + 1].set.len,
        };
    }
    joints[0].set.start = 0;
    for index in 0..joints.len() {
        let Joint { set: Set { start, .. }, kind } = joints[index];
        match kind {
            Kind::Cell(cell) => cells[cell as usize] = start as u32,
            Kind::Cut(first) => {
                let first = first as usize;
                joints[first].set.start = start;
                joints[first + 1].set.start = start + joints[first].set.len;
            }
        }
    }
}

/// The items of primitives in an order.
fn gather(order: &[u32], item: impl Fn(u32) -> Item + Sync + Send) -> Vec<Item> {
    let mut items = vec![Item::NONE; order.len()];
    for_each_part(&mut items, GATHERED, PRIMITIVES_MANY, |i, items| {
        let order = &order[i * GATHERED..][..items.len()];
        dispatch!(level(), _simd => {
            for (to, &index) in items.iter_mut().zip(order) {
                *to = item(index);
            }
        });
    });
    items
}
