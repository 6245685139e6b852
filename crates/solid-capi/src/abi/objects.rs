//! Objects and their placements.

use super::error::call;
use super::{DtObjectRef, DtScalar, DtShapeRef};
use crate::engine::Engine;
use crate::fault::{Fault, Result};

/// Does something to the state.
fn change(function: &str, f: impl FnOnce(&mut Engine) -> Result<()>) {
    call(function, (), || f(&mut Engine::lock()));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtCreateObject(object: DtObjectRef, shape: DtShapeRef) {
    call("dtCreateObject", (), || {
        if shape.is_null() {
            return Err(Fault::null("shape"));
        }
        Engine::lock().create_object(object.into(), shape.into())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtDeleteObject(object: DtObjectRef) {
    change("dtDeleteObject", |engine| engine.delete_object(object.into()));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSelectObject(object: DtObjectRef) {
    change("dtSelectObject", |engine| engine.select_object(object.into()));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtLoadIdentity() {
    change("dtLoadIdentity", Engine::load_identity);
}

/// See the header.
///
/// # Safety
/// `m` holds 16 numbers, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtLoadMatrixf(m: *const f32) {
    change("dtLoadMatrixf", |engine| {
        // SAFETY: as the caller guarantees.
        let matrix = unsafe { matrix(m) }?;
        engine.load_matrix(&matrix)
    });
}

/// See the header.
///
/// # Safety
/// `m` holds 16 numbers, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtLoadMatrixd(m: *const f64) {
    change("dtLoadMatrixd", |engine| {
        // SAFETY: as the caller guarantees.
        let matrix = unsafe { matrix(m) }?;
        engine.load_matrix(&matrix)
    });
}

/// See the header.
///
/// # Safety
/// `m` holds 16 numbers, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtMultMatrixf(m: *const f32) {
    change("dtMultMatrixf", |engine| {
        // SAFETY: as the caller guarantees.
        let matrix = unsafe { matrix(m) }?;
        engine.multiply_matrix(&matrix)
    });
}

/// See the header.
///
/// # Safety
/// `m` holds 16 numbers, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtMultMatrixd(m: *const f64) {
    change("dtMultMatrixd", |engine| {
        // SAFETY: as the caller guarantees.
        let matrix = unsafe { matrix(m) }?;
        engine.multiply_matrix(&matrix)
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtTranslate(x: DtScalar, y: DtScalar, z: DtScalar) {
    change("dtTranslate", |engine| engine.translate(x, y, z));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtRotate(x: DtScalar, y: DtScalar, z: DtScalar, w: DtScalar) {
    change("dtRotate", |engine| engine.rotate(x, y, z, w));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtScale(x: DtScalar, y: DtScalar, z: DtScalar) {
    change("dtScale", |engine| engine.scale(x, y, z));
}

/// A client's matrix, which may be unaligned.
///
/// # Safety
/// `m` holds 16 numbers, or is NULL.
unsafe fn matrix<T: Copy + Into<f64>>(m: *const T) -> Result<[f64; 16]> {
    if m.is_null() {
        return Err(Fault::null("m"));
    }
    // SAFETY: `m` holds 16 numbers, as the caller guarantees.
    let matrix = unsafe { m.cast::<[T; 16]>().read_unaligned() };
    Ok(matrix.map(Into::into))
}
