//! The same two objects, asked again and again: frame coherence.

use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};

use super::again::{contains_origin, differences, left_by, search_from};
use super::balls::Look;
use super::clock::Clock;
use super::descent::{End, Goal, descend_robustly};
use super::distance::{Answer, Measure, Measured, measure};
use super::intersection::is_clear;
use super::lean::{Lean, Sure};
use super::pairs::{Pair, Pairs};
use super::task::{self, Task};
use super::{Closest, ClosestInWorld, Glance, Witness, closest_points, nearby_feature};
use crate::difference::{Difference, MinkowskiDifference, SUPPORT_ERROR, SupportPoint};
use crate::feature::sides_of_origin;
use crate::simd::dispatch;
use crate::simplex::Simplex;
use crate::{Polytope, Support, epa};

/// Two convex objects about which the same is asked frame after frame, as they move a little: what was found last is tried
/// first (thesis, section 4.4.3, and for objects that intersect likewise).
///
/// Whether they intersect is the same answer as from scratch, always. Their distance and their depth have the same error bounds, but
/// not always the same bits.
///
/// ```
/// use solid_convex::{Cuboid, gjk::{self, Coherent}};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let mut pair = Coherent::new(&block, &block);
/// for frame in 0..40 {
///     let moved = DAffine3::from_translation(DVec3::new(2.0 - 0.05 * f64::from(frame), 0.3, 0.2));
///     assert_eq!(pair.intersects(&DAffine3::IDENTITY, &moved), moved.translation.x <= 1.0);
///     let distance = pair.closest_points(&DAffine3::IDENTITY, &moved).distance;
///     assert!((distance - (moved.translation.x - 1.0).max(0.0)).abs() < 1e-12);
/// }
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Coherent<'a, A: ?Sized, B: ?Sized> {
    a: &'a A,
    b: &'a B,
    memory: Memory,
}

/// What [`Coherent`] keeps from one question to the next: to be handed on where the objects cannot be borrowed all the time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Memory {
    /// An axis that separated the objects, from `B` to `A`; zero for none. Space: world.
    pub(super) axis: DVec3,
    /// For how long the last sure answer is.
    clock: Clock,
    /// Four whose tetrahedron of differences contained the origin, or up to three whose hull of differences had the point closest to it.
    pub(super) pairs: Pairs,
}

impl<'a, A: Support + ?Sized, B: Support + ?Sized> Coherent<'a, A, B> {
    /// Two objects of which nothing is known yet.
    pub fn new(a: &'a A, b: &'a B) -> Self {
        Coherent::with_memory(a, b, Memory::default())
    }

    /// Two objects, and what was kept of the same two: of others, the answers may be wrong.
    pub fn with_memory(a: &'a A, b: &'a B, memory: Memory) -> Self {
        Coherent { a, b, memory }
    }

    /// What to keep for [`with_memory`](Coherent::with_memory).
    pub fn memory(&self) -> Memory {
        self.memory
    }

    /// What [`Memory::intersects`] says of them.
    pub fn intersects(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> bool {
        self.memory.intersects(self.a, placement_a, self.b, placement_b)
    }

    /// What [`Memory::penetration`] says of them.
    pub fn penetration(
        &mut self,
        placement_a: &DAffine3,
        placement_b: &DAffine3,
    ) -> Option<epa::Penetration> {
        self.memory.penetration(self.a, placement_a, self.b, placement_b)
    }

    /// What [`Memory::closest_points`] says of them.
    pub fn closest_points(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> Closest {
        self.memory.closest_points(self.a, placement_a, self.b, placement_b)
    }
}

/// # Questions
///
/// All must be asked about the same two objects, the first first: of others, the answers may be wrong.
impl Memory {
    /// Whether they intersect, by what was found last and how little they moved since: what [`intersects`](Memory::intersects) says, or
    /// `None`. Placements that it answers for are finite, and not near singular. Cost: some 40 to 150 sums and products, no support point.
    ///
    /// ```
    /// use solid_convex::{Cuboid, gjk::Memory};
    /// use glam::{DAffine3, DVec3};
    /// let block = Cuboid::new(DVec3::ONE)?;
    /// let mut memory = Memory::default();
    /// let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    /// assert!(!memory.intersects(&block, &at(0.0), &block, &at(3.0)));
    /// assert_eq!(memory.still(&at(0.0), &at(1.1)), Some(false));
    /// assert_eq!(memory.still(&at(0.0), &at(0.9)), None);
    /// # Ok::<(), solid_convex::SizeError>(())
    /// ```
    #[inline]
    pub fn still(&self, placement_a: &DAffine3, placement_b: &DAffine3) -> Option<bool> {
        self.clock.answer(&self.pairs, placement_a, placement_b)
    }

    /// Whether they intersect: exactly when [`intersection`](super::intersection()) does not say
    /// [`Separated`](super::Outcome::Separated). Cost: while they moved by less than the room that the last answer had, no support
    /// point; then, while the axis that separated them does, one of each; while the four pairs of points that showed an overlap do, none.
    pub fn intersects<A, B>(&mut self, a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let still = self.still(placement_a, placement_b);
        still.unwrap_or_else(|| self.intersects_anew(a, placement_a, b, placement_b))
    }

    /// What [`still`](Memory::still) says, as a part of a kernel.
    #[inline(always)]
    #[doc(hidden)]
    pub fn still_by<S: Simd>(&self, simd: S, placement_a: &DAffine3, placement_b: &DAffine3) -> Option<bool> {
        self.clock.answer_by(simd, &self.pairs, placement_a, placement_b)
    }

    /// What [`glance_by`](super::glance_by) says, or the axis that separated the polytopes last, when [`still`](Memory::still) said nothing.
    /// Of an answer, that will know for how long it is.
    #[inline(always)]
    #[doc(hidden)]
    pub fn glance_by<S: Simd>(
        &mut self,
        simd: S,
        a: (&Polytope, &DAffine3),
        b: (&Polytope, &DAffine3),
    ) -> Glance {
        let Some(look) = Look::at(simd, a, b) else { return Glance::Unusual };
        let seen = look.glance();
        if let Glance::Sure(meet) = seen {
            self.clock.set_by_balls(a, b, &look, meet);
        } else if self.axis != DVec3::ZERO {
            if let Some(gap) = look.gap_along(simd, a, b, self.axis) {
                self.clock.set_similar_apart(a, b, &look, self.axis, gap);
                return Glance::Sure(false);
            }
            self.axis = DVec3::ZERO;
        }
        seen
    }

    /// That a question was answered by other means: what [`still`](Memory::still) knew is forgotten. It ran
    /// out, and asking it again is seldom worth it before the next search.
    #[inline]
    pub fn rest(&mut self) {
        self.clock.stop();
    }

    /// The same, when [`still`](Memory::still) was asked already, and said nothing.
    pub fn intersects_anew<A, B>(
        &mut self,
        a: &A,
        placement_a: &DAffine3,
        b: &B,
        placement_b: &DAffine3,
    ) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let (placed_a, placed_b) = ((a, placement_a), (b, placement_b));
        match task::run(a, placement_a, b, placement_b, Intersects { memory: self }) {
            Said::Apart { gap } => {
                self.clock.set_apart(placed_a, placed_b, self.axis, gap);
                false
            }
            Said::Common => {
                self.clock.set_common(placed_a, placed_b);
                true
            }
            Said::Nothing => self.intersects_robustly(&Difference::new(a, placement_a, b, placement_b)),
        }
    }

    #[cold]
    fn intersects_robustly<A, B>(&mut self, difference: &Difference<A, B>) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if self.tetrahedron(difference).is_some() {
            return true;
        }
        let descent = descend_robustly(difference, Goal::Separation);
        self.keep(descent.end == End::Separated, descent.v, descent.simplex.points());
        descent.end != End::Separated
    }

    /// How deep they are in each other, as [`epa::penetration`] within the same error; `None` exactly when that says so. Cost: while
    /// the axis that separated them does, one support point of each; while the four pairs of points that showed an overlap do,
    /// the search for the depth alone.
    ///
    /// ```
    /// use solid_convex::{Cuboid, epa, gjk::Coherent};
    /// use glam::{DAffine3, DVec3};
    /// let block = Cuboid::new(DVec3::ONE)?;
    /// let mut pair = Coherent::new(&block, &block);
    /// for frame in 0..40 {
    ///     let moved = DAffine3::from_translation(DVec3::new(1.5 - 0.03 * f64::from(frame), 0.0, 0.0));
    ///     let depth = pair.penetration(&DAffine3::IDENTITY, &moved).map(|found| found.depth);
    ///     assert_eq!(depth.is_some(), moved.translation.x <= 1.0);
    ///     assert!(depth.is_none_or(|depth| (depth - (1.0 - moved.translation.x)).abs() < 1e-12));
    /// }
    /// # Ok::<(), solid_convex::SizeError>(())
    /// ```
    pub fn penetration<A, B>(
        &mut self,
        a: &A,
        placement_a: &DAffine3,
        b: &B,
        placement_b: &DAffine3,
    ) -> Option<epa::Penetration>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if !self.intersects(a, placement_a, b, placement_b) {
            return None;
        }
        let difference = Difference::new(a, placement_a, b, placement_b);
        let kept = self.tetrahedron(&difference);
        let simplex = kept.unwrap_or_else(|| descend_robustly(&difference, Goal::Separation).simplex);
        Some(epa::penetration_from(a, placement_a, b, placement_b, &simplex))
    }

    /// The closest points, as [`closest_points`] within the same error. Cost: where the points lie on the same
    /// features as before, one support point of each object.
    pub fn closest_points<A, B>(
        &mut self,
        a: &A,
        placement_a: &DAffine3,
        b: &B,
        placement_b: &DAffine3,
    ) -> Closest
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if a.core_radius() + b.core_radius() > 0.0 {
            // The cores, which are not what is kept, are as fast from scratch.
            return closest_points(a, placement_a, b, placement_b);
        }
        let difference = Difference::new(a, placement_a, b, placement_b);
        if let Some(simplex) = self.tetrahedron(&difference) {
            return Closest { distance: 0.0, points: Witness::of(&simplex) };
        }
        let (pairs, len) = self.start(&difference);
        let task = Measure { bound: f64::INFINITY, warm: &pairs[..len] };
        let found = measure(a, placement_a, b, placement_b, task);
        let Measured { closest, v, points, len } = found.expect("every distance is finite");
        self.keep(closest.distance > 0.0, v, &points[..len]);
        closest
    }

    /// What [`closest_points`](Memory::closest_points) says of two polytopes, within the same error, where a search without care is enough. Of
    /// placements and of no answer, see [`quickly_closest`](super::quickly_closest).
    ///
    /// ```
    /// use solid_convex::{Polytope, gjk::Memory};
    /// use glam::{DAffine3, DVec3};
    /// let corners = (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
    /// let block = Polytope::new(corners.collect()).unwrap();
    /// let mut memory = Memory::default();
    /// for frame in 0..40 {
    ///     let right = DAffine3::from_translation(DVec3::new(3.0 - 0.01 * f64::from(frame), 0.5, 0.5));
    ///     let found = memory.quickly_closest(&block, &DAffine3::IDENTITY, &block, &right).unwrap();
    ///     assert!((found.distance - (right.translation.x - 1.0)).abs() < 1e-12);
    /// }
    /// ```
    #[inline]
    pub fn quickly_closest(
        &mut self,
        a: &Polytope,
        placement_a: &DAffine3,
        b: &Polytope,
        placement_b: &DAffine3,
    ) -> Option<ClosestInWorld> {
        dispatch!(move simd => {
            match self.nearby_closest(simd, (a, placement_a), (b, placement_b)) {
                None => self.search_closest(a, placement_a, b, placement_b),
                found => found,
            }
        })
    }

    /// What [`quickly_closest`](Memory::quickly_closest) finds near to what was found last, as a part of a kernel; else `None`, and
    /// [`search_closest`](Memory::search_closest) is to be asked.
    #[inline(always)]
    #[doc(hidden)]
    pub fn nearby_closest<S: Simd>(
        &mut self,
        simd: S,
        a: (&Polytope, &DAffine3),
        b: (&Polytope, &DAffine3),
    ) -> Option<ClosestInWorld> {
        nearby_feature::closest(simd, self, a, b)
    }

    /// The same by a search, which is out of the way of the kernel.
    #[cold]
    #[inline(never)]
    #[doc(hidden)]
    pub fn search_closest(
        &mut self,
        a: &Polytope,
        placement_a: &DAffine3,
        b: &Polytope,
        placement_b: &DAffine3,
    ) -> Option<ClosestInWorld> {
        task::run_in_world(a, placement_a, b, placement_b, Renew { memory: self })
    }

    /// The pairs, to be changed: what is known otherwise is forgotten.
    #[inline(always)]
    pub(super) fn pairs_to_change(&mut self) -> &mut Pairs {
        self.clock.stop();
        self.axis = DVec3::ZERO;
        &mut self.pairs
    }

    /// The tetrahedron of the four kept pairs, when it still contains the origin: then no axis separates the objects.
    fn tetrahedron<A, B>(&self, difference: &Difference<A, B>) -> Option<Simplex>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if self.pairs.len() < 4 {
            return None;
        }
        let mut simplex = Simplex::new();
        for pair in self.pairs.all() {
            simplex.push(difference.point(pair.a, pair.b));
        }
        simplex.reduce_if_inside().then_some(simplex)
    }

    fn keep<'p>(&mut self, separated: bool, v: DVec3, points: impl IntoIterator<Item = &'p SupportPoint>) {
        self.clock.stop();
        self.axis = if separated { v.normalize_or_zero() } else { DVec3::ZERO };
        self.pairs = Pairs::of(points);
    }

    /// The pairs that a search begins with, and how many of them: those between which the closest point was; of a tetrahedron that contained the
    /// origin, the face by which it went out.
    #[inline(always)]
    fn start(&self, difference: &impl MinkowskiDifference) -> ([Pair; 4], usize) {
        let pairs = self.pairs.all();
        if self.pairs.len() < 4 {
            return (pairs, self.pairs.len());
        }
        (left_by(pairs, sides_of_origin(differences(&pairs, difference)).0), 3)
    }
}

/// Whether two objects intersect, by what is kept of them, or a search from there, whose end is kept in its place.
struct Intersects<'m> {
    memory: &'m mut Memory,
}

enum Said {
    /// By this gap at least. World units.
    Apart {
        gap: f64,
    },
    Common,
    Nothing,
}

impl Task for Intersects<'_> {
    type Found = Said;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Said {
        let Memory { axis, ref pairs, .. } = *self.memory;
        let scale = difference.scale();
        if axis != DVec3::ZERO {
            let along = axis.dot(difference.support_against(axis).w);
            if is_clear(axis, along) {
                return Said::Apart { gap: gap(axis, along) / scale };
            }
        }
        let (mut start, mut len) = (pairs.all(), pairs.len());
        if len == 4 {
            match contains_origin(start, difference) {
                ControlFlow::Break(()) => return Said::Common,
                ControlFlow::Continue(pairs) => (start, len) = (pairs, 3),
            }
        }
        let mut lean = Lean::default();
        if !search_from(&start[..len], difference, &mut lean) {
            return Said::Nothing;
        }
        let v = lean.v;
        match lean.sure {
            Sure::Separated(along) => {
                self.memory.keep(true, v, lean.points());
                Said::Apart { gap: gap(v, along) / (v.length() * scale) }
            }
            _ => {
                self.memory.keep(false, v, lean.points());
                Said::Common
            }
        }
    }
}

/// A lower bound of the gap along an axis, times its length, by its product with a support point against it. The difference's unit.
#[inline(always)]
fn gap(axis: DVec3, along: f64) -> f64 {
    along - SUPPORT_ERROR * axis.abs().element_sum()
}

/// The closest points, by a search from where the last one ended, which is kept in its place.
struct Renew<'m> {
    memory: &'m mut Memory,
}

impl Task for Renew<'_> {
    type Found = Option<Closest>;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Option<Closest> {
        let (pairs, len) = self.memory.start(difference);
        let search = Measure { bound: f64::INFINITY, warm: &pairs[..len] };
        let mut lean = Lean::default();
        match search.run_in(&mut lean, difference) {
            Answer::Closest(closest, v) => {
                self.memory.keep(closest.distance > 0.0, v, lean.points());
                Some(closest)
            }
            Answer::Beyond(_) | Answer::Unknown => None,
        }
    }
}
