//! The ways on which a body leaves the primitives of a soup that it meets: along which normals contacts are made.

use glam::DVec3;
use solid_convex::Support;

use super::difference::Polytope;
use super::inside::Inside;
use super::meeting::Meeting;
use super::side::Side;
use super::soup_body::Encounter;

/// How the body leaves a primitive.
pub(super) struct Leaving {
    pub primitive: u32,
    pub way: WayOut,
    /// Whether the two meet.
    pub meets: bool,
}

/// The way on which it does.
pub(super) enum WayOut {
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

impl WayOut {
    /// The normal out of the primitive; of what is open its own.
    pub fn out(&self) -> DVec3 {
        match *self {
            WayOut::Shortest { out, .. } => out,
            WayOut::Own(out) | WayOut::Across(out) | WayOut::Open(out) | WayOut::Under(out) => out,
        }
    }
}

impl Encounter<'_> {
    /// How the body leaves all that was found; ascending. Of what stands on a face of the body, its corners in that mostly tell.
    pub fn leaving(&self) -> Vec<Leaving> {
        let (mut told, mut waiting) = (Vec::with_capacity(self.found.len()), Vec::new());
        for &primitive in self.found {
            match self.with_side(primitive, |side| self.at_once(side)) {
                Some(leaving) => told.extend(leaving),
                None => waiting.push(primitive),
            }
        }
        if waiting.is_empty() && told.iter().all(|leaving| matches!(leaving.way, WayOut::Shortest { .. })) {
            return told;
        }
        let at_once = self.standing(&told);
        let late = |&primitive: &u32| {
            self.with_side(primitive, |side| {
                let gentle = at_once.filter(|&(_, out)| side.is_gentle(out));
                let under = gentle.map(|(_, out)| self.known(primitive, WayOut::Under(out)));
                under.filter(|leaving| leaving.meets).or_else(|| self.way_out(side))
            })
        };
        told.extend(waiting.iter().filter_map(late));
        told.sort_by_key(|leaving| leaving.primitive);
        let standing = if waiting.is_empty() { at_once } else { at_once.or_else(|| self.standing(&told)) };
        match standing {
            Some((depth, out)) => told.iter_mut().for_each(|leaving| self.stand(leaving, depth, out)),
            None => told.iter_mut().for_each(|leaving| self.look_around(leaving)),
        }
        told
    }

    /// That of what is on a way, whether it meets the body or is near it.
    fn known(&self, primitive: u32, way: WayOut) -> Leaving {
        Leaving { primitive, way, meets: self.met.binary_search(&primitive).is_ok() }
    }

    /// How the body leaves a primitive, if it does: where the surface is flat around it, or its corners in the body tell, or nothing stands on the body, as
    /// it is round. `None` of others.
    fn at_once(&self, side: &Side) -> Option<Option<Leaving>> {
        let primitive = side.body.primitive;
        if let Some(out) = side.flat() {
            return Some(Some(self.known(primitive, WayOut::Own(out))));
        }
        if !self.other.corners.is_empty() {
            return Some(self.way_out(side));
        }
        let (inside, _) = self.closed_forms();
        let meeting = side.meeting_of_corners(inside.as_ref()?, self.mirrored)?;
        Some(self.way_by(side, meeting).map(|way| Leaving { primitive, way, meets: true }))
    }

    /// How the body leaves a primitive, as far as that alone tells it; `None` where there is no contact.
    pub fn way_out(&self, side: &Side) -> Option<Leaving> {
        let meeting = self.meeting(side)?;
        let way = self.way_by(side, meeting)?;
        Some(Leaving { primitive: side.body.primitive, way, meets: meeting.depth >= 0.0 })
    }

    /// The way, by how the two lie to each other.
    fn way_by(&self, side: &Side, meeting: Meeting) -> Option<WayOut> {
        Some(match side.kept(meeting.normal * self.sign(), meeting.tilt) {
            Some(out) => WayOut::Shortest { out, meeting: Meeting { normal: out * self.sign(), ..meeting } },
            None => WayOut::Open(side.own()?),
        })
    }

    /// Of what is open the normals of the faces around it come into question.
    pub fn look_around(&self, Leaving { primitive, way, .. }: &mut Leaving) {
        if let WayOut::Open(own) = *way {
            let shorter = self.with_side(*primitive, |side| side.shorter_around(own));
            *way = shorter.map_or(WayOut::Own(own), WayOut::Across);
        }
    }

    /// How a primitive and the body lie to each other; `None` when they are further apart than the margin.
    pub fn meeting(&self, side: &Side) -> Option<Meeting> {
        let Encounter { pair, mirrored, .. } = *self;
        // Without a margin all of them are known to meet the body.
        let must = pair.margin == 0.0;
        let (inside, cuboid) = self.closed_forms();
        match side.meeting_of_body(inside.as_ref(), cuboid.as_ref(), mirrored) {
            Some(meeting) if must => Some(meeting.touching()),
            Some(meeting) => meeting.within(pair.margin),
            None => {
                let hull = self.stars.complex.primitive_hull(side.body.primitive);
                let [a, b] = self.in_order::<&dyn Support>(&hull, self.other.support);
                pair.meeting(a, b, must)
            }
        }
    }

    /// What tells in closed form how a triangle lies to the body.
    fn closed_forms(&self) -> &(Option<Inside<'_>>, Option<Polytope>) {
        self.closed_forms.get_or_init(|| {
            let cuboid = (self.pair.margin == 0.0).then(|| Polytope::of(&self.body)).flatten();
            (Inside::new(&self.body, self.found.len()), cuboid)
        })
    }
}
