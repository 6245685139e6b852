//! The convex kinds of SOLID, one file each (thesis, sections 2.1.2, 2.1.3 and 4.4.2).

mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod image;
mod points;
mod polytope;
mod sphere;

pub use capsule::Capsule;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use points::{IndexedPoints, Points};
pub(crate) use polytope::Passage;
pub use polytope::{FaceTowards, Polytope};
pub use sphere::Sphere;
pub(crate) use sphere::ball_support;
