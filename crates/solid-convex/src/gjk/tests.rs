//! Laws of GJK. Random pairs of all kinds are judged by the oracle in `solid3d`'s tests.

use glam::{DAffine3, DQuat, DVec3};

use super::descent::{End, Goal, ITERATIONS_MAX, descend_within};
use super::{Outcome, closest_points, intersection, separates};
use crate::difference::Difference;
use crate::{Capsule, Cone, Cuboid, Cylinder, Sphere, Support};

fn shapes() -> Vec<Box<dyn Support>> {
    vec![
        Box::new(Sphere::new(0.7).unwrap()),
        Box::new(Cuboid::new(DVec3::new(1.0, 0.5, 2.0)).unwrap()),
        Box::new(Cone::new(0.5, 1.5).unwrap()),
        Box::new(Cylinder::new(0.6, 1.0).unwrap()),
        Box::new(Capsule::new(0.3, 1.2).unwrap()),
    ]
}

/// Placements spread over orientations and distances by a low-discrepancy sequence.
fn placement(i: u32) -> DAffine3 {
    let part = |step: f64| (f64::from(i) * step).fract();
    let rotation =
        DQuat::from_xyzw(part(0.618) - 0.5, part(0.414) - 0.5, part(0.732) - 0.5, part(0.236) + 0.1);
    let translation = DVec3::new(part(0.7549), part(0.5698), part(0.3247)) * 1.6 - 0.8;
    DAffine3::from_rotation_translation(rotation.normalize(), translation)
}

#[test]
fn swapping_negates_the_axis() {
    let mut separated = 0;
    for (i, a) in shapes().iter().enumerate() {
        for (j, b) in shapes().iter().enumerate() {
            for k in 0..50 {
                let (at_a, at_b) = (placement(k), placement(7 * k + (i + 5 * j) as u32 + 1));
                let outcome = intersection(&**a, &at_a, &**b, &at_b);
                let swapped = intersection(&**b, &at_b, &**a, &at_a);
                match (outcome, swapped) {
                    (Outcome::Separated { axis }, Outcome::Separated { .. }) => {
                        separated += 1;
                        assert!(separates(-axis, &**b, &at_b, &**a, &at_a), "{axis} the other way round");
                    }
                    (Outcome::Separated { .. }, _) | (_, Outcome::Separated { .. }) => {
                        panic!("{outcome:?}, {swapped:?}")
                    }
                    _ => {}
                }
            }
        }
    }
    assert!((375..875).contains(&separated), "{separated} of 1250: not representative");
}

#[test]
fn what_a_cached_axis_separates_is_separated() {
    let (a, b) = (Cone::new(0.5, 1.5).unwrap(), Cylinder::new(0.6, 1.0).unwrap());
    let mut held = 0;
    for k in 0..2_000 {
        let axis = placement(k).translation;
        let (at_a, at_b) = (placement(3 * k), placement(5 * k + 1));
        if separates(axis, &a, &at_a, &b, &at_b) {
            held += 1;
            assert!(matches!(intersection(&a, &at_a, &b, &at_b), Outcome::Separated { .. }));
        }
        assert!(!separates(DVec3::ZERO, &a, &at_a, &b, &at_b), "no axis is no answer");
    }
    assert!(held > 200, "{held}");
}

/// At this gap GJK with Johnson's sub-algorithm recognises 32 of 2,000.
#[test]
fn boxes_a_billionth_apart_are_separate() {
    let cube = Cuboid::new(DVec3::ONE).unwrap();
    for k in 0..2_000 {
        let shift = placement(k).translation * 0.3;
        let turn = DAffine3::from_quat(DQuat::from_rotation_y(f64::from(k)));
        let above = turn * DAffine3::from_translation(DVec3::new(shift.x, 1.0 + 1e-9, shift.z));
        assert!(matches!(intersection(&cube, &turn, &cube, &above), Outcome::Separated { .. }), "{k}");
        let distance = closest_points(&cube, &turn, &cube, &above).distance;
        assert!((distance - 1e-9).abs() < 1e-15, "{distance:e}");
    }
}

/// A plate of 1000 x 1000 x 0.001 against a cube, 10^-12 of the size apart, or overlapping by that.
#[test]
fn plates_are_decided_at_a_trillionth() {
    let (plate, cube) =
        (Cuboid::new(DVec3::new(1000.0, 0.001, 1000.0)).unwrap(), Cuboid::new(DVec3::ONE).unwrap());
    for k in 0..2_000 {
        let shift = placement(k).translation * 300.0;
        let at = |gap: f64| {
            let turn = DAffine3::from_translation(DVec3::new(shift.x, 0.5005 + gap, shift.z));
            turn * DAffine3::from_rotation_y(f64::from(k))
        };
        let apart = intersection(&plate, &DAffine3::IDENTITY, &cube, &at(1e-9));
        assert!(matches!(apart, Outcome::Separated { .. }), "{k}: {apart:?}");
        let deep = intersection(&plate, &DAffine3::IDENTITY, &cube, &at(-1e-9));
        assert!(!matches!(deep, Outcome::Separated { .. }), "{k}");
    }
}

#[test]
fn coincident_shapes_intersect() {
    for shape in shapes() {
        for k in 0..20 {
            let at = placement(k);
            assert!(intersection(&*shape, &at, &*shape, &at).witness().is_some());
            assert_eq!(closest_points(&*shape, &at, &*shape, &at).distance, 0.0);
        }
    }
}

/// A descent that runs out of iterations says so, and claims nothing.
#[test]
fn the_iteration_limit_is_undecided() {
    let ball = Sphere::new(1.0).unwrap();
    let egg = DAffine3::from_scale(DVec3::new(1.0, 3.0, 0.2));
    let near = DAffine3::from_translation(DVec3::new(1.3, 2.0, 0.1)) * DAffine3::from_rotation_z(1.0);
    let difference = Difference::new(&ball, &egg, &ball, &near);
    let needed = (0..=ITERATIONS_MAX).find(|&limit| {
        descend_within(&difference, Goal::Distance { tolerance: 1e-12 }, limit).end != End::Undecided
    });
    let needed = needed.expect("it ends in time");
    assert!(needed > 2, "{needed}");
    assert_eq!(descend_within(&difference, Goal::Separation, 1).end, End::Undecided);
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
}

#[test]
fn a_support_mapping_that_lies_is_survived() {
    for seed in 0..200 {
        let liar = Liar(seed.into());
        intersection(&liar, &DAffine3::IDENTITY, &liar, &placement(seed));
        closest_points(&liar, &DAffine3::IDENTITY, &liar, &placement(seed));
        let calls = liar.0.load(std::sync::atomic::Ordering::Relaxed) - seed;
        assert!(calls as usize <= 4 * ITERATIONS_MAX, "{calls} calls");
    }
}
