//! The questions about two shapes, asked frame after frame.

use fearless_simd::Simd;
use glam::DAffine3;
use solid_convex::gjk::{Glance, Memory};
use solid_convex::simd::dispatch;

use super::{Distance, Penetration, placed, unchecked};
use crate::error::Result;
use crate::pair::{self, Scratch};
use crate::placement;
use crate::shape::Shape;
use crate::working::Working;

/// Two shapes about which the same is asked frame after frame, as they move a little: what was found last is tried first
/// (thesis, section 4.4.3). For pairs outside of a [`World`](crate::World), which does the like by itself.
///
/// Convex shapes gain most: while the axis, or the overlapping points, of the last frame still tell, a question costs a support point of
/// each, or none. Meshes and complex shapes gain that nothing is allocated any more. After a jump the answers are as right,
/// and cost what they cost without.
///
/// ```
/// use solid3d::{Shape, query::{self, PairCache}, glam::{DAffine3, DVec3}};
/// let block = Shape::cuboid([1.0, 1.0, 1.0])?;
/// let drum = Shape::cylinder(0.5, 1.0)?;
/// let mut pair = PairCache::new(&block, &drum);
/// for frame in 0..60 {
///     let moved = DAffine3::from_translation(DVec3::new(0.03 * f64::from(frame), 0.2, 0.1));
///     let meet = pair.intersects(&DAffine3::IDENTITY, &moved)?;
///     assert_eq!(meet, query::intersects(&block, &DAffine3::IDENTITY, &drum, &moved)?);
///     assert_eq!(meet, pair.distance(&DAffine3::IDENTITY, &moved)?.distance == 0.0);
/// }
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PairCache {
    a: Shape,
    b: Shape,
    /// Of these two shapes.
    memory: Memory,
    scratch: Working<Scratch>,
}

impl PairCache {
    /// Two shapes of which nothing is known yet. Cost: none to speak of; shapes share their geometry.
    pub fn new(a: &Shape, b: &Shape) -> PairCache {
        PairCache { a: a.clone(), b: b.clone(), memory: Memory::default(), scratch: Working::default() }
    }

    /// What [`intersects`](super::intersects) says, always.
    pub fn intersects(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> Result<bool> {
        dispatch!(move simd => {
            // Before anything is checked: placements that are near good ones are good.
            if let Some(answer) = self.memory.still_by(simd, placement_a, placement_b) {
                return Ok(answer);
            }
            match self.glance(simd, placement_a, placement_b) {
                Glance::Sure(answer) => Ok(answer),
                seen => self.intersects_at_length(placement_a, placement_b, seen),
            }
        })
    }

    #[inline(always)]
    fn glance<S: Simd>(&mut self, simd: S, placement_a: &DAffine3, placement_b: &DAffine3) -> Glance {
        if let (Some(a), Some(b)) = (self.a.polytope(), self.b.polytope()) {
            return self.memory.glance_by(simd, (a, placement_a), (b, placement_b));
        }
        let (a, b) = (unchecked(&self.a, placement_a), unchecked(&self.b, placement_b));
        let seen = pair::glance(simd, a, b);
        if matches!(seen, Glance::Sure(_)) {
            self.memory.rest();
        }
        seen
    }

    /// The same, where neither the last answer nor a glance tells.
    #[inline(never)]
    fn intersects_at_length(
        &mut self,
        placement_a: &DAffine3,
        placement_b: &DAffine3,
        seen: Glance,
    ) -> Result<bool> {
        if seen == Glance::Unusual {
            placement::checked("placement_a", placement_a)?;
            placement::checked("placement_b", placement_b)?;
        }
        let Self { a, b, memory, scratch } = self;
        let (a, b) = (unchecked(a, placement_a), unchecked(b, placement_b));
        Ok(pair::intersects_again(a, b, memory, scratch))
    }

    /// What [`distance`](super::distance()) says, with the same error, but not always the same bits.
    pub fn distance(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> Result<Distance> {
        dispatch!(move simd => {
            // Written once, where the caller has it: what is copied by wider words than it was written in is waited for.
            if let (Some(a), Some(b)) = (self.a.polytope(), self.b.polytope())
                && let Some(found) = self.memory.nearby_closest(simd, (a, placement_a), (b, placement_b))
            {
                return Ok(found.into());
            }
            self.distance_at_length(placement_a, placement_b)
        })
    }

    /// The same, where the last answer does not lead to the next.
    #[inline(never)]
    fn distance_at_length(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> Result<Distance> {
        let Self { a, b, memory, scratch } = self;
        if let (Some(a), Some(b)) = (a.polytope(), b.polytope())
            && let Some(found) = memory.search_closest(a, placement_a, b, placement_b)
        {
            return Ok(found.into());
        }
        let (on_a, on_b) = (unchecked(a, placement_a), unchecked(b, placement_b));
        if let Some(closest) = pair::quickly_closest(on_a, on_b) {
            return Ok(Distance::new(on_a, on_b, &closest));
        }
        let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
        Ok(Distance::new(a, b, &pair::closest_again(a, b, memory, scratch)))
    }

    /// What [`penetration`](super::penetration()) says, with the same error, but not always the same bits.
    ///
    /// ```
    /// use solid3d::{Shape, query::PairCache, glam::{DAffine3, DVec3}};
    /// let block = Shape::cuboid([1.0, 1.0, 1.0])?;
    /// let mut pair = PairCache::new(&block, &block);
    /// for frame in 0..30 {
    ///     let moved = DAffine3::from_translation(DVec3::new(1.5 - 0.03 * f64::from(frame), 0.0, 0.0));
    ///     let depth = pair.penetration(&DAffine3::IDENTITY, &moved)?.map(|found| found.depth);
    ///     assert!(depth.is_none_or(|depth| (depth - (1.0 - moved.translation.x)).abs() < 1e-12));
    ///     assert_eq!(depth.is_some(), moved.translation.x <= 1.0);
    /// }
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn penetration(
        &mut self,
        placement_a: &DAffine3,
        placement_b: &DAffine3,
    ) -> Result<Option<Penetration>> {
        let Self { a, b, memory, scratch } = self;
        let (a, b) = (placed("placement_a", a, placement_a)?, placed("placement_b", b, placement_b)?);
        let found = pair::penetration_again(a, b, memory, scratch);
        Ok(found.map(|found| Penetration::new(a, b, &found)))
    }
}
