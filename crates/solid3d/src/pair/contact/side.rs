//! A primitive of a soup in contact, and the normals that the surface has at it.
//!
//! A triangle in a surface is not alone: a box that slides over a floor is pushed up by each triangle under it, and by none of them aside,
//! though aside may be the shortest way off that triangle. A normal is one of the surface when the part of the triangle that it touches
//! is the highest along it of all that is around: the face always, an edge or a corner when the surface is convex there
//! and the normal between those of the faces. Any other is replaced by the normal of the triangle, or by that of a face next to it that the
//! surface has at the edge or corner that they share, as a riser with the tread above it, where the way out along that is shorter.

use glam::DVec3;
use smallvec::SmallVec;

use super::ball::{is_beside, way, way_along};
use super::difference::{self, Polytope};
use super::inside::Inside;
use super::meeting::Meeting;
use super::other::Other;
use super::stars::{LEVEL, SAME_NORMAL, Shortest, Stars, is_parallel};
use super::{face, through};

/// A triangle whose normal has a greater cosine than this with that of another tells on which side of that it is.
const SIDE_COSINE: f64 = 0.2;

/// What is less steep than this stands under a face, some 25 degrees: what is steeper holds a body from the side, too.
const GENTLE_COSINE: f64 = 0.9;

/// A primitive of a soup, and what it is in contact with.
pub(super) struct Side<'a> {
    stars: &'a Stars<'a>,
    pub body: face::Placed<'a>,
    other: Other<'a>,
}

/// A normal out of a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) enum Corrected {
    /// One that the surface has.
    Kept(DVec3),
    /// That of a face next to it, in place of another.
    Adopted(DVec3),
    /// That of the triangle, in place of another.
    Replaced(DVec3),
}

impl Corrected {
    pub fn normal(&self) -> DVec3 {
        match *self {
            Corrected::Kept(normal) | Corrected::Adopted(normal) | Corrected::Replaced(normal) => normal,
        }
    }
}

impl<'a> Side<'a> {
    pub fn new(stars: &'a Stars<'a>, body: face::Placed<'a>, other: Other<'a>) -> Self {
        Side { stars, body, other }
    }

    /// The same as [`meeting_of_body`](Side::meeting_of_body), as far as corners in the body tell it; not of a ball.
    pub fn meeting_of_corners(&self, inside: &Inside, mirrored: bool) -> Option<Meeting> {
        let &[p, q, r] = self.body.corners else { return None };
        Some(inside.way(&[p, q, r])?.meeting(mirrored))
    }

    /// How a triangle and a body lie to each other, where that is known in closed form.
    pub fn meeting_of_body(
        &self,
        inside: Option<&Inside>,
        cuboid: Option<&Polytope>,
        mirrored: bool,
    ) -> Option<Meeting> {
        let &[p, q, r] = self.body.corners else { return None };
        let triangle = [p, q, r];
        let way = match *self.other.corners {
            [center] => way(&triangle, center, self.other.radius)?,
            _ => inside
                .and_then(|inside| inside.way(&triangle))
                .or_else(|| through::way(&triangle, self.body.plane?, &self.other))
                .or_else(|| difference::way(&Polytope::triangle(triangle), cuboid?))?,
        };
        Some(way.meeting(mirrored))
    }

    /// How a triangle and a ball that is over it lie to each other along a normal out of it that is its own, or nearly; `None` for others.
    pub fn meeting_of_ball(&self, out: DVec3, mirrored: bool) -> Option<Meeting> {
        let (&[p, q, r], normal) = (self.body.corners, self.body.plane?) else { return None };
        let tip = self.other.furthest(-out);
        let is_over = face::is_aligned(normal.dot(out).abs());
        let way = is_over.then(|| way_along(&[p, q, r], normal, tip, out))??;
        Some(way.meeting(mirrored))
    }

    /// Whether the other is a ball, or a point, that is not over the triangle along its normal, nor nearly.
    fn has_ball_beside(&self, normal: DVec3) -> bool {
        match (self.body.corners, self.other.corners) {
            (&[p, q, r], &[center]) => is_beside(&[p, q, r], normal, center),
            _ => false,
        }
    }

    /// The normal of a triangle with a flat surface around it, to the side on which the way out is shorter.
    pub fn flat(&self) -> Option<DVec3> {
        Some(self.shorter(self.is_flat().then_some(self.body.plane)??))
    }

    /// Whether the surface is flat all around a triangle.
    pub fn is_flat(&self) -> bool {
        self.stars.is_flat(self.body.primitive)
    }

    /// The normal of a triangle beside a primitive of another soup. Out of a solid; of a surface to the side on which the other is, if that is smaller, or
    /// against the other's triangle.
    pub fn own_beside(&self, beside: &Side) -> Option<DVec3> {
        let normal = self.body.plane?;
        let of_surface = || {
            if self.is_of_larger(beside).unwrap_or(true) {
                return self.toward(beside.stars, normal);
            }
            let facing = beside.outward().or_else(|| Some(beside.toward(self.stars, beside.body.plane?)));
            match facing.map(|facing| normal.dot(facing)) {
                Some(cosine) if cosine.abs() > SIDE_COSINE => normal * -cosine.signum(),
                _ => self.shorter(normal),
            }
        };
        Some(self.outward().unwrap_or_else(of_surface))
    }

    /// How deep the primitive of another soup is in a triangle, along that normal.
    pub fn own_depth(&self, beside: &Side) -> Option<f64> {
        Some(self.other.depth(self.body.corners, self.own_beside(beside)?))
    }

    /// The normal of a triangle, or its opposite: to the side on which more of another soup is.
    fn toward(&self, other: &Stars, normal: DVec3) -> DVec3 {
        let [low, high] = other.extremes(normal);
        if low + high < 2.0 * normal.dot(self.body.corners[0]) { -normal } else { normal }
    }

    /// Whether it is a triangle that is larger than another.
    pub fn is_wider(&self, other: &Side) -> bool {
        let square = |side: &Side| match *side.body.corners {
            [p, q, r] => Some((q - p).cross(r - p).length_squared()),
            _ => None,
        };
        square(self).zip(square(other)).is_some_and(|(mine, its)| mine > (1.0 + LEVEL) * its)
    }

    /// Whether its soup is larger than that of another; `None` if they are of one size.
    pub fn is_of_larger(&self, other: &Side) -> Option<bool> {
        let [mine, its] = [self.stars.size(), other.stars.size()];
        ((mine - its).abs() > LEVEL * mine).then_some(mine > its)
    }

    /// Whether all around a triangle is in its plane.
    pub fn is_level(&self) -> bool {
        self.stars.is_level_around(self.body.primitive)
    }

    /// The normal of a triangle of a solid, out of that.
    fn outward(&self) -> Option<DVec3> {
        let orientation = self.stars.orientation;
        self.body.plane.filter(|_| orientation != 0.0).map(|normal| normal * orientation)
    }

    /// A normal or its opposite: to the side on which the way out is shorter.
    fn shorter(&self, normal: DVec3) -> DVec3 {
        let [depth, opposite] = self.other.depths(self.body.corners, normal);
        if depth <= opposite { normal } else { -normal }
    }

    /// Whether a normal is that of the triangle, or its opposite.
    pub fn is_own(&self, out: DVec3) -> bool {
        self.body.plane.is_some_and(|normal| is_parallel(normal, out))
    }

    /// Whether it is a triangle that rises little along a face with a normal.
    pub fn is_gentle(&self, out: DVec3) -> bool {
        self.body.plane.is_some_and(|normal| normal.dot(out).abs() >= GENTLE_COSINE)
    }

    /// Whether a normal points into a solid.
    pub fn is_inward(&self, out: DVec3) -> bool {
        self.outward().is_some_and(|outward| outward.dot(out) < -SAME_NORMAL)
    }

    /// The normal, which may be off by a tilt, if the surface has it where it is touched; else that of the triangle, or of a face next to it.
    /// `None` where there is no contact along any of these: a ball that is not over the triangle, or what is no triangle and left to those around it.
    pub fn corrected(&self, out: DVec3, tilt: f64) -> Option<Corrected> {
        if let Some(kept) = self.kept(out, tilt) {
            return Some(Corrected::Kept(kept));
        }
        let own = self.own()?;
        Some(self.shorter_around(own).map_or(Corrected::Replaced(own), Corrected::Adopted))
    }

    /// The normal, which may be off by a tilt, if the surface has it where it is touched.
    pub fn kept(&self, out: DVec3, tilt: f64) -> Option<DVec3> {
        let Some(normal) = self.body.plane else { return self.kept_without_plane(out, tilt) };
        let cosine = normal.dot(out);
        if is_parallel(normal, out) {
            return Some(normal * cosine.signum());
        }
        self.stars.have(out, tilt, &self.stars.welded(self.body.primitive)).then_some(out)
    }

    /// The same of what has no plane. A triangle of which two corners are one is but an edge of others: normals that the surface does not have
    /// there are theirs to correct.
    #[cold]
    fn kept_without_plane(&self, out: DVec3, tilt: f64) -> Option<DVec3> {
        let vertices = self.stars.welded(self.body.primitive);
        let is_body = vertices.len() > 3 || !self.stars.have_triangles(&vertices);
        (is_body || self.stars.have(out, tilt, &vertices)).then_some(out)
    }

    /// The normal of the triangle, in place of one that the surface does not have. `None` of what is no triangle, and where a ball is not over it.
    pub fn own(&self) -> Option<DVec3> {
        let normal = self.body.plane?;
        (!self.has_ball_beside(normal)).then(|| self.outward().unwrap_or_else(|| self.shorter(normal)))
    }

    /// The normal of a face next to the triangle that the surface has where they meet, when the way out along it is shorter
    /// than along the triangle's own: that of the shortest.
    pub fn shorter_around(&self, own: DVec3) -> Option<DVec3> {
        let Side { stars, other, .. } = *self;
        let corners = self.body.corners;
        let vertices = stars.welded(self.body.primitive);
        let mut shortest = Shortest { depth: other.depth(corners, own) - LEVEL, normal: None };
        let hubs: SmallVec<[u32; 3]> =
            vertices.iter().copied().filter(|&vertex| stars.is_hub(vertex)).collect();
        for &vertex in vertices.iter().filter(|vertex| !hubs.contains(vertex)) {
            // One at an edge is looked at twice, which takes less than to know that.
            for &triangle in stars.around(vertex).iter().filter(|&&around| around != self.body.primitive) {
                stars.shorten(&mut shortest, triangle, (&vertices, corners), Some(own), &other);
            }
        }
        // At hubs, and between two.
        for (i, &hub) in hubs.iter().enumerate() {
            for &end in &hubs[i..] {
                let found = stars.shortest_at([hub, end], own, &other);
                if found.depth < shortest.depth {
                    shortest = found;
                }
            }
        }
        shortest.normal
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_convex::{Cuboid, Sphere};
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::map::Map;
    use super::*;
    use crate::shape::{Body, Class, Shape};

    /// Triangles around one vertex, some beside the last of these, and some on a spoke that they share; bent at random, or but for a few spokes flat.
    fn fan(rng: &mut StdRng, is_flat: bool) -> Shape {
        let count = rng.random_range(3..40);
        let mut points = vec![DVec3::ZERO];
        for i in 0..count {
            let (sin, cos) = (f64::from(i) / f64::from(count) * std::f64::consts::TAU).sin_cos();
            let height = if is_flat && i % 8 != 0 { 0.0 } else { rng.random_range(-0.3..0.3) };
            points.push(DVec3::new(cos, sin, height));
        }
        points.push(DVec3::new(1.5, 0.0, rng.random_range(-0.5..0.5)));
        let mut triangles: Vec<_> = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        triangles.extend([[1, count, count + 1], [0, 1, count + 1]]);
        points.extend([(); 3].map(|()| in_cube(rng)));
        triangles.extend((2..5).map(|i| [0, 1, count + i]));
        Shape::mesh(points, triangles).unwrap()
    }

    /// Law: what is kept of a vertex of many triangles is what each triangle finds there by itself.
    #[test]
    fn hubs_change_nothing() {
        let mut rng = seeded(151);
        let [mut adopted, mut others, mut beside, mut laid_out] = [0; 4];
        for case in 0..600 {
            let shape = fan(&mut rng, case % 2 == 0);
            let Class::Complex(complex) = shape.class() else { unreachable!("a mesh is complex") };
            let here = Map::new(DAffine3::IDENTITY);
            let there = Map::new(DAffine3::from_translation(in_cube(&mut rng) * 0.5));
            let (ball, cuboid) = (Sphere::new(0.2).unwrap(), Cuboid::new(DVec3::splat(0.2)).unwrap());
            let center = [there.point(DVec3::ZERO)];
            let other = match case % 3 {
                0 => Other { primitive: 0, support: &ball, map: &there, corners: &center, radius: 0.2 },
                _ => Other { primitive: 0, support: &cuboid, map: &there, corners: &[], radius: 0.0 },
            };
            let [mut with_hubs, mut without] = [(); 2].map(|()| Stars::new(complex, &here, 8));
            (with_hubs.hub_min, without.hub_min) = (2, usize::MAX);
            for triangle in 0..complex.primitive_count() as u32 {
                let body = Body::of_primitive(complex, triangle);
                let corners = without.corners(triangle);
                let out = in_cube(&mut rng).normalize();
                let [found, expected] = [&with_hubs, &without].map(|stars| {
                    let placed = face::Placed::of_primitive(&body, triangle, &here, &corners);
                    Side::new(stars, placed, other).corrected(out, 0.0)
                });
                let (Some(found), Some(expected)) = (found, expected) else {
                    assert!(found.is_none() && expected.is_none(), "case {case}, triangle {triangle}");
                    beside += 1;
                    continue;
                };
                let depth = |corrected: Corrected| other.depth(&corners, corrected.normal());
                assert!(
                    (depth(found) - depth(expected)).abs() < LEVEL
                        && std::mem::discriminant(&found) == std::mem::discriminant(&expected),
                    "case {case}, triangle {triangle}: {found:?}, {expected:?}"
                );
                *(if matches!(found, Corrected::Adopted(_)) { &mut adopted } else { &mut others }) += 1;
            }
            laid_out += usize::from(with_hubs.has_laid_out());
        }
        assert!(adopted > 2_000 && others > 2_000 && beside > 2_000, "{adopted}, {others}, {beside}");
        assert!(laid_out > 100, "{laid_out}");
    }
}
