//! What hangs in a lane of a tree: its box cut with its [slab](super::slabs), in tree coordinates.
//!
//! Along a direction a patch reaches no further than its box does along what is left of the direction without a multiple of the
//! slab's normal, and the slab along that multiple; for any multiple, so for the projection on the normal.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use super::lanes::splat;
use super::slabs::{Eight, center};
use super::{Place, Tree};

/// A vector in each lane.
pub(super) type Vector<S> = [f32x8<S>; 3];

/// A patch in each lane.
pub(super) struct Patch<S: Simd> {
    pub center: Vector<S>,
    pub half_extents: Vector<S>,
    /// Those of the slab, which are zero where there is none.
    pub normal: Vector<S>,
    pub middle: f32x8<S>,
    pub half: f32x8<S>,
}

impl<S: Simd> Patch<S> {
    /// The lanes of a node.
    #[inline(always)]
    pub fn lanes(simd: S, tree: &Tree, slabs: &[Eight], node: usize) -> Self {
        let (node, slabs) = (&tree.nodes[node], &slabs[node]);
        let half = splat(simd, 0.5);
        let none = splat(simd, 0.0);
        let [mut center, mut half_extents, mut normal] = [[none; 3]; 3];
        for axis in 0..3 {
            let min = f32x8::load_array_ref(simd, &node.min[axis]);
            let max = f32x8::load_array_ref(simd, &node.max[axis]);
            center[axis] = half * (min + max);
            half_extents[axis] = half * (max - min);
            normal[axis] = f32x8::load_array_ref(simd, &slabs.normal[axis]);
        }
        let middle = f32x8::load_array_ref(simd, &slabs.middle);
        let half = f32x8::load_array_ref(simd, &slabs.half);
        Patch { center, half_extents, normal, middle, half }
    }

    /// What hangs at a place, the same in all lanes.
    #[inline(always)]
    pub fn one(simd: S, tree: &Tree, slabs: &[Eight], place: Place) -> Self {
        let bounds = tree.box_at(place);
        let (min, max) = (bounds.min(), bounds.max());
        let none = splat(simd, 0.0);
        let [mut centers, mut half_extents, mut normal] = [[none; 3]; 3];
        let (mut middle, mut half) = (none, none);
        for axis in 0..3 {
            centers[axis] = splat(simd, center(min[axis], max[axis]));
            half_extents[axis] = splat(simd, 0.5 * (max[axis] - min[axis]));
        }
        if let Some((node, lane)) = place.split() {
            let slabs = &slabs[node];
            for (x, row) in normal.iter_mut().zip(&slabs.normal) {
                *x = splat(simd, row[lane]);
            }
            (middle, half) = (splat(simd, slabs.middle[lane]), splat(simd, slabs.half[lane]));
        }
        Patch { center: centers, half_extents, normal, middle, half }
    }

    /// A direction without a multiple of the normal of the slab, and the multiple: the projection on the normal.
    #[inline(always)]
    pub fn split(&self, along: &Vector<S>) -> (Vector<S>, f32x8<S>) {
        let multiple = dot(along, &self.normal);
        let mut rest = *along;
        for axis in 0..3 {
            rest[axis] = along[axis] - multiple * self.normal[axis];
        }
        (rest, multiple)
    }

    /// How far the box reaches from its centre along a direction, at most.
    #[inline(always)]
    pub fn reach_of_box(&self, along: &Vector<S>) -> f32x8<S> {
        let [x, y, z] = &self.half_extents;
        along[0].abs() * *x + along[1].abs() * *y + along[2].abs() * *z
    }
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: &Vector<S>, b: &Vector<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The product with the transpose of a matrix that is given by rows.
#[inline(always)]
pub(super) fn transposed_product<S: Simd>(simd: S, [x, y, z]: &[[f32; 3]; 3], v: &Vector<S>) -> Vector<S> {
    let mut sums = *v;
    for axis in 0..3 {
        sums[axis] = splat(simd, x[axis]) * v[0] + splat(simd, y[axis]) * v[1] + splat(simd, z[axis]) * v[2];
    }
    sums
}
