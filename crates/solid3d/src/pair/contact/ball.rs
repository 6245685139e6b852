//! How a ball and a triangle lie to each other, in closed form.

use glam::DVec3;

use super::super::complex_convex::{is_confirmed, nearest_to, point_at};
use super::super::triangle_triangle::Triangle;

/// A centre nearer to the triangle than this, in the unit of the pair, has a way to it with few digits.
const WAY_MIN: f64 = 1e-6;

/// The shortest way of a body out of a triangle. Space: common.
pub(super) struct Way {
    /// A unit vector.
    pub out: DVec3,
    /// Negative for a gap.
    pub depth: f64,
    /// The point of the triangle that the body leaves last; of a ball it is the nearest to the centre.
    pub foot: DVec3,
}

/// The way from a triangle to the centre of a ball that is not on it. `None` where rounding hides which point of a sliver is the closest, and where the
/// centre is on it. Space: common.
pub(super) fn way(triangle: &Triangle, center: DVec3, radius: f64) -> Option<Way> {
    let foot = point_at(triangle, nearest_to(center, triangle));
    let way = center - foot;
    let length = way.length();
    if length < WAY_MIN {
        return None;
    }
    is_confirmed(triangle, center, way, length).then_some(Way {
        out: way / length,
        depth: radius - length,
        foot,
    })
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use rand::Rng;
    use solid_convex::{Points, Sphere, epa, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    use super::*;

    /// Law: where there is an answer it is that of EPA, or of GJK where they are apart; slivers among the triangles. Few are left open but slivers.
    #[test]
    fn the_way_is_that_of_the_searches() {
        let mut rng = seeded(150);
        let (mut meeting, mut open) = (0, 0);
        for case in 0..6_000 {
            let [p, q, r] = [(); 3].map(|()| in_cube(&mut rng));
            let triangle = if case % 4 == 0 { [p, q, p.lerp(q, 0.3) + 1e-7 * r] } else { [p, q, r] };
            let (center, radius) = (in_cube(&mut rng), rng.random_range(0.01..1.4));
            let Some(Way { out, depth, foot }) = way(&triangle, center, radius) else {
                open += usize::from(case % 4 != 0);
                continue;
            };
            let (ball, corners) =
                (Sphere::new(radius).expect("it has a size"), Points::new(&triangle).expect("points"));
            let (at, here) = (DAffine3::from_translation(center), DAffine3::IDENTITY);
            let context = format!("case {case}: {triangle:?}, {center}, {radius}");
            assert!(
                (out.length() - 1.0).abs() < 1e-14
                    && (foot + out * (radius - depth) - center).length() < 1e-14
            );
            if depth > 1e-9 {
                meeting += 1;
                let found = epa::penetration(&ball, &at, &corners, &here).expect("they meet");
                assert!((found.depth - depth).abs() < 1e-11, "{context}: {found:?}, {depth}");
                assert!((found.points.on_b - foot).length() < 1e-5, "{context}: {found:?}, {foot}");
            } else if depth < -1e-9 {
                let found = gjk::closest_points(&ball, &at, &corners, &here);
                assert!((found.distance + depth).abs() < 1e-11, "{context}: {found:?}, {depth}");
            }
        }
        assert!((2_000..5_000).contains(&meeting) && open < 10, "{meeting} meet, {open} open");
    }
}
