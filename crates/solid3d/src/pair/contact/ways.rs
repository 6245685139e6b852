//! What the tests of closed forms of ways out share.

use glam::{DAffine3, DVec3};
use rand::rngs::StdRng;
use solid_convex::{Points, Support, epa};
use solid_oracle::generate::direction;

use super::super::triangle_triangle::Triangle;
use super::ball::Way;
use crate::shape::{Class, Shape};

/// A body of each kind that is no ball.
pub(super) fn bodies(rng: &mut StdRng) -> [Shape; 5] {
    let points: Vec<DVec3> = (0..20).map(|_| direction(rng)).collect();
    [
        Shape::cuboid([1.2, 1.0, 0.8]),
        Shape::capsule(0.4, 0.8),
        Shape::cylinder(0.6, 1.0),
        Shape::cone(0.8, 1.2),
        Shape::convex_hull(&points),
    ]
    .map(Result::unwrap)
}

pub(super) fn support(body: &Shape) -> &dyn Support {
    let Class::Convex(support) = body.class() else { panic!("a body is convex") };
    support
}

/// Asserts that a way is as long as EPA says, up to its bounds, that it is along a unit vector, and that the body reaches as far against it as the
/// way is long, from the plane across it through the triangle's point.
pub(super) fn assert_is_shortest(
    way: &Way,
    triangle: &Triangle,
    body: &dyn Support,
    at: &DAffine3,
    case: &str,
) {
    let Way { out, depth, foot } = *way;
    let one = Points::new(triangle).unwrap();
    let exact = epa::penetration(body, at, &one, &DAffine3::IDENTITY).expect("they meet");
    let context = format!("{case}: {out}, {depth}, {exact:?}");
    assert!((exact.lower - 1e-12..=exact.upper + 1e-12).contains(&depth), "{context}");
    assert!((out.length() - 1.0).abs() < 1e-14, "{context}");
    let behind = at.transform_point3(body.support(at.matrix3.transpose() * -out));
    assert!((out.dot(foot - behind) - depth).abs() <= 1e-14, "{context}");
}
