//! How far a convex shape is at least from eight things: the boxes of a node, and the triangles of a leaf, by their images.
//!
//! All is in tree coordinates, from the middle of the shape on. Along any direction n a thing begins at some height, and the shape ends at
//! another: the gap over |n| is no more than their distance. Looked along are [`axes`] that told the shape from triangles before, and ways
//! from points of the shape to the nearest point of each thing: at first from its middle to boxes, and to triangles from a point near to the
//! nearest so far. The points are then moved towards these for some [`rounds`](Body::rounds): of a box or a segment to where it is nearest to
//! them, of a hull, towards triangles alone, along the way to its support point (Frank and Wolfe, *An algorithm for quadratic programming*,
//! 1956). The last two points are also no nearer than the distance is.
//!
//! # The error
//!
//! With u = 2^-24, heights are off, in parts of |n|, by no more than
//!
//! - the distance of a corner from its image: [`HALF_STEP`] of the grid on each axis;
//! - 4u of the sum R of all magnitudes that a coordinate of a corner is made of, on all axes, for roundings on the way to it, and 3u R for those of the
//!   product with n;
//! - 6u of the size S of the shape, for rounding its edges or points to `f32`, and their products;
//! - u (R + S) for the difference, 4u of that for |n|, a root of a sum, and u for the quotient;
//! - the slack of coordinates in `f64`, of a point and the middle, on three axes: [`SLACKS`] times.
//!
//! [`ROUNDING`] is 16u, and stands for what is relative to R + S: once for gaps, and once more for the distance of two points, of which each is
//! off by less. What underflows in |n|, less than 2^-73, is below [`TINY`].

mod axes;
mod body;
mod triangles;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};
use glam::{DMat3, DVec3};
use solid_convex::Support;
use solid_convex::simd::each;

use self::axes::Axes;
use self::body::{Body, POINTS_MAX, ROUNDS, rounded, splat};
use self::triangles::{Triangles, lowest_of_triangles};
use super::direct::Direct;
use super::frame::Frame;
use super::glance::{Points, dot};
use super::reach::convex_bounds;
use crate::bounds::Aabb;
use crate::placement::row_norm;
use crate::tree::{Boxes, HALF_STEP, Image, Normal, STEPS};

/// 16u: see the module.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// Of a point and the middle, on three axes: above twice the root of three.
const SLACKS: f64 = 4.0;

/// 2^-63: see the module.
const TINY: f32 = f32::from_bits((127 - 63) << 23);

/// Sizes up to here neither overflow nor turn into what is no number; of what is farther nothing is said.
const SIZE_MAX: f64 = (1u64 << 30) as f64;

/// A convex shape, apart from which things are.
pub(super) struct Gaps {
    body: Body,
    /// In the space of the shape, and in tree coordinates.
    middle: DVec3,
    middle_in_tree: DVec3,
    /// Takes vectors of the shape to tree coordinates.
    to_tree: DMat3,
    /// Takes normals of planes in the common frame to those in tree coordinates.
    normal_to_tree: DMat3,
    /// Whether a triangle that is near to a point of the body is known to be nearer than others. Not where the body is but a box around the
    /// shape; nor of a capsule, whose core crosses triangles: which of them is nearest is then not told by points.
    tells_by_points: bool,
    /// Of the shape, around its middle: the sum of the magnitudes that its coordinates are made of.
    size: f64,
    slack: f64,
    /// All that is within the radius of the body belongs to the shape, in the common frame.
    radius: f64,
    /// A length of one in tree coordinates is at least this in the common frame; its reciprocal; and how much longer it is at most.
    unit: f64,
    per_unit: f64,
    stretch: f64,
    /// A point of the shape that is near to the nearest triangle so far.
    from: [f32; 3],
    axes: Axes,
}

impl Gaps {
    /// `None` where the shapes are so far apart, or so different in size, that single precision tells nothing.
    pub fn new(shape: &dyn Support, direct: &Direct, frame: &Frame, normal: &Normal) -> Option<Gaps> {
        let Frame { b_to_a, slack_in_a, common: [from_complex, _], .. } = frame;
        let of_complex = frame.stretch_of_a();
        let to_tree = b_to_a.matrix3 * normal.inverse;
        let (mut middle, mut radius, mut tells_by_points) = (shape.center(), 0.0, true);
        let body = if let Direct::Round(round) = direct {
            let [p, q] = round.local_ends;
            (middle, radius, tells_by_points) = (0.5 * (p + q), round.radius, p == q);
            Body::edges(&to_tree, &[0.5 * (q - p)][..usize::from(p != q)])
        } else if let Some(edges) = shape.half_edges() {
            Body::edges(&to_tree, &edges)
        } else if let Some(polytope) = shape.as_polytope().filter(|it| it.points().len() <= POINTS_MAX) {
            Body::points(&to_tree, polytope.points(), middle)
        } else {
            let Aabb { min, max } = convex_bounds(shape, &DMat3::IDENTITY);
            (middle, tells_by_points) = (0.5 * (min + max), false);
            let DVec3 { x, y, z } = max - middle;
            Body::edges(&to_tree, &[DVec3::X * x, DVec3::Y * y, DVec3::Z * z])
        };
        let size = body.size();
        let middle_in_tree = (b_to_a.transform_point3(middle) - normal.origin) * normal.inverse;
        let slack = SLACKS * slack_in_a * normal.inverse;
        let unit = of_complex.least * normal.scale * (1.0 - ROUNDING);
        let linear = from_complex.matrix3 * normal.scale;
        let stretch = row_norm(&(linear.transpose() * linear)).sqrt() / unit * (1.0 + ROUNDING);
        let is_of_use =
            unit > 0.0 && stretch < SIZE_MAX && size + slack + middle_in_tree.abs().max_element() <= SIZE_MAX;
        is_of_use.then(|| Gaps {
            body,
            tells_by_points,
            middle,
            middle_in_tree,
            to_tree,
            normal_to_tree: from_complex.matrix3.transpose(),
            size,
            slack,
            radius,
            unit,
            per_unit: unit.recip(),
            stretch,
            from: [0.0; 3],
            axes: Axes::default(),
        })
    }

    /// From now on looks from a point of the shape, given in its space, too, which is near to the nearest triangle.
    pub fn look_from(&mut self, from: DVec3) {
        // Of what is round, the body is the core.
        self.from = if self.radius > 0.0 { [0.0; 3] } else { rounded(self.to_tree * (from - self.middle)) };
    }

    /// From now on looks along an axis of the common frame too: one that tells the shape from a triangle, to which it points.
    #[inline(always)]
    pub fn look_along<S: Simd>(&mut self, simd: S, axis: DVec3) {
        if let Some(axis) = (self.normal_to_tree * axis).try_normalize() {
            self.axes.keep(simd, rounded(axis), &self.body);
        }
    }

    /// Lower bounds of the distances of the boxes of a node from the body, in the common frame.
    #[inline(never)] // nor into the walk: on the scalar level, optimising it then takes minutes
    pub fn of_boxes<S: Simd>(&self, simd: S, boxes: &Boxes) -> f32x8<S> {
        simd.vectorize(
            #[inline(always)]
            || self.of_boxes_on(simd, boxes),
        )
    }

    #[inline(always)]
    fn of_boxes_on<S: Simd>(&self, simd: S, boxes: &Boxes) -> f32x8<S> {
        let (zero, tiny) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, TINY));
        let [mut least, mut greatest] = [[zero; 3]; 2];
        for axis in 0..3 {
            let middle = f32x8::splat(simd, self.middle_in_tree[axis] as f32);
            let (min, max) = boxes.axis(simd, axis);
            (least[axis], greatest[axis]) = (min - middle, max - middle);
        }
        let mut gap = self.axes.gap(
            simd,
            #[inline(always)]
            |axis| lowest_of_boxes(&least, &greatest, axis),
        );
        let mut from = [zero; 3];
        for _ in 0..=ROUNDS {
            let [mut way, mut nearest] = [[zero; 3]; 2];
            for axis in 0..3 {
                nearest[axis] = from[axis].max(least[axis]).min(greatest[axis]);
                way[axis] = nearest[axis] - from[axis];
            }
            let length = dot(&way, &way).sqrt() + tiny;
            let some = (dot(&nearest, &way) - self.body.reach(simd, &way)) / length;
            // Of a box that the point is in, nothing is known.
            gap = (some.simd_gt(gap) & length.simd_gt(tiny)).select(some, gap);
            // Support points of a hull for each box take longer than what they spare.
            let Body::Edges(edges) = &self.body else { break };
            from = edges.nearest(simd, &nearest);
        }
        // Boxes lie within 1 on each axis, and their ends and the middle are rounded.
        let furthest = 2.0 * self.middle_in_tree.abs().element_sum() + 3.0;
        let error = self.slack + ROUNDING * (furthest + self.size);
        // Rounded downward, as the error is upward.
        let unit = self.unit * (1.0 - ROUNDING);
        (gap - f32x8::splat(simd, (error * (1.0 + ROUNDING)) as f32)) * f32x8::splat(simd, unit as f32)
    }

    /// Which of the triangles of an image in some lanes may be the nearest, where one is sought that is nearer than a distance of the
    /// common frame; lanes are given as bits. The others are no nearer than that, or another of them is nearer by more than `margin`. (So who
    /// goes on from the nearest of a leaf, by less than the margin, goes on from the same.)
    #[inline(never)] // see `of_boxes`
    pub fn prospects<S: Simd>(&self, simd: S, image: &Image, lanes: u32, distance: f64, margin: f64) -> u32 {
        simd.vectorize(
            #[inline(always)]
            || self.prospects_on(simd, image, lanes, distance, margin),
        )
    }

    #[inline(always)]
    fn prospects_on<S: Simd>(&self, simd: S, image: &Image, lanes: u32, distance: f64, margin: f64) -> u32 {
        let Placed { corners, error, furthest } = self.place(simd, image);
        let error = error + self.slack + ROUNDING * (furthest + self.size);
        if furthest > SIZE_MAX {
            return lanes;
        }
        let limit = ((distance + self.radius) * self.per_unit + error) * (1.0 + ROUNDING);
        let mut gap = self.axes.gap(
            simd,
            #[inline(always)]
            |axis| lowest_of_triangles(&corners, axis),
        );
        if lanes & !at_least(simd, gap, limit) == 0 {
            return 0;
        }
        let triangles = Triangles::new(simd, corners);
        let tiny = f32x8::splat(simd, TINY);
        let mut from = splat(simd, &self.from);
        let mut nearest = f32x8::splat(simd, f32::INFINITY);
        for round in 0..=self.body.rounds() {
            let way = triangles.toward(simd, &from);
            let length = dot(&way, &way).sqrt() + tiny;
            nearest = nearest.min(length);
            if round == self.body.rounds() {
                gap = greater(
                    gap,
                    (lowest_of_triangles(&triangles.corners, &way) - self.body.reach(simd, &way)) / length,
                );
                break;
            }
            let (support, reach) = self.body.furthest(simd, &way);
            gap = greater(gap, (lowest_of_triangles(&triangles.corners, &way) - reach) / length);
            if lanes & !at_least(simd, gap, limit) == 0 {
                return 0;
            }
            from = self.body.nearer(simd, &from, &way, &support);
        }
        let limit = if self.tells_by_points {
            let infinity = f32x8::splat(simd, f32::INFINITY);
            let counts = mask32x8::from_bitmask(simd, u64::from(lanes)) & nearest.simd_lt(infinity);
            let sure = f64::from(counts.select(nearest, infinity).reduce_min());
            // What is no nearer than this, by lower bounds, is farther than that.
            let beaten = (sure + error) * self.stretch + margin * self.per_unit + error;
            limit.min(beaten * (1.0 + ROUNDING))
        } else {
            limit
        };
        lanes & !at_least(simd, gap, limit)
    }

    #[inline(always)]
    fn place<S: Simd>(&self, simd: S, image: &Image) -> Placed<S> {
        let mut corners = [[f32x8::splat(simd, 0.0); 3]; 3];
        let (mut error, mut furthest) = (0.0, 0.0);
        let words = [image.corner(simd, 0), image.corner(simd, 1), image.corner(simd, 2)];
        for axis in 0..3 {
            let (min, step) = image.axis(axis);
            let base = min - self.middle_in_tree[axis];
            error += HALF_STEP * step;
            furthest += base.abs() + f64::from(STEPS) * step;
            let (base, step) = (f32x8::splat(simd, base as f32), f32x8::splat(simd, step as f32));
            for (corner, word) in corners.iter_mut().zip(words) {
                corner[axis] = word.along(simd, axis) * step + base;
            }
        }
        Placed { corners, error, furthest }
    }
}

/// An image, placed around the middle of the shape.
struct Placed<S: Simd> {
    corners: [Points<S>; 3],
    /// How far they are off.
    error: f64,
    /// The sum of the magnitudes that their coordinates are made of.
    furthest: f64,
}

/// How high eight boxes begin along a direction.
#[inline(always)]
fn lowest_of_boxes<S: Simd>(least: &Points<S>, greatest: &Points<S>, way: &Points<S>) -> f32x8<S> {
    let [x, y, z] = each(
        [0, 1, 2],
        #[inline(always)]
        |axis| (way[axis] * least[axis]).min(way[axis] * greatest[axis]),
    );
    x + y + z
}

/// The greater ones; the first where the second is no number.
#[inline(always)]
fn greater<S: Simd>(a: f32x8<S>, b: f32x8<S>) -> f32x8<S> {
    b.simd_gt(a).select(b, a)
}

/// The lanes that are at least a limit, as bits.
#[inline(always)]
fn at_least<S: Simd>(simd: S, lanes: f32x8<S>, limit: f64) -> u32 {
    lanes.simd_ge(f32x8::splat(simd, limit as f32)).to_bitmask() as u32
}

#[cfg(test)]
pub(super) mod scenes;

#[cfg(test)]
mod tests {
    use super::scenes::{convex, triangles, turned};
    use super::*;
    use crate::pair::complex_convex::CLEARLY_APART;
    use glam::DAffine3;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_convex::{Cuboid, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    /// Law: no box is farther than the bound says from what is in it, and what is not among the prospects is no nearer than the distance, or farther than
    /// another triangle of its leaf by more than the margin; for all kinds, under any maps, near and far, at any size, before and after the first
    /// is found; on every level of instructions. Of what is farther by one part in a hundred, most is passed over.
    #[test]
    fn nothing_that_may_be_nearest_is_passed_over() {
        let seed = 95;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut lanes, mut apart, mut farther, mut passed_over) = (0, 0, 0, 0);
        for case in 0..3000 {
            let size = 10f64.powi(rng.random_range(-30..30));
            let far = if case % 11 == 0 { 1e6 * size * in_cube(&mut rng) } else { DVec3::ZERO };
            let complex = triangles(&mut rng, case, 60, size, far);
            let (turn, at_complex) = turned(&mut rng, case);
            let target = at_complex.transform_point3(complex.vertices()[0]);
            let half = size * 10f64.powf(rng.random_range(-2.0..0.0));
            let convex = convex(&mut rng, case / 3, half);
            let convex = &*convex;
            let mut at_convex =
                DAffine3::from_rotation_translation(turn.inverse(), target + size * in_cube(&mut rng));
            if case % 5 == 0 {
                at_convex.matrix3.y_axis *= 3.0;
            }
            let frame = Frame::new(&at_complex, complex.reach(), &at_convex, convex.reach());
            let direct = Direct::round(convex, &frame);
            let mut gaps =
                Gaps::new(convex, &direct, &frame, complex.tree().normal()).expect("they are of a size");
            let closest = |primitive: u32| {
                gjk::closest_points(&complex.primitive_hull(primitive), &at_complex, convex, &at_convex)
            };
            if case % 2 == 0 {
                let gjk::Closest { points, .. } = closest(0);
                let [from_complex, from_convex] = &frame.common;
                let way =
                    from_complex.transform_point3(points.on_a) - from_convex.transform_point3(points.on_b);
                gaps.look_from(points.on_b);
                dispatch!(simd => gaps.look_along(simd, way));
            }
            let images = complex.images().expect("it is a mesh");
            for leaf in complex.tree().leaves() {
                let exact: Vec<f64> =
                    leaf.primitives.iter().map(|&i| closest(i).distance * frame.scale).collect();
                let nearest = exact.iter().copied().fold(f64::INFINITY, f64::min);
                let distance = [f64::INFINITY, nearest, exact[0], 1.0001 * exact[0]][case % 4];
                let (boxes, own) = leaf.boxes();
                let (bound, near) = alike(|level| {
                    dispatch!(widest level, simd => (
                        gaps.of_boxes(simd, &boxes).to_array()[own],
                        gaps.prospects(simd, &images.of(&leaf), leaf.lanes(), distance, CLEARLY_APART),
                    ))
                });
                let bound = f64::from(bound) - gaps.radius;
                assert!(bound <= nearest + 1e-12, "case {case}: {bound} for {nearest}");
                // Of those that meet what is round, the nearest to its core is enough.
                let meets = |lane: usize| near >> lane & 1 == 1 && exact[lane] == 0.0;
                assert!(nearest > 0.0 || distance == 0.0 || (0..exact.len()).any(meets), "case {case}");
                for (lane, &exact) in exact.iter().enumerate() {
                    let is_near = near >> lane & 1 == 1;
                    let may_be = nearest > 0.0 && exact < distance && exact <= nearest + CLEARLY_APART;
                    assert!(is_near || !may_be, "case {case}: lane {lane} at {exact}, {nearest} {distance}");
                    lanes += 1;
                    apart += usize::from(exact > 0.0);
                    let is_farther = exact > 1.01 * distance.min(nearest) + 1e-5;
                    farther += usize::from(is_farther);
                    passed_over += usize::from(is_farther && !is_near);
                }
            }
        }
        println!("{apart} of {lanes} are apart; of {farther} that are farther {passed_over} are passed over");
        assert!(10 * apart > 3 * lanes && 10 * farther > 3 * lanes && 2 * passed_over > farther);
    }

    /// What is too far away, or too different in size, is refused; so is what is no number.
    #[test]
    fn extremes_are_refused() {
        let mut rng = seeded(96);
        let complex = triangles(&mut rng, 3, 60, 1.0, DVec3::ZERO);
        for (size, away, taken) in
            [(1.0, 1.0, true), (1e12, 1.0, false), (1.0, 1e12, false), (1e-30, 1.0, true)]
        {
            let ball = Cuboid::new(DVec3::splat(size)).expect("it has a size");
            let at = DAffine3::from_translation(DVec3::X * away);
            let frame = Frame::new(&DAffine3::IDENTITY, complex.reach(), &at, ball.reach());
            let direct = Direct::round(&ball, &frame);
            let gaps = Gaps::new(&ball, &direct, &frame, complex.tree().normal());
            assert_eq!(gaps.is_some(), taken, "{size} {away}");
        }
    }
}
