use solid3d::Aabb;
use solid3d::glam::{DAffine3, DMat3, DVec3};
use solid3d::hull::Hull;

use super::eigen::{surface_axes, surface_mean};
use super::sat::Orientation;
use super::{Sat, Triangle, Volume};

/// What the axes of an oriented box are fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// The triangles as surfaces: what the package RAPID does, which the thesis measured.
    Surface,
    /// The surface of their convex hull, as the paper on RAPID proposes.
    Hull,
}

/// The box of an OBB tree. Space: at first that of the mesh, in a tree that of the parent's box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// The axes, as columns.
    rotation: DMat3,
    center: DVec3,
    half: DVec3,
}

/// Where box B lies in the frame of box A.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    rotation: DMat3,
    center: DVec3,
}

impl Volume for OrientedBox {
    type Options = Fit;
    type Shared = ();
    type Frame = Frame;

    fn fit(triangles: &[Triangle], members: &[u32], fit: Fit) -> Self {
        let surface = members.iter().map(|&i| triangles[i as usize]);
        let points = || surface.clone().flatten();
        let rotation = match fit {
            Fit::Surface => surface_axes(surface.clone()),
            Fit::Hull => {
                let points: Vec<DVec3> = points().collect();
                let hull = Hull::of(&points).expect("there are points");
                let facets = hull.triangles().iter().map(|t| t.map(|i| points[i as usize]));
                if hull.dimension() < 2 { surface_axes(surface.clone()) } else { surface_axes(facets) }
            }
        };
        let to_box = rotation.transpose();
        let bounds = Aabb::of_points(points().map(|p| to_box * p));
        OrientedBox { rotation, center: rotation * bounds.center(), half: bounds.half_extents() }
    }

    /// Across the longest axis at the mean of the surface, as RAPID does.
    fn split(&self, triangles: &[Triangle], members: &[u32]) -> (DVec3, f64) {
        let axis = self.rotation.col(self.half.max_position());
        let (mean, _) = surface_mean(members.iter().map(|&i| triangles[i as usize]));
        (axis, mean.dot(axis))
    }

    fn within(&self, parent: &Self) -> Self {
        let to_parent = parent.rotation.transpose();
        OrientedBox {
            rotation: to_parent * self.rotation,
            center: to_parent * (self.center - parent.center),
            half: self.half,
        }
    }

    fn size(&self) -> f64 {
        self.half.element_product()
    }

    fn shared(_: &DAffine3) {}

    fn frame(a: &Self, b: &Self, b_to_a: &DAffine3) -> Frame {
        let to_box = a.rotation.transpose();
        Frame {
            rotation: to_box * b_to_a.matrix3 * b.rotation,
            center: to_box * (b_to_a.transform_point3(b.center) - a.center),
        }
    }

    fn frame_in_child_a(frame: &Frame, child: &Self) -> Frame {
        let to_child = child.rotation.transpose();
        Frame { rotation: to_child * frame.rotation, center: to_child * (frame.center - child.center) }
    }

    fn frame_in_child_b(frame: &Frame, child: &Self) -> Frame {
        Frame {
            rotation: frame.rotation * child.rotation,
            center: frame.rotation * child.center + frame.center,
        }
    }

    fn exit_axis(a: &Self, b: &Self, (): &(), frame: &Frame, sat: Sat) -> usize {
        Orientation::new(&frame.rotation).exit_axis(a.half, b.half, frame.center, sat)
    }
}
