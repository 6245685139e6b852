use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{in_cube, seeded};
use solid3d::glam::{DAffine3, DQuat, DVec3};

use super::*;

/// Small triangles scattered in a cube: no shape for the split to be lucky with.
fn soup(rng: &mut StdRng, count: usize) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let center = in_cube(rng);
            [0; 3].map(|_| center + 0.2 * in_cube(rng))
        })
        .collect()
}

fn placement(rng: &mut StdRng, reach: f64) -> DAffine3 {
    let turn = DQuat::from_axis_angle(in_cube(rng).normalize(), rng.random_range(0.0..6.0));
    DAffine3::from_rotation_translation(turn, in_cube(rng) * reach)
}

fn indexed(triangles: &[Triangle]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let count = triangles.len() as u32;
    (
        triangles.iter().flatten().copied().collect(),
        (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    )
}

fn finds_what_the_oracle_finds<V: Volume>(options: V::Options) {
    let mut rng = seeded(52);
    let mut hits = 0;
    for round in 0..60 {
        let (x, y) = (soup(&mut rng, 1 + round), soup(&mut rng, 1 + 2 * round));
        let b_to_a = placement(&mut rng, 1.3);
        let moved: Vec<Triangle> = y.iter().map(|t| t.map(|p| b_to_a.transform_point3(p))).collect();
        let ((points, faces), (moved, moved_faces)) = (indexed(&x), indexed(&moved));
        let expected = solid_oracle::mesh_pairs(&points, &faces, &moved, &moved_faces);
        hits += usize::from(!expected.is_empty());
        let (a, b) = (Tree::<V>::build(x, options), Tree::<V>::build(y, options));
        for sat in [Sat::Full, Sat::Lite] {
            let mut traversal = Traversal::new(sat);
            assert_eq!(traversal.intersects(&a, &b, &b_to_a), !expected.is_empty());
            let mut found = traversal.pairs(&a, &b, &b_to_a);
            found.sort_unstable();
            let expected: Vec<(u32, u32)> = expected.iter().map(|&(i, j)| (i, j)).collect();
            assert_eq!(found, expected, "{sat:?}");
        }
    }
    assert!((18..42).contains(&hits), "{hits} of 60: not representative");
}

#[test]
fn aabb_trees_find_what_the_oracle_finds() {
    finds_what_the_oracle_finds::<AlignedBox>(());
}

#[test]
fn obb_trees_find_what_the_oracle_finds() {
    finds_what_the_oracle_finds::<OrientedBox>(Fit::Surface);
    finds_what_the_oracle_finds::<OrientedBox>(Fit::Hull);
}

#[test]
fn sphere_trees_find_what_the_oracle_finds() {
    finds_what_the_oracle_finds::<Ball>(());
}

#[test]
fn k_dop_trees_find_what_the_oracle_finds() {
    finds_what_the_oracle_finds::<Dop>(());
}

#[test]
fn sat_lite_separates_only_what_sat_separates() {
    let mut rng = seeded(53);
    let mut differ = 0;
    for _ in 0..20_000 {
        let [a, b] = [0; 2].map(|_| AlignedBox { center: in_cube(&mut rng), half: in_cube(&mut rng).abs() });
        let shared = AlignedBox::shared(&placement(&mut rng, 1.0));
        let [full, lite] = [Sat::Full, Sat::Lite].map(|sat| AlignedBox::exit_axis(&a, &b, &shared, &(), sat));
        assert!(lite == 0 || lite == full);
        differ += usize::from(full != lite);
    }
    assert!(differ > 100, "{differ}");
}

#[test]
fn a_refitted_tree_is_that_of_the_moved_triangles() {
    let mut rng = seeded(54);
    let (before, after) = (soup(&mut rng, 100), soup(&mut rng, 100));
    let other = Tree::<AlignedBox>::build(soup(&mut rng, 50), ());
    let mut refitted = Tree::<AlignedBox>::build(before, ());
    refitted.refit(&after);
    let rebuilt = Tree::<AlignedBox>::build(after, ());
    for (x, y) in [(|b: &AlignedBox| b.center), (|b: &AlignedBox| b.half)]
        .map(|of| (of(&refitted.nodes[0].volume), of(&rebuilt.nodes[0].volume)))
    {
        assert!(x.abs_diff_eq(y, 1e-14), "{x}, not {y}");
    }
    let [mut found, mut expected] =
        [&refitted, &rebuilt].map(|tree| Traversal::new(Sat::Lite).pairs(tree, &other, &DAffine3::IDENTITY));
    found.sort_unstable();
    expected.sort_unstable();
    assert!(!expected.is_empty());
    assert_eq!(found, expected);
}

#[test]
fn distances_agree_with_the_oracle() {
    let mut rng = seeded(55);
    for round in 0..40 {
        let (x, y) = (soup(&mut rng, 1 + round), soup(&mut rng, 1 + round));
        let b_to_a = placement(&mut rng, 4.0);
        let moved: Vec<Triangle> = y.iter().map(|t| t.map(|p| b_to_a.transform_point3(p))).collect();
        let ((points, faces), (moved, moved_faces)) = (indexed(&x), indexed(&moved));
        let expected = solid_oracle::mesh_distance(&points, &faces, &moved, &moved_faces);
        let (a, b) = (Tree::build(x, ()), Tree::build(y, ()));
        let found = distance(&a, &b, &b_to_a, &mut Counters::default());
        // Rounding, relative to sizes of about 4.
        assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    }
}
