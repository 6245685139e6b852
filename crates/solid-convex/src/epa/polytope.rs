//! The polytope: vertices, faces, and how it grows.

use glam::DVec3;
use robust::orient3d;

use super::face::Face;
use crate::Support;
use crate::difference::{Difference, SUPPORT_ERROR, SupportPoint};
use crate::simplex::coord;

/// The hull of some points of `A - B`, with an inside. Invariant: exactly convex and closed, for the vertices as they were rounded;
/// faces may be coplanar.
#[derive(Debug)]
pub(super) struct Polytope {
    vertices: Vec<SupportPoint>,
    faces: Vec<Face>,
    /// For each face its offset while it is open: neither finished nor replaced. Infinite for the others.
    open: Vec<f64>,
    horizon: Horizon,
}

/// What a point sees of the polytope; working memory.
#[derive(Debug, Default)]
struct Horizon {
    /// The faces that see it.
    seen: Vec<u32>,
    /// The edges around them, in any order, then counterclockwise from outside.
    edges: Vec<HorizonEdge>,
    ring: Vec<HorizonEdge>,
    /// The edge that starts at a vertex; [`NONE`] for most.
    from: Vec<u32>,
}

/// An edge of a face that is seen, whose other face is not.
#[derive(Clone, Copy, Debug)]
struct HorizonEdge {
    start: u32,
    end: u32,
    /// The face beyond.
    beyond: u32,
}

const NONE: u32 = u32::MAX;

/// The faces of a tetrahedron whose fourth vertex is below the first three, and the face across each edge.
const TETRAHEDRON: [([u32; 3], [u32; 3]); 4] =
    [([0, 1, 2], [1, 2, 3]), ([1, 0, 3], [0, 3, 2]), ([2, 1, 3], [0, 1, 3]), ([0, 2, 3], [0, 2, 1])];

/// Where a point is to a plane, as [`orient3d`] says it for counterclockwise corners seen from outside: negative when the plane
/// has it outside, exactly.
pub(super) fn side([p, q, r]: [DVec3; 3], s: DVec3) -> f64 {
    orient3d(coord(p), coord(q), coord(r), coord(s))
}

impl Polytope {
    /// The tetrahedron of four points; `None` when they are coplanar.
    pub fn tetrahedron<A, B>(difference: &Difference<A, B>, points: [SupportPoint; 4]) -> Option<Self>
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let [p, q, r, s] = points;
        let side = side([p.w, q.w, r.w], s.w);
        let vertices = match side {
            below if below > 0.0 => vec![p, q, r, s],
            above if above < 0.0 => vec![p, r, q, s],
            _ => return None,
        };
        let mut polytope =
            Polytope { vertices, faces: Vec::new(), open: Vec::new(), horizon: Horizon::default() };
        for (corners, neighbours) in TETRAHEDRON {
            let face = polytope.new_face(difference, corners, neighbours);
            polytope.open.push(face.offset);
            polytope.faces.push(face);
        }
        Some(polytope)
    }

    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    pub fn face(&self, index: usize) -> &Face {
        &self.faces[index]
    }

    /// The corners of a face.
    pub fn corners(&self, index: usize) -> [SupportPoint; 3] {
        self.faces[index].corners.map(|i| self.vertices[i as usize])
    }

    /// The open face nearest to the origin, the first of equals; `None` when all are finished.
    pub fn nearest_open(&self) -> Option<usize> {
        let (mut nearest, mut least) = (None, f64::INFINITY);
        for (i, &offset) in self.open.iter().enumerate() {
            if offset < least {
                (nearest, least) = (Some(i), offset);
            }
        }
        nearest
    }

    /// Notes that the polytope does not grow beyond a face.
    pub fn finish(&mut self, index: usize) {
        self.open[index] = f64::INFINITY;
    }

    /// A ball of this radius around the origin is in the polytope; negative when that cannot be said. Beyond `enough` it need not
    /// be precise.
    pub fn radius(&self, enough: f64) -> f64 {
        let bound = |(index, face): (usize, &Face)| {
            let of_plane = face.offset - face.slack;
            if of_plane < enough { of_plane.max(self.sliver_distance(index)) } else { of_plane }
        };
        self.faces.iter().enumerate().map(bound).fold(f64::INFINITY, f64::min)
    }

    /// A lower bound of the distance of a face that needs no plane, which a sliver hardly has: that of its longest edge, less how wide it is.
    fn sliver_distance(&self, index: usize) -> f64 {
        let [p, q, r] = self.corners(index).map(|corner| corner.w);
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
        let leaves = move |face: &Face| {
            let along = face.normal.dot(direction);
            let known = along > 0.0 && face.slack < f64::INFINITY;
            if known { face.offset / along } else { f64::INFINITY }
        };
        let first = self.faces.iter().map(leaves).fold(f64::INFINITY, f64::min);
        let near = (0..self.faces.len()).filter(move |&i| leaves(&self.faces[i]) <= first + margin);
        near.map(|i| self.corners(i))
    }

    /// Takes a point in, which should be beyond a face; false, and nothing changes, when it is in the polytope.
    pub fn insert<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint, face: usize) -> bool
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let candidates = std::iter::once(face).chain(0..self.faces.len());
        let Some(first) = candidates.into_iter().find(|&i| self.is_live(i) && self.sees(i, p.w)) else {
            return false;
        };
        self.find_horizon(first, p.w);
        if !self.horizon.close(self.vertices.len()) {
            // Only where a product of coordinates is too small for a number is a sign not exact.
            self.horizon.seen.iter().for_each(|&i| self.faces[i as usize].seen = false);
            return false;
        }
        self.replace_seen(difference, p);
        true
    }

    fn is_live(&self, index: usize) -> bool {
        self.faces[index].offset < f64::INFINITY
    }

    fn sees(&self, index: usize, p: DVec3) -> bool {
        side(self.faces[index].corners.map(|i| self.vertices[i as usize].w), p) < 0.0
    }

    /// Marks the faces that see a point, from one of them on, and finds the edges around them.
    fn find_horizon(&mut self, first: usize, p: DVec3) {
        let mut horizon = std::mem::take(&mut self.horizon);
        horizon.seen.clear();
        horizon.edges.clear();
        horizon.seen.push(first as u32);
        self.faces[first].seen = true;
        let mut next = 0;
        while let Some(&index) = horizon.seen.get(next) {
            let Face { corners, neighbours, .. } = self.faces[index as usize];
            for (i, beyond) in neighbours.into_iter().enumerate() {
                if self.faces[beyond as usize].seen {
                    continue;
                }
                if self.sees(beyond as usize, p) {
                    self.faces[beyond as usize].seen = true;
                    horizon.seen.push(beyond);
                } else {
                    horizon.edges.push(HorizonEdge { start: corners[i], end: corners[(i + 1) % 3], beyond });
                }
            }
            next += 1;
        }
        self.horizon = horizon;
    }

    /// Replaces the faces that see a point by the cone from the horizon to it.
    fn replace_seen<A, B>(&mut self, difference: &Difference<A, B>, p: SupportPoint)
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        let horizon = std::mem::take(&mut self.horizon);
        let Horizon { seen, ring, .. } = &horizon;
        let apex = self.vertices.len() as u32;
        self.vertices.push(p);
        // The new faces take the places of the old ones, then new places.
        let (places, count) = (self.faces.len(), ring.len());
        let place = |i: usize| seen.get(i).copied().unwrap_or((places + i).wrapping_sub(seen.len()) as u32);
        for (i, edge) in ring.iter().enumerate() {
            let neighbours = [edge.beyond, place((i + 1) % count), place((i + count - 1) % count)];
            let face = self.new_face(difference, [edge.start, edge.end, apex], neighbours);
            let beyond = &mut self.faces[edge.beyond as usize];
            let shared =
                (0..3).find(|&j| beyond.corners[j] == edge.end && beyond.corners[(j + 1) % 3] == edge.start);
            beyond.neighbours[shared.expect("neighbours share an edge")] = place(i);
            if let Some(&old) = seen.get(i) {
                (self.faces[old as usize], self.open[old as usize]) = (face, face.offset);
            } else {
                self.faces.push(face);
                self.open.push(face.offset);
            }
        }
        for &left in seen.iter().skip(count) {
            self.faces[left as usize].offset = f64::INFINITY;
            self.open[left as usize] = f64::INFINITY;
        }
        self.horizon = horizon;
    }

    fn new_face<A, B>(&self, difference: &Difference<A, B>, corners: [u32; 3], neighbours: [u32; 3]) -> Face
    where
        A: Support + ?Sized,
        B: Support + ?Sized,
    {
        Face::new(difference, corners, corners.map(|i| &self.vertices[i as usize]), neighbours)
    }
}

impl Horizon {
    /// Puts the edges in order; false when they are not one closed walk.
    fn close(&mut self, vertices: usize) -> bool {
        let Horizon { edges, ring, from, .. } = self;
        from.clear();
        from.resize(vertices, NONE);
        ring.clear();
        for (i, edge) in (0u32..).zip(&*edges) {
            if std::mem::replace(&mut from[edge.start as usize], i) != NONE {
                return false;
            }
        }
        let mut at = 0;
        for _ in 0..edges.len() {
            let Some(&edge) = edges.get(at as usize) else { return false };
            ring.push(edge);
            at = from[edge.end as usize];
            if at == 0 {
                break;
            }
        }
        at == 0 && ring.len() == edges.len()
    }
}

#[cfg(test)]
impl Polytope {
    /// Whether it is closed and exactly convex, as its invariant says.
    pub fn assert_well_formed(&self) {
        let mut live = 0;
        for (index, face) in self.faces.iter().enumerate().filter(|&(i, _)| self.is_live(i)) {
            live += 1;
            assert!(!face.seen);
            for i in 0..3 {
                let neighbour = &self.faces[face.neighbours[i] as usize];
                let shared = (0..3).find(|&j| {
                    neighbour.corners[j] == face.corners[(i + 1) % 3]
                        && neighbour.corners[(j + 1) % 3] == face.corners[i]
                });
                assert_eq!(neighbour.neighbours[shared.unwrap()], index as u32);
            }
            assert!(self.vertices.iter().all(|p| !self.sees(index, p.w)), "face {index} is not of the hull");
        }
        let corners =
            self.faces.iter().filter(|face| face.offset < f64::INFINITY).flat_map(|face| face.corners);
        let used: std::collections::BTreeSet<u32> = corners.collect();
        assert_eq!(live, 2 * used.len() - 4, "Euler's formula");
    }
}
