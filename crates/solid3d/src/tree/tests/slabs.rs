//! Slabs, and what they do for distances and intersections.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_convex::simd::{alike, dispatch};

use super::scenes::{affine, point, relative, rng, torus, uniform};
use crate::Aabb;
use crate::tree::crossing::Folded;
use crate::tree::eights::Overlaps;
use crate::tree::node::{Kind, WIDTH};
use crate::tree::parting::Parting;
use crate::tree::slabs::center;
use crate::tree::{Counters, Facing, NearLeafPairs, Place, Slabs, Traversal, Tree, nearest_pairs_on};

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

    /// The lanes below which some primitive is, and that, which is any; from the root on.
    fn some_way_down(&self, rng: &mut StdRng) -> (Vec<(usize, usize)>, u32) {
        let (mut node, mut way) = (0, Vec::new());
        loop {
            let used =
                self.tree.nodes[node].child.iter().take_while(|child| child.kind() != Kind::Empty).count();
            let lane = rng.random_range(0..used);
            way.push((node, lane));
            match self.tree.nodes[node].child[lane].kind() {
                Kind::Empty => unreachable!("it is in use"),
                Kind::Inner(child) => node = child,
                Kind::Leaf(leaf) => {
                    let leaf = self.tree.leaf(leaf);
                    return (way, leaf[rng.random_range(0..leaf.len())]);
                }
            }
        }
    }
}

/// Whether slabs leave two lanes together, which the three ways to ask agree on, on all levels of instructions.
fn left_together(
    soups: [&Soup; 2],
    slabs: [&Slabs; 2],
    b_to_a: DAffine3,
    lanes: [(usize, usize); 2],
) -> bool {
    let [a, b] = soups.map(|soup| &soup.tree);
    let relative = relative(b_to_a, reach(a), reach(b));
    let ways = [
        Folded::new(&relative.b_to_a, relative.slack_in_a, &b.normal, &a.normal),
        Folded::new(&relative.a_to_b, relative.slack_in_b, &a.normal, &b.normal),
    ];
    let parting = Parting::new([a, b], slabs, &ways);
    let [(node_a, lane_a), (node_b, lane_b)] = lanes;
    let bit = 1 << (WIDTH * lane_b + lane_a);
    alike(|level| {
        dispatch!(widest level, simd => {
            let mut overlaps = Overlaps { hits: u64::MAX, deepest: Some(3), ..Overlaps::default() };
            parting.part(simd, node_a, node_b, &mut overlaps);
            let is_left = overlaps.hits & bit != 0;
            assert_eq!(overlaps.deepest.is_some(), overlaps.hits == u64::MAX);
            let of_a = parting.apart_from::<_, 0>(simd, node_a, Place::lane(node_b, lane_b));
            let of_b = parting.apart_from::<_, 1>(simd, node_b, Place::lane(node_a, lane_a));
            assert_eq!((of_a >> lane_a & 1 == 0, of_b >> lane_b & 1 == 0), (is_left, is_left));
            is_left
        })
    })
}

/// How far a tree reaches from its local origin.
fn reach(tree: &Tree) -> f64 {
    let bounds = tree.bounds();
    bounds.min.abs().max(bounds.max.abs()).max_element()
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
        // Boxes tell next to nothing: all that is skipped is skipped by slabs.
        let next_to_nothing = uniform(1e-6);
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
                    &next_to_nothing,
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

/// Law: what has a point in common is left together by all lanes that it is below, under maps of any size; of two lanes of leaves that face
/// each other and touch with their outermost points too, and a little further apart they are parted.
#[test]
fn what_touches_is_left_together() {
    let mut rng = rng(62);
    let (mut parted, mut asked) = (0, 0);
    for round in 0..300 {
        let sizes = [1.0, [1.0, 1e-3, 30.0, 1e-30][round % 4]];
        let soups = sizes.map(|size| {
            let warp = point(&mut rng, 0.1);
            let bent = |p: DVec3| (p + warp * p.x * p.y) * size;
            Soup::new(&torus(40, 14, bent).iter().map(|t| t.to_vec()).collect::<Vec<_>>())
        });
        let slabs = soups.each_ref().map(Soup::slabs);
        let (soups, slabs) = (soups.each_ref(), slabs.each_ref());
        let ways = soups.map(|soup| soup.some_way_down(&mut rng));
        let mut inside = |i: usize| {
            let triangle = &soups[i].primitives[ways[i].1 as usize];
            let [p, q, r] = [0, 1, 2].map(|corner| soups[i].vertices[triangle[corner] as usize]);
            p.lerp(q, rng.random()).lerp(r, rng.random())
        };
        let common = [inside(0), inside(1)];
        let DAffine3 { matrix3, .. } = affine(&mut rng, sizes[0] / sizes[1], 0.0);
        let onto = |matrix3: DMat3, [p, q]: [DVec3; 2]| DAffine3 { matrix3, translation: p - matrix3 * q };
        let at = onto(matrix3, common);
        for &of_a in &ways[0].0 {
            for &of_b in &ways[1].0 {
                assert!(left_together(soups, slabs, at, [of_a, of_b]), "round {round}: {of_a:?} {of_b:?}");
            }
        }
        // Leaf against leaf, slab to slab.
        let leaves = [0, 1].map(|i: usize| *ways[i].0.last().expect("there is a leaf"));
        let normals = [0, 1].map(|i: usize| {
            let (node, lane) = leaves[i];
            DVec3::from_array([0, 1, 2].map(|axis| f64::from(slabs[i].eights[node].normal[axis][lane])))
                .normalize()
        });
        let outermost = [0, 1].map(|i: usize| {
            let Kind::Leaf(leaf) = soups[i].tree.nodes[leaves[i].0].child[leaves[i].1].kind() else {
                panic!()
            };
            let points = soups[i].tree.leaf(leaf).iter().flat_map(|&j| &soups[i].primitives[j as usize]);
            let points = points.map(|&point| soups[i].vertices[point as usize]);
            points.max_by(|p, q| p.dot(normals[i]).total_cmp(&q.dot(normals[i]))).expect("it has points")
        });
        let turn =
            DMat3::from_quat(DQuat::from_rotation_arc(normals[1], -normals[0])) * (sizes[0] / sizes[1]);
        let at = onto(turn, outermost);
        assert!(left_together(soups, slabs, at, leaves), "round {round}");
        let away = DAffine3 { translation: at.translation + normals[0] * 1e-4 * reach(&soups[0].tree), ..at };
        parted += usize::from(!left_together(soups, slabs, away, leaves));
        asked += 1;
    }
    println!("{parted} of {asked} are parted");
    assert!(parted == asked);
}
