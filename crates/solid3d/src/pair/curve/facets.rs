//! The facets of the primitives that may meet, in the common frame.

use std::ops::Range;

use glam::{DAffine3, DVec3};

use super::Pair;
use super::sites::{Edge, Face, Site, Sites};
use crate::bounds::Aabb;
use crate::shape::{Complex, boundary};

/// Facets of two surfaces.
pub(super) struct Facets {
    pub sites: Sites,
    sides: [Side; 2],
}

/// The facets of some primitives of a surface.
struct Side {
    /// Ascending.
    primitives: Vec<u32>,
    /// The facets of the primitive in slot `i` are `facets[starts[i]..starts[i + 1]]`.
    starts: Vec<usize>,
    facets: Vec<Facet>,
}

/// A triangle, a segment or a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// Ascending; the last is repeated when there are fewer than three.
    corners: [Site; 3],
    count: usize,
    /// Whether the corners span no plane.
    pub collinear: bool,
    pub bounds: Aabb,
}

impl Facets {
    /// Of the primitives that the pairs name.
    pub fn new(complexes: [&Complex; 2], common: &[DAffine3; 2], pairs: &[Pair]) -> Self {
        let corners = [0, 1].map(|side| Corners::new(complexes[side], &common[side], pairs, side));
        let points = corners.iter().flat_map(|corners| corners.triangles.as_flattened());
        let sites = Sites::new(points.copied());
        let sides = corners.map(|corners| Side {
            facets: corners.triangles.iter().map(|triangle| Facet::new(triangle, &sites)).collect(),
            primitives: corners.primitives,
            starts: corners.starts,
        });
        Facets { sites, sides }
    }

    /// The facets of a primitive of either surface.
    pub fn of(&self, side: usize, primitive: u32) -> &[Facet] {
        let Side { primitives, starts, facets } = &self.sides[side];
        let slot = primitives.binary_search(&primitive).expect("a pair names the primitive");
        &facets[Range { start: starts[slot], end: starts[slot + 1] }]
    }
}

/// The same as [`Side`] before sites are known.
struct Corners {
    primitives: Vec<u32>,
    starts: Vec<usize>,
    triangles: Vec<[DVec3; 3]>,
}

impl Corners {
    fn new(complex: &Complex, map: &DAffine3, pairs: &[Pair], side: usize) -> Self {
        let mut primitives: Vec<u32> = pairs.iter().map(|pair| pair[side]).collect();
        primitives.sort_unstable();
        primitives.dedup();
        let (mut starts, mut triangles) = (vec![0], Vec::new());
        for &primitive in &primitives {
            let placed = |vertex: u32| map.transform_point3(complex.vertices()[vertex as usize]);
            triangles.extend(boundary(complex, primitive).into_iter().map(|facet| facet.map(placed)));
            starts.push(triangles.len());
        }
        Corners { primitives, starts, triangles }
    }
}

impl Facet {
    fn new(triangle: &[DVec3; 3], sites: &Sites) -> Self {
        let mut corners = triangle.map(|p| sites.of(p));
        corners.sort_unstable();
        let [a, b, c] = corners;
        let (corners, count) = match (a == b, b == c) {
            (true, true) => ([a; 3], 1),
            (true, false) | (false, true) => ([a, c, c], 2),
            (false, false) => (corners, 3),
        };
        let collinear = sites.dropped_axis(corners).is_none();
        Facet { corners, count, collinear, bounds: Aabb::of_points(*triangle) }
    }

    /// The distinct corners, ascending.
    pub fn corners(&self) -> &[Site] {
        &self.corners[..self.count]
    }

    /// The triangle, unless it is degenerate.
    pub fn face(&self) -> Option<Face> {
        (!self.collinear).then_some(self.corners)
    }

    /// The edges: all three of a degenerate triangle too, since each may be its neighbour's.
    pub fn edges(&self) -> &'static [[usize; 2]] {
        match self.count {
            1 => &[],
            2 => &[[0, 1]],
            _ => &[[0, 1], [1, 2], [0, 2]],
        }
    }

    /// An edge by the places of its corners.
    pub fn edge(&self, [i, j]: [usize; 2]) -> Edge {
        [self.corners[i], self.corners[j]]
    }

    /// The fewest corners whose hull the facet is: one, two or three.
    pub fn spanning(&self) -> ([Site; 3], usize) {
        match (self.count, self.collinear) {
            (3, true) => ([self.corners[0], self.corners[2], self.corners[2]], 2),
            (count, _) => (self.corners, count),
        }
    }
}
