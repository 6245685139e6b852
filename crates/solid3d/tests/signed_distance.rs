//! Signed distances of all kinds of shapes, judged by the oracle's bounds of distance and depth, and by their own laws.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking and says what it did"
)]

mod common;

use common::{
    block, direction, in_cube, joined, log_uniform, placement, random_complex, random_mesh, rescaled, torus,
};
use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_flat, random_shape, seeded};
use solid_oracle::{Convex, distance_bounds, mesh_distance, penetration_bounds, verify_axis, winding_number};
use solid3d::convex::epa::DEPTH_TOLERANCE;
use solid3d::convex::gjk::TOUCHING_ERROR;
use solid3d::query::{self, SignedDistance};
use solid3d::{Error, Shape, glam};

const SEED: u64 = 20_262;
const HERE: DAffine3 = DAffine3::IDENTITY;

fn of(shape: &Shape, at: &DAffine3, point: DVec3) -> SignedDistance {
    let found = query::signed_distance(shape, at, point).unwrap();
    assert!((found.normal.length() - 1.0).abs() < 1e-12 && found.distance.is_finite(), "{found:?}");
    found
}

/// The size of the data.
fn size_of(shape: &Shape, at: &DAffine3, point: DVec3) -> f64 {
    let bounds = query::bounds(shape, &DAffine3 { translation: DVec3::ZERO, ..*at }).unwrap();
    bounds.min.abs().max(bounds.max.abs()).max_element() + (point - at.translation).abs().max_element()
}

/// A point in or a little beside a shape, in its space.
fn point_near(rng: &mut StdRng, shape: &Convex) -> DVec3 {
    let around = |half: DVec3, rng: &mut StdRng| 1.05 * half * in_cube(rng);
    match shape {
        Convex::Sphere { radius } => around(DVec3::splat(*radius), rng),
        Convex::Cuboid { half } => around(*half, rng),
        Convex::Cone { radius, half_height } | Convex::Cylinder { radius, half_height } => {
            around(DVec3::new(0.8 * radius, *half_height, 0.8 * radius), rng)
        }
        Convex::Capsule { radius, half_height } => {
            around(DVec3::new(*radius, radius + half_height, *radius), rng)
        }
        Convex::Hull { points } => {
            // Between random points of it, or beyond.
            let mut pick = || points[rng.random_range(0..points.len())];
            let (p, q, r, s) = (pick(), pick(), pick(), pick());
            let mut part = || rng.random_range(-0.1..=1.1);
            p.lerp(q, part()).lerp(r.lerp(s, part()), part())
        }
    }
}

/// What is known of a convex shape and a point: the distance of the point and the oracle's bounds of it, the depth too; the
/// nearest point and the normal by their own laws.
#[derive(Debug, Default)]
struct Tally {
    tested: usize,
    inside: usize,
    judged: usize,
    worst: f64,
}

impl Tally {
    fn judge(&mut self, reference: &Convex, at: &DAffine3, p: DVec3) {
        let Ok(shape) = common::try_shape_of(reference) else { return };
        let context = format!("seed {SEED}: {reference:?} at {at:?}, {p}");
        let found = of(&shape, at, p);
        let size = size_of(&shape, at, p);
        let rounding = 8.0 * f64::EPSILON * (at.translation.abs().max(p.abs()).max_element() + size);
        let error = TOUCHING_ERROR * size + rounding;
        self.tested += 1;

        let contained = query::contains_point(&shape, at, p).unwrap();
        assert!(
            if contained { found.distance <= error } else { found.distance >= -error },
            "{context}: {found:?}"
        );

        let dot = Convex::Hull { points: vec![p] };
        let (least, most) = distance_bounds(reference, at, &dot, &HERE);
        if most == 0.0 {
            self.inside += 1;
            if let Some((lower, upper)) = penetration_bounds(&dot, &HERE, reference, at) {
                self.judged += 1;
                let stated = error + 2.0 * DEPTH_TOLERANCE * upper;
                let beyond = (lower + found.distance).max(-found.distance - upper).max(0.0);
                // Of those that are as deep in very many directions the oracle has no tight bounds either.
                self.worst = self.worst.max(beyond / (stated + (upper - lower)));
            }
        } else {
            self.judged += 1;
            let beyond = (least - found.distance).max(found.distance - most);
            self.worst = self.worst.max(beyond / (error + TOUCHING_ERROR * most));
        }

        // The plane through the nearest point supports the shape, and the point is on its normal.
        let foot = Convex::Hull { points: vec![p - found.normal * found.distance] };
        let gap = verify_axis(&foot, &HERE, reference, at, found.normal);
        // Near the surface, the direction of the way there has fewer digits.
        let turned = if found.distance > 0.0 { (rounding / found.distance).min(1.0) * size } else { 0.0 };
        let slack = 4.0 * error + 1e-7 * found.distance.abs() + turned;
        assert!(gap >= -slack, "{context}: {found:?} is beyond the surface by {gap:e} of {slack:e}");
        let missed = (found.point + found.normal * found.distance).distance(p);
        let depth = (-found.distance).max(0.0);
        let limit = 8.0 * (depth * (DEPTH_TOLERANCE * depth + error)).sqrt() + 1e-11 * size + rounding;
        // A cylinder around its axis, and the like, may be seen as a polytope of VERTICES_MAX vertices.
        let limit = limit + if is_stretched(reference, at) { 0.05 * depth } else { 0.0 };
        assert!(missed <= limit, "{context}: {found:?} misses the point by {missed:e} of {limit:e}");
    }

    fn finish(self, what: &str) {
        println!("{what}, seed {SEED}: {self:?}");
        common::assert_rate(what, self.inside, self.tested);
        assert!(self.judged * 100 >= self.tested * 95, "{what}: {self:?}");
        assert!(self.worst <= 1.0, "{what}: {} times the stated error", self.worst);
    }
}

fn is_stretched(reference: &Convex, at: &DAffine3) -> bool {
    let m = at.matrix3;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length());
    let skew = x.max(y).max(z) / x.min(y).min(z) - 1.0 + m.x_axis.dot(m.y_axis).abs() / (x * y);
    !matches!(reference, Convex::Cuboid { .. } | Convex::Hull { .. }) && skew > 1e-12
}

/// At most so much of each other are the shape and where it is.
fn scattered(rng: &mut StdRng, size: f64, far: f64) -> DAffine3 {
    let mut at = placement(rng, size);
    at.translation *= far;
    at
}

#[test]
fn random_shapes() {
    let (mut rng, mut tally) = (seeded(SEED), Tally::default());
    for _ in 0..3000 {
        let size = log_uniform(&mut rng, 1e-6, 1e6);
        let (shape, at) = (random_shape(&mut rng, size), scattered(&mut rng, size, 1.0));
        let p = at.transform_point3(point_near(&mut rng, &shape));
        tally.judge(&shape, &at, p);
    }
    tally.finish("random shapes");
}

#[test]
fn plates_and_shapes_far_from_the_origin() {
    let (mut rng, mut tally) = (seeded(SEED + 1), Tally::default());
    for i in 0..2000 {
        let size = log_uniform(&mut rng, 1e-6, 1e6);
        let (shape, far) = if i % 2 == 0 {
            (random_flat(&mut rng, size), 1.0)
        } else {
            (random_shape(&mut rng, size), log_uniform(&mut rng, 1e3, 1e7))
        };
        let at = scattered(&mut rng, size, far);
        let p = at.transform_point3(point_near(&mut rng, &shape));
        tally.judge(&shape, &at, p);
    }
    tally.finish("plates and far shapes");
}

/// From a point of the surface along its normal, the distance is the way, and the normal is the same; a little inward, too, unless
/// the point is at an edge.
#[test]
fn beside_the_surface_the_distance_is_the_way() {
    let mut rng = seeded(SEED + 2);
    let (mut cases, mut inward) = (0, 0);
    while cases < 2000 {
        let size = log_uniform(&mut rng, 1e-6, 1e6);
        let (reference, at) = (random_shape(&mut rng, size), scattered(&mut rng, size, 1.0));
        let Ok(shape) = common::try_shape_of(&reference) else { continue };
        let p = at.transform_point3(point_near(&mut rng, &reference));
        let on = of(&shape, &at, p);
        let size = size_of(&shape, &at, on.point);
        let way = size * log_uniform(&mut rng, 1e-10, 1e-1);
        let beside = on.point + on.normal * way;
        let found = of(&shape, &at, beside);
        let context = format!("{reference:?} at {at:?}: {on:?}, then {way:e} beside it {found:?}");
        // Of stretched curved shapes the first point is off along the surface by the root of what its depth is off.
        let depth = if is_stretched(&reference, &at) { on.distance.abs() } else { 0.0 };
        let error = 1e-11 * size + 1e-6 * depth;
        assert!((found.distance - way).abs() <= error, "{context}");
        assert!(
            found.point.distance(on.point) <= 1e-5 * (size * way).sqrt() + 4.0 * error + 1e-3 * depth,
            "{context}"
        );
        let turned = found.normal.distance(on.normal);
        assert!(turned <= 1e-5 + 8.0 * error / way || on.distance <= 0.0, "{context}, turned by {turned:e}");
        cases += 1;
        // Deeper than some way in: the point is off the edges by more than a part of it.
        if on.distance < -0.01 * size {
            inward += 1;
            let way = 1e-3 * way;
            let found = of(&shape, &at, on.point - on.normal * way);
            assert!((found.distance + way).abs() <= error + 1e-6 * way, "{context}, inward {found:?}");
        }
    }
    common::assert_rate("also inward", inward, cases);
}

/// A mesh that is closed, whichever way round, as a solid: the nearest triangle, with the side by the winding number.
#[test]
fn solids_are_their_surface_with_a_side() {
    let mut rng = seeded(SEED + 3);
    let (mut inside, cases) = (0, 900);
    for case in 0..cases {
        let (rows, columns) = (rng.random_range(3..9), 2 * rng.random_range(2..5));
        let size = log_uniform(&mut rng, 1e-6, 1e6);
        let mut soup = torus(rows, columns, rng.random_range(0.3..0.8)).scaled(size);
        if rng.random() {
            soup.primitives.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        }
        let at = scattered(&mut rng, size, 1.0);
        let (placed, triangles) = (soup.placed(&at), soup.triangles());
        // On the way through the tube.
        let (i, j) = (rng.random_range(0..rows), rng.random_range(0..columns));
        let vertex = |j: u32| placed[(i * columns + j % columns) as usize];
        let p = vertex(j).lerp(vertex(j + columns / 2), rng.random_range(-0.4..1.4));
        let shape = soup.shape().into_solid().unwrap();
        let found = of(&shape, &at, p);
        let contained = query::contains_point(&shape, &at, p).unwrap();
        assert_eq!(found.distance <= 0.0, contained, "case {case}: {found:?}");

        let error = 1e-13 * size_of(&shape, &at, p);
        let distance = mesh_distance(&placed, &triangles, &[p], &[[0, 0, 0]]);
        assert!((found.distance.abs() - distance).abs() <= error, "case {case}: {found:?}, not {distance}");
        if distance > error {
            let winds = winding_number(&placed, &triangles, p) != Some(0);
            assert_eq!(found.distance < 0.0, winds, "case {case}: {found:?}");
            inside += usize::from(winds);
            let missed = (found.point + found.normal * found.distance).distance(p);
            assert!(missed <= 4.0 * error, "case {case}: {found:?}, off by {missed:e}");
        }
        // On a triangle the normal leads out.
        let corners = triangles[rng.random_range(0..triangles.len())].map(|i| placed[i as usize]);
        let on = corners.into_iter().sum::<DVec3>() / 3.0;
        let found = of(&shape, &at, on);
        assert!(found.distance.abs() <= error && found.point.distance(on) <= error, "case {case}: {found:?}");
        let beside = |way: f64| query::contains_point(&shape, &at, on + found.normal * way * size).unwrap();
        assert!(!beside(1e-6) && beside(-1e-6), "case {case}: {found:?} leads in");
    }
    common::assert_rate("points in solids", inside, cases);
}

/// Law: normals lead out of a solid that is far from its local origin, by up to 3 * 10^10 times its extent, and to the point that was asked about, or from
/// it, where that is further off than the error of normals at edges; on a triangle too.
#[test]
fn far_from_the_local_origin_normals_lead_out() {
    let mut rng = seeded(SEED + 10);
    let (mut inside, mut judged, cases) = (0, 0, 4000);
    for case in 0..cases {
        let size = log_uniform(&mut rng, 1e-6, 1e6);
        let far = direction(&mut rng) * size * log_uniform(&mut rng, 1e8, 3e10);
        let mut soup = torus(5, 6, rng.random_range(0.3..0.8)).scaled(size);
        soup.vertices.iter_mut().for_each(|vertex| *vertex += far + 0.05 * size * in_cube(&mut rng));
        let shape = soup.shape().into_solid().unwrap();
        let at = scattered(&mut rng, size, 1.0);
        let (placed, triangles) = (soup.placed(&at), soup.triangles());
        let corners = triangles[rng.random_range(0..triangles.len())].map(|i| placed[i as usize]);
        let on = corners.into_iter().sum::<DVec3>() / 3.0;
        let data = size_of(&shape, &at, on);
        let error = 1e-11 * data;
        let p = on + direction(&mut rng) * log_uniform(&mut rng, error, (0.3 * size).max(4.0 * error));
        let found = of(&shape, &at, p);
        let context = format!("case {case}, size {size}: {p} at {at:?}: {found:?}");
        if found.distance.abs() > error {
            judged += 1;
            inside += usize::from(found.distance < 0.0);
            let missed = (found.point + found.normal * found.distance).distance(p);
            assert!(missed <= error, "{context}, off by {missed:e}");
        }
        let found = of(&shape, &at, on);
        let front = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let beside = |way: f64| query::contains_point(&shape, &at, on + front * way * size).unwrap();
        let is_clear = beside(1e-4) != beside(-1e-4);
        let out = if beside(-1e-4) { front } else { -front };
        assert!(!is_clear || found.normal.dot(out) > 0.99, "{context}: {found:?} leads in");
    }
    assert!(judged * 4 > cases, "{judged} of {cases}");
    common::assert_rate("points in far solids", inside, judged);
}

/// Of a surface or a union of parts it is the least of all parts, each as a hull of its own.
#[test]
fn a_union_is_as_near_as_its_nearest_part() {
    let mut rng = seeded(SEED + 4);
    let (mut inside, mut near, cases) = (0, 0, 600);
    for case in 0..cases {
        let is_mesh = case % 3 == 0;
        let soup = if is_mesh { random_mesh(&mut rng, 12) } else { random_complex(&mut rng, 6) };
        let (shape, at) = (soup.shape(), placement(&mut rng, 1.0));
        let hulls: Vec<Vec<DVec3>> =
            soup.primitives.iter().map(|p| p.iter().map(|&i| soup.vertices[i as usize]).collect()).collect();
        let picked = Convex::Hull {
            points: (0..20)
                .map(|_| &hulls[rng.random_range(0..hulls.len())])
                .max_by_key(|h| h.len())
                .unwrap()
                .clone(),
        };
        let p = at.transform_point3(point_near(&mut rng, &picked));
        let found = of(&shape, &at, p);
        let parts = hulls.iter().map(|hull| of(&Shape::convex_hull(hull).unwrap(), &at, p).distance);
        let least = parts.fold(f64::INFINITY, f64::min);
        assert!((found.distance - least).abs() < 1e-11, "case {case}: {found:?}, not {least}");
        assert!((found.point + found.normal * found.distance).distance(p) < 1e-6, "case {case}: {found:?}");
        assert!(!is_mesh || found.distance >= 0.0, "a surface has no inside");
        if !is_mesh {
            inside += usize::from(found.distance < -1e-9);
            near += 1;
        }
    }
    common::assert_rate("points in unions", inside, near);
}

/// A shape of any kind.
fn any_shape(rng: &mut StdRng, i: usize) -> Shape {
    match i % 4 {
        0 => random_mesh(rng, 20).shape(),
        1 => random_complex(rng, 5).shape(),
        2 => torus(5, 6, 0.6).shape().into_solid().unwrap(),
        _ => loop {
            if let Ok(shape) = common::try_shape_of(&random_shape(rng, 1.0)) {
                break shape;
            }
        },
    }
}

/// It changes by no more than the point is moved.
#[test]
fn it_changes_no_faster_than_the_point() {
    let mut rng = seeded(SEED + 5);
    let (mut crossed, cases) = (0, 2000);
    for i in 0..cases {
        let (shape, at) = (any_shape(&mut rng, 4 * (i % 2) + 2 + i % 2), placement(&mut rng, 1.0));
        let shape = if i % 5 == 0 { any_shape(&mut rng, i / 5) } else { shape };
        let mut point = || at.transform_point3(0.9 * in_cube(&mut rng));
        let (p, q) = (point(), point());
        let (of_p, of_q) = (of(&shape, &at, p).distance, of(&shape, &at, q).distance);
        assert!((of_p - of_q).abs() <= p.distance(q) + 1e-6, "{p}: {of_p}, {q}: {of_q}");
        crossed += usize::from((of_p < 0.0) != (of_q < 0.0));
    }
    println!("{crossed} of {cases} go through the surface");
    assert!(crossed * 10 > cases * 2);
}

/// Scaling a scene by a power of two scales the answer, to the bit.
#[test]
fn powers_of_two_change_nothing() {
    let mut rng = seeded(SEED + 6);
    let (mut inside, cases) = (0, 400);
    for i in 0..cases {
        let (shape, at) =
            (any_shape(&mut rng, if i % 3 == 0 { i } else { 2 + i % 2 }), placement(&mut rng, 1.0));
        let p = at.transform_point3(0.4 * in_cube(&mut rng));
        let answer = |power: i32| {
            let factor = 2f64.powi(power);
            let found = of(&shape, &rescaled(&at, factor), p * factor);
            (found.distance / factor, found.point / factor, found.normal)
        };
        let reference = answer(0);
        inside += usize::from(reference.0 < 0.0);
        for power in [-200, -1, 7, 200] {
            assert_eq!(answer(power), reference, "case {i}, 2^{power}");
        }
    }
    common::assert_rate("scaled", inside, cases);
}

/// In the middle, on edges and corners, and at any size a number comes out, by whichever way.
#[test]
fn known_answers() {
    for size in [1e-100, 1e-6, 1.0, 1e6, 1e99] {
        let sphere = Shape::sphere(size).unwrap();
        let cone = Shape::cone(size, 2.0 * size).unwrap();
        let cube = Shape::cuboid([2.0 * size; 3]).unwrap();
        let slim = Shape::cylinder(size, 8.0 * size).unwrap();
        let capsule = Shape::capsule(size, 2.0 * size).unwrap();
        let middle = [(&sphere, 1.0), (&cube, 1.0), (&slim, 1.0), (&capsule, 1.0), (&cone, 0.2f64.sqrt())];
        for (shape, depth) in middle {
            let found = of(shape, &HERE, DVec3::ZERO);
            assert!((found.distance / size + depth).abs() < 1e-14, "{found:?} of {size}");
        }
        let near = |found: SignedDistance, distance: f64, normal: DVec3| {
            let close = (found.distance / size - distance).abs() < 1e-14;
            assert!(close && found.normal.distance(normal.normalize()) < 1e-14, "{found:?} of {size}");
        };
        near(of(&cone, &HERE, DVec3::Y * (3.0 * size)), 2.0, DVec3::Y);
        near(of(&cone, &HERE, DVec3::new(4.0, -5.0, 0.0) * size), 5.0, DVec3::new(3.0, -4.0, 0.0));
        near(of(&cone, &HERE, DVec3::new(0.5, -3.0, 0.0) * size), 2.0, DVec3::NEG_Y);
        near(of(&cone, &HERE, DVec3::new(0.0, 1.0, 0.5) * size), 0.2f64.sqrt(), DVec3::new(0.0, 1.0, 2.0));
        near(of(&slim, &HERE, DVec3::new(4.0, 8.0, 0.0) * size), 5.0, DVec3::new(3.0, 4.0, 0.0));
        near(of(&slim, &HERE, DVec3::new(0.25, 3.75, 0.0) * size), -0.25, DVec3::Y);
        near(of(&cube, &HERE, DVec3::ONE * size), 0.0, of(&cube, &HERE, DVec3::ONE * size).normal);
        near(of(&capsule, &HERE, DVec3::new(0.0, 1.5, 0.0) * size), -0.5, DVec3::Y);
    }
    // A mesh that is a surface has two sides, and a plate, too.
    let sheet = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = Shape::mesh(sheet, [[0, 1, 2]]).unwrap();
    let plate = Shape::convex_hull(&sheet).unwrap();
    for (shape, side) in [&mesh, &plate].into_iter().flat_map(|shape| [(shape, 1.0), (shape, -1.0)]) {
        for way in [0.5, 1e-9, 1e-14] {
            let found = of(shape, &HERE, DVec3::new(0.25, 0.25, side * way));
            assert!((found.distance - way).abs() < 1e-12, "{found:?}");
            assert!(found.distance == 0.0 || found.normal.dot(DVec3::Z * side) > 0.999_999, "{found:?}");
        }
    }
}

#[test]
fn bad_input_is_refused() {
    let ball = Shape::sphere(1.0).unwrap();
    for point in [DVec3::NAN, DVec3::X * 1e101, DVec3::Y * f64::INFINITY] {
        let error = query::signed_distance(&ball, &HERE, point).unwrap_err();
        assert!(matches!(error, Error::Coordinates { argument: "point", .. }), "{error}");
    }
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert!(matches!(
        query::signed_distance(&ball, &flat, DVec3::ZERO),
        Err(Error::SingularPlacement { .. })
    ));
}

/// A point inside is its own closest one, also under a placement on the way through which most of its digits are lost.
#[test]
fn what_is_inside_is_itself_the_closest() {
    let solid = torus(8, 8, 0.5).shape().into_solid().unwrap();
    let turn = DMat3::from_axis_angle(DVec3::ONE.normalize(), 0.7);
    for stretch in [1.0, 1e3, 1e6] {
        let linear = turn * DMat3::from_diagonal(DVec3::new(stretch, 1.0, 1.0)) * turn;
        let at = DAffine3 { matrix3: linear, translation: DVec3::new(0.1, 0.2, 0.3) };
        let point = at.transform_point3(DVec3::new(0.6, 0.05, 0.1));
        let found = query::closest_point(&solid, &at, point).unwrap();
        assert_eq!((found.distance, found.point), (0.0, point), "{stretch:e}");
    }
}

/// Law: next to a face, also nearer than what rounding leaves of the way there, the normal is that of the face: of a surface on the side of the
/// point, of a solid outward.
#[test]
fn next_to_a_face_the_normal_is_that_of_the_face() {
    let mut rng = seeded(SEED + 40);
    let soup = torus(9, 7, 0.4);
    let [surface, solid] = [soup.shape(), soup.shape().into_solid().unwrap()];
    for case in 0..2_000 {
        let at = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..6.0));
        let at = DAffine3 { translation: in_cube(&mut rng), ..at };
        let triangle = soup.triangles()[rng.random_range(0..soup.primitives.len())];
        let [p, q, r] = triangle.map(|i| at.transform_point3(soup.vertices[i as usize]));
        let [u, v] = [0; 2].map(|_| rng.random_range(0.2..0.4));
        let front = (q - p).cross(r - p).normalize();
        let gap = log_uniform(&mut rng, 1e-13, 1e-9) * if case % 2 == 0 { 1.0 } else { -1.0 };
        let point = p + (q - p) * u + (r - p) * v + front * gap;
        let of_surface = of(&surface, &at, point).normal.dot(front) * gap.signum();
        assert!(of_surface > 1.0 - 1e-8, "case {case}, {gap:e}: {of_surface}");
        let out = if of(&solid, &at, point + front * 1e-3).distance > 0.0 { front } else { -front };
        let of_solid = of(&solid, &at, point).normal.dot(out);
        assert!(of_solid > 1.0 - 1e-12, "case {case}, {gap:e}: {of_solid}");
    }
}

/// On a face the normal leads out there, whichever way round the solid is, also where the middle of the face is in another part of it; where the
/// place itself is, no side leads out, and the normal is the front's.
#[test]
fn on_a_face_that_is_partly_in_another_part_the_normal_leads_out() {
    let parts = [block(DVec3::ZERO, DVec3::ONE), block(DVec3::new(0.9, 0.2, 0.2), DVec3::new(1.1, 0.8, 0.8))];
    let soup = joined(parts);
    let mut turned = soup.clone();
    turned.primitives.iter_mut().for_each(|triangle| triangle.reverse());
    for (soup, front) in [(soup, DVec3::X), (turned, DVec3::NEG_X)] {
        let solid = soup.shape().into_solid().unwrap();
        for (y, z, normal) in [
            (0.1, 0.15, DVec3::X),
            (0.9, 0.1, DVec3::X),
            (0.5, 0.1, DVec3::X),
            (0.4, 0.3, front),
            (0.3, 0.7, front),
        ] {
            let point = DVec3::new(1.0, y, z);
            let found = of(&solid, &HERE, point);
            assert_eq!((found.distance, found.point, found.normal), (0.0, point, normal), "{y} {z}");
        }
    }
}
