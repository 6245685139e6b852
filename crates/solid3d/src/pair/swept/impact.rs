//! When two shapes on their way first meet.
//!
//! Convex shapes by conservative advancement ([`advance`](super::advance)). Complex shapes by the boxes of their trees on the way, as
//! in the other files of this module, and then pair of primitives by pair of primitives, each up to the earliest contact so far.
//! The boxes know straight ways alone: a turn is cut into pieces, and boxes grow by what an arc is off its chord.

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::unit_scale;

use super::advance::{Arrival, Nearness, Span, advance};
use super::bodies::{Moving, MovingClass, MovingComplex, MovingConvex};
use super::body::Body;
use super::path::{Path, Way};
use super::query::{TreeSpace, size};
use crate::pair::reach::{convex_bounds, image_reach, reach};
use crate::pair::{Placed, Relation, Scratch, intersection, midpoint};
use crate::shape::{Class, Shape};

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
        let ways = [a, b].map(|moving| Way::new(moving.from.placement, moving.to.placement, path));
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
            space.primitives(&space.query_of_convex(b), &mut scratch.traversal, &mut primitives);
            let mut earliest = Earliest::new(span);
            for &primitive in &primitives {
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
        let mut primitives = std::mem::take(&mut scratch.on_the_way);
        let mut partners = Vec::new();
        let first = self.pieces().find_map(|span| {
            let [[from_a, to_a], [from_b, to_b]] = self.placements(span);
            let (a, b) = (piece(&a, &from_a, &to_a), piece(&b, &from_b, &to_b));
            let size = size(a.reaches(), b.reaches());
            let bend = self.bend([a.reach(), b.reach()], span);
            let (in_a, in_b) = (TreeSpace::new(&a, size, bend), TreeSpace::new(&b, size, bend));
            in_a.primitives(&in_a.query_of_complex(&b), &mut scratch.traversal, &mut primitives);
            let mut earliest = Earliest::new(span);
            for &of_a in &primitives {
                let hulls = a.primitive_hulls(of_a);
                let query = in_b.query_of_convex(a.ends(&hulls));
                in_b.primitives(&query, &mut scratch.traversal, &mut partners);
                if partners.is_empty() {
                    continue;
                }
                body_a.set_primitive([a.from.0, a.to.0], of_a);
                for &of_b in &partners {
                    body_b.set_primitive([b.from.0, b.to.0], of_b);
                    scratch.primitive_tests += 1;
                    earliest.offer(self.first([&mut body_a, &mut body_b], earliest.span));
                }
            }
            earliest.arrival
        });
        scratch.on_the_way = primitives;
        first
    }

    /// Spans of time in which no shape turns by much, in order.
    fn pieces(&self) -> impl Iterator<Item = Span> + use<> {
        let angle = self.ways.iter().filter_map(|way| way.turn).map(|turn| turn.angle()).fold(0.0, f64::max);
        let count = (angle / PIECE_ANGLE).ceil().max(1.0) as u32;
        let time = move |i: u32| f64::from(i) / f64::from(count);
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
    span: Span,
    arrival: Option<Arrival>,
}

impl Earliest {
    fn new(span: Span) -> Self {
        Earliest { span, arrival: None }
    }

    fn offer(&mut self, arrival: Option<Arrival>) {
        if let Some(arrival) = arrival.filter(|arrival| arrival.time <= self.span.to) {
            self.span.to = arrival.time;
            self.arrival = Some(arrival);
        }
    }
}
