//! Morph targets.

use glam::DVec3;

/// The displacements of a mesh's vertices, target by target. After [`grow`](Targets::grow) every target has one for each
/// vertex.
#[derive(Debug, Default)]
pub(super) struct Targets(Vec<Vec<DVec3>>);

impl Targets {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Adds displacements of the vertices from `first`, which is beyond those that the target has.
    pub fn add(&mut self, target: usize, first: usize, displacements: Vec<DVec3>) {
        if self.0.len() <= target {
            self.0.resize_with(target + 1, Vec::new);
        }
        self.0[target].resize(first, DVec3::ZERO);
        self.0[target].extend(displacements);
    }

    /// Lets vertices without a displacement stay where they are.
    pub fn grow(&mut self, vertices: usize) {
        self.0.iter_mut().for_each(|target| target.resize(vertices, DVec3::ZERO));
    }

    /// Displaces vertices, each target as much as its weight says; missing weights are 0.
    pub fn apply(&self, weights: &[f64], positions: &mut [DVec3]) {
        for (target, &weight) in self.0.iter().zip(weights) {
            if weight != 0.0 {
                positions.iter_mut().zip(target).for_each(|(position, &d)| *position += weight * d);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_scale_displacements() {
        let mut targets = Targets::default();
        targets.add(1, 1, vec![DVec3::X]);
        targets.grow(3);
        let mut positions = [DVec3::ZERO; 3];
        targets.apply(&[9.0, 0.5], &mut positions);
        assert_eq!(positions, [DVec3::ZERO, DVec3::X * 0.5, DVec3::ZERO]);
        targets.apply(&[9.0], &mut positions);
        assert_eq!(positions[1], DVec3::X * 0.5);
    }
}
