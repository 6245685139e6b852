//! Whether a closed surface is convex.

use std::f64::consts::TAU;

use glam::DVec3;

use super::facets::{Facets, NO_FACE, Triangles};
use super::topology::edges;
use crate::solid_angle::half_solid_angle;

/// How far a surface that is convex may bend inward, the angles of all edges together, in radians: so far above a face a corner may be, relative to the extent.
const BEND: f64 = 1e-6;

/// How far a corner may be above the plane of a face by rounding, relative to the extent.
const ROUNDING: f64 = 1e-14;

/// The faces of a closed surface that rises at no edge, if it is convex; in a unit in which distances are about one. Edges that bend outward are not
/// enough: the surface may go around a corner twice, as that of a star does, or be flat, which tells nothing of its outline. But one that from a point inside is seen
/// once in each direction, and from its back, passes through itself nowhere, and then there is no more to it (Van Heijenoort, *On locally convex
/// manifolds*, 1952). Cost: O(n log n).
pub(super) fn convex_facets(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Facets> {
    let mesh = Triangles::new(points, triangles);
    let (facets, face_of) = mesh.merged();
    if face_of.contains(&NO_FACE) {
        return None;
    }
    let surface = Surface { mesh, facets, face_of };
    let is_convex = match surface.facets.len() {
        2 => (0..2).all(|side| surface.covers_outline(side)),
        _ => surface.bend() <= BEND && surface.is_seen_from_inside(),
    };
    is_convex.then_some(surface.facets)
}

/// Six times the volume between a triangle and the origin.
pub(super) fn six_volumes([p, q, r]: [DVec3; 3]) -> f64 {
    p.dot(q.cross(r))
}

/// A closed surface and its faces.
struct Surface<'a> {
    mesh: Triangles<'a>,
    facets: Facets,
    /// The face that each triangle is a part of.
    face_of: Vec<u32>,
}

impl Surface<'_> {
    /// The triangles, and the face that each is a part of.
    fn parts(&self) -> impl Iterator<Item = (&[u32; 3], u32)> {
        self.mesh.triangles.iter().zip(self.face_of.iter().copied())
    }

    /// By how much all edges bend inward, together. Within a face, which is as flat as rounding leaves it, none does.
    fn bend(&self) -> f64 {
        let mut bend = 0.0;
        for (&triangle, face) in self.parts() {
            for edge in edges(triangle) {
                let beyond = self.mesh.beyond(edge).filter(|&beyond| self.face_of[beyond] > face);
                bend += beyond.map(|beyond| self.bend_at(edge, face, beyond)).sum::<f64>();
            }
        }
        bend
    }

    /// By how much an edge of a face bends inward. Where a surface is hardly curved, faces have ragged edges, at which the normals say less than the corners do.
    fn bend_at(&self, [from, to]: [u32; 2], face: u32, beyond: usize) -> f64 {
        let [normal, other] = [face, self.face_of[beyond]].map(|face| self.facets.get(face).normal);
        let [start, end] = [from, to].map(|point| self.mesh.corner(point));
        let is_above = |&point: &u32| normal.dot(self.mesh.corner(point) - start) > ROUNDING;
        let turn = normal.cross(other).dot((end - start).normalize_or_zero());
        if turn < 0.0 && self.mesh.triangles[beyond].iter().any(is_above) { -turn } else { 0.0 }
    }

    /// Whether, from its centroid, it is seen once in each direction, and from its back.
    fn is_seen_from_inside(&self) -> bool {
        let Some(center) = self.centroid() else { return false };
        let shows_back = |face: u32| {
            let facet = self.facets.get(face);
            facet.normal.dot(self.mesh.corner(facet.lowest) - center) > 0.0
        };
        let half = |corners: &[u32; 3]| half_solid_angle(corners.map(|i| self.mesh.corner(i) - center));
        (0..self.facets.len()).all(shows_back)
            && self.mesh.triangles.iter().map(half).sum::<f64>() < 1.5 * TAU
    }

    /// The centroid of what it bounds; `None` without a volume.
    fn centroid(&self) -> Option<DVec3> {
        let (mut moment, mut volume) = (DVec3::ZERO, 0.0);
        for corners in self.mesh.triangles {
            let [p, q, r] = corners.map(|i| self.mesh.corner(i));
            let here = six_volumes([p, q, r]);
            moment += here * (p + q + r);
            volume += here;
        }
        (volume > 0.0).then(|| 0.25 * moment / volume)
    }

    /// Whether the triangles of one side of what is flat cover its outline, once.
    fn covers_outline(&self, side: u32) -> bool {
        let facet = self.facets.get(side);
        let area = |corners: &[u32]| {
            let way = |i: usize| self.mesh.corner(corners[i]) - self.mesh.corner(corners[0]);
            (2..corners.len()).map(|i| way(i - 1).cross(way(i)).dot(facet.normal)).sum::<f64>()
        };
        let covering = self.parts().filter(|&(_, face)| face == side);
        let (covered, outlined) =
            (covering.map(|(corners, _)| area(corners)).sum::<f64>(), area(facet.corners));
        (covered - outlined).abs() <= BEND * outlined
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use rand::Rng;
    use solid_oracle::generate::{direction, seeded};

    use super::*;

    /// A ball of triangles, of so many rings, whose upper half is a disc that rises to a height in its middle.
    fn lens(rings: u32, height: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let side = 2 * rings;
        let ring = |i: u32| (f64::from(i) / f64::from(rings) * TAU / 2.0).sin_cos();
        let at = |(i, j): (u32, u32)| {
            let ((radius, up), (sin, cos)) = (ring(i), (f64::from(j) / f64::from(side) * TAU).sin_cos());
            let y = if 2 * i <= rings { height * (1.0 - radius * radius) } else { up };
            DVec3::new(radius * cos, y, -radius * sin)
        };
        let places = (1..rings).flat_map(|i| (0..side).map(move |j| (i, j)));
        let points = std::iter::once((0, 0)).chain(places).chain([(rings, 0)]).map(at).collect();
        let name = |i: u32, j: u32| match i {
            0 => 0,
            _ if i == rings => 1 + (rings - 1) * side,
            _ => 1 + (i - 1) * side + j % side,
        };
        let squares = (0..rings).flat_map(|i| (0..side).map(move |j| (i, j)));
        let corners = |(i, j)| {
            let [p, q, r, s] = [name(i, j), name(i + 1, j), name(i + 1, j + 1), name(i, j + 1)];
            [[p, q, s], [s, q, r]]
        };
        let all = squares.flat_map(corners);
        (points, all.filter(|[p, q, r]| p != q && q != r && r != p).collect())
    }

    /// Law: what is convex has no corner above a face, wherever it is; a dent is seen that is deeper than what all edges may bend, though none rises as far as is looked
    /// for at one.
    #[test]
    fn a_shallow_dent_is_seen() {
        let mut rng = seeded(467);
        for (rings, height, is_convex) in [
            (12, 0.0, true),
            (12, 0.5, true),
            (12, 1e-3, true),
            (12, -1e-5, false),
            (80, 0.0, true),
            (80, 0.1, true),
            (80, 1e-3, true),
            (80, 1e-5, true),
            (80, -3e-6, false),
            (80, -1e-4, false),
        ] {
            let (points, triangles) = lens(rings, height);
            for case in 0..3 {
                let turn = DQuat::from_axis_angle(direction(&mut rng), f64::from(case));
                let place = f64::from(case) * rng.random_range(-10.0..10.0);
                // What is far from its origin has lost digits.
                let turned: Vec<DVec3> = points.iter().map(|&p| turn * p + place - place).collect();
                let found = convex_facets(&turned, &triangles).is_some();
                assert_eq!(found, is_convex, "{rings} rings, {height}, case {case}");
            }
        }
    }
}
