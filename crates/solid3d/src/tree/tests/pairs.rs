//! Tree against tree, and against brute force.

use super::scenes::{
    affine, boxes_of, point, random_boxes, relative, rng, torus, torus_boxes, torus_placement,
};
use crate::Aabb;
use crate::tree::{Relative, Traversal, Tree, pairs};
use glam::{DAffine3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

fn found(a: &Tree, b: &Tree, relative: &Relative, traversal: &mut Traversal) -> BTreeSet<(u32, u32)> {
    let mut found = BTreeSet::new();
    let _ = pairs(a, b, relative, traversal, |leaf_a, leaf_b| {
        let product = leaf_a.iter().flat_map(|&i| leaf_b.iter().map(move |&j| (i, j)));
        for pair in product {
            assert!(found.insert(pair), "{pair:?} comes twice");
        }
        ControlFlow::<()>::Continue(())
    });
    found
}

/// The edges of the parallelepiped that is the image of a box: its centre, and half of each edge.
fn image(bounds: &Aabb, map: &DAffine3) -> (DVec3, [DVec3; 3]) {
    let h = bounds.half_extents();
    let edges = [map.x_axis * h.x, map.y_axis * h.y, map.z_axis * h.z];
    (map.transform_point3(bounds.center()), edges)
}

/// The separating-axes test of a box and a parallelepiped on all fifteen axes: the gap relative to the extent on the best axis.
fn gap(a: &Aabb, b: &Aabb, b_to_a: &DAffine3) -> f64 {
    let (center_a, edges_a) = image(a, &DAffine3::IDENTITY);
    let (center_b, edges_b) = image(b, b_to_a);
    let facets = |e: &[DVec3; 3]| [e[0].cross(e[1]), e[1].cross(e[2]), e[2].cross(e[0])];
    let crossed = edges_a.iter().flat_map(|&e| edges_b.map(|f| e.cross(f)));
    let axes = facets(&edges_a).into_iter().chain(facets(&edges_b)).chain(crossed);
    let on = |axis: DVec3| {
        let extent: f64 = edges_a.iter().chain(&edges_b).map(|e| e.dot(axis).abs()).sum();
        ((center_b - center_a).dot(axis).abs() - extent) / extent
    };
    axes.filter(|axis| axis.length_squared() > 1e-300).map(|axis| on(axis.normalize())).fold(-1.0, f64::max)
}

/// How the reported pairs compare with the true ones.
#[derive(Default)]
struct Tally {
    hits: usize,
    leaf_pairs: usize,
    /// Leaf pairs whose boxes do not overlap: lost to the edge axes and to rounding.
    needless: usize,
}

impl Tally {
    /// Compares with brute force.
    fn add(&mut self, a: &[Aabb], b: &[Aabb], relative: &Relative) {
        let (tree_a, tree_b) = (Tree::build(a), Tree::build(b));
        let union = |boxes: &[Aabb], leaf: &[u32]| {
            leaf.iter().fold(Aabb::EMPTY, |sum, &i| sum.union(&boxes[i as usize]))
        };
        let _ = pairs(&tree_a, &tree_b, relative, &mut Traversal::default(), |leaf_a, leaf_b| {
            self.leaf_pairs += 1;
            let apart = gap(&union(a, leaf_a), &union(b, leaf_b), &relative.b_to_a) > 0.0;
            self.needless += usize::from(apart);
            ControlFlow::<()>::Continue(())
        });
        let found = found(&tree_a, &tree_b, relative, &mut Traversal::default());
        for (i, box_a) in (0..).zip(a) {
            for (j, box_b) in (0..).zip(b) {
                // The oracle rounds too: what it calls touching within 1e-9 is left open.
                let hit = gap(box_a, box_b, &relative.b_to_a) < -1e-9;
                self.hits += usize::from(hit);
                assert!(!hit || found.contains(&(i, j)), "pair {i}, {j} is lost");
            }
        }
    }

    fn check(&self, what: &str) {
        let Tally { hits, leaf_pairs, needless } = self;
        eprintln!("{what}: {hits} pairs; {leaf_pairs} leaf pairs, {needless} of them needless");
        assert!(*hits > 20, "{hits} pairs are not representative");
        assert!(5 * needless < 2 * leaf_pairs, "{needless} of {leaf_pairs} leaf pairs are needless");
    }
}

/// A random affine map of about `size` that brings a point of one of `b` to a point of one of `a`.
fn meeting(rng: &mut StdRng, a: &[Aabb], b: &[Aabb], size: f64) -> DAffine3 {
    let inside = |rng: &mut StdRng, boxes: &[Aabb]| {
        let bounds = boxes[rng.random_range(0..boxes.len())];
        bounds.center() + bounds.half_extents() * point(rng, 1.0)
    };
    let (p, q) = (inside(rng, a), inside(rng, b));
    let linear = affine(rng, size, 0.0).matrix3;
    DAffine3 { matrix3: linear, translation: p - linear * q }
}

#[test]
fn no_overlapping_pair_is_lost_under_any_affine_map_and_size() {
    let mut rng = rng(3);
    for exponent in -6..=6 {
        let mut tally = Tally::default();
        for _ in 0..8 {
            let (a, b) = (random_boxes(&mut rng, 150, 0.1), random_boxes(&mut rng, 150, 0.1));
            let map = meeting(&mut rng, &a, &b, 10f64.powi(exponent));
            tally.add(&a, &b, &relative(map, 2.0, 2.0));
        }
        tally.check(&format!("size 1e{exponent}"));
    }
}

#[test]
fn no_pair_is_lost_far_from_the_origins() {
    let mut rng = rng(4);
    for exponent in [3, 6, 9] {
        let far = 10f64.powi(exponent);
        let mut shifted = || -> Vec<Aabb> {
            let by = point(&mut rng, far);
            random_boxes(&mut rng, 200, 0.2).iter().map(|b| Aabb::new(b.min + by, b.max + by)).collect()
        };
        let (a, b) = (shifted(), shifted());
        let map = meeting(&mut rng, &a, &b, 1.0);
        let mut tally = Tally::default();
        tally.add(&a, &b, &relative(map, 2.0 * far, 2.0 * far));
        tally.check(&format!("far 1e{exponent}"));
    }
}

#[test]
fn extreme_sizes_lose_nothing() {
    let mut rng = rng(5);
    for (size_a, size_b) in [(1e-90, 1e90), (1e90, 1e-90), (1e-290, 1e-290), (1e99, 1e99), (1.0, 1e-60)] {
        let scaled = |boxes: Vec<Aabb>, by: f64| -> Vec<Aabb> {
            boxes.iter().map(|b| Aabb::new(b.min * by, b.max * by)).collect()
        };
        let a = scaled(random_boxes(&mut rng, 200, 0.03), size_a);
        let b = scaled(random_boxes(&mut rng, 200, 0.03), size_b);
        // Local sizes are anything; in a common space the two are alike.
        let common = affine(&mut rng, 1.0, 0.3);
        let ratio = |x: f64| DAffine3::from_scale(DVec3::splat(x));
        let b_to_a = ratio(size_a) * common * ratio(1.0 / size_b);
        let a_to_b = ratio(size_b) * common.inverse() * ratio(1.0 / size_a);
        let exact = Relative { b_to_a, a_to_b, slack_in_a: 1e-14 * size_a, slack_in_b: 1e-14 * size_b };
        let found = found(&Tree::build(&a), &Tree::build(&b), &exact, &mut Traversal::default());
        let unit = |boxes: &[Aabb], by: f64| -> Vec<Aabb> {
            boxes.iter().map(|b| Aabb::new(b.min / by, b.max / by)).collect()
        };
        let (a, b) = (unit(&a, size_a), unit(&b, size_b));
        for (i, box_a) in (0..).zip(&a) {
            for (j, box_b) in (0..).zip(&b) {
                assert!(
                    gap(box_a, box_b, &common) > -1e-9 || found.contains(&(i, j)),
                    "{i}, {j} at {size_a:e}"
                );
            }
        }
        eprintln!("{size_a:e}, {size_b:e}: {} pairs", found.len());
        assert!(found.len() < 200 * 200 / 3);
    }
}

#[test]
fn slack_is_added_to_every_test() {
    let unit = [Aabb::new(DVec3::ZERO, DVec3::ONE); 30];
    let tree = Tree::build(&unit);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let b_to_a = DAffine3::from_translation(axis * 1.25);
        let with = |slack: f64| {
            let relative =
                Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: slack, slack_in_b: slack };
            found(&tree, &tree, &relative, &mut Traversal::default()).len()
        };
        assert_eq!(with(0.2), 0);
        assert_eq!(with(0.3), 900);
    }
}

#[test]
fn swapping_the_trees_swaps_the_pairs() {
    let mut rng = rng(6);
    let (a, b) = (random_boxes(&mut rng, 300, 0.05), random_boxes(&mut rng, 500, 0.1));
    let (a, b) = (Tree::build(&a), Tree::build(&b));
    let relative = relative(affine(&mut rng, 0.7, 0.5), 2.0, 2.0);
    let forward = found(&a, &b, &relative, &mut Traversal::default());
    let back = found(&b, &a, &relative.swapped(), &mut Traversal::default());
    assert!(!forward.is_empty());
    assert_eq!(forward, back.iter().map(|&(i, j)| (j, i)).collect());
}

#[test]
fn the_work_on_a_pair_of_tori_is_modest() {
    let mut rng = rng(42);
    let tree = Tree::build(&torus_boxes());
    let (mut first, mut all) = (Traversal::default(), Traversal::default());
    let rounds = 1000;
    let mut met = 0;
    for _ in 0..rounds {
        let relative = relative(torus_placement(&mut rng), 12.0, 12.0);
        let hit = pairs(&tree, &tree, &relative, &mut first, |_, _| ControlFlow::Break(()));
        met += usize::from(hit.is_break());
        let _ = pairs(&tree, &tree, &relative, &mut all, |_, _| ControlFlow::<()>::Continue(()));
    }
    let per = |count: u64| count as f64 / f64::from(rounds);
    eprintln!(
        "{met} of {rounds} pairs have a leaf pair; first leaf pair: {:.1} box tests; all: {:.1} box tests, {:.1} leaf pairs",
        per(first.counters.box_tests),
        per(all.counters.box_tests),
        per(all.counters.leaf_visits),
    );
    assert!((500..800).contains(&met), "{met} of {rounds} are not representative");
    assert!(per(first.counters.box_tests) < 60.0);
    assert!(per(all.counters.box_tests) < 600.0);
}

#[test]
fn a_tree_degraded_by_twisting_costs_more_than_one_rebuilt() {
    let first_box_tests = |tree: &Tree| {
        let (mut rng, mut traversal) = (rng(43), Traversal::default());
        for _ in 0..500 {
            let relative = relative(torus_placement(&mut rng), 15.0, 15.0);
            let _ = pairs(tree, tree, &relative, &mut traversal, |_, _| ControlFlow::<()>::Continue(()));
        }
        traversal.counters.box_tests as f64 / 500.0
    };
    let mut tree = Tree::build(&torus_boxes());
    for (angle, expected) in [(0.1, false), (0.5, false), (1.5, true), (3.0, true)] {
        let twist = |p: DVec3| glam::DQuat::from_rotation_x(angle * p.x / 12.0) * p;
        let boxes = boxes_of(&torus(100, 25, twist));
        tree.refit(|i| boxes[i as usize]);
        let rebuilt = first_box_tests(&Tree::build(&boxes));
        let growth = tree.cost / tree.cost_at_build;
        let ratio = first_box_tests(&tree) / rebuilt;
        eprintln!(
            "twisted by {angle}: cost grown {growth:.2}; {ratio:.2} times the box tests of a rebuilt tree"
        );
        assert_eq!(tree.degraded(), expected);
    }
}
