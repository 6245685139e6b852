//! Pairs of convex shapes of all kinds, judged by the certificates of the oracle: no wrong answer where the oracle is
//! certain beyond the stated error.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;

use common::{each_pair, rescaled, try_shape_of};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use solid_oracle::generate::{Pair, Regime, random_pair, seeded};
use solid_oracle::{Convex, Verdict, contains_within, distance_bounds, verdict, verify_axis};
use solid3d::convex::gjk::TOUCHING_ERROR;
use solid3d::{Shape, ShapeKind, query};

/// 10 regimes of these make 1.2 * 10^5 pairs.
const PAIRS: usize = 12_000;
const SEED: u64 = 20_260;

/// The largest coordinate of the placed shape, seen from the placement's origin.
fn extent(convex: &Convex, placement: &DAffine3) -> f64 {
    let reach = match convex {
        Convex::Sphere { radius } => DVec3::splat(*radius),
        Convex::Cuboid { half } => *half,
        Convex::Cone { radius, half_height } | Convex::Cylinder { radius, half_height } => {
            DVec3::new(*radius, *half_height, *radius)
        }
        Convex::Capsule { radius, half_height } => DVec3::new(*radius, radius + half_height, *radius),
        Convex::Hull { points } => points.iter().fold(DVec3::ZERO, |reach, p| reach.max(p.abs())),
    };
    let m = placement.matrix3;
    (m.x_axis.abs() * reach.x + m.y_axis.abs() * reach.y + m.z_axis.abs() * reach.z).max_element()
}

/// The size of the data, as the stated error means it.
fn size_of(pair: &Pair) -> f64 {
    let offset = (pair.pb.translation - pair.pa.translation).abs().max_element();
    extent(&pair.a, &pair.pa) + extent(&pair.b, &pair.pb) + offset
}

/// Compares every answer for the pair with the oracle's; returns whether they intersect where the oracle is certain.
fn judge(pair: &Pair, a: &Shape, b: &Shape, context: &str) -> Option<bool> {
    let Pair { a: reference_a, pa, b: reference_b, pb, .. } = pair;
    let error = TOUCHING_ERROR * size_of(pair);
    let intersects = query::intersects(a, pa, b, pb).unwrap();
    match query::separating_axis(a, pa, b, pb).unwrap() {
        Some(axis) => {
            assert!(!intersects, "{context}: an axis, but they intersect");
            assert!(
                verify_axis(reference_a, pa, reference_b, pb, axis) > 0.0,
                "{context}: {axis} does not separate"
            );
        }
        None => {
            let point = query::common_point(a, pa, b, pb).unwrap().unwrap();
            let contained = |shape, at: &DAffine3| contains_within(shape, at, point, error + rounding(point));
            assert!(
                contained(reference_a, pa) && contained(reference_b, pb),
                "{context}: {point} is not common"
            );
        }
    }
    match verdict(reference_a, pa, reference_b, pb) {
        Verdict::Separated { gap } => {
            assert!(!intersects || gap <= error, "{context}: {gap:e} apart, but said to intersect");
            Some(false)
        }
        Verdict::Intersecting { depth } => {
            assert!(intersects || depth <= error, "{context}: {depth:e} deep, but said to be apart");
            Some(true)
        }
        Verdict::Uncertain { .. } => None,
    }
}

/// The rounding of a point's world coordinates.
fn rounding(point: DVec3) -> f64 {
    4.0 * f64::EPSILON * point.abs().max_element()
}

fn judge_distance(pair: &Pair, a: &Shape, b: &Shape, context: &str) {
    let closest = query::distance(a, &pair.pa, b, &pair.pb).unwrap();
    let (lower, upper) = distance_bounds(&pair.a, &pair.pa, &pair.b, &pair.pb);
    let error = TOUCHING_ERROR * (size_of(pair) + upper);
    let distance = closest.distance;
    assert!(
        (lower - error..=upper + error).contains(&distance),
        "{context}: {distance}, not in {lower}..{upper}"
    );
    let between = closest.point_on_a.distance(closest.point_on_b);
    let coordinates = rounding(closest.point_on_a) + rounding(closest.point_on_b);
    assert!(
        (between - distance).abs() <= error + coordinates,
        "{context}: points {between} apart, distance {distance}"
    );
}

fn mirrored(pair: &Pair) -> Pair {
    let pair = pair.clone();
    Pair { a: pair.b, pa: pair.pb, b: pair.a, pb: pair.pa, size: pair.size }
}

/// Runs a regime; `hits` is the share of intersecting pairs that it is meant to have, in percent.
fn run(regime: Regime, hits: std::ops::RangeInclusive<usize>) {
    let (mut certain, mut intersecting, mut tested) = (0, 0, 0);
    let mut kinds: BTreeSet<(ShapeKind, ShapeKind)> = BTreeSet::new();
    each_pair(regime, SEED, PAIRS, |i, pair, [a, b], context| {
        kinds.insert((a.kind(), b.kind()));
        tested += 1;
        if let Some(hit) = judge(pair, a, b, context) {
            certain += 1;
            intersecting += usize::from(hit);
        }
        if i % 4 == 0 {
            judge_distance(pair, a, b, context);
        }
        if i % 8 == 0 {
            judge(&mirrored(pair), b, a, &format!("{context}, swapped"));
        }
    });
    println!(
        "{regime:?}, seed {SEED}: {tested} pairs, {} kinds, {certain} certain, {intersecting} intersect",
        kinds.len()
    );
    assert!(certain * 10 >= tested * 9, "the oracle must be certain of most pairs");
    assert!(
        hits.contains(&(100 * intersecting / certain)),
        "{intersecting} of {certain}: not representative"
    );
}

#[test]
fn random_pairs() {
    run(Regime::Random, 30..=70);
}

#[test]
fn pairs_far_from_the_origin() {
    run(Regime::FarFromOrigin, 30..=70);
}

#[test]
fn pairs_of_very_different_size() {
    run(Regime::SizeRatio, 30..=70);
}

#[test]
fn plates() {
    run(Regime::Flat, 30..=70);
}

#[test]
fn needles() {
    run(Regime::Sliver, 30..=70);
}

#[test]
fn concentric_pairs() {
    run(Regime::Concentric, 70..=100);
}

#[test]
fn near_touching_by_1e_6() {
    run(Regime::NearTouching { relative_gap: 1e-6 }, 30..=70);
}

#[test]
fn near_touching_by_1e_9() {
    run(Regime::NearTouching { relative_gap: 1e-9 }, 30..=70);
}

#[test]
fn near_touching_by_1e_11() {
    run(Regime::NearTouching { relative_gap: 1e-11 }, 30..=70);
}

#[test]
fn near_touching_by_1e_12() {
    run(Regime::NearTouching { relative_gap: 1e-12 }, 30..=70);
}

/// Scaling a scene by a power of two changes no answer, to the bit.
#[test]
fn powers_of_two_change_nothing() {
    let mut rng = seeded(SEED);
    for i in 0..2_000 {
        let regime = [Regime::Random, Regime::NearTouching { relative_gap: 1e-12 }, Regime::SizeRatio][i % 3];
        let Pair { a, pa, b, pb, .. } = random_pair(&mut rng, regime);
        let (Ok(a), Ok(b)) = (try_shape_of(&a), try_shape_of(&b)) else { continue };
        let answers = |power: i32| {
            let factor = 2f64.powi(power);
            let (pa, pb) = (rescaled(&pa, factor), rescaled(&pb, factor));
            let closest = query::distance(&a, &pa, &b, &pb).unwrap();
            let axis = query::separating_axis(&a, &pa, &b, &pb).unwrap();
            let point = query::common_point(&a, &pa, &b, &pb).unwrap().map(|point| point / factor);
            (axis, point, closest.distance / factor, closest.point_on_a / factor)
        };
        let reference = answers(0);
        for power in [-290, -60, -1, 7, 100, 290] {
            assert_eq!(answers(power), reference, "pair {i}, 2^{power}");
        }
    }
}

/// Law: the axis that separates a tiny ball from a box separates it from all of the box, however far its corners are.
#[test]
fn an_axis_beside_a_tiny_ball_separates_the_whole_box() {
    let mut rng = seeded(20_263);
    for case in 0..1000 {
        let radius = 10_f64.powi(rng.random_range(-10..-2));
        let half = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.5..1.0)));
        let turn =
            DQuat::from_scaled_axis(DVec3::from_array(std::array::from_fn(|_| rng.random_range(-2.0..2.0))));
        // Beyond a face.
        let beside =
            DVec3::new(rng.random_range(-0.5..0.5), half.y + radius * rng.random_range(1.1..3.0), 0.3);
        let (cuboid, ball) = (Shape::cuboid(2.0 * half).unwrap(), Shape::sphere(radius).unwrap());
        let at = [DAffine3::from_quat(turn), DAffine3::from_translation(turn * beside)];
        let axis = query::separating_axis(&ball, &at[1], &cuboid, &at[0]).unwrap().unwrap();
        let reach: f64 =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|e| (axis.dot(turn * e) * half.dot(e)).abs()).iter().sum();
        let gap = axis.dot(at[1].translation) - radius - reach;
        assert!(gap > 0.0, "case {case}: {axis} is off by {:e} radii", -gap / radius);
    }
}
