//! Several threads at once: each places its own objects, and each test is right.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr;
use std::sync::Barrier;
use std::thread;

use solid::*;

thread_local! {
    static CALLBACKS: Cell<u32> = const { Cell::new(0) };
}

unsafe extern "C-unwind" fn count(_: *mut c_void, _: DtObjectRef, _: DtObjectRef, _: *const DtCollData) {
    CALLBACKS.set(CALLBACKS.get() + 1);
}

fn object(number: usize) -> DtObjectRef {
    ptr::without_provenance_mut(number)
}

/// The lock is not held during a response: two threads meet within theirs.
unsafe extern "C-unwind" fn meet(barrier: *mut c_void, _: DtObjectRef, _: DtObjectRef, _: *const DtCollData) {
    // SAFETY: the barrier outlives the test.
    let barrier = unsafe { &*barrier.cast::<Barrier>() };
    barrier.wait();
}

/// One test, since the state is the process's.
#[test]
fn threads_do_not_get_in_each_others_way() {
    let ball = dtSphere(1.0).addr();
    thread::scope(|scope| {
        for thread in 0..4 {
            scope.spawn(move || {
                let ball = ptr::without_provenance_mut(ball);
                let (a, b) = (object(2 * thread), object(2 * thread + 1));
                let far = 1000.0 * thread as f64;
                dtCreateObject(a, ball);
                dtTranslate(far, 0.0, 0.0);
                dtCreateObject(b, ball);
                dtTranslate(far, 50.0, 0.0);
                dtSetPairResponse(a, b, Some(count), 2, ptr::null_mut());
                for step in 0..2000 {
                    // The current object is this thread's own; whoever tests makes the callback, so only this pair is asked about.
                    dtSelectObject(b);
                    dtLoadIdentity();
                    dtTranslate(far, 0.0, 0.0);
                    dtTranslate(0.0, if step % 2 == 0 { 1.5 } else { 2.5 }, 0.0);
                    CALLBACKS.set(0);
                    dtTestObjects(b, a);
                    assert_eq!(CALLBACKS.get(), 1 - step % 2);
                }
                assert_eq!(dtGetError(), 0, "no thread meddled");
            });
        }
    });

    // All four pairs are 2.5 apart. Move one, and let all test at once: each sees it.
    dtSelectObject(object(1));
    dtTranslate(0.0, -1.0, 0.0);
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..1000 {
                    CALLBACKS.set(0);
                    assert_eq!(dtTest(), 1);
                    assert_eq!(CALLBACKS.get(), 1);
                }
            });
        }
    });

    // A thread that never selected anything has the current object of whoever did last.
    thread::scope(|scope| drop(scope.spawn(|| dtTranslate(0.0, 1.0, 0.0))));
    assert_eq!(dtTest(), 0);
    dtTranslate(0.0, -1.0, 0.0);

    let barrier = Barrier::new(2);
    dtSetPairResponse(object(0), object(1), Some(meet), 1, (&raw const barrier).cast_mut().cast());
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| assert_eq!(dtTest(), 1));
        }
    });
}
