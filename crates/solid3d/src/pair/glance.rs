//! A glance at the image of a leaf: which of its triangles surely meet a ball or a box, or surely do not; of the rest nothing is said. Of other
//! convex shapes, which meet a ball in them, or no ball around them.
//!
//! Corners are placed in `f32` in a frame with the middle of the shape at its origin: that of a ball has lengths of the common frame; a
//! box is the cube from -1 to 1 in its own. A triangle with a corner inside meets the shape, and one that is beyond it along some axis
//! does not: along its normal, and towards its nearest corner or across a face of the cube.
//!
//! # The error
//!
//! On an axis a placed corner is `base + sum of coefficient * step of the grid`.
//!
//! - It is within [`HALF_STEP`] times the sum of the magnitudes of the coefficients, for the grid.
//! - With u = 2^-24, six roundings in `f32`, of coefficients and base, products and sums, are relative to at most the sum R of the magnitudes of
//!   all terms: [`ROUNDING`] is 8u.
//! - In `f64`, each of some two dozen roundings of 2^-53 is relative to the magnitudes of what goes into the offset: [`ROUNDING_F64`].
//!
//! Whatever direction n has been computed, heights along it bound the triangle. Such a product is off by 3u R |n|, and |n| by 4u of it, for
//! which [`ROUNDING`] stands each time; with the error E of the corners the triangle begins no lower than `height - (E + 8u R) |n|`. What
//! underflows in |n|, less than 2^-73, is below [`TINY`], and in products below that times any size.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::Support;
use solid_convex::gjk::Balls;
use solid_convex::simd::part;

use super::closed_form::{Similarity, to_world};
use super::direct::Direct;
use super::row::{Cube, Verdict};
use crate::bounds::abs;
use crate::tree::{HALF_STEP, Image, Normal, STEPS};

/// 8u: see the module.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// 32 roundings: see the module.
const ROUNDING_F64: f64 = 16.0 * f64::EPSILON;

/// 2^-63: see the module.
const TINY: f32 = f32::from_bits((127 - 63) << 23);

/// A radius inside which squares of `f32` neither underflow nor matter.
const RADIUS_MIN: f64 = 1.0 / (1u64 << 30) as f64;

/// A ball or a box, or a ball in a shape and one around it, beside which triangles are held.
pub(super) struct Glance {
    body: Body,
    /// From tree coordinates to the frame of the body.
    linear: Linear,
    offset: [f64; 3],
    /// What `f64` loses.
    slack: f64,
}

/// A linear map.
enum Linear {
    /// It makes all so many times as long.
    Alike(f64),
    Rows([[f64; 3]; 3]),
}

/// What meets the body within `inner` is clear, and what is apart from it beyond `outer`.
pub(super) struct Body {
    is_ball: bool,
    inner: f64,
    outer: f64,
}

impl Body {
    /// All that is within a radius of a point. A gap of `gap` is clear.
    #[inline(always)]
    fn ball(radius: f64, gap: f64) -> Body {
        Body { is_ball: true, inner: radius - gap, outer: radius + gap }
    }

    /// What has a ball in it and is in another, seen from the centre of the first; lengths are so many times as long here.
    #[inline(always)]
    pub fn between(Balls { inner, outer }: &Balls, times: f64, gap: f64) -> Body {
        Body::between_radii([inner.radius, outer.radius + outer.center.distance(inner.center)], times, gap)
    }

    /// The same, by the radii of two balls about one point.
    #[inline(always)]
    pub fn between_radii([inner, outer]: [f64; 2], times: f64, gap: f64) -> Body {
        Body { is_ball: true, inner: inner * times - gap, outer: outer * times + gap }
    }

    #[inline(always)]
    pub fn cube(cube: &Cube) -> Body {
        let (inner, outer) = cube.clear();
        Body { is_ball: false, inner, outer }
    }
}

/// Three coordinates of eight points.
pub(super) type Points<S> = [f32x8<S>; 3];

/// An image, placed.
struct Placed<S: Simd> {
    corners: [Points<S>; 3],
    /// How far corners are off, on each axis.
    error: [f64; 3],
    /// How far any corner is from the origin at most, in the sum over the axes.
    reach: f64,
}

impl Glance {
    /// For a shape with its way to the common frame, whose triangles are placed by a map; a gap of `gap` is clear. `None` for a capsule, and for what
    /// its placement leaves no ball.
    pub fn new(
        direct: &Direct,
        shape: &dyn Support,
        to_common: &DAffine3,
        map: &DAffine3,
        gap: f64,
        normal: &Normal,
    ) -> Option<Glance> {
        let (middle, body) = match direct {
            Direct::Round(round) => (round.center()?, Body::ball(round.radius, gap)),
            Direct::Cube(cube) => (DVec3::ZERO, Body::cube(cube)),
            Direct::None => {
                let balls = shape.balls()?;
                let Similarity { stretch, .. } = Similarity::new(&to_common.matrix3)?;
                (to_common.transform_point3(balls.inner.center), Body::between(&balls, stretch, gap))
            }
        };
        Some(Glance::of(body, middle, map, normal))
    }

    /// For a body with its middle, where triangles are placed by a map.
    #[inline(always)]
    pub fn of(body: Body, middle: DVec3, map: &DAffine3, normal: &Normal) -> Glance {
        let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
        let [x, y, z] = [x_axis * normal.scale, y_axis * normal.scale, z_axis * normal.scale];
        let terms = to_world(&abs(&map.matrix3), normal.origin.abs())
            + map.translation.abs()
            + middle.abs()
            + (x.abs() + y.abs() + z.abs());
        Glance {
            body,
            linear: Linear::Rows([[x.x, y.x, z.x], [x.y, y.y, z.y], [x.z, y.z, z.z]]),
            offset: (to_world(&map.matrix3, normal.origin) + map.translation - middle).to_array(),
            slack: ROUNDING_F64 * terms.max_element(),
        }
    }

    /// The same, where a map but makes all so many times as long, and triangles are off by no more than `slack` then.
    #[inline(always)]
    pub fn upright(body: Body, middle: DVec3, times: f64, normal: &Normal, slack: f64) -> Glance {
        let (step, origin) = (times * normal.scale, times * normal.origin);
        Glance {
            body,
            linear: Linear::Alike(step),
            offset: (origin - middle).to_array(),
            slack: slack + ROUNDING_F64 * ((origin.abs() + middle.abs()).max_element() + step),
        }
    }

    /// What is clear of the triangles of an image, as bits; in lanes beyond those in use it means nothing.
    #[inline(always)]
    pub fn verdict<S: Simd>(&self, simd: S, image: &Image) -> Verdict {
        let Body { is_ball, inner, outer } = self.body;
        part!(simd => {
            let placed = self.place(simd, image);
            if is_ball { of_ball(simd, &placed, inner, outer) } else { of_cube(simd, &placed, inner, outer) }
        })
    }

    #[inline(always)]
    fn place<S: Simd>(&self, simd: S, image: &Image) -> Placed<S> {
        match &self.linear {
            Linear::Alike(times) => self.place_by(
                simd,
                image,
                #[inline(always)]
                |axis| [(axis, *times)],
            ),
            Linear::Rows(rows) => self.place_by(
                simd,
                image,
                #[inline(always)]
                |axis| [(0, rows[axis][0]), (1, rows[axis][1]), (2, rows[axis][2])],
            ),
        }
    }

    /// By what has a part in each coordinate: some of the tree's, by their numbers, so many times.
    #[inline(always)]
    fn place_by<S: Simd, const PARTS: usize>(
        &self,
        simd: S,
        image: &Image,
        parts: impl Fn(usize) -> [(usize, f64); PARTS],
    ) -> Placed<S> {
        let grid = [image.axis(0), image.axis(1), image.axis(2)];
        let zero = splat(simd, 0.0);
        let mut coefficients = [[zero; PARTS]; 3];
        let (mut base, mut error, mut reach) = ([zero; 3], [0.0; 3], 0.0);
        for axis in 0..3 {
            let (mut at_min, mut sum) = (self.offset[axis], 0.0);
            for (part, (of, entry)) in parts(axis).into_iter().enumerate() {
                let (min, step) = grid[of];
                at_min += entry * min;
                sum += (entry * step).abs();
                coefficients[axis][part] = splat(simd, entry * step);
            }
            base[axis] = splat(simd, at_min);
            let furthest = at_min.abs() + f64::from(STEPS) * sum;
            error[axis] = HALF_STEP * sum + ROUNDING * furthest + self.slack;
            reach += furthest;
        }
        let mut corners = [[zero; 3]; 3];
        for (number, corner) in corners.iter_mut().enumerate() {
            let image = image.corner(simd, number);
            let along = [image.along(simd, 0), image.along(simd, 1), image.along(simd, 2)];
            for axis in 0..3 {
                let mut sum = zero;
                for (part, (of, _)) in parts(axis).into_iter().enumerate() {
                    let product = along[of] * coefficients[axis][part];
                    sum = if part == 0 { product } else { sum + product };
                }
                corner[axis] = sum + base[axis];
            }
        }
        Placed { corners, error, reach }
    }
}

#[inline(always)]
fn of_ball<S: Simd>(simd: S, placed: &Placed<S>, inner: f64, outer: f64) -> Verdict {
    let Placed { corners: [p, q, r], error: [x, y, z], reach } = placed;
    let error = x + y + z;
    let squares = [dot(p, p), dot(q, q), dot(r, r)];
    let inside = inner - error;
    let limit = if inside > RADIUS_MIN { inside * inside * (1.0 - ROUNDING) } else { -1.0 };
    let least = squares[0].min(squares[1]).min(squares[2]);
    let meet = least.simd_lt(splat(simd, limit));
    let mut nearest = *p;
    for (corner, square) in [(q, squares[1]), (r, squares[2])] {
        let is_nearest = square.simd_le(least);
        for axis in 0..3 {
            nearest[axis] = is_nearest.select(corner[axis], nearest[axis]);
        }
    }
    let limit = splat(simd, (outer + error + ROUNDING * reach) * (1.0 + 2.0 * ROUNDING));
    let mut apart = limit.simd_lt(limit);
    for way in [nearest, normal(p, q, r)] {
        let length = dot(&way, &way).sqrt() + f32x8::splat(simd, TINY);
        apart |= height(&placed.corners, &way).simd_gt(limit * length);
    }
    Verdict { meet: meet.to_bitmask() as u32, apart: apart.to_bitmask() as u32 }
}

#[inline(always)]
fn of_cube<S: Simd>(simd: S, placed: &Placed<S>, inner: f64, outer: f64) -> Verdict {
    let Placed { corners: [p, q, r], error, reach } = placed;
    let zero = splat(simd, 0.0);
    let none = zero.simd_lt(zero);
    let mut apart = none;
    let mut inside = [zero.simd_le(zero); 3];
    let way = normal(p, q, r);
    let mut of_normal = f32x8::splat(simd, TINY);
    for axis in 0..3 {
        let within = splat(simd, (inner - error[axis]) * (1.0 - ROUNDING));
        for (inside, corner) in inside.iter_mut().zip([p, q, r]) {
            *inside &= corner[axis].abs().simd_lt(within);
        }
        let beyond = splat(simd, (outer + error[axis]) * (1.0 + ROUNDING));
        let least = p[axis].min(q[axis]).min(r[axis]);
        let greatest = p[axis].max(q[axis]).max(r[axis]);
        apart |= least.simd_gt(beyond) | greatest.simd_lt(-beyond);
        let height = (outer + error[axis] + ROUNDING * reach) * (1.0 + 2.0 * ROUNDING);
        of_normal += way[axis].abs() * splat(simd, height);
    }
    apart |= height(&placed.corners, &way).simd_gt(of_normal);
    let meet = inside[0] | inside[1] | inside[2];
    Verdict { meet: meet.to_bitmask() as u32, apart: apart.to_bitmask() as u32 }
}

/// How high three points are along a direction or against it, times its length, at least.
#[inline(always)]
fn height<S: Simd>([p, q, r]: &[Points<S>; 3], way: &Points<S>) -> f32x8<S> {
    let (p, q, r) = (dot(p, way), dot(q, way), dot(r, way));
    p.min(q).min(r).max(-p.max(q).max(r))
}

/// Across three points.
#[inline(always)]
fn normal<S: Simd>(p: &Points<S>, q: &Points<S>, r: &Points<S>) -> Points<S> {
    let (a, b) = (minus(q, p), minus(r, p));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn minus<S: Simd>(a: &Points<S>, b: &Points<S>) -> Points<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: &Points<S>, b: &Points<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn splat<S: Simd>(simd: S, x: f64) -> f32x8<S> {
    f32x8::splat(simd, x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::complex_convex::CLEARLY_APART;
    use crate::pair::frame::Frame;
    use crate::pair::gaps::scenes::{triangles, turned};
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_convex::{Cone, Cuboid, Sphere, Support, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    /// Law: what is said of a triangle is what GJK says, of balls and boxes that are far or meet, or nearly touch, under any maps; on
    /// every level of instructions. What is clear is said of most.
    #[test]
    fn nothing_false_is_said_at_a_glance() {
        let seed = 93;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut meet, mut clear, mut lanes) = (0, 0, 0);
        for case in 0..4000 {
            let size = 10f64.powi(rng.random_range(-30..30));
            let far = [1e6, 1e6, 1e6, 1e10].map(|far| far * size * in_cube(&mut rng))[case / 7 % 4];
            let far = if case % 7 == 0 { far } else { DVec3::ZERO };
            let complex = triangles(&mut rng, case, 30, size, far);
            let (turn, at_complex) = turned(&mut rng, case);
            // Around a vertex, or up to a corner or anything of a triangle but for a little.
            let vertex = rng.random_range(0..complex.vertices().len());
            let target = at_complex.transform_point3(complex.vertices()[vertex]);
            let away = 0.6 * size * in_cube(&mut rng);
            let half = size * 10f64.powf(rng.random_range(-2.0..0.0));
            let near = 1.0 + [0.0, 1e-9, -1e-9, 1e-5, -1e-5, 1e-3][case / 4 % 6];
            let radius = if case % 2 == 0 { half } else { away.length() * near };
            let ball = Sphere::new(radius).expect("it has a size");
            let cuboid = Cuboid::new(2.0 * half * DVec3::new(1.0, 0.5, 0.7)).expect("it has a size");
            let cone = Cone::new(0.7 * radius, 2.0 * radius).expect("it has a size");
            let convex: &dyn Support = [&ball as &dyn Support, &ball, &cuboid, &cone][case % 4];
            let mut at_convex = DAffine3::from_rotation_translation(turn.inverse(), target + away);
            if case % 3 == 0 {
                let triangle = complex.primitive_hull(vertex as u32 / 3);
                let points = gjk::closest_points(&triangle, &at_complex, convex, &at_convex).points;
                let way = at_complex.transform_point3(points.on_a) - at_convex.transform_point3(points.on_b);
                at_convex.translation += way * near;
            }
            let frame = Frame::new(&at_complex, complex.reach(), &at_convex, convex.reach());
            let direct = Direct::new(convex, &frame, CLEARLY_APART);
            let map = if let Direct::Cube(cube) = &direct { cube.map } else { frame.common[0] };
            let (to_common, normal) = (&frame.common[1], complex.tree().normal());
            let Some(glance) = Glance::new(&direct, convex, to_common, &map, CLEARLY_APART, normal) else {
                continue; // far thinner than the rest is large
            };
            let images = complex.images().expect("it is a mesh");
            for leaf in complex.tree().leaves() {
                let image = images.of(&leaf);
                let said = alike(|level| {
                    let Verdict { meet, apart } =
                        dispatch!(widest level, simd => glance.verdict(simd, &image));
                    Verdict { meet: meet & leaf.lanes(), apart: apart & leaf.lanes() }
                });
                for (lane, &primitive) in leaf.primitives.iter().enumerate() {
                    let hull = complex.primitive_hull(primitive);
                    let truth = gjk::intersection(&hull, &at_complex, convex, &at_convex).witness().is_some();
                    let [says_meet, says_apart] = [said.meet, said.apart].map(|set| set >> lane & 1 == 1);
                    assert!(truth || !says_meet, "case {case}: triangle {primitive} does not meet");
                    assert!(!truth || !says_apart, "case {case}: triangle {primitive} meets");
                    meet += u32::from(truth);
                    clear += u32::from(says_meet || says_apart);
                    lanes += 1;
                }
            }
        }
        println!("{meet} of {lanes} meet, {clear} are clear");
        assert!(20 * meet > lanes && 5 * clear > 4 * lanes);
    }
}
