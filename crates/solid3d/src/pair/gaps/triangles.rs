//! The triangles of an image.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use crate::pair::glance::{Points, dot, minus};

/// Eight triangles, and what is known of them wherever they are looked at from.
pub struct Triangles<S: Simd> {
    pub corners: [Points<S>; 3],
    edges: [Points<S>; 3],
    /// One over their squares.
    inverse: [f32x8<S>; 3],
    /// Of the first edge, and the reverse of the last: their product, and one over the squared area of the parallelogram.
    product: f32x8<S>,
    squares: [f32x8<S>; 2],
    per_area: f32x8<S>,
}

impl<S: Simd> Triangles<S> {
    #[inline(always)]
    pub fn new(simd: S, corners: [Points<S>; 3]) -> Self {
        let (one, tiny) = (f32x8::splat(simd, 1.0), f32x8::splat(simd, f32::MIN_POSITIVE));
        let [p, q, r] = &corners;
        let edges = [minus(q, p), minus(r, q), minus(p, r)];
        let squares = [dot(&edges[0], &edges[0]), dot(&edges[1], &edges[1]), dot(&edges[2], &edges[2])];
        let inverse = [one / squares[0].max(tiny), one / squares[1].max(tiny), one / squares[2].max(tiny)];
        let product = -dot(&edges[0], &edges[2]);
        let per_area = one / (squares[0] * squares[2] - product * product).max(tiny);
        Triangles { corners, edges, inverse, product, squares: [squares[0], squares[2]], per_area }
    }

    /// The ways from points to what is nearest to them, of the triangle, or nearly so.
    #[inline(always)]
    pub fn toward(&self, simd: S, from: &Points<S>) -> Points<S> {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let Triangles { corners, edges, .. } = self;
        let mut best = minus(&corners[0], from);
        let to_first = best;
        let mut least = f32x8::splat(simd, f32::INFINITY);
        for j in 0..3 {
            let to_corner = minus(&corners[j], from);
            let t = (-dot(&edges[j], &to_corner) * self.inverse[j]).min(one).max(zero);
            let way = [
                to_corner[0] + edges[j][0] * t,
                to_corner[1] + edges[j][1] * t,
                to_corner[2] + edges[j][2] * t,
            ];
            let squared = dot(&way, &way);
            let is_nearer = squared.simd_lt(least);
            least = is_nearer.select(squared, least);
            for axis in 0..3 {
                best[axis] = is_nearer.select(way[axis], best[axis]);
            }
        }
        // Where the foot of the perpendicular is inside, by its coordinates along the first edge and the reverse of the last.
        let (along_first, along_last) = (-dot(&edges[0], &to_first), dot(&edges[2], &to_first));
        let s = (self.squares[1] * along_first - self.product * along_last) * self.per_area;
        let t = (self.squares[0] * along_last - self.product * along_first) * self.per_area;
        let is_inside = s.simd_gt(zero) & t.simd_gt(zero) & (s + t).simd_lt(one);
        for axis in 0..3 {
            let way = to_first[axis] + edges[0][axis] * s - edges[2][axis] * t;
            best[axis] = is_inside.select(way, best[axis]);
        }
        best
    }
}

/// How high eight triangles begin along a direction.
#[inline(always)]
pub fn lowest_of_triangles<S: Simd>([p, q, r]: &[Points<S>; 3], way: &Points<S>) -> f32x8<S> {
    dot(p, way).min(dot(q, way)).min(dot(r, way))
}
