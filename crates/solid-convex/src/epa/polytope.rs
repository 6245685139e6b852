//! The polytope: vertices, faces, and how it grows.

use std::cell::Cell;

use glam::DVec3;
use robust::orient3d;

use super::VERTICES_MAX;
use super::face::{Face, HalfEdge};
use super::stretch::Stretch;
use crate::Support;
use crate::difference::{Difference, SUPPORT_ERROR, SupportPoint};
use crate::simplex::coord;

/// The hull of some points of `A - B`, with an inside. Invariant: exactly convex and closed, for the vertices as they were rounded;
/// faces may be coplanar.
#[derive(Debug, Default)]
pub(super) struct Polytope {
    vertices: Vec<SupportPoint>,
    faces: Vec<Face>,
    /// For each face its offset while it is still to be looked across, then infinity.
    open: Vec<f64>,
    /// How the space of the vertices was stretched, if it was.
    stretch: Option<Stretch>,
    horizon: Horizon,
}

/// What a point sees of the polytope; working memory.
#[derive(Debug, Default)]
struct Horizon {
    /// The faces that see it.
    seen: Vec<u32>,
    /// The edges of these that are still to be looked across, the next one last.
    pending: Vec<HalfEdge>,
    /// The edges around them, counterclockwise from outside.
    ring: Vec<HorizonEdge>,
}

/// An edge of a face that is seen, whose other face is not.
#[derive(Clone, Copy, Debug)]
struct HorizonEdge {
    start: u32,
    end: u32,
    /// The same edge of the face beyond.
    beyond: HalfEdge,
}

/// The corners of the faces of a tetrahedron whose fourth vertex is below the first three, and the same edges of the faces across.
const TETRAHEDRON: [([u32; 3], [HalfEdge; 3]); 4] = {
    const fn edge(face: u32, corner: u32) -> HalfEdge {
        HalfEdge::new(face, corner)
    }
    [
        ([0, 1, 2], [edge(1, 0), edge(2, 0), edge(3, 0)]),
        ([1, 0, 3], [edge(0, 0), edge(3, 2), edge(2, 1)]),
        ([2, 1, 3], [edge(0, 1), edge(1, 2), edge(3, 1)]),
        ([0, 2, 3], [edge(0, 2), edge(2, 2), edge(1, 1)]),
    ]
};

thread_local! {
    /// A polytope whose memory the next one on this thread takes over: no more than [`VERTICES_MAX`] ask for.
    static SPARE: Cell<Option<Box<Polytope>>> = const { Cell::new(None) };
}

/// Where a point is to a plane, as [`orient3d`] says it for counterclockwise corners seen from outside: negative when the plane
/// has it outside, exactly.
pub(super) fn side([p, q, r]: [DVec3; 3], s: DVec3) -> f64 {
    orient3d(coord(p), coord(q), coord(r), coord(s))
}

/// The place of the least of some numbers, the first of equals; `None` when all are infinite.
fn place_of_least(numbers: &[f64]) -> Option<usize> {
    const BLOCK: usize = 64;
    let (mut least, mut start) = (f64::INFINITY, 0);
    for (i, block) in numbers.chunks(BLOCK).enumerate() {
        let least_here = least_of(block);
        if least_here < least {
            (least, start) = (least_here, i * BLOCK);
        }
    }
    let place = numbers[start..].iter().position(|&x| x == least && x < f64::INFINITY)?;
    Some(start + place)
}

/// The least of some numbers, or infinity: several at a time, each the least of its own.
fn least_of(numbers: &[f64]) -> f64 {
    let lesser = |x: f64, y: f64| if y < x { y } else { x };
    let (eights, rest) = numbers.as_chunks::<8>();
    let lanes = eights.iter().fold([f64::INFINITY; 8], |least, eight| {
        std::array::from_fn(|lane| lesser(least[lane], eight[lane]))
    });
    lanes.iter().chain(rest).copied().fold(f64::INFINITY, lesser)
}

impl Polytope {
    /// The tetrahedron of four points; `None` when they are coplanar.
    pub fn tetrahedron<A, B>(
        difference: &Difference<A, B>,
        points: [SupportPoint; 4],
        stretch: Option<Stretch>,
    ) -> Option<Box<Self>>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let [p, q, r, s] = points;
        let vertices = match side([p.w, q.w, r.w], s.w) {
            below if below > 0.0 => [p, q, r, s],
            above if above < 0.0 => [p, r, q, s],
            _ => return None,
        };
        let mut polytope = SPARE.take().unwrap_or_default();
        polytope.clear();
        polytope.stretch = stretch;
        polytope.vertices.extend(vertices);
        for (place, (corners, twins)) in (0..).zip(TETRAHEDRON) {
            polytope.put(difference, place, corners, twins);
        }
        Some(polytope)
    }

    fn clear(&mut self) {
        self.vertices.clear();
        self.faces.clear();
        self.open.clear();
    }

    /// Leaves the memory to the next one, but for one as large as hardly any is.
    pub fn recycle(self: Box<Self>) {
        if self.vertices.len() <= VERTICES_MAX {
            SPARE.set(Some(self));
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    pub fn vertices(&self) -> &[SupportPoint] {
        &self.vertices
    }

    /// Whether a support point is a vertex already.
    pub fn has_vertex(&self, p: &SupportPoint) -> bool {
        self.vertices.iter().any(|q| q.w == p.w)
    }

    pub fn face(&self, index: usize) -> &Face {
        &self.faces[index]
    }

    /// Whether lengths in it are others than in the space of the difference.
    pub fn is_stretched(&self) -> bool {
        self.stretch.is_some()
    }

    /// Three of the vertices.
    pub fn points(&self, corners: [u32; 3]) -> [SupportPoint; 3] {
        corners.map(|i| self.vertices[i as usize])
    }

    /// The corners of a face.
    pub fn corners(&self, index: usize) -> [SupportPoint; 3] {
        self.points(self.faces[index].corners)
    }

    /// The open face nearest to the origin, the first of equals, which is then no longer open; `None` when all are finished.
    pub fn take_nearest(&mut self) -> Option<usize> {
        let index = place_of_least(&self.open)?;
        self.open[index] = f64::INFINITY;
        Some(index)
    }

    /// A ball of this radius around the origin is in the hull of the vertices; negative when that cannot be said. Beyond `enough` it
    /// need not be precise.
    pub fn radius(&self, enough: f64) -> f64 {
        let bound = |(index, Face { plane, .. }): (usize, &Face)| {
            let of_plane = plane.offset - plane.slack;
            if of_plane < enough && self.stretch.is_none() {
                of_plane.max(self.sliver_distance(index))
            } else {
                of_plane
            }
        };
        self.faces.iter().enumerate().map(bound).fold(f64::INFINITY, f64::min)
    }

    /// A lower bound of the distance of a face that needs no plane, which a sliver hardly has: that of its longest edge, less how wide it is.
    /// Negative when the origin is not on its inner side.
    fn sliver_distance(&self, index: usize) -> f64 {
        let [p, q, r] = self.corners(index).map(|corner| corner.w);
        if side([p, q, r], DVec3::ZERO) < 0.0 {
            return f64::NEG_INFINITY;
        }
        let edges = [(p, q, r), (q, r, p), (r, p, q)];
        let length_squared = |(p, q, _): &(DVec3, DVec3, DVec3)| p.distance_squared(*q);
        let longer = |x, y| if length_squared(&y) > length_squared(&x) { y } else { x };
        let (p, q, r) = edges.into_iter().fold(edges[0], longer);
        let along = |x: DVec3| p + (q - p) * ((x - p).dot(q - p) / p.distance_squared(q)).clamp(0.0, 1.0);
        along(DVec3::ZERO).length() - along(r).distance(r) - SUPPORT_ERROR
    }

    /// The corners of the faces through which the ray along a direction leaves the polytope: those that it meets at most this much later than
    /// the first. Several when these are coplanar, or when it goes through an edge.
    pub fn faces_across(
        &self,
        direction: DVec3,
        margin: f64,
    ) -> impl Iterator<Item = [SupportPoint; 3]> + '_ {
        let latest = self.exit(direction) + margin;
        let near = (0..self.faces.len()).filter(move |&i| self.faces[i].plane.exit(direction) <= latest);
        near.map(|i| self.corners(i))
    }

    /// How many times a direction the way along it out of the polytope is.
    fn exit(&self, direction: DVec3) -> f64 {
        self.faces.iter().map(|face| face.plane.exit(direction)).fold(f64::INFINITY, f64::min)
    }

    /// The direction of a normal, and where along it a plane that is at this height leaves the polytope. What is stretched is left on the ray itself:
    /// the foot of a point beyond it would be aside of it, by far more than the point is beyond.
    pub fn ray(&self, normal: DVec3, height: f64) -> (DVec3, DVec3) {
        let Some(stretch) = &self.stretch else { return (normal, normal * height) };
        let direction = stretch.point(stretch.normal(normal));
        (direction, direction * self.exit(direction))
    }

    /// The corners of all faces.
    pub fn all_faces(&self) -> impl Iterator<Item = [SupportPoint; 3]> + '_ {
        (0..self.faces.len()).filter(|&i| self.faces[i].is_live()).map(|i| self.corners(i))
    }

    /// Takes a point in, which should be beyond a face; false, and nothing changes, when it is in the polytope.
    pub fn insert_beyond<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint, face: usize) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        if self.sees(face, p.w) {
            self.insert_seen_by(difference, p, face)
        } else {
            self.insert(difference, p)
        }
    }

    /// Takes a point in that a face sees; false, and nothing changes, when what it sees is not in one piece without holes: only where
    /// a product of coordinates is too small for a number is a sign not exact.
    fn insert_seen_by<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint, face: usize) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let mut horizon = std::mem::take(&mut self.horizon);
        let found = self.find_horizon(&mut horizon, face, p.w);
        if found {
            self.replace_seen(difference, p, &horizon);
        } else {
            horizon.seen.iter().for_each(|&i| self.faces[i as usize].seen = false);
        }
        self.horizon = horizon;
        found
    }

    /// Takes a point in; false, and nothing changes, when it is in the polytope.
    pub fn insert<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let first = (0..self.faces.len()).find(|&i| self.faces[i].is_live() && self.sees(i, p.w));
        first.is_some_and(|first| self.insert_seen_by(difference, p, first))
    }

    /// Whether a point is beyond a face: by its height over the plane where that is certain, else by the exact sign.
    #[inline]
    fn sees(&self, index: usize, p: DVec3) -> bool {
        let face = &self.faces[index];
        let height = face.plane.normal.dot(p) - face.plane.offset;
        if height.abs() > face.plane.blur {
            return height > 0.0;
        }
        side(face.corners.map(|i| self.vertices[i as usize].w), p) < 0.0
    }

    /// Marks the faces that see a point, from one of them on, and finds the edges around them; false when these are not one closed walk.
    ///
    /// The walk goes through the edges of each face counterclockwise, from that on which it came in, and into each further face that sees the
    /// point before the next edge: so it comes to the edges of the horizon in their order.
    fn find_horizon(&mut self, horizon: &mut Horizon, first: usize, p: DVec3) -> bool {
        let Horizon { seen, pending, ring } = horizon;
        seen.clear();
        ring.clear();
        pending.clear();
        pending.extend((0..3).rev().map(|corner| HalfEdge::new(first as u32, corner)));
        seen.push(first as u32);
        self.faces[first].seen = true;
        while let Some(edge) = pending.pop() {
            let beyond = self.faces[edge.face()].twins[edge.corner()];
            if self.faces[beyond.face()].seen {
                continue;
            }
            if self.sees(beyond.face(), p) {
                self.faces[beyond.face()].seen = true;
                seen.push(beyond.face() as u32);
                let [next, last] = beyond.others();
                pending.extend([last, next]);
            } else {
                let corners = &self.faces[edge.face()].corners;
                let [next, _] = edge.others();
                ring.push(HorizonEdge { start: corners[edge.corner()], end: corners[next.corner()], beyond });
            }
        }
        let follow = ring.windows(2).all(|pair| pair[0].end == pair[1].start);
        let closed = ring.first().zip(ring.last()).is_some_and(|(first, last)| first.start == last.end);
        follow && closed && ring.len() > 2
    }

    /// Replaces the faces that see a point by the cone from the horizon to it.
    fn replace_seen<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint, horizon: &Horizon)
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let Horizon { seen, ring, .. } = horizon;
        let apex = self.vertices.len() as u32;
        self.vertices.push(p);
        // The new faces take the places of the old ones, then new places.
        let (places, count) = (self.faces.len(), ring.len());
        let place = |i: usize| seen.get(i).copied().unwrap_or((places + i).wrapping_sub(seen.len()) as u32);
        let mut before = place(count - 1);
        for (i, edge) in ring.iter().enumerate() {
            let (here, after) = (place(i), place(if i + 1 < count { i + 1 } else { 0 }));
            let twins = [edge.beyond, HalfEdge::new(after, 2), HalfEdge::new(before, 1)];
            self.faces[edge.beyond.face()].twins[edge.beyond.corner()] = HalfEdge::new(here, 0);
            self.put(difference, here, [edge.start, edge.end, apex], twins);
            before = here;
        }
        for &left in seen.iter().skip(count) {
            (self.faces[left as usize], self.open[left as usize]) = (Face::NONE, f64::INFINITY);
        }
    }

    /// Puts a new face in the place of another, or in the next.
    fn put<A, B>(
        &mut self,
        difference: &Difference<A, B>,
        place: u32,
        corners: [u32; 3],
        twins: [HalfEdge; 3],
    ) where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let place = place as usize;
        if place == self.faces.len() {
            self.faces.push(Face::NONE);
            self.open.push(f64::INFINITY);
        }
        let face = &mut self.faces[place];
        (face.corners, face.twins, face.seen) = (corners, twins, false);
        face.plane.lay(difference, corners.map(|i| &self.vertices[i as usize]));
        if let Some(stretch) = &self.stretch {
            face.plane = stretch.measure(face.plane);
        }
        self.open[place] = face.plane.offset;
    }
}

#[cfg(test)]
impl Polytope {
    /// Whether it is closed and exactly convex, as its invariant says.
    pub fn assert_well_formed(&self) {
        let mut live = 0;
        for (index, face) in self.faces.iter().enumerate().filter(|&(i, _)| self.faces[i].is_live()) {
            live += 1;
            assert!(!face.seen);
            for corner in 0..3 {
                let twin = face.twins[corner as usize];
                let edge = HalfEdge::new(index as u32, corner);
                let neighbour = &self.faces[twin.face()];
                assert_eq!(neighbour.twins[twin.corner()], edge);
                let ends = |face: &Face, edge: HalfEdge| {
                    [face.corners[edge.corner()], face.corners[edge.others()[0].corner()]]
                };
                let [start, end] = ends(face, edge);
                assert_eq!(ends(neighbour, twin), [end, start]);
            }
            let corners = face.corners.map(|i| self.vertices[i as usize].w);
            for p in &self.vertices {
                assert!(side(corners, p.w) >= 0.0, "face {index} is not of the hull");
                assert_eq!(self.sees(index, p.w), side(corners, p.w) < 0.0);
            }
        }
        let corners = self.faces.iter().filter(|face| face.is_live()).flat_map(|face| face.corners);
        let used: std::collections::BTreeSet<u32> = corners.collect();
        assert_eq!(live, 2 * used.len() - 4, "Euler's formula");
    }
}
