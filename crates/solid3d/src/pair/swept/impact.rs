//! When two shapes on their way first meet.
//!
//! Convex shapes by conservative advancement ([`advance`](super::advance)). Complex shapes by the boxes of their trees on the way,
//! those first that touch first, and then pair of primitives by pair of primitives, each up to the earliest contact so far.
//! The boxes know straight ways alone: a turn is cut into pieces, and boxes grow by what an arc is off its chord.

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::unit_scale;

use super::advance::{Arrival, Nearness, Span, advance};
use super::bodies::{Moving, MovingClass, MovingComplex, MovingConvex};
use super::body::Body;
use super::moving_box::MovingBox;
use super::path::{Path, Roundness, Way};
use super::query::{TreeSpace, size};
use crate::pair::frame::Frame;
use crate::pair::reach::{convex_bounds, image_reach, reach};
use crate::pair::{Placed, Relation, Scratch, intersection, midpoint};
use crate::shape::{Class, Shape};
use crate::tree::first_pairs;

/// When and where two moving shapes meet. Space: world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub time: f64,
    pub point: DVec3,
    /// From `B` to `A`; `None` when they intersect at the start.
    pub normal: Option<DVec3>,
}

/// The least tolerance, of the sizes: ten times what GJK takes for touching, so that there is a gap to advance by.
pub(crate) const TOLERANCE_MIN: f64 = 1e-10;

/// The least gap that is a contact, of the way of one origin as seen from the other, and of how far shapes reach from theirs: positions on the
/// way are off by some 1e-15 of it.
const WAY_ERROR: f64 = 1e-13;

/// The most by which a shape turns in a piece of its way: an arc is then off its chord by 0.5 % of the radius.
const PIECE_ANGLE: f64 = std::f64::consts::PI / 16.0;

/// How much earlier a piece may end, as a part of it, where a shape would be flat: on a straight way it is so at three times at most, and there is but
/// one straight way where pieces end, as the other turns.
const EARLIER: [f64; 4] = [0.0, 0.125, 0.25, 0.375];

/// What arrives at the very end counts.
const END: f64 = 1.0 + 8.0 * f64::EPSILON;

/// The way of the origin of `B` as seen from itself.
const STILL: [DVec3; 2] = [DVec3::ZERO; 2];

/// The whole way.
const WHOLE: Span = Span { from: 0.0, to: 1.0 };

/// When two shapes first meet on their way; the tolerance is relative to the sum of their sizes.
pub(crate) fn impact(
    a: &Moving,
    b: &Moving,
    path: Path,
    tolerance: f64,
    scratch: &mut Scratch,
) -> Option<Meeting> {
    if let Relation::Common(witness) = intersection(a.from, b.from, scratch) {
        return Some(Meeting { time: 0.0, point: midpoint(a.from, b.from, &witness), normal: None });
    }
    let course = Course::new(a, b, path, tolerance);
    let arrival = match (a.class(), b.class()) {
        (MovingClass::Convex(a), MovingClass::Convex(b)) => course.convex_convex(a, b, scratch),
        (MovingClass::Complex(a), MovingClass::Convex(b)) => course.complex_convex(a, b, scratch),
        (MovingClass::Convex(a), MovingClass::Complex(b)) => {
            course.mirrored().complex_convex(b, a, scratch).map(mirrored_normal)
        }
        (MovingClass::Complex(a), MovingClass::Complex(b)) => course.complex_complex(a, b, scratch),
    };
    arrival.map(|Arrival { time, normal, point }| {
        // Points are seen from the origin of `B`, or of `A` where the two were swapped.
        let swapped = matches!((a.class(), b.class()), (MovingClass::Convex(_), MovingClass::Complex(_)));
        let seen_from = course.ways[usize::from(!swapped)].origin_at(time);
        Meeting { time, normal, point: point / course.scale + seen_from }
    })
}

fn mirrored_normal(arrival: Arrival) -> Arrival {
    Arrival { normal: arrival.normal.map(|normal| -normal), ..arrival }
}

/// The ways of two shapes, and what is a contact.
#[derive(Clone, Copy)]
struct Course {
    ways: [Way; 2],
    /// The way of the local origin of `A` as seen from that of `B`.
    origin: [DVec3; 2],
    scale: f64,
    nearness: Nearness,
}

impl Course {
    fn new(a: &Moving, b: &Moving, path: Path, tolerance: f64) -> Course {
        let deforms = [a, b].iter().any(|moving| moving.from.shape.is_deformation_of(moving.to.shape));
        let path = if deforms { Path::Straight } else { path };
        let ways = [a, b].map(|moving| {
            let way = Way::new(moving.from.placement, moving.to.placement, path);
            way.of_round(Roundness::of(moving.from.shape.kind()))
        });
        let origin = [0, 1].map(|end| ways[0].origin[end] - ways[1].origin[end]);
        let far =
            greatest(a, reach) + greatest(b, reach) + origin[0].abs().max(origin[1].abs()).max_element();
        let sizes = greatest(a, half_extents) + greatest(b, half_extents);
        let scale = unit_scale(far);
        let least = (TOLERANCE_MIN * sizes).max(WAY_ERROR * far) * scale;
        let nearness = Nearness { tolerance: (tolerance * sizes * scale).max(least), least };
        Course { ways, origin, scale, nearness }
    }

    /// The same with `A` for `B`.
    fn mirrored(&self) -> Course {
        let ([a, b], origin) = (self.ways, self.origin.map(|origin| -origin));
        Course { ways: [b, a], origin, ..*self }
    }

    fn convex_convex(&self, a: MovingConvex, b: MovingConvex, scratch: &mut Scratch) -> Option<Arrival> {
        let mut body_a = Body::shape(a[1].0, &self.ways[0], self.origin, self.scale);
        let mut body_b = Body::shape(b[1].0, &self.ways[1], STILL, self.scale);
        scratch.primitive_tests += 1;
        advance(&mut body_a, &mut body_b, WHOLE, self.nearness)
    }

    fn complex_convex(&self, a: MovingComplex, b: MovingConvex, scratch: &mut Scratch) -> Option<Arrival> {
        let mut body_a = Body::primitive(&self.ways[0], self.origin, self.scale);
        let mut body_b = Body::shape(b[1].0, &self.ways[1], STILL, self.scale);
        let mut primitives = std::mem::take(&mut scratch.on_the_way);
        let first = self.pieces().find_map(|span| {
            let [[from_a, to_a], [from_b, to_b]] = self.placements(span);
            let (a, b) = (piece(&a, &from_a, &to_a), [(b[0].0, &from_b), (b[1].0, &to_b)]);
            let size = size(a.reaches(), b.map(|(shape, at)| (shape.reach(), at)));
            let bend = self.bend([a.reach(), b[1].0.reach()], span);
            let space = TreeSpace::new(&a, size, bend);
            let query = space.query_of_convex(b);
            space.primitives(&query, &mut scratch.traversal, &mut primitives);
            // What may be met first comes first: the others are then mostly out of the question.
            let arrives = |&i: &u32| query.touches(&MovingBox::still(a.to.0.primitive_bounds(i)));
            let mut by_time: Vec<_> = primitives.iter().filter_map(|i| Some((arrives(i)?, *i))).collect();
            by_time.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let mut earliest = Earliest::new(span);
            for (arrives, primitive) in by_time {
                if arrives >= earliest.until() {
                    break;
                }
                body_a.set_primitive([a.from.0, a.to.0], primitive);
                scratch.primitive_tests += 1;
                earliest.offer(self.first([&mut body_a, &mut body_b], earliest.span));
            }
            earliest.arrival
        });
        scratch.on_the_way = primitives;
        first
    }

    fn complex_complex(&self, a: MovingComplex, b: MovingComplex, scratch: &mut Scratch) -> Option<Arrival> {
        let mut body_a = Body::primitive(&self.ways[0], self.origin, self.scale);
        let mut body_b = Body::primitive(&self.ways[1], STILL, self.scale);
        let Scratch { traversal, primitive_tests, .. } = scratch;
        self.pieces().find_map(|span| {
            let [[from_a, to_a], [from_b, to_b]] = self.placements(span);
            let (a, b) = (piece(&a, &from_a, &to_a), piece(&b, &from_b, &to_b));
            let size = size(a.reaches(), b.reaches());
            let space = TreeSpace::new(&a, size, self.bend([a.reach(), b.reach()], span));
            let (parts_a, parts_b) = (space.parts_of(&a), space.parts_of(&b));
            let relative = Frame::new(&to_a, a.reach(), &to_b, b.reach()).relative();
            let mut earliest = Earliest::new(span);
            let mut until = earliest.until();
            let look = |leaf_a: &[u32], leaf_b: &[u32], until: &mut f64| {
                for &of_a in leaf_a {
                    let moving_a = parts_a.primitive(of_a).inflated(space.slack);
                    for &of_b in leaf_b {
                        let arrives = moving_a.touches(&parts_b.primitive(of_b));
                        if arrives.is_none_or(|time| time >= earliest.until()) {
                            continue;
                        }
                        body_a.set_primitive([a.from.0, a.to.0], of_a);
                        body_b.set_primitive([b.from.0, b.to.0], of_b);
                        *primitive_tests += 1;
                        earliest.offer(self.first([&mut body_a, &mut body_b], earliest.span));
                    }
                }
                *until = earliest.until();
            };
            first_pairs(
                [a.to.0.tree(), b.to.0.tree()],
                &relative,
                |bounds| parts_a.within(bounds).inflated(space.slack),
                |bounds| parts_b.within(bounds),
                MovingBox::touches,
                &mut until,
                traversal,
                look,
            );
            earliest.arrival
        })
    }

    /// Spans of time in which no shape turns by much, in order. They end where no shape is flat, for boxes are compared in the space that one
    /// has at the end.
    fn pieces(&self) -> impl Iterator<Item = Span> + use<> {
        let angle = self.ways.iter().filter_map(|way| way.turn).map(|turn| turn.angle()).fold(0.0, f64::max);
        let count = (angle / PIECE_ANGLE).ceil().max(1.0) as u32;
        let ways = self.ways;
        let time = move |i: u32| {
            let [evenly, others @ ..] = EARLIER.map(|earlier| (f64::from(i) - earlier) / f64::from(count));
            let is_flat = |t: &f64| ways.iter().any(|way| way.is_flat_at(*t));
            if i == 0 || i == count || !is_flat(&evenly) {
                return evenly;
            }
            others.into_iter().find(|t| !is_flat(t)).unwrap_or(evenly)
        };
        (0..count).map(move |i| Span { from: time(i), to: time(i + 1) })
    }

    /// The placements of both at the ends of a span.
    fn placements(&self, span: Span) -> [[DAffine3; 2]; 2] {
        self.ways.map(|way| [way.placement_at(span.from), way.placement_at(span.to)])
    }

    /// How far points of the two, which reach that far from their origins, may in a span be off the straight ways between its ends.
    /// World units.
    fn bend(&self, reaches: [DVec3; 2], span: Span) -> f64 {
        let duration = span.to - span.from;
        let acceleration = |(way, reach): (&Way, DVec3)| {
            let far = |linear: DMat3| image_reach(&linear, reach).length();
            let [from, to] = way.linear;
            way.acceleration(far(from).max(far(to)), far(to - from))
        };
        let sum: f64 = self.ways.iter().zip(reaches).map(acceleration).sum();
        0.125 * duration * duration * sum
    }

    /// When two bodies first meet in a span, at the start of which they are apart.
    fn first(&self, [a, b]: [&mut Body; 2], span: Span) -> Option<Arrival> {
        let arrival = advance(a, b, span, self.nearness)?;
        if arrival.normal.is_none() && span.from > 0.0 {
            // They met at the end of the piece before, in which the boxes just missed it.
            return advance(a, b, Span { from: 0.0, ..span }, self.nearness).or(Some(arrival));
        }
        Some(arrival)
    }
}

/// A piece of a way.
fn piece<'a>(moving: &MovingComplex<'a>, from: &'a DAffine3, to: &'a DAffine3) -> MovingComplex<'a> {
    MovingComplex { from: (moving.from.0, from), to: (moving.to.0, to), deformation: moving.deformation }
}

/// The greatest coordinate of what a shape has in its own space, placed in the world, at the larger end of its way.
fn greatest(moving: &Moving, of: impl Fn(&Shape) -> DVec3) -> f64 {
    let (from, to) = (moving.from, moving.to);
    let at_first = of(from.shape);
    let at_last = if std::ptr::eq(from.shape, to.shape) { at_first } else { of(to.shape) };
    let placed = |at: Placed, of_shape| image_reach(&at.placement.matrix3, of_shape).max_element();
    placed(from, at_first).max(placed(to, at_last))
}

/// How far a shape reaches from its middle.
fn half_extents(shape: &Shape) -> DVec3 {
    match shape.class() {
        Class::Convex(convex) => convex_bounds(convex, &DMat3::IDENTITY).half_extents(),
        Class::Complex(complex) => complex.bounds().half_extents(),
    }
}

/// The earliest contact so far in a span, of which only what is before is of interest.
struct Earliest {
    /// When the span begins, and how long it is.
    from: f64,
    duration: f64,
    span: Span,
    arrival: Option<Arrival>,
}

impl Earliest {
    fn new(span: Span) -> Self {
        Earliest { from: span.from, duration: span.to - span.from, span, arrival: None }
    }

    /// Until when, as a part of the whole span, boxes are of interest: a little longer, for rounding.
    fn until(&self) -> f64 {
        (self.span.to - self.from) / self.duration * END
    }

    /// Takes one that was looked for in what is left of the span, and is the earlier therefore.
    fn offer(&mut self, arrival: Option<Arrival>) {
        if let Some(arrival) = arrival {
            self.span.to = arrival.time;
            self.arrival = Some(arrival);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ComplexShapeBuilder;
    use crate::bounds::Aabb;
    use solid_oracle::generate::grid;

    /// Law: what is met later costs little. Two surfaces of 7,000 triangles, of which each passes over all of the other.
    #[test]
    fn of_meshes_only_what_may_meet_first_is_looked_at() {
        const SIDE: u32 = 60;
        let point = |i: u32| {
            let (x, y) = (f64::from(i % SIDE), f64::from(i / SIDE));
            DVec3::new(x, y, 3.0 * (0.3 * x).sin() * (0.2 * y).cos()) / f64::from(SIDE)
        };
        let mesh = Shape::mesh((0..SIDE * SIDE).map(point).collect::<Vec<_>>(), grid(SIDE)).unwrap();
        let ball = Shape::sphere(0.05).unwrap();
        let polygon = ComplexShapeBuilder::new([DVec3::ZERO, DVec3::X * 0.1, DVec3::Y * 0.1]);
        let triangle = polygon.triangle([0, 1, 2]).build().unwrap();
        let here = DAffine3::IDENTITY;
        let from = DAffine3::from_translation(DVec3::new(-1.0, 0.2, 1.5));
        let to = DAffine3::from_translation(DVec3::new(2.0, 0.1, -1.5)) * DAffine3::from_rotation_z(1.0);
        let still = Aabb::new(DVec3::ZERO, DVec3::ZERO);
        for (other, most) in [(&mesh, 1000), (&triangle, 40), (&ball, 100)] {
            for path in [Path::Turning, Path::Straight] {
                let moving = |shape, from, to| Moving {
                    from: Placed { shape, placement: from },
                    to: Placed { shape, placement: to },
                    deformation: still,
                };
                let mut scratch = Scratch::default();
                let (a, b) = (moving(&mesh, &here, &here), moving(other, &from, &to));
                let found = impact(&a, &b, path, 1e-8, &mut scratch);
                println!("{path:?}: {} tests of primitives", scratch.primitive_tests);
                assert!(found.is_some_and(|meeting| meeting.time > 0.3), "{found:?}");
                assert!(scratch.primitive_tests < most, "{}", scratch.primitive_tests);
            }
        }
    }
}
