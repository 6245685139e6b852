//! How two placed spaces lie to each other, with the error of it.

use glam::{DAffine3, DMat3, DVec3};
use solid_convex::{gjk, unit_scale};

use super::reach::image_reach;
use crate::bounds::Aabb;
use crate::placement::{inverse_linear, row_norm};
use crate::tree::{PairMetric, Relative};

/// Roundings of 2^-53, relative to the size of the data, that lie between a local point and its image in another local
/// space: two products with matrices, three translations, and the products that made the matrices.
pub(super) const ROUNDINGS: f64 = 64.0 / (1u64 << 53) as f64;

/// The unit of a space around shapes is at least this part of the size of the data: by that much, positions are rounded less than what counts as
/// one place in such a unit.
const UNIT_MIN: f64 = 1.0 / (1u64 << 18) as f64;

/// Beyond what any shape that matters to the size of the data has; less is as valid a bound, and never infinite.
const STRETCH_MAX: f64 = 1e200;

/// Two placed spaces `A` and `B`, and how far the shapes in them reach from their origins.
pub(super) struct Frame {
    /// Takes points of `B` to `A`.
    pub b_to_a: DAffine3,
    /// How far, in any coordinate of `A`, the computed image of a point of `B` may be from where it truly lies.
    pub slack_in_a: f64,
    /// Takes points of either space to one where exact predicates neither overflow nor underflow: the world's axes, the origin of that of the
    /// two which comes first by its coordinates, and a unit of length that is a power of two near the size of the data. So it is the same space
    /// whichever is `A`.
    pub common: [DAffine3; 2],
    /// The origin of that space, in the world.
    origin: DVec3,
    /// World lengths times this are lengths of the common frame.
    pub scale: f64,
    /// The linear parts of the placements of `A` and `B`, and the inverse of the first.
    linear_a: DMat3,
    linear_b: DMat3,
    inverse_a: DMat3,
    /// The origin of `A` from that of `B`, in the world.
    offset: DVec3,
    /// The size of the data.
    size: f64,
}

/// How lengths change from a local space to the common frame.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    /// A slab one local unit thick along each local axis is this thick in the common frame.
    pub facets: DVec3,
    /// A local distance of one is at least this in the common frame.
    pub least: f64,
}

impl Frame {
    #[inline(always)]
    pub fn new(at_a: &DAffine3, reach_a: DVec3, at_b: &DAffine3, reach_b: DVec3) -> Frame {
        let size = size([at_a, at_b], [reach_a, reach_b]);
        Frame::scaled(at_a, at_b, size, unit_scale(size))
    }

    /// Of data of a given size, in a unit of which world lengths times `scale` are lengths: no less than near the size, and no more than some times it.
    #[inline(always)]
    pub fn scaled(at_a: &DAffine3, at_b: &DAffine3, size: f64, scale: f64) -> Frame {
        let inverse_a = inverse_linear(&at_a.matrix3);
        let offset = at_a.translation - at_b.translation;
        let (origin, [from_a, from_b]) = if comes_first(offset) {
            (at_a.translation, [DVec3::ZERO, -offset * scale])
        } else {
            (at_b.translation, [offset * scale, DVec3::ZERO])
        };
        let common = [
            DAffine3 { matrix3: at_a.matrix3 * scale, translation: from_a },
            DAffine3 { matrix3: at_b.matrix3 * scale, translation: from_b },
        ];
        Frame {
            b_to_a: DAffine3 { matrix3: inverse_a * at_b.matrix3, translation: inverse_a * -offset },
            slack_in_a: slack(&at_a.matrix3, &inverse_a, size),
            common,
            origin,
            scale,
            linear_a: at_a.matrix3,
            linear_b: at_b.matrix3,
            inverse_a,
            offset,
            size,
        }
    }

    /// Takes points of either space to the other. Of what is convex, where it is in the space of a mesh is mostly enough.
    #[inline(always)]
    pub fn relative(&self) -> Relative {
        let Frame { linear_a, linear_b, .. } = self;
        let inverse_b = inverse_linear(linear_b);
        Relative {
            b_to_a: self.b_to_a,
            a_to_b: DAffine3 { matrix3: inverse_b * *linear_a, translation: inverse_b * self.offset },
            slack_in_a: self.slack_in_a,
            slack_in_b: slack(linear_b, &inverse_b, self.size),
        }
    }

    /// How far a placed point may be from where it truly lies, along the axes of the world.
    pub fn rounding(&self) -> f64 {
        ROUNDINGS * self.size
    }

    /// Takes a point of the common frame to the world.
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        point / self.scale + self.origin
    }

    /// Bounds on how distances local to `A` and `B` show in the common frame.
    pub fn stretch(&self) -> [Stretch; 2] {
        [self.stretch_of_a(), self.stretch_of_b()]
    }

    /// The same, of `A` alone.
    pub fn stretch_of_a(&self) -> Stretch {
        Stretch::new(&self.inverse_a, self.scale)
    }

    /// The same, of `B` alone.
    pub fn stretch_of_b(&self) -> Stretch {
        Stretch::new(&inverse_linear(&self.linear_b), self.scale)
    }

    /// A length of the common frame beyond a world length and the error of what is computed there: a search for what is below it
    /// finds all up to the world length. The size of the data is at most two there.
    pub fn beyond(&self, length: f64) -> f64 {
        length * self.scale * (1.0 + gjk::TOUCHING_ERROR) + 2.0 * gjk::TOUCHING_ERROR
    }
}

/// A common space around two shapes, with a unit near their sizes: they may lie far from their local origins, as what is given in coordinates of
/// the earth. It is the same whichever is the first.
pub(super) struct Around {
    /// Takes local points of each to that space, which has the world's axes.
    pub common: [DAffine3; 2],
    /// The origin of that space, in the world.
    origin: DVec3,
    /// World lengths times this are lengths of that space; a power of two.
    pub scale: f64,
    /// How far a placed point may be from where it truly lies, in that space.
    pub rounding: f64,
}

impl Around {
    /// Of shapes that reach so far from their local origins, and are within these boxes of the world.
    pub fn new(at: [&DAffine3; 2], reach: [DVec3; 2], bounds: [Aabb; 2]) -> Around {
        let [center_a, center_b] = bounds.map(|bounds| bounds.center());
        let [half_a, half_b] = bounds.map(|bounds| bounds.half_extents().max_element());
        let between = center_a - center_b;
        let near = half_a + half_b + between.abs().max_element();
        let size = size(at, reach);
        let scale = unit_scale(near.max(UNIT_MIN * size));
        let origin = if comes_first(between) { center_a } else { center_b };
        let common = at.map(|at| DAffine3 {
            matrix3: at.matrix3 * scale,
            translation: (at.translation - origin) * scale,
        });
        Around { common, origin, scale, rounding: ROUNDINGS * size * scale }
    }

    /// Takes a point to the world.
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        point / self.scale + self.origin
    }
}

/// The size of the data: how far two placed shapes reach from their local origins, and how far apart these are.
#[inline(always)]
pub(super) fn size([at_a, at_b]: [&DAffine3; 2], [reach_a, reach_b]: [DVec3; 2]) -> f64 {
    image_reach(&at_a.matrix3, reach_a).max_element()
        + image_reach(&at_b.matrix3, reach_b).max_element()
        + (at_a.translation - at_b.translation).abs().max_element()
}

/// Whether what is so far from another comes before it, by the first coordinate in which they differ.
#[inline(always)]
fn comes_first(offset: DVec3) -> bool {
    let DVec3 { x, y, z } = offset;
    x < 0.0 || (x == 0.0 && (y < 0.0 || (y == 0.0 && z <= 0.0)))
}

/// The error of a world point of magnitude `size`, taken to local space by an inverse that has an error of its own.
#[inline(always)]
pub(super) fn slack(linear: &DMat3, inverse: &DMat3, size: f64) -> f64 {
    let norm = row_norm(inverse);
    ROUNDINGS * norm * (1.0 + norm * row_norm(linear)) * size
}

impl Stretch {
    /// Of what is bounded in the other space, and has no lengths of its own.
    pub const NONE: Stretch = Stretch { facets: DVec3::ZERO, least: 0.0 };

    /// What bounds distances of two trees in the common frame.
    pub fn metric(&self, other: &Stretch) -> PairMetric {
        PairMetric {
            facet_a: self.facets,
            facet_b: other.facets,
            sigma_min_a: self.least,
            sigma_min_b: other.least,
        }
    }

    fn new(inverse: &DMat3, scale: f64) -> Stretch {
        // Rows of the inverse are the facet normals; those of its Gram matrix bound its largest singular value.
        let rows = inverse.transpose();
        let facets = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()).recip();
        let gram = *inverse * rows;
        let least = row_norm(&gram).sqrt().recip();
        Stretch {
            facets: (facets * scale).min(DVec3::splat(STRETCH_MAX)),
            least: (least * scale).min(STRETCH_MAX),
        }
    }
}
