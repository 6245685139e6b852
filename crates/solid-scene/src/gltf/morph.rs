//! Morph targets.

use glam::DVec3;

/// The displacements of a mesh's vertices, target by target.
#[derive(Debug, Default)]
pub(super) struct Targets(Vec<Vec<Displaced>>);

/// Displacements of vertices that follow each other. Those of a target are of some primitives of the mesh alone, of which the others
/// may have any number of vertices.
#[derive(Debug)]
struct Displaced {
    first: usize,
    by: Vec<DVec3>,
}

impl Targets {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Adds displacements of the vertices from `first`.
    pub fn add(&mut self, target: usize, first: usize, by: Vec<DVec3>) {
        if self.0.len() <= target {
            self.0.resize_with(target + 1, Vec::new);
        }
        self.0[target].push(Displaced { first, by });
    }

    /// How many displacements the targets have whose weight is not 0.
    pub fn count(&self, weights: &[f64]) -> usize {
        self.weighted(weights).map(|(displaced, _)| displaced.by.len()).sum()
    }

    /// Displaces vertices, each target as much as its weight says; missing weights are 0.
    pub fn apply(&self, weights: &[f64], positions: &mut [DVec3]) {
        for (Displaced { first, by }, weight) in self.weighted(weights) {
            positions[*first..].iter_mut().zip(by).for_each(|(position, &by)| *position += weight * by);
        }
    }

    /// What has a weight that is not 0.
    fn weighted(&self, weights: &[f64]) -> impl Iterator<Item = (&Displaced, f64)> {
        let targets = self.0.iter().zip(weights).filter(|&(_, &weight)| weight != 0.0);
        targets.flat_map(|(target, &weight)| target.iter().map(move |displaced| (displaced, weight)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_scale_displacements() {
        let mut targets = Targets::default();
        targets.add(1, 1, vec![DVec3::X]);
        let mut positions = [DVec3::ZERO; 3];
        targets.apply(&[9.0, 0.5], &mut positions);
        assert_eq!(positions, [DVec3::ZERO, DVec3::X * 0.5, DVec3::ZERO]);
        targets.apply(&[9.0], &mut positions);
        assert_eq!(positions[1], DVec3::X * 0.5);
    }
}
