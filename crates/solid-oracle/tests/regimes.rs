//! Laws of the verdict over the generated regimes.

#![allow(clippy::print_stdout, reason = "tests print their seeds and their counts, from helpers too")]

use solid_oracle::generate::{Pair, Regime, random_pair, seeded};
use solid_oracle::{Verdict, verdict};

/// A regime, how many pairs of it to judge, and whether about half of them are expected to hit.
const REGIMES: [(Regime, u32, bool); 11] = [
    (Regime::Random, 1500, true),
    (Regime::NearTouching { relative_gap: 1e-2 }, 500, true),
    (Regime::NearTouching { relative_gap: 1e-5 }, 500, true),
    (Regime::NearTouching { relative_gap: 1e-8 }, 500, true),
    (Regime::NearTouching { relative_gap: 1e-11 }, 500, true),
    (Regime::NearTouching { relative_gap: 1e-13 }, 500, true),
    (Regime::SizeRatio, 500, true),
    (Regime::Flat, 500, true),
    (Regime::Concentric, 300, false),
    (Regime::Sliver, 500, true),
    (Regime::FarFromOrigin, 500, true),
];

fn judge(p: &Pair) -> Verdict {
    verdict(&p.a, &p.pa, &p.b, &p.pb)
}

/// Law: the generated cases are representative, and nearly all of them are decided.
#[test]
fn regimes_are_decided_and_balanced() {
    for (k, (regime, count, balanced)) in REGIMES.into_iter().enumerate() {
        let seed = 100 + k as u64;
        let mut rng = seeded(seed);
        let pairs: Vec<Pair> = (0..count).map(|_| random_pair(&mut rng, regime)).collect();
        let (mut hits, mut uncertain) = (0, 0);
        let start = std::time::Instant::now();
        for p in &pairs {
            match judge(p) {
                Verdict::Intersecting { .. } => hits += 1,
                Verdict::Separated { .. } => {}
                Verdict::Uncertain { gap_max } => {
                    uncertain += 1;
                    println!("  uncertain {:.1e} {:?} {:?}", gap_max / p.size, p.a, p.b);
                }
            }
        }
        let per_pair = start.elapsed().as_secs_f64() * 1e6 / f64::from(count);
        println!(
            "{regime:?} seed {seed}: {hits} hits, {uncertain} uncertain of {count}; {per_pair:.0} us a pair"
        );
        assert!(uncertain * 100 <= count, "{regime:?}: {uncertain} of {count} uncertain");
        let rate = f64::from(hits) / f64::from(count);
        assert!(!balanced || (0.3..=0.7).contains(&rate), "{regime:?}: hit rate {rate}");
    }
}

/// The same over many seeds, with the slowest pair: `cargo test -p solid-oracle soak -- --ignored --nocapture`.
#[test]
#[ignore = "takes a minute"]
fn soak() {
    let near = [1e-9, 1e-11, 1e-13, 1e-15].map(|relative_gap| Regime::NearTouching { relative_gap });
    for regime in REGIMES.into_iter().map(|(regime, ..)| regime).chain(near) {
        let seed = 1000;
        let mut rng = seeded(seed);
        let count = 20_000;
        let (mut hits, mut uncertain, mut slowest) = (0, 0, (0.0, None));
        for _ in 0..count {
            let p = random_pair(&mut rng, regime);
            let start = std::time::Instant::now();
            let v = judge(&p);
            let elapsed = start.elapsed().as_secs_f64();
            hits += u32::from(matches!(v, Verdict::Intersecting { .. }));
            if let Verdict::Uncertain { gap_max } = v {
                uncertain += 1;
                if uncertain < 6 {
                    println!("  uncertain {:.1e} of the size: {p:?}", gap_max / p.size);
                }
            }
            if elapsed > slowest.0 {
                slowest = (elapsed, Some(p));
            }
        }
        println!("{regime:?} seed {seed}: {hits} hits, {uncertain} uncertain of {count}");
        println!("  slowest {:.1} ms: {:?}", slowest.0 * 1e3, slowest.1.map(|p| (p.a, p.b)));
    }
}
