//! Of two convex bodies.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{Pair, Regime, direction, in_cube, random_pair, seeded};
use solid3d::query::{self, ContactPoint, Feature};
use solid3d::{ComplexShapeBuilder, Shape, glam};

use super::{SEED, assert_flat, assert_laws, contacts, cube, cube_mesh, deepest, floor, only, within};
use crate::common::{self, assert_rate, at, random_mesh, size_of};

/// All pairs of kinds of convex shapes: the points are on both surfaces, the deepest is as deep as the penetration, the swapped pair has the
/// same depth.
#[test]
fn convex_pairs_agree_with_the_penetration_depth() {
    for (regime, hits_expected) in [
        (Regime::Random, 30..=70),
        (Regime::SizeRatio, 30..=70),
        (Regime::NearTouching { relative_gap: 1e-6 }, 30..=70),
        (Regime::Flat, 30..=70),
        (Regime::Concentric, 70..=100),
    ] {
        let (mut rng, mut hits, mut tested, mut several) = (seeded(SEED), 0, 0, 0);
        for i in 0..1_000 {
            let Pair { a: reference_a, pa, b: reference_b, pb, .. } = random_pair(&mut rng, regime);
            let (Ok(a), Ok(b)) = (common::try_shape_of(&reference_a), common::try_shape_of(&reference_b))
            else {
                continue;
            };
            tested += 1;
            let context = format!("{regime:?}, pair {i}: {} {pa:?} {} {pb:?}", a.kind(), b.kind());
            let size = size_of(&a, &pa, &b, &pb);
            let found = contacts(&a, &pa, &b, &pb);
            let penetration = query::penetration(&a, &pa, &b, &pb).unwrap();
            assert_eq!(found.is_empty(), penetration.is_none(), "{context}");
            assert_laws(&found, 0.0, size, &context);
            let Some(penetration) = penetration else { continue };
            hits += 1;
            let depth = deepest(&found);
            several += usize::from(found[0].points.len() > 1);
            let error = 1e-6 * penetration.depth + 1e-9 * size;
            assert!(
                (depth - penetration.depth).abs() <= error,
                "{context}: {depth}, {penetration:?}, {found:?}"
            );
            for point in &found[0].points {
                let normal = found[0].normal;
                for (shape, placement, point, out, what) in
                    [(&a, &pa, point.point_on_a, -normal, "a"), (&b, &pb, point.point_on_b, normal, "b")]
                {
                    let on = query::closest_point(shape, placement, point).unwrap();
                    let limit = 1e-3 * penetration.depth + 1e-6 * size;
                    assert!(
                        on.distance.abs() <= limit,
                        "{context}: {point} is {:e} off {what}, {:?}",
                        on.distance,
                        found[0]
                    );
                    let outside = point + out * (2.0 * limit);
                    let inside = query::contains_point(shape, placement, outside).unwrap();
                    assert!(!inside, "{context}: {point} is within {what}, {:?}", found[0]);
                }
            }
            let swapped = contacts(&b, &pb, &a, &pa);
            let error = 1e-3 * depth + 1e-9 * size;
            assert!((deepest(&swapped) - depth).abs() <= error, "{context}: swapped {swapped:?}, {found:?}");
        }
        println!("{regime:?}: {hits} of {tested} hit, {several} with several points");
        assert!(hits_expected.contains(&(100 * hits / tested)), "{regime:?}: {hits} of {tested}");
        assert!(several > 0, "{regime:?}");
    }
}

/// Swapped, the same points and the opposite normal, where there is but one answer.
#[test]
fn swapping_mirrors() {
    let pose = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.003), DVec3::new(0.2, 0.98, 0.1));
    for (a, b) in
        [(cube(), cube()), (cube(), floor(7)), (cube_mesh(), floor(7)), (Shape::sphere(0.5).unwrap(), cube())]
    {
        let offset = if b.triangles().is_some() { at(0.0, -0.49, 0.0) } else { DAffine3::IDENTITY };
        let place = DAffine3 { translation: pose.translation + offset.translation, ..pose };
        let here = DAffine3::IDENTITY;
        let found = only(&a, &place, &b, &here);
        let mirrored = only(&b, &here, &a, &place);
        assert!((found.normal + mirrored.normal).length() < 1e-12);
        assert_eq!(found.points.len(), mirrored.points.len());
        for point in &found.points {
            let same = mirrored.points.iter().any(|other| {
                other.point_on_a.distance(point.point_on_b) < 1e-9 && (other.depth - point.depth).abs() < 1e-9
            });
            assert!(same, "{point:?} is not in {mirrored:?}");
        }
    }
}

#[test]
fn faces_on_faces() {
    let here = DAffine3::IDENTITY;
    assert_flat(&only(&cube(), &at(0.0, 0.9, 0.0), &cube(), &here), DVec3::Y, 0.1, 4);
    assert_flat(&only(&cube(), &at(0.3, 0.9, 0.2), &cube(), &here), DVec3::Y, 0.1, 4);
    let turned = at(0.0, 0.9, 0.0) * DAffine3::from_rotation_y(FRAC_PI_4);
    assert_flat(&only(&cube(), &turned, &cube(), &here), DVec3::Y, 0.1, 8);
    // All eight corners of a face of eight, on the whole of it.
    let rim = |i: u32, y: f64| DQuat::from_rotation_y(f64::from(i) * FRAC_PI_4) * DVec3::X + DVec3::Y * y;
    let prism =
        Shape::convex_hull(&(0..8).flat_map(|i| [rim(i, 0.5), rim(i, -0.5)]).collect::<Vec<_>>()).unwrap();
    let plate = Shape::cuboid([9.0, 1.0, 9.0]).unwrap();
    for turn in 0..10 {
        let turn = DAffine3::from_rotation_x(f64::from(turn));
        let found = only(&prism, &(turn * at(0.0, 0.9, 0.0)), &plate, &turn);
        assert_flat(&found, turn.transform_vector3(DVec3::Y), 0.1, 8);
        let corners: DVec3 = found.points.iter().map(|point| point.point_on_a).sum();
        let middle = turn.transform_point3(DVec3::Y * 0.4);
        assert!((corners / 8.0).distance(middle) < 1e-9, "on one side only: {found:?}");
    }
    // Under any affine placement.
    let shear =
        DAffine3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.5, 1.0, 0.2), DVec3::Z, DVec3::Y * 0.95);
    assert_flat(&only(&cube(), &shear, &plate, &here), DVec3::Y, 0.05, 4);
}

#[test]
fn round_shapes_on_faces() {
    let (plate, here) = (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), DAffine3::IDENTITY);
    let cylinder = Shape::cylinder(0.5, 1.0).unwrap();
    let lying = |y: f64| at(0.0, y, 0.0) * DAffine3::from_rotation_z(FRAC_PI_2);
    let standing = only(&cylinder, &at(0.0, 0.9, 0.0), &plate, &here);
    assert!(standing.points.len() >= 8, "{standing:?}");
    assert_flat(&standing, DVec3::Y, 0.1, standing.points.len());
    assert!(standing.points.iter().all(|p| (p.point_on_a.with_y(0.0).length() - 0.5).abs() < 1e-9));
    assert_flat(&only(&cylinder, &lying(0.9), &plate, &here), DVec3::Y, 0.1, 2);
    let cone = Shape::cone(0.5, 1.0).unwrap();
    let base = only(&cone, &at(0.0, 0.9, 0.0), &plate, &here);
    assert_flat(&base, DVec3::Y, 0.1, standing.points.len());
    let apex_down = at(0.0, 0.9, 0.0) * DAffine3::from_rotation_z(2.0 * FRAC_PI_2);
    assert_flat(&only(&cone, &apex_down, &plate, &here), DVec3::Y, 0.1, 1);
    let capsule = Shape::capsule(0.25, 1.0).unwrap();
    assert_flat(&only(&capsule, &lying(0.7), &plate, &here), DVec3::Y, 0.05, 2);
    assert_flat(&only(&capsule, &at(0.0, 1.2, 0.0), &plate, &here), DVec3::Y, 0.05, 1);
    assert_flat(&only(&capsule, &lying(0.4), &capsule, &lying(0.0)), DVec3::Y, 0.1, 2);
    assert_flat(&only(&Shape::sphere(0.5).unwrap(), &at(0.3, 0.9, 0.2), &plate, &here), DVec3::Y, 0.1, 1);
}

#[test]
fn crossing_edges_have_one_point() {
    let tip = |turn: DAffine3| turn * DAffine3::from_rotation_z(FRAC_PI_4);
    let upper = at(0.0, 2.0 * 0.5f64.sqrt() - 0.02, 0.0) * DAffine3::from_rotation_y(FRAC_PI_2);
    let found = only(&cube(), &tip(upper), &cube(), &tip(DAffine3::IDENTITY));
    assert_flat(&found, DVec3::Y, 0.02, 1);
    // Along each other there are two.
    let beside = at(0.0, 2.0 * 0.5f64.sqrt() + 0.02, 0.3);
    let here = tip(DAffine3::IDENTITY);
    let found = query::contacts(&cube(), &tip(beside), &cube(), &here, &within(0.05)).unwrap();
    assert_flat(&found[0], DVec3::Y, -0.02, 2);
}

/// A keel whose ends rise less than its sides stands on both ends of it, and is what touches, whichever end rounding puts lower.
#[test]
fn a_keel_stands_on_both_ends() {
    let mut rng = seeded(SEED);
    let sides = [-3.0, 3.0].into_iter().flat_map(|x| [-1.0, 1.0].map(|z| DVec3::new(x, 0.25, z)));
    let corners: Vec<DVec3> = [DVec3::NEG_X, DVec3::X, DVec3::Y].into_iter().chain(sides).collect();
    let (keel, floor) = (Shape::convex_hull(&corners).unwrap(), Shape::cuboid([20.0, 1.0, 20.0]).unwrap());
    for case in 0..200 {
        let turn = DQuat::from_rotation_y(rng.random_range(0.0..TAU));
        let at_keel = DAffine3::from_rotation_translation(turn, DVec3::new(0.0, 0.49, 0.0));
        let found = only(&keel, &at_keel, &floor, &DAffine3::IDENTITY);
        assert_flat(&found, DVec3::Y, 0.01, 2);
        let skew = DMat3::from_cols(DVec3::X, DVec3::new(2.0, 0.3, 1.0), DVec3::new(2.0, 0.3, -1.0));
        let above = DAffine3::from_rotation_translation(turn, DVec3::new(0.0, 0.79, 0.0));
        let found = only(&cube(), &(above * DAffine3::from_mat3(skew)), &floor, &DAffine3::IDENTITY);
        assert_flat(&found, DVec3::Y, 0.01, 2);
        // Across another keel, upside down, one point of both.
        let (tilt, over) = (rng.random_range(0.3..2.8), DQuat::from_rotation_x(PI));
        let across = DQuat::from_rotation_y(tilt) * turn * over;
        let at_other = DAffine3::from_rotation_translation(across, DVec3::new(0.0, 0.5, 0.0));
        let found = only(&keel, &at_keel, &keel, &at_other);
        let [point] = &found.points[..] else { panic!("case {case}: {found:?}") };
        assert_eq!(point.features, [Feature::Edge(0, 1); 2], "case {case}: {found:?}");
    }
}

/// A rim that is furthest at one of its corners has it once.
#[test]
fn no_point_of_a_rim_comes_twice() {
    let (slab, below) = (Shape::cuboid([4.0, 1.0, 4.0]).unwrap(), at(0.0, -0.5, 0.0));
    let mut rims = 0;
    for shape in [Shape::cylinder(0.5, 1.0).unwrap(), Shape::cone(0.5, 1.0).unwrap()] {
        for i in 0..64 {
            let (x, z) = (f64::from(i) * TAU / 64.0).sin_cos();
            let axis = DVec3::new(x, 0.0, z);
            let tilt = DAffine3::from_axis_angle(axis, 0.003);
            let found = only(&shape, &(at(0.0, 0.49, 0.0) * tilt), &slab, &below);
            rims += usize::from(found.points.len() > 8);
            for (k, x) in found.points.iter().enumerate() {
                let apart = |y: &ContactPoint| x.point_on_a.distance(y.point_on_a);
                assert!(found.points[..k].iter().all(|y| apart(y) > 1e-6), "{i}: {found:#?}");
            }
        }
    }
    assert!(rims > 100, "{rims}");
}

/// A flat hull has one face on either side, whatever its form, as a hull and as a polygon.
#[test]
fn a_flat_hull_is_one_face() {
    let corners = [(-5.0, -5.0), (5.0, -5.0), (6.0, 5.0), (-5.0, 5.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let polygon = ComplexShapeBuilder::new(corners).polygon(&[0, 1, 2, 3]).build().unwrap();
    for plate in [Shape::convex_hull(&corners).unwrap(), polygon] {
        for (x, z) in (-4..=4).flat_map(|x| (-4..=4).map(move |z| (f64::from(x), f64::from(z)))) {
            for (y, up) in [(0.49, DVec3::Y), (-0.49, DVec3::NEG_Y)] {
                let found = only(&cube(), &at(x, y, z), &plate, &DAffine3::IDENTITY);
                assert_flat(&found, up, 0.01, 4);
            }
        }
    }
}

/// Law: shapes whose vertices are far from their local origins, as in coordinates of the earth, have the contacts that they have around them.
#[test]
fn far_from_local_origins_contacts_are_the_same() {
    let mut rng = seeded(SEED + 9);
    let (mut hits, cases) = (0, 300);
    // On a grid on which no coordinate is rounded, there or here.
    let on_grid = |p: DVec3| (p * 2f64.powi(20)).round() / 2f64.powi(20);
    for case in 0..cases {
        let far = (common::direction(&mut rng) * [3e3, 1e5, 5e6][case % 3]).round();
        let soup = |rng: &mut StdRng| {
            let mut soup = random_mesh(rng, 60);
            // The furthest are in another unit, and bent: there edges that are side by side up to the grid, or triangles in a plane, have two normals
            // of one depth.
            let most = [0.0, 0.0, 0.02][case % 3];
            let bend = |rng: &mut StdRng, vertex| on_grid(vertex + most * common::in_cube(rng));
            soup.vertices.iter_mut().for_each(|vertex| *vertex = bend(rng, *vertex));
            let here = soup.shape();
            soup.vertices.iter_mut().for_each(|vertex| *vertex += far);
            [here, soup.shape()]
        };
        let ([a, far_a], [b, far_b]) = (soup(&mut rng), soup(&mut rng));
        let still = DAffine3::IDENTITY;
        let at = DAffine3::from_translation(on_grid(1.6 * common::in_cube(&mut rng)));
        let (here, there) = (contacts(&a, &still, &b, &at), contacts(&far_a, &still, &far_b, &at));
        assert_eq!(here.len(), there.len(), "case {case}");
        for (x, y) in here.iter().zip(&there) {
            assert!((x.normal - y.normal).length() < 1e-5, "case {case}: {} and {}", x.normal, y.normal);
        }
        hits += usize::from(!here.is_empty());
        assert!((deepest(&here) - deepest(&there)).abs() < 1e-9 || here.is_empty(), "case {case}");
    }
    assert_rate("pairs", hits, cases);
}

/// A hull of points on a line, which rounding takes off it by turns, touches where it is.
#[test]
fn contacts_of_a_hull_that_is_a_line_up_to_rounding_are_on_it() {
    let mut rng = seeded(SEED + 17);
    let (ground, slab) = (floor(1), Shape::cuboid([4.0, 1.0, 4.0]).unwrap());
    let (mut hits, cases) = (0, 8_000);
    for case in 0..cases {
        let (from, along) = (in_cube(&mut rng) * DVec3::new(1.0, 0.3, 1.0), direction(&mut rng));
        let points: Vec<DVec3> = (0..3 + case % 6).map(|i| from + along * (0.25 * i as f64)).collect();
        let rod = Shape::convex_hull(&points).unwrap();
        for (shape, there) in [(&ground, at(0.0, 0.0, 0.0)), (&slab, at(0.0, -0.5, 0.0))] {
            let found = contacts(shape, &there, &rod, &DAffine3::IDENTITY);
            hits += usize::from(!found.is_empty());
            for point in found.iter().flat_map(|manifold| &manifold.points) {
                let off = query::closest_point(&rod, &DAffine3::IDENTITY, point.point_on_b).unwrap().distance;
                assert!(off < 1e-8, "case {case}: {off:e}, {point:?}");
            }
        }
    }
    assert_rate("rods", hits, 2 * cases);
}
