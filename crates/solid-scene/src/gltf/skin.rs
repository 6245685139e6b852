//! Skins: vertices that follow joints.

use glam::{DAffine3, DMat3, DMat4, DVec3};
use gltf::json::accessor::Type;

use super::document::Document;
use super::local::affine_of;
use crate::fault::Result;
use crate::text::{counted, there_are};

/// The joints of a skin.
#[derive(Debug)]
pub(super) struct Skin {
    /// Their nodes, and the maps from the mesh's space into theirs as they were when it was bound.
    joints: Vec<(usize, DAffine3)>,
}

/// Which joints each vertex of a mesh follows. After [`grow`](Influences::grow) every vertex has a range.
#[derive(Debug, Default)]
pub(super) struct Influences {
    /// Vertex `i` has the influences before `ends[i]`, from where the vertex before it ends.
    ends: Vec<usize>,
    /// Joints of the skin and weights, which have the sum 1 where a vertex has any.
    influences: Vec<(u32, f64)>,
    /// Whether joints are given, if only with weights of 0.
    has_joints: bool,
}

impl Skin {
    /// Reads a skin; without inverse bind matrices they are the identity.
    pub fn read(document: &Document, index: usize) -> Result<Skin> {
        let what = format!("skin {index}");
        let skin = document.skin(index)?;
        let mut joints = Vec::new();
        for joint in &skin.joints {
            document.node(joint.value()).map_err(|fault| fault.of(&what))?;
            joints.push((joint.value(), DAffine3::IDENTITY));
        }
        let Some(accessor) = skin.inverse_bind_matrices else { return Ok(Skin { joints }) };
        let matrices =
            document.numbers(accessor.value(), Type::Mat4, &format!("{what}, inverseBindMatrices"))?;
        if matrices.len() < joints.len() {
            let (has, needs) = (matrices.len(), joints.len());
            return Err(
                format!("{what} has {}, but {has} inverseBindMatrices", counted(needs, "joint")).into()
            );
        }
        for (joint, (matrix, (_, inverse_bind))) in matrices.elements().zip(&mut joints).enumerate() {
            let wrong = || format!("{what}: inverse bind matrix {joint} is not affine");
            *inverse_bind = affine_of(DMat4::from_cols_slice(matrix)).ok_or_else(wrong)?;
        }
        Ok(Skin { joints })
    }

    /// How many joints it has.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Takes vertices from the mesh's space to the world: linear blend skinning. A vertex without influences follows the
    /// first joint. `worlds` are the nodes' maps to the world.
    pub fn apply(&self, influences: &Influences, worlds: &[DAffine3], positions: &mut [DVec3]) {
        let maps: Vec<DAffine3> = self.joints.iter().map(|&(node, bind)| worlds[node] * bind).collect();
        for (vertex, position) in positions.iter_mut().enumerate() {
            let map = match influences.of(vertex) {
                [] => maps.first().copied().unwrap_or(DAffine3::IDENTITY),
                influences => blend(influences, &maps),
            };
            *position = map.transform_point3(*position);
        }
    }
}

fn blend(influences: &[(u32, f64)], maps: &[DAffine3]) -> DAffine3 {
    let mut sum = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    for &(joint, weight) in influences {
        let map = maps[joint as usize];
        sum.matrix3 += map.matrix3 * weight;
        sum.translation += map.translation * weight;
    }
    sum
}

impl Influences {
    pub fn is_empty(&self) -> bool {
        self.influences.is_empty()
    }

    pub fn len(&self) -> usize {
        self.influences.len()
    }

    pub fn has_joints(&self) -> bool {
        self.has_joints
    }

    fn of(&self, vertex: usize) -> &[(u32, f64)] {
        let start = vertex.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.influences[start..self.ends[vertex]]
    }

    /// Adds `count` vertices from `first`, which is beyond those that are there: joints and weights by fours, set by
    /// set. Weights are divided by their sum, which quantization may have moved away from 1.
    pub fn add(
        &mut self,
        first: usize,
        count: usize,
        sets: &[(Vec<u32>, Vec<f64>)],
        what: &str,
    ) -> Result<()> {
        self.grow(first);
        self.has_joints |= !sets.is_empty();
        for vertex in 0..count {
            let range = 4 * vertex..4 * vertex + 4;
            let all = sets.iter().flat_map(|(j, w)| j[range.clone()].iter().zip(&w[range.clone()]));
            let used = all.filter(|&(_, &weight)| weight != 0.0).map(|(&joint, &weight)| (joint, weight));
            let start = self.influences.len();
            self.influences.extend(used);
            let own = &mut self.influences[start..];
            let sum: f64 = own.iter().map(|&(_, weight)| weight).sum();
            let can_divide = sum.is_finite() && sum > 0.0;
            if !own.is_empty() && !can_divide {
                return Err(format!("{what}: the weights of vertex {vertex} have the sum {sum}").into());
            }
            own.iter_mut().for_each(|(_, weight)| *weight /= sum);
            self.ends.push(self.influences.len());
        }
        Ok(())
    }

    /// Gives vertices without influences an empty range.
    pub fn grow(&mut self, vertices: usize) {
        self.ends.resize(vertices, self.influences.len());
    }

    /// Refuses influences of joints that the skin does not have.
    pub fn check(&self, skin: &Skin) -> Result<()> {
        let count = skin.joints.len();
        match self.influences.iter().find(|&&(joint, _)| joint as usize >= count) {
            Some((joint, _)) => {
                Err(format!("a vertex follows joint {joint}, but {}", there_are(count)).into())
            }
            None => Ok(()),
        }
    }
}
