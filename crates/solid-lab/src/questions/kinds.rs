use parry3d_f64::math::Vector;
use parry3d_f64::shape::{
    Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, Shape as ParryShape, TriMesh,
};
use rand::rngs::StdRng;
use solid3d::Shape;
use solid3d::glam::DVec3;

use crate::inputs::{Mesh, direction};
use crate::peers::Effort;
use crate::peers::contestants::parry::double::vector;

/// A shape of some kind, in the types of both.
pub struct Kind {
    /// What it is called.
    pub name: &'static str,
    /// Ours.
    pub ours: Shape,
    /// parry's.
    pub theirs: Box<dyn ParryShape>,
}

/// One of each kind, about as large as each other.
///
/// # Panics
/// When a library refuses one.
pub fn all(effort: Effort, rng: &mut StdRng) -> Vec<Kind> {
    let corners: Vec<DVec3> = (0..20).map(|_| direction(rng)).collect();
    let torus = Mesh::torus(effort.size(5_000));
    let hull = ConvexPolyhedron::from_convex_hull(&vectors(&corners)).expect("the points have a hull");
    let mesh =
        TriMesh::new(vectors(&torus.vertices), torus.triangles.clone()).expect("the mesh is well formed");
    let kind = |name, ours: solid3d::Result<Shape>, theirs| Kind {
        name,
        ours: ours.expect("the sizes are valid"),
        theirs,
    };
    vec![
        kind("ball", Shape::sphere(0.8), Box::new(Ball::new(0.8))),
        kind("box", Shape::cuboid([1.2, 1.0, 0.8]), Box::new(Cuboid::new(Vector::new(0.6, 0.5, 0.4)))),
        kind("capsule", Shape::capsule(0.4, 1.0), Box::new(Capsule::new_y(0.5, 0.4))),
        kind("cylinder", Shape::cylinder(0.5, 1.4), Box::new(Cylinder::new(0.7, 0.5))),
        kind("cone", Shape::cone(0.6, 1.4), Box::new(Cone::new(0.7, 0.6))),
        kind("hull of 20", Shape::convex_hull(&corners), Box::new(hull)),
        kind("mesh of 5,000", Ok(torus.shape()), Box::new(mesh)),
    ]
}

/// Points, for parry.
pub fn vectors(points: &[DVec3]) -> Vec<Vector> {
    points.iter().map(|p| vector(*p)).collect()
}
