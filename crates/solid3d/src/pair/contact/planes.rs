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
    /// How far the other reaches back behind it, along the normal and along its opposite.
    pub depths: [f64; 2],
}

/// What was found of a triangle; of one without a normal that it has no plane.
#[derive(Clone, Copy, Default)]
struct Found {
    /// The numbers of the triangle and of the primitive of the other, from 1 on; 0 for none.
    of: [u32; 2],
    plane: Option<Plane>,
}

/// A place for each of some consecutive triangles; what another takes the place of is found again.
pub(super) struct Planes {
    places: Box<[Cell<Found>]>,
}

impl Planes {
    /// For so many triangles, and those around them.
    pub fn new(count: usize) -> Planes {
        let places = (4 * count).clamp(16, 1 << 16).next_power_of_two();
        Planes { places: vec![Cell::default(); places].into() }
    }

    /// The plane of a triangle beside another shape; `find` tells its normal, if it has one, and a point of it.
    #[inline]
    pub fn beside(
        &self,
        other: &Other,
        triangle: u32,
        find: impl FnOnce() -> Option<(DVec3, DVec3)>,
    ) -> Option<Plane> {
        let place = &self.places[triangle as usize & (self.places.len() - 1)];
        let Found { of: of_found, plane } = place.get();
        let of = [triangle + 1, other.primitive + 1];
        if of_found == of {
            return plane;
        }
        let normal_and_height = match plane {
            _ if of_found[0] != of[0] => find().map(|(normal, point)| (normal, normal.dot(point))),
            plane => plane.map(|plane| (plane.normal, plane.height)),
        };
        let plane = normal_and_height.map(|(normal, height)| {
            let [behind, beyond] = other.extremes(normal);
            Plane { normal, height, depths: [height - behind, beyond - height] }
        });
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
            assert_eq!(found.is_some(), faces[triangle].is_some());
            let (Some(Plane { normal, height, depths }), Some((expected, point))) = (found, faces[triangle])
            else {
                continue;
            };
            let [behind, beyond] = other.extremes(expected);
            assert_eq!((normal, height), (expected, expected.dot(point)));
            assert_eq!(depths, [height - behind, beyond - height]);
        }
        assert!((cases / 4..cases * 3 / 4).contains(&looks), "{looks} of {cases}");
    }
}
