//! Meshes declared solid.

use std::collections::HashMap;

use anyhow::{Result, anyhow};
use solid_scene::{Scene, SceneObject};
use solid3d::Shape;

/// The shape of each object: the scene's, of the objects at the given places as the solid that it bounds (thesis, section
/// 3.1.2). Objects that share a shape share its solid.
pub fn shapes(scene: &Scene, solid: &[usize]) -> Result<Vec<Shape>> {
    let mut shapes: Vec<Shape> = scene.objects().iter().map(|object| object.shape().clone()).collect();
    let mut made = HashMap::new();
    for &place in solid {
        let key = buffers(&shapes[place]);
        let solid = match made.get(&key) {
            Some(solid) if key.is_some() => Shape::clone(solid),
            _ => shapes[place].clone().into_solid().map_err(|error| refusal(scene, place, &error))?,
        };
        made.insert(key, solid.clone());
        shapes[place] = solid;
    }
    Ok(shapes)
}

/// Which mesh a shape is: where it keeps its vertices and triangles, as clones do together. `None` for other shapes.
fn buffers(shape: &Shape) -> Option<(usize, usize)> {
    Some((shape.vertices()?.as_ptr().addr(), shape.triangles()?.as_ptr().addr()))
}

fn refusal(scene: &Scene, place: usize, error: &solid3d::Error) -> anyhow::Error {
    let object: &SceneObject = &scene.objects()[place];
    anyhow!("{}: object {:?} cannot be solid: {error}", scene.files()[object.file()].display(), object.name())
}
