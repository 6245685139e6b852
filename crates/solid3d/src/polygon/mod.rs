//! Non-convex polygons, with holes by doubled edges (thesis, chapter 3 and section 2.1.1).
//!
//! A polygon is what one closed chain of edges bounds in a plane. Edges may touch, and two edges may be the same, which is
//! how holes are made: a bridge of two opposite edges joins the hole's boundary to the outer one. A doubled edge inside is a
//! slit and counts for nothing; one outside is an antenna. Edges must not cross. Polygons are closed sets: touching is
//! intersecting.
//!
//! The laws, each tested in `tests`:
//!
//! 1. For flat polygons, whose vertices are exactly coplanar, every answer except those about spheres is exact: all is decided
//!    by signs of determinants from `robust`, degenerate and coplanar polygons included.
//! 2. [`intersect_sorted`], [`intersect_straightforward`] and [`intersect_triangulated`] agree.
//! 3. An uneven polygon stands for some surface over its chain that is within twice its [`Plane::deviation`] of it: an answer
//!    about it can be wrong only where the polygons are that close to just touching. Where a vertex of the other is too near its
//!    plane for signs to mean anything, its triangles decide.
//! 4. Scaling by a power of two, reversing and rotating a chain, and exchanging the polygons change no answer.
//!
//! Exact while the coordinates of both polygons are zero or from 2^-300 to 2^300; beyond that they are scaled by a power of two
//! first, and coordinates below 2^-300 times the largest count as zero.
//!
//! From the ground: `exact` (signs), `planar` (chains in the plane), `chain` (the vertices, and three that stand for the plane),
//! `segment` (segment against polygon), `section` (polygon against plane), `overlap` (Algorithms 3.1 and 3.2), `pair` and
//! `intersection` (polygon against polygon), `sphere`, `cuboid`; `triangulation` and `holes`, with `bridges` and `corner`, work on chains in the plane.

mod bridges;
mod chain;
mod corner;
mod counters;
mod cuboid;
mod error;
mod exact;
mod holes;
mod intersection;
mod overlap;
mod pair;
mod planar;
mod plane;
mod section;
mod segment;
mod sphere;
#[cfg(test)]
mod tests;
mod triangulation;

use chain::Chain;
pub use counters::Counters;
pub use error::{PolygonError, Result};
use glam::{DAffine3, DVec3};
pub use intersection::{Intersection, intersect_sorted, intersect_straightforward, intersect_triangulated};
pub use plane::Plane;
use solid_convex::{MAGNITUDE_MAX, unit_scale};
pub use sphere::SPHERE_ERROR;

use crate::bounds::Aabb;

/// How far a vertex may be off the polygon's plane, relative to the largest side of the polygon's box: some sixteen
/// roundings of the 32-bit numbers of files. [`Polygon::with_tolerance`] takes another limit.
pub const FLATNESS_TOLERANCE: f64 = 1e-6;

/// What the rounding of 64-bit coordinates may add to that, relative to the greatest coordinate.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A polygon in space, not necessarily convex.
///
/// ```
/// use solid3d::{glam::DVec3, polygon::Polygon};
/// // An arrowhead.
/// let arrow = Polygon::new([(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)))?;
/// assert!(!arrow.is_convex());
/// assert_eq!(arrow.area(), 1.0);
/// // A needle through its notch, and one through its tip.
/// let needle = |x: f64| Polygon::new([-1.0, 1.0, 1.0].map(|z| DVec3::new(x, 1.0, z)));
/// assert!(!arrow.intersects(&needle(0.5)?));
/// assert!(arrow.intersects(&needle(1.5)?));
/// # Ok::<(), solid3d::polygon::PolygonError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Polygon {
    chain: Chain,
    plane: Plane,
    area: f64,
    bounds: Aabb,
    /// Whether the coordinates are in the range in which predicates are exact.
    fits_predicates: bool,
}

impl Polygon {
    /// The polygon bounded by a closed chain: the last vertex is joined to the first. Vertices may be collinear, repeated, even
    /// all the same; they must be coplanar, up to [`FLATNESS_TOLERANCE`]. That edges do not cross is not checked here, since it
    /// takes longer: see [`simple`](Polygon::simple). Cost: O(n).
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let error = Polygon::new([DVec3::ZERO, DVec3::X]).unwrap_err();
    /// assert_eq!(error.to_string(), "polygon has 2 vertices; a closed chain needs at least 3");
    /// let tent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5), DVec3::Y];
    /// let error = Polygon::new(tent).unwrap_err().to_string();
    /// assert!(error.starts_with("vertex ") && error.contains("off the plane of the polygon; at most 1.0"), "{error}");
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn new(vertices: impl Into<Vec<DVec3>>) -> Result<Polygon> {
        let vertices = vertices.into();
        let tolerance = tolerance(&Aabb::of_points(vertices.iter().copied()));
        Polygon::with_tolerance(vertices, tolerance)
    }

    /// As [`new`](Polygon::new), but vertices may be up to `tolerance`, a length, off [the plane](Polygon::plane).
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let tent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5), DVec3::Y];
    /// assert!(Polygon::with_tolerance(tent, 0.12).is_ok());
    /// assert!(Polygon::with_tolerance(tent, 0.11).is_err());
    /// ```
    pub fn with_tolerance(vertices: impl Into<Vec<DVec3>>, tolerance: f64) -> Result<Polygon> {
        let vertices = vertices.into();
        check(&vertices)?;
        if vertices.len() < 3 {
            return Err(PolygonError::TooFewVertices { chain: "polygon".into(), count: vertices.len() });
        }
        let bounds = Aabb::of_points(vertices.iter().copied());
        let plane::Fit { plane, area, farthest } =
            plane::fit(&vertices, (bounds.max - bounds.min).max_element());
        // A tolerance that is not a number allows nothing.
        let allowed = plane.deviation == 0.0 || plane.deviation <= tolerance;
        if !allowed {
            return Err(PolygonError::NotFlat { index: farthest, deviation: plane.deviation, tolerance });
        }
        let fits_predicates = vertices.iter().copied().all(exact::fits);
        let chain = if fits_predicates {
            Chain::new(vertices, plane.normal)
        } else {
            let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
            Chain::unfit(vertices, plane.normal, unit_scale(reach))
        };
        Ok(Polygon { chain, plane, area, bounds, fits_predicates })
    }

    /// A polygon with holes: [`join_holes`] makes one chain of them. Also checks that no edges cross. Errors count the vertices of `outer`, and
    /// then those of each hole.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let square = |from: f64, to: f64| {
    ///     [(from, from), (to, from), (to, to), (from, to)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec()
    /// };
    /// let frame = Polygon::with_holes(square(0.0, 4.0), [square(1.0, 3.0)])?;
    /// assert_eq!((frame.vertices().len(), frame.area()), (10, 12.0));
    /// let needle = |x: f64| Polygon::new([-1.0, 1.0, 1.0].map(|z| DVec3::new(x, 2.0, z)));
    /// assert!(frame.intersects(&needle(0.5)?));
    /// assert!(!frame.intersects(&needle(2.0)?)); // through the hole
    /// let error = Polygon::with_holes(square(0.0, 4.0), [square(3.0, 5.0)]).unwrap_err();
    /// assert_eq!(error.to_string(), "hole 0 is not inside the outer boundary and outside the other holes");
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn with_holes(
        outer: impl Into<Vec<DVec3>>,
        holes: impl IntoIterator<Item = Vec<DVec3>>,
    ) -> Result<Polygon> {
        let mut vertices = outer.into();
        let outer: Vec<u32> = (0..vertices.len() as u32).collect();
        let mut places = Vec::new();
        for hole in holes {
            let first = vertices.len() as u32;
            vertices.extend(hole);
            places.push((first..vertices.len() as u32).collect::<Vec<u32>>());
        }
        let chain = join_holes(&vertices, &outer, &places)?;
        let polygon = Polygon::new(chain.iter().map(|&i| vertices[i as usize]).collect::<Vec<_>>());
        polygon.and_then(Polygon::simple).map_err(|error| {
            let mut next = vec![0; vertices.len()];
            for ring in std::iter::once(&outer).chain(&places) {
                ring.iter()
                    .zip(ring.iter().cycle().skip(1))
                    .for_each(|(&i, &after)| next[i as usize] = after);
            }
            error.of_rings(&chain, &next)
        })
    }

    /// The polygon itself, if none of its edges cross. Exact. Edges that touch, also along a piece, do not cross. Cost: O(n log n), and a
    /// look at each pair of edges that are about the same x.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let bow_tie = Polygon::new([DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::Y])?;
    /// let error = bow_tie.simple().unwrap_err().to_string();
    /// assert!(error.starts_with("edges 0 and 2 of the polygon cross"), "{error}");
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn simple(self) -> Result<Polygon> {
        let (flat, _) = self.flattened();
        match planar::crossing(&flat) {
            Some([first, second]) => Err(PolygonError::NotSimple { first, second }),
            None => Ok(self),
        }
    }

    /// The image under an affine map, within the rounding of coordinates and `self`'s unevenness: it need not be flat, where
    /// `self` is.
    ///
    /// ```
    /// use solid3d::{glam::{DAffine3, DVec3}, polygon::Polygon};
    /// let triangle = Polygon::new([DVec3::ZERO, DVec3::X, DVec3::Y])?;
    /// let raised = triangle.transformed(&DAffine3::from_translation(DVec3::Z))?;
    /// assert_eq!(raised.vertices()[1], DVec3::X + DVec3::Z);
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn transformed(&self, map: &DAffine3) -> Result<Polygon> {
        let vertices: Vec<DVec3> = self.vertices().iter().map(|&p| map.transform_point3(p)).collect();
        Polygon::with_tolerance(vertices, f64::INFINITY)
    }

    /// The vertices, in order.
    pub fn vertices(&self) -> &[DVec3] {
        &self.chain.vertices
    }

    /// Newell's plane.
    pub fn plane(&self) -> &Plane {
        &self.plane
    }

    /// The area: that of the outer boundary less that of the holes.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The box around the polygon.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether the vertices are exactly coplanar.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let mut square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// assert!(Polygon::new(square)?.is_flat());
    /// square[2].z = 1e-30;
    /// assert!(!Polygon::new(square)?.is_flat());
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn is_flat(&self) -> bool {
        if self.fits_predicates {
            self.chain.is_flat()
        } else {
            self.chain.scaled(unit_scale(self.reach())).is_flat()
        }
    }

    /// Whether the polygon is convex, and its chain goes around it once. Exact. Collinear and repeated vertices do not count.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let square = [DVec3::ZERO, 0.5 * DVec3::X, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// assert!(Polygon::new(square)?.is_convex());
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn is_convex(&self) -> bool {
        planar::is_convex(&self.flattened().0)
    }

    /// Whether the polygon is its convex hull, up to as much as a vertex may be off its plane: edges may be cut in pieces, however that
    /// was rounded. Cost: O(n log n).
    pub(crate) fn fills_hull(&self) -> bool {
        let (flat, _) = self.flattened();
        let bounds = Aabb::of_points(flat.iter().map(|p| p.extend(0.0)));
        planar::fills_hull(&flat, tolerance(&bounds))
    }

    /// A triangulation: n - 2 triangles of places in [`vertices`](Polygon::vertices), turned as the polygon is. Every vertex is a
    /// corner, so some triangles may have no area; together they cover the polygon exactly. Cost: O(n^2), at worst O(n^3).
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let arrow = Polygon::new([(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)))?;
    /// assert_eq!(arrow.triangles(), [[3, 0, 1], [1, 2, 3]]);
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        triangulation::triangulate(&self.flattened().0)
    }

    /// Whether two polygons have a point in common, touching included: [`intersect_sorted`], behind a test of their boxes.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let a = Polygon::new([DVec3::ZERO, DVec3::X, DVec3::Y])?;
    /// assert!(a.intersects(&Polygon::new([DVec3::X, DVec3::ONE, DVec3::new(2.0, 0.0, 1.0)])?)); // a corner of both
    /// assert!(!a.intersects(&Polygon::new([DVec3::Z * 1e-30, DVec3::ONE, DVec3::Z])?));
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn intersects(&self, other: &Polygon) -> bool {
        self.bounds.overlaps(&other.bounds) && intersect_sorted(self, other, &mut Counters::default())
    }

    /// What two polygons have in common: the segments in which they meet, by Algorithm 3.2 of the thesis.
    ///
    /// Whether there are any is exact; their ends are rounded, except at vertices.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::{Intersection, Polygon}};
    /// let comb = [(0.0, 0.0), (5.0, 0.0), (5.0, 2.0), (4.0, 2.0), (4.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    /// let comb = Polygon::new(comb.map(|(x, y)| DVec3::new(x, y, 0.0)))?;
    /// let wall = Polygon::new([(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(x, z)| DVec3::new(x, 1.5, z)))?;
    /// let segments = [[4.5, 4.0], [1.0, 0.0]].map(|ends| ends.map(|x| DVec3::new(x, 1.5, 0.0)));
    /// assert_eq!(comb.intersection(&wall), Intersection::Segments(segments.to_vec()));
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn intersection(&self, other: &Polygon) -> Intersection {
        if self.bounds.overlaps(&other.bounds) {
            intersection::intersection(self, other)
        } else {
            Intersection::Apart
        }
    }

    /// Whether the polygon has a point in common with the ball around `center`, touching included (thesis, section 3.3.1).
    ///
    /// Right when the distance of the centre from the polygon differs from the radius by more than [`SPHERE_ERROR`] times the
    /// greatest coordinate or radius, twice the plane's `deviation`, and `normal_error` times the distance.
    ///
    /// ```
    /// use solid3d::{glam::DVec3, polygon::Polygon};
    /// let triangle = Polygon::new([DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0])?;
    /// assert!(triangle.meets_sphere(DVec3::new(1.0, 1.0, 2.0), 2.0)?);
    /// assert!(!triangle.meets_sphere(DVec3::new(3.0, 3.0, 0.0), 1.4)?); // sqrt 2 away
    /// assert!(triangle.meets_sphere(DVec3::ZERO, -1.0).is_err());
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn meets_sphere(&self, center: DVec3, radius: f64) -> Result<bool> {
        sphere::meets(self, center, radius)
    }

    /// Whether the polygon has a point in common with a box, touching included (thesis, section 3.3.2). Exact for a flat
    /// polygon.
    ///
    /// ```
    /// use solid3d::{Aabb, glam::DVec3, polygon::Polygon};
    /// let triangle = Polygon::new([DVec3::X, DVec3::Y, DVec3::Z])?;
    /// let cube = |to: f64| Aabb::new(DVec3::ZERO, DVec3::splat(to));
    /// assert!(!triangle.meets_box(&cube(0.3333))?);
    /// assert!(triangle.meets_box(&cube(0.3334))?);
    /// # Ok::<(), solid3d::polygon::PolygonError>(())
    /// ```
    pub fn meets_box(&self, bounds: &Aabb) -> Result<bool> {
        cuboid::meets(self, bounds)
    }

    /// The greatest magnitude of a coordinate.
    fn reach(&self) -> f64 {
        self.bounds.min.abs().max(self.bounds.max.abs()).max_element()
    }

    /// The vertices seen along the axis closest to the normal, in a scale in which predicates are exact; and the axis.
    fn flattened(&self) -> (Vec<glam::DVec2>, usize) {
        // Collinear vertices may look like a point along one axis, but not along every one.
        let size = self.bounds.max - self.bounds.min;
        let shortest = (0..3).min_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
        let dropped = self.chain.base.map_or(shortest, |base| base.dropped);
        if self.fits_predicates {
            return (self.chain.flattened(dropped), dropped);
        }
        (self.chain.scaled(unit_scale(self.reach())).flattened(dropped), dropped)
    }
}

/// Makes one closed chain of a boundary and the holes in it, by doubled edges; all are indices into `vertices`, and so is the
/// result, which runs as `outer` does (thesis, section 2.1.1). Each hole is connected by the shortest of the edges between vertices
/// that touch nothing else, which is decided exactly. Holes may run either way, and may touch the boundary and each other, along edges too.
/// Cost: O(n^2), at worst O(n^3).
///
/// ```
/// use solid3d::{glam::DVec3, polygon::join_holes};
/// let vertices = [(0, 0), (9, 0), (0, 9), (1, 1), (2, 1), (1, 2)].map(|(x, y)| DVec3::new(x.into(), y.into(), 0.0));
/// let chain = join_holes(&vertices, &[0, 1, 2], &[vec![3, 4, 5]])?;
/// assert_eq!(chain, [0, 3, 5, 4, 3, 0, 1, 2]);
/// let error = join_holes(&vertices, &[0, 1, 2], &[vec![3, 4, 6]]).unwrap_err();
/// assert_eq!(error.to_string(), "hole 0 names vertex 6, but there are 6 vertices");
/// # Ok::<(), solid3d::polygon::PolygonError>(())
/// ```
pub fn join_holes(vertices: &[DVec3], outer: &[u32], holes: &[Vec<u32>]) -> Result<Vec<u32>> {
    let places = |chain: &[u32]| chain.iter().map(|&i| i as usize).collect::<Vec<usize>>();
    let names = std::iter::once("outer".to_owned()).chain((0..holes.len()).map(|i| format!("hole {i}")));
    let chains = std::iter::once(outer).chain(holes.iter().map(|hole| &hole[..]));
    for (chain, indices) in names.zip(chains) {
        if indices.len() < 3 {
            return Err(PolygonError::TooFewVertices { chain, count: indices.len() });
        }
        if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(PolygonError::VertexIndex { chain, index, vertices: vertices.len() });
        }
    }
    check(vertices)?;
    let boundary = outer.iter().map(|&i| vertices[i as usize]).collect::<Vec<_>>();
    let (_, dropped) = Polygon::with_tolerance(boundary, f64::INFINITY)?.flattened();
    let reach = vertices.iter().fold(0.0_f64, |reach, p| reach.max(p.abs().max_element()));
    let scale = unit_scale(reach);
    let flat: Vec<_> = vertices.iter().map(|&p| exact::flatten(dropped, chain::scaled(p, scale))).collect();
    let holes: Vec<_> = holes.iter().map(|hole| places(hole)).collect();
    let chain = holes::join(&flat, &places(outer), &holes)?;
    Ok(chain.into_iter().map(|i| i as u32).collect())
}

/// How far a vertex may be off the plane of a polygon, or off an edge of its hull, when the polygon has this box.
fn tolerance(bounds: &Aabb) -> f64 {
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    FLATNESS_TOLERANCE * (bounds.max - bounds.min).max_element() + ROUNDING * reach
}

fn check(vertices: &[DVec3]) -> Result<()> {
    let in_range = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAGNITUDE_MAX;
    match vertices.iter().position(|v| !in_range(v)) {
        Some(index) => Err(PolygonError::Vertex { index, value: vertices[index] }),
        None => Ok(()),
    }
}
