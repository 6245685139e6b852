//! Objects by reference, and the current one.

use std::cell::Cell;

use solid3d::ObjectId;
use solid3d::glam::{DAffine3, DMat3, DQuat, DVec3, DVec4};

use super::Engine;
use crate::fault::{Code, Fault, Result, finite};
use crate::reference::Reference;

/// Complex objects come first in a callback.
const RANK_COMPLEX: u8 = 0;
const RANK_PRIMITIVE: u8 = 1;

thread_local! {
    /// The object that this thread created or selected last.
    static CURRENT: Cell<Option<ObjectId>> = const { Cell::new(None) };
}

/// An object.
#[derive(Debug)]
pub(super) struct Object {
    pub id: ObjectId,
    /// Its shape, which may have been deleted since.
    shape: Reference,
}

/// What an object is called.
#[derive(Clone, Copy, Debug)]
pub(super) struct Name {
    pub reference: Reference,
    /// Its place in the creation order.
    pub serial: u64,
}

impl Engine {
    pub fn create_object(&mut self, object: Reference, shape: Reference) -> Result<()> {
        let entry = self.shapes.get(shape)?;
        if self.objects.contains_key(&object) {
            let message =
                format!("object is {object}, which there is already; dtDeleteObject must come first");
            return Err(Fault::new(Code::Object, message));
        }
        let rank = if entry.is_complex { RANK_COMPLEX } else { RANK_PRIMITIVE };
        let id = self.world.add_ranked(&entry.shape, DAffine3::IDENTITY, rank)?;
        if let Some(deformable) = self.shapes.deformable_mut(shape) {
            deformable.objects.insert(id);
        }
        self.objects.insert(object, Object { id, shape });
        self.names.insert(id, Name { reference: object, serial: self.created });
        self.created += 1;
        self.fresh.insert(id);
        self.make_current(id);
        self.apply_responses_of(object, id)
    }

    pub fn delete_object(&mut self, object: Reference) -> Result<()> {
        let Object { id, shape, .. } =
            self.objects.remove(&object).ok_or_else(|| Fault::unknown_object("object", object))?;
        if let Some(deformable) = self.shapes.deformable_mut(shape) {
            deformable.objects.remove(&id);
        }
        self.names.remove(id);
        self.fresh.remove(&id);
        self.responses.forget(object);
        if self.objects.is_empty() {
            self.objects.shrink_to_fit();
        }
        Ok(self.world.remove(id)?)
    }

    pub fn select_object(&mut self, object: Reference) -> Result<()> {
        let id = self.object("object", object)?.id;
        self.make_current(id);
        Ok(())
    }

    pub fn load_identity(&mut self) -> Result<()> {
        self.place(|_| DAffine3::IDENTITY)
    }

    /// By columns; the bottom row is ignored.
    pub fn load_matrix(&mut self, matrix: &[f64; 16]) -> Result<()> {
        self.place(|_| affine(matrix))
    }

    /// By columns; the bottom row is ignored.
    pub fn multiply_matrix(&mut self, matrix: &[f64; 16]) -> Result<()> {
        self.place(|placement| placement * affine(matrix))
    }

    pub fn translate(&mut self, x: f64, y: f64, z: f64) -> Result<()> {
        let translation = DVec3::new(finite("x", x)?, finite("y", y)?, finite("z", z)?);
        self.place(|placement| DAffine3 { translation: placement.transform_point3(translation), ..placement })
    }

    pub fn rotate(&mut self, x: f64, y: f64, z: f64, w: f64) -> Result<()> {
        let quaternion = DVec4::new(finite("x", x)?, finite("y", y)?, finite("z", z)?, finite("w", w)?);
        let largest = quaternion.abs().max_element();
        if largest == 0.0 {
            return Err(Fault::new(Code::Value, "the quaternion is (0, 0, 0, 0), which is no rotation"));
        }
        // Brought to size first, so that squares neither overflow nor vanish.
        let rotation = DMat3::from_quat(DQuat::from_vec4((quaternion / largest).normalize()));
        self.place(|placement| DAffine3 { matrix3: placement.matrix3 * rotation, ..placement })
    }

    pub fn scale(&mut self, x: f64, y: f64, z: f64) -> Result<()> {
        let scale = DVec3::new(finite("x", x)?, finite("y", y)?, finite("z", z)?);
        self.place(|placement| DAffine3 {
            matrix3: placement.matrix3 * DMat3::from_diagonal(scale),
            ..placement
        })
    }

    pub(super) fn object(&self, argument: &str, object: Reference) -> Result<&Object> {
        self.objects.get(&object).ok_or_else(|| Fault::unknown_object(argument, object))
    }

    fn make_current(&mut self, id: ObjectId) {
        CURRENT.set(Some(id));
        self.last_current = Some(id);
    }

    /// Gives the current object a placement that follows from the one it has.
    fn place(&mut self, follow: impl FnOnce(DAffine3) -> DAffine3) -> Result<()> {
        let current = CURRENT.get().or(self.last_current).filter(|&id| self.world.contains(id));
        let Some(id) = current else {
            let message = "there is no current object: none was created or selected, or it was deleted";
            return Err(Fault::new(Code::Order, message));
        };
        let placement = follow(self.world.placement(id)?);
        Ok(self.world.set_placement(id, placement)?)
    }
}

fn affine(m: &[f64; 16]) -> DAffine3 {
    DAffine3::from_cols(
        DVec3::new(m[0], m[1], m[2]),
        DVec3::new(m[4], m[5], m[6]),
        DVec3::new(m[8], m[9], m[10]),
        DVec3::new(m[12], m[13], m[14]),
    )
}
