//! Pairs of convex polyhedra.

use std::rc::Rc;

use solid_oracle::{Convex, distance_bounds, penetration_bounds, verdict};
use solid3d::query;

use super::pairs::{
    Scene, Truth, distance, distance_again, intersection, intersection_again, penetration, report_wrong,
};
use super::with_commas;
use crate::inputs::{PairPose, Polyhedron, pairs_at_overlap, track_at_overlap};
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Coherent, Depths, Library, Ours, Thesis, each};
use crate::peers::{Bench, Kind, Peer};

/// No polyhedra whose origins are further apart, in radii, meet; and in so large a cube hardly any do.
const REACH: f64 = 20.0;

/// How many pairs, or frames, are drawn, and of how many the answers are judged.
const PAIRS: usize = 1000;
const JUDGED: usize = 100;

/// Off by more of a radius than this, a distance is wrong: what single precision can give, a hundred times over.
const DISTANCE_ERROR: f64 = 1e-5;

/// Sizes at which answers are judged: 1, and what is 0.1 mm to objects of 1 m.
const SIZES: [(f64, &str); 2] = [(1.0, "radius 1"), (1e-4, "radius 0.0001")];

/// Races on random pairs, then on motions; then judges.
pub fn measure(bench: &mut Bench) {
    for vertices in [20, 100, 1000] {
        let name = format!("{} vertices", with_commas(vertices));
        let mut rng = bench.rng(&name);
        let polyhedra = [(); 2].map(|()| Polyhedron::random(&mut rng, bench.effort.size(vertices)));
        let shapes = polyhedra.each_ref().map(Polyhedron::shape);
        let meet = |pair: &PairPose| {
            let [at_a, at_b] = pair.map(|pose| pose.affine());
            query::intersects(&shapes[0], &at_a, &shapes[1], &at_b).expect("the poses are valid")
        };
        let count = bench.effort.sample(PAIRS);
        for overlap in [10, 50, 90] {
            let rate = f64::from(overlap) / 100.0;
            let poses = pairs_at_overlap(&mut rng, count, rate, REACH, |_, pair| meet(pair));
            race(bench, &name, &format!("{overlap} % overlap"), &polyhedra, &poses);
            // At half that rate too few of a small sample meet.
            if overlap >= 50 {
                let deep: Vec<PairPose> = poses.iter().filter(|pair| meet(pair)).copied().collect();
                race_depths(bench, &format!("{name}, penetration, {overlap} % overlap"), &polyhedra, &deep);
                if overlap == 50 {
                    SIZES.iter().for_each(|(size, text)| {
                        judge_depths(bench, &format!("{name}, {text}"), &polyhedra, &deep, *size)
                    });
                }
            }
            if overlap == 50 {
                SIZES.iter().for_each(|(size, text)| {
                    judge(bench, &format!("{name}, {text}"), &polyhedra, &poses, *size)
                });
            }
        }
        for overlap in [10, 50] {
            let poses = track_at_overlap(&mut rng, count, f64::from(overlap) / 100.0, REACH, meet);
            race_again(bench, &name, &format!("coherent, {overlap} % overlap"), &polyhedra, &poses);
        }
    }
}

fn scene<L: Library>(polyhedra: &[Polyhedron; 2], poses: &[PairPose]) -> Rc<Scene<L>> {
    Scene::new(polyhedra.each_ref().map(L::polyhedron), poses)
}

fn race(bench: &mut Bench, name: &str, how: &str, polyhedra: &[Polyhedron; 2], poses: &[PairPose]) {
    let entries = each!(questions: Ours, Thesis, double::Parry, single::Parry; (polyhedra, poses));
    race_both(bench, name, how, poses.len(), entries);
}

fn questions<L: Library>(polyhedra: &[Polyhedron; 2], poses: &[PairPose]) -> (Entry, Entry) {
    let scene = &scene::<L>(polyhedra, poses);
    (intersection(scene), distance(scene))
}

fn race_again(bench: &mut Bench, name: &str, how: &str, polyhedra: &[Polyhedron; 2], poses: &[PairPose]) {
    let entries = each!(questions_again: Ours, Thesis, double::Parry, single::Parry; (polyhedra, poses));
    race_both(bench, name, how, poses.len(), entries);
}

fn questions_again<L: Coherent>(polyhedra: &[Polyhedron; 2], poses: &[PairPose]) -> (Entry, Entry) {
    let scene = &scene::<L>(polyhedra, poses);
    (intersection_again(scene), distance_again(scene))
}

fn race_both(bench: &mut Bench, name: &str, how: &str, count: usize, entries: Vec<(Entry, Entry)>) {
    let (intersections, distances) = entries.into_iter().unzip();
    bench.race(&format!("{name}, intersection, {how}"), count, Unit::Nano, intersections);
    bench.race(&format!("{name}, closest points, {how}"), count, Unit::Nano, distances);
}

fn race_depths(bench: &mut Bench, work: &str, polyhedra: &[Polyhedron; 2], poses: &[PairPose]) {
    let entries = each!(depths: Ours, double::Parry, single::Parry; (polyhedra, poses));
    bench.race(work, poses.len(), Unit::Nano, entries);
}

fn depths<L: Depths>(polyhedra: &[Polyhedron; 2], poses: &[PairPose]) -> Entry {
    penetration(&scene::<L>(polyhedra, poses))
}

/// Compares the depths of some pairs that meet, scaled, with the oracle's.
fn judge_depths(bench: &mut Bench, name: &str, polyhedra: &[Polyhedron; 2], poses: &[PairPose], size: f64) {
    let polyhedra = polyhedra.each_ref().map(|polyhedron| polyhedron.scaled(size));
    let hulls = polyhedra.each_ref().map(|polyhedron| Convex::Hull { points: polyhedron.vertices.clone() });
    let (mut certain, mut truths) = (Vec::new(), Vec::new());
    for pair in poses.iter().take(bench.effort.sample(JUDGED)).map(|pair| pair.map(|pose| pose.scaled(size)))
    {
        let [at_a, at_b] = pair.map(|pose| pose.affine());
        if let Some((least, greatest)) = penetration_bounds(&hulls[0], &at_a, &hulls[1], &at_b) {
            certain.push(pair);
            truths.push([least, greatest]);
        }
    }
    let wrong = each!(wrong_depths: Ours, double::Parry, single::Parry; (&polyhedra, &certain, &truths, DISTANCE_ERROR * size));
    let work = format!("{name}, wrong answers to penetration of {}", truths.len());
    bench.figures(&work, Kind::Wrong, "wrong", &wrong);
}

fn wrong_depths<L: Depths>(
    polyhedra: &[Polyhedron; 2],
    poses: &[PairPose],
    truths: &[[f64; 2]],
    tolerance: f64,
) -> (Peer, f64) {
    (L::PEER, scene::<L>(polyhedra, poses).wrong_depths(truths, tolerance) as f64)
}

/// Compares the answers to some pairs, scaled, with the oracle's.
fn judge(bench: &mut Bench, name: &str, polyhedra: &[Polyhedron; 2], poses: &[PairPose], size: f64) {
    let polyhedra = polyhedra.each_ref().map(|polyhedron| polyhedron.scaled(size));
    let hulls = polyhedra.each_ref().map(|polyhedron| Convex::Hull { points: polyhedron.vertices.clone() });
    let judged = bench.effort.sample(JUDGED);
    let poses: Vec<PairPose> =
        poses.iter().take(judged).map(|pair| pair.map(|pose| pose.scaled(size))).collect();
    let truth = |pair: &PairPose| {
        let [at_a, at_b] = pair.map(|pose| pose.affine());
        let (least, greatest) = distance_bounds(&hulls[0], &at_a, &hulls[1], &at_b);
        let meet = verdict(&hulls[0], &at_a, &hulls[1], &at_b).shares_point();
        Truth { meet, distance: Some([least, greatest]) }
    };
    let truths: Vec<Truth> = poses.iter().map(truth).collect();
    let wrong = each!(wrong: Ours, Thesis, double::Parry, single::Parry; (&polyhedra, &poses, &truths, DISTANCE_ERROR * size));
    report_wrong(bench, name, ["intersection", "closest points"], truths.len(), &wrong);
}

fn wrong<L: Library>(
    polyhedra: &[Polyhedron; 2],
    poses: &[PairPose],
    truths: &[Truth],
    tolerance: f64,
) -> (Peer, [usize; 2]) {
    (L::PEER, scene::<L>(polyhedra, poses).wrong(truths, tolerance))
}
