//! `SOLID/error.h`, and the frame around every call: no panic and no error gets past it.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_uint};
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::LazyLock;

use crate::fault::{Code, Fault, Result};

/// Printing errors: the environment variable, as the first error found it.
static PRINTS: LazyLock<bool> =
    LazyLock::new(|| std::env::var_os("SOLID_ERRORS").is_some_and(|value| !value.is_empty() && value != "0"));

/// A code and its message.
struct LastError {
    code: Code,
    message: CString,
}

thread_local! {
    /// This thread's last wrong call.
    static LAST: RefCell<Option<LastError>> = const { RefCell::new(None) };
}

/// Runs what a C function does. When it is refused, the fault is noted and `refused` returned.
pub(super) fn call<T>(function: &str, refused: T, body: impl FnOnce() -> Result<T>) -> T {
    let result = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| {
        Err(Fault::new(
            Code::Internal,
            "a mistake of libsolid; its state may have suffered. Please report it",
        ))
    });
    result.unwrap_or_else(|fault| {
        // The frame must hold even if noting the fault does not work out.
        let _ = catch_unwind(|| note(function, &fault));
        refused
    })
}

fn note(function: &str, fault: &Fault) {
    let message = format!("{function}: {}", fault.message);
    if *PRINTS {
        // Nobody is there to be told when stderr is closed.
        let _ = writeln!(std::io::stderr(), "libsolid: {message}");
    }
    let message = CString::new(message).unwrap_or_default();
    // A thread that is ending has no last error any more.
    let _ = LAST.try_with(|last| last.replace(Some(LastError { code: fault.code, message })));
}

/// The code of this thread's last wrong call.
#[unsafe(no_mangle)]
pub extern "C" fn dtGetError() -> c_uint {
    LAST.try_with(|last| last.borrow().as_ref().map_or(0, |error| error.code as c_uint)).unwrap_or(0)
}

/// This thread's last wrong call in words.
#[unsafe(no_mangle)]
pub extern "C" fn dtGetErrorMessage() -> *const c_char {
    let none: &'static CStr = c"";
    let message = |last: &RefCell<Option<LastError>>| {
        // The buffer stays where it is until the next error replaces it, as the header says.
        last.borrow().as_ref().map_or(none.as_ptr(), |error| error.message.as_ptr())
    };
    LAST.try_with(message).unwrap_or(none.as_ptr())
}

/// Forgets this thread's last wrong call.
#[unsafe(no_mangle)]
pub extern "C" fn dtClearError() {
    let _ = LAST.try_with(|last| last.replace(None));
}
