//! How much of all directions a triangle takes.

use glam::DVec3;
use libm::atan2;

use crate::placement::direction;

/// Half of the solid angle of a triangle seen from the origin; positive when its corners run clockwise there, that is, when it
/// shows its back. 0 where the origin is a corner.
pub(crate) fn half_solid_angle(corners: [DVec3; 3]) -> f64 {
    // Only directions count; unit vectors stay in range whatever the unit of length.
    let [Some(a), Some(b), Some(c)] = corners.map(direction) else { return 0.0 };
    // Next to an edge its ends are seen in opposite directions, whose sum is what is left of them.
    let [a, b, c] = [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min_by(|[a, b, _], [p, q, _]| a.dot(*b).total_cmp(&p.dot(*q)))
        .expect("there are three edges");
    let left = a + b;
    atan2(left.dot(b.cross(c)), 0.5 * left.length_squared() + c.dot(left))
}
