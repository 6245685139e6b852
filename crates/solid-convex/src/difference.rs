//! The Minkowski difference of two placed objects, as a support mapping of its own.

use glam::{DAffine3, DMat3, DVec3};

use crate::gjk::{Pair, newton};
use crate::{Support, unit_scale};

/// A point of an object.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    /// Space: local to the object.
    pub point: DVec3,
    /// Which of the points of a polytope it is, or [`NO_VERTEX`].
    pub index: u16,
}

/// Of a point that is no vertex of a polytope, or one beyond so many: no index.
pub(crate) const NO_VERTEX: u16 = u16::MAX;

impl Vertex {
    #[inline(always)]
    pub fn new(point: DVec3, index: usize) -> Vertex {
        Vertex { point, index: index.min(usize::from(NO_VERTEX)) as u16 }
    }
}

/// A point of which nothing else is known.
impl From<DVec3> for Vertex {
    #[inline(always)]
    fn from(point: DVec3) -> Self {
        Vertex { point, index: NO_VERTEX }
    }
}

/// A support point of `A - B`, with the points of the two objects it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SupportPoint {
    /// The point of the difference. Space: the difference's own.
    pub w: DVec3,
    /// The point of `A`. Space: local to `A`.
    pub a: DVec3,
    /// The point of `B`. Space: local to `B`.
    pub b: DVec3,
    /// Which of the points of `A` and of `B` they are, as in [`Vertex`].
    pub indices: [u16; 2],
}

impl SupportPoint {
    /// What stands where there is none yet: zeros alone, which are soon written.
    pub const ZERO: SupportPoint =
        SupportPoint { w: DVec3::ZERO, a: DVec3::ZERO, b: DVec3::ZERO, indices: [0; 2] };

    /// Whether both come from the same points of the two objects.
    pub fn same_features(&self, other: &SupportPoint) -> bool {
        self.a == other.a && self.b == other.b
    }
}

/// What a search asks of `A - B`. To be inlined, all of it.
pub(crate) trait MinkowskiDifference {
    /// A support point in the direction `-v`: where `v` points from `B` to `A`, the point that is least along `v`.
    /// Theorem 4.7 for each of the two objects.
    fn support_against(&self, v: DVec3) -> SupportPoint;

    /// The point of the difference that a point of each object makes.
    fn point(&self, a: DVec3, b: DVec3) -> SupportPoint;

    /// The points of two polytopes that have these indices; `None` of other objects.
    fn vertices(&self, indices: [u16; 2]) -> Option<[DVec3; 2]>;

    /// Whether it is the hull of finitely many points.
    fn is_polytope(&self) -> bool {
        true
    }

    /// Of what is curved: pairs of points to go on from, and how many there are, where a descent has come to these points of the difference.
    fn nearer(&self, _points: &[SupportPoint]) -> Option<([Pair; 3], usize)> {
        None
    }

    /// Where to start: from the middle of `B` to that of `A`, and along x when they coincide.
    fn initial_direction(&self) -> DVec3;

    /// World lengths times this are lengths of the difference; a power of two.
    fn scale(&self) -> f64;
}

/// `A - B` for two placed objects. (The thesis writes "Minkowski sum of A and -B", section 4.2.)
///
/// Space: along the world's axes, in a unit of length that is the power of two just above half the size of the data,
/// so that every coordinate is below 2 whatever unit the caller uses, and no answer depends on it.
/// Positions are relative to the placement of `A`, so that a pair far from the world's origin loses nothing.
pub(crate) struct Difference<'a, A: ?Sized, B: ?Sized> {
    a: &'a A,
    b: &'a B,
    linear_a: DMat3,
    linear_b: DMat3,
    /// The origin of `B` as seen from that of `A`.
    offset: DVec3,
    /// World lengths times this are lengths of the difference; a power of two.
    scale: f64,
}

/// A bound on the error of `v.dot(w) / |v|_1` as the least value along `v` over the difference, in its unit (coordinates
/// are below 2), for a computed support point `w`. Placing a point costs a matrix product and two subtractions, its
/// support mapping some ulps, turning the direction into either local space another product, the choice of the furthest
/// point two scalar products, and the product with `v` one more: together less than 40 roundings of 2^-53 each.
pub(crate) const SUPPORT_ERROR: f64 = 64.0 / (1u64 << 53) as f64;

impl<'a, A: Support + ?Sized, B: Support + ?Sized> Difference<'a, A, B> {
    #[inline(always)]
    pub fn new(a: &'a A, placement_a: &DAffine3, b: &'a B, placement_b: &DAffine3) -> Self {
        let offset = placement_b.translation - placement_a.translation;
        let size = extent(&placement_a.matrix3, a.reach())
            + extent(&placement_b.matrix3, b.reach())
            + offset.abs().max_element();
        let scale = unit_scale(size);
        let (linear_a, linear_b) = (placement_a.matrix3 * scale, placement_b.matrix3 * scale);
        Difference { a, b, linear_a, linear_b, offset: offset * scale, scale }
    }

    /// The same with `B` moved by `v`, in the unit of the difference.
    pub fn moved(&self, v: DVec3) -> Self {
        Difference { offset: self.offset + v, ..*self }
    }

    /// The image of the difference by a linear map.
    pub fn mapped(&self, map: &DMat3) -> Self {
        let (linear_a, linear_b) = (*map * self.linear_a, *map * self.linear_b);
        Difference { linear_a, linear_b, offset: *map * self.offset, ..*self }
    }

    /// A support point in the direction `-v`: where `v` points from `B` to `A`, the point that is least along `v`.
    /// Theorem 4.7 for each of the two objects.
    #[inline]
    pub fn support_against(&self, v: DVec3) -> SupportPoint {
        self.point_against(v, |d| self.a.support(d).into(), |d| self.b.support(d).into())
    }

    /// The same with support mappings of the objects that are inlined.
    #[inline(always)]
    pub fn point_against(
        &self,
        v: DVec3,
        support_a: impl Fn(DVec3) -> Vertex,
        support_b: impl Fn(DVec3) -> Vertex,
    ) -> SupportPoint {
        let a = support_a(self.linear_a.mul_transpose_vec3(-v));
        let b = support_b(self.linear_b.mul_transpose_vec3(v));
        SupportPoint { indices: [a.index, b.index], ..self.point(a.point, b.point) }
    }

    /// The objects.
    pub fn objects(&self) -> (&'a A, &'a B) {
        (self.a, self.b)
    }

    /// The linear maps of both objects into the space of the difference.
    pub fn linear(&self) -> [&DMat3; 2] {
        [&self.linear_a, &self.linear_b]
    }

    /// The point of the difference that a point of each object makes.
    #[inline(always)]
    pub fn point(&self, a: DVec3, b: DVec3) -> SupportPoint {
        let w = (self.linear_a * a - self.linear_b * b) - self.offset;
        SupportPoint { w, a, b, indices: [NO_VERTEX; 2] }
    }

    /// `y.w - x.w`, from the differences of the local points: the error is relative to the edge, not to the positions.
    pub fn edge(&self, x: &SupportPoint, y: &SupportPoint) -> DVec3 {
        self.linear_a * (y.a - x.a) - self.linear_b * (y.b - x.b)
    }

    /// The same as [`edge`](Difference::edge), and the size of the two edges that it is the difference of, whose rounding is its error.
    #[inline]
    pub fn edge_with_size(&self, x: &SupportPoint, y: &SupportPoint) -> (DVec3, f64) {
        let (of_a, of_b) = (self.linear_a * (y.a - x.a), self.linear_b * (y.b - x.b));
        (of_a - of_b, of_a.abs().element_sum() + of_b.abs().element_sum())
    }

    /// Where to start: from the middle of `B` to that of `A`, and along x when they coincide.
    #[inline]
    pub fn initial_direction(&self) -> DVec3 {
        let [a, b] = self.centers();
        start_along(self.point(a, b).w)
    }

    /// Of two parallelepipeds: the half edges of both, those of `A` first, in their local spaces and in that of the difference; and its middle.
    pub fn half_edges(&self) -> Option<([DVec3; 6], [DVec3; 6], DVec3)> {
        let ([a, b, c], [d, e, f]) = (self.a.half_edges()?, self.b.half_edges()?);
        let (of_a, of_b) = (self.linear_a, self.linear_b);
        let [at_a, at_b] = self.centers();
        let placed = [of_a * a, of_a * b, of_a * c, of_b * d, of_b * e, of_b * f];
        Some(([a, b, c, d, e, f], placed, self.point(at_a, at_b).w))
    }

    /// The centres of both objects, each in its local space.
    pub fn centers(&self) -> [DVec3; 2] {
        [self.a.center(), self.b.center()]
    }

    /// Whether it is the hull of finitely many points.
    pub fn is_polytope(&self) -> bool {
        self.a.is_polytope() && self.b.is_polytope()
    }

    /// World lengths times this are lengths of the difference; a power of two.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

impl<A: Support + ?Sized, B: Support + ?Sized> MinkowskiDifference for Difference<'_, A, B> {
    #[inline(always)]
    fn support_against(&self, v: DVec3) -> SupportPoint {
        self.support_against(v)
    }

    #[inline(always)]
    fn point(&self, a: DVec3, b: DVec3) -> SupportPoint {
        self.point(a, b)
    }

    #[inline]
    fn is_polytope(&self) -> bool {
        self.is_polytope()
    }

    fn nearer(&self, points: &[SupportPoint]) -> Option<([Pair; 3], usize)> {
        newton(self, points)
    }

    fn vertices(&self, [i, j]: [u16; 2]) -> Option<[DVec3; 2]> {
        Some([self.a.as_polytope()?.vertex(i), self.b.as_polytope()?.vertex(j)])
    }

    #[inline(always)]
    fn initial_direction(&self) -> DVec3 {
        self.initial_direction()
    }

    #[inline(always)]
    fn scale(&self) -> f64 {
        self.scale
    }
}

/// The first direction of a search, by the way from the middle of `B` to that of `A`.
#[inline(always)]
pub(crate) fn start_along(way: DVec3) -> DVec3 {
    // A branch: the first step does not wait for what hardly any search begins with.
    if way.abs().max_element() > SUPPORT_ERROR { way } else { along_x() }
}

#[cold]
#[inline(never)]
fn along_x() -> DVec3 {
    DVec3::X
}

/// The largest coordinate of the image of a box of half extents `reach`.
#[inline(always)]
fn extent(linear: &DMat3, reach: DVec3) -> f64 {
    let DMat3 { x_axis, y_axis, z_axis } = *linear;
    (x_axis.abs() * reach.x + y_axis.abs() * reach.y + z_axis.abs() * reach.z).max_element()
}
