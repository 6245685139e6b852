//! A triangle of which a corner is deep in a body, in closed form.
//!
//! The depth of a triangle in a body is no less than that of any of its corners, each of which has a way out to the nearest place of the
//! surface. Where no other corner is behind the deepest one on that way, it takes the whole triangle out, and is
//! the shortest. Of a fine mesh deep in a body nearly all triangles are like that.

use glam::DVec3;
use solid_convex::Support;

use super::super::closed_form::{Ellipsoid, Similarity, foot};
use super::super::triangle_triangle::Triangle;
use super::ball::Way;
use super::face::Placed;
use super::map::Map;
use crate::shape::{Body, Facet, Hulled};

/// What is less deep than this, in the unit of the pair, is not looked at.
pub(super) const DEPTH_MIN: f64 = 1e-9;

/// How far behind the deepest corner another may be on the way out: some rounding errors.
const LEVEL_ERROR: f64 = 1e-14;

/// Facets of a hull that are looked at for a corner, and made ready for each triangle: of more, the search for a depth takes no longer.
const FACETS_MAX: usize = 256;
const FACETS_EACH: usize = 16;

/// A body of which it is known where its surface is nearest to a point in it. Space: common.
pub(super) enum Inside<'a> {
    /// One that its map leaves what it is, and its origin.
    Similar(&'a Body<'a>, Similarity, DVec3),
    /// What a ball is that its map stretches, and its origin.
    Ellipsoid(Ellipsoid, DVec3),
    /// The outward normals of a hull's facets, and how far the hull reaches along each.
    Facets(Vec<(DVec3, f64)>),
}

impl<'a> Inside<'a> {
    /// To be asked of so many triangles. `None` where it is not known, or not worth it.
    pub fn new(body: &Placed<'a>, count: usize) -> Option<Inside<'a>> {
        match *body.body() {
            Body::Hull { hull, .. } => facets(hull, body.map, count).map(Inside::Facets),
            Body::Simplex(_) => None,
            _ => {
                let (linear, origin) = (body.map.linear(), body.map.affine.translation);
                if let Some(at) = Similarity::new(linear) {
                    return Some(Inside::Similar(body.body(), at, origin));
                }
                let Body::Sphere(ball) = *body.body() else { return None };
                Some(Inside::Ellipsoid(Ellipsoid::new(&(*linear * ball.radius()))?, origin))
            }
        }
    }

    /// The shortest way of the body out of a triangle. `None` where it is not known.
    pub fn way(&self, triangle: &Triangle) -> Option<Way> {
        let feet = triangle.iter().filter_map(|&corner| Some((self.foot(corner)?, corner)));
        let ((distance, normal), corner) = feet.min_by(|(x, _), (y, _)| x.0.total_cmp(&y.0))?;
        let is_behind = |other: &DVec3| normal.dot(*other - corner) < -LEVEL_ERROR;
        (distance < -DEPTH_MIN && !triangle.iter().any(is_behind)).then_some(Way {
            out: -normal,
            depth: -distance,
            foot: corner,
        })
    }

    /// How far a point is from the surface, negative inside, and the outward normal there; outside of a hull no more than that it is.
    fn foot(&self, point: DVec3) -> Option<(f64, DVec3)> {
        match self {
            Inside::Similar(body, at, origin) => foot(body, at, point - *origin),
            Inside::Ellipsoid(ellipsoid, origin) => {
                let foot = ellipsoid.foot(point - *origin)?;
                Some((foot.distance, foot.normal))
            }
            Inside::Facets(facets) => {
                let distances = facets.iter().map(|&(normal, height)| (normal.dot(point) - height, normal));
                distances.reduce(|nearest, plane| if plane.0 > nearest.0 { plane } else { nearest })
            }
        }
    }
}

/// The facets of a hull where they are few, and flat up to rounding: no way out is shorter than that through the lowest corner of one.
fn facets(hull: &Hulled, map: &Map, count: usize) -> Option<Vec<(DVec3, f64)>> {
    let facets = hull.facets();
    if facets.len() < 4 || facets.len() as usize > FACETS_MAX.min(FACETS_EACH * count) {
        return None;
    }
    let plane = |facet: Facet| {
        let normal = map.normal(facet.normal);
        let height = |local: DVec3| normal.dot(map.point(local));
        let highest = height(hull.polytope().support(map.linear().transpose() * normal));
        let lowest = height(hull.points()[facet.lowest as usize]);
        (highest - lowest <= LEVEL_ERROR).then_some((normal, highest))
    };
    (0..facets.len()).map(|face| plane(facets.get(face))).collect()
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DQuat};
    use rand::Rng;
    use solid_convex::{Points, epa};
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::ways::{assert_is_shortest, bodies, support};
    use super::*;
    use crate::shape::{Shape, ShapeKind};

    /// Law: where there is an answer it is within the bounds of EPA, the points are each in their object, and there is one of nearly all small triangles. The last body is an ellipsoid.
    #[test]
    fn the_way_out_is_the_shortest() {
        let mut rng = seeded(169);
        let ball = Shape::sphere(0.7).unwrap();
        for (kind, shape) in bodies(&mut rng).iter().chain([&ball]).enumerate() {
            let (mut answers, mut of_small, mut small, cases) = (0, 0, 0, 2000);
            for case in 0..cases {
                let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
                let stretch =
                    if shape.kind() == ShapeKind::Sphere { DVec3::new(1.0, 0.3, 1.7) } else { DVec3::ONE };
                let linear = turn * DMat3::from_diagonal(stretch) * rng.random_range(0.3..1.0);
                let at = DAffine3 { matrix3: linear, translation: in_cube(&mut rng) };
                let map = Map::new(at);
                let body = shape.body().unwrap();
                let placed = Placed::new(&body, &map);
                let middle = map.point(in_cube(&mut rng) * 0.4);
                let extent = [1.0, 0.3, 0.03, 0.003][case % 4];
                let triangle = [(); 3].map(|()| middle + in_cube(&mut rng) * extent);
                let (support, one) = (support(shape), Points::new(&triangle).unwrap());
                if epa::penetration(support, &at, &one, &DAffine3::IDENTITY).is_none() {
                    continue;
                }
                let way =
                    Inside::new(&placed, 100).expect("its placement leaves it what it is").way(&triangle);
                small += usize::from(case % 4 == 3);
                let Some(way) = way else { continue };
                answers += 1;
                of_small += usize::from(case % 4 == 3);
                assert!(triangle.contains(&way.foot), "{kind}, case {case}");
                assert_is_shortest(&way, &triangle, support, &at, &format!("{kind}, case {case}"));
            }
            println!("{kind}: {answers} answers, {of_small} of {small} small ones");
            assert!(
                answers > cases / 4 && of_small > small * 9 / 10,
                "{kind}: {answers}, {of_small} of {small}"
            );
        }
    }

    /// Facets that were put together are those of the hull only where they are flat up to rounding; many are looked at only for many triangles.
    #[test]
    fn facets_are_asked_where_they_say_it_all() {
        let map = Map::new(DAffine3::from_rotation_x(0.7));
        let is_known = |bent: f64, count: usize| {
            let corner = |i: u32| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1)));
            let points: Vec<DVec3> = (0..8).map(corner).map(|p| p + p * bent * p.element_product()).collect();
            let hull = Shape::convex_hull(&points).unwrap();
            let body = hull.body().unwrap();
            let placed = Placed::new(&body, &map);
            Inside::new(&placed, count).is_some()
        };
        assert!(is_known(0.0, 1) && is_known(1e-15, 1) && is_known(1e-3, 1));
        assert!(!is_known(1e-11, 1) && !is_known(1e-10, 1) && !is_known(0.0, 0));
    }
}
