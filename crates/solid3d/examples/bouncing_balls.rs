//! Balls in a box that bounce off each other and the walls, by smart response: the normal of a contact comes from the
//! previous frame, in which the objects were apart. A frame ends when nothing collides (thesis, section 6.3.3).

use solid3d::glam::{DAffine3, DVec3};
use solid3d::{ObjectId, Response, Shape, World};
use std::collections::BTreeMap;

struct Body {
    position: DVec3,
    velocity: DVec3,
}

const STEP: f64 = 1.0 / 60.0;

fn main() -> solid3d::Result<()> {
    let mut world = World::new();
    world.set_default_response(Response::Smart);
    let walls = add_walls(&mut world)?;
    let mut bodies = add_balls(&mut world)?;
    let energy_before = energy(&bodies);

    let mut bounces = 0;
    for _ in 0..600 {
        for (&id, body) in &bodies {
            world.set_placement(id, DAffine3::from_translation(body.position + body.velocity * STEP))?;
        }
        // Who collides bounces and stays where it was, where nothing collided. That may be in the way of others, so test again.
        let mut collisions = world.test();
        while !collisions.is_empty() {
            for collision in collisions {
                bounces += 1;
                let normal = collision.normal().expect("in the previous frame nothing collided");
                bounce(&mut bodies, collision.a, collision.b, normal);
                for id in [collision.a, collision.b] {
                    if let Some(body) = bodies.get(&id) {
                        world.set_placement(id, DAffine3::from_translation(body.position))?;
                    }
                }
            }
            collisions = world.test();
        }
        for (&id, body) in &mut bodies {
            body.position = world.placement(id)?.translation;
        }
        world.proceed();
    }

    println!("{} balls between {} walls bounced {bounces} times", bodies.len(), walls.len());
    println!("energy {energy_before:.3} before, {:.3} after", energy(&bodies));
    assert!(bounces > 100);
    assert!((energy(&bodies) - energy_before).abs() < 1e-6 * energy_before);
    assert!(bodies.values().all(|body| body.position.abs().max_element() < 6.0), "none escaped");
    Ok(())
}

/// Six slabs around a room of 10 x 10 x 10.
fn add_walls(world: &mut World) -> solid3d::Result<Vec<ObjectId>> {
    let slab = Shape::cuboid([14.0, 2.0, 14.0])?;
    let outward = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let walls: solid3d::Result<Vec<_>> = outward
        .into_iter()
        .map(|direction| {
            let turn = solid3d::glam::DQuat::from_rotation_arc(DVec3::Y, direction);
            world.add(&slab, DAffine3::from_rotation_translation(turn, direction * 6.0))
        })
        .collect();
    let walls = walls?;
    for (i, &a) in walls.iter().enumerate() {
        for &b in &walls[..i] {
            world.clear_pair_response(a, b)?;
        }
    }
    Ok(walls)
}

fn add_balls(world: &mut World) -> solid3d::Result<BTreeMap<ObjectId, Body>> {
    let ball = Shape::sphere(0.6)?;
    let mut bodies = BTreeMap::new();
    for i in 0..27 {
        let cell = DVec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) - 1.0;
        let position = cell * 3.0;
        let velocity = DVec3::new(cell.y + 0.3, cell.z - 0.5, cell.x + 0.7) * 3.0;
        let id = world.add(&ball, DAffine3::from_translation(position))?;
        bodies.insert(id, Body { position, velocity });
    }
    Ok(bodies)
}

/// An elastic bounce of equal masses, or off a wall, along a normal from `b` to `a`.
fn bounce(bodies: &mut BTreeMap<ObjectId, Body>, a: ObjectId, b: ObjectId, normal: DVec3) {
    let velocity = |id: ObjectId| bodies.get(&id).map(|body| body.velocity);
    let (of_a, of_b) = (velocity(a), velocity(b));
    let approach = (of_a.unwrap_or_default() - of_b.unwrap_or_default()).dot(normal);
    if approach >= 0.0 {
        return;
    }
    // A wall does not move: all of the approach is thrown back, twice what a ball of equal mass would.
    let share = if of_a.is_some() && of_b.is_some() { 1.0 } else { 2.0 };
    for (id, sign) in [(a, -share), (b, share)] {
        if let Some(body) = bodies.get_mut(&id) {
            body.velocity += normal * (approach * sign);
        }
    }
}

fn energy(bodies: &BTreeMap<ObjectId, Body>) -> f64 {
    bodies.values().map(|body| 0.5 * body.velocity.length_squared()).sum()
}
