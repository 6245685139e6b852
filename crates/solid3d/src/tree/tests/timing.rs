//! Times, for a human: `cargo test --release -p solid3d tree::tests::timing -- --ignored --nocapture`.

use super::scenes::{boxes_of, relative, rng, torus, torus_placement};
use crate::tree::{Relative, Traversal, Tree, pairs};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

/// The least nanoseconds of several runs.
fn least_ns(runs: u32, mut f: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        f();
        start.elapsed().as_nanos() as f64
    };
    (0..runs).map(time).fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "prints times"]
fn build_refit_and_pairs() {
    for (around, across) in [(100, 25), (400, 125), (1000, 500)] {
        let boxes = boxes_of(&torus(around, across, |p| p));
        let n = boxes.len() as f64;
        let mut tree = Tree::build(&boxes);
        let build = least_ns(7, || drop(black_box(Tree::build(&boxes))));
        let refit = least_ns(9, || tree.refit(|i| boxes[i as usize]));
        eprintln!(
            "{n} boxes: build {:.1} ns each, refit {:.2} ns each, {:.1} bytes each, depth {}",
            build / n,
            refit / n,
            tree.bytes() as f64 / n,
            tree.depth()
        );

        let mut rng = rng(42);
        let placements: Vec<Relative> =
            (0..2000).map(|_| relative(torus_placement(&mut rng), 12.0, 12.0)).collect();
        for (name, first) in [("first", true), ("all", false)] {
            let mut traversal = Traversal::default();
            let mut leaf_pairs = 0u64;
            let mut run = || {
                traversal.counters = Default::default();
                for relative in &placements {
                    let _ = black_box(pairs(&tree, &tree, relative, &mut traversal, |_, _| {
                        leaf_pairs += 1;
                        if first { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                    }));
                }
            };
            let ns = least_ns(5, &mut run);
            let count = traversal.counters;
            let queries = placements.len() as f64;
            eprintln!(
                "  {name}: {:.0} ns, {:.1} box tests, {:.1} leaf pairs a query, {:.1} ns a box test",
                ns / queries,
                count.box_tests as f64 / queries,
                count.leaf_visits as f64 / queries,
                ns / count.box_tests as f64
            );
        }
    }
}
