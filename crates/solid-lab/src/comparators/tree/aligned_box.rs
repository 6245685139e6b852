use solid3d::Aabb;
use solid3d::glam::{DAffine3, DMat3, DVec3};

use super::sat::Orientation;
use super::{Child, Sat, Tree, Triangle, Volume};

/// The box of an AABB tree: its sides along the axes of the mesh, the whole tree in one frame. Centre and half size
/// are rounded, as in the original: what touches within an ulp may be lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignedBox {
    /// Of the mesh's space.
    pub center: DVec3,
    /// Half of its size.
    pub half: DVec3,
}

/// The placement of tree B in the frame of tree A, and what the separating-axes test needs of it: the same for all boxes.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    rotation: DMat3,
    translation: DVec3,
    orientation: Orientation,
}

impl From<Aabb> for AlignedBox {
    fn from(bounds: Aabb) -> Self {
        AlignedBox { center: bounds.center(), half: bounds.half_extents() }
    }
}

impl AlignedBox {
    /// The same as corners.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.center - self.half, self.center + self.half)
    }
}

impl Volume for AlignedBox {
    type Options = ();
    type Shared = Placed;
    type Frame = ();

    fn fit(triangles: &[Triangle], members: &[u32], (): ()) -> Self {
        Aabb::of_points(members.iter().flat_map(|&i| triangles[i as usize])).into()
    }

    /// Across the middle of the longest side.
    fn split(&self, _: &[Triangle], _: &[u32]) -> (DVec3, f64) {
        let axis = DVec3::AXES[self.half.max_position()];
        (axis, self.center.dot(axis))
    }

    fn size(&self) -> f64 {
        self.half.element_product()
    }

    fn shared(b_to_a: &DAffine3) -> Placed {
        let rotation = b_to_a.matrix3;
        Placed { rotation, translation: b_to_a.translation, orientation: Orientation::new(&rotation) }
    }

    fn frame(_: &Self, _: &Self, _: &DAffine3) {}

    fn frame_in_child_a((): &(), _: &Self) {}

    fn frame_in_child_b((): &(), _: &Self) {}

    fn exit_axis(a: &Self, b: &Self, placed: &Placed, (): &(), sat: Sat) -> usize {
        let t = placed.rotation * b.center + placed.translation - a.center;
        placed.orientation.exit_axis(a.half, b.half, t, sat)
    }
}

impl Tree<AlignedBox> {
    /// Fits the boxes to moved triangles, children before their parents (thesis, section 5.2.5).
    ///
    /// # Panics
    /// When there are not as many as before.
    pub fn refit(&mut self, triangles: &[Triangle]) {
        assert_eq!(triangles.len(), self.triangles.len(), "a refit keeps the triangles");
        self.triangles.copy_from_slice(triangles);
        for i in (0..self.nodes.len()).rev() {
            self.nodes[i].volume = match self.nodes[i].child {
                Child::Leaf(triangle) => Aabb::of_points(triangles[triangle as usize]),
                Child::Inner(first) => {
                    let [x, y] = [first as usize, first as usize + 1].map(|j| self.nodes[j].volume.bounds());
                    x.union(&y)
                }
            }
            .into();
        }
    }
}
