//! The interpolators (ISO/IEC 14772-1, 4.6.8).

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::graph::{Graph, Node};
use crate::error::SceneError;
use crate::text::counted;

/// What an event carries.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Event {
    Number(f64),
    Vector(DVec3),
    Rotation(DQuat),
    /// Shared, so that an event costs the same however many fields it reaches.
    Points(Arc<[DVec3]>),
}

/// An interpolator: values at keys. Invariant: the keys never decrease, there is at least one, and a value for each.
#[derive(Clone, Debug)]
pub(super) struct Interpolator {
    keys: Vec<f64>,
    values: Values,
}

#[derive(Clone, Debug)]
enum Values {
    Numbers(Vec<f64>),
    Vectors(Vec<DVec3>),
    Rotations(Vec<DQuat>),
    /// So many points for each key.
    Points {
        count: usize,
        points: Vec<DVec3>,
    },
}

/// Whether a type of node is an interpolator that matters to collisions.
pub(super) fn is_interpolator(type_name: &str) -> bool {
    matches!(
        type_name,
        "ScalarInterpolator" | "PositionInterpolator" | "OrientationInterpolator" | "CoordinateInterpolator"
    )
}

impl Interpolator {
    /// The fields as the file gives them; `None` for one without keys, which never sends a value.
    pub fn read(graph: &Graph, node: Node) -> Result<Option<Interpolator>, SceneError> {
        let keys = graph.numbers(node, "key")?;
        if let Some(at) = keys.windows(2).position(|pair| pair[1] < pair[0]) {
            let message = format!(
                "key {} is {}, after {}; expected keys that never decrease",
                at + 1,
                keys[at + 1],
                keys[at]
            );
            return Err(graph.error(node, message));
        }
        if keys.is_empty() {
            return Ok(None);
        }
        let values = Values::read(graph, node, keys.len())?;
        let per_key = if matches!(values, Values::Points { .. }) {
            "as many points for each key"
        } else {
            "one for each key"
        };
        if values.len() != keys.len() {
            let message = format!(
                "keyValue holds {} for {}; expected {per_key}",
                counted(values.raw_len(), "value"),
                counted(keys.len(), "key")
            );
            return Err(graph.error(node, message));
        }
        Ok(Some(Interpolator { keys, values }))
    }

    /// How many points it sends; 0 when it sends something else.
    pub fn point_count(&self) -> usize {
        match self.values {
            Values::Points { count, .. } => count,
            _ => 0,
        }
    }

    /// The value at a fraction.
    pub fn at(&self, fraction: f64) -> Event {
        let (i, t) = self.span(fraction);
        let j = (i + 1).min(self.keys.len() - 1);
        match &self.values {
            Values::Numbers(values) => Event::Number(values[i] + t * (values[j] - values[i])),
            Values::Vectors(values) => Event::Vector(values[i].lerp(values[j], t)),
            Values::Rotations(values) => Event::Rotation(slerp(values[i], values[j], t)),
            Values::Points { count, points } => {
                let row = |key: usize| points[key * count..][..*count].iter();
                Event::Points(row(i).zip(row(j)).map(|(a, b)| a.lerp(*b, t)).collect())
            }
        }
    }

    /// The key before a fraction, and how far it is on the way to the next one: in [0, 1).
    fn span(&self, fraction: f64) -> (usize, f64) {
        let last = self.keys.len() - 1;
        let after = self.keys.partition_point(|&key| key <= fraction);
        match after {
            0 => (0, 0.0),
            after if after > last => (last, 0.0),
            after => {
                let (from, to) = (self.keys[after - 1], self.keys[after]);
                (after - 1, (fraction - from) / (to - from))
            }
        }
    }
}

impl Values {
    fn read(graph: &Graph, node: Node, keys: usize) -> Result<Values, SceneError> {
        Ok(match graph.type_name(node) {
            "ScalarInterpolator" => Values::Numbers(graph.numbers(node, "keyValue")?),
            "PositionInterpolator" => Values::Vectors(graph.vectors(node, "keyValue")?),
            "OrientationInterpolator" => Values::Rotations(graph.rotations(node, "keyValue")?),
            _ => {
                let points = graph.vectors(node, "keyValue")?;
                Values::Points { count: points.len() / keys, points }
            }
        })
    }

    /// For how many keys there are values; 0 when the points do not come out even.
    fn len(&self) -> usize {
        match self {
            Values::Points { count: 0, .. } => 0,
            Values::Points { count, points } if points.len() % count != 0 => 0,
            Values::Points { count, points } => points.len() / count,
            _ => self.raw_len(),
        }
    }

    fn raw_len(&self) -> usize {
        match self {
            Values::Numbers(values) => values.len(),
            Values::Vectors(values) => values.len(),
            Values::Rotations(values) => values.len(),
            Values::Points { points, .. } => points.len(),
        }
    }
}

/// The shortest way between two rotations (ISO/IEC 14772-1, 6.32).
fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    match t {
        0.0 => a,
        _ => a.slerp(b, t),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn numbers(keys: &[f64], values: &[f64]) -> Interpolator {
        Interpolator { keys: keys.to_vec(), values: Values::Numbers(values.to_vec()) }
    }

    #[test]
    fn values_are_linear_between_keys_and_constant_outside() {
        let ramp = numbers(&[0.25, 0.75], &[1.0, 3.0]);
        assert_eq!(ramp.at(0.0), Event::Number(1.0));
        assert_eq!(ramp.at(0.5), Event::Number(2.0));
        assert_eq!(ramp.at(0.75), Event::Number(3.0));
        assert_eq!(ramp.at(2.0), Event::Number(3.0));
        assert_eq!(numbers(&[0.5], &[7.0]).at(0.1), Event::Number(7.0));
    }

    #[test]
    fn a_key_that_repeats_is_a_jump() {
        let jump = numbers(&[0.0, 0.5, 0.5, 1.0], &[0.0, 0.0, 1.0, 1.0]);
        assert_eq!(jump.at(0.499), Event::Number(0.0));
        assert_eq!(jump.at(0.5), Event::Number(1.0));
    }

    #[test]
    fn rotations_take_the_short_way() {
        let turn = |angle: f64| DQuat::from_axis_angle(DVec3::Z, angle);
        let values = Values::Rotations(vec![turn(0.1), turn(2.0 * PI - 0.1)]);
        let interpolator = Interpolator { keys: vec![0.0, 1.0], values };
        let Event::Rotation(middle) = interpolator.at(0.5) else { panic!("expected a rotation") };
        assert!((middle * DVec3::X).distance(DVec3::X) < 1e-12, "not by way of the half turn");
    }

    #[test]
    fn points_are_interpolated_row_by_row() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE];
        let values = Values::Points { count: 2, points };
        let interpolator = Interpolator { keys: vec![0.0, 1.0], values };
        let expected = vec![0.5 * DVec3::Y, DVec3::new(1.0, 0.5, 0.5)];
        assert_eq!(interpolator.at(0.5), Event::Points(expected.into()));
    }
}
