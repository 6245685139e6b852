//! One box of `f32` in tree coordinates.

/// Beyond every tree coordinate (they lie within `[-1, 1]`), and far from overflow when squared in `f64`.
pub(super) const FAR: f32 = 1e30;

/// A box as `[min x, y, z, FAR, -max x, y, z, FAR]`: with the maximum negated, a union is one minimum over eight lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PackedBox(pub [f32; 8]);

impl PackedBox {
    /// Bounds nothing; the neutral element of `grow`.
    pub const EMPTY: PackedBox = PackedBox([FAR; 8]);

    /// Grows to the smallest box around both.
    #[inline]
    pub fn grow(&mut self, other: &PackedBox) {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = if b < *a { b } else { *a };
        }
    }

    /// The least coordinates.
    #[inline]
    pub fn min(&self) -> [f32; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The greatest coordinates.
    #[inline]
    pub fn max(&self) -> [f32; 3] {
        [-self.0[4], -self.0[5], -self.0[6]]
    }

    /// Twice the centre along an axis.
    #[inline]
    pub fn center_doubled(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[4 + axis]
    }

    /// The size along an axis; negative for an empty box.
    #[inline]
    pub fn size(&self, axis: usize) -> f32 {
        -self.0[4 + axis] - self.0[axis]
    }
}
