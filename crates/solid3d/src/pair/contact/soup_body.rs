//! The contacts of a soup and a body.

use std::cell::{Cell, OnceCell};
use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};
use solid_convex::{Support, gjk};

use super::super::reach::core;
use super::super::table::PlacedConvex;
use super::super::{Scratch, complex_convex};
use super::difference::Polytope;
use super::inside::Inside;
use super::other::{Other, highest};
use super::overhang::Overhang;
use super::side::Side;
use super::stars::{LEVEL, Stars};
use super::{Meeting, Pair, Part, Patch, SAME_DEPTH, Touch, face, ridge, standing};
use crate::shape::{Body, Complex};

/// A soup and a body, of which primitives that meet it are looked at one after the other.
struct Encounter<'a> {
    pair: &'a Pair<'a>,
    complex: &'a Complex,
    stars: &'a Stars<'a>,
    body: face::Placed<'a>,
    other: Other<'a>,
    /// What tells in closed form how a triangle lies to the body, once it was asked for.
    told: OnceCell<(Option<Inside<'a>>, Option<Polytope>)>,
    /// The primitives that meet the body, or with a margin are as near to it; ascending.
    found: &'a [u32],
    /// Those that meet it; ascending.
    met: &'a [u32],
    /// Whether the soup is the second of the pair.
    mirrored: bool,
    /// Whether some primitive that meets the body had contacts where they are in each other, and whether some had none.
    answered: Cell<bool>,
    unanswered: Cell<bool>,
}

/// How the body leaves a primitive.
struct Leaving {
    primitive: u32,
    way: Way,
    /// Whether the two meet.
    meets: bool,
}

/// The way on which it does.
enum Way {
    /// The shortest, along a normal that the surface has, and how the two lie to each other along that.
    Shortest { out: DVec3, meeting: Meeting },
    /// Along the normal of a triangle, its own.
    Own(DVec3),
    /// Along that of a face next to it, or of the face of the body that the soup stands on.
    Across(DVec3),
    /// Along its own normal, which this is, or another: the surface does not have that of the shortest.
    Open(DVec3),
    /// Across that face, of what lies along it; where it is not under the face, the shortest is still to be found.
    Under(DVec3),
}

impl Way {
    /// The normal out of the primitive; of what is open its own.
    fn out(&self) -> DVec3 {
        match *self {
            Way::Shortest { out, .. } => out,
            Way::Own(out) | Way::Across(out) | Way::Open(out) | Way::Under(out) => out,
        }
    }
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
        complex,
        stars: &Stars::new(complex, map_soup, found.len()),
        other: Other { primitive: 0, support: *support, map: map_body, corners, radius },
        told: OnceCell::new(),
        found,
        met: &met,
        body: face::Placed::new(kind, map_body),
        mirrored,
        answered: Cell::new(false),
        unanswered: Cell::new(false),
    };
    let mut patches = encounter.patches();
    if encounter.unanswered.get() && !encounter.answered.get() {
        // Where a body leaves an edge last it may lean over that, and not meet it.
        let near = beside_body(soup, convex, 0.0, scratch);
        patches.extend(encounter.patch_at_a_ridge(&near));
    }
    patches
}

impl Encounter<'_> {
    /// The contacts of all that was found, and of what the body leans over.
    fn patches(&self) -> Vec<Patch> {
        let leaving = self.leaving();
        let mut overhang = Overhang::new(self.stars, self.other, self.met);
        let patch = |leaving| self.patch(leaving, &mut overhang);
        let mut patches: Vec<Patch> = leaving.iter().filter_map(patch).collect();
        let behind = overhang.found.iter().filter_map(|&(triangle, out)| self.patch_behind(triangle, out));
        let behind: Vec<Patch> = behind.collect();
        if !behind.is_empty() {
            self.answered.set(true);
            patches.extend(behind);
            patches.sort_by_key(|patch| patch.touches[0].primitives); // stable
        }
        patches
    }

    /// The contacts of a primitive; `None` where there are none.
    fn patch(&self, leaving: &Leaving, overhang: &mut Overhang) -> Option<Patch> {
        self.with_side(leaving.primitive, |side| {
            let (mut out, mut touches) = (leaving.way.out(), self.touches(side, &leaving.way));
            if touches.is_empty()
                && matches!(leaving.way, Way::Under(_))
                && let Some(Leaving { way: way @ Way::Shortest { .. }, .. }) = self.way_out(side)
            {
                (out, touches) = (way.out(), self.touches(side, &way));
            }
            if leaving.meets {
                let is_told = touches.iter().any(|touch| touch.depth >= -SAME_DEPTH);
                (if is_told { &self.answered } else { &self.unanswered }).set(true);
                // A ball that is not stretched meets the triangle in front of its deepest point.
                let is_round = matches!(self.other.corners, [_]);
                if !is_round && side.is_own(out) {
                    overhang.look(leaving.primitive, out);
                }
            }
            self.patch_of(side, out, touches)
        })
    }

    /// The contacts of a triangle that the body does not meet, but is behind.
    fn patch_behind(&self, triangle: u32, out: DVec3) -> Option<Patch> {
        self.with_side(triangle, |side| self.patch_of(side, out, self.over(side, out)))
    }

    /// The contacts across an edge of the surface, which is one of some triangles.
    fn patch_at_a_ridge(&self, triangles: &[u32]) -> Option<Patch> {
        let (triangle, way) = ridge::shortest(self.stars, &self.other, triangles)?;
        self.with_side(triangle, |side| {
            let [a, b] = self.in_order(&side.body, &self.body);
            let touches = self.pair.touches(a, b, &way.meeting(self.mirrored));
            self.patch_of(side, way.out, touches)
        })
    }

    fn with_side<R>(&self, primitive: u32, ask: impl FnOnce(&Side) -> R) -> R {
        let body = Body::of_primitive(self.complex, primitive);
        let corners = self.stars.corners(primitive);
        let placed = face::Placed::of_primitive(&body, primitive, self.stars.map, &corners);
        ask(&Side::new(self.stars, placed, &corners, self.other))
    }

    fn patch_of(&self, side: &Side, out: DVec3, touches: Vec<Touch>) -> Option<Patch> {
        let (normal, is_inward) = (out * self.sign(), side.is_inward(out));
        (!touches.is_empty()).then_some(Patch { normal, touches, is_inward })
    }

    /// How the body leaves all that was found; ascending. Of what stands on a face of the body, its corners in that mostly tell.
    fn leaving(&self) -> Vec<Leaving> {
        let (mut told, mut waiting) = (Vec::with_capacity(self.found.len()), Vec::new());
        // Nothing stands on what is round.
        let is_round = !self.other.corners.is_empty();
        let first = |side: &Side| match self.way_at_once(side) {
            Some(way) => Some(self.known(side.body.primitive, way)),
            None if is_round => self.way_out(side),
            None => None,
        };
        for &primitive in self.found {
            match self.with_side(primitive, first) {
                Some(leaving) => told.push(leaving),
                None if is_round => {}
                None => waiting.push(primitive),
            }
        }
        if waiting.is_empty() && told.iter().all(|leaving| matches!(leaving.way, Way::Shortest { .. })) {
            return told;
        }
        let mut standing = self.standing(&told);
        let late = |&primitive: &u32| {
            self.with_side(primitive, |side| match standing {
                Some((_, out)) if side.is_gentle(out) => Some(self.known(primitive, Way::Under(out))),
                _ => self.way_out(side),
            })
        };
        told.extend(waiting.iter().filter_map(late));
        told.sort_by_key(|leaving| leaving.primitive);
        standing = standing.or_else(|| self.standing(&told).filter(|_| !waiting.is_empty()));
        match standing {
            Some((depth, out)) => self.stand(&mut told, depth, out),
            None => told.iter_mut().for_each(|leaving| self.look_around(leaving)),
        }
        told
    }

    fn known(&self, primitive: u32, way: Way) -> Leaving {
        Leaving { primitive, way, meets: self.met.binary_search(&primitive).is_ok() }
    }

    /// The way out of a primitive, where the surface is flat around it, or its corners in the body tell.
    fn way_at_once(&self, side: &Side) -> Option<Way> {
        if let Some(out) = side.flat() {
            return Some(Way::Own(out));
        }
        let (inside, _) = self.told();
        self.way_by(side, side.meeting_of_corners(inside.as_ref()?, self.mirrored)?)
    }

    /// How the body leaves a primitive, as far as that alone tells it; `None` where there is no contact.
    fn way_out(&self, side: &Side) -> Option<Leaving> {
        let meeting = self.meeting(side)?;
        let way = self.way_by(side, meeting)?;
        Some(Leaving { primitive: side.body.primitive, way, meets: meeting.depth >= 0.0 })
    }

    fn way_by(&self, side: &Side, meeting: Meeting) -> Option<Way> {
        Some(match side.kept(meeting.normal * self.sign(), meeting.tilt) {
            Some(out) if side.is_cut_short(out, self.found) => Way::Own(-out),
            Some(out) => Way::Shortest { out, meeting: Meeting { normal: out * self.sign(), ..meeting } },
            None => Way::Open(side.own()?),
        })
    }

    /// The way across a face of the body, and how long it is, if the soup is known to stand on one.
    fn standing(&self, told: &[Leaving]) -> Option<(f64, DVec3)> {
        let ways = told.iter().filter_map(|leaving| match leaving.way {
            Way::Shortest { out, meeting } => Some((meeting.depth, out)),
            _ => None,
        });
        let has_left = |primitive, way| self.has_left(primitive, way);
        standing::way(ways, &self.body, &self.other, self.stars, self.found, has_left)
    }

    /// Where the soup stands on a face of the body, that is left along its normal by all whose way would be longer.
    fn stand(&self, told: &mut [Leaving], depth: f64, out: DVec3) {
        let lowest = self.other.lowest(out);
        for Leaving { primitive, way, .. } in told {
            let is_longer = |own: DVec3| {
                let corners = self.stars.corners(*primitive);
                (highest(&corners, out) - lowest).min(depth) < self.other.depth(&corners, own) - LEVEL
            };
            match *way {
                Way::Open(_) => *way = Way::Across(out),
                Way::Own(own) if is_longer(own) => *way = Way::Across(out),
                _ => {}
            }
        }
    }

    /// Where it does not, the normals of the faces around a primitive come into question.
    fn look_around(&self, Leaving { primitive, way, .. }: &mut Leaving) {
        if let Way::Open(own) = *way {
            let shorter = self.with_side(*primitive, |side| side.shorter_around(own));
            *way = shorter.map_or(Way::Own(own), Way::Across);
        }
    }

    /// Whether the body does not meet a primitive, once it went some way. Space: common.
    fn has_left(&self, primitive: u32, way: DVec3) -> bool {
        let mut moved = self.other.map.affine;
        moved.translation += way;
        let hull = self.complex.primitive_hull(primitive);
        let found = gjk::intersection(self.other.support, &moved, &hull, &self.stars.map.affine);
        matches!(found, gjk::Outcome::Separated { .. })
    }

    /// The contacts along the way out of a primitive, if any.
    fn touches(&self, side: &Side, way: &Way) -> Vec<Touch> {
        let [a, b] = self.in_order(&side.body, &self.body);
        match *way {
            Way::Shortest { meeting, .. } => self.pair.touches(a, b, &meeting),
            Way::Across(out) | Way::Under(out) if !self.body.is_ball() => {
                self.pair.across(a, b, out * self.sign())
            }
            _ => self.over(side, way.out()),
        }
    }

    /// How a primitive and the body lie to each other; `None` when they are further apart than the margin.
    fn meeting(&self, side: &Side) -> Option<Meeting> {
        let Encounter { pair, mirrored, .. } = *self;
        // Without a margin all of them are known to meet the body.
        let must = pair.margin == 0.0;
        let (inside, cuboid) = self.told();
        match side.meeting_of_body(inside.as_ref(), cuboid.as_ref(), mirrored) {
            Some(meeting) if must => Some(meeting.touching()),
            Some(meeting) => meeting.within(pair.margin),
            None => {
                let hull = self.complex.primitive_hull(side.body.primitive);
                let [a, b] = self.in_order::<&dyn Support>(&hull, self.other.support);
                pair.meeting(a, b, must)
            }
        }
    }

    /// What tells in closed form how a triangle lies to the body.
    fn told(&self) -> &(Option<Inside<'_>>, Option<Polytope>) {
        self.told.get_or_init(|| {
            let cuboid = (self.pair.margin == 0.0).then(|| Polytope::of(&self.body)).flatten();
            (Inside::new(&self.body, self.found.len()), cuboid)
        })
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

    /// What is of the first shape, then what is of the second.
    fn in_order<T>(&self, of_soup: T, of_body: T) -> [T; 2] {
        if self.mirrored { [of_body, of_soup] } else { [of_soup, of_body] }
    }

    /// A normal out of the soup times this leads from the second shape to the first.
    fn sign(&self) -> f64 {
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
