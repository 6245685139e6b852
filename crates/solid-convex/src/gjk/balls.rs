//! Whether two objects intersect, by a ball around each and a ball in each: for the many pairs that no search is needed for.
//!
//! A placement makes ellipsoids of the balls, `x -> L x` of a ball of radius `r`. Along a vector `v` such an ellipsoid reaches
//! `r |L^T v|` from its centre, and along the line of `v` it extends `r / |L^-1 v|` times `v`. Where those around the objects are apart along
//! the line of their centres, so are the objects; where those in the objects overlap on that line, so do the objects.

use std::ops::RangeInclusive;

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};

use super::intersection::CACHED_GAP_MIN;
use crate::difference::SUPPORT_ERROR;
use crate::simd::dispatch;
use crate::similarity::{STRETCH_ERROR, rough_squares};
use crate::{Polytope, Support};

/// A ball. Space: that of the object that it is told of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre.
    pub center: DVec3,
    /// The radius.
    pub radius: f64,
}

/// Balls by which a pair may be decided, the less is between them the more often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balls {
    /// One that the object contains; of radius 0 for none.
    pub inner: Ball,
    /// One that contains the object.
    pub outer: Ball,
}

/// The least gap that is an answer, relative to the size of the data, which here is more than [`Difference`](crate::difference::Difference)
/// has it: then the first step of a search sees it too, and says the same.
const GAP_MIN: f64 = 4.0 * SUPPORT_ERROR;

/// A bound on the error of the way from centre to centre, relative to the size of the data: two matrix products and three sums.
const CENTER_ERROR: f64 = 16.0 * f64::EPSILON;

/// A bound on the relative error of the test for an overlap, beside that of the centres: some thirty roundings.
const OVERLAP_ERROR: f64 = 64.0 * f64::EPSILON;

/// A bound on the error of scalar products of a placement's axes, relative to the longest one's square.
const GRAM_ERROR: f64 = 16.0 * f64::EPSILON;

/// Squares whose products neither overflow nor lose digits.
const PLAIN_SQUARES: RangeInclusive<f64> = 1e-120..=1e120;

/// Whether two placed objects intersect; `None` where their balls do not tell.
#[inline]
pub(super) fn decide<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> Option<bool>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    match (a.as_polytope(), b.as_polytope()) {
        (Some(a), Some(b)) => match glance(a, placement_a, b, placement_b) {
            Glance::Sure(answer) => Some(answer),
            Glance::Open => None,
            // Without a call that would return them through memory.
            Glance::Unusual => compare(a.own_balls(), placement_a, b.own_balls(), placement_b),
        },
        _ => compare(&a.balls()?, placement_a, &b.balls()?, placement_b),
    }
}

/// What a glance at two placed polytopes tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Glance {
    /// Whether they intersect: what [`intersects`](super::intersects) says. The placements are good: finite, and rotations or reflections
    /// with a uniform scale.
    Sure(bool),
    /// Nothing, but that the placements are good.
    Open,
    /// Nothing, of the placements neither.
    Unusual,
}

/// Whether two placed polytopes intersect, where the balls around them and in them tell, and the placements turn and scale nearly alike in all
/// directions, of a plain size. Nothing is asked of the placements: they may hold anything.
///
/// Cost: some 120 sums and products, no support point.
///
/// ```
/// use solid_convex::{Polytope, gjk::{self, Glance}};
/// use glam::{DAffine3, DVec3};
/// let corners = (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
/// let block = Polytope::new(corners.collect()).unwrap();
/// let here = DAffine3::IDENTITY;
/// let glance = |at: DAffine3| gjk::glance(&block, &here, &block, &at);
/// assert_eq!(glance(DAffine3::from_translation(DVec3::X * 2.0)), Glance::Sure(false));
/// assert_eq!(glance(DAffine3::from_translation(DVec3::X * 1.1)), Glance::Open);
/// assert_eq!(glance(DAffine3::from_scale(DVec3::new(1.0, 2.0, f64::NAN))), Glance::Unusual);
/// ```
#[inline]
pub fn glance(a: &Polytope, placement_a: &DAffine3, b: &Polytope, placement_b: &DAffine3) -> Glance {
    dispatch!(simd => glance_by(simd, (a, placement_a), (b, placement_b)))
}

/// A [`glance`], for kernels that it is a part of.
#[doc(hidden)]
#[inline(always)]
pub fn glance_by<S: Simd>(
    simd: S,
    (a, placement_a): (&Polytope, &DAffine3),
    (b, placement_b): (&Polytope, &DAffine3),
) -> Glance {
    match Look::at(simd, (a, placement_a), (b, placement_b)) {
        Some(look) => look.glance(),
        None => Glance::Unusual,
    }
}

/// Balls of two polytopes, under placements that are good.
pub(super) struct Look {
    pub scales: [f64; 2],
    /// From the origin of the first to that of the second.
    pub offset: DVec3,
    /// Of the balls in the polytopes: the square of the distance of their centres, and the distance at which they overlap.
    inner: f64,
    near: f64,
    /// Of the balls around the polytopes: the same, and the distance at which they are apart.
    outer: f64,
    far: f64,
}

impl Look {
    #[inline(always)]
    pub fn at<S: Simd>(
        simd: S,
        (a, placement_a): (&Polytope, &DAffine3),
        (b, placement_b): (&Polytope, &DAffine3),
    ) -> Option<Look> {
        let squares = rough_squares(simd, [placement_a, placement_b])?;
        let scales = [squares[0].sqrt(), squares[1].sqrt()];
        let offset = placement_b.translation - placement_a.translation;
        let square = {
            #[inline(always)]
            |on_a: DVec3, on_b: DVec3| {
                (placement_a.matrix3 * on_a - (placement_b.matrix3 * on_b + offset)).length_squared()
            }
        };
        let (of_a, of_b) = (a.own_balls(), b.own_balls());
        let inner = square(of_a.inner.center, of_b.inner.center);
        let outer = square(of_a.outer.center, of_b.outer.center);
        let ([inside_a, outside_a], [inside_b, outside_b]) = (a.sure_radii(), b.sure_radii());
        let near = inside_a * scales[0] + inside_b * scales[1];
        let far = outside_a * scales[0] + outside_b * scales[1];
        Some(Look { scales, offset, inner, near, outer, far })
    }

    #[inline(always)]
    pub fn glance(&self) -> Glance {
        let Look { inner, near, outer, far, .. } = *self;
        let meet = (near > 0.0) & (inner < near * near);
        let sure = PLAIN_SQUARES.contains(&(far * far)) & (meet | (outer > far * far));
        if sure { Glance::Sure(meet) } else { Glance::Open }
    }

    /// The gap along a unit axis, from the second to the first, where it is so large that the axis may answer alone. World units.
    #[inline(always)]
    pub fn gap_along<S: Simd>(
        &self,
        simd: S,
        (a, at_a): (&Polytope, &DAffine3),
        (b, at_b): (&Polytope, &DAffine3),
        axis: DVec3,
    ) -> Option<f64> {
        let reach = a.farthest() * self.scales[0] + b.farthest() * self.scales[1];
        // As much as any coordinate of the difference; and the sum of those of an axis.
        let error = (reach + self.offset.abs().max_element()) * axis.abs().element_sum();
        let along = [at_a.matrix3.mul_transpose_vec3(-axis), at_b.matrix3.mul_transpose_vec3(axis)];
        let [of_a, of_b] = Polytope::greatest_of_both(simd, [a, b], along, &mut [DVec3::ZERO; 2]);
        let gap = -(of_a + of_b + axis.dot(self.offset));
        (PLAIN_SQUARES.contains(&(reach * reach)) & (gap > CACHED_GAP_MIN * error))
            .then_some(gap - SUPPORT_ERROR * error)
    }

    /// How far apart the balls are that tell, or how deep in each other.
    #[inline(always)]
    pub fn room(&self, meet: bool) -> f64 {
        if meet { self.near - self.inner.sqrt() } else { self.outer.sqrt() - self.far }
    }
}

fn compare(a: &Balls, placement_a: &DAffine3, b: &Balls, placement_b: &DAffine3) -> Option<bool> {
    let linear = [&placement_a.matrix3, &placement_b.matrix3];
    let offset = placement_b.translation - placement_a.translation;
    let (stretch_a, stretch_b) = (Stretch::of(linear[0]), Stretch::of(linear[1]));
    let size = stretch_a.most * a.extent() + stretch_b.most * b.extent() + offset.abs().max_element();
    if Line::of([a.outer, b.outer], linear, offset).is_some_and(|line| line.parts(GAP_MIN * size)) {
        return Some(false);
    }
    let Line { along: [along_a, along_b], .. } = Line::of([a.inner, b.inner], linear, offset)?;
    let error = CENTER_ERROR * size;
    let (along_a, along_b) = (along_a + error * stretch_a.most, along_b + error * stretch_b.most);
    // Each reaches at least this far along v, times |v|, times the other's |L^T v|.
    let reach_a = a.inner.radius * stretch_a.least_squared(linear[0]) * along_b;
    let reach_b = b.inner.radius * stretch_b.least_squared(linear[1]) * along_a;
    (reach_a + reach_b > along_a * along_b * (1.0 + OVERLAP_ERROR)).then_some(true)
}

/// The line of the centres of two balls, each of which a linear map makes an ellipsoid of.
struct Line {
    /// From the second to the first.
    v: DVec3,
    /// The length of `L^T v` of each map.
    along: [f64; 2],
    radii: [f64; 2],
}

impl Line {
    /// `None` where squares are not plain.
    fn of([a, b]: [Ball; 2], linear: [&DMat3; 2], offset: DVec3) -> Option<Line> {
        let v = *linear[0] * a.center - (*linear[1] * b.center + offset);
        let squares = linear.map(|linear| linear.mul_transpose_vec3(v).length_squared());
        let is_plain = [v.length_squared(), squares[0], squares[1]].iter().all(|s| PLAIN_SQUARES.contains(s));
        is_plain.then(|| Line { v, along: squares.map(f64::sqrt), radii: [a.radius, b.radius] })
    }

    /// Whether the ellipsoids are apart along it by more than a gap.
    fn parts(&self, gap: f64) -> bool {
        let Line { v, along, radii } = self;
        let reach = radii[0] * along[0] + radii[1] * along[1];
        v.length_squared() - reach > gap * v.abs().element_sum()
    }
}

impl Ball {
    /// Whether it has all of another in it, up to rounding.
    pub(crate) fn contains(&self, other: Ball) -> bool {
        self.center.distance(other.center) + other.radius <= self.radius
    }
}

impl Balls {
    /// Both about the local origin, of these radii.
    #[inline(always)] // into kernels: what a call writes is waited for there
    pub fn about_origin(inner: f64, outer: f64) -> Balls {
        let center = DVec3::ZERO;
        Balls { inner: Ball { center, radius: inner }, outer: Ball { center, radius: outer } }
    }

    /// Radii by which two objects certainly overlap or are apart, under placements that nearly are similarities: the distance of the
    /// centres is less than the sum of the first, or more than that of the second.
    ///
    /// The size of the data is at most 2.75 times the sum of the [extents](Balls::extent) and the distance of the centres, and a sum of the coordinates of a unit vector at
    /// most the root of three: eight times the least gap for each extent is more than both make of it.
    pub(crate) fn sure_radii(&self) -> [f64; 2] {
        let margin = 8.0 * GAP_MIN * self.extent();
        let (inner, outer) = (self.inner.radius, self.outer.radius);
        [inner * (1.0 - 2.0 * STRETCH_ERROR) - margin, outer * (1.0 + 2.0 * STRETCH_ERROR) + margin]
    }

    /// No coordinate of the object is larger.
    fn extent(&self) -> f64 {
        self.outer.radius + self.outer.center.abs().max_element()
    }
}

/// By how much a map stretches vectors.
struct Stretch {
    /// The squares of the lengths of its axes.
    squares: [f64; 3],
    /// At most by this: the Frobenius norm.
    most: f64,
}

impl Stretch {
    #[inline]
    fn of(&DMat3 { x_axis: x, y_axis: y, z_axis: z }: &DMat3) -> Self {
        let squares = [x, y, z].map(DVec3::length_squared);
        Stretch { squares, most: (squares[0] + squares[1] + squares[2]).sqrt() }
    }

    /// A lower bound of the square of the least stretch: the least eigenvalue of `L^T L`, by Gershgorin's circles; exact for scales
    /// before a rotation, negative for a strong skew. So `|L^-1 v|`, which is `|(L^T L)^-1 L^T v|`, is at most `|L^T v|` over it.
    #[inline]
    fn least_squared(&self, DMat3 { x_axis: x, y_axis: y, z_axis: z }: &DMat3) -> f64 {
        let [xx, yy, zz] = self.squares;
        let [xy, yz, zx] = [x.dot(*y).abs(), y.dot(*z).abs(), z.dot(*x).abs()];
        let error = GRAM_ERROR * xx.max(yy).max(zz);
        (xx - xy - zx).min(yy - yz - xy).min(zz - zx - yz) - error
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::gjk::{intersection, intersects_closely};
    use crate::testing::{octahedron_faces, placement, shapes};
    use crate::{Polytope, Sphere};

    /// A hull with its faces: an octahedron that was stretched, and moved off its origin.
    fn octahedron() -> Polytope {
        let corner = |axis: usize, sign: f64| {
            DVec3::new(0.3, 0.2, -0.1) + DVec3::AXES[axis] * sign * (1.0 + axis as f64)
        };
        let points = (0..6).map(|i| corner(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 })).collect();
        Polytope::new(points).unwrap().with_faces(&octahedron_faces())
    }

    fn objects() -> Vec<Box<dyn Support>> {
        let mut objects = shapes();
        objects.push(Box::new(octahedron()));
        objects
    }

    #[test]
    fn the_balls_are_around_and_in_the_object() {
        for object in objects() {
            assert!(object.balls().unwrap().inner.radius > 0.1);
            let [least, most] = reaches(object.as_ref(), |k| placement(k).translation.normalize());
            assert!((1.0 - 1e-12..1.1).contains(&least), "{least}: {:?}", object.balls());
            assert!((0.95..1.0 + 1e-12).contains(&most), "{most}: {:?}", object.balls());
        }
    }

    /// How far an object reaches from the centre of the ball in it where that is least, in radii of that; and of the ball around it where it is most.
    fn reaches(object: &dyn Support, direction: impl Fn(u32) -> DVec3) -> [f64; 2] {
        let Balls { inner, outer } = object.balls().unwrap();
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for k in 0..20_000 {
            let direction = direction(k);
            let reach = |ball: Ball| (object.support(direction) - ball.center).dot(direction);
            (least, most) = (least.min(reach(inner)), most.max(reach(outer)));
        }
        [least / inner.radius, most / outer.radius]
    }

    #[test]
    fn what_balls_decide_a_search_says_too() {
        let (mut apart, mut meeting, mut total) = (0, 0, 0);
        let objects = objects();
        let far = DVec3::new(1e6, -3e5, 2e4);
        let skew = |k: u32| {
            let part = |step: f64| (f64::from(k) * step).fract() * 0.4 - 0.2;
            DMat3::from_cols(
                DVec3::new(1.0, part(0.37), part(0.91)),
                DVec3::new(part(0.13), 1.0 + part(0.61), part(0.47)),
                DVec3::new(part(0.83), part(0.29), [0.5, 1.0, 1.5, 1e-2][k as usize % 4]),
            )
        };
        for k in 0..20_000 {
            let (a, b) = (&objects[k as usize % 6], &objects[k as usize / 6 % 6]);
            let unit = [1.0, 1e-20, 1e20, 1e-9][k as usize / 7 % 4];
            let place = |k: u32, spread: f64| {
                let DAffine3 { mut matrix3, translation } = placement(k);
                if !k.is_multiple_of(3) {
                    matrix3 *= skew(k);
                }
                DAffine3 { matrix3: matrix3 * unit, translation: translation * (spread * unit) }
            };
            let (mut at_a, mut at_b) = (place(k, 0.5), place(7 * k + 1, [0.5, 4.0][k as usize / 3 % 2]));
            if k % 11 == 0 {
                (at_a.translation, at_b.translation) =
                    (at_a.translation + far * unit, at_b.translation + far * unit);
            }
            total += 1;
            if let Some(answer) = decide(&**a, &at_a, &**b, &at_b) {
                let found = intersection(&**a, &at_a, &**b, &at_b).witness().is_some();
                assert_eq!(answer, found, "{k}");
                if answer { meeting += 1 } else { apart += 1 }
            }
        }
        assert!(apart * 5 > total && meeting * 5 > total, "{apart} and {meeting} of {total}");
    }

    /// Of polytopes under similarities, by the balls that stay balls; also close to where the balls touch, from inside and outside.
    #[test]
    fn what_a_glance_tells_a_search_says_too() {
        let (octahedron, far) = (octahedron(), DVec3::new(1e6, -3e5, 2e4));
        let cloud = Polytope::new((0..40).map(|i| placement(i).translation).collect()).unwrap();
        let (mut apart, mut meeting, mut open) = (0, 0, 0);
        for k in 0..20_000 {
            let pair = [[&octahedron; 2], [&octahedron; 2], [&octahedron, &cloud], [&cloud, &octahedron]];
            let [a, b] = pair[k as usize % 4];
            let unit = [1.0, 1e-20, 1e20, 1e-9][k as usize / 7 % 4];
            let [mut at_a, mut at_b] =
                [(k, 0.3), (7 * k + 1, [0.3, 12.0][k as usize / 4 % 2])].map(|(k, spread)| {
                    let DAffine3 { matrix3, translation } = placement(k);
                    let sign = if k % 5 == 0 { -1.0 } else { 1.0 };
                    DAffine3 { matrix3: matrix3 * (sign * unit), translation: translation * (spread * unit) }
                });
            if k % 13 == 0 {
                // Centres at the distance at which the balls touch, up to a few roundings.
                let balls = [a, b].map(|object| {
                    let Balls { inner, outer } = *object.own_balls();
                    [inner, outer][k as usize / 13 % 2]
                });
                let error = [-1e-6, -1e-12, 0.0, 1e-12, 1e-6][k as usize / 26 % 5];
                let length = (balls[0].radius + balls[1].radius) * (1.0 + error) * unit;
                let way = placement(k + 3).translation.normalize() * length;
                at_b.translation =
                    at_a.transform_point3(balls[0].center) + way - at_b.matrix3 * balls[1].center;
            } else if k % 11 == 0 {
                (at_a.translation, at_b.translation) =
                    (at_a.translation + far * unit, at_b.translation + far * unit);
            }
            match glance(a, &at_a, b, &at_b) {
                Glance::Sure(answer) => {
                    assert_eq!(answer, intersects_closely(a, &at_a, b, &at_b), "{k}");
                    if answer { meeting += 1 } else { apart += 1 }
                }
                Glance::Open => open += 1,
                Glance::Unusual => panic!("a similarity of plain size"),
            }
        }
        assert!(apart > 4_000 && meeting > 4_000 && open > 1_000, "{apart}, {meeting}, {open}");
    }

    /// Between two balls nothing is left out: what is decided changes at a gap of the margin, and never on its wrong side.
    #[test]
    fn balls_that_touch_are_left_to_the_search() {
        let (ball, large) = (Sphere::new(1.0).unwrap(), Sphere::new(1e6).unwrap());
        for k in 0..1_000 {
            let (at_a, turned) = (placement(k), placement(3 * k + 1));
            let direction = turned.translation.normalize();
            for (b, radii) in [(&ball, 2.0), (&large, 1e6 + 1.0)] {
                let at_b = |gap: f64| DAffine3 {
                    translation: at_a.translation + direction * (radii * (1.0 + gap)),
                    ..turned
                };
                let decided = |gap: f64| decide(&ball, &at_a, b, &at_b(gap));
                assert_eq!(decided(1e-12), Some(false));
                assert_eq!(decided(-1e-12), Some(true));
                for roundings in -4..=4 {
                    assert_eq!(decided(f64::from(roundings) * f64::EPSILON), None, "{roundings}");
                }
            }
        }
    }

    /// Law: what balls tell of polytopes far off their local origins a search says too, corner to corner.
    #[test]
    fn corners_that_touch_far_off_are_left_to_the_search() {
        let mut open = 0;
        for k in 0..2_000 {
            let DAffine3 { matrix3, translation } = placement(k);
            let center = translation.normalize() * [1e3, 1e9, 1e11][k as usize % 3];
            let corners = (0..6).map(|i| center + DVec3::AXES[i / 2] * if i % 2 == 0 { 1.0 } else { -1.0 });
            let a = Polytope::new(corners.collect()).unwrap();
            let gap = [1e-9, 1e-7, 1e-5, 1e-3][k as usize / 3 % 4] * (f64::from(k % 7) - 3.0);
            let at_a = DAffine3 { matrix3, translation };
            let at_b = DAffine3 { matrix3, translation: translation + matrix3 * DVec3::X * (2.0 + gap) };
            match glance(&a, &at_a, &a, &at_b) {
                Glance::Sure(answer) => assert_eq!(answer, intersects_closely(&a, &at_a, &a, &at_b), "{k}"),
                _ => open += 1,
            }
        }
        assert!((200..2_000).contains(&open), "{open}");
    }

    /// Law: of placements that only nearly are similarities, what is longest counts.
    #[test]
    fn what_is_a_little_longer_along_one_axis_reaches_as_far() {
        let octahedron = octahedron();
        let corners = octahedron.points().iter().map(|&p| p - DVec3::new(0.3, 0.2, -0.1)).collect();
        let octahedron = Polytope::new(corners).unwrap();
        let longer = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 1.0 + 2e-7));
        let at = |z: f64| DAffine3 { matrix3: longer, translation: DVec3::Z * z };
        let reach = 3.0 * (1.0 + 2e-7);
        let [here, touching, beyond] = [0.0, 2.0 * reach * (1.0 - 1e-9), 2.0 * reach * (1.0 + 1e-5)].map(at);
        assert!(intersects_closely(&octahedron, &here, &octahedron, &touching));
        assert_eq!(glance(&octahedron, &here, &octahedron, &touching), Glance::Open);
        assert_eq!(glance(&octahedron, &here, &octahedron, &beyond), Glance::Sure(false));
    }

    /// What is flat has no ball in it: of two that face each other closely a search says whether they meet.
    #[test]
    fn flat_polytopes_that_face_each_other_do_not_meet_at_a_glance() {
        let square = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y];
        let square = Polytope::new(square.to_vec()).unwrap();
        for gap in [0.0, 1e-15, 5e-14, 1e-13, 1e-9] {
            let at = DAffine3::from_translation(DVec3::Z * gap);
            assert_eq!(glance(&square, &DAffine3::IDENTITY, &square, &at), Glance::Open, "{gap:e}");
        }
    }

    /// Where squares of lengths vanish, balls tell nothing.
    #[test]
    fn balls_of_lengths_whose_squares_vanish_are_left_to_the_search() {
        let ball = Sphere::new(1e-81).unwrap();
        let at = |x: f64| DAffine3 {
            matrix3: DMat3::IDENTITY * 1e-81,
            translation: DVec3::new(x, 0.0, 0.0) * 1e-162,
        };
        for x in [1.9, 1.99, 2.01, 2.1] {
            assert_eq!(decide(&ball, &at(0.0), &ball, &at(x)), None, "{x}");
            assert_eq!(intersection(&ball, &at(0.0), &ball, &at(x)).witness().is_some(), x < 2.0, "{x}");
        }
    }

    /// Cones of any shape are around and in their balls, which touch them.
    #[test]
    fn cones_of_any_width_touch_their_balls() {
        for (radius, height) in [(0.1, 3.0), (1.0, 1.0), (1.0, 2.0), (3.0, 1.0), (5.0, 0.1)] {
            let cone = crate::Cone::new(radius, height).unwrap();
            let [least, most] = reaches(&cone, |k| {
                let (sin, cos) = (f64::from(k) * 0.0001 * std::f64::consts::PI).sin_cos();
                DVec3::new(sin, cos, 0.0)
            });
            assert!((1.0 - 1e-12..1.01).contains(&least), "{radius} {height}: {least}");
            assert!((0.99..1.0 + 1e-12).contains(&most), "{radius} {height}: {most}");
        }
    }

    /// A ball that is wider than a tube is not in it, however long that is.
    #[test]
    fn no_ball_is_in_what_is_narrower() {
        let tube = crate::Cylinder::new(1.0, 10.0).unwrap();
        let holds = |radius: f64| tube.contains_ball(Ball { center: DVec3::ZERO, radius });
        assert!(holds(0.9) && !holds(1.1) && !holds(3.0) && !holds(6.0));
    }
}
