//! Laws of the penetration depth. Random pairs of all kinds are judged by the oracle in `solid3d`'s tests.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};

use super::start::start;
use super::{DEPTH_TOLERANCE, Penetration, VERTICES_MAX, deepen, expand, penetration, zonotope};
use crate::difference::Difference;
use crate::gjk::{self, End, Goal, descend};
use crate::testing::{for_each_pair, in_cube, of_sizes, placement, shapes};
use crate::{Capsule, Cone, Cuboid, Cylinder, Locus, Points, Polytope, Sphere, Support, Witness};
use rand::Rng;
use solid_oracle::generate::seeded;

fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// The bounds hold the depth, and are as near to each other as they are said to be.
fn assert_certain(found: &Penetration, size: f64) {
    assert!(found.lower <= found.depth && found.depth <= found.upper, "{found:?}");
    assert!(found.upper - found.lower <= 2.0 * DEPTH_TOLERANCE * found.depth + 1e-12 * size, "{found:?}");
    assert!(found.direction.is_normalized(), "{found:?}");
}

/// Pairs of all kinds: moving `A` by the depth leaves them touching, by less they still overlap, and the points say the same.
#[test]
fn the_translation_leaves_them_touching() {
    let (mut deep, mut count) = (0, 0);
    for_each_pair(50, |[.., k], [a, b], [at_a, at_b]| {
        count += 1;
        let found = penetration(a, at_a, b, at_b);
        let outcome = gjk::intersection(a, at_a, b, at_b);
        assert_eq!(found.is_some(), outcome.witness().is_some());
        let Some(found) = found else { return };
        deep += 1;
        assert_certain(&found, 3.0);
        let moved = |part: f64| {
            let way = found.direction * found.depth * part;
            DAffine3 { translation: at_a.translation + way, ..*at_a }
        };
        let distance = |part: f64| gjk::closest_points(a, &moved(part), b, at_b).distance;
        assert!(distance(1.0) <= DEPTH_TOLERANCE * found.depth + 1e-12, "{found:?}");
        let gap = distance(1.001);
        assert!(gap >= 0.0009 * found.depth, "{found:?}: {gap:e}");
        assert_eq!(distance(0.999), 0.0, "{found:?}");
        let way = at_b.transform_point3(found.points.on_b) - at_a.transform_point3(found.points.on_a);
        let missed = way.distance(found.direction * found.depth);
        assert!(missed <= DEPTH_TOLERANCE * 10.0, "{k}: {missed:e} {found:?}");
    });
    assert!((count * 3 / 10..count * 7 / 10).contains(&deep), "{deep} of {count}: not representative");
}

/// What is curved is as deep as its normals all around say, to the rounding error: bounds that are 1e-7 of the depth apart would leave the normal
/// off by 1e-4 and more, and the points with it.
#[test]
fn what_is_curved_is_as_deep_as_any_normal_near_says() {
    let (mut count, mut exact) = (0, 0);
    for_each_pair(60, |_, [a, b], [at_a, at_b]| {
        let Some(found) = penetration(a, at_a, b, at_b) else { return };
        let difference = Difference::new(a, at_a, b, at_b);
        if difference.is_polytope() || found.depth < 1e-3 {
            return;
        }
        let height = |n: DVec3| n.dot(difference.support_against(-n).w) / (n.length() * difference.scale());
        let (s, t) = found.direction.any_orthonormal_pair();
        let around = (0..24).map(|i| {
            let aside = DVec2::from_angle(f64::from(i % 6) * TAU / 6.0) * 0.1f64.powi(2 + i / 6);
            height(-found.direction + s * aside.x + t * aside.y)
        });
        let way = at_b.transform_point3(found.points.on_b) - at_a.transform_point3(found.points.on_a);
        let missed = way.distance(found.direction * found.depth);
        count += 1;
        exact += usize::from(around.fold(f64::INFINITY, f64::min) >= found.depth - 1e-13 && missed < 1e-11);
    });
    println!("{exact} of {count}");
    assert!(count > 500 && 50 * exact > 49 * count, "{exact} of {count}");
}

#[test]
fn swapping_mirrors() {
    for_each_pair(20, |_, [a, b], [at_a, at_b]| {
        let Some(found) = penetration(a, at_a, b, at_b) else { return };
        let swapped = penetration(b, at_b, a, at_a).unwrap();
        let apart = (found.depth - swapped.depth).abs();
        assert!(apart <= DEPTH_TOLERANCE * found.depth, "{found:?}, {swapped:?}");
        assert!(found.direction.dot(swapped.direction) < -0.99, "{found:?}, {swapped:?}");
    });
}

/// The known failures of others: no depth for what coincides, a wrong face for boxes on a grid.
#[test]
fn coincident_and_concentric_shapes_have_a_depth() {
    let (unit, block) = (Cuboid::new(DVec3::ONE).unwrap(), Cuboid::new(DVec3::new(2.0, 3.0, 4.0)).unwrap());
    let here = DAffine3::IDENTITY;
    let depth = |a: &dyn Support, b: &dyn Support, at_b: DAffine3| {
        let found = penetration(a, &here, b, &at_b).unwrap();
        assert_certain(&found, 4.0);
        found.depth
    };
    assert_eq!(depth(&unit, &unit, here), 1.0);
    assert_eq!(depth(&block, &block, here), 2.0);
    assert_eq!(depth(&unit, &unit, at(0.75, 0.0, 0.0)), 0.25);
    assert_eq!(depth(&unit, &unit, at(0.75, 0.75, 0.0)), 0.25);
    let (slim, flat) = (Cylinder::new(0.5, 3.0).unwrap(), Cylinder::new(3.0, 1.0).unwrap());
    assert!((depth(&flat, &flat, here) - 1.0).abs() < 1e-15);
    assert!((depth(&slim, &flat, here) - 2.0).abs() < 1e-15);
    let (cone, capsule) = (Cone::new(0.5, 1.0).unwrap(), Capsule::new(0.3, 1.0).unwrap());
    // Its base leaves the box sideways.
    let across = depth(&cone, &block, at(0.0, 0.25, 0.0));
    assert!((across - 1.5).abs() < 1.5 * DEPTH_TOLERANCE, "{across}");
    let ball = Sphere::new(1.0).unwrap();
    assert_eq!(depth(&capsule, &capsule, here), 0.6);
    assert_eq!(depth(&ball, &ball, here), 2.0);
    assert_eq!(depth(&ball, &block, here), 2.0);
    assert_eq!(depth(&ball, &unit, at(0.0, 0.75, 0.0)), 0.75);
}

/// What has a difference without thickness has depth 0 along its normal; a flat shape in a solid one does not.
#[test]
fn flat_shapes_have_a_depth() {
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let (plate, point) = (Points::new(&triangle).unwrap(), Points::new(&triangle[..1]).unwrap());
    let edge = Points::new(&triangle[1..]).unwrap();
    let block = Cuboid::new(DVec3::splat(2.0)).unwrap();
    for k in 0..50 {
        let turn = placement(k);
        let normal = turn.transform_vector3(DVec3::Z);
        let flat = [
            penetration(&plate, &turn, &plate, &turn),
            penetration(&plate, &turn, &plate, &(turn * at(0.2, 0.3, 0.0))),
            penetration(&edge, &turn, &plate, &turn),
            penetration(&point, &turn, &plate, &turn),
        ];
        for found in flat {
            let found = found.unwrap();
            assert_certain(&found, 3.0);
            assert!(found.depth < 1e-15 && found.direction.dot(normal).abs() > 1.0 - 1e-12, "{k}: {found:?}");
        }
        for found in [penetration(&edge, &turn, &edge, &turn), penetration(&point, &turn, &point, &turn)] {
            let found = found.unwrap();
            assert_certain(&found, 3.0);
            let along = turn.transform_vector3(triangle[2] - triangle[1]);
            assert!(found.depth < 1e-15, "{found:?}");
            assert!(
                found.points.on_a == DVec3::ZERO || found.direction.dot(along).abs() < 1e-12,
                "{found:?}"
            );
        }
        let found = penetration(&point, &(turn * at(0.1, -0.7, 0.2)), &block, &turn).unwrap();
        assert!((found.depth - 0.3).abs() < 1e-15, "{found:?}");
        assert!((found.direction + turn.transform_vector3(DVec3::Y)).length() < 1e-14, "{found:?}");
        let found = penetration(&plate, &(turn * at(-0.1, -0.1, 0.9)), &block, &turn).unwrap();
        assert!((found.depth - 0.1).abs() < 1e-15, "{found:?}");
    }
}

/// In one plane, and the narrower the more nearly parallel they are: segments that cross, and slivers. They have no depth, however narrow.
#[test]
fn narrow_flat_shapes_have_no_depth() {
    for power in 0..14 {
        let narrow = 0.1f64.powi(power);
        for k in 0..50 {
            let along = placement(k).translation.normalize();
            let aside = placement(k + 1).translation.cross(along) * narrow;
            let in_plane = |x: f64, y: f64| along * x + aside * y;
            // Their rounding is off the plane by 1e-16, where the narrower are not 1e-16 wide.
            let segment = [in_plane(-0.7, -0.7), in_plane(0.7, 0.7)];
            let sliver = [in_plane(-1.0, 0.0), in_plane(1.0, 0.1), in_plane(0.3, 0.4)];
            let across = [segment[0], in_plane(0.8, 0.0)];
            let (here, at) = (DAffine3::IDENTITY, placement(k + 2));
            let shapes =
                [&segment[..], &sliver, &across].map(|points| Points::new(points).expect("some points"));
            for (a, b) in [(0, 1), (0, 2), (1, 1), (1, 2)] {
                for (here, there) in [(here, here), (at, at)] {
                    let Some(found) = penetration(&shapes[a], &here, &shapes[b], &there) else { continue };
                    assert!(found.upper <= 1e-13, "{narrow:e}, {k}, {a} and {b}: {found:?}");
                }
            }
        }
    }
}

/// Touching: a depth of nothing, and the normal of the common plane.
#[test]
fn touching_shapes_have_a_direction() {
    let block = Cuboid::new(DVec3::new(2.0, 2.0, 2.0)).unwrap();
    let (ball, plate) = (Sphere::new(1.0).unwrap(), Cuboid::new(DVec3::new(1000.0, 0.002, 1000.0)).unwrap());
    for k in 0..50 {
        let turn = placement(k);
        let shift = turn.translation * 0.7;
        for (other, height) in [(&block as &dyn Support, 2.0), (&ball, 2.0), (&plate, 1.001)] {
            let above = turn * at(shift.x, height, shift.z);
            let Some(found) = penetration(other, &above, &block, &turn) else { continue };
            assert_certain(&found, 2000.0);
            assert!(found.depth < 1e-12, "{found:?}");
            let up = turn.transform_vector3(DVec3::Y);
            assert!((found.direction - up).length() < 1e-5, "{k}, {height}: {found:?}, {up}");
        }
    }
}

/// Scaling both by a power of two scales the answer, to the bit.
#[test]
fn powers_of_two_change_nothing() {
    for (i, a) in shapes().iter().enumerate() {
        for k in 0..20 {
            let b = &shapes()[k as usize % 5];
            let answer = |power: i32| {
                let factor = 2f64.powi(power);
                let scaled = |at: DAffine3| DAffine3 {
                    matrix3: at.matrix3 * factor,
                    translation: at.translation * factor,
                };
                let (at_a, at_b) = (scaled(placement(k)), scaled(placement(k + i as u32)));
                let found = penetration(&**a, &at_a, &**b, &at_b)?;
                let lengths = [found.depth, found.lower, found.upper].map(|length| length / factor);
                Some((lengths, found.direction, found.points))
            };
            let reference = answer(0);
            for power in [-290, -20, 1, 20, 290] {
                assert_eq!(answer(power), reference);
            }
        }
    }
}

/// The polytope stays convex and closed, exactly, whatever points come: grids have many that are coplanar.
#[test]
fn the_polytope_is_well_formed() {
    let mut grown = 0;
    for k in 0..200u32 {
        let coordinate = |i: u32| f64::from((i * 7919 + k) % 5) - 2.0;
        let mut points: Vec<DVec3> =
            (0..30).map(|i| DVec3::new(coordinate(i), coordinate(i / 3), coordinate(i * i))).collect();
        if k % 2 == 0 {
            points.iter_mut().for_each(|p| *p = placement(k).transform_point3(*p));
        }
        let (hull, point) = (Points::new(&points).unwrap(), Points::new(&[DVec3::ZERO]).unwrap());
        let here = DAffine3::IDENTITY;
        let difference = Difference::new(&hull, &here, &point, &here);
        let first = difference.support_against(placement(k).translation);
        let Ok(mut polytope) = start(&difference, &[first]) else { continue };
        polytope.assert_well_formed();
        for &p in &points {
            let direction = p + placement(k + 1).translation * 0.1;
            grown += usize::from(polytope.insert(&difference, difference.support_against(direction)));
            polytope.assert_well_formed();
        }
    }
    assert!(grown > 500, "{grown}");
}

/// So it does where curved shapes make its faces small, and their planes are taken from the edges of the objects.
#[test]
fn the_polytope_of_curved_shapes_is_well_formed() {
    let mut vertices = 0;
    for_each_pair(20, |_, [a, b], [at_a, at_b]| {
        let difference = Difference::new(a, at_a, b, at_b);
        let descent = descend(&difference, Goal::Separation);
        let ended: Vec<_> = descent.simplex.points().copied().collect();
        if descent.end != End::Inside || difference.is_polytope() {
            return;
        }
        let Ok(mut polytope) = start(&difference, &ended) else { return };
        expand(&difference, &mut polytope);
        polytope.assert_well_formed();
        vertices += polytope.vertex_count();
    });
    assert!(vertices > 3_000, "{vertices}");
}

/// Concentric ellipsoids of revolution have their least depth in every direction across: no polytope of this many vertices decides
/// that, and the bounds say so.
#[test]
fn the_vertex_limit_is_honest() {
    let ball = Sphere::new(1.0).unwrap();
    let egg = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 3.0, 1.0)));
    let difference = Difference::new(&ball, &egg, &ball, &egg);
    let mut polytope = start(&difference, &[difference.support_against(DVec3::X)]).unwrap();
    expand(&difference, &mut polytope);
    assert_eq!(polytope.vertex_count(), VERTICES_MAX);
    polytope.assert_well_formed();
    let found = penetration(&ball, &egg, &ball, &egg).unwrap();
    assert!(found.lower <= 2.0 && 2.0 <= found.upper, "{found:?}");
    assert!(found.upper - found.lower < 0.05 && found.upper - found.lower > 2e-5, "{found:?}");
}

/// Law: the depth of polytopes is exact, also of hulls of many points in each other's place, which are about as deep along all directions.
#[test]
fn hulls_of_many_points_are_as_deep_as_is_said() {
    for (count, off) in [(700, 0.0), (1500, 0.0), (1500, 0.01), (5000, 0.0)] {
        let mut rng = seeded(count);
        let mut globe =
            || Polytope::new((0..count).map(|_| in_cube(&mut rng).normalize()).collect()).unwrap();
        let (a, b, here) = (globe(), globe(), DAffine3::IDENTITY);
        let at_b = DAffine3::from_translation(DVec3::new(0.6, 0.0, 0.8) * off);
        let found = penetration(&a, &here, &b, &at_b).unwrap();
        assert!(found.upper - found.lower < 1e-12, "{count}: {found:?}");
        let Witness { on_a, on_b } = found.points;
        let way = at_b.transform_point3(on_b) - on_a - found.direction * found.depth;
        assert!(way.length() < 1e-12, "{count}: {found:?}");
    }
}

/// The closed form of two boxes says what the search says, wherever it says anything: for boxes at any angle, nearly or just in line,
/// stretched and sheared, and of very different size.
#[test]
fn boxes_are_as_deep_as_the_search_says() {
    let (mut deep, mut answered, mut count) = (0, 0, 0);
    for k in 0..3_000 {
        let part = |step: f64| (f64::from(k) * step).fract();
        let small = [1.0, 1.0, 0.1, 1e-3][k as usize % 4];
        let half_a = DVec3::new(0.2 + part(0.618), 0.2 + part(0.414), 0.2 + part(0.732)) * 0.7;
        let half_b = DVec3::new(0.2 + part(0.236), 0.2 + part(0.7549), 0.2 + part(0.5698)) * 0.7 * small;
        let (a, b) = (Cuboid::new(2.0 * half_a).unwrap(), Cuboid::new(2.0 * half_b).unwrap());
        let at_a = placement(k);
        let mut at_b = placement(5 * k + 1);
        // Turned against each other by nothing, by little, or by anything.
        let turn = [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1.0][k as usize % 8];
        if turn < 1.0 {
            let about = DQuat::from_axis_angle(placement(k + 3).translation.normalize(), turn);
            at_b.matrix3 = at_a.matrix3 * DMat3::from_quat(about);
        }
        if k % 5 == 0 {
            let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.5, 0.0), DVec3::new(0.0, -0.2, 0.7));
            at_b.matrix3 *= shear;
        }
        count += 1;
        let difference = Difference::new(&a, &at_a, &b, &at_b);
        let descent = descend(&difference, Goal::Separation);
        let found = zonotope::penetration(&difference);
        if descent.end == End::Separated {
            assert!(found.is_none(), "{k}: {found:?}");
            continue;
        }
        deep += 1;
        let Some(found) = found else { continue };
        answered += 1;
        assert_certain(&found, 3.0);
        let searched = deepen(&difference, &descent.simplex).penetration(difference.scale(), 0.0);
        assert!(
            found.lower <= searched.upper && searched.lower <= found.upper,
            "{k}: {found:?} {searched:?}"
        );
        assert!((found.depth - searched.depth).abs() <= 1e-13 * 3.0, "{k}: {found:?} {searched:?}");
        // The points are of the boxes, and lie as far apart as the depth, along the normal.
        for (point, half) in [(found.points.on_a, half_a), (found.points.on_b, half_b)] {
            assert!((point.abs() - half).max_element() <= 1e-15, "{k}: {point} of {half}");
        }
        let way = at_b.transform_point3(found.points.on_b) - at_a.transform_point3(found.points.on_a);
        let missed = way.distance(found.direction * found.depth);
        assert!(missed <= 1e-12, "{k}: {missed:e}, {found:?}");
    }
    assert!((count * 3 / 10..count * 7 / 10).contains(&deep), "{deep} of {count}: not representative");
    assert!(answered * 10 >= deep * 9, "{answered} of {deep} in closed form");
}

/// The corners of a prism along z, of length 1, over a section.
fn prism(section: &[DVec2]) -> Vec<DVec3> {
    section.iter().flat_map(|p| [-0.5, 0.5].map(|height| p.extend(height))).collect()
}

/// How deep two polygons in a plane are in each other, both counterclockwise: some side of the two is the one that they are to be parted along.
fn depth_of_sections(a: &[DVec2], b: &[DVec2]) -> f64 {
    let sides = |polygon: &[DVec2], sign: f64| -> Vec<DVec2> {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(p, q)| (*p - *q).perp().normalize() * sign).collect()
    };
    let reach = |polygon: &[DVec2], normal: DVec2| {
        polygon.iter().map(|p| normal.dot(*p)).fold(f64::NEG_INFINITY, f64::max)
    };
    let normals = sides(a, 1.0).into_iter().chain(sides(b, -1.0));
    normals.map(|normal| reach(a, normal) + reach(b, -normal)).fold(f64::INFINITY, f64::min)
}

/// Two needles side by side: their depth is that of their sections, however thin these are. What the coordinates round by is all that it
/// may be off, and what the bounds leave open.
#[test]
fn parallel_needles_are_as_deep_as_their_sections() {
    for thickness in [1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11] {
        let mut deep = 0;
        for k in 0..200 {
            let part = |step: f64| (f64::from(k) * step).fract();
            let section = |corners: u32, turn: f64, middle: DVec2| -> Vec<DVec2> {
                let angle = |i: u32| TAU * (f64::from(i) + 0.4 * turn) / f64::from(corners);
                let corner = |i| middle + DVec2::from_angle(angle(i)) * DVec2::new(1.0, 0.3 + turn);
                (0..corners).map(|i| corner(i) * thickness).collect()
            };
            let away = DVec2::new(part(0.7549) - 0.3, part(0.5698) - 0.3) * 2.0;
            let (a, b) =
                (section(3 + k % 5, part(0.618), DVec2::ZERO), section(3 + k % 3, part(0.414), away));
            let expected = depth_of_sections(&a, &b);
            let at = placement(k);
            let slid = at * DAffine3::from_translation(DVec3::Z * (part(0.236) - 0.5));
            let corners = [&a, &b].map(|section| prism(section));
            let [needle_a, needle_b] = corners.each_ref().map(|corners| Points::new(corners).unwrap());
            let found = penetration(&needle_a, &at, &needle_b, &slid);
            if expected < 0.01 * thickness {
                continue;
            }
            deep += 1;
            let found = found.unwrap();
            let error = 1e-14;
            assert!((found.depth - expected).abs() <= error, "{thickness}, {k}: {found:?}, not {expected}");
            assert!(found.upper - found.lower <= 10.0 * error, "{thickness}, {k}: {found:?}");
            assert!(found.lower - error <= expected && expected <= found.upper + error, "{k}: {found:?}");
        }
        assert!((60..=180).contains(&deep), "{deep} of 200: not representative");
    }
}

/// A splinter in a ribbon, both all but flat: where they lie along each other may be lost, but not that they lie on each other.
#[test]
fn the_points_of_ribbons_lie_on_each_other() {
    let mut count = 0;
    for thickness in [1e-9, 1e-11, 1e-12, 1e-13] {
        let size = DVec3::new(1.0, f64::sqrt(thickness), thickness);
        for k in 0..300 {
            let at = placement(k);
            let corner = |i: u32| placement(11 * k + i).translation;
            let ribbon: Vec<DVec3> =
                (0..5).map(|i| at.transform_vector3((corner(i) - corner(5)) * size)).collect();
            let middle = ribbon.iter().sum::<DVec3>() / 5.0;
            let splinter: Vec<DVec3> = (6..10).map(|i| middle + corner(i) * thickness).collect();
            let (ribbon, splinter) = (Points::new(&ribbon).unwrap(), Points::new(&splinter).unwrap());
            let here = DAffine3::IDENTITY;
            let Some(found) = penetration(&ribbon, &here, &splinter, &here) else { continue };
            count += 1;
            let missed = (found.points.on_b - found.points.on_a).distance(found.direction * found.depth);
            assert!(missed <= found.depth + 1e-10, "{thickness:e}, {k}: {missed:e} off, {found:?}");
        }
    }
    assert!(count > 1_000, "{count} of 1,200 overlap");
}

/// A needle that meets a corner with its end: the faces there are slivers of all lengths, and the bounds say how well they are known. Judged
/// by the directions across any two edges, one of which is that of the depth.
#[test]
fn needles_at_a_corner_are_as_deep_as_said() {
    for thickness in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10] {
        for k in 0..400 {
            let corner = |i: u32| placement(13 * k + i).translation;
            let at = placement(k);
            let body: Vec<DVec3> = (0..4).map(corner).collect();
            let slim = |i: u32| at.transform_vector3(corner(i) * DVec3::new(1.0, thickness, thickness));
            let needle: Vec<DVec3> = (4..9).map(|i| slim(i) - slim(4) + body[0]).collect();
            let (of_body, of_needle) = (Points::new(&body).unwrap(), Points::new(&needle).unwrap());
            let found = penetration(&of_body, &DAffine3::IDENTITY, &of_needle, &DAffine3::IDENTITY).unwrap();
            let edges_of = |points: &[DVec3]| -> Vec<DVec3> {
                points.iter().flat_map(|p| points.iter().map(move |q| *q - *p)).collect()
            };
            let edges = [edges_of(&body), edges_of(&needle)].concat();
            let normals = edges.iter().flat_map(|x| edges.iter().filter_map(|y| x.cross(*y).try_normalize()));
            let reach = |points: &[DVec3], normal: DVec3| {
                points.iter().map(|p| normal.dot(*p)).fold(f64::NEG_INFINITY, f64::max)
            };
            let expected =
                normals.map(|n| reach(&body, n) + reach(&needle, -n)).fold(f64::INFINITY, f64::min);
            let context = || format!("{thickness:e}, {k}: {found:?}, not {expected:e}");
            let limit = if thickness > 1e-4 { 3e-12 } else { 3e-8 };
            assert!(found.upper - found.lower <= limit, "{}", context());
            assert!(found.lower <= expected + 1e-14 && found.depth <= expected + limit, "{}", context());
        }
    }
}

/// A support mapping that is none: it must not hang nor crash whoever asks it.
struct Liar(std::sync::atomic::AtomicU32);

impl Support for Liar {
    fn support(&self, _direction: DVec3) -> DVec3 {
        placement(self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed)).translation
    }

    fn reach(&self) -> DVec3 {
        DVec3::splat(1.5)
    }

    fn locus(&self, point: DVec3) -> Locus {
        let kinds = [
            Locus::Point,
            Locus::Circle { radius: 100.0 * point.x },
            Locus::Sphere { center: point, radius: f64::INFINITY },
            Locus::Sphere { center: DVec3::NAN, radius: point.y },
        ];
        kinds[point.z.to_bits() as usize % 4]
    }
}

#[test]
fn a_support_mapping_that_lies_is_survived() {
    for seed in 0..200 {
        let liar = Liar(seed.into());
        let found = penetration(&liar, &DAffine3::IDENTITY, &liar, &placement(seed));
        assert!(
            found.is_none_or(|found| found.lower <= found.depth && found.depth <= found.upper),
            "{found:?}"
        );
        let calls = liar.0.load(std::sync::atomic::Ordering::Relaxed) - seed;
        assert!(calls as usize <= 4 * super::EXPANSIONS_PER_VERTEX * VERTICES_MAX, "{calls} calls");
    }
}

/// Gives points that are far beyond its reach, or no numbers.
struct Wild(std::sync::atomic::AtomicU32);

impl Support for Wild {
    fn support(&self, direction: DVec3) -> DVec3 {
        let call = self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let far = [1.0, 1e110, 1e200, 1e300, f64::INFINITY, f64::NAN]
            [(call.wrapping_mul(2_654_435_761) >> 16) as usize % 6];
        placement(call).translation + direction.signum() * far
    }

    fn reach(&self) -> DVec3 {
        DVec3::ONE
    }
}

#[test]
fn support_points_beyond_all_numbers_are_survived() {
    for seed in 0..2_000 {
        let (wild, other) = (Wild(seed.into()), Wild((7 * seed).into()));
        penetration(&wild, &DAffine3::IDENTITY, &other, &placement(seed));
    }
}

/// What is round about one axis has its depth in a circle of directions at once: that of the half-planes at the axis.
#[test]
fn coaxial_shapes_have_the_depth_of_their_profiles() {
    let mut rng = seeded(291);
    let mut count = 0;
    for case in 0..1000 {
        let mut size = || rng.random_range(0.2..2.0);
        let round = [0, 1, 3];
        let [a, b] = [case % 3, case / 3 % 3].map(|kind| of_sizes(round[kind], &mut size));
        let turn = [DQuat::IDENTITY, DQuat::from_scaled_axis(DVec3::splat(size()))][case / 9 % 2];
        let at_a = DAffine3::from_quat(turn);
        let at_b = at_a * at(0.0, [0.0, 0.1, -0.05][case / 18 % 3], 0.0);
        let Some(found) = penetration(&*a, &at_a, &*b, &at_b) else { continue };
        count += 1;
        let height = |angle: f64| {
            let n = turn * DVec3::new(angle.cos(), angle.sin(), 0.0);
            let furthest = |of: &dyn Support, at: &DAffine3, n: DVec3| {
                at.transform_point3(of.support(at.matrix3.transpose() * n)).dot(n)
            };
            furthest(&*a, &at_a, -n) + furthest(&*b, &at_b, n)
        };
        // It may have several valleys, each of which is narrowed down to.
        let step = TAU / 4000.0;
        let narrowed = |i: i32| {
            let (mut low, mut high) = (step * f64::from(i - 1), step * f64::from(i + 1));
            for _ in 0..60 {
                let third = (high - low) / 3.0;
                if height(low + third) < height(high - third) {
                    high -= third;
                } else {
                    low += third;
                }
            }
            height(low)
        };
        let is_valley = |i: &i32| {
            [i - 1, i + 1].iter().all(|&j| height(step * f64::from(*i)) <= height(step * f64::from(j)))
        };
        let expected = (-1000..=1000).filter(is_valley).map(narrowed).fold(f64::INFINITY, f64::min);
        assert!((found.depth - expected).abs() <= 1e-12, "case {case}: {found:?}, {expected}");
        let between = at_b.transform_point3(found.points.on_b) - at_a.transform_point3(found.points.on_a);
        assert!((between - found.direction * found.depth).length() <= 1e-12, "case {case}: {found:?}");
    }
    assert!(count > 900, "{count} of 1,000 overlap");
}

/// Law: the bounds of two boxes that are turned against each other by next to nothing are as near to each other as those of any.
#[test]
fn boxes_turned_by_next_to_nothing_have_near_bounds() {
    let mut rng = seeded(178);
    let (mut deep, cases) = (0, 3_000);
    for case in 0..cases {
        let [a, b] = [(); 2].map(|()| Cuboid::new(in_cube(&mut rng).abs() + 0.2).unwrap());
        let angle = 0.1f64.powf(rng.random_range(1.0..17.0));
        let turn = DAffine3::from_axis_angle(in_cube(&mut rng).normalize(), angle);
        let at_a = placement(case);
        let at_b = at_a * DAffine3 { translation: in_cube(&mut rng) * 0.6, ..turn };
        let Some(found) = penetration(&a, &at_a, &b, &at_b) else { continue };
        deep += 1;
        assert!(found.upper - found.lower <= 1e-12, "{case}, turned by {angle:e}: {found:?}");
    }
    assert!(3 * deep > cases, "{deep} of {cases}");
}

/// Of boxes whose middles are over each other the deepest points are the middles of the faces.
#[test]
fn boxes_over_each_other_meet_in_the_middle() {
    let [small, large] = [1.0, 3.0].map(|width| Cuboid::new(DVec3::new(width, 1.0, width)).unwrap());
    for (a, b) in [(small, small), (small, large), (large, small)] {
        let found = penetration(&a, &at(0.0, 0.75, 0.0), &b, &at(0.0, 0.0, 0.0)).unwrap();
        assert_eq!((found.depth, found.direction), (0.25, DVec3::Y));
        assert_eq!([found.points.on_a, found.points.on_b], [-0.5, 0.5].map(|y| DVec3::Y * y));
    }
}
