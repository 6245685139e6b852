//! The contacts of two convex bodies along a normal: the faces that lie across it, clipped against each other.

use glam::{DVec2, DVec3};
use solid_convex::epa;

use super::clip::{self, Origin, clip};
use super::face::{self, Face};
use super::meeting::Meeting;
use super::outline::Outline;
use super::{Feature, Pair, Part, Patch, SAME_DEPTH, Touch};

/// The error of the depth of a curved body, relative to it.
pub(super) const DEPTH_ERROR: f64 = 4.0 * epa::DEPTH_TOLERANCE;

impl Pair<'_> {
    /// The contacts of two bodies; `None` when they are further apart than the margin.
    pub(super) fn patch_of_bodies(&self, a: &Part, b: &Part) -> Option<Patch> {
        let (Part::Body(kind_a, of_a), Part::Body(kind_b, of_b)) = (a, b) else { return None };
        let meeting = self.meeting_of_bodies(*of_a, *of_b)?;
        let [map_a, map_b] = &self.maps;
        let (placed_a, placed_b) = (face::Placed::new(kind_a, map_a), face::Placed::new(kind_b, map_b));
        let touches = self.touches(&placed_a, &placed_b, &meeting);
        Some(Patch { normal: meeting.normal, touches, is_inward: false })
    }

    /// The contacts of two bodies along their normal, the deepest point among them.
    pub(super) fn touches(&self, a: &face::Placed, b: &face::Placed, meeting: &Meeting) -> Vec<Touch> {
        let Meeting { normal, depth, on_a, on_b, .. } = *meeting;
        let primitives = [a.primitive, b.primitive];
        let deepest = |features| Touch { on_a, on_b, depth, primitives, features };
        if a.is_ball() || b.is_ball() {
            return vec![deepest([touched(a, -normal), touched(b, normal)])];
        }
        let mut face_a = a.face_beside(-normal, b);
        let mut face_b = b.face_beside(normal, a);
        leave_across(&mut face_a, &mut face_b, normal);
        let mut touches = self.clipped(a, &face_a, b, &face_b, normal);
        let error = SAME_DEPTH + DEPTH_ERROR * depth.abs();
        // Nothing is deeper along the normal; but a face is flat only up to what is a length to a much smaller body.
        for touch in touches.iter_mut().filter(|touch| touch.depth > depth + error) {
            touch.on_b -= normal * (touch.depth - depth);
            touch.depth = depth;
        }
        if touches.iter().all(|touch| touch.depth < depth - error) {
            touches.push(deepest([face_a.feature(), face_b.feature()]));
        }
        touches
    }

    /// The corners of what two faces have in common, seen along a normal from `b` to `a`, that are within the margin.
    fn clipped(
        &self,
        a: &face::Placed,
        face_a: &Face,
        b: &face::Placed,
        face_b: &Face,
        normal: DVec3,
    ) -> Vec<Touch> {
        let (u, v) = normal.any_orthonormal_pair();
        // Around a point of the contact, so that what is far away does not cost digits.
        let origin = face_a.corners[0].point;
        let flat = |point: DVec3| DVec2::new(u.dot(point - origin), v.dot(point - origin));
        let (seen_a, seen_b) = (Outline::new(face_a, flat), Outline::new(face_b, flat));
        let base = origin - normal * origin.dot(normal);
        let corners = clip(&seen_a.polygon, &seen_b.polygon);
        let mut touches = Vec::with_capacity(corners.len());
        for clip::Clipped { at, origin } in &corners {
            let features = || match *origin {
                Origin::OfA(i) => [seen_a.vertex(i), face_b.feature()],
                Origin::OfB(j) => [face_a.feature(), seen_b.vertex(j)],
                Origin::Crossing(i, j) => [seen_a.edge(i), seen_b.edge(j)],
            };
            let at = base + u * at.x + v * at.y;
            if let Some(touch) = self.touch([(a, face_a), (b, face_b)], normal, at, features) {
                touches.push(touch);
            }
        }
        touches
    }

    /// The contact of two faces on the line along a normal through a point of the plane across that through the origin; `None` where one is not on it, or they
    /// are further apart than the margin.
    #[inline(always)]
    pub(super) fn touch(
        &self,
        [(a, face_a), (b, face_b)]: [(&face::Placed, &Face); 2],
        normal: DVec3,
        at: DVec3,
        features: impl FnOnce() -> [Feature; 2],
    ) -> Option<Touch> {
        let height_a = a.height(face_a, at, normal, -normal)?;
        let height_b = b.height(face_b, at, normal, normal)?;
        let depth = height_b - height_a;
        let (on_a, on_b) = (at + normal * height_a, at + normal * height_b);
        let primitives = [a.primitive, b.primitive];
        let is_within = depth >= -self.margin - SAME_DEPTH;
        is_within.then(|| Touch { on_a, on_b, depth, primitives, features: features() })
    }

    /// The contacts along a normal, given from `b` to `a`, that may not be that of the deepest point.
    pub(super) fn across(&self, a: &face::Placed, b: &face::Placed, normal: DVec3) -> Vec<Touch> {
        let mut face_a = a.face_beside(-normal, b);
        let mut face_b = b.face_beside(normal, a);
        leave_across(&mut face_a, &mut face_b, normal);
        self.clipped(a, &face_a, b, &face_b, normal)
    }

    /// The contacts over a triangle along its own normal, given from `b` to `a`; `of_a` says whose it is.
    pub(super) fn over(&self, a: &face::Placed, b: &face::Placed, normal: DVec3, of_a: bool) -> Vec<Touch> {
        let mut face_a = a.face_beside(-normal, b);
        let mut face_b = b.face_beside(normal, a);
        let other = if of_a { &mut face_b } else { &mut face_a };
        if !other.is_faced() {
            let along = if of_a { normal } else { -normal };
            other.slim(along);
        }
        self.clipped(a, &face_a, b, &face_b, normal)
    }
}

/// Leaves of the two faces that face each other along a normal what lies across it: all of both, when one is aligned with it, else their edges and corners.
fn leave_across(face_a: &mut Face, face_b: &mut Face, normal: DVec3) {
    let across = face_a.is_aligned() || face_b.is_aligned();
    for (face, direction) in [(face_a, -normal), (face_b, normal)] {
        if !(across && face.is_faced()) {
            face.slim(direction);
        }
    }
}

/// What of a body a ball touches, on the side that faces a direction: of a ball it is the one point.
pub(super) fn touched(body: &face::Placed, direction: DVec3) -> Feature {
    if body.is_ball() {
        return Feature::Vertex(0);
    }
    let mut face = body.face(direction);
    if !face.is_aligned() {
        face.slim(direction);
    }
    face.feature()
}
