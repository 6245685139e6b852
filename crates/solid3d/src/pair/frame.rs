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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::Placed;
    use crate::pair::reach::{reach, world_bounds};
    use crate::shape::Shape;
    use glam::DQuat;
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::{in_cube, seeded};

    /// Turned, stretched and mirrored anyhow.
    fn linear(rng: &mut StdRng) -> DMat3 {
        let turn = |rng: &mut StdRng| {
            DMat3::from_quat(DQuat::from_axis_angle(in_cube(rng).normalize(), rng.random_range(0.0..6.0)))
        };
        let sizes = [(); 3].map(|()| 10f64.powf(rng.random_range(-2.0..2.0)));
        turn(rng) * DMat3::from_diagonal(DVec3::from_array(sizes)) * turn(rng)
    }

    /// Law: the common space is the same whichever of two comes first, also where they differ in some coordinates only, or in none.
    #[test]
    fn the_common_space_is_that_of_both() {
        let mut rng = seeded(184);
        for case in 0..200 {
            let [mut at_a, at_b] = [0, 1].map(|_| DAffine3 {
                matrix3: linear(&mut rng),
                translation: in_cube(&mut rng) * 10f64.powi(case % 9),
            });
            for axis in (0..3).filter(|axis| case >> axis & 1 == 1) {
                at_a.translation[axis] = at_b.translation[axis];
            }
            let shapes = [1.0, 2.0].map(|size| Shape::cuboid([size, 1.0, 3.0]).expect("it has a size"));
            let [reach_a, reach_b] = shapes.each_ref().map(reach);
            let [one, other] =
                [Frame::new(&at_a, reach_a, &at_b, reach_b), Frame::new(&at_b, reach_b, &at_a, reach_a)];
            let [of_b, of_a] = other.common;
            assert_eq!(
                (one.common, one.origin, one.scale),
                ([of_a, of_b], other.origin, other.scale),
                "{case}"
            );
            let [in_a, in_b] = [(0, &at_a), (1, &at_b)]
                .map(|(i, placement)| world_bounds(Placed { shape: &shapes[i], placement }));
            let one = Around::new([&at_a, &at_b], [reach_a, reach_b], [in_a, in_b]);
            let other = Around::new([&at_b, &at_a], [reach_b, reach_a], [in_b, in_a]);
            let [of_b, of_a] = other.common;
            assert_eq!(
                (one.common, one.origin, one.scale),
                ([of_a, of_b], other.origin, other.scale),
                "{case}"
            );
        }
    }

    /// Law: around two shapes, of whatever size and however far from their local origins, all of both has coordinates of a few units at most, and
    /// what positions are rounded there is said: next to nothing.
    #[test]
    fn all_is_near_in_the_space_around_two_shapes() {
        let mut rng = seeded(185);
        for case in 0..400 {
            let size = 10f64.powi(rng.random_range(-60..60));
            let far = [0.0, 1.0, 1e4, 1e9][case % 4] * size * in_cube(&mut rng);
            let apart = [0.0, 1.0, 1e3][case / 4 % 3] * size * in_cube(&mut rng);
            let mut corners =
                |place: DVec3| -> Vec<DVec3> { (0..8).map(|_| place + size * in_cube(&mut rng)).collect() };
            let corners = [corners(far), corners(far + apart)];
            let shapes =
                corners.each_ref().map(|corners| Shape::convex_hull(corners).expect("they are finite"));
            let at = DAffine3::IDENTITY;
            let bounds = shapes.each_ref().map(|shape| world_bounds(Placed { shape, placement: &at }));
            let around = Around::new([&at; 2], shapes.each_ref().map(reach), bounds);
            for (corners, common) in corners.iter().zip(&around.common) {
                for &corner in corners {
                    let image = common.transform_point3(corner);
                    assert!(image.abs().max_element() <= 4.0, "case {case}: {image}");
                    let off = around.to_world(image) - corner;
                    assert!(
                        (off * around.scale).abs().max_element() <= around.rounding,
                        "case {case}: {off}"
                    );
                }
            }
            assert!(around.rounding <= 1e-8, "case {case}: {}", around.rounding);
        }
    }

    /// Law: no distance in the common frame is less than is said, whichever is `A`: of two points, nor of two planes of one coordinate.
    #[test]
    fn nothing_is_nearer_than_the_stretch_says() {
        let mut rng = seeded(186);
        for case in 0..200 {
            let [at_a, at_b] = [0, 1].map(|_| DAffine3::from_mat3(linear(&mut rng)));
            let frame = Frame::new(&at_a, DVec3::ONE, &at_b, DVec3::ONE);
            for (common, stretch) in frame.common.iter().zip(frame.stretch()) {
                let grown = 1.0 + 1e-9;
                for _ in 0..20 {
                    let v = in_cube(&mut rng);
                    let length = (common.matrix3 * v).length() * grown;
                    assert!(length >= stretch.least * v.length(), "case {case}");
                    assert!((stretch.facets * v.abs()).max_element() <= length, "case {case}");
                }
                // Across a facet it is as much.
                for axis in 0..3 {
                    let across = common.matrix3.inverse().transpose().col(axis);
                    let v = common.matrix3.inverse() * (across / across.length_squared());
                    assert!((v[axis] - 1.0).abs() < 1e-6, "case {case}");
                    assert!((common.matrix3 * v).length() <= stretch.facets[axis] * grown, "case {case}");
                }
            }
        }
    }

    /// Law: the image of a point in the other space is as near to where it truly lies as is said, also where a placement flattens nearly all. Judged in
    /// whole numbers.
    #[test]
    fn an_image_is_as_exact_as_is_said() {
        let mut rng = seeded(187);
        let mut inexact = 0;
        for case in 0..1000 {
            let mut whole = |most: i64| [(); 3].map(|()| rng.random_range(-most..=most));
            let mut map = |is_flat: bool| {
                let (x, z, off) =
                    (whole(1 << 28), whole(1 << 28), whole(if is_flat { 1 << 8 } else { 1 << 28 }));
                [x, std::array::from_fn(|i| x[i] + off[i]), z]
            };
            let maps = [map(case % 2 == 0), map(case % 3 == 0)];
            let (places, point) = ([whole(1 << 40), whole(1 << 40)], whole(1000));
            let [at_a, at_b] = [0, 1].map(|i| DAffine3 {
                matrix3: DMat3::from_cols_array_2d(&maps[i].map(|column| column.map(|x| x as f64))),
                translation: DVec3::from_array(places[i].map(|x| x as f64)),
            });
            let cross = |p: [i64; 3], q: [i64; 3]| {
                [1, 2, 0].map(|i| {
                    i128::from(p[i]) * i128::from(q[(i + 1) % 3])
                        - i128::from(p[(i + 1) % 3]) * i128::from(q[i])
                })
            };
            let dot = |p: [i128; 3], q: [i128; 3]| -> i128 { (0..3).map(|i| p[i] * q[i]).sum() };
            let determinant = |m: &[[i64; 3]; 3]| dot(cross(m[0], m[1]), m[2].map(i128::from));
            if maps.iter().any(|map| determinant(map) == 0) {
                continue;
            }
            let reach = DVec3::splat(1000.0);
            let relative = Frame::new(&at_a, reach, &at_b, reach).relative();
            for (from, to, image, slack) in
                [(1, 0, relative.b_to_a, relative.slack_in_a), (0, 1, relative.a_to_b, relative.slack_in_b)]
            {
                let exact: [i128; 3] = std::array::from_fn(|i| {
                    let sum: i64 = (0..3).map(|k| maps[from][k][i] * point[k]).sum();
                    i128::from(sum + places[from][i] - places[to][i])
                });
                let image = image.transform_point3(DVec3::from_array(point.map(|x| x as f64)));
                let m = &maps[to];
                let rows = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
                for axis in 0..3 {
                    // To 2^-20, times the determinant.
                    let computed = (image[axis] * f64::from(1 << 20)) as i128 * determinant(m);
                    let off = (computed - (dot(rows[axis], exact) << 20)).unsigned_abs() as f64;
                    let off = off / determinant(m).unsigned_abs() as f64 / f64::from(1 << 20);
                    let resolution = 2.0 / f64::from(1 << 20);
                    assert!(off <= slack + resolution, "case {case}: {off:e}, not {slack:e}");
                    inexact += u32::from(off > 1e-4);
                }
            }
        }
        assert!(inexact > 500, "{inexact}");
    }
}
