//! The smallest program: two objects, one collision.

use solid3d::glam::{DAffine3, DVec3};
use solid3d::{Shape, World};

fn main() -> solid3d::Result<()> {
    let mut world = World::new();
    let ball = world.add(&Shape::sphere(0.5)?, DAffine3::from_translation(DVec3::Y))?;
    let floor = world.add(&Shape::cuboid([10.0, 1.0, 10.0])?, DAffine3::IDENTITY)?;
    for collision in world.test() {
        assert_eq!((collision.a, collision.b), (ball, floor));
        println!("{:?} meets {:?} at {:?}", collision.a, collision.b, collision.point());
    }
    Ok(())
}
