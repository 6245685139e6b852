//! The laws of the hull.

use super::Hull;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{in_cube, seeded};
use std::f64::consts::TAU;

fn hull_of(points: &[DVec3]) -> Hull {
    let hull = Hull::of(points).expect("there are points");
    hull.validate(points);
    assert_eq!(Hull::of(points).as_ref(), Some(&hull), "the same points give the same hull");
    hull
}

fn on_sphere(rng: &mut StdRng) -> DVec3 {
    loop {
        let v = in_cube(rng);
        if v.length_squared() <= 1.0 && v.length_squared() > 1e-4 {
            return v.normalize();
        }
    }
}

/// All integer points `p` with `0 <= p < size`.
fn grid(size: [i32; 3]) -> Vec<DVec3> {
    let [x, y, z] = size;
    (0..x * y * z)
        .map(|i| DVec3::new(f64::from(i % x), f64::from(i / x % y), f64::from(i / (x * y))))
        .collect()
}

fn volume_and_area(hull: &Hull, points: &[DVec3]) -> (f64, f64) {
    let origin = points[hull.vertices()[0] as usize];
    hull.triangles().iter().fold((0.0, 0.0), |(volume, area), t| {
        let [a, b, c] = t.map(|i| points[i as usize] - origin);
        (volume + a.dot(b.cross(c)) / 6.0, area + 0.5 * (b - a).cross(c - a).length())
    })
}

/// Law: the greatest dot product over the vertices is that over all points, up to rounding of the products.
fn assert_supports(hull: &Hull, points: &[DVec3], rng: &mut StdRng) {
    let size = points.iter().fold(0.0f64, |s, p| s.max(p.abs().max_element()));
    for i in 0..200 {
        let direction =
            if i < 6 { DVec3::AXES[i % 3] * if i < 3 { 1.0 } else { -1.0 } } else { in_cube(rng) };
        let all = points.iter().map(|p| p.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
        let slots = 0..hull.vertices().len();
        let value = |slot: usize| points[hull.vertices()[slot] as usize].dot(direction);
        let best = slots.map(value).fold(f64::NEG_INFINITY, f64::max);
        if i < 6 {
            assert_eq!(best, all, "along an axis nothing is rounded");
        } else {
            assert!(all - best <= 4.0 * f64::EPSILON * size, "{best} < {all} along {direction}");
        }
    }
}

/// Law: hill climbing along the edges ends at a support point, where neighbours' products differ by more than rounding.
fn assert_climbs(hull: &Hull, points: &[DVec3], rng: &mut StdRng) {
    for _ in 0..200 {
        let direction = in_cube(rng);
        let value = |slot: usize| points[hull.vertices()[slot] as usize].dot(direction);
        let best = (0..hull.vertices().len()).map(value).fold(f64::NEG_INFINITY, f64::max);
        let mut slot = rng.random_range(0..hull.vertices().len());
        while let Some(&better) = hull.neighbours(slot).iter().find(|&&n| value(n as usize) > value(slot)) {
            slot = better as usize;
        }
        assert!(best - value(slot) <= 1e-12, "hill climbing stopped at {} of {best}", value(slot));
    }
}

/// Law: a line across a flat facet meets few of its triangles, however many corners it has.
#[test]
fn facets_are_cut_in_depth() {
    for count in [5, 64, 1001] {
        let corner = |i: u32| {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
            [DVec3::new(cos, sin, 0.0), DVec3::new(cos, sin, 1.0)]
        };
        let points: Vec<DVec3> = (0..count).flat_map(corner).collect();
        let hull = hull_of(&points);
        let lids = hull.triangles().iter().map(|t| t.map(|i| points[i as usize]));
        let lids: Vec<_> = lids.filter(|t| t.iter().all(|p| p.z == 0.0)).collect();
        assert_eq!(lids.len(), count as usize - 2);
        for x in [-0.9, -0.3, 0.01, 0.5, 0.99] {
            let met = lids.iter().filter(|t| t.iter().any(|p| p.x < x) && t.iter().any(|p| p.x > x)).count();
            assert!(met <= 2 * count.ilog2() as usize, "{met} of {count} at {x}");
        }
    }
}

#[test]
fn random_clouds() {
    let mut rng = seeded(1);
    for n in [4, 5, 8, 30, 300, 2000] {
        let points: Vec<_> = (0..n).map(|_| in_cube(&mut rng)).collect();
        let hull = hull_of(&points);
        assert_eq!(hull.dimension(), 3);
        assert_supports(&hull, &points, &mut rng);
        assert_climbs(&hull, &points, &mut rng);
    }
}

#[test]
fn all_points_of_a_sphere_are_vertices() {
    let mut rng = seeded(2);
    let points: Vec<_> = (0..1000).map(|_| on_sphere(&mut rng)).collect();
    let hull = hull_of(&points);
    assert_eq!(hull.vertices().len(), 1000);
    assert_eq!(hull.triangles().len(), 2 * 1000 - 4);
    assert_supports(&hull, &points, &mut rng);
    assert_climbs(&hull, &points, &mut rng);
}

#[test]
fn a_grid_has_the_corners_of_a_box() {
    for size in [[2, 2, 2], [3, 3, 3], [7, 5, 4], [12, 2, 3]] {
        let points = grid(size);
        let hull = hull_of(&points);
        assert_eq!((hull.vertices().len(), hull.triangles().len()), (8, 12), "{size:?}");
        assert!((0..8).all(|slot| hull.neighbours(slot).len() == 3));
        let expected = size.iter().map(|&n| f64::from(n - 1)).product::<f64>();
        assert!((volume_and_area(&hull, &points).0 - expected).abs() < 1e-12 * expected);
    }
}

#[test]
fn a_grid_of_any_order_and_affine_image_has_eight_vertices() {
    let mut rng = seeded(3);
    for _ in 0..20 {
        // Small integer matrices keep the image exact.
        let m = DMat3::from_cols_array(&std::array::from_fn(|_| f64::from(rng.random_range(-9..=9i32))));
        if m.determinant() == 0.0 {
            continue;
        }
        let mut points: Vec<_> = grid([5, 4, 6]).into_iter().map(|p| m * p).collect();
        for i in (1..points.len()).rev() {
            points.swap(i, rng.random_range(0..=i));
        }
        assert_eq!(hull_of(&points).vertices().len(), 8);
    }
}

#[test]
fn cospherical_integer_points() {
    // x^2 + y^2 + z^2 = r^2: many coplanar ones, all extreme.
    for (r_squared, r) in [(9i32, 3), (225, 15), (1105, 34)] {
        let side = -r..=r;
        let points: Vec<_> = side
            .clone()
            .flat_map(|x| side.clone().map(move |y| (x, y)))
            .flat_map(|(x, y)| side.clone().map(move |z| (x, y, z)))
            .filter(|(x, y, z)| x * x + y * y + z * z == r_squared)
            .map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)))
            .collect();
        let hull = hull_of(&points);
        assert!(points.len() >= 30);
        assert_eq!(hull.vertices().len(), points.len(), "radius^2 {r_squared}");
    }
}

#[test]
fn a_prism_with_many_coplanar_points() {
    // Regular only up to rounding: the sides are nearly, the ends exactly plane.
    let ring = |z: f64| {
        (0..500).map(move |i| (f64::from(i) * TAU / 500.0).sin_cos()).map(move |(y, x)| DVec3::new(x, y, z))
    };
    let points: Vec<_> = ring(0.0).chain(ring(1.0)).collect();
    let hull = hull_of(&points);
    assert_eq!(hull.vertices().len(), 1000);
}

#[test]
fn flattened_clouds() {
    let mut rng = seeded(4);
    for flatness in [1e-3, 1e-15, 1e-17, 1e-100] {
        let points: Vec<_> = (0..300).map(|_| in_cube(&mut rng) * DVec3::new(1.0, 1.0, flatness)).collect();
        let hull = hull_of(&points);
        assert_eq!(hull.dimension(), 3, "{flatness}");
        assert_supports(&hull, &points, &mut rng);
        // Turned, so that rounding makes the cloud rough.
        let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3);
        let points: Vec<_> = points.iter().map(|&p| turn * p + 10.0).collect();
        let hull = hull_of(&points);
        assert_eq!(hull.dimension(), 3, "{flatness}");
        assert_supports(&hull, &points, &mut rng);
    }
}

#[test]
fn slivers() {
    let mut rng = seeded(5);
    for _ in 0..50 {
        // Points within some units in the last place of a line or of few places.
        let axis = in_cube(&mut rng);
        let points: Vec<_> = (0..60)
            .map(|_| {
                let t = f64::from(rng.random_range(0..5u8));
                axis * t + 2e-16 * in_cube(&mut rng)
            })
            .collect();
        assert_supports(&hull_of(&points), &points, &mut rng);
    }
}

#[test]
fn the_range_reaches_from_1e_minus_100_to_1e100() {
    let mut rng = seeded(6);
    let points: Vec<_> = (0..100).map(|_| in_cube(&mut rng)).collect();
    let vertices = hull_of(&points).vertices().to_vec();
    for exponent in [-332, -100, 100, 332] {
        let scaled: Vec<_> = points.iter().map(|&p| p * 2f64.powi(exponent)).collect();
        assert_eq!(hull_of(&scaled).vertices(), vertices, "2^{exponent}");
    }
    let uneven: Vec<_> =
        points.iter().map(|&p| p * DVec3::new(2f64.powi(332), 1.0, 2f64.powi(-332))).collect();
    assert_eq!(hull_of(&uneven).vertices(), vertices);
    // Mixed sizes in one hull.
    let mixed: Vec<_> = (0..200).map(|_| in_cube(&mut rng) * 10f64.powi(rng.random_range(-80..80))).collect();
    assert_eq!(hull_of(&mixed).dimension(), 3);
    // What is smaller on an axis than 10^-188 of the greatest there is zero.
    for (small, corners) in [(1e-187, [1, 2, 3]), (1e-189, [0, 1, 2])] {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NEG_X * small];
        assert_eq!(Hull::of(&points).unwrap().vertices(), corners, "{small}");
    }
}

#[test]
fn lower_dimensions_are_recognised_exactly() {
    let one = hull_of(&[DVec3::ONE; 5]);
    assert_eq!((one.dimension(), one.vertices(), one.neighbours(0).len()), (0, [0].as_slice(), 0));

    let zero_signs = hull_of(&[DVec3::ZERO, -DVec3::ZERO]);
    assert_eq!(zero_signs.vertices(), [0]);

    let direction = DVec3::new(3.0, -7.0, 11.0);
    let line: Vec<_> = [2, 5, -3, 5, 0, -3].map(|i| direction * f64::from(i)).into();
    let segment = hull_of(&line);
    assert_eq!((segment.dimension(), segment.vertices()), (1, [1, 2].as_slice()));
    assert_eq!((segment.neighbours(0), segment.neighbours(1)), ([1].as_slice(), [0].as_slice()));

    // A plane in general position with a grid of points on it.
    let (u, v) = (DVec3::new(1.0, 2.0, -3.0), DVec3::new(4.0, -1.0, 2.0));
    let plane: Vec<_> = grid([5, 4, 1]).iter().map(|p| u * p.x + v * p.y).collect();
    let polygon = hull_of(&plane);
    assert_eq!((polygon.dimension(), polygon.vertices()), (2, [0, 4, 15, 19].as_slice()));
    assert_eq!(polygon.triangles().len(), 4);
    assert!((0..4).all(|slot| polygon.neighbours(slot).len() == 2));

    // One unit in the last place off that plane makes it solid.
    let mut bent = plane.clone();
    bent[7].z = bent[7].z.next_up();
    assert_eq!(hull_of(&bent).dimension(), 3);
}

#[test]
fn planes_along_each_axis() {
    for axis in 0..3 {
        let points: Vec<_> = grid([3, 3, 1])
            .iter()
            .map(|p| {
                let mut q = [p.x, p.y, 5.0];
                q.rotate_left(axis);
                DVec3::from(q)
            })
            .collect();
        assert_eq!(hull_of(&points).vertices(), [0, 2, 6, 8], "axis {axis}");
    }
}

#[test]
#[should_panic(expected = "point 1 is not finite")]
fn a_point_of_nan_is_refused() {
    let _ = Hull::of(&[DVec3::ZERO, DVec3::NAN]);
}

proptest! {
    #[test]
    fn small_integer_points_give_the_extreme_points_of_brute_force(
        points in proptest::collection::vec([-2i8..3, -2..3, -2..3], 1..14)
    ) {
        let points: Vec<_> = points.iter().map(|p| DVec3::from(p.map(f64::from))).collect();
        let hull = hull_of(&points);
        for (i, p) in points.iter().enumerate() {
            let others: Vec<_> = points.iter().copied().filter(|q| q != p).collect();
            let first = points.iter().position(|q| q == p) == Some(i);
            let is_vertex = hull.vertices().contains(&(i as u32));
            assert_eq!(is_vertex, first && is_separable(*p, &others), "point {i} of {points:?}");
        }
    }

    #[test]
    fn the_order_of_the_points_changes_no_vertex(
        mut points in proptest::collection::vec([-3i8..4, -3..4, -3..4], 1..40), seed in any::<u64>()
    ) {
        let corners = |points: &[[i8; 3]]| {
            let points: Vec<_> = points.iter().map(|p| DVec3::from(p.map(f64::from))).collect();
            let hull = hull_of(&points);
            let mut corners: Vec<_> = hull.vertices().iter().map(|&i| points[i as usize].as_i64vec3().to_array()).collect();
            corners.sort_unstable();
            (corners, hull.dimension(), hull.triangles().len())
        };
        let before = corners(&points);
        let mut rng = seeded(seed);
        for i in (1..points.len()).rev() {
            points.swap(i, rng.random_range(0..=i));
        }
        assert_eq!(corners(&points), before);
    }
}

/// Brute force over integers: whether some simplex of the other points contains `p`, by Caratheodory's theorem.
fn is_separable(p: DVec3, others: &[DVec3]) -> bool {
    let n = others.len();
    let q = |i: usize| others[i] - p;
    for i in 0..n {
        for j in i..n {
            if q(i).cross(q(j)) == DVec3::ZERO && q(i).dot(q(j)) < 0.0 {
                return false;
            }
            for k in j..n {
                let (a, b, c) = (q(i).cross(q(j)), q(j).cross(q(k)), q(k).cross(q(i)));
                let normal = (q(j) - q(i)).cross(q(k) - q(i));
                let flat = q(i).dot(b) == 0.0 && normal != DVec3::ZERO;
                if flat && a.dot(normal) >= 0.0 && b.dot(normal) >= 0.0 && c.dot(normal) >= 0.0 {
                    return false;
                }
                for l in k..n {
                    let volume = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c));
                    let total = volume(q(j) - q(i), q(k) - q(i), q(l) - q(i));
                    let parts = [
                        volume(q(j), q(k), q(l)),
                        -volume(q(i), q(k), q(l)),
                        volume(q(i), q(j), q(l)),
                        -volume(q(i), q(j), q(k)),
                    ];
                    if total != 0.0 && parts.iter().all(|part| part * total >= 0.0) {
                        return false;
                    }
                }
            }
        }
    }
    true
}

/// 3,378 point sets from the Jolt test assets: vertex count, volume and area as CGAL found them.
#[test]
fn the_hulls_of_jolt() {
    let Some(folder) = solid_oracle::known_answers("convex") else { return };
    let table = std::fs::read_to_string(folder.join("jolt_convex_hulls_open.csv")).expect("the table");
    // For each set a little-endian u32, the number of points, and that many triples of f32.
    let bytes = std::fs::read(folder.join("jolt_convex_hulls_open.bin")).expect("the points");
    let mut words = bytes.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]));
    let mut hulls = 0;
    for row in table.lines().skip(1) {
        let field: Vec<&str> = row.split(',').collect();
        let n = words.next().expect("a count");
        assert_eq!(field[1], n.to_string());
        let points: Vec<_> = (0..n)
            .map(|_| {
                DVec3::from_array(std::array::from_fn(|_| {
                    f64::from(f32::from_bits(words.next().expect("a point")))
                }))
            })
            .collect();
        let hull = hull_of(&points);
        hulls += 1;
        assert_eq!(field[2], hull.dimension().to_string(), "dimension of set {}", field[0]);
        if hull.dimension() < 3 {
            continue;
        }
        assert_eq!(field[3], hull.vertices().len().to_string(), "vertices of set {}", field[0]);
        let (volume, area) = volume_and_area(&hull, &points);
        let expected = |i: usize| field[i].parse::<f64>().expect("a number");
        assert!((volume - expected(4)).abs() <= 1e-9 * expected(4), "volume of set {}: {volume}", field[0]);
        assert!((area - expected(5)).abs() <= 1e-9 * expected(5), "area of set {}: {area}", field[0]);
    }
    assert_eq!(words.next(), None);
    assert!(hulls > 3000);
}

#[test]
#[ignore = "reports times: cargo test --release -p solid3d hull -- --ignored --nocapture"]
fn times() {
    let mut rng = seeded(7);
    for n in [100, 1_000, 10_000, 100_000, 1_000_000] {
        let sphere: Vec<_> = (0..n).map(|_| on_sphere(&mut rng)).collect();
        let cube: Vec<_> = (0..n).map(|_| in_cube(&mut rng)).collect();
        let side = f64::from(n).cbrt().round() as i32;
        let ring: Vec<_> = (0..n)
            .map(|i| (f64::from(i) * TAU / f64::from(n)).sin_cos())
            .map(|(y, x)| DVec3::new(x, y, rng.random_range(-1e-9..1e-9)))
            .collect();
        for (name, points) in [("sphere", sphere), ("cube", cube), ("grid", grid([side; 3])), ("ring", ring)]
        {
            let start = std::time::Instant::now();
            let hull = Hull::of(&points).expect("there are points");
            let time = start.elapsed().as_secs_f64() * 1e3;
            println!("{name} of {n}: {time:.2} ms, {} vertices", hull.vertices().len());
        }
    }
    for (name, points) in adversaries(16_000) {
        let start = std::time::Instant::now();
        let hull = Hull::of(&points).expect("there are points");
        println!("{name}: {:.2} ms, {} vertices", start.elapsed().as_secs_f64() * 1e3, hull.vertices().len());
    }
}

/// Families of `n` points that are hard for some hull algorithms.
fn adversaries(n: u32) -> Vec<(&'static str, Vec<DVec3>)> {
    let turn = TAU / f64::from(n);
    let curve = |point: &dyn Fn(f64) -> DVec3| (0..n).map(|i| point(f64::from(i))).collect::<Vec<_>>();
    let exponential = |t: f64| DVec3::new(t.cos(), t.sin(), t * t);
    let mut cone = curve(&|t| DVec3::new((t * turn).cos(), (t * turn).sin(), 0.0));
    cone.extend([DVec3::Z, -DVec3::Z]);
    vec![
        // Every pair of points is joined by an edge of the four-dimensional relative of this curve.
        ("moment curve", curve(&|t| DVec3::new(t, t * t, t * t * t) / f64::from(n))),
        (
            "trigonometric curve",
            curve(&|t| DVec3::new((t * turn).cos(), (t * turn).sin(), (2.0 * t * turn).cos())),
        ),
        // Ever denser: each farthest point cuts off few others. Exact arithmetic has much to do.
        ("exponential curve", curve(&|t| exponential((-0.01 * t).exp()))),
        // Two vertices of degree n.
        ("double cone", cone),
        (
            "integer paraboloid",
            curve(&|t| {
                DVec3::new(t % 100.0, (t / 100.0).floor(), (t % 100.0).powi(2) + (t / 100.0).floor().powi(2))
            }),
        ),
    ]
}

#[test]
fn adversaries_of_hull_algorithms() {
    for (name, points) in adversaries(700) {
        assert_eq!(hull_of(&points).vertices().len(), points.len(), "{name}");
    }
}
