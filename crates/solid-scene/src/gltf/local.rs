//! A node's transformation to its parent.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use super::text::Node;
use crate::fault::Result;

/// How far the last row of a node's matrix may be from 0 0 0 1.
const LAST_ROW_TOLERANCE: f64 = 1e-6;

/// Scale, then rotate, then translate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Local {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
    /// A matrix instead; animation of the node's other values is then of no effect.
    matrix: Option<DAffine3>,
}

impl Local {
    /// The transformation that a node has when it is not animated.
    pub fn of(index: usize, node: &Node) -> Result<Local> {
        let matrix = node.matrix.as_deref().map(|&matrix| affine(index, matrix)).transpose()?;
        let translation = DVec3::from_array(node.translation.unwrap_or([0.0; 3]).map(f64::from));
        let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]).map(f64::from));
        let scale = DVec3::from_array(node.scale.unwrap_or([1.0; 3]).map(f64::from));
        Ok(Local { matrix, ..Local::new(translation, rotation, scale, &format!("node {index}"))? })
    }

    /// The transformation of three values; a rotation of any length but 0. `what` names what has it.
    pub fn new(translation: DVec3, rotation: DQuat, scale: DVec3, what: &str) -> Result<Local> {
        if !(translation.is_finite() && scale.is_finite() && rotation.is_finite()) {
            return Err(format!("{what} has a transformation that is not finite").into());
        }
        let rotation = unit(rotation).ok_or_else(|| format!("{what} has a rotation of length 0"))?;
        Ok(Local { translation, rotation, scale, matrix: None })
    }

    /// Whether it is a matrix, which no animation changes.
    pub fn is_matrix(&self) -> bool {
        self.matrix.is_some()
    }

    pub fn affine(&self) -> DAffine3 {
        self.matrix.unwrap_or_else(|| {
            DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
        })
    }
}

/// A quaternion of length 1; `None` for one that is nearly 0 or not finite.
pub(super) fn unit(rotation: DQuat) -> Option<DQuat> {
    let length = rotation.length();
    (length > 1e-12 && length.is_finite()).then(|| rotation / length)
}

fn affine(index: usize, matrix: [f32; 16]) -> Result<DAffine3> {
    affine_of(DMat4::from_cols_array(&matrix.map(f64::from)))
        .ok_or_else(|| format!("node {index} has a matrix that is not affine").into())
}

/// A matrix as an affine map; `None` where its last row is not 0 0 0 1 or a number is not finite.
pub(super) fn affine_of(matrix: DMat4) -> Option<DAffine3> {
    let last = matrix.row(3) - glam::DVec4::W;
    let is_affine = matrix.is_finite() && last.abs().max_element() <= LAST_ROW_TOLERANCE;
    is_affine.then(|| DAffine3::from_mat3_translation(DMat3::from_mat4(matrix), matrix.w_axis.truncate()))
}
