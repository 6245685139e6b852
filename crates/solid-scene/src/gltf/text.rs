//! The text of a file, as types: of all that it may hold what is read, so that materials and the like take no memory.

use std::collections::BTreeMap;
use std::fmt;

use gltf::json::animation::{Property, Sampler};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Asset, Buffer, Mesh, Skin, buffer};
use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use serde_json::{Result, from_slice};

/// Nodes of a file: each takes some 700 bytes in all, where the text need not have more than three.
pub(super) const NODES_MAX: usize = 500_000;

/// The whole text.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Root {
    pub asset: Asset,
    #[serde(default)]
    pub extensions_used: Vec<String>,
    #[serde(default)]
    pub extensions_required: Vec<String>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub animations: Vec<Animation>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub buffer_views: Vec<buffer::View>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub nodes: Nodes,
    pub scene: Option<u32>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub skins: Vec<Skin>,
}

/// The nodes; of more than [`NODES_MAX`] the first.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    pub first: Vec<Node>,
    /// How many the text has.
    pub count: usize,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    pub children: Option<Box<[u32]>>,
    pub matrix: Option<Box<[f32; 16]>>,
    pub mesh: Option<u32>,
    pub name: Option<Box<str>>,
    pub rotation: Option<[f32; 4]>,
    pub scale: Option<[f32; 3]>,
    pub translation: Option<[f32; 3]>,
    pub skin: Option<u32>,
    pub weights: Option<Box<[f32]>>,
    #[serde(default)]
    extensions: Option<NodeExtensions>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Instancing {
    attributes: BTreeMap<String, usize>,
}

/// A scene, which may be empty.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub nodes: Option<Box<[u32]>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Animation {
    pub name: Option<String>,
    pub channels: Vec<Channel>,
    pub samplers: Vec<Sampler>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Channel {
    pub sampler: u32,
    pub target: Target,
}

#[derive(Debug, Deserialize)]
pub(super) struct Target {
    /// An extension may say what else is changed.
    pub node: Option<u32>,
    pub path: Checked<Property>,
}

impl Node {
    /// The accessors of the instances of the node's mesh, by what they tell; `None` where there is but the mesh.
    pub fn instancing(&self) -> Option<&BTreeMap<String, usize>> {
        Some(&self.extensions.as_ref()?.instancing.as_ref()?.attributes)
    }
}

impl<'de> Deserialize<'de> for Nodes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_seq(NodesVisitor)
    }
}

struct NodesVisitor;

impl<'de> Visitor<'de> for NodesVisitor {
    type Value = Nodes;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a sequence")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut all: A) -> std::result::Result<Nodes, A::Error> {
        let mut nodes = Nodes::default();
        while nodes.first.len() < NODES_MAX {
            let Some(node) = all.next_element()? else { break };
            nodes.first.push(node);
        }
        nodes.count = nodes.first.len();
        while all.next_element::<IgnoredAny>()?.is_some() {
            nodes.count += 1;
        }
        Ok(nodes)
    }
}

/// Parses a text.
pub(super) fn parse(text: &[u8]) -> Result<Root> {
    check_object(text)?;
    from_slice(text)
}

/// What the types would say in words of their own: that the text, where it is JSON, is an object.
fn check_object(text: &[u8]) -> Result<()> {
    let found = match text.trim_ascii_start().first() {
        Some(b'[') => "an array",
        Some(b'"') => "a string",
        Some(b'-' | b'0'..=b'9') => "a number",
        Some(b't' | b'f') => "a truth value",
        Some(b'n') => "null",
        _ => return Ok(()),
    };
    from_slice::<IgnoredAny>(text)?;
    Err(Error::custom(format!("expected a JSON object, but the text is {found}")))
}
