//! The one door to wide instructions.
//!
//! Kernels, loops over lanes, are written once, over `fearless_simd`'s vectors, and compiled twice: scalar, which is what tests
//! hold the other against, and for the wide instructions of the architecture (AVX2, NEON, WebAssembly's SIMD), if it has any. Which one runs
//! is chosen here, at run time. It changes no bit of any answer: no kernel contracts a product and a sum, and ties go to the
//! lowest lane or index.
//!
//! What walks the trees of meshes, but along rays, is compiled once more, for AVX-512, where a machine has it: it takes up to a fifth less time there. Questions
//! about two convex shapes and broad phases run the AVX2 code, being no faster, some slower by 3 to 8 %. SSE2 alone runs the scalar code, which
//! the compiler vectorises by itself. Each further copy of the kernels costs seconds of everybody's build.
//!
//! [`prefetch`], which asks for memory ahead, is no vector, but as much of the machine: the one `unsafe` here.

use std::any::TypeId;
use std::sync::OnceLock;

use fearless_simd::Fallback;

#[doc(hidden)]
pub use machine::HAS_WIDE;
pub use machine::Wide;

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod machine {
    /// The wide instructions of the architecture.
    pub type Wide = fearless_simd::Avx2;
    /// Kernels are compiled for these too.
    pub const HAS_WIDE: bool = true;

    pub fn wide() -> Option<Wide> {
        fearless_simd::Level::new().as_avx2()
    }
}

#[cfg(target_arch = "aarch64")]
mod machine {
    /// The wide instructions of the architecture.
    pub type Wide = fearless_simd::Neon;
    /// Kernels are compiled for these too.
    pub const HAS_WIDE: bool = true;

    pub fn wide() -> Option<Wide> {
        fearless_simd::Level::new().as_neon()
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod machine {
    /// The wide instructions of the architecture.
    pub type Wide = fearless_simd::WasmSimd128;
    /// Kernels are compiled for these too.
    pub const HAS_WIDE: bool = true;

    pub fn wide() -> Option<Wide> {
        fearless_simd::Level::new().as_wasm_simd128()
    }
}

#[cfg(not(any(
    target_arch = "x86",
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
mod machine {
    /// The architecture has no wide instructions that are known here: there is only the scalar level.
    pub type Wide = fearless_simd::Fallback;
    /// Kernels are compiled once.
    pub const HAS_WIDE: bool = false;

    pub fn wide() -> Option<Wide> {
        None
    }
}

/// What `f` makes of each of an array, as `array.map(f)`, but always in place: that is a call now and then, and then not compiled for the wide
/// instructions around it, with all that it is given and gives written to memory and read again.
#[inline(always)]
#[doc(hidden)]
pub fn each<T: Copy, U, const N: usize>(array: [T; N], f: impl Fn(T) -> U) -> [U; N] {
    std::array::from_fn(
        #[inline(always)]
        |i| f(array[i]),
    )
}

/// What kernels run on.
#[derive(Clone, Copy, Debug)]
pub enum Level {
    /// No vectors.
    Scalar(Fallback),
    /// The wide instructions of this machine.
    Wide(Wide),
    /// Those that are twice as wide, for the kernels that are compiled for them too.
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    Widest(fearless_simd::Avx512),
}

impl Level {
    /// For kernels that are not compiled for the widest instructions.
    #[inline(always)]
    #[doc(hidden)]
    pub fn narrow(self) -> Narrow {
        match self {
            Level::Scalar(simd) => Narrow::Scalar(simd),
            Level::Wide(simd) => Narrow::Wide(simd),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Widest(simd) => {
                let wide = fearless_simd::Level::Avx512(simd).as_avx2();
                Narrow::Wide(wide.expect("what has AVX-512 has AVX2"))
            }
        }
    }
}

/// The levels that all kernels are compiled for.
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub enum Narrow {
    Scalar(Fallback),
    Wide(Wide),
}

/// Runs a kernel, a call of an `#[inline(always)]` function generic over `fearless_simd::Simd`: on the [`level`] that everything runs on, or on a level
/// that is given; `widest`: compiled for the widest instructions too.
#[macro_export]
#[doc(hidden)]
macro_rules! dispatch {
    ($simd:ident => $kernel:expr) => {
        $crate::simd::on_level(
            #[inline(always)]
            |level| $crate::dispatch!(level, $simd => $kernel),
        )
    };
    // With copies of what the kernel takes from its surroundings, which is few words.
    (move $simd:ident => $kernel:expr) => {
        $crate::simd::on_level(
            #[inline(always)]
            move |level| $crate::dispatch!(@ level, $simd, #[inline(always)] move || $kernel),
        )
    };
    (widest $level:expr, $simd:ident => $kernel:expr) => {
        match $level {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            $crate::simd::Level::Widest($simd) => $crate::simd::vectorize($simd, #[inline(always)] || $kernel),
            level => $crate::dispatch!(level, $simd => $kernel),
        }
    };
    ($level:expr, $simd:ident => $kernel:expr) => {
        $crate::dispatch!(@ $level, $simd, #[inline(always)] || $kernel)
    };
    (@ $level:expr, $simd:ident, $kernel:expr) => {
        match $level.narrow() {
            $crate::simd::Narrow::Scalar($simd) => $crate::simd::one_by_one($kernel),
            // What a constant decides is not compiled: there is one copy where there is nothing wide.
            $crate::simd::Narrow::Wide($simd) => {
                if const { $crate::simd::HAS_WIDE } {
                    $crate::simd::vectorize($simd, $kernel)
                } else {
                    $crate::simd::nothing_wide()
                }
            }
        }
    };
}
pub use dispatch;

#[cold]
#[doc(hidden)]
pub fn nothing_wide() -> ! {
    unreachable!("the scalar level is the only one")
}

/// Runs what is inlined into `kernel` without vectors: out of the way of its caller, in which every register that it took would be saved first.
#[inline(never)]
#[doc(hidden)]
pub fn one_by_one<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

/// A part that many kernels have in them: inlined into each among wide instructions, and a call without, where its loops over lanes
/// are eight times as long, and the compiler would take minutes for all their copies.
#[macro_export]
#[doc(hidden)]
macro_rules! part {
    ($simd:expr => $part:expr) => {
        $crate::simd::run_part(
            $simd,
            #[inline(always)]
            || $part,
        )
    };
}
pub use part;

/// See [`part!`].
#[inline(always)]
#[doc(hidden)]
pub fn run_part<S: fearless_simd::Simd, R>(_: S, part: impl FnOnce() -> R) -> R {
    // What a constant decides is not compiled, even unoptimised; identities of types are compared in the program.
    if const { size_of::<S::f32s>() > SCALAR_BYTES } {
        part()
    } else if cfg!(any(target_arch = "x86", target_arch = "x86_64")) || is_scalar::<S>() {
        one_by_one(part)
    } else {
        part()
    }
}

/// As wide are the vectors of the scalar level, and the wide ones of other architectures than x86.
const SCALAR_BYTES: usize = 16;

/// Whether a kernel is the copy that runs without vectors.
#[inline(always)]
pub(crate) fn is_scalar<S: fearless_simd::Simd>() -> bool {
    TypeId::of::<S>() == TypeId::of::<Fallback>()
}

/// Runs what is inlined into `kernel` on wide instructions.
#[inline(always)]
#[doc(hidden)]
pub fn vectorize<S: fearless_simd::Simd, R>(simd: S, kernel: impl FnOnce() -> R) -> R {
    simd.vectorize(kernel)
}

/// Asks for the memory of something to which a walk may soon come, where the architecture has an instruction for that: it is then on its
/// way, while else one place is waited for after the other. It changes no answer.
#[inline(always)]
#[doc(hidden)]
pub fn prefetch<T>(value: &T) {
    prefetch_some::<T, 1>(std::slice::from_ref(value), 0);
}

/// The same for so many elements of a slice, from one on. Of what is beyond its end nothing comes.
#[inline(always)]
#[doc(hidden)]
pub fn prefetch_some<T, const N: usize>(slice: &[T], first: usize) {
    /// What memory comes by, in bytes.
    const LINE: usize = 64;
    let (first, size) = (slice.as_ptr().wrapping_add(first).cast::<i8>(), N * size_of::<T>());
    for offset in (0..size).step_by(LINE) {
        prefetch_line(first.wrapping_add(offset));
    }
    // What is aligned to less than a line may end in one more.
    if LINE.saturating_sub(align_of::<T>()) + size > size.next_multiple_of(LINE) {
        prefetch_line(first.wrapping_add(size - 1));
    }
}

#[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse", not(miri)))]
#[expect(unsafe_code, reason = "there is no safe way to this instruction")]
#[inline(always)]
fn prefetch_line(address: *const i8) {
    #[cfg(target_arch = "x86")]
    use std::arch::x86::{_MM_HINT_T0, _mm_prefetch};
    #[cfg(target_arch = "x86_64")]
    use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
    // SAFETY: the machine has the instruction, for which this is compiled; it gives nothing, and faults on no address.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(address) }
}

#[cfg(not(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse", not(miri))))]
#[inline(always)]
fn prefetch_line(_: *const i8) {}

static LEVEL: OnceLock<Level> = OnceLock::new();

/// The level that everything runs on: the widest that this machine has, unless the environment variable `SOLID_SIMD` is `scalar`, or `wide`, which
/// leaves AVX-512 out, when the process first asks.
#[inline]
pub fn level() -> Level {
    *LEVEL.get_or_init(chosen)
}

/// Runs something on [`level`]. That it asks for the first time is out of the way: what is short would else save registers for it.
#[inline(always)]
#[doc(hidden)]
pub fn on_level<R>(run: impl FnOnce(Level) -> R) -> R {
    // Being cold it is not inlined, but stands beside the kernel: elsewhere the wide one would be compiled again for it.
    #[cold]
    #[inline]
    fn at_first<R>(run: impl FnOnce(Level) -> R) -> R {
        run(level())
    }
    match LEVEL.get() {
        Some(&level) => run(level),
        None => at_first(run),
    }
}

#[cold]
fn chosen() -> Level {
    let [scalar, wide] = levels();
    match std::env::var_os("SOLID_SIMD") {
        Some(name) if name == "scalar" => scalar,
        Some(name) if name == "wide" => wide,
        _ => widest().unwrap_or(wide),
    }
}

/// The levels that all kernels are compiled for, the first again where this machine has no other: for tests that hold them against each other.
pub fn levels() -> [Level; 2] {
    let scalar = Level::Scalar(Fallback::new());
    [scalar, machine::wide().map_or(scalar, Level::Wide)]
}

/// What comes of a kernel on every level that this machine has, the widest too: asserts that it is the same. For tests.
#[track_caller]
#[doc(hidden)]
pub fn alike<R: PartialEq + std::fmt::Debug>(mut run: impl FnMut(Level) -> R) -> R {
    let [scalar, wide] = levels();
    let found = run(scalar);
    for level in [wide, widest().unwrap_or(wide)] {
        assert_eq!(run(level), found, "on {level:?}");
    }
    found
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn widest() -> Option<Level> {
    fearless_simd::Level::new().as_avx512().map(Level::Widest)
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn widest() -> Option<Level> {
    None
}
