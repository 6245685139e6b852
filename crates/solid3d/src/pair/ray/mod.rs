//! Rays against shapes: a row of the table with one column. Convex shapes by closed forms where there are any, else by the
//! GJK cast of a point ([`convex`]); complex shapes by their trees ([`complex`]), their triangles watertight ([`triangle`]) after a glance at
//! images of them ([`glance`]).

mod complex;
mod convex;
mod glance;
mod triangle;

use std::collections::BTreeSet;

pub(crate) use convex::first_hit;
use glam::{DMat3, DVec3};

use super::{Placed, Scratch};
use crate::error::{Error, Result, at_least_zero, bounded};
use crate::placement::direction;
use crate::shape::Class;
use solid_convex::MAGNITUDE_MIN;

/// A ray or a segment: the points `origin + t * direction` of the world for `t` from 0 to `max`.
///
/// ```
/// use solid3d::{glam::DVec3, query::Ray};
/// let ray = Ray::new(DVec3::ZERO, DVec3::X * 2.0); // endless
/// assert_eq!(ray.at(1.5), DVec3::X * 3.0);
/// assert_eq!(Ray::segment(DVec3::ONE, DVec3::Y).at(1.0), DVec3::Y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes: the unit of `t`. Of any length, but with a coordinate of at least 1e-100 in magnitude.
    pub direction: DVec3,
    /// The greatest `t`: at least 0, perhaps infinite.
    pub max: f64,
}

impl Ray {
    /// An endless ray.
    pub fn new(origin: DVec3, direction: DVec3) -> Ray {
        Ray { origin, direction, max: f64::INFINITY }
    }

    /// The segment between two points; `t` is 1 at the second.
    pub fn segment(from: DVec3, to: DVec3) -> Ray {
        Ray { origin: from, direction: to - from, max: 1.0 }
    }

    /// The same ray up to another `max`.
    pub fn until(self, max: f64) -> Ray {
        Ray { max, ..self }
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The ray itself when it can be cast.
    pub(crate) fn checked(&self) -> Result<&Ray> {
        bounded("ray.origin", self.origin)?;
        bounded("ray.direction", self.direction)?;
        if self.direction.abs().max_element() < MAGNITUDE_MIN {
            return Err(Error::NoDirection { argument: "ray.direction", value: self.direction });
        }
        at_least_zero("ray.max", self.max)?;
        Ok(self)
    }
}

/// Which sides of a surface a ray hits. The front of a triangle is the side from which its corners run counterclockwise, in the
/// shape's own space; that of a convex shape is its outside. A triangle that is seen edge on shows both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Faces {
    /// Both.
    #[default]
    Both,
    /// Fronts only: rays come out through back faces.
    Front,
    /// Backs only.
    Back,
}

impl Faces {
    fn includes(self, back: bool) -> bool {
        match self {
            Faces::Both => true,
            Faces::Front => !back,
            Faces::Back => back,
        }
    }
}

/// What a ray does that starts inside of a solid: a convex shape, a solid mesh, or a convex primitive of a complex shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FromInside {
    /// It hits at once, at `t` = 0, whatever [`Faces`] says: so that a ray hits a shape if and only if it has a point of it.
    #[default]
    Hits,
    /// It hits surfaces alone.
    Passes,
}

/// What counts as a hit.
///
/// ```
/// use solid3d::{Shape, glam::{DAffine3, DVec3}, query::{self, FromInside, Ray, RayOptions}};
/// let (ball, here) = (Shape::sphere(1.0)?, DAffine3::IDENTITY);
/// let ray = Ray::new(DVec3::ZERO, DVec3::X);
/// let hit = query::cast_ray(&ball, &here, &ray, &RayOptions::default())?.unwrap();
/// assert_eq!((hit.t, hit.surface), (0.0, None));
/// let options = RayOptions { from_inside: FromInside::Passes, ..RayOptions::default() };
/// let hit = query::cast_ray(&ball, &here, &ray, &options)?.unwrap();
/// assert!(hit.t == 1.0 && hit.surface.unwrap().back);
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct RayOptions {
    /// Which sides of surfaces.
    pub faces: Faces,
    /// What starts inside of a solid.
    pub from_inside: FromInside,
}

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Where on the ray: from 0 to its `max`, in units of its direction.
    pub t: f64,
    /// The point. Space: world.
    pub point: DVec3,
    /// The surface there; `None` where the ray starts inside of a solid.
    pub surface: Option<SurfaceHit>,
}

impl RayHit {
    #[inline(always)]
    fn on(ray: &Ray, t: f64, surface: Option<SurfaceHit>) -> RayHit {
        // A negative zero would come before zero in the order of all hits.
        RayHit { t: t + 0.0, point: ray.at(t), surface }
    }
}

/// The surface that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// The normal on the side that the ray comes from, a unit vector. Space: world.
    pub normal: DVec3,
    /// Whether that side is the back.
    pub back: bool,
    /// The primitive of a mesh or a complex shape, in the order in which they were given; 0 for a convex shape.
    pub primitive: u32,
    /// The weights of a triangle's corners that give the point, for triangles; they sum to 1. A polygon of more corners has none.
    pub barycentric: Option<[f64; 3]>,
}

/// Which hits are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// The one with the least `t`; of equal ones that of the first primitive.
    First,
    /// Whichever is found first.
    Any,
    /// All.
    All,
}

/// The hits of a ray so far.
pub(crate) struct Hits<'r> {
    pub ray: &'r Ray,
    pub options: &'r RayOptions,
    pub wanted: Wanted,
    /// The greatest `t` that is still of interest; negative when nothing is.
    pub until: f64,
    /// The best, or the last.
    pub found: Option<RayHit>,
    /// All, when all are wanted.
    all: Vec<RayHit>,
}

impl<'r> Hits<'r> {
    pub fn new(ray: &'r Ray, options: &'r RayOptions, wanted: Wanted) -> Self {
        Hits { ray, options, wanted, until: ray.max, found: None, all: Vec::new() }
    }

    /// Whether a hit on the surface is of interest.
    #[inline]
    fn wants(&self, t: f64, primitive: u32) -> bool {
        let first = match (self.wanted, &self.found) {
            (Wanted::First, Some(best)) => {
                t < best.t || best.surface.is_some_and(|surface| primitive < surface.primitive)
            }
            _ => true,
        };
        (0.0..=self.until).contains(&t) && first
    }

    #[inline]
    fn add(&mut self, t: f64, surface: Option<SurfaceHit>) {
        let hit = RayHit::on(self.ray, t, surface);
        match self.wanted {
            // Nothing comes before what has no surface.
            Wanted::First => self.until = if surface.is_some() { t } else { -1.0 },
            Wanted::Any => self.until = -1.0,
            Wanted::All => self.all.push(hit),
        }
        self.found = Some(hit);
    }

    /// The ray starts inside of a solid.
    fn add_inside(&mut self) {
        if self.options.from_inside == FromInside::Hits && self.until >= 0.0 {
            self.add(0.0, None);
        }
    }

    /// A polygon that was cut has one hit, that of the piece which is hit first; no weights are told of corners that were not given as a triangle's.
    fn put_together(&mut self, is_cut: impl Fn(u32) -> bool) {
        self.sort();
        let mut met = BTreeSet::new();
        self.all.retain(|hit| {
            hit.surface.is_none_or(|SurfaceHit { primitive, .. }| !is_cut(primitive) || met.insert(primitive))
        });
        let surfaces = self.all.iter_mut().chain(&mut self.found).filter_map(|hit| hit.surface.as_mut());
        surfaces.filter(|surface| is_cut(surface.primitive)).for_each(|surface| surface.barycentric = None);
    }

    fn sort(&mut self) {
        let primitive = |hit: &RayHit| hit.surface.map(|surface| surface.primitive);
        self.all.sort_by(|x, y| x.t.total_cmp(&y.t).then(primitive(x).cmp(&primitive(y))));
    }

    /// All in order.
    pub fn sorted(mut self) -> Vec<RayHit> {
        self.sort();
        self.all
    }
}

/// Finds where a ray meets a shape.
pub(crate) fn ray_hits(placed: Placed, hits: &mut Hits, scratch: &mut Scratch) {
    match placed.shape.class() {
        Class::Convex(shape) => convex::hits(placed, shape, hits),
        Class::Complex(shape) => complex::hits(placed, shape, hits, scratch),
    }
}

/// The normal on the side that a ray comes from, by that of the front.
///
/// Of the world: turned round before a placement takes it along, a zero may have another sign.
#[inline(always)]
fn facing(front: DVec3, back: bool) -> DVec3 {
    if back { -front } else { front }
}

/// The world's unit normal of a surface that has a normal in local space; `None` where that is zero.
fn world_normal(to_local: &DMat3, normal: DVec3) -> Option<DVec3> {
    // Normals go by the inverse transpose. Its entries may be so large or small that their squares are not numbers.
    direction(to_local.transpose() * normal)
}
