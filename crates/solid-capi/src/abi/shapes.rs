//! Shapes.

use std::cell::RefCell;
use std::ffi::c_void;
use std::ptr;

use solid3d::glam::DVec3;

use super::error::call;
use super::{DtCount, DtIndex, DtPolyType, DtScalar, DtShapeRef};
use crate::builder::Builder;
use crate::engine::Engine;
use crate::fault::{Code, Fault, Result};
use crate::reference::Reference;

/// One more than the last `DtPolyType`.
const POLY_TYPES: DtPolyType = 3;

thread_local! {
    /// The complex shape that this thread builds.
    static BUILDER: RefCell<Option<Builder>> = const { RefCell::new(None) };
}

/// Makes a primitive shape.
fn make(function: &str, add: impl FnOnce(&mut Engine) -> Result<Reference>) -> DtShapeRef {
    call(function, ptr::null_mut(), || Ok(add(&mut Engine::lock())?.pointer()))
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtBox(x: DtScalar, y: DtScalar, z: DtScalar) -> DtShapeRef {
    make("dtBox", |engine| engine.add_box(x, y, z))
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtCone(radius: DtScalar, height: DtScalar) -> DtShapeRef {
    make("dtCone", |engine| engine.add_cone(radius, height))
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtCylinder(radius: DtScalar, height: DtScalar) -> DtShapeRef {
    make("dtCylinder", |engine| engine.add_cylinder(radius, height))
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSphere(radius: DtScalar) -> DtShapeRef {
    make("dtSphere", |engine| engine.add_sphere(radius))
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtNewComplexShape() -> DtShapeRef {
    call("dtNewComplexShape", ptr::null_mut(), || {
        with_slot(|slot| {
            if slot.is_some() {
                let message = "a complex shape is begun already; dtEndComplexShape must come first";
                return Err(Fault::new(Code::Order, message));
            }
            let reference = Engine::lock().promise_shape();
            *slot = Some(Builder::new(reference));
            Ok(reference.pointer())
        })
    })
}

/// See the header.
///
/// # Safety
/// The array that `dtVertexBase` named holds every vertex that a polytope names.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtEndComplexShape() {
    call("dtEndComplexShape", (), || {
        let builder = with_slot(|slot| slot.take().ok_or_else(not_begun))?;
        let (reference, base) = (builder.reference, builder.base);
        let soup = builder.finish()?;
        let shape = match base {
            Some(base) => {
                // SAFETY: the caller guarantees that the array holds the vertices that `soup` reads.
                let read = unsafe { reader(base.pointer()) };
                soup.shape(read)?
            }
            None => soup.shape(|_| unreachable!("without an array no vertex is named by its place"))?,
        };
        Engine::lock().add_complex(reference, shape, soup);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtBegin(poly_type: DtPolyType) {
    build("dtBegin", |builder| {
        check_poly_type(poly_type)?;
        builder.begin()
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtEnd() {
    build("dtEnd", Builder::end);
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtVertex(x: DtScalar, y: DtScalar, z: DtScalar) {
    build("dtVertex", |builder| builder.vertex(DVec3::new(x, y, z)));
}

/// See the header.
///
/// # Safety
/// `base` may be anything; it is read by [`dtEndComplexShape`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtVertexBase(base: *const c_void) {
    build("dtVertexBase", |builder| {
        builder.base = Some(not_null("base", base)?);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtVertexIndex(index: DtIndex) {
    build("dtVertexIndex", |builder| builder.vertex_index(index));
}

/// See the header.
///
/// # Safety
/// `indices` holds `count` numbers, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtVertexIndices(poly_type: DtPolyType, count: DtCount, indices: *const DtIndex) {
    build("dtVertexIndices", |builder| {
        check_poly_type(poly_type)?;
        check_count(count)?;
        not_null("indices", indices.cast())?;
        let index = |i: usize| {
            // SAFETY: `i` is less than `count`, which the caller guarantees to be in `indices`.
            let place = unsafe { indices.add(i) };
            // SAFETY: the same; `place` may be unaligned.
            unsafe { place.read_unaligned() }
        };
        builder.polytope((0..count as usize).map(index))
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtVertexRange(poly_type: DtPolyType, first: DtIndex, count: DtCount) {
    build("dtVertexRange", |builder| {
        check_poly_type(poly_type)?;
        check_count(count)?;
        builder.range(first, count)
    });
}

/// See the header.
///
/// # Safety
/// The array at `base` holds every vertex that a polytope of the shape names, or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtChangeVertexBase(shape: DtShapeRef, base: *const c_void) {
    call("dtChangeVertexBase", (), || {
        not_null("base", base)?;
        // SAFETY: the caller guarantees that the array holds the vertices that the shape reads.
        let read = unsafe { reader(base) };
        Engine::lock().deform(shape.into(), read)
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtDeleteShape(shape: DtShapeRef) {
    call("dtDeleteShape", (), || {
        let shape = Reference::from(shape);
        let give_up = |slot: &RefCell<Option<Builder>>| {
            slot.borrow_mut().take_if(|builder| builder.reference == shape).is_some()
        };
        // A thread that is ending builds none.
        let given_up = BUILDER.try_with(give_up).unwrap_or(false);
        if given_up { Ok(()) } else { Engine::lock().delete_shape(shape) }
    });
}

/// Does something to the complex shape that this thread builds.
fn build(function: &str, change: impl FnOnce(&mut Builder) -> Result<()>) {
    call(function, (), || with_slot(|slot| change(slot.as_mut().ok_or_else(not_begun)?)));
}

fn with_slot<T>(f: impl FnOnce(&mut Option<Builder>) -> Result<T>) -> Result<T> {
    BUILDER.try_with(|slot| f(&mut slot.borrow_mut())).unwrap_or_else(|_| {
        Err(Fault::new(Code::Order, "the thread is ending; it builds no shapes any more"))
    })
}

fn not_begun() -> Fault {
    Fault::new(Code::Order, "no complex shape is begun on this thread; dtNewComplexShape must come first")
}

/// Reads the vertex at a place of a client's array, which may be unaligned.
///
/// # Safety
/// The array holds every vertex that is read.
unsafe fn reader(base: *const c_void) -> impl Fn(u32) -> [f64; 3] {
    let base = base.cast::<[f64; 3]>();
    move |place| {
        // SAFETY: the caller of `reader` guarantees that the vertex is in the array.
        let vertex = unsafe { base.add(place as usize) };
        // SAFETY: the same; any bits are a number.
        unsafe { vertex.read_unaligned() }
    }
}

fn not_null(argument: &str, pointer: *const c_void) -> Result<Reference> {
    if pointer.is_null() { Err(Fault::null(argument)) } else { Ok(pointer.cast_mut().into()) }
}

fn check_count(count: DtCount) -> Result<()> {
    match count {
        0 => Err(Fault::new(Code::Empty, "count is 0; a polytope needs at least one vertex")),
        _ => Ok(()),
    }
}

fn check_poly_type(poly_type: DtPolyType) -> Result<()> {
    if poly_type < POLY_TYPES {
        return Ok(());
    }
    let message =
        format!("type is {poly_type}; it must be DT_SIMPLEX (0), DT_POLYGON (1) or DT_POLYHEDRON (2)");
    Err(Fault::new(Code::Enum, message))
}
