//! The result: polylines, with the primitives that they come from.

use glam::DVec3;

/// Where the surfaces of two placed shapes meet: polylines, in the order of the smallest pair of primitives that each comes
/// from.
///
/// ```
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// let sheet = Shape::mesh([DVec3::ZERO, 2.0 * DVec3::X, 2.0 * DVec3::Y], [[0, 1, 2]])?;
/// let upright = DAffine3::from_translation(DVec3::new(0.5, 0.5, -0.5)) * DAffine3::from_rotation_x(1.5707963267948966);
/// let curve = query::intersection_curve(&sheet, &DAffine3::IDENTITY, &sheet, &upright)?;
/// assert_eq!(curve.polylines.len(), 1);
/// assert_eq!(curve.polylines[0].points, [DVec3::new(1.5, 0.5, 0.0), DVec3::new(0.5, 0.5, 0.0)]);
/// assert!((curve.length() - 1.0).abs() < 1e-15 && !curve.polylines[0].closed);
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntersectionCurve {
    /// The polylines.
    pub polylines: Vec<Polyline>,
}

/// Segments joined end to end, or a single point in which two primitives touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// The ends of the segments, in order; of a closed polyline the first is not repeated. Space: world.
    pub points: Vec<DVec3>,
    /// For each segment the primitives that meet there: the first segment starts at the first point. A single point has one
    /// pair. Where a segment lies on an edge, so that several pairs meet there, the smallest.
    pub primitives: Vec<PrimitivePair>,
    /// Whether a last segment joins the last point with the first.
    pub closed: bool,
}

/// A primitive of each shape, by its place in the order in which they were given; 0 for a convex shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PrimitivePair {
    /// The primitive of the first shape.
    pub a: u32,
    /// The primitive of the second shape.
    pub b: u32,
}

/// A segment in which two primitives meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its ends. Space: world.
    pub ends: [DVec3; 2],
    /// The primitives.
    pub primitives: PrimitivePair,
}

impl IntersectionCurve {
    /// Whether the surfaces do not meet.
    pub fn is_empty(&self) -> bool {
        self.polylines.is_empty()
    }

    /// The first point of the first polyline.
    pub fn first_point(&self) -> Option<DVec3> {
        self.polylines.first().and_then(|polyline| polyline.points.first().copied())
    }

    /// The segments of all polylines; a single point has none.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.polylines.iter().flat_map(Polyline::segments)
    }

    /// The sum of the lengths of all segments.
    pub fn length(&self) -> f64 {
        // The sum of nothing is -0 in the standard library.
        self.segments().map(|segment| segment.ends[0].distance(segment.ends[1])).fold(0.0, |sum, x| sum + x)
    }
}

impl Polyline {
    /// The segments, in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let next = self.points.iter().cycle().skip(1);
        let count = if self.closed { self.points.len() } else { self.points.len().saturating_sub(1) };
        let ends = self.points.iter().zip(next).take(count);
        ends.zip(&self.primitives).map(|((&p, &q), &primitives)| Segment { ends: [p, q], primitives })
    }

    /// The points one after the other, the first again at the end when the polyline is closed: what to draw.
    pub fn path(&self) -> impl Iterator<Item = DVec3> + '_ {
        let again = if self.closed { self.points.first() } else { None };
        self.points.iter().chain(again).copied()
    }
}
