use std::ops::ControlFlow;

use solid3d::glam::DAffine3;

use super::{Child, Sat, Tree, Volume, triangles_intersect};

/// Work done by a traversal: counts that repeat exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Pairs of volumes tested: the thesis's `N_b`.
    pub box_tests: u64,
    /// Pairs of triangles tested: `N_p`.
    pub triangle_tests: u64,
    /// By the number of the axis that separated two volumes; first those that were found to overlap.
    pub exits: [u64; 16],
}

/// Tests pairs of trees (thesis, section 5.2.3), and counts.
#[derive(Clone, Debug)]
pub struct Traversal<V: Volume> {
    /// Which axes the boxes are tested on.
    pub sat: Sat,
    /// The work done so far.
    pub counters: Counters,
    stack: Vec<(u32, u32, V::Frame)>,
}

impl<V: Volume> Traversal<V> {
    /// With nothing counted.
    pub fn new(sat: Sat) -> Self {
        Traversal { sat, counters: Counters::default(), stack: Vec::new() }
    }

    /// Whether any two triangles intersect, `b_to_a` taking the space of `b` to that of `a`.
    pub fn intersects(&mut self, a: &Tree<V>, b: &Tree<V>, b_to_a: &DAffine3) -> bool {
        self.visit(a, b, b_to_a, |_, _| ControlFlow::Break(())).is_break()
    }

    /// All pairs of triangles that intersect, in no particular order.
    pub fn pairs(&mut self, a: &Tree<V>, b: &Tree<V>, b_to_a: &DAffine3) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let _ = self.visit(a, b, b_to_a, |i, j| {
            pairs.push((i, j));
            ControlFlow::Continue(())
        });
        pairs
    }

    /// Calls `found` for pairs of triangles that intersect until it breaks.
    fn visit(
        &mut self,
        a: &Tree<V>,
        b: &Tree<V>,
        b_to_a: &DAffine3,
        mut found: impl FnMut(u32, u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let shared = V::shared(b_to_a);
        self.stack.clear();
        self.stack.push((0, 0, V::frame(&a.nodes[0].volume, &b.nodes[0].volume, b_to_a)));
        while let Some((i, j, frame)) = self.stack.pop() {
            let (node_a, node_b) = (&a.nodes[i as usize], &b.nodes[j as usize]);
            self.counters.box_tests += 1;
            let exit = V::exit_axis(&node_a.volume, &node_b.volume, &shared, &frame, self.sat);
            self.counters.exits[exit] += 1;
            if exit != 0 {
                continue;
            }
            // The larger volume is unfolded; a leaf cannot be.
            let a_first = node_a.volume.size() > node_b.volume.size();
            match (node_a.child, node_b.child) {
                (Child::Leaf(x), Child::Leaf(y)) => {
                    self.counters.triangle_tests += 1;
                    let moved = b.triangles[y as usize].map(|p| b_to_a.transform_point3(p));
                    if triangles_intersect(&a.triangles[x as usize], &moved) {
                        found(x, y)?;
                    }
                }
                (Child::Inner(first), other) if a_first || matches!(other, Child::Leaf(_)) => {
                    for child in [first + 1, first] {
                        let frame = V::frame_in_child_a(&frame, &a.nodes[child as usize].volume);
                        self.stack.push((child, j, frame));
                    }
                }
                (_, Child::Inner(first)) => {
                    for child in [first + 1, first] {
                        let frame = V::frame_in_child_b(&frame, &b.nodes[child as usize].volume);
                        self.stack.push((i, child, frame));
                    }
                }
                (Child::Inner(_), Child::Leaf(_)) => unreachable!("the first inner arm takes it"),
            }
        }
        ControlFlow::Continue(())
    }
}
