//! The same two objects, asked again and again: frame coherence.

use glam::{DAffine3, DVec3};

use super::descent::{End, Goal, descend_robustly};
use super::distance::{Measure, Measured, measure};
use super::intersection::clearly_separates;
use super::lean::{self, Lean, Search, Sure, Task};
use super::{Closest, Witness, closest_points};
use crate::difference::{Difference, SupportPoint};
use crate::simplex::{Simplex, VOLUME_ERROR, sides_of_origin};
use crate::{Support, epa};

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
    axis: DVec3,
    /// Pairs of points, one of each object: the first `len` of them. Four whose tetrahedron of differences contained the
    /// origin, or up to three whose hull of differences had the point closest to it.
    pairs: [Pair; 4],
    len: u8,
}

/// A point of each object, each in its local space.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair {
    pub a: DVec3,
    pub b: DVec3,
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

    /// Whether they intersect: exactly when [`intersection`](super::intersection) does not say
    /// [`Separated`](super::Outcome::Separated). Cost: while the axis that separated them does, one support point of each; while the
    /// four pairs of points that showed an overlap do, none.
    pub fn intersects(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> bool {
        let found = lean::run(self.a, placement_a, self.b, placement_b, Again { memory: &self.memory });
        let lean = match found {
            Found::Separated => return false,
            Found::Inside => return true,
            Found::Unknown => None,
            Found::Anew(lean) => Some(lean),
        };
        match lean {
            Some(lean) if matches!(lean.sure, Sure::Separated | Sure::Inside) => {
                self.memory.keep(lean.sure == Sure::Separated, lean.v, lean.points());
                lean.sure == Sure::Inside
            }
            _ => self.intersects_robustly(&Difference::new(self.a, placement_a, self.b, placement_b)),
        }
    }

    #[cold]
    fn intersects_robustly(&mut self, difference: &Difference<A, B>) -> bool {
        if self.memory.len == 4 && self.tetrahedron(difference).is_some() {
            return true;
        }
        let descent = descend_robustly(difference, Goal::Separation);
        self.memory.keep(descent.end == End::Separated, descent.v, descent.simplex.points());
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
    pub fn penetration(
        &mut self,
        placement_a: &DAffine3,
        placement_b: &DAffine3,
    ) -> Option<epa::Penetration> {
        if !self.intersects(placement_a, placement_b) {
            return None;
        }
        let difference = Difference::new(self.a, placement_a, self.b, placement_b);
        let kept = (self.memory.len == 4).then(|| self.tetrahedron(&difference)).flatten();
        let simplex = kept.unwrap_or_else(|| descend_robustly(&difference, Goal::Separation).simplex);
        Some(epa::penetration_from(self.a, placement_a, self.b, placement_b, &simplex))
    }

    /// The closest points, as [`closest_points`](super::closest_points) within the same error. Cost: where the points lie on the same
    /// features as before, two support points of each object.
    pub fn closest_points(&mut self, placement_a: &DAffine3, placement_b: &DAffine3) -> Closest {
        if self.a.core_radius() + self.b.core_radius() > 0.0 {
            // The cores, which are not what is kept, are as fast from scratch.
            return closest_points(self.a, placement_a, self.b, placement_b);
        }
        if self.memory.len == 4 {
            let difference = Difference::new(self.a, placement_a, self.b, placement_b);
            if let Some(simplex) = self.tetrahedron(&difference) {
                return Closest { distance: 0.0, points: Witness::of(&simplex) };
            }
        }
        let task = Measure { bound: f64::INFINITY, warm: self.memory.nearest() };
        let found = measure(self.a, placement_a, self.b, placement_b, task);
        let Measured { closest, v, points, len } = found.expect("every distance is finite");
        self.memory.keep(closest.distance > 0.0, v, &points[..len]);
        closest
    }

    /// The tetrahedron of the four kept pairs, when it still contains the origin: then no axis separates the objects.
    fn tetrahedron(&self, difference: &Difference<A, B>) -> Option<Simplex> {
        let mut simplex = Simplex::new();
        for pair in &self.memory.pairs {
            simplex.push(difference.point(pair.a, pair.b));
        }
        simplex.reduce_if_inside().then_some(simplex)
    }
}

impl Memory {
    fn keep<'p>(&mut self, separated: bool, v: DVec3, points: impl IntoIterator<Item = &'p SupportPoint>) {
        self.axis = if separated { v.normalize_or_zero() } else { DVec3::ZERO };
        self.len = 0;
        for (pair, p) in self.pairs.iter_mut().zip(points) {
            *pair = Pair { a: p.a, b: p.b };
            self.len += 1;
        }
    }

    /// The pairs between which the closest point was.
    fn nearest(&self) -> &[Pair] {
        let len = if self.len < 4 { self.len } else { 0 };
        &self.pairs[..usize::from(len)]
    }
}

/// Whether two objects intersect, by what is kept of them, else from scratch.
struct Again<'m> {
    memory: &'m Memory,
}

/// What [`Again`] found.
#[expect(clippy::large_enum_variant, reason = "it is looked at where it is made, and never stored")]
enum Found {
    /// The kept axis clearly separates them.
    Separated,
    /// The kept tetrahedron contains the origin.
    Inside,
    /// The kept tetrahedron is too close to tell.
    Unknown,
    /// What is kept is of no use any more.
    Anew(Lean),
}

impl Task for Again<'_> {
    type Found = Found;

    #[inline(always)]
    fn run<A, B>(self, difference: &Difference<A, B>, against: impl Fn(DVec3) -> SupportPoint) -> Found
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let Memory { axis, pairs, len } = self.memory;
        if *axis != DVec3::ZERO && clearly_separates(*axis, against(*axis).w) {
            return Found::Separated;
        }
        if *len == 4 {
            let (sides, least) = sides_of_origin(pairs.map(|pair| difference.point(pair.a, pair.b).w));
            if least <= VOLUME_ERROR {
                return Found::Unknown;
            }
            if sides.iter().all(|&side| side > 0.0) {
                return Found::Inside;
            }
        }
        Found::Anew(Search { goal: Goal::Separation, warm: &[] }.run(difference, against))
    }
}
