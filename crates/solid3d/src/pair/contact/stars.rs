//! What lies around the vertices of a placed soup, and which normals its surface has there.

use std::cell::{Cell, OnceCell, RefCell};
use std::collections::{BTreeSet, HashMap};

use glam::{DMat3, DVec3};
use smallvec::SmallVec;
use solid_convex::simd::each;
use solid_convex::{Polytope, Support};

use super::face;
use super::map::Map;
use super::other::Other;
use super::planes::{Plane, Planes};
use crate::shape::Complex;

/// Heights along a normal that differ by less than this, in the unit of the pair, are the same.
pub(super) const LEVEL: f64 = 1e-9;

/// A normal within this of that of the triangle is the same: the square root of the error of a depth.
pub(super) const SAME_NORMAL: f64 = 1e-6;

/// What is kept of a vertex takes longer than looking at so few triangles again.
const HUB_MIN: usize = 32;

/// All around a hub are looked at so often, one after the other, before their corners are laid out for vectors.
const LOOKS: usize = 8;

/// So many corners of them are compared at once.
const PART: usize = 128;

/// The stars of the vertices of a soup: the primitives around each.
pub(super) struct Stars<'a> {
    pub complex: &'a Complex,
    pub map: &'a Map,
    /// 1 when the normals of the triangles point out of a solid, -1 when into it, 0 when there is none.
    pub orientation: f64,
    /// Vertices with more primitives around them are hubs: their triangles do not each look at all others.
    pub hub_min: usize,
    /// What was found at a hub, or at an edge from one vertex to another, beside a primitive of the other shape: all around it ask for the same.
    /// Two of them, along normals that are not parallel, for whom one is that of its own.
    shortest: RefCell<HashMap<[u32; 3], [Shortest; 2]>>,
    /// What is around a hub, or around an edge from one to another.
    hubs: RefCell<HashMap<[u32; 2], Hub>>,
    /// The last vertex that had a normal, and that in local space: a face lies on all around it.
    last: Cell<Option<(u32, DVec3)>>,
    /// The planes of triangles around those that meet the other, of which there are so many; once they are asked for.
    planes: OnceCell<Planes>,
    found: usize,
}

/// How many of the primitives around a hub were looked at, one after the other, and the corners of all, once these were many.
#[derive(Default)]
struct Hub {
    looked_at: usize,
    parts: Vec<Polytope>,
}

/// The normal along which the way out is the shortest.
#[derive(Clone, Copy)]
pub(super) struct Shortest {
    pub depth: f64,
    pub normal: Option<DVec3>,
}

/// How deep the other is along the normal of a triangle, times a sign.
type Along = (f64, u32, f64);

impl<'a> Stars<'a> {
    /// For the contacts of so many of the primitives.
    pub fn new(complex: &'a Complex, map: &'a Map, found: usize) -> Stars<'a> {
        let turned = map.linear().determinant().signum();
        let orientation =
            if complex.is_solid() { complex.topology().enclosed().orientation * turned } else { 0.0 };
        let (shortest, hubs) = (RefCell::default(), RefCell::default());
        let (last, planes) = (Cell::new(None), OnceCell::new());
        Stars { complex, map, orientation, hub_min: HUB_MIN, shortest, hubs, last, planes, found }
    }

    /// Where the corners of a primitive are.
    pub fn corners(&self, primitive: u32) -> SmallVec<[DVec3; 4]> {
        few(self.complex.primitive(primitive), |vertex| self.place(vertex))
    }

    /// Where a vertex is.
    #[inline]
    fn place(&self, vertex: u32) -> DVec3 {
        self.map.point(self.complex.vertices()[vertex as usize])
    }

    /// The primitives around a vertex.
    pub fn around(&self, vertex: u32) -> &'a [u32] {
        self.complex.topology().around(vertex)
    }

    /// The primitives that have all of some vertices, of which there is one at least. Cost: follows those around the vertex that has the
    /// fewest.
    pub fn around_all(&self, vertices: &[u32]) -> impl Iterator<Item = u32> {
        let stars = vertices.iter().map(|&vertex| (vertex, self.around(vertex)));
        let (own, fewest) = stars.min_by_key(|(_, star)| star.len()).unwrap_or_default();
        let has_all =
            move |&triangle: &u32| vertices.iter().all(|&vertex| vertex == own || self.has(triangle, vertex));
        fewest.iter().copied().filter(has_all)
    }

    /// The primitives at an edge of one of them, but for that. At one between two hubs none: what is around it is too much to look at for each of them.
    pub fn across(&self, edge: &[u32; 2], own: u32) -> impl Iterator<Item = u32> {
        let around = self.hub(edge).is_none().then(|| self.around_all(edge));
        around.into_iter().flatten().filter(move |&primitive| primitive != own)
    }

    /// Whether a normal, or its opposite, is that of a triangle.
    pub fn is_level(&self, triangle: u32, normal: DVec3, other: &Other) -> bool {
        is_parallel(self.plane(triangle, other).normal, normal)
    }

    /// Whether the surface has a normal at what of some vertices is highest along it: nothing around that is higher. A normal that is off by a tilt
    /// raises what is as far off as these vertices are from each other by that part of it; larger primitives around may be raised by more, but they
    /// ask for themselves.
    pub fn have(&self, normal: DVec3, tilt: f64, vertices: &[u32]) -> bool {
        let local = self.map.linear().transpose() * normal;
        let heights = few(vertices, |vertex| local.dot(self.complex.vertices()[vertex as usize]));
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let level = LEVEL + if tilt > 0.0 { tilt * self.extent(vertices) } else { 0.0 };
        let mut touched: SmallVec<[u32; 4]> = SmallVec::new();
        for (&vertex, height) in vertices.iter().zip(heights) {
            if height >= highest - level {
                touched.push(vertex);
            }
        }
        let star = (touched.len() == 1).then(|| (touched[0], local));
        if star.is_some() && star == self.last.get() {
            return true;
        }
        let has = self.are_below(&touched, local, highest + level);
        if has {
            self.last.set(star);
        }
        has
    }

    /// How far some vertices are from the first of them, at most.
    fn extent(&self, vertices: &[u32]) -> f64 {
        let first = self.place(vertices[0]);
        vertices.iter().map(|&vertex| first.distance(self.place(vertex))).fold(0.0, f64::max)
    }

    /// Whether all primitives that have some vertices are below a height along a direction. Space: local.
    fn are_below(&self, vertices: &[u32], direction: DVec3, height: f64) -> bool {
        let around = || self.around_all(vertices).map(|primitive| self.complex.primitive(primitive));
        let place = |&vertex: &u32| self.complex.vertices()[vertex as usize];
        let is_below = |corners: &[u32]| corners.iter().all(|corner| direction.dot(place(corner)) <= height);
        let Some(ends) = self.hub(vertices) else { return around().all(is_below) };
        let hubs = &mut *self.hubs.borrow_mut();
        let Hub { looked_at, parts } = hubs.entry(ends).or_default();
        if *looked_at > LOOKS * self.around(ends[0]).len() {
            if parts.is_empty() {
                let corners: BTreeSet<u32> = around().flatten().copied().collect();
                let corners: Vec<DVec3> = corners.iter().map(place).collect();
                parts.extend(corners.chunks(PART).filter_map(|part| Polytope::new(part.to_vec())));
            }
            return parts.iter().all(|part| direction.dot(part.support(direction)) <= height);
        }
        around().inspect(|_| *looked_at += 1).all(is_below)
    }

    /// The hub, or the ends of an edge from one to another, if that is what some vertices are.
    fn hub(&self, vertices: &[u32]) -> Option<[u32; 2]> {
        let ends = match *vertices {
            [hub] => [hub; 2],
            [from, to] => [from.min(to), from.max(to)],
            _ => return None,
        };
        ends.iter().all(|&end| self.is_hub(end)).then_some(ends)
    }

    /// Whether some hub was looked at so often that what is around it is laid out.
    #[cfg(test)]
    pub fn has_laid_out(&self) -> bool {
        self.hubs.borrow().values().any(|hub| !hub.parts.is_empty())
    }

    /// Whether the surface is flat all around a triangle.
    pub fn is_flat(&self, triangle: u32) -> bool {
        self.complex.is_flat(triangle)
    }

    /// The least and the greatest height of the box around the soup along a direction.
    pub fn extremes(&self, direction: DVec3) -> [f64; 2] {
        let bounds = self.complex.bounds();
        let middle = direction.dot(self.map.point(bounds.center()));
        let reach = (self.map.linear().transpose() * direction).abs().dot(0.5 * (bounds.max - bounds.min));
        [middle - reach, middle + reach]
    }

    /// How large the soup is: the edges of its local box.
    pub fn size(&self) -> f64 {
        let bounds = self.complex.bounds();
        let edges = DMat3::from_diagonal(bounds.max - bounds.min);
        let DMat3 { x_axis, y_axis, z_axis } = *self.map.linear() * edges;
        x_axis.length() + y_axis.length() + z_axis.length()
    }

    /// Whether the surface around a triangle is in its plane, as far as it goes.
    pub fn is_level_around(&self, triangle: u32) -> bool {
        self.complex.is_level(triangle)
    }

    /// Whether so many primitives are around a vertex that what was found there is kept.
    pub fn is_hub(&self, vertex: u32) -> bool {
        self.around(vertex).len() > self.hub_min
    }

    /// The shortest way out at a vertex, or at an edge between two, along one of the normals of the triangles there, of those that the surface
    /// has there. Not along one that is known.
    pub fn shortest_at(&self, vertices: [u32; 2], known: DVec3, other: &Other) -> Shortest {
        let [from, to] = [vertices[0].min(vertices[1]), vertices[0].max(vertices[1])];
        let kept = &mut *self.shortest.borrow_mut();
        let [first, second] = *kept.entry([from, to, other.primitive]).or_insert_with(|| {
            let all = [from, to];
            let vertices = if from == to { &all[..1] } else { &all };
            let corners: SmallVec<[DVec3; 2]> = vertices.iter().map(|&vertex| self.place(vertex)).collect();
            let besides = |known| self.shortest_of_all((vertices, &corners), known, other);
            let first = besides(None);
            [first, first.normal.map_or(first, |normal| besides(Some(normal)))]
        });
        if first.normal.is_some_and(|normal| is_parallel(normal, known)) { second } else { first }
    }

    /// The shortest way out along the normal of a triangle that has all of some vertices, or its opposite, that the surface has there. The shorter
    /// ones are tried first, so that it is seldom asked what the surface has.
    fn shortest_of_all(
        &self,
        (vertices, corners): (&[u32], &[DVec3]),
        known: Option<DVec3>,
        other: &Other,
    ) -> Shortest {
        let mut ways = Vec::new();
        for triangle in self.around_all(vertices) {
            let Plane { normal, depths, .. } = self.plane(triangle, other);
            let is_other = known.is_none_or(|known| !is_parallel(normal, known));
            if is_other && depths[0] < f64::INFINITY {
                ways.extend([(depths[0], triangle, 1.0), (depths[1], triangle, -1.0)]);
            }
        }
        let leads_out = |&&(_, triangle, sign): &&Along| {
            self.leads_out(&self.plane(triangle, other), sign, triangle, (vertices, corners))
        };
        let by_depth = |x: &Along, y: &Along| x.0.total_cmp(&y.0);
        let shortest = |&(depth, triangle, sign): &Along| Shortest {
            depth,
            normal: Some(self.plane(triangle, other).normal * sign),
        };
        // It mostly is the first; to find that takes less than to sort all.
        let first = ways.iter().min_by(|x, y| by_depth(x, y)).filter(leads_out).map(shortest);
        first.unwrap_or_else(|| {
            ways.sort_by(by_depth); // stable
            let found = ways.iter().find(leads_out).map(shortest);
            found.unwrap_or(Shortest { depth: f64::INFINITY, normal: None })
        })
    }

    /// Takes the way out along the normal of a triangle, or its opposite, where it is shorter and the surface has that at what the
    /// triangle shares with some vertices, which are at `corners`. Not along one that is known.
    #[inline(always)]
    pub fn shorten(
        &self,
        shortest: &mut Shortest,
        triangle: u32,
        (vertices, corners): (&[u32], &[DVec3]),
        known: Option<DVec3>,
        other: &Other,
    ) {
        let plane = self.plane(triangle, other);
        if plane.depths[0] < shortest.depth || plane.depths[1] < shortest.depth {
            self.shorten_along(plane, shortest, triangle, (vertices, corners), known);
        }
    }

    fn shorten_along(
        &self,
        plane: Plane,
        shortest: &mut Shortest,
        triangle: u32,
        shared: (&[u32], &[DVec3]),
        known: Option<DVec3>,
    ) {
        if known.is_some_and(|known| is_parallel(plane.normal, known)) {
            return;
        }
        for (sign, depth) in [1.0, -1.0].into_iter().zip(plane.depths) {
            if depth < shortest.depth && self.leads_out(&plane, sign, triangle, shared) {
                *shortest = Shortest { depth, normal: Some(plane.normal * sign) };
            }
        }
    }

    /// Whether the surface has the normal of a triangle, or its opposite, at what the triangle shares with some vertices, which are at `corners`.
    fn leads_out(
        &self,
        plane: &Plane,
        sign: f64,
        triangle: u32,
        (vertices, corners): (&[u32], &[DVec3]),
    ) -> bool {
        let is_outward = self.orientation * sign >= 0.0;
        let is_above = |corner: &DVec3| sign * (plane.normal.dot(*corner) - plane.height) > LEVEL;
        is_outward && !corners.iter().any(is_above) && {
            let shared = vertices.iter().copied().filter(|&vertex| self.has(triangle, vertex));
            self.have(plane.normal * sign, 0.0, &shared.collect::<SmallVec<[u32; 4]>>())
        }
    }

    /// The plane of a triangle beside another shape.
    #[inline(always)]
    pub fn plane(&self, triangle: u32, other: &Other) -> Plane {
        let planes = self.planes.get_or_init(|| Planes::new(self.found));
        planes.beside(other, triangle, || self.normal_and_point(triangle))
    }

    /// The normal of a triangle that has one, and a point of its plane.
    fn normal_and_point(&self, triangle: u32) -> Option<(DVec3, DVec3)> {
        let &[p, q, r] = self.complex.primitive(triangle) else { return None };
        let placed = [p, q, r].map(|vertex| self.place(vertex));
        Some((face::triangle_normal(placed)?, placed[0]))
    }

    /// Whether a triangle that has a normal is at an edge between some of the vertices, or at the only one.
    pub fn have_triangles(&self, vertices: &[u32]) -> bool {
        let is_one = vertices.iter().all(|vertex| *vertex == vertices[0]);
        let edges = vertices.iter().flat_map(|&i| vertices.iter().map(move |&j| [i, j]));
        edges
            .filter(|[i, j]| is_one || i < j)
            .any(|edge| self.around_all(&edge).any(|primitive| self.normal_and_point(primitive).is_some()))
    }

    /// The vertices that stand for those of a primitive and all at their positions.
    pub fn welded(&self, primitive: u32) -> SmallVec<[u32; 4]> {
        few(self.complex.primitive(primitive), |vertex| self.complex.topology().welded(vertex))
    }

    /// Whether a primitive has a vertex that stands for all at its position.
    pub fn has(&self, primitive: u32, welded: u32) -> bool {
        self.complex.welded(primitive).any(|vertex| vertex == welded)
    }
}

/// What there is of each vertex of a primitive, of which most have three.
#[inline(always)]
pub(super) fn few<T: Copy>(vertices: &[u32], of: impl Fn(u32) -> T) -> SmallVec<[T; 4]> {
    match *vertices {
        [p, q, r] => {
            let [p, q, r] = each([p, q, r], of);
            SmallVec::from_buf_and_len([p, q, r, r], 3)
        }
        _ => vertices.iter().map(|&vertex| of(vertex)).collect(),
    }
}

/// Whether two unit normals are one, or each other's opposite.
pub(super) fn is_parallel(normal: DVec3, other: DVec3) -> bool {
    normal.dot(other).abs() > 1.0 - 0.5 * SAME_NORMAL * SAME_NORMAL
}
