//! A value over time.

use glam::{DQuat, DVec4};
use gltf::json::accessor::Type;
use gltf::json::animation::{self, Interpolation, Property};
use gltf::json::validation::Checked;

use super::document::Document;
use super::local::unit;
use crate::fault::Result;
use crate::text::counted;

/// Keys and what is between them. Invariants: there is a key; times do not decrease; there are `width` values a key, or
/// three times as many for a spline (slope before, value, slope after); values of a rotation are not nearly 0.
#[derive(Debug)]
pub(super) struct Sampler {
    times: Vec<f64>,
    values: Vec<f64>,
    width: usize,
    interpolation: Interpolation,
    is_rotation: bool,
}

impl Sampler {
    /// Reads a sampler of a property.
    pub fn read(
        document: &Document,
        sampler: &animation::Sampler,
        property: Property,
        what: &str,
    ) -> Result<Sampler> {
        let Checked::Valid(interpolation) = sampler.interpolation else {
            return Err(format!("{what} has an unknown interpolation").into());
        };
        let times = document.numbers(sampler.input.value(), Type::Scalar, &format!("{what}, input"))?.values;
        check_times(&times, what)?;
        let kind = match property {
            Property::Translation | Property::Scale => Type::Vec3,
            Property::Rotation => Type::Vec4,
            Property::MorphTargetWeights => Type::Scalar,
        };
        let values = document.numbers(sampler.output.value(), kind, &format!("{what}, output"))?.values;
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let width =
            if kind == Type::Scalar { values.len() / (times.len() * per_key) } else { kind.multiplicity() };
        if values.len() != times.len() * per_key * width {
            let (keys, values) = (times.len(), values.len() / kind.multiplicity());
            let (keys, values) = (counted(keys, "key"), counted(values, "value"));
            return Err(format!("{what} has {keys}, but {values}").into());
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(format!("{what} has the value {value}; expected finite numbers").into());
        }
        let sampler =
            Sampler { times, values, width, interpolation, is_rotation: property == Property::Rotation };
        sampler.check_rotations(what)?;
        Ok(sampler)
    }

    fn check_rotations(&self, what: &str) -> Result<()> {
        let keys = 0..self.times.len();
        let zero = |&key: &usize| unit(DQuat::from_slice(self.key(key))).is_none();
        match keys.into_iter().filter(|_| self.is_rotation).find(zero) {
            Some(key) => Err(format!("{what}: the rotation of key {key} has length 0").into()),
            None => Ok(()),
        }
    }

    /// How many numbers a value has.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The time of the last key.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The value at a time; before the first key and after the last the value there. A rotation is of length 1.
    pub fn sample(&self, time: f64, value: &mut Vec<f64>) {
        let after = self.times.partition_point(|&key| key <= time);
        value.clear();
        match (after.checked_sub(1), self.times.get(after)) {
            (None, _) => value.extend(self.key(0)),
            (Some(before), None) => value.extend(self.key(before)),
            (Some(before), Some(&end)) => {
                let length = end - self.times[before];
                self.between(before, (time - self.times[before]) / length, length, value);
            }
        }
        if self.is_rotation {
            let rotation = unit(DQuat::from_slice(value)).unwrap_or(DQuat::IDENTITY);
            value.copy_from_slice(&rotation.to_array());
        }
    }

    fn between(&self, before: usize, t: f64, length: f64, value: &mut Vec<f64>) {
        match self.interpolation {
            Interpolation::Step => value.extend(self.key(before)),
            Interpolation::CubicSpline => self.spline(before, t, length, value),
            Interpolation::Linear if self.is_rotation => {
                let [a, b] = [before, before + 1].map(|key| DQuat::from_slice(self.key(key)));
                value.extend(slerp(a, b, t).to_array());
            }
            Interpolation::Linear => {
                let pairs = self.key(before).iter().zip(self.key(before + 1));
                value.extend(pairs.map(|(a, b)| (1.0 - t) * a + t * b));
            }
        }
    }

    /// Hermite's spline (glTF 2.0, appendix C.5).
    fn spline(&self, before: usize, t: f64, length: f64, value: &mut Vec<f64>) {
        let (t2, t3) = (t * t, t * t * t);
        let values = self.key(before).iter().zip(self.key(before + 1));
        let slopes = self.part(before, 2).iter().zip(self.part(before + 1, 0));
        value.extend(values.zip(slopes).map(|((v0, v1), (b0, a1))| {
            (2.0 * t3 - 3.0 * t2 + 1.0) * v0
                + length * (t3 - 2.0 * t2 + t) * b0
                + (3.0 * t2 - 2.0 * t3) * v1
                + length * (t3 - t2) * a1
        }));
    }

    /// The value of a key.
    fn key(&self, key: usize) -> &[f64] {
        if self.interpolation == Interpolation::CubicSpline {
            return self.part(key, 1);
        }
        &self.values[key * self.width..(key + 1) * self.width]
    }

    /// Part 0, 1 or 2 of a spline's key.
    fn part(&self, key: usize, part: usize) -> &[f64] {
        let start = (3 * key + part) * self.width;
        &self.values[start..start + self.width]
    }
}

fn check_times(times: &[f64], what: &str) -> Result<()> {
    if times.is_empty() {
        return Err(format!("{what} has no key").into());
    }
    if let Some(time) = times.iter().find(|time| !time.is_finite()) {
        return Err(format!("{what} has a key at {time}; expected a finite time").into());
    }
    match times.windows(2).find(|pair| pair[0] > pair[1]) {
        Some(pair) => Err(format!("{what} has a key at {} after one at {}", pair[1], pair[0]).into()),
        None => Ok(()),
    }
}

/// Turns evenly from one rotation to another, the short way (glTF 2.0, appendix C.3). The values are taken as they are,
/// since files round them and other programs take them so: of 0.707 for the square root of 1/2, normalizing first would
/// show in the fifth digit.
///
/// Not glam's, which below an angle of about 2 degrees takes the chord for the arc.
fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    let (a, b) = (DVec4::from(a), DVec4::from(b));
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let angle = a.dot(b).min(1.0).acos();
    let sine = angle.sin();
    // Rounding may have made the cosine of a small angle 1; then the chord is the arc.
    if sine == 0.0 {
        return DQuat::from_vec4(a.lerp(b, t));
    }
    DQuat::from_vec4(a * (((1.0 - t) * angle).sin() / sine) + b * ((t * angle).sin() / sine))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;

    fn sampler(interpolation: Interpolation, width: usize, values: Vec<f64>) -> Sampler {
        Sampler { times: vec![1.0, 2.0, 4.0], values, width, interpolation, is_rotation: width == 4 }
    }

    fn at(sampler: &Sampler, time: f64) -> Vec<f64> {
        let mut value = vec![9.0];
        sampler.sample(time, &mut value);
        value
    }

    #[test]
    fn steps_and_lines() {
        let step = sampler(Interpolation::Step, 1, vec![10.0, 20.0, 40.0]);
        let line = sampler(Interpolation::Linear, 1, vec![10.0, 20.0, 40.0]);
        let times = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(times.map(|t| at(&step, t)[0]), [10.0, 10.0, 10.0, 20.0, 20.0, 40.0, 40.0]);
        assert_eq!(times.map(|t| at(&line, t)[0]), [10.0, 10.0, 15.0, 20.0, 30.0, 40.0, 40.0]);
    }

    #[test]
    fn a_spline_goes_through_its_keys_with_their_slopes() {
        // The parabola t^2, which a cubic spline with its slopes follows exactly.
        let keys = [1.0f64, 2.0, 4.0].iter().flat_map(|t| [2.0 * t, t * t, 2.0 * t]).collect();
        let spline = sampler(Interpolation::CubicSpline, 1, keys);
        for time in [1.0, 1.25, 2.0, 3.0, 3.9, 4.0] {
            assert!((at(&spline, time)[0] - time * time).abs() < 1e-12, "{time}");
        }
    }

    #[test]
    fn times_that_are_equal_do_not_divide_by_zero() {
        let mut line = sampler(Interpolation::Linear, 1, vec![10.0, 20.0, 40.0]);
        line.times = vec![1.0, 1.0, 1.0];
        assert_eq!([0.0, 1.0, 2.0].map(|t| at(&line, t)[0]), [10.0, 40.0, 40.0]);
    }

    proptest! {
        #[test]
        fn slerp_turns_evenly_the_short_way(angle in -3.0f64..3.0, t in 0.0f64..=1.0, flip: bool) {
            let (a, b) = (DQuat::IDENTITY, DQuat::from_rotation_z(angle));
            let turned = slerp(a, if flip { -b } else { b }, t);
            let expected = DQuat::from_rotation_z(angle * t);
            prop_assert!(turned.abs_diff_eq(expected, 1e-14), "{turned} {expected}");
        }
    }

    #[test]
    fn opposite_rotations_stay_unit() {
        let half = DQuat::from_rotation_x(TAU / 2.0);
        assert!((slerp(DQuat::IDENTITY, half, 0.5).length() - 1.0).abs() < 1e-15);
    }
}
