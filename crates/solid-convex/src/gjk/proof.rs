//! What showed whether two objects intersect, small enough to be kept for each of many pairs.

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};

use super::again::{contains_origin, search_from};
use super::intersection::{is_clear, robust_axis};
use super::lean::{Lean, Sure};
use super::pairs::Pair;
use super::task::{self, Task};
use crate::Support;
use crate::difference::{Difference, MinkowskiDifference, NO_VERTEX, SupportPoint};

/// Why two objects were apart, or why they were not: what is tried first when it is asked again (thesis, section 4.4.3, and for objects
/// that intersect likewise). Where more room may be taken, [`Memory`](super::Memory) knows more.
///
/// ```
/// use solid_convex::{Polytope, gjk::Proof};
/// use glam::{DAffine3, DVec3};
/// let corners = (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
/// let block = Polytope::new(corners.collect()).unwrap();
/// let mut proof = Proof::default();
/// let mut stood = 0;
/// for frame in 0..40 {
///     let moved = DAffine3::from_translation(DVec3::new(2.0 - 0.05 * f64::from(frame), 0.3, 0.2));
///     let found = proof.renew(&block, &DAffine3::IDENTITY, &block, &moved);
///     assert_eq!(found.intersect, moved.translation.x <= 1.0);
///     stood += u32::from(found.by_the_same);
/// }
/// assert!(stood > 30);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Proof {
    /// Nothing is known.
    #[default]
    None,
    /// A unit axis, from `B` to `A`, that separates them. Space: world.
    Apart(DVec3),
    /// Points of two polytopes whose differences contain the origin.
    Common(Vertices),
}

/// Four of the points of each of two polytopes, by index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertices([[u16; 2]; 4]);

/// Whether two objects intersect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// What [`intersects`](super::intersects) says.
    pub intersect: bool,
    /// Whether it was shown by the same as before.
    pub by_the_same: bool,
}

/// That of an axis, if there is one.
impl From<Option<DVec3>> for Proof {
    fn from(axis: Option<DVec3>) -> Self {
        axis.map_or(Proof::None, Proof::Apart)
    }
}

impl Vertices {
    /// Those that points of a difference are made of; `None` where these are no vertices.
    #[inline(always)]
    fn of([p, q, r, s]: &[SupportPoint; 4]) -> Option<Vertices> {
        let indices = [p.indices, q.indices, r.indices, s.indices];
        let greatest = indices.as_flattened().iter().fold(0, |greatest, &index| index.max(greatest));
        (greatest < NO_VERTEX).then_some(Vertices(indices))
    }

    /// The same as points of the objects of a difference.
    #[inline(always)]
    fn pairs(&self, difference: &impl MinkowskiDifference) -> Option<[Pair; 4]> {
        let &Vertices([p, q, r, s]) = self;
        let pair = {
            #[inline(always)]
            |indices: [u16; 2]| {
                let [a, b] = difference.vertices(indices)?;
                Some(Pair { a, b, indices })
            }
        };
        Some([pair(p)?, pair(q)?, pair(r)?, pair(s)?])
    }
}

impl Proof {
    /// Whether two objects intersect, where they are now, and why, in place of why they did or did not. What was kept may be of other objects:
    /// it is looked at, not believed. The placements must be finite, with entries of at most [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX). Cost: while
    /// the same shows it, one support point of each; of polytopes that intersect, none. Else that of a search from there.
    pub fn renew<A, B>(&mut self, a: &A, at_a: &DAffine3, b: &B, at_b: &DAffine3) -> Decision
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        match task::run(a, at_a, b, at_b, Renew(self)) {
            Renewed::Same => {
                return Decision { intersect: matches!(self, Proof::Common(_)), by_the_same: true };
            }
            Renewed::Apart(v) => *self = Proof::Apart(v.normalize()),
            Renewed::Common(vertices) => *self = vertices.map_or(Proof::None, Proof::Common),
            Renewed::Unknown => *self = robust_axis(&Difference::new(a, at_a, b, at_b)).into(),
        }
        Decision { intersect: !matches!(self, Proof::Apart(_)), by_the_same: false }
    }
}

/// A search for a proof, from one that is known.
struct Renew<'k>(&'k Proof);

enum Renewed {
    Same,
    /// An axis, of any length.
    Apart(DVec3),
    Common(Option<Vertices>),
    Unknown,
}

impl Task for Renew<'_> {
    type Found = Renewed;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Renewed {
        let (mut start, mut len) = ([Pair::ZERO; 4], 0);
        match self.0 {
            Proof::None => {}
            Proof::Apart(axis) => {
                let p = difference.support_against(*axis);
                if is_clear(*axis, axis.dot(p.w)) {
                    return Renewed::Same;
                }
                start[0] = Pair::from(&p);
                len = 1;
            }
            Proof::Common(vertices) => {
                if let Some(pairs) = vertices.pairs(difference) {
                    match contains_origin(pairs, difference) {
                        ControlFlow::Break(()) => return Renewed::Same,
                        ControlFlow::Continue(pairs) => (start, len) = (pairs, 3),
                    }
                }
            }
        }
        let mut lean = Lean::default();
        if !search_from(&start[..len], difference, &mut lean) {
            return Renewed::Unknown;
        }
        match lean.sure {
            Sure::Separated(_) => Renewed::Apart(lean.v),
            _ => Renewed::Common(Vertices::of(&lean.points)),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DQuat};

    use super::*;
    use crate::gjk::intersects;
    use crate::testing::placement;
    use crate::{Cuboid, Polytope};

    fn cloud(count: u32) -> Polytope {
        Polytope::new((0..count).map(|k| placement(k + 7 * count).translation.normalize()).collect()).unwrap()
    }

    /// Law: what a proof says is what a search from nothing says, as objects come together and part, of any size, under any maps, far off too.
    #[test]
    fn what_a_proof_shows_a_search_says_too() {
        let polytopes = [4, 20, 60, 400].map(cloud);
        let block = Cuboid::new(DVec3::new(1.0, 0.5, 1.5)).unwrap();
        let (mut same, mut common, mut total) = ([0, 0], 0, 0);
        for case in 0..400u32 {
            let kinds = [case as usize % 4, case as usize / 4 % 4];
            let [a, b] = kinds.map(|kind| &polytopes[kind]);
            let of_block = case % 11 == 0;
            let b: &dyn Support = if of_block { &block } else { b };
            let (unit, far) = [(1.0, 0.0), (1e-30, 0.0), (1e30, 0.0), (1.0, 1e7)][case as usize / 16 % 4];
            let shear =
                DMat3::from_cols(DVec3::X, DVec3::new(0.3, [1.0, 1e-3][case as usize % 2], 0.0), DVec3::Z);
            let mut proof = Proof::None;
            for frame in 0..60 {
                let turn =
                    DQuat::from_axis_angle(placement(case).translation.normalize(), 0.03 * f64::from(frame));
                let apart = 2.5 * (f64::from(frame + case) * 0.1).sin();
                let at = |linear: DMat3, way: DVec3| DAffine3 {
                    matrix3: linear * unit,
                    translation: (way + far) * unit,
                };
                let at_a = at(shear, DVec3::ZERO);
                let at_b = at(DMat3::from_quat(turn), placement(case + 3).translation.normalize() * apart);
                let before = proof;
                let found = proof.renew(a, &at_a, b, &at_b);
                assert_eq!(found.intersect, intersects(a, &at_a, b, &at_b), "{case}, {frame}");
                assert!(!found.by_the_same || before == proof);
                assert_eq!(!found.intersect, matches!(proof, Proof::Apart(_)), "{case}, {frame}");
                assert!(!of_block || !matches!(proof, Proof::Common(_)));
                same[usize::from(found.intersect)] += u32::from(found.by_the_same);
                common += u32::from(matches!(proof, Proof::Common(_)));
                total += 1;
            }
        }
        println!("{same:?} of {total} were shown by the same; {common} can be kept");
        assert!(2 * same[0] > total && 5 * same[1] > total, "{same:?} of {total}");
    }

    /// A proof that is of other objects is not believed, nor are vertices that there are not.
    #[test]
    fn a_proof_of_other_objects_does_no_harm() {
        let polytopes = [60, 4].map(cloud);
        let block = Cuboid::new(DVec3::ONE).unwrap();
        for k in 0..200 {
            let (at_a, at_b) = (placement(k), placement(k + 1));
            let mut proof = Proof::None;
            let near = DAffine3::from_translation(0.5 * placement(k).translation.normalize());
            proof.renew(&polytopes[0], &DAffine3::IDENTITY, &polytopes[0], &near);
            assert!(matches!(proof, Proof::Common(_)));
            for (a, b) in
                [(&polytopes[1] as &dyn Support, &polytopes[1] as &dyn Support), (&block, &polytopes[1])]
            {
                let mut proof = proof;
                assert_eq!(proof.renew(a, &at_a, b, &at_b).intersect, intersects(a, &at_a, b, &at_b), "{k}");
            }
        }
    }

    /// Where an index would not fit, nothing is kept.
    #[test]
    fn vertices_beyond_the_last_index_are_not_kept() {
        let many = cloud(70_000);
        let mut kept = 0;
        for k in 0..50 {
            let mut proof = Proof::None;
            let at = DAffine3::from_translation(placement(k).translation.normalize());
            assert!(proof.renew(&many, &DAffine3::IDENTITY, &many, &at).intersect);
            if let Proof::Common(Vertices(vertices)) = proof {
                assert!(vertices.as_flattened().iter().all(|&index| index < NO_VERTEX));
                kept += 1;
            }
            let again = proof.renew(&many, &DAffine3::IDENTITY, &many, &at);
            assert_eq!(again, Decision { intersect: true, by_the_same: proof != Proof::None }, "{k}");
        }
        assert!((1..50).contains(&kept), "{kept}");
    }
}
