//! Whether something lies wholly inside a solid mesh (thesis, section 3.1.2).
//!
//! Asked only when the surfaces do not meet: then a connected part of a shape is inside a solid if any one of its points is.
//! A soup may consist of several parts, so one point of each is tested. All points are those of the common frame of the
//! pair, in which the surfaces were tested, and every decision there is exact.

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use solid_convex::simd::each;

use super::Scratch;
use super::crossing::crossing;
use super::frame::Frame;
use super::reach::image_reach;
use crate::bounds::Aabb;
use crate::exact::plain;
use crate::shape::Complex;
use crate::tree::{PlacedBox, Relative};

/// A solid mesh in the common frame of a pair.
pub(super) struct PlacedSolid<'a> {
    mesh: &'a Complex,
    to_common: &'a DAffine3,
    /// The mesh's space and the common frame, which is `b` here.
    relative: Relative,
    /// A bound on the coordinates of the mesh in the common frame: where rays end.
    beyond: f64,
}

impl<'a> PlacedSolid<'a> {
    /// `None` for what is not solid.
    pub fn new(mesh: &'a Complex, to_common: &'a DAffine3) -> Option<Self> {
        mesh.is_solid().then(|| {
            let reach = image_reach(&to_common.matrix3, mesh.reach()) + to_common.translation.abs();
            let beyond = 2.0 * reach.max_element();
            let frame = Frame::new(to_common, mesh.reach(), &DAffine3::IDENTITY, DVec3::splat(beyond));
            PlacedSolid { mesh, to_common, relative: frame.relative(), beyond }
        })
    }

    /// Whether a point of the common frame is in the solid. The walk goes along a ray from the point: by the triangles that
    /// it crosses, the winding number is counted.
    pub fn contains(&self, point: DVec3, scratch: &mut Scratch) -> bool {
        let point = plain(point);
        let bounds = self.mesh.bounds().inflated(self.relative.slack_in_a);
        let local = self.relative.b_to_a.transform_point3(point);
        if !bounds.contains(&Aabb::new(local, local)) {
            return false;
        }
        let ray = Aabb::of_points([point, DVec3::new(self.beyond, point.y, point.z)]);
        let query = PlacedBox { bounds: ray, relative: self.relative };
        let Scratch { traversal, primitive_tests, .. } = scratch;
        let mut winding = 0;
        let on_surface = self.mesh.tree().overlapping_box(&query, traversal, |leaf| {
            for &primitive in leaf {
                *primitive_tests += 1;
                match crossing(&self.triangle(primitive), point) {
                    Some(count) => winding += count,
                    None => return ControlFlow::Break(()),
                }
            }
            ControlFlow::Continue(())
        });
        on_surface.is_break() || winding != 0
    }

    fn triangle(&self, primitive: u32) -> [DVec3; 3] {
        let indices = self.mesh.primitive(primitive);
        each([0, 1, 2], |i| plain(self.to_common.transform_point3(self.mesh.vertices()[indices[i] as usize])))
    }
}

/// A vertex, in its own space, of a part of `other` that is in the solid; for surfaces that do not meet.
pub(super) fn part_inside(
    solid: &PlacedSolid,
    other: &Complex,
    other_to_common: &DAffine3,
    scratch: &mut Scratch,
) -> Option<DVec3> {
    let vertices = other.parts().iter().map(|&index| other.vertices()[index as usize]);
    let mut inside = |&v: &DVec3| solid.contains(other_to_common.transform_point3(v), scratch);
    vertices.into_iter().find(|v| inside(v))
}
