//! Of what stands on a ground of triangles.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{direction, in_cube, seeded};
use solid3d::query::{self, Manifold};
use solid3d::{Shape, glam};

use super::{SEED, assert_flat, contacts, cube, deepest, floor, only, reach, within};
use crate::common::{self, assert_rate, at, placement, sheet};

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

/// Two flat grounds of one plane are two regions, each of which ends at the gap between them: also where the body is deeper than triangles are wide.
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
    for depth in [0.01, 0.2] {
        let found = contacts(&cube(), &at(0.0, 0.5 - depth, 0.0), &ground, &DAffine3::IDENTITY);
        assert_eq!(found.len(), 2);
        for manifold in &found {
            assert_flat(manifold, DVec3::Y, depth, 4);
            let near = manifold.points.iter().filter(|point| (point.point_on_a.x.abs() - 0.1).abs() < 1e-9);
            assert_eq!(near.count(), 2, "{manifold:#?}");
        }
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

/// Law: of two prisms that are not convex and stand on each other, turned a little and beside each other by less than a wall is thick, no contact is deeper than they
/// overlap, upwards or aside; though the floor of the one hangs over the walls of the other by less than it is in it.
#[test]
fn prisms_stand_on_prisms() {
    let prism = |ring: &[(f64, f64)], floor: &[[u32; 3]]| {
        let count = ring.len() as u32;
        let layer = |y: f64| ring.iter().map(move |&(x, z)| DVec3::new(x, y, z));
        let vertices: Vec<DVec3> = layer(-0.5).chain(layer(0.5)).collect();
        let mut triangles = floor.to_vec();
        triangles.extend(floor.iter().map(|&[p, q, r]| [p, r, q].map(|vertex| vertex + count)));
        for i in 0..count {
            let next = (i + 1) % count;
            triangles.extend([[i, i + count, next], [next, i + count, next + count]]);
        }
        Shape::mesh(vertices, triangles).unwrap().into_solid().unwrap()
    };
    let of_u = [(0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)]
        .map(|(x, z)| (f64::from(x), f64::from(z)));
    let of_l = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)].map(|(x, z)| (f64::from(x), f64::from(z)));
    let shapes = [
        prism(&of_u, &[[0, 1, 4], [0, 4, 5], [0, 5, 6], [0, 6, 7], [1, 2, 3], [1, 3, 4]]),
        prism(&of_l, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]),
    ];
    let mut rng = seeded(SEED);
    for case in 0..1200 {
        let shape = &shapes[case % 2];
        let depth = [0.0001, 0.001, 0.01][case % 3];
        let (turn, beside) = (rng.random_range(-0.02..0.02), in_cube(&mut rng) * 0.1);
        let tilt = if case % 4 < 2 { 0.0 } else { 0.001 * rng.random_range(-1.0..1.0) };
        let place = at(beside.x, 1.0 - depth, beside.z)
            * DAffine3::from_rotation_y(turn)
            * DAffine3::from_rotation_z(tilt);
        let found = contacts(shape, &place, shape, &DAffine3::IDENTITY);
        let is_up = |region: &&Manifold| region.normal.y > 0.999;
        let (up, aside): (Vec<_>, Vec<_>) = found.iter().partition(is_up);
        let deepest_of = |regions: Vec<&Manifold>| {
            regions.into_iter().map(|region| deepest(std::slice::from_ref(region))).fold(0.0, f64::max)
        };
        let (up, aside) = (deepest_of(up), deepest_of(aside));
        let (most, most_aside) = (depth + 5.0 * tilt.abs(), 0.1 + 5.0 * turn.abs());
        assert!(up > 0.0 && up < most + 1e-9 && aside < most_aside, "case {case}: {up}, {aside}, {found:#?}");
    }
}
