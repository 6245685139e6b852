//! The intersection of a polygon and a plane: a sorted sequence of segments on a line (thesis, section 3.2.2).
//!
//! The line is that in which the planes of the two polygons meet; it runs along `n_a x n_b`. Nothing on it is computed:
//! its points are known as the edges that cross it there, and their order is the sign of a determinant of the ends of two
//! edges. So the order is exact as long as the polygons are flat and simple.
//!
//! Vertices on the plane: they are first taken to be above it. That gives the part of the polygon in a plane that is lower by
//! nothing; its closure, together with the vertices and edges that lie on the plane themselves, is all.

use std::cmp::Ordering;

use glam::DVec3;

use super::chain::{Base, Chain};
use super::counters::Counters;
use super::exact::{flatten, height, turn};

/// A point on the line: where the segment from vertex `on_or_above` to vertex `off` crosses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    on_or_above: usize,
    off: usize,
    /// Whether `on_or_above` is the point itself.
    is_vertex: bool,
}

/// The segments in which a polygon meets a plane, sorted and disjoint. They may be single points.
#[derive(Debug)]
pub(super) struct Section<'a> {
    chain: &'a Chain,
    base: Base,
    /// For each vertex its height over the other polygon's plane.
    sides: &'a [f64],
    /// 1 when a left turn, seen from `off`, goes forward on the line; else -1.
    sense: f64,
    /// 1 when each `off` is below the plane, -1 when each is above.
    below: f64,
    pub segments: Vec<[Crossing; 2]>,
}

/// Which of the two polygons a section is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    A,
    B,
}

impl<'a> Section<'a> {
    /// `axis` is about the direction of the line. Empty if the plane misses the polygon.
    pub fn new(
        (chain, base): (&'a Chain, Base),
        sides: &'a [f64],
        role: Role,
        axis: DVec3,
        counters: &mut Counters,
    ) -> Section<'a> {
        let below = if sides.iter().any(|&side| side < 0.0) { 1.0 } else { -1.0 };
        // With e below B in the plane of A: from e, forward along n_a x n_b is a left turn about n_a. With A and B exchanged
        // it is a right turn about n_b.
        let sense = if role == Role::A { below } else { -below };
        let mut section = Section { chain, base, sides, sense, below, segments: Vec::new() };
        section.fill(axis, counters);
        section
    }

    fn fill(&mut self, axis: DVec3, counters: &mut Counters) {
        let mut crossings: Vec<Crossing> = Vec::new();
        let mut touches: Vec<[Crossing; 2]> = Vec::new();
        let outlier = (0..self.sides.len()).find(|&i| self.sides[i] * self.below < 0.0);
        for [i, j] in self.chain.edges() {
            counters.edge_plane_tests += 1;
            let (from, to) = (self.sides[i], self.sides[j]);
            if (from < 0.0) != (to < 0.0) {
                let [above, off] = if from < 0.0 { [j, i] } else { [i, j] };
                crossings.push(Crossing { on_or_above: above, off, is_vertex: self.sides[above] == 0.0 });
            }
            if from == 0.0
                && let Some(off) = outlier
            {
                let vertex = |i: usize| Crossing { on_or_above: i, off, is_vertex: true };
                touches.push([vertex(i), vertex(if to == 0.0 { j } else { i })]);
            }
        }
        self.sort(&mut crossings, |crossing| crossing, axis, counters);
        self.segments.extend(crossings.chunks_exact(2).map(|ends| [ends[0], ends[1]]));
        if !touches.is_empty() {
            self.add(touches, axis, counters);
        }
    }

    /// Sorts by where each is: by rounded coordinates first, along the axis closest to the line's direction; then exactly, by insertion,
    /// which finds little to do.
    fn sort<T: Copy>(
        &self,
        items: &mut Vec<T>,
        place: impl Fn(&T) -> &Crossing,
        axis: DVec3,
        counters: &mut Counters,
    ) {
        if items.len() > 2 {
            let closest = (0..3).max_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
            let sign = axis[closest].signum();
            let key = |item: &T| sign * self.point(*place(item))[closest];
            let mut keyed: Vec<(f64, T)> = items.iter().map(|item| (key(item), *item)).collect();
            keyed.sort_by(|(x, _), (y, _)| x.total_cmp(y));
            items.clear();
            items.extend(keyed.into_iter().map(|(_, item)| item));
        }
        insertion_sort(items, |x, y| self.order(place(x), place(y), counters));
    }

    /// Adds segments that may overlap.
    fn add(&mut self, segments: Vec<[Crossing; 2]>, axis: DVec3, counters: &mut Counters) {
        let mut all = std::mem::take(&mut self.segments);
        for [x, y] in segments {
            let forward = self.order(&x, &y, counters).is_le();
            all.push(if forward { [x, y] } else { [y, x] });
        }
        self.sort(&mut all, |[begin, _]| begin, axis, counters);
        for [begin, end] in all {
            match self.segments.last().copied() {
                Some([_, last]) if self.order(&begin, &last, counters).is_le() => {
                    if self.order(&end, &last, counters) == Ordering::Greater
                        && let Some(segment) = self.segments.last_mut()
                    {
                        segment[1] = end;
                    }
                }
                _ => self.segments.push([begin, end]),
            }
        }
    }

    /// How two points lie on the line. Edges that cross each other, which a simple polygon has not, count as meeting on it.
    fn order(&self, x: &Crossing, y: &Crossing, counters: &mut Counters) -> Ordering {
        counters.comparisons += 1;
        let flat = |i: usize| flatten(self.base.dropped, self.chain.vertices[i]);
        // Positive where a vertex is to the left of a crossing's edge, seen from its lower end.
        let left = |of: &Crossing, i: usize| turn(flat(of.off), flat(of.on_or_above), flat(i));
        let turned = if y.is_vertex {
            left(x, y.on_or_above)
        } else if x.is_vertex {
            -left(y, x.on_or_above)
        } else {
            common_sign(left(x, y.on_or_above), left(x, y.off))
                .or_else(|| common_sign(-left(y, x.on_or_above), -left(y, x.off)))
                .unwrap_or(0.0)
        };
        order_of(self.sense * turned)
    }

    /// How a point of this section, which is of A, lies to one of a section of B on the same line.
    pub fn order_to(&self, x: &Crossing, b: &Section, y: &Crossing, counters: &mut Counters) -> Ordering {
        counters.comparisons += 1;
        let (p, q) = (self.chain.vertices[x.on_or_above], self.chain.vertices[x.off]);
        let (r, s) = (b.chain.vertices[y.on_or_above], b.chain.vertices[y.off]);
        order_of(self.below * b.below * height(p, q, r, s))
    }

    /// Where it is, rounded; at a vertex exactly.
    pub fn point(&self, crossing: Crossing) -> DVec3 {
        let Crossing { on_or_above, off, is_vertex } = crossing;
        let (p, q) = (self.chain.vertices[on_or_above], self.chain.vertices[off]);
        if is_vertex {
            return p;
        }
        let (above, below) = (self.sides[on_or_above], self.sides[off]);
        p + (q - p) * (above / (above - below))
    }
}

/// Positive forward: the second is behind the first.
fn order_of(forward: f64) -> Ordering {
    if forward > 0.0 {
        Ordering::Less
    } else if forward < 0.0 {
        Ordering::Greater
    } else {
        Ordering::Equal
    }
}

/// A number with the sign that both have, where zero has either; `None` for opposite signs.
fn common_sign(x: f64, y: f64) -> Option<f64> {
    let opposite = (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    (!opposite).then_some(if x == 0.0 { y } else { x })
}

/// Unlike the sorts of the standard library it never panics, even where an uneven polygon makes the order inconsistent.
/// Linear for what is almost sorted.
fn insertion_sort<T: Copy>(items: &mut [T], mut order: impl FnMut(&T, &T) -> Ordering) {
    for i in 1..items.len() {
        let mut j = i;
        while j > 0 && order(&items[j - 1], &items[j]) == Ordering::Greater {
            items.swap(j - 1, j);
            j -= 1;
        }
    }
}
