//! Where the polytope starts.

use std::ops::Deref;

use glam::DVec3;

use super::HEIGHT_ERROR;
use super::polytope::{Polytope, side};
use crate::Support;
use crate::difference::{Difference, SupportPoint};

/// A polytope that contains the points GJK ended with, and so the origin, up to [`TOUCHING_ERROR`](crate::gjk::TOUCHING_ERROR).
/// `Err` with the unit normal of the plane in which `A - B` lies, when it has no thickness.
pub(super) fn start<A, B>(
    difference: &Difference<A, B>,
    ended: &[SupportPoint],
) -> Result<Box<Polytope>, DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    if let [p, q, r, s] = *ended
        && let Some(polytope) = Polytope::tetrahedron(difference, [p, q, r, s], None)
    {
        return Ok(polytope);
    }
    let mut points = Points::new(ended);
    look_along(difference, &[DVec3::X, DVec3::Y, DVec3::Z], &mut points);
    let corners = spanned(difference, &mut points)?;
    let Some(mut polytope) = Polytope::tetrahedron(difference, corners, None) else {
        unreachable!("a corner with a height off the others is not in their plane")
    };
    for &p in &*points {
        polytope.insert(difference, p);
    }
    Ok(polytope)
}

/// Support points, without memory of their own: those that GJK ended with, and of three, two and one axis, both ways.
struct Points {
    slots: [SupportPoint; POINTS_MAX],
    count: usize,
}

const POINTS_MAX: usize = 4 + 2 * (3 + 2 + 1);

impl Points {
    fn new(points: &[SupportPoint]) -> Self {
        let mut all = Points { slots: [SupportPoint::ZERO; POINTS_MAX], count: 0 };
        points.iter().for_each(|&point| all.push(point));
        all
    }

    fn push(&mut self, point: SupportPoint) {
        self.slots[self.count] = point;
        self.count += 1;
    }
}

impl Deref for Points {
    type Target = [SupportPoint];

    fn deref(&self) -> &[SupportPoint] {
        &self.slots[..self.count]
    }
}

/// Adds the support points along some axes, both ways.
fn look_along<A, B>(difference: &Difference<A, B>, axes: &[DVec3], points: &mut Points)
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    for axis in axes.iter().flat_map(|&axis| [axis, -axis]) {
        points.push(difference.support_against(axis));
    }
}

/// Four of the points that are not coplanar; each time that those there are do not reach beyond the rounding error, support points
/// across what they span are added. `Err` with the normal, when there are none.
fn spanned<A, B>(difference: &Difference<A, B>, points: &mut Points) -> Result<[SupportPoint; 4], DVec3>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let p = points[0];
    let from_p = |x: &SupportPoint| difference.edge(&p, x);
    // Support points along all axes: what has any extent shows it.
    let (q, length) = furthest(points, |x| from_p(x).length());
    if length <= HEIGHT_ERROR {
        return Err(DVec3::X);
    }
    let line = from_p(&q) / length;
    let off_line = |x: &SupportPoint| from_p(x).reject_from_normalized(line);
    let (mut r, mut width) = furthest(points, |x| off_line(x).length());
    if width <= HEIGHT_ERROR {
        let (u, v) = line.any_orthonormal_pair();
        look_along(difference, &[u, v], points);
        (r, width) = furthest(points, |x| off_line(x).length());
    }
    if width <= HEIGHT_ERROR {
        return Err(line.any_orthonormal_vector());
    }
    // Of what is off the line, however long its points are along it.
    let normal = line.cross(off_line(&r)).normalize();
    let off_plane = |x: &SupportPoint| {
        // Of points so far off that they have no side, none is known to be.
        let off = side([p.w, q.w, r.w], x.w).abs() > 0.0;
        if off { normal.dot(from_p(x)).abs() } else { 0.0 }
    };
    let (mut s, mut height) = furthest(points, off_plane);
    if height <= HEIGHT_ERROR {
        look_along(difference, &[normal], points);
        (s, height) = furthest(points, off_plane);
    }
    if height <= HEIGHT_ERROR { Err(normal) } else { Ok([p, q, r, s]) }
}

/// The point of the greatest measure, the first of equals.
pub(super) fn furthest(
    points: &[SupportPoint],
    measure: impl Fn(&SupportPoint) -> f64,
) -> (SupportPoint, f64) {
    let further = |best: (SupportPoint, f64), x: &SupportPoint| {
        let reach = measure(x);
        if reach > best.1 { (*x, reach) } else { best }
    };
    points.iter().fold((points[0], 0.0), further)
}
