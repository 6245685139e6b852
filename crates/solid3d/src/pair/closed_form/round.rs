//! Balls and capsules: all points within a radius of a core. Their gap is that of the cores, less the radii.

use glam::DVec3;
use solid_convex::Witness;

use super::boxes::PlacedBox;
use super::similarity::Similarity;
use super::{Gap, Relation};
use crate::shape::Round;

/// A ball or a capsule, in the space of the pair.
pub(super) struct PlacedRound {
    radius: f64,
    center: DVec3,
    /// From the centre to an end of the core, in its own space; zero for a ball.
    half_height: f64,
    /// The same in the space of the pair.
    half_axis: DVec3,
    at: Similarity,
}

/// The closest points of the cores of two shapes, the second of which may be a box without a radius.
pub(super) struct Cores<'a> {
    /// From the one on `B` to the one on `A`, in the space of the pair.
    way: DVec3,
    radii: [f64; 2],
    /// The gap of the cores along the way: no more than the distance of the cores. The points'
    /// own distance is no less.
    gap_along: f64,
    /// The points, each in its shape's own space: in that of the pair, one on a small shape beside a large one would have no digits.
    local: [DVec3; 2],
    at: [&'a Similarity; 2],
}

impl PlacedRound {
    pub fn new(Round { radius, half_height }: Round, at: Similarity, center: DVec3) -> PlacedRound {
        let half_axis = if half_height == 0.0 { DVec3::ZERO } else { at.y_axis() * half_height };
        PlacedRound { radius: radius * at.stretch, center, half_height, half_axis, at }
    }

    /// Where on the core, in half heights from its middle.
    fn on_core(&self, part: f64) -> DVec3 {
        DVec3::Y * (self.half_height * part)
    }
}

impl<'a> Cores<'a> {
    pub fn of_rounds(a: &'a PlacedRound, b: &'a PlacedRound) -> Cores<'a> {
        let between = a.center - b.center;
        let [s, t] = Products::new(between, a.half_axis, b.half_axis).closest();
        let v = between + a.half_axis * s - b.half_axis * t;
        // What A has least along v, less what B has most.
        let along = v.dot(between) - v.dot(a.half_axis).abs() - v.dot(b.half_axis).abs();
        Cores {
            way: v,
            radii: [a.radius, b.radius],
            gap_along: along,
            local: [a.on_core(s), b.on_core(t)],
            at: [&a.at, &b.at],
        }
        .with_length()
    }

    /// `None` for a capsule.
    pub fn of_round_and_box(a: &'a PlacedRound, b: &'a PlacedBox) -> Option<Cores<'a>> {
        if a.half_axis != DVec3::ZERO {
            return None;
        }
        let local = b.at.local(a.center - b.center);
        let on_box = local.clamp(-b.half, b.half);
        // From the difference in the box's own space, which is exactly along its axes where the centre is beyond a face: as
        // an axis it must be right over the whole box, however near to it a small ball is.
        let v = b.at.apply(local - on_box);
        let cores = Cores {
            way: v,
            radii: [a.radius, 0.0],
            gap_along: v.dot(a.center - b.center) - b.at.reach_along(v, b.half),
            local: [DVec3::ZERO, on_box],
            at: [&a.at, &b.at],
        };
        Some(cores.with_length())
    }

    /// With the gap in units of length, where it was times the length of the way.
    fn with_length(mut self) -> Self {
        let length = self.way.length();
        self.gap_along = if length > 0.0 { self.gap_along / length } else { 0.0 };
        self
    }

    pub fn gap(&self) -> Gap {
        let radii = self.radii[0] + self.radii[1];
        Gap { least: self.gap_along - radii, greatest: self.way.length() - radii }
    }

    pub fn relation(&self) -> Option<Relation> {
        Some(if self.gap().intersects()? {
            Relation::Common(self.common_point())
        } else {
            Relation::Separated { axis: Some(self.way.normalize()) }
        })
    }

    /// A point between those of the cores, as far from each as its radius is of both; of a box without a radius, its own.
    fn common_point(&self) -> Witness {
        let both = self.radii[0] + self.radii[1];
        let part = |k: usize| self.at[k].local(self.way * (self.radii[k] / both));
        Witness { on_a: self.local[0] - part(0), on_b: self.local[1] + part(1) }
    }
}

/// The scalar products of two segments: of their half axes `a` and `b`, and of the way `between` their middles, from the second to the first.
pub(super) struct Products {
    aa: f64,
    bb: f64,
    ab: f64,
    to_a: f64,
    to_b: f64,
    between: f64,
}

impl Products {
    #[inline(always)]
    pub fn new(between: DVec3, a: DVec3, b: DVec3) -> Self {
        Products {
            aa: a.length_squared(),
            bb: b.length_squared(),
            ab: a.dot(b),
            to_a: a.dot(between),
            to_b: b.dot(between),
            between: between.length_squared(),
        }
    }

    /// Where the segments are the closest, in half axes from their middles, from -1 to 1 (Ericson, *Real-Time Collision
    /// Detection*, section 5.1.9). Only points of the segments, however nearly parallel they are; how good these are is told
    /// by the gap along the line that joins them.
    #[inline(always)]
    pub fn closest(&self) -> [f64; 2] {
        let &Products { aa, bb, ab, to_a, to_b, .. } = self;
        let square = aa * bb - ab * ab;
        // The divisions do not wait for each other.
        #[inline(always)]
        fn reciprocal(x: f64) -> f64 {
            if x > 0.0 { 1.0 / x } else { 0.0 }
        }
        let (by_aa, by_bb, by_square) = (reciprocal(aa), reciprocal(bb), reciprocal(square));
        // The place on the other segment's line that is closest, kept on the segment; the middle of a point.
        let on_a = |t: f64| ((ab * t - to_a) * by_aa).clamp(-1.0, 1.0);
        let on_b = |s: f64| ((ab * s + to_b) * by_bb).clamp(-1.0, 1.0);
        let t = on_b(((ab * to_b - bb * to_a) * by_square).clamp(-1.0, 1.0));
        [on_a(t), t]
    }

    /// Of the way between two points of the segments: the gap along it times its length, and the square of its length. Off by a few roundings of
    /// the square of the size of the data.
    #[inline(always)]
    pub fn gap_and_square(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        let of_between = (self.between - t * self.to_b) + s * self.to_a;
        let (of_a, of_b) = (s * self.aa - (self.ab * t - self.to_a), (self.to_b - t * self.bb) + s * self.ab);
        [of_between - of_a.abs() - of_b.abs(), of_between + s * of_a - t * of_b]
    }
}
