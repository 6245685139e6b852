//! Spheres and boxes, judged by the oracle over the triangles.

use glam::DVec3;
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
