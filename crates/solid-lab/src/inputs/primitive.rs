use solid_oracle::Convex;
use solid3d::glam::DVec3;
use solid3d::{Result, Shape};

/// A primitive shape, as any library has it: around its centre, its axis along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// The radius.
    Sphere(f64),
    /// Full sizes.
    Cuboid(DVec3),
    /// The radius, and the length of the segment between the centres of the caps.
    Capsule(f64, f64),
}

impl Primitive {
    /// For the library.
    pub fn shape(self) -> Result<Shape> {
        match self {
            Primitive::Sphere(radius) => Shape::sphere(radius),
            Primitive::Cuboid(size) => Shape::cuboid(size),
            Primitive::Capsule(radius, height) => Shape::capsule(radius, height),
        }
    }

    /// For the oracle.
    pub fn convex(self) -> Convex {
        match self {
            Primitive::Sphere(radius) => Convex::Sphere { radius },
            Primitive::Cuboid(size) => Convex::Cuboid { half: size / 2.0 },
            Primitive::Capsule(radius, height) => Convex::Capsule { radius, half_height: height / 2.0 },
        }
    }
}
