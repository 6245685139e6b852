//! Clusters: a first order of many primitives, by the cells of a grid.
//!
//! To bin all primitives again at each level of the tree is most of the work of a build. So those of a cell are taken together, and the
//! upper levels are found by the same heuristic on boxes of cells, of which there are few; only what is within a cell is binned by itself.
//! (Garanzha, Pantaleoni and McAllister, *Simpler and faster HLBVH with work queues*, 2011, do the same with cells along a Morton curve.)
//! The boxes of cells are tight, so a plane that is found is as good as one of 16 bins, but where cells are larger than bins.

#[cfg(feature = "rayon")]
use rayon::prelude::*;
use solid_convex::simd::dispatch;

use super::packed::PackedBox;
use super::split::{Item, Set, Spare};
use crate::threads::both;
#[cfg(feature = "rayon")]
use crate::threads::share;

/// Fewer primitives have no clusters: a tree of 5,000 triangles is built fast enough, and with clusters a pair of them takes 5 % more box
/// tests. Of 100,000 it is 2 %, and as many tests of primitives. So many are worth another thread.
const PRIMITIVES_MIN: usize = 1 << 13;

/// Primitives for each cell of the grid. A surface goes through some of the cells only, and has several times as many in each.
const PRIMITIVES_PER_CELL: usize = 32;

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
    /// Of primitives; of clusters while these are cut.
    set: Set,
    /// What it is cut into, unless it is one cluster: the first of two joints, which the second follows.
    below: Option<JointIndex>,
}

/// Where the primitives of a cluster are. They end where those of the next begin.
#[derive(Clone, Copy, Debug)]
struct Cluster {
    /// In the order of the tree.
    start: u32,
    /// Among those in the order of cells.
    by_cell: u32,
}

/// The clusters, and the tree above them: binary, cut by the surface-area heuristic.
#[derive(Debug)]
pub(super) struct Clusters {
    /// The root first; children after their parent.
    joints: Vec<Joint>,
    /// In the order of the tree, and then where the last ends.
    clusters: Vec<Cluster>,
    /// Cell by cell; those of a cell ascend.
    by_cell: Vec<u32>,
}

/// The number of a joint.
pub(super) type JointIndex = u32;

impl Clusters {
    /// The clusters of primitives `0..count`: `pack` gives the box of each, and `root` that of all. A few are one cluster.
    pub fn new(count: usize, root: &PackedBox, pack: &(impl Fn(u32) -> PackedBox + Sync)) -> Self {
        if count < PRIMITIVES_MIN {
            return Clusters {
                joints: vec![Joint { set: Set::of_bounds(*root, count), below: None }],
                clusters: [0, count as u32].map(|start| Cluster { start, by_cell: 0 }).to_vec(),
                by_cell: (0..count as u32).collect(),
            };
        }
        let grid = Grid::new(root, count / PRIMITIVES_PER_CELL);
        let mut cells = vec![0; count];
        let (mut items, mut counts) = (Vec::new(), vec![0; grid.len()]);
        for (cell, Cell { bounds, count }) in (0..).zip(fill(&grid, &mut cells, pack)) {
            if count > 0 {
                items.push(Item { bounds, index: cell });
                counts[cell as usize] = count;
            }
        }
        let (mut joints, mut by_cell, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        let (cut, sort) = (|| joints = cut(&mut items, &counts), || (by_cell, ends) = sort(&cells, &counts));
        both(true, cut, sort);
        let mut start = 0;
        let mut clusters = Vec::with_capacity(items.len() + 1);
        for cell in items.iter().map(|item| item.index as usize) {
            clusters.push(Cluster { start, by_cell: ends[cell] - counts[cell] });
            start += counts[cell];
        }
        clusters.push(Cluster { start, by_cell: 0 });
        for Joint { set, .. } in &mut joints {
            let [start, end] =
                [set.start, set.start + set.len].map(|cluster| clusters[cluster].start as usize);
            (set.start, set.len) = (start, end - start);
        }
        Clusters { joints, clusters, by_cell }
    }

    /// The joint of all.
    pub fn root(&self) -> (JointIndex, Set) {
        (0, self.joints[0].set)
    }

    /// What a joint is cut into; nothing if it is one cluster.
    pub fn below(&self, joint: JointIndex) -> Option<[(JointIndex, Set); 2]> {
        let first = self.joints[joint as usize].below?;
        Some([first, first + 1].map(|index| (index, self.joints[index as usize].set)))
    }

    /// The primitives of a joint's set, in the order of the tree, cluster by cluster.
    pub fn primitives(&self, set: &Set) -> impl Iterator<Item = &[u32]> {
        let (start, end) = (set.start as u32, (set.start + set.len) as u32);
        let first = self.clusters.partition_point(|cluster| cluster.start < start);
        let clusters = self.clusters[first..].windows(2).take_while(move |cluster| cluster[0].start < end);
        clusters.map(|cluster| {
            let count = cluster[1].start - cluster[0].start;
            &self.by_cell[cluster[0].by_cell as usize..][..count as usize]
        })
    }
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
        dispatch!(simd => {
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
    if share(cells.len(), PRIMITIVES_MIN) {
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
fn cut(clusters: &mut [Item], counts: &[u32]) -> Vec<Joint> {
    let mut joints = Vec::with_capacity(2 * clusters.len());
    let mut spare = Spare::default();
    dispatch!(simd => {
        joints.push(Joint { set: Set::new(simd, 0, clusters), below: None });
        let mut index = 0;
        // Ends, because a cut makes two of fewer clusters.
        while index < joints.len() {
            let set = joints[index].set;
            if set.len > 1 {
                joints[index].below = Some(joints.len() as JointIndex);
                let items = &mut clusters[set.start..set.start + set.len];
                for half in set.split(simd, items, &mut spare, |item| counts[item.index as usize]) {
                    joints.push(Joint { set: half, below: None });
                }
            }
            index += 1;
        }
    });
    joints
}

/// The primitives cell by cell, given the cell of each and how many are in each cell; and where those of each cell end.
fn sort(cells: &[u32], counts: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut next = Vec::with_capacity(counts.len());
    let mut start = 0;
    for &count in counts {
        next.push(start);
        start += count;
    }
    let mut by_cell = vec![0; cells.len()];
    for (primitive, &cell) in (0..).zip(cells) {
        let place = &mut next[cell as usize];
        by_cell[*place as usize] = primitive;
        *place += 1;
    }
    (by_cell, next)
}
