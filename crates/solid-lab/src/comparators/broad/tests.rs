use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::glam::DVec3;

use super::*;

/// A box on a coarse grid, so that ends fall together.
fn random_box(rng: &mut StdRng) -> Aabb {
    let mut cell =
        |below: i32| DVec3::from_array([0; 3].map(|_| f64::from(rng.random_range(0..below)) * 0.25));
    let min = cell(40);
    Aabb::new(min, min + cell(8))
}

fn brute_force(boxes: &[Aabb]) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    for (j, y) in boxes.iter().enumerate() {
        pairs.extend((0..j).filter(|&i| boxes[i].overlaps(y)).map(|i| (i as u32, j as u32)));
    }
    pairs.sort_unstable();
    pairs
}

/// Boxes that creep, boxes that jump, and frames in which nothing moves.
fn keeps_what_brute_force_finds(new: impl Fn(&[Aabb]) -> Box<dyn BroadTest>) {
    for count in [0, 1, 2, 60] {
        let mut rng = seeded(87);
        let mut boxes: Vec<Aabb> = (0..count).map(|_| random_box(&mut rng)).collect();
        let mut engine = new(&boxes);
        assert_eq!(engine.pairs(), brute_force(&boxes), "{}", engine.name());
        let mut changes = 0;
        for frame in 0..120 {
            let mut moved = Vec::new();
            for (i, bounds) in boxes.iter_mut().enumerate() {
                if rng.random_range(0..10) < frame % 11 {
                    let step = DVec3::from_array([0; 3].map(|_| f64::from(rng.random_range(-1..=1)) * 0.25));
                    let old = *bounds;
                    *bounds = if rng.random_range(0..8) == 0 {
                        random_box(&mut rng)
                    } else {
                        Aabb::new(old.min + step, old.max + step)
                    };
                    moved.push((i as u32, *bounds));
                }
            }
            let before = engine.pairs();
            engine.update(&moved);
            let expected = brute_force(&boxes);
            changes += usize::from(before != expected);
            assert_eq!(engine.pairs(), expected, "{}, frame {frame}", engine.name());
        }
        assert!(count < 60 || changes > 60, "{changes} frames changed something");
    }
}

#[test]
fn the_linked_sweep_keeps_what_brute_force_finds() {
    keeps_what_brute_force_finds(|boxes| Box::new(LinkedSweep::new(boxes)));
}

#[test]
fn baraffs_sweep_keeps_what_brute_force_finds() {
    keeps_what_brute_force_finds(|boxes| Box::new(Baraff::new(boxes)));
}

#[test]
fn the_voxel_grid_keeps_what_brute_force_finds() {
    keeps_what_brute_force_finds(|boxes| Box::new(VoxelGrid::new(boxes)));
}

#[test]
fn octrees_and_k_d_trees_keep_what_brute_force_finds() {
    for cut in [Cut::Octree, Cut::KdTree] {
        keeps_what_brute_force_finds(|boxes| Box::new(SpaceTree::new(boxes, cut)));
    }
}

#[test]
fn the_fieldtree_keeps_what_brute_force_finds() {
    keeps_what_brute_force_finds(|boxes| Box::new(FieldTree::new(boxes)));
}
