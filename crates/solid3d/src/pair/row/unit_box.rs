//! Which triangles of a row meet a box, wherever it is clear; of the rest nothing is said.
//!
//! The box is the cube from -1 to 1 on each axis: rows are placed in its space. By the separating-axis theorem a triangle is apart
//! from it along one of thirteen axes or meets it: the normals of the faces of either, and the products of their edges
//! (Akenine-Moller, *Fast 3D Triangle-Box Overlap Testing*, 2001). Along an axis L the cube reaches as far as the sum |L| of the
//! magnitudes of its coordinates, and the triangle from the least to the greatest of its corners.
//!
//! # What is clear
//!
//! Whatever rounding makes of L, what is apart along it is apart; and what is by a [`margin`](Cube::margin) times |L| is
//! so by that margin, as |L| is no less than the length.
//!
//! Triangles that overlap the cube along all axes by a depth d meet it, where d is [`DEPTH`] margins. With u = 2^-53 and the
//! coordinates within 4m, m the most that lengths of the common frame grow here: an edge is off by a part of u on each axis, so its
//! products with the axes have the right direction up to u, and heights along L are off by 64 u m |L| at most. The margin is 2^-24 m or
//! more: a billion times that. Only the normal of a triangle much longer than wide may have a wrong direction, by 4u 8m / w for the
//! width w, which moves heights by less than d / 2 where w exceeds d / 2. Thinner ones have no say: the sums of the cube and the
//! reversed triangle make up a convex body that has the cube in it, and without its two facets across that normal it grows by caps,
//! each over a facet narrower than the body, so that they narrow too and nothing in them is as deep as w between its sides.

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::{DAffine3, DMat3, DVec3};

use super::vector::{Vector, Wide, cross, dot, load, minus, one, steps, width};
use super::{Row, Verdict};
use crate::bounds::Aabb;

/// Overlaps are this many margins deep: see the module.
const DEPTH: f64 = 4.0;

/// The greatest growth of lengths: of the common frame's, a box is no thinner than that part. The depth is then a half.
const GROWTH_MAX: f64 = (1u64 << 20) as f64;

/// The space of a box in which it is the cube from -1 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cube {
    /// From the space of the triangles.
    pub map: DAffine3,
    /// A gap of which all is known that the caller wants to know.
    margin: f64,
}

impl Cube {
    /// `growth` bounds how much longer lengths of the common frame are here; a gap of `gap` there is clear, and `slack` the error of a
    /// coordinate here. `None` where it is too thin.
    pub fn new(map: DAffine3, growth: f64, gap: f64, slack: f64) -> Option<Cube> {
        // False of what is no number.
        (growth <= GROWTH_MAX && slack <= gap * growth).then_some(Cube { map, margin: gap * growth + slack })
    }

    /// A box that holds all that may meet it.
    pub fn bounds(&self) -> Aabb {
        let reach = DVec3::splat(1.0 + self.margin);
        Aabb::new(-reach, reach)
    }

    /// Half sizes of the cubes within which it is clear that what is there meets it, and beyond which that it does not.
    pub fn clear(&self) -> (f64, f64) {
        (1.0 - DEPTH * self.margin, 1.0 + self.margin)
    }

    /// Which of the triangles in some lanes meet it, and which do not, as bits.
    #[inline(never)] // see `distances`
    pub fn verdict<S: Simd>(&self, simd: S, row: &Row, lanes: u32) -> Verdict {
        simd.vectorize(
            #[inline(always)]
            || self.verdict_on(simd, row, lanes),
        )
    }

    #[inline(always)]
    fn verdict_on<S: Simd>(&self, simd: S, row: &Row, lanes: u32) -> Verdict {
        let mut all = Verdict { meet: 0, apart: 0 };
        for from in steps::<S>() {
            let asked = lanes >> from & ((1 << width::<S>()) - 1);
            if asked == 0 {
                continue;
            }
            let some = self.of_step(simd, row, from, asked);
            all.meet |= some.meet << from;
            all.apart |= some.apart << from;
        }
        Verdict { meet: all.meet & lanes, apart: all.apart & lanes }
    }

    #[inline(always)]
    fn of_step<S: Simd>(&self, simd: S, row: &Row, from: usize, asked: u32) -> Verdict {
        let (inner, outer) = self.clear();
        let mut axes = Axes::new(simd, outer, inner);
        for axis in 0..3 {
            axes.look(load(simd, &row.min[axis], from), load(simd, &row.max[axis], from), one(simd, 1.0));
        }
        if asked & !(axes.apart.to_bitmask() as u32) == 0 {
            return Verdict { meet: 0, apart: asked };
        }
        let corners = row.corners(simd, from);
        let edges =
            [minus(corners[1], corners[0]), minus(corners[2], corners[1]), minus(corners[0], corners[2])];
        let normal = cross(edges[0], edges[1]);
        let heights = [dot(normal, corners[0]), dot(normal, corners[1]), dot(normal, corners[2])];
        axes.look_at_three(heights, normal.0[0].abs() + normal.0[1].abs() + normal.0[2].abs());
        for j in 0..3 {
            let (Vector(e), Vector(p), Vector(q)) = (edges[j], corners[j], corners[(j + 2) % 3]);
            for k in 0..3 {
                // The product of an axis and the edge: both ends of the edge are at one height.
                let (l, m) = ((k + 1) % 3, (k + 2) % 3);
                let of_edge = e[l] * p[m] - e[m] * p[l];
                let of_corner = e[l] * q[m] - e[m] * q[l];
                axes.look(of_edge.min(of_corner), of_edge.max(of_corner), e[l].abs() + e[m].abs());
            }
        }
        Verdict { meet: axes.meet.to_bitmask() as u32, apart: axes.apart.to_bitmask() as u32 }
    }
}

/// What the axes say that were looked along.
struct Axes<S: Simd> {
    outer: Wide<S>,
    inner: Wide<S>,
    apart: S::mask64s,
    meet: S::mask64s,
}

impl<S: Simd> Axes<S> {
    #[inline(always)]
    fn new(simd: S, outer: f64, inner: f64) -> Self {
        let (outer, inner) = (one(simd, outer), one(simd, inner));
        Axes { outer, inner, apart: outer.simd_lt(outer), meet: outer.simd_le(outer) }
    }

    /// Along an axis of a given sum of magnitudes, a triangle reaches from `least` to `greatest`.
    #[inline(always)]
    fn look(&mut self, least: Wide<S>, greatest: Wide<S>, sum: Wide<S>) {
        let (outer, inner) = (self.outer * sum, self.inner * sum);
        self.apart |= least.simd_gt(outer) | greatest.simd_lt(-outer);
        self.meet &= least.simd_le(inner) & greatest.simd_ge(-inner);
    }

    #[inline(always)]
    fn look_at_three(&mut self, [p, q, r]: [Wide<S>; 3], sum: Wide<S>) {
        self.look(p.min(q).min(r), p.max(q).max(r), sum);
    }
}

/// A bound on how much a linear map stretches lengths.
pub(crate) fn stretch_max(linear: &DMat3) -> f64 {
    (linear.x_axis.length_squared() + linear.y_axis.length_squared() + linear.z_axis.length_squared()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::row::tests::row_of;
    use crate::pair::triangle_triangle::Triangle;
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_convex::{Cuboid, IndexedPoints, gjk};
    use solid_oracle::generate::seeded;

    /// Against GJK, for large and small triangles, slivers, along the axes and aslant, near to touching and not; on every level of
    /// instructions. What is clear is said.
    #[test]
    fn nothing_false_is_said_of_a_box() {
        let seed = 34;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut hits, mut unknown, mut lanes) = (0, 0, 0);
        let cuboid = Cuboid::new(DVec3::splat(2.0)).unwrap();
        let margin = 1e-6;
        for case in 0..4000 {
            let mut point =
                |size: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-size..size)));
            let ys: [Triangle; 8] = std::array::from_fn(|lane| {
                let size = [0.1, 1.0, 10.0][lane % 3];
                let corner = point(1.6);
                match case % 4 {
                    0 => [corner, corner + point(size), corner + point(size)],
                    // Along the axes.
                    1 => [
                        corner,
                        corner + DVec3::AXES[lane % 3] * size,
                        corner + DVec3::AXES[(lane + 1) % 3] * size,
                    ],
                    // Slivers.
                    2 => {
                        let along = point(size);
                        [corner, corner + along, corner + along * 0.4 + point(1e-9)]
                    }
                    // In the plane of a face, or near to it.
                    _ => {
                        let height = 1.0 + [0.0, 1e-7, -1e-7, 1e-5, -1e-5][case / 4 % 5];
                        [corner, corner + point(size), corner + point(size)].map(|p| p.with_z(height))
                    }
                }
            });
            let row = row_of(&ys);
            let cube = Cube { map: DAffine3::IDENTITY, margin };
            let asked = 0b0111_1111;
            let Verdict { meet, apart } =
                alike(|level| dispatch!(widest level, simd => cube.verdict(simd, &row, asked)));
            assert_eq!((meet | apart) & !asked | meet & apart, 0);
            for (lane, y) in ys.iter().enumerate().filter(|(lane, _)| asked >> lane & 1 == 1) {
                let hull = IndexedPoints::new(y, &[0, 1, 2]).unwrap();
                let expected = gjk::intersects(&hull, &DAffine3::IDENTITY, &cuboid, &DAffine3::IDENTITY);
                assert!(expected || meet >> lane & 1 == 0, "{y:?} does not meet");
                assert!(!expected || apart >> lane & 1 == 0, "{y:?} meets");
                hits += usize::from(expected);
                lanes += 1;
                unknown += usize::from(case % 4 != 3 && (meet | apart) >> lane & 1 == 0);
            }
        }
        println!("{hits} of {lanes} meet; of {unknown} nothing is said");
        assert!((lanes * 3 / 10..lanes * 7 / 10).contains(&hits) && unknown * 1000 < lanes);
    }

    #[test]
    fn boxes_that_are_too_thin_have_no_cube() {
        let cube = |growth: f64, slack: f64| Cube::new(DAffine3::IDENTITY, growth, 1e-7, slack);
        assert!(cube(1e3, 1e-9).is_some());
        for (growth, slack) in
            [(1e7, 0.0), (1e3, 1e-3), (f64::NAN, 0.0), (f64::INFINITY, 0.0), (1.0, f64::NAN)]
        {
            assert!(cube(growth, slack).is_none());
        }
    }
}
