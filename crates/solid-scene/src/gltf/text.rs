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
}

/// Parses a text. In the crate's types a channel that names no node names node 0: ask [`Rest::has_target`].
pub(super) fn parse(text: &[u8]) -> Result<(Root, Rest)> {
    check_object(text)?;
    let rest: Rest = from_slice(text)?;
    if rest.without_target().next().is_none() {
        return Ok((from_slice(text)?, rest));
    }
    let mut value: Value = from_slice(text)?;
    for (animation, channel) in rest.without_target() {
        if let Some(Value::Object(target)) =
            value.pointer_mut(&format!("/animations/{animation}/channels/{channel}/target"))
        {
            target.insert("node".to_owned(), json!(0));
        }
    }
    Ok((from_value(value)?, rest))
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
