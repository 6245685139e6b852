//! When two shapes that move along straight lines first meet. Only the relative motion counts: `A` moves, `B` stands still.
//!
//! Convex against convex by the GJK cast; complex shapes by branch and bound over their trees, with the boxes of one swept through
//! the space of the other. The time found so far cuts off what is met later.

use glam::{DAffine3, DVec3};
use solid_convex::{Impact, gjk};

use super::complex_convex::convex_in_complex;
use super::frame::{Frame, slack};
use super::table::{PlacedComplex, PlacedConvex};
use super::{Placed, Relation, Scratch, intersection};
use crate::bounds::Aabb;
use crate::placement::inverse_linear;
use crate::shape::Class;
use crate::tree::{TreeRay, cast_pairs};

/// A contact at the very end counts: what is swept may arrive at a box at exactly that time.
const END: f64 = 1.0 + 4.0 * f64::EPSILON;

/// When `a`, moving by `motion` relative to `b` in a unit of time, first meets it in that time; at time 0 without a normal.
pub(crate) fn cast(a: Placed, motion: DVec3, b: Placed, scratch: &mut Scratch) -> Option<Impact> {
    let (at_a, at_b) = (a.placement, b.placement);
    if motion != DVec3::ZERO
        && let (Class::Convex(on_a), Class::Convex(on_b)) = (a.shape.class(), b.shape.class())
    {
        // What is apart at the start is so by the first step of the cast.
        let impact = gjk::cast(on_a, at_a, motion, on_b, at_b, 1.0)?;
        let start = if impact.normal.is_none() { at_start(a, b, scratch) } else { None };
        return start.or(Some(impact));
    }
    let start = at_start(a, b, scratch);
    if start.is_some() || motion == DVec3::ZERO {
        return start;
    }
    match (a.shape.class(), b.shape.class()) {
        (Class::Convex(_), Class::Convex(_)) => unreachable!("convex shapes were answered"),
        (Class::Complex(a), Class::Convex(b)) => complex_convex((a, at_a), motion, (b, at_b), scratch),
        (Class::Convex(a), Class::Complex(b)) => {
            complex_convex((b, at_b), -motion, (a, at_a), scratch).map(mirrored)
        }
        (Class::Complex(a), Class::Complex(b)) => complex_complex((a, at_a), motion, (b, at_b), scratch),
    }
}

/// The impact of what intersects at the start.
fn at_start(a: Placed, b: Placed, scratch: &mut Scratch) -> Option<Impact> {
    match intersection(a, b, scratch) {
        Relation::Common(points) => Some(Impact { time: 0.0, normal: None, points }),
        Relation::Separated { .. } => None,
    }
}

fn mirrored(impact: Impact) -> Impact {
    use super::Mirror;
    Impact { normal: impact.normal.mirrored(), points: impact.points.mirrored(), ..impact }
}

/// The earliest impact so far, and the time up to which one is of interest.
struct Earliest {
    until: f64,
    impact: Option<Impact>,
}

impl Earliest {
    fn new() -> Self {
        Earliest { until: END, impact: None }
    }

    fn offer(&mut self, impact: Option<Impact>) {
        if let Some(impact) = impact.filter(|impact| impact.time < self.until && impact.time <= 1.0) {
            self.until = impact.time;
            self.impact = Some(impact);
        }
    }
}

/// A world motion in local space, with a bound on the error of what is moved by it.
fn local_motion(at: &DAffine3, motion: DVec3) -> (DVec3, f64) {
    let inverse = inverse_linear(&at.matrix3);
    (inverse * motion, slack(&at.matrix3, &inverse, motion.abs().max_element()))
}

fn complex_convex(
    (complex, at): PlacedComplex,
    motion: DVec3,
    (convex, at_convex): PlacedConvex,
    scratch: &mut Scratch,
) -> Option<Impact> {
    let (bounds, _) = convex_in_complex((complex, at), (convex, at_convex));
    // In the space of the complex shape it is the convex one that moves.
    let (direction, error) = local_motion(at, -motion);
    let moving = TreeRay {
        origin: bounds.center(),
        direction,
        half_extents: bounds.half_extents() * (1.0 + f64::EPSILON) + error,
    };
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let mut earliest = Earliest::new();
    complex.tree().along(&moving, &mut END.clone(), traversal, |leaf, until| {
        for &primitive in leaf {
            let arrives = moving.reaches(&complex.primitive_bounds(primitive));
            if arrives.is_some_and(|t| t < earliest.until) {
                *primitive_tests += 1;
                let hull = complex.primitive_hull(primitive);
                earliest.offer(gjk::cast(&hull, at, motion, convex, at_convex, earliest.until.min(1.0)));
            }
        }
        *until = earliest.until;
    });
    earliest.impact
}

fn complex_complex(
    (a, at_a): PlacedComplex,
    motion: DVec3,
    (b, at_b): PlacedComplex,
    scratch: &mut Scratch,
) -> Option<Impact> {
    let frame = Frame::new(at_a, a.reach(), at_b, b.reach());
    // In the space of `a` it is `b` that moves.
    let (direction, error) = local_motion(at_a, -motion);
    let mut relative = frame.relative();
    relative.slack_in_a += error;
    let moving = |bounds: &Aabb| TreeRay {
        origin: bounds.center(),
        direction,
        half_extents: bounds.half_extents() * (1.0 + f64::EPSILON) + relative.slack_in_a,
    };
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let mut earliest = Earliest::new();
    cast_pairs(
        a.tree(),
        b.tree(),
        &relative,
        direction,
        &mut END.clone(),
        traversal,
        |leaf_a, leaf_b, until| {
            let to_a = |point| relative.b_to_a.transform_point3(point);
            for &of_b in leaf_b {
                let moving = moving(&Aabb::of_points(b.points_of(of_b).map(to_a)));
                for &of_a in leaf_a {
                    let arrives = moving.reaches(&a.primitive_bounds(of_a));
                    if arrives.is_some_and(|t| t < earliest.until) {
                        *primitive_tests += 1;
                        let (hull_a, hull_b) = (a.primitive_hull(of_a), b.primitive_hull(of_b));
                        earliest.offer(gjk::cast(
                            &hull_a,
                            at_a,
                            motion,
                            &hull_b,
                            at_b,
                            earliest.until.min(1.0),
                        ));
                    }
                }
            }
            *until = earliest.until;
        },
    );
    earliest.impact
}
