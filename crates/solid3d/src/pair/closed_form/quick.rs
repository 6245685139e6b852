//! Balls, capsules and boxes without a common space: from two placements that are seen at once.

use std::ops::RangeInclusive;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::gjk::Glance;
use solid_convex::similarity::{STRETCH_ERROR, regular_squares, rough_squares};
use solid_convex::{Closest, Penetration, Witness};

use super::GAP_MIN;
use super::foot::{extent, is_within};
use super::round::Products;
use super::similarity::to_body;
use crate::pair::Placed;
use crate::shape::{Body, Round, Simple};

/// Sizes of the data whose squares and the products of these neither overflow nor vanish.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-30..=1e30;

/// The least square of a size, of which the same holds. None is too large where squares are compared alone: what overflows is the greater.
const SQUARE_MIN: f64 = 1e-60;

/// The squares of scales relative to that of the size of the data, where closest points are found: then they are regular also in a unit near that size,
/// which gives the same bits. They are far from 1 where shapes are that large, or that small, in their own spaces.
const REGULAR_PARTS: RangeInclusive<f64> = 1e-197..=1e197;

/// The least gap or overlap that is decided where lengths are off by as much as a rough look lets them be: of both shapes, twice, for the box that is
/// mapped there and back; more is as good, since few pairs are nearer.
const ROUGH_GAP_MIN: f64 = 8.0 * STRETCH_ERROR;

/// The error of a distance that is given out, relative to the size of the data: no more than GJK's.
pub(super) const DISTANCE_ERROR: f64 = 0.25 * solid_convex::gjk::TOUCHING_ERROR;

/// The same in the margins of an answer.
pub(super) const MARGIN_TO_ERROR: f64 = DISTANCE_ERROR / GAP_MIN;

/// Whether two shapes intersect: squares of lengths against squares, and no evidence.
#[inline(always)]
pub(super) fn intersects<S: Simd>(simd: S, a: Placed, b: Placed) -> Glance {
    let at = [a.placement, b.placement];
    let Some(squares) = rough_squares(simd, at) else { return Glance::Unusual };
    let meet = match (a.shape.simple(), b.shape.simple()) {
        (Some(Simple::Round(a)), Some(Simple::Round(b))) if a.is_ball() & b.is_ball() => {
            balls_meet([a.radius, b.radius], squares, at[1].translation - at[0].translation)
        }
        (Some(a), Some(b)) => View::with_squares(at, squares).meet(a, b),
        _ => return Glance::Unusual,
    };
    meet.map_or(Glance::Open, Glance::Sure)
}

/// Whether a ball and a cylinder, a cone or a hull intersect.
#[inline(always)]
pub(super) fn ball_intersects<S: Simd>(simd: S, a: Placed, b: Placed) -> Glance {
    let (ball, body, turned) = if a.shape.is_ball() { (a, b, 1) } else { (b, a, 0) };
    let (Some(radius), Some(body @ (Body::Cylinder(_) | Body::Cone(_) | Body::Hull { .. }))) =
        (ball.shape.ball_radius(), body.shape.body())
    else {
        return Glance::Unusual;
    };
    let at = [a.placement, b.placement];
    let Some(squares) = rough_squares(simd, at) else { return Glance::Unusual };
    View::with_squares(at, squares).ball_meets(radius, turned, &body).map_or(Glance::Open, Glance::Sure)
}

/// Whether two balls intersect. Where they touch, the size of the data is less than three times the sum of their radii.
#[inline(always)]
fn balls_meet([a, b]: [f64; 2], squares: [f64; 2], offset: DVec3) -> Option<bool> {
    /// Of squares.
    const MARGIN: f64 = 6.0 * ROUGH_GAP_MIN;
    let square = offset.length_squared();
    // The square of the sum of the radii is the sum of their squares and the root of this: no root is waited for.
    let (a, b) = (a * a * squares[0], b * b * squares[1]);
    let (sum, product) = (a + b, 4.0 * (a * b));
    let (less, more) = (square * (1.0 - MARGIN) - sum, square * (1.0 + MARGIN) - sum);
    let meet = (more < 0.0) | (more * more < product);
    let apart = (less > 0.0) & (less * less > product);
    ((sum >= SQUARE_MIN) & (meet | apart)).then_some(meet)
}

/// The closest points of two shapes; `None` where a closer look has to say.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, a: Placed, b: Placed) -> Option<Closest> {
    View::of(simd, [a.placement, b.placement])?.closest(a.shape.simple()?, b.shape.simple()?)
}

/// How deep two balls or capsules are in each other; `None` where a closer look has to say.
#[inline(always)]
pub(super) fn penetration<S: Simd>(simd: S, at: [&DAffine3; 2], rounds: [Round; 2]) -> Option<Penetration> {
    View::of(simd, at)?.penetration(rounds)
}

/// Two placements that are good, as far as all questions want them.
pub(super) struct View<'a> {
    pub at: [&'a DAffine3; 2],
    pub scales: [f64; 2],
    pub squares: [f64; 2],
    /// From the origin of the first to that of the second.
    offset: DVec3,
}

impl<'a> View<'a> {
    #[inline(always)]
    pub fn of<S: Simd>(simd: S, at: [&'a DAffine3; 2]) -> Option<Self> {
        Some(View::with_squares(at, regular_squares(simd, at)?))
    }

    #[inline(always)]
    fn with_squares(at: [&'a DAffine3; 2], squares: [f64; 2]) -> Self {
        let scales = [squares[0].sqrt(), squares[1].sqrt()];
        View { at, scales, squares, offset: at[1].translation - at[0].translation }
    }

    /// Lengths of the two shapes, together.
    #[inline(always)]
    fn both(&self, [a, b]: [f64; 2]) -> f64 {
        a * self.scales[0] + b * self.scales[1]
    }

    /// Whether two shapes intersect.
    #[inline(always)]
    fn meet(&self, a: Simple, b: Simple) -> Option<bool> {
        match (a, b) {
            (Simple::Round(a), Simple::Round(b)) => self.rounds_meet([a, b]),
            (Simple::Round(a), Simple::Cuboid { half }) => self.round_and_box_meet(a, 1, half),
            (Simple::Cuboid { half }, Simple::Round(b)) => self.round_and_box_meet(b, 0, half),
            (Simple::Cuboid { half: a }, Simple::Cuboid { half: b }) => self.boxes_meet([a, b]),
        }
    }

    /// Whether a ball or a capsule and a box, the `cuboid`th of the two, intersect: in the box's own space, times the square of its scale.
    #[inline(always)]
    fn round_and_box_meet(&self, round: Round, cuboid: usize, half: DVec3) -> Option<bool> {
        let unit = self.scales[cuboid];
        let reach = round.reach() * self.scales[1 - cuboid];
        let size = reach + half.element_sum() * unit + self.offset.abs().element_sum();
        if !PLAIN_SIZES.contains(&size) {
            return None;
        }
        let pair = self.ball_and_box(cuboid, half);
        let (radius, margin) = (round.radius * self.scales[1 - cuboid] * unit, ROUGH_GAP_MIN * size * unit);
        let radii = [radius - margin, radius + margin];
        if round.is_ball() {
            return decide(pair.way().length_squared(), radii);
        }
        let axis = self.at[1 - cuboid].matrix3.y_axis * round.half_height;
        pair.segment_meets(self.local(cuboid, axis), half * self.squares[cuboid], radii)
    }

    /// Whether a ball and a body, the `k`th of the two, intersect: in the body's own space, times the square of its scale.
    #[inline(always)]
    fn ball_meets(&self, radius: f64, k: usize, body: &Body) -> Option<bool> {
        let (unit, radius) = (self.scales[k], radius * self.scales[1 - k]);
        let size = radius + extent(body)? * unit + self.offset.abs().element_sum();
        if !PLAIN_SIZES.contains(&size) {
            return None;
        }
        let center = self.other_origin(k);
        is_within(body, self.squares[k], center, radius * unit, ROUGH_GAP_MIN * size * unit)
    }

    /// Whether two boxes intersect, by the balls around them and in them.
    #[inline(always)]
    fn boxes_meet(&self, [a, b]: [DVec3; 2]) -> Option<bool> {
        let inner = self.both([a.min_element(), b.min_element()]);
        let reach = self.both([a.element_sum(), b.element_sum()]);
        if reach < *PLAIN_SIZES.start() {
            return None;
        }
        let outer = self.both([a.length(), b.length()]);
        let ([near, _], [_, far]) = (around(inner, reach), around(outer, reach));
        decide(self.offset.length_squared(), [near, far])
    }

    /// Whether balls or capsules intersect. Without a branch: to ask balls around them and in them first took 41 ns in place of 30, since nobody can
    /// foretell what those say.
    #[inline(always)]
    fn rounds_meet(&self, [a, b]: [Round; 2]) -> Option<bool> {
        let (reach, radii) = (self.both([a.reach(), b.reach()]), self.both([a.radius, b.radius]));
        let [near, far] = around(radii, reach);
        let [axis_a, axis_b] = self.half_axes([a.half_height, b.half_height]);
        let products = Products::new(-self.offset, axis_a, axis_b);
        // The margin is far beyond the rounding of products of lengths, whose squares are beyond its square.
        let [gap, square] = products.gap_and_square(products.closest());
        let apart = (gap > 0.0) & (gap * gap > far * far * square);
        let meet = (near > 0.0) & (square < near * near);
        ((reach >= *PLAIN_SIZES.start()) & (apart | meet)).then_some(meet)
    }

    /// The least gap or overlap that is decided where points are found, of shapes that reach so far; `None` for sizes that are not plain.
    #[inline(always)]
    pub fn margin(&self, reach: [f64; 2]) -> Option<f64> {
        let size = self.both(reach) + self.offset.abs().element_sum();
        let unit = size * size;
        let is_regular =
            |square: f64| (unit * REGULAR_PARTS.start() <= square) & (square <= unit * REGULAR_PARTS.end());
        (PLAIN_SIZES.contains(&size) && is_regular(self.squares[0]) & is_regular(self.squares[1]))
            .then_some(GAP_MIN * size)
    }

    #[inline(always)]
    fn closest(&self, a: Simple, b: Simple) -> Option<Closest> {
        let margin = self.margin([a.radius(), b.radius()])?;
        match (a, b) {
            (Simple::Round(a), Simple::Round(b)) if a.is_ball() & b.is_ball() => {
                self.of_cores(&self.centers(), [DVec3::ZERO; 2], [a.radius, b.radius], margin)
            }
            (Simple::Round(ball), Simple::Cuboid { half }) if ball.is_ball() => {
                let cores = self.ball_and_box(1, half);
                let on_cores = [DVec3::ZERO, cores.on_box()];
                self.of_cores(&cores.placed(self.at[1], 1.0), on_cores, [ball.radius, 0.0], margin)
            }
            (Simple::Cuboid { half }, Simple::Round(ball)) if ball.is_ball() => {
                let cores = self.ball_and_box(0, half);
                let on_cores = [cores.on_box(), DVec3::ZERO];
                self.of_cores(&cores.placed(self.at[0], -1.0), on_cores, [0.0, ball.radius], margin)
            }
            (Simple::Round(a), Simple::Round(b)) => {
                let (cores, on_cores) = self.segments([a.half_height, b.half_height]);
                self.of_cores(&cores, on_cores, [a.radius, b.radius], margin)
            }
            _ => None,
        }
    }

    /// How deep two balls or capsules are in each other, where their cores are apart.
    #[inline(always)]
    fn penetration(&self, [a, b]: [Round; 2]) -> Option<Penetration> {
        let margin = self.margin([a.reach(), b.reach()])?;
        let (cores, on_cores) = if a.is_ball() & b.is_ball() {
            (self.centers(), [DVec3::ZERO; 2])
        } else {
            self.segments([a.half_height, b.half_height])
        };
        let radii = [a.radius * self.scales[0], b.radius * self.scales[1]];
        let (both, length) = (radii[0] + radii[1], cores.square.sqrt());
        let inverse = 1.0 / length;
        let (least, error) = (cores.gap * inverse, margin * MARGIN_TO_ERROR);
        let is_sure = (least > margin) & (length - least <= error) & (length - both < -margin);
        is_sure.then(|| {
            // So far along the way, and no further, are the cores apart.
            let depth = both - least;
            let on_surface = |k: usize| self.local(k, cores.v) * (radii[k] * inverse / self.squares[k]);
            Penetration {
                depth,
                lower: depth - 2.0 * error,
                upper: depth + error,
                direction: cores.v * inverse,
                points: Witness { on_a: on_cores[0] - on_surface(0), on_b: on_cores[1] + on_surface(1) },
            }
        })
    }

    /// From the closest points of the cores, in the shapes' own spaces.
    #[inline(always)]
    fn of_cores(
        &self,
        cores: &Cores,
        on_cores: [DVec3; 2],
        [of_a, of_b]: [f64; 2],
        margin: f64,
    ) -> Option<Closest> {
        let [scale_a, scale_b] = self.scales;
        let (radius_a, radius_b) = (of_a * scale_a, of_b * scale_b);
        let radii = radius_a + radius_b;
        let length = cores.square.sqrt();
        // How far the points are from those of the cores, in lengths of the way between these.
        let (distance, part_a, part_b) = if length - radii < -margin {
            // A common point, as far from each core as its radius is of both.
            let part = radius_a / radii;
            (0.0, part, 1.0 - part)
        } else {
            let inverse = 1.0 / length;
            let least = cores.gap * inverse;
            if !((least - radii > margin) & (length - least <= margin * MARGIN_TO_ERROR)) {
                return None;
            }
            (length - radii, radius_a * inverse, radius_b * inverse)
        };
        let on_a = on_cores[0] - self.local(0, cores.v) * (part_a / self.squares[0]);
        let on_b = on_cores[1] + self.local(1, cores.v) * (part_b / self.squares[1]);
        Some(Closest { distance, points: Witness { on_a, on_b } })
    }

    /// The centres of two balls.
    #[inline(always)]
    fn centers(&self) -> Cores {
        let square = self.offset.length_squared();
        Cores { v: -self.offset, gap: square, square }
    }

    #[inline(always)]
    fn half_axes(&self, [a, b]: [f64; 2]) -> [DVec3; 2] {
        [self.at[0].matrix3.y_axis * a, self.at[1].matrix3.y_axis * b]
    }

    /// Two segments, by half their heights, and the closest points in their own spaces.
    #[inline(always)]
    fn segments(&self, heights: [f64; 2]) -> (Cores, [DVec3; 2]) {
        let [a, b] = self.half_axes(heights);
        let between = -self.offset;
        let [s, t] = Products::new(between, a, b).closest();
        let v = between + a * s - b * t;
        let gap = v.dot(between) - v.dot(a).abs() - v.dot(b).abs();
        let on_cores = [DVec3::Y * (heights[0] * s), DVec3::Y * (heights[1] * t)];
        (Cores { v, gap, square: v.length_squared() }, on_cores)
    }

    /// A ball, and the box that is the `cuboid`th of the two.
    #[inline(always)]
    fn ball_and_box(&self, cuboid: usize, half: DVec3) -> CenterAndBox {
        let center = self.other_origin(cuboid);
        let stretch_squared = self.squares[cuboid];
        let half = half * stretch_squared;
        CenterAndBox { center, on_box: center.clamp(-half, half), stretch_squared }
    }

    /// The origin of the other in the own space of one of the two, times the square of its scale.
    #[inline(always)]
    pub fn other_origin(&self, k: usize) -> DVec3 {
        self.local(k, if k == 1 { -self.offset } else { self.offset })
    }

    /// A vector of the world in the own space of one of the two, times the square of its scale.
    #[inline(always)]
    pub fn local(&self, k: usize, v: DVec3) -> DVec3 {
        to_body(&self.at[k].matrix3, v)
    }
}

/// The closest points of two cores.
struct Cores {
    /// From that of the second to that of the first.
    v: DVec3,
    /// The gap along it, times its length: the distance of the cores is no less.
    gap: f64,
    /// The square of its length: the distance of the cores is no more.
    square: f64,
}

/// A point and a box, in the box's own space, times the square of its scale: there the way from the box is exactly along its axes where the point is
/// beyond a face, and as long as the gap along it.
struct CenterAndBox {
    center: DVec3,
    on_box: DVec3,
    stretch_squared: f64,
}

impl CenterAndBox {
    /// From the box to the point.
    #[inline(always)]
    fn way(&self) -> DVec3 {
        self.center - self.on_box
    }

    /// Whether all within the lesser radius of a segment through the point, given by its half axis, meets the box, and all within the greater does not. What is
    /// apart is told along the axes of the box, and what meets by a point of the segment that is near the box: not where edges pass each other.
    #[inline(always)]
    fn segment_meets(&self, axis: DVec3, half: DVec3, [near, far]: [f64; 2]) -> Option<bool> {
        if (self.center.abs() - axis.abs() - half).max_element() > far {
            return Some(false);
        }
        let inverse = 1.0 / axis.length_squared();
        let nearest_to =
            |point: DVec3| self.center + axis * ((point - self.center).dot(axis) * inverse).clamp(-1.0, 1.0);
        let on_box = nearest_to(DVec3::ZERO).clamp(-half, half);
        let square = nearest_to(on_box).distance_squared(on_box);
        ((near > 0.0) & (square < near * near)).then_some(true)
    }

    /// The point of the box. Space: its own.
    #[inline(always)]
    fn on_box(&self) -> DVec3 {
        self.on_box / self.stretch_squared
    }

    /// In the world; the way from the box is to point there, or the other way for a sign of -1.
    #[inline(always)]
    fn placed(&self, at: &DAffine3, sign: f64) -> Cores {
        let v = at.matrix3 * (self.way() * (sign / self.stretch_squared));
        let square = self.way().length_squared() / self.stretch_squared;
        Cores { v, gap: square, square }
    }
}

/// A length, less and more by the least gap or overlap that is decided: of the size of the data, which is less than three times the reach of both shapes
/// where their reach does not part them.
#[inline(always)]
fn around(length: f64, reach: f64) -> [f64; 2] {
    let margin = 3.0 * ROUGH_GAP_MIN * reach;
    [length - margin, length + margin]
}

/// Whether what is within the lesser radius intersects, and what is within the greater does not, by the square of a distance. Without a branch.
#[inline(always)]
fn decide(square: f64, [near, far]: [f64; 2]) -> Option<bool> {
    let meet = (near > 0.0) & (square < near * near);
    ((square > far * far) | meet).then_some(meet)
}
