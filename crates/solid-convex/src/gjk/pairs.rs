//! Pairs of points that are kept from one question about two objects to the next.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DMat3, DVec3};

use crate::difference::{NO_VERTEX, SupportPoint};

/// A point of each object, each in its local space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub a: DVec3,
    pub b: DVec3,
    /// As of a [`SupportPoint`].
    pub indices: [u16; 2],
}

impl Pair {
    /// What stands where there is none.
    pub const ZERO: Pair = Pair { a: DVec3::ZERO, b: DVec3::ZERO, indices: [0; 2] };
}

/// The points that one of the difference is made of.
impl From<&SupportPoint> for Pair {
    #[inline(always)]
    fn from(&SupportPoint { a, b, indices, .. }: &SupportPoint) -> Pair {
        Pair { a, b, indices }
    }
}

/// Four points of an object by coordinate, for vector instructions. Space: local.
pub(super) type Points = [[f64; 4]; 3];

/// Up to four pairs; the points of those that are missing are finite.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pairs {
    pub a: Points,
    pub b: Points,
    len: u8,
}

impl Pairs {
    /// Those of which points of a difference are made, the nearest to the origin first: from there a face is measured best.
    pub fn of<'p>(points: impl IntoIterator<Item = &'p SupportPoint>) -> Pairs {
        let mut pairs = Pairs::default();
        let (mut nearest, mut least) = (0, f64::INFINITY);
        for (k, p) in points.into_iter().enumerate().take(4) {
            for axis in 0..3 {
                (pairs.a[axis][k], pairs.b[axis][k]) = (p.a[axis], p.b[axis]);
            }
            let square = p.w.length_squared();
            if square < least {
                (nearest, least) = (k, square);
            }
            pairs.len += 1;
        }
        pairs.a.iter_mut().chain(&mut pairs.b).for_each(|row| row.swap(0, nearest));
        pairs
    }

    #[inline]
    pub fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// All four, also those that are missing.
    #[inline]
    pub fn all(&self) -> [Pair; 4] {
        [0, 1, 2, 3].map(|k| Pair { a: point(&self.a, k), b: point(&self.b, k), indices: [NO_VERTEX; 2] })
    }

    /// Sets how many there are.
    #[inline(always)]
    pub fn set_len(&mut self, len: usize) {
        self.len = len as u8;
    }
}

/// One of four points.
#[inline(always)]
pub(super) fn point(points: &Points, k: usize) -> DVec3 {
    DVec3::new(points[0][k], points[1][k], points[2][k])
}

/// Sets one of four points. In whole vectors, so that reading them does not wait for parts.
#[inline(always)]
pub(super) fn put<S: Simd>(simd: S, points: &mut Points, k: usize, p: DVec3) {
    let is_there = f64x4::simd_from(simd, [0.0, 1.0, 2.0, 3.0]).simd_eq(f64x4::splat(simd, k as f64));
    for axis in 0..3 {
        let row = f64x4::simd_from(simd, points[axis]);
        is_there.select(f64x4::splat(simd, p[axis]), row).store_slice(&mut points[axis]);
    }
}

/// The images of points under a linear map.
#[inline(always)]
pub(super) fn images<S: Simd>(simd: S, linear: &DMat3, [x, y, z]: &Points) -> [f64x4<S>; 3] {
    let (x, y, z) = (f64x4::simd_from(simd, *x), f64x4::simd_from(simd, *y), f64x4::simd_from(simd, *z));
    let image = {
        #[inline(always)]
        |i: usize| {
            x * f64x4::splat(simd, linear.x_axis[i])
                + y * f64x4::splat(simd, linear.y_axis[i])
                + z * f64x4::splat(simd, linear.z_axis[i])
        }
    };
    [image(0), image(1), image(2)]
}
