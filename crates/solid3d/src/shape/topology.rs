//! Which primitives of a soup lie next to each other, for contacts.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;
use solid_convex::unit_scale;

use super::hulled::Hulled;
use crate::bounds::Aabb;

/// How far a neighbour may rise above the plane of a triangle in a surface that is convex, relative to its extent.
const FLATNESS: f64 = 1e-9;

/// What lies next to what in a soup. Vertices at exactly the same position are one, whatever their indices.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    /// The first vertex at the position of each.
    welded: Vec<u32>,
    /// The primitives at welded vertex `i` are `around[starts[i]..starts[i + 1]]`, ascending.
    starts: Vec<u32>,
    around: Vec<u32>,
    /// Whether the surface around a welded vertex is flat, and without an edge there.
    flat: Vec<bool>,
    /// 1 when the triangles of a closed mesh run around counter-clockwise seen from outside, -1 when clockwise, 0 when not closed.
    orientation: f64,
    /// The body that a closed convex mesh bounds, and which vertices its points are.
    convex: Option<(Arc<Hulled>, Vec<u32>)>,
}

impl Topology {
    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        let Topology { welded, starts, around, flat, orientation: _, convex } = self;
        let of_convex = |(hull, names): &(Arc<Hulled>, Vec<u32>)| {
            size_of::<Hulled>() + hull.bytes() + names.capacity() * size_of::<u32>()
        };
        let indices = welded.capacity() + starts.capacity() + around.capacity();
        indices * size_of::<u32>() + flat.capacity() + convex.as_ref().map_or(0, of_convex)
    }

    /// Cost: O(n), and O(n log n) for a closed convex mesh.
    pub fn of<'a>(
        vertices: &[DVec3],
        primitives: impl Iterator<Item = &'a [u32]> + Clone,
        triangles: Option<&[[u32; 3]]>,
    ) -> Topology {
        let mut first_at = HashMap::new();
        // 0 and -0 are the same.
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let welded: Vec<u32> =
            (0u32..).zip(vertices).map(|(i, &p)| *first_at.entry(key(p)).or_insert(i)).collect();
        let corners =
            primitives.clone().map(|primitive| primitive.iter().map(|&i| welded[i as usize] as usize));
        let mut starts = vec![0u32; vertices.len() + 1];
        corners.clone().flatten().for_each(|corner| starts[corner + 1] += 1);
        for i in 0..vertices.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut around = vec![0; starts[vertices.len()] as usize];
        for (primitive, corners) in (0u32..).zip(corners) {
            for corner in corners {
                around[next[corner] as usize] = primitive;
                next[corner] += 1;
            }
        }
        let mut topology =
            Topology { welded, starts, around, flat: Vec::new(), orientation: 0.0, convex: None };
        if let Some(triangles) = triangles {
            topology.flatten(vertices, triangles);
            topology.close(vertices, triangles);
        }
        topology
    }

    /// The vertex that stands for all at the position of a vertex.
    pub fn welded(&self, vertex: u32) -> u32 {
        self.welded[vertex as usize]
    }

    /// The primitives that have a vertex, or one at its position. A primitive that names it twice comes twice.
    pub fn around(&self, vertex: u32) -> &[u32] {
        let i = self.welded(vertex) as usize;
        &self.around[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// Whether a primitive is a triangle whose surroundings are in its plane on all sides: such a surface has no other normal there.
    pub fn is_flat(&self, corners: &[u32]) -> bool {
        !self.flat.is_empty() && corners.iter().all(|&corner| self.flat[self.welded(corner) as usize])
    }

    /// 1, -1 or 0; see the field.
    pub fn orientation(&self) -> f64 {
        self.orientation
    }

    /// The body that a closed convex mesh bounds, and which vertices its points are.
    pub fn convex(&self) -> Option<(&Arc<Hulled>, &[u32])> {
        self.convex.as_ref().map(|(hull, vertices)| (hull, vertices.as_slice()))
    }

    /// Finds out where the surface is flat.
    fn flatten(&mut self, vertices: &[DVec3], triangles: &[[u32; 3]]) {
        let (mut before, mut after) = (Vec::new(), Vec::new());
        let flat = (0u32..).zip(vertices).map(|(vertex, &here)| {
            if self.welded(vertex) != vertex || self.around(vertex).is_empty() {
                return false;
            }
            before.clear();
            after.clear();
            let mut plane = None;
            for &triangle in self.around(vertex) {
                let corners = triangles[triangle as usize].map(|i| self.welded(i));
                // The triangle from this vertex on.
                let Some(first) = corners.iter().position(|&corner| corner == vertex) else { return false };
                let [next, last] = [1, 2].map(|step| corners[(first + step) % 3]);
                after.push(next);
                before.push(last);
                let arms = [next, last].map(|corner| vertices[corner as usize] - here);
                let across = arms[0].cross(arms[1]).normalize_or_zero();
                let normal = *plane.get_or_insert(across);
                let rises = |arm: &DVec3| normal.dot(*arm).abs() > FLATNESS * arm.length();
                if normal.dot(across) <= 0.0 || arms.iter().any(rises) {
                    return false;
                }
            }
            // All around: what one triangle ends with another begins with.
            before.sort_unstable();
            after.sort_unstable();
            before == after && before.windows(2).all(|pair| pair[0] != pair[1])
        });
        self.flat = flat.collect();
    }

    /// Finds out whether a mesh is closed, and convex.
    fn close(&mut self, vertices: &[DVec3], triangles: &[[u32; 3]]) {
        let welded = |triangle: &[u32; 3]| triangle.map(|i| self.welded[i as usize]);
        let mut beyond = HashMap::new();
        let mut manifold = true;
        for triangle in triangles.iter().map(welded) {
            let [i, j, k] = triangle;
            for (edge, third) in [([i, j], k), ([j, k], i), ([k, i], j)] {
                manifold &= i != j && j != k && k != i && beyond.insert(edge, third).is_none();
            }
        }
        if !manifold || !beyond.keys().all(|&[i, j]| beyond.contains_key(&[j, i])) {
            return;
        }
        let bounds = Aabb::of_points(triangles.as_flattened().iter().map(|&i| vertices[i as usize]));
        let (center, scale) = (bounds.center(), unit_scale(bounds.half_extents().max_element()));
        let at = |i: u32| (vertices[i as usize] - center) * scale;
        let volume: f64 = triangles.iter().map(|&[i, j, k]| at(i).dot(at(j).cross(at(k)))).sum();
        self.orientation = if volume < 0.0 { -1.0 } else { 1.0 };
        let rises = |&triangle: &[u32; 3]| {
            let [i, j, k] = triangle;
            let normal = (at(j) - at(i)).cross(at(k) - at(i)).normalize_or_zero() * self.orientation;
            [[i, j], [j, k], [k, i]].iter().any(|&[from, to]| {
                beyond.get(&[to, from]).is_none_or(|&third| normal.dot(at(third) - at(i)) > FLATNESS)
            })
        };
        // A closed surface of one part that is a sphere and nowhere rises is convex. Euler's formula tells the sphere.
        let mut corners: Vec<u32> = triangles.iter().flat_map(welded).collect();
        corners.sort_unstable();
        corners.dedup();
        let sphere = corners.len() + triangles.len() == beyond.len() / 2 + 2;
        let parts = super::parts::parts(
            vertices.len(),
            triangles.iter().map(|triangle| triangle.as_slice()),
            &(0u32..).zip(&self.welded).map(|(i, &j)| [i, j]).collect::<Vec<_>>(),
        );
        if sphere && parts.len() == 1 && !triangles.iter().map(welded).any(|t| rises(&t)) {
            let hull = Hulled::new(corners.iter().map(|&i| vertices[i as usize]).collect());
            self.convex = hull.map(|hull| (Arc::new(hull), corners));
        }
    }
}
