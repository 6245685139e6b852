use solid3d::convex::Support;
use solid3d::glam::{DAffine3, DVec3};

use super::Polytope;

/// Two placed convex objects, polytopes or others. Space of everything it gives: the world.
#[derive(Debug)]
pub struct Pair<'a, A: ?Sized = Polytope, B: ?Sized = Polytope> {
    /// The first object.
    pub a: &'a A,
    /// From the space of `a` to the world.
    pub placement_a: &'a DAffine3,
    /// The second object.
    pub b: &'a B,
    /// From the space of `b` to the world.
    pub placement_b: &'a DAffine3,
}

/// A point of A-B and the two it is the difference of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SupportPoint {
    /// `p - q`.
    pub w: DVec3,
    /// Of A.
    pub p: DVec3,
    /// Of B.
    pub q: DVec3,
}

impl<A: Support + ?Sized, B: Support + ?Sized> Pair<'_, A, B> {
    /// The support point of A-B along `-v` (thesis, Theorem 4.7).
    pub fn support_against(&self, v: DVec3) -> SupportPoint {
        let p = self
            .placement_a
            .transform_point3(self.a.support(self.placement_a.matrix3.mul_transpose_vec3(-v)));
        let q =
            self.placement_b.transform_point3(self.b.support(self.placement_b.matrix3.mul_transpose_vec3(v)));
        SupportPoint { w: p - q, p, q }
    }

    /// A point of A-B well inside it, where a search may start; never zero.
    pub fn center(&self) -> DVec3 {
        let v = self.placement_a.transform_point3(self.a.center())
            - self.placement_b.transform_point3(self.b.center());
        if v == DVec3::ZERO { DVec3::X } else { v }
    }
}

impl Pair<'_> {
    /// The same as [`support_against`](Pair::support_against), climbing from the vertices found last.
    pub fn climb_against(&self, v: DVec3, vertices: &mut [u32; 2]) -> SupportPoint {
        vertices[0] = self.a.climb(self.placement_a.matrix3.mul_transpose_vec3(-v), vertices[0]);
        vertices[1] = self.b.climb(self.placement_b.matrix3.mul_transpose_vec3(v), vertices[1]);
        let p = self.placement_a.transform_point3(self.a.vertices()[vertices[0] as usize]);
        let q = self.placement_b.transform_point3(self.b.vertices()[vertices[1] as usize]);
        SupportPoint { w: p - q, p, q }
    }
}
