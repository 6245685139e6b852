//! The contacts of two shapes: all points where their surfaces meet, or are in each other.
//!
//! Of two convex bodies: the normal is that of the penetration depth, or of the closest points of what is apart; the faces of
//! both that lie across it are clipped against each other ([`clip`](mod@clip)), and each corner of what they have in common is a contact, as deep as
//! the surfaces overlap there along the normal. The deepest point is always among them.
//!
//! Of meshes and complex shapes: the contacts of all pairs of primitives, each with a normal that the surface around the
//! primitive has ([`side`]), put together where the surface is connected and the normal the same ([`joining`], [`region`]).
//!
//! Everything is computed in a common frame around the pair: lengths near 1, so that tolerances are relative to the shapes.

mod ball;
mod clip;
mod cover;
mod difference;
mod face;
mod inside;
mod joining;
mod leaving;
mod map;
mod one_point;
mod other;
mod outline;
mod overhang;
mod own_feature;
mod places;
mod planes;
mod region;
mod ridge;
mod ring;
mod side;
mod soup;
mod soup_body;
mod standing;
mod stars;
mod through;
#[cfg(test)]
mod ways;

use glam::{DVec2, DVec3};
use smallvec::SmallVec;
use solid_convex::{Penetration, Support, Witness, epa, gjk};

use super::approach::is_solid;
use super::depth::of_common;
use super::frame::{Around, Frame};
use super::reach::reach;
use super::{Placed, Scratch, closed_form, table, world_bounds};
use crate::shape::{Body, Class, Complex};
use clip::{Origin, clip};
use face::Face;
use map::Map;
use outline::Outline;
use soup_body::soup_body;

/// A part of the surface of a shape. Its number stays with the shape however it moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// A vertex: by its place in [`Shape::vertices`](crate::Shape::vertices); of a box, of the rims of cones and cylinders and of
    /// the ends of capsules by a number of its own.
    Vertex(u32),
    /// An edge between two vertices, the lesser first.
    Edge(u32, u32),
    /// A face, by a number of its own; of a mesh, the front (0) or back (1) of a triangle.
    Face(u32),
}

impl Feature {
    /// The edge between two vertices, in either order.
    fn edge(i: u32, j: u32) -> Feature {
        Feature::Edge(i.min(j), i.max(j))
    }
}

/// A point of contact of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The point of the first shape. Space: world.
    pub point_on_a: DVec3,
    /// The point of the second shape, off the first by the depth along the normal; to within 0.001 of the depth where a region joins
    /// normals, which differ by up to 0.001 rad. Space: world.
    pub point_on_b: DVec3,
    /// How deep the surfaces are in each other here, along the normal; negative for a gap. World units.
    pub depth: f64,
    /// The primitive of each shape; 0 for a convex shape.
    pub primitives: [u32; 2],
    /// The part of each primitive that the point is of. With `primitives` it names the contact from frame to frame.
    pub features: [Feature; 2],
}

/// Contacts of two shapes that have one normal: a region of their surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifold {
    /// The unit normal, from `b` to `a`. Space: world.
    pub normal: DVec3,
    /// The points, at least one. Corners of the region in which the surfaces face each other. One alone, as a ball always has, takes no memory of its own.
    pub points: SmallVec<[ContactPoint; 1]>,
}

/// Which contacts are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactOptions {
    /// Surfaces that are apart by no more than this are in contact, with a negative depth: what a solver needs to stop them in time. At
    /// least 0; 0 by default. World units.
    pub margin: f64,
    /// The most points of a manifold: the deepest, and those furthest from it and each other. At least one is kept. `None`, which is the
    /// default, for all of them. Cost: the product of how many there are and how many are kept.
    pub max_points: Option<usize>,
}

/// Depths this far apart are the same, in the unit of the pair: above the error of the depth of polytopes.
const SAME_DEPTH: f64 = 1e-10;

/// The error of the depth of a curved body, relative to it.
const DEPTH_ERROR: f64 = 4.0 * epa::DEPTH_TOLERANCE;

/// Closest points nearer to each other than this, in the unit of the pair, give a direction of few digits. A separating axis is better where it is that
/// direction up to those: across what is flat or straight it can only be off by their distance over the extent. At corners it may be any.
const NEAR: f64 = 1e-9;

/// A contact in the common frame.
#[derive(Clone, Copy, Debug)]
struct Touch {
    on_a: DVec3,
    on_b: DVec3,
    depth: f64,
    primitives: [u32; 2],
    features: [Feature; 2],
}

/// The contacts of a pair of primitives, at least one. Space: common.
struct Patch {
    normal: DVec3,
    touches: Vec<Touch>,
    /// Whether the normal points into a solid: what is on the wrong side of a wall of it.
    is_inward: bool,
}

/// How two convex bodies lie to each other.
#[derive(Clone, Copy)]
struct Meeting {
    /// From `b` to `a`, unit.
    normal: DVec3,
    /// How far the normal may be off by the rounding of closest points; 0 of any other.
    tilt: f64,
    /// Negative for a gap. Space: common.
    depth: f64,
    /// The deepest point of each, or the closest. Space: common.
    on_a: DVec3,
    on_b: DVec3,
}

impl Meeting {
    /// Of what is known to have a common point.
    fn touching(self) -> Meeting {
        Meeting { depth: self.depth.max(0.0), ..self }
    }

    /// `None` for what is further apart than a margin.
    fn within(self, margin: f64) -> Option<Meeting> {
        (self.depth >= -margin).then_some(self)
    }
}

/// Of what lies to each other in some ways the deepest, the first of several.
fn deepest<T>(meetings: impl Iterator<Item = (T, Meeting)>) -> Option<(T, Meeting)> {
    meetings.reduce(|most, other| if other.1.depth > most.1.depth { other } else { most })
}

/// A pair in its common frame.
struct Pair<'a> {
    a: Placed<'a>,
    b: Placed<'a>,
    /// Where their contacts are.
    frame: Around,
    /// Those of `a` and `b` to that frame.
    maps: [Map; 2],
    /// Space: common.
    margin: f64,
}

/// A shape as contacts see it.
enum Part<'a> {
    Body(Body<'a>, &'a dyn Support),
    Soup(&'a Complex),
}

/// The contacts of two shapes that have one, known in closed form, and plain sizes; `None` of others. Placements need not have been checked: those of an
/// answer are good.
#[inline(always)]
pub(crate) fn quick_contact(a: Placed, b: Placed) -> Option<Manifold> {
    one_point::quick_contact(a, b)
}

/// All contacts of two shapes, where [`quick_contact`] says nothing.
pub(crate) fn contacts_closely(
    a: Placed,
    b: Placed,
    options: &ContactOptions,
    scratch: &mut Scratch,
) -> Vec<Manifold> {
    if let Some(contact) = one_point::contact(a, b) {
        return vec![contact];
    }
    let is_convex = |of: Placed| matches!(of.shape.class(), Class::Convex(_));
    if is_convex(a) && is_convex(b) {
        return contact_of_bodies(a, b, options).into_iter().collect();
    }
    contacts_at_length(a, b, options, scratch)
}

/// The same of two convex shapes.
fn contact_of_bodies(a: Placed, b: Placed, options: &ContactOptions) -> Option<Manifold> {
    let pair = Pair::new(a, b, options.margin);
    let Patch { normal, touches, .. } = pair.patch_of_bodies(&part(a), &part(b))?;
    Some(pair.manifold(normal, touches, options))
}

/// The same, of all shapes.
#[inline(never)]
fn contacts_at_length(
    a: Placed,
    b: Placed,
    options: &ContactOptions,
    scratch: &mut Scratch,
) -> Vec<Manifold> {
    let (mut part_a, mut part_b) = (part(a), part(b));
    let pair = Pair::new(a, b, options.margin);
    // A surface that is taken for the body it bounds does not collide with what is inside.
    let hollow = is_hollow(a) || is_hollow(b);
    let apart = |scratch: &mut _| !table::intersects(a, b, scratch);
    if hollow && options.margin == 0.0 && apart(scratch) {
        return Vec::new();
    }
    let mut patches = pair.patches(&part_a, &part_b, scratch);
    // What is apart has a normal of each surface between them, and none that leads through one, as what is inside of a hollow one may have or miss.
    let is_doubtful = patches.iter().any(Patch::is_deep) || hollow && patches.is_empty();
    if options.margin > 0.0 && is_doubtful && apart(scratch) {
        if hollow {
            (part_a, part_b) = (surface(a), surface(b));
            patches = pair.patches(&part_a, &part_b, scratch);
        }
        patches.retain(|patch| !patch.is_deep());
    }
    if patches.iter().any(|patch| !patch.is_inward) {
        patches.retain(|patch| !patch.is_inward);
    }
    // Nothing touches what is wholly inside a solid; with a margin there may be walls near it, from the wrong side.
    let is_inside = |scratch: &mut _| [a, b].iter().any(is_solid) && !apart(scratch);
    if !patches.iter().any(Patch::touches) && (patches.is_empty() || is_inside(scratch)) {
        patches = soup::whole(&pair, scratch).into_iter().collect();
    }
    let regions = region::regions(&part_a, &part_b, patches);
    regions.into_iter().map(|region| pair.manifold(region.normal, region.points, options)).collect()
}

/// What a shape is in contact with: of a closed convex mesh the body that it bounds.
fn part<'a>(placed: Placed<'a>) -> Part<'a> {
    match placed.shape.class() {
        Class::Convex(support) => Part::Body(placed.shape.body().expect("a convex shape is a body"), support),
        Class::Complex(complex) => match &complex.topology().enclosed().convex {
            Some((hull, vertices)) => Part::Body(Body::Hull { hull, names: Some(vertices) }, hull.polytope()),
            None => Part::Soup(complex),
        },
    }
}

/// The same, of a surface without an inside the triangles, whether they bound a body or not.
fn surface<'a>(placed: Placed<'a>) -> Part<'a> {
    match placed.shape.class() {
        Class::Complex(complex) if !complex.is_solid() => Part::Soup(complex),
        _ => part(placed),
    }
}

/// Whether a surface without an inside counts as the body that it bounds.
fn is_hollow(placed: Placed) -> bool {
    !placed.shape.is_solid() && matches!(part(placed), Part::Body(..))
}

impl Patch {
    /// Whether the surfaces are together here.
    fn touches(&self) -> bool {
        self.touches.iter().any(|touch| touch.depth >= -SAME_DEPTH)
    }

    /// Whether the surfaces are in each other here.
    fn is_deep(&self) -> bool {
        self.touches.iter().any(|touch| touch.depth > SAME_DEPTH)
    }
}

impl<'a> Pair<'a> {
    /// With a margin in world units.
    fn new(a: Placed<'a>, b: Placed<'a>, margin: f64) -> Self {
        let frame = Around::new(
            [a.placement, b.placement],
            [reach(a.shape), reach(b.shape)],
            [world_bounds(a), world_bounds(b)],
        );
        let (maps, margin) = (frame.common.map(Map::new), margin * frame.scale);
        Pair { a, b, frame, maps, margin }
    }

    /// A point of each shape in the common frame.
    fn placed(&self, points: Witness) -> [DVec3; 2] {
        let [from_a, from_b] = &self.maps;
        [from_a.point(points.on_a), from_b.point(points.on_b)]
    }

    /// How the two spaces lie to each other, as it is seen where it is decided which primitives meet, here as everywhere.
    fn placing(&self) -> Frame {
        let Pair { a, b, .. } = self;
        Frame::new(a.placement, reach(a.shape), b.placement, reach(b.shape))
    }

    fn patches(&self, a: &Part, b: &Part, scratch: &mut Scratch) -> Vec<Patch> {
        match (a, b) {
            (Part::Body(..), Part::Body(..)) => self.patch_of_bodies(a, b).into_iter().collect(),
            (Part::Soup(_), Part::Body(..)) => soup_body(self, a, b, false, scratch),
            (Part::Body(..), Part::Soup(_)) => soup_body(self, b, a, true, scratch),
            (Part::Soup(of_a), Part::Soup(of_b)) => soup::soup_soup(self, of_a, of_b, scratch),
        }
    }

    /// The contacts of two bodies; `None` when they are further apart than the margin.
    fn patch_of_bodies(&self, a: &Part, b: &Part) -> Option<Patch> {
        let (Part::Body(kind_a, of_a), Part::Body(kind_b, of_b)) = (a, b) else { return None };
        let meeting = self.meeting_of_bodies(*of_a, *of_b)?;
        let [map_a, map_b] = &self.maps;
        let (placed_a, placed_b) = (face::Placed::new(kind_a, map_a), face::Placed::new(kind_b, map_b));
        let touches = self.touches(&placed_a, &placed_b, &meeting);
        Some(Patch { normal: meeting.normal, touches, is_inward: false })
    }

    fn manifold(&self, normal: DVec3, mut points: Vec<Touch>, options: &ContactOptions) -> Manifold {
        if let Some(most) = options.max_points {
            region::reduce(&mut points, normal, most.max(1));
        }
        let points = points.into_iter().map(|touch| ContactPoint {
            point_on_a: self.frame.to_world(touch.on_a),
            point_on_b: self.frame.to_world(touch.on_b),
            depth: touch.depth / self.frame.scale,
            primitives: [self.owner(self.a, touch.primitives[0]), self.owner(self.b, touch.primitives[1])],
            features: touch.features,
        });
        Manifold { normal, points: points.collect() }
    }

    /// The user's primitive.
    fn owner(&self, placed: Placed, primitive: u32) -> u32 {
        match placed.shape.class() {
            Class::Complex(complex) => complex.owner(primitive),
            Class::Convex(_) => 0,
        }
    }

    /// How the shapes lie to each other, of which these are the bodies; `None` when they are further apart than the margin.
    fn meeting_of_bodies(&self, a: &dyn Support, b: &dyn Support) -> Option<Meeting> {
        let of_any = || epa::penetration(a, self.a.placement, b, self.b.placement);
        self.meeting_by(closed_form::penetration(self.a, self.b).or_else(of_any), a, b)
    }

    /// How two primitives lie to each other; `None` when they are further apart than the margin. `must` says that they are known
    /// to have a common point.
    fn meeting(&self, a: &dyn Support, b: &dyn Support, must: bool) -> Option<Meeting> {
        let (at_a, at_b) = (self.a.placement, self.b.placement);
        let found =
            if must { Some(of_common((a, at_a), (b, at_b))) } else { epa::penetration(a, at_a, b, at_b) };
        self.meeting_by(found, a, b)
    }

    /// The same by how deep they are in each other, if they are.
    fn meeting_by(&self, found: Option<Penetration>, a: &dyn Support, b: &dyn Support) -> Option<Meeting> {
        let (at_a, at_b) = (self.a.placement, self.b.placement);
        if let Some(found) = found {
            let [on_a, on_b] = self.placed(found.points);
            let depth = found.depth * self.frame.scale;
            return Some(Meeting { normal: found.direction, tilt: 0.0, depth, on_a, on_b });
        }
        if self.margin == 0.0 {
            return None;
        }
        let closest = gjk::closest_points(a, at_a, b, at_b);
        let distance = closest.distance * self.frame.scale;
        if distance > self.margin {
            return None;
        }
        let [on_a, on_b] = self.placed(closest.points);
        let between = (on_a - on_b).try_normalize();
        // Each end of the way is off by that; unit vectors never by more than 2.
        let tilt = (2.0 * self.frame.rounding / distance).min(2.0);
        let is_between = |axis: &DVec3| between.is_none_or(|between| between.distance(*axis) <= tilt);
        let axis = || match gjk::intersection(a, at_a, b, at_b) {
            gjk::Outcome::Separated { axis } => Some(axis).filter(is_between),
            _ => None,
        };
        let axis = if distance < NEAR { axis() } else { None };
        let (normal, tilt) = match axis {
            Some(axis) => (axis, 2.0 * tilt),
            None => (between?, tilt),
        };
        Some(Meeting { normal, tilt, depth: -distance, on_a, on_b })
    }

    /// The contacts of two bodies along their normal, the deepest point among them.
    fn touches(&self, a: &face::Placed, b: &face::Placed, meeting: &Meeting) -> Vec<Touch> {
        let Meeting { normal, depth, on_a, on_b, .. } = *meeting;
        let primitives = [a.primitive, b.primitive];
        let deepest = |features| Touch { on_a, on_b, depth, primitives, features };
        if a.is_ball() || b.is_ball() {
            return vec![deepest([touched(a, -normal), touched(b, normal)])];
        }
        let mut face_a = a.face(-normal);
        let mut face_b = b.face(normal);
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
    fn touch(
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
fn touched(body: &face::Placed, direction: DVec3) -> Feature {
    if body.is_ball() {
        return Feature::Vertex(0);
    }
    let mut face = body.face(direction);
    if !face.is_aligned() {
        face.slim(direction);
    }
    face.feature()
}
