//! A complex shape against another: two trees are walked together (thesis, sections 5.2.3 and 5.2.4).

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use solid_convex::{Closest, Witness, gjk};

use super::containment::{PlacedSolid, part_inside};
use super::frame::{Frame, Stretch};
use super::scratch::PlacedPrimitive;
use super::table::PlacedComplex;
use super::{Relation, Scratch, triangle_triangle};
use crate::bounds::Aabb;
use crate::shape::Complex;
use crate::tree::{PairMetric, nearest_pairs, pairs};

pub(super) fn intersection(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Relation {
    let found = meetings(a, b, scratch, |i, j| ControlFlow::Break((i, j)));
    match found.break_value() {
        Some((i, j)) => Relation::Common(closest_of(a, i, b, j).points),
        None => contained(a, b, scratch).map_or(Relation::Separated { axis: None }, Relation::Common),
    }
}

/// Visits the pairs of primitives that meet.
pub(super) fn meetings<B>(
    a: PlacedComplex,
    b: PlacedComplex,
    scratch: &mut Scratch,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let Scratch { traversal, leaves: [in_a, in_b], primitive_tests, .. } = scratch;
    let Frame { relative, common: [from_a, from_b], .. } = frame(a, b);
    pairs(a.0.tree(), b.0.tree(), &relative, traversal, |leaf_a, leaf_b| {
        place(a.0, leaf_a, &from_a, in_a);
        place(b.0, leaf_b, &from_b, in_b);
        for x in &*in_a {
            for y in in_b.iter().filter(|y| x.bounds.overlaps(&y.bounds)) {
                *primitive_tests += 1;
                let meet = match (&x.triangle, &y.triangle) {
                    (Some(x), Some(y)) => triangle_triangle::intersect(x, y),
                    _ => hulls_meet(a, x.primitive, b, y.primitive),
                };
                if meet {
                    visit(x.primitive, y.primitive)?;
                }
            }
        }
        ControlFlow::Continue(())
    })
}

/// A point of a part of one that is inside the other, a solid; for surfaces that do not meet.
fn contained(a: PlacedComplex, b: PlacedComplex, scratch: &mut Scratch) -> Option<Witness> {
    if !a.0.is_solid() && !b.0.is_solid() {
        return None;
    }
    let Frame { relative, common: [from_a, from_b], .. } = frame(a, b);
    let b_in_a = PlacedSolid::new(a.0, &from_a).and_then(|a| part_inside(&a, b.0, &from_b, scratch));
    if let Some(on_b) = b_in_a {
        return Some(Witness { on_a: relative.b_to_a.transform_point3(on_b), on_b });
    }
    let on_a = PlacedSolid::new(b.0, &from_b).and_then(|b| part_inside(&b, a.0, &from_a, scratch))?;
    Some(Witness { on_a, on_b: relative.a_to_b.transform_point3(on_a) })
}

pub(super) fn closest_within(
    a: PlacedComplex,
    b: PlacedComplex,
    bound: f64,
    scratch: &mut Scratch,
) -> Option<Closest> {
    // Whether they intersect is decided as everywhere else; the distance is 0 then.
    if let Relation::Common(points) = intersection(a, b, scratch) {
        return Some(Closest { distance: 0.0, points });
    }
    let frame = frame(a, b);
    let beyond = frame.beyond(bound);
    let Frame { relative, common: [from_a, from_b], scale, stretch: [of_a, of_b] } = frame;
    let Scratch { traversal, leaves: [in_a, in_b], primitive_tests, .. } = scratch;
    // The best distance so far is kept in the common frame, as the bounds are.
    let (mut best, mut answer) = (beyond, None);
    let metric = metric(&of_a, &of_b);
    // From the closest point of B to that of A so far: what is further apart along it is no nearer.
    let mut axis = DVec3::ZERO;
    let visit = |leaf_a: &[u32], leaf_b: &[u32], best: &mut f64| {
        place(a.0, leaf_a, &from_a, in_a);
        place(b.0, leaf_b, &from_b, in_b);
        for x in &*in_a {
            for y in &*in_b {
                let apart = x.bounds.gap(&y.bounds).length() >= *best
                    || x.least_along(axis) + y.least_along(-axis) >= *best;
                if apart {
                    continue;
                }
                *primitive_tests += 1;
                let closest = closest_of(a, x.primitive, b, y.primitive);
                if closest.distance * scale < *best {
                    *best = closest.distance * scale;
                    let on_a = from_a.transform_point3(closest.points.on_a);
                    axis = (on_a - from_b.transform_point3(closest.points.on_b)).normalize_or_zero();
                    answer = Some(closest);
                }
            }
        }
    };
    nearest_pairs(a.0.tree(), b.0.tree(), &relative, &metric, &mut best, traversal, visit);
    answer.filter(|closest| closest.distance <= bound)
}

fn frame(a: PlacedComplex, b: PlacedComplex) -> Frame {
    Frame::new(a.1, a.0.reach(), b.1, b.0.reach())
}

fn metric(a: &Stretch, b: &Stretch) -> PairMetric {
    PairMetric { facet_a: a.facets, facet_b: b.facets, sigma_min_a: a.least, sigma_min_b: b.least }
}

/// The primitives of a leaf in the common frame.
pub(super) fn place(complex: &Complex, leaf: &[u32], map: &DAffine3, placed: &mut Vec<PlacedPrimitive>) {
    let vertex = |index: u32| map.transform_point3(complex.vertices()[index as usize]);
    let corners = |indices: &[u32]| -> Option<[DVec3; 3]> {
        match *indices {
            [i] => Some([vertex(i); 3]),
            [i, j] => Some([vertex(i), vertex(j), vertex(j)]),
            [i, j, k] => Some([vertex(i), vertex(j), vertex(k)]),
            _ => None,
        }
    };
    placed.clear();
    placed.extend(leaf.iter().map(|&primitive| {
        let indices = complex.primitive(primitive);
        let triangle = corners(indices);
        let bounds = match &triangle {
            Some(corners) => Aabb::of_points(*corners),
            None => Aabb::of_points(indices.iter().map(|&index| vertex(index))),
        };
        PlacedPrimitive { primitive, bounds, triangle }
    }));
}

fn hulls_meet(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32) -> bool {
    gjk::intersection(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1).witness().is_some()
}

fn closest_of(a: PlacedComplex, i: u32, b: PlacedComplex, j: u32) -> Closest {
    gjk::closest_points(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1)
}
