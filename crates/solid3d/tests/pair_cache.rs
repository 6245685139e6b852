//! What a pair keeps from frame to frame changes no answer, for all kinds of shapes.

mod common;

use common::{assert_rate, direction, in_cube, placement, random_complex, random_mesh};
use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;
use solid3d::query::{self, PairCache};
use solid3d::{Shape, glam};

const SEED: u64 = 4_711;
const FRAMES: u32 = 40;

#[test]
fn what_is_kept_changes_no_answer() {
    let mut rng = seeded(SEED);
    let cloud: Vec<DVec3> = (0..120).map(|_| direction(&mut rng)).collect();
    let shapes = [
        Shape::sphere(0.7).unwrap(),
        Shape::cuboid([1.0, 0.7, 1.3]).unwrap(),
        Shape::cone(0.7, 1.5).unwrap(),
        Shape::cylinder(0.6, 1.1).unwrap(),
        Shape::capsule(0.4, 1.0).unwrap(),
        Shape::convex_hull(&cloud).unwrap(),
        random_mesh(&mut rng, 40).shape(),
        random_complex(&mut rng, 8).shape(),
    ];
    let (mut hits, mut frames) = (0, 0);
    for a in &shapes {
        for b in &shapes {
            let (mut asked, mut mixed) = (PairCache::new(a, b), PairCache::new(a, b));
            let at_a = placement(&mut rng, 1.0);
            let mut at_b = placement(&mut rng, 1.0);
            at_b.translation = at_a.translation + direction(&mut rng) * 2.4;
            let mut step = (at_a.translation - at_b.translation) * 0.06;
            for frame in 0..FRAMES {
                if frame % 20 == 19 {
                    // A jump.
                    at_b.translation = at_a.translation + in_cube(&mut rng) * 1.8;
                    step = direction(&mut rng) * 0.05;
                }
                at_b.translation += step;
                at_b.matrix3 = DMat3::from_rotation_y(0.01) * at_b.matrix3;
                let context = format!("{} and {}, frame {frame}: {at_a}, {at_b}", a.kind(), b.kind());
                let hit = query::intersects(a, &at_a, b, &at_b).unwrap();
                assert_eq!(asked.intersects(&at_a, &at_b).unwrap(), hit, "{context}");
                if rng.random() {
                    assert_eq!(mixed.intersects(&at_a, &at_b).unwrap(), hit, "{context}");
                }
                let cold = query::distance(a, &at_a, b, &at_b).unwrap();
                let warm = mixed.distance(&at_a, &at_b).unwrap();
                assert!((warm.distance - cold.distance).abs() < 1e-11, "{context}: {warm:?}, {cold:?}");
                let between = warm.point_on_a.distance(warm.point_on_b);
                assert!((between - warm.distance).abs() < 1e-11, "{context}: {between}, {warm:?}");
                let (cold, warm) = (
                    query::penetration(a, &at_a, b, &at_b).unwrap(),
                    mixed.penetration(&at_a, &at_b).unwrap(),
                );
                assert_eq!(warm.is_some(), hit, "{context}");
                if let (Some(cold), Some(warm)) = (cold, warm) {
                    let meet = warm.depth_min <= cold.depth_max && cold.depth_min <= warm.depth_max;
                    assert!(meet && warm.depth_min <= warm.depth, "{context}: {warm:?}, {cold:?}");
                    let off = (warm.point_on_b - warm.point_on_a).distance(warm.normal * warm.depth);
                    let cold_off = (cold.point_on_b - cold.point_on_a).distance(cold.normal * cold.depth);
                    assert!(off <= 1e-3 * warm.depth + 1e-9 + cold_off, "{context}: {off:e}, {warm:?}");
                }
                hits += usize::from(hit);
                frames += 1;
            }
        }
    }
    assert_rate("frames", hits, frames);
}

#[test]
fn bad_placements_are_errors_and_change_nothing() {
    let ball = Shape::sphere(1.0).unwrap();
    let mut pair = PairCache::new(&ball, &Shape::cone(1.0, 1.0).unwrap());
    let (here, nowhere) = (DAffine3::IDENTITY, DAffine3::from_translation(DVec3::NAN));
    assert!(pair.intersects(&here, &here).unwrap());
    assert!(pair.intersects(&here, &nowhere).is_err());
    assert!(pair.distance(&nowhere, &here).is_err());
    assert!(pair.penetration(&nowhere, &here).is_err());
    assert!(pair.intersects(&here, &here).unwrap());
}
