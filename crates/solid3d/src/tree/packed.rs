//! One box of `f32` in tree coordinates.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// Beyond every tree coordinate (they lie within `[-1, 1]`), and far from overflow when squared in `f64`.
pub(super) const FAR: f32 = 1e30;

/// A box as `[min x, y, z, FAR, -max x, y, z, FAR]`: with the maximum negated, a union is one minimum over eight lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PackedBox(pub [f32; 8]);

impl PackedBox {
    /// Bounds nothing; the neutral element of `grow`.
    pub const EMPTY: PackedBox = PackedBox([FAR; 8]);

    /// Grows to the smallest box around both.
    #[inline(always)]
    pub fn grow(&mut self, other: &PackedBox) {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = if b < *a { b } else { *a };
        }
    }

    /// The same in a kernel. (Of the loop above the compiler makes a store of those alone that are less, which is far slower there.)
    #[inline(always)]
    pub fn grow_on<S: Simd>(&mut self, simd: S, other: &PackedBox) {
        let (a, b) = (f32x8::load_array_ref(simd, &self.0), f32x8::load_array_ref(simd, &other.0));
        self.0 = b.min(a).to_array();
    }

    /// The least coordinates.
    #[inline(always)]
    pub fn min(&self) -> [f32; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The greatest coordinates.
    #[inline(always)]
    pub fn max(&self) -> [f32; 3] {
        [-self.0[4], -self.0[5], -self.0[6]]
    }

    /// Twice the centre along an axis.
    #[inline(always)]
    pub fn center_doubled(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[4 + axis]
    }

    /// The size along an axis; negative for an empty box.
    #[inline(always)]
    pub fn size(&self, axis: usize) -> f32 {
        -self.0[4 + axis] - self.0[axis]
    }
}
