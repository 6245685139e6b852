//! glTF 2.0: `.gltf` with buffers in files or in the text, and `.glb`.
//!
//! The crate `gltf` has the types that the text is parsed into; its validation is left out, since it refuses good files. Nothing in
//! the types is trusted: whatever the text names is looked up by [`Document`], which answers with an error where there
//! is nothing, and never by the crate, which panics.
//!
//! What lives where: [`text`] the text as types, [`document`] the file and its buffers, [`accessor`] numbers out of
//! buffers, [`graph`] the nodes' hierarchy, [`instances`] where a node has its mesh several times, [`mesh`] geometry,
//! [`skin`] and [`morph`] deformation, [`animation`] and [`sampler`] change over time, and [`motion`] all of it at a time.

mod accessor;
mod animation;
mod buffer;
mod document;
mod graph;
mod instances;
mod local;
mod mesh;
mod morph;
mod motion;
mod objects;
mod primitive;
mod sampler;
mod skin;
mod text;
mod uri;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::error::SceneError;
use crate::fault::Result;
use crate::file;
use crate::load::LoadOptions;
use crate::part::Part;
use document::Document;

/// Reads a glTF file: an object for each node of the scene that has a mesh, named by the node, else by its mesh, else
/// `node<i>`; its path are the nodes from the scene's root to it. Of a node with instances of its mesh each is an object,
/// as one on a child of the node.
///
/// The scene is the file's default one, else its first, else all nodes. Of several animations
/// [`LoadOptions::animation`] is played, else the first, with a warning that lists the others; before its first key and
/// after its last it stands still. A node whose placement flattens it (scale 0, the usual way to hide one) is loaded as
/// it is: the world is who refuses the placement, and the caller decides.
pub(crate) fn load(path: &Path, options: &LoadOptions) -> std::result::Result<Part, SceneError> {
    let bytes = file::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&bytes, folder, options.animation.as_deref()).map_err(|fault| fault.in_file(path))
}

fn parse(bytes: &[u8], folder: &Path, animation: Option<&str>) -> Result<Part> {
    let document = Document::parse(bytes, folder)?;
    objects::part(&document, animation)
}
