//! The slow twin is GJK.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_convex::simd::levels;
use solid_convex::{Outcome, Support, Witness, epa, gjk};
use solid_oracle::generate::{in_cube, seeded};

use super::*;
use crate::Shape;
use crate::shape::Class;

const SEED: u64 = 77;

fn kinds() -> [Shape; 3] {
    [Shape::sphere(0.6).unwrap(), Shape::capsule(0.3, 1.0).unwrap(), Shape::cuboid([1.0, 0.8, 1.2]).unwrap()]
}

/// A cylinder and a cone.
fn turned() -> [Shape; 2] {
    [Shape::cylinder(0.5, 1.4).unwrap(), Shape::cone(0.6, 1.4).unwrap()]
}

/// A round hull, and a box.
fn hulls() -> [Shape; 2] {
    let mut rng = seeded(SEED);
    let round = [(); 20].map(|()| in_cube(&mut rng).normalize() * 0.8);
    let corner =
        |i: usize| DVec3::from([0, 1, 2].map(|k| [-0.5, 0.5][i >> k & 1])) * DVec3::new(1.0, 0.8, 1.2);
    [
        Shape::convex_hull(&round).unwrap(),
        Shape::convex_hull(&std::array::from_fn::<_, 8, _>(corner)).unwrap(),
    ]
}

fn support(shape: &Shape) -> &dyn Support {
    match shape.class() {
        Class::Convex(convex) => convex,
        Class::Complex(_) => panic!("a simple shape"),
    }
}

/// Any rotation, or a quarter turn; any scale; near the origin or far from it.
fn placements(rng: &mut StdRng) -> [DAffine3; 2] {
    let mut unit = || DVec3::from([0; 3].map(|_| rng.random_range(-1.0..1.0)));
    let (at, way) = (unit() * 100.0, unit());
    [at, at + way * 1.35].map(|translation| {
        let axis = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE.normalize()][rng.random_range(0..4)];
        let quarters = f64::from(rng.random_range(0..4)) * std::f64::consts::FRAC_PI_2;
        let angle = if rng.random() { quarters } else { rng.random_range(-3.0..3.0) };
        let scale = DVec3::splat(rng.random_range(0.7..1.4));
        DAffine3::from_scale_rotation_translation(scale, DQuat::from_axis_angle(axis, angle), translation)
    })
}

#[test]
fn closed_forms_say_what_gjk_says() {
    let mut rng = seeded(SEED);
    let (mut all_hits, mut all_decided) = (0, 0);
    for (i, a) in kinds().iter().enumerate() {
        for (j, b) in kinds().iter().enumerate() {
            let (mut hits, mut decided) = (0, 0);
            for _ in 0..2_000 {
                let [at_a, at_b] = placements(&mut rng);
                let placed = [Placed { shape: a, placement: &at_a }, Placed { shape: b, placement: &at_b }];
                let outcome = gjk::intersection(support(a), &at_a, support(b), &at_b);
                let separated = matches!(outcome, Outcome::Separated { .. });
                if let Some(answer) = intersects(placed[0], placed[1]) {
                    decided += 1;
                    hits += usize::from(answer);
                    assert_eq!(answer, !separated, "{at_a}, {at_b}");
                }
                match intersection(placed[0], placed[1]) {
                    Some(Relation::Separated { axis: Some(axis) }) => {
                        assert!(gjk::separates(&axis, support(a), &at_a, support(b), &at_b), "{axis}");
                        assert!((axis.length() - 1.0).abs() < 1e-14);
                    }
                    Some(Relation::Common(points)) => {
                        assert!(!separated);
                        let on = [at_a.transform_point3(points.on_a), at_b.transform_point3(points.on_b)];
                        assert!(on[0].distance(on[1]) < 1e-12, "{points:?}");
                        for (shape, point) in [(a, points.on_a), (b, points.on_b)] {
                            let here = DAffine3::IDENTITY;
                            let dot = solid_convex::Points::new(std::slice::from_ref(&point)).unwrap();
                            let out = gjk::closest_points(support(shape), &here, &dot, &here).distance;
                            assert!(out < 1e-12, "{out:e} outside");
                        }
                    }
                    Some(Relation::Separated { axis: None }) => panic!("no axis"),
                    None => {}
                }
                if let Some(found) = closest(placed[0], placed[1]) {
                    let slow = gjk::closest_points(support(a), &at_a, support(b), &at_b);
                    assert!((found.distance - slow.distance).abs() < 1e-11, "{found:?}, {slow:?}");
                    let on_a = at_a.transform_point3(found.points.on_a);
                    let on_b = at_b.transform_point3(found.points.on_b);
                    assert!((on_a.distance(on_b) - found.distance).abs() < 1e-11, "{found:?}");
                }
            }
            // Of a capsule and a box, nothing is decided.
            if i + j != 3 {
                assert!(decided > 1_700, "{i}, {j}: {decided} of 2000 decided");
                assert!((15..=85).contains(&(100 * hits / decided)), "{i}, {j}: {hits} of {decided} hit");
                (all_hits, all_decided) = (all_hits + hits, all_decided + decided);
            }
        }
    }
    assert!((30..=70).contains(&(100 * all_hits / all_decided)), "{all_hits} of {all_decided}");
}

/// The points of two shapes in the world; they are of these.
fn in_world(a: Placed, b: Placed, points: Witness, context: &str) -> [DVec3; 2] {
    [(a, points.on_a), (b, points.on_b)].map(|(placed, point)| {
        let dot = solid_convex::Points::new(std::slice::from_ref(&point)).unwrap();
        let here = DAffine3::IDENTITY;
        let out = gjk::closest_points(support(placed.shape), &here, &dot, &here).distance;
        assert!(out < 1e-12, "{context}: {out:e} outside");
        placed.placement.transform_point3(point)
    })
}

/// A depth is EPA's, and its points are as far from each other, along its direction.
fn assert_is_the_depth(a: Placed, b: Placed, found: &Penetration, context: &str) {
    let slow = epa::penetration(support(a.shape), a.placement, support(b.shape), b.placement).unwrap();
    let error = 1e-11 + 1e-3 * slow.depth * f64::from(u8::from(slow.upper - slow.lower > 1e-6));
    let bounds = slow.lower - 1e-11..=slow.upper + error;
    assert!(bounds.contains(&found.depth), "{context}: {found:?}, {slow:?}");
    assert!((0.0..=found.depth).contains(&found.lower) && found.depth <= found.upper, "{context}: {found:?}");
    let [x, y] = in_world(a, b, found.points, context);
    assert!((x + found.direction * found.depth).distance(y) < 1e-11, "{context}: {found:?}");
    assert!((found.direction.length() - 1.0).abs() < 1e-13, "{context}: {found:?}");
}

/// Capsules of all sizes and ways, side by side among them, whose cores are apart.
#[test]
fn capsules_are_as_deep_in_each_other_as_epa_tells() {
    let mut rng = seeded(SEED + 1);
    let capsules =
        [(0.4, 1.0), (0.1, 2.0), (1.5, 0.1)].map(|(radius, length)| Shape::capsule(radius, length).unwrap());
    let (mut hits, mut decided) = (0, 0);
    for case in 0..9_000 {
        let [mut at_a, at_b] = placements(&mut rng);
        if case % 4 == 0 {
            at_a.matrix3 = at_b.matrix3 * [1.0, -0.5, 2.0][case % 3];
        }
        at_a.translation = at_b.translation + (at_a.translation - at_b.translation) * 0.8;
        let (a, b) = (&capsules[case % 3], &capsules[case / 3 % 3]);
        let (a, b) = (Placed { shape: a, placement: &at_a }, Placed { shape: b, placement: &at_b });
        let context = format!("seed {SEED}, case {case}: {at_a}, {at_b}");
        hits += usize::from(intersects(a, b) == Some(true));
        let Some(found) = penetration(a, b) else { continue };
        decided += 1;
        assert_eq!(intersects(a, b), Some(true), "{context}");
        assert_is_the_depth(a, b, &found, &context);
    }
    println!("{decided} of {hits} decided");
    assert!((2_000..7_000).contains(&hits) && 10 * decided > 9 * hits, "{decided} of {hits}");
}

/// Balls of all sizes, and points, near or far, slow or fast, that miss, graze or hit each other.
#[test]
fn balls_meet_when_gjk_says_so() {
    let mut rng = seeded(SEED + 2);
    let balls = [0.7, 0.05, 1e-4].map(|radius| Shape::sphere(radius).unwrap());
    let balls = [&balls[0], &balls[1], &balls[2], &Shape::convex_hull(&[DVec3::ZERO]).unwrap()];
    let (mut hits, mut decided, cases) = (0, 0, 12_000);
    for case in 0..cases {
        let [mut at_a, at_b] = placements(&mut rng);
        at_a.translation += (at_a.translation - at_b.translation) * 10f64.powf(rng.random_range(0.0..4.0));
        let (a, b) = (
            Placed { shape: balls[case % 4], placement: &at_a },
            Placed { shape: balls[case / 4 % 4], placement: &at_b },
        );
        let way = at_b.translation - at_a.translation;
        let aside = way.any_orthonormal_vector() * rng.random_range(0.0..[1.5, 1e-3][case % 2]);
        let motion = (way + aside) * [0.9, 1.1, 30.0, -1.0][case / 16 % 4];
        let context = format!("seed {SEED}, case {case}: {at_a}, {at_b}, {motion}");
        let seen = levels().map(|level| dispatch!(level, simd => cast(simd, a, motion, b)));
        assert_eq!(seen[0], seen[1], "{context}");
        let Some(found) = seen[0] else { continue };
        decided += 1;
        let slow = gjk::cast(support(a.shape), &at_a, motion, support(b.shape), &at_b, 1.0);
        assert_eq!(found.is_some(), slow.is_some(), "{context}: {found:?}, {slow:?}");
        let (Some(found), Some(slow)) = (found, slow) else { continue };
        hits += 1;
        // Either may be before the impact by a gap of 1e-10 of the size of the data.
        let size = way.length() + motion.length() + 2.0;
        let normal = found.normal.unwrap();
        let later = (found.time - slow.time).abs() * -normal.dot(motion);
        assert!(later < 2e-10 * size, "{context}: {found:?}, {slow:?}");
        assert!((normal.length() - 1.0).abs() < 1e-14, "{context}: {found:?}");
        let moved = DAffine3 { translation: at_a.translation + motion * found.time, ..at_a };
        let [x, y] = in_world(Placed { placement: &moved, ..a }, b, found.points, &context);
        assert!(x.distance(y) < 1e-11 * size && (x - y).dot(normal) > -1e-14 * size, "{context}: {found:?}");
    }
    assert!(
        100 * decided > 80 * cases && (15..=60).contains(&(100 * hits / decided)),
        "{hits} of {decided} of {cases}"
    );
}

/// Balls of all sizes, and points, beside all bodies, in either order.
#[test]
fn balls_and_bodies_are_told_as_gjk_and_epa_tell_them() {
    let mut rng = seeded(SEED);
    let point = || Shape::convex_hull(&[DVec3::ZERO]).unwrap();
    let balls = [point(), Shape::sphere(0.05).unwrap(), Shape::sphere(0.7).unwrap()];
    let [sphere, capsule, block] = kinds();
    let [cylinder, cone] = turned();
    let [round, cuboid] = hulls();
    let bodies = [sphere, capsule, block, cylinder, cone, round, cuboid];
    let [mut hits, mut decided, mut inside, mut glanced, mut of_hulls] = [0; 5];
    for case in 0..21_000 {
        let [mut at_a, at_b] = placements(&mut rng);
        at_a.translation = at_b.translation + (at_a.translation - at_b.translation) * 0.8;
        let (ball, body) = (&balls[case % 3], &bodies[case / 3 % 7]);
        let placed = [Placed { shape: ball, placement: &at_a }, Placed { shape: body, placement: &at_b }];
        let [a, b] = if case % 2 == 0 { placed } else { [placed[1], placed[0]] };
        let context = format!("seed {SEED}, case {case}: {at_a}, {at_b}");
        let (of_a, of_b) = ((support(a.shape), a.placement), (support(b.shape), b.placement));
        let outcome = gjk::intersection(of_a.0, of_a.1, of_b.0, of_b.1);
        let seen = levels().map(|level| dispatch!(level, simd => glance(simd, a, b)));
        assert_eq!(seen[0], seen[1], "{context}");
        if let Glance::Sure(answer) = seen[0] {
            assert_eq!(answer, outcome.witness().is_some(), "{context}");
            glanced += 1;
        }
        let Some(hit) = ball_intersects(a, b) else { continue };
        (decided, hits) = (decided + 1, hits + usize::from(hit));
        of_hulls += usize::from(body.polytope().is_some());
        assert_eq!(hit, outcome.witness().is_some(), "{context}");
        let seen = levels().map(|level| {
            dispatch!(level, simd => {
                BallAndBody::new(simd, placed[0], placed[1]).map(|pair| (pair.closest(), pair.penetration()))
            })
        });
        assert_eq!(seen[0], seen[1], "{context}");
        let [closest, depth] = [quickly_closest(a, b).is_some(), quickly_penetration(a, b).is_some()];
        assert!(closest || case % 3 == 0, "{context}");
        assert!(depth == hit || case % 3 == 0 || case / 3 % 7 < 2, "{context}");
        assert_eq!(quickly_closest(a, b), in_unit(a, b, quickly_closest), "{context}");
        assert_eq!(quickly_penetration(a, b), in_unit(a, b, quickly_penetration), "{context}");
        let in_world = |points| in_world(a, b, points, &context);
        match of_ball(a, b, |pair| pair.relation()).unwrap() {
            Relation::Separated { axis } => {
                assert!(gjk::separates(&axis.unwrap(), of_a.0, of_a.1, of_b.0, of_b.1), "{context}");
            }
            Relation::Common(points) => {
                let [x, y] = in_world(points);
                assert!(x.distance(y) < 1e-12, "{context}: {points:?}");
            }
        }
        let found = of_ball(a, b, |pair| pair.closest()).unwrap();
        let slow = gjk::closest_points(of_a.0, of_a.1, of_b.0, of_b.1);
        assert!((found.distance - slow.distance).abs() < 1e-11, "{context}: {found:?}, {slow:?}");
        let [x, y] = in_world(found.points);
        assert!((x.distance(y) - found.distance).abs() < 1e-11, "{context}: {found:?}");
        if ball.ball_radius() == Some(0.0) {
            // As asked of the point alone.
            let (point, on_body) =
                (at_a.translation, if case % 2 == 0 { found.points.on_b } else { found.points.on_a });
            assert_eq!(contains(placed[1], point), Some(hit), "{context}");
            let ClosestPoint { distance, point: of_body } =
                closest_to(placed[1], point, || unreachable!("{context}")).unwrap();
            assert!((distance - found.distance).abs() < 1e-14, "{context}: {distance}, {found:?}");
            assert!(of_body.distance(at_b.transform_point3(on_body)) < 1e-12, "{context}: {of_body}");
        }
        let found = penetration(a, b);
        assert_eq!(found.is_some(), hit, "{context}");
        if let Some(found) = found {
            assert_is_the_depth(a, b, &found, &context);
            inside += usize::from(found.depth > 0.7);
        }
    }
    assert!(
        decided > 17_000 && of_hulls > 2_500 && inside > 500,
        "{decided} decided, {of_hulls} of hulls, {inside} deep"
    );
    assert!(glanced > 12_000, "{glanced} at a glance");
    assert!((30..=70).contains(&(100 * hits / decided)), "{hits} of {decided} hit");
}

/// A common point is in either shape as told in its own space, however much smaller than the other that is.
#[test]
fn a_common_point_is_in_the_smaller_too() {
    let mut rng = seeded(SEED);
    let [ball, capsule, block] = kinds();
    let mut found = 0;
    for (a, b) in [(&ball, &capsule), (&capsule, &capsule), (&capsule, &ball), (&ball, &block)] {
        for exponent in -200..200 {
            let [mut at_a, mut at_b] = placements(&mut rng);
            at_a.matrix3 *= 10f64.powi(-exponent / 2);
            at_b.matrix3 *= 10f64.powi((exponent + 1) / 2);
            let way = (at_b.translation - at_a.translation) * 0.2;
            at_b.translation = at_a.translation + way * 10f64.powi(exponent.abs() / 2);
            let placed = [Placed { shape: a, placement: &at_a }, Placed { shape: b, placement: &at_b }];
            let Some(Relation::Common(points)) = intersection(placed[0], placed[1]) else { continue };
            found += 1;
            for (shape, point) in [(a, points.on_a), (b, points.on_b)] {
                let dot = solid_convex::Points::new(std::slice::from_ref(&point)).unwrap();
                let here = DAffine3::IDENTITY;
                let out = gjk::closest_points(support(shape), &here, &dot, &here).distance;
                assert!(out < 1e-12, "{out:e} outside: {at_a}, {at_b}");
            }
        }
    }
    assert!(found > 500, "{found}");
}

/// Nearer than the error, a closed form says nothing.
#[test]
fn what_touches_is_left_to_gjk() {
    let [ball, _, block] = kinds();
    for gap in [-1e-12, 0.0, 1e-12] {
        let (here, beside) = (DAffine3::IDENTITY, DAffine3::from_translation(DVec3::X * (1.2 + gap)));
        let placed = |shape, placement| Placed { shape, placement };
        assert_eq!(intersects(placed(&ball, &here), placed(&ball, &beside)), None);
        let beside = DAffine3::from_translation(DVec3::X * (1.0 + gap));
        assert_eq!(intersects(placed(&block, &here), placed(&block, &beside)), None);
    }
}

/// The quick look against the close one: the same answers; and closest points and depths of the same bits in another unit of length, and on every level
/// of instructions.
#[test]
fn a_quick_look_says_what_a_close_one_says() {
    let mut rng = seeded(SEED);
    let [mut decided, mut measured, mut apart, mut deep] = [0; 4];
    for a in &kinds() {
        for b in &kinds() {
            for _ in 0..1_000 {
                let [at_a, at_b] = placements(&mut rng);
                let (a, b) = (Placed { shape: a, placement: &at_a }, Placed { shape: b, placement: &at_b });
                let seen = levels().map(|level| dispatch!(level, simd => quick::intersects(simd, a, b)));
                assert_eq!(seen[0], seen[1]);
                if let Glance::Sure(answer) = seen[0] {
                    decided += 1;
                    // Of a capsule and a box, that the balls around them are apart is all that is known.
                    assert!(closely_intersects(a, b).is_none_or(|closely| closely == answer));
                }
                let found = levels().map(|level| dispatch!(level, simd => quick::closest(simd, a, b)));
                assert_eq!(found[0], found[1]);
                assert_eq!(found[0], in_unit(a, b, quickly_closest));
                let depths = levels().map(|level| match (a.shape.simple(), b.shape.simple()) {
                    (Some(Simple::Round(x)), Some(Simple::Round(y))) => {
                        dispatch!(level, simd => quick::penetration(simd, [&at_a, &at_b], [x, y]))
                    }
                    _ => None,
                });
                assert_eq!(depths[0], depths[1]);
                deep += usize::from(depths[0].is_some());
                assert_eq!(quickly_penetration(a, b), in_unit(a, b, quickly_penetration));
                measured += usize::from(found[0].is_some());
                apart += usize::from(found[0].is_some_and(|found| found.distance > 0.0));
            }
        }
    }
    // Six of the nine pairs have closest points in closed form; of two boxes few are apart by the balls around them.
    assert!(deep > 1_000, "{deep} are in each other");
    assert!(decided > 5_500 && measured > 5_000, "{decided} and {measured} of 9000");
    assert!((30..=70).contains(&(100 * apart / measured)), "{apart} of {measured} are apart");
}

/// Placements that are similarities only nearly are looked at roughly, and the answers are GJK's.
#[test]
fn a_rough_look_says_what_gjk_says() {
    let mut rng = seeded(SEED);
    let (mut hits, mut decided) = (0, 0);
    let shapes: Vec<Shape> = kinds().into_iter().chain(turned()).chain(hulls()).collect();
    for a in &shapes {
        for b in &shapes {
            for _ in 0..1_000 {
                let [at_a, at_b] = placements(&mut rng).map(|at| {
                    let skew = DMat3::from_cols_array(&[0; 9].map(|_| rng.random_range(-1e-7..1e-7)));
                    DAffine3 { matrix3: at.matrix3 * (DMat3::IDENTITY + skew), ..at }
                });
                let placed = [Placed { shape: a, placement: &at_a }, Placed { shape: b, placement: &at_b }];
                let [a, b] = placed;
                if let Glance::Sure(answer) = dispatch!(simd => glance(simd, a, b)) {
                    let outcome = gjk::intersection(support(a.shape), &at_a, support(b.shape), &at_b);
                    assert_eq!(answer, outcome.witness().is_some(), "{at_a}, {at_b}");
                    (hits, decided) = (hits + usize::from(answer), decided + 1);
                }
            }
        }
    }
    // Of cylinders, cones and hulls, those beside balls.
    assert!(decided > 13_500, "{decided} of 17000 decided");
    assert!((30..=70).contains(&(100 * hits / decided)), "{hits} of {decided} hit");
}

/// Balls of any two radii, placed in any size that has one: by squares alone, as far as they reach, and close to where they touch.
#[test]
fn balls_of_any_size_are_told_as_gjk_tells_them() {
    let mut rng = seeded(SEED);
    let (mut hits, mut decided, mut near) = (0, 0, 0);
    for i in 0..20_000 {
        let size = [1.0, 1e-90, 1e-45, 1e-29, 1e30, 1e50, 1e90][i % 7];
        let radii =
            [(); 2].map(|()| size * 10f64.powf(rng.random_range(-9.0..0.0) * f64::from(i as u32 % 2)));
        let unit = [1.0, 1e-9, 1e9][i / 7 % 3];
        let [at_a, mut at_b] = placements(&mut rng)
            .map(|at| DAffine3 { matrix3: at.matrix3 * unit, translation: at.translation * (size * unit) });
        let radii_placed = radii[0] * at_a.matrix3.x_axis.length() + radii[1] * at_b.matrix3.x_axis.length();
        if i % 3 == 0 {
            let way = (at_b.translation / (size * unit) - at_a.translation / (size * unit)).normalize();
            let gap = [-1e-3, -1e-5, -1e-6, 0.0, 1e-6, 1e-5, 1e-3][i / 3 % 7];
            at_b.translation = at_a.translation + way * (radii_placed * (1.0 + gap));
            near += 1;
        }
        let [a, b] = radii.map(|radius| Shape::sphere(radius).unwrap());
        let (a, b) = (Placed { shape: &a, placement: &at_a }, Placed { shape: &b, placement: &at_b });
        if let Glance::Sure(answer) = dispatch!(simd => quick::intersects(simd, a, b)) {
            let outcome = gjk::intersection(support(a.shape), &at_a, support(b.shape), &at_b);
            assert_eq!(answer, outcome.witness().is_some(), "{radii:?}, {at_a}, {at_b}");
            (hits, decided) = (hits + usize::from(answer), decided + 1);
        }
    }
    assert!(decided > 8_000 && near > 6_000, "{decided} decided, {near} near");
    assert!((30..=70).contains(&(100 * hits / decided)), "{hits} of {decided} hit");
}

/// Capsules of any thinness, any way across each other or nearly parallel, close to where they touch: squares by scalar products of axes alone lose
/// no more than the margin.
#[test]
fn thin_capsules_are_told_as_gjk_tells_them() {
    let mut rng = seeded(SEED);
    let (mut hits, mut decided, mut thin) = (0, 0, 0);
    for i in 0..20_000 {
        let radius = 10f64.powf(rng.random_range(-8.0..-0.5));
        let capsule = Shape::capsule(radius, 2.0).unwrap();
        let [at_a, mut at_b] = placements(&mut rng);
        if i % 4 == 0 {
            // Nearly parallel.
            let skew = DQuat::from_rotation_x(10f64.powf(rng.random_range(-9.0..-1.0)));
            at_b.matrix3 = at_a.matrix3 * DMat3::from_quat(skew);
        }
        // So that they touch, nearly, by a point of each core.
        let [s, t] = [(); 2].map(|()| rng.random_range(-1.0..1.0));
        let (a, b) = (at_a.matrix3.y_axis, at_b.matrix3.y_axis);
        let normal = a.cross(b).try_normalize().unwrap_or(a.any_orthonormal_vector());
        let radii = radius * (a.length() + b.length());
        let gap = [0.5, 0.9, 0.999, 1.001, 1.1, 2.0][i % 6];
        at_b.translation = at_a.translation + a * s - b * t + normal * (radii * gap);
        let (a, b) =
            (Placed { shape: &capsule, placement: &at_a }, Placed { shape: &capsule, placement: &at_b });
        let seen = levels().map(|level| dispatch!(level, simd => quick::intersects(simd, a, b)));
        assert_eq!(seen[0], seen[1]);
        if let Glance::Sure(answer) = seen[0] {
            let outcome = gjk::intersection(support(a.shape), &at_a, support(b.shape), &at_b);
            assert_eq!(answer, outcome.witness().is_some(), "{i}: {radius:e}, {gap}: {at_a}, {at_b}");
            (hits, decided) = (hits + usize::from(answer), decided + 1);
            thin += usize::from(radius < 1e-4);
        }
    }
    assert!(decided > 8_000 && thin > 300, "{decided} decided, {thin} of them thin");
    assert!((30..=70).contains(&(100 * hits / decided)), "{hits} of {decided} hit");
}

/// Capsules and boxes of any sizes and proportions, mirrored among them, that all but touch, by a face, an edge or a corner: seen on every level alike,
/// and as GJK tells them. Most are not left open.
#[test]
fn capsules_and_boxes_are_seen_as_gjk_tells_them() {
    let mut rng = seeded(SEED + 3);
    let [mut sure_hits, mut sure_misses, mut hits, mut misses] = [0; 4];
    for case in 0..24_000 {
        let spread = [0.3, 3.0][case % 2];
        let mut size = || 10f64.powf(rng.random_range(-spread..spread));
        let capsule = Shape::capsule(size(), size()).unwrap();
        let block = Shape::cuboid([size(), size(), size()]).unwrap();
        let [mut at_a, at_b] = placements(&mut rng);
        if case % 3 == 0 {
            at_a.matrix3 = at_b.matrix3 * DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
        }
        // Along the way that parts them, by a part of their gap or overlap.
        let unit = DVec3::from([0; 3].map(|_| rng.random_range(-1.0..1.0)));
        let reach = capsule.simple().unwrap().radius() + block.simple().unwrap().radius();
        at_a.translation = at_b.translation + unit * reach;
        let [of_a, of_b] = [&capsule, &block].map(support);
        let closest = gjk::closest_points(of_a, &at_a, of_b, &at_b);
        if closest.distance > 0.0 {
            let [p, q] =
                [at_a.transform_point3(closest.points.on_a), at_b.transform_point3(closest.points.on_b)];
            at_a.translation += (q - p) * [0.0, 0.9, 0.999_999_9, 1.000_000_1, 1.2, 3.0][case / 3 % 6];
        }
        let placed =
            [Placed { shape: &capsule, placement: &at_a }, Placed { shape: &block, placement: &at_b }];
        let [a, b] = if case % 2 == 0 { placed } else { [placed[1], placed[0]] };
        let seen = levels().map(|level| dispatch!(level, simd => quick::intersects(simd, a, b)));
        assert_eq!(seen[0], seen[1], "case {case}: {at_a}, {at_b}");
        let meets = gjk::intersection(of_a, &at_a, of_b, &at_b).witness().is_some();
        (hits, misses) = (hits + usize::from(meets), misses + usize::from(!meets));
        if let Glance::Sure(answer) = seen[0] {
            assert_eq!(answer, meets, "case {case}: {capsule:?}, {block:?}, {at_a}, {at_b}");
            sure_hits += usize::from(answer);
            sure_misses += usize::from(!answer);
        }
    }
    println!("{sure_hits} of {hits} that meet, {sure_misses} of {misses} that do not");
    assert!(hits > 6_000 && misses > 6_000 && sure_hits * 10 > hits * 6 && sure_misses * 2 > misses);
}

/// Law: on an ellipsoid the foot of a point is on the surface and straight below the point, and no plane that touches the ellipsoid is nearer to a point inside, nor
/// further from one outside.
#[test]
fn a_foot_on_an_ellipsoid_is_the_nearest() {
    let mut rng = seeded(SEED + 9);
    let (mut insides, mut cases) = (0, 0);
    for case in 0..3_000 {
        let stretch =
            [DVec3::new(1.0, 0.4, 1.7), DVec3::new(1.0, 1e-3, 1.0), DVec3::new(2.5e-4, 2.0, 1e-3)][case % 3];
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
        let skew = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::Z);
        let linear =
            turn * DMat3::from_diagonal(stretch) * if case % 2 == 0 { skew } else { DMat3::IDENTITY };
        let found = Ellipsoid::new(&linear).expect("its axes are alike enough");
        // Anywhere, or near or in the middle of one axis or more.
        let within = in_cube(&mut rng)
            * DVec3::from_array([0; 3].map(|_| [1.0, 0.0, 1e-9, 1e-17][rng.random_range(0..4)]));
        let point = linear * within * [0.9, 4.0][case / 3 % 2];
        let foot = found.foot(point).expect("the search ends");
        let context = format!("case {case}: {linear}, {point}");
        let size = linear.to_cols_array().iter().fold(0.0, |most: f64, x| most.max(x.abs())) + point.length();
        let on_ball = linear.inverse() * foot.at;
        assert!((on_ball.length() - 1.0).abs() < 1e-11, "{context}, {on_ball}");
        assert!((point - foot.at - foot.normal * foot.distance).length() < 1e-14 * size, "{context}");
        let beyond = |normal: DVec3| normal.dot(point) - (linear.transpose() * normal).length();
        assert!((beyond(foot.normal) - foot.distance).abs() < 1e-14 * size, "{context}");
        for _ in 0..200 {
            let near =
                (foot.normal + in_cube(&mut rng) * 10f64.powf(rng.random_range(-6.0..0.5))).normalize();
            assert!(beyond(near) <= foot.distance + 1e-14 * size, "{context}, {near}");
        }
        insides += usize::from(foot.distance < 0.0);
        cases += 1;
    }
    assert!((cases / 2..cases * 9 / 10).contains(&insides), "{insides} of {cases}");
    assert!(Ellipsoid::new(&DMat3::from_diagonal(DVec3::new(1.0, 1e-5, 1.0))).is_none());
}

/// Law: how deep a ball or a point is in an ellipsoid is within the bounds of EPA, and its points are in their shapes; it is sought wherever they intersect clearly.
#[test]
fn depths_in_ellipsoids_are_those_of_epa() {
    let mut rng = seeded(SEED + 10);
    let (ball, stretched) = (Shape::sphere(0.6).unwrap(), Shape::sphere(0.5).unwrap());
    let point = Shape::convex_hull(&[DVec3::ZERO]).unwrap();
    let (mut answers, cases) = (0, 1_500);
    for case in 0..cases {
        let unit = 2f64.powi([0, 40, -60][case % 3]);
        let round = if case % 2 == 0 { &ball } else { &point };
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
        let to = turn * DMat3::from_diagonal(DVec3::new(1.0, 0.3, 1.7)) * unit;
        let at = DAffine3 { matrix3: to, translation: in_cube(&mut rng) * unit };
        let at_ball = DAffine3 {
            matrix3: turn.transpose() * (0.7 * unit),
            translation: at.translation + to * in_cube(&mut rng) * 0.6,
        };
        let [a, b] =
            [Placed { shape: round, placement: &at_ball }, Placed { shape: &stretched, placement: &at }];
        let exact = epa::penetration(support(round), &at_ball, support(&stretched), &at);
        let Some(found) = penetration(a, b) else {
            assert!(exact.is_none_or(|exact| exact.depth < 1e-10 * unit), "case {case}: {exact:?}");
            continue;
        };
        answers += 1;
        let exact = exact.expect("they meet");
        let error = 1e-12 * unit;
        assert!(
            (exact.lower - error..=exact.upper + error).contains(&found.depth),
            "case {case}: {found:?}, {exact:?}"
        );
        let [on_ball, on_stretched] =
            [at_ball.transform_point3(found.points.on_a), at.transform_point3(found.points.on_b)];
        let apart = on_stretched - on_ball - found.direction * found.depth;
        assert!(apart.length() < error, "case {case}: {apart}");
        let mirrored = penetration(b, a).unwrap();
        assert_eq!((mirrored.depth, mirrored.direction), (found.depth, -found.direction));
    }
    assert!(answers > cases / 2, "{answers} of {cases}");
}
