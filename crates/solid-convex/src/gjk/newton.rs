//! Newton's method for the closest points of what is curved.
//!
//! A descent replaces one point of its simplex with each support point, and next to what is curved comes closer by a constant factor: some four
//! support points for each digit. Here all points of the simplex move at once, each along its [`Locus`] to where it is furthest along the
//! normal, and the normal turns to where what they span has its closest point along it: with the curvature of the loci
//! that converges quadratically. What comes out is a simplex to go on from, nothing more. What is sure is for the descent to say.
//!
//! With `n` the normal, `w(n)` the points, `x` the point of weights `λ` between them and `d` its height along `n`: of closest points `x` is `d n`,
//! and all `w` are as high. A turn of `n` by `t` moves `w` by `-H t`, where `H` is the curvature of the two support functions, and its
//! height by `w t`. So the next normal follows from `(H + d) t = x + E dλ`, `E t = -(heights above the first)`, where `E` are the edges from the first
//! point, across `n`.

use glam::{DMat3, DVec2, DVec3};

use super::descent::begun;
use super::pairs::Pair;
use crate::difference::{Difference, NO_VERTEX, SupportPoint};
use crate::{Locus, Support};

/// Newton's method ends after so many steps: begun within some percent, it takes three or four.
const STEPS_MAX: usize = 6;

/// A turn of the normal by less than this is the last: the next would be by its square.
const TURN_MIN: f64 = 1e-5;

/// A turn by more than this leads nowhere.
const TURN_MAX: f64 = 0.5;

/// Points of a circle whose directions from its centre have a cosine below this are not near one place of it, but around a face.
const SPREAD_COSINE: f64 = 0.9;

/// Points of an object, and how they move. Space: local.
struct Loci<'a> {
    linear: &'a DMat3,
    points: [DVec3; 3],
    loci: [Locus; 3],
}

impl<'a> Loci<'a> {
    /// Of up to three support points of an object.
    fn new<S: Support + ?Sized>(object: &S, linear: &'a DMat3, points: [DVec3; 3], len: usize) -> Self {
        let mut loci = points.map(|point| object.locus(point));
        // Those around a face stay.
        for (i, j) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|&(_, j)| j < len) {
            if let Locus::Circle { radius } = object.locus(points[i])
                && points[i].y == points[j].y
                && points[i].with_y(0.0).dot(points[j].with_y(0.0)) < SPREAD_COSINE * radius * radius
            {
                (loci[i], loci[j]) = (Locus::Point, Locus::Point);
            }
        }
        Loci { linear, points, loci }
    }

    /// Whether two points move as one.
    fn are_one(&self, i: usize, j: usize) -> bool {
        self.loci[i] == self.loci[j]
            && match self.loci[i] {
                Locus::Point => self.points[i] == self.points[j],
                Locus::Circle { .. } => self.points[i].y == self.points[j].y,
                Locus::Sphere { .. } => true,
            }
    }

    fn put(&mut self, to: usize, from: usize) {
        (self.points[to], self.loci[to]) = (self.points[from], self.loci[from]);
    }

    /// Moves the points to where they are furthest along a direction of the difference.
    fn slide(&mut self, direction: DVec3, len: usize) {
        let local = self.linear.mul_transpose_vec3(direction);
        for (point, locus) in self.points[..len].iter_mut().zip(&self.loci) {
            *point = locus.furthest(*point, local);
        }
    }

    /// How much a point bends at a direction: up to two vectors, of which the curvature is the sum of squares. Space: that of the difference.
    fn bends(&self, i: usize, direction: DVec3) -> [DVec3; 2] {
        let local = self.linear.mul_transpose_vec3(direction);
        self.loci[i].bends(local).map(|bend| *self.linear * bend)
    }
}

/// Pairs of points to go on from, and how many there are, by the points of the difference that a descent has come to; `None` where nothing bends,
/// or this leads nowhere.
#[inline(never)]
pub(crate) fn newton<A, B>(
    difference: &Difference<A, B>,
    points: &[SupportPoint],
) -> Option<([Pair; 3], usize)>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (simplex, v) = begun(points)?;
    let (mut len, mut weights) = (0, [0.0; 3]);
    let mut points = [[DVec3::ZERO; 3]; 2];
    for (p, weight) in simplex.weighted() {
        (points[0][len], points[1][len], weights[len]) = (p.a, p.b, weight);
        len += 1;
    }
    let ((object_a, object_b), [linear_a, linear_b]) = (difference.objects(), difference.linear());
    let mut a = Loci::new(object_a, linear_a, points[0], len);
    let mut b = Loci::new(object_b, linear_b, points[1], len);
    let mut kept = 0;
    for i in 0..len {
        if let Some(same) = (0..kept).find(|&j| a.are_one(i, j) && b.are_one(i, j)) {
            weights[same] += weights[i];
        } else {
            a.put(kept, i);
            b.put(kept, i);
            weights[kept] = weights[i];
            kept += 1;
        }
    }
    len = kept;
    if a.loci[..len].iter().chain(&b.loci[..len]).all(|locus| *locus == Locus::Point) {
        return None;
    }
    let mut n = v.normalize();
    for _ in 0..STEPS_MAX {
        a.slide(-n, len);
        b.slide(n, len);
        let mut w = [DVec3::ZERO; 3];
        (0..len).for_each(|i| w[i] = difference.point(a.points[i], b.points[i]).w);
        // Along two axes across n.
        let (s, t) = n.any_orthonormal_pair();
        let across = |w: DVec3| DVec2::new(s.dot(w), t.dot(w));
        let edges = [1, 2].map(|i| (across(w[i] - w[0]), n.dot(w[i] - w[0])));
        let turn = if len == 3 {
            // The normal of the face.
            let [(e, e_rises), (f, f_rises)] = edges;
            DVec2::new(e_rises * f.y - f_rises * e.y, f_rises * e.x - e_rises * f.x) / -e.perp_dot(f)
        } else {
            let x = (0..len).map(|i| w[i] * weights[i]).sum::<DVec3>();
            let distance = n.dot(x);
            let (mut xx, mut xy, mut yy) = (distance, 0.0, distance);
            for i in 0..len {
                for bend in a.bends(i, -n).into_iter().chain(b.bends(i, n)).map(across) {
                    xx += weights[i] * bend.x * bend.x;
                    xy += weights[i] * bend.x * bend.y;
                    yy += weights[i] * bend.y * bend.y;
                }
            }
            let determinant = xx * yy - xy * xy;
            let solved = |y: DVec2| DVec2::new(yy * y.x - xy * y.y, xx * y.y - xy * y.x) / determinant;
            let of_x = solved(across(x));
            if len == 1 {
                of_x
            } else {
                let (e, rises) = edges[0];
                let of_e = solved(e);
                let shift = -(rises + e.dot(of_x)) / e.dot(of_e);
                weights[0] -= shift;
                weights[1] += shift;
                of_x + of_e * shift
            }
        };
        // Neither what is too far nor what is no number.
        if !(turn.length_squared() < TURN_MAX * TURN_MAX) {
            return None;
        }
        n = (n + s * turn.x + t * turn.y).normalize();
        if turn.length_squared() < TURN_MIN * TURN_MIN {
            break;
        }
    }
    a.slide(-n, len);
    b.slide(n, len);
    Some(([0, 1, 2].map(|i| Pair { a: a.points[i], b: b.points[i], indices: [NO_VERTEX; 2] }), len))
}
