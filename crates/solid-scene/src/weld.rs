//! Welding equal vertices.

use std::collections::HashMap;

use glam::DVec3;

/// Numbers positions so that equal ones share a number: what is closed in space is closed in its indices too.
#[derive(Debug, Default)]
pub(crate) struct Weld {
    numbers: HashMap<[u64; 3], u32>,
    vertices: Vec<DVec3>,
}

impl Weld {
    /// The number of a position, bit for bit; 0 and -0 are one.
    pub fn number(&mut self, position: DVec3) -> u32 {
        let key = position.to_array().map(|x| (x + 0.0).to_bits());
        *self.numbers.entry(key).or_insert_with(|| {
            self.vertices.push(position);
            (self.vertices.len() - 1) as u32
        })
    }

    /// The positions by number.
    pub fn into_vertices(self) -> Vec<DVec3> {
        self.vertices
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_share_a_number() {
        let mut weld = Weld::default();
        let positions = [DVec3::ZERO, DVec3::X, -DVec3::ZERO, DVec3::X * (1.0 + f64::EPSILON)];
        assert_eq!(positions.map(|p| weld.number(p)), [0, 1, 0, 2]);
        assert_eq!(weld.into_vertices().len(), 3);
    }
}
