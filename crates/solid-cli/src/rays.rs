//! Rays that are cast in every frame.

use std::collections::HashMap;

use anyhow::{Context, Result, bail};
use solid3d::World;
use solid3d::glam::DVec3;
use solid3d::query::{Ray, RayOptions};

use crate::words::quoted;

/// A ray or a segment under a name. It can be cast.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedRay {
    pub name: String,
    pub ray: Ray,
    /// `rules.toml:7`, or the option.
    place: String,
}

impl NamedRay {
    /// The ray, if it can be cast; `place` says where it stands.
    pub fn new(name: String, ray: Ray, place: String) -> Result<NamedRay> {
        // That is for a world to say, also for an empty one.
        let cast = World::new().ray_meets(&ray, &RayOptions::default(), |_| true);
        cast.with_context(|| place.clone())?;
        Ok(NamedRay { name, ray, place })
    }
}

/// The rays of the command line: origins and directions in turn. They are numbered from 1.
fn of_arguments(vectors: &[DVec3]) -> Result<Vec<NamedRay>> {
    let numbered = (1..).zip(vectors.chunks_exact(2));
    let ray = |(number, vectors): (u32, &[DVec3])| {
        let ray = Ray::new(vectors[0], vectors[1]);
        NamedRay::new(number.to_string(), ray, format!("--ray {number}"))
    };
    numbered.map(ray).collect()
}

/// The rays of the command line, and those of the rules: an error where two have one name, since nobody could tell what each meets.
pub fn all(vectors: &[DVec3], of_rules: &[NamedRay]) -> Result<Vec<NamedRay>> {
    let rays = [of_arguments(vectors)?.as_slice(), of_rules].concat();
    let mut places = HashMap::new();
    for NamedRay { name, place, .. } in &rays {
        if let Some(other) = places.insert(name, place) {
            let name = quoted(name);
            bail!(
                "{place}: the ray at {other} has the name {name}, too; expected a name of its own (rays of --ray are named by numbers from 1)"
            );
        }
    }
    Ok(rays)
}

/// A point or direction written as `X,Y,Z`.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|number| number.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three finite numbers X,Y,Z in one word, as 0,1.5,-2".to_owned()),
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
            let ray = Ray::new(DVec3::ZERO, DVec3::X);
            NamedRay::new(name.to_owned(), ray, "r.toml:2".to_owned()).expect("it has a direction")
        };
        let numbered = [DVec3::ZERO, DVec3::X];
        assert_eq!(all(&numbered, &[named("a"), named("b")]).map(|rays| rays.len()).ok(), Some(3));
        for (of_rules, other) in [
            ([named("a"), named("a")], "r.toml:2 has the name \"a\""),
            ([named("a"), named("1")], "--ray 1 has the name \"1\""),
        ] {
            let error = all(&numbered, &of_rules).expect_err("two have one name").to_string();
            assert!(error.starts_with(&format!("r.toml:2: the ray at {other}")), "{error}");
        }
    }
}
