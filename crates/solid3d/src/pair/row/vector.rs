//! Points in the lanes of vectors that are as wide as the level of instructions has them: a row is one to four of them.

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::super::triangle_triangle::Triangle;
use super::Lanes;
use crate::tree::LEAF_SIZE;

/// As many numbers as a vector of the level holds, two to eight. On levels with shorter vectors, vectors of eight took
/// minutes to compile.
pub(super) type Wide<S> = <S as Simd>::f64s;

/// As many vectors.
#[derive(Clone, Copy)]
pub(super) struct Vector<S: Simd>(pub [Wide<S>; 3]);

/// The first lanes of the vectors that make up a row.
#[inline(always)]
pub(super) fn steps<S: Simd>() -> impl Iterator<Item = usize> {
    (0..LEAF_SIZE).step_by(width::<S>())
}

/// Those of them in which some lanes are, given as bits.
#[inline(always)]
pub(super) fn steps_with<S: Simd>(lanes: u32) -> impl Iterator<Item = usize> {
    steps::<S>().filter(
        #[inline(always)]
        move |from| lanes >> from & ((1 << width::<S>()) - 1) != 0,
    )
}

#[inline(always)]
pub(super) const fn width<S: Simd>() -> usize {
    <Wide<S> as SimdBase<S>>::LEN
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, lanes: &Lanes, from: usize) -> Wide<S> {
    Wide::<S>::from_slice(simd, &lanes[from..from + width::<S>()])
}

#[inline(always)]
pub(super) fn store<S: Simd>(_: S, v: Wide<S>, lanes: &mut Lanes, from: usize) {
    v.store_slice(&mut lanes[from..from + width::<S>()]);
}

/// The same number in all lanes.
#[inline(always)]
pub(super) fn one<S: Simd>(simd: S, x: f64) -> Wide<S> {
    Wide::<S>::splat(simd, x)
}

/// The same vector in all lanes.
#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, v: DVec3) -> Vector<S> {
    Vector([one(simd, v.x), one(simd, v.y), one(simd, v.z)])
}

#[inline(always)]
pub(super) fn minus<S: Simd>(Vector(a): Vector<S>, Vector(b): Vector<S>) -> Vector<S> {
    Vector([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// `a + b * t`.
#[inline(always)]
pub(super) fn along<S: Simd>(Vector(a): Vector<S>, Vector(b): Vector<S>, t: Wide<S>) -> Vector<S> {
    Vector([a[0] + b[0] * t, a[1] + b[1] * t, a[2] + b[2] * t])
}

#[inline(always)]
pub(super) fn times<S: Simd>(Vector(a): Vector<S>, t: Wide<S>) -> Vector<S> {
    Vector([a[0] * t, a[1] * t, a[2] * t])
}

/// The same triangle in all lanes.
#[inline(always)]
pub(super) fn splat_triangle<S: Simd>(simd: S, t: &Triangle) -> [Vector<S>; 3] {
    [splat(simd, t[0]), splat(simd, t[1]), splat(simd, t[2])]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(Vector(a): Vector<S>, Vector(b): Vector<S>) -> Wide<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<S: Simd>(Vector(a): Vector<S>, Vector(b): Vector<S>) -> Vector<S> {
    Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}
