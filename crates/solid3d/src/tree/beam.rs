//! Pairs of leaves that are likely near to each other, for a first bound on a distance: a beam search by the distances of centres.
//!
//! Where boxes overlap all lower bounds are zero, and do not lead a walk to what is near. One that begins with a distance near the
//! least opens about half as many nodes. Nothing but time depends on what is found here.

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::DVec3;
use solid_convex::simd::part;

use super::lanes::{extents, lanes, splat};
use super::node::{Child, Node, WIDTH};
use super::order::{Order, PAIRS_MAX};
use super::pairs::{Duel, Pair, Step};
use super::traversal::Counters;

/// As many pairs go on from each level to the next, all of whose children can be put in order at once.
const BEAM: usize = 8;

/// Trees that have no more nodes, together, are as soon walked.
const NODES_MIN: usize = 2 * WIDTH;

/// The pair of leaves of those looked at whose centres are nearest; of small trees none.
#[inline(always)]
pub(super) fn seek<S: Simd>(simd: S, duel: &Duel, counters: &mut Counters) -> Option<Pair> {
    if duel.a.nodes.len() + duel.b.nodes.len() <= NODES_MIN {
        return None;
    }
    let mut beam = [(f32::MAX, duel.roots()); BEAM];
    let mut count = 1;
    let mut nearest: Option<(f32, Pair)> = None;
    while count > 0 {
        let mut children = [beam[0].1; BEAM * WIDTH];
        let mut distances = [0.0; BEAM * WIDTH];
        let mut opened = 0;
        for &(distance, pair) in &beam[..count] {
            let (is_a, node) = match duel.step(&pair) {
                Step::OpenA(node) => (true, node),
                Step::OpenB(node) => (false, node),
                Step::Leaves(..) => {
                    if nearest.is_none_or(|nearest| distance < nearest.0) {
                        nearest = Some((distance, pair));
                    }
                    continue;
                }
                Step::OpenBoth(..) | Step::Nothing => continue,
            };
            counters.box_tests += 1;
            let (center, unit) = if is_a { duel.center_of_b(&pair) } else { duel.center_of_a(&pair) };
            let lanes = if is_a { &duel.a.nodes[node] } else { &duel.b.nodes[node] };
            let extents = extents(simd, lanes);
            let of_lanes = distances_squared(simd, lanes, center, unit);
            for (lane, (distance, child)) in of_lanes.into_iter().zip(lanes.child).enumerate() {
                if child == Child::EMPTY {
                    break;
                }
                children[opened] =
                    if is_a { pair.with_a(node, lane, &extents) } else { pair.with_b(node, lane, &extents) };
                distances[opened] = distance;
                opened += 1;
            }
        }
        let all = u64::MAX.checked_shr((PAIRS_MAX - opened) as u32).unwrap_or(0);
        let order = Order::ascending(simd, all, &distances);
        count = opened.min(BEAM);
        for (pair, &child) in beam.iter_mut().zip(order.as_slice()) {
            *pair = (distances[usize::from(child)], children[usize::from(child)]);
        }
    }
    Some(nearest?.1)
}

/// The squared distances of the centres of the lanes from a point of their coordinates, in a unit.
#[inline(always)]
fn distances_squared<S: Simd>(simd: S, node: &Node, from: DVec3, unit: f32) -> [f32; WIDTH] {
    part!(simd => {
        let mut squared = splat(simd, 0.0);
        for axis in 0..3 {
            let (min, max) = lanes(simd, node, axis);
            let way = splat(simd, unit) * (splat(simd, 0.5) * (min + max) - splat(simd, from[axis] as f32));
            squared += way * way;
        }
        // What is not a number is far.
        let far = splat(simd, f32::MAX);
        squared.simd_lt(far).select(squared, far).to_array()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;
    use crate::tree::node::Kind;
    use crate::tree::tests::scenes::{boxes_of, relative, rng, rotation, torus};
    use glam::DAffine3;
    use solid_convex::simd::{alike, dispatch};

    /// Law: of two tori that are apart, the pair that is found is mostly hardly further apart than the nearest, as far as corners tell;
    /// every level of instructions finds the same. Of small trees there is none.
    #[test]
    fn what_is_found_is_near() {
        let mut rng = rng(98);
        let triangles = torus(24, 10, |p| p);
        let [tree, few] = [&triangles[..], &triangles[..20]].map(|some| Tree::build(&boxes_of(some)));
        let (rounds, mut near) = (50, 0);
        for _ in 0..rounds {
            let away = rotation(&mut rng) * DVec3::X * 26.0;
            let b_to_a = DAffine3::from_rotation_translation(rotation(&mut rng), away);
            let moved: Vec<_> = triangles.iter().map(|t| t.map(|p| b_to_a.transform_point3(p))).collect();
            let relative = relative(b_to_a, 12.0, 12.0);
            let found = |tree| {
                let duel = Duel::one_by_one(tree, tree, &relative);
                let found = alike(|level| {
                    let mut counters = Counters::default();
                    let pair = dispatch!(widest level, simd => seek(simd, &duel, &mut counters));
                    (pair.map(|pair| [pair.a, pair.b]), counters)
                });
                found.0
            };
            let least = |in_a: &[u32], in_b: &[u32]| {
                let corners = |&i: &u32| triangles[i as usize];
                let moved = |&j: &u32| moved[j as usize];
                let of_b: Vec<DVec3> = in_b.iter().flat_map(moved).collect();
                let of_a = in_a.iter().flat_map(corners);
                of_a.flat_map(|p| of_b.iter().map(move |q| p.distance(*q))).fold(f64::INFINITY, f64::min)
            };
            let of_pair = found(&tree).map(|places| {
                let [in_a, in_b] = places.map(|place| match tree.child_at(place).kind() {
                    Kind::Leaf(range) => tree.leaf(range),
                    Kind::Empty | Kind::Inner(_) => panic!("no leaf"),
                });
                least(in_a, in_b)
            });
            near +=
                usize::from(of_pair.is_some_and(|of_pair| of_pair < 1.1 * least(tree.order(), tree.order())));
            assert_eq!(found(&few), None);
        }
        println!("{near} of {rounds} are near");
        assert!(10 * near > 8 * rounds);
    }
}
