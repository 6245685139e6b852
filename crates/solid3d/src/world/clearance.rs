//! How near is too near: the clearances of pairs, and how much boxes are grown for them.

use std::collections::HashMap;

use slotmap::SecondaryMap;
use solid_convex::MAGNITUDE_MAX;

use super::stirred::Staleness;
use super::{ObjectId, World};
use crate::bounds::Aabb;
use crate::error::{Error, Result};

/// How much more than half of a clearance a box is grown, relative to the clearance: the error of a distance is 1e-12 of it
/// ([`query::distance`](crate::query::distance)). The rest of that error, relative to the size of the data, is in the boxes
/// already.
const GROWTH_ERROR: f64 = 4e-12;

/// Fewer pairs than this are never searched for those of objects that are gone.
const SWEEP_MIN: usize = 64;

/// Clearances by default and per pair.
#[derive(Clone, Debug, Default)]
pub(super) struct Clearances {
    default: f64,
    /// The lesser id first. Ids never come back, so pairs of objects that are gone do no harm until they are dropped.
    pairs: HashMap<(ObjectId, ObjectId), f64>,
    /// How many pairs there may be before those of objects that are gone are dropped: twice as many as were left then.
    sweep_at: usize,
    /// Of objects whose boxes are grown for more than the default: the greatest clearance that was set for a pair with it, which is more.
    greatest: SecondaryMap<ObjectId, f64>,
}

impl Clearances {
    /// The clearance of a pair, in whichever order.
    pub fn of(&self, a: ObjectId, b: ObjectId) -> f64 {
        if self.pairs.is_empty() {
            return self.default;
        }
        self.pairs.get(&(a.min(b), a.max(b))).copied().unwrap_or(self.default)
    }

    /// What the box of an object is grown for.
    fn of_box(&self, id: ObjectId) -> f64 {
        self.greatest.get(id).copied().unwrap_or(self.default)
    }

    /// Grows boxes so that each overlaps that of another object wherever the two are nearer than their clearance.
    pub fn grow<'a>(&self, boxes: impl IntoIterator<Item = (ObjectId, &'a mut Aabb)>) {
        if self.default == 0.0 && self.greatest.is_empty() {
            return;
        }
        for (id, bounds) in boxes {
            let clearance = self.of_box(id);
            if clearance == 0.0 {
                continue;
            }
            let Aabb { min, max } = bounds.inflated(clearance * (0.5 + GROWTH_ERROR));
            // To the next numbers outside, for the sums are rounded.
            *bounds = Aabb::new(min.map(f64::next_down), max.map(f64::next_up));
        }
    }

    fn set(&mut self, a: ObjectId, b: ObjectId, clearance: f64, is_there: impl Fn(ObjectId) -> bool) {
        if self.pairs.len() >= self.sweep_at.max(SWEEP_MIN) {
            self.pairs.retain(|&(a, b), _| is_there(a) && is_there(b));
            self.sweep_at = 2 * self.pairs.len();
        }
        self.pairs.insert((a.min(b), a.max(b)), clearance);
    }

    /// Has the box of an object grown for a clearance too; whether it was for less.
    fn raise(&mut self, id: ObjectId, clearance: f64) -> bool {
        let is_more = clearance > self.of_box(id);
        if is_more {
            self.greatest.insert(id, clearance);
        }
        is_more
    }

    /// Forgets an object that is gone.
    pub fn forget(&mut self, id: ObjectId) {
        self.greatest.remove(id);
    }
}

/// # Clearances
impl World {
    /// Sets how near two objects may come that have no clearance of their own, in world units; 0 at first. See
    /// [`near`](World::near).
    ///
    /// The box of an object in the broad phase is grown by half of this, or of the greatest clearance that was set for a pair with it; so a
    /// clearance costs tests of pairs that are apart, and no answer of a test changes. It shrinks again when this clearance is set. Cost of
    /// setting one: as if everything had moved.
    ///
    /// Errors: a clearance that is not from 0 to [`MAGNITUDE_MAX`].
    ///
    /// ```
    /// use solid3d::World;
    /// let mut world = World::new();
    /// world.set_clearance(0.05)?;
    /// let error = world.set_clearance(f64::NAN).unwrap_err();
    /// assert_eq!(error.to_string(), "clearance is NaN; it must be from 0 to 1e100");
    /// assert_eq!(world.clearance(), 0.05);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn set_clearance(&mut self, clearance: f64) -> Result<()> {
        self.clearances.default = checked(clearance)?;
        self.clearances.greatest.clear();
        let pairs = std::mem::take(&mut self.clearances.pairs);
        for (&(a, b), &clearance) in &pairs {
            // Some may be of objects that were removed since.
            if self.objects.contains_key(a) && self.objects.contains_key(b) {
                self.clearances.raise(a, clearance);
                self.clearances.raise(b, clearance);
            }
        }
        self.clearances.pairs = pairs;
        let ids: Vec<_> = self.objects.keys().collect();
        ids.into_iter().for_each(|id| self.stir(id, Staleness::Bounds));
        Ok(())
    }

    /// The clearance of pairs that have none of their own.
    pub fn clearance(&self) -> f64 {
        self.clearances.default
    }

    /// Sets how near two objects may come, in whichever order, in place of [`clearance`](World::clearance).
    ///
    /// Cost: as if the two objects had moved.
    ///
    /// Errors: as [`set_clearance`](World::set_clearance); an object that is not in the world, or twice the same.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}};
    /// let mut world = World::new();
    /// world.set_clearance(0.5)?;
    /// let ball = Shape::sphere(1.0)?;
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// let [a, b, c] = [0.0, 2.25, 5.0].map(|x| world.add(&ball, at(x)).unwrap());
    /// world.set_pair_clearance(b, c, 1.0)?;
    /// let near: Vec<_> = world.near().iter().map(|near| (near.a, near.b, near.distance)).collect();
    /// assert_eq!(near, [(a, b, 0.25), (b, c, 0.75)]);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn set_pair_clearance(&mut self, a: ObjectId, b: ObjectId, clearance: f64) -> Result<()> {
        self.check_pair(a, b)?;
        checked(clearance)?;
        let Self { clearances, objects, .. } = self;
        clearances.set(a, b, clearance, |id| objects.contains_key(id));
        for id in [a, b] {
            if self.clearances.raise(id, clearance) {
                self.stir(id, Staleness::Bounds);
            }
        }
        self.stir_pair(a, b);
        Ok(())
    }

    /// Drops the clearance set for a pair.
    pub fn reset_pair_clearance(&mut self, a: ObjectId, b: ObjectId) -> Result<()> {
        self.check_pair(a, b)?;
        self.clearances.pairs.remove(&(a.min(b), a.max(b)));
        self.stir_pair(a, b);
        Ok(())
    }

    /// The clearance that holds for a pair.
    pub fn pair_clearance(&self, a: ObjectId, b: ObjectId) -> Result<f64> {
        self.check_pair(a, b)?;
        Ok(self.clearances.of(a, b))
    }
}

fn checked(clearance: f64) -> Result<f64> {
    if (0.0..=MAGNITUDE_MAX).contains(&clearance) {
        Ok(clearance)
    } else {
        Err(Error::Clearance { value: clearance })
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::Shape;

    /// What is set for a pair costs nothing elsewhere.
    #[test]
    fn boxes_of_a_pair_alone_are_grown_for_it() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let at = |i: i32| DAffine3::from_translation(3.0 * glam::DVec3::X * f64::from(i));
        let ids: Vec<_> = (0..100).map(|i| world.add(&ball, at(i)).unwrap()).collect();
        world.near();
        world.set_pair_clearance(ids[1], ids[3], 4.5)?;
        let before = world.statistics().examined;
        let near = world.near();
        assert_eq!((near.len(), near[0].a, near[0].b, near[0].distance), (1, ids[1], ids[3], 4.0));
        // The two, and each with those beside it.
        assert_eq!(world.statistics().examined - before, 5);
        Ok(())
    }

    /// Objects that come and go leave no more pairs behind than there are.
    #[test]
    fn what_removed_objects_leave_is_bounded() -> Result<()> {
        let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
        let stays = world.add(&ball, DAffine3::IDENTITY)?;
        for _ in 0..10 * SWEEP_MIN {
            let goes = world.add(&ball, DAffine3::IDENTITY)?;
            world.set_pair_clearance(stays, goes, 1.0)?;
            assert_eq!(world.pair_clearance(goes, stays), Ok(1.0));
            world.remove(goes)?;
        }
        assert!(world.clearances.pairs.len() <= SWEEP_MIN && world.clearances.greatest.len() == 1);
        Ok(())
    }
}
