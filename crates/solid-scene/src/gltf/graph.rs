//! The hierarchy of the nodes.

use super::document::{Document, find};
use crate::fault::Result;

/// The deepest node: objects keep the path from their root, so that depth costs memory.
pub(super) const DEPTH_MAX: usize = 256;

/// Nodes in the paths of all objects together: a file of a few bytes a node could make [`DEPTH_MAX`] times as many.
pub(super) const PATHS_MAX: usize = 16_000_000;

/// The nodes as a forest.
#[derive(Debug)]
pub(super) struct Graph {
    /// Each node's parent.
    pub parents: Vec<Option<usize>>,
    /// All nodes, parents before their children.
    pub order: Vec<usize>,
    /// The nodes of the scene, in the order in which a walk from its roots meets them.
    pub scene: Vec<usize>,
}

impl Graph {
    /// Checks that the nodes are a forest that is not too deep, and finds the scene's.
    pub fn new(document: &Document) -> Result<Graph> {
        let parents = parents(document)?;
        let roots = (0..parents.len()).filter(|&node| parents[node].is_none()).collect::<Vec<_>>();
        let order = walk(document, &roots)?;
        if order.len() < parents.len() {
            let node = on_cycle(&parents, &order);
            return Err(format!("node {node} is its own ancestor").into());
        }
        let scene = match scene_roots(document)? {
            None => order.clone(),
            Some(roots) => walk(document, &roots)?,
        };
        Ok(Graph { parents, order, scene })
    }

    /// The nodes from the root to a node, itself included.
    pub fn path(&self, node: usize) -> Vec<u32> {
        let mut path: Vec<u32> =
            std::iter::successors(Some(node), |&node| self.parents[node]).map(|node| node as u32).collect();
        path.reverse();
        path
    }
}

fn children(document: &Document, node: usize) -> impl DoubleEndedIterator<Item = usize> {
    let children = document.root.nodes.first[node].children.iter().flatten();
    children.map(|&child| child as usize)
}

/// Each node's parent, of which it has one at most.
fn parents(document: &Document) -> Result<Vec<Option<usize>>> {
    let mut parents = vec![None; document.root.nodes.first.len()];
    for node in 0..parents.len() {
        for child in children(document, node) {
            document.node(child).map_err(|fault| fault.of(&format!("child of node {node}")))?;
            if let Some(other) = parents[child].replace(node) {
                return Err(format!("node {child} is a child of both node {other} and node {node}").into());
            }
        }
    }
    Ok(parents)
}

/// The roots, each followed by what is below it, every node once.
fn walk(document: &Document, roots: &[usize]) -> Result<Vec<usize>> {
    let mut order = Vec::new();
    let mut seen = vec![false; document.root.nodes.first.len()];
    let mut waiting: Vec<(usize, usize)> = roots.iter().rev().map(|&root| (root, 1)).collect();
    while let Some((node, depth)) = waiting.pop() {
        if depth > DEPTH_MAX {
            return Err(format!("node {node} is deeper than {DEPTH_MAX} nodes").into());
        }
        if std::mem::replace(&mut seen[node], true) {
            continue;
        }
        order.push(node);
        waiting.extend(children(document, node).rev().map(|child| (child, depth + 1)));
    }
    Ok(order)
}

/// The roots of the scene; `None` where the file has no scene. They should have no parents, but some do, and stay where
/// these place them.
fn scene_roots(document: &Document) -> Result<Option<Vec<usize>>> {
    let scenes = &document.root.scenes;
    let scene = match document.root.scene {
        Some(scene) => find("scene", scenes, scene as usize)?,
        None => match scenes.first() {
            Some(scene) => scene,
            None => return Ok(None),
        },
    };
    let root = |node: usize| document.node(node).map(|_| node).map_err(|fault| fault.of("the scene"));
    scene.nodes.iter().flatten().map(|&node| root(node as usize)).collect::<Result<_>>().map(Some)
}

/// A node on a cycle: where many steps up from a node that no root reaches lead.
fn on_cycle(parents: &[Option<usize>], reached: &[usize]) -> usize {
    let mut is_reached = vec![false; parents.len()];
    reached.iter().for_each(|&node| is_reached[node] = true);
    let start = is_reached.iter().position(|&reached| !reached).unwrap_or(0);
    (0..parents.len()).fold(start, |node, _| parents[node].unwrap_or(node))
}
