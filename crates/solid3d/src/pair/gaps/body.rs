//! What is looked from: the core of a convex shape, in tree coordinates.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::{DMat3, DVec3};

use crate::pair::glance::{Points, dot};

/// Of the hull of more points, a box around them is looked at: to multiply them all would take longer than what it spares.
pub const POINTS_MAX: usize = 64;

/// How often a point of what has edges is moved towards another body. A hull's is moved once less, as each support point takes many products.
pub const ROUNDS: usize = 2;

/// A convex body around its middle, in tree coordinates.
#[expect(clippy::large_enum_variant, reason = "there is one on the stack while a distance is sought")]
pub enum Body {
    /// All sums of parts of some half edges, from -1 to 1: of a ball's core there are none, of a capsule's one.
    Edges(Edges),
    /// The hull of points.
    Points { points: [[f32; 3]; POINTS_MAX], count: usize },
}

pub struct Edges {
    halves: [[f32; 3]; 3],
    /// What a point is multiplied with to know how many half edges it is from the middle.
    duals: [[f32; 3]; 3],
    count: usize,
}

impl Body {
    pub fn edges(to_tree: &DMat3, edges: &[DVec3]) -> Body {
        let [mut halves, mut duals] = [[[0.0; 3]; 3]; 2];
        for (i, edge) in edges.iter().enumerate() {
            let edge = *to_tree * *edge;
            (halves[i], duals[i]) = (rounded(edge), rounded(edge / edge.length_squared()));
        }
        Body::Edges(Edges { halves, duals, count: edges.len() })
    }

    /// At most [`POINTS_MAX`].
    pub fn points(to_tree: &DMat3, local: &[DVec3], middle: DVec3) -> Body {
        let mut points = [[0.0; 3]; POINTS_MAX];
        for (point, local) in points.iter_mut().zip(local) {
            *point = rounded(*to_tree * (*local - middle));
        }
        Body::Points { points, count: local.len() }
    }

    pub fn size(&self) -> f64 {
        let sum = |v: &[f32; 3]| f64::from(v[0].abs()) + f64::from(v[1].abs()) + f64::from(v[2].abs());
        match self {
            Body::Edges(edges) => edges.halves.iter().map(sum).sum(),
            Body::Points { points, count } => points[..*count].iter().map(sum).fold(0.0, f64::max),
        }
    }

    /// How often a point of it is moved towards triangles: of what is only its middle, never.
    pub fn rounds(&self) -> usize {
        match self {
            Body::Edges(Edges { count: 0, .. }) => 0,
            Body::Edges(_) => ROUNDS,
            Body::Points { .. } => ROUNDS - 1,
        }
    }

    /// How far it reaches along directions.
    #[inline(always)]
    pub fn reach<S: Simd>(&self, simd: S, way: &Points<S>) -> f32x8<S> {
        match self {
            Body::Edges(Edges { halves, count, .. }) => {
                let mut reach = f32x8::splat(simd, 0.0);
                for half in &halves[..*count] {
                    reach += dot(way, &splat(simd, half)).abs();
                }
                reach
            }
            Body::Points { points, count } => {
                let mut reach = f32x8::splat(simd, f32::NEG_INFINITY);
                for point in &points[..*count] {
                    reach = reach.max(dot(way, &splat(simd, point)));
                }
                reach
            }
        }
    }

    /// The same with the points that reach so far, where [`nearer`](Body::nearer) needs them.
    #[inline(always)]
    pub fn furthest<S: Simd>(&self, simd: S, way: &Points<S>) -> (Points<S>, f32x8<S>) {
        let mut furthest = [f32x8::splat(simd, 0.0); 3];
        let Body::Points { points, count } = self else { return (furthest, self.reach(simd, way)) };
        let mut reach = f32x8::splat(simd, f32::NEG_INFINITY);
        for point in &points[..*count] {
            let point = splat(simd, point);
            let height = dot(way, &point);
            let is_higher = height.simd_gt(reach);
            reach = is_higher.select(height, reach);
            for axis in 0..3 {
                furthest[axis] = is_higher.select(point[axis], furthest[axis]);
            }
        }
        (furthest, reach)
    }

    /// A point of the body that is nearer to the end of a way from another, if there is any; given the support point along it.
    #[inline(always)]
    pub fn nearer<S: Simd>(
        &self,
        simd: S,
        from: &Points<S>,
        way: &Points<S>,
        support: &Points<S>,
    ) -> Points<S> {
        match self {
            Body::Edges(edges) => {
                edges.nearest(simd, &[from[0] + way[0], from[1] + way[1], from[2] + way[2]])
            }
            Body::Points { .. } => {
                let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
                let chord = [support[0] - from[0], support[1] - from[1], support[2] - from[2]];
                let part = dot(&chord, way) / dot(&chord, &chord).max(f32x8::splat(simd, f32::MIN_POSITIVE));
                let part = part.min(one).max(zero);
                [from[0] + chord[0] * part, from[1] + chord[1] * part, from[2] + chord[2] * part]
            }
        }
    }
}

impl Edges {
    /// The points nearest to others, if the edges are perpendicular; if not, points near to them.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, simd: S, there: &Points<S>) -> Points<S> {
        let one = f32x8::splat(simd, 1.0);
        let mut nearest = [f32x8::splat(simd, 0.0); 3];
        for (half, dual) in self.halves.iter().zip(&self.duals).take(self.count) {
            let part = dot(there, &splat(simd, dual)).min(one).max(-one);
            for axis in 0..3 {
                nearest[axis] += part * f32x8::splat(simd, half[axis]);
            }
        }
        nearest
    }
}

#[inline(always)]
pub fn splat<S: Simd>(simd: S, v: &[f32; 3]) -> Points<S> {
    [f32x8::splat(simd, v[0]), f32x8::splat(simd, v[1]), f32x8::splat(simd, v[2])]
}

pub fn rounded(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
