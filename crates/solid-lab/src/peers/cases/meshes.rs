//! Pairs of meshes: tori.

use std::rc::Rc;

use solid_oracle::{mesh_distance, mesh_pairs};
use solid3d::glam::DVec3;
use solid3d::{Response, Shape, World, WorldOptions, query};

use super::pairs::{Scene, Truth, all_pairs, distance, distance_again, intersection, report_wrong};
use super::with_commas;
use crate::inputs::{Mesh, PairPose, Pose, pairs_at_overlap, track_at_overlap};
use crate::peers::bench::Unit;
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{AllPairs, Library, Ours, Thesis, each};
use crate::peers::{Bench, Kind, Peer};

/// As for convex polyhedra.
const REACH: f64 = 10.0;

/// The share of pairs that meet: as in the thesis, section 5.2.4.
const OVERLAP: f64 = 0.6;

/// The motion whose distances are asked for: as long as the two are apart, of which these frames have enough.
const TRACK_FRAMES: usize = 4000;
const TRACK_OVERLAP: f64 = 0.1;

/// Off by more than this, a distance is wrong.
const DISTANCE_ERROR: f64 = 1e-5;

/// Of so many pairs are the answers judged; the oracle tests all triangles with all.
const JUDGED: usize = 4;

/// The oracle judges meshes of at most so many triangles.
const JUDGED_TRIANGLES_MAX: usize = 5_000;

/// The inputs of a size: distances of large meshes take some peers seconds each.
struct Size {
    triangles: usize,
    pairs: usize,
    distances: usize,
}

const SIZES: [Size; 2] = [
    Size { triangles: 5_000, pairs: 200, distances: 8 },
    Size { triangles: 100_000, pairs: 50, distances: 2 },
];

/// Races on random pairs and on a motion; then judges.
pub fn measure(bench: &mut Bench) {
    for Size { triangles, pairs, distances } in SIZES {
        let name = format!("tori of {} triangles", with_commas(triangles));
        let mut rng = bench.rng(&name);
        let torus = Mesh::torus(bench.effort.size(triangles));
        let shape = torus.shape();
        let meet = |pair: &PairPose| {
            let [at_a, at_b] = pair.map(|pose| pose.affine());
            query::intersects(&shape, &at_a, &shape, &at_b).expect("the poses are valid")
        };
        let poses =
            pairs_at_overlap(&mut rng, bench.effort.sample(pairs), OVERLAP, REACH, |_, pair| meet(pair));
        hits(bench, &name, &torus, &poses);
        counters(bench, &name, &shape, &torus, &poses);

        let apart: Vec<PairPose> =
            poses.iter().filter(|pair| !meet(pair)).take(bench.effort.sample(distances)).copied().collect();
        race_distances(bench, &name, &torus, &apart);
        if triangles <= JUDGED_TRIANGLES_MAX {
            let few: Vec<PairPose> = poses.iter().take(bench.effort.sample(JUDGED)).copied().collect();
            judge(bench, &name, &torus, &few);
        }
        let frames = track_at_overlap(&mut rng, TRACK_FRAMES, TRACK_OVERLAP, REACH, meet);
        let apart = frames.into_iter().skip_while(meet).take_while(|pair| !meet(pair));
        let apart: Vec<PairPose> = apart.take(bench.effort.sample(pairs / 2)).collect();
        let entries = vec![
            distance_again(&scene::<Ours>(&torus, &apart)),
            distance_again(&scene::<Thesis>(&torus, &apart)),
        ];
        bench.race(&format!("{name}, distance, coherent"), apart.len(), Unit::Micro, entries);
    }
}

fn scene<L: Library>(torus: &Mesh, poses: &[PairPose]) -> Rc<Scene<L>> {
    Scene::new([(); 2].map(|()| L::mesh(L::buffers(torus))), poses)
}

fn hits(bench: &mut Bench, name: &str, torus: &Mesh, poses: &[PairPose]) {
    let (ours, thesis) = (scene::<Ours>(torus, poses), scene::<Thesis>(torus, poses));
    let entries = vec![
        intersection(&ours),
        intersection(&thesis),
        intersection(&scene::<double::Parry>(torus, poses)),
        intersection(&scene::<single::Parry>(torus, poses)),
    ];
    bench.race(&format!("{name}, first hit"), poses.len(), Unit::Micro, entries);
    let entries = vec![all_pairs(&ours), all_pairs(&thesis)];
    bench.race(&format!("{name}, all pairs"), poses.len(), Unit::Micro, entries);
}

fn race_distances(bench: &mut Bench, name: &str, torus: &Mesh, poses: &[PairPose]) {
    let mut entries = vec![distance(&scene::<Ours>(torus, poses)), distance(&scene::<Thesis>(torus, poses))];
    // Of large meshes it takes seconds a pair.
    if torus.triangles.len() <= JUDGED_TRIANGLES_MAX || bench.effort.large() {
        entries.push(distance(&scene::<double::Parry>(torus, poses)));
        entries.push(distance(&scene::<single::Parry>(torus, poses)));
    }
    bench.race(&format!("{name}, distance"), poses.len(), Unit::Micro, entries);
}

/// What the walks to the first hit visit. A box test of ours is one box against eight.
fn counters(bench: &mut Bench, name: &str, shape: &Shape, torus: &Mesh, poses: &[PairPose]) {
    let options =
        WorldOptions { default_response: Response::Simple, caching: false, ..WorldOptions::default() };
    let mut world = World::with_options(&options);
    let ids = [(); 2].map(|()| world.add(shape, Pose::IDENTITY.affine()).expect("the pose is valid"));
    for pair in poses {
        for (id, pose) in ids.iter().zip(pair) {
            world.set_placement(*id, pose.affine()).expect("the pose is valid");
        }
        world.test_pair(ids[0], ids[1]).expect("both are in the world");
    }
    let statistics = world.statistics();
    let thesis = scene::<Thesis>(torus, poses);
    let walked = thesis.each().map(|([a, b], [at_a, at_b])| Thesis::work(a, at_a, b, at_b));
    let [boxes, triangles] = walked.fold([0, 0], |sum, work| [sum[0] + work[0], sum[1] + work[1]]);
    let per_pair = |count: u64| count as f64 / poses.len() as f64;
    let rows = [
        ("box tests to the first hit", statistics.box_tests, boxes),
        ("triangle tests to the first hit", statistics.primitive_tests, triangles),
    ];
    for (what, ours, theirs) in rows {
        let figures = [(Peer::Ours, per_pair(ours)), (Peer::Thesis, per_pair(theirs))];
        bench.figures(&format!("{name}: {what}"), Kind::Count, "tests", &figures);
    }
}

/// Compares the answers with those of the oracle for the vertices as placed, rounded.
fn judge(bench: &mut Bench, name: &str, torus: &Mesh, poses: &[PairPose]) {
    let placed = |pose: &Pose| -> Vec<DVec3> {
        let at = pose.affine();
        torus.vertices.iter().map(|v| at.transform_point3(*v)).collect()
    };
    let (truths, counts): (Vec<Truth>, Vec<usize>) = poses
        .iter()
        .map(|pair| {
            let [a, b] = pair.each_ref().map(placed);
            let count = mesh_pairs(&a, &torus.triangles, &b, &torus.triangles).len();
            let meet = count > 0;
            let distance = if meet { 0.0 } else { mesh_distance(&a, &torus.triangles, &b, &torus.triangles) };
            (Truth { meet: Some(meet), distance: Some([distance; 2]) }, count)
        })
        .unzip();
    let wrong = each!(wrong: Ours, Thesis, double::Parry, single::Parry; (torus, poses, &truths));
    report_wrong(bench, name, ["intersection", "distance"], truths.len(), &wrong);
    let wrong = each!(wrong_counts: Ours, Thesis; (torus, poses, &counts));
    let work = format!("{name}, wrong numbers of pairs of {}", counts.len());
    bench.figures(&work, Kind::Wrong, "wrong", &wrong);
}

fn wrong_counts<L: AllPairs>(torus: &Mesh, poses: &[PairPose], truths: &[usize]) -> (Peer, f64) {
    let scene = scene::<L>(torus, poses);
    let found = scene.each().map(|([a, b], [at_a, at_b])| L::pair_count(a, at_a, b, at_b));
    (L::PEER, found.zip(truths).filter(|(found, truth)| found != *truth).count() as f64)
}

fn wrong<L: Library>(torus: &Mesh, poses: &[PairPose], truths: &[Truth]) -> (Peer, [usize; 2]) {
    (L::PEER, scene::<L>(torus, poses).wrong(truths, DISTANCE_ERROR))
}
