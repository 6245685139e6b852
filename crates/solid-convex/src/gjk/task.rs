//! What is asked of two placed objects by their support points, compiled into one piece with the support mappings of polytopes, once
//! for each level of instructions.

use fearless_simd::Simd;
use glam::DAffine3;

use super::distance::{Closest, ClosestInWorld};
use crate::difference::{Difference, MinkowskiDifference};
use crate::polytope_difference::{PolytopeDifference, Scanned, in_world, is_plain};
use crate::simd::{self, Level, dispatch};
use crate::{Polytope, Support};

/// Something that is found of a difference by its support points.
pub(super) trait Task {
    /// What is found.
    type Found;

    /// Finds it. To be inlined.
    fn run(self, difference: &impl MinkowskiDifference) -> Self::Found;
}

/// Runs a task on two placed objects: on polytopes in one piece, compiled for the level of instructions.
#[inline]
pub(super) fn run<A, B, T>(a: &A, placement_a: &DAffine3, b: &B, placement_b: &DAffine3, task: T) -> T::Found
where
    A: Support + ?Sized,
    B: Support + ?Sized,
    T: Task,
{
    match (a.as_polytope(), b.as_polytope()) {
        (Some(a), Some(b)) => run_on_polytopes(a, placement_a, b, placement_b, task),
        _ => {
            let difference = Difference::new(a, placement_a, b, placement_b);
            task.run(&difference)
        }
    }
}

fn run_on_polytopes<T: Task>(
    a: &Polytope,
    placement_a: &DAffine3,
    b: &Polytope,
    placement_b: &DAffine3,
    task: T,
) -> T::Found {
    dispatch!(simd => run_in_kernel(simd, (a, placement_a), (b, placement_b), task))
}

#[inline(always)]
fn run_in_kernel<S: Simd, T: Task>(
    simd: S,
    (a, placement_a): (&Polytope, &DAffine3),
    (b, placement_b): (&Polytope, &DAffine3),
    task: T,
) -> T::Found {
    if simd::is_scalar::<S>() {
        let difference = Difference::new(a, placement_a, b, placement_b);
        task.run(&Scanned { simd, difference: &difference, polytopes: [a, b] })
    } else {
        task.run(&PolytopeDifference::new(simd, (a, placement_a), (b, placement_b)))
    }
}

/// Runs a search for closest points on two polytopes, of whose placements nothing was asked, and places what it finds; `None` where a
/// placement is not plain, or nothing is found.
#[inline]
pub(super) fn run_in_world<T: Task<Found = Option<Closest>>>(
    a: &Polytope,
    placement_a: &DAffine3,
    b: &Polytope,
    placement_b: &DAffine3,
    task: T,
) -> Option<ClosestInWorld> {
    dispatch!(simd => {
        if !(is_plain(simd, placement_a) & is_plain(simd, placement_b)) {
            return None;
        }
        let Closest { distance, points } = run_in_kernel(simd, (a, placement_a), (b, placement_b), task)?;
        let point_on_a = in_world(simd, placement_a, points.on_a);
        let point_on_b = in_world(simd, placement_b, points.on_b);
        Some(ClosestInWorld { distance, point_on_a, point_on_b })
    })
}

/// Runs a task on a difference.
#[inline]
pub(super) fn run_on<A, B, T>(level: Level, difference: &Difference<A, B>, task: T) -> T::Found
where
    A: Support + ?Sized,
    B: Support + ?Sized,
    T: Task,
{
    let (a, b) = difference.objects();
    match (a.as_polytope(), b.as_polytope()) {
        (Some(a), Some(b)) => {
            dispatch!(level, simd => task.run(&Scanned { simd, difference, polytopes: [a, b] }))
        }
        _ => task.run(difference),
    }
}
