//! An object: an instance of a shape at a place.

use fearless_simd::Simd;
use glam::{DAffine3, DVec3};
use solid_convex::simd::dispatch;

use super::{Boxes, Motion};
use crate::bounds::Aabb;
use crate::error::Result;
use crate::pair::swept::{Moving, deformation, moving_bounds};
use crate::pair::{Placed, fixed_bounds, world_bounds, world_bounds_into};
use crate::shape::Shape;

slotmap::new_key_type! {
    /// An object of a world. The id of a removed object never comes back. Worlds number their objects alike: in another world, but for a copy, an id
    /// may name another object.
    pub struct ObjectId;
}

/// The bits of a place in the creation order: more than any machine will count to.
const RANK_SHIFT: u32 = 56;

/// An object.
#[derive(Clone, Debug)]
pub(super) struct Object {
    /// Its place in the order of pairs and their results: by rank, then by creation.
    pub order: u64,
    pub shape: Shape,
    pub placement: DAffine3,
    /// Where it was in the previous frame, if it is displaced; else memory to be used again. What never moved has none.
    previous_placement: Option<Box<DAffine3>>,
    /// What most objects do without.
    extra: Option<Box<Extra>>,
    /// Whether its way from the previous frame is tested.
    motion: Motion,
    /// Whether the previous frame is another.
    pub displaced: bool,
    /// How many pair responses were set for it and not reset; some may be for objects that were removed since.
    pub pair_responses: u32,
}

/// What an object has whose shape changed, or whose box is of a fixed size.
#[derive(Clone, Debug)]
struct Extra {
    /// The shape of the previous frame, if it is another.
    previous_shape: Option<Shape>,
    /// The shape of the frame before the previous one, whose memory the next deformation takes.
    spare: Option<Shape>,
    /// How its vertices moved on its way from the previous frame; see [`deformation`].
    deformation: Aabb,
    /// The radius about the local origin, when its box in the broad phase is to have a fixed size.
    radius: Option<f64>,
}

impl Default for Extra {
    fn default() -> Self {
        Extra { previous_shape: None, spare: None, deformation: STILL, radius: None }
    }
}

impl Extra {
    /// What is now, of this shape, becomes the previous frame.
    #[inline(never)]
    fn proceed(&mut self, shape: &Shape) {
        self.deformation = STILL;
        if let Some(old) = self.previous_shape.take()
            && old.is_deformation_of(shape)
        {
            self.spare = Some(old);
        }
    }
}

impl Object {
    pub fn new(
        rank: u8,
        serial: u64,
        shape: Shape,
        placement: DAffine3,
        motion: Motion,
        boxes: Boxes,
    ) -> Self {
        let radius = radius(&shape, boxes);
        Object {
            order: (u64::from(rank) << RANK_SHIFT) | serial,
            motion,
            shape,
            placement,
            previous_placement: None,
            extra: radius.map(|_| Box::new(Extra { radius, ..Extra::default() })),
            displaced: false,
            pair_responses: 0,
        }
    }

    /// Its place in the creation order.
    pub fn serial(&self) -> u64 {
        self.order & ((1 << RANK_SHIFT) - 1)
    }

    /// As it is.
    pub fn placed(&self) -> Placed<'_> {
        Placed { shape: &self.shape, placement: &self.placement }
    }

    /// As it was in the previous frame.
    pub fn previously_placed(&self) -> Placed<'_> {
        Placed { shape: self.previous_shape(), placement: self.previous_placement() }
    }

    fn previous_shape(&self) -> &Shape {
        self.extra.as_ref().and_then(|extra| extra.previous_shape.as_ref()).unwrap_or(&self.shape)
    }

    fn previous_placement(&self) -> &DAffine3 {
        self.previous_placement.as_deref().filter(|_| self.displaced).unwrap_or(&self.placement)
    }

    /// On its way from the previous frame; nowhere else than it is when only that is tested, or when it stood still.
    pub fn moving(&self) -> Moving<'_> {
        let from = if self.has_way() {
            Placed { shape: self.shape_on_way(), placement: self.previous_placement() }
        } else {
            self.placed()
        };
        let deformation = self.extra.as_ref().map_or(STILL, |extra| extra.deformation);
        Moving { from, to: self.placed(), deformation }
    }

    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Whether there is a way from the previous frame to be tested.
    #[inline]
    pub fn has_way(&self) -> bool {
        self.motion == Motion::Swept && self.displaced && self.has_moved()
    }

    #[inline(never)]
    fn has_moved(&self) -> bool {
        self.placement != *self.previous_placement() || self.was_deformed()
    }

    /// Sets whether its way is tested. Cost: linear in a shape that deformed.
    pub fn set_motion(&mut self, motion: Motion) {
        self.motion = motion;
        self.note_deformation();
    }

    /// Brings up to date what is kept of how its shape changed.
    fn note_deformation(&mut self) {
        let deforms = self.has_way() && self.was_deformed();
        let deformation = if deforms { deformation(self.previous_shape(), &self.shape) } else { STILL };
        if let Some(extra) = &mut self.extra {
            extra.deformation = deformation;
        }
    }

    /// Whether it is a deformation of what it was in the previous frame.
    fn was_deformed(&self) -> bool {
        self.previous_shape().is_deformation_of(&self.shape)
    }

    /// What comes from the previous frame: a shape that was set since is there from the start.
    fn shape_on_way(&self) -> &Shape {
        if self.was_deformed() { self.previous_shape() } else { &self.shape }
    }

    /// The box for the broad phase: it contains the object on its way.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        dispatch!(simd => self.bounds_into(simd, &mut bounds));
        bounds
    }

    /// The same, in a kernel that finds those of many: put where it is to be, since what is written by numbers and copied by vectors is
    /// waited for.
    #[inline(always)]
    pub fn bounds_into<S: Simd>(&self, simd: S, bounds: &mut Aabb) {
        if self.has_way() || self.extra.is_some() {
            *bounds = self.unusual_bounds();
        } else {
            world_bounds_into(simd, self.placed(), bounds);
        }
    }

    /// Of an object on its way, or with a box of a fixed size.
    #[inline(never)]
    fn unusual_bounds(&self) -> Aabb {
        // On its way it may have had other forms, of other sizes.
        let is_rigid = !self.has_way() || !self.was_deformed();
        let radius = self.extra.as_ref().and_then(|extra| extra.radius).filter(|_| is_rigid);
        let bounds_of = |placed: Placed| {
            let fixed = radius.and_then(|radius| fixed_bounds(placed.placement, radius));
            fixed.unwrap_or_else(|| world_bounds(placed))
        };
        if self.has_way() { moving_bounds(&self.moving(), bounds_of) } else { bounds_of(self.placed()) }
    }

    /// Notes that it leaves the place and the shape of the previous frame, before it does.
    #[inline]
    pub fn displace(&mut self) {
        if !std::mem::replace(&mut self.displaced, true) {
            match &mut self.previous_placement {
                Some(previous) => **previous = self.placement,
                None => self.displace_first(),
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn displace_first(&mut self) {
        self.previous_placement = Some(Box::new(self.placement));
    }

    /// Takes another place; it is displaced.
    #[inline]
    pub fn set_placement(&mut self, placement: DAffine3) {
        self.displace();
        self.placement = placement;
    }

    /// Takes another shape; it is displaced.
    pub fn set_shape(&mut self, shape: &Shape, boxes: Boxes) {
        self.displace();
        let deformed = self.shape.is_deformation_of(shape);
        let old = std::mem::replace(&mut self.shape, shape.clone());
        let radius = if deformed { None } else { radius(shape, boxes) };
        let extra = self.extra_mut();
        extra.previous_shape.get_or_insert(old);
        (extra.spare, extra.radius) = (None, radius);
        self.note_deformation();
    }

    /// Takes new vertex positions; it is displaced. The previous frame keeps the old ones, so the first deformation of a frame
    /// goes to a buffer of its own: that of the frame before, when there is one (double buffering; thesis, section 6.3.3).
    pub fn deform(&mut self, positions: &[DVec3]) -> Result<()> {
        let first = self.extra.as_ref().is_none_or(|extra| extra.previous_shape.is_none());
        let old = first.then(|| self.shape.clone());
        match self.extra.as_mut().and_then(|extra| extra.spare.as_mut()) {
            Some(spare) => {
                spare.deform(positions)?;
                self.shape = spare.clone();
            }
            None => self.shape.deform(positions)?,
        }
        self.displace();
        let extra = self.extra_mut();
        extra.previous_shape = old.or(extra.previous_shape.take());
        (extra.spare, extra.radius) = (None, None);
        self.note_deformation();
        Ok(())
    }

    /// What is now becomes the previous frame.
    #[inline]
    pub fn proceed(&mut self) {
        self.displaced = false;
        if let Some(extra) = &mut self.extra {
            extra.proceed(&self.shape);
        }
    }

    fn extra_mut(&mut self) -> &mut Extra {
        self.extra.get_or_insert_default()
    }
}

/// Nothing was deformed.
const STILL: Aabb = Aabb::new(DVec3::ZERO, DVec3::ZERO);

fn radius(shape: &Shape, boxes: Boxes) -> Option<f64> {
    match boxes {
        Boxes::Dynamic => None,
        Boxes::FixedSize => Some(shape.radius()),
    }
}
