//! Pairs of primitives.

use std::rc::Rc;

use solid_oracle::verdict;
use solid3d::glam::DVec3;
use solid3d::query;

use super::pairs::{Scene, Truth, intersection};
use crate::inputs::{PairPose, Primitive, pairs_at_overlap};
use crate::peers::bench::Unit;
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Ours, Primitives, each};
use crate::peers::{Bench, Kind, Peer};

const SPHERE: Primitive = Primitive::Sphere(1.0);
const CUBOID: Primitive = Primitive::Cuboid(DVec3::new(1.0, 1.4, 1.8));
const CAPSULE: Primitive = Primitive::Capsule(0.5, 1.0);

/// The pairs with their names.
const CASES: [(&str, [Primitive; 2]); 5] = [
    ("sphere-sphere", [SPHERE, SPHERE]),
    ("sphere-box", [SPHERE, CUBOID]),
    ("capsule-capsule", [CAPSULE, CAPSULE]),
    ("box-box", [CUBOID, CUBOID]),
    ("capsule-box", [CAPSULE, CUBOID]),
];

/// As for convex polyhedra.
const REACH: f64 = 20.0;
const PAIRS: usize = 1000;
const JUDGED: usize = 200;

/// Half of the pairs meet.
const OVERLAP: f64 = 0.5;

/// Races, and judges.
pub fn measure(bench: &mut Bench) {
    for (name, primitives) in &CASES {
        let mut rng = bench.rng(name);
        let shapes = primitives.map(|primitive| primitive.shape().expect("the sizes are valid"));
        let poses = pairs_at_overlap(&mut rng, bench.effort.sample(PAIRS), OVERLAP, REACH, |_, pair| {
            let [at_a, at_b] = pair.map(|pose| pose.affine());
            query::intersects(&shapes[0], &at_a, &shapes[1], &at_b).expect("the poses are valid")
        });
        let entries = vec![
            intersection(&scene::<Ours>(primitives, &poses)),
            intersection(&scene::<double::Parry>(primitives, &poses)),
            intersection(&scene::<single::Parry>(primitives, &poses)),
        ];
        bench.race(&format!("{name}, intersection"), poses.len(), Unit::Nano, entries);

        let [a, b] = primitives.map(Primitive::convex);
        let truth = |pair: &PairPose| {
            let [at_a, at_b] = pair.map(|pose| pose.affine());
            Truth { meet: verdict(&a, &at_a, &b, &at_b).shares_point(), distance: None }
        };
        let truths: Vec<Truth> = poses.iter().take(bench.effort.sample(JUDGED)).map(truth).collect();
        let wrong = each!(wrong: Ours, double::Parry, single::Parry; (primitives, &poses, &truths));
        bench.figures(&format!("{name}, wrong answers of {}", truths.len()), Kind::Wrong, "wrong", &wrong);
    }
}

fn scene<L: Primitives>(primitives: &[Primitive; 2], poses: &[PairPose]) -> Rc<Scene<L>> {
    Scene::new(primitives.map(L::primitive), poses)
}

fn wrong<L: Primitives>(primitives: &[Primitive; 2], poses: &[PairPose], truths: &[Truth]) -> (Peer, f64) {
    (L::PEER, scene::<L>(primitives, poses).wrong(truths, 0.0)[0] as f64)
}
