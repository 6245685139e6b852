//! Where the surface of an ellipsoid, which a ball is that its placement stretches, is nearest to a point.
//!
//! Along its principal axes, half of which are `e`, the foot of a point `y` is at `e² y / (t + e²)`, with the `t` for which that is on the surface and all
//! that is divided by is positive: no other place is nearer (Eberly, *Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid*, 2013). Sought is
//! not `t` but how far it is above the first pole, so that no digits are lost near the plane of the two longer axes.

use glam::{DMat3, DVec3};
use solid_convex::{Penetration, Witness, unit_scale};

use super::foot::Foot;
use super::quick::DISTANCE_ERROR;
use super::similarity::{Similarity, to_body, to_world};
use super::{GAP_MIN, Lengths};
use crate::pair::{Mirror, Placed};
use crate::shape::ShapeKind;

/// How many times as long as the shortest axis the longest may be.
const RATIO_MAX: f64 = 1e4;

/// The least half axis, so that squares keep their digits.
const HALF_MIN: f64 = 1e-60;

/// A coordinate this near to zero, beside the longest axis, is on one side as well as on the other: some is chosen.
const MIDDLE: f64 = 1e-18;

/// What is this near to the surface of the ball is on it: some roundings.
const SAME: f64 = 16.0 * f64::EPSILON;

/// Rotations bring axes to right angles in some five sweeps, and Newton's method finds a foot in some five steps.
const SWEEPS_MAX: usize = 24;
const STEPS_MAX: usize = 64;

/// An ellipsoid around the origin.
pub(in crate::pair) struct Ellipsoid {
    /// The directions of the principal axes, and half their lengths.
    axes: DMat3,
    half: DVec3,
}

impl Ellipsoid {
    /// The image of a ball of radius one. `None` of one that is too long, or too small.
    pub fn new(linear: &DMat3) -> Option<Ellipsoid> {
        let (axes, half) = principal_axes(linear);
        let least = half.min_element();
        (least >= HALF_MIN && half.max_element() <= RATIO_MAX * least).then_some(Ellipsoid { axes, half })
    }

    /// Where the surface is nearest to a point. `None` where the search finds no end.
    pub fn foot(&self, point: DVec3) -> Option<Foot<DVec3>> {
        let Ellipsoid { axes, half } = *self;
        let point = to_body(&axes, point);
        let least = half.min_element();
        let poles = (half - least) * (half + least);
        let scaled = half * point.abs().max(DVec3::splat(MIDDLE * half.max_element()));
        // By one coordinate alone it would be that far above; Newton's method on one over a length goes up from there, and not too far.
        let least_above = (scaled - poles).max_element();
        let mut above = least_above;
        for _ in 0..STEPS_MAX {
            let on_ball = scaled / (above + poles);
            let square = on_ball.length_squared();
            let length = square.sqrt();
            if (length - 1.0).abs() <= SAME {
                let on_ball = (on_ball / length).copysign(point);
                let (at, normal) = (half * on_ball, (on_ball / half).normalize());
                let distance = normal.dot(point - at);
                return Some(Foot { distance, normal: to_world(&axes, normal), at: to_world(&axes, at) });
            }
            let slope = (on_ball * on_ball / (above + poles)).element_sum();
            above = (above + (length - 1.0) * square / slope).max(least_above);
        }
        None
    }
}

/// The principal axes of the image of a ball of radius one, as unit vectors, and half their lengths: by rotations of the rows of its map until they are at
/// right angles (Hestenes, *Inversion of Matrices by Biorthogonalization*, 1958), which keep the digits of the shortest.
fn principal_axes(linear: &DMat3) -> (DMat3, DVec3) {
    let (mut rows, mut axes) = (linear.transpose().to_cols_array_2d().map(DVec3::from), DVec3::AXES);
    for _ in 0..SWEEPS_MAX {
        let mut turned = false;
        for [i, j] in [[0, 1], [0, 2], [1, 2]] {
            let product = rows[i].dot(rows[j]);
            let (square_i, square_j) = (rows[i].length_squared(), rows[j].length_squared());
            if product.abs() <= f64::EPSILON * (square_i * square_j).sqrt() {
                continue;
            }
            let cotangent = (square_j - square_i) / (2.0 * product);
            let tangent = 1f64.copysign(cotangent) / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            let sine = cosine * tangent;
            for vectors in [&mut rows, &mut axes] {
                let [of_i, of_j] = [vectors[i], vectors[j]];
                (vectors[i], vectors[j]) = (of_i * cosine - of_j * sine, of_i * sine + of_j * cosine);
            }
            turned = true;
        }
        if !turned {
            break;
        }
    }
    (DMat3::from_cols(axes[0], axes[1], axes[2]), DVec3::from(rows.map(DVec3::length)))
}

/// How deep a ball, or a point, and an ellipsoid are in each other. `None` for other shapes, and where EPA has to say.
pub(super) fn penetration(a: Placed, b: Placed) -> Option<Penetration> {
    of_ball(a, b).or_else(|| Some(of_ball(b, a)?.mirrored()))
}

fn of_ball(ball: Placed, ellipsoid: Placed) -> Option<Penetration> {
    let stretched = &ellipsoid.placement.matrix3;
    if ellipsoid.shape.kind() != ShapeKind::Sphere || Similarity::new(stretched).is_some() {
        return None;
    }
    let [radius, own_radius] = [ball.shape.ball_radius()?, ellipsoid.shape.ball_radius()?];
    let at = if radius == 0.0 { Similarity::ONE } else { Similarity::new(&ball.placement.matrix3)? };
    let (radius, linear) = (radius * at.stretch, *stretched * own_radius);
    let offset = ball.placement.translation - ellipsoid.placement.translation;
    let reach = [linear.x_axis, linear.y_axis, linear.z_axis].map(|axis| axis.abs().max_element());
    let unit = unit_scale(radius + reach.iter().sum::<f64>() + offset.abs().element_sum());
    let foot = Ellipsoid::new(&(linear * unit))?.foot(offset * unit)?;
    let depth = radius * unit - foot.distance;
    // The size of the data is less than two.
    let [margin, error] = [2.0 * GAP_MIN, 2.0 * DISTANCE_ERROR];
    let found = (depth > margin).then(|| Penetration {
        depth,
        lower: depth - error,
        upper: depth + error,
        direction: foot.normal,
        points: Witness {
            on_a: at.local(foot.normal * -radius),
            on_b: to_body(stretched, foot.normal).normalize() * own_radius,
        },
    })?;
    Some(found.divided(unit))
}
