//! Meshes declared solid, or unions of convex pieces.

use std::collections::HashMap;

use anyhow::{Result, anyhow, bail};
use solid_decompose::{Options, decompose};
use solid_scene::{Pose, Scene};
use solid3d::Shape;

use crate::rules::Bodies;
use crate::words::quoted;

/// The shape of each object: the scene's, or where it is so declared the solid that it bounds (thesis, section 3.1.2), and then a
/// union of convex pieces (3.1.1). Objects that share a shape share what is made of it.
pub fn shapes(scene: &Scene, bodies: &Bodies) -> Result<Vec<Shape>> {
    let mut shapes: Vec<Shape> = scene.objects().iter().map(|object| object.shape().clone()).collect();
    remake(&mut shapes, &bodies.solid, |place, shape| {
        let solid = shape.clone().into_solid();
        solid.map_err(|error| anyhow!("{} cannot be solid: {error}", name(scene, place)))
    })?;
    refuse_deforming(scene, &bodies.decomposed)?;
    remake(&mut shapes, &bodies.decomposed, |place, shape| {
        let parts = decompose(shape, &Options::default());
        let parts = parts.map_err(|error| anyhow!("{} cannot be decomposed: {error}", name(scene, place)))?;
        Ok(parts.shape)
    })?;
    Ok(shapes)
}

/// Replaces the shapes at some places, each shape once.
fn remake(
    shapes: &mut [Shape],
    places: &[usize],
    make: impl Fn(usize, &Shape) -> Result<Shape>,
) -> Result<()> {
    let mut made = HashMap::new();
    let mut done = vec![false; shapes.len()];
    for &place in places {
        if std::mem::replace(&mut done[place], true) {
            continue;
        }
        let key = buffers(&shapes[place]);
        let body = match made.get(&key) {
            Some(body) if key.is_some() => Shape::clone(body),
            _ => make(place, &shapes[place])?,
        };
        made.insert(key, body.clone());
        shapes[place] = body;
    }
    Ok(())
}

/// The pieces of a mesh do not move with its vertices.
fn refuse_deforming(scene: &Scene, places: &[usize]) -> Result<()> {
    let mut pose = Pose::default();
    scene.sample(0.0, &mut pose);
    match places.iter().find(|&&place| !pose.objects[place].positions.is_empty()) {
        Some(&place) => bail!(
            "{} cannot be decomposed: it deforms, and convex pieces cannot follow; leave it out of --decompose",
            name(scene, place)
        ),
        None => Ok(()),
    }
}

/// Which mesh a shape is: where it keeps its vertices and triangles, as clones do together. `None` for other shapes.
fn buffers(shape: &Shape) -> Option<(usize, usize)> {
    Some((shape.vertices()?.as_ptr().addr(), shape.triangles()?.as_ptr().addr()))
}

fn name(scene: &Scene, place: usize) -> String {
    let object = &scene.objects()[place];
    format!("{}: object {}", scene.files()[object.file()].display(), quoted(object.name()))
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use solid3d::glam::DVec3;

    use super::*;

    /// What takes a second for each mesh is done once for all that share one.
    #[test]
    fn what_is_shared_is_remade_once() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let [one, other] = [0, 1].map(|_| Shape::mesh(corners, faces).expect("it is a tetrahedron"));
        let ball = Shape::sphere(1.0).expect("the radius is fine");
        let mut shapes = [&one, &other, &one, &ball, &ball].map(Shape::clone);
        let calls = Cell::new(0);
        let make = |_, shape: &Shape| {
            calls.set(calls.get() + 1);
            Ok(shape.clone().into_solid()?)
        };
        remake(&mut shapes, &[2, 0, 2, 3, 4], make).expect("it is closed");
        assert_eq!(calls.get(), 3, "of the tetrahedron, and of each ball");
        assert_eq!(buffers(&shapes[0]), buffers(&shapes[2]));
        assert_eq!(buffers(&shapes[1]), buffers(&other));
    }
}
