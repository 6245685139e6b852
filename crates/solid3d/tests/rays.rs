//! Rays against every kind of shape under every kind of placement: by laws, and against slow twins.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use common::{
    assert_rate, bumpy_sphere, cube, direction, globe, in_cube, joined, placement, random_complex,
    random_mesh, shape_of, torus, voxels,
};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid3d::query::{self, Faces, FromInside, Ray, RayHit, RayOptions};
use solid3d::{Aabb, Error, Shape, ShapeKind, glam};

const PASSES: RayOptions = RayOptions { faces: Faces::Both, from_inside: FromInside::Passes };
const BY_DEFAULT: RayOptions = RayOptions { faces: Faces::Both, from_inside: FromInside::Hits };

/// A shape of about unit size.
fn some_shape(rng: &mut StdRng, case: u32) -> Shape {
    match case % 4 {
        0 => random_mesh(rng, 60).shape(),
        1 => random_complex(rng, 60).shape(),
        _ => shape_of(&random_shape(rng, 1.0)),
    }
}

/// A ray through the box of what is placed, somewhere: it has a fair chance to hit.
fn some_ray(rng: &mut StdRng, shape: &Shape, at: &DAffine3) -> Ray {
    let bounds = query::bounds(shape, at).unwrap();
    let target = bounds.center() + in_cube(rng) * bounds.half_extents() * 0.9;
    let from = target + direction(rng) * bounds.half_extents().max_element() * rng.random_range(0.1..4.0);
    Ray::new(from, (target - from) * 10f64.powi(rng.random_range(-3..3)))
}

/// Whether a ray runs through a convex shape for less than a part of 1e-5 of the size of the data. What is round then reaches beyond the ray by some 1e-11 of
/// that size, as the square of the part, and rounding of a few times 1e-12 may decide whether it is met; so it may at an edge, and at a hull that is flat or a point.
fn grazes(shape: &Shape, at: &DAffine3, ray: &Ray) -> bool {
    let ends: Vec<f64> =
        query::cast_ray_all(shape, at, ray, &PASSES).unwrap().iter().map(|hit| hit.t).collect();
    let part = match ends[..] {
        [leave] => leave,
        [enter, leave] => leave - enter,
        _ => return false,
    };
    let extent = query::bounds(shape, at).unwrap().half_extents().max_element();
    let size = extent + (at.translation - ray.origin).length();
    shape.kind() != ShapeKind::Complex && part * ray.direction.length() < 1e-5 * size
}

/// A segment is a shape too: a ray hits if and only if they intersect, and first where they first do.
#[test]
fn a_ray_hits_if_and_only_if_its_segment_intersects() {
    let seed = 91;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let mut by_kind = [[0u32; 2]; ShapeKind::ALL.len()];
    for case in 0..4000 {
        let size = 10f64.powi(rng.random_range(-6..7));
        let shape = some_shape(&mut rng, case);
        let mut at = placement(&mut rng, 1.0);
        at = DAffine3::from_scale(DVec3::splat(size)) * at;
        let ray = some_ray(&mut rng, &shape, &at);
        let ray = ray.until(6.0 * size / ray.direction.length());
        let segment = |max: f64| Shape::convex_hull(&[ray.origin, ray.at(max)]).unwrap();
        let here = DAffine3::IDENTITY;
        let meets = query::intersects(&shape, &at, &segment(ray.max), &here).unwrap();
        let hit = query::cast_ray(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        let context = || format!("case {case}: {} {at:?} {ray:?} {hit:?}", shape.kind());
        // What is decided by rounding: the shape nearly touches the segment.
        let extent = size + (ray.at(ray.max) - ray.origin).length();
        if hit.is_some() != meets {
            let gap = query::distance(&shape, &at, &segment(ray.max), &here).unwrap().distance;
            assert!(gap < 1e-10 * extent, "{}: {meets}, {gap}", context());
            continue;
        }
        assert_eq!(query::ray_meets(&shape, &at, &ray, &BY_DEFAULT).unwrap(), meets, "{}", context());
        let all = query::cast_ray_all(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        assert_eq!(all.first(), hit.as_ref(), "{}", context());
        assert!(all.iter().all(|hit| (0.0..=ray.max).contains(&hit.t)));
        let kind = ShapeKind::ALL.iter().position(|kind| *kind == shape.kind()).unwrap();
        by_kind[kind][usize::from(meets)] += 1;
        let Some(hit) = hit else { continue };
        for hit in &all {
            let point = Shape::convex_hull(&[hit.point]).unwrap();
            let off = query::distance(&shape, &at, &point, &here).unwrap().distance;
            assert!(off < 1e-9 * extent, "{}: {off}", context());
            if let Some(surface) = hit.surface {
                assert!((surface.normal.length() - 1.0).abs() < 1e-12, "{}", context());
                let facing = surface.normal.dot(ray.direction) / ray.direction.length();
                assert!(facing < 1e-6, "{}: {facing}", context());
            }
        }
        // Nothing is met before.
        let before = hit.t - 1e-6 * extent / ray.direction.length();
        if before > 0.0 {
            let early = query::distance(&shape, &at, &segment(before), &here).unwrap().distance;
            let grazes = hit
                .surface
                .is_some_and(|s| s.normal.dot(ray.direction).abs() < 1e-2 * ray.direction.length());
            assert!(early > 0.0 || grazes, "{}: met before {before}", context());
        }
    }
    for (kind, [misses, hits]) in ShapeKind::ALL.iter().zip(by_kind) {
        println!("{kind}: {hits} hits, {misses} misses");
        let rate = f64::from(hits) / f64::from(hits + misses);
        assert!((0.1..=0.85).contains(&rate), "{kind}: {rate}");
    }
    let hits: u32 = by_kind.iter().map(|[_, hits]| hits).sum();
    let rate = f64::from(hits) / by_kind.as_flattened().iter().sum::<u32>() as f64;
    println!("{hits} hits in all");
    assert!((0.3..=0.7).contains(&rate), "{rate}");
}

/// Far off, rounding would have a ray leave what is flat before it comes there, or pass it.
#[test]
fn what_is_flat_is_entered_before_it_is_left() {
    let mut rng = seeded(93);
    let (mut hits, cases) = (0, 4000);
    for case in 0..cases {
        let corners = [(); 3].map(|()| in_cube(&mut rng));
        let shape = Shape::convex_hull(&corners).unwrap();
        let mut at = placement(&mut rng, 1.0);
        at.translation += 1e3 * in_cube(&mut rng);
        // Half of the parallelogram is the triangle.
        let [p, q, r] = corners.map(|corner| at.transform_point3(corner));
        let (along_q, along_r) = (rng.random::<f64>(), rng.random::<f64>());
        let target = p + (q - p) * along_q + (r - p) * along_r;
        let from = target + direction(&mut rng);
        let ray = Ray::new(from, target - from);
        let hit = query::cast_ray(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        let all = query::cast_ray_all(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        assert_eq!(all.first(), hit.as_ref(), "case {case}: {all:?}");
        let (is_hit, beyond) = (hit.is_some(), along_q + along_r - 1.0);
        assert!(is_hit == (beyond < 0.0) || beyond.abs() < 1e-9, "case {case}: {is_hit}, {beyond}");
        hits += usize::from(is_hit);
    }
    assert_rate("rays", hits, cases);
}

/// Law: no hit is before the ray, where it starts hardly inside, nor at a negative zero, which would come before zero: where the ray starts on what it
/// grazes, the first of all hits is the first hit still.
#[test]
fn no_hit_is_at_a_negative_zero() {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let shapes = [
        Shape::sphere(1.0).unwrap(),
        Shape::cuboid([2.0, 2.0, 2.0]).unwrap(),
        Shape::cone(1.0, 2.0).unwrap(),
        Shape::cylinder(1.0, 2.0).unwrap(),
        Shape::capsule(1.0, 2.0).unwrap(),
        Shape::convex_hull(&corners).unwrap(),
        cube(1.0).shape(),
    ];
    let (here, steps) = (DAffine3::IDENTITY, [-1.0, -0.0, 0.0, 1.0]);
    let places = steps.map(|x| steps.map(|y| steps.map(|z| DVec3::new(x, y, z))));
    let places = || places.iter().flatten().flatten().copied();
    let starts = || places().chain(places().map(|place| place * (1.0 - 1e-10)));
    let mut at_once = 0;
    for shape in &shapes {
        for (from, way) in starts().flat_map(|from| places().map(move |way| (from, way))) {
            for options in [BY_DEFAULT, PASSES] {
                if way == DVec3::ZERO {
                    continue;
                }
                let ray = Ray::new(from, way);
                let all = query::cast_ray_all(shape, &here, &ray, &options).unwrap();
                let first = query::cast_ray(shape, &here, &ray, &options).unwrap();
                let context = || format!("{} {ray:?}: {first:?} {all:?}", shape.kind());
                assert!(all.iter().chain(&first).all(|hit| hit.t.is_sign_positive()), "{}", context());
                assert_eq!(first, all.first().copied(), "{}", context());
                at_once += usize::from(first.is_some_and(|hit| hit.t == 0.0));
            }
        }
    }
    assert!(at_once > 1000, "{at_once}");
}

/// Scaling by a power of two changes no bit, also far beyond the sizes at which a placement is plain.
#[test]
fn a_power_of_two_changes_no_hit() {
    let seed = 97;
    println!("seed {seed}");
    let rng = &mut seeded(seed);
    let mut met = 0_usize;
    let cases = 2_000;
    for case in 0..cases {
        let shape = some_shape(rng, case);
        // Turned and scaled alike, as balls and hulls have a closed form of their own, or anything.
        let at = if case % 8 < 4 {
            let turn = DQuat::from_axis_angle(direction(rng), rng.random_range(0.0..6.0));
            let scale = DVec3::splat(rng.random_range(0.1..10.0));
            DAffine3::from_scale_rotation_translation(scale, turn, in_cube(rng))
        } else {
            placement(rng, 3.0)
        };
        let ray = some_ray(rng, &shape, &at);
        let hits = |scale: f64| {
            let placed = DAffine3 { matrix3: at.matrix3 * scale, translation: at.translation * scale };
            let ray = Ray::new(ray.origin * scale, ray.direction * scale);
            let mut hits = query::cast_ray_all(&shape, &placed, &ray, &PASSES).unwrap();
            assert_eq!(
                query::cast_ray(&shape, &placed, &ray, &PASSES).unwrap().as_ref(),
                hits.first(),
                "case {case}"
            );
            hits.iter_mut().for_each(|hit| hit.point /= scale);
            hits
        };
        let expected = hits(1.0);
        met += usize::from(!expected.is_empty());
        for power in [-240, -120, -40, 1, 40, 120, 240] {
            assert_eq!(
                hits(2f64.powi(power)),
                expected,
                "case {case} times 2^{power}: {shape:?} at {at}, {ray:?}"
            );
        }
    }
    assert_rate("scaled", met, cases as usize);
}

/// Where the ray of local space meets the shape, that of the world meets it, at the same `t`.
#[test]
fn a_placement_takes_hits_along() {
    let mut rng = seeded(92);
    let (mut hits, cases) = (0, 3000);
    for case in 0..cases {
        let shape = some_shape(&mut rng, case);
        let at = placement(&mut rng, 3.0);
        let local = some_ray(&mut rng, &shape, &DAffine3::IDENTITY);
        let world = Ray {
            origin: at.transform_point3(local.origin),
            direction: at.transform_vector3(local.direction),
            ..local
        };
        let in_local = query::cast_ray(&shape, &DAffine3::IDENTITY, &local, &PASSES).unwrap();
        let in_world = query::cast_ray(&shape, &at, &world, &PASSES).unwrap();
        let (Some(x), Some(y)) = (in_local, in_world) else {
            let one_alone = in_local.map(|_| (DAffine3::IDENTITY, local)).or(in_world.map(|_| (at, world)));
            let grazed = one_alone.is_none_or(|(at, ray)| grazes(&shape, &at, &ray));
            assert!(grazed, "case {case}: {in_local:?} {in_world:?}");
            continue;
        };
        hits += 1;
        let (on_x, on_y) = (x.surface.unwrap(), y.surface.unwrap());
        let slope = on_x.normal.dot(local.direction).abs() / local.direction.length();
        assert!((x.t - y.t).abs() * local.direction.length() * slope < 1e-9, "case {case}: {x:?} {y:?}");
        assert_eq!((on_x.back, on_x.primitive), (on_y.back, on_y.primitive), "case {case}");
        // The tangent plane is taken along: two of its vectors stay across the normal.
        let tangents =
            [on_x.normal.any_orthonormal_vector(), on_x.normal.cross(on_x.normal.any_orthonormal_vector())];
        for tangent in tangents.map(|tangent| at.transform_vector3(tangent).normalize()) {
            assert!(tangent.dot(on_y.normal).abs() < 1e-5, "case {case}: {on_x:?} {on_y:?}");
        }
    }
    println!("{hits} of {cases} hit");
    assert!((0.3..=0.8).contains(&(f64::from(hits) / f64::from(cases))));
}

/// What a placement turns and scales alike has a way of its own, and is hit as what is skewed by so little that nothing shows it, but the way that it takes.
#[test]
fn what_is_turned_is_hit_as_what_is_skewed_a_little() {
    let mut rng = seeded(94);
    let (mut hits, mut backs, cases) = (0, 0, 6000);
    for case in 0..cases {
        let shape = shape_of(&random_shape(&mut rng, 1.0));
        let size = 10f64.powi(rng.random_range(-6..7)) * [1.0, -1.0][rng.random_range(0..2)];
        let turn = DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.0..3.1));
        let to = in_cube(&mut rng) * 10.0 * size;
        let at = DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn, to);
        let skew = DMat3::from_cols(DVec3::X, DVec3::new(1e-12, 1.0, 0.0), DVec3::Z);
        let skewed = DAffine3 { matrix3: at.matrix3 * skew, ..at };
        let ray = some_ray(&mut rng, &shape, &at);
        let options = RayOptions {
            faces: [Faces::Both, Faces::Front, Faces::Back][rng.random_range(0..3)],
            from_inside: [FromInside::Hits, FromInside::Passes][rng.random_range(0..2)],
        };
        let [x, y] = [&at, &skewed].map(|at| query::cast_ray(&shape, at, &ray, &options).unwrap());
        let all = query::cast_ray_all(&shape, &at, &ray, &options).unwrap();
        assert_eq!(
            (x.as_ref(), x.is_some()),
            (all.first(), query::ray_meets(&shape, &at, &ray, &options).unwrap())
        );
        let (Some(x), Some(y)) = (x, y) else {
            let one_alone = x.map(|_| &at).or(y.map(|_| &skewed));
            let grazed = one_alone.is_none_or(|at| grazes(&shape, at, &ray));
            assert!(grazed, "case {case}: {shape:?} at {at:?}, {ray:?}: {x:?} {y:?}");
            continue;
        };
        let slope = x.surface.map_or(1.0, |on| on.normal.dot(ray.direction.normalize()).abs());
        let apart = (x.point - y.point).length() / size.abs();
        assert!(apart * slope < 1e-9, "case {case}: {x:?} {y:?}");
        let back = |hit: &RayHit| hit.surface.map(|on| on.back);
        assert_eq!(back(&x), back(&y), "case {case}");
        hits += 1;
        backs += usize::from(back(&x) == Some(true));
    }
    println!("{hits} of {cases} hit, {backs} from the back");
    assert!(hits > 3 * cases / 10 && backs > cases / 20);
}

/// Law: a placement that makes a needle, or what is flat, as long as wide takes hits along, whatever its own extents: rays hit it where they hit what has
/// that size itself.
#[test]
fn what_a_placement_makes_even_is_hit_as_what_is_even() {
    let mut rng = seeded(96);
    let even = |width: f64, height: f64| {
        let corners = [DVec3::NEG_X, DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.3, -0.8, -0.9)]
            .map(|corner| corner * DVec3::new(width, height, width));
        let faces = [[0, 2, 3], [2, 1, 3], [0, 4, 2], [4, 1, 2], [3, 1, 4], [0, 3, 4]];
        [
            ("cylinder", Shape::cylinder(width, height).unwrap()),
            ("cone", Shape::cone(width, height).unwrap()),
            ("cuboid", Shape::cuboid([width, height, width]).unwrap()),
            ("hull", Shape::convex_hull(&corners).unwrap()),
            ("mesh", Shape::mesh(corners, faces).unwrap()),
        ]
    };
    let (mut hits, mut cases) = (0, 0);
    for power in (0..100).step_by(9) {
        for (width, height) in [(-power, power), (power, -power)].map(|(w, h)| (10f64.powi(w), 10f64.powi(h)))
        {
            let stretch = DVec3::new(1.0 / width, 1.0 / height, 1.0 / width);
            for ((name, shape), (_, plain)) in even(width, height).iter().zip(even(1.0, 1.0)) {
                for case in 0..60 {
                    // Beside it, or all around it.
                    let to = in_cube(&mut rng) * if case % 2 == 0 { 3.0 } else { 3e3 };
                    let here = DAffine3::from_translation(to);
                    let at = DAffine3 { translation: to, ..DAffine3::from_scale(stretch) };
                    let from = to + direction(&mut rng) * 4.0;
                    let target = if case % 4 < 3 { to + in_cube(&mut rng) } else { in_cube(&mut rng) };
                    let ray = Ray::segment(from, target + (target - from));
                    let [x, y] = [(&plain, &here), (shape, &at)]
                        .map(|(shape, at)| query::cast_ray(shape, at, &ray, &PASSES).unwrap());
                    let context = || format!("{name}, {width:e} by {height:e}, case {case}: {x:?} {y:?}");
                    assert_eq!(x.is_some(), y.is_some(), "{}", context());
                    cases += 1;
                    let (Some(x), Some(y)) = (x, y) else { continue };
                    hits += 1;
                    let slope = x.surface.unwrap().normal.dot(ray.direction.normalize()).abs();
                    let apart = (x.point - y.point).length();
                    assert!(apart * slope < 1e-9, "{}", context());
                }
            }
        }
    }
    assert_rate("rays", hits, cases);
}

/// Law: a normal is on the side that the ray comes from. The sides of a needle are told by signs, but its normal is a rounded product, which may be any
/// across the needle.
#[test]
fn the_normal_of_a_needle_is_on_the_side_that_the_ray_comes_from() {
    let mut rng = seeded(75);
    let (mut hits, cases) = (0, 40_000);
    for case in 0..cases {
        let (from, along) = (in_cube(&mut rng), direction(&mut rng));
        let mut corner = || {
            let on_line = from + along * rng.random_range(-4.0..4.0);
            on_line + 10f64.powi(-rng.random_range(15..18)) * in_cube(&mut rng)
        };
        let corners: Vec<DVec3> = (0..18).map(|_| corner()).collect();
        let needles: Vec<[u32; 3]> = (0..6).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let to = corners[rng.random_range(0..18)];
        let needles = Shape::mesh(corners, needles).unwrap();
        let way = direction(&mut rng);
        let ray = Ray::new(to - way * f64::from(case % 2), way);
        let hit = query::cast_ray(&needles, &DAffine3::IDENTITY, &ray, &RayOptions::default()).unwrap();
        let Some(hit) = hit else { continue };
        hits += 1;
        assert!(hit.surface.unwrap().normal.dot(way) <= 1e-15, "case {case}: {hit:?}");
    }
    println!("{hits} of {cases} hit");
    assert!(hits > cases / 20);
}

/// Rays to the tip of a cone, where rounding decides on which side of the axis they meet it.
#[test]
fn the_normal_at_a_tip_is_on_the_side_that_the_ray_comes_from() {
    let mut rng = seeded(76);
    let options = RayOptions { from_inside: FromInside::Passes, ..BY_DEFAULT };
    let (mut hits, mut backs, cases) = (0, 0, 40_000);
    for case in 0..cases {
        let [radius, height] = std::array::from_fn(|_| rng.random_range(0.05..1.0));
        let cone = Shape::cone(radius, height).unwrap();
        let at = if case % 2 == 0 { DAffine3::IDENTITY } else { placement(&mut rng, 1.0) };
        let (tip, way) = (at.transform_point3(DVec3::Y * height * 0.5), direction(&mut rng));
        let from = if case % 5 == 0 { 0.0 } else { rng.random_range(0.0..2.0) };
        let ray = Ray::new(tip - way * from, way);
        let found = query::cast_ray_all(&cone, &at, &ray, &options).unwrap();
        hits += usize::from(!found.is_empty());
        for surface in found.iter().filter_map(|hit| hit.surface) {
            backs += usize::from(surface.back);
            let along = surface.normal.dot(way);
            assert!(along <= 1e-8 && surface.normal.is_normalized(), "case {case}: {along:e}, {found:?}");
        }
    }
    println!("{hits} of {cases} hit, {backs} from behind");
    assert!(hits > cases / 4 && backs > cases / 10);
}

/// From so far off that rounding leaves few digits of where a ray meets a shape, normals are unit vectors still.
#[test]
fn normals_are_unit_vectors_from_any_distance() {
    let mut rng = seeded(95);
    let capsule = Shape::capsule(0.4, 1.0).unwrap();
    let length = |shape: &Shape, at: DVec3, ray: &Ray| {
        let hit = query::cast_ray(shape, &DAffine3::from_translation(at), ray, &BY_DEFAULT).unwrap();
        Some(hit?.surface?.normal.length())
    };
    let from = DVec3::new(-0.939785283202279, -0.7526486304935327, 0.0);
    let way = DVec3::new(1e51, 0.6098951083457971, -1.331127453611705);
    let found = length(&capsule, DVec3::new(1e30, -0.22980058601357012, 1e-8), &Ray::new(from, way));
    assert!(found.is_none_or(|length| (length - 1.0).abs() < 1e-12), "{found:?}");
    let mut hits = 0;
    for case in 0..6000 {
        let shape = shape_of(&random_shape(&mut rng, 1.0));
        let away = direction(&mut rng) * 10f64.powi(case % 60);
        let ray = Ray::new(away + in_cube(&mut rng), in_cube(&mut rng) - away);
        let Some(length) = length(&shape, DVec3::ZERO, &ray) else { continue };
        hits += 1;
        assert!((length - 1.0).abs() < 1e-12, "case {case}: {length}");
    }
    assert!(hits > 1000, "{hits}");
}

/// All triangles one by one, in the world.
#[test]
fn meshes_agree_with_brute_force() {
    let seed = 93;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, mut cases) = (0, 0);
    for _ in 0..60 {
        let soup = random_mesh(&mut rng, 400);
        let (shape, at) = (soup.shape(), placement(&mut rng, 2.0));
        let placed = soup.placed(&at);
        for _ in 0..100 {
            let ray = some_ray(&mut rng, &shape, &at);
            let mut expected: Vec<(f64, u32)> = Vec::new();
            let mut doubtful = false;
            for (primitive, corners) in (0u32..).zip(soup.triangles()) {
                let [a, b, c] = corners.map(|i| placed[i as usize] - ray.origin);
                let normal = (b - a).cross(c - a);
                let along = normal.dot(ray.direction);
                let shares = [b.cross(c), c.cross(a), a.cross(b)].map(|n| n.dot(ray.direction) / along);
                let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
                let t = normal.dot(a) / along;
                if least > 1e-9 && t > 0.0 {
                    expected.push((t, primitive));
                }
                let flat =
                    normal.length() < 1e-9 || along.abs() < 1e-9 * normal.length() * ray.direction.length();
                doubtful |= least.abs() <= 1e-9 || flat && normal.length() > 0.0;
            }
            if doubtful {
                continue;
            }
            cases += 1;
            expected.sort_by(|x, y| x.partial_cmp(y).unwrap());
            let all = query::cast_ray_all(&shape, &at, &ray, &PASSES).unwrap();
            let found: Vec<u32> = all.iter().map(|hit| hit.surface.unwrap().primitive).collect();
            assert_eq!(found, expected.iter().map(|&(_, primitive)| primitive).collect::<Vec<_>>());
            for (hit, (t, _)) in all.iter().zip(&expected) {
                assert!((hit.t - t).abs() <= 1e-10 * (1.0 + t), "{hit:?} {t}");
            }
            let first = query::cast_ray(&shape, &at, &ray, &PASSES).unwrap();
            assert_eq!(first.as_ref(), all.first());
            for (faces, back) in [(Faces::Front, false), (Faces::Back, true)] {
                let options = RayOptions { faces, ..PASSES };
                let some = query::cast_ray_all(&shape, &at, &ray, &options).unwrap();
                let of_side: Vec<_> =
                    all.iter().filter(|hit| hit.surface.unwrap().back == back).copied().collect();
                assert_eq!(some, of_side);
            }
            hits += usize::from(!expected.is_empty());
        }
    }
    println!("{hits} of {cases} hit");
    assert!(cases > 4000 && (0.3..=0.8).contains(&(hits as f64 / cases as f64)));
}

/// A mesh is looked at by images of its triangles, unless it was deformed: to the same positions, for the same answers, to the bit.
#[test]
fn a_deformation_to_the_same_positions_is_hit_alike() {
    let seed = 97;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, cases) = (0, 4000);
    for case in 0..cases {
        let mut soup = if case % 2 == 0 { random_mesh(&mut rng, 60) } else { torus(12, 8, 0.3) };
        let far = if case % 3 == 0 { 10f64.powi(rng.random_range(0..9)) } else { 0.0 };
        soup.vertices.iter_mut().for_each(|vertex| *vertex += far);
        let soup = soup.scaled(10f64.powi(rng.random_range(-9..9)));
        let shape = soup.shape();
        let mut deformed = shape.clone();
        deformed.deform(&soup.vertices).unwrap();
        let at = placement(&mut rng, 1.0);
        let ray = some_ray(&mut rng, &shape, &at);
        let first = query::cast_ray(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        assert_eq!(first, query::cast_ray(&deformed, &at, &ray, &BY_DEFAULT).unwrap());
        let all = query::cast_ray_all(&shape, &at, &ray, &BY_DEFAULT).unwrap();
        assert_eq!(all, query::cast_ray_all(&deformed, &at, &ray, &BY_DEFAULT).unwrap());
        let meets = query::ray_meets(&deformed, &at, &ray, &BY_DEFAULT).unwrap();
        assert_eq!(meets, query::ray_meets(&shape, &at, &ray, &BY_DEFAULT).unwrap());
        hits += usize::from(meets);
    }
    assert_rate("rays", hits, cases);
}

/// From inside of a closed mesh, every ray comes out: also at corners, along edges, and from far away after an affine map.
#[test]
fn no_ray_leaves_a_closed_mesh_unseen() {
    let mut rng = seeded(94);
    for round in 0..20 {
        let soup = bumpy_sphere(&mut rng, 12, 17);
        let mut at = placement(&mut rng, 1.0);
        at.translation *= 10f64.powi(round % 6);
        let shape = soup.shape();
        // The poles of the sphere are rings of vertices, open in between.
        let closed = soup.triangles();
        for case in 0..300 {
            let triangle = closed[rng.random_range(0..closed.len())].map(|i| soup.vertices[i as usize]);
            let target = match case % 3 {
                0 => triangle[0],
                1 => triangle[0].lerp(triangle[1], rng.random_range(0.0..1.0)),
                _ => (triangle[0] + triangle[1] + triangle[2]) / 3.0,
            };
            let origin = at.transform_point3(DVec3::ZERO);
            let ray = Ray::new(origin, at.transform_vector3(target));
            let hit = query::cast_ray(&shape, &at, &ray, &PASSES).unwrap();
            let pole = target.y.abs() > 0.95 * target.length();
            assert!(hit.is_some() || pole, "round {round}, case {case}: {ray:?}");
        }
    }
}

#[test]
fn a_solid_mesh_is_hit_from_inside() {
    let soup = torus(24, 12, 0.4);
    let (surface, here) = (soup.shape(), DAffine3::IDENTITY);
    let solid = surface.clone().into_solid().unwrap();
    let tube = soup.vertices.iter().copied().fold(DVec3::ZERO, |far, v| if v.x > far.x { v } else { far });
    let inside = Ray::new(tube * 0.75, DVec3::new(0.1, 0.9, 0.05));
    let hit = query::cast_ray(&solid, &here, &inside, &BY_DEFAULT).unwrap().unwrap();
    assert_eq!((hit.t, hit.point, hit.surface), (0.0, inside.origin, None));
    for (shape, options) in [(&surface, BY_DEFAULT), (&solid, PASSES)] {
        let hit = query::cast_ray(shape, &here, &inside, &options).unwrap().unwrap();
        assert!(hit.t > 0.0 && hit.surface.is_some());
    }
    let all = query::cast_ray_all(&solid, &here, &inside, &BY_DEFAULT).unwrap();
    assert!(all[0].surface.is_none() && all[1].surface.is_some());
    let hole = Ray::new(DVec3::ZERO, DVec3::Y);
    assert_eq!(query::cast_ray(&solid, &here, &hole, &BY_DEFAULT).unwrap(), None);
}

/// Law: a ray that starts on the surface of a solid mesh hits it there when it goes in, and when it goes out nowhere after: from corners, edges and
/// faces, under all placements and in all sizes.
#[test]
fn a_ray_that_starts_on_the_surface_of_a_solid_and_goes_in_hits_there() {
    /// In units of the solid: how long a ray is that is wholly inside or outside, and how near to its start counts as there.
    const LENGTH: f64 = 1e-3;
    const THERE: f64 = 1e-9;
    let seed = 98;
    println!("seed {seed}");
    let (mut rng, here) = (seeded(seed), DAffine3::IDENTITY);
    let (mut cases, mut inward, mut missed) = ([0; 3], [0; 3], [0; 3]);
    for round in 0..600 {
        let soup = match round % 4 {
            0 => torus(8, 6, rng.random_range(0.2..0.8)),
            1 => globe(5, 6, |v| v * rng.random_range(0.5..1.0)),
            2 => cube(0.7),
            // Some faces of one are inside of the other.
            _ => joined([cube(0.5), globe(4, 5, |v| v * rng.random_range(0.6..1.0))]),
        };
        // The torus is inside out.
        let outside = if round % 4 == 0 { Faces::Back } else { Faces::Front };
        let from_outside = RayOptions { faces: outside, ..BY_DEFAULT };
        let size = 10f64.powi(rng.random_range(-80..80));
        let mut at = placement(&mut rng, 1.0);
        at.translation *= 10f64.powi(round % 3);
        let at = DAffine3::from_scale(DVec3::splat(size)) * at;
        let solid = soup.shape().into_solid().unwrap();
        for case in 0..60 {
            let from = case % 3;
            let corners = soup.triangles()[rng.random_range(0..soup.primitives.len())];
            let [a, b, c] = corners.map(|i| soup.vertices[i as usize]);
            let [along, across] = [(); 2].map(|()| rng.random_range(0.0..1.0));
            let origin = [a, a.lerp(b, along), a.lerp(b, along).lerp(c, across)][from];
            // At a corner fewer go in than out; towards the middle more do.
            let mut way = direction(&mut rng);
            if way.dot(origin) > 0.0 && rng.random_bool(0.5) {
                way = -way;
            }
            // Clearly in or out, from its start on.
            let depth =
                |t: f64| -query::signed_distance(&solid, &here, origin + way * t).unwrap().distance / t;
            let depths = [1e-6, 1e-5, 1e-4, LENGTH].map(depth);
            let [goes_in, goes_out] = [1.0, -1.0].map(|sign| depths.iter().all(|depth| sign * depth > 0.1));
            if !goes_in && !goes_out {
                continue;
            }
            cases[from] += 1;
            let ray = Ray::new(at.transform_point3(origin), at.transform_vector3(way));
            let short = ray.until(LENGTH);
            let first = query::cast_ray(&solid, &at, &short, &BY_DEFAULT).unwrap();
            let hits_there = first.is_some_and(|hit| hit.t < THERE);
            let context = || format!("round {round}, case {case}: {at:?} {ray:?} {first:?}");
            assert_eq!(query::ray_meets(&solid, &at, &short, &BY_DEFAULT).unwrap(), first.is_some());
            let all = query::cast_ray_all(&solid, &at, &short, &BY_DEFAULT).unwrap();
            assert_eq!(all.first(), first.as_ref(), "{}", context());
            if goes_in {
                inward[from] += 1;
                let enters = query::cast_ray(&solid, &at, &short, &from_outside).unwrap();
                missed[from] += usize::from(!hits_there || enters.is_none_or(|hit| hit.t >= THERE));
                let endless = query::cast_ray(&solid, &at, &ray, &BY_DEFAULT).unwrap();
                assert!(!hits_there || endless == first, "{}: {endless:?}", context());
            } else {
                assert!(first.is_none() || hits_there, "{}", context());
            }
        }
    }
    for (i, from) in ["a corner", "an edge", "a face"].iter().enumerate() {
        println!("from {from}: of {} rays that go in {} do not hit there", inward[i], missed[i]);
        assert_rate("rays", inward[i], cases[i]);
    }
    assert_eq!(missed, [0; 3]);
}

/// On a lattice, where rays meet corners, edges and planes of a solid exactly: a ray starts inside if and only if the solid contains its origin, and
/// from within the solid's box hits if and only if its segment has a point of it. (From beyond it is moved up to the box, which rounds it.)
#[test]
fn a_ray_starts_inside_where_the_solid_contains_its_origin() {
    let (mut rng, here) = (seeded(99), DAffine3::IDENTITY);
    let (mut inside, mut outside, mut later) = (0, 0, 0);
    for _ in 0..60 {
        let (filled, soup) = voxels(&mut rng, 4);
        if filled.is_empty() {
            continue;
        }
        let solid = soup.shape().into_solid().unwrap();
        for _ in 0..200 {
            // In halves: in a cell, on a face, an edge or a corner. Directions are sheared exactly.
            let mut lattice = |range: std::ops::RangeInclusive<i32>| {
                DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(range.clone()))))
            };
            let (origin, mut way) = (lattice(-1..=9) / 2.0, lattice(-4..=4));
            if ![1.0, 2.0, 4.0].contains(&way.abs().max_element()) {
                way = DVec3::new(1.0, 0.0, -1.0);
            }
            let ray = Ray::segment(origin, origin + way);
            let contains = query::contains_point(&solid, &here, origin).unwrap();
            let hit = query::cast_ray(&solid, &here, &ray, &BY_DEFAULT).unwrap();
            let context = || format!("{filled:?} {ray:?} {hit:?}");
            let starts_inside = hit.is_some_and(|hit| hit.t == 0.0 && hit.surface.is_none());
            assert_eq!(starts_inside, contains, "{}", context());
            let segment = Shape::convex_hull(&[origin, origin + way]).unwrap();
            let meets = query::intersects(&solid, &here, &segment, &here).unwrap();
            let in_box = query::bounds(&solid, &here).unwrap().contains(&Aabb::new(origin, origin));
            assert!(hit.is_some() == meets || !in_box, "{}", context());
            inside += usize::from(contains);
            outside += usize::from(!contains);
            later += usize::from(!contains && meets);
        }
    }
    println!("{later} of {outside} that start outside hit");
    assert_rate("origins", inside, inside + outside);
    assert!(6 * later > outside && 2 * later < outside);
}

/// Wild but allowed numbers neither panic nor hang, and what comes back is a number.
#[test]
fn wild_rays_are_survived() {
    let mut rng = seeded(95);
    let wild = [0.0, -0.0, 5e-324, 1e-310, 1e-100, 1e-30, 1.0, 3.0, 1e16, 1e100, -1e100, -1.0, -1e-100];
    for case in 0..4000 {
        let shape = some_shape(&mut rng, case);
        let mut pick = || DVec3::from_array(std::array::from_fn(|_| wild[rng.random_range(0..wild.len())]));
        let scale = pick();
        let ray = Ray::new(pick(), pick());
        let at = DAffine3 { translation: pick(), ..DAffine3::from_scale(scale) };
        if let Ok(all) = query::cast_ray_all(&shape, &at, &ray, &BY_DEFAULT) {
            assert!(all.iter().all(|hit| hit.t >= 0.0), "{all:?}");
            assert!(
                all.iter().filter_map(|hit| hit.surface).all(|surface| surface.normal.is_finite()),
                "{all:?}"
            );
        }
    }
}

#[test]
fn bad_rays_are_refused_by_name() {
    let (ball, here) = (Shape::sphere(1.0).unwrap(), DAffine3::IDENTITY);
    let refused = |ray: Ray, words: &[&str]| {
        let errors = [
            query::cast_ray(&ball, &here, &ray, &BY_DEFAULT).unwrap_err(),
            query::cast_ray_all(&ball, &here, &ray, &BY_DEFAULT).unwrap_err(),
            query::ray_meets(&ball, &here, &ray, &BY_DEFAULT).unwrap_err(),
        ];
        for error in errors {
            let message = error.to_string();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
    };
    for bad in [f64::NAN, f64::INFINITY, 1.1e100] {
        let vector = DVec3::new(0.0, bad, 1.0);
        refused(Ray::new(vector, DVec3::X), &["ray.origin", "1e100"]);
        refused(Ray::new(DVec3::X, vector), &["ray.direction", "1e100"]);
    }
    for short in [0.0, 5e-324, 9e-101] {
        refused(Ray::new(DVec3::X, DVec3::splat(short)), &["ray.direction", "1e-100"]);
    }
    for bad in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        refused(Ray::new(DVec3::X, DVec3::X).until(bad), &["ray.max", "at least 0"]);
    }
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let error = query::cast_ray(&ball, &flat, &Ray::new(DVec3::X, DVec3::X), &BY_DEFAULT).unwrap_err();
    assert!(matches!(error, Error::SingularPlacement { .. }));
}
