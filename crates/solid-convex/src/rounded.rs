//! Objects that are a core with a radius: spheres and capsules.

use glam::{DAffine3, DMat3, DVec3};

use crate::{Locus, Polytope, Support};

/// A placement turns balls into balls when its axes are as long as each other and at right angles up to this, relative to their
/// length squared: what is left of a rotation and a scale when it is rounded. By Gershgorin's circles no length is then off the scale by more than
/// one and a half of it, 6e-15 of a radius; the bounds of a depth leave 1.4e-14 of it open, and an error of a distance is far more. Placements that are more
/// skewed, as products of many rotations are, lose no more than this closed form.
const SIMILARITY_ERROR: f64 = 16.0 * f64::EPSILON;

/// The core of an object; of one that is not rounded, or no longer round where it is placed, the object itself.
pub(crate) struct Core<'a, S: ?Sized> {
    object: &'a S,
    /// The scale of the placement, when the object is rounded.
    scale: Option<f64>,
}

impl<'a, S: Support + ?Sized> Core<'a, S> {
    pub fn of(object: &'a S, placement: &DAffine3) -> Self {
        let rounded = object.core_radius() > 0.0;
        Core { object, scale: if rounded { similarity(&placement.matrix3) } else { None } }
    }

    /// What it is the core of.
    pub fn object(&self) -> &'a S {
        self.object
    }

    /// World units.
    pub fn radius(&self) -> f64 {
        self.scale.map_or(0.0, |scale| scale * self.object.core_radius())
    }

    /// From the core to the surface in a direction of the world. Space: local.
    pub fn to_surface(&self, placement: &DAffine3, direction: DVec3) -> DVec3 {
        let along = |scale: f64| placement.matrix3.transpose() * (direction / scale);
        self.scale.map_or(DVec3::ZERO, |scale| along(scale) * self.object.core_radius())
    }
}

impl<S: Support + ?Sized> Support for Core<'_, S> {
    fn support(&self, direction: DVec3) -> DVec3 {
        if self.scale.is_some() {
            self.object.core_support(direction)
        } else {
            self.object.support(direction)
        }
    }

    fn reach(&self) -> DVec3 {
        self.object.reach()
    }

    fn center(&self) -> DVec3 {
        self.object.center()
    }

    fn locus(&self, point: DVec3) -> Locus {
        if self.scale.is_some() { Locus::Point } else { self.object.locus(point) }
    }

    fn is_polytope(&self) -> bool {
        self.scale.is_some() || self.object.is_polytope()
    }

    fn as_polytope(&self) -> Option<&Polytope> {
        // None is rounded.
        self.object.as_polytope()
    }
}

/// The scale of a placement that is a rotation or mirroring and a scale, up to rounding.
fn similarity(linear: &DMat3) -> Option<f64> {
    let largest = linear.x_axis.abs().max_element();
    // Dividing first keeps the squares away from overflow and underflow.
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *linear * largest.recip();
    let square = x.length_squared();
    let [of_y, of_z] = [y, z].map(|axis| axis.length_squared() - square);
    let off = [of_y, of_z, x.dot(y), y.dot(z), z.dot(x)];
    off.iter().all(|part| part.abs() <= SIMILARITY_ERROR * square).then(|| square.sqrt() * largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;

    /// A ball is one under turns and scales; stretched along an axis, or sheared along another, by more than rounding, it is none.
    #[test]
    fn what_is_stretched_or_sheared_is_no_ball() {
        let ball = Sphere::new(1.0).unwrap();
        let is_round = |linear: DMat3| Core::of(&ball, &DAffine3::from_mat3(linear)).radius() > 0.0;
        let turn = DMat3::from_rotation_x(0.3) * DMat3::from_rotation_y(1.0);
        assert!([1e-90, 1e-9, -1.0, 1e90].iter().all(|&scale| is_round(turn * scale)));
        for i in 0..3 {
            let [axis, next] = [i, i + 1].map(|i| DVec3::AXES[i % 3]);
            let stretched = DMat3::from_diagonal(DVec3::ONE + axis * 1e-13);
            let mut sheared = DMat3::IDENTITY;
            *sheared.col_mut(i) += next * 1e-13;
            assert!(!is_round(turn * stretched) && !is_round(turn * sheared), "{axis}");
        }
    }
}
