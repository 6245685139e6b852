//! A ray against a complex shape: along its tree, nearest leaf first.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::simd::level;
use solid_convex::unit_scale;

use super::super::table::PlacedComplex;
use super::super::{Placed, Scratch};
use super::convex::{hull_hits, into_box, into_world_box};
use super::glance::Glance;
use super::triangle::{Corners, LANES, Shear, TriangleHit, put};
use super::{FromInside, Hits, SurfaceHit, facing, world_normal};
use crate::bounds::Aabb;
use crate::placement::{direction, inverse_linear};
use crate::shape::Complex;
use crate::tree::{Leaf, LeafImages, RayLeaves, TreeRay, bits};
use crate::triangle_triangle::Triangle;

/// A ray in the space of a complex shape, moved up to it.
struct LocalRay {
    /// The point at the parameter `start`, before the ray comes into the shape's box.
    origin: DVec3,
    direction: DVec3,
    start: f64,
    /// No hit of a cast is before; of what is no mesh, for which casts are asked.
    earliest: Option<f64>,
    shear: Shear,
    to_local: DMat3,
}

pub(super) fn hits(placed: Placed, complex: &Complex, hits: &mut Hits, scratch: &mut Scratch) {
    let at = placed.placement;
    let Some(ray) = LocalRay::new(placed, complex, hits) else { return };
    let asks_for_start =
        ray.start == 0.0 && complex.is_solid() && hits.options.from_inside == FromInside::Hits;
    let found = Found { hits, crossed: asks_for_start.then(Crossed::default) };
    let tree_ray = TreeRay { origin: ray.origin, direction: ray.direction, half_extents: DVec3::ZERO };
    let Scratch { traversal, primitive_tests, .. } = scratch;
    let mut left = found.left(&ray);
    let images = complex.images().map(|images| (Glance::new(&ray.shear, complex.tree().normal()), images));
    let mut meeting = Meeting { complex, at, ray: &ray, images, found, primitive_tests };
    complex.tree().along_on(level(), &tree_ray, &mut left, traversal, &mut meeting);
    if meeting.found.crossed.is_some_and(|crossed| crossed.starts_inside()) {
        hits.add_inside();
    }
    if complex.has_polygons() {
        hits.put_together(|primitive| complex.is_cut(primitive));
    }
}

/// Looks for primitives that the ray meets.
struct Meeting<'s, 'r> {
    complex: &'s Complex,
    at: &'s DAffine3,
    ray: &'s LocalRay,
    /// Images of triangles, and what looks at them.
    images: Option<(Glance, &'s LeafImages)>,
    found: Found<'s, 'r>,
    primitive_tests: &'s mut u64,
}

/// What a ray has found on its way.
struct Found<'s, 'r> {
    hits: &'s mut Hits<'r>,
    /// Where a hit is wanted if it starts inside of a solid mesh.
    crossed: Option<Crossed>,
}

/// Where a ray starts, as to a solid mesh: told by the triangles that it crosses from there to beyond all.
///
/// By the same hits as are reported, rounded as they are. For of a closed mesh the windings around the whole line of the ray sum to 0: so a ray that
/// starts outside and has no hit up to some point of it is outside there. The exact test of the origin in the common frame, which rounds it
/// otherwise, took for outside what had the triangle behind it: one in ten of the rays that go into a solid from its surface missed it.
#[derive(Default)]
struct Crossed {
    /// Where it starts, whichever way it goes: that is inside.
    on_surface: bool,
    winding: i64,
}

impl RayLeaves for Meeting<'_, '_> {
    #[inline(always)]
    fn prefetch(&self, start: usize) {
        if let Some((_, images)) = &self.images {
            images.prefetch(start);
        }
    }

    #[inline(always)]
    fn visit<S: Simd>(&mut self, simd: S, leaf: &Leaf, left: &mut f64) {
        let Meeting { complex, at, ray, images, found, primitive_tests } = self;
        **primitive_tests += leaf.primitives.len() as u64;
        match (images, complex.triangles()) {
            (Some((glance, images)), _) => {
                let image = images.of(leaf);
                for lane in bits(glance.candidates(simd, &image) & leaf.lanes()) {
                    let triangle = image.indices(lane).map(|i| complex.vertices()[i as usize]);
                    ray.meet(&triangle, leaf.primitives[lane], found);
                }
            }
            (None, Some(triangles)) => ray.meet_leaf(complex.vertices(), triangles, leaf.primitives, found),
            (None, None) => {
                for &primitive in leaf.primitives {
                    ray.meet_primitive((complex, at), primitive, found);
                }
            }
        }
        *left = found.left(ray);
    }
}

impl Found<'_, '_> {
    /// How far a ray has to look on; negative when nothing is of interest.
    ///
    /// What is further has a sum with `start` above `until`. The sum is at most that, rounded, if it is less than half the distance of two numbers beyond it,
    /// `EPSILON / 2` of it; and the difference and the sum here lose no more than that each. From far away that is much of a shape.
    #[inline]
    fn left(&self, ray: &LocalRay) -> f64 {
        /// Part of `until`: above what the three come to.
        const ROUNDING: f64 = 2.0 * f64::EPSILON;
        let until = self.hits.until;
        match self.crossed {
            _ if until < 0.0 => -1.0,
            Some(_) => f64::INFINITY,
            // A cast may be early, and be wanted where its box is beyond.
            None if ray.earliest.is_some() && self.hits.found.is_none() => f64::INFINITY,
            None => (until - ray.start).max(0.0) + ROUNDING * until,
        }
    }
}

impl Crossed {
    /// Adds a triangle that is hit.
    fn add(&mut self, t: f64, winding: i64) {
        self.on_surface |= t == 0.0;
        self.winding += winding;
    }

    fn starts_inside(&self) -> bool {
        self.on_surface || self.winding != 0
    }
}

/// A primitive of up to three vertices as a triangle.
fn triangle(complex: &Complex, primitive: u32) -> Option<Triangle> {
    let at = |i: u32| complex.vertices()[i as usize];
    match *complex.primitive(primitive) {
        [i, j, k] => Some([at(i), at(j), at(k)]),
        [i, j] => Some([at(i), at(j), at(j)]),
        [i] => Some([at(i); 3]),
        _ => None,
    }
}

impl LocalRay {
    /// `None` for a ray that passes the shape's box.
    fn new(placed: Placed, complex: &Complex, hits: &Hits) -> Option<LocalRay> {
        let at = placed.placement;
        let to_local = inverse_linear(&at.matrix3);
        let (origin, direction) =
            (to_local * (hits.ray.origin - at.translation), to_local * hits.ray.direction);
        let bounds = complex.bounds();
        let start = entry(&roomy(&bounds, origin), origin, direction)?;
        let earliest = (!complex.is_mesh()).then(|| into_world_box(placed, hits.ray));
        if start > hits.until && earliest.is_none() {
            return None;
        }
        let origin = origin + direction * start;
        let reach = bounds.half_extents() + (origin - bounds.center()).abs();
        let shear = Shear::new(origin, direction, reach);
        Some(LocalRay { origin, direction, start, earliest, shear, to_local })
    }

    /// Adds where the ray meets the triangles of a leaf: eight at once sort out most of those that it does not.
    #[inline(never)] // into the walk, which has no need of it but for what was deformed
    fn meet_leaf(&self, vertices: &[DVec3], triangles: &[[u32; 3]], leaf: &[u32], found: &mut Found) {
        let corner = |i: u32| &vertices[i as usize];
        for some in leaf.chunks(LANES) {
            let mut corners = Corners::default();
            for (lane, &primitive) in some.iter().enumerate() {
                put(&mut corners, lane, triangles[primitive as usize].map(corner));
            }
            for lane in bits(self.shear.candidates(&corners) & ((1 << some.len()) - 1)) {
                let triangle = triangles[some[lane] as usize].map(|i| *corner(i));
                self.meet(&triangle, some[lane], found);
            }
        }
    }

    /// Adds where the ray meets a primitive of any kind.
    fn meet_primitive(&self, (complex, at): PlacedComplex, primitive: u32, found: &mut Found) {
        let owner = complex.owner(primitive);
        match triangle(complex, primitive) {
            Some(triangle) => self.meet(&triangle, owner, found),
            None => {
                let earliest = || {
                    let bounds = Aabb::of_points(complex.points_of(primitive));
                    let in_local = self.start + into_box(&bounds, self.origin, self.direction);
                    in_local.max(self.earliest.unwrap_or(0.0))
                };
                hull_hits(&complex.primitive_hull(primitive), at, owner, earliest, found.hits);
            }
        }
    }

    /// Adds where the ray meets a triangle.
    #[inline]
    fn meet(&self, triangle: &Triangle, primitive: u32, found: &mut Found) {
        let Some(TriangleHit { t, barycentric, back }) = self.shear.hit(triangle) else { return };
        let Found { hits, crossed } = found;
        if let Some(crossed) = crossed {
            crossed.add(t, self.shear.winding(triangle));
        }
        let t = self.start + t;
        if back.is_some_and(|back| !hits.options.faces.includes(back)) || !hits.wants(t, primitive) {
            return;
        }
        let scale = unit_scale(
            (triangle[1] - triangle[0]).abs().max((triangle[2] - triangle[0]).abs()).max_element(),
        );
        let edge = |i: usize| (triangle[i] - triangle[0]) * scale;
        let back = back.unwrap_or(false);
        let normal = match world_normal(&self.to_local, edge(1).cross(edge(2))) {
            Some(front) => {
                // The side is told by signs, and the normal of a needle is a rounded one.
                let normal = facing(front, back);
                if normal.dot(hits.ray.direction) > 0.0 { -normal } else { normal }
            }
            // A segment or a point has none: it turns to the ray.
            None => -direction(hits.ray.direction).expect("a ray has a direction"),
        };
        hits.add(t, Some(SurfaceHit { normal, back, primitive, barycentric: Some(barycentric) }));
    }
}

/// The box, with so much room around that a ray is moved to well before what is in it.
fn roomy(bounds: &Aabb, origin: DVec3) -> Aabb {
    /// Part of the size of the box.
    const ROOM: f64 = 1.0 / 64.0;
    /// Beyond what rounding makes of a far origin.
    const FAR_ROOM: f64 = 1e-12;
    let far = origin.abs().max_element() + bounds.center().abs().max_element();
    bounds.inflated(ROOM * bounds.half_extents().max_element() + FAR_ROOM * far)
}

/// When a ray comes into a box, 0 when it starts there; `None` when it passes it.
#[inline]
fn entry(bounds: &Aabb, origin: DVec3, direction: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (p, d, min, max) = (origin[axis], direction[axis], bounds.min[axis], bounds.max[axis]);
        // By order and not by the sign of the direction: half of all branches on where a ray goes are foretold wrongly.
        let (a, b) = ((min - p) / d, (max - p) / d);
        let (near, far) = (if b < a { b } else { a }, if b < a { a } else { b });
        let within = p >= min && p <= max;
        let of_flat = if within { f64::NEG_INFINITY } else { f64::INFINITY };
        let (near, far) = if d == 0.0 { (of_flat, -of_flat) } else { (near, far) };
        enter = if near > enter { near } else { enter };
        leave = if far < leave { far } else { leave };
    }
    (enter <= leave).then_some(enter)
}
