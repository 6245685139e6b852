//! The planes of all faces of a polytope, four side by side: how deep a point is below them, and where a line crosses them.

use fearless_simd::{Simd, f64x4, i64x4, mask64x4, prelude::*};
use glam::DVec3;

use super::plane::Plane;
use crate::gjk::CAST_ERROR;

/// Planes that are looked at at once.
const LANES: usize = 4;

/// The error of a height in that of a normal, which turns the plane about a corner, and what is rounded: beside the way from the centre and the reach.
const HEIGHT_SLACK: f64 = 2.0;

/// How much of a distance may be left open, and how much normals of one plane may be apart: beside the way from the centre and the reach.
const OPEN_MAX: f64 = 5e-14;

/// Four planes: inside is what is at least `offset` along the unit normal `inward`, seen from the centre; the normal may be off by `error`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Row {
    inward: [[f64; LANES]; 3],
    offset: [f64; LANES],
    error: [f64; LANES],
}

/// The planes of all faces of a polytope, seen from its centre. Invariant: there are some, and their numbers are finite.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    /// Filled up with the last plane.
    rows: Box<[Row]>,
    /// How far the polytope reaches from the centre: the greatest sum of the coordinates' magnitudes.
    reach: f64,
}

/// The face of a polytope that is towards a point: of those that the point is above, the one that it is furthest above; else the one that it is least below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceTowards {
    /// How far the point is above the plane of the face; negative inside of the polytope. The distance from the polytope is no less, up to 1e-13 of its size
    /// and the way there.
    pub distance: f64,
    /// The outward normal of the face, a unit vector.
    pub normal: DVec3,
    /// Whether the face is what is nearest to the point, of the surface, and the distance that from it: wherever that is sure, so nearly everywhere inside.
    pub is_nearest: bool,
}

/// Where a line crosses a plane, and the inward normal of that.
pub(crate) type Crossing = (f64, DVec3);

/// What planes tell of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Passage {
    /// It surely has no point in common with the polytope.
    Beside,
    /// It surely has some: from the one place to the other, which is no less.
    Through([Crossing; 2]),
    /// It is next to an edge, or a plane there is that of a sliver.
    Unsure,
}

impl Planes {
    /// `None` where there are none, or not all have a normal. The polytope is the hull of `points`.
    pub(super) fn new(planes: &[Plane], points: &[DVec3], center: DVec3) -> Option<Planes> {
        let last = planes.last()?;
        let row = |four: &[Plane]| {
            let lane = |i: usize| four.get(i).unwrap_or(last);
            Row {
                inward: [0, 1, 2].map(|axis| std::array::from_fn(|i| lane(i).inward[axis])),
                offset: std::array::from_fn(|i| lane(i).inward.dot(lane(i).corner - center)),
                error: std::array::from_fn(|i| lane(i).error),
            }
        };
        let reach = points.iter().map(|&point| (point - center).abs().element_sum()).fold(0.0, f64::max);
        let are_known = planes.iter().all(|plane| plane.inward.is_finite() && plane.error.is_finite());
        are_known.then(|| Planes { rows: planes.chunks(LANES).map(row).collect(), reach })
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.rows)
    }

    /// Whether a ball is surely inside of all, of which the centre is so far from theirs.
    #[inline(always)]
    pub fn contain<S: Simd>(&self, simd: S, way: DVec3, radius: f64) -> bool {
        let slack = f64x4::splat(simd, HEIGHT_SLACK * (way.abs().element_sum() + self.reach));
        for Row { inward, offset, error } in &self.rows {
            let height = rates(simd, inward, way) - lanes(simd, offset);
            let least = height - lanes(simd, error) * slack;
            if !least.simd_ge(f64x4::splat(simd, radius)).all_true() {
                return false;
            }
        }
        true
    }

    /// The face that a point, so far from the centre, is least below, or most above; `None` where rounding leaves that open, among slivers.
    #[inline(always)]
    pub fn towards<S: Simd>(&self, simd: S, way: DVec3) -> Option<FaceTowards> {
        let size = way.abs().element_sum() + self.reach;
        let slack = f64x4::splat(simd, HEIGHT_SLACK * size);
        let all = mask64x4::from_bitmask(simd, 0b1111);
        let mut index = i64x4::simd_from(simd, [0, 1, 2, 3]);
        let mut ends = Ends::new(simd);
        for Row { inward, offset, error } in &self.rows {
            let above = lanes(simd, offset) - rates(simd, inward, way);
            ends.take(all, above, above + lanes(simd, error) * slack, index);
            index += i64x4::splat(simd, LANES as i64);
        }
        let End { from: distance, until, index } = ends.last();
        // Nor of what is no number.
        let is_told = until - distance <= OPEN_MAX * size;
        if !is_told {
            return None;
        }
        let inward = self.inward(index);
        // Surely inside of all, which nothing is of what is flat, or on the face.
        let is_nearest = until < 0.0 || self.has_on_face(simd, way + inward * distance, inward, slack);
        Some(FaceTowards { distance, normal: -inward, is_nearest })
    }

    /// Whether a point of the plane of a face, seen from the centre, surely is on that face: inside of all others, but those in the same plane.
    #[inline(always)]
    fn has_on_face<S: Simd>(&self, simd: S, point: DVec3, inward: DVec3, slack: f64x4<S>) -> bool {
        let same = f64x4::splat(simd, OPEN_MAX);
        for Row { inward: normals, offset, error } in &self.rows {
            let error = lanes(simd, error);
            let height = rates(simd, normals, point) - lanes(simd, offset);
            let is_below = height.simd_ge((error + same) * slack);
            // Planes that are one up to that: the point is no further outside of any.
            let mut turn = error;
            for (of_all, of_face) in normals.iter().zip(inward.to_array()) {
                turn += (lanes(simd, of_all) - f64x4::splat(simd, of_face)).abs();
            }
            if !(is_below | turn.simd_le(same)).all_true() {
                return false;
            }
        }
        true
    }

    /// The normal of a plane.
    fn inward(&self, index: usize) -> DVec3 {
        DVec3::from_array(self.rows[index / LANES].inward.map(|row| row[index % LANES]))
    }

    /// Where a line runs through the polytope: the points `center + foot + t * along`. The foot is the point of the line closest to the centre, the
    /// longest coordinate of `along` from 1 to 2.
    ///
    /// Each plane may be off by no more than a slack, in the box around the polytope that is twice as wide. It is crossed then in an interval of `t`, and the
    /// polytope is entered in no later than at the last end of those of planes that are entered.
    #[inline(always)]
    pub fn passage<S: Simd>(&self, simd: S, foot: DVec3, along: DVec3) -> Passage {
        /// The error of a normal, times the way from the corner, and what is rounded in heights and rates, beside the reach.
        const SLACK: f64 = 6.0;
        let size = self.reach;
        if foot.abs().max_element() > 2.0 * size {
            return Passage::Beside;
        }
        let (zero, one) = (f64x4::splat(simd, 0.0), f64x4::splat(simd, 1.0));
        let widest = f64x4::splat(simd, SLACK * size);
        let mut index = i64x4::simd_from(simd, [0, 1, 2, 3]);
        let mut ends = [Ends::new(simd); 2];
        for Row { inward, offset, error } in &self.rows {
            let rate = rates(simd, inward, along);
            let outside = lanes(simd, offset) - rates(simd, inward, foot);
            let slack = lanes(simd, error) * widest;
            // Of a plane that the line is parallel to, an end is endless on the side that it is on; or no number, which is passed over.
            let unit = one / rate.abs();
            let (from, until) = ((outside - slack) * unit, (outside + slack) * unit);
            let enters = rate.simd_ge(zero);
            ends[0].take(enters, from, until, index);
            ends[1].take(!enters, from, until, index);
            index += i64x4::splat(simd, LANES as i64);
        }
        // Where it is left, all is seen backwards: from the last.
        let [enter, leave] = ends.map(Ends::last);
        if enter.from + leave.from > 0.0 {
            return Passage::Beside;
        }
        let crossings = [enter, leave].map(|end| self.crossing(end.index, foot, along));
        let is_near = |&(t, _): &Crossing| (foot + along * t).abs().element_sum() <= 2.0 * size;
        let is_sharp = |end: &End| end.until - end.from <= 0.1 * CAST_ERROR * size;
        if enter.until + leave.until <= 0.0
            && [enter, leave].iter().all(is_sharp)
            && crossings.iter().all(is_near)
        {
            return Passage::Through(crossings);
        }
        Passage::Unsure
    }

    /// Where a line crosses a plane.
    fn crossing(&self, index: usize, foot: DVec3, along: DVec3) -> Crossing {
        let (inward, offset) = (self.inward(index), self.rows[index / LANES].offset[index % LANES]);
        ((offset - inward.dot(foot)) / inward.dot(along), inward)
    }
}

#[inline(always)]
fn lanes<S: Simd>(simd: S, row: &[f64; LANES]) -> f64x4<S> {
    f64x4::simd_from(simd, *row)
}

/// How far a way goes along each of four normals.
#[inline(always)]
fn rates<S: Simd>(simd: S, [x, y, z]: &[[f64; LANES]; 3], way: DVec3) -> f64x4<S> {
    lanes(simd, x) * f64x4::splat(simd, way.x)
        + lanes(simd, y) * f64x4::splat(simd, way.y)
        + lanes(simd, z) * f64x4::splat(simd, way.z)
}

/// The last of intervals, one for each plane, in each lane.
#[derive(Clone, Copy)]
struct Ends<S: Simd> {
    from: f64x4<S>,
    until: f64x4<S>,
    /// The plane with that `from`.
    index: i64x4<S>,
}

/// The last of the intervals of all planes: the last beginning, with its plane, and the last end.
#[derive(Clone, Copy)]
struct End {
    from: f64,
    until: f64,
    index: usize,
}

impl<S: Simd> Ends<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let none = f64x4::splat(simd, f64::NEG_INFINITY);
        Ends { from: none, until: none, index: i64x4::splat(simd, 0) }
    }

    #[inline(always)]
    fn take(&mut self, are: mask64x4<S>, from: f64x4<S>, until: f64x4<S>, index: i64x4<S>) {
        let later = are & from.simd_gt(self.from);
        self.from = later.select(from, self.from);
        self.index = later.select(index, self.index);
        self.until = (are & until.simd_gt(self.until)).select(until, self.until);
    }

    /// Of equal beginnings, that of the first plane.
    #[inline(always)]
    fn last(self) -> End {
        let (from, until, index) = (self.from.as_slice(), self.until.as_slice(), self.index.as_slice());
        let end = |lane: usize| End { from: from[lane], until: until[lane], index: index[lane] as usize };
        (1..LANES).map(end).fold(end(0), |last, end| {
            let is_later = end.from > last.from || end.from == last.from && end.index < last.index;
            End { until: last.until.max(end.until), ..if is_later { end } else { last } }
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use solid_oracle::generate::{in_cube, seeded};

    use super::*;
    use crate::simd::{dispatch, levels};
    use crate::testing::{block, octahedron_faces};
    use crate::{Polytope, Support, gjk};

    fn octahedron() -> Planes {
        let corners = DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]).collect::<Vec<_>>();
        Planes::new(&Plane::all(&corners, &octahedron_faces()), &corners, DVec3::ZERO).unwrap()
    }

    /// Law: no point is nearer than its face tells, and as far where that is nearest; on every level. Faces that lie in one plane are one.
    #[test]
    fn a_face_is_as_far_as_gjk_tells() {
        let mut rng = seeded(49);
        let here = DAffine3::IDENTITY;
        let corners: Vec<DVec3> = DVec3::AXES.iter().flat_map(|&axis| [axis * 1.5, -axis]).collect();
        for (corners, faces) in [(corners, octahedron_faces()), block(DVec3::new(1.0, 0.5, 2.0))] {
            let hull = Polytope::new(corners).unwrap().with_faces(&faces);
            let (mut nearest, mut inside) = (0, 0);
            for _ in 0..2000 {
                let point = hull.center() + in_cube(&mut rng) * 1.5;
                let levels = levels()
                    .map(|level| dispatch!(level, simd => hull.planes().unwrap().towards(simd, point - hull.center())));
                assert_eq!(levels[0], levels[1], "{point}");
                let face = levels[0].unwrap();
                let dot = Polytope::new(vec![point]).unwrap();
                let slow = gjk::closest_points(&dot, &here, &hull, &here).distance;
                assert!(face.distance <= slow + 1e-14, "{point}: {face:?}, {slow}");
                if face.is_nearest {
                    nearest += 1;
                    assert!((face.distance.max(0.0) - slow).abs() < 1e-14, "{point}: {face:?}, {slow}");
                }
                if face.distance < 0.0 {
                    inside += 1;
                    let out = Polytope::new(vec![point - face.normal * (face.distance - 1e-9)]).unwrap();
                    assert!(
                        gjk::closest_points(&out, &here, &hull, &here).distance > 0.9e-9,
                        "{point}: {face:?}"
                    );
                }
            }
            assert!(nearest > 200 && inside > 50, "{nearest} are nearest, {inside} inside");
        }
    }

    /// Law: every level tells the same of a line.
    #[test]
    fn every_level_sees_the_same_passage() {
        let mut rng = seeded(47);
        let planes = octahedron();
        let mut told = [0; 2];
        for _ in 0..2000 {
            let (point, along) = (in_cube(&mut rng), in_cube(&mut rng));
            let along = along / along.abs().max_element();
            let foot = point - along * (point.dot(along) / along.length_squared());
            let [scalar, wide] =
                levels().map(|level| dispatch!(level, simd => planes.passage(simd, foot, along)));
            assert_eq!(scalar, wide, "{foot} {along}");
            told[0] += usize::from(scalar == Passage::Beside);
            told[1] += usize::from(matches!(scalar, Passage::Through(_)));
        }
        assert!(told.iter().all(|&told| told > 400), "{told:?}");
    }

    /// Law: what is told of lines next to an edge is right; and of all but those that rounding might turn, something is told.
    #[test]
    fn what_is_told_next_to_an_edge_is_right() {
        let mut rng = seeded(48);
        let planes = octahedron();
        let mut open = 0;
        for case in 0..2000 {
            // So few digits that the edge above `x` is exact; on which side of it `y` is, is the sign of a difference.
            let x = (in_cube(&mut rng).x.abs() * 1024.0).floor() / 1024.0;
            let y = (1.0 - x) + in_cube(&mut rng).y * 10f64.powi(-(case % 18));
            let above = y.abs() - (1.0 - x);
            match dispatch!(simd => planes.passage(simd, DVec3::new(x, y, 0.0), DVec3::Z)) {
                Passage::Beside => assert!(above > 0.0, "{x} {above:e}"),
                Passage::Through([enter, leave]) => {
                    assert!(above <= 0.0, "{x} {above:e}");
                    assert!((leave.0 + above).abs() < 1e-15 && enter.0 == -leave.0, "{x} {above:e}");
                }
                Passage::Unsure => {
                    open += 1;
                    assert!(above.abs() < 1e-12, "{x} {above:e}");
                }
            }
        }
        assert!((100..1000).contains(&open), "{open}");
    }
}
