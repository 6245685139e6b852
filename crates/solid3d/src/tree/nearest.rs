//! Branch and bound for one query.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x4, f64x8};
use solid_convex::simd::{Level, dispatch};

use super::lanes::{LANES, bits, distances_squared_to_box, lanes};
use super::metric::{Folded, PairMetric};
use super::node::{Child, Kind, Node, WIDTH};
use super::packed::PackedBox;
use super::{Leaf, Place, Traversal, Tree};
use crate::Aabb;

/// Where a query is: within a distance, in the world, of some point of a box of local coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub bounds: Aabb,
    pub radius: f64,
}

/// What [`nearest_on`](Tree::nearest_on) is asked, in the coordinates of the tree.
pub(crate) struct NearQuery {
    last: (PackedBox, f64),
    before: Option<(PackedBox, f64)>,
    metric: Folded,
}

/// The boxes of a node.
pub(crate) struct Boxes<'t>(pub(super) &'t Node);

impl Boxes<'_> {
    /// Their ends along an axis, in tree coordinates.
    #[inline(always)]
    pub fn axis<S: Simd>(&self, simd: S, axis: usize) -> (f32x8<S>, f32x8<S>) {
        lanes(simd, self.0, axis)
    }
}

/// What is done with leaves, in vectors of the level of instructions that the walk runs on.
pub(crate) trait NearLeaves {
    /// Of how many nodes, the last opened, the nearest child comes next: nodes that were opened since may hold what is farther. Where the first
    /// that is found will do, one is enough.
    const NODES_LOOKED_AT: usize = 3;

    /// Raises lower bounds of the distances to anything in the boxes of a node, where it knows better; of lanes that are not in use they mean nothing.
    #[inline(always)]
    fn raise<S: Simd>(&mut self, _simd: S, _boxes: &Boxes, _bounds: &mut [f64; WIDTH]) {}

    /// Asks for the memory of a leaf that the walk may come to.
    #[inline(always)]
    fn prefetch(&self, _leaf: &Leaf) {}

    /// Called with the leaves that may hold something nearer than `best`; lowers it.
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, best: &mut f64);
}

impl Tree {
    /// Visits the leaves that may hold something nearer than `best`, the nearest child first.
    ///
    /// `bound` gives a lower bound of the distance of the query to anything in a local box. `visit` lowers the best distance as it
    /// finds nearer primitives; subtrees whose bound is not below it are skipped. At zero the query ends.
    ///
    /// ```
    /// use solid3d::{Aabb, glam::DVec3, tree::{Traversal, Tree}};
    /// let points: Vec<DVec3> = (0..100).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
    /// let tree = Tree::build(&points.iter().map(|&p| Aabb::new(p, p)).collect::<Vec<_>>());
    ///
    /// let query = DVec3::new(41.7, 3.0, 0.0);
    /// let bound = |b: &Aabb| query.distance(query.clamp(b.min, b.max));
    /// let (mut best, mut nearest) = (f64::INFINITY, None);
    /// tree.nearest(bound, &mut best, &mut Traversal::default(), |leaf, best| {
    ///     for &i in leaf {
    ///         let distance = points[i as usize].distance(query);
    ///         if distance < *best {
    ///             (*best, nearest) = (distance, Some(i));
    ///         }
    ///     }
    /// });
    /// assert_eq!(nearest, Some(42));
    /// ```
    pub fn nearest(
        &self,
        bound: impl Fn(&Aabb) -> f64,
        best: &mut f64,
        traversal: &mut Traversal,
        mut visit: impl FnMut(&[u32], &mut f64),
    ) {
        let bounds = |node: &Node, bounds: &mut [f64; WIDTH]| {
            for (lane, least) in bounds.iter_mut().enumerate() {
                if node.child[lane] != Child::EMPTY {
                    *least = bound(&self.normal.unpack(&node.lane(lane)));
                }
            }
        };
        let mut visitor = Plain(&mut visit);
        dispatch!(simd => self.walk_near(simd, &mut visitor, bounds, best, traversal));
    }

    /// The query that `last` holds, and `before` too. Of `metric`, the half for `a` counts. Where both tell no distance, the last gives the order.
    #[inline(always)] // into kernels, where nothing of it need be written before it is read
    pub(crate) fn near_query(&self, before: Option<Around>, last: Around, metric: &PairMetric) -> NearQuery {
        let pack = {
            #[inline(always)]
            |Around { bounds, radius }: Around| (self.normal.pack_any(&bounds), radius)
        };
        let metric = Folded::new(metric, &self.normal, &self.normal);
        NearQuery { last: pack(last), before: before.map(pack), metric }
    }

    /// As [`nearest`](Tree::nearest), on a level of instructions.
    pub(crate) fn nearest_on(
        &self,
        level: Level,
        query: &NearQuery,
        best: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut impl NearLeaves,
    ) {
        dispatch!(widest level, simd => {
            self.walk_near(
                simd,
                visitor,
                #[inline(always)]
                |node, bounds| bound_lanes(simd, node, query, bounds),
                best,
                traversal,
            );
        });
    }

    /// `bounds` fills in lower bounds of the lanes in use.
    #[inline(always)] // into the function that is compiled for a level of instructions
    fn walk_near<S: Simd, V: NearLeaves>(
        &self,
        simd: S,
        visitor: &mut V,
        bounds: impl Fn(&Node, &mut [f64; WIDTH]),
        best: &mut f64,
        traversal: &mut Traversal,
    ) {
        let Traversal { counters, near: broods, .. } = traversal;
        broods.clear();
        // What comes next, where it is known: of a node with near children mostly one of these.
        let mut next = Some((f64::NEG_INFINITY, Place::ROOT));
        while let Some((least, place)) = next.take().or_else(
            #[inline(always)]
            || broods.take(simd, V::NODES_LOOKED_AT, *best),
        ) {
            // Bounds below zero are as good as zero.
            if *best == 0.0 {
                return;
            }
            let child = self.child_at(place);
            if least >= *best || child == Child::EMPTY {
                continue;
            }
            match child.kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visitor.visit(simd, &self.leaf_at(place, range), best);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let node = &self.nodes[index];
                    // Empty lanes are infinitely far, or do no harm.
                    let mut of_lanes = [f64::INFINITY; WIDTH];
                    bounds(node, &mut of_lanes);
                    if reaching(simd, &of_lanes, *best) == u32::MAX {
                        continue;
                    }
                    visitor.raise(simd, &Boxes(node), &mut of_lanes);
                    let near = !reaching(simd, &of_lanes, *best);
                    if near == 0 {
                        continue;
                    }
                    if near.is_power_of_two() {
                        let lane = near.trailing_zeros() as usize;
                        next = Some((of_lanes[lane], Place::lane(index, lane)));
                        continue;
                    }
                    for lane in bits(near) {
                        self.prefetch(
                            (node.child[lane], Place::lane(index, lane)),
                            #[inline(always)]
                            |leaf| visitor.prefetch(leaf),
                        );
                    }
                    next = broods.add_and_take(simd, (index, &of_lanes), V::NODES_LOOKED_AT, *best);
                }
            }
        }
    }
}

/// The lanes whose bound is at least a limit, as bits.
#[inline(always)]
fn reaching<S: Simd>(simd: S, bounds: &[f64; WIDTH], limit: f64) -> u32 {
    let bounds = f64x8::from_slice(simd, bounds);
    bounds.simd_ge(f64x8::splat(simd, limit)).to_bitmask() as u32 | !LANES
}

/// What needs no vectors. Not generic over the function: the walk is compiled for every level of instructions.
struct Plain<'f>(&'f mut dyn FnMut(&[u32], &mut f64));

impl NearLeaves for Plain<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, _: S, leaf: &Leaf, best: &mut f64) {
        (self.0)(leaf.primitives, best);
    }
}

#[inline(never)] // nor into each walk: on the scalar level, optimising these then takes minutes
fn bound_lanes<S: Simd>(simd: S, node: &Node, query: &NearQuery, bounds: &mut [f64; WIDTH]) {
    simd.vectorize(
        #[inline(always)]
        || bound_lanes_on(simd, node, query, bounds),
    );
}

#[inline(always)]
fn bound_lanes_on<S: Simd>(
    simd: S,
    node: &Node,
    NearQuery { last, before, metric }: &NearQuery,
    bounds: &mut [f64; WIDTH],
) {
    let least = {
        #[inline(always)]
        |(query, radius): &(PackedBox, f64)| {
            let squared = distances_squared_to_box(simd, node, query, &metric.a);
            let [low, high] = metric.world(simd, squared);
            let radius = f64x4::splat(simd, *radius);
            [low - radius, high - radius]
        }
    };
    let mut all = least(last);
    if let Some(query) = before {
        for (bound, least) in all.iter_mut().zip(least(query)) {
            let counts = least.simd_gt(f64x4::splat(simd, 0.0)) & least.simd_gt(*bound);
            *bound = counts.select(least, *bound);
        }
    }
    // At once, as they will be read.
    simd.combine_f64x4(all[0], all[1]).store_slice(bounds);
}
