//! Questions about pairs of placed shapes: what most cases race on.

use std::rc::Rc;

use crate::inputs::PairPose;
use crate::peers::bench::Entry;
use crate::peers::contestants::{AllPairs, Coherent, Depths, Library};
use crate::peers::{Bench, Kind, Peer};

/// The two shapes of all pairs, and where they are, in a library's own types.
pub struct Scene<L: Library> {
    shapes: [L::Shape; 2],
    poses: Vec<[L::Pose; 2]>,
}

impl<L: Library> Scene<L> {
    /// Shared by the races on it.
    pub fn new(shapes: [L::Shape; 2], poses: &[PairPose]) -> Rc<Self> {
        let poses = poses.iter().map(|pair| [L::pose(&pair[0]), L::pose(&pair[1])]).collect();
        Rc::new(Scene { shapes, poses })
    }

    /// How many pairs are such.
    fn count(&self, mut is: impl FnMut([&L::Shape; 2], &[L::Pose; 2]) -> bool) -> usize {
        let [a, b] = &self.shapes;
        self.poses.iter().filter(|at| is([a, b], at)).count()
    }

    /// What is wrong in the answers to the first pairs: whether they meet, as far as that is certain, and how far apart they are, to
    /// within `tolerance` of the interval that it lies in.
    pub fn wrong(&self, truths: &[Truth], tolerance: f64) -> [usize; 2] {
        let [a, b] = &self.shapes;
        let mut wrong = [0, 0];
        for (truth, [at_a, at_b]) in truths.iter().zip(&self.poses) {
            wrong[0] += usize::from(truth.meet.is_some_and(|meet| L::intersects(a, at_a, b, at_b) != meet));
            if let Some([least, greatest]) = truth.distance {
                let distance = L::distance(a, at_a, b, at_b);
                wrong[1] += usize::from(!(least - tolerance..=greatest + tolerance).contains(&distance));
            }
        }
        wrong
    }

    /// The shapes and where they are.
    pub fn each(&self) -> impl Iterator<Item = ([&L::Shape; 2], [&L::Pose; 2])> {
        self.poses.iter().map(|[at_a, at_b]| ([&self.shapes[0], &self.shapes[1]], [at_a, at_b]))
    }
}

impl<L: Depths> Scene<L> {
    /// How many depths of the first pairs are off the interval that they lie in by more than `tolerance`.
    pub fn wrong_depths(&self, truths: &[[f64; 2]], tolerance: f64) -> usize {
        let mut wrong = 0;
        for ([least, greatest], ([a, b], [at_a, at_b])) in truths.iter().zip(self.each()) {
            let within = |depth| (least - tolerance..=greatest + tolerance).contains(&depth);
            wrong += usize::from(!L::depth(a, at_a, b, at_b).is_some_and(within));
        }
        wrong
    }
}

/// What the oracle proved of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Whether they meet; `None` where that is too close to call.
    pub meet: Option<bool>,
    /// An interval that the distance lies in; `None` where nobody asked.
    pub distance: Option<[f64; 2]>,
}

/// Whether each pair meets.
pub fn intersection<L: Library>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || scene.count(|[a, b], [at_a, at_b]| L::intersects(a, at_a, b, at_b)))
}

/// How far apart each pair is.
pub fn distance<L: Library>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || scene.count(|[a, b], [at_a, at_b]| L::distance(a, at_a, b, at_b) > 0.0))
}

/// How deep in each other each pair is.
pub fn penetration<L: Depths>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || {
        scene.count(|[a, b], [at_a, at_b]| L::depth(a, at_a, b, at_b).is_some_and(|depth| depth > 0.0))
    })
}

/// Whether the two meet in each frame of a motion, which begins with nothing known.
pub fn intersection_again<L: Coherent>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || {
        let mut memory = L::Memory::default();
        scene.count(|[a, b], [at_a, at_b]| L::intersects_again(&mut memory, a, at_a, b, at_b))
    })
}

/// How far apart the two are in each frame of a motion.
pub fn distance_again<L: Coherent>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || {
        let mut memory = L::Memory::default();
        scene.count(|[a, b], [at_a, at_b]| L::distance_again(&mut memory, a, at_a, b, at_b) > 0.0)
    })
}

/// All pairs of triangles that meet, of each pair.
pub fn all_pairs<L: AllPairs>(scene: &Rc<Scene<L>>) -> Entry {
    let scene = scene.clone();
    Entry::new(L::PEER, move || {
        scene.each().map(|([a, b], [at_a, at_b])| L::pair_count(a, at_a, b, at_b)).sum()
    })
}

/// Reports how many of so many answers to two questions were wrong.
pub fn report_wrong(
    bench: &mut Bench,
    name: &str,
    questions: [&str; 2],
    count: usize,
    wrong: &[(Peer, [usize; 2])],
) {
    for (i, question) in questions.into_iter().enumerate() {
        let figures: Vec<(Peer, f64)> = wrong.iter().map(|(peer, wrong)| (*peer, wrong[i] as f64)).collect();
        let work = format!("{name}, wrong answers to {question} of {count}");
        bench.figures(&work, Kind::Wrong, "wrong", &figures);
    }
}
