//! The state behind the C functions: one world, with the client's references for everything in it.

mod objects;
mod responses;
mod shapes;
mod test;

use std::collections::BTreeSet;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use slotmap::SecondaryMap;
use solid3d::{ObjectId, Response, World, WorldOptions};

use crate::reference::{ByReference, Reference};
use objects::{Name, Object};
pub(crate) use responses::Callback;
use responses::Responses;
use shapes::Shapes;
pub(crate) use test::{Event, Nesting, Points};

/// Everything that there is, for all threads.
#[derive(Debug)]
pub(crate) struct Engine {
    world: World,
    shapes: Shapes,
    objects: ByReference<Reference, Object>,
    /// What the client knows each object in the world by.
    names: SecondaryMap<ObjectId, Name>,
    responses: Responses,
    /// How many objects were ever created.
    created: u64,
    /// Objects that no test has seen: where they are placed until then is where they begin.
    fresh: BTreeSet<ObjectId>,
    /// The object that any thread created or selected last.
    last_current: Option<ObjectId>,
}

static ENGINE: LazyLock<Mutex<Engine>> = LazyLock::new(|| Mutex::new(Engine::new()));

impl Engine {
    fn new() -> Self {
        let options = WorldOptions { default_response: Response::Ignore, ..WorldOptions::default() };
        Engine {
            world: World::with_options(&options),
            shapes: Shapes::default(),
            objects: ByReference::default(),
            names: SecondaryMap::new(),
            responses: Responses::default(),
            created: 0,
            fresh: BTreeSet::new(),
            last_current: None,
        }
    }

    /// The state, for this thread alone until the guard is dropped. Never hold it while client code runs.
    pub fn lock() -> MutexGuard<'static, Engine> {
        // A panic under the lock was reported as an internal error; refusing all service ever after would not help.
        ENGINE.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn set_caching(&mut self, on: bool) {
        if on { self.world.enable_caching() } else { self.world.disable_caching() }
    }

    /// What is now becomes the previous frame.
    pub fn proceed(&mut self) {
        self.fresh.clear();
        self.world.proceed();
    }
}
