//! A body that comes through a triangle by less than the triangle reaches around it, in closed form.
//!
//! Let the body be `d` behind the plane of the triangle, by its deepest point `x`, and let `c` be a point of it that is `d` before the plane. If the triangle
//! has all points of its plane that are no more than `d` from the feet of `x` and of `c`, no way out is shorter than that along its normal: by a direction
//! at an angle `t` from the normal the body is behind a point beside the foot of `x`, or of `c` when `t` is beyond a right angle, by
//! `d (|cos t| + sin t)` or more.

use glam::DVec3;
use solid_convex::simd::each;

use super::super::triangle_triangle::Triangle;
use super::ball::Way;
use super::inside::DEPTH_MIN;
use super::other::Other;

/// The shortest way out of a triangle with a unit normal, along that or its opposite. `None` where it may be another.
pub(super) fn way(triangle: &Triangle, normal: DVec3, other: &Other) -> Option<Way> {
    let [p, q, r] = *triangle;
    let [back, front] = each([-normal, normal], |direction| other.furthest(direction));
    let (behind, beyond) = (normal.dot(p - back), normal.dot(front - p));
    let (depth, out, deepest) =
        if behind <= beyond { (behind, normal, back) } else { (beyond, -normal, front) };
    let center = other.center();
    let height = out.dot(center - p);
    if depth <= DEPTH_MIN || height <= depth {
        return None;
    }
    let before = deepest + (center - deepest) * (2.0 * depth / (height + depth));
    let has_around = |(from, to): (DVec3, DVec3)| {
        let edge = to - from;
        let (inward, room) = (normal.cross(edge), depth * edge.length());
        inward.dot(deepest - from) >= room && inward.dot(before - from) >= room
    };
    [(p, q), (q, r), (r, p)].into_iter().all(has_around).then(|| Way {
        out,
        depth,
        foot: deepest + out * depth,
    })
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DQuat};
    use rand::Rng;
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::face::triangle_normal;
    use super::super::map::Map;
    use super::super::ways::{assert_is_shortest, bodies, support};
    use super::*;

    /// Law: where there is an answer it is within the bounds of EPA, the points are each in their object, and there is one of most bodies that come
    /// through the middle of a triangle.
    #[test]
    fn the_way_out_is_the_shortest() {
        let mut rng = seeded(170);
        for (kind, shape) in bodies(&mut rng).iter().enumerate() {
            let (mut answers, mut through, cases) = (0, 0, 2000);
            for case in 0..cases {
                let triangle = [(); 3].map(|()| in_cube(&mut rng) * 1.5);
                let Some(normal) = triangle_normal(triangle) else { continue };
                let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
                let stretch = DMat3::from_diagonal(DVec3::new(1.0, [1.0, 0.2][case / 2 % 2], 1.0));
                let linear = turn * stretch * rng.random_range(0.1..0.6);
                let support = support(shape);
                // Behind its plane by some thousandths, or anywhere.
                let deepest = linear * support.support(linear.transpose() * normal);
                let part = [rng.random_range(0.0..1.0), rng.random_range(0.0..1.0)];
                let [p, q, r] = triangle;
                let on = p.lerp(q, part[0]).lerp(r, part[1]);
                let behind = normal * [rng.random_range(0.001..0.05), rng.random_range(0.0..1.0)][case % 2];
                let at = DAffine3 { matrix3: linear, translation: on + behind - deepest };
                let map = Map::new(at);
                let other = Other { primitive: 0, support, map: &map, corners: &[], radius: 0.0 };
                through += usize::from(case % 2 == 0);
                let Some(found) = way(&triangle, normal, &other) else { continue };
                answers += usize::from(case % 2 == 0);
                let context = format!("{kind}, case {case}");
                assert_is_shortest(&found, &triangle, support, &at, &context);
                let Way { out, depth, foot } = found;
                assert!(out == normal || out == -normal, "{context}");
                assert!(out.dot(foot - p).abs() < 1e-14, "{context}");
                assert!((foot - out * depth - other.furthest(-out)).length() < 1e-14, "{context}");
            }
            println!("{kind}: {answers} answers of {through}");
            assert!(answers > through / 2, "{kind}: {answers} of {through}");
        }
    }
}
