//! Newton's method for the closest points of what is curved, and for the deepest.
//!
//! A descent replaces one point of its simplex with each support point, and next to what is curved comes closer by a constant factor: some four
//! support points for each digit. Here all points of the simplex move at once, each along its [`Locus`] to where it is furthest along the
//! normal, and the normal turns to where what they span has its closest point along it: with the curvature of the loci
//! that converges quadratically. What comes out is a simplex to go on from, nothing more. What is sure is for the descent to say.
//!
//! With `n` the normal, `w(n)` the points, `x` the point of weights `λ` between them and `d` its height along `n`: of closest points `x` is `d n`,
//! and all `w` are as high. A turn of `n` by `t` moves `w` by `-H t`, where `H` is the curvature of the two support functions, and its
//! height by `w t`. So the next normal follows from `(H + d) t = x + E dλ`, `E t = -(heights above the first)`, where `E` are the edges from the first
//! point, across `n`. Where the origin is inside, `d` is negative, and all else is the same.

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::descent::begun;
use super::pairs::Pair;
use crate::difference::{Difference, NO_VERTEX, SupportPoint};
use crate::simplex::Simplex;
use crate::{Locus, Support, Witness};

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
    /// Along which the points are furthest, once they slid.
    direction: DVec3,
}

impl<'a> Loci<'a> {
    /// Of up to three support points of an object.
    fn new<S: Support + ?Sized>(object: &S, linear: &'a DMat3, points: [DVec3; 3], len: usize) -> Self {
        let each = points.map(|point| object.locus(point));
        let mut loci = each;
        // Those around a face stay.
        for (i, j) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|&(_, j)| j < len) {
            if let Locus::Circle { radius } = each[i]
                && points[i].y == points[j].y
                && points[i].with_y(0.0).dot(points[j].with_y(0.0)) < SPREAD_COSINE * radius * radius
            {
                (loci[i], loci[j]) = (Locus::Point, Locus::Point);
            }
        }
        Loci { linear, points, loci, direction: DVec3::ZERO }
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

    /// Takes a point into the place of another.
    fn put(&mut self, to: usize, from: usize) {
        (self.points[to], self.loci[to]) = (self.points[from], self.loci[from]);
    }

    /// Moves the first points to where they are furthest along a direction of the difference.
    fn slide(&mut self, direction: DVec3, len: usize) {
        self.direction = self.linear.mul_transpose_vec3(direction);
        for (point, locus) in self.points[..len].iter_mut().zip(&self.loci) {
            *point = locus.furthest(*point, self.direction);
        }
    }

    /// How much the locus of a point bends where the point is: up to two vectors, of which the curvature is the sum of squares. Space: that of
    /// the difference.
    fn bends(&self, i: usize) -> [DVec3; 2] {
        self.loci[i].bends(self.direction).map(|bend| *self.linear * bend)
    }
}

/// The points of a simplex, those that move as one taken together, with the weights of the closest point between them.
struct Span<'a> {
    a: Loci<'a>,
    b: Loci<'a>,
    weights: [f64; 3],
    len: usize,
}

impl<'a> Span<'a> {
    fn new<A, B>(difference: &'a Difference<A, B>, simplex: &Simplex) -> Self
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let (mut on_a, mut on_b, mut weights, mut count) = ([DVec3::ZERO; 3], [DVec3::ZERO; 3], [0.0; 3], 0);
        for (p, weight) in simplex.weighted().take(3) {
            (on_a[count], on_b[count], weights[count]) = (p.a, p.b, weight);
            count += 1;
        }
        let ((of_a, of_b), [linear_a, linear_b]) = (difference.objects(), difference.linear());
        let (a, b) = (Loci::new(of_a, linear_a, on_a, count), Loci::new(of_b, linear_b, on_b, count));
        let mut span = Span { a, b, weights, len: 0 };
        for i in 0..count {
            let Span { a, b, weights, len } = &mut span;
            if let Some(same) = (0..*len).find(|&j| a.are_one(i, j) && b.are_one(i, j)) {
                weights[same] += weights[i];
            } else {
                a.put(*len, i);
                b.put(*len, i);
                weights[*len] = weights[i];
                *len += 1;
            }
        }
        span
    }

    /// Whether any of its points moves.
    fn is_curved(&self) -> bool {
        self.a.loci[..self.len].iter().chain(&self.b.loci[..self.len]).any(|locus| *locus != Locus::Point)
    }

    /// Its points as those of the difference; what is beyond their number is nothing.
    fn placed<A, B>(&self, difference: &Difference<A, B>) -> [SupportPoint; 3]
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let mut placed = [SupportPoint::ZERO; 3];
        for (i, p) in placed[..self.len].iter_mut().enumerate() {
            *p = difference.point(self.a.points[i], self.b.points[i]);
        }
        placed
    }

    /// Moves its points to where they are along a normal.
    fn slide(&mut self, n: DVec3) {
        self.a.slide(-n, self.len);
        self.b.slide(n, self.len);
    }

    /// The turn of a normal by a step of Newton's method, where the points slid to `w` for it; the weights go along.
    fn turn(&mut self, n: DVec3, w: &[DVec3; 3]) -> DVec3 {
        // Along two axes across n.
        let (s, t) = n.any_orthonormal_pair();
        let across = |w: DVec3| DVec2::new(s.dot(w), t.dot(w));
        let [(e, e_rises), (f, f_rises)] = [1, 2].map(|i| (across(w[i] - w[0]), n.dot(w[i] - w[0])));
        if self.len == 3 {
            // To the normal of the face.
            let turn = DMat2::from_cols(e, f).transpose().inverse() * -DVec2::new(e_rises, f_rises);
            return s * turn.x + t * turn.y;
        }
        let x = (0..self.len).map(|i| w[i] * self.weights[i]).sum::<DVec3>();
        let mut curvature = DMat2::from_diagonal(DVec2::splat(n.dot(x)));
        for i in 0..self.len {
            for bend in self.a.bends(i).into_iter().chain(self.b.bends(i)).map(across) {
                curvature += DMat2::from_cols(bend * bend.x, bend * bend.y) * self.weights[i];
            }
        }
        let inverse = inverse(curvature);
        let mut turn = inverse * across(x);
        if self.len == 2 {
            let along = inverse * e;
            let shift = -(e_rises + e.dot(turn)) / e.dot(along);
            self.weights[0] -= shift;
            self.weights[1] += shift;
            turn += along * shift;
        }
        s * turn.x + t * turn.y
    }
}

/// The inverse of a symmetric matrix; of one that is nearly singular it leads nowhere along what it takes to nothing. That is how coaxial shapes bend:
/// they are as deep in each other all around their axis.
fn inverse(symmetric: DMat2) -> DMat2 {
    /// Of the greater eigenvalue.
    const SINGULAR: f64 = 1e-7;
    let determinant = symmetric.determinant();
    let trace = symmetric.x_axis.x + symmetric.y_axis.y;
    // The lesser eigenvalue is about the determinant by the greater.
    if determinant.abs() > SINGULAR * trace * trace {
        return symmetric.inverse();
    }
    symmetric * (1.0 / (trace * trace))
}

/// Turns a normal, and moves the points of a simplex along with it, until these are furthest against it where what they span has its closest
/// point; `None` where nothing bends, or this leads nowhere.
fn converge<'a, A, B>(difference: &'a Difference<A, B>, simplex: &Simplex, mut n: DVec3) -> Option<Span<'a>>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let mut span = Span::new(difference, simplex);
    if !span.is_curved() {
        return None;
    }
    for _ in 0..STEPS_MAX {
        span.slide(n);
        let turn = span.turn(n, &span.placed(difference).map(|p| p.w));
        let square = turn.length_squared();
        if square.is_nan() || square > TURN_MAX * TURN_MAX {
            return None;
        }
        n = (n + turn).normalize();
        if square < TURN_MIN * TURN_MIN {
            break;
        }
    }
    span.slide(n);
    Some(span)
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
    let span = converge(difference, &simplex, v.normalize())?;
    let pair = |i: usize| Pair { a: span.a.points[i], b: span.b.points[i], indices: [NO_VERTEX; 2] };
    Some(([0, 1, 2].map(pair), span.len))
}

/// The same for a boundary that has the origin inside: where it is nearest to that, as a point of the difference and of the objects, by
/// points of it that are near there. Whether it is nearest is for the caller to see.
#[inline(never)]
pub(crate) fn nearest_boundary<A, B>(
    difference: &Difference<A, B>,
    points: &[SupportPoint],
) -> Option<(DVec3, Witness)>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (simplex, v) = begun(points)?;
    // Against the normal of what has the origin on the other side.
    let span = converge(difference, &simplex, -v.normalize())?;
    let (simplex, v) = begun(&span.placed(difference)[..span.len])?;
    Some((v, Witness::of(&simplex)))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use glam::{DAffine3, DQuat};
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::seeded;

    use super::super::descent::{Goal, descend_robustly};
    use super::super::distance::{DISTANCE_TOLERANCE, closest_points};
    use crate::testing::{in_cube, of_sizes};
    use crate::{Locus, Support};

    use super::*;

    /// Counts the support points that are asked for.
    struct Counted<'a> {
        object: Box<dyn Support>,
        count: &'a AtomicUsize,
    }

    impl Support for Counted<'_> {
        fn support(&self, direction: DVec3) -> DVec3 {
            self.count.fetch_add(1, Ordering::Relaxed);
            self.object.support(direction)
        }

        fn reach(&self) -> DVec3 {
            self.object.reach()
        }

        fn is_polytope(&self) -> bool {
            self.object.is_polytope()
        }

        fn locus(&self, point: DVec3) -> Locus {
            self.object.locus(point)
        }
    }

    /// As stretched as 1 to 10 and more, so that what is round is so no longer.
    fn placement(rng: &mut StdRng) -> DAffine3 {
        let mut turned = || DAffine3::from_quat(DQuat::from_vec4(in_cube(rng).extend(0.5).normalize()));
        let (first, then) = (turned(), turned());
        let stretched = then * DAffine3::from_scale(in_cube(rng).exp()) * first;
        DAffine3 { translation: in_cube(rng) * 3.0, ..stretched }
    }

    /// Law: distances are those of the robust descent, for little more than half of its support points.
    #[test]
    fn it_finds_what_the_descent_finds() {
        let mut rng = seeded(152);
        let counts = [AtomicUsize::new(0), AtomicUsize::new(0)];
        let mut apart = 0;
        for case in 0..6_000 {
            let mut size = || rng.random_range(0.1..1.5);
            let objects = [case % 4, case / 4 % 5].map(|kind| of_sizes(kind, &mut size));
            let [at_a, at_b] = [placement(&mut rng), placement(&mut rng)];
            let [a, b] = objects.map(|object| Counted { object, count: &counts[0] });
            let found = closest_points(&a, &at_a, &b, &at_b);
            let [a, b] = [a, b].map(|counted| Counted { count: &counts[1], ..counted });
            let difference = Difference::new(&a, &at_a, &b, &at_b);
            let goal = Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: f64::INFINITY };
            let expected = descend_robustly(&difference, goal).v.length() / difference.scale();
            let error = 2.0 * DISTANCE_TOLERANCE * expected + 1e-13; // what touches, of objects as large as 4, is so within rounding
            assert!((found.distance - expected).abs() <= error, "case {case}: {found:?}, {expected}");
            let way = difference.point(found.points.on_a, found.points.on_b).w.length() / difference.scale();
            assert!((way - found.distance).abs() <= error, "case {case}: {found:?}, {way}");
            apart += usize::from(found.distance > 0.0);
        }
        let [with, without] = counts.map(AtomicUsize::into_inner);
        println!("{apart} apart, {with} and {without} support points");
        assert!(apart > 4_000 && 5 * with < 3 * without, "{apart}, {with}, {without}");
    }
}
