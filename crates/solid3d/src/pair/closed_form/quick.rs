//! Balls, capsules and boxes without a common space: from two placements that are seen at once.

use std::ops::RangeInclusive;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::similarity::{STRETCH_ERROR, plain_squares, rough_square};
use solid_convex::{Closest, Witness};

use super::GAP_MIN;
use super::round::{DISTANCE_ERROR, closest_on_segments};
use crate::pair::Placed;
use crate::shape::{Shape, Simple};

/// Sizes of the data whose squares and the products of these neither overflow nor vanish.
const PLAIN_SIZES: RangeInclusive<f64> = 1e-30..=1e30;

/// The squares of scales relative to that of the size of the data, where closest points are found: then they are plain also in a unit near that size,
/// which gives the same bits.
const PLAIN_PARTS: RangeInclusive<f64> = 1e-58..=1e58;

/// The least gap or overlap that is decided where lengths are off by as much as a rough look lets them be: of both shapes, twice, for the box that is
/// mapped there and back; more is as good, since few pairs are nearer.
const ROUGH_GAP_MIN: f64 = 8.0 * STRETCH_ERROR;

/// The error of a distance that is given out, in the margins of an answer.
const MARGIN_TO_ERROR: f64 = DISTANCE_ERROR / GAP_MIN;

/// What a first look says. Whatever it says but [`Unusual`](Quick::Unusual), the placements are good: similarities of plain sizes.
pub(super) enum Quick<T> {
    Sure(T),
    /// A closer look has to say.
    Open,
    /// Nothing is known, of the placements neither.
    Unusual,
}

/// Whether two shapes intersect: squares of lengths against squares, and no evidence.
#[inline]
pub(super) fn intersects(a: Placed, b: Placed) -> Quick<bool> {
    if let (Some(Simple::Ball { radius: of_a }), Some(Simple::Ball { radius: of_b })) =
        (a.shape.simple(), b.shape.simple())
    {
        return balls((of_a, a.placement), (of_b, b.placement));
    }
    match View::rough([a.placement, b.placement]) {
        Some(view) => view.intersects(a.shape, b.shape).map_or(Quick::Open, Quick::Sure),
        None => Quick::Unusual,
    }
}

/// Whether two balls intersect. Where they touch, the size of the data is less than three times the sum of their radii.
#[inline(always)]
fn balls((of_a, at_a): (f64, &DAffine3), (of_b, at_b): (f64, &DAffine3)) -> Quick<bool> {
    /// Of squares.
    const MARGIN: f64 = 6.0 * ROUGH_GAP_MIN;
    let (Some(square_a), Some(square_b)) = (rough_square(at_a), rough_square(at_b)) else {
        return Quick::Unusual;
    };
    let square = (at_b.translation - at_a.translation).length_squared();
    let radii = of_a * square_a.sqrt() + of_b * square_b.sqrt();
    let touching = radii * radii;
    if !PLAIN_SIZES.contains(&radii) {
        Quick::Open
    } else if square > touching * (1.0 + MARGIN) {
        Quick::Sure(false)
    } else if square < touching * (1.0 - MARGIN) {
        Quick::Sure(true)
    } else {
        Quick::Open
    }
}

/// The closest points of two shapes; `None` where a closer look has to say.
#[inline(always)]
pub(super) fn closest<S: Simd>(simd: S, a: Placed, b: Placed) -> Option<Closest> {
    View::of(simd, [a.placement, b.placement])?.closest(a.shape.simple()?, b.shape.simple()?)
}

/// Two placements that are good, as far as all questions want them.
struct View<'a> {
    at: [&'a DAffine3; 2],
    scales: [f64; 2],
    squares: [f64; 2],
    /// From the origin of the first to that of the second.
    offset: DVec3,
}

impl<'a> View<'a> {
    #[inline(always)]
    fn of<S: Simd>(simd: S, at: [&'a DAffine3; 2]) -> Option<Self> {
        Some(View::with_squares(at, plain_squares(simd, at)?))
    }

    /// Of placements that nearly turn and scale alike in all directions: lengths are off by up to [`STRETCH_ERROR`].
    #[inline(always)]
    fn rough(at: [&'a DAffine3; 2]) -> Option<Self> {
        Some(View::with_squares(at, [rough_square(at[0])?, rough_square(at[1])?]))
    }

    #[inline(always)]
    fn with_squares(at: [&'a DAffine3; 2], squares: [f64; 2]) -> Self {
        let scales = [squares[0].sqrt(), squares[1].sqrt()];
        View { at, scales, squares, offset: at[1].translation - at[0].translation }
    }

    /// The radii of balls around the origins that contain the shapes, together; and the size of the data. `None` of sizes that are not plain.
    #[inline(always)]
    fn reach_and_size(&self, a: &Simple, b: &Simple) -> Option<[f64; 2]> {
        let reach = a.radius() * self.scales[0] + b.radius() * self.scales[1];
        let size = reach + self.offset.abs().element_sum();
        PLAIN_SIZES.contains(&size).then_some([reach, size])
    }

    #[inline(always)]
    fn intersects(&self, a: &Shape, b: &Shape) -> Option<bool> {
        let square = self.offset.length_squared();
        match (a.simple()?, b.simple()?) {
            // In the box's own space, times the square of its scale.
            (a @ Simple::Ball { radius }, b @ Simple::Cuboid { half }) => {
                let [_, size] = self.reach_and_size(&a, &b)?;
                let square = self.ball_and_box(1, half).way().length_squared();
                let unit = self.scales[1];
                decide([square, square], radius * self.scales[0] * unit, ROUGH_GAP_MIN * size * unit)
            }
            (a @ Simple::Cuboid { half }, b @ Simple::Ball { radius }) => {
                let [_, size] = self.reach_and_size(&a, &b)?;
                let square = self.ball_and_box(0, half).way().length_squared();
                let unit = self.scales[0];
                decide([square, square], radius * self.scales[1] * unit, ROUGH_GAP_MIN * size * unit)
            }
            // By the balls around them and in them.
            (a @ Simple::Cuboid { half: half_a }, b @ Simple::Cuboid { half: half_b }) => {
                let [reach, size] = self.reach_and_size(&a, &b)?;
                let margin = ROUGH_GAP_MIN * size;
                let far = reach + margin;
                let near =
                    half_a.min_element() * self.scales[0] + half_b.min_element() * self.scales[1] - margin;
                let meet = (near > 0.0) & (square < near * near);
                ((square > far * far) | meet).then_some(meet)
            }
            (a, b) => {
                let [reach, size] = self.reach_and_size(&a, &b)?;
                let margin = ROUGH_GAP_MIN * size;
                // Balls around them are apart.
                if square > (reach + margin) * (reach + margin) {
                    return Some(false);
                }
                let ((radius_a, height_a), (radius_b, height_b)) = (a.core()?, b.core()?);
                let cores = self.segments(height_a, height_b);
                let radii = radius_a * self.scales[0] + radius_b * self.scales[1];
                decide([cores.least_squared(), cores.square], radii, ROUGH_GAP_MIN * size)
            }
        }
    }

    #[inline(always)]
    fn closest(&self, a: Simple, b: Simple) -> Option<Closest> {
        let [_, size] = self.reach_and_size(&a, &b)?;
        let (margin, unit) = (GAP_MIN * size, size * size);
        let is_plain =
            |square: f64| (unit * PLAIN_PARTS.start() <= square) & (square <= unit * PLAIN_PARTS.end());
        if !(is_plain(self.squares[0]) & is_plain(self.squares[1])) {
            return None;
        }
        match (a, b) {
            (Simple::Ball { radius: a }, Simple::Ball { radius: b }) => {
                self.of_cores(&self.centers(), [DVec3::ZERO; 2], [a, b], margin)
            }
            (Simple::Ball { radius }, Simple::Cuboid { half }) => {
                let cores = self.ball_and_box(1, half);
                let on_cores = [DVec3::ZERO, cores.on_box()];
                self.of_cores(&cores.placed(self.at[1], 1.0), on_cores, [radius, 0.0], margin)
            }
            (Simple::Cuboid { half }, Simple::Ball { radius }) => {
                let cores = self.ball_and_box(0, half);
                let on_cores = [cores.on_box(), DVec3::ZERO];
                self.of_cores(&cores.placed(self.at[0], -1.0), on_cores, [0.0, radius], margin)
            }
            (a, b) => {
                let ((radius_a, height_a), (radius_b, height_b)) = (a.core()?, b.core()?);
                let cores = self.segments(height_a, height_b);
                let [s, t] = cores.along;
                self.of_cores(
                    &cores,
                    [DVec3::Y * (height_a * s), DVec3::Y * (height_b * t)],
                    [radius_a, radius_b],
                    margin,
                )
            }
        }
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
        let back = |k: usize| self.at[k].matrix3.mul_transpose_vec3(cores.v);
        let on_a = on_cores[0] - back(0) * (part_a / self.squares[0]);
        let on_b = on_cores[1] + back(1) * (part_b / self.squares[1]);
        Some(Closest { distance, points: Witness { on_a, on_b } })
    }

    /// The centres of two balls.
    #[inline(always)]
    fn centers(&self) -> Cores {
        let square = self.offset.length_squared();
        Cores { v: -self.offset, gap: square, square, along: [0.0; 2] }
    }

    /// Two segments, by half their heights.
    #[inline(always)]
    fn segments(&self, height_a: f64, height_b: f64) -> Cores {
        let (a, b) = (self.at[0].matrix3.y_axis * height_a, self.at[1].matrix3.y_axis * height_b);
        let between = -self.offset;
        let (s, t) = closest_on_segments(between, a, b);
        let v = between + a * s - b * t;
        let gap = v.dot(between) - v.dot(a).abs() - v.dot(b).abs();
        Cores { v, gap, square: v.length_squared(), along: [s, t] }
    }

    /// A ball, and the box that is the `cuboid`th of the two.
    #[inline(always)]
    fn ball_and_box(&self, cuboid: usize, half: DVec3) -> CenterAndBox {
        let center = if cuboid == 1 { -self.offset } else { self.offset };
        let stretch_squared = self.squares[cuboid];
        let half = half * stretch_squared;
        let center = self.at[cuboid].matrix3.mul_transpose_vec3(center);
        CenterAndBox { center, on_box: center.clamp(-half, half), stretch_squared }
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
    /// Where on the segments, in half heights from the middles.
    along: [f64; 2],
}

impl Cores {
    /// The square of a lower bound of their distance.
    #[inline(always)]
    fn least_squared(&self) -> f64 {
        if self.gap > 0.0 { self.gap * self.gap / self.square } else { 0.0 }
    }
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
        Cores { v, gap: square, square, along: [0.0; 2] }
    }
}

/// Whether what is within the radii of two cores intersects, by the squares of bounds of their distance. Without a branch.
#[inline(always)]
fn decide([least, greatest]: [f64; 2], radii: f64, margin: f64) -> Option<bool> {
    let (near, far) = (radii - margin, radii + margin);
    let meet = (near > 0.0) & (greatest < near * near);
    ((least > far * far) | meet).then_some(meet)
}
