//! Shapes by reference.

use std::collections::BTreeSet;

use solid3d::convex::MAGNITUDE_MIN;
use solid3d::{ObjectId, Shape};

use super::Engine;
use crate::fault::{Code, Fault, Result};
use crate::reference::{ByReference, Reference};
use crate::soup::{MAGNITUDE_MAX, Soup};

/// The shapes that there are.
#[derive(Debug, Default)]
pub(super) struct Shapes {
    entries: ByReference<Reference, Entry>,
    /// How many references were ever given out: the last one's number. None is given out twice.
    given: usize,
}

/// A shape.
#[derive(Debug)]
pub(super) struct Entry {
    pub shape: Shape,
    /// Whether it was made as a complex shape, whatever it became.
    pub is_complex: bool,
    /// What deformation needs, if it can be deformed.
    pub deformable: Option<Deformable>,
}

#[derive(Debug)]
pub(super) struct Deformable {
    soup: Soup,
    /// The shape before the last deformation.
    spare: Option<Shape>,
    /// The objects to deform.
    pub objects: BTreeSet<ObjectId>,
}

impl Shapes {
    pub fn get(&self, shape: Reference) -> Result<&Entry> {
        self.entries.get(&shape).ok_or_else(|| Fault::unknown_shape(shape))
    }

    /// The deformable part of a shape, if the shape is known and has one.
    pub fn deformable_mut(&mut self, shape: Reference) -> Option<&mut Deformable> {
        self.entries.get_mut(&shape)?.deformable.as_mut()
    }

    fn next_reference(&mut self) -> Reference {
        // The addresses wrap after 2^32 shapes on machines of 32 bits.
        loop {
            self.given = self.given.wrapping_add(1);
            let reference = Reference::of_number(self.given);
            if self.given != 0 && !self.entries.contains_key(&reference) {
                return reference;
            }
        }
    }
}

impl Engine {
    pub fn add_box(&mut self, x: f64, y: f64, z: f64) -> Result<Reference> {
        let size = [size("x", x)?, size("y", y)?, size("z", z)?];
        Ok(self.add_primitive(Shape::cuboid(size)?))
    }

    pub fn add_cone(&mut self, radius: f64, height: f64) -> Result<Reference> {
        let shape = Shape::cone(size("radius", radius)?, size("height", height)?)?;
        Ok(self.add_primitive(shape))
    }

    pub fn add_cylinder(&mut self, radius: f64, height: f64) -> Result<Reference> {
        let shape = Shape::cylinder(size("radius", radius)?, size("height", height)?)?;
        Ok(self.add_primitive(shape))
    }

    pub fn add_sphere(&mut self, radius: f64) -> Result<Reference> {
        let shape = Shape::sphere(size("radius", radius)?)?;
        Ok(self.add_primitive(shape))
    }

    fn add_primitive(&mut self, shape: Shape) -> Reference {
        let reference = self.shapes.next_reference();
        self.shapes.entries.insert(reference, Entry { shape, is_complex: false, deformable: None });
        reference
    }

    /// A reference for a shape that is to be built.
    pub fn promise_shape(&mut self) -> Reference {
        self.shapes.next_reference()
    }

    /// Keeps the promise.
    pub fn add_complex(&mut self, reference: Reference, shape: Shape, soup: Soup) {
        let deformable = soup.has_array().then(|| Deformable { soup, spare: None, objects: BTreeSet::new() });
        self.shapes.entries.insert(reference, Entry { shape, is_complex: true, deformable });
    }

    /// Gives a shape, and all objects of it, the vertices that the client's array holds now.
    pub fn deform(&mut self, shape: Reference, read: impl Fn(u32) -> [f64; 3]) -> Result<()> {
        let entry = self.shapes.entries.get_mut(&shape).ok_or_else(|| Fault::unknown_shape(shape))?;
        let Some(Deformable { soup, spare, objects }) = &mut entry.deformable else {
            let message =
                format!("shape is {shape}, which has no vertex array; only shapes that have one deform");
            return Err(Fault::new(Code::Shape, message));
        };
        let deformed = soup.deformed(&entry.shape, spare.take(), read)?;
        let old = std::mem::replace(&mut entry.shape, deformed);
        *spare = (old.kind() == entry.shape.kind()).then_some(old);
        for &object in &*objects {
            self.world.set_shape(object, &entry.shape)?;
        }
        Ok(())
    }

    pub fn delete_shape(&mut self, shape: Reference) -> Result<()> {
        self.shapes.entries.remove(&shape).ok_or_else(|| Fault::unknown_shape(shape))?;
        if self.shapes.entries.is_empty() {
            self.shapes.entries.shrink_to_fit();
        }
        Ok(())
    }
}

/// A size as `solid3d` takes it: SOLID 2.0 knows flat boxes and balls that are points, which the least size stands for.
fn size(argument: &str, value: f64) -> Result<f64> {
    if (0.0..=MAGNITUDE_MAX).contains(&value) {
        Ok(value.max(MAGNITUDE_MIN))
    } else {
        let message = format!("{argument} is {value:?}; it must be from 0 to {MAGNITUDE_MAX:e}");
        Err(Fault::new(Code::Value, message))
    }
}
