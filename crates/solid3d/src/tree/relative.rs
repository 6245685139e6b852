//! How two spaces lie to each other.

use crate::Aabb;
use glam::DAffine3;

/// The placement of a space `b` relative to a space `a`: any invertible affine map, mirrored or sheared as may be.
///
/// ```
/// use solid3d::{glam::{DAffine3, DVec3}, tree::Relative};
/// let b_to_a = DAffine3::from_translation(DVec3::X);
/// let relative = Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: 0.0, slack_in_b: 1e-15 };
/// assert_eq!(relative.swapped().b_to_a, relative.a_to_b);
/// assert_eq!(relative.swapped().slack_in_a, 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// Takes points of `b` to `a`.
    pub b_to_a: DAffine3,
    /// Takes points of `a` to `b`.
    pub a_to_b: DAffine3,
    /// How far, in any coordinate of `a`, the computed image of a point of a box of `b` may be from where it truly lies.
    /// The rounding of the queries themselves is not part of it.
    pub slack_in_a: f64,
    /// The same in `b` for points of boxes of `a`.
    pub slack_in_b: f64,
}

impl Relative {
    /// The same with `a` and `b` exchanged.
    pub fn swapped(&self) -> Relative {
        Relative {
            b_to_a: self.a_to_b,
            a_to_b: self.b_to_a,
            slack_in_a: self.slack_in_b,
            slack_in_b: self.slack_in_a,
        }
    }
}

/// A parallelepiped: a box of some space `b`, placed relative to the space `a` of a tree.
///
/// ```
/// use solid3d::{Aabb, glam::{DAffine3, DVec3}, tree::{PlacedBox, Relative, Traversal, Tree}};
/// use std::ops::ControlFlow;
/// let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE)]);
/// let b_to_a = DAffine3::from_rotation_z(0.5) * DAffine3::from_translation(DVec3::new(0.5, 0.0, 0.0));
/// let relative = Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: 1e-12, slack_in_b: 1e-12 };
/// let query = PlacedBox { bounds: Aabb::new(DVec3::ZERO, DVec3::ONE), relative };
/// let hit = tree.overlapping_box(&query, &mut Traversal::default(), |leaf| ControlFlow::Break(leaf[0]));
/// assert_eq!(hit, ControlFlow::Break(0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedBox {
    /// The box in its own space.
    pub bounds: Aabb,
    /// That space as `b`, and the tree's as `a`.
    pub relative: Relative,
}
