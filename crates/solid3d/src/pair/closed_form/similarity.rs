//! Placements that turn and scale alike in all directions.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::dispatch;
use solid_convex::similarity::{SKEW_MAX, plain_square};
use solid_convex::unit_scale;

use crate::placement;

/// The linear part of a placement that is a rotation, or a reflection, with a uniform scale.
#[derive(Clone, Copy)]
pub(in crate::pair) struct Similarity {
    linear: DMat3,
    /// The scale.
    pub stretch: f64,
}

/// The least square of a scale, far enough above the least number for the digits of sums of such squares.
const SQUARE_MIN: f64 = 1e-270;

impl Similarity {
    pub const ONE: Similarity = Similarity { linear: DMat3::IDENTITY, stretch: 1.0 };

    /// `None` for other maps, and for one so small that squares of its lengths lose digits.
    #[inline]
    pub fn new(linear: &DMat3) -> Option<Similarity> {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *linear;
        let square = x.length_squared();
        let skew = (y.length_squared() - square).abs().max((z.length_squared() - square).abs());
        let skew = skew.max(x.dot(y).abs()).max(y.dot(z).abs()).max(z.dot(x).abs());
        ((skew <= SKEW_MAX * square) & (square >= SQUARE_MIN))
            .then(|| Similarity { linear: *linear, stretch: square.sqrt() })
    }

    /// The map, then a scale.
    pub fn scaled(self, scale: f64) -> Similarity {
        Similarity { linear: self.linear * scale, stretch: self.stretch * scale }
    }

    pub fn apply(&self, local: DVec3) -> DVec3 {
        self.linear * local
    }

    /// The image of the local axis y.
    pub fn y_axis(&self) -> DVec3 {
        self.linear.y_axis
    }

    /// The local axes as unit vectors.
    pub fn units(&self) -> [DVec3; 3] {
        let inverse = 1.0 / self.stretch;
        [self.linear.x_axis * inverse, self.linear.y_axis * inverse, self.linear.z_axis * inverse]
    }

    /// How far the image of a box of half extents `half` reaches along a vector from its centre, times the vector's length.
    pub fn reach_along(&self, vector: DVec3, half: DVec3) -> f64 {
        self.linear.mul_transpose_vec3(vector).abs().dot(half)
    }

    pub fn local(&self, displacement: DVec3) -> DVec3 {
        // Not by the square, which vanishes where a tiny shape is in the unit of a huge one.
        self.linear.mul_transpose_vec3(displacement / self.stretch) / self.stretch
    }
}

/// The scale of a placement; `None` of one that is not a rotation with a uniform scale, or not good.
#[inline(always)]
pub(super) fn stretch<S: Simd>(simd: S, at: &DAffine3) -> Option<f64> {
    match plain_square(simd, at) {
        Some(square) => Some(square.sqrt()),
        None => stretch_at_length(at),
    }
}

/// The scale of a good placement of any size: that of the same one near the size 1, whose digits are the same.
#[inline(never)]
fn stretch_at_length(at: &DAffine3) -> Option<f64> {
    let linear = &placement::checked("placement", at).ok()?.matrix3;
    let scale = unit_scale(linear.x_axis.abs().max_element());
    let near = DAffine3 { matrix3: *linear * scale, translation: DVec3::ZERO };
    Some(dispatch!(simd => plain_square(simd, &near))?.sqrt() / scale)
}

/// A vector of the world in the directions of a body, times the scale: its product with the matrix, transposed. (glam's is not always inlined, and is then
/// called without vectors.)
#[inline(always)]
pub(in crate::pair) fn to_body(DMat3 { x_axis, y_axis, z_axis }: &DMat3, v: DVec3) -> DVec3 {
    DVec3::new(x_axis.dot(v), y_axis.dot(v), z_axis.dot(v))
}

/// A vector in the directions of a body as the world has it, times the scale.
#[inline(always)]
pub(in crate::pair) fn to_world(DMat3 { x_axis, y_axis, z_axis }: &DMat3, v: DVec3) -> DVec3 {
    x_axis * v.x + y_axis * v.y + z_axis * v.z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_and_scales_are_similarities_and_skews_are_none() {
        let mut turn = DMat3::IDENTITY;
        for k in 1..=12 {
            turn *= DMat3::from_rotation_y(f64::from(k)) * DMat3::from_rotation_x(0.7);
            for scale in [1e-100, 0.1, -1.0, 1e100] {
                let similarity = Similarity::new(&(turn * scale)).unwrap();
                assert!((similarity.stretch / scale.abs() - 1.0).abs() < 1e-14);
                let point = DVec3::new(1.0, 2.0, 3.0);
                assert!((similarity.local(similarity.apply(point)) - point).length() < 1e-13);
            }
            assert!(Similarity::new(&(turn * 1e-160)).is_none());
            for skew in
                [DVec3::new(1.0, 1.0, 1.0 + 1e-13), DVec3::new(1.0, 2.0, 1.0), DVec3::new(1.0, 0.0, 1.0)]
            {
                assert!(Similarity::new(&(turn * DMat3::from_diagonal(skew))).is_none(), "{skew}");
            }
        }
    }
}
