use glam::DVec3;

use crate::double_double::{DoubleDouble, Vec3};
use crate::exact::{Dyadic, ExactVec3};

/// A closed convex reference shape in its own space. Numbers are half extents and must not be negative.
#[derive(Clone, Debug, PartialEq)]
pub enum Convex {
    /// A ball around the origin.
    Sphere {
        /// Distance from the centre to the surface.
        radius: f64,
    },
    /// A box around the origin, its edges along the axes.
    Cuboid {
        /// Half of the edge lengths.
        half: DVec3,
    },
    /// A solid cone: apex at `+half_height` of y, base disc at `-half_height`.
    Cone {
        /// Radius of the base.
        radius: f64,
        /// Half of the distance from base to apex.
        half_height: f64,
    },
    /// A solid cylinder along y.
    Cylinder {
        /// Radius of the caps.
        radius: f64,
        /// Half of the distance between the caps.
        half_height: f64,
    },
    /// All points within `radius` of the segment from `-half_height` to `+half_height` of y.
    Capsule {
        /// Radius of the ball swept along the segment.
        radius: f64,
        /// Half of the length of the segment.
        half_height: f64,
    },
    /// The convex hull of any points: a point, a segment, a polygon, duplicates and interior points included.
    Hull {
        /// At least one point.
        points: Vec<DVec3>,
    },
}

/// The factor 1 - 2^-96, with which a rounded surface point is first tried to be pulled inside, loses this much.
const FIRST_HAIR: f64 = 1.0 / ((1u128 << 96) as f64);

/// Each further attempt pulls 2^8 times as far; the last one by 2^-16, far more than rounding can ask for.
const HAIR_GROWTH: f64 = 256.0;

/// See [`HAIR_GROWTH`].
const PULLS_MAX: usize = 11;

/// -1 for negative numbers, 1 for the others, zero included.
fn sign(x: DoubleDouble) -> DoubleDouble {
    if x.is_negative() { -DoubleDouble::ONE } else { DoubleDouble::ONE }
}

impl Convex {
    /// Whether the shape is the hull of finitely many points.
    pub(crate) fn is_polytope(&self) -> bool {
        matches!(self, Self::Cuboid { .. } | Self::Hull { .. })
    }

    /// The points whose hull a polytope is; empty for the round shapes.
    pub(crate) fn corners(&self) -> Vec<DVec3> {
        match self {
            Self::Hull { points } => points.clone(),
            Self::Cuboid { half } => {
                let sign = |bit: u32, i: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
                (0..8).map(|i| *half * DVec3::new(sign(0, i), sign(1, i), sign(2, i))).collect()
            }
            _ => Vec::new(),
        }
    }

    /// A point of the shape, up to rounding, where the linear form `g` is greatest.
    pub(crate) fn support(&self, g: Vec3) -> Vec3 {
        let scalar = DoubleDouble::new;
        match self {
            Self::Sphere { radius } => on_ball(*radius, g),
            Self::Cuboid { half } => {
                Vec3::new(sign(g.x) * scalar(half.x), sign(g.y) * scalar(half.y), sign(g.z) * scalar(half.z))
            }
            Self::Cylinder { radius, half_height } => on_disc(*radius, sign(g.y) * scalar(*half_height), g),
            Self::Capsule { radius, half_height } => {
                let ball = on_ball(*radius, g);
                Vec3 { y: ball.y + sign(g.y) * scalar(*half_height), ..ball }
            }
            Self::Cone { radius, half_height } => {
                let height = scalar(*half_height);
                let base = on_disc(*radius, -height, g);
                let apex = Vec3::new(DoubleDouble::ZERO, height, DoubleDouble::ZERO);
                if g.dot(apex) >= g.dot(base) { apex } else { base }
            }
            Self::Hull { points } => {
                let first = *points.first().expect("a hull has at least one point");
                let mut best = (g.dot(Vec3::from_f64(first)), first);
                let slack = 1e-14 * g.to_f64().abs().element_sum() * max_abs(points);
                for &p in &points[1..] {
                    if g.to_f64().dot(p) < best.0.to_f64() - slack {
                        continue;
                    }
                    let value = g.dot(Vec3::from_f64(p));
                    if value > best.0 {
                        best = (value, p);
                    }
                }
                Vec3::from_f64(best.1)
            }
        }
    }

    /// An upper bound of the linear form `g` over the shape; exact for polytopes and wherever the roots are.
    pub(crate) fn support_value_up(&self, g: &ExactVec3) -> Dyadic {
        let [gx, gy, gz] = &g.0;
        let exact = Dyadic::from_f64;
        let disc = |radius: f64| &exact(radius) * &(&gx.square() + &gz.square()).sqrt_up();
        match self {
            Self::Sphere { radius } => &exact(*radius) * &g.length_squared().sqrt_up(),
            Self::Cuboid { half } => {
                ExactVec3::from_f64(*half).dot(&ExactVec3([gx.abs(), gy.abs(), gz.abs()]))
            }
            Self::Cylinder { radius, half_height } => &(&exact(*half_height) * &gy.abs()) + &disc(*radius),
            Self::Capsule { radius, half_height } => {
                &(&exact(*half_height) * &gy.abs()) + &(&exact(*radius) * &g.length_squared().sqrt_up())
            }
            Self::Cone { radius, half_height } => {
                let apex = &exact(*half_height) * gy;
                let base = &disc(*radius) - &apex;
                apex.max(base)
            }
            Self::Hull { points } => hull_support_value(points, g),
        }
    }

    /// A point proven to lie in the shape, equal to `point` where that does, else pulled inside by a hair.
    ///
    /// `point` comes from [`support`](Self::support). `None` when a longer pull than rounding explains is needed.
    pub(crate) fn proven_inside(&self, point: Vec3) -> Option<ExactVec3> {
        let exact = point.to_exact();
        if self.is_polytope() || self.contains(&exact) {
            return Some(exact);
        }
        let mut hair = FIRST_HAIR;
        for _ in 0..PULLS_MAX {
            let pulled = self.pulled_inside(point, hair).to_exact();
            if self.contains(&pulled) {
                return Some(pulled);
            }
            hair *= HAIR_GROWTH;
        }
        None
    }

    /// The round part of a surface point scaled by `1 - hair`.
    fn pulled_inside(&self, p: Vec3, hair: f64) -> Vec3 {
        let factor = DoubleDouble::ONE - DoubleDouble::new(hair);
        match self {
            Self::Capsule { half_height, .. } => {
                let centre = sign(p.y) * DoubleDouble::new(*half_height);
                Vec3::new(p.x * factor, (p.y - centre) * factor + centre, p.z * factor)
            }
            Self::Sphere { .. } => p * factor,
            _ => Vec3::new(p.x * factor, p.y, p.z * factor),
        }
    }

    /// Exact membership in a round shape.
    fn contains(&self, p: &ExactVec3) -> bool {
        let [x, y, z] = &p.0;
        let exact = Dyadic::from_f64;
        let radial = || &x.square() + &z.square();
        match self {
            Self::Sphere { radius } => p.length_squared() <= exact(*radius).square(),
            Self::Cylinder { radius, half_height } => {
                y.abs() <= exact(*half_height) && radial() <= exact(*radius).square()
            }
            Self::Capsule { radius, half_height } => {
                let beyond = (&y.abs() - &exact(*half_height)).max(Dyadic::ZERO);
                &radial() + &beyond.square() <= exact(*radius).square()
            }
            Self::Cone { radius, half_height } => {
                let height = exact(*half_height);
                let to_apex = &height - y;
                // The first bound on the radius is all there is of a cone without height, a disc.
                y.abs() <= height
                    && radial() <= exact(*radius).square()
                    && &radial() * &height.scaled(1).square() <= (&exact(*radius) * &to_apex).square()
            }
            Self::Cuboid { .. } | Self::Hull { .. } => unreachable!("polytopes support at their own corners"),
        }
    }
}

fn max_abs(points: &[DVec3]) -> f64 {
    points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
}

fn on_ball(radius: f64, g: Vec3) -> Vec3 {
    let length = g.length_squared().sqrt();
    if length.is_zero() { Vec3::ZERO } else { g * (DoubleDouble::new(radius) / length) }
}

fn on_disc(radius: f64, y: DoubleDouble, g: Vec3) -> Vec3 {
    let length = (g.x * g.x + g.z * g.z).sqrt();
    if length.is_zero() {
        return Vec3::new(DoubleDouble::ZERO, y, DoubleDouble::ZERO);
    }
    let factor = DoubleDouble::new(radius) / length;
    Vec3::new(g.x * factor, y, g.z * factor)
}

/// The exact maximum; only points that `f64` cannot rule out are looked at exactly.
fn hull_support_value(points: &[DVec3], g: &ExactVec3) -> Dyadic {
    let rough = g.rounded();
    // Rounding g and the dot product each lose less than 4 ulp of the sum of magnitudes.
    let slack = 1e-14 * rough.abs().element_sum() * max_abs(points) + f64::MIN_POSITIVE;
    let greatest = points.iter().map(|p| rough.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
    points
        .iter()
        .filter(|p| rough.dot(**p) >= greatest - slack)
        .map(|p| ExactVec3::from_f64(*p).dot(g))
        .max()
        .expect("a hull has at least one point")
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn membership_is_exact_at_the_rim() {
        let inside = |shape: &Convex, p: DVec3| shape.contains(&ExactVec3::from_f64(p));
        let next = 1.0 + f64::EPSILON;
        let cone = Convex::Cone { radius: 1.0, half_height: 1.0 };
        assert!(inside(&cone, dvec3(0.5, 0.0, 0.0)) && !inside(&cone, dvec3(0.5 * next, 0.0, 0.0)));
        let disc = Convex::Cone { radius: 1.0, half_height: 0.0 };
        assert!(inside(&disc, DVec3::X) && !inside(&disc, DVec3::X * next));
        let capsule = Convex::Capsule { radius: 1.0, half_height: 2.0 };
        assert!(inside(&capsule, 3.0 * DVec3::Y) && !inside(&capsule, 3.0 * next * DVec3::Y));
        let cylinder = Convex::Cylinder { radius: 5.0, half_height: 2.0 };
        assert!(inside(&cylinder, dvec3(3.0, -2.0, 4.0)) && !inside(&cylinder, dvec3(3.0, -2.0, 4.0 * next)));
    }

    #[test]
    fn support_points_lie_inside_and_attain_the_support_value() {
        let shapes = [
            Convex::Sphere { radius: 0.7 },
            Convex::Cuboid { half: dvec3(1.0, 0.2, 3.0) },
            Convex::Cone { radius: 0.3, half_height: 2.0 },
            Convex::Cylinder { radius: 1e-6, half_height: 1e3 },
            Convex::Capsule { radius: 1e-6, half_height: 1e3 },
            Convex::Hull { points: vec![dvec3(1.0, 2.0, 3.0), DVec3::ZERO, dvec3(0.1, 5.0, -2.0)] },
        ];
        for shape in &shapes {
            for g in
                [dvec3(0.3, 0.4, -0.9), dvec3(-1.0, 7.0, 0.1), dvec3(1.0, -0.01, 0.01), DVec3::Y, -DVec3::X]
            {
                let point = shape.support(Vec3::from_f64(g));
                let inside = shape.proven_inside(point).expect("a support point is inside up to rounding");
                let g = ExactVec3::from_f64(g);
                let missing = &shape.support_value_up(&g) - &inside.dot(&g);
                assert!(missing.sign() >= 0 && missing.round_up() < 1e-25, "{shape:?} {g:?}");
            }
        }
    }
}
