//! The curve in which the surfaces of two shapes meet, as polylines (thesis, chapter 3 and section 6.5).
//!
//! Like the test of two triangles, whether and where two facets meet is decided by signs of determinants, exactly, for their
//! corners as they lie in the common frame. A meeting is a point, a segment, or, of coplanar triangles, a region; its ends
//! are *nodes*, named by what meets there: a corner, an edge and a face, or two edges. Neighbouring facets name the node
//! between them alike, so segments are joined by names; no tolerance is asked for. Only at the end are the points of the
//! nodes computed, each once, to the last few bits.
//!
//! Deviation from SOLID 1.0, which ignores coplanar polygons: the region in which coplanar facets overlap gives its outline.
//! The edges between two facets inside the region are no part of it, and are known by having the region on both sides.
//!
//! | file | holds |
//! |---|---|
//! | `sites` | distinct corners, with the exact predicates on them |
//! | `facets` | the facets of the primitives that may meet |
//! | `meeting`, `planar` | what two facets have in common: in general, in one plane |
//! | `position`, `double` | where a node is; the arithmetic for it |
//! | `join` | from segments to polylines |
//! | `polyline` | the result |

mod double;
mod facets;
mod join;
mod meeting;
mod planar;
mod polyline;
mod position;
mod sites;

use std::ops::ControlFlow;

pub use polyline::{IntersectionCurve, Polyline, PrimitivePair, Segment};

use super::complex_complex::place;
use super::frame::Frame;
use super::{Placed, Scratch};
use crate::error::{Error, Result};
use crate::shape::{Complex, Surface};
use crate::tree::pairs;
use facets::Facets;
use join::Chain;

/// The curve; an error for a shape without facets.
pub(crate) fn intersection_curve(a: Placed, b: Placed, scratch: &mut Scratch) -> Result<IntersectionCurve> {
    let refusal = |argument, placed: Placed| Error::NoFacets { argument, kind: placed.shape.kind() };
    let on_a = a.shape.surface().ok_or_else(|| refusal("a", a))?;
    let on_b = b.shape.surface().ok_or_else(|| refusal("b", b))?;
    let (complex_a, complex_b) = (on_a.complex(), on_b.complex());
    let frame = Frame::new(a.placement, complex_a.reach(), b.placement, complex_b.reach());
    let candidates = candidates(complex_a, complex_b, &frame, scratch);
    let facets = Facets::new([complex_a, complex_b], &frame.common, &candidates);
    let chains = join::chains(meeting::all(&facets, &candidates));
    let polyline = |chain: Chain| Polyline {
        points: chain.nodes.iter().map(|node| frame.to_world(facets.sites.position(node))).collect(),
        primitives: chain.pairs.iter().map(|&pair| named(pair, &on_a, &on_b)).collect(),
        closed: chain.closed,
    };
    Ok(IntersectionCurve { polylines: chains.into_iter().map(polyline).collect() })
}

/// A primitive of each surface.
type Pair = [u32; 2];

/// The pairs of primitives whose boxes overlap, ascending.
fn candidates(a: &Complex, b: &Complex, frame: &Frame, scratch: &mut Scratch) -> Vec<Pair> {
    let Scratch { traversal, leaves: [in_a, in_b], primitive_tests, .. } = scratch;
    let [from_a, from_b] = &frame.common;
    let mut candidates = Vec::new();
    let _ = pairs(a.tree(), b.tree(), &frame.relative(), traversal, |leaf_a, leaf_b| {
        place(a, leaf_a, from_a, in_a);
        place(b, leaf_b, from_b, in_b);
        for x in &*in_a {
            let near = in_b.iter().filter(|y| x.bounds.overlaps(&y.bounds));
            candidates.extend(near.map(|y| [x.primitive, y.primitive]));
        }
        ControlFlow::<()>::Continue(())
    });
    *primitive_tests += candidates.len() as u64;
    candidates.sort_unstable();
    candidates
}

/// The primitives as the caller numbers them.
fn named([i, j]: Pair, a: &Surface, b: &Surface) -> PrimitivePair {
    PrimitivePair { a: a.primitive(i), b: b.primitive(j) }
}
