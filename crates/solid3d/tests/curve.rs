//! The intersection curve, judged by known answers, by brute force over all pairs of primitives, and by its laws.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

use common::{
    Case, Soup, assert_rate, at, direction, in_cube, log_uniform, random_complex, random_mesh, rescaled,
    torus,
};
use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid_oracle::{Convex, distance_bounds, mesh_distance, mesh_pairs, triangles_intersect};
use solid3d::query::{self, IntersectionCurve, Polyline, PrimitivePair};
use solid3d::{Error, Shape, ShapeKind, glam};

fn curve(a: &Shape, at_a: &DAffine3, b: &Shape, at_b: &DAffine3) -> IntersectionCurve {
    let curve = query::intersection_curve(a, at_a, b, at_b).unwrap();
    well_formed(&curve);
    curve
}

/// The laws of the type.
fn well_formed(curve: &IntersectionCurve) {
    for polyline in &curve.polylines {
        let Polyline { points, primitives, closed } = polyline;
        let segments = if *closed { points.len() } else { points.len() - 1 };
        assert_eq!(primitives.len(), segments.max(1));
        assert_eq!(polyline.segments().count(), segments);
        assert!(!*closed || segments >= 3);
        assert!(points.iter().all(|p| p.is_finite()));
    }
    let smallest = |polyline: &Polyline| polyline.primitives.iter().min().copied();
    assert!(curve.polylines.is_sorted_by_key(smallest));
}

/// A bumpy sphere without a seam: an octahedron's faces, each split into `n * n`.
fn ball(n: u32, mut radius: impl FnMut(DVec3) -> f64) -> Soup {
    let mut slots: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for octant in 0..8 {
        let sign = |axis: u32| if octant >> axis & 1 == 0 { 1 } else { -1 };
        let mut slot = |i: u32, j: u32| {
            let (i, j) = (i64::from(i), i64::from(j));
            let key = [sign(0) * i, sign(1) * j, sign(2) * (i64::from(n) - i - j)];
            *slots.entry(key).or_insert_with(|| {
                let direction = DVec3::from_array(key.map(|x| x as f64)).normalize();
                vertices.push(direction * radius(direction));
                vertices.len() as u32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([slot(i, j), slot(i + 1, j), slot(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([slot(i + 1, j), slot(i + 1, j + 1), slot(i, j + 1)]);
                }
            }
        }
    }
    Soup::mesh(vertices, triangles)
}

fn pairs(curve: &IntersectionCurve) -> Vec<(u32, u32)> {
    let of = |polyline: &Polyline| polyline.primitives.clone();
    let pairs: BTreeSet<PrimitivePair> = curve.polylines.iter().flat_map(of).collect();
    pairs.into_iter().map(|pair| (pair.a, pair.b)).collect()
}

fn points(curve: &IntersectionCurve) -> Vec<DVec3> {
    let mut points: Vec<DVec3> =
        curve.polylines.iter().flat_map(|polyline| polyline.points.clone()).collect();
    points.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z)));
    points
}

/// How far each point of one is at most from the nearest of the other.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    let nearest = |p: &DVec3, all: &[DVec3]| all.iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
    let one_way = |a: &[DVec3], b: &[DVec3]| a.iter().map(|p| nearest(p, b)).fold(0.0, f64::max);
    one_way(a, b).max(one_way(b, a))
}

#[test]
fn corners_of_two_boxes_meet_in_a_hexagon() {
    let block = Shape::cuboid([2.0, 2.0, 2.0]).unwrap();
    let found = curve(&block, &DAffine3::IDENTITY, &block, &at(1.0, 1.0, 1.0));
    let [polyline] = &found.polylines[..] else { panic!("{found:?}") };
    assert!(polyline.closed);
    assert_eq!(found.length(), 6.0);
    for point in &polyline.points {
        assert!(point.cmpge(DVec3::ZERO).all() && point.cmple(DVec3::ONE).all(), "{point}");
        assert!(point.to_array().contains(&0.0) && point.to_array().contains(&1.0), "{point}");
    }
    assert!(polyline.primitives.iter().all(|pair| (pair.a, pair.b) == (0, 0)));
}

/// Where faces lie on each other, the outline of the contact, without the diagonals in it.
#[test]
fn stacked_boxes_give_the_outline_of_the_contact() {
    let block = Shape::cuboid([2.0, 2.0, 2.0]).unwrap();
    for ([x, y], length) in [([0.0, 0.0], 8.0), ([0.5, 0.25], 6.5), ([1.0, 0.0], 6.0)] {
        let found = curve(&block, &DAffine3::IDENTITY, &block, &at(x, y, 2.0));
        assert!(found.polylines.len() == 1 && found.polylines[0].closed, "{found:?}");
        assert_eq!(found.length(), length);
        assert!(found.polylines[0].points.iter().all(|p| p.z == 1.0));
    }
    // An edge on an edge, a corner on a corner.
    let edges = curve(&block, &DAffine3::IDENTITY, &block, &at(2.0, 1.5, 2.0));
    assert!(edges.polylines.len() == 1 && !edges.polylines[0].closed);
    assert_eq!(edges.length(), 0.5);
    let corners = curve(&block, &DAffine3::IDENTITY, &block, &at(2.0, 2.0, 2.0));
    assert_eq!(points(&corners), [DVec3::ONE]);
    assert_eq!(corners.polylines[0].primitives, [PrimitivePair { a: 0, b: 0 }]);
    assert_eq!((corners.first_point(), corners.length()), (Some(DVec3::ONE), 0.0));
}

/// The same with sheets, which have no sides to give the outline.
#[test]
fn coplanar_sheets_give_the_outline_of_what_they_share() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y].map(|p| 2.0 * p);
    let sheet = Shape::mesh(square, [[0, 1, 2], [0, 2, 3]]).unwrap();
    // Twice the same triangles, the other way round, and split along the other diagonal.
    let doubled = Shape::mesh(square, [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]]).unwrap();
    let other = Shape::mesh(square, [[0, 1, 3], [1, 2, 3]]).unwrap();
    for a in [&sheet, &doubled, &other] {
        for b in [&sheet, &doubled, &other] {
            for ([x, y], length) in [([0.0, 0.0], 8.0), ([1.0, 0.5], 5.0), ([0.0, -1.5], 5.0)] {
                let found = curve(a, &DAffine3::IDENTITY, b, &at(x, y, 0.0));
                assert!(found.polylines.len() == 1 && found.polylines[0].closed, "{found:?}");
                assert!((found.length() - length).abs() < 1e-14, "{} for {length}", found.length());
            }
        }
    }
}

#[test]
fn a_plane_through_a_torus_gives_two_circles() {
    let (tube, size) = (0.4, 1.0 / 1.4);
    let ring = torus(200, 100, tube).shape();
    let corners = [DVec3::new(-2.0, 0.0, -2.0), DVec3::new(5.0, 0.0, -2.0), DVec3::new(-2.0, 0.0, 5.0)];
    let plane = Shape::mesh(corners, [[0, 1, 2]]).unwrap();
    let height = 0.123;
    let found = curve(&ring, &DAffine3::IDENTITY, &plane, &at(0.0, height, 0.0));
    assert!(found.polylines.len() == 2 && found.polylines.iter().all(|polyline| polyline.closed));
    let across = ((tube * size).powi(2) - height * height).sqrt();
    let expected = 2.0 * TAU * size;
    assert!((found.length() / expected - 1.0).abs() < 1e-3, "{} for {expected}", found.length());
    for point in points(&found) {
        let radius = (point.x * point.x + point.z * point.z).sqrt();
        assert!(((radius - size).abs() / across - 1.0).abs() < 3e-3, "{radius}");
    }
}

#[test]
fn two_spheres_meet_in_a_circle() {
    let mesh = ball(48, |_| 1.0).shape();
    let turned = DAffine3::from_quat(DQuat::from_rotation_z(0.3)) * DAffine3::from_rotation_x(0.7);
    let found = curve(
        &mesh,
        &DAffine3::IDENTITY,
        &mesh,
        &DAffine3 { translation: DVec3::new(0.6, 0.8, 0.0), ..turned },
    );
    assert!(found.polylines.len() == 1 && found.polylines[0].closed);
    let expected = PI * 3f64.sqrt();
    assert!((found.length() / expected - 1.0).abs() < 1e-3, "{} for {expected}", found.length());
}

#[test]
fn the_inside_does_not_count() {
    let (small, large) = (Shape::cuboid([1.0, 1.0, 1.0]).unwrap(), Shape::cuboid([3.0, 3.0, 3.0]).unwrap());
    assert!(query::intersects(&small, &DAffine3::IDENTITY, &large, &DAffine3::IDENTITY).unwrap());
    let found = curve(&small, &DAffine3::IDENTITY, &large, &DAffine3::IDENTITY);
    assert!(found.is_empty() && found.length().is_sign_positive());
}

#[test]
fn round_shapes_are_refused() {
    let block = Shape::cuboid([1.0, 1.0, 1.0]).unwrap();
    let here = DAffine3::IDENTITY;
    for (round, kind) in [
        (Shape::sphere(1.0), ShapeKind::Sphere),
        (Shape::cone(1.0, 1.0), ShapeKind::Cone),
        (Shape::cylinder(1.0, 1.0), ShapeKind::Cylinder),
        (Shape::capsule(1.0, 1.0), ShapeKind::Capsule),
    ] {
        let round = round.unwrap();
        let error = |argument| Err(Error::NoFacets { argument, kind });
        assert_eq!(query::intersection_curve(&round, &here, &block, &here), error("a"));
        assert_eq!(query::intersection_curve(&block, &here, &round, &here), error("b"));
    }
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let error = query::intersection_curve(&block, &here, &block, &flat).unwrap_err();
    assert!(matches!(error, Error::SingularPlacement { .. }));
}

impl Case {
    /// Its size is that of the data, about.
    fn near(rng: &mut StdRng, a: Soup, b: Soup, away: f64) -> Case {
        let mut case = Case::new(rng, a, b, away, 10.0);
        case.size += case.at_a.translation.distance(case.at_b.translation);
        case
    }

    fn meshes(rng: &mut StdRng) -> Case {
        let count = |rng: &mut StdRng| log_uniform(rng, 20.0, 800.0) as u32;
        let (n, m) = (count(rng), count(rng));
        let (a, b) = (random_mesh(rng, n), random_mesh(rng, m));
        Case::near(rng, a, b, 2.0)
    }

    fn closed_meshes(rng: &mut StdRng) -> Case {
        let mut closed = || {
            if rng.random() {
                let (rows, columns, tube) =
                    (rng.random_range(4..20), rng.random_range(3..20), rng.random_range(0.2..0.8));
                torus(rows, columns, tube)
            } else {
                let (n, bump) = (rng.random_range(1..9), rng.random_range(0.0..0.4));
                ball(n, |_| 1.0 - rng.random_range(0.0..=bump))
            }
        };
        let (a, b) = (closed(), closed());
        Case::near(rng, a, b, 2.1)
    }

    fn curve(&self) -> IntersectionCurve {
        curve(&self.a.shape(), &self.at_a, &self.b.shape(), &self.at_b)
    }

    /// How far the curve is from the primitives that it comes from, at most.
    fn error(&self, found: &IntersectionCurve) -> f64 {
        let hulls = [self.a.hulls(&self.at_a), self.b.hulls(&self.at_b)];
        let mut error: f64 = 0.0;
        for polyline in &found.polylines {
            let points = &polyline.points;
            for (i, pair) in polyline.primitives.iter().enumerate() {
                for point in [points[i], points[(i + 1) % points.len()]] {
                    for (hulls, primitive) in hulls.iter().zip([pair.a, pair.b]) {
                        error = error.max(distance(&hulls[primitive as usize], point));
                    }
                }
            }
        }
        error
    }
}

fn distance(hull: &[DVec3], point: DVec3) -> f64 {
    if let [a, b, c] = *hull {
        return mesh_distance(&[a, b, c], &[[0, 1, 2]], &[point], &[[0; 3]]);
    }
    let hull_of = |points: &[DVec3]| Convex::Hull { points: points.to_vec() };
    distance_bounds(&hull_of(hull), &DAffine3::IDENTITY, &hull_of(&[point]), &DAffine3::IDENTITY).1
}

#[test]
fn curves_of_meshes_agree_with_brute_force() {
    let seed = 1;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut segments) = (600, 0, 0);
    for i in 0..cases {
        let case = Case::meshes(&mut rng);
        let found = case.curve();
        let (placed_a, placed_b) = (case.a.placed(&case.at_a), case.b.placed(&case.at_b));
        let expected = mesh_pairs(&placed_a, &case.a.triangles(), &placed_b, &case.b.triangles());
        assert_eq!(pairs(&found), expected, "case {i}");
        // In general position each pair gives one segment, or a point.
        let given = found.polylines.iter().map(|polyline| polyline.primitives.len()).sum::<usize>();
        assert_eq!(given, expected.len(), "case {i}");
        let error = case.error(&found);
        assert!(error <= 1e-14 * case.size, "case {i}: off by {error:e} of {:e}", case.size);
        hits += usize::from(!found.is_empty());
        segments += given;
    }
    println!("{segments} segments");
    assert_rate("meshes that meet", hits, cases);
}

#[test]
fn curves_are_those_of_all_pairs_of_triangles() {
    let seed = 2;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let mut segments = 0;
    for i in 0..120 {
        let case = Case::meshes(&mut rng);
        for segment in case.curve().segments() {
            segments += 1;
            let one = |soup: &Soup, primitive: u32| {
                Soup::mesh(soup.vertices.clone(), vec![soup.triangles()[primitive as usize]]).shape()
            };
            let (a, b) = (one(&case.a, segment.primitives.a), one(&case.b, segment.primitives.b));
            let alone = curve(&a, &case.at_a, &b, &case.at_b);
            assert_eq!(alone.segments().count(), 1, "case {i}");
            let error = apart(&segment.ends, &points(&alone));
            assert!(error <= 1e-12 * case.size, "case {i}: {error:e} of {:e}", case.size);
        }
    }
    assert!(segments > 1000, "{segments}");
}

#[test]
fn curves_of_closed_surfaces_are_closed() {
    let seed = 3;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut loops) = (600, 0, 0);
    for i in 0..cases {
        let case = Case::closed_meshes(&mut rng);
        let found = case.curve();
        assert!(found.polylines.iter().all(|polyline| polyline.closed), "case {i}: {found:?}");
        hits += usize::from(!found.is_empty());
        loops += found.polylines.len();
    }
    println!("{loops} loops");
    assert_rate("closed meshes that meet", hits, cases);
}

/// Where vertices are not shared but only equal, and some triangles are degenerate, segments join all the same.
#[test]
fn neighbours_are_known_by_their_positions() {
    let seed = 4;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for i in 0..100 {
        let mut case = Case::closed_meshes(&mut rng);
        let before = case.curve();
        let corners: Vec<DVec3> =
            case.a.triangles().iter().flatten().map(|&v| case.a.vertices[v as usize]).collect();
        let count = corners.len() as u32 / 3;
        case.a = Soup::mesh(corners, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect());
        assert_eq!(case.curve(), before, "case {i}");
    }
    // A square with a corner more on one side, closed by a triangle without area, through which the curve runs.
    let [a, b, c, d, e] =
        [[0, 0], [4, 0], [4, 4], [0, 4], [2, 2]].map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0));
    let sheet = Shape::mesh([a, b, c, d, e], [[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]]).unwrap();
    let upright = Shape::mesh(
        [DVec3::new(3.0, -9.0, -9.0), DVec3::new(3.0, 9.0, -9.0), DVec3::new(3.0, 0.0, 9.0)],
        [[0, 1, 2]],
    );
    let found = curve(&sheet, &DAffine3::IDENTITY, &upright.unwrap(), &DAffine3::IDENTITY);
    assert_eq!((found.polylines.len(), found.length()), (1, 4.0), "{found:?}");
}

#[test]
fn complex_shapes_meet_where_their_boundaries_do() {
    let seed = 5;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (600, 0);
    for i in 0..cases {
        let count = |rng: &mut StdRng| log_uniform(rng, 1.0, 50.0) as u32;
        let (n, m) = (count(&mut rng), count(&mut rng));
        let a = random_complex(&mut rng, n);
        let b = if rng.random() { random_complex(&mut rng, m) } else { random_mesh(&mut rng, m.max(20)) };
        let mut case = Case::near(&mut rng, a, b, 0.7);
        // Without solid primitives the curve is empty if and only if nothing intersects.
        let surfaces = rng.random();
        if surfaces {
            for soup in [&mut case.a, &mut case.b] {
                soup.primitives.iter_mut().for_each(|primitive| primitive.truncate(3));
            }
        }
        let found = case.curve();
        let meet = query::intersects(&case.a.shape(), &case.at_a, &case.b.shape(), &case.at_b).unwrap();
        assert!(meet || found.is_empty(), "case {i}");
        assert!(!surfaces || meet != found.is_empty(), "case {i}");
        let error = case.error(&found);
        assert!(error <= 1e-12 * case.size, "case {i}: off by {error:e} of {:e}", case.size);
        hits += usize::from(!found.is_empty());
    }
    assert_rate("complex shapes that meet", hits, cases);
}

fn lattice_triangle(rng: &mut StdRng, end: i32) -> [DVec3; 3] {
    let mut corner = || DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(0..=end))));
    [corner(), corner(), corner()]
}

/// On a lattice, coplanar, touching and degenerate triangles abound. Few of them and many.
#[test]
fn surfaces_on_a_lattice_meet_if_and_only_if_they_intersect() {
    let seed = 6;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (20_000, 0);
    let here = DAffine3::IDENTITY;
    for i in 0..cases {
        let mut soup =
            |count: u32| -> Vec<DVec3> { (0..count).flat_map(|_| lattice_triangle(&mut rng, 2)).collect() };
        let count = if i % 10 == 0 { 5 } else { 1 };
        let (a, b) = (soup(count), soup(count));
        let triangles: Vec<[u32; 3]> = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let meet = !mesh_pairs(&a, &triangles, &b, &triangles).is_empty();
        let mesh = |soup: &[DVec3]| Shape::mesh(soup, triangles.clone()).unwrap();
        let found = curve(&mesh(&a), &here, &mesh(&b), &here);
        assert_eq!(!found.is_empty(), meet, "{a:?} {b:?}");
        for polyline in &found.polylines {
            for (k, pair) in polyline.primitives.iter().enumerate() {
                let of = |soup: &[DVec3], i: u32| [0, 1, 2].map(|k| soup[3 * i as usize + k]);
                let (x, y) = (of(&a, pair.a), of(&b, pair.b));
                assert!(triangles_intersect(&x, &y));
                let error = distance(&x, polyline.points[k]).max(distance(&y, polyline.points[k]));
                assert!(error < 1e-14, "{error:e}: {x:?} {y:?}");
            }
        }
        // No rounding tells the order of the shapes.
        let swapped = curve(&mesh(&b), &here, &mesh(&a), &here);
        assert_eq!(points(&swapped), points(&found), "{a:?} {b:?}");
        hits += usize::from(meet);
    }
    assert_rate("lattice soups", hits, cases);
}

/// The region that two convex polygons of the plane z = 0 share, clipped edge by edge.
fn clipped(a: &[DVec3; 3], b: &[DVec3; 3]) -> Vec<DVec3> {
    let turn = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).z;
    let sense = turn(b[0], b[1], b[2]).signum();
    (0..3).fold(a.to_vec(), |region, k| {
        let inside = |p: DVec3| sense * turn(b[k], b[(k + 1) % 3], p);
        let mut kept = Vec::new();
        for (i, &p) in region.iter().enumerate() {
            let q = region[(i + 1) % region.len()];
            let (at_p, at_q) = (inside(p), inside(q));
            if at_p >= 0.0 {
                kept.push(p);
            }
            if at_p * at_q < 0.0 {
                kept.push(p.lerp(q, at_p / (at_p - at_q)));
            }
        }
        kept
    })
}

#[test]
fn outlines_of_coplanar_triangles_agree_with_clipping() {
    let seed = 7;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut regions) = (10_000, 0);
    for _ in 0..cases {
        let mut triangle = || {
            loop {
                let triangle = lattice_triangle(&mut rng, 5).map(|p| DVec3::new(p.x, p.y, 0.0));
                if (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).z != 0.0 {
                    return triangle;
                }
            }
        };
        let (a, b) = (triangle(), triangle());
        let region = clipped(&a, &b);
        let next = |i: usize| region[(i + 1) % region.len()];
        let area: f64 = (0..region.len()).map(|i| region[i].cross(next(i)).z).sum();
        if area.abs() < 1e-9 {
            continue;
        }
        regions += 1;
        let outline: f64 = (0..region.len()).map(|i| region[i].distance(next(i))).sum();
        let mesh = |t: &[DVec3; 3]| Shape::mesh(t.to_vec(), [[0, 1, 2]]).unwrap();
        let found = curve(&mesh(&a), &DAffine3::IDENTITY, &mesh(&b), &DAffine3::IDENTITY);
        assert!(found.polylines.len() == 1 && found.polylines[0].closed, "{a:?} {b:?}: {found:?}");
        assert!((found.length() - outline).abs() < 1e-12, "{a:?} {b:?}");
        assert!(apart(&points(&found), &region) < 1e-12, "{a:?} {b:?}");
    }
    assert_rate("regions", regions, cases);
}

/// Edges that lie in the plane of the other triangle but for rounding: signs and weights are those of the last bits.
#[test]
fn edges_that_graze_a_plane_are_cut_precisely() {
    let seed = 8;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (5000, 0);
    for _ in 0..cases {
        let t = [in_cube(&mut rng), in_cube(&mut rng), in_cube(&mut rng)];
        let mut near = || {
            let (u, v) = (rng.random_range(-0.2..1.2), rng.random_range(-0.2..1.2));
            t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])
        };
        let s = [near(), near(), near()];
        let mesh = |t: &[DVec3; 3]| Shape::mesh(t.to_vec(), [[0, 1, 2]]).unwrap();
        let found = curve(&mesh(&s), &DAffine3::IDENTITY, &mesh(&t), &DAffine3::IDENTITY);
        assert_eq!(!found.is_empty(), triangles_intersect(&s, &t));
        for point in points(&found) {
            let error = distance(&s, point).max(distance(&t, point));
            assert!(error <= 4e-15, "{error:e}: {s:?} {t:?}");
        }
        hits += usize::from(!found.is_empty());
    }
    assert_rate("grazing triangles", hits, cases);
}

/// The signs that tell where facets meet are lost where products of the coordinates underflow.
#[test]
fn coordinates_of_very_different_magnitudes_do_no_harm() {
    let one = [[0.5, 1e-100, 0.5], [1.0, -1e100, 1e-9], [1e50, 1e-9, -1e100]].map(DVec3::from_array);
    let other = [[0.5, 1e-100, 1e-100], [1e-100, 0.0, -1e100], [1e50, 1e-100, 1.0]].map(DVec3::from_array);
    let [a, b] = [one, other].map(|corners| Shape::mesh(corners, [[0, 1, 2]]).unwrap());
    let found = curve(&a, &DAffine3::IDENTITY, &b, &DAffine3::IDENTITY);
    assert!(found.length().is_finite());
}

#[test]
fn swapping_the_shapes_gives_the_same_points() {
    let seed = 9;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for i in 0..200 {
        let case = Case::meshes(&mut rng);
        let found = case.curve();
        let swapped = curve(&case.b.shape(), &case.at_b, &case.a.shape(), &case.at_a);
        let mut mirrored: Vec<(u32, u32)> = pairs(&swapped).into_iter().map(|(b, a)| (a, b)).collect();
        mirrored.sort_unstable();
        assert_eq!(mirrored, pairs(&found), "case {i}");
        if !found.is_empty() {
            let error = apart(&points(&found), &points(&swapped));
            assert!(error <= 1e-12 * case.size, "case {i}: {error:e} of {:e}", case.size);
        }
    }
}

#[test]
fn another_unit_of_length_changes_no_bit() {
    let seed = 10;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for i in 0..100 {
        let case = Case::meshes(&mut rng);
        let found = case.curve();
        for exponent in [-200, -3, 150] {
            let factor = 2f64.powi(exponent);
            let (at_a, at_b) = (rescaled(&case.at_a, factor), rescaled(&case.at_b, factor));
            let mut expected = found.clone();
            for polyline in &mut expected.polylines {
                polyline.points.iter_mut().for_each(|p| *p *= factor);
            }
            assert_eq!(curve(&case.a.shape(), &at_a, &case.b.shape(), &at_b), expected, "case {i}");
        }
    }
}

#[test]
fn moving_both_moves_the_curve() {
    let seed = 11;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for i in 0..200 {
        let case = Case::meshes(&mut rng);
        let found = case.curve();
        let turn = DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let motion = DAffine3::from_rotation_translation(turn, case.size * in_cube(&mut rng));
        let moved = curve(&case.a.shape(), &(motion * case.at_a), &case.b.shape(), &(motion * case.at_b));
        assert_eq!(pairs(&moved), pairs(&found), "case {i}");
        if !found.is_empty() {
            let expected: Vec<DVec3> = points(&found).iter().map(|&p| motion.transform_point3(p)).collect();
            let error = apart(&points(&moved), &expected);
            assert!(error <= 1e-10 * case.size, "case {i}: {error:e} of {:e}", case.size);
        }
    }
}
