//! Choosing the reader of a file.

use std::path::Path;

use crate::error::SceneError;
use crate::part::Part;
use crate::{gltf, obj, ply, stl, vrml};

/// How to load files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadOptions {
    /// Makes each group of an OBJ file an object, instead of one for the whole file.
    pub split: bool,
    /// The animation of a glTF file to play, by its name or else by its number, from 0. Without it the first is played,
    /// with a warning that lists the others. Other formats have one animation at most, and take no notice of this.
    pub animation: Option<String>,
}

/// A file format that scenes come in, told by the file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// VRML97: `.wrl`, `.vrml`.
    Vrml97,
    /// glTF 2.0: `.gltf`, `.glb`.
    Gltf,
    /// Wavefront OBJ: `.obj`.
    Obj,
    /// STL, ASCII or binary: `.stl`.
    Stl,
    /// PLY, ASCII or binary: `.ply`.
    Ply,
}

impl Format {
    /// The format that a file's extension tells, in any case; `None` for any other.
    pub fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "wrl" | "vrml" => Some(Format::Vrml97),
            "gltf" | "glb" => Some(Format::Gltf),
            "obj" => Some(Format::Obj),
            "stl" => Some(Format::Stl),
            "ply" => Some(Format::Ply),
            _ => None,
        }
    }
}

/// Reads a file.
pub(crate) fn load(path: &Path, options: &LoadOptions) -> Result<Part, SceneError> {
    let Some(format) = Format::of(path) else {
        let is = if path.is_dir() { "is a folder" } else { "unknown format" };
        let expected = "expected a file ending in .wrl, .vrml, .gltf, .glb, .obj, .stl or .ply";
        return Err(SceneError::new(path, None, format!("{is}; {expected}")));
    };
    match format {
        Format::Vrml97 => vrml::load(path),
        Format::Gltf => gltf::load(path, options),
        Format::Obj => obj::load(path, options),
        Format::Stl => stl::load(path),
        Format::Ply => ply::load(path),
    }
}
