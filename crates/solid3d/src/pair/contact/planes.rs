//! The planes of triangles beside another shape, which all triangles around them ask for.

use std::cell::Cell;

use glam::DVec3;

use super::other::Other;

/// The plane of a triangle, and how the other shape lies to it. Space: common.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    pub normal: DVec3,
    /// The height of the plane along its normal.
    pub height: f64,
    /// How far the other reaches back behind it, along the normal and along its opposite; infinite for a triangle without a normal.
    pub depths: [f64; 2],
}

impl Plane {
    const NONE: Plane = Plane { normal: DVec3::ZERO, height: 0.0, depths: [f64::INFINITY; 2] };

    fn at(normal: DVec3, height: f64, other: &Other) -> Plane {
        let [behind, beyond] = other.extremes(normal);
        Plane { normal, height, depths: [height - behind, beyond - height] }
    }

    /// The same beside another primitive.
    fn beside(self, other: &Other) -> Plane {
        if self.normal == DVec3::ZERO { self } else { Plane::at(self.normal, self.height, other) }
    }
}

/// What was found of a triangle: its number and that of the primitive of the other, from 1 on; 0 for none.
#[derive(Clone, Copy)]
struct Found {
    of: [u32; 2],
    plane: Plane,
}

/// A place for each of some consecutive triangles; what another takes the place of is found again.
pub(super) struct Planes {
    places: Box<[Cell<Found>]>,
}

impl Planes {
    /// For so many triangles, and those around them.
    pub fn new(count: usize) -> Planes {
        let places = (4 * count).clamp(16, 1 << 16).next_power_of_two();
        Planes { places: vec![Cell::new(Found { of: [0; 2], plane: Plane::NONE }); places].into() }
    }

    /// The plane of a triangle beside another shape; `find` tells its normal, if it has one, and a point of it.
    #[inline(always)]
    pub fn beside(
        &self,
        other: &Other,
        triangle: u32,
        find: impl FnOnce() -> Option<(DVec3, DVec3)>,
    ) -> Plane {
        let place = &self.places[triangle as usize & (self.places.len() - 1)];
        let of = [triangle + 1, other.primitive + 1];
        let Found { of: of_found, plane } = place.get();
        if of_found == of {
            return plane;
        }
        let plane = if of_found[0] == of[0] {
            plane.beside(other)
        } else {
            find().map_or(Plane::NONE, |(normal, point)| Plane::at(normal, normal.dot(point), other))
        };
        place.set(Found { of, plane });
        plane
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use rand::Rng;
    use solid_convex::Sphere;
    use solid_oracle::generate::{direction, seeded};

    use super::super::map::Map;
    use super::*;

    /// Law: what was found of a triangle is what would be found now, though more than have places are asked for, beside more than one
    /// primitive of the other.
    #[test]
    fn what_is_kept_is_what_would_be_found() {
        let mut rng = seeded(168);
        let (balls, here) =
            ([1.0, 0.5].map(|radius| Sphere::new(radius).unwrap()), Map::new(DAffine3::IDENTITY));
        let faces: Vec<_> =
            (0..40).map(|i| (i % 7 != 0).then(|| (direction(&mut rng), direction(&mut rng)))).collect();
        let planes = Planes::new(1);
        assert!(planes.places.len() < faces.len());
        let (mut looks, cases) = (0, 4000);
        for case in 0..cases {
            let (triangle, primitive) =
                (rng.random_range(0..2) * 16 + case / 100 % 8, rng.random_range(0..2));
            let support = &balls[primitive];
            let other = Other { primitive: primitive as u32, support, map: &here, corners: &[], radius: 0.0 };
            let find = || {
                looks += 1;
                faces[triangle]
            };
            let found = planes.beside(&other, triangle as u32, find);
            let Some((normal, point)) = faces[triangle] else {
                assert_eq!(found.depths, [f64::INFINITY; 2]);
                continue;
            };
            let ([behind, beyond], height) = (other.extremes(normal), normal.dot(point));
            assert_eq!((found.normal, found.height), (normal, height));
            assert_eq!(found.depths, [height - behind, beyond - height]);
        }
        assert!((cases / 4..cases * 3 / 4).contains(&looks), "{looks} of {cases}");
    }
}
