//! The flat faces of a convex hull, for contacts: triangles that lie in one plane up to rounding are one face.
//!
//! [`Hull`] merges what is exactly coplanar. The corners of a prism that was turned are not, by their rounding; here they are.

use glam::{DVec2, DVec3};
use solid_convex::unit_scale;

use super::incidence::Incidence;
use super::topology::edges;
use crate::bounds::Aabb;
use crate::hull::{Hull, outline};

/// Corners this near to the plane of a face, relative to the extent of the hull, belong to it: far above the rounding of
/// positions that were turned and moved, far below what can be seen.
const FLATNESS: f64 = 1e-9;

/// The number of no face.
pub(super) const NO_FACE: u32 = u32::MAX;

/// The faces of a convex hull.
#[derive(Clone, Debug)]
pub(crate) struct Facets {
    faces: Vec<Face>,
    /// Those of all faces, one after the other.
    corners: Vec<u32>,
    /// The faces at each point.
    at_point: Incidence,
    /// The extreme points: of a hull that is a segment up to rounding its ends, which are its face, as a point is.
    extreme: Vec<u32>,
}

/// A face as it is kept.
#[derive(Clone, Debug)]
struct Face {
    normal: DVec3,
    lowest: u32,
    /// Where its corners end.
    end: u32,
}

/// A face: a convex polygon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet<'a> {
    /// The outward unit normal.
    pub normal: DVec3,
    /// The corners, in order around it.
    pub corners: &'a [u32],
    /// The corner of the triangles in it that is furthest below the plane of the others.
    pub lowest: u32,
}

impl Facet<'_> {
    /// The corner that follows one of it.
    pub fn after(&self, corner: u32) -> u32 {
        let at = self.corners.iter().position(|&other| other == corner);
        self.corners[at.map_or(0, |at| at + 1) % self.corners.len()]
    }
}

impl Facets {
    /// Of so many points.
    fn new(faces: Vec<Face>, corners: Vec<u32>, points: usize) -> Facets {
        let mut facets = Facets { faces, corners, at_point: Incidence::default(), extreme: Vec::new() };
        let each = (0..facets.len()).map(|face| facets.get(face).corners.iter().copied());
        facets.at_point = Incidence::of(points, each);
        facets
    }

    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        let Facets { faces, corners, at_point, extreme } = self;
        let indices = corners.capacity() + extreme.capacity();
        faces.capacity() * size_of::<Face>() + indices * size_of::<u32>() + at_point.bytes()
    }

    /// The faces of the hull of points, of which there must be one. A flat hull has two, one for each side. O(n log n).
    pub fn of(points: &[DVec3]) -> Facets {
        let bounds = Aabb::of_points(points.iter().copied());
        let scale = unit_scale(bounds.half_extents().max_element());
        let center = bounds.center();
        // In a unit near the extent, so that no product overflows.
        let unit: Vec<DVec3> = points.iter().map(|&p| (p - center) * scale).collect();
        let hull = Hull::of(&unit);
        let (triangles, extreme) = hull
            .map_or((Vec::new(), Vec::new()), |hull| (hull.triangles().to_vec(), hull.vertices().to_vec()));
        let mut facets = Triangles::new(&unit, &triangles).merged().0;
        facets.extreme = if facets.faces.is_empty() && extreme.len() > 2 {
            ends(&unit, &extreme).to_vec()
        } else {
            extreme
        };
        facets
    }

    /// How many faces there are.
    pub fn len(&self) -> u32 {
        self.faces.len() as u32
    }

    /// A face.
    pub fn get(&self, face: u32) -> Facet<'_> {
        let face = face as usize;
        let start = face.checked_sub(1).map_or(0, |before| self.faces[before].end as usize);
        let Face { normal, lowest, end } = self.faces[face];
        Facet { normal, corners: &self.corners[start..end as usize], lowest }
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

/// The triangles of a closed surface, counter-clockwise seen from outside; in a unit in which their distances are about one.
pub(super) struct Triangles<'a> {
    points: &'a [DVec3],
    pub triangles: &'a [[u32; 3]],
    /// Those at each point.
    around: Incidence,
}

impl<'a> Triangles<'a> {
    pub fn new(points: &'a [DVec3], triangles: &'a [[u32; 3]]) -> Self {
        Triangles { points, triangles, around: Incidence::of(points.len(), triangles.iter().copied()) }
    }

    pub fn corner(&self, point: u32) -> DVec3 {
        self.points[point as usize]
    }

    /// The normal of a triangle, as long as its area is large.
    fn cross(&self, triangle: usize) -> DVec3 {
        let [p, q, r] = self.triangles[triangle].map(|point| self.corner(point));
        (q - p).cross(r - p)
    }

    fn longest_edge(&self, triangle: usize) -> f64 {
        let lengths = edges(self.triangles[triangle]).map(|ends| {
            let [from, to] = ends.map(|point| self.corner(point));
            from.distance(to)
        });
        lengths.into_iter().fold(0.0, f64::max)
    }

    /// The triangles on the other side of an edge of one: of a flat hull a diagonal is run through the same way by one of either side.
    pub fn beyond(&self, [from, to]: [u32; 2]) -> impl Iterator<Item = usize> {
        let [of_from, of_to] = [from, to].map(|end| self.around.at(end as usize));
        let star = if of_from.len() < of_to.len() { of_from } else { of_to };
        let has_edge = move |&triangle: &usize| edges(self.triangles[triangle]).contains(&[to, from]);
        star.iter().map(|&triangle| triangle as usize).filter(has_edge)
    }

    /// Grows a face from each triangle, the largest first, over its neighbours in the same plane. The number of the face that each is a part of is told, too;
    /// [`NO_FACE`] of what is no wider than rounding, and has none beside it.
    pub fn merged(&self) -> (Facets, Vec<u32>) {
        let crosses: Vec<DVec3> = (0..self.triangles.len()).map(|i| self.cross(i)).collect();
        let area = |i: usize| crosses[i].length_squared();
        let mut seeds: Vec<usize> = (0..crosses.len()).collect();
        seeds.sort_unstable_by(|&i, &j| area(j).total_cmp(&area(i)).then(i.cmp(&j)));
        let mut face_of = vec![NO_FACE; crosses.len()];
        let (mut faces, mut corners) = (Vec::new(), Vec::new());
        for seed in seeds {
            // What is left that is no wider than rounding is a sliver within a face, or has no plane.
            let wide = crosses[seed].length() > FLATNESS * self.longest_edge(seed);
            let is_left = face_of[seed] == NO_FACE;
            let Some(normal) = crosses[seed].try_normalize().filter(|_| wide && is_left) else {
                continue;
            };
            let members = self.grow(seed, normal, faces.len() as u32, &mut face_of);
            let height = |index: &u32| normal.dot(self.corner(*index));
            let lowest = members.iter().copied().min_by(|i, j| height(i).total_cmp(&height(j)));
            let lowest = lowest.expect("a face has a triangle");
            let (u, v) = normal.any_orthonormal_pair();
            let flat: Vec<DVec2> =
                members.iter().map(|&i| DVec2::new(u.dot(self.corner(i)), v.dot(self.corner(i)))).collect();
            corners.extend(outline(&flat, FLATNESS).into_iter().map(|i| members[i]));
            faces.push(Face { normal, lowest, end: corners.len() as u32 });
        }
        (Facets::new(faces, corners, self.points.len()), face_of)
    }

    /// Makes a face, of a number, of a triangle and what lies around it in its plane; gives the corners of these, ascending.
    fn grow(&self, seed: usize, normal: DVec3, number: u32, face_of: &mut [u32]) -> Vec<u32> {
        let origin = self.corner(self.triangles[seed][0]);
        let in_plane = |&index: &u32| normal.dot(self.corner(index) - origin).abs() <= FLATNESS;
        let (mut stack, mut members) = (vec![seed], Vec::new());
        face_of[seed] = number;
        // Each triangle enters once.
        while let Some(index) = stack.pop() {
            members.extend(self.triangles[index]);
            for other in edges(self.triangles[index]).into_iter().flat_map(|edge| self.beyond(edge)) {
                let same_side = self.cross(other).dot(normal) >= -FLATNESS;
                let is_left = face_of[other] == NO_FACE;
                if is_left && same_side && self.triangles[other].iter().all(in_plane) {
                    face_of[other] = number;
                    stack.push(other);
                }
            }
        }
        members.sort_unstable();
        members.dedup();
        members
    }
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
        let mut corners: Vec<usize> = (0..facets.len()).map(|face| facets.get(face).corners.len()).collect();
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
