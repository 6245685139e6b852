//! The support mapping.

use glam::DVec3;

/// A convex object, known by its support mapping. Space: the object's own.
///
/// Laws, for every direction `d` and every point `x` of the object:
/// `d.dot(support(d)) >= d.dot(x)` up to a rounding error of a few ulps, `support(d)` is a point of the object up to
/// the same, and `reach()` bounds the magnitude of each coordinate.
pub trait Support: Send + Sync {
    /// A point of the object that lies furthest along `direction`, which need not be a unit vector. Any point of the
    /// object for the zero direction. The same direction gives the same point, always.
    fn support(&self, direction: DVec3) -> DVec3;

    /// The largest magnitude of each coordinate over the object.
    fn reach(&self) -> DVec3;

    /// A point of the object, well inside when it has an inside: where a search starts.
    fn center(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// Whether it is the hull of finitely many points, which its support points are: then a search among them ends with the exact answer.
    fn is_polytope(&self) -> bool {
        false
    }

    /// The three half edges of a parallelepiped around its [`center`](Support::center), when the object is one.
    fn half_edges(&self) -> Option<[DVec3; 3]> {
        None
    }

    /// The object is all that is within this distance of its core; 0 for one that is its own core.
    fn core_radius(&self) -> f64 {
        0.0
    }

    /// A support point of the core, a polytope that the object is rounded from: of a ball its centre.
    fn core_support(&self, direction: DVec3) -> DVec3 {
        self.support(direction)
    }
}

/// `-magnitude` for negative `sign`, else `magnitude`: the thesis's sgn, which is 1 at 0.
pub(crate) fn with_sign(magnitude: f64, sign: f64) -> f64 {
    if sign < 0.0 { -magnitude } else { magnitude }
}

/// The point at distance `radius` from the axis y in the direction (x, z); on the axis when there is none.
pub(crate) fn rim(radius: f64, x: f64, z: f64) -> (f64, f64) {
    let largest = x.abs().max(z.abs());
    if largest == 0.0 {
        return (0.0, 0.0);
    }
    // Dividing first keeps the squares away from overflow and underflow.
    let (x, z) = (x / largest, z / largest);
    let scale = radius / (x * x + z * z).sqrt();
    (x * scale, z * scale)
}
