//! Spheres and boxes, judged by the oracle over the triangles.

use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;
use solid_oracle::{hulls_intersect_exact, mesh_distance};

use super::{assert_rate, cases};
use crate::Aabb;
use crate::polygon::{Polygon, SPHERE_ERROR};

fn box_corners(bounds: &Aabb) -> [DVec3; 8] {
    let Aabb { min, max } = *bounds;
    std::array::from_fn(|i| {
        DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 0 { min[k] } else { max[k] }))
    })
}

#[test]
fn boxes_agree_with_the_oracle() {
    let seed = 40;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (12_000, 0);
    for case in 0..cases {
        let [a, b] = cases::pair(&mut rng, case);
        // On the lattice, so that much touches; sometimes flat, or a point.
        let large = if case % 5 == 4 { 150 } else { 1 };
        let mut whole = |end: i32| {
            DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(0..=end * large))))
        };
        let size = whole([1, 2, 4][case % 3]);
        let center = 0.5 * (a.vertices()[0] + b.vertices()[0].clamp(a.bounds().min, a.bounds().max));
        let min =
            (center - size + whole(2)).round() + if case % 2 == 0 { DVec3::ZERO } else { DVec3::splat(0.5) };
        let bounds = Aabb::new(min, min + size);
        let corners = box_corners(&bounds);
        let expected = a.triangles().iter().any(|t| {
            let triangle = t.map(|i| a.vertices()[i as usize]);
            Aabb::of_points(triangle).overlaps(&bounds) && hulls_intersect_exact(&triangle, &corners)
        });
        assert_eq!(a.meets_box(&bounds).unwrap(), expected, "case {case}: {:?} {bounds:?}", a.vertices());
        let scale = 2f64.powi(-400);
        let small = Polygon::new(a.vertices().iter().map(|&v| v * scale).collect::<Vec<_>>()).unwrap();
        let small_box = Aabb::new(bounds.min * scale, bounds.max * scale);
        assert_eq!(small.meets_box(&small_box).unwrap(), expected, "case {case}, scaled");
        hits += usize::from(expected);
    }
    assert_rate("boxes", hits, cases);
}

#[test]
fn spheres_agree_with_the_oracle() {
    let seed = 41;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut worst) = (20_000, 0, 0.0_f64);
    for case in 0..cases {
        let [a, b] = cases::pair(&mut rng, case);
        let center = b.vertices()[0] + DVec3::splat(rng.random_range(-0.5..0.5));
        let distance = mesh_distance(a.vertices(), &a.triangles(), &[center], &[[0, 0, 0]]);
        let size = a.reach().max(center.abs().max_element()).max(distance);
        let margin = SPHERE_ERROR * size;
        let radius = match case % 4 {
            0 => distance + margin,
            1 => distance - margin,
            _ => rng.random_range(0.0..=2.0) * distance,
        };
        if radius >= 0.0 && (radius - distance).abs() >= margin * 0.999 {
            let expected = radius >= distance;
            assert_eq!(a.meets_sphere(center, radius).unwrap(), expected, "case {case}: {distance} {radius}");
            hits += usize::from(expected);
        }
        // How much nearer than stated the answer flips.
        for steps in [1, 2, 4, 8, 16] {
            let off = f64::from(steps) * 0.5 * f64::EPSILON * size;
            let wrong = !a.meets_sphere(center, distance + off).unwrap()
                || distance > off && a.meets_sphere(center, distance - off).unwrap();
            worst = if wrong { worst.max(off / size) } else { worst };
        }
    }
    println!("the greatest error seen is {worst:e} of the size; stated: {SPHERE_ERROR:e}");
    assert_rate("spheres", hits, cases);
}

#[test]
fn bad_arguments_are_named() {
    let triangle = Polygon::new([DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
    let error = triangle.meets_sphere(DVec3::new(0.0, f64::NAN, 0.0), 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "center is NaN; each coordinate must be finite and at most 1e100 in magnitude"
    );
    let error = triangle.meets_sphere(DVec3::ZERO, -2.0).unwrap_err();
    assert_eq!(error.to_string(), "radius is -2.0; it must be from 0 to 1e100");
    let error = triangle.meets_box(&Aabb::new(DVec3::ZERO, DVec3::splat(f64::NAN))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "bounds is NaN; each coordinate must be infinite, or at most 1e100 in magnitude"
    );
    assert!(!triangle.meets_box(&Aabb::EMPTY).unwrap());
    assert!(triangle.meets_box(&Aabb::new(DVec3::NEG_INFINITY, DVec3::INFINITY)).unwrap());
    assert!(!triangle.meets_box(&Aabb::new(DVec3::NEG_INFINITY, DVec3::new(9.0, 9.0, -1e-9))).unwrap());
    assert!(Polygon::new([DVec3::X, DVec3::NAN, DVec3::Y]).is_err());
    assert!(Polygon::new([DVec3::X, DVec3::splat(1e101), DVec3::Y]).is_err());
}

/// Law: a ball over the middle of a polygon meets it where it reaches its plane, wherever that is.
#[test]
fn balls_over_the_middle_reach_the_plane() {
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    for place in [DVec3::ZERO, DVec3::new(7.0, -3.0, 5.0), DVec3::new(0.0, 100.0, 20.0)] {
        let map = DAffine3::from_rotation_translation(DQuat::from_scaled_axis(place + DVec3::ONE), place);
        let polygon = Polygon::new(square).unwrap().transformed(&map).unwrap();
        for (height, meets) in [(0.0, true), (0.99, true), (-0.99, true), (1.01, false), (-1.01, false)] {
            let center = map.transform_point3(DVec3::Z * height);
            assert_eq!(polygon.meets_sphere(center, 1.0).unwrap(), meets, "{place}, {height}");
        }
    }
}

/// Law: the edges of an uneven polygon are part of it, though its plane passes them; and an empty box meets nothing.
#[test]
fn edges_off_the_plane_are_met() {
    let tent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5), DVec3::Y];
    let polygon = Polygon::with_tolerance(tent, 0.12).unwrap();
    for (i, &corner) in tent.iter().enumerate() {
        for part in [0.0, 0.1, 0.3, 0.9] {
            let on_edge = corner.lerp(tent[(i + 1) % 4], part);
            assert!(polygon.meets_sphere(on_edge, 1e-3).unwrap(), "{on_edge}");
            assert!(polygon.meets_box(&Aabb::new(on_edge, on_edge).inflated(1e-3)).unwrap(), "{on_edge}");
        }
    }
    for axis in 0..3 {
        let mut bounds = Aabb::new(DVec3::splat(-1.0), DVec3::splat(2.0));
        assert!(polygon.meets_box(&bounds).unwrap());
        (bounds.min[axis], bounds.max[axis]) = (0.3, 0.2);
        assert!(!polygon.meets_box(&bounds).unwrap());
    }
}
