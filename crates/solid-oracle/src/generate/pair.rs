use glam::{DAffine3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;

use super::{
    PlacementKind, direction, log_uniform, random_flat, random_placement, random_shape, random_sliver,
};
use crate::double_double::Vec3;
use crate::placed::PlacedPair;
use crate::search::{Limits, search};
use crate::shape::Convex;

/// How the two shapes of a pair relate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regime {
    /// Any two shapes, overlapping or a little apart.
    Random,
    /// Any two shapes, apart by `relative_gap` times the size or overlapping by that, up to the rounding of the
    /// translation. A shape without thickness is left on the other side of what it overlaps.
    NearTouching {
        /// Gap or overlap, relative to [`Pair::size`].
        relative_gap: f64,
    },
    /// One shape 1e1 to 1e9 times the other, near its surface.
    SizeRatio,
    /// Two plates, some without thickness.
    Flat,
    /// Both origins in the same place: nearly always intersecting.
    Concentric,
    /// Two needles, some without thickness.
    Sliver,
    /// As `Random`, 1e3 to 1e9 sizes away from the origin.
    FarFromOrigin,
}

/// Two placed shapes.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The first shape.
    pub a: Convex,
    /// Its placement.
    pub pa: DAffine3,
    /// The second shape.
    pub b: Convex,
    /// Its placement.
    pub pb: DAffine3,
    /// The length in which gaps are to be measured: about the extent of the smaller shape.
    pub size: f64,
}

/// A pair of that regime, its size between 1e-6 and 1e6.
pub fn random_pair(rng: &mut StdRng, regime: Regime) -> Pair {
    let size = log_uniform(rng, 1e-6, 1e6);
    match regime {
        Regime::Random => overlapping_or_apart(rng, size),
        Regime::FarFromOrigin => {
            let mut pair = overlapping_or_apart(rng, size);
            let away = direction(rng) * size * log_uniform(rng, 1e3, 1e9);
            pair.pa.translation += away;
            pair.pb.translation += away;
            pair
        }
        Regime::NearTouching { relative_gap } => {
            let pair = any(rng, size, random_shape);
            let sign = if rng.random() { 1.0 } else { -1.0 };
            with_gap(rng, pair, sign * relative_gap * size)
        }
        Regime::SizeRatio => {
            let ratio = log_uniform(rng, 1e1, 1e9).min(1e6 / size).max(10.0);
            let mut pair = any(rng, size, random_shape);
            (pair.a, pair.pa) = (random_shape(rng, size * ratio), any_placement(rng));
            if rng.random() {
                pair = Pair { a: pair.b, pa: pair.pb, b: pair.a, pb: pair.pa, size };
            }
            let gap = rng.random_range(-0.6..=0.4) * size;
            with_gap(rng, pair, gap)
        }
        Regime::Flat => {
            let pair = any(rng, size, random_flat);
            near(rng, pair)
        }
        Regime::Sliver => {
            // Two needles at random never meet: move them together, most of them to cross.
            let pair = any(rng, size, random_sliver);
            let gap = if rng.random_range(0..3) == 0 { size * log_uniform(rng, 1e-9, 1.0) } else { 0.0 };
            through_each_other(rng, pair, gap)
        }
        Regime::Concentric => {
            let mut pair = any(rng, size, random_shape);
            pair.pa.translation = direction(rng) * size;
            pair.pb.translation = pair.pa.translation;
            pair
        }
    }
}

fn any(rng: &mut StdRng, size: f64, shape: impl Fn(&mut StdRng, f64) -> Convex) -> Pair {
    let (a, b) = (shape(rng, size), shape(rng, size));
    Pair { a, pa: any_placement(rng), b, pb: any_placement(rng), size }
}

fn any_placement(rng: &mut StdRng) -> DAffine3 {
    let kind = PlacementKind::ALL[rng.random_range(0..PlacementKind::ALL.len())];
    random_placement(rng, kind)
}

/// B at a random part of the way to where its extent surely leaves that of A.
fn overlapping_or_apart(rng: &mut StdRng, size: f64) -> Pair {
    let pair = any(rng, size, random_shape);
    near(rng, pair)
}

/// How far B moves at most, in parts of the way after which the extents are surely apart; gives about 55 % hits.
const WAY_MAX: f64 = 1.15;

/// Moves B to a random part of the way along which the extents of both overlap.
fn near(rng: &mut StdRng, mut pair: Pair) -> Pair {
    let size = pair.size;
    pair.pa.translation *= size;
    pair.pb.translation = pair.pa.translation;
    let direction = direction(rng);
    let reach = placed(&pair).support(Vec3::from_f64(direction)).w.to_f64().dot(direction).max(0.0);
    pair.pb.translation += direction * reach * rng.random_range(0.0..=WAY_MAX);
    pair
}

/// Moves B so that the gap becomes `gap`, along the axis that separates the shapes when B is far away.
fn with_gap(rng: &mut StdRng, mut pair: Pair, gap: f64) -> Pair {
    let scale = placed(&pair).scale().to_f64();
    pair.pa.translation = direction(rng) * pair.size;
    pair.pb.translation = pair.pa.translation + direction(rng) * 3.0 * scale;
    // Twice, because the translation that closes a large distance is rounded coarsely.
    for _ in 0..2 {
        let Some((axis, current)) = separation(&pair) else { break };
        pair.pb.translation += axis * (current - gap);
    }
    pair
}

/// Moves B so that inner points of both coincide, then off by `gap` in a random direction.
fn through_each_other(rng: &mut StdRng, mut pair: Pair, gap: f64) -> Pair {
    let inner_a = inner_point(rng, &pair.a);
    let inner_b = inner_point(rng, &pair.b);
    pair.pa.translation = direction(rng) * pair.size;
    let meet = pair.pa.transform_point3(inner_a);
    pair.pb.translation = meet - pair.pb.matrix3 * inner_b + direction(rng) * gap;
    pair
}

/// A point between two support points, or the origin of the space of a shape that has it inside.
fn inner_point(rng: &mut StdRng, shape: &Convex) -> DVec3 {
    let direction = Vec3::from_f64(direction(rng));
    let (p, q) = (shape.support(direction).to_f64(), shape.support(-direction).to_f64());
    p.lerp(q, rng.random_range(0.0..=1.0))
}

fn placed(pair: &Pair) -> PlacedPair<'_> {
    PlacedPair::new(&pair.a, &pair.pa, &pair.b, &pair.pb)
}

/// The unit axis from B to A and the gap along it; `None` when the shapes seem to meet.
fn separation(pair: &Pair) -> Option<(DVec3, f64)> {
    let pair = placed(pair);
    if pair.offset().is_zero() {
        return None;
    }
    let found = search(&pair, pair.offset(), Limits { relative_width: 1e-10, iterations_max: 200 });
    let axis = found.axis.to_f64().try_normalize()?;
    let gap = pair.gap_along(&crate::exact::ExactVec3::from_f64(axis));
    (!found.encloses && gap > 0.0).then_some((axis, gap))
}
