//! Tests, and the end of a frame.

use std::ptr;

use super::error::call;
use super::{DtCollData, DtCount, DtObjectRef, DtScalar};
use crate::engine::{Engine, Event, Nesting};
use crate::fault::{Code, Fault, finite};

/// See the header.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn dtTest() -> DtCount {
    let begun = call("dtTest", None, || {
        let nesting = Nesting::enter()?;
        Ok(Some((nesting, Engine::lock().begin_test()?)))
    });
    let Some((_nesting, mut test)) = begun else {
        return 0;
    };
    let mut count: DtCount = 0;
    while let Some(event) = call("dtTest", None, || Ok(Engine::lock().next_event(&mut test))) {
        count = count.saturating_add(1);
        deliver(&event);
    }
    count
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn dtTestObjects(object1: DtObjectRef, object2: DtObjectRef) {
    let found = call("dtTestObjects", None, || {
        let nesting = Nesting::enter()?;
        let event = Engine::lock().test_objects(object1.into(), object2.into())?;
        Ok(event.map(|event| (nesting, event)))
    });
    if let Some((_nesting, event)) = found {
        deliver(&event);
    }
}

/// Calls the client's function. No lock is held, and what it throws passes through.
fn deliver(event: &Event) {
    let data = event.points.map(DtCollData::from);
    let data = data.as_ref().map_or(ptr::null(), ptr::from_ref);
    let client_data = event.callback.client_data.pointer();
    // SAFETY: the client gave the function as one of this type, and `data` is NULL or lives until it returns.
    unsafe { (event.callback.function)(client_data, event.object1.pointer(), event.object2.pointer(), data) }
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtProceed() {
    call("dtProceed", (), || {
        Engine::lock().proceed();
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtEnableCaching() {
    call("dtEnableCaching", (), || {
        Engine::lock().set_caching(true);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtDisableCaching() {
    call("dtDisableCaching", (), || {
        Engine::lock().set_caching(false);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSetTolerance(tolerance: DtScalar) {
    call("dtSetTolerance", (), || {
        if finite("tolerance", tolerance)? < 0.0 {
            let message = format!("tolerance is {tolerance}; it must be at least 0");
            return Err(Fault::new(Code::Value, message));
        }
        Ok(())
    });
}
