//! Branch and bound for two trees.

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::DVec3;
use solid_convex::simd::{Level, dispatch, level};

use super::beam::seek;
use super::facing::{Faces, Facing};
use super::insertion::push_unless_far;
use super::lanes::{bits, distances_squared, extents};
use super::metric::{Folded, PairMetric};
use super::pairs::{Duel, Pair, Step, Tested};
use super::relative::Relative;
use super::squares::reaching;
use super::traversal::STACK_USUAL;
use super::{Traversal, Tree};

/// Visits the pairs of leaves that may hold primitives nearer to each other, in the world, than `best`; nearest children first.
///
/// `visit` lowers the best distance as it finds nearer primitives; pairs whose lower bound is not below it are skipped. At zero
/// the query ends. Nothing nearer is lost, however the placements stretch, shear and mirror.
///
/// ```
/// use solid3d::{Aabb, glam::{DAffine3, DVec3}, tree::{PairMetric, Relative, Traversal, Tree, nearest_pairs}};
///
/// let points: Vec<DVec3> = (0..100).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
/// let tree = Tree::build(&points.iter().map(|&p| Aabb::new(p, p)).collect::<Vec<_>>());
/// let b_to_a = DAffine3::from_translation(DVec3::new(101.5, 2.0, 0.0));
/// let relative = Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: 1e-12, slack_in_b: 1e-12 };
/// let metric = PairMetric { facet_a: DVec3::ONE, facet_b: DVec3::ONE, sigma_min_a: 1.0, sigma_min_b: 1.0 };
///
/// let mut best = f64::INFINITY;
/// nearest_pairs(&tree, &tree, &relative, &metric, &mut best, &mut Traversal::default(), |leaf_a, leaf_b, best| {
///     for &i in leaf_a {
///         for &j in leaf_b {
///             *best = best.min(points[i as usize].distance(b_to_a.transform_point3(points[j as usize])));
///         }
///     }
/// });
/// assert_eq!(best, DVec3::new(2.5, 2.0, 0.0).length());
/// ```
pub fn nearest_pairs(
    a: &Tree,
    b: &Tree,
    relative: &Relative,
    metric: &PairMetric,
    best: &mut f64,
    traversal: &mut Traversal,
    mut visit: impl FnMut(&[u32], &[u32], &mut f64),
) {
    nearest_pairs_on(level(), a, b, relative, metric, None, best, traversal, &mut Plain(&mut visit));
}

/// What is done with pairs of leaves, in vectors of the level of instructions that the walk runs on.
pub(crate) trait NearLeafPairs {
    /// A direction along which what was nearest was apart, in the space in which distances count: of length one, or zero.
    fn axis(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// Called with the pairs of leaves that may hold something nearer than `best`; lowers it.
    fn visit<S: Simd>(&mut self, simd: S, in_a: &[u32], in_b: &[u32], best: &mut f64);
}

/// What needs no vectors. Not generic over the function: each walk is compiled for every level of instructions.
struct Plain<'f>(&'f mut Visit<'f>);

type Visit<'f> = dyn FnMut(&[u32], &[u32], &mut f64) + 'f;

impl NearLeafPairs for Plain<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, _: S, in_a: &[u32], in_b: &[u32], best: &mut f64) {
        (self.0)(in_a, in_b, best);
    }
}

/// As [`nearest_pairs`], on a level of instructions, and with slabs if there are any: their common space is that of the metric.
#[expect(clippy::too_many_arguments, reason = "the public function, the level and the slabs")]
pub(crate) fn nearest_pairs_on(
    level: Level,
    a: &Tree,
    b: &Tree,
    relative: &Relative,
    metric: &PairMetric,
    facing: Option<&Facing>,
    best: &mut f64,
    traversal: &mut Traversal,
    visitor: &mut impl NearLeafPairs,
) {
    let duel = Duel::one_by_one(a, b, relative);
    let metric = Folded::new(metric, &a.normal, &b.normal);
    let faces = facing.and_then(|facing| Faces::new(facing, a, b));
    dispatch!(widest level, simd => walk(simd, &duel, &metric, faces.as_ref(), best, traversal, visitor));
}

#[inline(always)] // into the function that is compiled for a level of instructions
fn walk<S: Simd>(
    simd: S,
    duel: &Duel,
    metric: &Folded,
    faces: Option<&Faces>,
    best: &mut f64,
    traversal: &mut Traversal,
    visitor: &mut impl NearLeafPairs,
) {
    let Traversal { counters, near_pairs: stack, .. } = traversal;
    stack.clear();
    stack.reserve(STACK_USUAL);
    stack.push((0.0, duel.roots()));
    if *best == f64::INFINITY {
        stack.extend(seek(simd, duel, counters).map(|pair| (0.0, pair)));
    }
    let mut opening = Opening { duel, metric, faces, tested: Default::default() };
    let mut limit = metric.limit(*best);
    while let Some((square, pair)) = stack.pop() {
        if *best == 0.0 {
            return;
        }
        if square >= limit {
            continue;
        }
        match duel.step(&pair) {
            Step::Leaves(leaf_a, leaf_b) => {
                counters.leaf_visits += 1;
                visitor.visit(simd, leaf_a, leaf_b, best);
                limit = metric.limit(*best);
            }
            Step::OpenA(node) => {
                counters.box_tests += 1;
                opening.push::<_, 0>(simd, pair, node, visitor.axis(), limit, stack);
            }
            Step::OpenB(node) => {
                counters.box_tests += 1;
                opening.push::<_, 1>(simd, pair, node, visitor.axis(), limit, stack);
            }
            Step::OpenBoth(..) => unreachable!("nodes are opened one by one"),
            Step::Nothing => {}
        }
    }
}

/// What it takes to open a node of either tree.
struct Opening<'w, 't> {
    duel: &'w Duel<'t>,
    metric: &'w Folded,
    faces: Option<&'w Faces<'t>>,
    tested: [Tested; 2],
}

impl Opening<'_, '_> {
    /// Puts the lanes of a node of a pair on the stack that may hold something nearer than the limit is; of the first tree for `OF` = 0, of the
    /// second for 1.
    #[inline(always)]
    fn push<S: Simd, const OF: usize>(
        &mut self,
        simd: S,
        pair: Pair,
        node: usize,
        axis: DVec3,
        limit: f32,
        stack: &mut Vec<(f32, Pair)>,
    ) {
        let Opening { duel, metric, faces, tested } = self;
        let other = 1 - OF;
        let (trees, weights) = ([duel.a, duel.b], [&metric.a, &metric.b]);
        let (lanes, beside) = (&trees[OF].nodes[node], [pair.b, pair.a][OF]);
        let crossing = if OF == 0 { duel.b_to_a() } else { duel.a_to_b() };
        let probe = tested[other].probe(simd, crossing, trees[other], beside);
        let mut squares = distances_squared(simd, lanes, crossing, probe, weights[OF], weights[other]);
        let mut near = !reaching(simd, squares, limit);
        if near == 0 {
            return;
        }
        if let Some(faces) = faces {
            squares = faces.raised::<S, OF>(simd, (node, beside), axis, metric.units, limit, squares);
            near = !reaching(simd, squares, limit);
        }
        let (squares, extents, from) = (squares.to_array(), extents(simd, lanes), stack.len());
        for lane in bits(near) {
            let below =
                if OF == 0 { pair.with_a(node, lane, &extents) } else { pair.with_b(node, lane, &extents) };
            push_unless_far((squares[lane], below), limit, stack, from);
        }
    }
}
