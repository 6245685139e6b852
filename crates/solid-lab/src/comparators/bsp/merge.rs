use solid3d::Aabb;
use solid3d::glam::{DAffine3, DVec3};

use super::build::greatest_coordinate;
use super::cell::Cell;
use super::{BspTree, Child, FLAT, Plane};

/// Whether two polyhedra intersect, by merging their trees until a cell is inside both (thesis, section 5.1.3).
///
/// Source: Naylor, Amanatides and Thibault, *Merging BSP trees yields polyhedral set operations*, 1990. Deviation: theirs splits one tree by
/// each plane of the other, with a convex polygon at each node to split it by, and makes a third tree. For the question alone no tree is needed: the
/// region that the planes above leave is carried along and cut, first by the planes of the one tree, and where that is inside, by those of
/// the other. So nodes are without polygons, and nothing is stored.
#[derive(Clone, Debug, Default)]
pub struct Merge {
    counters: Counters,
}

/// Work done: counts that repeat exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Planes that a cell was held against.
    pub planes: u64,
    /// Of those, the ones that cut it.
    pub cuts: u64,
}

/// A part of space, and what both trees still have to say about it.
struct Region {
    cell: Cell,
    children: [Child; 2],
}

impl Merge {
    /// Whether the solids have a part in common that is thicker than the tolerance. `b_to_a` must have an inverse.
    pub fn intersect(&mut self, a: &BspTree, b: &BspTree, b_to_a: &DAffine3) -> bool {
        let transposed_inverse = b_to_a.matrix3.inverse().transpose();
        let placed_bounds = b.bounds().transformed(b_to_a);
        let tolerance = FLAT * greatest_coordinate(&a.bounds()).max(greatest_coordinate(&placed_bounds));
        let Some(cell) = self.common_box(a, b, tolerance, |plane| plane.placed(b_to_a, &transposed_inverse))
        else {
            return false;
        };
        let mut open = vec![Region { cell, children: [a.root(), b.root()] }];
        while let Some(Region { cell, children }) = open.pop() {
            let (plane, parts) = match children {
                [Child::Out, _] | [_, Child::Out] => continue,
                [Child::In, Child::In] => return true,
                [Child::Node(number), other] => {
                    let node = a.nodes()[number as usize];
                    (node.plane, [node.above, node.below].map(|child| [child, other]))
                }
                [Child::In, Child::Node(number)] => {
                    let node = b.nodes()[number as usize];
                    let plane = node.plane.placed(b_to_a, &transposed_inverse);
                    (plane, [node.above, node.below].map(|child| [Child::In, child]))
                }
            };
            let cells = self.cut(cell, &plane, tolerance);
            for (cell, children) in cells.into_iter().zip(parts) {
                open.extend(cell.map(|cell| Region { cell, children }));
            }
        }
        false
    }

    /// The work done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// What the boxes around both have in common. Space: A's.
    fn common_box(
        &mut self,
        a: &BspTree,
        b: &BspTree,
        tolerance: f64,
        placed: impl Fn(Plane) -> Plane,
    ) -> Option<Cell> {
        if a.nodes().is_empty() || b.nodes().is_empty() {
            return None;
        }
        let Aabb { min, max } = b.bounds();
        let mut cell = Cell::of_box(&a.bounds());
        for (normal, offset) in DVec3::AXES.into_iter().flat_map(|n| [(n, n.dot(max)), (-n, -n.dot(min))]) {
            let [_, below] = self.cut(cell, &placed(Plane { normal, offset }), tolerance);
            cell = below?;
        }
        Some(cell)
    }

    /// What of a cell is above a plane, and below it.
    fn cut(&mut self, cell: Cell, plane: &Plane, tolerance: f64) -> [Option<Cell>; 2] {
        let parts = cell.cut(plane, tolerance);
        self.counters.planes += 1;
        self.counters.cuts += u64::from(parts.above.is_some() && parts.below.is_some());
        [parts.above, parts.below]
    }
}
