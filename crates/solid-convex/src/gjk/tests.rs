//! Laws of GJK. Random pairs of all kinds are judged by the oracle in `solid3d`'s tests.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid_oracle::{Convex, distance_bounds};

use super::descent::{End, Goal, ITERATIONS_MAX, descend, descend_robustly, descend_within};
use super::lean::{Search, Sure};
use super::task;
use super::{
    CAST_ERROR, Closest, ClosestInWorld, Coherent, DISTANCE_TOLERANCE, Glance, Memory, Outcome,
    TOUCHING_ERROR, cast, closest_points, intersection, intersects, quickly_closest, separates,
};
use crate::difference::Difference;
use crate::simd;
use crate::testing::{for_each_pair, in_cube, placement, shapes};
use crate::{Capsule, Cone, Cuboid, Cylinder, Polytope, Sphere, Support};

#[test]
fn swapping_negates_the_axis() {
    let mut separated = 0;
    for_each_pair(50, |_, [a, b], [at_a, at_b]| {
        let outcome = intersection(a, at_a, b, at_b);
        let swapped = intersection(b, at_b, a, at_a);
        match (outcome, swapped) {
            (Outcome::Separated { axis }, Outcome::Separated { .. }) => {
                separated += 1;
                assert!(separates(&-axis, b, at_b, a, at_a), "{axis} the other way round");
            }
            (Outcome::Separated { .. }, _) | (_, Outcome::Separated { .. }) => {
                panic!("{outcome:?}, {swapped:?}")
            }
            _ => {}
        }
    });
    assert!((375..875).contains(&separated), "{separated} of 1250: not representative");
}

/// Where objects just touch, from a place where they meet to one where they do not, bit by bit: swapping them changes no outcome, and of those
/// that meet the distance is 0.
#[test]
fn touching_is_the_same_either_way_round_and_for_distances() {
    let (mut cases, mut hits) = (0, 0);
    for_each_pair(20, |[i, j, k], [a, b], [at_a, at_b]| {
        let way = placement(3 * k + 2).translation.normalize() * 16.0;
        let moved = |t: f64| DAffine3 { translation: at_b.translation + way * t, ..*at_b };
        let meet = |t: f64| intersects(a, at_a, b, &moved(t));
        if !meet(0.0) || meet(1.0) {
            return;
        }
        let (mut near, mut far) = (0.0, 1.0);
        for _ in 0..54 {
            let middle = f64::midpoint(near, far);
            *if meet(middle) { &mut near } else { &mut far } = middle;
        }
        for step in -8..8 {
            let at_b = &moved(near + f64::from(step) * 1e-16);
            let (outcome, swapped) = (intersection(a, at_a, b, at_b), intersection(b, at_b, a, at_a));
            let apart = |outcome: &Outcome| outcome.witness().is_none();
            assert_eq!(apart(&outcome), apart(&swapped), "{i} {j} {k}: {outcome:?}, {swapped:?}");
            let distance = closest_points(a, at_a, b, at_b).distance;
            assert!(apart(&outcome) || distance == 0.0, "{i} {j} {k}: {outcome:?}, {distance:e}");
            cases += 1;
            hits += usize::from(!apart(&outcome));
        }
    });
    assert!(
        cases > 2_000 && (30..=70).contains(&(100 * hits / cases)),
        "{hits} of {cases}: not representative"
    );
}

#[test]
fn what_a_cached_axis_separates_is_separated() {
    let (a, b) = (Cone::new(0.5, 1.5).unwrap(), Cylinder::new(0.6, 1.0).unwrap());
    let mut held = 0;
    for k in 0..2_000 {
        let axis = placement(k).translation;
        let (at_a, at_b) = (placement(3 * k), placement(5 * k + 1));
        if separates(&axis, &a, &at_a, &b, &at_b) {
            held += 1;
            assert!(matches!(intersection(&a, &at_a, &b, &at_b), Outcome::Separated { .. }));
        }
        assert!(!separates(&DVec3::ZERO, &a, &at_a, &b, &at_b), "no axis is no answer");
    }
    assert!(held > 50, "{held}");
}

/// At this gap GJK with Johnson's sub-algorithm recognises 32 of 2,000.
#[test]
fn boxes_a_billionth_apart_are_separate() {
    let cube = Cuboid::new(DVec3::ONE).unwrap();
    for k in 0..2_000 {
        let shift = placement(k).translation * 0.3;
        let turn = DAffine3::from_quat(DQuat::from_rotation_y(f64::from(k)));
        let above = turn * DAffine3::from_translation(DVec3::new(shift.x, 1.0 + 1e-9, shift.z));
        assert!(matches!(intersection(&cube, &turn, &cube, &above), Outcome::Separated { .. }), "{k}");
        let distance = closest_points(&cube, &turn, &cube, &above).distance;
        assert!((distance - 1e-9).abs() < 1e-15, "{distance:e}");
    }
}

/// A plate of 1000 x 1000 x 0.001 against a cube, 10^-12 of the size apart, or overlapping by that.
#[test]
fn plates_are_decided_at_a_trillionth() {
    let (plate, cube) =
        (Cuboid::new(DVec3::new(1000.0, 0.001, 1000.0)).unwrap(), Cuboid::new(DVec3::ONE).unwrap());
    for k in 0..2_000 {
        let shift = placement(k).translation * 300.0;
        let at = |gap: f64| {
            let turn = DAffine3::from_translation(DVec3::new(shift.x, 0.5005 + gap, shift.z));
            turn * DAffine3::from_rotation_y(f64::from(k))
        };
        let apart = intersection(&plate, &DAffine3::IDENTITY, &cube, &at(1e-9));
        assert!(matches!(apart, Outcome::Separated { .. }), "{k}: {apart:?}");
        let deep = intersection(&plate, &DAffine3::IDENTITY, &cube, &at(-1e-9));
        assert!(!matches!(deep, Outcome::Separated { .. }), "{k}");
    }
}

/// A point under the base of a cone or of a cylinder: the descent's first two support points and the point lie in one plane with
/// the axis, so that the base passes the origin as closely as the edge between the two.
#[test]
fn points_just_under_a_round_base_are_separate() {
    let under = crate::Points::new(&[DVec3::ZERO]).unwrap();
    for k in 0..4_000 {
        let height = 0.5 + 0.01 * f64::from(k % 300);
        let (cone, cylinder) = (Cone::new(1.0, height).unwrap(), Cylinder::new(1.0, height).unwrap());
        let at = placement(k);
        let aside = placement(3 * k).translation * 0.8;
        for gap in [2.0, 10.0, 100.0].map(|times| times * TOUCHING_ERROR * (2.0 + height)) {
            let here = at.transform_point3(DVec3::new(aside.x, -0.5 * height - gap, aside.z));
            let here = DAffine3::from_translation(here);
            for shape in [&cone as &dyn Support, &cylinder] {
                let outcome = intersection(shape, &at, &under, &here);
                assert!(matches!(outcome, Outcome::Separated { .. }), "{k}, {gap:e}: {outcome:?}");
                let distance = closest_points(shape, &at, &under, &here).distance;
                assert!((distance - gap).abs() < 1e-14, "{k}: {distance:e}, not {gap:e}");
            }
        }
    }
}

/// A point just off the side of a cone: next to the tip, where the weight of a point of the rim is 10^-12, and on cones so flat that
/// rounding hides on which side of an edge across them the point is.
#[test]
fn points_just_off_the_side_of_a_cone_are_separate() {
    let off = crate::Points::new(&[DVec3::ZERO]).unwrap();
    for k in 0..12_000 {
        // The slope of the side and the way from the tip, as parts of the radius.
        let [slope, way] = [k % 13, k / 13 % 11].map(|power| 10f64.powf(-f64::from(power)));
        let cone = Cone::new(1.0, slope).unwrap();
        let at = placement(k);
        let out = DQuat::from_rotation_y(f64::from(k));
        let side = DVec3::new(0.9 * way, slope * (0.5 - 0.9 * way), 0.0);
        let normal = DVec3::new(slope, 1.0, 0.0).normalize();
        for gap in [2.0, 10.0, 1000.0].map(|times| times * TOUCHING_ERROR * (2.0 + slope)) {
            let here = DAffine3::from_translation(at.transform_point3(out * (side + gap * normal)));
            let outcome = intersection(&cone, &at, &off, &here);
            assert!(matches!(outcome, Outcome::Separated { .. }), "{k}, {gap:e}: {outcome:?}");
            let distance = closest_points(&cone, &at, &off, &here).distance;
            assert!((distance - gap).abs() < 1e-14, "{k}: {distance:e}, not {gap:e}");
        }
    }
}

/// A shape of any kind, half of them flat or thin, down to a billionth.
fn any_shape(rng: &mut StdRng) -> Box<dyn Support> {
    let mut thin = || if rng.random() { 1.0 } else { 10f64.powf(-rng.random_range(0.0..9.0)) };
    let (f, g) = (thin(), thin());
    match rng.random_range(0..7) {
        0 => Box::new(Sphere::new(1.0).unwrap()),
        1 => Box::new(Cuboid::new(DVec3::new(1.0, f, g)).unwrap()),
        2 => Box::new(Cone::new(g, f).unwrap()),
        3 => Box::new(Cylinder::new(g, f).unwrap()),
        4 => Box::new(Capsule::new(g, f).unwrap()),
        5 => Box::new(crate::Polytope::new(vec![DVec3::ZERO]).unwrap()),
        _ => {
            let points = (0..rng.random_range(4..30)).map(|_| in_cube(rng) * DVec3::new(1.0, f, g));
            Box::new(crate::Polytope::new(points.collect()).unwrap())
        }
    }
}

/// A map at the origin: turned, half of them stretched and sheared, some small.
fn any_map(rng: &mut StdRng) -> DMat3 {
    let mut turn = || {
        DMat3::from_quat(DQuat::from_euler(
            glam::EulerRot::XYZ,
            3.0 * rng.random::<f64>(),
            3.0,
            6.0 * rng.random::<f64>(),
        ))
    };
    let (outer, inner) = (turn(), turn());
    let mut thin = || 10f64.powf(-rng.random_range(0.0..4.0));
    let stretched = outer * DMat3::from_diagonal(DVec3::new(thin(), thin(), 1.0)) * inner;
    let size = if rng.random_bool(0.2) { 10f64.powf(-rng.random_range(0.0..8.0)) } else { 1.0 };
    if rng.random() { stretched * size } else { outer * size }
}

/// How much nearer or further than the distance the closest points may be, as a part of the size: of 1.8 * 10^6 gaps, needles and slivers
/// among them, the worst was a tenth of it.
const POINTS_ERROR: f64 = 1e-14;

/// Law: a gap is seen that is opened along the normal of any two objects, near or deep in each other; and the distance is no less, and that
/// of the closest points. Of needles whose every triangle is a sliver, too.
#[test]
fn gaps_beyond_the_stated_error_are_seen() {
    const SEED: u64 = 51;
    let mut rng = seeded(SEED);
    let (mut hits, cases) = (0, 20_000);
    for case in 0..cases {
        let (a, b) = (any_shape(&mut rng), any_shape(&mut rng));
        let at_a = DAffine3::from_mat3(any_map(&mut rng));
        let map = any_map(&mut rng);
        let extent = |map: &DMat3, reach: DVec3| {
            (map.x_axis.abs() * reach.x + map.y_axis.abs() * reach.y + map.z_axis.abs() * reach.z)
                .max_element()
        };
        let extents = extent(&at_a.matrix3, a.reach()) + extent(&map, b.reach());
        if extents == 0.0 {
            continue; // two points
        }
        let at = |translation: DVec3| DAffine3 { matrix3: map, translation };
        let at_b = at(in_cube(&mut rng) * extents * rng.random::<f64>().powi(8));
        let normal = if let Some(found) = crate::epa::penetration(&*a, &at_a, &*b, &at_b) {
            hits += 1;
            found.direction
        } else {
            let Closest { points, .. } = closest_points(&*a, &at_a, &*b, &at_b);
            let between = at_a.transform_point3(points.on_a) - at_b.transform_point3(points.on_b);
            let Some(normal) = between.try_normalize() else { continue };
            normal
        };
        // Where the two just touch.
        let end = |shape: &dyn Support, map: &DMat3, normal: DVec3| {
            normal.dot(*map * shape.support(map.transpose() * normal))
        };
        let way = -end(&*a, &at_a.matrix3, -normal) - end(&*b, &map, normal) - normal.dot(at_b.translation);
        let touching = at_b.translation + normal * way;
        let size = extents + touching.abs().max_element();
        for gap in [1.05, 2.0, 10.0].map(|times| times * TOUCHING_ERROR * size) {
            let at_b = at(touching - normal * gap);
            let outcome = intersection(&*a, &at_a, &*b, &at_b);
            assert!(
                matches!(outcome, Outcome::Separated { .. }),
                "seed {SEED}, {case}, {gap:e}: {outcome:?}"
            );
            let Closest { distance, points } = closest_points(&*a, &at_a, &*b, &at_b);
            assert!(distance >= gap - 1e-14 * size, "seed {SEED}, {case}: {distance:e}, not {gap:e}");
            let between = at_a.transform_point3(points.on_a).distance(at_b.transform_point3(points.on_b));
            let off = (between - distance).abs();
            assert!(
                off <= POINTS_ERROR * size,
                "seed {SEED}, {case}: {between:e} between points, {distance:e} apart"
            );
        }
    }
    assert!((30..=70).contains(&(100 * hits / cases)), "{hits} of {cases}: not representative");
}

/// Law: the distance of hulls is right where a corner, or what is between corners, of one nearly meets such of the other. Of coordinates of few digits the closest
/// point is often exactly at the end of an edge, or on one of a face, so that rounding hides which of them it is on.
#[test]
fn distances_of_what_nearly_meets_are_right() {
    let mut rng = seeded(67);
    let few_digits =
        |rng: &mut StdRng| DVec3::from_array([(); 3].map(|()| f64::from(rng.random_range(-2..=2))));
    let some = |rng: &mut StdRng, points: &[DVec3]| -> DVec3 {
        [(); 4].map(|()| points[rng.random_range(0..points.len().min(3))] / 4.0).iter().sum()
    };
    let (identity, mut apart) = (DAffine3::IDENTITY, 0);
    for case in 0..60_000 {
        let [a, b] = [(); 2]
            .map(|()| -> Vec<DVec3> { (0..rng.random_range(1..9)).map(|_| few_digits(&mut rng)).collect() });
        let off = few_digits(&mut rng) * 10_f64.powi(rng.random_range(-10..-2));
        let at_b = DAffine3::from_translation(some(&mut rng, &a) - some(&mut rng, &b) + off);
        let [hull_a, hull_b] = [&a, &b].map(|points| Polytope::new(points.clone()).unwrap());
        let distance = closest_points(&hull_a, &identity, &hull_b, &at_b).distance;
        let [a, b] = [a, b].map(|points| Convex::Hull { points });
        let (least, most) = distance_bounds(&a, &identity, &b, &at_b);
        let error = 16.0 * TOUCHING_ERROR; // no coordinate is greater than 8
        assert!(
            (least - error..=most + error).contains(&distance),
            "case {case}: {distance:e}, not in {least:e}..{most:e}"
        );
        apart += usize::from(least > 0.0);
    }
    assert!(apart > 10_000, "{apart} of 60000: not representative");
}

/// Balls and capsules, whose distance is that of their cores: the slow twin is a descent on the round surfaces.
#[test]
fn distances_of_round_objects_are_those_of_their_surfaces() {
    let (mut hits, mut cases) = (0, 0);
    let rounds: [&dyn Support; 2] = [&Sphere::new(0.5).unwrap(), &Capsule::new(0.3, 0.9).unwrap()];
    for (i, other) in shapes().iter().enumerate() {
        for (round, scale, k) in rounds.iter().flat_map(|&round| (0..150).map(move |k| (round, k % 3, k))) {
            let turned = placement(k + 11 * i as u32);
            // Also scaled alike, and so that the round is none.
            let scale = [DVec3::ONE, DVec3::splat(0.7), DVec3::new(1.0, 0.6, 1.2)][scale as usize];
            let (at, at_other) = (turned * DAffine3::from_scale(scale), placement(5 * k + 1));
            let difference = Difference::new(round, &at, &**other, &at_other);
            let descent = descend(
                &difference,
                Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: f64::INFINITY },
            );
            let (slow, _) = Closest::of(&descent, &difference);
            let found = closest_points(round, &at, &**other, &at_other);
            assert!((found.distance - slow.distance).abs() < 1e-11, "{i} {k}: {found:?}, {slow:?}");
            let (on_a, on_b) = (found.points.on_a, found.points.on_b);
            let between = at.transform_point3(on_a).distance(at_other.transform_point3(on_b));
            assert!((between - found.distance).abs() < 1e-11, "{i} {k}: {between}, {found:?}");
            for (shape, point) in [(round, on_a), (&**other, on_b)] {
                let dot = [point];
                let out = intersection(
                    shape,
                    &DAffine3::IDENTITY,
                    &crate::Points::new(&dot).unwrap(),
                    &DAffine3::from_translation(-1e-11 * point),
                );
                assert!(out.witness().is_some(), "{i} {k}: {point} is outside");
            }
            let mirrored = closest_points(&**other, &at_other, round, &at);
            assert!((mirrored.distance - found.distance).abs() < 1e-11, "{i} {k}: {mirrored:?}");
            hits += usize::from(found.distance == 0.0);
            cases += 1;
        }
    }
    assert!((30..=70).contains(&(100 * hits / cases)), "{hits} of {cases}: not representative");
}

/// The slow twin of the lean descent is the robust one, which never says the opposite of what the lean one is sure of; on all
/// levels it is sure of the same, to the bit.
#[test]
fn the_lean_descent_says_what_the_robust_one_says() {
    let hull = |count: u32, k: u32| {
        let points = (0..count).map(|i| placement(i * 7 + k).translation.normalize_or(DVec3::X));
        Box::new(crate::Polytope::new(points.collect()).unwrap()) as Box<dyn Support>
    };
    let all: Vec<_> =
        shapes().into_iter().chain([hull(4, 0), hull(20, 3), hull(60, 5), hull(250, 11)]).collect();
    let (mut cases, mut hits, mut sure, mut measured) = (0, 0, 0, 0);
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate() {
            for k in 0..60 {
                let (at_a, mut at_b) = (placement(k), placement(7 * k + (i + 5 * j) as u32 + 1));
                at_b.translation = at_a.translation + (at_b.translation - at_a.translation) * 1.6;
                // One in three just touches, or misses by up to 1e-9.
                if k % 3 == 0 {
                    let closest = closest_points(&**a, &at_a, &**b, &at_b).points;
                    let way = at_a.transform_point3(closest.on_a) - at_b.transform_point3(closest.on_b);
                    at_b.translation += way * (1.0 - 1e-9 * f64::from(k % 2));
                }
                let difference = Difference::new(&**a, &at_a, &**b, &at_b);
                for goal in [
                    Goal::Separation,
                    Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: f64::INFINITY },
                ] {
                    let search = Search { goal, warm: &[] };
                    let [scalar, wide] = simd::levels().map(|level| task::run_on(level, &difference, search));
                    assert_eq!((scalar.sure, scalar.v), (wide.sure, wide.v), "{i} {j} {k}");
                    assert_eq!(scalar.points(), wide.points(), "{i} {j} {k}");
                    let slow = descend_robustly(&difference, goal);
                    cases += 1;
                    hits += usize::from(slow.end != End::Separated);
                    sure += usize::from(wide.sure != Sure::Nothing);
                    match wide.sure {
                        Sure::Separated(_) => assert_ne!(slow.end, End::Inside, "{i} {j} {k}"),
                        Sure::Inside => assert_ne!(slow.end, End::Separated, "{i} {j} {k}"),
                        Sure::Near(mu) => {
                            let Some((v, _)) = wide.closest_point() else { continue };
                            let (found, slow) = (v.length(), slow.v.length());
                            let given_out = goal.is_within_tolerance(found, mu);
                            assert!(mu - slow < 1e-11, "{i} {j} {k}: {slow:e}, at least {mu:e}");
                            assert!(
                                !given_out || (found - mu).abs() < 1e-11,
                                "{i} {j} {k}: {found:e}, at least {mu:e}"
                            );
                            assert!((found - slow).abs() < 1e-11, "{i} {j} {k}: {found:e}, {slow:e}");
                            measured += usize::from(given_out);
                        }
                        Sure::Beyond | Sure::Nothing => {}
                    }
                }
            }
        }
    }
    assert!((30..=70).contains(&(100 * hits / cases)), "{hits} of {cases}: not representative");
    assert!(2 * sure > cases && 6 * measured > cases, "{sure} sure, {measured} measured, of {cases}");
}

/// What is quickly found of two polytopes in the world is what a search finds, to the bit; and nothing where a placement is no good.
#[test]
fn what_is_quickly_found_is_what_is_found() {
    const SEED: u64 = 53;
    let mut rng = seeded(SEED);
    let (mut hits, mut found) = (0, 0);
    const CASES: usize = 4_000;
    for case in 0..CASES {
        let mut hull = || {
            let flat = if rng.random() { 1.0 } else { 10f64.powf(-rng.random_range(0.0..9.0)) };
            let points = (0..rng.random_range(1..40)).map(|_| in_cube(&mut rng) * DVec3::new(1.0, flat, 1.0));
            crate::Polytope::new(points.collect()).unwrap()
        };
        let (a, b) = (hull(), hull());
        let unit = 10f64.powi([0, 0, -9, 9][case % 4]);
        let [at_a, at_b] = [(); 2].map(|()| DAffine3 {
            matrix3: any_map(&mut rng) * unit,
            translation: in_cube(&mut rng) * unit * 0.5,
        });
        let Closest { distance, points } = closest_points(&a, &at_a, &b, &at_b);
        hits += usize::from(distance == 0.0);
        let [on_a, on_b] = [at_a.transform_point3(points.on_a), at_b.transform_point3(points.on_b)];
        let expected = ClosestInWorld { distance, point_on_a: on_a, point_on_b: on_b };
        let quickly = quickly_closest(&a, &at_a, &b, &at_b);
        assert!(quickly.is_none_or(|quickly| quickly == expected), "{case}: {quickly:?}, not {expected:?}");
        found += usize::from(quickly.is_some());

        let mut memory = Memory::default();
        let kept = memory.closest_points(&a, &at_a, &b, &at_b);
        let again = memory.quickly_closest(&a, &at_a, &b, &at_b);
        let error = |again: ClosestInWorld| (kept.distance - again.distance).abs();
        assert!(again.is_none_or(|again| error(again) <= 1e-11 * unit), "{case}: {kept:?}, {again:?}");

        let wild = [f64::NAN, f64::INFINITY, 0.0, 1e-80, 1e80][case % 5];
        let mut no_good = at_b;
        no_good.matrix3.y_axis *= wild;
        assert_eq!(quickly_closest(&a, &at_a, &b, &no_good), None, "{case}");
        assert_eq!(memory.quickly_closest(&a, &no_good, &b, &at_b), None, "{case}");
        no_good = DAffine3 {
            translation: DVec3::new(0.0, [f64::NAN, f64::INFINITY, 1e101][case % 3], 0.0),
            ..at_a
        };
        assert_eq!(quickly_closest(&a, &no_good, &b, &at_b), None, "{case}");
    }
    assert!((30..=70).contains(&(100 * hits / CASES)), "{hits} of {CASES}: not representative");
    assert!(10 * found > 8 * CASES, "{found} of {CASES} were found");
}

#[test]
fn coincident_shapes_intersect() {
    for shape in shapes() {
        for k in 0..20 {
            let at = placement(k);
            assert!(intersection(&*shape, &at, &*shape, &at).witness().is_some());
            assert_eq!(closest_points(&*shape, &at, &*shape, &at).distance, 0.0);
        }
    }
}

/// A descent that runs out of iterations says so, and claims nothing.
#[test]
fn the_iteration_limit_is_undecided() {
    let ball = Sphere::new(1.0).unwrap();
    let egg = DAffine3::from_scale(DVec3::new(1.0, 3.0, 0.2));
    let near = DAffine3::from_translation(DVec3::new(1.3, 2.0, 0.1)) * DAffine3::from_rotation_z(1.0);
    let difference = Difference::new(&ball, &egg, &ball, &near);
    let needed = (0..=ITERATIONS_MAX).find(|&limit| {
        descend_within(
            &difference,
            Goal::DistanceWithin { tolerance: 1e-12, bound: f64::INFINITY },
            &[],
            limit,
        )
        .end != End::Undecided
    });
    let needed = needed.expect("it ends in time");
    assert!(needed > 2, "{needed}");
    assert_eq!(descend_within(&difference, Goal::Separation, &[], 1).end, End::Undecided);
}

/// A support mapping that is none: it must not hang nor crash whoever asks it.
struct Liar(std::sync::atomic::AtomicU32);

impl Support for Liar {
    fn support(&self, _direction: DVec3) -> DVec3 {
        placement(self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed)).translation
    }

    fn reach(&self) -> DVec3 {
        DVec3::splat(1.5)
    }
}

#[test]
fn a_support_mapping_that_lies_is_survived() {
    for seed in 0..200 {
        let liar = Liar(seed.into());
        intersection(&liar, &DAffine3::IDENTITY, &liar, &placement(seed));
        closest_points(&liar, &DAffine3::IDENTITY, &liar, &placement(seed));
        let calls = liar.0.load(std::sync::atomic::Ordering::Relaxed) - seed;
        assert!(calls as usize <= 4 * ITERATIONS_MAX, "{calls} calls");
    }
}

/// Pairs on their way past each other: what is kept from frame to frame changes no answer, and no distance beyond its error.
#[test]
fn coherence_changes_no_answer() {
    let (mut frames, mut hits) = (0, 0);
    let spiked = crate::Polytope::new((0..90).map(|i| placement(i).translation).collect()).unwrap();
    let shapes = || shapes().into_iter().chain([Box::new(spiked.clone()) as Box<dyn Support>]);
    for (i, a) in shapes().enumerate() {
        for (j, b) in shapes().enumerate() {
            let (at_a, mut at_b) = (placement(i as u32), placement(31 + j as u32));
            let (mut asked, mut measured) = (Coherent::new(&*a, &*b), Coherent::new(&*a, &*b));
            let turn = DQuat::from_axis_angle(placement(7).translation.normalize(), 0.02);
            for frame in 0..100 {
                // Through the other and away; every so often a jump.
                at_b.translation = at_a.translation
                    + placement(frame / 25).translation * 0.2
                    + DVec3::new(f64::from(frame % 50) * 0.08 - 2.0, 0.1, 0.2);
                at_b.matrix3 = glam::DMat3::from_quat(turn) * at_b.matrix3;
                let outcome = intersection(&*a, &at_a, &*b, &at_b);
                let hit = !matches!(outcome, Outcome::Separated { .. });
                assert_eq!(asked.intersects(&at_a, &at_b), hit, "{i} {j} {frame}");
                let cold = closest_points(&*a, &at_a, &*b, &at_b);
                let warm = measured.closest_points(&at_a, &at_b);
                assert!((warm.distance - cold.distance).abs() < 1e-11, "{i} {j} {frame}: {warm:?}, {cold:?}");
                let (on_a, on_b) = (warm.points.on_a, warm.points.on_b);
                let between = at_a.transform_point3(on_a).distance(at_b.transform_point3(on_b));
                assert!((between - warm.distance).abs() < 1e-11, "{i} {j} {frame}: {between}, {warm:?}");
                frames += 1;
                hits += usize::from(hit);
            }
        }
    }
    assert!((30..=70).contains(&(100 * hits / frames)), "{hits} of {frames}: not representative");
}

/// Law: where a cast ends, the objects are no further apart than is stated, and no deeper in each other along the normal than rounding; flat, thin and
/// round ones, too.
#[test]
fn a_cast_ends_at_the_stated_gap() {
    const SEED: u64 = 52;
    let mut rng = seeded(SEED);
    let (mut hits, cases) = (0, 20_000);
    for case in 0..cases {
        let (a, b) = (any_shape(&mut rng), any_shape(&mut rng));
        let (at_a, map) = (DAffine3::from_mat3(any_map(&mut rng)), any_map(&mut rng));
        let reach = |shape: &dyn Support, map: &DMat3| {
            let [min, max] = shape.image_bounds(map);
            min.abs().max(max.abs()).max_element()
        };
        let extents = reach(&*a, &at_a.matrix3) + reach(&*b, &map);
        if extents == 0.0 {
            continue; // two points
        }
        let away = in_cube(&mut rng).normalize_or_zero() * extents * rng.random_range(1.0..4.0);
        let motion = away * rng.random_range(0.5..2.0) + in_cube(&mut rng) * extents * rng.random::<f64>();
        let at_b = DAffine3 { matrix3: map, translation: away };
        let Some(impact) = cast(&*a, &at_a, motion, &*b, &at_b, 2.0) else { continue };
        let at = |time: f64| DAffine3 { translation: motion * time, ..at_a };
        let gap = closest_points(&*a, &at(impact.time), &*b, &at_b).distance;
        let size = extents + (motion * impact.time - away).abs().max_element();
        hits += 1;
        assert!(gap <= CAST_ERROR * size, "seed {SEED}, {case}: {:e} of the size", gap / size);
        let Some(normal) = impact.normal else { continue };
        let along = |shape: &dyn Support, at: &DAffine3, direction: DVec3| {
            let point = shape.support(at.matrix3.transpose() * direction);
            at.transform_point3(point).dot(normal)
        };
        let overlap = along(&*b, &at_b, normal) - along(&*a, &at(impact.time), -normal);
        assert!(
            overlap <= 1e-6 * size,
            "seed {SEED}, {case}: {:e} of the size along {normal}",
            overlap / size
        );
    }
    assert!((30..=70).contains(&(100 * hits / cases)), "{hits} of {cases}: not representative");
}

/// Law: what is flat is not passed, neither by what is flat itself, however long the way to it is or far from the origin of the world, where
/// positions are rounded.
#[test]
fn a_cast_passes_nothing_that_is_flat() {
    const SEED: u64 = 53;
    let mut rng = seeded(SEED);
    let polytope = |corners: &[DVec3]| Polytope::new(corners.to_vec()).unwrap();
    for case in 0..20_000 {
        let mut corners: [DVec3; 3] = std::array::from_fn(|_| in_cube(&mut rng));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if normal.length() < 0.1 {
            continue;
        }
        let inside = |corners: &[DVec3]| corners.iter().sum::<DVec3>() / corners.len() as f64;
        let target = polytope(&corners);
        let met = inside(&corners);
        // A point, a segment, or a triangle; these all parallel to the target, or not.
        if case % 2 == 0 {
            corners = std::array::from_fn(|_| in_cube(&mut rng));
        }
        let corners = &corners[..1 + case % 3];
        let mover = polytope(corners);
        let far = |rng: &mut StdRng| 10_f64.powf(rng.random_range(0.0..8.0)) * in_cube(rng).normalize();
        let (origin, motion) = (far(&mut rng), far(&mut rng));
        if motion.normalize().dot(normal.normalize()).abs() < 0.05 {
            continue;
        }
        let time = rng.random_range(0.1..0.9);
        let from = DAffine3::from_translation(origin);
        let at = DAffine3::from_translation(origin + motion * time + inside(corners) - met);
        let impact = cast(&mover, &from, motion, &target, &at, 1.0);
        let impact = impact.unwrap_or_else(|| panic!("seed {SEED}, {case}: {corners:?} passes"));
        let off = (impact.time - time) * motion.length();
        let rounding = 1e-9 + 1e-14 * (origin.length() + motion.length());
        assert!(off < rounding, "seed {SEED}, {case}: late by {off:e}");
        if corners.len() == 1 {
            assert!(off > -100.0 * rounding, "seed {SEED}, {case}: early by {off:e}");
        }
    }
}

/// A support mapping that gives no numbers has no distance; nothing panics.
#[test]
fn support_points_that_are_no_numbers_are_survived() {
    struct Nowhere(f64);
    impl Support for Nowhere {
        fn support(&self, direction: DVec3) -> DVec3 {
            direction.signum() * self.0
        }
        fn reach(&self) -> DVec3 {
            DVec3::ONE
        }
    }
    let ball = Sphere::new(1.0).unwrap();
    let (here, there) = (DAffine3::IDENTITY, DAffine3::from_translation(DVec3::new(3.0, 1.0, 0.0)));
    for far in [f64::NAN, f64::INFINITY, 1e300] {
        let nowhere = Nowhere(far);
        super::closest_points(&nowhere, &here, &ball, &there);
        super::closest_points(&nowhere, &here, &nowhere, &there);
        super::Coherent::new(&ball, &nowhere).closest_points(&here, &there);
        super::cast(&nowhere, &here, DVec3::X, &ball, &there, 1.0);
    }
}

/// Of a gap that rounding might have made a cached axis does not answer alone.
#[test]
fn a_cached_axis_leaves_small_gaps_to_a_search() {
    let block = Cuboid::new(DVec3::ONE).unwrap();
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.2, -0.3));
    let separated = |gap: f64| separates(&DVec3::X, &block, &at(1.0 + gap), &block, &at(0.0));
    assert!(separated(1e-6) && !separated(1e-9) && !separated(1e-13) && !separated(-1e-9));

    let (corners, faces) = crate::testing::block(DVec3::ONE);
    let block = Polytope::new(corners).unwrap().with_faces(&faces);
    let glance = |gap: f64| {
        let mut memory = Memory::default();
        memory.intersects(&block, &at(1.5), &block, &at(0.0));
        let there = at(1.0 + gap);
        crate::simd::dispatch!(simd => memory.glance_by(simd, (&block, &there), (&block, &at(0.0))))
    };
    assert_eq!([1e-6, 1e-9, 1e-13].map(glance), [Glance::Sure(false), Glance::Open, Glance::Open]);
}
