//! Where two shapes just touch, the questions about them agree: from a place where they intersect to one where they do not, bit by bit.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its seed"
)]

mod common;

use common::{assert_rate, convex_of_kind, direction, placement, random_complex, random_mesh, torus};
use glam::DAffine3;
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::query::{self, PairCache};
use solid3d::{Shape, glam};

const PAIRS: usize = 600;

/// Any shape of about 1 in size.
fn shape(rng: &mut StdRng) -> Shape {
    let mut size = || rng.random_range(0.3..=1.5);
    let sizes = [size(), size(), size()];
    match rng.random_range(0..9) {
        6 => random_mesh(rng, 60).shape(),
        7 => torus(12, 8, 0.4).shape().into_solid().unwrap(),
        8 => random_complex(rng, 5).shape(),
        kind => convex_of_kind(rng, kind, sizes, 1.0),
    }
}

/// Two shapes that intersect have no distance, however they are asked, nor an axis that separates them; and convex shapes intersect either way
/// round.
#[test]
fn shapes_that_touch_have_no_distance_and_no_axis() {
    let mut rng = seeded(71);
    let (mut cases, mut hits) = (0, 0);
    for pair in 0..PAIRS {
        let (a, b) = (shape(&mut rng), shape(&mut rng));
        let (at_a, start) = (placement(&mut rng, 1.0), placement(&mut rng, 1.0));
        let way = direction(&mut rng) * 64.0;
        let at = |t: f64| DAffine3 { translation: start.translation + way * t, ..start };
        let meet = |t: f64| query::intersects(&a, &at_a, &b, &at(t)).unwrap();
        if !meet(0.0) || meet(1.0) {
            continue;
        }
        let (mut near, mut far) = (0.0, 1.0);
        for _ in 0..56 {
            let middle = f64::midpoint(near, far);
            *if meet(middle) { &mut near } else { &mut far } = middle;
        }
        let are_convex = [&a, &b].iter().all(|shape| shape.primitive_count() == 1);
        for step in -12..12 {
            let at_b = at(near + f64::from(step) * 2e-17);
            let context = format!("pair {pair} ({} and {}), step {step}", a.kind(), b.kind());
            let touch = query::intersects(&a, &at_a, &b, &at_b).unwrap();
            cases += 1;
            hits += usize::from(touch);
            let swapped = query::intersects(&b, &at_b, &a, &at_a).unwrap();
            assert!(swapped == touch || !are_convex, "{context}");
            if touch {
                assert_eq!(query::distance(&a, &at_a, &b, &at_b).unwrap().distance, 0.0, "{context}");
                let within = query::distance_within(&a, &at_a, &b, &at_b, 0.0).unwrap();
                assert_eq!(within.unwrap().distance, 0.0, "{context}");
                let again = PairCache::new(&a, &b).distance(&at_a, &at_b).unwrap();
                assert_eq!(again.distance, 0.0, "{context}");
                assert_eq!(query::separating_axis(&a, &at_a, &b, &at_b).unwrap(), None, "{context}");
            }
        }
    }
    assert_rate("shapes that touch", hits, cases);
}
