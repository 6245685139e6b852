use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{in_cube, seeded};
use solid3d::Aabb;
use solid3d::glam::{DAffine3, DQuat, DVec3};

use super::*;
use crate::inputs::{Mesh, Polyhedron};

/// Tori and polyhedra in turn, with so many triangles at most.
fn solid(rng: &mut StdRng, round: usize) -> Mesh {
    if round.is_multiple_of(3) {
        let polyhedron = Polyhedron::random(rng, 8 + round % 7);
        let triangles = polyhedron.hull.triangles().to_vec();
        return Mesh { vertices: polyhedron.vertices, triangles };
    }
    let triangles = [18, 72, 128, 200][round % 4];
    Mesh::torus(triangles)
}

fn placement(rng: &mut StdRng, reach: f64) -> DAffine3 {
    let turn = DQuat::from_axis_angle(in_cube(rng).normalize(), rng.random_range(0.0..6.0));
    DAffine3::from_rotation_translation(turn, in_cube(rng) * reach)
}

fn tree(mesh: &Mesh) -> BspTree {
    BspTree::of_triangles(mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices[v as usize])))
}

fn moved(mesh: &Mesh, placement: &DAffine3) -> Mesh {
    let vertices = mesh.vertices.iter().map(|p| placement.transform_point3(*p)).collect();
    Mesh { vertices, triangles: mesh.triangles.clone() }
}

/// By the oracle: the surfaces meet, or one solid is within the other.
fn solids_intersect(a: &Mesh, b: &Mesh) -> bool {
    let inside = |x: &Mesh, y: &Mesh| {
        solid_oracle::winding_number(&y.vertices, &y.triangles, x.vertices[0]).is_some_and(|n| n != 0)
    };
    inside(a, b)
        || inside(b, a)
        || !solid_oracle::mesh_pairs(&a.vertices, &a.triangles, &b.vertices, &b.triangles).is_empty()
}

#[test]
fn merging_finds_what_the_oracle_finds_either_way_round() {
    const ROUNDS: usize = 150;
    let mut rng = seeded(95);
    let mut merge = Merge::default();
    let (mut hits, mut within) = (0, 0);
    for round in 0..ROUNDS {
        let (a, b) = (solid(&mut rng, round), solid(&mut rng, round / 2));
        // One in ten so small, and so near to the middle, that it may lie within the other.
        let (scale, reach) = if round.is_multiple_of(10) { (0.1, 0.5) } else { (1.0, 2.0) };
        let b_to_a = placement(&mut rng, reach) * DAffine3::from_scale(DVec3::splat(scale));
        let b_in_a = moved(&b, &b_to_a);
        let expected = solids_intersect(&a, &b_in_a);
        hits += usize::from(expected);
        within += usize::from(
            expected
                && solid_oracle::mesh_pairs(&a.vertices, &a.triangles, &b_in_a.vertices, &b_in_a.triangles)
                    .is_empty(),
        );
        let (tree_a, tree_b) = (tree(&a), tree(&b));
        assert_eq!(merge.intersect(&tree_a, &tree_b, &b_to_a), expected, "round {round}");
        assert_eq!(merge.intersect(&tree_b, &tree_a, &b_to_a.inverse()), expected, "round {round}, swapped");
    }
    assert!((ROUNDS * 3 / 10..ROUNDS * 7 / 10).contains(&hits), "{hits} of {ROUNDS}: not representative");
    assert!(within > 0, "no solid lay within another");
    let Counters { planes, cuts } = merge.counters();
    assert!(0 < cuts && cuts < planes, "{cuts} of {planes}");
}

#[test]
fn a_tree_contains_the_points_that_its_surface_winds_around() {
    const POINTS: usize = 600;
    let mut rng = seeded(96);
    let mut inside = 0;
    for round in 0..6 {
        let mesh = solid(&mut rng, round);
        let tree = tree(&mesh);
        let Aabb { min, max } = tree.bounds();
        for _ in 0..POINTS / 6 {
            let point = (min + max) / 2.0 + (max - min) / 2.0 * in_cube(&mut rng);
            let winds = solid_oracle::winding_number(&mesh.vertices, &mesh.triangles, point);
            let expected = winds.expect("no random point is on a surface") == 1;
            inside += usize::from(expected);
            assert_eq!(tree.contains(point), expected, "round {round}, {point}");
        }
    }
    assert!((POINTS * 3 / 10..POINTS * 7 / 10).contains(&inside), "{inside} of {POINTS}: not representative");
}

/// An L: not convex, with facets in common planes, each of them of many triangles.
fn bracket() -> Vec<[DVec3; 3]> {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |i: usize, z: f64| DVec3::new(outline[i % 6][0], outline[i % 6][1], z);
    let lids = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let top = lids.map(|t| t.map(|i| at(i, 1.0)));
    let bottom = lids.map(|[i, j, k]| [i, k, j].map(|i| at(i, 0.0)));
    let walls = (0..6).flat_map(|i| {
        let [p, q, r, s] = [at(i, 0.0), at(i + 1, 0.0), at(i + 1, 1.0), at(i, 1.0)];
        [[p, q, r], [p, r, s]]
    });
    top.into_iter().chain(bottom).chain(walls).collect()
}

#[test]
fn coplanar_facets_have_one_plane() {
    let tree = BspTree::of_triangles(bracket());
    // Eight facets, of 20 triangles; the first plane may cut two of them.
    assert!((8..=10).contains(&tree.nodes().len()), "{}", tree.nodes().len());
}

#[test]
fn what_is_thinner_than_the_tolerance_counts_as_nothing() {
    let tree = BspTree::of_triangles(bracket());
    // The greatest coordinate is that of the second one's far sides.
    let tolerance = 3.0 * FLAT;
    // The notch of one takes the corner of the other, with faces in common planes.
    let nested = DAffine3::from_translation(DVec3::new(1.0, 1.0, 0.0));
    let mut merge = Merge::default();
    for (depth, expected) in [(-1.0, false), (0.0, false), (0.5, false), (4.0, true)] {
        let b_to_a = DAffine3::from_translation(DVec3::new(-1.0, -1.0, 0.0) * depth * tolerance) * nested;
        assert_eq!(merge.intersect(&tree, &tree, &b_to_a), expected, "{depth} tolerances deep");
    }
}

#[test]
fn no_facets_are_an_empty_solid() {
    let (nothing, bracket) = (BspTree::of_triangles([]), BspTree::of_triangles(bracket()));
    assert!(!nothing.contains(DVec3::ZERO));
    let mut merge = Merge::default();
    assert!(!merge.intersect(&nothing, &bracket, &DAffine3::IDENTITY));
    assert!(!merge.intersect(&bracket, &nothing, &DAffine3::IDENTITY));
    assert!(merge.intersect(&bracket, &bracket, &DAffine3::IDENTITY));
}
