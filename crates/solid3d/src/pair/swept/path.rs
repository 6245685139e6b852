//! How a shape gets from one placement to another.
//!
//! With `M0`, `M1` the linear parts of the placements, `o0`, `o1` the positions of the local origin, and `v0`, `v1` those of a
//! point of the shape in its own space, its way is
//!
//! ```text
//! x(t) = o0 + t (o1 - o0) + Q(t) ((1 - t) M0 v0 + t Q(1)^-1 M1 v1),        Q(t): a rotation by t times an angle about an axis
//! ```
//!
//! Of a straight path the angle is 0: each point moves straight. Of a turning one, `Q(1)` is the rotation nearest to
//! `M1 M0^-1`, the factor `U` of its polar decomposition `U S`: a rigid body then turns about a fixed axis at constant speed, and
//! what scales does so linearly. Every placement on the way is regular: it is `Q(t) ((1 - t) I + t S) M0`, and `S` is positive.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use libm::{atan2, sincos};
use solid_convex::unit_scale;

use crate::placement::inverse_linear;
use crate::shape::ShapeKind;

/// How shapes move between two placements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Path {
    /// The local origin moves straight, and the shape turns about it with constant speed, by the rotation nearest to that between
    /// the two placements, of at most half a turn. What is left of them (scale, shear) changes linearly.
    /// What turns about another point, as the link of an arm about its joint, takes that point for the origin of its shape.
    ///
    /// Straight, when one of the two placements mirrors and the other does not, or when sizes change by so much that there is no
    /// nearest rotation in numbers. Where one of the two shapes deforms, both move straight.
    #[default]
    Turning,
    /// Each point moves straight, at constant speed, from where it was to where it is: as if vertices were interpolated. The
    /// motion of [`Motion::Swept`](crate::Motion::Swept).
    Straight,
}

/// Turns by less are none: the way of a point is then straight within 1e-19 of its distance from the axis.
const ANGLE_MIN: f64 = 1e-9;

/// Steps of the iteration for the polar decomposition. It doubles the digits with each, and before that halves the
/// largest stretch, of which there is at most 1e200.
const POLAR_STEPS_MAX: usize = 1024;

/// The iteration ends when no entry changes by more.
const POLAR_ERROR: f64 = 1e-15;

/// A map is flat when its volume is less, of the larger of those at the ends of the way.
const FLAT: f64 = 1e-6;

/// How far from round about its axis a shape may be placed that counts as round, relative to its size: a hundredth of the least gap that is a contact,
/// and a hundred times what rotations are rounded.
const ROUNDNESS: f64 = 1e-12;

/// What is round about an axis, and turns about one that is off that by an angle of at most this sine, turns as its axis does. Where it is more, little is
/// gained, and [`share_along`](Way::share_along) is lost.
const TILT_MAX: f64 = 0.25;

/// About what a shape is round, in its own space: to turn about that changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Roundness {
    Nothing,
    /// The axis y.
    Axis,
    Origin,
}

impl Roundness {
    pub fn of(kind: ShapeKind) -> Roundness {
        match kind {
            ShapeKind::Sphere => Roundness::Origin,
            ShapeKind::Cone | ShapeKind::Cylinder | ShapeKind::Capsule => Roundness::Axis,
            _ => Roundness::Nothing,
        }
    }
}

/// A rotation at constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// A unit vector.
    axis: DVec3,
    /// In a unit of time.
    angle: f64,
}

/// The way of a shape from one placement to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// `M0` and `Q(1)^-1 M1`.
    pub linear: [DMat3; 2],
    pub origin: [DVec3; 2],
    pub turn: Option<Turn>,
    /// The axis about which the shape is round, a unit vector, where it was; see [`of_round`](Way::of_round).
    spindle: Option<DVec3>,
    ends: [DAffine3; 2],
}

impl Turn {
    /// The turn that leads from one linear part to another.
    fn between(from: &DMat3, to: &DMat3) -> Option<Turn> {
        let rotation = nearest_rotation(&(*to * inverse_linear(from)))?;
        let turn = DQuat::from_mat3(&rotation).normalize();
        // Of the two quaternions that is the one of at most half a turn.
        let (sine, cosine) = (turn.xyz() * turn.w.signum(), turn.w.abs());
        let angle = 2.0 * atan2(sine.length(), cosine);
        (angle > ANGLE_MIN).then(|| Turn { axis: sine.normalize(), angle })
    }

    /// The rotation up to a time.
    fn rotation(&self, t: f64) -> DMat3 {
        let (sine, cosine) = sincos(0.5 * self.angle * t);
        DMat3::from_quat(DQuat::from_vec4((self.axis * sine).extend(cosine)))
    }

    /// What it does in a unit of time, as a vector along its axis.
    fn velocity(&self) -> DVec3 {
        self.axis * self.angle
    }

    /// The sine of the angle to a unit vector.
    fn tilt(&self, of: DVec3) -> f64 {
        self.axis.cross(of).length()
    }

    /// The angle in a unit of time.
    pub fn angle(&self) -> f64 {
        self.angle
    }
}

/// What a vector that turns changes by in a unit of time.
fn rate(velocity: DVec3) -> DMat3 {
    let DVec3 { x, y, z } = velocity;
    DMat3::from_cols(DVec3::new(0.0, z, -y), DVec3::new(-z, 0.0, x), DVec3::new(y, -x, 0.0))
}

/// The rotation nearest to a map, by Newton's iteration (Higham, *Computing the Polar Decomposition*, 1986); `None` when it
/// mirrors, or is not a number.
fn nearest_rotation(map: &DMat3) -> Option<DMat3> {
    let largest = map.to_cols_array().into_iter().fold(0.0, |most, entry: f64| entry.abs().max(most));
    let mut x = *map * unit_scale(largest);
    for _ in 0..POLAR_STEPS_MAX {
        let next = (x + x.inverse().transpose()) * 0.5;
        if !next.is_finite() {
            return None;
        }
        let change =
            (next - x).to_cols_array().into_iter().fold(0.0, |most, entry: f64| entry.abs().max(most));
        x = next;
        if change <= POLAR_ERROR {
            break;
        }
    }
    ((x.determinant() - 1.0).abs() < 1e-6).then_some(x)
}

impl Way {
    pub fn new(from: &DAffine3, to: &DAffine3, path: Path) -> Way {
        let turns = path == Path::Turning && from.matrix3 != to.matrix3;
        let turn = turns.then(|| Turn::between(&from.matrix3, &to.matrix3)).flatten();
        let back = |turn: Turn| turn.rotation(1.0).transpose() * to.matrix3;
        Way {
            linear: [from.matrix3, turn.map_or(to.matrix3, back)],
            origin: [from.translation, to.translation],
            turn,
            spindle: None,
            ends: [*from, *to],
        }
    }

    /// The same of a shape that is round, for which turns about its axis, or its middle, are none: then a ball that rolls moves straight.
    ///
    /// With `w` the axis of the turn times the angle, and `a` that of the shape, which turns with it, the points of the shape may as well have the velocities
    /// `u x y` with `u = w - (w.a) a`: the shape is where it is. The angle from `w` to `a` stays as it is, and `u` changes by `w x u`, so that
    /// points accelerate by `(w x u) x y + u x (u x y) + 2 u x y'`, which is nothing for a wheel.
    pub fn of_round(self, roundness: Roundness) -> Way {
        let Some(turn) = self.turn else { return self };
        let [from, to] = self.linear;
        let [x, y, z] = [from.x_axis, from.y_axis, from.z_axis];
        let is_alike = |p: DVec3, q: DVec3| (p.length() - q.length()).abs() <= ROUNDNESS * p.length();
        let is_upright = |p: DVec3, q: DVec3| p.dot(q).abs() <= ROUNDNESS * p.length() * q.length();
        let is_kept = (0..3).all(|i| (to.col(i) - from.col(i)).length() <= ROUNDNESS * from.col(i).length());
        let is_round = is_kept && is_alike(x, z) && is_upright(x, y) && is_upright(y, z) && is_upright(z, x);
        match roundness {
            Roundness::Origin if is_round && is_alike(x, y) => Way { turn: None, ..self },
            Roundness::Axis if is_round && turn.tilt(y.normalize()) <= TILT_MAX => {
                Way { spindle: Some(y.normalize()), ..self }
            }
            _ => self,
        }
    }

    /// The same with another way of the local origin, in a unit of length of which `scale` make one.
    pub fn seen_from(&self, origin: [DVec3; 2], scale: f64) -> Way {
        let linear = self.linear.map(|linear| linear * scale);
        Way { linear, origin: origin.map(|origin| origin * scale), ..*self }
    }

    /// Where the local origin is.
    pub fn origin_at(&self, t: f64) -> DVec3 {
        self.origin[0] * (1.0 - t) + self.origin[1] * t
    }

    /// The placement at a time; at the ends to the bit.
    pub fn placement_at(&self, t: f64) -> DAffine3 {
        match t {
            0.0 => self.ends[0],
            1.0 => self.ends[1],
            _ => {
                let linear = self.linear[0] * (1.0 - t) + self.linear[1] * t;
                DAffine3 { matrix3: self.rotation(t) * linear, translation: self.origin_at(t) }
            }
        }
    }

    /// Whether the shape is flat at a time, or nearly: as it is half way where one placement mirrors and the other does not. There it has no
    /// local space.
    pub fn is_flat_at(&self, t: f64) -> bool {
        let [from, to] = self.linear;
        let volume = |linear: DMat3| linear.determinant().abs();
        volume(from * (1.0 - t) + to * t) < FLAT * volume(from).max(volume(to))
    }

    /// `Q(t)`.
    pub fn rotation(&self, t: f64) -> DMat3 {
        self.turn.map_or(DMat3::IDENTITY, |turn| turn.rotation(t))
    }

    /// `Q'(t)`.
    pub fn rotation_rate(&self, t: f64) -> DMat3 {
        let Some(turn) = self.turn else { return DMat3::ZERO };
        let rotation = turn.rotation(t);
        let about = self.spindle.map_or(DVec3::ZERO, |spindle| rotation * spindle);
        rate(turn.velocity() - about * turn.velocity().dot(about)) * rotation
    }

    /// A bound on the acceleration of a point that never is further than `reach` from the local origin, and would move by
    /// `change` if it did not turn: `|Q''| |y| + 2 |Q'| |y'|`; of what is round, see [`of_round`](Way::of_round).
    pub fn acceleration(&self, reach: f64, change: f64) -> f64 {
        let Some(turn) = self.turn else { return 0.0 };
        let angle = turn.angle;
        match self.spindle.map(|spindle| turn.tilt(spindle)) {
            Some(tilt) => angle * tilt * ((1.0 + tilt) * angle * reach + 2.0 * change),
            None => angle * (angle * reach + 2.0 * change),
        }
    }

    /// A bound on the share of an acceleration that is along a unit vector `n`. With `w` the axis times the angle, the acceleration is
    /// `w x (w x y) + 2 w x y'`, whose product with `n` is one of two vectors with `n x w`: along the axis nothing accelerates. Of what is round it is all.
    pub fn share_along(&self, n: DVec3) -> f64 {
        self.turn.map_or(0.0, |turn| if self.spindle.is_some() { 1.0 } else { turn.tilt(n) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;
    use solid_oracle::generate::{PlacementKind, random_placement, seeded};

    /// Both ends are what was given, a rigid body stays rigid, and no placement on the way is singular.
    #[test]
    fn a_way_leads_from_one_placement_to_the_other() {
        let mut rng = seeded(2100);
        let mut turned = 0;
        for case in 0..2000 {
            let kind = PlacementKind::ALL[case % PlacementKind::ALL.len()];
            let [from, to] = [0, 1].map(|_| random_placement(&mut rng, kind));
            let way = Way::new(&from, &to, Path::Turning);
            turned += usize::from(way.turn.is_some());
            let size = to.matrix3.to_cols_array().into_iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (end, at) in [(0.0, &from), (1.0, &to)] {
                let linear = way.rotation(end) * way.linear[end as usize];
                assert!(linear.abs_diff_eq(at.matrix3, 1e-12 * size.max(1.0)), "{linear} {at:?}");
                assert_eq!(way.placement_at(end), *at);
            }
            let t = rng.random_range(0.0..1.0);
            let middle = way.placement_at(t).matrix3;
            let mirrors = |m: &DMat3| m.determinant() < 0.0;
            if mirrors(&from.matrix3) == mirrors(&to.matrix3) {
                assert!(middle.determinant() != 0.0 && mirrors(&middle) == mirrors(&to.matrix3));
            } else {
                assert_eq!(way.turn, None);
            }
            let rigid = |m: &DMat3| (*m * m.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9);
            if rigid(&from.matrix3) && rigid(&to.matrix3) && way.turn.is_some() {
                assert!(rigid(&middle), "{middle}");
            }
        }
        assert!(turned > 600, "{turned}");
    }

    /// Law: no point accelerates by more than the bound, nor along a direction by more than its share; along the axis by nothing.
    #[test]
    fn accelerations_are_bounded_along_every_direction() {
        const STEP: f64 = 1e-3;
        let mut rng = seeded(2101);
        let mut most: f64 = 0.0;
        for case in 0..2000 {
            let kind = PlacementKind::ALL[case % PlacementKind::ALL.len()];
            let [from, to] = [0, 1].map(|_| random_placement(&mut rng, kind));
            let way = Way::new(&from, &to, Path::Turning);
            let mut vector = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let (point, any) = (vector(), vector().normalize());
            let n = way.turn.filter(|_| case % 3 == 0).map_or(any, |turn| turn.axis);
            let t = rng.random_range(STEP..1.0 - STEP);
            let height = |t: f64| n.dot(way.placement_at(t).transform_vector3(point));
            let (was, is, will) = (height(t - STEP), height(t), height(t + STEP));
            let acceleration = (was - 2.0 * is + will) / (STEP * STEP);
            let ends = way.linear.map(|linear| linear * point);
            let far = ends[0].length().max(ends[1].length());
            let bound = way.acceleration(far, ends[0].distance(ends[1])) * way.share_along(n);
            assert!(
                acceleration.abs() <= bound * (1.0 + STEP) + 1e-8 * far,
                "{case}: {acceleration}, {bound}"
            );
            if bound > 1e-3 * far {
                most = most.max(acceleration.abs() / bound);
            }
        }
        assert!(most > 0.5, "the bound is {most} of what is needed");
    }

    #[test]
    fn a_quarter_turn_is_an_eighth_at_half_time() {
        let to = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let way = Way::new(&DAffine3::IDENTITY, &to, Path::Turning);
        let half = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4);
        assert!(way.placement_at(0.5).abs_diff_eq(half, 1e-15));
        let straight = Way::new(&DAffine3::IDENTITY, &to, Path::Straight);
        assert!(straight.placement_at(0.5).matrix3.determinant() < 0.6);
    }
}
