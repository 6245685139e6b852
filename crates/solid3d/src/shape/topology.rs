//! Which primitives of a soup lie next to each other, for contacts.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU8, Ordering};

use foldhash::fast::RandomState;
use glam::DVec3;
use smallvec::SmallVec;
use solid_convex::unit_scale;

use super::enclosed::Enclosed;
use super::incidence::Incidence;
use super::solid::bits;
use crate::bounds::Aabb;

/// How far a neighbour may rise above the plane of a triangle in a surface that is flat, relative to the way to it.
const FLATNESS: f64 = 1e-9;

/// What lies next to what in a soup. Vertices at exactly the same position are one, whatever their indices.
#[derive(Debug)]
pub(crate) struct Topology {
    /// The first vertex at the position of each.
    welded: Vec<u32>,
    /// The primitives at each welded vertex.
    around: Incidence,
    /// What is known of the surface around each welded vertex of a mesh: whether it [is flat](FLAT), also [where it ends](LEVEL), or [not](BENT).
    known: Vec<AtomicU8>,
    enclosed: Enclosed,
}

const UNKNOWN: u8 = 0;
const BENT: u8 = 1;
const LEVEL: u8 = 2;
const FLAT: u8 = 3;

/// A mesh at some positions, whose primitives are its triangles.
#[derive(Clone, Copy)]
pub(crate) struct Positioned<'a> {
    pub vertices: &'a [DVec3],
    pub triangles: &'a [[u32; 3]],
}

impl Topology {
    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        let Topology { welded, around, known, enclosed } = self;
        welded.capacity() * size_of::<u32>() + around.bytes() + known.capacity() + enclosed.bytes()
    }

    /// Cost: O(n).
    pub fn of<'a>(vertices: &[DVec3], primitives: impl Iterator<Item = &'a [u32]> + Clone) -> Topology {
        let mut first_at = HashMap::with_capacity_and_hasher(vertices.len(), RandomState::default());
        let welded: Vec<u32> =
            (0u32..).zip(vertices).map(|(i, &p)| *first_at.entry(bits(p)).or_insert(i)).collect();
        let corners = primitives.map(|primitive| primitive.iter().map(|&i| welded[i as usize]));
        let around = Incidence::of(vertices.len(), corners);
        Topology { welded, around, known: Vec::new(), enclosed: Enclosed::default() }
    }

    /// The same of a mesh. Cost: O(n), and O(n log n) for a closed convex one.
    pub fn of_mesh(mesh: Positioned, bounds: &Aabb, is_solid: bool) -> Topology {
        let mut topology = Topology::of(mesh.vertices, mesh.triangles.iter().map(<[u32; 3]>::as_slice));
        topology.known = mesh.vertices.iter().map(|_| AtomicU8::new(UNKNOWN)).collect();
        topology.enclosed = Enclosed::of(&topology, mesh, bounds, is_solid).unwrap_or_default();
        topology
    }

    /// The vertex that stands for all at the position of a vertex.
    pub fn welded(&self, vertex: u32) -> u32 {
        self.welded[vertex as usize]
    }

    /// The primitives that have a vertex, or one at its position. A primitive that names it twice comes twice.
    pub fn around(&self, vertex: u32) -> &[u32] {
        self.around.at(self.welded(vertex) as usize)
    }

    /// What a closed mesh bounds.
    pub fn enclosed(&self) -> &Enclosed {
        &self.enclosed
    }

    /// Whether the surroundings of a triangle are in its plane on all sides: such a surface has no other normal there.
    pub fn is_flat(&self, mesh: Positioned, triangle: u32) -> bool {
        mesh.triangles[triangle as usize].iter().all(|&corner| self.known_around(mesh, corner) == FLAT)
    }

    /// The same, but for where the surface ends, if it does: what there is, is in that plane.
    pub fn is_level(&self, mesh: Positioned, triangle: u32) -> bool {
        mesh.triangles[triangle as usize].iter().all(|&corner| self.known_around(mesh, corner) != BENT)
    }

    /// How flat the surface around a vertex is. It is looked at once.
    fn known_around(&self, mesh: Positioned, vertex: u32) -> u8 {
        let vertex = self.welded(vertex);
        let known = &self.known[vertex as usize];
        match known.load(Ordering::Relaxed) {
            UNKNOWN => {
                let found = self.look_around(mesh, vertex);
                known.store(found, Ordering::Relaxed);
                found
            }
            found => found,
        }
    }

    fn look_around(&self, Positioned { vertices, triangles }: Positioned, vertex: u32) -> u8 {
        let here = vertices[vertex as usize];
        let (mut before, mut after) = (SmallVec::<[u32; 8]>::new(), SmallVec::<[u32; 8]>::new());
        let mut plane = None;
        for &triangle in self.around(vertex) {
            let Some(corners) = self.spread(triangles[triangle as usize]) else { continue };
            // The triangle from this vertex on.
            let Some(first) = corners.iter().position(|&corner| corner == vertex) else { return BENT };
            let [next, last] = [1, 2].map(|step| corners[(first + step) % 3]);
            after.push(next);
            before.push(last);
            let arms = [next, last].map(|corner| vertices[corner as usize] - here);
            // In a unit near to their length: squares of areas are numbers.
            let scale = unit_scale(arms[0].abs().max(arms[1].abs()).max_element());
            let arms = arms.map(|arm| arm * scale);
            let across = arms[0].cross(arms[1]).normalize_or_zero();
            let normal = *plane.get_or_insert(across);
            let rises = |arm: &DVec3| normal.dot(*arm).abs() > FLATNESS * arm.length();
            if normal.dot(across) <= 0.0 || arms.iter().any(rises) {
                return BENT;
            }
        }
        // All around: what one triangle ends with another begins with.
        before.sort_unstable();
        after.sort_unstable();
        let is_closed = before == after && before.windows(2).all(|pair| pair[0] != pair[1]);
        if is_closed { FLAT } else { LEVEL }
    }

    /// The corners of a triangle, welded; `None` where two of them are one.
    pub(super) fn spread(&self, triangle: [u32; 3]) -> Option<[u32; 3]> {
        let [i, j, k] = triangle.map(|i| self.welded(i));
        (i != j && j != k && k != i).then_some([i, j, k])
    }

    /// The third corner of the triangle on the other side of an edge, where there is one on each side, and the one runs through it as the other
    /// does not. Cost: follows the triangles around the end that has fewer.
    pub(super) fn beyond(&self, triangles: &[[u32; 3]], [from, to]: [u32; 2]) -> Option<u32> {
        let star = [self.around(from), self.around(to)].into_iter().min_by_key(|star| star.len())?;
        let (mut along, mut against, mut third) = (0, 0, None);
        for [i, j, k] in star.iter().filter_map(|&triangle| self.spread(triangles[triangle as usize])) {
            for (edge, other) in [([i, j], k), ([j, k], i), ([k, i], j)] {
                along += i32::from(edge == [from, to]);
                if edge == [to, from] {
                    against += 1;
                    third = Some(other);
                }
            }
        }
        third.filter(|_| along == 1 && against == 1)
    }
}

/// The edges of a triangle, as it runs through them.
pub(super) fn edges([i, j, k]: [u32; 3]) -> [[u32; 2]; 3] {
    [[i, j], [j, k], [k, i]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Complex;

    /// Squares of two triangles each, so many in a row and as many rows.
    fn floor(squares: u32, size: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let row = squares + 1;
        let place = |i: u32| size * DVec3::new(f64::from(i % row), f64::from(i / row), 0.0);
        let corners = (0..row * squares).filter(|i| i % row < squares);
        let triangles = corners.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]);
        ((0..row * row).map(place).collect(), triangles.collect())
    }

    /// Law: a triangle is level where nothing around its corners leaves its plane, by more than rounding does, and flat if the surface goes on all around
    /// them; at any size.
    #[test]
    fn what_lies_around_a_triangle_is_known() {
        for size in [1e-100, 1e-80, 1.0, 1e80, 1e98] {
            let (vertices, triangles) = floor(6, size);
            let is_rim = |i: u32| [0, 6].iter().any(|&end| i % 7 == end || i / 7 == end);
            let raised = 3 * 7 + 3;
            let around = |corner: u32| triangles.iter().filter(move |triangle| triangle.contains(&corner));
            for (height, is_bent) in [(0.0, false), (1e-11, false), (1e-7, true), (-1.0, true)] {
                let mut vertices = vertices.clone();
                vertices[raised].z = height * size;
                let mesh = Complex::mesh(vertices, triangles.clone()).unwrap();
                for (number, triangle) in (0..).zip(&triangles) {
                    let sees = |&corner: &u32| around(corner).any(|other| other.contains(&(raised as u32)));
                    let is_level = !(is_bent && triangle.iter().any(sees));
                    let is_inside = !triangle.iter().any(|&corner| is_rim(corner));
                    let found = [mesh.is_level(number), mesh.is_flat(number)];
                    assert_eq!(found, [is_level, is_level && is_inside], "{triangle:?}, {height}, {size}");
                }
            }
        }
    }

    /// Law: what lies on the other side, or twice in one place, does not go on all around.
    #[test]
    fn what_lies_in_one_place_is_no_surrounding() {
        let (vertices, triangles) = floor(6, 1.0);
        let (inside, reversed) = (2 * (2 * 6 + 2), triangles.iter().map(|&[i, j, k]| [k, j, i]));
        let known = |triangles: Vec<[u32; 3]>| {
            let mesh = Complex::mesh(vertices.clone(), triangles).unwrap();
            [0, inside].map(|i| (mesh.is_level(i), mesh.is_flat(i)))
        };
        let twice: Vec<_> = triangles.iter().chain(&triangles).copied().collect();
        let both_sides: Vec<_> = triangles.iter().copied().chain(reversed).collect();
        assert_eq!(known(triangles.clone()), [(true, false), (true, true)]);
        assert_eq!(known(twice), [(true, false); 2]);
        assert_eq!(known(both_sides), [(false, false); 2]);
    }
}
