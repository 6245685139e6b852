//! The convex hull of points, with the adjacency of its vertices, for those who climb it. (The library's own hulls look support points up.)
//!
//! All decisions are exact: they are signs of determinants from `robust`. So no tolerance is asked for, and none is
//! hidden; nearly coplanar points make slender facets, exactly coplanar ones make one facet.
//!
//! The laws, each tested in `tests.rs`:
//!
//! 1. No point lies above any facet, and the surface is a closed manifold (checked by [`Hull::validate`]).
//! 2. The vertices are exactly the extreme points: none is lost, and no point inside a facet or an edge is among them.
//! 3. The result depends on the points and their order alone; there is no random choice.
//!
//! Method: quickhull (Barber, Dobkin and Huhdanpaa, *The quickhull algorithm for convex hulls*, 1996) in
//! `quickhull`, over distinct points, with exact predicates in place of its facet thickness; then exactly coplanar
//! triangles are merged into facets, which drops the points that turned out not to be extreme, in `facets`.

mod exact;
mod facets;
mod outline;
mod planar;
mod quickhull;
#[cfg(test)]
mod tests;
mod validate;

use exact::Sites;
use facets::Polygons;
use glam::DVec3;
pub(crate) use outline::outline;

/// The most points that [`Hull::of`] takes.
pub(crate) const POINTS_MAX: usize = (u32::MAX / 8) as usize;

/// The convex hull of finitely many points, as indices into the caller's points.
///
/// The points are not kept: a deformed copy of them can be used with the same hull as long as it stays convex.
///
/// ```
/// use solid3d::{glam::DVec3, hull::Hull};
/// // The corners of a cube, the centre of a face, and the centre of the cube.
/// let mut points: Vec<_> = (0..8u8).map(|i| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from))).collect();
/// points.extend([DVec3::new(0.5, 0.5, 1.0), DVec3::splat(0.5)]);
/// let hull = Hull::of(&points).expect("there are points");
/// assert_eq!(hull.dimension(), 3);
/// assert_eq!(hull.vertices(), [0, 1, 2, 3, 4, 5, 6, 7]);
/// assert_eq!(hull.triangles().len(), 12);
/// assert_eq!(hull.neighbours(0), [1, 2, 4]); // along the edges, not along diagonals
/// hull.validate(&points);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hull {
    dimension: u8,
    /// Ascending.
    vertices: Vec<u32>,
    /// Each with its smallest index first, ascending.
    triangles: Vec<[u32; 3]>,
    /// The neighbours of slot `i` are `neighbours[starts[i]..starts[i + 1]]`, ascending.
    neighbour_starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Hull {
    /// The convex hull of any finite points: interior, repeated, coplanar, collinear, or a single one. `None` if there
    /// are none.
    ///
    /// Exact while, on each axis, the coordinates other than zero differ in magnitude by a factor of at most 10^188;
    /// smaller ones count as zero. No other limit of range: the points are scaled by a power of two on each axis.
    ///
    /// Expected cost O(n log n), of prisms and other rings of many points, too: 10,000 points on a sphere take about 25 ms. Bad inputs can
    /// make it O(n^2), as any quickhull; nothing makes it fail.
    ///
    /// # Panics
    /// If a coordinate is not finite, or if there are more than `u32::MAX / 8` points.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let points = [1.0, 4.0, 2.0, 1.0].map(DVec3::splat);
    /// let hull = Hull::of(&points).expect("there are points");
    /// assert_eq!((hull.dimension(), hull.vertices()), (1, [0, 1].as_slice()));
    /// assert_eq!(Hull::of(&[]), None);
    /// ```
    pub fn of(points: &[DVec3]) -> Option<Hull> {
        assert!(points.len() <= POINTS_MAX, "too many points: {}", points.len());
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            panic!("point {i} is not finite: {}", points[i]);
        }
        if points.is_empty() {
            return None;
        }
        let sites = Sites::new(points);
        let (dimension, polygons) = polygons_of(&sites);
        Some(Hull::assemble(dimension, &polygons, &sites))
    }

    /// The dimension of the points' affine hull: 0 for one point, 1 for a segment, 2 for a polygon, 3 for a solid.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let hull = Hull::of(&[DVec3::ZERO, DVec3::X, DVec3::Y]).expect("there are points");
    /// assert_eq!(hull.dimension(), 2);
    /// ```
    pub fn dimension(&self) -> u8 {
        self.dimension
    }

    /// The extreme points, as ascending indices into the input; of equal points the first.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Y, 0.5 * DVec3::X];
    /// assert_eq!(Hull::of(&points).expect("there are points").vertices(), [0, 1, 2]);
    /// ```
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The surface, as triangles of indices into the input, counter-clockwise seen from outside.
    ///
    /// Flat facets are cut into triangles by taking off every second corner, again and again, so that a line meets few of them. A polygon (dimension 2) has both its sides; points and segments have
    /// no triangles.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let hull = Hull::of(&[DVec3::ZERO, DVec3::X, DVec3::Y]).expect("there are points");
    /// assert_eq!(hull.triangles(), [[0, 1, 2], [0, 2, 1]]);
    /// ```
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The vertices joined to a vertex by an edge. Vertices are named by their slots in [`vertices`](Self::vertices).
    ///
    /// Diagonals of flat facets are not edges. A linear function that is greater at no neighbour of a
    /// vertex has its greatest value there, so hill climbing along these edges ends at a support point. That holds for
    /// exact products: where neighbours are so near that their rounded products are equal (slivers, clusters), climbing
    /// by strict improvement can stop early, on a plateau.
    ///
    /// # Panics
    /// If there is no such slot.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
    /// let hull = Hull::of(&square).expect("there are points");
    /// assert_eq!(hull.neighbours(0), [1, 3]);
    /// ```
    pub fn neighbours(&self, vertex_slot: usize) -> &[u32] {
        let start = self.neighbour_starts[vertex_slot] as usize;
        let end = self.neighbour_starts[vertex_slot + 1] as usize;
        &self.neighbours[start..end]
    }

    /// From facets over sites to vertices, triangles and edges over the input.
    fn assemble(dimension: u8, polygons: &Polygons, sites: &Sites) -> Hull {
        let mut vertices = Vec::new();
        let mut triangles = Vec::new();
        let mut edges = Vec::new();
        let mut polygon = Vec::new();
        for corners in polygons.iter() {
            polygon.clear();
            polygon.extend(corners.iter().map(|&site| sites.input(site)));
            begin_with_smallest(&mut polygon);
            vertices.extend_from_slice(&polygon);
            let next = polygon.iter().cycle().skip(1);
            edges.extend(polygon.iter().copied().zip(next.copied()).filter(|(a, b)| a != b));
            triangulate(&mut polygon, &mut triangles);
        }
        if dimension == 2 {
            let (fronts, rim) = (triangles.len(), edges.len());
            triangles.extend_from_within(..);
            triangles[fronts..].iter_mut().for_each(|[_, q, r]| std::mem::swap(q, r));
            edges.extend_from_within(..);
            edges[rim..].iter_mut().for_each(|(a, b)| std::mem::swap(a, b));
        }
        vertices.sort_unstable();
        vertices.dedup();
        triangles.sort_unstable();
        edges.sort_unstable();
        let slot = |input: u32| vertices.binary_search(&input).expect("edges join vertices") as u32;
        let neighbours = edges.iter().map(|&(_, to)| slot(to)).collect();
        let mut neighbour_starts = vec![0; vertices.len() + 1];
        for &(from, _) in &edges {
            neighbour_starts[slot(from) as usize + 1] += 1;
        }
        for i in 0..vertices.len() {
            neighbour_starts[i + 1] += neighbour_starts[i];
        }
        Hull { dimension, vertices, triangles, neighbour_starts, neighbours }
    }
}

/// Cuts every second corner off a polygon until nothing is left.
fn triangulate(polygon: &mut Vec<u32>, triangles: &mut Vec<[u32; 3]>) {
    while let [first, _, _, ..] = polygon[..] {
        let ears = polygon.chunks_exact(2).zip(polygon.iter().skip(2).step_by(2).chain([&first]));
        triangles.extend(ears.map(|(ear, &next)| {
            let mut triangle = [ear[0], ear[1], next];
            begin_with_smallest(&mut triangle);
            triangle
        }));
        let mut is_kept = [true, false].into_iter().cycle();
        polygon.retain(|_| is_kept.next() == Some(true));
    }
}

/// Turns a polygon, so that its smallest corner comes first.
fn begin_with_smallest(polygon: &mut [u32]) {
    let smallest = (0..polygon.len()).min_by_key(|&i| polygon[i]).unwrap_or(0);
    polygon.rotate_left(smallest);
}

/// The facets of the hull, whatever its dimension: of a polygon, which has two, the one side; a segment counts as one facet of two corners, a
/// point as one of one corner.
fn polygons_of(sites: &Sites) -> (u8, Polygons) {
    let first = 0;
    let last = sites.len() - 1;
    if first == last {
        return (0, Polygons::from_iter([vec![first]]));
    }
    let Some((third, dropped_axis)) = sites.farthest_from_line(first, last) else {
        // The sites are in lexicographic order: the first and the last are the ends.
        return (1, Polygons::from_iter([vec![first, last]]));
    };
    let Some(fourth) = sites.farthest_from_plane([first, last, third]) else {
        return (2, Polygons::from_iter([planar::convex_polygon(sites, dropped_axis)]));
    };
    let surface = quickhull::surface(sites, [first, last, third, fourth]);
    (3, facets::merge(sites, &surface))
}
