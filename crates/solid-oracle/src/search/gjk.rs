use crate::double_double::{DoubleDouble, Vec3};
use crate::placed::PlacedPair;

use super::simplex::Simplex;

/// When to stop searching.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Stop when the distance is known up to this fraction of itself.
    pub(crate) relative_width: f64,
    /// Support points asked for at most.
    pub(crate) iterations_max: usize,
}

/// What the search believes.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Holds the point of A-B closest to the origin that was met, or encloses the origin.
    pub(crate) simplex: Simplex,
    /// The origin seems to lie in the simplex.
    pub(crate) encloses: bool,
    /// The axis (A above B) with the greatest gap or least overlap met.
    pub(crate) axis: Vec3,
}

/// Two vectors nearer to zero than this fraction of the coordinates they were computed from are rounding errors.
const ZERO_RELATIVE: f64 = 1e-30;

/// Iterations without a shorter v after which rounding has the upper hand.
const STALLS_MAX: usize = 3;

/// GJK from the direction `start`.
///
/// v: point of conv(W) closest to the origin; w: support point of A-B along -v. Gilbert, Johnson, Keerthi 1988.
pub(crate) fn search(pair: &PlacedPair, start: Vec3, limits: Limits) -> Found {
    let zero_squared = {
        let zero = pair.scale() * DoubleDouble::new(ZERO_RELATIVE);
        zero * zero
    };
    let width = DoubleDouble::new(limits.relative_width);
    let mut simplex = Simplex::default();
    let mut v = start;
    let mut axis = start;
    let mut best_gap = f64::NEG_INFINITY;
    let mut stalls = 0;
    for _ in 0..limits.iterations_max {
        let vertex = pair.support(-v);
        let progress = v.dot(vertex.w);
        let v_squared = v.length_squared();
        let gap = (progress / v_squared.sqrt()).to_f64();
        if gap > best_gap {
            (best_gap, axis) = (gap, v);
        }
        let started = !simplex.vertices.is_empty();
        if started && (v_squared - progress <= width * v_squared || simplex.contains(vertex.w)) {
            break;
        }
        let before = simplex.clone();
        simplex.vertices.push(vertex);
        if simplex.encloses_origin() {
            return Found { simplex, encloses: true, axis };
        }
        let closer = simplex.reduce();
        if closer.length_squared() <= zero_squared {
            return Found { simplex, encloses: true, axis };
        }
        if started && closer.length_squared() >= v_squared {
            stalls += 1;
            if stalls >= STALLS_MAX {
                simplex = before;
                break;
            }
        }
        v = closer;
    }
    Found { simplex, encloses: false, axis }
}
