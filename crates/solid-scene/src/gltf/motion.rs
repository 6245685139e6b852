//! Where everything is at a time.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::animation::Animation;
use super::graph::Graph;
use super::local::Local;
use super::mesh::Geometry;
use super::skin::Skin;
use crate::part::Motion;
use crate::pose::ObjectPose;

/// How many displacements, joints and influences of vertices, of which nothing is kept, count as much as a number that is read.
const STEPS_PER_NUMBER: usize = 8;

/// The nodes, what changes them and what hangs on them. A sample takes scratch memory in proportion to the nodes.
#[derive(Debug)]
pub(super) struct GltfMotion {
    pub graph: Graph,
    pub locals: Vec<Local>,
    pub animation: Animation,
    pub objects: Vec<Moved>,
}

/// A node with a mesh, or an instance of it.
#[derive(Clone, Debug)]
pub(super) struct Moved {
    pub node: usize,
    /// The map from the space of the instance to that of the node, where it is one of several.
    pub instance: Option<DAffine3>,
    /// Whether the node's own placement has no effect: its skin takes the vertices to the world.
    pub in_world: bool,
    /// What changes its form over time, if anything does.
    pub deformation: Option<Deformation>,
}

/// A mesh and what changes its form.
#[derive(Clone, Debug)]
pub(super) struct Deformation {
    pub geometry: Arc<Geometry>,
    pub skin: Option<Arc<Skin>>,
    /// The weights of the morph targets while no animation changes them.
    pub weights: Vec<f64>,
}

impl Deformation {
    /// For how many numbers it counts: the positions, and the steps to find them at one time. Many nodes may have one mesh, of many
    /// targets or joints.
    pub fn numbers(&self) -> usize {
        let Deformation { geometry, skin, weights } = self;
        let skinned = skin.as_ref().map_or(0, |skin| skin.len() + geometry.influences.len());
        3 * geometry.soup.vertices.len() + (geometry.targets.count(weights) + skinned) / STEPS_PER_NUMBER
    }
}

impl GltfMotion {
    /// The nodes' maps to the world at a time.
    pub fn worlds(&self, time: f64) -> Vec<DAffine3> {
        let mut locals = self.locals.clone();
        self.animation.pose(time, &mut locals);
        let mut worlds = vec![DAffine3::IDENTITY; locals.len()];
        for &node in &self.graph.order {
            let local = locals[node].affine();
            worlds[node] = match self.graph.parents[node] {
                Some(parent) => worlds[parent] * local,
                None => local,
            };
        }
        worlds
    }

    /// The vertices of a deformed mesh on a node at a time: morphed, then skinned.
    pub fn deform(
        &self,
        deformation: &Deformation,
        node: usize,
        time: f64,
        worlds: &[DAffine3],
        positions: &mut Vec<DVec3>,
    ) {
        let Deformation { geometry, skin, weights } = deformation;
        let mut weights = weights.clone();
        self.animation.weights(time, node, &mut weights);
        positions.clear();
        positions.extend_from_slice(&geometry.soup.vertices);
        geometry.targets.apply(&weights, positions);
        if let Some(skin) = skin {
            skin.apply(&geometry.influences, worlds, positions);
        }
    }
}

impl Moved {
    /// Where it is, by the nodes' maps to the world.
    pub fn placement(&self, worlds: &[DAffine3]) -> DAffine3 {
        match self.instance {
            _ if self.in_world => DAffine3::IDENTITY,
            Some(instance) => worlds[self.node] * instance,
            None => worlds[self.node],
        }
    }
}

impl Motion for GltfMotion {
    fn sample(&self, time: f64, poses: &mut [ObjectPose]) {
        let worlds = self.worlds(time);
        for (moved, pose) in self.objects.iter().zip(poses) {
            pose.placement = moved.placement(&worlds);
            match &moved.deformation {
                Some(deformation) => self.deform(deformation, moved.node, time, &worlds, &mut pose.positions),
                None => pose.positions.clear(),
            }
        }
    }
}
