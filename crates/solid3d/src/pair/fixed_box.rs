//! The fixed-size box: large enough to enclose a rigid object in any orientation (thesis, section 6.5).

use glam::{DAffine3, DVec3};

use super::reach::bounds_margin;
use crate::bounds::Aabb;

/// A map is rigid up to a uniform scale when no direction is stretched more than another by a larger part than this.
/// Rotations that were composed a million times have an error of some 1e-10; beyond it the box is still right, only larger.
const ANISOTROPY_MAX: f64 = 1e-6;

/// Bits of a scale that are kept when it is rounded up: so many that the box is larger by 1e-6, and so few that the rounding
/// error of a rotation does not show, and the size of the box stays the same to the bit.
const SCALE_BITS: u32 = 20;

/// More than the rounding error of a scale, relative: one that is exactly a number of so few bits, like 1, is then rounded to
/// the next, whatever its error.
const SCALE_ROUNDINGS: f64 = 1e-12;

/// A box of the world around everything within `radius` of the local origin of a placed object: a cube whose size depends on
/// the scale alone. `None` when the placement is not rigid up to a uniform scale.
pub(crate) fn fixed_bounds(placement: &DAffine3, radius: f64) -> Option<Aabb> {
    let half = radius * scale(placement)?;
    let margin = bounds_margin(half + 1e-3 * placement.translation.abs().max_element());
    let center = Aabb::new(placement.translation, placement.translation);
    Some(center.inflated(half).inflated(margin))
}

/// How much a placement stretches lengths at most, rounded up; `None` when some directions more than others.
fn scale(placement: &DAffine3) -> Option<f64> {
    let linear = &placement.matrix3;
    let unit = linear.x_axis.length();
    // How far the Gram matrix is from a multiple of the identity, by the sums over its rows.
    let gram = linear.transpose() * *linear;
    let skew = DVec3::new(gram.x_axis.y, gram.y_axis.z, gram.z_axis.x).abs().element_sum();
    let diagonal = DVec3::new(gram.x_axis.x, gram.y_axis.y, gram.z_axis.z) - unit * unit;
    let off = (skew + diagonal.abs().max_element()) / (unit * unit);
    // The eigenvalues, in units of the first diagonal entry, lie within `off` of 1; so do their roots, but for rounding.
    (off <= ANISOTROPY_MAX).then(|| rounded_up(unit * (1.0 + 2.0 * off + SCALE_ROUNDINGS)))
}

/// The next number of [`SCALE_BITS`] bits after the first. `x` must be positive and normal.
fn rounded_up(x: f64) -> f64 {
    let dropped = (1u64 << (52 - SCALE_BITS)) - 1;
    f64::from_bits((x.to_bits() + dropped) & !dropped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::Placed;
    use crate::pair::reach::world_bounds;
    use crate::shape::Shape;
    use glam::{DMat3, DQuat};
    use rand::Rng;
    use solid_oracle::generate::seeded;

    /// Law: a rotation does not change the box, to the bit.
    #[test]
    fn a_rotation_keeps_the_box() {
        let mut rng = seeded(900);
        for scale in [1.0, 3.7, 1e-100, 1e100, 0.1] {
            let at = |q: DQuat| DAffine3 {
                matrix3: DMat3::from_quat(q) * scale,
                translation: DVec3::new(1.0, 2.0, 3.0) * scale,
            };
            let expected = fixed_bounds(&at(DQuat::IDENTITY), 2.0);
            let size = expected.map(|bounds| bounds.half_extents().x / (2.0 * scale));
            assert!(size.is_some_and(|size| (1.0..1.0 + 3e-6).contains(&size)), "{size:?}");
            for _ in 0..1000 {
                let q = DQuat::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
                assert_eq!(fixed_bounds(&at(q.normalize()), 2.0), expected);
            }
        }
    }

    #[test]
    fn what_is_not_rigid_has_none() {
        for factors in [[1.0, 1.0, 1.1], [1.00001, 1.0, 1.0], [1e-100, 1.0, 1.0], [1.0, 1e100, 1.0]] {
            assert_eq!(fixed_bounds(&DAffine3::from_scale(DVec3::from_array(factors)), 1.0), None);
        }
        for (axis, along) in [(0, 1), (1, 2), (2, 0)] {
            for shear in [1e-5, -1e-5] {
                let mut sheared = DAffine3::IDENTITY;
                sheared.matrix3.col_mut(along)[axis] = shear;
                assert_eq!(fixed_bounds(&sheared, 1.0), None, "{sheared}");
            }
        }
        assert!(fixed_bounds(&DAffine3::from_scale(DVec3::new(-2.0, 2.0, 2.0)), 1.0).is_some());
    }

    /// Law: the box holds that around what is within the radius, near and far, also where some directions are stretched by a little more than others.
    #[test]
    fn all_within_the_radius_is_in_the_box() {
        let mut rng = seeded(901);
        let mut stretched = 0;
        for case in 0..1000 {
            let [y, z] = [0, 1].map(|_| 1.0 + 4e-7 * rng.random_range(-1.0..1.0) * f64::from(case % 2));
            let scale = rng.random_range(1.0..2.0) * DVec3::new(1.0, y, z);
            let far = DVec3::splat(10f64.powi([0, 3, 11, 13][case as usize / 2 % 4]));
            let placement = DAffine3 { translation: far, ..DAffine3::from_scale(scale) };
            let fixed = fixed_bounds(&placement, 0.5).expect("it is as good as rigid");
            let ball = Shape::sphere(0.5).expect("it has a size");
            let bounds = world_bounds(Placed { shape: &ball, placement: &placement });
            assert!(fixed.contains(&bounds), "case {case}: {fixed:?} {bounds:?}");
            stretched += usize::from(scale.max_element() > scale.x);
        }
        assert!(stretched > 300);
    }
}
