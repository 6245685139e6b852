use rand::Rng;
use solid_oracle::generate::{in_cube, seeded};
use solid_oracle::{Convex, distance_bounds, verdict};
use solid3d::glam::{DAffine3, DQuat, DVec3};

use super::*;

/// Polytopes of 4 to 40 vertices at distances at which half of them overlap.
fn random_pairs(count: usize) -> Vec<[(Vec<DVec3>, DAffine3); 2]> {
    let mut rng = seeded(44);
    let mut placed = |reach: f64| {
        let vertices = (0..rng.random_range(4..=40)).map(|_| in_cube(&mut rng)).collect::<Vec<_>>();
        let turn = DQuat::from_axis_angle(in_cube(&mut rng).normalize(), rng.random_range(0.0..6.0));
        (vertices, DAffine3::from_rotation_translation(turn, in_cube(&mut rng) * reach))
    };
    (0..count).map(|_| [placed(0.0), placed(1.9)]).collect()
}

fn each_pair(count: usize, mut judge: impl FnMut(&Pair, bool, f64)) {
    let mut hits = 0;
    for [(a, placement_a), (b, placement_b)] in &random_pairs(count) {
        let [convex_a, convex_b] = [a, b].map(|points| Convex::Hull { points: points.clone() });
        let hit = verdict(&convex_a, placement_a, &convex_b, placement_b)
            .shares_point()
            .expect("polytopes are decided");
        let (_, distance) = distance_bounds(&convex_a, placement_a, &convex_b, placement_b);
        let [a, b] = [a, b].map(|points| Polytope::hull_of(points).expect("there are points"));
        judge(&Pair { a: &a, placement_a, b: &b, placement_b }, hit, distance);
        hits += usize::from(hit);
    }
    assert!((count * 3 / 10..count * 7 / 10).contains(&hits), "{hits} of {count}: not representative");
}

fn agrees_with_the_oracle(mut test: impl ConvexTest) {
    let mut memory = Memory::default();
    each_pair(400, |pair, hit, _| {
        // Two starts: from nothing, and from what the pair left.
        memory = Memory::default();
        assert_eq!(test.intersects(pair, &mut memory), hit, "{}: {:?}, {pair:?}", test.name(), memory);
        assert_eq!(test.intersects(pair, &mut memory), hit, "{}, warm: {pair:?}", test.name());
    });
    assert_eq!(test.counters().tests, 800);
    assert_eq!(test.counters().gave_up, 0, "{}", test.name());
}

#[test]
fn isa_gjk_agrees_with_the_oracle() {
    agrees_with_the_oracle(IsaGjk::default());
}

#[test]
fn chung_wang_agrees_with_the_oracle() {
    agrees_with_the_oracle(ChungWang::default());
}

#[test]
fn lin_canny_agrees_with_the_oracle() {
    agrees_with_the_oracle(LinCanny::default());
}

#[test]
fn signed_volumes_agree_with_the_oracle() {
    agrees_with_the_oracle(SignedVolumes::default());
}

#[test]
fn the_linear_program_agrees_with_the_oracle() {
    agrees_with_the_oracle(LinearProgram::default());
}

#[test]
fn bsp_trees_agree_with_the_oracle() {
    agrees_with_the_oracle(BspTrees::default());
}

#[test]
fn enhanced_gjk_agrees_with_the_oracle() {
    agrees_with_the_oracle(EnhancedGjk::default());
}

#[test]
fn the_library_agrees_with_the_oracle() {
    agrees_with_the_oracle(Library::default());
}

/// Rounding, relative to the size of the objects, which is about 1.
const DISTANCE_ERROR: f64 = 1e-9;

#[test]
fn distances_agree_with_the_oracle() {
    for rules in [Rules::thesis(1e-10), Rules::original(1e-10)] {
        each_pair(200, |pair, _, expected| {
            let found = distance(pair, &rules);
            assert!(
                (found.distance - expected).abs() <= DISTANCE_ERROR,
                "{rules:?}: {found:?}, not {expected}"
            );
            assert!(
                (found.on_a.distance(found.on_b) - expected).abs() <= DISTANCE_ERROR,
                "{rules:?}: {found:?}"
            );
        });
    }
}

#[test]
fn climbing_finds_what_scanning_finds() {
    let mut rng = seeded(45);
    for [(points, _), _] in random_pairs(50) {
        let polytope = Polytope::hull_of(&points).expect("there are points");
        for start in 0..polytope.vertices().len() as u32 {
            let d = in_cube(&mut rng);
            assert_eq!(polytope.climb(d, start), polytope.scan(d));
        }
    }
}
