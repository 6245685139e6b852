//! What single primitives and leaves are held against.

use std::cell::OnceCell;

use glam::DAffine3;

use super::super::direct::Direct;
use super::super::frame::{Frame, size};
use super::super::table::{PlacedComplex, PlacedConvex};
use super::CLEARLY_APART;
use super::interior::Interior;
use super::shadow::Shadow;

/// For any placements.
pub(super) struct Details<'s> {
    pub frame: Frame,
    pub direct: Direct,
    /// Where primitives are placed: in the common frame, or the space of a box.
    pub map: DAffine3,
    pub shadow: Shadow<'s>,
    /// What finds corners in the shape, once a primitive is looked at by itself.
    pub interior: OnceCell<Interior<'s>>,
}

impl<'s> Details<'s> {
    #[inline(always)] // made where it stays: it is large
    pub fn new(frame: Frame, convex: PlacedConvex<'s>) -> Self {
        let direct = Direct::new(convex.0, &frame, CLEARLY_APART);
        let map = match &direct {
            Direct::Cube(cube) => cube.map,
            _ => frame.common[0],
        };
        let shadow = Shadow::new(convex.0, &frame, CLEARLY_APART);
        Details { frame, direct, map, shadow, interior: OnceCell::new() }
    }

    /// Those that there are, or new ones in a common frame of which world lengths times `scale` are lengths.
    #[inline(always)]
    pub fn of<'d>(
        details: &'d mut Option<Self>,
        complex: PlacedComplex,
        convex: PlacedConvex<'s>,
        scale: f64,
    ) -> &'d mut Self {
        if details.is_none() {
            fill(details, complex, convex, scale);
        }
        details.as_mut().expect("they were made")
    }
}

/// Out of the way of the walk.
#[cold]
#[inline(never)]
fn fill<'s>(details: &mut Option<Details<'s>>, complex: PlacedComplex, convex: PlacedConvex<'s>, scale: f64) {
    let size = size([complex.1, convex.1], [complex.0.reach(), convex.0.reach()]);
    *details = Some(Details::new(Frame::scaled(complex.1, convex.1, size, scale), convex));
}
