//! An object: an instance of a shape at a place.

use glam::{DAffine3, DVec3};

use super::{Boxes, Motion};
use crate::bounds::Aabb;
use crate::error::Result;
use crate::pair::swept::{Moving, deformation, moving_bounds};
use crate::pair::{Placed, fixed_bounds, world_bounds};
use crate::shape::Shape;

slotmap::new_key_type! {
    /// An object of a world. The id of a removed object never comes back.
    pub struct ObjectId;
}

/// The bits of a place in the creation order: more than any machine will count to.
const RANK_SHIFT: u32 = 56;

/// What of an object is out of date in the candidates: each includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Staleness {
    /// Nothing.
    #[default]
    Fresh,
    /// What depends on its previous frame.
    Previous,
    /// All that was found about its pairs.
    Pairs,
    /// Its box in the broad phase.
    Bounds,
}

/// An object.
#[derive(Debug)]
pub(super) struct Object {
    /// Its place in the creation order.
    pub serial: u64,
    /// Its place in the order of pairs and their results: by rank, then by creation.
    pub order: u64,
    pub shape: Shape,
    pub placement: DAffine3,
    previous_shape: Shape,
    previous_placement: DAffine3,
    /// The shape of the frame before the previous one, whose memory the next deformation takes.
    pub spare: Option<Shape>,
    /// Whether its way from the previous frame is tested.
    pub motion: Motion,
    /// How its vertices moved since the previous frame; see [`deformation`]. Up to date unless the bounds are stale.
    deformation: Aabb,
    /// The radius about the local origin, when its box in the broad phase is to have a fixed size.
    radius: Option<f64>,
    /// What of it is out of date.
    pub staleness: Staleness,
    /// Whether the previous frame is another.
    pub displaced: bool,
    /// How many pair responses were set for it and not reset; some may be for objects that were removed since.
    pub pair_responses: u32,
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
        Object {
            serial,
            order: (u64::from(rank) << RANK_SHIFT) | serial,
            motion,
            deformation: STILL,
            radius: radius(&shape, boxes),
            previous_shape: shape.clone(),
            previous_placement: placement,
            shape,
            placement,
            spare: None,
            staleness: Staleness::Fresh,
            displaced: false,
            pair_responses: 0,
        }
    }

    /// As it is.
    pub fn placed(&self) -> Placed<'_> {
        Placed { shape: &self.shape, placement: &self.placement }
    }

    /// As it was in the previous frame.
    pub fn previously_placed(&self) -> Placed<'_> {
        Placed { shape: &self.previous_shape, placement: &self.previous_placement }
    }

    /// On its way from the previous frame; nowhere else than it is when only that is tested, or when it stood still.
    pub fn moving(&self) -> Moving<'_> {
        let from = if self.has_way() {
            Placed { shape: self.shape_on_way(), placement: &self.previous_placement }
        } else {
            self.placed()
        };
        Moving { from, to: self.placed(), deformation: self.deformation }
    }

    /// Whether there is a way from the previous frame to be tested.
    pub fn has_way(&self) -> bool {
        let moved = || self.placement != self.previous_placement || self.was_deformed();
        self.motion == Motion::Swept && self.displaced && moved()
    }

    /// Whether it is a deformation of what it was in the previous frame.
    fn was_deformed(&self) -> bool {
        self.previous_shape.is_deformation_of(&self.shape)
    }

    /// What comes from the previous frame: a shape that was set since is there from the start.
    fn shape_on_way(&self) -> &Shape {
        if self.was_deformed() { &self.previous_shape } else { &self.shape }
    }

    /// Brings what depends on the way up to date; gives the box for the broad phase, which contains the object on its way.
    pub fn update_bounds(&mut self) -> Aabb {
        self.deformation = if self.has_way() { deformation(self.shape_on_way(), &self.shape) } else { STILL };
        if self.has_way() {
            moving_bounds(&self.moving(), |placed| self.bounds_of(placed))
        } else {
            self.bounds_of(self.placed())
        }
    }

    fn bounds_of(&self, placed: Placed) -> Aabb {
        let fixed = self.radius.and_then(|radius| fixed_bounds(placed.placement, radius));
        fixed.unwrap_or_else(|| world_bounds(placed))
    }

    /// Takes another shape.
    pub fn set_shape(&mut self, shape: &Shape, boxes: Boxes) {
        let deformed = self.shape.is_deformation_of(shape);
        self.shape = shape.clone();
        self.spare = None;
        self.radius = if deformed { None } else { radius(shape, boxes) };
    }

    /// Takes new vertex positions. The previous frame keeps the old ones, so the first deformation of a frame goes to a
    /// buffer of its own: that of the frame before, when there is one (double buffering; thesis, section 6.3.3).
    pub fn deform(&mut self, positions: &[DVec3]) -> Result<()> {
        match &mut self.spare {
            Some(spare) => {
                spare.deform(positions)?;
                self.shape = spare.clone();
                self.spare = None;
            }
            None => self.shape.deform(positions)?,
        }
        self.radius = None;
        Ok(())
    }

    /// What is now becomes the previous frame.
    pub fn proceed(&mut self) {
        self.displaced = false;
        self.previous_placement = self.placement;
        let old = std::mem::replace(&mut self.previous_shape, self.shape.clone());
        if old.is_deformation_of(&self.shape) {
            self.spare = Some(old);
        }
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
