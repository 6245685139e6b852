//! The one contact of a ball and a convex body that have a closed form, or of two capsules that do not lie along each other: no space around
//! the two is needed for it.

use glam::DVec3;
use smallvec::smallvec;
use solid_convex::Penetration;

use super::super::closed_form::DepthOfBall;
use super::super::{Mirror, Placed, closed_form};
use super::clip::PARALLEL_SINE;
use super::own_feature::own_feature;
use super::{ContactPoint, Feature, Manifold};
use crate::placement::direction;

/// What [`contact`] says of plain sizes. Placements need not have been checked: those of an answer are good.
#[inline(always)]
pub(super) fn quick_contact(a: Placed, b: Placed) -> Option<Manifold> {
    if closed_form::are_round(a, b) {
        return closed_form::by_depth_of_rounds(
            a,
            b,
            #[inline(always)]
            |found| contact_of(a, b, found),
        );
    }
    if a.shape.is_ball() || b.shape.is_ball() { of_ball_and_body(a, b) } else { None }
}

/// The same of a ball and another body, in either order.
#[inline(never)]
fn of_ball_and_body(a: Placed, b: Placed) -> Option<Manifold> {
    let in_order = closed_form::ball_is_first(a, b)?;
    let (ball, body) = if in_order { (a, b) } else { (b, a) };
    closed_form::by_depth_of_ball(
        ball,
        body,
        #[inline(always)]
        |found, own_normal| {
            if in_order {
                contact_of_ball(a, b, true, found, own_normal)
            } else {
                contact_of_ball(a, b, false, &found.mirrored(), own_normal)
            }
        },
    )
}

/// The contact of a ball and a convex body that are in each other, or of two capsules that are; `None` for other shapes,
/// and where the general way has to say.
pub(super) fn contact(a: Placed, b: Placed) -> Option<Manifold> {
    if closed_form::are_round(a, b) {
        return contact_of(a, b, &closed_form::penetration(a, b)?);
    }
    if !(a.shape.is_ball() || b.shape.is_ball()) {
        return None;
    }
    let (in_order, DepthOfBall { found, own_normal }) =
        (closed_form::ball_is_first(a, b)?, closed_form::depth_of_ball(a, b)?);
    contact_of_ball(a, b, in_order, &found, own_normal)
}

/// The same of a ball and another body, by how deep they are in each other, and the outward normal of the body in its own directions there.
#[inline(always)]
fn contact_of_ball(
    a: Placed,
    b: Placed,
    in_order: bool,
    found: &Penetration,
    own_normal: DVec3,
) -> Option<Manifold> {
    let (body, ball) = (if in_order { b } else { a }, Feature::Vertex(0));
    let of_body = own_feature(body.shape, own_normal)?;
    Some(manifold(a, b, found, if in_order { [ball, of_body] } else { [of_body, ball] }))
}

/// That of two balls or capsules, by how deep they are in each other.
#[inline(always)]
fn contact_of(a: Placed, b: Placed, found: &Penetration) -> Option<Manifold> {
    let normal = found.direction;
    let features = [feature(a, -normal)?, feature(b, normal)?];
    if let [Feature::Edge(..), Feature::Edge(..)] = features {
        let [along_a, along_b] =
            [direction(a.placement.matrix3.y_axis)?, direction(b.placement.matrix3.y_axis)?];
        if along_a.cross(along_b).length() < 2.0 * PARALLEL_SINE {
            return None;
        }
    }
    Some(manifold(a, b, found, features))
}

/// In the world.
#[inline(always)]
fn manifold(a: Placed, b: Placed, found: &Penetration, features: [Feature; 2]) -> Manifold {
    let point = ContactPoint {
        point_on_a: a.placement.transform_point3(found.points.on_a),
        point_on_b: b.placement.transform_point3(found.points.on_b),
        depth: found.depth,
        primitives: [0, 0],
        features,
    };
    Manifold { normal: found.direction, points: smallvec![point] }
}

/// What of a shape, whose placement changes no angle, faces a direction of the world.
#[inline(always)] // two calls take a quarter longer
fn feature(of: Placed, facing: DVec3) -> Option<Feature> {
    if of.shape.is_ball() {
        return Some(Feature::Vertex(0));
    }
    let facing = direction(of.placement.matrix3.mul_transpose_vec3(facing))?;
    own_feature(of.shape, facing)
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DQuat};
    use rand::Rng;
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::contacts_at_length;
    use super::*;
    use crate::pair::Scratch;
    use crate::query::{ContactOptions, bounds};
    use crate::shape::Shape;

    /// Law: the contact is that of the general way: the ball as the first and as the second, at any size and place; capsules across and along
    /// each other.
    #[test]
    fn the_contact_is_that_of_the_general_way() {
        let mut rng = seeded(151);
        let ball = Shape::sphere(0.6).unwrap();
        let capsule = Shape::capsule(0.3, 1.0).unwrap();
        let corners = [(); 20].map(|()| in_cube(&mut rng).normalize() * 0.6);
        let pairs = [
            (&ball, &ball),
            (&ball, &capsule),
            (&ball, &Shape::cuboid([1.0, 0.8, 1.2]).unwrap()),
            (&ball, &Shape::cylinder(0.5, 1.0).unwrap()),
            (&ball, &Shape::cone(0.6, 1.2).unwrap()),
            (&capsule, &capsule),
            (&ball, &Shape::convex_hull(&corners).unwrap()),
        ];
        for (kind, (first, second)) in pairs.into_iter().enumerate() {
            let (mut found, cases) = (0, 1000);
            for case in 0..cases {
                let mut unit = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
                let size = 10f64.powi([0, -6, 6, 60, -60][case % 5]);
                let (at, way) = (unit() * 10.0, unit());
                let turn = unit() * [3.0, 3.0, 0.01][case % 3];
                let place = |to: DVec3, scale: f64, turn: DQuat| {
                    DAffine3::from_scale_rotation_translation(DVec3::splat(scale * size), turn, to * size)
                };
                let placements = [
                    place(at, 0.8, DQuat::IDENTITY),
                    place(at + way * 1.2, 1.1, DQuat::from_scaled_axis(turn)),
                ];
                let mut pair = [
                    Placed { shape: first, placement: &placements[0] },
                    Placed { shape: second, placement: &placements[1] },
                ];
                if case % 2 == 0 {
                    pair.reverse();
                }
                let [a, b] = pair;
                let Some(closely) = contact(a, b) else { continue };
                found += 1;
                let general = contacts_at_length(a, b, &ContactOptions::default(), &mut Scratch::default());
                let extent = bounds(a.shape, a.placement).unwrap().max.abs().max_element();
                let near = |x: DVec3, y: DVec3, limit: f64| (x - y).length() <= limit;
                let [general] = &general[..] else { panic!("{kind} {case}: {general:?}") };
                let quickly = quick_contact(a, b);
                assert!(quickly.is_some() || size != 1.0, "{kind} {case}");
                for found in quickly.iter().chain([&closely]) {
                    let ([x], [y]) = (&found.points[..], &general.points[..]) else { panic!("{general:?}") };
                    assert!(near(found.normal, general.normal, 1e-14), "{kind} {case}");
                    assert!(
                        near(x.point_on_a, y.point_on_a, 1e-14 * extent)
                            && near(x.point_on_b, y.point_on_b, 1e-14 * extent)
                    );
                    assert!((x.depth - y.depth).abs() <= 1e-14 * extent, "{kind} {case}");
                    assert_eq!((x.primitives, x.features), (y.primitives, y.features), "{kind} {case}");
                }
            }
            assert!((cases / 8..cases * 4 / 5).contains(&found), "{kind}: {found} of {cases}");
        }
    }
}
