//! The kinds of shapes.

use std::fmt;

/// The kind of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShapeKind {
    /// A ball.
    Sphere,
    /// A box.
    Cuboid,
    /// A capped cone.
    Cone,
    /// A capped cylinder.
    Cylinder,
    /// A capsule.
    Capsule,
    /// The convex hull of points.
    ConvexHull,
    /// A surface of triangles, and nothing else.
    Mesh,
    /// A soup of convex primitives of other kinds, too.
    Complex,
}

impl ShapeKind {
    /// All kinds, for tests and tables that go through all pairs.
    pub const ALL: [ShapeKind; 8] = [
        ShapeKind::Sphere,
        ShapeKind::Cuboid,
        ShapeKind::Cone,
        ShapeKind::Cylinder,
        ShapeKind::Capsule,
        ShapeKind::ConvexHull,
        ShapeKind::Mesh,
        ShapeKind::Complex,
    ];
}

impl fmt::Display for ShapeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ShapeKind::Sphere => "sphere",
            ShapeKind::Cuboid => "box",
            ShapeKind::Cone => "cone",
            ShapeKind::Cylinder => "cylinder",
            ShapeKind::Capsule => "capsule",
            ShapeKind::ConvexHull => "convex hull",
            ShapeKind::Mesh => "mesh",
            ShapeKind::Complex => "complex shape",
        })
    }
}
