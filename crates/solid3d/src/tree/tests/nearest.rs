//! Branch and bound against brute force.

use super::scenes::{
    affine, boxes_of, metric, point, random_boxes, relative, rng, torus, torus_placement, uniform,
};
use crate::Aabb;
use crate::tree::{Relative, Traversal, Tree, nearest_pairs};
use glam::{DAffine3, DVec3};
use rand::rngs::StdRng;

#[test]
fn nearest_is_that_of_brute_force() {
    let mut rng = rng(11);
    for scale in [1e-50, 1.0, 1e50] {
        let boxes: Vec<Aabb> = random_boxes(&mut rng, 2000, 0.02)
            .iter()
            .map(|b| Aabb::new(b.min * scale, b.max * scale))
            .collect();
        let tree = Tree::build(&boxes);
        let mut traversal = Traversal::default();
        for _ in 0..200 {
            let query = point(&mut rng, 3.0) * scale;
            let distance = |b: &Aabb| query.distance(query.clamp(b.min, b.max));
            let mut best = f64::INFINITY;
            tree.nearest(distance, &mut best, &mut traversal, |leaf, best| {
                *best = leaf.iter().map(|&i| distance(&boxes[i as usize])).fold(*best, f64::min);
            });
            assert_eq!(best, boxes.iter().map(distance).fold(f64::INFINITY, f64::min));
        }
        assert!(traversal.counters.leaf_visits < 200 * 10, "{:?}", traversal.counters);
    }
}

#[test]
fn nearest_ends_at_zero_and_needs_not_find() {
    let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE); 500]);
    let mut traversal = Traversal::default();
    tree.nearest(|_| 0.0, &mut f64::INFINITY.clone(), &mut traversal, |_, best| *best = 0.0);
    assert_eq!(traversal.counters.leaf_visits, 1);
    let mut limit = 1.0;
    tree.nearest(|_| 1.0, &mut limit, &mut traversal, |_, _| panic!("nothing is nearer than the limit"));
}

#[test]
fn nearest_pairs_end_at_zero() {
    let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE); 500]);
    let relative = relative(DAffine3::IDENTITY, 2.0, 2.0);
    let ones = uniform(1.0);
    let mut traversal = Traversal::default();
    let mut best = f64::INFINITY;
    nearest_pairs(&tree, &tree, &relative, &ones, &mut best, &mut traversal, |_, _, best| *best = 0.0);
    assert_eq!(traversal.counters.leaf_visits, 1);
}

/// Four points: a primitive whose distance to another is simple.
type Cloud = [DVec3; 4];

fn clouds(rng: &mut StdRng, n: usize, scale: f64) -> Vec<Cloud> {
    random_boxes(rng, n, 0.05)
        .iter()
        .map(|b| [(); 4].map(|()| (b.center() + b.half_extents() * point(rng, 1.0)) * scale))
        .collect()
}

fn distance(a: &Cloud, b: &Cloud) -> f64 {
    a.iter().flat_map(|p| b.iter().map(move |q| p.distance(*q))).fold(f64::INFINITY, f64::min)
}

fn placed(clouds: &[Cloud], map: &DAffine3) -> Vec<Cloud> {
    clouds.iter().map(|cloud| cloud.map(|p| map.transform_point3(p))).collect()
}

fn tree_of(clouds: &[Cloud]) -> Tree {
    Tree::build(&clouds.iter().map(|c| Aabb::of_points(*c)).collect::<Vec<_>>())
}

#[test]
fn nearest_pairs_is_that_of_brute_force_under_any_affine_map_and_size() {
    let mut rng = rng(12);
    let mut traversal = Traversal::default();
    let (rounds, n) = (300, 150);
    for round in 0..rounds {
        let size = 10f64.powi(round % 13 - 6);
        // Half of the size in the local coordinates, half in the placement.
        let (a, b) = (clouds(&mut rng, n, 1.0), clouds(&mut rng, n, size.sqrt()));
        let place_a = affine(&mut rng, 1.0, 10.0);
        let place_b = affine(&mut rng, size.sqrt(), 10.0);
        let relative = relative(place_a.inverse() * place_b, 20.0, 2.0 * size.sqrt());
        let (world_a, world_b) = (placed(&a, &place_a), placed(&b, &place_b));
        let mut best = f64::INFINITY;
        let metric = metric(&place_a, &place_b);
        nearest_pairs(
            &tree_of(&a),
            &tree_of(&b),
            &relative,
            &metric,
            &mut best,
            &mut traversal,
            |la, lb, best| {
                for &i in la {
                    for &j in lb {
                        *best = best.min(distance(&world_a[i as usize], &world_b[j as usize]));
                    }
                }
            },
        );
        let pairs = world_a.iter().flat_map(|p| world_b.iter().map(move |q| distance(p, q)));
        assert_eq!(best, pairs.fold(f64::INFINITY, f64::min), "round {round}, size {size}");
    }
    let leaf_pairs = traversal.counters.leaf_visits as f64 / f64::from(rounds);
    eprintln!("{leaf_pairs:.1} leaf pairs a query, of about 700");
    assert!(leaf_pairs < 250.0);
}

#[test]
fn a_metric_that_knows_nothing_visits_everything() {
    let mut rng = rng(13);
    let tree = tree_of(&clouds(&mut rng, 100, 1.0));
    let far = relative(DAffine3::from_translation(DVec3::splat(10.0)), 2.0, 2.0);
    let nothing = uniform(0.0);
    let mut seen = 0;
    nearest_pairs(&tree, &tree, &far, &nothing, &mut 1e-300, &mut Traversal::default(), |a, b, _| {
        seen += a.len() * b.len();
    });
    assert_eq!(seen, 100 * 100);
}

#[test]
fn distance_in_units_of_any_size() {
    let mut rng = rng(14);
    for scale in [1e-80, 1e80] {
        let unit = clouds(&mut rng, 200, 1.0);
        let tree = tree_of(&placed(&unit, &DAffine3::from_scale(DVec3::splat(scale))));
        let shift = DVec3::new(3.0, 1.0, 0.0);
        let b_to_a = DAffine3::from_translation(shift * scale);
        let relative = Relative {
            b_to_a,
            a_to_b: b_to_a.inverse(),
            slack_in_a: 1e-14 * scale,
            slack_in_b: 1e-14 * scale,
        };
        let ones = uniform(1.0);
        let other = placed(&unit, &DAffine3::from_translation(shift));
        let mut best = f64::INFINITY;
        let mut traversal = Traversal::default();
        nearest_pairs(&tree, &tree, &relative, &ones, &mut best, &mut traversal, |la, lb, best| {
            for &i in la {
                for &j in lb {
                    *best = best.min(distance(&unit[i as usize], &other[j as usize]) * scale);
                }
            }
        });
        let least = unit.iter().flat_map(|p| other.iter().map(move |q| distance(p, q)));
        assert_eq!(best, least.fold(f64::INFINITY, f64::min) * scale);
        assert!(traversal.counters.leaf_visits < 60, "{:?}", traversal.counters);
    }
}

#[test]
fn the_work_on_separated_tori_is_modest() {
    let mut rng = rng(15);
    let triangles = torus(100, 25, |p| p);
    let tree = Tree::build(&boxes_of(&triangles));
    let ones = uniform(1.0);
    let mut traversal = Traversal::default();
    let rounds = 200;
    for _ in 0..rounds {
        let relative = relative(torus_placement(&mut rng), 12.0, 12.0);
        let moved: Vec<_> =
            triangles.iter().map(|t| t.map(|p| relative.b_to_a.transform_point3(p))).collect();
        let mut best = f64::INFINITY;
        nearest_pairs(&tree, &tree, &relative, &ones, &mut best, &mut traversal, |la, lb, best| {
            for &i in la {
                for &j in lb {
                    let (a, b) = (&triangles[i as usize], &moved[j as usize]);
                    // Vertices only: an upper bound of the distance of the triangles, so more work than theirs.
                    *best = a.iter().flat_map(|p| b.iter().map(|q| p.distance(*q))).fold(*best, f64::min);
                }
            }
        });
    }
    let per = |count: u64| count as f64 / f64::from(rounds);
    let count = traversal.counters;
    eprintln!("{:.1} box tests, {:.1} leaf pairs a query", per(count.box_tests), per(count.leaf_visits));
    assert!(per(count.box_tests) < 1000.0);
}
