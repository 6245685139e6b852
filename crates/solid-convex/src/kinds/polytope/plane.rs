//! The planes of the faces of a polytope.

use glam::DVec3;

use crate::determinant::difference_of_products;
use crate::unit_scale;

/// The plane of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub corner: DVec3,
    /// Its unit normal.
    pub inward: DVec3,
    /// By how much the normal may be off.
    pub error: f64,
}

impl Plane {
    /// Those of triangles of points, counter-clockwise seen from outside.
    pub fn all(points: &[DVec3], faces: &[[u32; 3]]) -> Vec<Plane> {
        faces.iter().map(|face| Plane::of(face.map(|i| points[i as usize]))).collect()
    }

    /// That of a triangle, counter-clockwise seen from outside. Which side is the inner one is not told by a point of the hull: the mean of
    /// corners, as it is rounded, may be off what is flat.
    fn of(corners: [DVec3; 3]) -> Plane {
        /// The error of a normal, which turns the plane about the corner: some roundings, and of a sliver the squares of these in its edges, over the sine
        /// of its angle.
        const NORMAL_ERROR: f64 = 8.0 * f64::EPSILON;
        const SLIVER_ERROR: f64 = 16.0 * f64::EPSILON * f64::EPSILON;
        /// Products that lose no digits, in a unit near the length of the longest edge.
        const PLAIN_MIN: f64 = 1e-200;
        // From the corner that is opposite to the longest edge, at which the error is least.
        let opposite = |k: usize| corners[(k + 1) % 3].distance_squared(corners[(k + 2) % 3]);
        let widest = (1..3).fold(0, |widest, k| if opposite(k) > opposite(widest) { k } else { widest });
        let [p, q, r] = [0, 1, 2].map(|k| corners[(widest + k) % 3]);
        let edges = [q - p, r - p];
        let scale = unit_scale(edges[0].abs().max_element().max(edges[1].abs().max_element()));
        let [lost_q, lost_r] = [(q, edges[0]), (r, edges[1])].map(|(to, edge)| lost(to, p, edge) * scale);
        let [q, r] = edges.map(|edge| edge * scale);
        let normal = cross(r, q) + (r.cross(lost_q) + lost_r.cross(q));
        let (length, product) = (normal.length(), q.length() * r.length());
        let error =
            if length > PLAIN_MIN { NORMAL_ERROR + SLIVER_ERROR * product / length } else { f64::INFINITY };
        Plane { corner: p, inward: normal / length, error }
    }

    /// How far a point is above it, at least. Below any point of a sliver without a plane to speak of.
    pub fn height(&self, point: DVec3) -> f64 {
        let way = point - self.corner;
        // Of what is no number, that it is lowest.
        (self.inward.dot(way) - self.error * way.abs().element_sum()).max(f64::NEG_INFINITY)
    }
}

/// What a difference lost by rounding (Knuth, *The Art of Computer Programming*, volume 2, section 4.2.2).
fn lost(to: DVec3, from: DVec3, difference: DVec3) -> DVec3 {
    let of_from = to - difference;
    let of_to = difference + of_from;
    (to - of_to) - (from - of_from)
}

/// A cross product that is exact to two roundings in each coordinate, however much of its products cancels.
fn cross(u: DVec3, v: DVec3) -> DVec3 {
    DVec3::new(
        difference_of_products(u.y, v.z, u.z, v.y),
        difference_of_products(u.z, v.x, u.x, v.z),
        difference_of_products(u.x, v.y, u.y, v.x),
    )
}

#[cfg(test)]
mod tests {
    use solid_oracle::generate::{in_cube, seeded};

    use super::*;

    /// Law: the corners of a triangle are in its plane, however thin it is and however far from the origin, and the normal is as exact as it says.
    #[test]
    fn corners_are_in_the_plane() {
        let mut rng = seeded(50);
        for case in 0..20_000 {
            let (p, along, aside) = (in_cube(&mut rng), in_cube(&mut rng), in_cube(&mut rng));
            let far = in_cube(&mut rng) * [0.0, 1e3][case % 2];
            // Flat at any of its corners.
            let middle = p + along * in_cube(&mut rng).x.abs() + aside * 10f64.powi(-(case as i32 / 2 % 12));
            let mut corners = [p, p + along, middle].map(|corner| corner + far);
            corners.rotate_left(case / 24 % 3);
            let plane = Plane::of(corners);
            let longest = (corners[1] - corners[0]).length().max((corners[2] - corners[0]).length());
            for corner in corners {
                let height = plane.inward.dot(corner - plane.corner);
                assert!(height.abs() <= plane.error * 2.0 * longest, "{case}: {height:e}, {plane:?}");
            }
            assert!(plane.error < 1e-14, "{case}: {plane:?}");
        }
    }

    /// Law: the normal is as exact as it says, also of a sliver, and where the difference of two corners is no number that is exact.
    #[test]
    fn normals_are_as_exact_as_they_say() {
        let mut rng = seeded(51);
        let whole = |v: DVec3| v.to_array().map(|x| x as i128);
        for case in 0..20_000 {
            let size = 2f64.powi(52);
            let (p, q) = ((in_cube(&mut rng) * size).round(), (in_cube(&mut rng) * size * 1.9).round());
            let aside = in_cube(&mut rng) * 2f64.powi(case % 52);
            let mut corners = [p, q, (p.lerp(q, in_cube(&mut rng).x.abs()) + aside).round()];
            corners.rotate_left(case as usize / 52 % 3);
            let plane = Plane::of(corners);
            let [p, q, r] = corners.map(whole);
            let [u, v] = [q, r].map(|to| [0, 1, 2].map(|k| to[k] - p[k]));
            // Inward: against the side from which they run counter-clockwise.
            let exact = [0, 1, 2].map(|k| {
                let (l, m) = ((k + 1) % 3, (k + 2) % 3);
                (v[l] * u[m] - v[m] * u[l]) as f64
            });
            let exact = DVec3::from_array(exact);
            if exact != DVec3::ZERO {
                let off = plane.inward.distance(exact.normalize());
                assert!(off <= plane.error, "{case}: {off:e}, {plane:?}");
            }
        }
    }
}
