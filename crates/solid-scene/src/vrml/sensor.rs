//! The TimeSensor (ISO/IEC 14772-1, 6.50), with time 0 at the start of the scene.

use super::graph::{Graph, Node};
use crate::error::SceneError;

/// A clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensor {
    pub enabled: bool,
    pub looping: bool,
    pub start: f64,
    pub stop: f64,
    /// Positive.
    pub cycle: f64,
}

impl Sensor {
    /// The fields as the file gives them.
    pub fn read(graph: &Graph, node: Node) -> Result<Sensor, SceneError> {
        let cycle = graph.number(node, "cycleInterval")?;
        if cycle <= 0.0 {
            return Err(graph.error(node, format!("cycleInterval is {cycle}; expected more than 0")));
        }
        Ok(Sensor {
            enabled: graph.flag(node, "enabled"),
            looping: graph.flag(node, "loop"),
            start: graph.number(node, "startTime")?,
            stop: graph.number(node, "stopTime")?,
            cycle,
        })
    }

    /// The fraction of the cycle that was sent last at a time; `None` before the first.
    pub fn fraction(&self, time: f64) -> Option<f64> {
        if !self.enabled || !time.is_finite() || time < self.start {
            return None;
        }
        let elapsed = time.min(self.end()) - self.start;
        let cycles = elapsed / self.cycle;
        if !self.looping && cycles >= 1.0 {
            return Some(1.0);
        }
        // An end of a cycle may come out a little late by rounding.
        let error = 2.0 * f64::EPSILON * (self.start.abs() + elapsed) / self.cycle;
        let fraction = cycles.fract();
        Some(if cycles >= 0.5 && fraction <= error { 1.0 } else { fraction })
    }

    /// When its first cycle is over, or it is stopped in that; `None` where it never runs.
    pub fn first_cycle_end(&self) -> Option<f64> {
        self.enabled.then(|| self.stopped_by(self.start + self.cycle))
    }

    /// When it stops.
    pub fn end(&self) -> f64 {
        self.stopped_by(if self.looping { f64::INFINITY } else { self.start + self.cycle })
    }

    /// An end, or the stopTime where that is earlier. One that is not after the startTime is ignored.
    fn stopped_by(&self, end: f64) -> f64 {
        if self.stop > self.start { end.min(self.stop) } else { end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONCE: Sensor = Sensor { enabled: true, looping: false, start: 1.0, stop: 0.0, cycle: 2.0 };

    #[test]
    fn it_runs_once_and_holds_its_last_fraction() {
        let at = |time| ONCE.fraction(time);
        assert_eq!(at(0.5), None);
        assert_eq!(at(1.0), Some(0.0));
        assert_eq!(at(2.0), Some(0.5));
        assert_eq!(at(3.0), Some(1.0));
        assert_eq!(at(9.0), Some(1.0));
    }

    #[test]
    fn a_loop_ends_each_cycle_with_1() {
        let sensor = Sensor { looping: true, ..ONCE };
        assert_eq!(sensor.fraction(3.0), Some(1.0));
        assert_eq!(sensor.fraction(3.5), Some(0.25));
        assert_eq!(sensor.fraction(5.0), Some(1.0));
    }

    /// Law: whatever the decimals, the end of a cycle is no jump to its start.
    #[test]
    fn a_cycle_ends_with_1_also_where_its_end_is_rounded() {
        for (start, cycle) in [(4, 2), (1, 2), (3, 7), (12345, 1), (0, 3)] {
            let seconds = |tenths: i32| f64::from(tenths) / 10.0;
            let sensor = Sensor { looping: true, start: seconds(start), cycle: seconds(cycle), ..ONCE };
            assert_eq!(sensor.fraction(sensor.start), Some(0.0));
            for n in 1..1000 {
                let end = sensor.fraction(seconds(start + n * cycle)).expect("it runs");
                assert!((1.0 - 1e-12..=1.0).contains(&end), "{start} + {n} * {cycle}: {end}");
            }
            let after = sensor.fraction(seconds(start + 999 * cycle) + 1e-6).expect("it runs");
            assert!((0.0..2e-5).contains(&after), "{after}");
        }
    }

    #[test]
    fn stop_time_freezes_it() {
        let sensor = Sensor { looping: true, stop: 3.5, ..ONCE };
        assert_eq!(sensor.fraction(100.0), Some(0.25));
        assert_eq!(Sensor { stop: 2.0, ..ONCE }.fraction(100.0), Some(0.5));
    }

    #[test]
    fn a_disabled_one_and_a_time_that_is_none_send_nothing() {
        assert_eq!(Sensor { enabled: false, ..ONCE }.fraction(2.0), None);
        assert_eq!(ONCE.fraction(f64::NAN), None);
        assert_eq!(ONCE.fraction(f64::INFINITY), None);
    }
}
