//! When two convex objects on their way first meet: conservative advancement, along planes.
//!
//! Mirtich, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 1996, section 2.3.2, advances by a distance over a bound on
//! the speed. Here a step goes as far as the supporting planes of the closest points are sure to stay apart. With `n` their normal
//! from `B` to `A`, `x` and `v` the positions and velocities of points now, and `c` a bound on the accelerations of both along it,
//!
//! ```text
//! gap(s) = min over A of n.(x + s v)  -  max over B of n.(x + s v)  -  c s^2 / 2
//! ```
//!
//! is a lower bound on the gap after the time `s`: each minimum is a support mapping of the objects as they are moved to first order.
//! It is concave in `s`, so a time at which it is positive is reached without contact. Straight motion has no third
//! term, nor has what turns about the normal, as on a turntable, and a step is one of Newton's method; a ball that turns about its
//! centre is known to stay where it is to second order.

use glam::DVec3;
use solid_convex::gjk;

use super::body::Body;

/// Steps after which an advance ends where it is, which is before the contact. What slides by at a gap of `g` of its size, turning
/// by the angle `t` about an axis across the normal, takes some `t / sqrt(g)`.
const STEPS_MAX: usize = 4096;

/// Rounds in which the end of a step is narrowed down; each halves at least what is left.
const ROUNDS_MAX: usize = 10;

/// Where two objects first meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    pub time: f64,
    /// From `B` to `A`; `None` when there was no gap at the start.
    pub normal: Option<DVec3>,
    /// The middle between the closest points. Space: of the bodies.
    pub point: DVec3,
}

/// How near is a contact. Unit: of the bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    /// What is nearer has met.
    pub tolerance: f64,
    /// What starts within the tolerance has met when half of the gap is left, but not before it is less than this.
    pub least: f64,
}

/// A span of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: f64,
    pub to: f64,
}

/// Directions that are tried before the closest points are looked for: most pairs of primitives whose boxes overlap on the whole way
/// stay apart along an axis in what is left of it.
const AXES: [DVec3; 6] = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];

/// A lower bound on the gap along a direction from `B` to `A`, after a time from that of the bodies.
fn gap(a: &Body, b: &Body, n: DVec3, s: f64) -> f64 {
    let acceleration = a.acceleration_along(n) + b.acceleration_along(n);
    -a.furthest(-n, s) - b.furthest(n, s) - 0.5 * s * s * acceleration
}

/// When two bodies first meet in a span of time; `None` when they do not. Never later than they do.
pub(super) fn advance(a: &mut Body, b: &mut Body, span: Span, nearness: Nearness) -> Option<Arrival> {
    let Nearness { mut tolerance, least } = nearness;
    let (mut t, mut normal, mut met) = (span.from, None, None);
    for step in 0..STEPS_MAX {
        a.seek(t);
        b.seek(t);
        let apart = |n: &DVec3| [0.0, span.to - t].iter().all(|&s| gap(a, b, *n, s) >= 0.5 * tolerance);
        if step == 0 && AXES.iter().any(apart) {
            return None;
        }
        let (v, point) = closest(a, b);
        let distance = v.length();
        met = Some(Arrival { time: t, normal, point });
        if distance == 0.0 {
            break;
        }
        if step == 0 {
            tolerance = tolerance.min(0.5 * distance).max(least);
        }
        let n = v / distance;
        normal = Some(n);
        met = Some(Arrival { time: t, normal, point });
        if distance <= tolerance {
            break;
        }
        let next = t + stride(|s| gap(a, b, n, s), span.to - t, tolerance);
        if next >= span.to {
            return None;
        }
        if next <= t {
            break;
        }
        t = next;
    }
    met
}

/// How long a concave function is sure to stay above half of a tolerance, of a time that is left: all of it, or nearly as long as it
/// does.
fn stride(gap: impl Fn(f64) -> f64, left: f64, tolerance: f64) -> f64 {
    let floor = 0.5 * tolerance;
    let above = |s: f64| gap(s) - floor;
    let (mut low, mut high) = ((0.0, above(0.0)), (left, above(left)));
    if high.1 >= 0.0 {
        return left;
    }
    for _ in 0..ROUNDS_MAX {
        // Positive before, negative after; the chord is below the function. It is followed to a little above zero, for rounding.
        if low.1 <= 0.25 * tolerance || !high.1.is_finite() {
            break;
        }
        let chord = low.0 + (high.0 - low.0) * ((low.1 - 0.125 * tolerance) / (low.1 - high.1));
        let on_chord = (chord, above(chord));
        if on_chord.1 < 0.0 {
            break;
        }
        low = on_chord;
        let between = 0.5 * (low.0 + high.0);
        let in_between = (between, above(between));
        if in_between.1 >= 0.0 { low = in_between } else { high = in_between }
    }
    low.0
}

/// The vector from the closest point of `B` to that of `A`, zero when they meet, and the point between them.
fn closest(a: &Body, b: &Body) -> (DVec3, DVec3) {
    a.with_placed(|shape_a, at_a| {
        b.with_placed(|shape_b, at_b| {
            let closest = gjk::closest_points(shape_a, at_a, shape_b, at_b);
            let (on_a, on_b) =
                (at_a.transform_point3(closest.points.on_a), at_b.transform_point3(closest.points.on_b));
            let v = if closest.distance > 0.0 { on_a - on_b } else { DVec3::ZERO };
            (v, 0.5 * (on_a + on_b))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stride never passes the zero of what it is given, and comes near it.
    #[test]
    fn a_stride_ends_before_the_zero() {
        let functions: [(&dyn Fn(f64) -> f64, f64); 3] = [
            (&|s| 1.0 - 4.0 * s, 0.25),
            (&|s| 1.0 + s - 30.0 * s * s, 0.2),
            (&|s| (1.0 - 0.1 * s).min(1.0 - 8.0 * (s - 0.5)), 0.625),
        ];
        for (gap, zero) in functions {
            let s = stride(gap, 1.0, 1e-6);
            assert!(s <= zero && s > 0.9 * zero, "{s} {zero}");
            assert_eq!(stride(gap, 0.5 * zero, 1e-6), 0.5 * zero);
        }
        assert_eq!(stride(|_| f64::NAN, 1.0, 1e-6), 0.0);
    }
}
