//! The flat faces of a convex hull, for contacts: triangles that lie in one plane up to rounding are one face.
//!
//! [`Hull`] merges what is exactly coplanar. The corners of a prism that was turned are not, by their rounding; here they are.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use smallvec::SmallVec;
use solid_convex::unit_scale;

use super::incidence::Incidence;
use super::topology::edges;
use crate::bounds::Aabb;
use crate::hull::{Hull, outline};

/// Corners this near to the plane of a face, relative to the extent of the hull, belong to it: far above the rounding of
/// positions that were turned and moved, far below what can be seen.
const FLATNESS: f64 = 1e-9;

/// The faces of a convex hull.
#[derive(Clone, Debug)]
pub(crate) struct Facets {
    faces: Vec<Facet>,
    /// The faces at each point.
    at_point: Incidence,
    /// The extreme points: of a hull that is a segment up to rounding its ends, which are its face, as a point is.
    extreme: Vec<u32>,
}

/// A face: a convex polygon.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    /// The outward unit normal.
    pub normal: DVec3,
    /// The corners, in order around it.
    pub corners: Vec<u32>,
    /// The corner of the triangles in it that is furthest below the plane of the others.
    pub lowest: u32,
}

impl Facet {
    /// The corner that follows one of it.
    pub fn after(&self, corner: u32) -> u32 {
        let at = self.corners.iter().position(|&other| other == corner);
        self.corners[at.map_or(0, |at| at + 1) % self.corners.len()]
    }
}

impl Facets {
    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        let Facets { faces, at_point, extreme } = self;
        let corners: usize = faces.iter().map(|face| face.corners.capacity()).sum();
        let indices = corners + extreme.capacity();
        faces.capacity() * size_of::<Facet>() + indices * size_of::<u32>() + at_point.bytes()
    }

    /// The faces of the hull of points, of which there must be one. A flat hull has two, one for each side. O(n log n).
    pub fn of(points: &[DVec3]) -> Facets {
        let bounds = Aabb::of_points(points.iter().copied());
        let scale = unit_scale(bounds.half_extents().max_element());
        let center = bounds.center();
        // In a unit near the extent, so that no product overflows.
        let unit: Vec<DVec3> = points.iter().map(|&p| (p - center) * scale).collect();
        let hull = Hull::of(&unit);
        let (triangles, mut extreme) = hull
            .map_or((Vec::new(), Vec::new()), |hull| (hull.triangles().to_vec(), hull.vertices().to_vec()));
        let faces = merged(&unit, &triangles);
        if faces.is_empty() && extreme.len() > 2 {
            extreme = ends(&unit, &extreme).to_vec();
        }
        let at_point = Incidence::of(points.len(), faces.iter().map(|face| face.corners.iter().copied()));
        Facets { faces, at_point, extreme }
    }

    /// How many faces there are.
    pub fn len(&self) -> u32 {
        self.faces.len() as u32
    }

    /// A face.
    pub fn get(&self, face: u32) -> &Facet {
        &self.faces[face as usize]
    }

    /// The faces that have a point for a corner; none when the hull has no faces.
    pub fn at(&self, point: usize) -> &[u32] {
        self.at_point.at(point)
    }

    /// The extreme points.
    pub fn extreme(&self) -> &[u32] {
        &self.extreme
    }
}

/// The ends of points that lie on a line up to rounding.
fn ends(points: &[DVec3], extreme: &[u32]) -> [u32; 2] {
    let furthest_from = |from: u32| {
        let distance = |&i: &u32| points[i as usize].distance_squared(points[from as usize]);
        extreme.iter().copied().max_by(|i, j| distance(i).total_cmp(&distance(j))).expect("there are points")
    };
    let end = furthest_from(extreme[0]);
    let other = furthest_from(end);
    [end.min(other), end.max(other)]
}

/// Grows a face from each triangle, the largest first, over its neighbours in the same plane.
fn merged(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Facet> {
    let corner = |index: u32| points[index as usize];
    let cross = |[i, j, k]: [u32; 3]| (corner(j) - corner(i)).cross(corner(k) - corner(i));
    let longest_edge = |triangle: [u32; 3]| {
        edges(triangle).map(|[from, to]| corner(from).distance(corner(to))).into_iter().fold(0.0, f64::max)
    };
    // Of a flat hull a diagonal is run through the same way by a triangle of either side.
    let mut beyond: HashMap<[u32; 2], SmallVec<[usize; 2]>> = HashMap::new();
    for (index, &triangle) in triangles.iter().enumerate() {
        for edge in edges(triangle) {
            beyond.entry(edge).or_default().push(index);
        }
    }
    let mut seeds: Vec<usize> = (0..triangles.len()).collect();
    seeds.sort_by(|&i, &j| {
        cross(triangles[j]).length_squared().total_cmp(&cross(triangles[i]).length_squared()).then(i.cmp(&j))
    });
    let mut taken = vec![false; triangles.len()];
    let mut faces = Vec::new();
    for seed in seeds {
        // What is left that is no wider than rounding is a sliver within a face, or has no plane.
        let wide = cross(triangles[seed]).length() > FLATNESS * longest_edge(triangles[seed]);
        let Some(normal) = cross(triangles[seed]).try_normalize().filter(|_| wide && !taken[seed]) else {
            continue;
        };
        let origin = corner(triangles[seed][0]);
        let in_plane = |&index: &u32| normal.dot(corner(index) - origin).abs() <= FLATNESS;
        let (mut stack, mut members) = (vec![seed], Vec::new());
        taken[seed] = true;
        // Each triangle enters once.
        while let Some(index) = stack.pop() {
            let [i, j, k] = triangles[index];
            members.extend([i, j, k]);
            for edge in [[j, i], [k, j], [i, k]] {
                for &other in beyond.get(&edge).into_iter().flatten() {
                    let same_side = cross(triangles[other]).dot(normal) >= -FLATNESS;
                    if !taken[other] && same_side && triangles[other].iter().all(in_plane) {
                        taken[other] = true;
                        stack.push(other);
                    }
                }
            }
        }
        members.sort_unstable();
        members.dedup();
        let height = |index: &u32| normal.dot(corner(*index));
        let lowest = members.iter().copied().min_by(|i, j| height(i).total_cmp(&height(j)));
        let lowest = lowest.expect("a face has a triangle");
        let (u, v) = normal.any_orthonormal_pair();
        let flat: Vec<DVec2> =
            members.iter().map(|&i| DVec2::new(u.dot(corner(i)), v.dot(corner(i)))).collect();
        let corners = outline(&flat, FLATNESS).into_iter().map(|i| members[i]).collect();
        faces.push(Facet { normal, corners, lowest });
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    /// Sides of a prism, turned so that its rounded corners are in no plane.
    #[test]
    fn rounding_parts_no_face() {
        let turn = DMat3::from_rotation_x(0.3) * DMat3::from_rotation_z(1.1);
        let rim = |i: u32| DMat3::from_rotation_y(f64::from(i) * std::f64::consts::FRAC_PI_4) * DVec3::X;
        let points: Vec<DVec3> =
            (0..8).flat_map(|i| [rim(i) + DVec3::Y, rim(i) - DVec3::Y]).map(|p| turn * p + 5.0).collect();
        let facets = Facets::of(&points);
        let mut corners: Vec<usize> = facets.faces.iter().map(|face| face.corners.len()).collect();
        corners.sort_unstable();
        assert_eq!(corners, [4, 4, 4, 4, 4, 4, 4, 4, 8, 8]);
        assert!((0..16).all(|i| facets.at(i).len() == 3));
    }

    #[test]
    fn hulls_without_a_volume_have_what_they_have() {
        let [x, y, z] = DVec3::AXES;
        assert_eq!(Facets::of(&[x, y, z]).faces.len(), 2);
        let segment = Facets::of(&[x, 2.0 * x, 3.0 * x]);
        assert_eq!((segment.faces.len(), segment.extreme()), (0, [0, 2].as_slice()));
        assert_eq!(Facets::of(&[x, x]).extreme().len(), 1);
        // On a line up to rounding.
        let along = DVec3::new(0.1, 0.7, 0.3);
        let points: Vec<DVec3> = (0..9).map(|i| x * 0.1 + along * f64::from(i) * 0.1).collect();
        assert_eq!((Facets::of(&points).faces.len(), Facets::of(&points).extreme()), (0, [0, 8].as_slice()));
    }
}
