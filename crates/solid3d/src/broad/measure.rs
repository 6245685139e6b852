//! Times of the broad phases, in the scene of the design's table: uniform unit boxes, about half a pair per box, motion
//! along straight lines. Run by hand:
//! `cargo test --release -p solid3d broad::measure -- --ignored --nocapture`.

use super::{BroadPhase, BroadPhaseKind, Proxy};
use crate::bounds::Aabb;
use glam::DVec3;
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use std::time::Instant;

/// Frames before the measured ones: the fat boxes must have come to a steady state.
const WARM_UP: usize = 20;

struct Swarm {
    places: Vec<DVec3>,
    velocities: Vec<DVec3>,
    side: f64,
    broad: Box<dyn BroadPhase>,
}

impl Swarm {
    fn new(kind: BroadPhaseKind, n: usize, speed: f64) -> Self {
        let mut rng = StdRng::seed_from_u64(n as u64);
        let mut vector =
            |scale: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0f64))) * scale;
        // The chance that two unit boxes overlap is 8 / side^3.
        let side = (8.0 * n as f64).cbrt();
        let mut swarm = Swarm {
            places: (0..n).map(|_| vector(0.5 * side)).collect(),
            velocities: (0..n).map(|_| vector(speed)).collect(),
            side,
            broad: kind.build(),
        };
        for (proxy, &place) in (0..).zip(&swarm.places) {
            swarm.broad.insert(proxy, unit_box(place));
        }
        swarm.broad.flush();
        swarm
    }

    fn frame(&mut self, moving: usize, frame: usize) -> usize {
        let n = self.places.len();
        for i in (0..moving).map(|i| i * (n / moving) + frame / 40 % (n / moving)) {
            let (place, velocity) = (&mut self.places[i], &mut self.velocities[i]);
            *place += *velocity;
            for k in 0..3 {
                if place[k].abs() > 0.5 * self.side {
                    velocity[k] = -place[k].signum() * velocity[k].abs();
                }
            }
            self.broad.update(i as Proxy, unit_box(*place));
        }
        self.broad.flush();
        self.pairs()
    }

    fn pairs(&self) -> usize {
        let mut pairs = 0;
        self.broad.for_each_pair(&mut |_, _| pairs += 1);
        pairs
    }
}

fn unit_box(center: DVec3) -> Aabb {
    Aabb::new(center - 0.5, center + 0.5)
}

fn report(kind: BroadPhaseKind, n: usize, speed: f64, percent: usize, frames: usize) {
    let start = Instant::now();
    let mut swarm = Swarm::new(kind, n, speed);
    let first = start.elapsed();
    let moving = n * percent / 100;
    for frame in 0..WARM_UP {
        swarm.frame(moving, frame);
    }
    let before = swarm.broad.counters();
    let mut times: Vec<_> = (WARM_UP..WARM_UP + frames)
        .map(|frame| {
            let start = Instant::now();
            swarm.frame(moving, frame);
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    let mean = times.iter().sum::<f64>() / frames as f64;
    times.sort_by(f64::total_cmp);
    let after = swarm.broad.counters();
    println!(
        "{kind:?} n={n} speed={speed} moving={percent}%: first {:.2} ms; mean {mean:.4} median {:.4} max {:.4} ms; per \
         frame: {} swaps, {} reinsertions, {} visits; {} rebuilds, {} sweeps; {} pairs",
        first.as_secs_f64() * 1e3,
        times[frames / 2],
        times[frames - 1],
        (after.swaps - before.swaps) / frames as u64,
        (after.reinsertions - before.reinsertions) / frames as u64,
        (after.node_visits - before.node_visits) / frames as u64,
        after.rebuilds - before.rebuilds,
        after.sweeps - before.sweeps,
        swarm.pairs(),
    );
}

#[test]
#[ignore = "reports times"]
fn times() {
    let n_max: usize = std::env::var("BROAD_N_MAX").map_or(100_000, |n| n.parse().expect("a number"));
    for n in [1_000, 10_000, 100_000, 1_000_000].into_iter().filter(|&n| n <= n_max) {
        let frames = (2_000_000 / n).clamp(8, 100);
        for speed in [0.02, 0.15] {
            for percent in [1, 10, 100] {
                report(BroadPhaseKind::DynamicTree, n, speed, percent, frames);
                if n < 1_000_000 {
                    report(BroadPhaseKind::SweepAndPrune, n, speed, percent, frames);
                }
            }
        }
    }
}
