//! The pairs of leaves of two trees whose boxes may overlap.

use fearless_simd::Simd;
use glam::DVec3;
use solid_convex::simd::{Level, dispatch, each, level};

use super::crossing::{Crossing, Folded, Probe};
use super::eights::{Image, overlaps};
use super::lanes::overlapping_probe;
use super::node::{Kind, WIDTH};
use super::packed::PackedBox;
use super::parting::Parting;
use super::relative::Relative;
use super::siblings::Subtree;
use super::slabs::Slabs;
use super::{Place, Traversal, Tree};
use std::cell::OnceCell;
use std::ops::ControlFlow;

/// Visits the pairs of leaves of `a` and `b` whose boxes may overlap (six facet axes): all pairs of primitives whose boxes do, and
/// some whose boxes do not.
///
/// ```
/// use solid3d::{Aabb, glam::{DAffine3, DVec3}, tree::{Relative, Traversal, Tree, pairs}};
/// use std::ops::ControlFlow;
///
/// let tree = Tree::build(&[Aabb::new(DVec3::ZERO, DVec3::ONE)]);
/// let count = |x: f64| {
///     let b_to_a = DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)) * DAffine3::from_rotation_z(0.3);
///     let relative = Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: 1e-12, slack_in_b: 1e-12 };
///     let mut count = 0;
///     let _ = pairs(&tree, &tree, &relative, &mut Traversal::default(), |_, _| {
///         count += 1;
///         ControlFlow::<()>::Continue(())
///     });
///     count
/// };
/// assert_eq!(count(0.5), 1);
/// assert_eq!(count(1.5), 0);
/// ```
pub fn pairs<B>(
    a: &Tree,
    b: &Tree,
    relative: &Relative,
    traversal: &mut Traversal,
    mut visit: impl FnMut(&[u32], &[u32]) -> ControlFlow<B>,
) -> ControlFlow<B> {
    pairs_on(level(), a, b, relative, &|| None, traversal, &mut Plain(&mut visit))
}

/// What is done with pairs of leaves, in vectors of the level of instructions that the walk runs on.
pub(crate) trait LeafPairs<B> {
    /// Whether the first pair that meets is all that is wanted: then what overlaps deepest is looked at first.
    fn wants_first(&self) -> bool {
        false
    }

    /// Called with every pair of leaves.
    fn visit<S: Simd>(&mut self, simd: S, in_a: &[u32], in_b: &[u32]) -> ControlFlow<B>;
}

/// What needs no vectors. Not generic over the function: each walk is compiled for every level of instructions.
struct Plain<'f, B>(&'f mut Visit<'f, B>);

type Visit<'f, B> = dyn FnMut(&[u32], &[u32]) -> ControlFlow<B> + 'f;

impl<B> LeafPairs<B> for Plain<'_, B> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, _: S, in_a: &[u32], in_b: &[u32]) -> ControlFlow<B> {
        (self.0)(in_a, in_b)
    }
}

/// Finds the slabs of both trees, unless they cost more than they save.
pub(crate) type SlabsOf<'f, 't> = &'f dyn Fn() -> Option<[&'t Slabs; 2]>;

/// A walk that opens so many pairs of nodes is long: from then on it asks slabs. What is quickly found is found sooner without.
const LONG: u32 = 4;

/// As [`pairs`], on a level of instructions.
pub(crate) fn pairs_on<'t, B>(
    level: Level,
    a: &'t Tree,
    b: &'t Tree,
    relative: &Relative,
    slabs: SlabsOf<'_, 't>,
    traversal: &mut Traversal,
    visitor: &mut impl LeafPairs<B>,
) -> ControlFlow<B> {
    dispatch!(widest level, simd => walk(simd, &Duel::new(a, b, relative), slabs, traversal, visitor))
}

#[inline(always)] // into the function that is compiled for a level of instructions
fn walk<'t, B, S: Simd>(
    simd: S,
    duel: &Duel<'t>,
    slabs: SlabsOf<'_, 't>,
    traversal: &mut Traversal,
    visitor: &mut impl LeafPairs<B>,
) -> ControlFlow<B> {
    let (a, b) = (duel.a, duel.b);
    let Traversal { counters, pairs: stack, .. } = traversal;
    let Pair { extent_a, extent_b, .. } = duel.roots();
    stack.begin([Subtree::root(extent_a), Subtree::root(extent_b)]);
    let wants_first = visitor.wants_first();
    // Of the boxes tested last: several in a row are often the same.
    let (mut in_a, mut in_b) = (Tested::default(), Tested::default());
    let (mut opened, mut parting) = (0, None::<Parting>);
    while let Some(subtrees) = stack.pop(simd, wants_first) {
        let [of_a, of_b] = &subtrees;
        match duel.step_of(&subtrees) {
            Step::Leaves(leaf_a, leaf_b) => {
                counters.leaf_visits += 1;
                visitor.visit(simd, leaf_a, leaf_b)?;
            }
            Step::OpenA(node) => {
                counters.box_tests += 1;
                let (node_a, probe) = (&a.nodes[node], in_b.probe(simd, duel.b_to_a(), b, of_b.place));
                let (mut hits, gaps) = overlapping_probe(simd, node_a, duel.b_to_a(), probe);
                if let Some(parting) = &parting {
                    hits &= !parting.apart_from::<S, 0>(simd, node, of_b.place);
                }
                stack.above().of_a(simd, (node, node_a), of_b, (hits, gaps));
                stack.push();
            }
            Step::OpenB(node) => {
                counters.box_tests += 1;
                let (node_b, probe) = (&b.nodes[node], in_a.probe(simd, duel.a_to_b(), a, of_a.place));
                let (mut hits, gaps) = overlapping_probe(simd, node_b, duel.a_to_b(), probe);
                if let Some(parting) = &parting {
                    hits &= !parting.apart_from::<S, 1>(simd, node, of_a.place);
                }
                stack.above().of_b(simd, (node, node_b), of_a, (hits, gaps));
                stack.push();
            }
            Step::OpenBoth(node_a, node_b, images) => {
                let (lanes_a, lanes_b) = (&a.nodes[node_a], &b.nodes[node_b]);
                let siblings = stack.above();
                siblings.of_both(simd, (node_a, lanes_a), (node_b, lanes_b));
                overlaps(
                    simd,
                    lanes_a,
                    lanes_b,
                    images,
                    &a.box_at(of_a.place),
                    wants_first,
                    &mut siblings.left,
                );
                counters.box_tests += u64::from(siblings.left.tested.count_ones());
                opened += 1;
                if opened == LONG {
                    parting = slabs().map(|slabs| duel.parting(slabs));
                }
                if let Some(parting) = &parting {
                    parting.part(simd, node_a, node_b, &mut siblings.left);
                }
                stack.push();
            }
            Step::Nothing => {}
        }
    }
    ControlFlow::Continue(())
}

/// A pair of subtrees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub a: Place,
    pub b: Place,
    /// The sizes of their boxes.
    pub extent_a: f32,
    pub extent_b: f32,
}

impl Pair {
    /// With a lane of a node of `a`, of which the sizes are known.
    #[inline(always)]
    pub fn with_a(self, node: usize, lane: usize, extents: &[f32; WIDTH]) -> Self {
        Pair { a: Place::lane(node, lane), extent_a: extents[lane], ..self }
    }

    /// The same with a lane of a node of `b`.
    #[inline(always)]
    pub fn with_b(self, node: usize, lane: usize, extents: &[f32; WIDTH]) -> Self {
        Pair { b: Place::lane(node, lane), extent_b: extents[lane], ..self }
    }
}

/// The box of a tree that was prepared last for tests against lanes of the other.
#[derive(Default)]
pub(super) struct Tested {
    place: Option<Place>,
    probe: Probe,
}

impl Tested {
    /// The box at a place, prepared.
    #[inline(always)]
    pub fn probe<S: Simd>(&mut self, simd: S, crossing: &Crossing, tree: &Tree, place: Place) -> &Probe {
        if self.place != Some(place) {
            self.place = Some(place);
            self.probe = crossing.probe(simd, &tree.box_at(place));
        }
        &self.probe
    }
}

/// Two trees, and the way between them.
pub(super) struct Duel<'t> {
    pub a: &'t Tree,
    pub b: &'t Tree,
    /// The ways of boxes of `b` to `a`, and the reverse.
    ways: [Folded; 2],
    /// The same for one box against eight, found when that is first asked for.
    crossings: OnceCell<[Crossing; 2]>,
    /// For boxes of `b` taken to `a`, and the reverse, eight at once.
    images: Option<[Image; 2]>,
    /// The size of things in `a` over their size in `b`.
    magnification: f32,
}

/// The ways of boxes of `b` to `a`, and the reverse.
#[inline(always)]
fn folded(a: &Tree, b: &Tree, relative: &Relative) -> [Folded; 2] {
    [
        Folded::new(&relative.b_to_a, relative.slack_in_a, &b.normal, &a.normal),
        Folded::new(&relative.a_to_b, relative.slack_in_b, &a.normal, &b.normal),
    ]
}

/// Nodes are opened together when neither is larger than the other by more than this: than by about one level.
const EVEN: f32 = 3.0;

/// What to do with a pair of subtrees.
pub(super) enum Step<'d, 't> {
    /// Both are leaves.
    Leaves(&'t [u32], &'t [u32]),
    /// The node of `a` is to be opened.
    OpenA(usize),
    /// The node of `b` is to be opened.
    OpenB(usize),
    /// Both nodes are to be opened, which are of about the same size: with the images of `b` in `a` and the reverse.
    OpenBoth(usize, usize, &'d [Image; 2]),
    /// One is an empty lane.
    Nothing,
}

impl<'t> Duel<'t> {
    #[inline(always)]
    pub fn new(a: &'t Tree, b: &'t Tree, relative: &Relative) -> Self {
        let ways = folded(a, b, relative);
        let images = Image::new(&ways[0]).zip(Image::new(&ways[1])).map(|(of_b, of_a)| [of_b, of_a]);
        Self::of(a, b, ways, images)
    }

    /// The same, of which no two nodes are ever opened together.
    pub fn one_by_one(a: &'t Tree, b: &'t Tree, relative: &Relative) -> Self {
        Self::of(a, b, folded(a, b, relative), None)
    }

    #[inline(always)]
    fn of(a: &'t Tree, b: &'t Tree, ways: [Folded; 2], images: Option<[Image; 2]>) -> Self {
        let magnification = ways[0].magnification() as f32;
        Duel { a, b, ways, crossings: OnceCell::new(), images, magnification }
    }

    /// For boxes of `b` against lanes of `a`.
    #[inline(always)]
    pub fn b_to_a(&self) -> &Crossing {
        &self.crossings()[0]
    }

    /// For boxes of `a` against lanes of `b`.
    #[inline(always)]
    pub fn a_to_b(&self) -> &Crossing {
        &self.crossings()[1]
    }

    #[inline(always)]
    fn crossings(&self) -> &[Crossing; 2] {
        self.crossings.get_or_init(|| {
            let [of_b, of_a] = &self.ways;
            [Crossing::of(of_b, of_a), Crossing::of(of_a, of_b)]
        })
    }

    /// By the slabs of both: where there are images.
    #[cold]
    fn parting(&self, slabs: [&'t Slabs; 2]) -> Parting<'t> {
        Parting::new([self.a, self.b], slabs, &self.ways)
    }

    /// Where the centre of the box of `b` is in the coordinates of `a`, and the length of their unit.
    pub fn center_of_b(&self, pair: &Pair) -> (DVec3, f32) {
        (self.ways[0].map.transform_point3(center(&self.b.box_at(pair.b))), 1.0)
    }

    /// Where the centre of the box of `a` is in the coordinates of `b`, and the length of their unit in that of `a`.
    pub fn center_of_a(&self, pair: &Pair) -> (DVec3, f32) {
        (self.ways[1].map.transform_point3(center(&self.a.box_at(pair.a))), self.magnification)
    }

    /// The two trees.
    pub fn roots(&self) -> Pair {
        Pair {
            a: Place::ROOT,
            b: Place::ROOT,
            extent_a: extent(&self.a.root),
            extent_b: extent(&self.b.root),
        }
    }

    /// The larger of two nodes is opened (thesis, 5.2.3); or both, where they are about as large, so that their children are held against
    /// each other all at once.
    #[inline(always)]
    pub fn step(&self, pair: &Pair) -> Step<'_, 't> {
        self.step_of(&[
            Subtree { place: pair.a, child: self.a.child_at(pair.a), extent: pair.extent_a },
            Subtree { place: pair.b, child: self.b.child_at(pair.b), extent: pair.extent_b },
        ])
    }

    /// The same of two subtrees.
    #[inline(always)]
    fn step_of(&self, [a, b]: &[Subtree; 2]) -> Step<'_, 't> {
        match (a.child.kind(), b.child.kind()) {
            (Kind::Empty, _) | (_, Kind::Empty) => Step::Nothing,
            (Kind::Leaf(of_a), Kind::Leaf(of_b)) => Step::Leaves(self.a.leaf(of_a), self.b.leaf(of_b)),
            (Kind::Inner(node), Kind::Leaf(_)) => Step::OpenA(node),
            (Kind::Leaf(_), Kind::Inner(node)) => Step::OpenB(node),
            (Kind::Inner(node_a), Kind::Inner(node_b)) => {
                let (size_a, size_b) = (a.extent, self.magnification * b.extent);
                if let Some(images) = &self.images
                    && size_a <= EVEN * size_b
                    && size_b <= EVEN * size_a
                {
                    return Step::OpenBoth(node_a, node_b, images);
                }
                if size_a >= size_b { Step::OpenA(node_a) } else { Step::OpenB(node_b) }
            }
        }
    }
}

fn center(bounds: &PackedBox) -> DVec3 {
    let doubled = each([0, 1, 2], |axis| f64::from(bounds.center_doubled(axis)));
    0.5 * DVec3::from_array(doubled)
}

/// The size by which nodes compare: the volume, as in the thesis, gives 1 to 4 % fewer box tests on tori, but flat boxes have none.
pub(super) fn extent(bounds: &PackedBox) -> f32 {
    bounds.size(0) + bounds.size(1) + bounds.size(2)
}
