//! The text of a file: as the crate's types, and what these leave out.

use std::collections::BTreeMap;

use gltf::json::Root;
use serde::Deserialize;
use serde::de::{Error, IgnoredAny};
use serde_json::{Result, Value, from_slice, from_value, json};

/// What the crate's types leave out.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Rest {
    nodes: Vec<Node>,
    animations: Vec<Animation>,
    scenes: Vec<Scene>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Scene {
    nodes: Option<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Node {
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

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Animation {
    channels: Vec<Channel>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Channel {
    target: Target,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Target {
    node: Option<IgnoredAny>,
}

impl Rest {
    /// The accessors of the instances of a node's mesh, by what they tell; `None` where there is but the mesh.
    pub fn instancing(&self, node: usize) -> Option<&BTreeMap<String, usize>> {
        Some(&self.nodes.get(node)?.extensions.as_ref()?.instancing.as_ref()?.attributes)
    }

    /// Whether a channel of an animation names a node, which it need not.
    pub fn has_target(&self, animation: usize, channel: usize) -> bool {
        let channels = self.animations.get(animation).map(|animation| animation.channels.as_slice());
        channels
            .and_then(|channels| channels.get(channel))
            .is_some_and(|channel| channel.target.node.is_some())
    }

    /// The channels that name no node: animation and number.
    fn without_target(&self) -> impl Iterator<Item = (usize, usize)> {
        let animations = self.animations.iter().enumerate();
        let channels =
            animations.flat_map(|(i, animation)| (0..animation.channels.len()).map(move |j| (i, j)));
        channels.filter(|&(animation, channel)| !self.has_target(animation, channel))
    }

    /// What a file need not have, and the crate's types want: where, under what name, and what stands for nothing.
    fn left_out(&self) -> impl Iterator<Item = (String, &str, Value)> {
        let target = |(animation, channel)| {
            (format!("/animations/{animation}/channels/{channel}/target"), "node", json!(0))
        };
        let empty = self.scenes.iter().enumerate().filter(|(_, scene)| scene.nodes.is_none());
        let nodes = empty.map(|(i, _)| (format!("/scenes/{i}"), "nodes", json!([])));
        self.without_target().map(target).chain(nodes)
    }
}

/// Parses a text. In the crate's types a channel that names no node names node 0: ask [`Rest::has_target`].
pub(super) fn parse(text: &[u8]) -> Result<(Root, Rest)> {
    check_object(text)?;
    let rest: Rest = from_slice(text)?;
    if rest.left_out().next().is_none() {
        return Ok((from_slice(text)?, rest));
    }
    let mut value: Value = from_slice(text)?;
    for (place, name, nothing) in rest.left_out() {
        if let Some(Value::Object(object)) = value.pointer_mut(&place) {
            object.insert(name.to_owned(), nothing);
        }
    }
    Ok((from_value(value).map_err(|error| with_line(text, error))?, rest))
}

/// An error with its line and column, where the text has the same as it stands: a value that was changed knows no lines.
fn with_line(text: &[u8], error: serde_json::Error) -> serde_json::Error {
    match from_slice::<Root>(text) {
        Err(same) if same.to_string().starts_with(&error.to_string()) => same,
        _ => error,
    }
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
