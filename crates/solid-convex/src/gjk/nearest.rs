//! The closest point of a simplex to the origin as a quotient, for which no division is waited, where the newest point is needed in any
//! case (Theorem 4.8). No sliver is measured twice: of what is too thin to tell, the divisor is next to nothing.

use glam::DVec3;

use crate::difference::{SUPPORT_ERROR, SupportPoint};
use crate::feature::{VOLUME_ERROR, sides_of_origin};

/// A step that shortens `v` squared by less than this part of it: the robust descent sees to it.
const PROGRESS_MIN: f64 = 4.0 * f64::EPSILON;

/// The closest point of a hull: `v / divisor`, on the newest point and those older ones whose bits are set.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub v: DVec3,
    pub divisor: f64,
    pub older: u8,
}

impl Nearest {
    /// The same, where another point comes before the older ones.
    #[inline(always)]
    fn after_another(self) -> Nearest {
        Nearest { older: self.older << 1, ..self }
    }

    /// The nearer one to the origin of two.
    #[inline(always)]
    fn or_nearer(self, other: Nearest) -> Nearest {
        if other.is_nearer_than(&self) { other } else { self }
    }

    /// Whether it is nearer to the origin than another.
    #[inline(always)]
    fn is_nearer_than(&self, other: &Nearest) -> bool {
        let (mine, its) = (self.square(), other.square());
        mine.dividend * its.divisor < its.dividend * mine.divisor
    }

    /// Its distance to the origin, squared.
    #[inline(always)]
    pub fn square(&self) -> Square {
        Square { dividend: self.v.length_squared(), divisor: self.divisor * self.divisor }
    }
}

/// A squared length as a quotient, for which no division is waited.
#[derive(Clone, Copy)]
pub(super) struct Square {
    dividend: f64,
    divisor: f64,
}

impl Square {
    pub const INFINITE: Square = Square { dividend: f64::INFINITY, divisor: 1.0 };

    /// Whether it is more than rounding makes of nothing.
    #[inline(always)]
    pub fn is_sure(self) -> bool {
        self.dividend > SUPPORT_ERROR * SUPPORT_ERROR * self.divisor
    }

    /// Whether a step made it so much smaller that it is progress.
    #[inline(always)]
    pub fn is_progress_from(self, before: Square) -> bool {
        self.dividend * before.divisor < before.dividend * self.divisor * (1.0 - PROGRESS_MIN)
    }
}

/// Of the edge from an older point to the newest, which is needed in any case (Theorem 4.8).
#[inline(always)]
pub(super) fn edge(p: DVec3, newest: DVec3) -> Nearest {
    let d = newest - p;
    let along = newest.dot(d);
    if along <= 0.0 {
        return Nearest { v: newest, divisor: 1.0, older: 0 };
    }
    let square = d.length_squared();
    Nearest { v: newest * square - d * along, divisor: square, older: 1 }
}

/// Of the face of two older points and the newest.
#[inline(always)]
pub(super) fn face(p: DVec3, q: DVec3, newest: DVec3) -> Nearest {
    let (to_p, to_q) = (p - newest, q - newest);
    let n = to_p.cross(to_q);
    let square = n.length_squared();
    // -newest = x to_p + y to_q + an offset along n; all times n^2.
    let across = newest.cross(n);
    let (x, y) = (to_q.dot(across), -to_p.dot(across));
    if x > 0.0 && y > 0.0 && x + y < square {
        return Nearest { v: n * n.dot(newest), divisor: square, older: 3 };
    }
    let with_p = || edge(p, newest);
    let with_q = || edge(q, newest).after_another();
    // Beyond one edge it is on that one; beyond both, where an angle is obtuse, on the one that leads to the origin.
    match (x > 0.0, y > 0.0) {
        (true, false) => with_p(),
        (false, true) => with_q(),
        (false, false) if newest.dot(to_q) < 0.0 => with_q(),
        (false, false) => with_p(),
        (true, true) => with_p().or_nearer(with_q()),
    }
}

/// Of the tetrahedron of three older points and the newest; `None` when it certainly contains the origin.
#[inline(always)]
pub(super) fn tetrahedron(p: DVec3, q: DVec3, r: DVec3, newest: DVec3) -> Option<Nearest> {
    let (sides, least) = sides_of_origin([p, q, r, newest]);
    let [pq, qr, rp, old] = sides.map(|side| side > 0.0);
    if pq && qr && rp {
        // Of what is too flat to tell, nothing: no divisor is that small.
        let unknown = Nearest { v: newest, divisor: 0.0, older: 7 };
        return if old && least > VOLUME_ERROR { None } else { Some(unknown) };
    }
    // On a face with the newest point that has the origin outside.
    let mut closest = Nearest { v: DVec3::INFINITY, divisor: 1.0, older: 0 };
    if !pq {
        closest = face(p, q, newest);
    }
    if !qr {
        closest = closest.or_nearer(face(q, r, newest).after_another());
    }
    if !rp {
        let found = face(p, r, newest);
        closest = closest.or_nearer(Nearest { older: found.older & 1 | (found.older & 2) << 1, ..found });
    }
    Some(closest)
}

/// The closest point of the hull of up to three points in any order, of which those that it does not need are dropped.
#[inline(always)]
pub(super) fn closest_of_any(points: &mut [SupportPoint; 4], len: &mut usize) -> Nearest {
    let [p, q, r, _] = *points;
    if *len == 3 {
        let closest = face(p.w, q.w, r.w);
        if closest.older == 3 {
            return closest;
        }
    }
    // Off their face, the two that are nearest are a start as good as any.
    let squares = [p, q, r].map(|p| p.w.length_squared());
    let pair = match *len {
        1 => [p, p],
        2 => [p, q],
        _ if squares[0] >= squares[1] && squares[0] >= squares[2] => [q, r],
        _ if squares[1] >= squares[2] => [p, r],
        _ => [p, q],
    };
    let [near, far] =
        if pair[0].w.length_squared() < pair[1].w.length_squared() { pair } else { [pair[1], pair[0]] };
    let closest = edge(far.w, near.w);
    (points[0], points[1]) = if closest.older == 1 { (far, near) } else { (near, far) };
    *len = 1 + usize::from(closest.older);
    closest
}
