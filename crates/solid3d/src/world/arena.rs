//! The objects by their ids.
//!
//! As `slotmap::SlotMap`, of whose kind the ids are, but in a vector that grows by an eighth: one that doubles leaves room for
//! up to as many objects as there are.

use std::ops::{Index, IndexMut};

use slotmap::{Key, KeyData};
use solid_convex::simd::prefetch;

use super::candidates::PairKey;
use super::object::{Object, ObjectId};
use crate::broad::Proxy;
use crate::broad::room::push;

/// No slot. Slot 0 is never used.
const NONE: u32 = 0;

#[derive(Clone, Debug)]
struct Slot {
    /// Odd when there is an object. Grows with each that comes and goes, so that the id of one that went names no other.
    version: u32,
    /// The next slot that is not in use, when this is not.
    next: u32,
    object: Option<Object>,
}

/// Objects under generational ids.
#[derive(Clone, Debug)]
pub(super) struct Arena {
    slots: Vec<Slot>,
    /// The first slot that is not in use.
    unused: u32,
    len: usize,
}

impl Default for Arena {
    fn default() -> Self {
        Arena { slots: vec![Slot { version: 0, next: NONE, object: None }], unused: NONE, len: 0 }
    }
}

impl Arena {
    /// Adds an object.
    pub fn insert(&mut self, object: Object) -> ObjectId {
        if self.unused == NONE {
            self.unused = self.slots.len() as u32;
            push(&mut self.slots, Slot { version: 0, next: NONE, object: None });
        }
        let at = self.unused;
        let slot = &mut self.slots[at as usize];
        self.unused = slot.next;
        slot.version = slot.version.wrapping_add(1);
        slot.object = Some(object);
        self.len += 1;
        self.id_of(at)
    }

    /// Takes an object out.
    pub fn remove(&mut self, id: ObjectId) -> Option<Object> {
        let (at, _) = parts(id);
        let object = self.slot_mut(id)?.object.take()?;
        let slot = &mut self.slots[at as usize];
        slot.version = slot.version.wrapping_add(1);
        self.len -= 1;
        // Where all versions were there, ids would come back: such a slot stays out of use.
        if slot.version != 0 {
            slot.next = std::mem::replace(&mut self.unused, at);
        }
        Some(object)
    }

    pub fn get(&self, id: ObjectId) -> Option<&Object> {
        let (at, version) = parts(id);
        let slot = self.slots.get(at as usize).filter(|slot| slot.version == version);
        slot.and_then(|slot| slot.object.as_ref())
    }

    /// Asks for the memory of some objects.
    pub fn prefetch(&self, ids: impl IntoIterator<Item = ObjectId>) {
        ids.into_iter().filter_map(|id| self.slots.get(parts(id).0 as usize)).for_each(prefetch);
    }

    pub fn get_mut(&mut self, id: ObjectId) -> Option<&mut Object> {
        self.slot_mut(id)?.object.as_mut()
    }

    /// The object in a slot, if there is one.
    pub fn at(&self, slot: Proxy) -> Option<&Object> {
        self.slots.get(slot as usize).and_then(|slot| slot.object.as_ref())
    }

    fn slot_mut(&mut self, id: ObjectId) -> Option<&mut Slot> {
        let (at, version) = parts(id);
        self.slots.get_mut(at as usize).filter(|slot| slot.version == version)
    }

    pub fn contains_key(&self, id: ObjectId) -> bool {
        self.get(id).is_some()
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The id of the object in a slot that is in use.
    pub fn id_of(&self, slot: Proxy) -> ObjectId {
        KeyData::from_ffi(u64::from(self.slots[slot as usize].version) << 32 | u64::from(slot)).into()
    }

    /// All objects, slot by slot.
    pub fn iter(&self) -> impl Iterator<Item = (ObjectId, &Object)> {
        let slots = (0..).zip(&self.slots);
        slots.filter_map(|(at, slot)| slot.object.as_ref().map(|object| (self.id_of(at), object)))
    }

    /// Two of them in the order of pairs.
    pub fn in_order(&self, a: ObjectId, b: ObjectId) -> (ObjectId, ObjectId) {
        if self[a].order <= self[b].order { (a, b) } else { (b, a) }
    }

    /// The place of a pair in the order; the earlier object first.
    pub fn key(&self, a: ObjectId, b: ObjectId) -> PairKey {
        (self[a].order, self[b].order)
    }

    /// Their ids.
    pub fn keys(&self) -> impl Iterator<Item = ObjectId> {
        self.iter().map(|(id, _)| id)
    }

    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut Object> {
        self.slots.iter_mut().filter_map(|slot| slot.object.as_mut())
    }
}

impl Index<ObjectId> for Arena {
    type Output = Object;

    fn index(&self, id: ObjectId) -> &Object {
        self.get(id).expect("the object is in the world")
    }
}

impl IndexMut<ObjectId> for Arena {
    fn index_mut(&mut self, id: ObjectId) -> &mut Object {
        self.get_mut(id).expect("the object is in the world")
    }
}

/// The slot of an id, which names its box in the broad phase.
pub(super) fn slot_of(id: ObjectId) -> Proxy {
    parts(id).0
}

/// The slot and the version of an id.
fn parts(id: ObjectId) -> (u32, u32) {
    let bits = id.data().as_ffi();
    (bits as u32, (bits >> 32) as u32)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::DAffine3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::Shape;
    use crate::world::{Boxes, Motion};

    /// Law: ids name what was added under them, until it is removed, and never again; slots are used again.
    #[test]
    fn ids_name_one_object_each() {
        let mut rng = seeded(840);
        let ball = Shape::sphere(1.0).unwrap();
        let (mut arena, mut there, mut gone) = (Arena::default(), BTreeMap::new(), Vec::new());
        for serial in 0..2000 {
            if rng.random_bool(0.5) || there.is_empty() {
                let object =
                    Object::new(0, serial, ball.clone(), DAffine3::IDENTITY, Motion::Sampled, Boxes::Dynamic);
                assert!(there.insert(arena.insert(object), serial).is_none());
            } else {
                let (&id, &serial) = there.iter().nth(rng.random_range(0..there.len())).unwrap();
                assert_eq!(arena.remove(id).map(|object| object.serial()), Some(serial));
                there.remove(&id);
                gone.push(id);
            }
            assert_eq!((arena.len(), arena.is_empty()), (there.len(), there.is_empty()));
        }
        assert!(
            gone.len() > 500 && arena.slots.len() < 500,
            "{} gone, {} slots",
            gone.len(),
            arena.slots.len()
        );
        let mut found: Vec<_> = arena.iter().map(|(id, object)| (id, object.serial())).collect();
        found.sort_unstable();
        assert!(found.into_iter().eq(there.iter().map(|(&id, &serial)| (id, serial))));
        assert!(there.keys().all(|&id| arena.id_of(slot_of(id)) == id));
        for id in gone.into_iter().chain([ObjectId::default()]) {
            assert!(!arena.contains_key(id) && arena.get_mut(id).is_none() && arena.remove(id).is_none());
        }
    }

    /// A slot of which all ids were given away is not used again.
    #[test]
    fn ids_do_not_come_back_when_versions_run_out() {
        let mut arena = Arena::default();
        let object = || {
            let ball = Shape::sphere(1.0).unwrap();
            Object::new(0, 0, ball, DAffine3::IDENTITY, Motion::Sampled, Boxes::Dynamic)
        };
        let first = arena.insert(object());
        arena.remove(first);
        arena.slots[slot_of(first) as usize].version = u32::MAX - 1;
        let last = arena.insert(object());
        assert_eq!(parts(last), (slot_of(first), u32::MAX));
        arena.remove(last);
        let next = [arena.insert(object()), arena.insert(object())];
        assert!(next.iter().all(|&id| slot_of(id) != slot_of(first)) && next[0] != next[1]);
        assert_eq!(arena.len(), 2);
    }
}
