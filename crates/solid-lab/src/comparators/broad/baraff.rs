use std::collections::BTreeSet;

use solid3d::Aabb;

use super::BroadTest;
use super::order::{End, all_pairs, box_of, is_upper, key, ordered, sorted};

/// Baraff's sweep and prune: the ends in three arrays, each sorted anew by insertion in every frame (*Dynamic simulation of
/// non-penetrating rigid bodies*, 1992; thesis, section 5.2.2).
#[derive(Clone, Debug)]
pub struct Baraff {
    boxes: Vec<Aabb>,
    orders: [Vec<End>; 3],
    pairs: BTreeSet<(u32, u32)>,
    swaps: u64,
}

impl Baraff {
    /// Over boxes numbered from 0.
    pub fn new(boxes: &[Aabb]) -> Self {
        Baraff {
            boxes: boxes.to_vec(),
            orders: [0, 1, 2].map(|axis| sorted(boxes, axis)),
            pairs: all_pairs(boxes).collect(),
            swaps: 0,
        }
    }

    fn sort(&mut self, axis: usize) {
        for start in 1..self.orders[axis].len() {
            let end = self.orders[axis][start];
            let place = key(&self.boxes, axis, end);
            let mut i = start;
            while i > 0 && key(&self.boxes, axis, self.orders[axis][i - 1]) > place {
                let passed = self.orders[axis][i - 1];
                self.orders[axis][i] = passed;
                self.swaps += 1;
                let (x, y) = (box_of(end), box_of(passed));
                if is_upper(end) && !is_upper(passed) {
                    self.pairs.remove(&ordered(x, y));
                } else if !is_upper(end)
                    && is_upper(passed)
                    && self.boxes[x as usize].overlaps(&self.boxes[y as usize])
                {
                    self.pairs.insert(ordered(x, y));
                }
                i -= 1;
            }
            self.orders[axis][i] = end;
        }
    }
}

impl BroadTest for Baraff {
    fn name(&self) -> &'static str {
        "Baraff's sweep and prune"
    }

    fn update(&mut self, moved: &[(u32, Aabb)]) {
        for &(index, bounds) in moved {
            self.boxes[index as usize] = bounds;
        }
        for axis in 0..3 {
            self.sort(axis);
        }
    }

    fn pairs(&self) -> Vec<(u32, u32)> {
        self.pairs.iter().copied().collect()
    }

    fn steps(&self) -> u64 {
        self.swaps
    }
}
