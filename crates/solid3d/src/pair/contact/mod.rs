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
mod bodies;
mod clip;
mod cover;
mod difference;
mod face;
mod inside;
mod joining;
mod leaving;
mod manifold;
mod map;
mod meeting;
mod near_pairs;
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
mod whole;

use glam::DVec3;
use solid_convex::{Support, Witness};

use super::approach::is_solid;
use super::frame::{Around, Frame};
use super::reach::reach;
use super::{Placed, Scratch, table, world_bounds};
use crate::shape::{Body, Class, Complex};
pub use manifold::{ContactOptions, ContactPoint, Feature, Manifold};
use map::Map;
use soup_body::soup_body;

/// Depths this far apart are the same, in the unit of the pair: above the error of the depth of polytopes.
const SAME_DEPTH: f64 = 1e-10;

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
        patches = whole::whole(&pair, scratch).into_iter().collect();
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

    /// The margin in a frame, and in the local spaces of the two.
    fn margins(&self, placing: &Frame) -> (f64, [f64; 2]) {
        let margin = self.margin / self.frame.scale * placing.scale;
        (margin, placing.stretch().map(|stretch| margin / stretch.least))
    }

    fn patches(&self, a: &Part, b: &Part, scratch: &mut Scratch) -> Vec<Patch> {
        match (a, b) {
            (Part::Body(..), Part::Body(..)) => self.patch_of_bodies(a, b).into_iter().collect(),
            (Part::Soup(_), Part::Body(..)) => soup_body(self, a, b, false, scratch),
            (Part::Body(..), Part::Soup(_)) => soup_body(self, b, a, true, scratch),
            (Part::Soup(of_a), Part::Soup(of_b)) => soup::soup_soup(self, of_a, of_b, scratch),
        }
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
}
