//! The lean descent: the same search as [`descend`](super::descend), for the many pairs that are easy.
//!
//! It answers only where it is sure, by the evidence that the robust descent would accept: an axis along which the gap exceeds
//! the rounding error, a tetrahedron whose signs exceed theirs, a lower bound that is as good as the distance. For the rest
//! it says nothing, and the robust descent begins anew. So it may leave out whatever makes that one robust: no sliver is measured
//! twice, nothing is recomputed or taken back, and closest points are kept as quotients whose division is not needed to go on.

use glam::DVec3;

use super::descent::Goal;
use super::nearest::{Nearest, Square, closest_of_any, edge, face, tetrahedron};
use super::pairs::Pair;
use super::task::Task;
use super::{BEYOND_TOUCHING, Witness};
use crate::difference::{MinkowskiDifference, SUPPORT_ERROR, SupportPoint};
use crate::feature::{
    SLIVER_SINE_SQUARED, Within, sides_of_origin, weights_of_origin, within_edge, within_face,
};
use crate::simd::each;
use crate::simplex::Simplex;

/// Support points after which it gives up. A random pair of polytopes takes 3 of each object, in the mean, to tell whether it
/// intersects, and 5 to tell how far it is apart; what takes many times that is about to touch.
const STEPS_MAX: usize = 24;

/// After so many steps what is curved is told from near enough for Newton's method: with six, one of twenty pairs of a cylinder and a hull was not,
/// with eight one of a hundred.
const STEPS_BEFORE_NEWTON: usize = 8;

/// What that gave is the answer, or lacks a point or two.
const STEPS_AFTER_NEWTON: usize = 4;

/// So often Newton's method is tried: few take more than one.
const NEWTON_MAX: usize = 3;

/// The least square of twice a face's area, or of an edge: of slivers whose closest points have few right digits.
const DIVISOR_MIN: f64 = 1e-24;

/// What the lean descent is sure of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sure {
    /// The axis separates the objects: its product with any point of the difference is this, up to the error of a support point.
    Separated(f64),
    /// The four points contain the origin.
    Inside,
    /// The hull of the points has the point closest to the origin, within the goal's tolerance; the distance is at least this.
    Near(f64),
    /// The objects are further apart than the goal asks for.
    Beyond,
    /// Nothing.
    Nothing,
}

/// Where a lean descent ended. Space: the difference's own.
#[repr(align(32))]
pub(super) struct Lean {
    pub sure: Sure,
    /// The axis, or a vector along the shortest way from the origin to the hull; of any length.
    pub v: DVec3,
    /// The support points that it ended with are the first `len`, the oldest first.
    pub points: [SupportPoint; 4],
    len: usize,
}

impl Default for Lean {
    /// One that has not begun.
    #[inline(always)]
    fn default() -> Self {
        Lean { sure: Sure::Nothing, v: DVec3::ZERO, points: [SupportPoint::ZERO; 4], len: 0 }
    }
}

impl Lean {
    /// Begins anew.
    #[inline(always)]
    pub fn begin(&mut self) {
        (self.sure, self.len) = (Sure::Nothing, 0);
    }

    /// The support points that it ended with, the oldest first.
    pub fn points(&self) -> &[SupportPoint] {
        &self.points[..self.len.min(4)]
    }

    /// The common point, of objects that intersect: where the origin is in the tetrahedron.
    #[inline]
    pub fn common_point(&self) -> Witness {
        let (sides, _) = sides_of_origin(self.points.map(|p| p.w));
        if let Some(witness) = common_point(&self.points, sides) {
            return witness;
        }
        self.careful_common_point()
    }

    /// Of a flat tetrahedron, where the ratios have no right digit.
    #[cold]
    fn careful_common_point(&self) -> Witness {
        let mut simplex = self.simplex();
        simplex.reduce_if_inside();
        Witness::of(&simplex)
    }

    /// The closest point of the hull of up to three points, measured again by more careful means, with the points of the objects that
    /// it is the difference of; `None` where it takes yet more care.
    #[inline(always)]
    pub fn closest_point(&self) -> Option<(DVec3, Witness)> {
        let (v, weights) = match *self.points() {
            [p] => (p.w, [1.0, 0.0, 0.0]),
            [p, q] => {
                let (v, [x, y]) = within_edge([p.w, q.w]).ok()?;
                (v, [x, y, 0.0])
            }
            [p, q, r] => {
                let squares = [p.w.length_squared(), q.w.length_squared(), r.w.length_squared()];
                // Around the face from the corner nearest to the origin.
                let i = if squares[1] < squares[0] { 1 } else { 0 };
                let i = if squares[2] < squares[i] { 2 } else { i };
                let [j, k] = [[1, 2], [2, 0], [0, 1]][i];
                match within_face([self.points[i].w, self.points[j].w, self.points[k].w], SLIVER_SINE_SQUARED)
                {
                    Within::Face(v, [x, y, z]) => {
                        let mut weights = [0.0; 3];
                        (weights[i], weights[j], weights[k]) = (x, y, z);
                        (v, weights)
                    }
                    Within::Beyond(_) | Within::Sliver => return None,
                }
            }
            _ => return None,
        };
        let (mut on_a, mut on_b) = (DVec3::ZERO, DVec3::ZERO);
        for (point, weight) in self.points().iter().zip(weights) {
            on_a += point.a * weight;
            on_b += point.b * weight;
        }
        Some((v, Witness { on_a, on_b }))
    }

    /// The first three as pairs of points to begin with, and how many they are.
    fn pairs(&self) -> ([Pair; 3], usize) {
        (each([0, 1, 2], |i| Pair::from(&self.points[i])), self.points().len().min(3))
    }

    /// The same as a simplex that is not reduced.
    pub fn simplex(&self) -> Simplex {
        Simplex::of(self.points())
    }

    /// Drops those of up to three points whose bits are not set.
    #[inline(always)]
    fn keep(&mut self, bits: u8) {
        match bits {
            0b000 => {}
            0b010 => self.points[0] = self.points[1],
            0b100 => self.points[0] = self.points[2],
            0b101 => self.points[1] = self.points[2],
            0b110 => (self.points[0], self.points[1]) = (self.points[1], self.points[2]),
            _ => {}
        }
        self.len = bits.count_ones() as usize;
    }
}

/// Where the origin is in a tetrahedron, by the volumes that it makes with the faces, as a point of each object; `None` where that is not precise.
#[inline(always)]
fn common_point(points: &[SupportPoint; 4], sides: [f64; 4]) -> Option<Witness> {
    let (mut w, mut on_a, mut on_b) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for (point, weight) in points.iter().zip(weights_of_origin(sides)) {
        w += point.w * weight;
        on_a += point.a * weight;
        on_b += point.b * weight;
    }
    (w.length_squared() <= SUPPORT_ERROR * SUPPORT_ERROR).then_some(Witness { on_a, on_b })
}

/// A lean descent.
#[derive(Clone, Copy)]
pub(super) struct Search<'w> {
    pub goal: Goal,
    /// Pairs of local points, up to three, between whose differences the closest point was last.
    pub warm: &'w [Pair],
}

impl Task for Search<'_> {
    type Found = Lean;

    #[inline(always)]
    fn run(self, difference: &impl MinkowskiDifference) -> Lean {
        let mut lean = Lean::default();
        self.descend(&mut lean, difference);
        lean
    }
}

impl Search<'_> {
    /// Runs a descent in place: what it ends with is too large to be moved about.
    ///
    /// Of distances of what is curved, a few steps lead near enough for Newton's method.
    #[inline(always)]
    pub fn descend(self, lean: &mut Lean, difference: &impl MinkowskiDifference) {
        if difference.is_polytope() || !matches!(self.goal, Goal::DistanceWithin { .. }) {
            return self.walk(lean, difference, STEPS_MAX);
        }
        self.walk(lean, difference, STEPS_BEFORE_NEWTON);
        for _ in 0..NEWTON_MAX {
            if lean.sure != Sure::Nothing {
                break;
            }
            let nearer = difference.nearer(lean.points());
            let steps_max = if nearer.is_some() { STEPS_AFTER_NEWTON } else { STEPS_MAX };
            let (pairs, len) = nearer.unwrap_or_else(|| lean.pairs());
            lean.begin();
            Search { warm: &pairs[..len], ..self }.walk(lean, difference, steps_max);
        }
        // What touches is to do so for all questions.
        if matches!(lean.sure, Sure::Near(mu) if mu <= BEYOND_TOUCHING) {
            lean.sure = Sure::Nothing;
        }
    }

    /// Takes so many steps at most.
    // v / divisor: the point of conv(W) closest to the origin; p.w: a support point of A - B against v; W: the points.
    #[inline(always)]
    fn walk(self, lean: &mut Lean, difference: &impl MinkowskiDifference, steps_max: usize) {
        let mut v;
        let mut divisor = 1.0;
        let mut before = Square::INFINITE;
        if self.warm.is_empty() {
            v = difference.initial_direction();
        } else {
            for (place, &Pair { a, b, indices }) in lean.points.iter_mut().zip(self.warm.iter().take(3)) {
                *place = SupportPoint { indices, ..difference.point(a, b) };
            }
            lean.len = self.warm.len().min(3);
            let closest = closest_of_any(&mut lean.points, &mut lean.len);
            (v, divisor) = (closest.v, closest.divisor);
            before = closest.square();
            if !(divisor >= DIVISOR_MIN && before.is_sure()) {
                return;
            }
        }
        for _ in 0..steps_max {
            let p = difference.support_against(v);
            let vw = v.dot(p.w);
            if vw > SUPPORT_ERROR * v.abs().element_sum() {
                let sure = self.reached(v, divisor, vw, lean.len);
                if sure != Sure::Nothing {
                    (lean.sure, lean.v) = (sure, v);
                    return;
                }
            }
            let [x, y, z, _] = lean.points;
            let closest = match lean.len {
                0 => Nearest { v: p.w, divisor: 1.0, older: 0 },
                1 => edge(x.w, p.w),
                2 => face(x.w, y.w, p.w),
                _ => match tetrahedron(x.w, y.w, z.w, p.w) {
                    Some(closest) => closest,
                    None => {
                        (lean.points[3], lean.len) = (p, 4);
                        lean.sure = Sure::Inside;
                        return;
                    }
                },
            };
            lean.keep(closest.older);
            (lean.points[lean.len & 3], lean.len) = (p, (lean.len & 3) + 1);
            (v, divisor) = (closest.v, closest.divisor);
            let square = closest.square();
            // All of it at once, for a single branch.
            if !(square.is_progress_from(before) & (divisor >= DIVISOR_MIN) & square.is_sure()) {
                return;
            }
            before = square;
        }
    }

    /// What is sure, after `v` was found to separate the objects: `vw` is its product with a support point against it.
    #[inline(always)]
    fn reached(self, v: DVec3, divisor: f64, vw: f64, len: usize) -> Sure {
        let square = v.length_squared();
        let tolerance = match self.goal {
            Goal::Separation => return Sure::Separated(vw),
            // What exceeds the bound by its margin does so squared: most need no root.
            Goal::DistanceWithin { bound, .. }
                if vw * vw > bound * bound * square && self.goal.is_exceeded(vw / square.sqrt()) =>
            {
                return Sure::Beyond;
            }
            Goal::DistanceWithin { tolerance, .. } => tolerance,
            Goal::Gap { .. } => {
                let length = square.sqrt();
                let (distance, mu) = (length / divisor, vw / length);
                let near = len > 0 && self.goal.is_within_tolerance(distance, mu);
                return if near { Sure::Near(mu) } else { Sure::Nothing };
            }
        };
        if len > 0 && square - vw * divisor <= tolerance * square {
            Sure::Near(vw / square.sqrt())
        } else {
            Sure::Nothing
        }
    }
}
