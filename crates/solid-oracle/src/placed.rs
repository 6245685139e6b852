use glam::{DAffine3, DVec3};

use crate::double_double::{DoubleDouble, Vec3};
use crate::exact::{Dyadic, ExactVec3};
use crate::shape::Convex;

/// A shape and the exact affine map that its placement is.
pub(crate) struct Placed<'a> {
    pub(crate) shape: &'a Convex,
    /// Columns of the linear part.
    columns: [DVec3; 3],
    exact_columns: [ExactVec3; 3],
    translation: DVec3,
    exact_translation: ExactVec3,
}

impl<'a> Placed<'a> {
    pub(crate) fn new(shape: &'a Convex, placement: &DAffine3) -> Self {
        let m = placement.matrix3;
        let columns = [m.x_axis, m.y_axis, m.z_axis];
        Self {
            shape,
            columns,
            exact_columns: columns.map(ExactVec3::from_f64),
            translation: placement.translation,
            exact_translation: ExactVec3::from_f64(placement.translation),
        }
    }

    pub(crate) fn translation(&self) -> DVec3 {
        self.translation
    }

    /// A local point where the placed shape reaches farthest along the world direction `d`.
    pub(crate) fn local_support(&self, d: Vec3) -> Vec3 {
        let [x, y, z] = self.columns.map(|column| Vec3::from_f64(column).dot(d));
        self.shape.support(Vec3::new(x, y, z))
    }

    /// The linear part of the placement.
    pub(crate) fn rotated(&self, p: Vec3) -> Vec3 {
        let [x, y, z] = self.columns.map(Vec3::from_f64);
        x * p.x + y * p.y + z * p.z
    }

    /// The world position of a local point.
    pub(crate) fn world(&self, p: &ExactVec3) -> ExactVec3 {
        let [x, y, z] = [0, 1, 2].map(|i| self.exact_columns[i].scaled_by(&p.0[i]));
        &(&x + &y) + &(&z + &self.exact_translation)
    }

    /// The world positions of the corners of a polytope.
    pub(crate) fn world_corners(&self) -> Vec<ExactVec3> {
        self.shape.corners().iter().map(|&p| self.world(&ExactVec3::from_f64(p))).collect()
    }

    /// An upper bound of `d . x` over the placed shape.
    fn support_value_up(&self, d: &ExactVec3) -> Dyadic {
        let g = ExactVec3([0, 1, 2].map(|i| self.exact_columns[i].dot(d)));
        &self.shape.support_value_up(&g) + &self.exact_translation.dot(d)
    }
}

/// A and B with what the queries ask of their Minkowski difference A-B.
pub(crate) struct PlacedPair<'a> {
    pub(crate) a: Placed<'a>,
    pub(crate) b: Placed<'a>,
    /// Translation of A minus that of B, exact in the digits kept.
    offset: Vec3,
}

/// A point of A-B and the local points it is the difference of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    a: Vec3,
    b: Vec3,
    pub(crate) w: Vec3,
}

impl<'a> PlacedPair<'a> {
    pub(crate) fn new(a: &'a Convex, pa: &DAffine3, b: &'a Convex, pb: &DAffine3) -> Self {
        let (a, b) = (Placed::new(a, pa), Placed::new(b, pb));
        let offset = Vec3::from_f64(a.translation()) - Vec3::from_f64(b.translation());
        Self { a, b, offset }
    }

    pub(crate) fn offset(&self) -> Vec3 {
        self.offset
    }

    /// The point of A-B that lies farthest along `d`, up to rounding.
    pub(crate) fn support(&self, d: Vec3) -> Vertex {
        let (a, b) = (self.a.local_support(d), self.b.local_support(-d));
        Vertex { a, b, w: self.a.rotated(a) - self.b.rotated(b) + self.offset }
    }

    /// The vertex as the exact difference of two points proven to lie in A and in B.
    pub(crate) fn proven(&self, vertex: &Vertex) -> Option<ExactVec3> {
        let a = self.a.shape.proven_inside(vertex.a)?;
        let b = self.b.shape.proven_inside(vertex.b)?;
        Some(&self.a.world(&a) - &self.b.world(&b))
    }

    /// A rigorous lower bound of the gap along `axis` (A above B), in units of length; negative where none is proven.
    pub(crate) fn gap_along(&self, axis: &ExactVec3) -> f64 {
        // The axis of an exact program may exceed the range of `f64`, with which hulls rule out most of their points.
        let axis = &axis.normalised();
        let gap = -&(&self.a.support_value_up(&-axis) + &self.b.support_value_up(axis));
        let length_squared = axis.length_squared();
        match gap.sign() {
            _ if length_squared.is_zero() => f64::NEG_INFINITY,
            0 => 0.0,
            1 => gap.div_down(&length_squared.sqrt_up()).round_down(),
            _ => gap.div_down(&length_squared.sqrt_down()).round_down(),
        }
    }

    /// The size of the largest coordinate the search meets, for tolerances.
    pub(crate) fn scale(&self) -> DoubleDouble {
        let reach = |d: DVec3| self.support(Vec3::from_f64(d)).w.to_f64().abs().max_element();
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        DoubleDouble::new(axes.iter().flat_map(|&d| [reach(d), reach(-d)]).fold(0.0, f64::max))
    }
}

/// A rigorous lower bound of the gap between the placed shapes along `axis`.
///
/// The gap is (least `axis . x` over A minus greatest `axis . y` over B) / |axis|: positive when the axis separates
/// with A on its side, negative by the overlap otherwise. The axis need not be a unit vector; along the zero vector
/// the bound is minus infinity. The bound is the greatest `f64` not above the gap for polytopes and unit axes, and
/// within one more ulp otherwise.
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use solid_oracle::{Convex, verify_axis};
/// let ball = Convex::Sphere { radius: 1.0 };
/// let above = DAffine3::from_translation(3.0 * DVec3::Z);
/// assert_eq!(verify_axis(&ball, &above, &ball, &DAffine3::IDENTITY, DVec3::Z), 1.0);
/// assert_eq!(verify_axis(&ball, &above, &ball, &DAffine3::IDENTITY, -DVec3::Z), -5.0);
/// ```
pub fn verify_axis(a: &Convex, pa: &DAffine3, b: &Convex, pb: &DAffine3, axis: DVec3) -> f64 {
    PlacedPair::new(a, pa, b, pb).gap_along(&ExactVec3::from_f64(axis))
}
