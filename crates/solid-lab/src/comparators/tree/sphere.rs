use solid3d::Aabb;
use solid3d::glam::{DAffine3, DVec3};

use super::eigen::{surface_axes, surface_mean};
use super::{Sat, Triangle, Volume};

/// The ball of a sphere tree. Space: that of the mesh; the map between two meshes must keep lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    center: DVec3,
    radius: f64,
}

impl Ball {
    fn grow(&mut self, p: DVec3) {
        let distance = self.center.distance(p);
        if distance > self.radius {
            // The smallest ball around the old one and the point.
            let radius = 0.5 * (self.radius + distance);
            self.center = p + (self.center - p) * (radius / distance);
            self.radius = radius;
        }
    }
}

impl Volume for Ball {
    type Options = ();
    type Shared = DAffine3;
    type Frame = ();

    /// From the farthest two of the extreme points along the principal axes, grown by what is outside (thesis, section 5.2.1).
    fn fit(triangles: &[Triangle], members: &[u32], (): ()) -> Self {
        let points = || members.iter().flat_map(|&i| triangles[i as usize]);
        let axes = surface_axes(members.iter().map(|&i| triangles[i as usize]));
        let extremes = |axis: DVec3| {
            let along = |p: &DVec3, q: &DVec3| p.dot(axis).total_cmp(&q.dot(axis));
            let some = "a volume has triangles";
            [points().min_by(along).expect(some), points().max_by(along).expect(some)]
        };
        let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis].map(extremes);
        let longer =
            |p: [DVec3; 2], q: [DVec3; 2]| if q[0].distance(q[1]) > p[0].distance(p[1]) { q } else { p };
        let [from, to] = longer(longer(x, y), z);
        let mut ball = Ball { center: 0.5 * (from + to), radius: 0.5 * from.distance(to) };
        points().for_each(|p| ball.grow(p));
        ball
    }

    /// Across the longest side of the box, at the mean.
    fn split(&self, triangles: &[Triangle], members: &[u32]) -> (DVec3, f64) {
        let bounds = Aabb::of_points(members.iter().flat_map(|&i| triangles[i as usize]));
        let axis = DVec3::AXES[bounds.half_extents().max_position()];
        let (mean, _) = surface_mean(members.iter().map(|&i| triangles[i as usize]));
        (axis, mean.dot(axis))
    }

    fn size(&self) -> f64 {
        self.radius
    }

    fn shared(b_to_a: &DAffine3) -> DAffine3 {
        *b_to_a
    }

    fn frame(_: &Self, _: &Self, _: &DAffine3) {}

    fn frame_in_child_a((): &(), _: &Self) {}

    fn frame_in_child_b((): &(), _: &Self) {}

    fn exit_axis(a: &Self, b: &Self, b_to_a: &DAffine3, (): &(), _: Sat) -> usize {
        let reach = (a.radius + b.radius) * (1.0 + ROUNDING);
        usize::from(b_to_a.transform_point3(b.center).distance_squared(a.center) > reach * reach)
    }
}

/// Balls are larger by this, so that a grown one contains what it was grown to: some roundings for each point of a mesh.
const ROUNDING: f64 = 1e-12;
