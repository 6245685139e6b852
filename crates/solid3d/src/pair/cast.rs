//! When two shapes that move along straight lines first meet. Only the relative motion counts: `A` moves, `B` stands still.
//!
//! Convex against convex by the GJK cast; complex shapes by branch and bound over their trees, with the boxes of one swept through
//! the space of the other. The time found so far cuts off what is met later, and so do the planes of the last impacts, of what is behind them.

use glam::{DAffine3, DVec3};
use solid_convex::{Impact, gjk};

use super::complex_convex::convex_in_complex;
use super::frame::{Frame, ROUNDINGS, slack};
use super::table::{PlacedComplex, PlacedConvex, convex};
use super::{Mirror, Placed, Relation, Scratch, intersection};
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
        && let Some(((on_a, _), (on_b, _))) = convex(a, b)
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
            complex_convex((b, at_b), -motion, (a, at_a), scratch).mirrored()
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
    let (bounds, frame) = convex_in_complex((complex, at), (convex, at_convex));
    // In the space of the complex shape it is the convex one that moves.
    let (direction, error) = local_motion(at, -motion);
    let moving = TreeRay {
        origin: bounds.center(),
        direction,
        half_extents: bounds.half_extents() * (1.0 + f64::EPSILON) + error,
    };
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let (mut earliest, mut planes) = (Earliest::new(), Planes::new());
    complex.tree().along(&moving, &mut END.clone(), traversal, |leaf, until| {
        for &primitive in leaf {
            let arrives = moving.reaches(&complex.primitive_bounds(primitive));
            let parted = || part(&planes.planes, complex.points_of(primitive));
            if arrives.is_some_and(|t| t < earliest.until) && !parted() {
                *primitive_tests += 1;
                let hull = complex.primitive_hull(primitive);
                let impact = gjk::cast(&hull, at, motion, convex, at_convex, earliest.until.min(1.0));
                if let Some(plane) =
                    impact.and_then(|impact| Plane::of(&impact, at, motion, at_convex, &frame))
                {
                    planes.add(plane.over(plane.normals[1].dot(convex.support(plane.normals[1]))));
                }
                earliest.offer(impact);
            }
        }
        *until = earliest.until;
    });
    earliest.impact
}

/// A plane between two shapes at an impact, towards which they came together all the way: what is beyond it then was not met before.
#[derive(Clone, Copy)]
struct Plane {
    /// From `B` to `A`, in the space of `A` and in that of `B`.
    normals: [DVec3; 2],
    /// What of `A` is this much further along its normal than what of `B` is along its own is beyond. Infinite of no plane.
    beyond: f64,
}

impl Plane {
    const NONE: Plane = Plane { normals: [DVec3::ZERO; 2], beyond: f64::INFINITY };

    /// The plane of an impact of a shape that moves and one that stands still; `None` where they did not come together along its normal.
    fn of(impact: &Impact, at_a: &DAffine3, motion: DVec3, at_b: &DAffine3, frame: &Frame) -> Option<Plane> {
        let normal = impact.normal.filter(|normal| normal.dot(motion) < 0.0)?;
        let moved = motion * impact.time;
        let rounding = frame.rounding() + ROUNDINGS * moved.abs().max_element();
        Some(Plane {
            normals: [at_a, at_b].map(|at| at.matrix3.transpose() * normal),
            beyond: normal.dot(at_b.translation - at_a.translation - moved) + rounding,
        })
    }

    /// The same over what of `B` reaches so far along its normal.
    fn over(self, height: f64) -> Plane {
        Plane { beyond: self.beyond + height, ..self }
    }

    /// Whether points of `A` are beyond it.
    fn parts(&self, points: impl Iterator<Item = DVec3>) -> bool {
        points.map(|point| self.normals[0].dot(point)).all(|height| height >= self.beyond)
    }
}

/// The last planes found.
struct Planes {
    planes: [Plane; 4],
    next: usize,
}

impl Planes {
    fn new() -> Self {
        Planes { planes: [Plane::NONE; 4], next: 0 }
    }

    fn add(&mut self, plane: Plane) {
        self.planes[self.next] = plane;
        self.next = (self.next + 1) % self.planes.len();
    }

    /// Over points of `B`.
    fn over(&self, points: impl Iterator<Item = DVec3> + Clone) -> [Plane; 4] {
        self.planes.map(|plane| {
            let heights = points.clone().map(|point| plane.normals[1].dot(point));
            plane.over(heights.fold(f64::NEG_INFINITY, f64::max))
        })
    }
}

/// Whether one of some planes tells that points of `A` are met no earlier than what it is of.
fn part(planes: &[Plane], points: impl Iterator<Item = DVec3> + Clone) -> bool {
    planes.iter().any(|plane| plane.parts(points.clone()))
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
    let (mut earliest, mut planes) = (Earliest::new(), Planes::new());
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
                    let parted = || part(&planes.over(b.points_of(of_b)), a.points_of(of_a));
                    if arrives.is_some_and(|t| t < earliest.until) && !parted() {
                        *primitive_tests += 1;
                        let (hull_a, hull_b) = (a.primitive_hull(of_a), b.primitive_hull(of_b));
                        let until = earliest.until.min(1.0);
                        let impact = gjk::cast(&hull_a, at_a, motion, &hull_b, at_b, until);
                        let plane = impact.and_then(|impact| Plane::of(&impact, at_a, motion, at_b, &frame));
                        plane.into_iter().for_each(|plane| planes.add(plane));
                        earliest.offer(impact);
                    }
                }
            }
            *until = earliest.until;
        },
    );
    earliest.impact
}
