//! The pairs of primitives of two soups that meet, or are as near as a margin.

use std::ops::ControlFlow;

use fearless_simd::Simd;
use glam::DAffine3;
use solid_convex::simd::level;

use super::super::row::{CONFIRMED, Near, Row, Rows, distances, exceed, verdict};
use super::super::triangle_triangle::Triangle;
use super::super::{Scratch, triangle_triangle};
use super::Pair;
use crate::shape::Complex;
use crate::tree::{LeafPairs, bits, pairs_on};

/// The most pairs of primitives whose contacts are told, at up to a kilobyte each. Of more, as where one of many triangles lies in the place of another, or the
/// margin is as large as both, the deepest point alone is.
const PAIRS_MAX: usize = 1 << 20;

/// A pair of primitives, with whether they are known to meet.
type NearPair = ([u32; 2], bool);

/// Those of two soups, ascending; `None` of more than [`PAIRS_MAX`].
pub(super) fn near_pairs(pair: &Pair, soups: [&Complex; 2], scratch: &mut Scratch) -> Option<Vec<NearPair>> {
    let placing = pair.placing();
    let mut relative = placing.relative();
    let (margin, [in_a, in_b]) = pair.margins(&placing);
    relative.slack_in_a += in_a;
    relative.slack_in_b += in_b;
    let Scratch { traversal, rows, primitive_tests, .. } = scratch;
    rows.iter_mut().for_each(Rows::clear);
    let maps = &placing.common;
    let mut near = NearPairs { soups, maps, margin, rows, primitive_tests, found: Vec::new() };
    let [tree_a, tree_b] = soups.map(Complex::tree);
    let walk = pairs_on(level(), tree_a, tree_b, &relative, &|| None, traversal, &mut near);
    near.found.sort_unstable();
    walk.is_continue().then_some(near.found)
}

/// Looks for pairs of primitives that meet; with a margin, those whose boxes are as near.
struct NearPairs<'s> {
    soups: [&'s Complex; 2],
    maps: &'s [DAffine3; 2],
    margin: f64,
    rows: &'s mut [Rows; 2],
    primitive_tests: &'s mut u64,
    found: Vec<NearPair>,
}

impl LeafPairs<()> for NearPairs<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf_a: &[u32], leaf_b: &[u32]) -> ControlFlow<()> {
        let [rows_a, rows_b] = &mut *self.rows;
        let in_a = rows_a.place(simd, self.soups[0], leaf_a, &self.maps[0]);
        let in_b = rows_b.place(simd, self.soups[1], leaf_b, &self.maps[1]);
        for i in bits(in_a.overlapping(simd, &in_b.union().inflated(self.margin))) {
            let bounds = in_a.bounds(i);
            let near = in_b.overlapping(simd, &bounds.inflated(self.margin));
            *self.primitive_tests += u64::from(near.count_ones());
            let triangles = if in_a.triangles() >> i & 1 == 1 { near & in_b.triangles() } else { 0 };
            let sure = verdict(simd, (in_a, i), in_b, triangles);
            let apart = if self.margin == 0.0 {
                sure.apart
            } else {
                beyond(simd, self.margin, &in_a.triangle(i), in_b, triangles & !sure.meet)
            };
            for j in bits(near & !apart) {
                // Of triangles it is decided exactly, as everywhere.
                let known = triangles >> j & 1 == 1;
                let certain = (sure.meet | sure.apart) >> j & 1 == 1;
                let meet = if certain {
                    sure.meet >> j & 1 == 1
                } else {
                    known && triangle_triangle::intersect(&in_a.triangle(i), &in_b.triangle(j))
                };
                if meet || !known || self.margin > 0.0 {
                    self.found.push(([in_a.primitive(i), in_b.primitive(j)], meet));
                }
            }
        }
        if self.found.len() > PAIRS_MAX { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Of triangles in some lanes, those that are further from a triangle than a margin, certainly.
#[inline(always)]
fn beyond<S: Simd>(simd: S, margin: f64, x: &Triangle, row: &Row, lanes: u32) -> u32 {
    if lanes == 0 {
        return 0;
    }
    let Near { least, .. } = distances(simd, x, row, lanes);
    exceed(simd, &least, margin * (1.0 + CONFIRMED) + CONFIRMED) & lanes
}
