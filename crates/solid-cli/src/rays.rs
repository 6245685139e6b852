//! Rays that are cast in every frame.

use anyhow::{Context, Result};
use solid3d::World;
use solid3d::glam::DVec3;
use solid3d::query::{Ray, RayOptions};

/// A ray or a segment under a name. It can be cast.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedRay {
    pub name: String,
    pub ray: Ray,
}

impl NamedRay {
    /// The ray, if it can be cast; `place` says where it stands.
    pub fn new(name: String, ray: Ray, place: &str) -> Result<NamedRay> {
        // That is for a world to say, also for an empty one.
        let cast = World::new().ray_meets(&ray, &RayOptions::default(), |_| true);
        cast.with_context(|| place.to_owned())?;
        Ok(NamedRay { name, ray })
    }
}

/// The rays of the command line: origins and directions in turn. They are numbered from 1.
pub fn of_arguments(vectors: &[DVec3]) -> Result<Vec<NamedRay>> {
    let numbered = (1..).zip(vectors.chunks_exact(2));
    let ray = |(number, vectors): (u32, &[DVec3])| {
        let ray = Ray::new(vectors[0], vectors[1]);
        NamedRay::new(number.to_string(), ray, &format!("--ray {number}"))
    };
    numbered.map(ray).collect()
}

/// A point or direction written as `X,Y,Z`.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|number| number.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three finite numbers X,Y,Z without blanks, as 0,1.5,-2".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_three_finite_numbers() {
        assert_eq!(vector("-1,2.5,3e2"), Ok(DVec3::new(-1.0, 2.5, 300.0)));
        for text in ["", "1,2", "1,2,3,4", "1 2 3", "x,0,0", "nan,0,0", "0,inf,0", "1,,3"] {
            assert!(vector(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_ray_that_cannot_be_cast_is_named() {
        let error =
            of_arguments(&[DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::ZERO]).expect_err("no direction");
        assert!(format!("{error:#}").starts_with("--ray 2: ray.direction is (0.0, 0.0, 0.0)"), "{error:#}");
        let rays = of_arguments(&[DVec3::ZERO, DVec3::X]).expect("it has a direction");
        assert_eq!((rays.len(), rays[0].name.as_str()), (1, "1"));
    }
}
