//! Rays that are cast in every frame.

use std::collections::HashSet;

use anyhow::{Context, Result, bail};
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
fn of_arguments(vectors: &[DVec3]) -> Result<Vec<NamedRay>> {
    let numbered = (1..).zip(vectors.chunks_exact(2));
    let ray = |(number, vectors): (u32, &[DVec3])| {
        let ray = Ray::new(vectors[0], vectors[1]);
        NamedRay::new(number.to_string(), ray, &format!("--ray {number}"))
    };
    numbered.map(ray).collect()
}

/// The rays of the command line, and those of the rules: an error where two have one name, since nobody could tell what each meets.
pub fn all(vectors: &[DVec3], of_rules: &[NamedRay]) -> Result<Vec<NamedRay>> {
    let rays = [of_arguments(vectors)?.as_slice(), of_rules].concat();
    let mut names = HashSet::new();
    if let Some(NamedRay { name, .. }) = rays.iter().find(|ray| !names.insert(&ray.name)) {
        bail!("two rays have the name {name:?}: [[ray]] needs another (those of --ray are numbered from 1)");
    }
    Ok(rays)
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

    #[test]
    fn a_name_stands_for_one_ray() {
        let named = |name: &str| {
            NamedRay::new(name.to_owned(), Ray::new(DVec3::ZERO, DVec3::X), "").expect("it has a direction")
        };
        let numbered = [DVec3::ZERO, DVec3::X];
        assert_eq!(all(&numbered, &[named("a"), named("b")]).map(|rays| rays.len()).ok(), Some(3));
        for (of_rules, name) in [([named("a"), named("a")], "a"), ([named("a"), named("1")], "1")] {
            let error = all(&numbered, &of_rules).expect_err("two have one name").to_string();
            assert!(error.starts_with(&format!("two rays have the name \"{name}\":")), "{error}");
        }
    }
}
