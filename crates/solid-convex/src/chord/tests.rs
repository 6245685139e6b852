//! Chords against their slow twin: the GJK cast of a point, from either end.

use glam::{DAffine3, DMat3, DVec3};

use super::{Chord, Line};
use crate::{Capsule, Cone, Cuboid, Cylinder, Points, Polytope, Sphere, Support, gjk};

/// A chord is none where it is not told.
type Shape = (Box<dyn Support>, Box<dyn Fn(&Line) -> Option<Option<Chord>>>);

macro_rules! shape {
    ($shape:expr) => {{
        let shape = $shape.unwrap();
        (Box::new(shape) as Box<dyn Support>, Box::new(move |line: &Line| Some(shape.chord(line))) as Box<_>)
    }};
}

/// A pyramid over a polygon of an even number of sides, and one below it; every other side is as short as `short`.
fn double_pyramid(sides: u32, short: f64, map: DMat3) -> Polytope {
    let rim = (0..sides).map(|i| {
        let turn = std::f64::consts::TAU / f64::from(sides) * f64::from(i / 2 * 2) + f64::from(i % 2) * short;
        DVec3::new(turn.cos(), 0.0, turn.sin())
    });
    let corners = rim.chain([DVec3::Y, DVec3::NEG_Y]).map(|corner| map * corner);
    let of_side = |i| [[(i + 1) % sides, i, sides], [i, (i + 1) % sides, sides + 1]];
    let faces: Vec<[u32; 3]> = (0..sides).flat_map(of_side).collect();
    Polytope::new(corners.collect()).unwrap().with_faces(&faces)
}

fn hull(hull: Polytope) -> Shape {
    (Box::new(hull.clone()), Box::new(move |line| hull.chord(line)))
}

fn shapes(size: f64) -> Vec<Shape> {
    vec![
        shape!(Sphere::new(0.9 * size)),
        shape!(Cuboid::new(DVec3::new(1.0, 1.5, 2.0) * size)),
        shape!(Cone::new(1.0 * size, 2.2 * size)),
        shape!(Cone::new(1.4 * size, 0.4 * size)),
        shape!(Cylinder::new(0.9 * size, 1.7 * size)),
        shape!(Cylinder::new(0.02 * size, 2.5 * size)),
        shape!(Capsule::new(0.5 * size, 1.6 * size)),
        hull(double_pyramid(4, 1.5, DMat3::from_diagonal(DVec3::new(1.2, 0.9, 1.5) * size))),
        hull(double_pyramid(
            32,
            0.1,
            DMat3::from_cols(DVec3::ONE, DVec3::Y - DVec3::Z, DVec3::Z * 1.5) * size,
        )),
        hull(double_pyramid(12, 1e-6, DMat3::from_diagonal(DVec3::splat(1.2 * size)))),
    ]
}

/// Numbers from -1 to 1, spread by a low-discrepancy sequence.
fn spread(i: u32, step: f64) -> f64 {
    2.0 * (f64::from(i) * step).fract() - 1.0
}

/// The origin some 5 sizes away, the target near the shape; every fifth line is along an axis.
fn line(i: u32, size: f64) -> (DVec3, DVec3) {
    let target = DVec3::new(spread(i, 0.7549), spread(i, 0.5698), spread(i, 0.3247))
        * if i.is_multiple_of(3) { 0.3 } else { 1.45 };
    let away = match i % 5 {
        0 => DVec3::AXES[(i / 5 % 3) as usize] * if i.is_multiple_of(2) { 5.0 } else { -5.0 },
        _ => DVec3::new(spread(i, 0.618), spread(i, 0.414), spread(i, 0.732)).normalize() * 5.0,
    };
    ((target + away) * size, away * -2.0 * size * (1.5 + spread(i, 0.236)))
}

/// Both ends are where the casts of a point from either side meet the shape, and a chord is there exactly where they do.
#[test]
fn chords_end_where_casts_do() {
    let point = Points::new(&[DVec3::ZERO]).unwrap();
    for size in [1.0, 1e-40, 1e40] {
        for (which, (support, chord)) in shapes(size).iter().enumerate() {
            let (mut hits, mut untold, mut worst) = (0, 0, 0.0);
            for i in 0..1000 {
                let (origin, direction) = line(i, size);
                let Some(found) = chord(&Line::new(origin, direction).unwrap()) else {
                    untold += 1;
                    continue;
                };
                let length = direction.length() / size;
                let far = origin + direction * (16.0 / length);
                let from = |origin: DVec3, direction: DVec3| {
                    let at = DAffine3::from_translation(origin);
                    gjk::cast(&point, &at, direction, &**support, &DAffine3::IDENTITY, f64::INFINITY)
                };
                let (enter, leave) = (from(origin, direction), from(far, -direction));
                let Some(found) = found else {
                    // A chord whose length is rounding may be lost.
                    let length = |enter: crate::Impact| {
                        16.0 - (enter.time + leave.map_or(0.0, |leave| leave.time)) * length
                    };
                    assert!(
                        enter.is_none_or(|enter| length(enter) < 1e-5),
                        "{which} {i}: {enter:?} {leave:?}"
                    );
                    continue;
                };
                hits += 1;
                let (enter, leave) = (enter.unwrap(), leave.unwrap());
                // Where the line grazes, times are sensitive as square roots are.
                let slope = |normal: DVec3| (normal.dot(direction).abs() / direction.length()).max(1e-6);
                let errors = [
                    (found.enter.t - enter.time).abs() * slope(found.enter.normal),
                    (found.leave.t - (16.0 / length - leave.time)).abs() * slope(found.leave.normal),
                ];
                worst = errors.iter().fold(worst, |worst: f64, error| worst.max(error * length));
                for end in [found.enter, found.leave] {
                    assert!((end.normal.length() - 1.0).abs() < 1e-12);
                    let at = origin + direction * end.t;
                    let beyond = end.normal.dot(support.support(end.normal) - at) / size;
                    assert!(beyond.abs() < 1e-11, "{which} {i}: the normal {} supports {beyond}", end.normal);
                }
            }
            println!("shape {which}: {hits} of 1000, {untold} untold, worst error {worst:e}");
            assert_eq!(untold, 0, "{which}");
            assert!(worst < gjk::CAST_ERROR, "{which}: {worst:e}");
            let thin = which == 5;
            assert!((if thin { 20 } else { 300 }..=720).contains(&hits), "{which}: {hits} of 1000");
        }
    }
}

/// Cones slim down to 1e-12, or flat: a line through a point inside has a chord, that point is on it, both its ends are on the cone, and it
/// comes in from outside.
#[test]
fn chords_of_flat_cones_end_on_them() {
    for power in 0..=90 {
        for (radius, height) in [(1.0, 0.1f64.powi(power)), (0.1f64.powi(power.min(12)), 1.0)] {
            let cone = Cone::new(radius, height).unwrap();
            for i in 0..500 {
                let part = |step: f64| 0.5 + 0.5 * spread(i, step);
                let (share, turn) = (part(0.7549), 6.0 * part(0.5698));
                let across = DVec3::new(turn.cos(), 0.0, turn.sin()) * radius * share * 0.9 * part(0.3247);
                let inside = across + DVec3::Y * height * (0.5 - share);
                let away = DVec3::new(spread(i, 0.618), spread(i, 0.414), spread(i, 0.732)).normalize();
                let chord = cone.chord(&Line::new(inside - away, away).unwrap()).unwrap();
                let context = || format!("{radius:e} {height:e}, {i}: {chord:?}");
                assert!(chord.enter.t <= 1.0 + 1e-15 && 1.0 - 1e-15 <= chord.leave.t, "{}", context());
                let (enter, leave) = (chord.enter.normal.dot(away), chord.leave.normal.dot(away));
                assert!(enter <= 0.0 && leave >= 0.0 || chord.enter == chord.leave, "{}", context());
                for t in [chord.enter.t, chord.leave.t] {
                    let end = inside + away * (t - 1.0);
                    let below = 0.5 - end.y / height;
                    let error = 1e-15 * (1.0 + 1.0 / height);
                    assert!((-error..=1.0 + error).contains(&below), "{}", context());
                    let off = DVec3::new(end.x, 0.0, end.z).length() - radius * below;
                    assert!(off <= radius * error + 1e-15, "{}: {off:e} off", context());
                }
            }
        }
    }
}

#[test]
fn special_lines() {
    let through = |shape: &dyn Fn(&Line) -> Option<Chord>, origin: DVec3, direction: DVec3| {
        shape(&Line::new(origin, direction).unwrap()).map(|chord| (chord.enter.t, chord.leave.t))
    };
    let cone = Cone::new(1.0, 2.0).unwrap();
    let cone = |line: &Line| cone.chord(line);
    // Down the axis, through the apex, and across at the base.
    assert_eq!(through(&cone, DVec3::Y * 3.0, DVec3::NEG_Y), Some((2.0, 4.0)));
    assert_eq!(through(&cone, DVec3::Y * -3.0, DVec3::Y), Some((2.0, 4.0)));
    assert_eq!(through(&cone, DVec3::new(-3.0, -1.0, 0.0), DVec3::X), Some((2.0, 4.0)));
    // In the half above the apex there is nothing.
    assert_eq!(through(&cone, DVec3::new(-3.0, 1.5, 0.0), DVec3::X), None);
    // Parallel to a side: from the other side to the base, at its rim, and beyond it.
    let slanted = |x: f64| through(&cone, DVec3::new(x, 2.0, 0.0), DVec3::new(1.0, -2.0, 0.0));
    for (x, expected) in [(-1.0, 0.75), (-1.5, 1.0)] {
        let (enter, leave) = slanted(x).unwrap();
        assert!((enter - expected).abs() < 1e-15 && (leave - 1.5).abs() < 1e-15, "{enter} {leave}");
    }
    assert_eq!(slanted(-2.6), None);
    // In the half above the apex, and beside the side in the plane that touches it, there is nothing, whichever way they run.
    for (origin, direction) in [
        (DVec3::new(2.0, 2.0, 0.0), DVec3::new(1.0, -2.0, 0.0)),
        (DVec3::new(0.0, 1.0, 0.25), DVec3::new(1.0, -2.0, 0.0)),
    ] {
        assert_eq!([direction, -direction].map(|direction| through(&cone, origin, direction)), [None; 2]);
    }
    let block = Cuboid::new(DVec3::splat(2.0)).unwrap();
    let block = |line: &Line| block.chord(line);
    // Along a face, and beside it.
    assert_eq!(through(&block, DVec3::new(-3.0, 1.0, 0.0), DVec3::X), Some((2.0, 4.0)));
    assert_eq!(through(&block, DVec3::new(-3.0, 1.0 + 1e-15, 0.0), DVec3::X), None);
    // From far away, with a direction of any length.
    let ball = Sphere::new(1.0).unwrap();
    let ball = |line: &Line| ball.chord(line);
    let (enter, leave) = through(&ball, DVec3::X * -1e9, DVec3::X * 1e-80).unwrap();
    assert!((enter * 1e-80 - (1e9 - 1.0)).abs() < 1e-6 && (leave * 1e-80 - (1e9 + 1.0)).abs() < 1e-6);
    assert_eq!(Line::new(DVec3::ZERO, DVec3::NAN), None);
    assert_eq!(Line::new(DVec3::INFINITY, DVec3::X), None);
}

/// Where the side of a capsule meets its ends, also where a line only touches it there, the normal is that of the side.
#[test]
fn normals_at_the_seams_of_a_capsule() {
    let capsule = Capsule::new(2.0, 4.0).unwrap();
    let chord =
        |origin: DVec3, direction: DVec3| capsule.chord(&Line::new(origin, direction).unwrap()).unwrap();
    for axis in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
        for down in [DVec3::Y, DVec3::NEG_Y] {
            let along_side = chord(axis * 2.0 - down * 7.0, down);
            assert_eq!([along_side.enter.normal, along_side.leave.normal], [axis; 2], "{axis} {down}");
            let normal = chord(axis * 5.0 - down * 8.0, down * 2.0 - axis).enter.normal;
            assert!((normal - axis).length() < 1e-14, "{axis} {down}: {normal}");
        }
    }
}

/// Where a line touches the rim of a cone's base the normal is that of the place, up to the rounding of where that is.
#[test]
fn normals_at_the_rim_of_a_cone() {
    let cone = Cone::new(3.0, 4.0).unwrap();
    for (origin, direction) in [
        (DVec3::new(-3.0, -2.0, -4.5), DVec3::Z),
        (DVec3::new(3.0, -2.0, 1.5), DVec3::NEG_Z),
        (DVec3::new(0.0, -2.0, 3.0), DVec3::X),
        (DVec3::new(-3.0 + 1e-15, -2.0, -4.5), DVec3::Z),
        (DVec3::new(3.0 - 1e-15, -2.0, 4.5), DVec3::NEG_Z),
    ] {
        let outward = origin.reject_from_normalized(direction).with_y(0.0).normalize();
        let chord = cone.chord(&Line::new(origin, direction).unwrap()).unwrap();
        for normal in [chord.enter.normal, chord.leave.normal] {
            let expected = outward * 0.8 + DVec3::Y * 0.6;
            assert!((normal - expected).length() < 1e-6, "{origin} {direction}: {normal}");
        }
    }
}

/// A line in a plane that touches a cone, parallel to its side there but beside it, meets nothing, though rounding may tilt it a little.
#[test]
fn lines_beside_the_side_of_a_cone_miss() {
    for (radius, height) in [(2.0, 2.0), (1.0, 2.0), (3.0, 1.0), (0.7, 1.9), (1e-3, 1.0), (1.0, 1e-6)] {
        let cone = Cone::new(radius, height).unwrap();
        for i in 0..10_000 {
            let turn = if i % 2 == 0 { 0.0 } else { 3.0 * spread(i, 0.7549) };
            let (sin, cos) = turn.sin_cos();
            let side = DVec3::new(cos * radius, -height, sin * radius);
            let beside = DVec3::new(-sin, 0.0, cos) * radius * (0.6 + 0.35 * spread(i, 0.5698));
            let origin = DVec3::Y * 0.5 * height + side * 1.5 * spread(i, 0.3247) + beside;
            let direction = side * if i % 3 == 0 { 1.0 } else { 1.5 + spread(i, 0.618) };
            let chord = cone.chord(&Line::new(origin, direction).unwrap());
            assert_eq!(chord, None, "{radius} {height}, {i}");
        }
    }
}

/// Law: a line comes in where it runs against the normal and goes out where it runs along it, next to an apex too, where no digits are left of that.
#[test]
fn normals_next_to_an_apex_face_the_line() {
    let mut hits = 0;
    for (radius, height) in [(2.0, 2.0), (1.0, 2.0), (3.0, 0.1), (1e-3, 1.0)] {
        let cone = Cone::new(radius, height).unwrap();
        for i in 0..10_000 {
            let direction = DVec3::new(spread(i, 0.618), spread(i, 0.414), spread(i, 0.732)).normalize();
            let aside = DVec3::new(spread(i, 0.7549), spread(i, 0.5698), spread(i, 0.3247));
            let target = DVec3::Y * 0.5 * height + aside * 0.1f64.powi(3 + i as i32 % 18);
            let Some(Chord { enter, leave }) =
                cone.chord(&Line::new(target - direction * 3.0, direction).unwrap())
            else {
                continue;
            };
            hits += 1;
            assert!(enter.normal.is_normalized() && leave.normal.is_normalized(), "{radius} {height}, {i}");
            assert!(enter.normal.dot(direction) < 1e-8, "{radius} {height}, {i}: {enter:?}");
            assert!(leave.normal.dot(direction) > -1e-8, "{radius} {height}, {i}: {leave:?}");
        }
    }
    assert!(hits > 10_000, "{hits}");
}

/// What is next to nothing beside its length is as wide as it is.
#[test]
fn slim_shapes_are_met_at_their_sides() {
    for radius in [1e-50, 1e-70, 1e-90, 1e-99] {
        let line = Line::new(DVec3::new(-3.0 * radius, 0.0, 0.0), DVec3::X * radius).unwrap();
        let chords = [
            (Cylinder::new(radius, 2.0).unwrap().chord(&line), 1.0),
            (Capsule::new(radius, 2.0).unwrap().chord(&line), 1.0),
            (Cone::new(radius, 2.0).unwrap().chord(&line), 0.5),
        ];
        for (which, (chord, width)) in chords.into_iter().enumerate() {
            let Chord { enter, leave } = chord.unwrap();
            let off = (enter.t - (3.0 - width)).abs().max((leave.t - (3.0 + width)).abs());
            assert!(off < 1e-12, "{which} of {radius:e}: {enter:?}, {leave:?}");
            let turned = enter.normal.distance(DVec3::NEG_X).max(leave.normal.distance(DVec3::X));
            assert!(turned < 1e-12, "{which} of {radius:e}: {enter:?}, {leave:?}");
        }
        let beside = Line::new(DVec3::new(-3.0, 0.0, 1.01) * radius, DVec3::X * radius).unwrap();
        assert_eq!(Cylinder::new(radius, 2.0).unwrap().chord(&beside), None, "{radius:e}");
    }
}

/// A face without a plane leaves open where a line meets the hull.
#[test]
fn a_face_without_a_plane_tells_nothing() {
    let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    let line = Line::new(DVec3::new(0.25, 0.25, -1.0), DVec3::Z).unwrap();
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    assert!(corner.clone().with_faces(&faces).chord(&line).is_some());
    let with_none = corner.with_faces(&[&faces[..3], &[[1, 1, 3]]].concat());
    assert!(with_none.chord(&line).is_none() && with_none.face_towards(DVec3::ZERO).is_none());
}
