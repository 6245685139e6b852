//! What the algorithms cost: counts are asserted, times are only printed.

use std::time::Instant;

use glam::{DQuat, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;

use super::assert_rate;
use crate::polygon::{
    Counters, Polygon, intersect_sorted, intersect_straightforward, intersect_triangulated,
};

/// Random star-shaped polygons of n corners in space, whose boxes meet.
fn scene(n: usize, count: usize) -> Vec<[Polygon; 2]> {
    let mut rng = seeded(80);
    let mut polygon = |near: f64| {
        let turn = DQuat::from_rotation_arc(
            DVec3::Z,
            DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0))).normalize(),
        );
        let off = near * DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
        let vertices: Vec<DVec3> = (0..n)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                off + turn * (rng.random_range(0.4..1.0) * DVec3::new(angle.cos(), angle.sin(), 0.0))
            })
            .collect();
        Polygon::new(vertices).unwrap()
    };
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let pair = [polygon(0.0), polygon(1.0)];
        if pair[0].bounds().overlaps(&pair[1].bounds()) {
            pairs.push(pair);
        }
    }
    pairs
}

#[test]
fn work_of_the_two_approaches() {
    for n in [4, 10, 30, 100] {
        let pairs = scene(n, 4000);
        let mut hits = [0; 3];
        let mut counters = [Counters::default(); 2];
        let start = Instant::now();
        hits[0] = pairs.iter().filter(|[a, b]| intersect_sorted(a, b, &mut counters[0])).count();
        let sorted = start.elapsed();
        let start = Instant::now();
        hits[1] = pairs.iter().filter(|[a, b]| intersect_straightforward(a, b, &mut counters[1])).count();
        let straightforward = start.elapsed();
        let start = Instant::now();
        hits[2] = pairs[..200].iter().filter(|[a, b]| intersect_triangulated(a, b)).count();
        let triangulated = start.elapsed() * 20;
        println!("{n} corners, {} pairs: sorted {sorted:?} {:?}", pairs.len(), counters[0]);
        println!(
            "  straightforward {straightforward:?} {:?}; triangulated about {triangulated:?}",
            counters[1]
        );
        assert_eq!(hits[0], hits[1]);
        assert_rate("stars", hits[0], pairs.len());
        assert_eq!(counters[0].point_in_polygon_tests, 0);
        assert_eq!(counters[1].comparisons, 0);
        assert!(counters[0].edge_plane_tests <= (2 * n * pairs.len()) as u64);
        assert_eq!(scene(n, 3)[2][1].vertices(), pairs[2][1].vertices(), "the counts repeat");
    }
}

/// Corners that lie in the other's plane are in order at once, whichever way the polygon runs.
#[test]
fn tips_in_a_plane_take_comparisons_in_proportion() {
    let tips = 1000;
    let far = 2.0 * f64::from(tips);
    let table = [(-far, -far), (far, -far), (far, far), (-far, far)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let teeth = (0..tips).map(f64::from).flat_map(|x| [DVec3::X * x, DVec3::new(x + 0.5, 0.0, 1.0)]);
    let back = [DVec3::new(far, 0.0, 3.0), DVec3::new(-1.0, 0.0, 3.0)];
    let mut comb: Vec<DVec3> = teeth.chain(back).collect();
    for _ in 0..2 {
        let mut counters = Counters::default();
        assert!(intersect_sorted(
            &Polygon::new(&*comb).unwrap(),
            &Polygon::new(table).unwrap(),
            &mut counters
        ));
        assert!(counters.comparisons < 5 * tips as u64, "{counters:?}");
        comb.reverse();
    }
}
