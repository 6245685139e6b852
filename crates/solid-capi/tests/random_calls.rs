//! A million random calls, in random order, from several threads, from within responses too: no crash, no internal error, and
//! in the end the library still gives right answers.
#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

use std::cell::{Cell, RefCell};
use std::ffi::c_void;
use std::ptr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use rand::Rng;
use rand::rngs::StdRng;
use rand::seq::IndexedRandom;
use solid::*;
use solid_oracle::generate::seeded;

const CALLS: u64 = 1_000_000;
const THREADS: u64 = 4;
const SEED: u64 = 0x501d_2000;
/// References of objects are numbers below this.
const OBJECTS: usize = 24;
/// Vertices in each array.
const VERTICES: usize = 48;
const DT_ERROR_INTERNAL: u32 = 9;

/// The shapes that were made: some are deleted since.
static SHAPES: Mutex<Vec<usize>> = Mutex::new(Vec::new());
static ACCEPTED: AtomicU64 = AtomicU64::new(0);
static REFUSED: AtomicU64 = AtomicU64::new(0);
static CALLBACKS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    static RNG: RefCell<StdRng> = RefCell::new(seeded(SEED));
    /// How many responses this thread is in.
    static DEPTH: Cell<u32> = const { Cell::new(0) };
}

/// Good vertices; others of which one is not finite.
fn array(good: bool) -> *const c_void {
    static ARRAYS: [[[f64; 3]; VERTICES]; 3] = {
        let mut arrays = [[[0.0; 3]; VERTICES]; 3];
        let mut i = 0;
        while i < VERTICES {
            let x = i as f64;
            arrays[0][i] = [(i % 4) as f64, (i / 4 % 4) as f64, (i / 16) as f64];
            arrays[1][i] = [x * 0.1, (i % 7) as f64 * 0.2, (i % 5) as f64 * -0.3];
            arrays[2][i] = [x, if i == 5 { f64::NAN } else { 0.0 }, 1.0];
            i += 1;
        }
        arrays
    };
    let which = if good { random(0..2) } else { 2 };
    (&raw const ARRAYS[which]).cast()
}

fn random<T: rand::distr::uniform::SampleUniform + PartialOrd>(range: std::ops::Range<T>) -> T {
    RNG.with_borrow_mut(|rng| rng.random_range(range))
}

fn rarely() -> bool {
    random(0..20) == 0
}

/// Mostly ordinary, sometimes none at all.
fn number() -> f64 {
    if !rarely() {
        return random(-3.0..3.0);
    }
    let odd = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 1e-300, f64::MIN_POSITIVE, 1e99];
    RNG.with_borrow_mut(|rng| *odd.choose(rng).unwrap())
}

fn size() -> f64 {
    if rarely() { number() } else { random(0.0..2.0) }
}

fn object() -> DtObjectRef {
    ptr::without_provenance_mut(random(0..OBJECTS))
}

fn shape() -> DtShapeRef {
    let shapes = SHAPES.lock().unwrap();
    let known = RNG.with_borrow_mut(|rng| shapes.choose(rng).copied());
    ptr::without_provenance_mut(if rarely() { random(0..usize::MAX) } else { known.unwrap_or(0) })
}

fn keep(shape: DtShapeRef) {
    if !shape.is_null() {
        SHAPES.lock().unwrap().push(shape.addr());
    }
}

fn kind() -> u32 {
    if rarely() { random(0..u32::MAX) } else { random(0..4) }
}

fn response() -> DtResponse {
    if rarely() { None } else { Some(respond) }
}

/// Calls what it likes, a few deep.
unsafe extern "C-unwind" fn respond(
    client_data: *mut c_void,
    object1: DtObjectRef,
    object2: DtObjectRef,
    data: *const DtCollData,
) {
    assert_eq!(client_data.addr(), 0xc11e);
    assert!(object1.addr() < OBJECTS && object2.addr() < OBJECTS && object1 != object2);
    if !data.is_null() {
        // SAFETY: the library says that it holds during the call.
        let DtCollData { point1, point2, normal } = unsafe { *data };
        assert!([point1, point2, normal].iter().flatten().all(|x| x.is_finite()));
    }
    CALLBACKS.fetch_add(1, Ordering::Relaxed);
    DEPTH.set(DEPTH.get() + 1);
    if DEPTH.get() <= 3 && random(0..4) == 0 {
        call();
    }
    DEPTH.set(DEPTH.get() - 1);
}

/// One random call.
fn call() {
    dtClearError();
    let client_data = ptr::without_provenance_mut(0xc11e);
    let m: [f64; 16] = std::array::from_fn(|_| number());
    let f = m.map(|x| x as f32);
    let indices: [u32; 8] = std::array::from_fn(|_| random(0..VERTICES as u32));
    match random(0..46) {
        0 => keep(dtBox(size(), size(), size())),
        1 => keep(dtCone(size(), size())),
        2 => keep(dtCylinder(size(), size())),
        3 => keep(dtSphere(size())),
        4 | 5 => keep(dtNewComplexShape()),
        // SAFETY: every array that is ever named lives for ever, and every index is in it.
        6 | 7 => unsafe { dtEndComplexShape() },
        8 => dtBegin(kind()),
        9 => dtEnd(),
        10 => dtVertex(number(), number(), number()),
        11 => {
            let base = if rarely() { ptr::null() } else { array(!rarely()) };
            // SAFETY: as above.
            unsafe { dtVertexBase(base) }
        }
        12 => dtVertexIndex(if rarely() { random(1 << 27..u32::MAX) } else { indices[0] }),
        13 | 14 => {
            let count = random(0..9);
            let indices = if rarely() { ptr::null() } else { indices.as_ptr() };
            // SAFETY: at most as many as there are.
            unsafe { dtVertexIndices(kind(), count, indices) }
        }
        15 => {
            let first = random(0..VERTICES as u32);
            let count =
                if rarely() { random(1 << 30..u32::MAX) } else { random(0..VERTICES as u32 - first + 1) };
            dtVertexRange(kind(), first, count);
        }
        16 | 17 => {
            let (shape, base) = (shape(), if rarely() { ptr::null() } else { array(!rarely()) });
            // SAFETY: as for dtEndComplexShape.
            unsafe { dtChangeVertexBase(shape, base) }
        }
        18 => {
            let shape = shape();
            dtDeleteShape(shape);
            if dtGetError() == 0 {
                SHAPES.lock().unwrap().retain(|&known| known != shape.addr());
            }
        }
        19..=21 => dtCreateObject(object(), shape()),
        22 => dtDeleteObject(object()),
        23 => dtSelectObject(object()),
        24 => dtLoadIdentity(),
        // SAFETY: 16 numbers, for the four.
        25 => unsafe { dtLoadMatrixf(f.as_ptr()) },
        // SAFETY: as above.
        26 => unsafe { dtLoadMatrixd(m.as_ptr()) },
        // SAFETY: as above.
        27 => unsafe { dtMultMatrixf(f.as_ptr()) },
        // SAFETY: as above.
        28 => unsafe { dtMultMatrixd(if rarely() { ptr::null() } else { m.as_ptr() }) },
        29 => dtTranslate(number(), number(), number()),
        30 => dtRotate(number(), number(), number(), number()),
        31 => dtScale(number(), number(), number()),
        32 => dtSetDefaultResponse(response(), kind(), client_data),
        33 if rarely() => dtClearDefaultResponse(),
        34 => dtSetObjectResponse(object(), response(), kind(), client_data),
        35 => dtClearObjectResponse(object()),
        36 => dtResetObjectResponse(object()),
        37 => dtSetPairResponse(object(), object(), response(), kind(), client_data),
        38 => dtClearPairResponse(object(), object()),
        39 => dtResetPairResponse(object(), object()),
        40 => drop(dtTest()),
        41 => dtTestObjects(object(), object()),
        42 => dtProceed(),
        43 => dtEnableCaching(),
        44 => dtDisableCaching(),
        _ => dtSetTolerance(size()),
    }
    let error = dtGetError();
    assert_ne!(error, DT_ERROR_INTERNAL, "an internal error");
    let counter = if error == 0 { &ACCEPTED } else { &REFUSED };
    counter.fetch_add(1, Ordering::Relaxed);
}

unsafe extern "C-unwind" fn count(_: *mut c_void, _: DtObjectRef, _: DtObjectRef, _: *const DtCollData) {
    CALLBACKS.fetch_add(1, Ordering::Relaxed);
}

#[test]
fn a_million_calls_in_random_order() {
    thread::scope(|scope| {
        for thread in 0..THREADS {
            scope.spawn(move || {
                RNG.set(seeded(SEED + thread));
                (0..CALLS / THREADS).for_each(|_| call());
            });
        }
    });
    let (accepted, refused) = (ACCEPTED.load(Ordering::Relaxed), REFUSED.load(Ordering::Relaxed));
    let callbacks = CALLBACKS.load(Ordering::Relaxed);
    eprintln!("seed {SEED:#x}: {accepted} calls accepted, {refused} refused, {callbacks} callbacks");
    let share = accepted as f64 / (accepted + refused) as f64;
    assert!((0.3..0.95).contains(&share), "{share} of the calls are accepted");
    assert!(callbacks > CALLS / 100, "{callbacks} callbacks");

    // Nothing is left behind that would spoil what comes after.
    for object in 0..OBJECTS {
        let object = ptr::without_provenance_mut(object);
        dtDeleteObject(object);
        dtResetObjectResponse(object);
        (0..OBJECTS).for_each(|other| dtResetPairResponse(object, ptr::without_provenance_mut(other)));
    }
    SHAPES.lock().unwrap().iter().for_each(|&shape| dtDeleteShape(ptr::without_provenance_mut(shape)));
    dtClearError();
    CALLBACKS.store(0, Ordering::Relaxed);
    dtSetDefaultResponse(Some(count), 3, ptr::null_mut());
    assert_eq!(dtTest(), 0);
    let ball = dtSphere(1.0);
    for object in 0..10 {
        dtCreateObject(ptr::without_provenance_mut(object), ball);
        dtTranslate(1.5 * object as f64, 0.0, 0.0);
    }
    assert_eq!(dtTest(), 9);
    assert_eq!(CALLBACKS.load(Ordering::Relaxed), 9);
    (0..10).for_each(|object| dtDeleteObject(ptr::without_provenance_mut(object)));
    dtDeleteShape(ball);
    assert_eq!(dtGetError(), 0);
}
