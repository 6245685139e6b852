//! Slabs, and what they do for distances.

use fearless_simd::Simd;
use glam::DVec3;
use rand::Rng;
use solid_convex::simd::alike;

use super::scenes::{affine, point, relative, rng, torus};
use crate::Aabb;
use crate::tree::node::{Kind, WIDTH};
use crate::tree::slabs::center;
use crate::tree::{Counters, Facing, NearLeafPairs, PairMetric, Slabs, Traversal, Tree, nearest_pairs_on};

/// Primitives as hulls of vertices, which are all that is looked at.
struct Soup {
    vertices: Vec<DVec3>,
    primitives: Vec<Vec<u32>>,
    tree: Tree,
}

impl Soup {
    fn new(parts: &[Vec<DVec3>]) -> Soup {
        let vertices = parts.concat();
        let mut first = 0;
        let mut primitives = Vec::new();
        for part in parts {
            primitives.push((first..first + part.len() as u32).collect());
            first += part.len() as u32;
        }
        let boxes: Vec<Aabb> = parts.iter().map(|part| Aabb::of_points(part.iter().copied())).collect();
        Soup { vertices, primitives, tree: Tree::build(&boxes) }
    }

    fn slabs(&self) -> Slabs {
        Slabs::new(&self.tree, &self.vertices, |primitive| &self.primitives[primitive as usize])
    }
}

/// The least distance of vertices, as placed.
struct Vertices<'s> {
    soups: [&'s Soup; 2],
    placed: &'s [Vec<DVec3>; 2],
}

impl NearLeafPairs for Vertices<'_> {
    fn visit<S: Simd>(&mut self, _: S, in_a: &[u32], in_b: &[u32], best: &mut f64) {
        let [a, b] = self.soups;
        let [at_a, at_b] = self.placed;
        for &i in in_a.iter().flat_map(|&primitive| &a.primitives[primitive as usize]) {
            for &j in in_b.iter().flat_map(|&primitive| &b.primitives[primitive as usize]) {
                *best = best.min(at_a[i as usize].distance(at_b[j as usize]));
            }
        }
    }
}

/// Under any affine map, of any size: slabs change no answer, and save visits; all levels of instructions agree.
#[test]
fn slabs_lose_nothing() {
    let mut rng = rng(60);
    let mut visits = [0; 2];
    for round in 0..60 {
        let size = 10f64.powi(round % 13 - 6);
        // Triangles of a bent sheet, a torus, or a cloud of polyhedra.
        let mut soup = |size: f64| {
            let mut parts: Vec<Vec<DVec3>> = match round % 3 {
                0 => torus(40, 14, |p| p * 0.1).iter().map(|t| t.to_vec()).collect(),
                1 => torus(40, 14, |p| DVec3::new(p.x, p.y, 0.1 * p.x * p.y) * 0.1)
                    .iter()
                    .map(|t| t.to_vec())
                    .collect(),
                _ => (0..300)
                    .map(|_| {
                        let center = point(&mut rng, 1.0);
                        let count = rng.random_range(1..6);
                        (0..count).map(|_| center + point(&mut rng, 0.05)).collect()
                    })
                    .collect(),
            };
            parts.iter_mut().flatten().for_each(|p| *p *= size);
            Soup::new(&parts)
        };
        let soups = [soup(1.0), soup(size.sqrt())];
        let away = if round % 2 == 0 { 3.0 } else { 1.0 };
        let placements = [affine(&mut rng, 1.0, away), affine(&mut rng, size.sqrt(), away)];
        let [of_a, of_b] = placements;
        let relative = relative(of_a.inverse() * of_b, 4.0, 4.0 * size.sqrt());
        let placed = [0, 1].map(|i: usize| {
            soups[i].vertices.iter().map(|&v| placements[i].transform_point3(v)).collect::<Vec<_>>()
        });
        let slabs = soups.each_ref().map(Soup::slabs);
        let facing = Facing { slabs: slabs.each_ref(), placements };
        // Boxes tell nothing: all that is skipped is skipped by slabs.
        let nothing =
            PairMetric { facet_a: DVec3::ZERO, facet_b: DVec3::ZERO, sigma_min_a: 0.0, sigma_min_b: 0.0 };
        let mut answers = Vec::new();
        for facing in [Some(&facing), None] {
            answers.push(alike(|level| {
                let (mut best, mut traversal) = (f64::INFINITY, Traversal::default());
                let mut visitor = Vertices { soups: soups.each_ref(), placed: &placed };
                let [a, b] = &soups;
                nearest_pairs_on(
                    level,
                    &a.tree,
                    &b.tree,
                    &relative,
                    &nothing,
                    facing,
                    &mut best,
                    &mut traversal,
                    &mut visitor,
                );
                (best, traversal.counters)
            }));
        }
        assert_eq!(answers[0].0, answers[1].0, "round {round}");
        for (sum, (_, Counters { leaf_visits, .. })) in visits.iter_mut().zip(&answers) {
            *sum += leaf_visits;
        }
    }
    println!("{visits:?} leaf pairs with slabs and without");
    assert!(10 * visits[0] < visits[1]);
}

/// Law: every point of a lane lies in its slab, of any tree and size.
#[test]
fn slabs_hold_their_points() {
    let mut rng = rng(61);
    for scale in [1e-30, 1.0, 1e30] {
        let offset = point(&mut rng, 3.0);
        let parts: Vec<Vec<DVec3>> =
            torus(60, 20, |p| (p + offset) * scale).iter().map(|t| t.to_vec()).collect();
        let soup = Soup::new(&parts);
        let Slabs { eights } = soup.slabs();
        let (mut held, mut thin) = (0, 0);
        for (node, slabs) in soup.tree.nodes.iter().zip(&eights) {
            for lane in 0..WIDTH {
                let Kind::Leaf(range) = node.child[lane].kind() else { continue };
                let normal = DVec3::from_array([0, 1, 2].map(|axis| f64::from(slabs.normal[axis][lane])));
                let of = |axis: usize| (node.min[axis][lane], node.max[axis][lane]);
                let center =
                    DVec3::from_array([0, 1, 2].map(|axis| f64::from(center(of(axis).0, of(axis).1))));
                for &primitive in &soup.tree.order[range] {
                    for p in &parts[primitive as usize] {
                        let p = (*p - soup.tree.normal.origin) * soup.tree.normal.inverse;
                        let height = normal.dot(p - center) - f64::from(slabs.middle[lane]);
                        assert!(height.abs() <= f64::from(slabs.half[lane]));
                        held += 1;
                    }
                }
                let widest = (0..3).map(|axis| of(axis).1 - of(axis).0).fold(0.0, f32::max);
                thin += usize::from(4.0 * slabs.half[lane] < widest);
            }
        }
        assert!(held == 3 * parts.len() && 2 * thin > eights.len());
    }
}
