//! Penetration depth of all kinds of shapes, judged by the oracle's bounds and by its own laws.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking and says what it did")]

mod common;

use common::{in_cube, placement, random_complex, random_mesh, rescaled};
use glam::{DAffine3, DVec3};
use rand::Rng;
use solid_oracle::generate::{Pair, Regime, random_pair, seeded};
use solid_oracle::{Convex, penetration_bounds};
use solid3d::convex::epa::DEPTH_TOLERANCE;
use solid3d::convex::gjk::TOUCHING_ERROR;
use solid3d::query::{self, Penetration};
use solid3d::{Shape, glam};

const SEED: u64 = 20_261;
/// Pairs of a regime.
const PAIRS: usize = 1_500;

/// A length that bounds the extents of both shapes and the distance of their origins.
fn size_of(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> f64 {
    let extent = |shape: &Shape, at: &DAffine3| {
        let here = DAffine3 { translation: DVec3::ZERO, ..*at };
        let bounds = query::bounds(shape, &here).unwrap();
        bounds.min.abs().max(bounds.max.abs()).max_element()
    };
    extent(a, pa) + extent(b, pb) + (pa.translation - pb.translation).abs().max_element()
}

/// What the answers of a regime were like.
#[derive(Debug, Default)]
struct Tally {
    tested: usize,
    hits: usize,
    /// Of those that the oracle is certain about.
    judged: usize,
    /// Bounds further apart than is said of most.
    wide: usize,
    /// How far the depth was beyond the oracle's bounds, in parts of the stated error.
    worst: f64,
    /// The widest bounds, relative to the depth and 1e-12 of the size.
    widest: f64,
}

impl Tally {
    fn judge(&mut self, pair: &Pair, context: &str) {
        let Pair { a: reference_a, pa, b: reference_b, pb, .. } = pair;
        let (Ok(a), Ok(b)) = (common::try_shape_of(reference_a), common::try_shape_of(reference_b)) else { return };
        self.tested += 1;
        let found = query::penetration(&a, pa, &b, pb).unwrap();
        let intersects = query::intersects(&a, pa, &b, pb).unwrap();
        assert_eq!(found.is_some(), intersects, "{context}");
        let Some(found) = found else { return };
        self.hits += 1;
        let size = size_of(&a, pa, &b, pb);
        assert_is_consistent(&found, pa, pb, size, context);
        let stated = DEPTH_TOLERANCE * found.depth + TOUCHING_ERROR * size;
        let width = (found.depth_max - found.depth_min) / stated;
        self.widest = self.widest.max(width);
        self.wide += usize::from(width > 2.0);
        assert_parts(&a, pa, &b, pb, &found, size, context);
        if let Some((lower, upper)) = penetration_bounds(reference_a, pa, reference_b, pb) {
            self.judged += 1;
            let error = TOUCHING_ERROR * size;
            assert!(found.depth_max >= lower - error, "{context}: {found:?}, but the depth is at least {lower}");
            assert!(found.depth_min <= upper + error, "{context}: {found:?}, but the depth is at most {upper}");
            let beyond = (lower - found.depth).max(found.depth - upper).max(0.0);
            self.worst = self.worst.max(beyond / (stated + (found.depth_max - found.depth_min)));
        }
    }

    fn finish(self, what: &str, hits: std::ops::RangeInclusive<usize>) {
        println!("{what}, seed {SEED}: {self:?}");
        let Tally { tested, hits: hit, judged, wide, worst, .. } = self;
        assert!(hits.contains(&(100 * hit / tested)), "{what}: {hit} of {tested} is not representative");
        assert!(judged * 10 >= hit * 8, "{what}: the oracle must be certain of most, not of {judged} of {hit}");
        assert!(worst <= 1.0, "{what}: {worst} times the stated error");
        assert!(wide * 50 <= hit, "{what}: {wide} of {hit} are less certain than they should be");
    }
}

/// The parts of an answer fit to each other.
fn assert_is_consistent(found: &Penetration, pa: &DAffine3, pb: &DAffine3, size: f64, context: &str) {
    let Penetration { depth, depth_min, depth_max, normal, point_on_a, point_on_b } = *found;
    assert!((0.0..=depth).contains(&depth_min) && depth <= depth_max && depth_max.is_finite(), "{context}: {found:?}");
    assert!((normal.length() - 1.0).abs() < 1e-12, "{context}: {found:?}");
    let coordinates = 8.0 * f64::EPSILON * (pa.translation.abs().max(pb.translation.abs()).max_element() + size);
    let missed = (point_on_b - point_on_a).distance(normal * depth);
    let uncertain = depth_max - depth_min;
    let limit = (depth * uncertain).sqrt() + uncertain + 4.0 * DEPTH_TOLERANCE * depth + 1e-11 * size + coordinates;
    assert!(missed <= limit, "{context}: points {missed:e} off, more than {limit:e}: {found:?}");
}

/// Moved by the depth and a bit along the normal, `A` is off `B`; moved by less than what the depth is at least, it is not.
fn assert_parts(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3, found: &Penetration, size: f64, context: &str) {
    let rounding = 8.0 * f64::EPSILON * pa.translation.abs().max(pb.translation.abs()).max_element();
    let margin = 2.0 * TOUCHING_ERROR * size + rounding;
    let moved = |way: f64| DAffine3 { translation: pa.translation + found.normal * way, ..*pa };
    let apart = moved(found.depth + margin);
    assert!(!query::intersects(a, &apart, b, pb).unwrap(), "{context}: {found:?} does not part them");
    let still = found.depth_min - margin;
    if still > 0.0 {
        assert!(query::intersects(a, &moved(still), b, pb).unwrap(), "{context}: {found:?} is more than needed");
    }
}

fn run(regime: Regime, hits: std::ops::RangeInclusive<usize>) {
    let (mut rng, mut tally) = (seeded(SEED), Tally::default());
    for i in 0..PAIRS {
        let pair = random_pair(&mut rng, regime);
        tally.judge(&pair, &format!("{regime:?}, seed {SEED}, pair {i}: {pair:?}"));
    }
    tally.finish(&format!("{regime:?}"), hits);
}

#[test]
fn random_pairs() {
    run(Regime::Random, 30..=70);
}

#[test]
fn pairs_far_from_the_origin() {
    run(Regime::FarFromOrigin, 30..=70);
}

#[test]
fn pairs_of_very_different_size() {
    run(Regime::SizeRatio, 30..=70);
}

#[test]
fn plates() {
    run(Regime::Flat, 30..=70);
}

#[test]
fn needles() {
    run(Regime::Sliver, 30..=70);
}

#[test]
fn concentric_pairs() {
    run(Regime::Concentric, 70..=100);
}

#[test]
fn shallow_pairs() {
    run(Regime::NearTouching { relative_gap: 1e-6 }, 30..=70);
    run(Regime::NearTouching { relative_gap: 1e-9 }, 30..=70);
}
