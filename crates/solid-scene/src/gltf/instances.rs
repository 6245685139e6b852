//! The instances of a node's mesh (the extension `EXT_mesh_gpu_instancing`).

use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::Type;

use super::document::Document;
use super::local::Local;
use crate::fault::Result;

/// For how many numbers an object counts, which the file needs no bytes for: a small file shall not make millions.
const NUMBERS_PER_INSTANCE: u64 = 16;

/// The maps from the space of each instance to that of the node; `None` where the node has but its mesh.
pub(super) fn read(document: &Document, node: usize) -> Result<Option<Vec<DAffine3>>> {
    let Some(attributes) = document.node(node)?.instancing() else { return Ok(None) };
    let Some((first, &accessor)) = attributes.first_key_value() else { return Ok(None) };
    let what = |name: &str| format!("instances, {name}");
    let accessor = document.accessor(accessor).map_err(|fault| fault.of(&what(first)))?;
    document.spend(accessor.count.0.saturating_mul(NUMBERS_PER_INSTANCE), "instances")?;
    let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
    let values = |name: &str, kind: Type, default: &[f64]| -> Result<Vec<f64>> {
        let Some(&accessor) = attributes.get(name) else { return Ok(default.repeat(count)) };
        let numbers = document.numbers(accessor, kind, &what(name))?;
        match numbers.len() {
            found if found == count => Ok(numbers.values),
            found => Err(format!("{} has {found} elements, but {first} {count}", what(name)).into()),
        }
    };
    let translations = values("TRANSLATION", Type::Vec3, &[0.0; 3])?;
    let rotations = values("ROTATION", Type::Vec4, &[0.0, 0.0, 0.0, 1.0])?;
    let scales = values("SCALE", Type::Vec3, &[1.0; 3])?;
    let places = translations.chunks_exact(3).zip(rotations.chunks_exact(4)).zip(scales.chunks_exact(3));
    let maps = places.enumerate().map(|(instance, ((translation, rotation), scale))| {
        let (translation, scale) = (DVec3::from_slice(translation), DVec3::from_slice(scale));
        let what = format!("instance {instance}");
        Local::new(translation, DQuat::from_slice(rotation), scale, &what).map(|local| local.affine())
    });
    maps.collect::<Result<_>>().map(Some)
}
