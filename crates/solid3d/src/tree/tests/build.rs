//! Laws of build and refit.

#[cfg(feature = "rayon")]
use super::scenes::{boxes_of, torus};
use super::scenes::{point, random_boxes, rng, torus_boxes};
use crate::Aabb;
use crate::tree::{DEPTH_MAX, LeafPoints, Tree};
use glam::DVec3;
use proptest::prelude::*;
use solid_convex::simd::levels;
use solid_oracle::generate::grid;

fn checked(boxes: &[Aabb]) -> Tree {
    let tree = Tree::build(boxes);
    tree.validate(boxes);
    tree
}

fn boxed(corner: DVec3, size: DVec3) -> Aabb {
    Aabb::new(corner, corner + size)
}

/// Boxes that have something against them, `n` of each kind.
fn hard_cases(n: u32) -> Vec<(&'static str, Vec<Aabb>)> {
    let all = |f: &dyn Fn(f64) -> Aabb| (0..n).map(|i| f(f64::from(i))).collect::<Vec<_>>();
    let unit = DVec3::ONE;
    vec![
        (
            "a flat floor",
            all(&|i| boxed(DVec3::new(i % 10.0, (i / 10.0).floor(), 0.0), DVec3::new(1.0, 1.0, 0.0))),
        ),
        ("identical", all(&|_| boxed(unit, unit))),
        ("identical points", all(&|_| boxed(unit, DVec3::ZERO))),
        ("all at the origin", all(&|_| boxed(DVec3::ZERO, DVec3::ZERO))),
        ("points on a line", all(&|i| boxed(DVec3::X * i, DVec3::ZERO))),
        ("points on a diagonal", all(&|i| boxed(unit * i, DVec3::ZERO))),
        (
            "growing exponentially",
            all(&|i| boxed(unit * 1.2f64.powf(i % 1200.0), unit * 1.2f64.powf(i % 1200.0))),
        ),
        ("shrinking exponentially", all(&|i| boxed(unit * 0.5f64.powf(i), unit * 0.5f64.powf(i + 1.0)))),
        ("concentric", all(&|i| Aabb::new(unit * -i, unit * i))),
        ("nested from a corner", all(&|i| boxed(DVec3::ZERO, unit * 0.9f64.powf(i)))),
        ("far from the origin", all(&|i| boxed(unit * 1e9 + unit * i, unit))),
        ("huge", all(&|i| boxed(unit * (i * 1e95), unit * 1e95))),
        ("tiny", all(&|i| boxed(unit * (i * 1e-300), unit * 1e-300))),
        ("subnormal", all(&|i| boxed(unit * (i * 1e-320), unit * 1e-320))),
        ("of every magnitude", all(&|i| boxed(unit * 10f64.powf(i % 390.0 - 300.0), DVec3::ZERO))),
    ]
}

#[test]
fn every_hard_case_is_valid_at_every_size() {
    for n in [1, 2, 7, 8, 9, 16, 17, 63, 65, 100, 1000] {
        for (name, boxes) in hard_cases(n) {
            let tree = checked(&boxes);
            assert!(!tree.degraded(), "{name}, {n}");
            assert!(tree.node_count() <= boxes.len().div_ceil(4), "{name}, {n}: {} nodes", tree.node_count());
        }
    }
}

#[test]
fn the_depth_is_bounded() {
    for (name, boxes) in hard_cases(20_000) {
        let depth = checked(&boxes).depth();
        eprintln!("{name}: depth {depth}");
        assert!(depth <= DEPTH_MAX);
    }
    // Identical boxes split evenly.
    assert_eq!(Tree::build(&[boxed(DVec3::ZERO, DVec3::ONE); 8 * 8 * 8 * 8]).depth(), 3);
}

/// Law: a build gives the same tree on any number of threads, whether or not there are clusters.
#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_tree() {
    let mut cases = hard_cases(20_000);
    cases.push(("a torus", boxes_of(&torus(400, 125, |p| p))));
    cases.push(("boxes at random", random_boxes(&mut rng(3), 30_000, 0.02)));
    for (name, boxes) in cases {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Tree::build(&boxes))
        };
        let one = on(1);
        one.validate(&boxes);
        for threads in [2, 3] {
            let tree = on(threads);
            assert!(tree.nodes == one.nodes && tree.order == one.order, "{name}, {threads} threads");
            assert_eq!((tree.bounds, tree.cost.to_bits()), (one.bounds, one.cost.to_bits()), "{name}");
        }
    }
}

#[test]
fn where_the_heuristic_ends_the_split_is_even() {
    // None of the hard cases gets as deep as the limit, so here it is lowered. The more of them have clusters.
    for (name, boxes) in [5000, 20_000].into_iter().flat_map(hard_cases) {
        for heuristic_depth in [0, 1] {
            let tree = Tree::build_with(&boxes, heuristic_depth);
            tree.validate(&boxes);
            // Nodes are chosen to cost the least, not to be shallow: they are 4 to 8 deep, where the binary tree is 12.
            assert!(tree.depth() <= heuristic_depth + 8, "{name}: depth {}", tree.depth());
        }
    }
}

#[test]
fn a_torus_is_shallow_and_small() {
    let boxes = torus_boxes();
    let tree = checked(&boxes);
    eprintln!("{} nodes, {} bytes, depth {}", tree.node_count(), tree.bytes(), tree.depth());
    assert!(tree.depth() <= 6);
    assert!(tree.bytes() <= 16 * boxes.len());
}

#[test]
fn refit_follows_the_boxes() {
    let mut rng = rng(7);
    let mut boxes = random_boxes(&mut rng, 500, 0.1);
    let mut tree = checked(&boxes);
    // Little motion; then far away; then small, huge, flat, a point, and back.
    let scales = [1.0, 1e6, 1e-3, 1e80, 1e-200, 0.0, 1.0];
    for scale in scales {
        let shift = point(&mut rng, 10.0);
        boxes = random_boxes(&mut rng, 500, 0.1)
            .iter()
            .map(|b| Aabb::new(b.min * scale + shift, b.max * scale + shift))
            .collect();
        tree.refit(|i| boxes[i as usize]);
        tree.validate(&boxes);
    }
}

/// A grid of triangles, deformed: its vertices at a time, and its triangles.
fn cloth(side: u32, time: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |i: u32| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0);
    let wave = |p: DVec3| p + DVec3::new(0.0, 0.3 * time, (0.1 * p.x * p.y + time).sin());
    let vertices = (0..side * side).map(|i| wave(at(i))).collect();
    (vertices, grid(side))
}

/// Law: a refit from points gives the bits of one from boxes, on every level of instructions and any number of threads.
#[test]
fn a_refit_from_points_is_that_from_boxes() {
    // The second is large enough for several threads.
    for side in [20, 200] {
        let (mut vertices, triangles) = cloth(side, 0.0);
        let bounds =
            |vertices: &[DVec3], i: u32| Aabb::of_points(triangles[i as usize].map(|v| vertices[v as usize]));
        let boxes: Vec<Aabb> = (0..triangles.len() as u32).map(|i| bounds(&vertices, i)).collect();
        let mut slow = Tree::build(&boxes);
        let points = LeafPoints::new(&slow, |i| &triangles[i as usize]);
        for time in [0.5, 0.0, 7.0, 1e6] {
            vertices = cloth(side, time).0;
            let before = slow.clone();
            slow.refit(|i| bounds(&vertices, i));
            for level in levels() {
                let mut fast = before.clone();
                fast.refit_points_on(level, &points, &vertices);
                assert_eq!((&fast.nodes, fast.bounds), (&slow.nodes, slow.bounds), "{time}");
                assert_eq!(fast.cost.to_bits(), slow.cost.to_bits(), "{time}");
            }
            #[cfg(feature = "rayon")]
            for threads in [1, 2, 3] {
                let mut fast = before.clone();
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| fast.refit_points(&points, &vertices));
                assert_eq!((&fast.nodes, fast.bounds), (&slow.nodes, slow.bounds), "{time}, {threads}");
                assert_eq!(fast.cost.to_bits(), slow.cost.to_bits(), "{time}, {threads}");
            }
        }
    }
}

#[test]
fn torn_boxes_degrade_a_tree_and_whole_ones_do_not() {
    let boxes = torus_boxes();
    let mut tree = Tree::build(&boxes);
    tree.refit(|i| {
        let b = boxes[i as usize];
        Aabb::new(b.min * 1.1, b.max * 1.1 + DVec3::splat(0.01))
    });
    assert!(!tree.degraded());
    tree.refit(|i| boxes[(i as usize * 2503) % boxes.len()]);
    assert!(tree.degraded());
}

#[test]
fn a_point_that_becomes_a_mesh_is_degraded() {
    let boxes = torus_boxes();
    let mut tree = Tree::build(&vec![boxed(DVec3::ONE, DVec3::ZERO); boxes.len()]);
    assert!(!tree.degraded());
    tree.refit(|i| boxes[i as usize]);
    tree.validate(&boxes);
    assert!(tree.degraded());
}

#[test]
fn what_is_no_box_is_refused() {
    let bad = [
        Aabb::EMPTY,
        Aabb::new(DVec3::ZERO, DVec3::NAN),
        Aabb::new(DVec3::ZERO, DVec3::INFINITY),
        Aabb::new(DVec3::splat(-1e101), DVec3::ZERO),
    ];
    for bad in bad {
        let good = boxed(DVec3::ZERO, DVec3::ONE);
        assert!(std::panic::catch_unwind(|| Tree::build(&[good, bad])).is_err(), "{bad:?}");
        let refit = || Tree::build(&[good, good]).refit(|i| [good, bad][i as usize]);
        assert!(std::panic::catch_unwind(refit).is_err(), "{bad:?}");
    }
    assert!(std::panic::catch_unwind(|| Tree::build(&[])).is_err());
}

fn some_boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let corner = || prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from_array);
    let one = (corner(), corner(), -20..1i32);
    prop::collection::vec(one, 1..300)
        .prop_map(|boxes| boxes.into_iter().map(|(c, size, e)| boxed(c, size.abs() * 2f64.powi(e))).collect())
}

proptest! {
    #[test]
    fn any_boxes_make_a_valid_tree(boxes in some_boxes()) {
        checked(&boxes);
    }

    #[test]
    fn scaling_by_a_power_of_two_gives_the_same_bits(boxes in some_boxes(), exponent in -300..300i32) {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<Aabb> = boxes.iter().map(|b| Aabb::new(b.min * scale, b.max * scale)).collect();
        let (tree, other) = (Tree::build(&boxes), Tree::build(&scaled));
        prop_assert_eq!(&tree.nodes, &other.nodes);
        prop_assert_eq!(&tree.order, &other.order);
    }

    #[test]
    fn refit_of_unchanged_boxes_gives_the_same_bits(boxes in some_boxes()) {
        let tree = Tree::build(&boxes);
        let mut refit = tree.clone();
        refit.refit(|i| boxes[i as usize]);
        prop_assert_eq!(&tree.nodes, &refit.nodes);
        prop_assert_eq!((tree.normal, tree.root, tree.bounds), (refit.normal, refit.root, refit.bounds));
        prop_assert_eq!(tree.cost.to_bits(), refit.cost.to_bits());
    }
}
