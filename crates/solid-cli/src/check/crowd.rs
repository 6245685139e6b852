//! Whether objects crowd: of every pair whose boxes overlap a test keeps something, so of too many it would take all memory there is.

use std::ops::ControlFlow;

use anyhow::{Result, bail};
use solid3d::glam::DVec3;
use solid3d::tree::{COORDINATE_MAX, Traversal, Tree};
use solid3d::{Aabb, Motion};

use super::stage::Stage;
use crate::words;

/// A limit on the pairs whose boxes overlap.
pub struct Crowd {
    pairs_max: u64,
    /// By how much boxes are grown for clearances.
    margin: f64,
    tested: Motion,
    /// The boxes of the previous frame, where the way from there is tested.
    before: Vec<Aabb>,
    /// Boxes of which no more pairs overlap than may: while each object is within its own, nothing is counted.
    room: Vec<Aabb>,
}

impl Crowd {
    /// For a stage with clearances up to one, tested as said.
    pub fn new(pairs_max: u64, clearance: f64, tested: Motion) -> Self {
        Crowd { pairs_max, margin: 0.5 * clearance, tested, before: Vec::new(), room: Vec::new() }
    }

    /// Refuses a frame, at a time in seconds, in which the boxes of too many pairs overlap. To be asked of each frame before it is tested.
    pub fn refuse(&mut self, stage: &Stage, time: f64) -> Result<()> {
        if pairs_of(stage.len()) <= self.pairs_max {
            return Ok(());
        }
        let mut boxes: Vec<Aabb> = stage.bounds().map(|bounds| bounds.inflated(self.margin)).collect();
        if self.tested == Motion::Swept {
            let before = std::mem::replace(&mut self.before, boxes.clone());
            boxes.iter_mut().zip(&before).for_each(|(bounds, before)| *bounds = bounds.union(before));
        }
        if !self.admits(boxes) {
            bail!(
                "at {} s the boxes of more than {} of objects overlap, each of which would take a kilobyte of memory or more: are \
                 objects in one place that should not be, or is a clearance too great? --max-pairs allows more",
                words::seconds(time),
                words::count(self.pairs_max, "pair")
            );
        }
        Ok(())
    }

    fn admits(&mut self, boxes: Vec<Aabb>) -> bool {
        let mut both = self.room.iter().zip(&boxes);
        if self.room.len() == boxes.len() && both.all(|(room, bounds)| room.contains(bounds)) {
            return true;
        }
        // With room to move, if that is not too much: then the next frames need not be counted.
        let with_room = boxes.iter().map(|bounds| bounds.inflated(bounds.half_extents().max_element()));
        self.room = with_room.collect();
        if !self.are_few(&self.room) {
            self.room = boxes;
            return self.are_few(&self.room);
        }
        true
    }

    /// Whether no more pairs of boxes overlap than may.
    fn are_few(&self, boxes: &[Aabb]) -> bool {
        // What overlaps still does where both ends of all are brought into the range of a tree.
        let limit = DVec3::splat(COORDINATE_MAX);
        let within = |end: DVec3| end.clamp(-limit, limit);
        let near: Vec<Aabb> =
            boxes.iter().map(|bounds| Aabb::new(within(bounds.min), within(bounds.max))).collect();
        let (tree, mut traversal, mut count) = (Tree::build(&near), Traversal::default(), 0);
        (0..).zip(&near).all(|(i, bounds)| {
            let counted = tree.overlapping(bounds, &mut traversal, |leaf| {
                let others =
                    leaf.iter().filter(|&&j| j > i && boxes[j as usize].overlaps(&boxes[i as usize]));
                count += words::size(others.count());
                if count > self.pairs_max { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            counted.is_continue()
        })
    }
}

/// How many pairs so many objects make.
fn pairs_of(objects: usize) -> u64 {
    let objects = words::size(objects);
    objects * objects.saturating_sub(1) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(count: u32, step: f64) -> Vec<Aabb> {
        sized_row(count, step, 1.0)
    }

    fn sized_row(count: u32, step: f64, unit: f64) -> Vec<Aabb> {
        let at = |i: u32| DVec3::X * step * f64::from(i);
        (0..count).map(|i| Aabb::new(at(i) * unit, (at(i) + DVec3::ONE) * unit)).collect()
    }

    /// Law: just as many pairs are admitted as may be, after whatever was admitted before.
    #[test]
    fn as_many_pairs_are_admitted_as_may_be() {
        for (pairs_max, step, is_few) in
            [(99, 0.9, true), (98, 0.9, false), (4950, 0.0, true), (4949, 0.0, false)]
        {
            let mut crowd = Crowd::new(pairs_max, 0.0, Motion::Sampled);
            for unit in [1.0, 1e-80, 1e98, 1e180] {
                assert!(crowd.admits(row(100, 20.0)));
                assert_eq!(crowd.admits(sized_row(100, step, unit)), is_few, "{pairs_max}, {unit}");
            }
        }
    }

    /// What moves a little is not counted again.
    #[test]
    fn there_is_room_to_move() {
        let mut crowd = Crowd::new(10, 0.0, Motion::Sampled);
        assert!(crowd.admits(row(100, 20.0)));
        let room = crowd.room.clone();
        assert!(crowd.admits(row(100, 20.001)));
        assert_eq!(crowd.room, room);
        assert!(crowd.admits(row(100, 20.1)));
        assert_ne!(crowd.room, room);
    }
}
