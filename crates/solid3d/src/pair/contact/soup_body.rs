//! The contacts of a soup and a body.

use std::cell::OnceCell;
use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};

use super::super::reach::core;
use super::super::table::PlacedConvex;
use super::super::{Scratch, complex_convex};
use super::cover::Cover;
use super::difference::Polytope;
use super::inside::Inside;
use super::leaving::{Leaving, WayOut};
use super::meeting::{Meeting, deepest};
use super::other::Other;
use super::overhang::Overhang;
use super::places::{told, untold};
use super::side::Side;
use super::stars::Stars;
use super::{Feature, Pair, Part, Patch, SAME_DEPTH, Touch, face, ridge};
use crate::shape::{Body, Complex};

/// A soup and a body, of which primitives that meet it are looked at one after the other.
pub(super) struct Encounter<'a> {
    pub pair: &'a Pair<'a>,
    pub stars: &'a Stars<'a>,
    pub body: face::Placed<'a>,
    pub other: Other<'a>,
    /// What tells in closed form how a triangle lies to the body, once they were asked for.
    pub closed_forms: OnceCell<(Option<Inside<'a>>, Option<Polytope>)>,
    /// The primitives that meet the body, or with a margin are as near to it; ascending.
    pub found: &'a [u32],
    /// Those that meet it; ascending.
    pub met: &'a [u32],
    /// Whether the soup is the second of the pair.
    pub mirrored: bool,
}

/// The contacts of a soup and a body; `mirrored` when the soup is the second of the pair.
pub(super) fn soup_body(
    pair: &Pair,
    soup: &Part,
    body: &Part,
    mirrored: bool,
    scratch: &mut Scratch,
) -> Vec<Patch> {
    let (&Part::Soup(complex), Part::Body(kind, support)) = (soup, body) else { return Vec::new() };
    let (placed_soup, placed_body) = if mirrored { (pair.b, pair.a) } else { (pair.a, pair.b) };
    let [map_a, map_b] = &pair.maps;
    let [map_soup, map_body] = if mirrored { [map_b, map_a] } else { [map_a, map_b] };
    let convex: PlacedConvex = (*support, placed_body.placement);
    let soup = (complex, placed_soup.placement);
    let met = met_by_body(soup, convex, scratch);
    let near = (pair.margin > 0.0).then(|| {
        let (_, margins) = pair.margins(&pair.placing());
        beside_body(soup, convex, margins[usize::from(mirrored)], scratch)
    });
    let found = near.as_ref().unwrap_or(&met);
    if found.is_empty() {
        return Vec::new();
    }
    let round = core(*support).zip(map_body.stretch());
    let (ends, radius) = round.map_or(([DVec3::ZERO; 2], 0.0), |((ends, radius), stretch)| {
        (ends.map(|end| map_body.point(end)), radius * stretch)
    });
    let corners = match round {
        Some(_) if ends[0] == ends[1] => &ends[..1],
        Some(_) => &ends[..],
        None => &[],
    };
    let encounter = Encounter {
        pair,
        stars: &Stars::new(complex, map_soup, found.len()),
        other: Other { primitive: 0, support: *support, map: map_body, corners, radius },
        closed_forms: OnceCell::new(),
        found,
        met: &met,
        body: face::Placed::new(kind, map_body),
        mirrored,
    };
    let (mut patches, led) = encounter.patches();
    let told = told(&patches, encounter.pairs(&led));
    let places = untold(encounter.soups(), &encounter.pairs(&met), &told);
    if !places.is_empty() {
        // Where a body leaves an edge last it may lean over that, and not meet it.
        let mut near = beside_body(soup, convex, 0.0, scratch);
        near.extend(&met);
        near.sort_unstable();
        near.dedup();
        let mut near = encounter.pairs(&near);
        near.retain(|pair| told.binary_search(pair).is_err());
        patches.extend(encounter.patches_of_places(&places, &near));
    }
    patches
}

impl Encounter<'_> {
    /// The contacts of all that was found, and of what the body leans over; and what led to these.
    fn patches(&self) -> (Vec<Patch>, Vec<u32>) {
        let leaving = self.leaving();
        let cover = self.cover(&leaving);
        let mut overhang = Overhang::new(self.stars, self.other, self.met);
        let patch = |leaving| self.patch(leaving, cover.as_ref(), &mut overhang);
        let mut patches = Vec::with_capacity(leaving.len());
        patches.extend(leaving.iter().filter_map(patch));
        let mut led = Vec::new();
        for &(first, triangle, out) in &overhang.found {
            if let Some(patch) = self.patch_behind(triangle, out) {
                patches.push(patch);
                led.push(first);
            }
        }
        (patches, led)
    }

    /// The contacts of a primitive; `None` where there are none.
    fn patch(&self, leaving: &Leaving, cover: Option<&Cover>, overhang: &mut Overhang) -> Option<Patch> {
        self.with_side(leaving.primitive, |side| {
            let mut out = leaving.way.out();
            let one = cover.and_then(|cover| self.touch_under(cover, side, out));
            let mut touches = one.map_or_else(|| self.touches(side, &leaving.way), |touch| vec![touch]);
            if touches.is_empty()
                && matches!(leaving.way, WayOut::Under(_))
                && let Some(Leaving { way: way @ WayOut::Shortest { .. }, .. }) = self.way_out(side)
            {
                (out, touches) = (way.out(), self.touches(side, &way));
            }
            if leaving.meets {
                // A ball that is not stretched meets the triangle in front of its deepest point, a face that covers what it meets those in front of its corners.
                let is_round = matches!(self.other.corners, [_]);
                if !is_round && cover.is_none() && side.is_own(out) {
                    overhang.look(leaving.primitive, out);
                }
            }
            self.patch_of(side, out, touches)
        })
    }

    /// One contact of a triangle under a face that covers all, along its own normal, where it has none that tells how far that reaches.
    fn touch_under(&self, cover: &Cover, side: &Side, out: DVec3) -> Option<Touch> {
        let corner = cover.over(side.body.primitive, side.body.corners)?;
        let (below, at) = (side.body.face(out), side.body.corners[corner]);
        let features = || self.in_order(Feature::Vertex(below.corners[corner].vertex), cover.face.feature());
        let faces = self.in_order((&side.body, &below), (&self.body, &cover.face));
        self.pair.touch(faces, out * self.sign(), at - out * out.dot(at), features)
    }

    /// The contacts of places in which no primitive tells one: across an edge of the surface, which is one of what is connected with them and `near` the body, else where
    /// a primitive of each is deepest in that.
    fn patches_of_places(&self, places: &[Vec<[u32; 2]>], near: &[[u32; 2]]) -> Vec<Patch> {
        let primitive = |pair: &[u32; 2]| pair[usize::from(self.mirrored)];
        let mut patches = Vec::new();
        for around in untold(self.soups(), near, &[]) {
            let place = |pair| places.binary_search_by_key(pair, |place| place[0]).ok();
            let mut places = around.iter().filter_map(place).map(|i| &places[i]).peekable();
            if places.peek().is_none() {
                continue;
            }
            match ridge::shortest(self.stars, &self.other, around.iter().map(primitive)) {
                Some((triangle, way)) => {
                    patches.extend(self.patch_along(triangle, &way.meeting(self.mirrored)))
                }
                None => patches.extend(places.filter_map(|place| {
                    let (primitive, meeting) = self.deepest(place.iter().map(primitive))?;
                    self.patch_along(primitive, &meeting)
                })),
            }
        }
        patches
    }

    /// The contacts of a primitive along a normal.
    fn patch_along(&self, primitive: u32, meeting: &Meeting) -> Option<Patch> {
        self.with_side(primitive, |side| {
            let [a, b] = self.in_order(&side.body, &self.body);
            self.patch_of(side, meeting.normal * self.sign(), self.pair.touches(a, b, meeting))
        })
    }

    /// Of some primitives the one that is deepest in the body; it does not leave a solid for its inside.
    fn deepest(&self, primitives: impl Iterator<Item = u32>) -> Option<(u32, Meeting)> {
        let is_out = |side: &Side, meeting: &Meeting| !side.is_inward(meeting.normal * self.sign());
        let meeting = |side: &Side| self.meeting(side).filter(|meeting| is_out(side, meeting));
        let meetings =
            primitives.filter_map(|primitive| Some((primitive, self.with_side(primitive, meeting)?)));
        deepest(meetings)
    }

    /// The contacts of a triangle that the body does not meet, but is behind.
    fn patch_behind(&self, triangle: u32, out: DVec3) -> Option<Patch> {
        self.with_side(triangle, |side| self.patch_of(side, out, self.over(side, out)))
    }

    pub fn with_side<R>(&self, primitive: u32, ask: impl FnOnce(&Side) -> R) -> R {
        let body = Body::of_primitive(self.stars.complex, primitive);
        let corners = self.stars.corners(primitive);
        let placed = face::Placed::of_primitive(&body, primitive, self.stars.map, &corners);
        ask(&Side::new(self.stars, placed, self.other))
    }

    fn patch_of(&self, side: &Side, out: DVec3, touches: Vec<Touch>) -> Option<Patch> {
        let (normal, is_inward) = (out * self.sign(), side.is_inward(out));
        (!touches.is_empty()).then_some(Patch { normal, touches, is_inward })
    }

    /// The contacts along the way out of a primitive, if any.
    fn touches(&self, side: &Side, way: &WayOut) -> Vec<Touch> {
        let [a, b] = self.in_order(&side.body, &self.body);
        match *way {
            WayOut::Shortest { meeting, .. } => self.pair.touches(a, b, &meeting),
            WayOut::Across(out) | WayOut::Under(out) if !self.body.is_ball() => {
                self.pair.across(a, b, out * self.sign())
            }
            _ => self.over(side, way.out()),
        }
    }

    /// The contacts over a triangle along its own normal, or one that it has taken over.
    fn over(&self, side: &Side, out: DVec3) -> Vec<Touch> {
        let Encounter { pair, mirrored, .. } = *self;
        let [a, b] = self.in_order(&side.body, &self.body);
        if !self.body.is_ball() {
            return pair.over(a, b, out * self.sign(), !mirrored);
        }
        let meeting = side.meeting_of_ball(out, mirrored);
        let near = meeting.and_then(|meeting| meeting.within(pair.margin + SAME_DEPTH));
        near.map_or_else(Vec::new, |meeting| pair.touches(a, b, &meeting))
    }

    /// Primitives with the body, which is one.
    fn pairs(&self, primitives: &[u32]) -> Vec<[u32; 2]> {
        primitives.iter().map(|&primitive| self.in_order(primitive, 0)).collect()
    }

    fn soups(&self) -> [Option<&Complex>; 2] {
        self.in_order(Some(self.stars.complex), None)
    }

    /// What is of the first shape, then what is of the second.
    pub fn in_order<T>(&self, of_soup: T, of_body: T) -> [T; 2] {
        if self.mirrored { [of_body, of_soup] } else { [of_soup, of_body] }
    }

    /// A normal out of the soup times this leads from the second shape to the first.
    pub fn sign(&self) -> f64 {
        if self.mirrored { 1.0 } else { -1.0 }
    }
}

/// The primitives of a soup that meet a body. Ascending: in an order that does not depend on the tree.
fn met_by_body(soup: (&Complex, &DAffine3), body: PlacedConvex, scratch: &mut Scratch) -> Vec<u32> {
    let mut found = Vec::new();
    let _ = complex_convex::meeting_primitives(soup, body, scratch, &mut |primitive, _| {
        found.push(primitive);
        ControlFlow::Continue(())
    });
    found.sort_unstable();
    found
}

/// The primitives of a soup whose boxes are as near to a body as a margin, in the space of the soup. Ascending.
fn beside_body(
    soup: (&Complex, &DAffine3),
    body: PlacedConvex,
    margin: f64,
    Scratch { traversal, primitive_tests, .. }: &mut Scratch,
) -> Vec<u32> {
    let query = complex_convex::convex_in_complex(soup, body).0.inflated(margin);
    let mut found = Vec::new();
    let _ = soup.0.tree().overlapping(&query, traversal, |leaf| {
        found.extend(leaf.iter().filter(|&&i| soup.0.primitive_bounds(i).overlaps(&query)));
        ControlFlow::<()>::Continue(())
    });
    *primitive_tests += found.len() as u64;
    found.sort_unstable();
    found
}
