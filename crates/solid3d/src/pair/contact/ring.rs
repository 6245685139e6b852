//! A convex polygon from which the edges of another cut what is beyond them, one after the other (Sutherland and Hodgman, *Reentrant polygon
//! clipping*, 1974), in linear time: an edge does not look at all corners, but from where the last one cut.

use glam::DVec2;
use smallvec::SmallVec;

use super::clip::{Clipped, Corners, ON_EDGE, Origin, area};

/// What stands for [`ON_EDGE`] where a polygon is so thin that its edges, moved by that, would meet far from where they do: above rounding.
const ON_EDGE_MIN: f64 = 1e-14;

/// The line on which an edge of the working polygon lies.
#[derive(Clone, Copy)]
enum On {
    Subject(usize),
    Clip(usize),
}

impl On {
    /// What is at the place where edge `j` of a polygon cuts the edge.
    fn cut(self, at: DVec2, by: &[DVec2], j: usize) -> Clipped {
        match self {
            On::Subject(i) => Clipped { at, origin: Origin::Crossing(i, j) },
            On::Clip(k) => {
                let shared = if (j + 1) % by.len() == k { k } else { j };
                let adjacent = shared == k || (k + 1) % by.len() == j;
                // What is not a corner is beyond an edge that is still to come.
                Clipped { at: if adjacent { by[shared] } else { at }, origin: Origin::OfB(shared) }
            }
        }
    }
}

/// The subject cut by each edge of a polygon of area. Cost: linear in the corners of both.
pub(super) fn against(subject: &[DVec2], by: &[DVec2]) -> Corners {
    let area = area(by);
    let turn = area.signum();
    if is_within(subject, by, turn) {
        return distinct((0..).zip(subject).map(|(i, &at)| Clipped { at, origin: Origin::OfA(i) }));
    }
    let slack = slack(extent_squared(by), area);
    let mut left = Ring::default();
    left.take(subject);
    for j in 0..by.len() {
        let (from, to) = (by[j], by[(j + 1) % by.len()]);
        let Some(along) = (to - from).try_normalize() else { continue };
        left.cut(by, j, slack, |p| turn * along.perp_dot(p - from));
    }
    left.corners()
}

/// Whether no edge of a polygon cuts anything off another, as of a fine mesh under a large face: seen without a root.
fn is_within(subject: &[DVec2], by: &[DVec2], turn: f64) -> bool {
    let edges = by.iter().zip(by.iter().cycle().skip(1));
    edges.into_iter().all(|(from, to)| subject.iter().all(|p| turn * (to - from).perp_dot(p - from) >= 0.0))
}

/// The square of how far a polygon reaches from its first corner.
pub(super) fn extent_squared(polygon: &[DVec2]) -> f64 {
    polygon.iter().map(|p| p.distance_squared(polygon[0])).fold(0.0, f64::max)
}

/// How far outside an edge of a polygon a point is on it, by the square of how far the polygon reaches from its first corner and by twice its area.
pub(super) fn slack(extent_squared: f64, area: f64) -> f64 {
    (ON_EDGE * area.abs() / extent_squared).clamp(ON_EDGE_MIN, ON_EDGE)
}

/// A corner of the working polygon, and the edge from it to the next.
struct Node {
    corner: Clipped,
    on: On,
    before: usize,
    after: usize,
}

/// The working polygon, convex up to rounding: what an edge cuts off is in one piece, around the corner furthest beyond it, and that is near the one
/// of the edge before.
#[derive(Default)]
struct Ring {
    nodes: SmallVec<[Node; 16]>,
    /// The first corner; `None` when nothing is left.
    first: Option<usize>,
    /// The corner that was furthest beyond the last edge.
    furthest: usize,
}

impl Ring {
    /// Begins with all of a polygon. In place: the nodes are large.
    fn take(&mut self, polygon: &[DVec2]) {
        let count = polygon.len();
        let node = |(i, &at): (usize, &DVec2)| Node {
            corner: Clipped { at, origin: Origin::OfA(i) },
            on: On::Subject(i),
            before: (i + count - 1) % count,
            after: (i + 1) % count,
        };
        self.nodes.extend(polygon.iter().enumerate().map(node));
        self.first = Some(0);
    }

    /// Cuts off what is beyond edge `j` of a polygon by more than a slack; `inside` tells how far within it a point is.
    fn cut(&mut self, by: &[DVec2], j: usize, slack: f64, inside: impl Fn(DVec2) -> f64) {
        let Some(first) = self.first else { return };
        let nodes = &self.nodes[..];
        let height = |i: usize| inside(nodes[i].corner.at);
        let is_out = |i: usize| height(i) < -slack;
        let furthest = climb(nodes, self.furthest, slack, |i| -height(i));
        self.furthest = furthest;
        if !is_out(furthest) {
            return;
        }
        // The corners cut off, from the one to the other.
        let [mut from, mut to] = [furthest; 2];
        let mut has_first = from == first;
        while is_out(nodes[from].before) {
            from = nodes[from].before;
            has_first |= from == first;
            if from == furthest {
                self.first = None;
                return;
            }
        }
        while is_out(nodes[to].after) {
            to = nodes[to].after;
            has_first |= to == first;
        }
        let crossing = |start: usize, end: usize| {
            let (here, there) = (height(start), height(end));
            let (start, end) = (&nodes[start], &nodes[end]);
            let at = start.corner.at.lerp(end.corner.at, (here / (here - there)).clamp(0.0, 1.0));
            start.on.cut(at, by, j)
        };
        let (before, after) = (nodes[from].before, nodes[to].after);
        let (out, back) = (crossing(before, from), crossing(to, after));
        let (next, on) = (nodes.len(), nodes[to].on);
        self.nodes.push(Node { corner: out, on: On::Clip(j), before, after: next + 1 });
        self.nodes.push(Node { corner: back, on, before: next, after });
        self.nodes[before].after = next;
        self.nodes[after].before = next + 1;
        self.furthest = next;
        if has_first {
            self.first = Some(next + 1);
        }
    }

    /// What is left.
    fn corners(&self) -> Corners {
        let after = |&at: &usize| Some(self.nodes[at].after).filter(|&next| Some(next) != self.first);
        distinct(std::iter::successors(self.first, after).map(|at| self.nodes[at].corner))
    }
}

/// Corners in order, of those at one place the first.
fn distinct(all: impl Iterator<Item = Clipped>) -> Corners {
    let is_apart = |x: &Clipped, y: &Clipped| x.at.distance_squared(y.at) > ON_EDGE * ON_EDGE;
    let mut corners = Corners::new();
    for corner in all {
        if [corners.first(), corners.last()].into_iter().flatten().all(|other| is_apart(other, &corner)) {
            corners.push(corner);
        }
    }
    corners
}

/// The highest corner, sought from one on; past lower ones, if by no more than a slack.
#[inline(always)]
fn climb(nodes: &[Node], start: usize, slack: f64, height: impl Fn(usize) -> f64) -> usize {
    let (mut furthest, mut highest) = (start, height(start));
    for step in [|node: &Node| node.after, |node: &Node| node.before] {
        let mut at = step(&nodes[start]);
        while at != start {
            let here = height(at);
            if here < highest - slack {
                break;
            }
            if here > highest {
                (highest, furthest) = (here, at);
            }
            at = step(&nodes[at]);
        }
    }
    furthest
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::f64::consts::TAU;

    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// The slow twin of [`against`]: each edge looks at each corner.
    fn against_all(subject: &[DVec2], by: &[DVec2]) -> Vec<Clipped> {
        let area = area(by);
        let slack = slack(extent_squared(by), area);
        let corner = |(i, &at)| (Clipped { at, origin: Origin::OfA(i) }, On::Subject(i));
        let mut left: Vec<_> = subject.iter().enumerate().map(corner).collect();
        for j in 0..by.len() {
            let (from, to) = (by[j], by[(j + 1) % by.len()]);
            let Some(along) = (to - from).try_normalize() else { continue };
            let inside = |p: DVec2| area.signum() * along.perp_dot(p - from);
            let mut next = Vec::new();
            for (i, &(corner, on)) in left.iter().enumerate() {
                let following = left[(i + 1) % left.len()].0;
                let (here, there) = (inside(corner.at), inside(following.at));
                let (in_here, in_there) = (here >= -slack, there >= -slack);
                if in_here {
                    next.push((corner, on));
                }
                if in_here != in_there {
                    let at = corner.at.lerp(following.at, (here / (here - there)).clamp(0.0, 1.0));
                    let crossing = on.cut(at, by, j);
                    next.push((crossing, if in_here { On::Clip(j) } else { on }));
                }
            }
            left = next;
        }
        let mut corners: Vec<Clipped> = Vec::new();
        for (corner, _) in left {
            if corners.iter().all(|other| other.at.distance_squared(corner.at) > ON_EDGE * ON_EDGE) {
                corners.push(corner);
            }
        }
        corners
    }

    /// Points on a stretched circle, either way around, in order or reversed; perhaps one, two, or all in the place of others.
    fn round(rng: &mut StdRng) -> Vec<DVec2> {
        let count = if rng.random_bool(0.8) { rng.random_range(1..9) } else { rng.random_range(9..200) };
        let thin = if rng.random_bool(0.2) { 10f64.powi(rng.random_range(-4..0)) } else { 1.0 };
        let size = rng.random_range(0.2..1.5);
        let (middle, turn) = (
            DVec2::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)),
            rng.random_range(0.0..TAU),
        );
        let mut angles: Vec<f64> = (0..count).map(|_| rng.random_range(0.0..TAU)).collect();
        if rng.random_bool(0.3) {
            angles = (0..count).map(|i| f64::from(i) / f64::from(count) * TAU).collect();
        }
        angles.sort_by(f64::total_cmp);
        if rng.random_bool(0.5) {
            angles.reverse();
        }
        let place = |angle: &f64| {
            DVec2::from_angle(turn).rotate(DVec2::from_angle(*angle) * size * DVec2::new(1.0, thin))
        };
        angles.iter().map(|angle| middle + place(angle)).collect()
    }

    /// Law: what is kept of where an edge cut changes no corner.
    #[test]
    fn as_if_each_edge_looked_at_each_corner() {
        let mut rng = seeded(152);
        let mut of_both = 0;
        for case in 0..20_000 {
            let a = round(&mut rng);
            let b = if case % 10 == 0 { a.clone() } else { round(&mut rng) };
            if b.len() < 3 {
                continue;
            }
            let (found, expected) = (against(&a, &b), against_all(&a, &b));
            let all = |corners: &[Clipped]| format!("{corners:?}");
            assert_eq!(all(&found), all(&expected), "case {case}: {a:?}, {b:?}");
            of_both += usize::from(found.len() > 3);
        }
        assert!(of_both > 4_000, "{of_both}");
    }

    /// Law: the corners that edges look at are in proportion to those of both polygons.
    #[test]
    fn few_corners_are_looked_at() {
        for count in [100, 1_000, 10_000] {
            let step = TAU / f64::from(count);
            let polygon = |middle: DVec2| -> Vec<DVec2> {
                (0..count).map(|i| middle + DVec2::from_angle(step * f64::from(i))).collect()
            };
            let (a, b) = (polygon(DVec2::new(0.3, 0.1)), polygon(DVec2::ZERO));
            let (mut left, looks) = (Ring::default(), Cell::new(0));
            left.take(&a);
            for j in 0..b.len() {
                let along = (b[(j + 1) % b.len()] - b[j]).normalize();
                left.cut(&b, j, ON_EDGE_MIN, |p| {
                    looks.set(looks.get() + 1);
                    along.perp_dot(p - b[j])
                });
            }
            assert!(left.corners().len() > a.len() / 2 && looks.get() < 12 * count, "{looks:?} of {count}");
        }
    }
}
