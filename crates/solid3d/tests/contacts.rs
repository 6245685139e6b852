//! Contacts of all kinds of shapes: by their laws, against the penetration depth, and known cases.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking and says what it did"
)]

mod common;

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use common::{assert_rate, at, placement, random_complex, random_mesh, sheet, size_of};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{Pair, Regime, direction, in_cube, random_pair, seeded};
use solid3d::query::{self, ContactOptions, ContactPoint, Feature, Manifold};
use solid3d::{ComplexShapeBuilder, Motion, Response, Shape, When, World, WorldOptions, glam};

const SEED: u64 = 20_262;

fn within(margin: f64) -> ContactOptions {
    ContactOptions { margin, ..ContactOptions::default() }
}

fn contacts(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> Vec<Manifold> {
    query::contacts(a, pa, b, pb, &ContactOptions::default()).unwrap()
}

/// The only region.
fn only(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> Manifold {
    let mut found = contacts(a, pa, b, pb);
    assert_eq!(found.len(), 1, "{found:#?}");
    found.remove(0)
}

fn cube() -> Shape {
    Shape::cuboid([1.0; 3]).unwrap()
}

/// A flat floor of squares of two triangles each, from -5 to 5.
fn floor(squares: u32) -> Shape {
    sheet(squares + 1, squares + 1, [false, false], |u, v| DVec3::new(10.0 * v - 5.0, 0.0, 10.0 * u - 5.0))
        .shape()
}

/// The surface of a unit cube, of 12 triangles.
fn cube_mesh() -> Shape {
    common::cube(0.5).shape()
}

/// How far the vertices of a placed mesh are along a direction.
fn reach(mesh: &Shape, at: &DAffine3, along: DVec3) -> f64 {
    let heights = mesh.vertices().unwrap().iter().map(|&vertex| along.dot(at.transform_point3(vertex)));
    heights.fold(f64::NEG_INFINITY, f64::max)
}

fn deepest(manifolds: &[Manifold]) -> f64 {
    manifolds.iter().flat_map(|m| &m.points).map(|point| point.depth).fold(f64::NEG_INFINITY, f64::max)
}

/// What holds of every answer.
fn assert_laws(manifolds: &[Manifold], margin: f64, size: f64, context: &str) {
    for Manifold { normal, points } in manifolds {
        assert!((normal.length() - 1.0).abs() < 1e-9, "{context}: {normal}");
        assert!(!points.is_empty(), "{context}: a manifold without points");
        for ContactPoint { point_on_a, point_on_b, depth, .. } in points {
            assert!(depth.is_finite() && *depth >= -margin - 1e-9 * size, "{context}: {depth}");
            let off = (point_on_b - point_on_a).distance(normal * *depth);
            // The deepest points of round bodies are known to the square root of the error of the depth.
            let limit = 3e-3 * depth.abs() + 1e-8 * size;
            assert!(off <= limit, "{context}: the points of depth {depth} are {off:e} off the normal");
        }
    }
}

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

fn assert_flat(found: &Manifold, normal: DVec3, depth: f64, count: usize) {
    assert!((found.normal - normal).length() < 1e-9, "{found:?}");
    assert_eq!(found.points.len(), count, "{found:#?}");
    for point in &found.points {
        assert!((point.depth - depth).abs() < 1e-7, "{point:?} is not {depth} deep");
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

/// What reaches over the edge between two triangles of one floor, by however little, is held up by both.
#[test]
fn a_floor_of_two_triangles_pushes_nothing_down() {
    let mut rng = seeded(SEED);
    let (floor, mut both) = (floor(1), 0);
    for case in 0..5_000 {
        // A keel, and what is above it.
        let mut above = || {
            DVec3::new(rng.random_range(-0.3..1.0), rng.random_range(0.03..0.5), rng.random_range(-0.4..0.4))
        };
        let corners: Vec<DVec3> =
            [DVec3::ZERO, DVec3::X].into_iter().chain([(); 6].map(|()| above())).collect();
        let shape = Shape::convex_hull(&corners).unwrap();
        // One of the diagonals is the edge, over which the keel leads by so little.
        let turn = DQuat::from_rotation_y(rng.random_range(0.0..TAU));
        let across = DVec3::new(1.0, 0.0, [1.0, -1.0][case % 2]).normalize();
        let beyond =
            across * (turn * DVec3::X).dot(across).signum() * 10f64.powf(rng.random_range(-4.0..-1.0));
        let low = DVec3::NEG_Y * rng.random_range(0.001..0.02);
        let at = DAffine3::from_rotation_translation(turn, beyond - turn * DVec3::X + low);
        let found = contacts(&shape, &at, &floor, &DAffine3::IDENTITY);
        let touched = found.iter().flat_map(|region| region.points.iter().map(|point| point.primitives[1]));
        both += usize::from(touched.collect::<BTreeSet<u32>>().len() == 2);
        assert!(found.iter().all(|region| region.normal.y > 0.999_999), "case {case}: {found:#?}");
    }
    assert!(both > 1_000, "{both} are over both triangles");
}

/// What comes through one triangle of a floor and leans over others is as deep as in a slab.
#[test]
fn what_leans_over_is_as_deep_as_it_is() {
    let mut rng = seeded(SEED);
    let (slab, below) = (Shape::cuboid([10.0, 1.0, 10.0]).unwrap(), at(0.0, -0.5, 0.0));
    let (floors, mut upward) = ([1, 4, 50].map(floor), 0);
    for case in 0..1_500 {
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let (shape, turned) = match case % 5 {
            // Sheared, so that corners are acute.
            0 => (
                cube(),
                turned * DAffine3::from_mat3(DMat3::from_cols(DVec3::X, direction(&mut rng), DVec3::Z)),
            ),
            1 => (Shape::cone(0.4, 0.3).unwrap(), turned),
            // Nearly upright: as deep as a point of its rim, which is no corner of what is clipped.
            2 => (
                Shape::cylinder(0.3, 0.2).unwrap(),
                DAffine3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 0.005)),
            ),
            _ => {
                let corners = [(); 9].map(|()| in_cube(&mut rng) * DVec3::new(1.0, 0.4, 0.3));
                (Shape::convex_hull(&corners).unwrap(), turned)
            }
        };
        let low = query::bounds(&shape, &turned).unwrap().min.y;
        let place = in_cube(&mut rng) * 3.0;
        let depth = rng.random_range(0.001..0.03);
        let placed = DAffine3::from_translation(DVec3::new(place.x, -low - depth, place.z)) * turned;
        let expected = deepest(&contacts(&shape, &placed, &slab, &below));
        for floor in &floors {
            let found = contacts(&shape, &placed, floor, &DAffine3::IDENTITY);
            // What is nearly flat leaves a surface downward where more of it is below, or is below it.
            if found.first().is_some_and(|region| region.normal.y > 0.0) {
                let off = (deepest(&found) - expected).abs();
                assert!(off < 1e-6 * expected, "case {case}: {found:#?}, {expected}");
                upward += 1;
            }
        }
    }
    assert!(upward > 4_450, "{upward} of 4,500 are held up");
}

/// Law: a body that dips into a flat floor is held up, as deep as it is below that: wherever the edges in the floor are, and whatever body.
#[test]
fn a_flat_floor_holds_any_body_up() {
    let mut rng = seeded(SEED);
    let floors = [1, 2, 9].map(floor);
    // The tip of a cone that leans over the edge between two triangles, and is below the first alone sooner than above it.
    let cone = Shape::cone(0.5, 2.0).unwrap();
    let leaning = at(0.45, 0.816, 0.05) * DAffine3::from_rotation_z(150_f64.to_radians());
    assert_eq!(only(&cone, &leaning, &floors[0], &DAffine3::IDENTITY).normal, DVec3::Y);
    for case in 0..20_000 {
        let shape = common::convex_of_kind(&mut rng, case % 6, [0.3, 0.5, 0.8], 0.2);
        let turned = DAffine3 { translation: DVec3::ZERO, ..placement(&mut rng, 1.0) };
        let bounds = query::bounds(&shape, &turned).unwrap();
        let depth = rng.random_range(0.0001..0.3) * (bounds.max.y - bounds.min.y);
        let beside = in_cube(&mut rng) * 2.0;
        let place = at(beside.x, -bounds.min.y - depth, beside.z) * turned;
        let floor = &floors[case as usize % floors.len()];
        let found = only(&shape, &place, floor, &DAffine3::IDENTITY);
        assert!(found.normal.distance(DVec3::Y) < 1e-6, "case {case}: {found:#?}, {depth}");
        let off = (deepest(&[found]) - depth).abs();
        assert!(off < 1e-6, "case {case}: {off:e} off {depth}");
    }
}

/// The surface of a cube, of so many squares along each edge.
fn squares(half: f64, squares: u32) -> common::Soup {
    let face = |axis: usize, sign: f64| {
        sheet(squares + 1, squares + 1, [false, false], |u, v| {
            let [u, v] = if sign > 0.0 { [u, v] } else { [v, u] }.map(|x| half * (2.0 * x - 1.0));
            let mut point = DVec3::ZERO;
            (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (half * sign, u, v);
            point
        })
    };
    common::joined([0, 1, 2].into_iter().flat_map(|axis| [face(axis, 1.0), face(axis, -1.0)]))
}

/// Law: so is a mesh, curved or with flat parts, of a solid or of a surface alone, by the normal of the floor and not by those of its own triangles.
#[test]
fn a_flat_floor_holds_meshes_up() {
    let mut rng = seeded(SEED);
    let table = common::block(DVec3::new(-5.0, -1.0, -5.0), DVec3::new(5.0, 0.0, 5.0));
    let far = common::block(DVec3::new(20.0, -1.0, 0.0), DVec3::new(21.0, 0.0, 1.0));
    // Not convex, so that it is no body.
    let tables = common::joined([table, far]).shape();
    let slab = |low: f64| common::block(DVec3::new(-5.0, low, -5.0), DVec3::new(5.0, 0.0, 5.0));
    let bodies = [slab(-1.0).shape(), Shape::convex_hull(&slab(-0.1).vertices).unwrap()];
    let meshes = [floor(1), floor(2), floor(9), tables.clone(), tables.into_solid().unwrap()];
    let floors: Vec<Shape> = meshes.into_iter().chain(bodies).collect();
    let mut beside = squares(0.3, 2);
    beside.vertices.iter_mut().for_each(|vertex| vertex.x += 1.2);
    let surfaces =
        [common::torus(12, 8, 0.3), common::joined([squares(0.5, 5), beside])].map(|soup| soup.shape());
    let solids = surfaces.each_ref().map(|surface| surface.clone().into_solid().unwrap());
    for case in 0..1200 {
        let shape = [&surfaces[0], &solids[0], &surfaces[1], &solids[1]][case % 4];
        let turned = match case % 8 {
            0..4 => DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU)),
            // Upright, or nearly.
            _ => {
                DAffine3::from_rotation_y(rng.random_range(0.0..TAU))
                    * DAffine3::from_rotation_x([0.0, 0.001, 0.1][case % 3])
            }
        };
        let low = -reach(shape, &turned, DVec3::NEG_Y);
        let (beside, depth) = (in_cube(&mut rng) * 2.0, rng.random_range(0.001..0.02));
        let place = at(beside.x, -low - depth, beside.z) * turned;
        let floor = &floors[case % floors.len()];
        let (found, swapped) = (
            contacts(shape, &place, floor, &DAffine3::IDENTITY),
            contacts(floor, &DAffine3::IDENTITY, shape, &place),
        );
        for (found, up) in [(&found, DVec3::Y), (&swapped, DVec3::NEG_Y)] {
            let is_up = |region: &Manifold| region.normal.distance(up) < 1e-9;
            assert!(!found.is_empty() && found.iter().all(is_up), "case {case}: {found:#?}");
            assert!((deepest(found) - depth).abs() < 1e-9, "case {case}: {found:#?}, {depth}");
        }
        let gap = rng.random_range(0.001..0.1);
        let above = at(0.0, depth + gap, 0.0) * place;
        let near = query::contacts(shape, &above, floor, &DAffine3::IDENTITY, &within(1.5 * gap)).unwrap();
        assert!(near.iter().all(|region| region.normal.distance(DVec3::Y) < 1e-9), "case {case}: {near:#?}");
        assert!((deepest(&near) + gap).abs() < 1e-9, "case {case}: {near:#?}, {gap}");
    }
}

/// The ridge of a roof of small triangles has the normals that the edge of a wedge has, and faces their own.
#[test]
fn a_ridge_of_small_triangles_is_an_edge() {
    let mut rng = seeded(SEED);
    let corner = |x: f64, y: f64| DVec3::new(x, -y.abs(), y);
    let wedge =
        Shape::convex_hull(&[-5.0, 5.0].map(|x| [-2.0, 0.0, 2.0].map(|y| corner(x, y))).concat()).unwrap();
    let roof = sheet(41, 101, [false, false], |u, v| corner(10.0 * v - 5.0, 4.0 * u - 2.0)).shape();
    let slope = DVec3::new(0.0, 1.0, 1.0).normalize();
    let mut at_the_ridge = 0;
    for case in 0..6_000 {
        let shape = match case % 4 {
            0 => Shape::cone(0.3, 0.6).unwrap(),
            1 => Shape::cylinder(0.2, 0.5).unwrap(),
            2 => Shape::cuboid([0.3, 0.4, 0.5]).unwrap(),
            _ => Shape::convex_hull(&[(); 12].map(|()| in_cube(&mut rng) * 0.3)).unwrap(),
        };
        let turned = DAffine3::from_axis_angle(direction(&mut rng), rng.random_range(0.0..TAU));
        let (above, aside) = (DAffine3::from_translation(DVec3::Y), rng.random_range(-0.05..0.05));
        let high = above * turned;
        let hit =
            query::cast_shape(&shape, &high, DVec3::NEG_Y * 2.0, &wedge, &at(0.03, 0.0, aside), DVec3::ZERO);
        let depth = 10f64.powf(rng.random_range(-4.0..-1.5));
        let lower = DVec3::NEG_Y * (2.0 * hit.unwrap().unwrap().time + depth);
        let placed = DAffine3::from_translation(lower - DVec3::new(0.03, 0.0, aside)) * high;
        let expected = only(&shape, &placed, &wedge, &DAffine3::IDENTITY);
        if expected.normal.dot(slope).max(expected.normal.dot(slope * DVec3::new(1.0, 1.0, -1.0))) > 0.999_999
        {
            continue;
        }
        let found = contacts(&shape, &placed, &roof, &DAffine3::IDENTITY);
        let near = query::contacts(&shape, &placed, &roof, &DAffine3::IDENTITY, &within(0.02)).unwrap();
        assert!(deepest(&near) > deepest(&found) - 1e-6, "case {case}: {near:#?}, not {found:#?}");
        for region in found {
            let is_of_a_face = (region.normal.abs() - slope).length() < 1e-6;
            let off = deepest(std::slice::from_ref(&region)) - deepest(std::slice::from_ref(&expected));
            assert!(
                is_of_a_face || region.normal.distance(expected.normal) < 1e-4 && off.abs() < 1e-6,
                "case {case}: {region:#?}, not {expected:#?}"
            );
            at_the_ridge += usize::from(!is_of_a_face);
        }
    }
    assert!(at_the_ridge > 1_500, "{at_the_ridge}");
}

/// A box a little off a floor, tilted: all four corners within the margin, with their gaps.
#[test]
fn gaps_within_the_margin_are_contacts() {
    let (plate, here) = (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), DAffine3::IDENTITY);
    let tilted = at(0.0, 1.01, 0.0) * DAffine3::from_rotation_z(0.005);
    for floor in [&plate, &floor(4)] {
        let lift = if floor.triangles().is_some() { -0.5 } else { 0.0 };
        let place = at(0.0, lift, 0.0) * tilted;
        assert!(contacts(&cube(), &place, floor, &here).is_empty());
        let found = query::contacts(&cube(), &place, floor, &here, &within(0.05)).unwrap();
        assert_eq!((found.len(), found[0].points.len()), (1, 4), "{found:?}");
        assert_laws(&found, 0.05, 10.0, "tilted");
        let mut depths: Vec<f64> = found[0].points.iter().map(|point| point.depth).collect();
        depths.sort_by(f64::total_cmp);
        assert!((depths[3] - depths[0] - 0.005).abs() < 1e-5 && depths[3] < 0.0, "{depths:?}");
        let near = query::contacts(&cube(), &place, floor, &here, &within(0.008)).unwrap();
        assert_eq!(near[0].points.len(), 2, "{near:?}");
    }
    for gap in [1e-13, 1e-11, 1e-9, 1e-6] {
        let found = query::contacts(&cube(), &at(0.0, 1.0 + gap, 0.0), &plate, &here, &within(0.01)).unwrap();
        assert_eq!((found[0].points.len(), found[0].normal), (4, DVec3::Y), "{gap}: {found:?}");
    }
}

/// Law: what is nearer than a margin has a contact there, as deep as the gap is wide, however small that is: down to 1e-11 of the size, also of
/// shapes of which one is small.
#[test]
fn what_is_nearer_than_the_margin_has_a_contact() {
    let mut rng = seeded(SEED + 10);
    let (mut apart, cases) = (0, 6_000);
    for case in 0..cases {
        let soup = match case % 4 {
            0 => random_mesh(&mut rng, 12),
            1 => random_complex(&mut rng, 6),
            _ => common::grid(&mut rng, 4, 4),
        };
        let (a, b) = (soup.shape(), common::some_shape(&mut rng, case / 4));
        let [pa, mut pb] = [0, 1].map(|_| placement(&mut rng, 1.0));
        if case % 3 == 0 {
            pb.matrix3 *= 10f64.powf(rng.random_range(-3.0..0.0));
        }
        let size = size_of(&a, &pa, &b, &pb);
        pb.translation = pa.translation + direction(&mut rng) * size;
        let between = query::distance(&a, &pa, &b, &pb).unwrap();
        let Some(way) = (between.point_on_b - between.point_on_a).try_normalize() else { continue };
        let gap = size * 10f64.powf(rng.random_range(-11.0..-6.0));
        pb.translation -= way * (between.distance - gap);
        let distance = query::distance(&a, &pa, &b, &pb).unwrap().distance;
        if distance == 0.0 {
            continue;
        }
        apart += 1;
        let found = query::contacts(&a, &pa, &b, &pb, &within(0.05 * size)).unwrap();
        let context =
            format!("case {case}: {} {pa:?} {} {pb:?}, {distance:e} apart of {size}", a.kind(), b.kind());
        assert_laws(&found, 0.05 * size, size, &context);
        let deepest = deepest(&found);
        assert!((deepest + distance).abs() <= 1e-8 * size, "{context}: {deepest}, {found:?}");
    }
    println!("{apart} of {cases} are apart");
    assert!(apart * 10 > cases * 9, "{apart} of {cases}");
}

/// So has what reaches around the end of a plate, and is for the most part on its other side.
#[test]
fn a_hook_over_the_end_of_a_plate_is_within_the_margin() {
    let here = DAffine3::IDENTITY;
    for width in [1.0, 4.0, 30.0] {
        let ends = [DVec3::new(-width, 0.0, -width), DVec3::new(-width, 0.0, width), DVec3::X];
        let plate = Shape::mesh(ends, [[0, 1, 2]]).unwrap();
        for bend in [3.0, -3.0, -9.0] {
            let corners = [
                DVec3::new(0.0, 0.125, 0.0),
                DVec3::new(3.0, 0.5, -0.5),
                DVec3::new(3.0, 0.5, 0.5),
                DVec3::new(3.0, bend, 0.0),
            ];
            let hook = Shape::mesh(corners, [[0, 1, 2], [1, 2, 3]]).unwrap();
            for (a, b, normal) in [(&hook, &plate, DVec3::Y), (&plate, &hook, DVec3::NEG_Y)] {
                let found = query::contacts(a, &here, b, &here, &within(0.5)).unwrap();
                let context = format!("{width} wide, bent to {bend}: {found:?}");
                assert_laws(&found, 0.5, width, &context);
                assert!(found.len() == 1 && (deepest(&found) + 0.125).abs() < 1e-12, "{context}");
                assert!((found[0].normal - normal).length() < 1e-12, "{context}");
            }
        }
    }
}

/// A needle stands on its end, also over a floor that it does not meet yet.
#[test]
fn a_needle_over_a_floor_is_within_the_margin() {
    let needle = Shape::convex_hull(&[DVec3::Y, -DVec3::Y]).unwrap();
    let segment = ComplexShapeBuilder::new([DVec3::Y, -DVec3::Y]).segment([0, 1]).build().unwrap();
    for tilt in [0.0, 1e-9, 1e-7, 1e-6, 1e-3] {
        let place = at(0.3, 1e-4 + f64::cos(tilt), 0.2) * DAffine3::from_rotation_z(tilt);
        for shape in [&needle, &segment] {
            let found =
                query::contacts(shape, &place, &floor(8), &DAffine3::IDENTITY, &within(1e-3)).unwrap();
            assert_eq!(found.len(), 1, "tilted by {tilt}");
            assert_flat(&found[0], DVec3::Y, -1e-4, 1);
        }
    }
}

/// Two unit cubes of triangles, 0.30 in each other: that deep, everywhere.
#[test]
fn cubes_of_triangles_are_as_deep_as_cubes() {
    let mesh = cube_mesh();
    let solid = mesh.clone().into_solid().unwrap();
    for (a, b) in [(&mesh, &mesh), (&mesh, &solid), (&solid, &solid), (&mesh, &cube()), (&solid, &cube())] {
        for place in [at(0.7, 0.0, 0.0), at(0.7, 0.1, 0.2)] {
            assert_flat(&only(a, &place, b, &DAffine3::IDENTITY), DVec3::X, 0.3, 4);
        }
    }
    // A surface has no inside.
    let small = Shape::cuboid([0.1; 3]).unwrap();
    assert!(contacts(&small, &at(0.1, 0.0, 0.0), &mesh, &DAffine3::IDENTITY).is_empty());
    assert_eq!(contacts(&small, &at(0.1, 0.0, 0.0), &solid, &DAffine3::IDENTITY).len(), 1);
}

/// What is inside a surface that is closed and convex, but not solid, is beside its triangles: as near as it is to them, and no nearer.
#[test]
fn what_is_inside_a_surface_is_near_its_triangles() {
    let (hollow, ball) = (common::cube(1.0).shape(), Shape::sphere(0.25).unwrap());
    let (here, inside) = (at(0.0, 0.0, 0.0), at(0.625, 0.125, 0.25));
    let near = |margin| query::contacts(&ball, &inside, &hollow, &here, &within(margin)).unwrap();
    assert!(near(0.0).is_empty() && near(0.1).is_empty());
    let found = near(0.25);
    assert_eq!((found.len(), found[0].normal, found[0].points.len()), (1, DVec3::NEG_X, 1));
    let ContactPoint { point_on_a, point_on_b, depth, .. } = found[0].points[0];
    assert!((depth + 0.125).abs() < 1e-12, "{depth}");
    assert!(point_on_a.distance(DVec3::new(0.875, 0.125, 0.25)) < 1e-6, "{point_on_a}");
    assert!(point_on_b.distance(DVec3::new(1.0, 0.125, 0.25)) < 1e-6, "{point_on_b}");
    // So it is of two such surfaces, whichever is inside. A solid has the other in it.
    let small = common::cube(0.5).shape();
    assert!(query::contacts(&small, &here, &hollow, &here, &within(0.25)).unwrap().is_empty());
    let found = query::contacts(&hollow, &here, &small, &here, &within(0.625)).unwrap();
    assert_eq!(found.len(), 6);
    assert!(
        found.iter().flat_map(|m| &m.points).all(|point| (point.depth + 0.5).abs() < 1e-12),
        "{found:#?}"
    );
    // And of a solid that is not convex: a shell, thin as a leaf, in a box that is sheared.
    let shell = common::joined([common::cube(1.0), common::cube(-0.25)]).shape().into_solid().unwrap();
    let leaf = DMat3::from_cols_array_2d(&[
        [0.0008, -0.0004, -0.0012],
        [-0.045, 0.0056, -0.0059],
        [0.057, 0.0096, -0.005],
    ]);
    let sheared =
        DMat3::from_cols_array_2d(&[[-0.145, -0.127, -0.084], [0.772, -1.295, 0.631], [-0.272, 0.037, 0.41]]);
    let [leaf, sheared] = [leaf, sheared].map(DAffine3::from_mat3);
    let gap = query::distance(&shell, &leaf, &hollow, &sheared).unwrap().distance;
    let found = query::contacts(&shell, &leaf, &hollow, &sheared, &within(1.5 * gap)).unwrap();
    assert!((deepest(&found) + gap).abs() < 1e-12, "{found:#?}, {gap}");
    let solid = hollow.into_solid().unwrap();
    assert!(deepest(&query::contacts(&solid, &here, &ball, &inside, &within(0.25)).unwrap()) > 0.5);
}

/// Near a solid that is not convex, what is apart is in none of its walls, also where the margin reaches through them.
#[test]
fn a_margin_does_not_lead_through_walls() {
    let mut rng = seeded(SEED + 9);
    let ring = common::torus(24, 8, 0.25).shape().into_solid().unwrap();
    let (mut near, cases) = (0, 300);
    for case in 0..cases {
        let (at_ring, mut at_box) = (placement(&mut rng, 0.0), placement(&mut rng, 0.0));
        at_box.translation = common::in_cube(&mut rng);
        let block = Shape::cuboid([0.2, 0.3, 0.4]).unwrap();
        if query::intersects(&ring, &at_ring, &block, &at_box).unwrap() {
            continue;
        }
        let distance = query::distance(&ring, &at_ring, &block, &at_box).unwrap().distance;
        let found = query::contacts(&ring, &at_ring, &block, &at_box, &within(distance + 0.5)).unwrap();
        near += 1;
        let deepest = deepest(&found);
        assert!((deepest + distance).abs() < 1e-9, "case {case}: {deepest}, {distance} apart");
    }
    println!("{near} of {cases} are apart");
    assert!(near > cases / 3);
}

/// What is wholly inside a solid leaves it by the shortest way out, with any margin: also where that reaches a wall, from inside.
#[test]
fn a_margin_does_not_turn_what_is_inside() {
    let ring = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)];
    let level = |z: f64| ring.map(|(x, y)| DVec3::new(x, y, z));
    let caps = [[0_u32, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let caps = caps.into_iter().flat_map(|[i, j, k]| [[i, k, j], [i + 6, j + 6, k + 6]]);
    let sides = (0..6).map(|i| [i, (i + 1) % 6]).flat_map(|[i, j]| [[i, j, i + 6], [j, j + 6, i + 6]]);
    let corner = Shape::mesh([level(0.0), level(1.0)].concat(), caps.chain(sides).collect::<Vec<_>>());
    let corner = corner.unwrap().into_solid().unwrap();
    let place = at(1.0, 1.0, 0.8);
    for shape in [Shape::sphere(0.1).unwrap(), Shape::cuboid([0.2; 3]).unwrap()] {
        for margin in [0.0, 0.05, 0.15, 0.5] {
            let found =
                query::contacts(&shape, &place, &corner, &DAffine3::IDENTITY, &within(margin)).unwrap();
            assert_eq!((found.len(), found[0].normal), (1, DVec3::Z), "{margin}: {found:#?}");
            assert!((deepest(&found) - 0.3).abs() < 1e-12, "{margin}: {found:#?}");
        }
    }
}

/// What leans over is as deep with a margin as without.
#[test]
fn a_margin_loses_nothing_of_what_leans_over() {
    let plate =
        DMat3::from_cols(DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, -0.5, -3.0), DVec3::new(0.0, 0.0, 0.03));
    let plate = DAffine3::from_mat3(plate);
    let corners =
        [(-64.0, -64.0), (-64.0, 64.0), (64.0, -64.0), (64.0, 64.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let (ground, below) = (Shape::mesh(corners, [[0, 1, 2], [1, 3, 2]]).unwrap(), at(0.3, -0.3, -2.0));
    for margin in [0.0, 1e-6, 0.01, 0.05, 0.075, 0.2] {
        let found = query::contacts(&cube(), &plate, &ground, &below, &within(margin)).unwrap();
        assert!((deepest(&found) - 0.45).abs() < 1e-12, "{margin}: {found:#?}");
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

/// Sliding over a floor of triangles gives what one big box would: its normal, and the corners of what slides.
#[test]
fn internal_edges_have_no_normals() {
    let mut rng = seeded(SEED);
    let block = Shape::cuboid([1.0, 1.0, 1.5]).unwrap();
    let cylinder = Shape::cylinder(0.5, 1.0).unwrap();
    let sphere = Shape::sphere(0.5).unwrap();
    for squares in [3, 10, 40] {
        let floor = floor(squares);
        for step in 0..60 {
            let slide = DVec3::new(rng.random_range(-2.0..2.0), 0.0, rng.random_range(-2.0..2.0));
            let depth = if step % 3 == 0 { 0.2 } else { 0.001 };
            let turn =
                DAffine3::from_rotation_y(if step % 2 == 0 { 0.0 } else { rng.random_range(0.0..TAU) });
            for (shape, half, count) in
                [(&block, 0.5, 4), (&cube_mesh(), 0.5, 4), (&cylinder, 0.5, 16), (&sphere, 0.5, 1)]
            {
                let place = DAffine3::from_translation(slide + DVec3::Y * (half - depth)) * turn;
                let found = only(shape, &place, &floor, &DAffine3::IDENTITY);
                assert_eq!(found.normal, DVec3::Y, "{squares}, step {step}: {found:?}");
                // Where only the arc beyond a corner of a circle reaches a triangle, that adds a point.
                let more = if count == 16 { found.points.len().clamp(16, 24) } else { count };
                assert_flat(&found, DVec3::Y, depth, more);
            }
        }
    }
}

/// Triangles of which two corners are one change no contact: they are but edges and corners of others.
#[test]
fn collapsed_triangles_have_no_normals() {
    let mut rng = seeded(SEED);
    let collapsed = |mesh: &Shape| {
        let triangles = mesh.triangles().unwrap();
        let more = triangles.iter().flat_map(|&[i, j, k]| [[i, i, j], [j, k, j], [k; 3]]);
        let all: Vec<_> = triangles.iter().copied().chain(more).collect();
        Shape::mesh(mesh.vertices().unwrap(), all).unwrap()
    };
    let (floor, mesh) = (collapsed(&floor(10)), collapsed(&cube_mesh()));
    let sphere = Shape::sphere(0.5).unwrap();
    for step in 0..60 {
        let depth = if step % 3 == 0 { 0.2 } else { 0.001 };
        let place = at(rng.random_range(-2.0..2.0), 0.5 - depth, rng.random_range(-2.0..2.0))
            * DAffine3::from_rotation_y(rng.random_range(0.0..TAU));
        for (shape, count) in [(&cube(), 4), (&mesh, 4), (&sphere, 1)] {
            assert_flat(&only(shape, &place, &floor, &DAffine3::IDENTITY), DVec3::Y, depth, count);
        }
        let above = at(0.0, 1.0 - depth, 0.0) * place;
        assert_flat(&only(&cube(), &above, &mesh, &place), DVec3::Y, depth, 4);
    }
}

/// A convex edge of a mesh is no internal one.
#[test]
fn ridges_have_normals() {
    let ridge = Shape::mesh(
        [
            [-1.0, 0.0, -3.0],
            [-1.0, 0.0, 3.0],
            [0.0, 1.0, -3.0],
            [0.0, 1.0, 3.0],
            [1.0, 0.0, -3.0],
            [1.0, 0.0, 3.0],
        ]
        .map(DVec3::from),
        [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]],
    )
    .unwrap();
    let found = only(&cube(), &at(0.0, 1.49, 0.0), &ridge, &DAffine3::IDENTITY);
    assert_flat(&found, DVec3::Y, 0.01, 2);
    // In the valley below it, a ball touches both sides.
    let flipped = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let ball = Shape::sphere(0.5).unwrap();
    let found = contacts(&ball, &at(0.0, -1.0 + 0.5f64.sqrt() - 0.01, 0.1), &ridge, &flipped);
    let mut normals: Vec<f64> = found.iter().map(|manifold| manifold.normal.x).collect();
    normals.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!((normals[0] + 0.5f64.sqrt()).abs() < 1e-9 && (normals[1] - 0.5f64.sqrt()).abs() < 1e-9);
}

/// Law: a region has one normal also where a surface turns by so little from facet to facet that all of them are of one normal with
/// the next: that of the surface at each of its points.
#[test]
fn a_smooth_surface_has_many_normals() {
    // A quarter of a pipe along z, in facets of 4e-4 radians, and a rod that nearly fills it.
    let facets = 4000;
    let angle = |i: u32| PI + FRAC_PI_4 + FRAC_PI_2 * f64::from(i) / f64::from(facets);
    let edge = |i: u32| [-1.0, 1.0].map(|z| DVec3::new(angle(i).cos(), angle(i).sin(), z));
    let vertices: Vec<DVec3> = (0..=facets).flat_map(edge).collect();
    let strip = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
    let pipe = Shape::mesh(vertices, (0..facets).flat_map(strip).collect::<Vec<_>>()).unwrap();
    let rod = Shape::cylinder(0.999, 1.0).unwrap();
    let along_z = DAffine3::from_rotation_x(FRAC_PI_2);
    let found = query::contacts(&rod, &along_z, &pipe, &DAffine3::IDENTITY, &within(0.01)).unwrap();
    let mut points = 0;
    for region in &found {
        for point in &region.points {
            let inward = -DVec3::new(point.point_on_b.x, point.point_on_b.y, 0.0);
            let off = region.normal.angle_between(inward);
            assert!(off < 2e-3, "{off} radians at {point:?}");
            points += 1;
        }
    }
    println!("{} regions of {points} points", found.len());
    assert!((700..2000).contains(&found.len()), "{} regions", found.len());
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

/// What stands on the upper floor of a step, and hangs over its edge, is held by that floor: not pushed off by the riser below it.
#[test]
fn a_step_pushes_nothing_aside_that_stands_on_it() {
    // From left to right: the upper floor, the riser, the lower floor.
    let profile = |u: f64| match 3.0 * u {
        t if t <= 1.0 => DVec3::new(-5.0 + 5.0 * t, 1.0, 0.0),
        t if t <= 2.0 => DVec3::new(0.0, 2.0 - t, 0.0),
        t => DVec3::new(5.0 * (t - 2.0), 0.0, 0.0),
    };
    let step = sheet(13, 41, [false, false], |u, v| profile(u) + DVec3::Z * (10.0 * v - 5.0)).shape();
    let (mut rng, mut over) = (seeded(SEED), 0);
    for i in 0..400 {
        let depth = [0.001, 0.01, 0.05][i % 3];
        // So far over the edge that up is the shortest way out, and not so far that it would fall.
        let beyond = rng.random_range(-0.4..0.45);
        let turn = DAffine3::from_rotation_y(if i % 2 == 0 { 0.0 } else { rng.random_range(0.0..TAU) });
        let tilt = rng.random_range(-0.002..0.002);
        let tilted = DAffine3::from_axis_angle(common::direction(&mut rng), tilt);
        let place = at(beyond - 0.5, 1.5 - depth, rng.random_range(-2.0..2.0)) * tilted * turn;
        let reach = (0..8).map(|i| {
            let corner = DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -0.5 } else { 0.5 }));
            place.transform_point3(corner).x
        });
        let overhang = reach.fold(f64::NEG_INFINITY, f64::max);
        if overhang > 0.0 && overhang < 4.0 * depth {
            continue;
        }
        over += usize::from(overhang > 0.0);
        let found = contacts(&cube(), &place, &step, &DAffine3::IDENTITY);
        assert!(!found.is_empty(), "box {i}");
        for manifold in &found {
            assert!(manifold.normal.y > 0.99, "box {i}, {overhang} over the edge: {manifold:#?}");
        }
        let most = depth + 2.0 * tilt.abs();
        assert!(deepest(&found) <= most, "box {i}, {depth} deep: {found:#?}");
    }
    assert_rate("boxes over the edge", over, 400);
}

/// A box that is let down on hills stands on what of them is under it, also where they are higher beside it: nearly all of its contacts hold it up.
#[test]
fn hills_hold_up_what_stands_on_them() {
    let hills = |u: f64, v: f64| {
        let (x, z) = (6.0 * u - 3.0, 6.0 * v - 3.0);
        DVec3::new(x, 0.03 * (9.0 * x).sin() * (7.0 * z).cos(), z)
    };
    let ground = sheet(81, 81, [false, false], hills).shape();
    let (mut rng, mut upward, mut all) = (seeded(SEED), 0, 0);
    for i in 0..200 {
        let turn = DAffine3::from_rotation_y(rng.random_range(0.0..TAU));
        let high = at(rng.random_range(-1.5..1.5), 1.0, rng.random_range(-1.5..1.5)) * turn;
        let cast = query::cast_shape(&cube(), &high, DVec3::NEG_Y, &ground, &DAffine3::IDENTITY, DVec3::ZERO);
        let depth = [0.001, 0.005, 0.02][i % 3];
        let mut place = high;
        place.translation.y -= cast.unwrap().unwrap().time + depth;
        let found = contacts(&cube(), &place, &ground, &DAffine3::IDENTITY);
        // A slope across which it is left is a little deeper.
        assert!(deepest(&found) <= 1.01 * depth, "box {i}, {depth} deep: {found:#?}");
        let up = |manifold: &&Manifold| manifold.normal.y > 1.0 - 1e-9;
        upward += found.iter().filter(up).map(|manifold| manifold.points.len()).sum::<usize>();
        all += found.iter().map(|manifold| manifold.points.len()).sum::<usize>();
    }
    println!("{upward} of {all} points hold the box up");
    assert!(10 * upward > 9 * all, "{upward} of {all}");
}

/// A flat ground of jittered squares, cut along either diagonal, with holes.
fn ground_with_holes(rng: &mut StdRng) -> (Vec<[DVec3; 3]>, Shape) {
    const SIDE: u32 = 16;
    let mut place = |i: u32| f64::from(i) * 0.25 - 2.0 + rng.random_range(-0.08..0.08);
    let vertices: Vec<DVec3> = (0..=SIDE)
        .flat_map(|i| (0..=SIDE).map(move |j| (i, j)))
        .map(|(i, j)| DVec3::new(place(i), 0.0, place(j)))
        .collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
        let [a, b] = [i * (SIDE + 1) + j, (i + 1) * (SIDE + 1) + j];
        let square = if rng.random() {
            [[a, a + 1, b], [b, a + 1, b + 1]]
        } else {
            [[a, a + 1, b + 1], [a, b + 1, b]]
        };
        if rng.random_bool(0.97) {
            triangles.extend(square);
        }
    }
    let corners = triangles.iter().map(|triangle| triangle.map(|i| vertices[i as usize])).collect();
    (corners, Shape::mesh(vertices, triangles).unwrap())
}

/// What is left of a convex polygon on the left of each edge of a triangle, seen from above (Sutherland and Hodgman).
fn clipped(polygon: &[DVec3], triangle: &[DVec3; 3]) -> Vec<DVec3> {
    let mut left = polygon.to_vec();
    for (from, to) in (0..3).map(|i| (triangle[i], triangle[(i + 1) % 3])) {
        let inside = |p: DVec3| (to - from).cross(p - from).y;
        let edges: Vec<_> = left.iter().copied().zip(left.iter().copied().cycle().skip(1)).collect();
        left.clear();
        for (p, q) in edges {
            let (here, there) = (inside(p), inside(q));
            left.extend((here >= 0.0).then_some(p));
            left.extend(((here >= 0.0) != (there >= 0.0)).then(|| p.lerp(q, here / (here - there))));
        }
    }
    left
}

/// Law: what a flat face has in common with a flat ground is what it has with all triangles of that.
#[test]
fn a_flat_ground_is_the_sum_of_its_triangles() {
    const DEPTH: f64 = 0.002;
    let (mut rng, mut holed, mut whole, cases) = (seeded(SEED), 0, 0, 300);
    for case in 0..cases {
        let (triangles, ground) = ground_with_holes(&mut rng);
        let sides = if case % 3 == 0 { 4 } else { rng.random_range(3..30) };
        let phase = rng.random_range(0.0..TAU);
        let corner =
            |i: u32| DQuat::from_rotation_y(phase - TAU * f64::from(i) / f64::from(sides)) * DVec3::X;
        let face: Vec<DVec3> = (0..sides).map(corner).collect();
        let body =
            Shape::convex_hull(&face.iter().flat_map(|&p| [p, p + DVec3::Y]).collect::<Vec<_>>()).unwrap();
        let middle = DVec3::new(rng.random_range(-0.8..0.8), -DEPTH, rng.random_range(-0.8..0.8));
        let tilt = [0.0, 1e-4, 8e-3][case as usize / 3 % 3];
        let way = DVec3::new(rng.random_range(-1.0..1.0), 0.0, rng.random_range(-1.0..1.0)).normalize();
        let place = DAffine3::from_rotation_translation(DQuat::from_scaled_axis(way * tilt), middle);
        // A triangle beside a hole is left aside, if that is shorter.
        let error = 1.1 * (DEPTH + tilt);
        let margin = [0.0, 0.002, 0.005][case as usize % 3];
        let options = within(margin);
        let on_face = |p: DVec3| {
            let normal = place.transform_vector3(DVec3::Y);
            let lift = normal.dot(place.translation - p) / normal.y;
            p + DVec3::Y * lift
        };
        let seen: Vec<DVec3> =
            face.iter().map(|&p| place.transform_point3(p) * DVec3::new(1.0, 0.0, 1.0)).collect();
        let expected: Vec<DVec3> = triangles
            .iter()
            .flat_map(|triangle| clipped(&seen, triangle))
            .filter(|&p| on_face(p).y <= margin)
            .collect();
        // Turned with all of it, so that normals are rounded.
        let turn = DQuat::from_scaled_axis(in_cube(&mut rng) * f64::from(case % 2) * PI);
        let turned = DAffine3::from_rotation_translation(turn, in_cube(&mut rng) * 10.0);
        let found = query::contacts(&ground, &turned, &body, &(turned * place), &options).unwrap();
        let back = turned.inverse();
        let points = found.iter().flat_map(|manifold| &manifold.points);
        let found: Vec<DVec3> = points.map(|point| back.transform_point3(point.point_on_a)).collect();
        for k in 0..64 {
            let along = DQuat::from_rotation_y(TAU * f64::from(k) / 64.0) * DVec3::X;
            let reach = |points: &[DVec3]| points.iter().map(|p| p.dot(along)).fold(f64::MIN, f64::max);
            let off = reach(&found) - reach(&expected);
            assert!(off.abs() < error, "case {case}, {tilt}, {margin}: {off:e} along {along}");
        }
        *(if found.len() as u32 == sides { &mut whole } else { &mut holed }) += 1;
    }
    println!("{whole} faces are on the ground as a whole, {holed} are not");
    assert!(whole > cases / 10 && holed > cases / 10, "{whole} {holed}");
}

/// Two flat grounds of one plane are two regions, each of which ends at the gap between them.
#[test]
fn a_gap_parts_a_flat_ground() {
    let half = |side: f64| {
        sheet(21, 21, [false, false], move |u, v| {
            DVec3::new(side * (0.1 + 2.0 * v), 0.0, side * (2.0 * u - 1.0))
        })
    };
    let [left, right] = [half(-1.0), half(1.0)].map(|half| half.shape());
    let count = left.vertices().unwrap().len() as u32;
    let vertices: Vec<DVec3> =
        [&left, &right].iter().flat_map(|half| half.vertices().unwrap().to_vec()).collect();
    let moved = right.triangles().unwrap().iter().map(|triangle| triangle.map(|i| i + count));
    let triangles: Vec<_> = left.triangles().unwrap().iter().copied().chain(moved).collect();
    let ground = Shape::mesh(vertices, triangles).unwrap();
    let found = contacts(&cube(), &at(0.0, 0.49, 0.0), &ground, &DAffine3::IDENTITY);
    assert_eq!(found.len(), 2);
    for manifold in &found {
        assert_flat(manifold, DVec3::Y, 0.01, 4);
        let near = manifold.points.iter().filter(|point| (point.point_on_a.x.abs() - 0.1).abs() < 1e-9);
        assert_eq!(near.count(), 2, "{manifold:#?}");
    }
}

/// What stands on hills, below others that are within the margin, is not in those.
#[test]
fn a_ceiling_within_the_margin_is_not_what_stands_on_the_floor() {
    let hill = |x: f64, z: f64| 0.01 * (9.0 * x).sin() * (7.0 * z).cos();
    // Down one sheet, and back by the other.
    let cave = sheet(42, 21, [false, false], |u, v| {
        let (x, z) = (4.0 * if u < 0.5 { u } else { 1.0 - u } - 1.0, 2.0 * v - 1.0);
        DVec3::new(x, hill(x, z) + if u < 0.5 { 0.0 } else { 1.08 }, z)
    });
    let cave = cave.shape();
    let mut rng = seeded(SEED);
    for i in 0..100 {
        let turn = DAffine3::from_rotation_y(rng.random_range(0.0..TAU));
        let place = at(0.0, 0.5, 0.0) * turn;
        let found = query::contacts(&cube(), &place, &cave, &DAffine3::IDENTITY, &within(0.1)).unwrap();
        let points = || found.iter().flat_map(|manifold| &manifold.points);
        assert!(deepest(&found) < 0.0101, "box {i}: {found:#?}");
        assert!(points().any(|point| point.depth > 0.0 && point.point_on_b.y < 0.1), "box {i}: {found:#?}");
        assert!(points().any(|point| point.depth < 0.0 && point.point_on_b.y > 1.0), "box {i}: {found:#?}");
    }
}

/// A body that stands on a pebble in a groove is held by the walls of that, too.
#[test]
fn a_groove_holds_from_both_sides_what_stands_in_it() {
    let mut vertices = vec![DVec3::ZERO];
    vertices.extend(
        [(0.03, 0.03), (0.03, -0.03), (-0.03, -0.03), (-0.03, 0.03)].map(|(x, z)| DVec3::new(x, -0.1, z)),
    );
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    for (side, first) in [(1.0, 5), (-1.0, 9)] {
        let corners = [(-0.15, 2.0), (-0.15, -2.0), (1.0, -2.0), (1.0, 2.0)];
        vertices.extend(corners.map(|(y, z)| DVec3::new(side * (0.205 + y), y, z)));
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let groove = Shape::mesh(vertices, triangles).unwrap();
    let corners = (0..8).map(|i| {
        let [x, y, z] = [0, 1, 2].map(|k| f64::from(i >> k & 1));
        DVec3::new((2.0 * x - 1.0) * (0.2 + y), y, 2.0 * z - 1.0)
    });
    let keel = Shape::convex_hull(&corners.collect::<Vec<_>>()).unwrap();
    let found = contacts(&keel, &at(0.0, -0.01, 0.0), &groove, &DAffine3::IDENTITY);
    for (way, depth) in [
        (DVec3::Y, 0.01),
        (DVec3::new(-1.0, 1.0, 0.0), 0.005 / 2f64.sqrt()),
        (DVec3::new(1.0, 1.0, 0.0), 0.005 / 2f64.sqrt()),
    ] {
        let is_there = |manifold: &Manifold| {
            manifold.normal.distance(way.normalize()) < 1e-9
                && manifold.points.iter().any(|point| (point.depth - depth).abs() < 1e-9)
        };
        assert!(found.iter().any(is_there), "{way}: {found:#?}");
    }
}

/// Separate regions are reported apart.
#[test]
fn a_table_stands_on_its_legs() {
    let legs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut vertices = Vec::new();
    let mut builder_legs = Vec::new();
    for (x, z) in legs {
        let first = vertices.len() as u32;
        for i in 0..8u32 {
            let corner = DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -0.1 } else { 0.1 }));
            vertices.push(corner * DVec3::new(1.0, 5.0, 1.0) + DVec3::new(x, 0.5, z));
        }
        builder_legs.push((first..first + 8).collect::<Vec<u32>>());
    }
    let table = builder_legs
        .iter()
        .fold(solid3d::ComplexShapeBuilder::new(vertices), |builder, leg| builder.polyhedron(leg))
        .build()
        .unwrap();
    let found = contacts(&table, &at(0.0, -0.01, 0.0), &floor(10), &DAffine3::IDENTITY);
    assert_eq!(found.len(), 4, "{found:#?}");
    for (leg, manifold) in (0..).zip(&found) {
        assert_flat(manifold, DVec3::Y, 0.01, 4);
        assert!(manifold.points.iter().all(|point| point.primitives[0] == leg));
    }
}

fn names(manifold: &Manifold) -> BTreeSet<([u32; 2], [Feature; 2])> {
    manifold.points.iter().map(|point| (point.primitives, point.features)).collect()
}

/// While the same parts are in contact, the same names: each its own.
#[test]
fn names_persist() {
    let plate = Shape::cuboid([4.0, 1.0, 4.0]).unwrap();
    let shapes = [cube(), Shape::cylinder(0.5, 1.0).unwrap(), cube_mesh(), Shape::capsule(0.2, 0.6).unwrap()];
    for (k, shape) in shapes.iter().enumerate() {
        let mut before = None;
        for frame in 0..50 {
            let t = f64::from(frame);
            let turn =
                DQuat::from_rotation_y(0.3 + 0.001 * t) * DQuat::from_rotation_z(1e-4 * (0.1 * t).sin());
            let place = DAffine3::from_rotation_translation(turn, DVec3::new(0.002 * t, 0.95, 0.1));
            let found = query::contacts(shape, &place, &plate, &DAffine3::IDENTITY, &within(0.1)).unwrap();
            let now = names(&found[0]);
            if k < 3 {
                assert_eq!(now.len(), found[0].points.len(), "shape {k}: {found:#?}");
            }
            assert!(before.is_none_or(|before| before == now), "shape {k}, frame {frame}: {found:#?}");
            before = Some(now);
        }
    }
}

#[test]
fn at_most_so_many_points() {
    let (plate, here) = (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), DAffine3::IDENTITY);
    let cylinder = Shape::cylinder(0.5, 1.0).unwrap();
    for most in [0, 1, 2, 4, 7] {
        let options = ContactOptions { max_points: Some(most), ..ContactOptions::default() };
        let found = query::contacts(&cylinder, &at(0.0, 0.9, 0.0), &plate, &here, &options).unwrap();
        assert_eq!(found[0].points.len(), most.max(1));
        if most == 4 {
            let middle: DVec3 = found[0].points.iter().map(|point| point.point_on_a).sum();
            assert!((middle / 4.0).with_y(0.0).length() < 1e-9, "four that carry it: {found:?}");
        }
    }
}

/// They are the same ones from frame to frame, where these differ by rounding.
#[test]
fn at_most_so_many_points_persist() {
    let mut rng = seeded(SEED);
    let (plate, options) =
        (Shape::cuboid([9.0, 1.0, 9.0]).unwrap(), ContactOptions { max_points: Some(4), ..within(0.01) });
    for shape in [Shape::cylinder(0.5, 1.0).unwrap(), Shape::cone(0.5, 1.0).unwrap()] {
        let mut before = None;
        for frame in 0..100 {
            let turn = DQuat::from_scaled_axis(in_cube(&mut rng) * 1e-14) * DQuat::from_rotation_y(0.3);
            let beside = DVec3::new(0.2, 0.999, 0.1) + in_cube(&mut rng) * 1e-14;
            let place = DAffine3::from_rotation_translation(turn, beside);
            let found = query::contacts(&shape, &place, &plate, &DAffine3::IDENTITY, &options).unwrap();
            let now = names(&found[0]);
            assert!(before.is_none_or(|before| before == now), "frame {frame}: {found:#?}");
            before = Some(now);
        }
    }
}

/// Meshes and complex shapes, also degenerate ones, in any place: the laws hold, and there are contacts if and only if they intersect.
#[test]
fn soups_obey_the_laws() {
    let mut rng = seeded(SEED);
    let (mut hits, cases) = (0, 400);
    for case in 0..cases {
        let soup = |rng: &mut _| {
            let soup: common::Soup =
                if case % 3 == 0 { random_complex(rng, 6) } else { random_mesh(rng, 30) };
            soup.shape()
        };
        let (a, other) = (soup(&mut rng), soup(&mut rng));
        let Pair { b, .. } = random_pair(&mut rng, Regime::Random);
        let b = if case % 2 == 0 { other } else { common::try_shape_of(&b).unwrap_or(other) };
        let places = [0, 1].map(|_| placement(&mut rng, 0.8));
        let context = format!("case {case}: {} {:?} {} {:?}", a.kind(), places[0], b.kind(), places[1]);
        let size = size_of(&a, &places[0], &b, &places[1]);
        let found = contacts(&a, &places[0], &b, &places[1]);
        assert_eq!(
            !found.is_empty(),
            query::intersects(&a, &places[0], &b, &places[1]).unwrap(),
            "{context}"
        );
        assert_laws(&found, 0.0, size, &context);
        hits += usize::from(!found.is_empty());
        let wide = query::contacts(&a, &places[0], &b, &places[1], &within(0.1 * size)).unwrap();
        assert_laws(&wide, 0.1 * size, size, &context);
    }
    common::assert_rate("soups", hits, cases);
}

#[test]
fn degenerate_input_has_answers() {
    let here = DAffine3::IDENTITY;
    let points = [vec![DVec3::ZERO], vec![DVec3::ZERO, DVec3::X], vec![DVec3::ZERO, DVec3::X, DVec3::Z]];
    let mut shapes: Vec<Shape> = points.iter().map(|points| Shape::convex_hull(points).unwrap()).collect();
    shapes.push(Shape::mesh([DVec3::ZERO, DVec3::X], [[0, 1, 1], [0, 0, 0], [0, 0, 1]]).unwrap());
    shapes.push(Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Z], [[0, 1, 2], [0, 2, 1], [0, 1, 2]]).unwrap());
    shapes.extend([
        cube(),
        cube_mesh(),
        floor(2),
        Shape::cone(1.0, 1.0).unwrap(),
        Shape::sphere(1e-6).unwrap(),
    ]);
    for a in &shapes {
        for b in &shapes {
            for place in [here, at(0.5, 0.0, 0.0), at(0.0, -0.5, 0.0), at(0.5, 0.5, 0.5)] {
                for size in [1e-90, 1e-6, 1.0, 1e6, 1e90] {
                    let scaled = |at: DAffine3| DAffine3::from_scale(DVec3::splat(size)) * at;
                    let found = contacts(a, &scaled(place), b, &scaled(here));
                    let meet = query::intersects(a, &scaled(place), b, &scaled(here)).unwrap();
                    assert_eq!(!found.is_empty(), meet, "{} {} {place:?} {size}", a.kind(), b.kind());
                    assert_laws(&found, 0.0, 4.0 * size, "degenerate");
                }
            }
        }
    }
}

/// A roof of many triangles around one vertex, which each have all others next to them. Were each held against each, this would take
/// minutes.
#[test]
fn a_fan_of_many_triangles() {
    const COUNT: u32 = 20_000;
    let rim = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(COUNT)).sin_cos();
        DVec3::new(cos, -0.2, sin)
    };
    let points: Vec<DVec3> = std::iter::once(DVec3::ZERO).chain((0..COUNT).map(rim)).collect();
    let roof = Shape::mesh(points, (0..COUNT).map(|i| [0, 1 + i, 1 + (i + 1) % COUNT]).collect::<Vec<_>>());
    let (roof, here) = (roof.unwrap(), DAffine3::IDENTITY);
    let box_on_top = only(&roof, &here, &cube(), &at(0.1, 0.49, 0.2));
    assert!(box_on_top.normal.abs_diff_eq(-DVec3::Y, 1e-9), "{box_on_top:#?}");
    assert!(box_on_top.points.iter().any(|p| (p.depth - 0.01).abs() < 1e-9), "{box_on_top:#?}");
    let ball = Shape::sphere(0.5).unwrap();
    for region in contacts(&roof, &here, &ball, &at(0.0, 0.49, 0.0)) {
        assert!(region.normal.y < -0.9 && region.points.iter().all(|p| p.depth < 0.05), "{region:#?}");
    }
}

/// Scaling a scene by a power of two scales the answer, to the bit.
#[test]
fn powers_of_two_change_nothing() {
    let mut rng = seeded(SEED);
    for i in 0..200 {
        let Pair { a, pa, b, pb, .. } = random_pair(&mut rng, Regime::Random);
        let (Ok(mut a), Ok(b)) = (common::try_shape_of(&a), common::try_shape_of(&b)) else { continue };
        if i % 4 == 0 {
            a = random_mesh(&mut rng, 30).shape();
        }
        let answer = |power: i32| {
            let factor = 2f64.powi(power);
            let (pa, pb) = (common::rescaled(&pa, factor), common::rescaled(&pb, factor));
            let mut found = contacts(&a, &pa, &b, &pb);
            for point in found.iter_mut().flat_map(|manifold| &mut manifold.points) {
                point.depth /= factor;
                point.point_on_a /= factor;
                point.point_on_b /= factor;
            }
            found
        };
        let reference = answer(0);
        for power in [-200, -1, 7, 200] {
            assert_eq!(answer(power), reference, "pair {i}, 2^{power}");
        }
    }
}

#[test]
fn a_world_has_contacts() {
    let mut world = World::new();
    let ground = world.add(&floor(10), DAffine3::IDENTITY).unwrap();
    let block = world.add(&cube(), at(0.0, 0.49, 0.0)).unwrap();
    let found = world.contacts(ground, block, &ContactOptions::default()).unwrap();
    assert_flat(&found[0], DVec3::NEG_Y, 0.01, 4);
    assert!(world.contacts(ground, ground, &ContactOptions::default()).is_err());
    assert!(world.contacts(ground, block, &within(f64::NAN)).is_err());
}

/// Law: `Response::Contacts` tells what `query::contacts` says, under names that stay while a block slides.
#[test]
fn a_test_tells_contacts_by_names_that_persist() {
    let ground = floor(10);
    let run = |caching: bool| {
        let default_response = Response::Contacts;
        let mut world =
            World::with_options(&WorldOptions { caching, default_response, ..WorldOptions::default() });
        world.add(&ground, DAffine3::IDENTITY).unwrap();
        let block = world.add(&cube(), at(0.0, 0.49, 0.0)).unwrap();
        let mut frames = Vec::new();
        for frame in 0..60 {
            // Within one square of the floor, then over its edge.
            let here = at(0.51 + 0.01 * f64::from(frame), 0.49, 0.52);
            world.set_placement(block, here).unwrap();
            let collisions = world.test();
            let expected =
                query::contacts(&ground, &DAffine3::IDENTITY, &cube(), &here, &ContactOptions::default());
            let found = collisions[0].manifolds().unwrap();
            assert_eq!(**found, expected.unwrap()[..], "frame {frame}");
            assert_flat(&found[0], DVec3::NEG_Y, 0.01, 4);
            frames.push(names(&found[0]));
            world.proceed();
        }
        frames
    };
    let frames = run(true);
    assert_eq!(frames, run(false));
    let changes = frames.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(
        (1..=4).contains(&changes),
        "names change {changes} times, where a corner comes onto another square"
    );
}

/// What is apart now has no contacts, but a point of the way.
#[test]
fn on_the_way_there_are_no_contacts() {
    let (motion, default_response) = (Motion::Swept, Response::Contacts);
    let mut world =
        World::with_options(&WorldOptions { motion, default_response, ..WorldOptions::default() });
    world.add(&floor(10), DAffine3::IDENTITY).unwrap();
    let block = world.add(&cube(), at(0.0, 2.0, 0.0)).unwrap();
    world.proceed();
    world.set_placement(block, at(0.0, -2.0, 0.0)).unwrap();
    let collisions = world.test();
    assert_eq!((collisions.len(), collisions[0].when), (1, When::OnTheWay));
    assert!(collisions[0].manifolds().unwrap().is_empty() && collisions[0].point().is_some());
    assert_eq!((collisions[0].depth(), collisions[0].normal()), (None, None));
}
