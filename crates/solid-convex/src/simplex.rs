//! The simplex of GJK: up to four support points, and the point of their hull closest to the origin.
//!
//! The closest point is found by the Voronoi regions of the simplex's features, through the normal of the face,
//! rather than by Johnson's recursion of determinants as in the thesis (section 4.4.1). On nearly flat simplices these have
//! no right digit: of 2,000 pairs of boxes a billionth apart they separate 32 where this separates all, and they take
//! tetrahedra for containing the origin that do not. Whether a tetrahedron contains the origin is decided exactly.

use glam::DVec3;
use robust::{Coord3D, orient3d};

use crate::difference::{SUPPORT_ERROR, SupportPoint};
use crate::feature::{
    FACES, SLIVER_SINE_SQUARED, VOLUME_ERROR, Within, normal, perpendicular, sides_of_origin, within_edge,
    within_face,
};
use crate::simd::each;

/// Up to four support points. Invariant: after [`reduce`](Simplex::reduce), the smallest set whose hull contains the
/// closest point, with positive barycentric coordinates that sum to 1.
///
/// Support points stay in the slots that they were put in; which of them belong to the simplex is a matter of a few bytes.
#[derive(Clone, Debug)]
pub(crate) struct Simplex {
    slots: [SupportPoint; 4],
    members: Members,
}

/// Which slots a simplex consists of, the oldest first, and the barycentric coordinates of these.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Members {
    slots: [u8; 4],
    len: usize,
    barycentric: [f64; 4],
}

impl Members {
    /// Whether there are any.
    pub fn any(&self) -> bool {
        self.len > 0
    }
}

/// What [`Simplex::reduce`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reduced {
    /// The tetrahedron contains the origin: exactly, for the support points as they were rounded.
    ContainsOrigin,
    /// The point of the hull closest to the origin.
    Closest(DVec3),
}

/// Barycentric coordinates over up to three of the simplex's points: the closest point of a face, an edge, a vertex.
#[derive(Clone, Copy)]
struct Feature {
    v: DVec3,
    indices: [usize; 3],
    weights: [f64; 3],
    len: usize,
}

/// Six times the volume between the origin and a face, beyond which the face has the origin inside whatever rounding does;
/// coordinates are below 2. Of flatter tetrahedra all faces are looked at.
const CLEARLY_INSIDE: f64 = 1e-6;

impl Simplex {
    #[inline]
    pub fn new() -> Self {
        Simplex {
            slots: [SupportPoint::ZERO; 4],
            members: Members { slots: [0; 4], len: 0, barycentric: [0.0; 4] },
        }
    }

    /// Up to four points, the oldest first; not reduced.
    pub fn of(points: &[SupportPoint]) -> Self {
        let mut simplex = Simplex::new();
        points.iter().for_each(|p| simplex.push(*p));
        simplex
    }

    /// The support points, the oldest first.
    pub fn points(&self) -> impl Iterator<Item = &SupportPoint> + Clone {
        (0..self.members.len).map(|i| self.point(i))
    }

    pub fn is_empty(&self) -> bool {
        self.members.len == 0
    }

    fn point(&self, i: usize) -> &SupportPoint {
        &self.slots[usize::from(self.members.slots[i] & 3)]
    }

    /// Whether a support point is in the simplex already, or coincides with one that is.
    #[inline]
    pub fn contains(&self, p: &SupportPoint) -> bool {
        self.points().any(|q| q.w == p.w || q.same_features(p))
    }

    /// Adds a support point; there is room, since a reduced simplex of four contains the origin and ends the search.
    #[inline]
    pub fn push(&mut self, p: SupportPoint) {
        let members = &mut self.members;
        let taken = members.slots[..members.len].iter().fold(0u8, |taken, slot| taken | 1 << slot);
        let free = taken.trailing_ones() as usize & 3;
        self.slots[free] = p;
        members.slots[members.len] = free as u8;
        members.len += 1;
    }

    /// Adds a support point where rounding hides on which face with it the closest point is (Theorem 4.8), and keeps the face of which the
    /// origin is least outside. False where there is no such face; then nothing is to be done with the simplex but to go back.
    pub fn push_to_face(&mut self, p: SupportPoint) -> bool {
        let faces: &[[usize; 3]] = match self.members.len {
            2 => &[[0, 1, 2]],
            3 => &[FACES[0].0, FACES[1].0, FACES[2].0],
            _ => return false,
        };
        self.push(p);
        let least = |weights: [f64; 3]| weights[0].min(weights[1]).min(weights[2]);
        let weighted = faces.iter().map(|&face| (face, weights(face.map(|i| self.w(i)), 1.0, DVec3::ZERO)));
        let proper = weighted.filter(|(_, weights)| weights.iter().all(|weight| weight.is_finite()));
        let best = proper.max_by(|(_, x), (_, y)| least(*x).total_cmp(&least(*y)));
        if let Some((indices, weights)) = best {
            let inside = weights.map(|weight| weight.max(0.0));
            let sum: f64 = inside.iter().sum();
            self.keep(&Feature {
                v: DVec3::ZERO,
                indices,
                weights: inside.map(|weight| weight / sum),
                len: 3,
            });
        }
        best.is_some()
    }

    /// What the simplex consists of, to be gone back to before the next but one point is added.
    pub fn members(&self) -> Members {
        self.members
    }

    /// Goes back to what the simplex was before the last point was added.
    pub fn restore(&mut self, members: Members) {
        self.members = members;
    }

    /// The points of `A` and of `B`, each in its local space, that the closest point is the difference of.
    pub fn witness(&self) -> (DVec3, DVec3) {
        let none = (DVec3::ZERO, DVec3::ZERO);
        self.weighted().fold(none, |(a, b), (p, weight)| (a + p.a * weight, b + p.b * weight))
    }

    /// The support points with the barycentric coordinates of the closest point.
    pub fn weighted(&self) -> impl Iterator<Item = (&SupportPoint, f64)> {
        self.points().zip(self.members.barycentric)
    }

    /// Whether a simplex of any four points contains the origin: then it is as [`reduce`](Simplex::reduce) leaves it.
    pub fn reduce_if_inside(&mut self) -> bool {
        let sides = self.sides_of_origin().filter(|sides| sides.iter().all(|&side| side >= 0.0));
        if let Some(sides) = sides {
            self.members.barycentric = self.origin_in_tetrahedron(sides);
        }
        sides.is_some()
    }

    /// Finds the point of the hull closest to the origin, and drops the points that it does not need.
    pub fn reduce(&mut self) -> Reduced {
        let feature = match self.members.len {
            1 => self.vertex(0),
            2 => self.edge([0, 1]),
            3 => self.face([0, 1, 2]),
            4 => match self.sides_of_origin() {
                Some(sides) if sides.iter().all(|&side| side >= 0.0) => {
                    self.members.barycentric = self.origin_in_tetrahedron(sides);
                    return Reduced::ContainsOrigin;
                }
                sides => self.tetrahedron_boundary(sides.unwrap_or_default()),
            },
            _ => unreachable!("a simplex has one to four points"),
        };
        self.keep(&feature);
        Reduced::Closest(feature.v)
    }

    fn keep(&mut self, feature: &Feature) {
        let members = &mut self.members;
        let kept = feature.indices.map(|i| members.slots[i]);
        members.len = feature.len;
        members.slots[..3].copy_from_slice(&kept);
        members.barycentric[..3].copy_from_slice(&feature.weights);
    }

    fn w(&self, i: usize) -> DVec3 {
        self.point(i).w
    }

    /// Which of three points is nearest to the origin: 0, 1 or 2; the first of equals.
    fn nearest_of(&self, indices: [usize; 3]) -> usize {
        let [p, q, r] = each(indices, |i| self.w(i).length_squared());
        let (first, least) = if q < p { (1, q) } else { (0, p) };
        if r < least { 2 } else { first }
    }

    fn vertex(&self, i: usize) -> Feature {
        Feature { v: self.w(i), indices: [i, 0, 0], weights: [1.0, 0.0, 0.0], len: 1 }
    }

    fn edge(&self, [i, j]: [usize; 2]) -> Feature {
        let (p, q) = (self.w(i), self.w(j));
        match within_edge([p, q]) {
            Ok((v, [x, y])) => Feature { v, indices: [i, j, 0], weights: [x, y, 0.0], len: 2 },
            Err(end) => self.vertex([i, j][end]),
        }
    }

    /// The closest point of a face whose last point is the newest.
    fn face(&self, [i, j, k]: [usize; 3]) -> Feature {
        // From the vertex nearest to the origin, whose rounding error is the smallest: next to it a weight may be 10^-17 of
        // those of the others, and still its sign decides.
        let around = [[i, j, k], [j, k, i], [k, i, j]][self.nearest_of([i, j, k])];
        let [p, q, r] = each(around, |i| self.w(i));
        match within_face([p, q, r], SLIVER_SINE_SQUARED) {
            Within::Face(v, weights) => return Feature { v, indices: around, weights, len: 3 },
            Within::Beyond(_) => {}
            Within::Sliver => {
                let weights = weights([p, q, r], 1.0, DVec3::ZERO);
                if weights.iter().all(|&weight| weight > 0.0) {
                    let n = normal([q - p, r - q, p - r]);
                    let v = n * (n.dot(p) / n.length_squared());
                    return Feature { v, indices: around, weights, len: 3 };
                }
            }
        }
        // The newest point is part of the result (Theorem 4.8), whatever the weights of a sliver say.
        closest([[j, k], [k, i]].into_iter().map(|edge| self.edge(edge))).unwrap_or_else(|| self.vertex(k))
    }

    /// On which side of each of the [`FACES`] the origin is, six times the volume it makes with the face: positive inside,
    /// with exact signs. `None` for a flat tetrahedron.
    fn sides_of_origin(&self) -> Option<[f64; 4]> {
        let (sides, least) = sides_of_origin(each([0, 1, 2, 3], |i| self.w(i)));
        if least > VOLUME_ERROR { Some(sides) } else { self.exact_sides_of_origin() }
    }

    #[cold]
    fn exact_sides_of_origin(&self) -> Option<[f64; 4]> {
        let [p, q, r, s] = [0, 1, 2, 3].map(|i| coord(self.w(i)));
        let volume = orient3d(p, q, r, s);
        let origin = coord(DVec3::ZERO);
        // With the origin in place of the vertex opposite.
        let parts = [
            orient3d(p, q, origin, s),
            orient3d(origin, q, r, s),
            orient3d(p, origin, r, s),
            orient3d(p, q, r, origin),
        ];
        (volume != 0.0).then(|| parts.map(|part| part * volume.signum()))
    }

    /// The barycentric coordinates of the origin in the tetrahedron that contains it.
    ///
    /// The ratios of its determinants, unless it is flat: then these have the right sign but no right digit. Of the
    /// coordinates found from each face, with and without the fourth point, those are taken that give the origin best.
    fn origin_in_tetrahedron(&self, sides: [f64; 4]) -> [f64; 4] {
        let mut ratios = [0.0; 4];
        let inverse = 1.0 / sides.iter().sum::<f64>();
        FACES.iter().zip(sides).for_each(|(&(_, apex), side)| ratios[apex] = side * inverse);
        let over_faces = FACES.iter().map(|&(face, apex)| self.origin_over(face, apex));
        let on_faces = FACES.iter().map(|&(face, _)| {
            let feature = self.face(face);
            let mut weights = [0.0; 4];
            (0..feature.len).for_each(|k| weights[feature.indices[k]] = feature.weights[k]);
            weights
        });
        let (mut best, mut best_residual) = ([0.25; 4], f64::INFINITY);
        for weights in std::iter::once(ratios).chain(over_faces).chain(on_faces) {
            let residual = (0..4).map(|i| self.w(i) * weights[i]).sum::<DVec3>().length_squared();
            if residual < best_residual {
                (best, best_residual) = (weights, residual);
            }
            if best_residual <= SUPPORT_ERROR * SUPPORT_ERROR {
                break;
            }
        }
        best
    }

    /// The barycentric coordinates of the origin: that of the apex by its height over the face, the others in the face.
    fn origin_over(&self, [i, j, k]: [usize; 3], apex: usize) -> [f64; 4] {
        let (p, q, r, s) = (self.w(i), self.w(j), self.w(k), self.w(apex));
        let n = normal([q - p, r - q, p - r]);
        let of_apex = (-n.dot(p) / n.dot(s - p)).clamp(0.0, 1.0);
        // What the face has to contribute: weights that sum to `rest`, and that point.
        let (rest, target) = (1.0 - of_apex, -of_apex * s);
        let in_face = weights([p, q, r], rest, target).map(|weight| weight.max(0.0));
        let mut all = [0.0; 4];
        all[apex] = of_apex;
        (all[i], all[j], all[k]) = (in_face[0], in_face[1], in_face[2]);
        let total: f64 = all.iter().sum();
        all.map(|weight| weight / total)
    }

    /// The closest point of the tetrahedron's boundary: on a face with the newest point, which lies beyond the face of the
    /// others (Theorem 4.8), that does not clearly have the origin inside. Where rounding leaves no such face, on any of them.
    fn tetrahedron_boundary(&self, sides: [f64; 4]) -> Feature {
        let newest = || FACES[..3].iter().zip(sides).map(|(&(face, _), side)| (face, side));
        let toward_origin = newest().filter(|(_, side)| *side <= CLEARLY_INSIDE);
        closest(toward_origin.map(|(face, _)| self.face(face)))
            .or_else(|| closest(newest().map(|(face, _)| self.face(face))))
            .unwrap_or_else(|| self.vertex(3))
    }
}

/// The weights of three points that sum to `sum` and whose combination is as close as can be to a point: negative where it
/// is outside of the triangle, not numbers where the triangle is degenerate.
///
/// First across the longest edge, then along it: what the short side of a sliver leaves uncertain then stays as small as
/// that side. Signed areas, the usual way, let it move the result along the long one.
fn weights(points: [DVec3; 3], sum: f64, target: DVec3) -> [f64; 3] {
    let length_squared = |i: usize, j: usize| (points[j] - points[i]).length_squared();
    let edges = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
    let longest = |x: [usize; 3], y: [usize; 3]| {
        if length_squared(y[0], y[1]) > length_squared(x[0], x[1]) { y } else { x }
    };
    let [i, j, k] = edges.into_iter().fold(edges[0], longest);
    // What is across the edge from the end that is nearer to the third point, the rest from the end that is nearer to the target: next
    // to it a weight may be 10^-12 of those of the others.
    let near = if length_squared(i, k) <= length_squared(j, k) { i } else { j };
    let across = perpendicular(points[k] - points[near], points[j] - points[i]);
    let rest = |i: usize| target - sum * points[i];
    let [i, j] = if rest(i).length_squared() <= rest(j).length_squared() { [i, j] } else { [j, i] };
    let (long, short, rest) = (points[j] - points[i], points[k] - points[i], rest(i));
    let of_k = perpendicular(rest, long).dot(across) / across.length_squared();
    let of_j = (rest - short * of_k).dot(long) / long.length_squared();
    let mut weights = [0.0; 3];
    (weights[i], weights[j], weights[k]) = (sum - of_k - of_j, of_j, of_k);
    weights
}

/// The feature whose closest point is nearest to the origin; the first of equals.
fn closest(features: impl Iterator<Item = Feature>) -> Option<Feature> {
    features.min_by(|x, y| x.v.length_squared().total_cmp(&y.v.length_squared()))
}

pub(crate) fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}
