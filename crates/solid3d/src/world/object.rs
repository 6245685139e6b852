//! An object: an instance of a shape at a place.

use glam::{DAffine3, DVec3};

use crate::error::Result;
use crate::pair::Placed;
use crate::shape::Shape;

slotmap::new_key_type! {
    /// An object of a world. The id of a removed object never comes back.
    pub struct ObjectId;
}

/// The bits of a place in the creation order: more than any machine will count to.
const RANK_SHIFT: u32 = 56;

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
    /// Whether the broad phase has another box.
    pub moved: bool,
    /// Whether the previous frame is another.
    pub displaced: bool,
    /// The objects with which it has a pair response; all are in the world.
    pub pair_partners: Vec<ObjectId>,
}

impl Object {
    pub fn new(rank: u8, serial: u64, shape: Shape, placement: DAffine3) -> Self {
        Object {
            serial,
            order: (u64::from(rank) << RANK_SHIFT) | serial,
            previous_shape: shape.clone(),
            previous_placement: placement,
            shape,
            placement,
            spare: None,
            moved: false,
            displaced: false,
            pair_partners: Vec::new(),
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

    /// Takes new vertex positions. The previous frame keeps the old ones, so the first deformation of a frame goes to a
    /// buffer of its own: that of the frame before, when there is one (double buffering; thesis, section 6.3.3).
    pub fn deform(&mut self, positions: &[DVec3]) -> Result<()> {
        match &mut self.spare {
            Some(spare) => {
                spare.deform(positions)?;
                self.shape = spare.clone();
                self.spare = None;
                Ok(())
            }
            None => self.shape.deform(positions),
        }
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
