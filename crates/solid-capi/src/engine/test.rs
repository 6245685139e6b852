//! Tests: collision by collision, so that callbacks run between them, without the lock.

use std::cell::Cell;

use solid3d::glam::DVec3;
use solid3d::{Collision, Contact, TestProgress};

use super::responses::check_pair;
use super::{Callback, Engine};
use crate::fault::{Code, Fault, Result};
use crate::reference::Reference;

/// How many calls of `dtTest` may be within one another: more are a response that calls it without end.
const NESTING_MAX: u32 = 64;

thread_local! {
    /// How many tests this thread is in.
    static NESTING: Cell<u32> = const { Cell::new(0) };
    /// Whether these were too many, since the first of them began: then each pair of each of them would call for more.
    static IS_ENDLESS: Cell<bool> = const { Cell::new(false) };
}

/// A test that this thread is in, until it is dropped.
pub(crate) struct Nesting(());

impl Nesting {
    pub fn enter() -> Result<Nesting> {
        if NESTING.get() == NESTING_MAX {
            IS_ENDLESS.set(true);
        }
        if IS_ENDLESS.get() {
            let message = format!("a response calls dtTest within dtTest more than {NESTING_MAX} deep");
            return Err(Fault::new(Code::Limit, message));
        }
        NESTING.set(NESTING.get() + 1);
        Ok(Nesting(()))
    }
}

impl Drop for Nesting {
    fn drop(&mut self) {
        NESTING.set(NESTING.get() - 1);
        if NESTING.get() == 0 {
            IS_ENDLESS.set(false);
        }
    }
}

/// A test under way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Test {
    progress: TestProgress,
    /// Objects created from here on take no part, so that a response that creates objects cannot keep it from ending.
    created: u64,
}

/// A callback to be made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub callback: Callback,
    pub object1: Reference,
    pub object2: Reference,
    pub points: Option<Points>,
}

/// What a callback is told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points {
    /// Space: local to `object1`.
    pub point1: DVec3,
    /// Space: local to `object2`.
    pub point2: DVec3,
    /// From `point2` to `point1`; where these were in each other, the unit vector along which `object1` leaves; or zero. Space: world.
    pub normal: DVec3,
}

impl Engine {
    pub fn begin_test(&mut self) -> Result<Test> {
        self.settle()?;
        Ok(Test { progress: TestProgress::default(), created: self.created })
    }

    /// The next callback of a test; `None` at its end.
    pub fn next_event(&mut self, test: &mut Test) -> Option<Event> {
        while let Some(collision) = self.world.test_next(&mut test.progress) {
            let event = self.event(&collision, test.created);
            if event.is_some() {
                return event;
            }
        }
        None
    }

    /// The callback for two objects, if they collide.
    pub fn test_objects(&mut self, object1: Reference, object2: Reference) -> Result<Option<Event>> {
        let (a, b) = (self.object("object1", object1)?.id, self.object("object2", object2)?.id);
        check_pair(object1, object2)?;
        self.settle()?;
        Ok(self.world.test_pair(a, b)?.and_then(|collision| self.event(&collision, self.created)))
    }

    /// Objects begin where the first test finds them: placing them before is no motion.
    fn settle(&mut self) -> Result<()> {
        while let Some(id) = self.fresh.pop_first() {
            self.world.proceed_object(id)?;
        }
        Ok(())
    }

    /// The callback for a collision; `None` where there is none, or an object is not among the first so many that were created.
    fn event(&self, collision: &Collision, created: u64) -> Option<Event> {
        let named = |id| self.names.get(id).filter(|name| name.serial < created).map(|name| name.reference);
        let (object1, object2) = (named(collision.a)?, named(collision.b)?);
        let callback = self.responses.of(object1, object2)?;
        Some(Event { callback, object1, object2, points: points(&collision.contact) })
    }
}

fn points(contact: &Contact) -> Option<Points> {
    match *contact {
        Contact::Witness { local_a, local_b, .. } => {
            Some(Points { point1: local_a, point2: local_b, normal: DVec3::ZERO })
        }
        Contact::Smart { local_a, local_b, distance, normal, .. } => {
            // As long as the points are apart; of unit length where they are not, since clients divide by it.
            let normal = if distance > 0.0 { normal * distance } else { normal };
            Some(Points { point1: local_a, point2: local_b, normal })
        }
        // Of the rest, only the simple one is ever asked for.
        _ => None,
    }
}
