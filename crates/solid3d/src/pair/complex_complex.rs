//! A complex shape against another: two trees are walked together (thesis, sections 5.2.3 and 5.2.4).

use std::ops::ControlFlow;

use glam::DAffine3;
use solid_convex::{Closest, gjk};

use super::frame::Frame;
use super::nearest_shim::{PairMetric, nearest_pairs};
use super::table::PlacedComplex;
use super::triangle_triangle::{self, Triangle};
use super::{Relation, Scratch};
use crate::shape::Complex;
use crate::tree::pairs;

pub(super) fn intersection(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Relation {
    let Scratch { traversal, corners: [corners_a, corners_b], primitive_tests } = scratch;
    let Frame { relative, common: [from_a, from_b], .. } = frame(a, b);
    let found = pairs(a.0.tree(), b.0.tree(), &relative, traversal, |leaf_a, leaf_b| {
        place(a.0, leaf_a, &from_a, corners_a);
        place(b.0, leaf_b, &from_b, corners_b);
        for (&i, triangle_a) in leaf_a.iter().zip(&*corners_a) {
            for (&j, triangle_b) in leaf_b.iter().zip(&*corners_b) {
                *primitive_tests += 1;
                let meet = match (triangle_a, triangle_b) {
                    (Some(x), Some(y)) => triangle_triangle::intersect(x, y),
                    _ => hulls_meet(a, i, b, j),
                };
                if meet {
                    return ControlFlow::Break((i, j));
                }
            }
        }
        ControlFlow::Continue(())
    });
    match found.break_value() {
        Some((i, j)) => Relation::Common(closest_of(a, i, b, j).points),
        None => Relation::Separated { axis: None },
    }
}

pub(super) fn closest(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Closest {
    // Whether they intersect is decided as everywhere else; the distance is 0 then.
    if let Relation::Common(points) = intersection(a, b, scratch) {
        return Closest { distance: 0.0, points };
    }
    let Frame { relative, stretch: [of_a, of_b], .. } = frame(a, b);
    let metric = PairMetric {
        facet_a: of_a.facets,
        facet_b: of_b.facets,
        sigma_min_a: of_a.least,
        sigma_min_b: of_b.least,
    };
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let (mut best, mut answer) = (f64::INFINITY, None);
    nearest_pairs(
        a.0.tree(),
        b.0.tree(),
        &relative,
        &metric,
        &mut best,
        traversal,
        |leaf_a, leaf_b, best| {
            for &i in leaf_a {
                for &j in leaf_b {
                    *primitive_tests += 1;
                    let closest = closest_of(a, i, b, j);
                    if closest.distance < *best {
                        *best = closest.distance;
                        answer = Some(closest);
                    }
                }
            }
        },
    );
    answer.expect("a complex shape has a primitive, and every distance is finite")
}

fn frame(a: PlacedComplex, b: PlacedComplex) -> Frame {
    Frame::new(a.1, a.0.reach(), b.1, b.0.reach())
}

/// The primitives of a leaf in the common frame: those of up to three vertices as triangles, `None` for the others.
fn place(complex: &Complex, leaf: &[u32], map: &DAffine3, corners: &mut Vec<Option<Triangle>>) {
    let vertex = |index: u32| map.transform_point3(complex.vertices()[index as usize]);
    corners.clear();
    corners.extend(leaf.iter().map(|&primitive| match *complex.primitive(primitive) {
        [i] => Some([vertex(i); 3]),
        [i, j] => Some([vertex(i), vertex(j), vertex(j)]),
        [i, j, k] => Some([vertex(i), vertex(j), vertex(k)]),
        _ => None,
    }));
}

fn hulls_meet(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32) -> bool {
    gjk::intersection(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1).witness().is_some()
}

fn closest_of(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32) -> Closest {
    gjk::closest_points(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1)
}
