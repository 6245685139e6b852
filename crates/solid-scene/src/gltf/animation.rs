//! Animations: which one is played, and what it changes.

use std::collections::{BTreeSet, HashMap};

use glam::{DQuat, DVec3};
use gltf::json::animation::Property;
use gltf::json::mesh::Primitive;
use gltf::json::validation::Checked;

use super::document::{Document, find};
use super::local::Local;
use super::sampler::Sampler;
use super::text;
use crate::fault::Result;
use crate::text::{counted, quoted};
use crate::warnings::Warnings;

/// The animation that is played; without any, nothing changes.
#[derive(Debug, Default)]
pub(super) struct Animation {
    /// What moves nodes.
    channels: Vec<Channel>,
    /// What changes the weights of nodes, by node.
    weights: HashMap<usize, Sampler>,
    /// The time of the last key.
    pub duration: f64,
}

/// A value of a node that is changed over time.
#[derive(Debug)]
struct Channel {
    node: usize,
    property: Property,
    sampler: Sampler,
}

impl Animation {
    /// Reads the animation that `choice` names by name or else by number, from 0; without a choice the file's first.
    pub fn read(document: &Document, choice: Option<&str>, warnings: &mut Warnings) -> Result<Animation> {
        let names = names(document);
        let index = match choice {
            Some(choice) => chosen(document, &names, choice)?,
            None if names.is_empty() => return Ok(Animation::default()),
            None => {
                if names.len() > 1 {
                    warnings.add(format!("plays the animation {}, not {}", names[0], list(&names[1..])));
                }
                0
            }
        };
        let (mut animation, mut untargeted) = (Animation::default(), 0);
        let source = find("animation", &document.root.animations, index)?;
        for (number, channel) in source.channels.iter().enumerate() {
            let what = format!("animation {}, channel {number}", names[index]);
            let Some(node) = channel.target.node.map(|node| node as usize) else {
                untargeted += 1;
                continue;
            };
            document.node(node).map_err(|fault| fault.of(&what))?;
            let Checked::Valid(property) = channel.target.path else {
                warnings.add(format!("{what} is passed over: it changes something unknown"));
                continue;
            };
            let sampler = find("sampler", &source.samplers, channel.sampler as usize)
                .map_err(|fault| fault.of(&what))?;
            let sampler = Sampler::read(document, sampler, property, &what)?;
            if property == Property::MorphTargetWeights {
                check_weights(document, node, &sampler).map_err(|fault| fault.of(&what))?;
            }
            animation.duration = animation.duration.max(sampler.end());
            match property {
                Property::MorphTargetWeights => drop(animation.weights.insert(node, sampler)),
                _ => animation.channels.push(Channel { node, property, sampler }),
            }
        }
        untargeted_warning(&names[index], untargeted).into_iter().for_each(|warning| warnings.add(warning));
        Ok(animation)
    }

    /// The nodes that it moves, in order, each once.
    pub fn moved(&self) -> impl Iterator<Item = usize> + use<> {
        self.channels.iter().map(|channel| channel.node).collect::<BTreeSet<_>>().into_iter()
    }

    /// Whether it moves nodes, rather than only changing weights.
    pub fn moves(&self) -> bool {
        !self.channels.is_empty()
    }

    /// Whether it changes the weights of a node.
    pub fn morphs(&self, node: usize) -> bool {
        self.weights.contains_key(&node)
    }

    /// Moves the nodes to where they are at a time.
    pub fn pose(&self, time: f64, locals: &mut [Local]) {
        let mut value = Vec::new();
        for Channel { node, property, sampler } in &self.channels {
            let local = &mut locals[*node];
            sampler.sample(time, &mut value);
            match property {
                Property::Translation => local.translation = DVec3::from_slice(&value),
                Property::Rotation => local.rotation = DQuat::from_slice(&value),
                Property::Scale => local.scale = DVec3::from_slice(&value),
                Property::MorphTargetWeights => {}
            }
        }
    }

    /// The weights of a node at a time; left as they are where nothing changes them.
    pub fn weights(&self, time: f64, node: usize, weights: &mut Vec<f64>) {
        if let Some(sampler) = self.weights.get(&node) {
            sampler.sample(time, weights);
        }
    }
}

/// That there is a weight for each target of a node's mesh (glTF 2.0, section 3.11); without a mesh they have no effect.
fn check_weights(document: &Document, node: usize, sampler: &Sampler) -> Result<()> {
    let Some(mesh) = document.node(node)?.mesh else { return Ok(()) };
    let of_each = |primitive: &Primitive| primitive.targets.as_ref().map_or(0, Vec::len);
    let targets = document.mesh(mesh as usize)?.primitives.iter().map(of_each).max().unwrap_or(0);
    if sampler.width() == targets {
        return Ok(());
    }
    let (weights, targets) = (counted(sampler.width(), "weight"), counted(targets, "target"));
    Err(format!("a key has {weights}, but the mesh of node {node} has {targets}").into())
}

/// What messages call the animations: by name in quotes, or by number where they have none.
fn names(document: &Document) -> Vec<String> {
    let animations = document.root.animations.iter().enumerate();
    let name = |(number, animation): (usize, &text::Animation)| match &animation.name {
        Some(name) => format!("`{}`", quoted(name)),
        None => number.to_string(),
    };
    animations.map(name).collect()
}

/// What to tell the user of channels, where there were some, of which nothing is known but that they change no node.
fn untargeted_warning(animation: &str, count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some(format!("animation {animation}: 1 channel that names no node is passed over")),
        n => Some(format!("animation {animation}: {n} channels that name no node are passed over")),
    }
}

/// Names, as far as anybody would read them.
pub(super) fn list(names: &[String]) -> String {
    const NAMES_MAX: usize = 20;
    let (told, more) = names.split_at(names.len().min(NAMES_MAX));
    match more.len() {
        0 => told.join(", "),
        count => format!("{} and {count} more", told.join(", ")),
    }
}

fn chosen(document: &Document, names: &[String], choice: &str) -> Result<usize> {
    let mut animations = document.root.animations.iter();
    let by_name = animations.position(|animation| animation.name.as_deref() == Some(choice));
    let by_number = || choice.parse().ok().filter(|&number: &usize| number < names.len());
    by_name.or_else(by_number).ok_or_else(|| {
        let known = match names {
            [] => "the file has none".to_owned(),
            [name] => format!("the only one of the file is {name}"),
            names => format!("the animations of the file are {}", list(names)),
        };
        format!("there is no animation `{choice}`; {known}").into()
    })
}
