//! A file and its buffers.

use std::borrow::Cow;
use std::cell::Cell;
use std::path::{Path, PathBuf};

use gltf::binary::Glb;
use gltf::json::{Accessor, Mesh, Skin, buffer};

use super::buffer::Buffers;
use super::text::{self, NODES_MAX, Node, Root};
use crate::fault::Result;
use crate::text::{quoted, there_are, without_mark};

/// How many numbers, of eight bytes and more each, may be read out of a file per byte of it and its buffers. A text can name one
/// buffer any number of times, so that a small one could ask for any amount of memory. Of 37 files the one with most has 0.6; what
/// is left allows some dozens of meshes or channels to share what most of the file consists of.
const NUMBERS_PER_BYTE: u64 = 16;

/// How many numbers may be read out of any file.
const NUMBERS_ALWAYS: u64 = 1 << 20;

/// The beginnings of the names of extensions that a file may require: they have no part in geometry, except for
/// `KHR_mesh_quantization`, which only widens the types of accessors, and instances, which are read.
const UNDERSTOOD: [&str; 10] = [
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_xmp",
    "EXT_texture_",
    "EXT_lights_",
    "EXT_materials_",
    "MSFT_",
];

/// The beginnings of the names of others that a file may use, without requiring them, and that change no geometry;
/// an animation of anything but nodes is warned of where it is.
const HARMLESS: [&str; 10] = [
    "KHR_animation_pointer",
    "KHR_audio",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "ADOBE_materials_",
    "CESIUM_primitive_outline",
    "FB_ngon_encoding",
];

/// The extensions that compress geometry.
const COMPRESSIONS: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// A parsed file and the bytes of its buffers. What the text names is looked up here.
pub(super) struct Document {
    pub root: Root,
    buffers: Buffers,
    /// How many more numbers may be read.
    budget: Cell<u64>,
}

impl Document {
    /// Parses a `.gltf` or `.glb` and loads its buffers; those in files of their own are looked for in `folder`.
    pub fn parse(bytes: &[u8], folder: &Path) -> Result<Document> {
        let bytes = without_mark(bytes);
        check_container(bytes)?;
        let (text, binary) = chunks(bytes)?;
        let root = text::parse(&text).map_err(|error| format!("not glTF 2.0: {error}"))?;
        check_version(&root)?;
        check_extensions(&root)?;
        check_size(&root)?;
        let buffers = Buffers::load(&root.buffers, binary, folder)?;
        let size = bytes.len() as u64 + buffers.size;
        let budget = Cell::new(size.saturating_mul(NUMBERS_PER_BYTE).max(NUMBERS_ALWAYS));
        Ok(Document { root, buffers, budget })
    }

    pub fn accessor(&self, index: usize) -> Result<&Accessor> {
        find("accessor", &self.root.accessors, index)
    }

    pub fn view(&self, index: usize) -> Result<&buffer::View> {
        find("bufferView", &self.root.buffer_views, index)
    }

    pub fn buffer(&self, index: usize) -> Result<&[u8]> {
        self.buffers.bytes(index)
    }

    /// The files of buffers.
    pub fn files(&self) -> &[PathBuf] {
        &self.buffers.files
    }

    pub fn mesh(&self, index: usize) -> Result<&Mesh> {
        find("mesh", &self.root.meshes, index)
    }

    pub fn node(&self, index: usize) -> Result<&Node> {
        find("node", &self.root.nodes.first, index)
    }

    pub fn skin(&self, index: usize) -> Result<&Skin> {
        find("skin", &self.root.skins, index)
    }

    /// The compression that the file uses, if any.
    pub fn compression(&self) -> Option<&str> {
        let used = self.root.extensions_used.iter().map(String::as_str);
        used.into_iter().find(|name| COMPRESSIONS.contains(name))
    }

    /// The extensions that the file uses and that may change geometry in ways that are not known here, by quoted name.
    pub fn unknown_extensions(&self) -> Vec<String> {
        let used = self.root.extensions_used.iter();
        let known = |name: &str| {
            is_among(&UNDERSTOOD, name) || is_among(&HARMLESS, name) || COMPRESSIONS.contains(&name)
        };
        used.filter(|name| !known(name)).map(|name| format!("`{}`", quoted(name))).collect()
    }

    /// Counts numbers that are about to be read; `what` names them.
    pub fn spend(&self, numbers: u64, what: &str) -> Result<()> {
        match self.budget.get().checked_sub(numbers) {
            Some(left) => {
                self.budget.set(left);
                Ok(())
            }
            None => {
                Err(format!("{what}: {numbers} numbers are more than a file of this size may hold").into())
            }
        }
    }
}

/// The element that an index names.
pub(super) fn find<'a, T>(kind: &str, all: &'a [T], index: usize) -> Result<&'a T> {
    all.get(index).ok_or_else(|| format!("{kind} {index} is named, but {}", there_are(all.len())).into())
}

/// The text, and the binary part of a `.glb`.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Vec<u8>>);

fn chunks(bytes: &[u8]) -> Result<Chunks<'_>> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.into(), None));
    }
    let glb = Glb::from_slice(bytes).map_err(|error| format!("not glTF 2.0: {error}"))?;
    Ok((glb.json, glb.bin.map(Cow::into_owned)))
}

/// What the crate takes for granted of a `.glb`, or has no good words for: that it is of version 2, that its length is that
/// of its header and more, and that the file has as much.
fn check_container(bytes: &[u8]) -> Result<()> {
    let number = |at: usize| bytes.get(at..)?.first_chunk().map(|number| u32::from_le_bytes(*number));
    let (version, length) = (number(4), number(8));
    let present = bytes.len();
    match length {
        _ if !bytes.starts_with(b"glTF") => Ok(()),
        None => Err(format!("the file ends in its header, of 12 bytes; it has {present}").into()),
        _ if version != Some(2) => {
            let version = version.unwrap_or_default();
            Err(format!("the file is of glTF {version}, in its binary form; expected 2").into())
        }
        Some(length) if length < 12 => {
            Err(format!("the header tells a length of {length} bytes; it has 12 itself").into())
        }
        Some(length) if length as usize > present => Err(format!(
            "the header tells a length of {length} bytes; the file has {present}, so it was cut off"
        )
        .into()),
        Some(_) => Ok(()),
    }
}

fn check_version(root: &Root) -> Result<()> {
    let asset = &root.asset;
    let least = asset.min_version.as_deref().unwrap_or("2.0");
    if asset.version.starts_with("2.") && least == "2.0" {
        return Ok(());
    }
    let version = asset.min_version.as_ref().unwrap_or(&asset.version);
    Err(format!("the file is of glTF {}; expected 2.0", quoted(version)).into())
}

fn check_extensions(root: &Root) -> Result<()> {
    for name in &root.extensions_required {
        if COMPRESSIONS.contains(&name.as_str()) {
            return Err(compressed(name).into());
        }
        if !is_among(&UNDERSTOOD, name) {
            let name = quoted(name);
            return Err(format!("the file requires the extension `{name}`, which is not supported").into());
        }
    }
    Ok(())
}

fn check_size(root: &Root) -> Result<()> {
    match root.nodes.count {
        0..=NODES_MAX => Ok(()),
        count => Err(format!("the file has {count} nodes; the limit is {NODES_MAX}").into()),
    }
}

/// Whether an extension's name begins with one of these.
fn is_among(beginnings: &[&str], name: &str) -> bool {
    beginnings.iter().any(|beginning| name.starts_with(beginning))
}

/// What to say of a file whose geometry is compressed.
pub(super) fn compressed(extension: &str) -> String {
    format!(
        "the file is compressed ({extension}); decompress it first, for example with `gltf-transform copy`"
    )
}
