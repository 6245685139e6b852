//! Branch and bound for one query: what it asks, and the walk down the tree, the nearest child first.
//!
//! Subtrees are compared by [squares](super::squares) of the distance of their boxes from that of the query. With a radius r around that, what is at a
//! distance d is d + r from it.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use solid_convex::simd::{Level, dispatch};

use super::lanes::{bits, distances_squared_to_box, lanes};
use super::metric::{Folded, PairMetric};
use super::node::{Kind, Node};
use super::normal::round_down;
use super::packed::PackedBox;
use super::squares::{below, key_limit, keys, lane, limit, raised};
use super::{Leaf, Place, Signposts, Traversal, Tree};
use crate::Aabb;

/// Where a query is: within a distance, in the world, of some point of a box of local coordinates; anywhere, if the distance is no number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub bounds: Aabb,
    pub radius: f64,
}

/// What [`nearest_on`](Tree::nearest_on) is asked, in the coordinates of the tree.
pub(crate) struct NearQuery {
    around: PackedBox,
    radius: f64,
    within: Option<PackedBox>,
    metric: Folded,
    /// The radius in units, by which squares are raised: no more than that.
    reach: f32,
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

    /// Lower bounds of the distances to anything in the boxes of a node, where it knows better; of lanes that are not in use they mean nothing.
    #[inline(always)]
    fn bounds<S: Simd>(&mut self, _simd: S, _boxes: &Boxes) -> Option<f32x8<S>> {
        None
    }

    /// Tells where to look before the walk, if what is found there may be all that is wanted.
    #[inline(always)]
    fn signposts(&self) -> Option<&Signposts> {
        None
    }

    /// Asks for the memory of a leaf that the walk may come to, given where it begins in the order of the tree.
    #[inline(always)]
    fn prefetch(&self, _start: usize) {}

    /// Called with the leaves that may hold something nearer than `best`; lowers it.
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, best: &mut f64);
}

impl Tree {
    /// What distances are worth in the world, of which the half for `a` counts.
    #[inline(always)]
    pub(crate) fn folded(&self, metric: &PairMetric) -> Folded {
        Folded::new(metric, &self.normal, &self.normal)
    }

    /// The same, where all are stretched alike: those of one are at least `length`.
    #[inline(always)]
    pub(crate) fn folded_alike(&self, length: f64) -> Folded {
        Folded::alike(length, &self.normal)
    }

    /// The query that is around `around`, and within a box too. Where both tell no distance, the former gives the order.
    #[inline(always)] // into kernels, where nothing of it need be written before it is read
    pub(crate) fn near_query<S: Simd>(
        &self,
        simd: S,
        within: Option<Aabb>,
        around: Around,
        metric: Folded,
    ) -> NearQuery {
        let Around { bounds, radius } = around;
        NearQuery {
            around: self.normal.pack_any(simd, &bounds),
            radius,
            within: within.map(
                #[inline(always)]
                |bounds| self.normal.pack_any(simd, &bounds),
            ),
            reach: round_down((radius * f64::from(metric.units)).min(f64::from(f32::MAX))),
            metric,
        }
    }

    /// Visits the leaves that may hold something nearer than `best`, the nearest child first, on a level of instructions. `visitor` lowers the best
    /// distance; at zero the walk ends.
    pub(crate) fn nearest_on(
        &self,
        level: Level,
        query: &NearQuery,
        best: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut impl NearLeaves,
    ) {
        dispatch!(widest level, simd => self.walk_near(simd, query, best, traversal, visitor));
    }

    /// The leaf that signposts name where the query is, if that is near.
    #[inline(always)]
    fn leaf_ahead<S: Simd>(
        &self,
        simd: S,
        query: &NearQuery,
        signposts: &Signposts,
        limit: i32,
    ) -> Option<Leaf<'_>> {
        let place = signposts.at(&query.around);
        let (node, lane) = place.split()?;
        let near = below(simd, keys(simd, query.squares(simd, &self.nodes[node])), limit);
        if near >> lane & 1 == 1 { self.leaf_if_any(place) } else { None }
    }

    #[inline(always)] // into the function that is compiled for a level of instructions
    fn walk_near<S: Simd, V: NearLeaves>(
        &self,
        simd: S,
        query: &NearQuery,
        best: &mut f64,
        traversal: &mut Traversal,
        visitor: &mut V,
    ) {
        let Traversal { counters, near: broods, .. } = traversal;
        broods.clear();
        let mut limit = query.limit(*best);
        if let Some(signposts) = visitor.signposts() {
            counters.box_tests += 1;
            if let Some(leaf) = self.leaf_ahead(simd, query, signposts, limit) {
                counters.leaf_visits += 1;
                visitor.visit(simd, &leaf, best);
                limit = query.limit(*best);
            }
        }
        // What comes next, where it is known: of a node with near children mostly one of these.
        let mut next = Some((0, Place::ROOT));
        while let Some((key, place)) = next.take().or_else(
            #[inline(always)]
            || broods.take(simd, V::NODES_LOOKED_AT, limit),
        ) {
            if *best == 0.0 {
                return;
            }
            if key >= limit {
                continue;
            }
            match self.child_at(place).kind() {
                Kind::Empty => {}
                Kind::Leaf(range) => {
                    counters.leaf_visits += 1;
                    visitor.visit(simd, &self.leaf_at(place, range), best);
                    limit = query.limit(*best);
                }
                Kind::Inner(index) => {
                    counters.box_tests += 1;
                    let node = &self.nodes[index];
                    let squares = query.squares(simd, node);
                    let mut found = keys(simd, squares);
                    let mut near = below(simd, found, limit);
                    if near != 0
                        && let Some(bounds) = visitor.bounds(simd, &Boxes(node))
                    {
                        found = keys(simd, query.raised(simd, squares, bounds));
                        near = below(simd, found, limit);
                    }
                    if near == 0 {
                        continue;
                    }
                    if near.is_power_of_two() {
                        let least = found.reduce_min();
                        next = Some((least, Place::lane(index, lane(least))));
                        continue;
                    }
                    next = broods.add_and_take(simd, (index, found), V::NODES_LOOKED_AT, limit);
                    // Last, as nobody can foretell how many there are: where the walk goes on is then on its way.
                    for lane in bits(near) {
                        self.prefetch(
                            node.child[lane],
                            #[inline(always)]
                            |start| visitor.prefetch(start),
                        );
                    }
                }
            }
        }
    }
}

impl NearQuery {
    /// What has a square of at least this is no nearer than a distance.
    #[inline(always)]
    fn limit(&self, distance: f64) -> i32 {
        key_limit(limit((distance + self.radius) * self.metric.per_unit))
    }

    /// Those of the lanes of a node. Empty lanes are far off, or do no harm.
    #[inline(always)]
    fn squares<S: Simd>(&self, simd: S, node: &Node) -> f32x8<S> {
        let squares = distances_squared_to_box(simd, node, &self.around, &self.metric.a);
        let Some(within) = &self.within else { return squares };
        let zero = f32x8::splat(simd, 0.0);
        let apart = distances_squared_to_box(simd, node, within, &self.metric.a);
        let units = apart.simd_gt(zero).select(apart.sqrt() + f32x8::splat(simd, self.reach), zero);
        raised(simd, squares, units)
    }

    /// Squares, raised by lower bounds of distances in the world.
    #[inline(always)]
    fn raised<S: Simd>(&self, simd: S, squares: f32x8<S>, bounds: f32x8<S>) -> f32x8<S> {
        let [units, reach] = [f32x8::splat(simd, self.metric.units), f32x8::splat(simd, self.reach)];
        raised(simd, squares, bounds * units + reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::node::WIDTH;
    use crate::tree::tests::scenes::{affine, metric, point, rng, uniform};
    use glam::{DAffine3, DVec3};
    use rand::Rng;
    use solid_convex::simd::alike;

    /// Looks for what is nearest.
    struct Nearest<'t, F> {
        tree: &'t Tree,
        distances: &'t [f64],
        /// Bounds of local boxes, where they are told.
        bound: Option<F>,
    }

    impl<F: Fn(&Aabb) -> f64> NearLeaves for Nearest<'_, F> {
        fn bounds<S: Simd>(&mut self, simd: S, boxes: &Boxes) -> Option<f32x8<S>> {
            let bound = self.bound.as_ref()?;
            let lane = |lane| round_down(bound(&self.tree.normal.unpack(&boxes.0.lane(lane))));
            Some(f32x8::from_slice(simd, &std::array::from_fn::<f32, WIDTH, _>(lane)))
        }

        fn visit<S: Simd>(&mut self, _: S, leaf: &Leaf, best: &mut f64) {
            *best = leaf.primitives.iter().map(|&i| self.distances[i as usize]).fold(*best, f64::min);
        }
    }

    /// Law: what is nearest to a ball, or to a point that is known to be in a box and in a ball, or of which bounds are told, is found, as brute force finds
    /// it: of any size and radius, under any affine map, on every level of instructions; and few leaves are visited, as many whatever the size.
    #[test]
    fn the_nearest_is_that_of_brute_force() {
        let mut rng = rng(99);
        let (mut traversal, cases) = (Traversal::default(), 600);
        for case in 0..cases {
            let [size, scale] = [(); 2].map(|()| 10f64.powi(rng.random_range(-40..40)));
            // A metric that tells nothing loses nothing, and the walk ends where there is no distance, in the last leaf too.
            let tells_nothing = case % 10 == 0;
            let count = if tells_nothing { 20 } else { 600 };
            let points: Vec<DVec3> = (0..count).map(|_| point(&mut rng, size)).collect();
            let tree = Tree::build(&points.iter().map(|&p| Aabb::new(p, p)).collect::<Vec<_>>());
            let query = if tells_nothing { points[case / 10 % 20] } else { point(&mut rng, 2.0 * size) };
            let (knows_bounds, knows_box) = (case % 3 == 1, case % 3 == 2);
            let map = if knows_bounds {
                DAffine3::from_scale(DVec3::splat(scale))
            } else {
                affine(&mut rng, scale, 0.0)
            };
            let metric = if tells_nothing { uniform(0.0) } else { metric(&map, &map) };
            let is_ball = case % 3 == 0;
            let radius = match case / 3 % 5 {
                _ if tells_nothing => 0.0,
                4 if !is_ball => f64::NAN,
                kind => [0.0, 1e-9, 0.1, 1e3, 1.0][kind] * size * scale,
            };
            let around = Around { bounds: Aabb::new(query, query), radius };
            let within = knows_box.then_some(around.bounds);
            let distances: Vec<f64> = (points.iter())
                .map(|&p| map.transform_vector3(p - query).length() - if is_ball { radius } else { 0.0 })
                .map(|distance| distance.max(0.0))
                .collect();
            let bound =
                |bounds: &Aabb| scale * query.distance(query.clamp(bounds.min, bounds.max)) * (1.0 - 1e-14);
            let limit = if case % 2 == 0 { f64::INFINITY } else { 1.5 * size * scale };
            let found = alike(|level| {
                let mut best = limit;
                let mut visitor =
                    Nearest { tree: &tree, distances: &distances, bound: knows_bounds.then_some(bound) };
                let query = dispatch!(widest level, simd => tree.near_query(simd, within, around, tree.folded(&metric)));
                tree.nearest_on(level, &query, &mut best, &mut traversal, &mut visitor);
                best
            });
            assert_eq!(found, distances.iter().copied().fold(limit, f64::min), "case {case}");
        }
        let visits = traversal.counters.leaf_visits;
        println!("{visits} leaves in {cases} queries, on each level");
        assert!(visits < 60 * cases as u64);
    }
}
