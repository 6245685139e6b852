//! Two trees that face each other: bounds on distances, by boxes that are cut with slabs.
//!
//! The body that counts is the [patch](super::patch) in a lane. There are three directions to look along: from centre to centre, and
//! across each of the two slabs.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::part;

use super::crossing::rows;
use super::lanes::splat;
use super::patch::{Patch, Vector, dot, transposed_product};
use super::slabs::{Eight, Slabs};
use super::squares::{raised, reaching};
use super::{Place, Tree};
use crate::placement::row_norm;

/// Two trees, in a space in which distances count.
pub(crate) struct Facing<'t> {
    pub slabs: [&'t Slabs; 2],
    /// Takes the local space of each tree to that space.
    pub placements: [DAffine3; 2],
}

/// The error of a bound, relative to how far the two roots reach from one of their origins. With u = 2^-24, and in units of that
/// reach: the direction has a norm of 1, so a sum of coordinates of 1.74. Then the distance of the centres along it is off by
/// 14u; a support point's height by 60u at most for each of both, in proportion to their share of the reach (8.7u from the direction taken
/// to tree coordinates, 27u from the box, 24u from the slab); and the two subtractions add 25u. This is 128u.
const MARGIN: f32 = 64.0 * f32::EPSILON;

/// Pays for a direction's norm that is 1 up to rounding only; what rounds squares, the metric pays for.
const NORM: f64 = 1.0 - 8.0 * f32::EPSILON as f64;

/// What is divided by is at least this.
const TINY: f32 = f32::MIN_POSITIVE;

/// A tree in a common space, of which the unit is the reach of both.
struct Side<'t> {
    tree: &'t Tree,
    slabs: &'t [Eight],
    /// From tree coordinates; by rows.
    linear: [[f32; 3]; 3],
    exact: DMat3,
    /// Takes normals of planes there, up to a factor.
    cofactors: [[f32; 3]; 3],
}

/// Two trees that face each other.
pub(super) struct Faces<'t> {
    sides: [Side<'t>; 2],
    /// From the origin of the tree coordinates of `b` to that of `a`.
    offset: DVec3,
    unit: f64,
}

impl<'t> Faces<'t> {
    /// `None` where no unit suits.
    pub fn new(facing: &Facing<'t>, a: &'t Tree, b: &'t Tree) -> Option<Self> {
        let linear = |at: &DAffine3, tree: &Tree| at.matrix3 * tree.normal.scale;
        let [at_a, at_b] = &facing.placements;
        let (of_a, of_b) = (linear(at_a, a), linear(at_b, b));
        let offset = at_a.transform_point3(a.normal.origin) - at_b.transform_point3(b.normal.origin);
        let unit = row_norm(&of_a) + row_norm(&of_b) + offset.abs().max_element();
        if !unit.is_normal() || !unit.recip().is_normal() {
            return None;
        }
        let side = |tree: &'t Tree, linear: DMat3, slabs: &'t Slabs| {
            let exact = linear * unit.recip();
            let DMat3 { x_axis: x, y_axis: y, z_axis: z } = exact;
            let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
            let largest = cofactors.to_cols_array().iter().fold(0.0, |most: f64, c| most.max(c.abs()));
            let cofactors = if largest.is_normal() { cofactors * largest.recip() } else { DMat3::ZERO };
            Side { tree, slabs: &slabs.eights, linear: rows(&exact), exact, cofactors: rows(&cofactors) }
        };
        let [slabs_a, slabs_b] = facing.slabs;
        Some(Faces {
            sides: [side(a, of_a, slabs_a), side(b, of_b, slabs_b)],
            offset: offset * unit.recip(),
            unit,
        })
    }

    /// Squares of the distances of the lanes of a node and what hangs at a place of the other tree, raised until none is below a limit; the node is of the
    /// first tree for `OF` = 0, of the second for 1. A length of one in the world is so many `units`. What was near was apart along `kept`, of length one, or
    /// zero.
    #[inline(always)]
    pub fn raised<S: Simd, const OF: usize>(
        &self,
        simd: S,
        (node, place): (usize, Place),
        kept: DVec3,
        units: f32,
        limit: f32,
        squares: f32x8<S>,
    ) -> f32x8<S> {
        let (many, one) = (&self.sides[OF], &self.sides[1 - OF]);
        let offset = if OF == 0 { -self.offset } else { self.offset };
        let units = splat(simd, (self.unit * f64::from(units) * NORM) as f32);
        let by = {
            #[inline(always)]
            |squares: f32x8<S>, gap: f32x8<S>| raised(simd, squares, (gap - splat(simd, MARGIN)) * units)
        };
        part!(simd => {
            let lanes = Patch::lanes(simd, many.tree, many.slabs, node);
            let single = Patch::one(simd, one.tree, one.slabs, place);
            let gaps = Gaps::new(simd, many, lanes, one, single, offset);
            let kept = [splat(simd, kept.x as f32), splat(simd, kept.y as f32), splat(simd, kept.z as f32)];
            let squares = by(squares, gaps.along(simd, &kept));
            if reaching(simd, squares, limit) == u32::MAX {
                return squares;
            }
            let mut gap = splat(simd, 0.0);
            for direction in &gaps.directions(simd) {
                let squared = dot(direction, direction);
                let per_length = splat(simd, 1.0) / squared.max(splat(simd, TINY)).sqrt();
                let unit = [direction[0] * per_length, direction[1] * per_length, direction[2] * per_length];
                gap = gap.max(gaps.along(simd, &unit));
            }
            by(squares, gap)
        })
    }
}

impl<S: Simd> Patch<S> {
    /// How far it reaches from its centre along a direction of tree coordinates, at most.
    #[inline(always)]
    fn reach(&self, along: &Vector<S>) -> f32x8<S> {
        let (rest, multiple) = self.split(along);
        let of_slab = multiple * self.middle + multiple.abs() * self.half;
        (self.reach_of_box(&rest) + of_slab).min(self.reach_of_box(along))
    }
}

/// The lanes and the one, held against each other.
struct Gaps<'s, S: Simd> {
    many: &'s Side<'s>,
    lanes: Patch<S>,
    one: &'s Side<'s>,
    single: Patch<S>,
    /// From the centre of the one to those of the lanes.
    away: Vector<S>,
}

impl<'s, S: Simd> Gaps<'s, S> {
    #[inline(always)]
    fn new(
        simd: S,
        many: &'s Side<'s>,
        lanes: Patch<S>,
        one: &'s Side<'s>,
        single: Patch<S>,
        offset: DVec3,
    ) -> Self {
        let [x, y, z] = &single.center;
        let center =
            DVec3::new(f64::from(x.to_array()[0]), f64::from(y.to_array()[0]), f64::from(z.to_array()[0]));
        let from = (one.exact * center + offset).to_array();
        let mut away = product(simd, &many.linear, &lanes.center);
        for axis in 0..3 {
            away[axis] -= splat(simd, from[axis] as f32);
        }
        Gaps { many, lanes, one, single, away }
    }

    /// From centre to centre, and across each of the two slabs.
    #[inline(always)]
    fn directions(&self, simd: S) -> [Vector<S>; 3] {
        let across = product(simd, &self.one.cofactors, &self.single.normal);
        let across_lanes = product(simd, &self.many.cofactors, &self.lanes.normal);
        [self.away, across, across_lanes]
    }

    /// How far the lanes and the one are apart along unit vectors or against them, up to the margin: no more than their distances.
    #[inline(always)]
    fn along(&self, simd: S, unit: &Vector<S>) -> f32x8<S> {
        let height = dot(unit, &self.away);
        // From the one to the lanes.
        let back = height.simd_lt(splat(simd, 0.0));
        let unit =
            [back.select(-unit[0], unit[0]), back.select(-unit[1], unit[1]), back.select(-unit[2], unit[2])];
        let to_one = transposed_product(simd, &self.one.linear, &unit);
        let to_lanes = transposed_product(simd, &self.many.linear, &unit);
        let to_lanes = [-to_lanes[0], -to_lanes[1], -to_lanes[2]];
        height.abs() - self.single.reach(&to_one) - self.lanes.reach(&to_lanes)
    }
}

#[inline(always)]
fn product<S: Simd>(simd: S, rows: &[[f32; 3]; 3], v: &Vector<S>) -> Vector<S> {
    let mut sums = *v;
    for axis in 0..3 {
        let [a, b, c] = &rows[axis];
        sums[axis] = splat(simd, *a) * v[0] + splat(simd, *b) * v[1] + splat(simd, *c) * v[2];
    }
    sums
}
