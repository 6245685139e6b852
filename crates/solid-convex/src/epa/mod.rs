//! Penetration depth by the expanding polytope algorithm (EPA): how far, and which way, must `A` move to leave `B`?
//!
//! The thesis names the question (section 2.3); the algorithm is its author's later one (van den Bergen, *Proximity Queries and
//! Penetration Depth Computation on 3D Game Objects*, 2001). A polytope inside `A - B` that contains the origin grows, by
//! a support point along the normal of the face nearest to the origin, until that face is known to lie on the boundary of `A - B`.
//! What differs, and why:
//!
//! - Which faces a new point sees is decided exactly, so that the polytope is always convex and closed. Where rounding decides,
//!   the seen faces can be several patches, or none.
//! - It starts from GJK's tetrahedron when there is one. When GJK ended with less, as it does for shapes that touch or have
//!   their middles in one place, the start is spanned by support points along the axes and then across what these span; a
//!   difference without thickness is recognised there, and its depth is 0 along its normal.
//! - Two boxes, however placed, need no search: the facets of their difference are known.
//! - Spheres and capsules, unless they are stretched, are points and segments with a radius: what is searched is the depth or the
//!   distance of these, and both are found exactly.
//! - Where what is curved is nearest Newton's method finds, from the face that the search ends with: the polytope would need a vertex for
//!   each two or three bits of the normal, and says only how much nearer the boundary might be elsewhere.
//! - Needles side by side are searched once more, in a space that is stretched across them.
//! - Every direction that was looked along gives an upper bound, the nearest face a lower one. Both are reported, so that an
//!   answer that had to stop early ([`VERTICES_MAX`], [`POLYTOPE_VERTICES_MAX`]) says how good it is.

mod face;
mod plane;
mod polytope;
mod rounded;
mod start;
mod stretch;
#[cfg(test)]
mod tests;
mod zonotope;

use glam::{DAffine3, DVec3};

use crate::difference::{Difference, SUPPORT_ERROR, SupportPoint};
use crate::feature::SLIVER_SINE_SQUARED;
use crate::gjk::{BEYOND_TOUCHING, End, Goal, descend, intersects, nearest_boundary};
use crate::rounded::Core;
use crate::simplex::{Reduced, Simplex};
use crate::{Support, Witness};
use face::Face;
use plane::Plane;
use polytope::Polytope;
use start::start;
use stretch::Stretch;

/// The depth of curved objects is searched until its bounds are this near, relative to it: they need some five support points for
/// each digit. The upper one is then nearly always the depth to the rounding error. That of polytopes is searched to the rounding
/// error, for a few vertices more.
pub const DEPTH_TOLERANCE: f64 = 1e-7;

/// The most vertices of the polytope of curved objects. Those that have their least depth in many directions at once, as a cylinder around
/// another, need one for every few degrees; at this many, of a circle of directions, the bounds are 3e-4 of the depth apart.
pub const VERTICES_MAX: usize = 256;

/// The same of polytopes, which end with the exact answer: two hulls of 50,000 points on a sphere, one in the place of the other, need 14,500, for
/// a tenth of a second; of 1,000 points 400, for 0.2 ms.
pub const POLYTOPE_VERTICES_MAX: usize = 1 << 14;

/// The most support points that are looked at for each vertex: each gives a vertex or finishes a face, of which there are at most two a vertex.
const EXPANSIONS_PER_VERTEX: usize = 4;

/// The error of the height of a support point along a unit vector, whose coordinates sum to less than 2.
const HEIGHT_ERROR: f64 = 2.0 * SUPPORT_ERROR;

/// Bounds that are further apart than the tolerance of the search, times this, are so because planes of faces were lost in rounding, or because
/// [`VERTICES_MAX`] ended it.
const UNCERTAIN: f64 = 2.0;

/// How deep two placed convex objects are in each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// The length of the shortest translation that leaves them touching, at least 0. World units.
    pub depth: f64,
    /// The depth is at least this.
    pub lower: f64,
    /// The depth is at most this.
    pub upper: f64,
    /// The unit vector along which `A` is to move by [`depth`](Penetration::depth), from `B` to `A`. Space: world.
    pub direction: DVec3,
    /// The point of each object that is deepest in the other: that of `A` comes to lie on that of `B`.
    pub points: Witness,
}

/// How deep two placed convex objects are in each other; `None` when [`intersection`](crate::gjk::intersection) says that they are
/// separate. Touching objects have a depth of about 0, and the direction of their common plane.
///
/// Flat objects have a depth too, in the sense that a translation by it leaves them touching: two triangles in a plane, and whatever else has
/// a Minkowski difference without thickness, have a depth of 0 along its normal. Of several shortest translations one is
/// given, the same for the same input. Scaling both by a power of two scales the answer and changes no other bit.
///
/// The placements must be finite, with entries of at most [`MAGNITUDE_MAX`](crate::MAGNITUDE_MAX). The error is what `lower` and `upper`
/// say: for polytopes some 1e-14 of the size of the data, more where one is thin and meets a corner with its end; for others
/// [`DEPTH_TOLERANCE`] of the depth unless [`VERTICES_MAX`] ended the search. Cost: of two boxes some hundred nanoseconds; of others that of [`intersection`](crate::gjk::intersection), and some ten support
/// points of each object, more the deeper they are.
///
/// ```
/// use solid_convex::{Cuboid, epa};
/// use glam::{DAffine3, DVec3};
/// let block = Cuboid::new(DVec3::ONE)?;
/// let right = DAffine3::from_translation(DVec3::new(0.75, 0.0, 0.0));
/// let found = epa::penetration(&block, &right, &block, &DAffine3::IDENTITY).unwrap();
/// assert_eq!((found.depth, found.direction), (0.25, DVec3::X));
/// assert_eq!((found.points.on_a.x, found.points.on_b.x), (-0.5, 0.5));
/// # Ok::<(), solid_convex::SizeError>(())
/// ```
pub fn penetration<A, B>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3) -> Option<Penetration>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(a, placement_a, b, placement_b);
    if let found @ Some(_) = zonotope::penetration(&difference) {
        return found;
    }
    let (core_a, core_b) = (Core::of(a, placement_a), Core::of(b, placement_b));
    if core_a.radius() > 0.0 || core_b.radius() > 0.0 {
        let found = rounded::penetration(&core_a, placement_a, &core_b, placement_b, BEYOND_TOUCHING)?;
        // Of what touches GJK has the word.
        let surely = found.lower * difference.scale() > BEYOND_TOUCHING;
        return (surely || intersects(a, placement_a, b, placement_b)).then_some(found);
    }
    let descent = descend(&difference, Goal::Separation);
    (descent.end != End::Separated)
        .then(|| deepen(&difference, &descent.simplex).penetration(difference.scale(), 0.0))
}

/// The same for objects that are known to intersect or touch, with a simplex of their difference that shows it.
pub(crate) fn penetration_from<A, B>(
    a: &A,
    placement_a: &DAffine3,
    b: &B,
    placement_b: &DAffine3,
    simplex: &Simplex,
) -> Penetration
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(a, placement_a, b, placement_b);
    if let Some(found) = zonotope::penetration(&difference) {
        return found;
    }
    let (core_a, core_b) = (Core::of(a, placement_a), Core::of(b, placement_b));
    if core_a.radius() > 0.0 || core_b.radius() > 0.0 {
        let found = rounded::penetration(&core_a, placement_a, &core_b, placement_b, f64::INFINITY);
        return found.expect("no distance is beyond all bounds");
    }
    deepen(&difference, simplex).penetration(difference.scale(), 0.0)
}

/// The depth of the origin in a difference, from the simplex around it that a descent ended with.
fn deepen<A, B>(difference: &Difference<A, B>, simplex: &Simplex) -> Nearest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let mut points = simplex.points().copied();
    let first = points.next().unwrap_or_else(|| difference.support_against(DVec3::X));
    let (mut ended, mut count) = ([first; 4], 1);
    for (place, p) in ended[1..].iter_mut().zip(points) {
        *place = p;
        count += 1;
    }
    let ended = &ended[..count];
    match start(difference, ended) {
        Ok(mut polytope) => {
            let found = expand(difference, &mut polytope);
            let found = match found.is_certain(difference) {
                true => found,
                false => uncertain(difference, polytope.vertices(), found),
            };
            polytope.recycle();
            found
        }
        Err(normal) => flat(difference, normal, ended),
    }
}

/// The better of what was found and what is found of the difference when it is stretched: see [`Stretch`]. Of the points of both, and those that
/// GJK finds where the boundary is said to be, the nearest to there are given: planes of slivers leave the rays elsewhere.
#[cold]
#[inline(never)]
fn uncertain<A, B>(difference: &Difference<A, B>, points: &[SupportPoint], found: Nearest) -> Nearest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let better = stretched(difference, points).filter(|better| better.uncertainty() < found.uncertainty());
    let best = better.unwrap_or(found);
    let target = best.normal * best.height;
    let there = descend(&difference.moved(target), Goal::Separation).simplex;
    let missed = |points: &Witness| difference.point(points.on_a, points.on_b).w.distance_squared(target);
    let of_gjk = (there.points().next().is_some()).then(|| Witness::of(&there));
    match of_gjk.filter(|points| missed(points) < missed(&best.points)) {
        Some(points) => Nearest { points, ..best },
        None => best,
    }
}

/// The depth of the origin in a difference as thin as a needle, of which some points are known, as its stretched image has it.
fn stretched<A, B>(difference: &Difference<A, B>, points: &[SupportPoint]) -> Option<Nearest>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (stretch, corners) = Stretch::across(difference, points)?;
    let stretched = stretch.apply(difference);
    let corners = corners.map(|p| stretched.point(p.a, p.b));
    let mut polytope = Polytope::tetrahedron(&stretched, corners, Some(stretch))?;
    let found = expand(&stretched, &mut polytope);
    polytope.recycle();
    let normal = stretch.normal(found.normal).normalize();
    let height = normal.dot(difference.support_against(-normal).w);
    Some(Nearest { height, normal, ..found })
}

/// The point of the boundary of `A - B` nearest to the origin.
struct Nearest {
    /// Its distance: an upper bound of the depth. Negative when the origin is outside.
    height: f64,
    /// A lower bound.
    lower: f64,
    /// The outward normal there.
    normal: DVec3,
    /// The point, as a point of `A` and one of `B`.
    points: Witness,
}

impl Nearest {
    /// How far its bounds are apart; no depth is below 0.
    fn uncertainty(&self) -> f64 {
        self.height.max(0.0) - self.lower.max(0.0)
    }

    /// Whether they are as near to each other as the search wants them.
    fn is_certain<A, B>(&self, difference: &Difference<A, B>) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        self.uncertainty() <= UNCERTAIN * tolerance(self.height, relative_tolerance(difference))
    }

    /// The answer in world units, for two objects that are all within some distance of these; `radius` is the sum of both.
    fn penetration(&self, scale: f64, radius: f64) -> Penetration {
        let depth = (self.height + radius).max(0.0);
        let error = HEIGHT_ERROR * (1.0 + radius);
        Penetration {
            depth: depth / scale,
            lower: (self.lower + radius - error).clamp(0.0, depth) / scale,
            upper: (depth + error) / scale,
            direction: -self.normal,
            points: self.points,
        }
    }
}

/// Grows a polytope until the point of the boundary nearest to the origin is known.
fn expand<A, B>(difference: &Difference<A, B>, polytope: &mut Polytope) -> Nearest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let relative = relative_tolerance(difference);
    let tolerance = |height: f64| tolerance(height, relative);
    let (mut height, mut normal, mut corners) = (f64::INFINITY, DVec3::X, [0; 3]);
    let vertices_max = if relative > 0.0 { VERTICES_MAX } else { POLYTOPE_VERTICES_MAX };
    for _ in 0..EXPANSIONS_PER_VERTEX * vertices_max {
        let Some(index) = polytope.take_nearest() else { break };
        let Face { plane: Plane { normal: across, offset, .. }, corners: around, .. } = *polytope.face(index);
        if offset >= height - tolerance(height) {
            break;
        }
        let p = difference.support_against(-across);
        let beyond = across.dot(p.w);
        if beyond < height {
            (height, normal, corners) = (beyond, across, around);
        }
        // A point that is a vertex already is beyond the face by the rounding error only.
        let grows = beyond - offset > tolerance(beyond)
            && polytope.vertex_count() < vertices_max
            && !polytope.has_vertex(&p);
        if grows {
            polytope.insert_beyond(difference, p, index);
        }
    }
    let margin = tolerance(height);
    let lower = polytope.radius(height - margin);
    // Of polytopes nothing bends; what is stretched has other lengths.
    let may_bend = relative > 0.0 && !polytope.is_stretched();
    let refined = may_bend.then(|| refined(difference, &polytope.points(corners))).flatten();
    let (height, normal, points) = refined
        .filter(|(refined, ..)| *refined <= height)
        .unwrap_or_else(|| (height, normal, witness(polytope, normal, height, height - lower, margin)));
    Nearest { height, lower, normal, points }
}

/// Where the boundary of `A - B` near some points of it is nearest to the origin, to the rounding error: its height, its normal, and the
/// point. `None` where nothing bends, and where that is not found.
fn refined<A, B>(difference: &Difference<A, B>, near: &[SupportPoint]) -> Option<(f64, DVec3, Witness)>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let (point, points) = nearest_boundary(difference, near)?;
    let normal = point.normalize();
    let height = normal.dot(difference.support_against(-normal).w);
    // On the plane across the way to it, beyond which nothing is.
    ((height - point.length()).abs() <= HEIGHT_ERROR).then_some((height, normal, points))
}

/// The point where the ray along a normal leaves the polytope, which is at a height less at most `beyond`, up to a margin.
fn witness(polytope: &Polytope, normal: DVec3, height: f64, beyond: f64, margin: f64) -> Witness {
    let (direction, target) = polytope.ray(normal, height);
    let foot =
        |corners: [SupportPoint; 3]| over(&corners, target).unwrap_or_else(|| closest(&corners, target));
    let nearer = |x: &(f64, Witness), y: &(f64, Witness)| x.0.total_cmp(&y.0);
    let across = polytope.faces_across(direction, margin).map(foot).min_by(nearer);
    let reach = beyond + margin;
    let found = across.filter(|(distance_squared, _)| *distance_squared <= reach * reach);
    // The planes of slivers can be anywhere: then their corners tell.
    let found = found.or_else(|| polytope.all_faces().map(foot).min_by(nearer));
    found.expect("a polytope has faces").1
}

/// The point of a triangle at the foot of a point, by the areas, with the square of the distance; `None` when that is not well inside, or the triangle too thin for these.
fn over([p, q, r]: &[SupportPoint; 3], target: DVec3) -> Option<(f64, Witness)> {
    let (pq, pr) = (q.w - p.w, r.w - p.w);
    let n = pq.cross(pr);
    let n_squared = n.length_squared();
    if n_squared < SLIVER_SINE_SQUARED * pq.length_squared() * pr.length_squared() {
        return None;
    }
    let from = p.w - target;
    let across = from.cross(n) / n_squared;
    let distance = from.dot(n);
    let (of_q, of_r) = (pr.dot(across), -pq.dot(across));
    let of_p = 1.0 - of_q - of_r;
    let blend = |p: DVec3, q: DVec3, r: DVec3| p * of_p + q * of_q + r * of_r;
    let inside = of_p > 0.0 && of_q > 0.0 && of_r > 0.0;
    inside.then(|| {
        let points = Witness { on_a: blend(p.a, q.a, r.a), on_b: blend(p.b, q.b, r.b) };
        (distance * distance / n_squared, points)
    })
}

/// The side of a difference without thickness on which less of it is; `ended` has the origin between its points.
fn flat<A, B>(difference: &Difference<A, B>, normal: DVec3, ended: &[SupportPoint]) -> Nearest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let height = |normal: DVec3| normal.dot(difference.support_against(-normal).w);
    let (above, below) = (height(normal), height(-normal));
    let (height, normal) = if below < above { (below, -normal) } else { (above, normal) };
    Nearest { height, lower: 0.0, normal, points: closest(ended, DVec3::ZERO).1 }
}

/// To what part of it a depth is searched.
fn relative_tolerance<A, B>(difference: &Difference<A, B>) -> f64
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    if difference.is_polytope() { 0.0 } else { DEPTH_TOLERANCE }
}

/// How far above a face `A - B` may reach for the face to count as its boundary.
fn tolerance(height: f64, relative: f64) -> f64 {
    if height.is_finite() { relative * height.max(0.0) + HEIGHT_ERROR } else { 0.0 }
}

/// The point of the hull of up to three points that is closest to a target, with the square of the distance.
fn closest(points: &[SupportPoint], target: DVec3) -> (f64, Witness) {
    let shifted = |p: &SupportPoint| SupportPoint { w: p.w - target, ..*p };
    // A simplex keeps its newest point, as GJK wants it: each in turn is the newest.
    let newest = (0..points.len()).map(|last| {
        let mut simplex = Simplex::new();
        for p in points[last + 1..].iter().chain(&points[..=last]).map(shifted) {
            if !simplex.contains(&p) {
                simplex.push(p);
            }
        }
        let distance_squared = match simplex.reduce() {
            Reduced::ContainsOrigin => 0.0,
            Reduced::Closest(v) => v.length_squared(),
        };
        let (on_a, on_b) = simplex.witness();
        (distance_squared, Witness { on_a, on_b })
    });
    newest.min_by(|x, y| x.0.total_cmp(&y.0)).expect("there is a point")
}
