use std::collections::BTreeSet;

use solid3d::Aabb;

use super::BroadTest;
use super::order::{End, all_pairs, box_of, is_upper, key, lower, ordered, sorted, upper};

/// The thesis's incremental sweep and prune: the ends of the boxes in three doubly linked lists; each end that moves is put in its
/// place at once, up or down, and the pairs are kept in a balanced tree (sections 5.2.2 and 6.3.4). What SOLID uses.
#[derive(Clone, Debug)]
pub struct LinkedSweep {
    boxes: Vec<Aabb>,
    lists: [Vec<Link>; 3],
    pairs: BTreeSet<(u32, u32)>,
    swaps: u64,
}

/// The neighbours of an end in the list of its axis.
#[derive(Clone, Copy, Debug)]
struct Link {
    before: End,
    after: End,
}

/// No neighbour: the end of the list.
const NONE: End = End::MAX;

impl LinkedSweep {
    /// Over boxes numbered from 0.
    pub fn new(boxes: &[Aabb]) -> Self {
        let list = |axis: usize| {
            let order = sorted(boxes, axis);
            let mut links = vec![Link { before: NONE, after: NONE }; order.len()];
            for pair in order.windows(2) {
                links[pair[0] as usize].after = pair[1];
                links[pair[1] as usize].before = pair[0];
            }
            links
        };
        LinkedSweep {
            boxes: boxes.to_vec(),
            lists: [0, 1, 2].map(list),
            pairs: all_pairs(boxes).collect(),
            swaps: 0,
        }
    }

    /// Walks an end to its place. Passing an end of another box may begin or end an overlap.
    fn settle(&mut self, axis: usize, end: End) {
        let place = key(&self.boxes, axis, end);
        loop {
            let after = self.lists[axis][end as usize].after;
            if after == NONE || place <= key(&self.boxes, axis, after) {
                break;
            }
            self.swap(axis, end, after);
            // The other end is now below.
            self.passed(after, end);
        }
        loop {
            let before = self.lists[axis][end as usize].before;
            if before == NONE || key(&self.boxes, axis, before) <= place {
                break;
            }
            self.swap(axis, before, end);
            self.passed(end, before);
        }
    }

    /// Exchanges neighbours, `x` before `y`.
    fn swap(&mut self, axis: usize, x: End, y: End) {
        self.swaps += 1;
        let list = &mut self.lists[axis];
        let (first, last) = (list[x as usize].before, list[y as usize].after);
        if first != NONE {
            list[first as usize].after = y;
        }
        if last != NONE {
            list[last as usize].before = x;
        }
        list[y as usize] = Link { before: first, after: x };
        list[x as usize] = Link { before: y, after: last };
    }

    /// `below` has come below `above`: a lower end below an upper one begins an overlap on the axis, an upper end below a lower
    /// one ends it.
    fn passed(&mut self, below: End, above: End) {
        let (i, j) = (box_of(below), box_of(above));
        if i == j || is_upper(below) == is_upper(above) {
            return;
        }
        if is_upper(below) {
            self.pairs.remove(&ordered(i, j));
        } else if self.boxes[i as usize].overlaps(&self.boxes[j as usize]) {
            self.pairs.insert(ordered(i, j));
        }
    }
}

impl BroadTest for LinkedSweep {
    fn name(&self) -> &'static str {
        "incremental sweep and prune"
    }

    fn update(&mut self, moved: &[(u32, Aabb)]) {
        for &(index, bounds) in moved {
            self.boxes[index as usize] = bounds;
            for axis in 0..3 {
                self.settle(axis, lower(index));
                self.settle(axis, upper(index));
                // An end that its own other end was in the way of.
                self.settle(axis, lower(index));
            }
        }
    }

    fn pairs(&self) -> Vec<(u32, u32)> {
        self.pairs.iter().copied().collect()
    }

    fn steps(&self) -> u64 {
        self.swaps
    }
}
