//! Bounding boxes and areas of a scene.

use glam::{DAffine3, DVec3};
use solid_scene::{Pose, Scene};
use solid3d::{Aabb, Shape, ShapeKind};

/// The radius of a ball, half of the size of a box, the radius and half of the height of a cone or a cylinder; nothing of other shapes.
pub fn sizes(shape: &Shape) -> Vec<f64> {
    let ball = shape.as_sphere().map(|it| vec![it.radius()]);
    let cuboid = shape.as_cuboid().map(|it| (0.5 * it.size()).to_array().to_vec());
    let cone = shape.as_cone().map(|it| vec![it.radius(), 0.5 * it.height()]);
    let cylinder = shape.as_cylinder().map(|it| vec![it.radius(), 0.5 * it.height()]);
    ball.or(cuboid).or(cone).or(cylinder).unwrap_or_default()
}

/// How far a shape reaches along a direction.
fn reach(shape: &Shape, direction: DVec3) -> f64 {
    let sizes = sizes(shape);
    let rim = |radius: f64| radius * direction.x.hypot(direction.z);
    match shape.kind() {
        ShapeKind::Sphere => sizes[0] * direction.length(),
        ShapeKind::Cuboid => DVec3::from_slice(&sizes).dot(direction.abs()),
        ShapeKind::Cylinder => rim(sizes[0]) + sizes[1] * direction.y.abs(),
        ShapeKind::Cone => (sizes[1] * direction.y).max(rim(sizes[0]) - sizes[1] * direction.y),
        _ => used(shape).map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max),
    }
}

/// The vertices of the triangles of a mesh; all vertices of a complex shape.
fn used(shape: &Shape) -> impl Iterator<Item = DVec3> {
    let vertices = shape.vertices().expect("a mesh or complex shape has vertices");
    let all = shape.triangles().is_none().then_some(0..vertices.len()).into_iter().flatten();
    let corners = shape.triangles().unwrap_or_default().iter().flatten().map(|&i| i as usize);
    corners.chain(all).map(|i| vertices[i])
}

/// The world bounds of all objects.
pub fn of_scene(scene: &Scene, pose: &Pose) -> Aabb {
    let each = scene.objects().iter().zip(&pose.objects);
    each.map(|(object, pose)| of_shape(object.shape(), &pose.placement))
        .fold(Aabb::EMPTY, |all, one| all.union(&one))
}

/// The bounds of a placed shape.
pub fn of_shape(shape: &Shape, placement: &DAffine3) -> Aabb {
    let rows = placement.matrix3.transpose();
    let along = |sign: f64| {
        let reach = |row: DVec3| sign * reach(shape, sign * row);
        DVec3::new(reach(rows.x_axis), reach(rows.y_axis), reach(rows.z_axis)) + placement.translation
    };
    Aabb::new(along(-1.0), along(1.0))
}

/// The triangles of a placed mesh or box; `None` for other shapes.
pub fn triangles(shape: &Shape, placement: &DAffine3) -> Option<Vec<[DVec3; 3]>> {
    let local = match shape.kind() {
        ShapeKind::Mesh => {
            let vertices = shape.vertices()?;
            shape.triangles()?.iter().map(|t| t.map(|i| vertices[i as usize])).collect()
        }
        ShapeKind::Cuboid => box_triangles(DVec3::from_slice(&sizes(shape))),
        _ => return None,
    };
    let place = |triangle: [DVec3; 3]| triangle.map(|p| placement.transform_point3(p));
    Some(Vec::into_iter(local).map(place).collect())
}

fn box_triangles(half: DVec3) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let corner = |u: f64, v: f64| {
                let mut corner = DVec3::ZERO;
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (sign, u, v);
                corner * half
            };
            triangles.push([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)]);
            triangles.push([corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
        }
    }
    triangles
}

pub fn area([a, b, c]: &[DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() / 2.0
}
