//! Shapes that move along straight lines: by laws, and against small steps.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use common::{
    are_convex, at, convex_of_kind, direction, in_cube, overlap_along, placement, random_mesh, sheet,
    some_shape, torus,
};
use glam::{DAffine3, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;
use solid3d::convex::gjk::CAST_ERROR;
use solid3d::{Shape, World, glam, query};

fn moved(at: &DAffine3, motion: DVec3, t: f64) -> DAffine3 {
    DAffine3 { translation: at.translation + motion * t, ..*at }
}

/// Steps along the way, of which none may find what a cast did not.
const STEPS: u32 = 40;

/// At the time of a cast the shapes are as near as makes no difference, before it they are apart, and without one they never meet. Convex ones are then on
/// either side of a plane across the normal.
#[test]
fn a_cast_is_when_shapes_first_meet() {
    let seed = 101;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, mut at_start, mut worst) = (0, 0, 0.0f64);
    let cases = 1600;
    for case in 0..cases {
        let size = 10f64.powi(rng.random_range(-5..6));
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let scaled = |at: DAffine3| DAffine3::from_scale(DVec3::splat(size)) * at;
        let (at_a, mut at_b) = (scaled(placement(&mut rng, 1.0)), scaled(placement(&mut rng, 1.0)));
        let away = direction(&mut rng) * rng.random_range(2.0..6.0) * size;
        at_b.translation = at_a.translation + away;
        let motion_b = in_cube(&mut rng) * size;
        let motion_a = motion_b + (away + in_cube(&mut rng) * 2.5 * size) * rng.random_range(0.5..1.5);
        let (start_a, start_b) = (at_a, at_b);
        let cast = query::cast_shape(&a, &at_a, motion_a, &b, &at_b, motion_b).unwrap();
        let context = || {
            format!("case {case}: {} {} {at_a:?} {at_b:?} {motion_a} {motion_b} {cast:?}", a.kind(), b.kind())
        };
        let at = |t: f64| (moved(&at_a, motion_a, t), moved(&at_b, motion_b, t));
        let meet = |t: f64| {
            let (at_a, at_b) = at(t);
            query::intersects(&a, &at_a, &b, &at_b).unwrap()
        };
        let gap = |t: f64| {
            let (at_a, at_b) = at(t);
            query::distance(&a, &at_a, &b, &at_b).unwrap().distance
        };
        let until = cast.map_or(1.0, |cast| cast.time);
        for step in 0..STEPS {
            // Relative to the end, for the contact itself may be at it.
            let t = until * f64::from(step) / f64::from(STEPS);
            assert!(t >= until || !meet(t), "{}: they meet at {t}", context());
        }
        let Some(cast) = cast else {
            assert!(!meet(1.0), "{}", context());
            continue;
        };
        hits += 1;
        at_start += i32::from(cast.time == 0.0);
        let left = gap(cast.time) / size;
        worst = worst.max(left);
        assert!(left < 1e-9, "{}: {left}", context());
        let (at_a, at_b) = at(cast.time);
        let point = Shape::convex_hull(&[cast.point]).unwrap();
        for (shape, at) in [(&a, &at_a), (&b, &at_b)] {
            let off = query::distance(shape, at, &point, &DAffine3::IDENTITY).unwrap().distance;
            assert!(off < 1e-8 * size, "{}: {off}", context());
        }
        if let Some(normal) = cast.normal {
            assert!((normal.length() - 1.0).abs() < 1e-12);
            let approach = normal.dot(motion_a - motion_b) / (motion_a - motion_b).length();
            assert!(approach < 1e-6, "{}: they part along the normal, {approach}", context());
            let overlap = overlap_along(normal, &a, &at_a, &b, &at_b) / size;
            assert!(!are_convex(&a, &b) || overlap < 1e-6, "{}: {overlap} along the normal", context());
        }
        // Only the relative motion counts, and who is which does not.
        let swapped =
            query::cast_shape(&b, &start_b, motion_b - motion_a, &a, &start_a, DVec3::ZERO).unwrap();
        assert!(swapped.is_some(), "{}: swapped", context());
        let slope = cast
            .normal
            .map_or(1.0, |normal| normal.dot(motion_a - motion_b).abs() / (motion_a - motion_b).length());
        let difference = (swapped.unwrap().time - cast.time).abs();
        assert!(slope < 1e-2 || difference < 1e-8, "{}: {swapped:?}", context());
    }
    println!("{hits} of {cases} hit, {at_start} at the start; the widest gap is {worst:e} of the size");
    assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))));
}

/// Shapes that are apart at the start by hardly more than rounding have a normal, as all that do not intersect; where they part they do not meet.
#[test]
fn next_to_each_other_they_have_a_normal() {
    let (block, here) = (Shape::cuboid([1.0; 3]).unwrap(), DAffine3::IDENTITY);
    let cast = |gap: f64, motion: DVec3| {
        let there = DAffine3::from_translation(DVec3::X * -(1.0 + gap));
        let meet = query::intersects(&block, &there, &block, &here).unwrap();
        (meet, query::cast_shape(&block, &there, motion, &block, &here, DVec3::ZERO).unwrap())
    };
    for gap in [1e-13, 4e-14, 2e-14, 1e-14, 1e-15, 0.0] {
        let (meet, found) = cast(gap, DVec3::X);
        let found = found.unwrap();
        assert!(found.time <= gap && found.normal.is_none() == meet, "{gap}: {found:?}");
        assert!(found.normal.is_none_or(|normal| (normal + DVec3::X).length() < 1e-6), "{gap}: {found:?}");
        for motion in [DVec3::NEG_X, DVec3::ZERO] {
            assert_eq!(cast(gap, motion).1.is_some(), meet, "{gap}, {motion}");
        }
    }
    assert!(!cast(2e-14, DVec3::X).0 && cast(1e-15, DVec3::X).0);
}

/// Law: what stops sooner by a skin slides along whatever it meets, a floor of triangles too, and never touches.
#[test]
fn with_a_skin_bodies_slide() {
    const SKIN: f64 = 1e-6;
    let mut rng = seeded(104);
    let floor =
        |rows| sheet(rows, rows, [false; 2], |x, z| DVec3::new(20.0 * x - 10.0, 0.0, 20.0 * z - 10.0));
    let wall_at = DAffine3::from_rotation_y(0.3) * DAffine3::from_translation(DVec3::new(4.0, 2.0, 0.0));
    let along = wall_at.transform_vector3(DVec3::Z);
    for floor in [floor(21).shape(), Shape::convex_hull(&floor(2).vertices).unwrap()] {
        let mut world = World::new();
        world.add(&floor, DAffine3::IDENTITY).unwrap();
        world.add(&Shape::cuboid([1.0, 4.0, 20.0]).unwrap(), wall_at).unwrap();
        let slide = |body: &Shape, mut from: DVec3, mut motion: DVec3| {
            for _ in 0..10 {
                let met = world.cast_shape(body, &at(from.x, from.y, from.z), motion, |_| true).unwrap();
                let Some(cast) = met.map(|met| met.cast) else { return from + motion };
                let normal = cast.normal.unwrap();
                let time = (cast.time + SKIN / motion.dot(normal)).max(0.0);
                from += motion * time;
                motion = (motion * (1.0 - time)).reject_from_normalized(normal);
            }
            from
        };
        for kind in 0..6 {
            let body = convex_of_kind(&mut rng, kind, [0.5, 1.0, 1.0], 0.7);
            let mut place = DVec3::new(0.0, 1.5, 0.0);
            for frame in 0..100 {
                let from = slide(&body, place, DVec3::Y * -0.1);
                place = slide(&body, from, DVec3::new(0.1, 0.0, 0.1));
                let way = (place - from).dot(along);
                assert!(way > 0.1, "kind {kind}, frame {frame}: {way} from {from}");
                let met = world.objects_in(&body, &at(place.x, place.y, place.z)).unwrap();
                assert_eq!(met, [], "kind {kind}, frame {frame}, {place}");
            }
        }
    }
}

/// Balls that come from afar stop no further off than others.
#[test]
fn from_afar_balls_come_as_near() {
    let (ball, here) = (Shape::sphere(1.0).unwrap(), DAffine3::IDENTITY);
    for far in [10.0, 1e2, 1e4, 1e6] {
        let from = DAffine3::from_translation(DVec3::X * -far);
        let motion = DVec3::X * 1.5 * far;
        let found = query::cast_shape(&ball, &from, motion, &ball, &here, DVec3::ZERO).unwrap().unwrap();
        let gap = -2.0 - (motion.x * found.time - far);
        assert!((-1e-14 * far..=4e-10_f64.max(1e-14 * far)).contains(&gap), "{far}: {gap}");
    }
}

/// What passes a corner more closely than the search for the last step tells is not met from further away than is stated.
#[test]
fn what_passes_a_corner_is_met_at_the_stated_gap() {
    let mut rng = seeded(103);
    let corners =
        [[0.75, 0.25, 0.25], [0.0, -0.25, -0.5], [-1.0, -0.75, 0.25], [0.5, 0.0, -0.25]].map(DVec3::from);
    let (wedge, here) = (Shape::convex_hull(&corners).unwrap(), DAffine3::IDENTITY);
    let point = Shape::convex_hull(&[DVec3::ZERO]).unwrap();
    let (mut hits, cases) = (0, 20_000);
    for case in 0..cases {
        let (motion, past) =
            (in_cube(&mut rng), 10f64.powf(rng.random_range(-11.0..-6.0)) * in_cube(&mut rng));
        let from = DAffine3::from_translation(corners[case % 4] + past - 0.7 * motion);
        let Some(cast) = query::cast_shape(&point, &from, motion, &wedge, &here, DVec3::ZERO).unwrap() else {
            continue;
        };
        hits += 1;
        let gap = query::distance(&point, &moved(&from, motion, cast.time), &wedge, &here).unwrap().distance;
        assert!(gap <= 3.0 * CAST_ERROR, "case {case}: {gap:e}, {cast:?}");
    }
    println!("{hits} of {cases} hit");
    assert!(hits > cases / 5);
}

/// Two meshes by their trees, and primitive by primitive.
#[test]
fn meshes_agree_with_all_pairs_of_primitives() {
    let mut rng = seeded(102);
    let (mut hits, cases) = (0, 40);
    for case in 0..cases {
        let (x, y) = (torus(9, 6, 0.4), random_mesh(&mut rng, 40));
        let (at_x, mut at_y) = (placement(&mut rng, 1.0), placement(&mut rng, 1.0));
        let away = direction(&mut rng) * 4.0;
        at_y.translation = at_x.translation + away;
        let motion = (away + in_cube(&mut rng) * 2.0) * 1.2;
        let found = query::cast_shape(&x.shape(), &at_x, motion, &y.shape(), &at_y, DVec3::ZERO).unwrap();
        let mut first = f64::INFINITY;
        for p in x.hulls(&at_x) {
            let p = Shape::convex_hull(&p).unwrap();
            for q in y.hulls(&at_y) {
                let (q, here) = (Shape::convex_hull(&q).unwrap(), DAffine3::IDENTITY);
                let cast = query::cast_shape(&p, &here, motion, &q, &here, DVec3::ZERO).unwrap();
                first = cast.map_or(first, |cast| first.min(cast.time));
            }
        }
        let time = found.map_or(f64::INFINITY, |cast| cast.time);
        assert!(time == first || (time - first).abs() < 1e-9, "case {case}: {time} {first}");
        hits += i32::from(found.is_some());
    }
    println!("{hits} of {cases} hit");
    assert!((0.3..=0.8).contains(&(f64::from(hits) / f64::from(cases))));
}

/// A mesh and a convex shape by its tree and the planes of impacts, and primitive by primitive.
#[test]
fn meshes_agree_with_all_primitives_beside_convex_shapes() {
    let mut rng = seeded(103);
    let (mut hits, cases) = (0, 300);
    for case in 0..cases {
        let mesh = if case % 2 == 0 { torus(16, 10, 0.4) } else { random_mesh(&mut rng, 200) };
        let convex = match case / 2 % 6 {
            0 => Shape::sphere(0.3),
            1 => Shape::cuboid([0.3, 0.5, 0.4]),
            2 => Shape::capsule(0.2, 0.5),
            3 => Shape::cylinder(0.3, 0.4),
            4 => Shape::cone(0.4, 0.5),
            _ => Shape::convex_hull(&[(); 12].map(|()| in_cube(&mut rng) * 0.5)),
        };
        let convex = convex.unwrap();
        let (at_x, mut at_y) = (placement(&mut rng, 1.0), placement(&mut rng, 1.0));
        let away = direction(&mut rng) * 4.0;
        at_y.translation = at_x.translation + away;
        let motion = (away + in_cube(&mut rng) * 1.5) * 1.2;
        let shape = mesh.shape();
        // Either of the two may be the one that moves.
        let found = match case % 3 {
            0 => query::cast_shape(&convex, &at_y, -motion, &shape, &at_x, DVec3::ZERO),
            _ => query::cast_shape(&shape, &at_x, motion, &convex, &at_y, DVec3::ZERO),
        };
        let mut first = f64::INFINITY;
        for p in mesh.hulls(&at_x) {
            let (p, here) = (Shape::convex_hull(&p).unwrap(), DAffine3::IDENTITY);
            let cast = query::cast_shape(&p, &here, motion, &convex, &at_y, DVec3::ZERO).unwrap();
            first = cast.map_or(first, |cast| first.min(cast.time));
        }
        let time = found.unwrap().map_or(f64::INFINITY, |cast| cast.time);
        assert!(time == first || (time - first).abs() < 1e-9, "case {case}: {time} {first}");
        hits += i32::from(time < f64::INFINITY);
    }
    println!("{hits} of {cases} hit");
    assert!((0.3..=0.8).contains(&(f64::from(hits) / f64::from(cases))));
}

#[test]
fn a_solid_takes_in_what_starts_inside() {
    let solid = torus(24, 12, 0.4).shape().into_solid().unwrap();
    let (ball, here) = (Shape::sphere(0.01).unwrap(), DAffine3::IDENTITY);
    let inside = DAffine3::from_translation(DVec3::X * 0.72);
    let cast = query::cast_shape(&ball, &inside, DVec3::Y, &solid, &here, DVec3::ZERO).unwrap().unwrap();
    assert_eq!((cast.time, cast.normal), (0.0, None));
    let hole = query::cast_shape(&ball, &here, DVec3::Y, &solid, &here, DVec3::ZERO).unwrap();
    assert_eq!(hole, None);
}

#[test]
fn bad_motions_and_points_are_refused_by_name() {
    let (ball, here) = (Shape::sphere(1.0).unwrap(), DAffine3::IDENTITY);
    for bad in [f64::NAN, f64::INFINITY, -1.1e100] {
        let (vector, zero) = (DVec3::new(0.0, bad, 0.0), DVec3::ZERO);
        let errors = [
            (query::cast_shape(&ball, &here, vector, &ball, &here, zero).unwrap_err(), "motion_a"),
            (query::cast_shape(&ball, &here, zero, &ball, &here, vector).unwrap_err(), "motion_b"),
            (query::closest_point(&ball, &here, vector).unwrap_err(), "point"),
            (query::contains_point(&ball, &here, vector).unwrap_err(), "point"),
        ];
        for (error, name) in errors {
            assert!(error.to_string().starts_with(name), "{error}");
        }
        let mesh = torus(3, 3, 0.5).shape();
        assert!(query::winding_number(&mesh, &here, vector).unwrap_err().to_string().starts_with("point"));
    }
    assert!(query::winding_number(&ball, &here, DVec3::ZERO).unwrap_err().to_string().contains("sphere"));
}

/// Wild but allowed numbers neither panic nor hang.
#[test]
fn wild_motions_are_survived() {
    let mut rng = seeded(103);
    let wild = [0.0, 5e-324, 1e-100, 1e-30, 1.0, -3.0, 1e16, 1e100, -1e100];
    for case in 0..600 {
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let mut pick = || DVec3::from_array(std::array::from_fn(|_| wild[rng.random_range(0..wild.len())]));
        let at = [pick(), pick()].map(DAffine3::from_translation);
        let cast = query::cast_shape(&a, &at[0], pick(), &b, &at[1], pick()).unwrap();
        assert!(cast.is_none_or(|cast| (0.0..=1.0).contains(&cast.time)), "{cast:?}");
    }
}

/// Law: a mirroring placement does not turn a mesh inside out.
#[test]
fn winding_numbers_are_the_same_in_a_mirror() {
    let mesh = common::cube(1.0).shape();
    for signs in [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -2.0, 1.0], [-1.0, -2.0, -3.0]] {
        let at = DAffine3::from_scale(DVec3::from_array(signs));
        let winding = query::winding_number(&mesh, &at, DVec3::splat(0.25)).unwrap();
        assert!((winding - 1.0).abs() < 1e-12, "{winding} for {signs:?}");
    }
}

/// The winding number of closed meshes is a whole number, and not 0 exactly inside.
#[test]
fn winding_numbers_tell_inside_from_outside() {
    let mut rng = seeded(104);
    let (mut inside, cases) = (0, 1500);
    for _ in 0..cases {
        let soup = torus(14, 9, rng.random_range(0.2..0.8));
        let (surface, at) = (soup.shape(), placement(&mut rng, 2.0));
        let solid = surface.clone().into_solid().unwrap();
        let point = at.transform_point3(in_cube(&mut rng) * DVec3::new(0.9, 0.4, 0.9));
        let winding = query::winding_number(&surface, &at, point).unwrap();
        let contained = query::contains_point(&solid, &at, point).unwrap();
        assert!((winding - winding.round()).abs() < 1e-9, "{winding}");
        assert_eq!(winding.round() != 0.0, contained, "{winding}");
        inside += i32::from(contained);
    }
    println!("{inside} of {cases} inside");
    assert!((0.3..=0.7).contains(&(f64::from(inside) / f64::from(cases))));
}

/// Next to an edge the winding number keeps as many digits as the distance from it has: here ends are seen in opposite directions.
#[test]
fn winding_numbers_are_right_next_to_edges() {
    let corners = [DVec3::new(6e-6, 0.0, -0.5), DVec3::new(0.0, -2e-5, 0.5), DVec3::new(6e-6, 0.0, 0.5)];
    let here = DAffine3::IDENTITY;
    let winding = |corners: [DVec3; 3]| {
        query::winding_number(&Shape::mesh(corners, [[0, 1, 2]]).unwrap(), &here, DVec3::ZERO).unwrap()
    };
    let expected = 0.203_613_210_426_085_55; // computed with 60 digits
    for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
        assert!((winding([i, j, k].map(|i: usize| corners[i])).abs() - expected).abs() < 1e-15);
    }
    let cube = common::cube(1.0).shape();
    for near in [1e-3, 1e-5, 1e-7, 1e-9] {
        for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 0.3)] {
            let point = DVec3::new(1.0 - x * near, 1.0 - y * near, 0.25);
            let (winding, inside) = (query::winding_number(&cube, &here, point).unwrap(), x.min(y) > 0.0);
            assert!((winding - f64::from(u8::from(inside))).abs() < 1e-15 / near, "{near}: {winding}");
        }
    }
}
