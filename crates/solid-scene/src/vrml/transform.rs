//! The fields of a Transform, and the map that they mean.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::graph::{Graph, Node};
use crate::error::SceneError;

/// The fields of a Transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transform {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
    pub scale_orientation: DQuat,
    pub center: DVec3,
}

impl Transform {
    /// The fields as the file gives them.
    pub fn read(graph: &Graph, node: Node) -> Result<Transform, SceneError> {
        Ok(Transform {
            translation: graph.vector(node, "translation")?,
            rotation: graph.rotation(node, "rotation")?,
            scale: graph.vector(node, "scale")?,
            scale_orientation: graph.rotation(node, "scaleOrientation")?,
            center: graph.vector(node, "center")?,
        })
    }

    /// P' = T × C × R × SR × S × -SR × -C × P (ISO/IEC 14772-1, 6.52).
    pub fn map(&self) -> DAffine3 {
        let orientation = DMat3::from_quat(self.scale_orientation);
        let scale = orientation * DMat3::from_diagonal(self.scale) * orientation.transpose();
        let matrix3 = DMat3::from_quat(self.rotation) * scale;
        let translation = self.translation + self.center - matrix3 * self.center;
        DAffine3 { matrix3, translation }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    const IDENTITY: Transform = Transform {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        scale_orientation: DQuat::IDENTITY,
        center: DVec3::ZERO,
    };

    #[test]
    fn the_default_is_exactly_the_identity() {
        assert_eq!(IDENTITY.map(), DAffine3::IDENTITY);
    }

    #[test]
    fn rotation_and_scale_keep_the_center() {
        let center = DVec3::new(1.0, 2.0, 3.0);
        let rotation = DQuat::from_rotation_z(FRAC_PI_2);
        let map = Transform { center, rotation, scale: DVec3::splat(2.0), ..IDENTITY }.map();
        assert!(map.transform_point3(center).distance(center) < 1e-12);
        let x = map.transform_point3(center + DVec3::X);
        assert!(x.distance(center + 2.0 * DVec3::Y) < 1e-12);
    }

    #[test]
    fn scale_acts_along_the_scale_orientation() {
        let turned = DQuat::from_rotation_z(FRAC_PI_2);
        let scale = DVec3::new(3.0, 1.0, 1.0);
        let map = Transform { scale, scale_orientation: turned, ..IDENTITY }.map();
        assert!(map.transform_point3(DVec3::Y).distance(3.0 * DVec3::Y) < 1e-12);
        assert!(map.transform_point3(DVec3::X).distance(DVec3::X) < 1e-12);
    }
}
