//! The laws of the broad phase, held by both engines against brute force.

use super::{BroadPhase, BroadPhaseKind, DynamicTree, Proxy, bound_along, bound_in, matters};
use crate::bounds::Aabb;
use crate::tree::TreeRay;
use glam::DVec3;
use proptest::prelude::*;
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use std::collections::BTreeMap;

const KINDS: [BroadPhaseKind; 2] = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune];

/// Both engines and the truth, fed alike.
struct Trial {
    boxes: BTreeMap<Proxy, Aabb>,
    engines: Vec<Box<dyn BroadPhase>>,
    pairs_seen: usize,
    /// By rays.
    boxes_met: usize,
}

impl Trial {
    fn new() -> Self {
        Trial {
            boxes: BTreeMap::new(),
            engines: KINDS.iter().map(|k| k.build()).collect(),
            pairs_seen: 0,
            boxes_met: 0,
        }
    }

    fn insert(&mut self, proxy: Proxy, b: Aabb) {
        self.boxes.insert(proxy, b);
        self.engines.iter_mut().for_each(|e| e.insert(proxy, b));
    }

    fn update(&mut self, proxy: Proxy, b: Aabb) {
        self.boxes.insert(proxy, b);
        self.engines.iter_mut().for_each(|e| e.update(proxy, b));
    }

    fn remove(&mut self, proxy: Proxy) {
        self.boxes.remove(&proxy);
        self.engines.iter_mut().for_each(|e| e.remove(proxy));
    }

    fn check(&mut self, what: &str) {
        let all: Vec<_> = self.boxes.iter().collect();
        let mut truth = Vec::new();
        for (i, (a, box_a)) in all.iter().enumerate() {
            truth.extend(all[i + 1..].iter().filter(|(_, b)| box_a.overlaps(b)).map(|(b, _)| (**a, **b)));
        }
        self.pairs_seen += truth.len();
        for (engine, kind) in self.engines.iter_mut().zip(KINDS) {
            engine.validate();
            engine.flush();
            engine.validate();
            assert_eq!(engine.sorted_pairs(), truth, "{kind:?}, {what}");
            for region in all.iter().map(|(_, region)| **region).step_by(1 + all.len() / 4) {
                let there: Vec<_> =
                    all.iter().filter(|(_, b)| region.overlaps(b)).map(|(a, _)| **a).collect();
                for until in [0.0, f64::INFINITY] {
                    let mut found = visited(engine.as_ref(), &region, until);
                    found.sort_unstable();
                    assert_eq!(found, there, "{kind:?}, {what}, in {region:?}, until {until}");
                }
                let mut found = Vec::new();
                engine.for_each_in(&region, &mut |proxy| found.push(proxy));
                found.sort_unstable();
                assert_eq!(found, there, "{kind:?}, {what}, in {region:?}");
            }
            let centers: Vec<_> = all.iter().map(|(_, bounds)| bounds.center()).collect();
            for (ray, until) in rays_among(&centers) {
                let bound = bound_along(&ray);
                let there: Vec<_> =
                    all.iter().filter(|(_, b)| matters(bound(b), until)).map(|(a, _)| **a).collect();
                let mut found = Vec::new();
                engine.for_each_along(&ray, until, &mut |proxy| {
                    found.push(proxy);
                    until
                });
                found.sort_unstable();
                self.boxes_met += there.len();
                assert_eq!(found, there, "{kind:?}, {what}, along {ray:?} until {until}");
            }
        }
    }
}

/// Rays, and boxes that move, from some points to others, and until when: from afar, along an axis, and short ones among them.
fn rays_among(points: &[DVec3]) -> Vec<(TreeRay, f64)> {
    let ends = points.iter().zip(points.iter().skip(1)).step_by(1 + points.len() / 8).enumerate();
    let ray = |(i, (from, to)): (usize, (&DVec3, &DVec3))| {
        let way = *to - *from;
        let direction = if i % 4 == 3 { DVec3::AXES[i % 3] * way.dot(DVec3::AXES[i % 3]) } else { way };
        let origin = if i % 3 == 2 { *from - 1e5 * direction } else { *from };
        let half_extents = if i % 5 == 4 { 0.1 * direction.abs() } else { DVec3::ZERO };
        let until = [f64::INFINITY, 1.0, 1e5 + 0.5][i % 3];
        (direction != DVec3::ZERO).then_some((TreeRay { origin, direction, half_extents }, until))
    };
    ends.filter_map(ray).collect()
}

/// The boxes that overlap a region, as they are visited by a bound.
fn visited(engine: &dyn BroadPhase, region: &Aabb, until: f64) -> Vec<Proxy> {
    let mut found = Vec::new();
    engine.for_each_nearest(&bound_in(region), until, &mut |proxy| {
        found.push(proxy);
        until
    });
    found
}

/// What a scene's boxes are like.
#[derive(Clone, Copy, Debug)]
enum Scene {
    Uniform,
    /// Integer coordinates: many equal ones, many touches, flat and point boxes.
    Lattice,
    Identical,
    /// Sizes and places over two hundred decades.
    AllScales,
    /// Few tight clusters and one box far away.
    Clusters,
    /// One huge box over all.
    Ground,
    /// So far from the origin that `f32` tells none from another there, but for a few.
    Far,
}

const SCENES: [Scene; 7] = [
    Scene::Uniform,
    Scene::Lattice,
    Scene::Identical,
    Scene::AllScales,
    Scene::Clusters,
    Scene::Ground,
    Scene::Far,
];

fn any_box(scene: Scene, proxy: Proxy, rng: &mut StdRng) -> Aabb {
    let mut vector = |lo: f64, hi: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(lo..hi)));
    match scene {
        Scene::Uniform => {
            let min = vector(0.0, 5.0);
            Aabb::new(min, min + vector(0.2, 1.5))
        }
        Scene::Lattice => {
            let min = vector(0.0, 8.0).floor();
            Aabb::new(min, min + vector(0.0, 2.5).floor())
        }
        Scene::Identical => {
            let min = DVec3::splat(vector(0.0, 3.0).x.floor());
            Aabb::new(min, min + 0.5)
        }
        Scene::AllScales => {
            let min = vector(-1.0, 1.0) * 10f64.powf(vector(-100.0, 100.0).x);
            let size = vector(0.0, 1.0) * 10f64.powf(vector(-100.0, 100.0).x);
            Aabb::new(min, min + size)
        }
        Scene::Clusters if proxy == 0 => Aabb::new(DVec3::splat(1e30), DVec3::splat(2e30)),
        Scene::Clusters => {
            let center = DVec3::splat(100.0 * f64::from(proxy % 3));
            let min = center + vector(-1e-3, 1e-3);
            Aabb::new(min, min + vector(0.0, 5e-4))
        }
        Scene::Ground if proxy == 0 => {
            Aabb::new(DVec3::new(-100.0, -100.0, -1.0), DVec3::new(100.0, 100.0, 0.5))
        }
        Scene::Ground => {
            let min = vector(0.0, 6.0);
            Aabb::new(min, min + 0.8)
        }
        Scene::Far => {
            let offset = if proxy.is_multiple_of(10) { DVec3::ZERO } else { DVec3::new(3e9, -2e10, 1e12) };
            let min = offset + vector(0.0, 5.0);
            Aabb::new(min, min + vector(0.2, 1.5))
        }
    }
}

/// A box nearby: drifts, or grows and shrinks, or stays on the lattice.
fn moved(scene: Scene, b: &Aabb, rng: &mut StdRng) -> Aabb {
    let size = b.max - b.min;
    let mut vector = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-0.3..0.3)));
    match scene {
        Scene::Lattice => {
            let min = (b.min + (vector() * 5.0).trunc()).rem_euclid(DVec3::splat(8.0));
            Aabb::new(min, min + size)
        }
        Scene::Identical => {
            let min = DVec3::splat((b.min.x + 1.0).rem_euclid(3.0));
            Aabb::new(min, min + size)
        }
        _ => {
            let (low, high) = (size * vector(), size * vector());
            let (min, max) = (b.min + low, b.max + high);
            Aabb::new(min.min(max), max.max(min))
        }
    }
}

#[test]
fn both_engines_agree_with_brute_force_in_long_animations() {
    for (seed, scene) in (100..).zip(SCENES) {
        let (mut pairs_seen, mut boxes_met) = (0, 0);
        for (share_moving, boxes) in [(0.02, 150), (0.3, 60), (1.0, 40), (1.0, 9), (0.5, 2)] {
            let mut rng = seeded(seed);
            let mut trial = Trial::new();
            for proxy in 0..boxes {
                trial.insert(proxy, any_box(scene, proxy, &mut rng));
            }
            for frame in 0..150 {
                let what =
                    format!("seed {seed}, {scene:?}, {boxes} boxes, moving {share_moving}, frame {frame}");
                trial.check(&what);
                for proxy in 0..boxes + 5 {
                    let Some(&b) = trial.boxes.get(&proxy) else {
                        if rng.random_bool(0.3) {
                            trial.insert(proxy, any_box(scene, proxy, &mut rng));
                        }
                        continue;
                    };
                    match rng.random_range(0.0..1.0) {
                        x if x < 0.005 => trial.remove(proxy),
                        x if x < 0.01 => trial.update(proxy, any_box(scene, proxy, &mut rng)),
                        x if x < 0.015 => {
                            trial.remove(proxy);
                            trial.insert(proxy, any_box(scene, proxy, &mut rng));
                        }
                        x if x < 0.015 + share_moving => {
                            trial.update(proxy, moved(scene, &b, &mut rng));
                            if rng.random_bool(0.1) {
                                let b = trial.boxes[&proxy];
                                trial.update(proxy, moved(scene, &b, &mut rng));
                            }
                        }
                        _ => {}
                    }
                }
            }
            pairs_seen += trial.pairs_seen;
            boxes_met += trial.boxes_met;
        }
        assert!(pairs_seen > 5_000, "seed {seed}, {scene:?}: only {pairs_seen} pairs");
        assert!(boxes_met > 5_000, "seed {seed}, {scene:?}: rays met only {boxes_met} boxes");
    }
}

#[test]
fn everything_teleports_in_every_frame() {
    // Exhausts the swaps of a frame of the sweep and prune, and rebuilds the tree.
    let mut rng = seeded(7);
    let mut trial = Trial::new();
    for frame in 0..20 {
        for proxy in 0..700 {
            let min = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..10.0)));
            let b = Aabb::new(min, min + 1.0);
            if frame == 0 { trial.insert(proxy, b) } else { trial.update(proxy, b) }
        }
        trial.check(&format!("frame {frame}"));
    }
    assert!(trial.engines[0].counters().rebuilds >= 20);
    let sweeps = trial.engines[1].counters().sweeps;
    assert!(sweeps > 1, "no frame ran out of swaps: {sweeps}");
}

#[test]
fn a_chain_of_insertions_cannot_make_the_tree_deep() {
    // Each box is far smaller than the last and lies beside it: greedy insertion alone goes ever deeper.
    let mut trial = Trial::new();
    for proxy in 0..2000 {
        let x = 0.97f64.powi(proxy as i32);
        trial.insert(proxy, Aabb::new(DVec3::splat(x), DVec3::splat(1.005 * x)));
        if proxy % 40 == 0 {
            trial.check("chain");
        }
    }
    trial.check("chain");
}

/// Law: it costs no more to be far from the origin, nor to come from there.
#[test]
fn far_boxes_cost_what_near_ones_cost() {
    let visits = |offset: f64| {
        let mut broad = DynamicTree::default();
        let bounds = |proxy: Proxy, offset: f64| {
            let at = [proxy % 10, proxy / 10 % 10, proxy / 100].map(|k| 2.0 * f64::from(k));
            let min = DVec3::from_array(at) + offset;
            Aabb::new(min, min + 1.0)
        };
        for from in [0.0, offset] {
            for proxy in 0..1000 {
                if from == 0.0 {
                    broad.insert(proxy, bounds(proxy, 0.0));
                } else {
                    broad.update(proxy, bounds(proxy, from));
                }
            }
            broad.flush();
            broad.validate();
        }
        assert!(broad.sorted_pairs().is_empty());
        assert_eq!(visited(&broad, &bounds(555, offset), 0.0), [555]);
        broad.counters().node_visits
    };
    let near = visits(4.0);
    for offset in [1e7, 1e9, -1e13] {
        let far = visits(offset);
        assert!(far <= 2 * near, "{far} nodes visited at {offset}, {near} near the origin");
    }
}

#[test]
fn what_does_not_move_costs_nothing() {
    for kind in KINDS {
        let mut broad = kind.build();
        for proxy in 0..1000 {
            let min = DVec3::new(f64::from(proxy % 10), f64::from(proxy / 10 % 10), f64::from(proxy / 100));
            broad.insert(proxy, Aabb::new(min, min + 0.9));
        }
        broad.flush();
        let before = broad.counters();
        for proxy in 0..1000 {
            let min = DVec3::new(f64::from(proxy % 10), f64::from(proxy / 10 % 10), f64::from(proxy / 100));
            broad.update(proxy, Aabb::new(min, min + 0.9));
        }
        broad.flush();
        assert_eq!(broad.counters(), before, "{kind:?}");
    }
}

#[test]
fn the_same_calls_give_the_same_order() {
    for kind in KINDS {
        let run = || {
            let mut rng = seeded(3);
            let mut broad = kind.build();
            let mut order = Vec::new();
            for frame in 0..30 {
                for proxy in 0..100 {
                    let b = any_box(Scene::Uniform, proxy, &mut rng);
                    if frame == 0 {
                        broad.insert(proxy, b);
                    } else if proxy % 9 == frame % 9 {
                        broad.update(proxy, b);
                    }
                }
                broad.flush();
                broad.for_each_pair(&mut |a, b| order.push((a, b)));
            }
            (order, broad.counters())
        };
        assert_eq!(run(), run(), "{kind:?}");
    }
}

/// Law: the same pairs in the same order, the same changes and counters, on any number of threads.
#[cfg(feature = "rayon")]
#[test]
fn the_number_of_threads_changes_nothing() {
    /// Enough for several threads to have something to do.
    const BOXES: u32 = 60_000;
    let run = || {
        let mut rng = seeded(5);
        let mut anywhere =
            |scale: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..scale)));
        let side = (8.0 * f64::from(BOXES)).cbrt();
        let places: Vec<_> = (0..BOXES).map(|_| (anywhere(side), anywhere(0.1))).collect();
        let mut broad = BroadPhaseKind::DynamicTree.build();
        let (mut pairs, mut changes) = (Vec::new(), Vec::new());
        for frame in 0..8 {
            for (proxy, (place, velocity)) in (0..).zip(&places) {
                let min = *place + *velocity * f64::from(frame);
                let b = Aabb::new(min, min + 1.0);
                if frame == 0 { broad.insert(proxy, b) } else { broad.update(proxy, b) }
            }
            broad.flush();
            broad.for_each_pair(&mut |a, b| pairs.push((a, b)));
            changes.extend_from_slice(broad.changes());
        }
        broad.validate();
        (pairs, changes, broad.counters())
    };
    let on = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run);
    let alone = on(1);
    assert!(alone.2.rebuilds > 1 && alone.1.len() > 10_000, "{:?}, {} changes", alone.2, alone.1.len());
    for threads in [2, 3, 8] {
        assert!(on(threads) == alone, "{threads} threads");
    }
}

/// How boxes are told.
#[derive(Clone, Copy, Debug)]
enum Told {
    OneByOne,
    Many,
    With,
}

/// Law: many boxes told at once are as if told one by one, whatever their order: the same pairs in the same order, the same changes
/// and counters.
#[test]
fn many_at_once_are_as_one_by_one() {
    /// Enough for several threads to have something to do.
    const BOXES: u32 = 40_000;
    let mut rng = seeded(11);
    let mut anywhere = |scale: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..scale)));
    let side = (8.0 * f64::from(BOXES)).cbrt();
    let mut boxes: Vec<(Proxy, Aabb)> = (0..BOXES)
        .map(|proxy| {
            let min = anywhere(side);
            (3 * proxy, Aabb::new(min, min + 1.0))
        })
        .collect();
    let mut frames = vec![boxes.clone()];
    // Few move, half, all; far, so that most leave their fat boxes, and little; then in no order, some twice.
    for (share, scale) in [(20, 1.0), (2, 0.01), (1, 0.01), (1, 3.0), (1, 0.1)] {
        for (_, b) in boxes.iter_mut().step_by(share) {
            let way = anywhere(scale);
            *b = Aabb::new(b.min + way, b.max + way);
        }
        frames.push(boxes.clone());
    }
    // The first move, and no others.
    for (_, b) in &mut boxes[..1000] {
        let way = anywhere(0.3);
        *b = Aabb::new(b.min + way, b.max + way);
    }
    frames.push(boxes.clone());
    let mut shuffled = boxes.clone();
    shuffled.reverse();
    shuffled.extend_from_slice(&frames[1][..5000]);
    frames.push(shuffled);
    for kind in KINDS {
        let run = |how: Told| {
            let mut broad = kind.build();
            let (mut pairs, mut changes) = (Vec::new(), Vec::new());
            for (frame, boxes) in frames.iter().enumerate() {
                match (frame, how) {
                    (0, Told::OneByOne) => boxes.iter().for_each(|(proxy, b)| broad.insert(*proxy, *b)),
                    (0, _) => broad.insert_many(boxes),
                    (_, Told::OneByOne) => boxes.iter().for_each(|(proxy, b)| broad.update(*proxy, *b)),
                    (_, Told::Many) => broad.update_many(boxes),
                    (_, Told::With) => {
                        let (once, again) = boxes.split_at(BOXES as usize);
                        let proxies: Vec<Proxy> = once.iter().map(|(proxy, _)| *proxy).collect();
                        let bounds: BTreeMap<Proxy, Aabb> = once.iter().copied().collect();
                        broad.update_with(&proxies, &|boxes| {
                            boxes.iter_mut().for_each(|(proxy, to)| *to = bounds[proxy])
                        });
                        broad.update_many(again);
                    }
                }
                broad.validate();
                broad.flush();
                broad.for_each_pair(&mut |a, b| pairs.push((a, b)));
                changes.extend_from_slice(broad.changes());
            }
            broad.validate();
            (pairs, changes, broad.counters())
        };
        let one_by_one = run(Told::OneByOne);
        assert!(one_by_one.1.len() > 5_000, "{kind:?}: {} changes", one_by_one.1.len());
        for how in [Told::Many, Told::With] {
            assert!(run(how) == one_by_one, "{kind:?}, {how:?}");
            #[cfg(feature = "rayon")]
            for threads in [1, 2, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert!(pool.install(|| run(how)) == one_by_one, "{kind:?}, {how:?}, {threads} threads");
            }
        }
    }
}

/// Law: of many boxes the first that is refused is named, on any number of threads, and what was told before stands.
#[test]
fn many_boxes_with_a_bad_one_are_refused() {
    const BOXES: u32 = 40_000;
    let good: Vec<(Proxy, Aabb)> = (0..BOXES)
        .map(|proxy| {
            let min = DVec3::new(2.0 * f64::from(proxy), 0.0, 0.0);
            (proxy, Aabb::new(min, min + 1.0))
        })
        .collect();
    let mut bad = good.clone();
    bad[27_000].1.max.y = f64::NAN;
    bad[27_003].1.max.y = f64::INFINITY;
    let proxies: Vec<Proxy> = (0..BOXES).collect();
    let run = || {
        for (insert, how) in [(true, Told::Many), (false, Told::Many), (false, Told::With)] {
            let mut broad = BroadPhaseKind::DynamicTree.build();
            if !insert {
                broad.insert_many(&good);
                broad.flush();
            }
            let told = std::panic::AssertUnwindSafe(|| match how {
                _ if insert => broad.insert_many(&bad),
                Told::With => broad.update_with(&proxies, &|boxes| {
                    boxes.iter_mut().for_each(|(proxy, to)| *to = bad[*proxy as usize].1)
                }),
                _ => broad.update_many(&bad),
            });
            let refused = std::panic::catch_unwind(told).unwrap_err();
            let message = refused.downcast_ref::<String>().unwrap();
            assert!(message.contains("the box of proxy 27000 is empty or not finite"), "{message}");
            broad.flush();
            broad.validate();
        }
    };
    run();
    #[cfg(feature = "rayon")]
    rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap().install(run);
}

#[test]
#[should_panic(expected = "changed since the last flush")]
fn unflushed_pairs_are_refused() {
    let mut broad = BroadPhaseKind::DynamicTree.build();
    broad.insert(0, Aabb::new(DVec3::ZERO, DVec3::ONE));
    broad.for_each_pair(&mut |_, _| {});
}

#[test]
#[should_panic(expected = "empty or not finite")]
fn a_box_of_nan_is_refused() {
    BroadPhaseKind::SweepAndPrune.build().insert(0, Aabb::new(DVec3::NAN, DVec3::ONE));
}

#[test]
#[should_panic(expected = "already in use")]
fn a_proxy_is_inserted_once() {
    let mut broad = BroadPhaseKind::SweepAndPrune.build();
    broad.insert(0, Aabb::new(DVec3::ZERO, DVec3::ONE));
    broad.insert(0, Aabb::new(DVec3::ZERO, DVec3::ONE));
}

/// One call, on small integers so that coincidences are common.
#[derive(Clone, Copy, Debug)]
enum Call {
    Put(Proxy, [i8; 3], [u8; 3]),
    Remove(Proxy),
    Flush,
}

fn calls() -> impl Strategy<Value = Vec<Call>> {
    let put = (0u32..12, [-4i8..4, -4..4, -4..4], [0u8..4, 0..4, 0..4])
        .prop_map(|(proxy, min, size)| Call::Put(proxy, min, size));
    let call = prop_oneof![6 => put, 1 => (0u32..12).prop_map(Call::Remove), 1 => Just(Call::Flush)];
    proptest::collection::vec(call, 1..80)
}

proptest! {
    #[test]
    fn any_sequence_of_calls_gives_the_pairs_of_brute_force(calls in calls()) {
        let mut trial = Trial::new();
        for call in calls {
            match call {
                Call::Put(proxy, min, size) => {
                    let min = DVec3::from_array(min.map(f64::from));
                    let b = Aabb::new(min, min + DVec3::from_array(size.map(f64::from)));
                    if trial.boxes.contains_key(&proxy) { trial.update(proxy, b) } else { trial.insert(proxy, b) }
                }
                Call::Remove(proxy) if trial.boxes.contains_key(&proxy) => trial.remove(proxy),
                Call::Remove(_) => {}
                Call::Flush => trial.check("calls"),
            }
        }
        trial.check("calls");
    }
}
