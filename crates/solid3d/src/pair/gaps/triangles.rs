//! The triangles of an image.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use crate::pair::glance::{Points, dot, minus};

/// Eight triangles, and what is known of them wherever they are looked at from.
pub struct Triangles<S: Simd> {
    pub corners: [Points<S>; 3],
    /// From the first corner to the second and the third.
    edges: [Points<S>; 2],
    /// Of these edges, and of the one between their ends: their squares, and one over these.
    squares: [f32x8<S>; 3],
    inverse: [f32x8<S>; 3],
    /// Of the two edges: their product, and one over the squared area of the parallelogram.
    product: f32x8<S>,
    per_area: f32x8<S>,
}

impl<S: Simd> Triangles<S> {
    #[inline(always)]
    pub fn new(simd: S, corners: [Points<S>; 3]) -> Self {
        let (one, tiny) = (f32x8::splat(simd, 1.0), f32x8::splat(simd, f32::MIN_POSITIVE));
        let [p, q, r] = &corners;
        let (pq, pr) = (minus(q, p), minus(r, p));
        let product = dot(&pq, &pr);
        let (of_pq, of_pr) = (dot(&pq, &pq), dot(&pr, &pr));
        let squares = [of_pq, of_pr, of_pq + of_pr - (product + product)];
        let inverse = [one / squares[0].max(tiny), one / squares[1].max(tiny), one / squares[2].max(tiny)];
        let per_area = one / (of_pq * of_pr - product * product).max(tiny);
        Triangles { corners, edges: [pq, pr], squares, inverse, product, per_area }
    }

    /// The ways from points to what is nearest to them, of the triangle, or nearly so.
    ///
    /// By two coordinates, along the two edges: of the foot of the perpendicular, or of the nearest point of the nearest edge. The distance from a point
    /// of these is a quadratic function of them, of which what is the same for all is left out.
    #[inline(always)]
    pub fn toward(&self, simd: S, from: &Points<S>) -> Points<S> {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let Triangles {
            corners,
            edges: [pq, pr],
            squares: [of_pq, of_pr, of_qr],
            inverse,
            product,
            per_area,
        } = self;
        let away = minus(&corners[0], from);
        let (u, v) = (-dot(pq, &away), -dot(pr, &away));
        let on_pq = (u * inverse[0]).min(one).max(zero);
        let on_pr = (v * inverse[1]).min(one).max(zero);
        let along = v - u + *of_pq - *product;
        let on_qr = (along * inverse[2]).min(one).max(zero);
        let at_pq = on_pq * (on_pq * *of_pq - (u + u));
        let at_pr = on_pr * (on_pr * *of_pr - (v + v));
        let at_qr = on_qr * (on_qr * *of_qr - (along + along)) + (*of_pq - (u + u));
        let is_pr = at_pr.simd_lt(at_pq);
        let is_qr = at_qr.simd_lt(at_pq.min(at_pr));
        let s = is_qr.select(one - on_qr, is_pr.select(zero, on_pq));
        let t = is_qr.select(on_qr, is_pr.select(on_pr, zero));
        let foot_s = (*of_pr * u - *product * v) * *per_area;
        let foot_t = (*of_pq * v - *product * u) * *per_area;
        let is_inside = foot_s.simd_gt(zero) & foot_t.simd_gt(zero) & (foot_s + foot_t).simd_lt(one);
        let (s, t) = (is_inside.select(foot_s, s), is_inside.select(foot_t, t));
        [away[0] + pq[0] * s + pr[0] * t, away[1] + pq[1] * s + pr[1] * t, away[2] + pq[2] * s + pr[2] * t]
    }
}

/// How high eight triangles begin along a direction.
#[inline(always)]
pub fn lowest_of_triangles<S: Simd>([p, q, r]: &[Points<S>; 3], way: &Points<S>) -> f32x8<S> {
    dot(p, way).min(dot(q, way)).min(dot(r, way))
}
