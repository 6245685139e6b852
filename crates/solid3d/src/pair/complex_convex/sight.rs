//! What a walk down the tree begins with: where the convex shape is, what lengths are worth, and a glance at the images of leaves.

use solid_convex::simd::dispatch;

use super::super::frame::Stretch;
use super::super::glance::Glance;
use super::super::table::{PlacedComplex, PlacedConvex};
use super::CLEARLY_APART;
use super::details::Details;
use crate::tree::NearQuery;

/// Lengths are those of a common frame.
pub(super) struct Sight {
    /// World lengths times this are lengths of that frame.
    pub scale: f64,
    pub query: NearQuery,
    /// `None` where it would tell nothing, or is of no use.
    pub glance: Option<Glance>,
}

impl Sight {
    /// For any placements. With a glance, where any primitive that meets will do: where all are wanted, most leaves that are visited hold some.
    pub fn new(
        (complex, _): PlacedComplex,
        convex: PlacedConvex,
        details: &Details,
        wants_any: bool,
    ) -> Sight {
        let Details { frame, direct, shadow, map, .. } = details;
        let (to_common, tree) = (&frame.common[1], complex.tree());
        let (box_around, around) = shadow.around(direct, frame);
        let glance = || Glance::new(direct, convex.0, to_common, map, CLEARLY_APART, tree.normal());
        let metric = tree.folded(&frame.stretch_of_a().metric(&Stretch::NONE));
        Sight {
            scale: frame.scale,
            query: dispatch!(simd => tree.near_query(simd, box_around, around, metric)),
            glance: wants_any.then(glance).flatten(),
        }
    }
}
