//! Boxes and placed boxes against a tree, and against brute force.

use super::scenes::{affine, point, random_boxes, relative, rng};
use crate::Aabb;
use crate::tree::{PlacedBox, Traversal, Tree};
use glam::DVec3;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

fn found(tree: &Tree, query: &Aabb, traversal: &mut Traversal) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    let _ = tree.overlapping(query, traversal, |leaf| {
        found.extend(leaf);
        ControlFlow::<()>::Continue(())
    });
    found
}

#[test]
fn no_overlapping_box_is_lost_and_few_others_come() {
    let mut rng = rng(1);
    let boxes = random_boxes(&mut rng, 3000, 0.05);
    let tree = Tree::build(&boxes);
    let (mut traversal, mut hits, mut reported) = (Traversal::default(), 0, 0);
    for _ in 0..300 {
        let query = Aabb::of_points([point(&mut rng, 1.2), point(&mut rng, 1.2)]);
        let found = found(&tree, &query, &mut traversal);
        for (i, b) in (0..).zip(&boxes) {
            let hit = b.overlaps(&query);
            hits += usize::from(hit);
            assert!(!hit || found.contains(&i), "box {i} is lost");
        }
        reported += found.len();
    }
    assert!(hits > 10_000 && reported < 2 * hits, "{hits} hits, {reported} reported");
    assert!(traversal.counters.box_tests < 300 * tree.node_count() as u64 / 2);
}

#[test]
fn touching_counts_and_an_empty_query_finds_nothing() {
    let boxes: Vec<Aabb> = (0..50).map(|i| DVec3::splat(f64::from(i))).map(|p| Aabb::new(p, p)).collect();
    let (tree, mut traversal) = (Tree::build(&boxes), Traversal::default());
    let query = Aabb::new(DVec3::splat(7.0), DVec3::splat(7.0));
    assert!(found(&tree, &query, &mut traversal).contains(&7));
    assert!(found(&tree, &Aabb::EMPTY, &mut traversal).is_empty());
    let everything = Aabb::new(DVec3::splat(-1e300), DVec3::splat(1e300));
    assert_eq!(found(&tree, &everything, &mut traversal).len(), 50);
}

#[test]
fn the_visitor_ends_the_query() {
    let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE); 100]);
    let mut traversal = Traversal::default();
    let hit = tree.overlapping(&tree.bounds(), &mut traversal, |leaf| ControlFlow::Break(leaf[0]));
    assert!(hit.is_break());
    assert_eq!(traversal.counters.leaf_visits, 1);
}

#[test]
fn no_box_that_a_placed_box_meets_is_lost() {
    let mut rng = rng(2);
    let boxes = random_boxes(&mut rng, 1000, 0.05);
    let tree = Tree::build(&boxes);
    let (mut traversal, mut hits, mut reported) = (Traversal::default(), 0, 0);
    for round in 0..300 {
        let size = 10f64.powi(round % 13 - 6);
        let b_to_a = affine(&mut rng, size, 0.5);
        let half = point(&mut rng, 0.5).abs() / size;
        let bounds = Aabb::new(-half, half);
        let query = PlacedBox { bounds, relative: relative(b_to_a, 2.0, 1.0 / size) };
        let mut found = BTreeSet::<u32>::new();
        let _ = tree.overlapping_box(&query, &mut traversal, |leaf| {
            found.extend(leaf);
            ControlFlow::<()>::Continue(())
        });
        reported += found.len();
        for (i, b) in (0..).zip(&boxes) {
            // A point of a box of the tree, and whether it lies in the query.
            let p = b.center() + point(&mut rng, 1.0) * b.half_extents();
            let q = query.relative.a_to_b.transform_point3(p);
            let hit = bounds.contains(&Aabb::new(q, q));
            hits += usize::from(hit);
            assert!(!hit || found.contains(&i), "box {i} is lost at size {size}");
        }
    }
    assert!(hits > 1000, "{hits} hits are not representative");
    eprintln!("{hits} hits of points, {reported} reported");
}
