//! Branch and bound for two trees that move.

use glam::DVec3;

use super::insertion::push_unless_far;
use super::node::Child;
use super::pairs::{Duel, Pair, Step, extent};
use super::ray::TreeRay;
use super::relative::Relative;
use super::{Place, Traversal, Tree};
use crate::Aabb;

/// Visits the pairs of leaves that may hold primitives which meet before `until`, when `b` moves by `motion` (in the space of
/// `a`) in a unit of time; those that may meet first come first. The slack in `a` must cover the error of the motion too.
///
/// `visit` lowers `until` as it finds earlier contacts. Nothing that meets earlier is lost.
///
/// ```
/// use solid3d::{Aabb, glam::{DAffine3, DVec3}, tree::{Relative, Traversal, Tree, cast_pairs}};
/// let unit = |i: u32| Aabb::new(DVec3::X * f64::from(i), DVec3::X * f64::from(i) + 0.5);
/// let tree = Tree::build(&(0..100).map(unit).collect::<Vec<_>>());
/// let b_to_a = DAffine3::from_translation(DVec3::new(0.0, 3.0, 0.0));
/// let relative = Relative { b_to_a, a_to_b: b_to_a.inverse(), slack_in_a: 1e-12, slack_in_b: 1e-12 };
/// let visited = |motion: DVec3| {
///     let mut pairs = 0;
///     cast_pairs(&tree, &tree, &relative, motion, &mut 1.0, &mut Traversal::default(), |_, _, _| pairs += 1);
///     pairs
/// };
/// assert!(visited(DVec3::Y * -2.4) == 0 && visited(DVec3::Y * -2.6) > 0);
/// ```
pub fn cast_pairs(
    a: &Tree,
    b: &Tree,
    relative: &Relative,
    motion: DVec3,
    until: &mut f64,
    traversal: &mut Traversal,
    visit: impl FnMut(&[u32], &[u32], &mut f64),
) {
    let still_a = |bounds: &Aabb| *bounds;
    let moving_b = |bounds: &Aabb| {
        let bounds = bounds.transformed(&relative.b_to_a);
        let half_extents = bounds.half_extents() * (1.0 + 4.0 * f64::EPSILON) + relative.slack_in_a;
        TreeRay { origin: bounds.center(), direction: motion, half_extents }
    };
    let least = |still: &Aabb, moving: &TreeRay| moving.reaches(still);
    first_pairs([a, b], relative, still_a, moving_b, least, until, traversal, visit);
}

/// The same for boxes of both trees on any way, given those at rest in their local spaces. `least` is a lower bound of the time at which two meet,
/// `None` where they do not; `relative` says how large those of one tree are beside those of the other, the larger being opened first.
#[expect(
    clippy::too_many_arguments,
    reason = "a walk over two trees, by three functions, with what is found on the way"
)]
pub(crate) fn first_pairs<A, B>(
    [a, b]: [&Tree; 2],
    relative: &Relative,
    moving_a: impl Fn(&Aabb) -> A,
    moving_b: impl Fn(&Aabb) -> B,
    least: impl Fn(&A, &B) -> Option<f64>,
    until: &mut f64,
    traversal: &mut Traversal,
    mut visit: impl FnMut(&[u32], &[u32], &mut f64),
) {
    let duel = Duel::one_by_one(a, b, relative);
    let box_a = |place: Place| moving_a(&a.normal.unpack(&a.box_at(place)));
    let box_b = |place: Place| moving_b(&b.normal.unpack(&b.box_at(place)));
    let Traversal { counters, pairs_ahead: stack, .. } = traversal;
    stack.clear();
    stack.push((0.0, duel.roots()));
    while let Some((first, pair)) = stack.pop() {
        if first >= *until {
            continue;
        }
        let from = stack.len();
        match duel.step(&pair) {
            Step::Leaves(leaf_a, leaf_b) => {
                counters.leaf_visits += 1;
                visit(leaf_a, leaf_b, until);
            }
            Step::OpenA(node) => {
                counters.box_tests += 1;
                let of_b = box_b(pair.b);
                for lane in used(&a.nodes[node].child) {
                    let place = Place::lane(node, lane);
                    if let Some(first) = least(&box_a(place), &of_b) {
                        let pair = Pair { a: place, extent_a: extent(&a.box_at(place)), ..pair };
                        push_unless_far((first, pair), *until, stack, from);
                    }
                }
            }
            Step::OpenB(node) => {
                counters.box_tests += 1;
                let of_a = box_a(pair.a);
                for lane in used(&b.nodes[node].child) {
                    let place = Place::lane(node, lane);
                    if let Some(first) = least(&of_a, &box_b(place)) {
                        let pair = Pair { b: place, extent_b: extent(&b.box_at(place)), ..pair };
                        push_unless_far((first, pair), *until, stack, from);
                    }
                }
            }
            Step::OpenBoth(..) => unreachable!("nodes are opened one by one"),
            Step::Nothing => {}
        }
    }
}

/// The lanes in use.
fn used(children: &[Child]) -> impl Iterator<Item = usize> {
    children.iter().enumerate().filter(|(_, child)| **child != Child::EMPTY).map(|(lane, _)| lane)
}
