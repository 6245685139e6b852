//! The contacts of the pairs of primitives of two soups, with normals that the surfaces have.
//!
//! Where the surface is flat all around a triangle it has one normal only, and no penetration depth needs to be searched for; else that
//! is corrected as [`side`](super::side) says.

use std::cell::LazyCell;

use glam::DVec3;

use super::super::Scratch;
use super::ball::Way;
use super::difference::{self, Polytope};
use super::meeting::{Meeting, deepest};
use super::near_pairs::near_pairs;
use super::other::Other;
use super::places::{told, untold};
use super::side::{Corrected, Side};
use super::stars::{LEVEL, Stars};
use super::whole::{nearest, whole};
use super::{Pair, Patch, SAME_DEPTH, Touch, face};
use crate::shape::{Body, Complex};

/// The contacts of two soups.
pub(super) fn soup_soup(pair: &Pair, a: &Complex, b: &Complex, scratch: &mut Scratch) -> Vec<Patch> {
    let Some(found) = near_pairs(pair, [a, b], scratch) else {
        return whole(pair, scratch).or_else(|| nearest(pair, scratch)).into_iter().collect();
    };
    let stars = [&Stars::new(a, &pair.maps[0], found.len()), &Stars::new(b, &pair.maps[1], found.len())];
    let soups = Soups { pair, stars };
    let mut patches: Vec<Patch> =
        found.iter().filter_map(|&(primitives, must)| soups.patch(primitives, must)).collect();
    let met: Vec<[u32; 2]> =
        found.iter().filter(|(_, must)| *must).map(|(primitives, _)| *primitives).collect();
    let places = untold([Some(a), Some(b)], &met, &told(&patches, []));
    patches.extend(places.iter().filter_map(|place| soups.deepest(place)));
    patches
}

/// Two soups, of which pairs of primitives are looked at one after the other.
struct Soups<'a> {
    pair: &'a Pair<'a>,
    stars: [&'a Stars<'a>; 2],
}

impl Soups<'_> {
    /// The contacts of two primitives, along a normal that the surfaces have; `None` where there are none. `must` says that they are known to meet.
    fn patch(&self, primitives: [u32; 2], must: bool) -> Option<Patch> {
        self.with_sides(primitives, must, |sides, meeting| {
            let (normal, touches) = match level_touches(self.pair, sides, must, meeting) {
                Some(found) => found,
                None => touches(self.pair, sides, &meeting()?)?,
            };
            patch_of(sides, normal, touches)
        })
    }

    /// The contacts of those of some pairs that are deepest in each other; they do not leave a solid for its inside.
    fn deepest(&self, pairs: &[[u32; 2]]) -> Option<Patch> {
        let meeting = |&primitives: &[u32; 2]| {
            self.with_sides(primitives, true, |sides, meeting| {
                let meeting = meeting().filter(|meeting| !is_inward(sides, meeting.normal))?;
                Some((primitives, meeting))
            })
        };
        let (primitives, meeting) = deepest(pairs.iter().filter_map(meeting))?;
        self.with_sides(primitives, true, |sides, _| {
            let touches = self.pair.touches(&sides[0].body, &sides[1].body, &meeting);
            patch_of(sides, meeting.normal, touches)
        })
    }

    /// What there is to say of two primitives by the surface of each, and by how they lie to each other; `None` where that is further apart than the margin.
    fn with_sides<R>(
        &self,
        [i, j]: [u32; 2],
        must: bool,
        ask: impl FnOnce([&Side; 2], &dyn Fn() -> Option<Meeting>) -> Option<R>,
    ) -> Option<R> {
        let Soups { pair, stars: [stars_a, stars_b] } = *self;
        let (hull_a, hull_b) = (stars_a.complex.primitive_hull(i), stars_b.complex.primitive_hull(j));
        let (body_a, body_b) =
            (Body::of_primitive(stars_a.complex, i), Body::of_primitive(stars_b.complex, j));
        let (corners_a, corners_b) = (stars_a.corners(i), stars_b.corners(j));
        let [map_a, map_b] = &pair.maps;
        let placed_a = face::Placed::of_primitive(&body_a, i, map_a, &corners_a);
        let placed_b = face::Placed::of_primitive(&body_b, j, map_b, &corners_b);
        let other_a = Other { primitive: i, support: &hull_a, map: map_a, corners: &corners_a, radius: 0.0 };
        let other_b = Other { primitive: j, support: &hull_b, map: map_b, corners: &corners_b, radius: 0.0 };
        let of_a = Side::new(stars_a, placed_a, other_b);
        let of_b = Side::new(stars_b, placed_b, other_a);
        let meeting = LazyCell::new(|| match must.then(|| way_of([&corners_a, &corners_b])).flatten() {
            Some(way) => Some(way.meeting(false).touching()),
            None => pair.meeting(&hull_a, &hull_b, must),
        });
        ask([&of_a, &of_b], &|| *meeting)
    }
}

/// Whether a normal, given from the second to the first, points into a solid.
fn is_inward([of_a, of_b]: [&Side; 2], normal: DVec3) -> bool {
    of_a.is_inward(-normal) || of_b.is_inward(normal)
}

fn patch_of(sides: [&Side; 2], normal: DVec3, touches: Vec<Touch>) -> Option<Patch> {
    (!touches.is_empty()).then(|| Patch { normal, touches, is_inward: is_inward(sides, normal) })
}

/// The contacts of two triangles of which one has all around it in its plane, along the normal of that, unless the other is larger; of two such along that
/// of the larger soup.
fn level_touches(
    pair: &Pair,
    sides: [&Side; 2],
    must: bool,
    meeting: &dyn Fn() -> Option<Meeting>,
) -> Option<(DVec3, Vec<Touch>)> {
    let of_first = match sides.map(Side::is_level) {
        [false, false] => return None,
        [true, true] => sides[0].is_of_larger(sides[1])?,
        [is_first, _] => is_first,
    };
    let [level, beside] = if of_first { sides } else { [sides[1], sides[0]] };
    beside.body.plane?;
    if !beside.is_level() && beside.is_wider(level) {
        return None;
    }
    if !level.is_flat() {
        // Where it ends, the surface has other normals.
        let Meeting { normal, tilt, .. } = meeting()?;
        let corrected = level.corrected(if of_first { -normal } else { normal }, tilt)?;
        if !level.is_own(corrected.normal()) {
            return None;
        }
    }
    let (normal, mut touches) = own_touches(pair, sides, of_first)?;
    // What does not meet is not in each other either, but on the other side.
    touches.retain(|touch| must || touch.depth <= SAME_DEPTH);
    // Nothing is left where the soup is beyond the plane as a whole, but not here, as what reaches around an end of the triangle.
    (!touches.is_empty()).then_some((normal, touches))
}

/// The contacts of two primitives along the normal of one, which is a triangle; `of_first` says whose.
fn own_touches(pair: &Pair, [of_a, of_b]: [&Side; 2], of_first: bool) -> Option<(DVec3, Vec<Touch>)> {
    let normal = if of_first { -of_a.own_beside(of_b)? } else { of_b.own_beside(of_a)? };
    Some((normal, pair.over(&of_a.body, &of_b.body, normal, of_first)))
}

/// The contacts of two primitives, along a normal that the surfaces have; `None` where there is none. Where one surface does not have that along which they
/// are left, it is the normal of a triangle: of the larger one, if that may be, but where that is much longer a way than that of the other. A floor that hangs over
/// a wall by less than the wall is in it is left upwards, not along itself as far as it reaches.
fn touches(pair: &Pair, [of_a, of_b]: [&Side; 2], meeting: &Meeting) -> Option<(DVec3, Vec<Touch>)> {
    let on_b = of_b.corrected(meeting.normal, meeting.tilt)?;
    let on_a = || of_a.corrected(-meeting.normal, meeting.tilt);
    let is_replaced = |on: Corrected| matches!(on, Corrected::Replaced(_));
    let own = |of_first: bool| {
        let (chosen, other) = if of_first { (of_a, of_b) } else { (of_b, of_a) };
        let is_long = meeting.depth >= 0.0 && is_long(chosen, other);
        own_touches(pair, [of_a, of_b], of_first != is_long)
    };
    if is_replaced(on_b) {
        return own(of_a.is_wider(of_b) && on_a().is_some_and(|on_a| of_a.is_own(on_a.normal())));
    }
    let on_a = on_a()?;
    if is_replaced(on_a) {
        return own(!(of_b.is_wider(of_a) && of_b.is_own(on_b.normal())));
    }
    let (in_a, in_b) = (&of_a.body, &of_b.body);
    Some(match (on_a, on_b) {
        (_, Corrected::Adopted(normal)) => (normal, pair.across(in_a, in_b, normal)),
        (Corrected::Adopted(normal), _) => (-normal, pair.across(in_a, in_b, -normal)),
        (_, kept) => {
            let meeting = Meeting { normal: kept.normal(), ..*meeting };
            (meeting.normal, pair.touches(in_a, in_b, &meeting))
        }
    })
}

/// Whether the normal of one of two triangles that meet is much longer a way than that of the other.
fn is_long(chosen: &Side, other: &Side) -> bool {
    /// How many times as long it may be.
    const LONG: f64 = 4.0;
    let depths = chosen.own_depth(other).zip(other.own_depth(chosen));
    depths.is_some_and(|(chosen, other)| chosen > LONG * other + LEVEL)
}

/// The shortest way out of two triangles that have a common point.
fn way_of(corners: [&[DVec3]; 2]) -> Option<Way> {
    let [&[p, q, r], &[x, y, z]] = corners else { return None };
    difference::way(&Polytope::triangle([p, q, r]), &Polytope::triangle([x, y, z]))
}
