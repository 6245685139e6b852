//! The axis-aligned bounding box.

use glam::{DAffine3, DVec3};

/// An axis-aligned box, closed: boxes that touch overlap.
///
/// An empty box has `min` above `max` in some coordinate. [`Aabb::EMPTY`] is the neutral element of [`union`](Aabb::union), overlaps nothing, and has
/// no centre; of other empty boxes nothing is promised.
///
/// ```
/// use solid3d::{Aabb, glam::DVec3};
/// let a = Aabb::new(DVec3::ZERO, DVec3::ONE);
/// let b = Aabb::new(DVec3::ONE, DVec3::splat(2.0));
/// assert!(a.overlaps(&b)); // they touch
/// assert_eq!(a.union(&b).max, DVec3::splat(2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the least coordinates.
    pub min: DVec3,
    /// The corner with the greatest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// Bounds nothing.
    pub const EMPTY: Aabb = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box between two opposite corners.
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Aabb { min, max }
    }

    /// The smallest box around points; [`Aabb::EMPTY`] for none.
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Aabb::EMPTY, |b, p| Aabb { min: b.min.min(p), max: b.max.max(p) })
    }

    /// Grows the box to hold a point, whose coordinates must be numbers.
    #[inline(always)]
    pub(crate) fn grow(&mut self, p: DVec3) {
        // Plain comparisons are one instruction each; `DVec3::min` also looks for what is not a number.
        let (least, greatest) = (&mut self.min, &mut self.max);
        least.x = if p.x < least.x { p.x } else { least.x };
        least.y = if p.y < least.y { p.y } else { least.y };
        least.z = if p.z < least.z { p.z } else { least.z };
        greatest.x = if p.x > greatest.x { p.x } else { greatest.x };
        greatest.y = if p.y > greatest.y { p.y } else { greatest.y };
        greatest.z = if p.z > greatest.z { p.z } else { greatest.z };
    }

    /// Whether two boxes share a point.
    #[inline(always)]
    pub fn overlaps(&self, other: &Aabb) -> bool {
        // Without a branch: of many pairs of boxes that are asked one after the other, nobody can foretell the answers.
        (0..3).fold(true, |is, k| is & (self.min[k] <= other.max[k]) & (other.min[k] <= self.max[k]))
    }

    /// How far apart two boxes are along each axis; 0 where their intervals overlap.
    pub fn gap(&self, other: &Aabb) -> DVec3 {
        (self.min - other.max).max(other.min - self.max).max(DVec3::ZERO)
    }

    /// Whether `other` lies in this box.
    pub fn contains(&self, other: &Aabb) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// The smallest box around two.
    pub fn union(&self, other: &Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box grown by `margin` on each side.
    pub fn inflated(&self, margin: f64) -> Aabb {
        Aabb { min: self.min - margin, max: self.max + margin }
    }

    /// The centre.
    pub fn center(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the size.
    pub fn half_extents(&self) -> DVec3 {
        0.5 * self.max - 0.5 * self.min
    }

    /// Half the surface area: the cost measure of the surface-area heuristic.
    pub fn half_area(&self) -> f64 {
        let d = self.max - self.min;
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The smallest box around the image of this box under an affine map, up to rounding.
    #[inline]
    pub fn transformed(&self, map: &DAffine3) -> Aabb {
        let center = map.transform_point3(self.center());
        let half = abs(&map.matrix3) * self.half_extents();
        Aabb { min: center - half, max: center + half }
    }
}

/// The matrix of absolute values.
#[inline(always)]
pub(crate) fn abs(m: &glam::DMat3) -> glam::DMat3 {
    glam::DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

#[cfg(test)]
mod tests {
    use glam::DMat3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: what boxes of a lattice are to each other is what its points tell, the gap between two and the sizes of one included.
    #[test]
    fn points_tell_what_boxes_are() {
        let mut rng = seeded(419);
        let lattice = || (0..64).map(|i| DVec3::from([i % 4, i / 4 % 4, i / 16].map(f64::from)));
        let mut met = 0;
        for _ in 0..2000 {
            let mut corner = || DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(0..4))));
            let [a, b] = [(); 2].map(|()| Aabb::of_points([corner(), corner()]));
            let holds = |of: &Aabb, p: DVec3| of.min.cmple(p).all() && p.cmple(of.max).all();
            let overlap = lattice().any(|p| holds(&a, p) && holds(&b, p));
            assert_eq!(a.overlaps(&b), overlap, "{a:?} {b:?}");
            assert_eq!(a.contains(&b), lattice().all(|p| holds(&a, p) || !holds(&b, p)), "{a:?} {b:?}");
            let gap = a.gap(&b);
            assert_eq!((gap == DVec3::ZERO, gap), (overlap, b.gap(&a)), "{a:?} {b:?}");
            // Where one is grown by the gap they touch; by less they do not.
            let most = gap.max_element();
            assert!(a.inflated(most).overlaps(&b) && (overlap || !b.inflated(most - 0.5).overlaps(&a)));
            let union = Aabb::of_points(lattice().filter(|&p| holds(&a, p) || holds(&b, p)));
            assert_eq!(a.union(&b), union);
            let mut grown = a;
            [b.min, b.max].into_iter().for_each(|p| grown.grow(p));
            assert_eq!(grown, union);
            assert_eq!([a.center() - a.half_extents(), a.center() + a.half_extents()], [a.min, a.max]);
            let size = a.max - a.min;
            assert_eq!(2.0 * a.half_area(), size.dot(DVec3::splat(size.element_sum()) - size), "{a:?}");
            met += usize::from(overlap);
        }
        assert!((600..1400).contains(&met), "{met}");
    }

    /// Law: the image of a box is the box around the images of its corners.
    #[test]
    fn an_image_holds_the_corners_alone() {
        let bounds = Aabb::new(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(3.0, 1.0, 2.0));
        let linear = DMat3::from_cols_array(&[1.0, -2.0, 0.5, 0.0, 3.0, -1.0, 4.0, 0.25, 2.0]);
        let map = DAffine3::from_mat3_translation(linear, DVec3::new(5.0, -6.0, 7.0));
        let corner =
            |i: usize| DVec3::from_array(std::array::from_fn(|k| [bounds.min, bounds.max][i >> k & 1][k]));
        let corners = (0..8).map(|i| map.transform_point3(corner(i)));
        assert_eq!(bounds.transformed(&map), Aabb::of_points(corners));
    }
}
