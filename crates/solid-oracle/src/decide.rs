use glam::DVec3;

use crate::double_double::Vec3;
use crate::exact::{Dyadic, ExactVec3, Separation, contains_origin, separate};
use crate::placed::{PlacedPair, Vertex};
use crate::search::{Found, Limits, Simplex, search};

/// What was proven about a pair.
pub(crate) enum Decision {
    /// They share a point; the vertices of A-B around the origin that show it.
    Common(Vec<Vertex>),
    /// Bounds of their distance; `lower` is positive.
    Apart { lower: f64, upper: f64 },
    /// Neither; an upper bound of the distance and one of the depth.
    Open { distance_max: f64, depth_max: f64 },
}

/// Searches started from different directions before the exact cuts.
const STARTS_MAX: usize = 3;

/// Support points added by exact cuts before giving up.
const CUTS_MAX: usize = 40;

/// Searches, proves, and searches differently until something is proven.
pub(crate) fn decide(pair: &PlacedPair, limits: Limits) -> Decision {
    let mut distance_max = f64::INFINITY;
    let mut gap_best = f64::NEG_INFINITY;
    let mut met: Vec<Vertex> = Vec::new();
    for start in starts(pair) {
        let Found { simplex, encloses, axis } = search(pair, start, limits);
        if encloses && shows_common_point(pair, &simplex) {
            return Decision::Common(simplex.vertices);
        }
        let gap = pair.gap_along(&axis.to_exact());
        gap_best = gap_best.max(gap);
        distance_max = distance_max.min(distance_up(pair, &simplex));
        if gap > 0.0 {
            return Decision::Apart { lower: gap, upper: distance_max };
        }
        met.extend(simplex.vertices);
    }
    let cut = if pair.a.shape.is_polytope() && pair.b.shape.is_polytope() {
        separate_polytopes(pair)
    } else {
        cut_until_proven(pair, &mut met)
    };
    match cut {
        Cut::Common => Decision::Common(met),
        Cut::Gap(lower) => Decision::Apart { lower, upper: distance_max },
        Cut::Open => Decision::Open { distance_max, depth_max: -gap_best },
    }
}

/// The outcome of an exact linear program.
enum Cut {
    Common,
    Gap(f64),
    Open,
}

fn starts(pair: &PlacedPair) -> impl Iterator<Item = Vec3> {
    let centres = pair.offset();
    [centres, Vec3::from_f64(DVec3::new(0.6, -0.7, 0.4)), Vec3::from_f64(DVec3::new(-0.5, 0.3, 0.8))]
        .into_iter()
        .filter(|v| !v.is_zero())
        .take(STARTS_MAX)
}

fn shows_common_point(pair: &PlacedPair, simplex: &Simplex) -> bool {
    let points: Option<Vec<_>> = simplex.vertices.iter().map(|vertex| pair.proven(vertex)).collect();
    points.is_some_and(|points| contains_origin(&points))
}

/// A rigorous upper bound of the distance: the length of a weighted mean of proven points of A-B.
fn distance_up(pair: &PlacedPair, simplex: &Simplex) -> f64 {
    let mut mean = ExactVec3([Dyadic::ZERO, Dyadic::ZERO, Dyadic::ZERO]);
    let mut sum = Dyadic::ZERO;
    for (vertex, &weight) in simplex.vertices.iter().zip(&simplex.weights) {
        let Some(point) = pair.proven(vertex) else { return f64::INFINITY };
        if weight.is_negative() {
            return f64::INFINITY;
        }
        let weight = weight.to_exact();
        mean = &mean + &point.scaled_by(&weight);
        sum = &sum + &weight;
    }
    if sum.is_zero() {
        return f64::INFINITY;
    }
    -(-&mean.length_squared().sqrt_up()).div_down(&sum).round_down()
}

/// Decides two polytopes from all their corners.
fn separate_polytopes(pair: &PlacedPair) -> Cut {
    match separate(&pair.a.world_corners(), &pair.b.world_corners()) {
        Separation::Common => Cut::Common,
        Separation::Axis(axis) => Cut::Gap(pair.gap_along(&axis)),
    }
}

/// Cutting planes: while the points met leave the origin out, add the one that lies farthest beyond it.
fn cut_until_proven(pair: &PlacedPair, met: &mut Vec<Vertex>) -> Cut {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    met.extend(axes.iter().flat_map(|&d| [d, -d]).map(|d| pair.support(Vec3::from_f64(d))));
    let mut points: Vec<ExactVec3> = met.iter().filter_map(|vertex| pair.proven(vertex)).collect();
    let origin = [ExactVec3::from_f64(DVec3::ZERO)];
    for _ in 0..CUTS_MAX {
        if points.is_empty() {
            return Cut::Open;
        }
        let Separation::Axis(axis) = separate(&points, &origin) else { return Cut::Common };
        // All digits of the axis count where the points span less than a body: a needle next to a point.
        let gap = pair.gap_along(&axis);
        if gap > 0.0 {
            return Cut::Gap(gap);
        }
        let vertex = pair.support(-Vec3::from_exact(&axis.normalised()));
        let Some(point) = pair.proven(&vertex) else { return Cut::Open };
        if points.contains(&point) {
            return Cut::Open;
        }
        met.push(vertex);
        points.push(point);
    }
    Cut::Open
}
