//! The closest points of a ball and a triangle, in closed form.

use glam::DVec3;
use solid_convex::simd::each;
use solid_convex::{Closest, Witness};

use super::super::direct::Round;
use super::super::frame::Frame;
use super::super::row::CONFIRMED;
use super::super::triangle_triangle::Triangle;
use super::CLEARLY_APART;

/// The closest points of a triangle in its own space, the first of the frame, and a ball, the second; a common point of what overlaps.
/// `None` of what is no ball, where GJK has to say whether they touch, and where rounding hides which point of a sliver is the closest.
pub(super) fn closest_points(triangle: &Triangle, round: &Round, frame: &Frame) -> Option<Closest> {
    let center = round.center()?;
    let placed = each(*triangle, |corner| frame.common[0].transform_point3(corner));
    let at = nearest_to(center, &placed);
    let way = center - point_at(&placed, at);
    let length = way.length();
    let gap = length - round.radius;
    let to_surface = if gap > CLEARLY_APART {
        is_confirmed(&placed, center, way, length).then_some(round.radius / length)?
    } else {
        // The point is in the ball.
        (gap < -CLEARLY_APART).then_some(1.0)?
    };
    let on_b = round.local_ends[0] - round.at.local(way * to_surface);
    Some(Closest {
        distance: gap.max(0.0) / frame.scale,
        points: Witness { on_a: point_at(triangle, at), on_b },
    })
}

/// Whether the way from a triangle to a point is the shortest, or no longer by what rounding hides: the plane across it bounds the distance from below.
pub(in super::super) fn is_confirmed(triangle: &Triangle, point: DVec3, way: DVec3, length: f64) -> bool {
    let heights = each(*triangle, |corner| way.dot(point - corner));
    let least = heights[0].min(heights[1]).min(heights[2]) / length;
    length - least <= CONFIRMED
}

/// The point of a triangle that is nearest to another, by how far it is from the first corner along the edges to the second and the third
/// (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5).
pub(in super::super) fn nearest_to(point: DVec3, [p, q, r]: &Triangle) -> [f64; 2] {
    let (pq, pr) = (*q - *p, *r - *p);
    let [(p1, p2), (q1, q2), (r1, r2)] = each([p, q, r], |corner| {
        let way = point - *corner;
        (pq.dot(way), pr.dot(way))
    });
    if p1 <= 0.0 && p2 <= 0.0 {
        return [0.0, 0.0];
    }
    if q1 >= 0.0 && q2 <= q1 {
        return [1.0, 0.0];
    }
    if r2 >= 0.0 && r1 <= r2 {
        return [0.0, 1.0];
    }
    // Areas of the triangles that the foot of the perpendicular spans with the edges, each opposite of a corner.
    let (of_r, of_q, of_p) = (p1 * q2 - q1 * p2, r1 * p2 - p1 * r2, q1 * r2 - r1 * q2);
    if of_r <= 0.0 && p1 >= 0.0 && q1 <= 0.0 {
        return [p1 / (p1 - q1), 0.0];
    }
    if of_q <= 0.0 && p2 >= 0.0 && r2 <= 0.0 {
        return [0.0, p2 / (p2 - r2)];
    }
    let (beyond_q, beyond_r) = (q2 - q1, r1 - r2);
    if of_p <= 0.0 && beyond_q >= 0.0 && beyond_r >= 0.0 {
        let t = beyond_q / (beyond_q + beyond_r);
        return [1.0 - t, t];
    }
    let inverse = 1.0 / (of_p + of_q + of_r);
    // Rounding may have hidden beyond which edge of a sliver the point is.
    let s = (of_q * inverse).clamp(0.0, 1.0);
    [s, (of_r * inverse).clamp(0.0, 1.0 - s)]
}

/// The point of a triangle that is so far from the first corner along the edges to the second and the third.
#[inline(always)]
pub(in super::super) fn point_at([p, q, r]: &Triangle, [s, t]: [f64; 2]) -> DVec3 {
    *p + (*q - *p) * s + (*r - *p) * t
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3};
    use rand::Rng;
    use solid_convex::gjk::TOUCHING_ERROR;
    use solid_convex::{Sphere, Support};
    use solid_oracle::generate::{in_cube, seeded};
    use solid_oracle::triangle_distance;

    use super::super::super::direct::Direct;
    use super::*;

    /// Law: where there is an answer it is right, for slivers and degenerate triangles, under any affine map of the triangle, at any size:
    /// the distance, and that each point is in its object and they are as far apart. Little is left to GJK but what all but touches, or is thin.
    #[test]
    fn closest_points_are_right_where_they_are_said() {
        let seed = 140;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let [mut apart, mut overlapping, mut open, mut open_of_wide] = [0; 4];
        for case in 0..20_000 {
            let size = 10f64.powi(rng.random_range(-60..60));
            let mut point = || size * in_cube(&mut rng);
            let (p, q, r) = (point(), point(), point());
            let (is_wide, triangle) = match case % 8 {
                0 => (false, [p, q, p.lerp(q, 0.3) + 1e-8 * r]),
                1 => (false, [p, p + 1e-12 * q, r]),
                2 => (false, [p, q, q]),
                3 => (false, [p, p, p]),
                _ => (true, [p, q, r]),
            };
            let radius = size * 10f64.powf(rng.random_range(-3.0..0.3));
            let ball = Sphere::new(radius).expect("it has a size");
            let turn = DMat3::from_quat(glam::DQuat::from_rotation_arc(
                in_cube(&mut rng).normalize(),
                in_cube(&mut rng).normalize(),
            ));
            let stretch = if case % 3 == 0 { DVec3::new(1.0, 20.0, 0.1) } else { DVec3::ONE };
            let at_triangle = DAffine3 {
                matrix3: turn * DMat3::from_diagonal(stretch),
                translation: size * in_cube(&mut rng),
            };
            let near = at_triangle.transform_point3((p + q + r) / 3.0);
            let at_ball = DAffine3 {
                matrix3: turn.transpose() * 0.7,
                translation: near + [2.0 * size, radius][case % 2] * in_cube(&mut rng),
            };
            let reach = triangle.iter().fold(DVec3::ZERO, |most, corner| most.max(corner.abs()));
            let frame = Frame::new(&at_triangle, reach, &at_ball, ball.reach());
            let Direct::Round(round) = Direct::round(&ball, &frame) else { panic!("it is round") };

            let placed = triangle.map(|corner| frame.common[0].transform_point3(corner));
            let center = frame.common[1].translation;
            let exact = triangle_distance(&[center; 3], &placed) - frame.scale * 0.7 * radius;
            let Some(Closest { distance, points }) = closest_points(&triangle, &round, &frame) else {
                open += 1;
                open_of_wide +=
                    usize::from(is_wide && stretch == DVec3::ONE && exact.abs() > 2.0 * CLEARLY_APART);
                continue;
            };
            let told = distance * frame.scale;
            assert!((told - exact.max(0.0)).abs() <= TOUCHING_ERROR, "case {case}: {told} for {exact}");
            assert_eq!(distance > 0.0, exact > 0.0, "case {case}");
            let [on_a, on_b] = [(0, points.on_a), (1, points.on_b)]
                .map(|(i, point)| frame.common[i].transform_point3(point));
            assert!((on_a.distance(on_b) - told).abs() <= TOUCHING_ERROR, "case {case}");
            assert!(triangle_distance(&[on_a; 3], &placed) <= TOUCHING_ERROR, "case {case}");
            assert!(points.on_b.length() <= radius + TOUCHING_ERROR / frame.scale, "case {case}");
            apart += usize::from(distance > 0.0);
            overlapping += usize::from(distance == 0.0);
        }
        println!("{apart} are apart, {overlapping} overlap; {open} are open, of wide ones {open_of_wide}");
        assert!(apart > 10_000 && overlapping > 3000 && open < 400 && open_of_wide < 50);
    }

    /// What a placement does not leave round, and what is no ball, is for GJK.
    #[test]
    fn what_is_no_ball_is_left_open() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let away = DVec3::Z * 5.0;
        let capsule = solid_convex::Capsule::new(0.5, 1.0).expect("it has a size");
        let frame =
            Frame::new(&DAffine3::IDENTITY, DVec3::ONE, &DAffine3::from_translation(away), capsule.reach());
        let Direct::Round(round) = Direct::round(&capsule, &frame) else { panic!("it is round") };
        assert!(closest_points(&triangle, &round, &frame).is_none());
    }
}
