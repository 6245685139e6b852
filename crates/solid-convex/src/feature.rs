//! Edges, faces and tetrahedra seen from the origin: where on them is the point closest to it, or on which side of them is it?

use glam::DVec3;

/// The faces of a tetrahedron, each with the vertex opposite. The first three have the newest vertex.
pub(crate) const FACES: [([usize; 3], usize); 4] =
    [([0, 1, 3], 2), ([1, 2, 3], 0), ([2, 0, 3], 1), ([0, 1, 2], 3)];

/// A bound on the error of six times a volume as the sum of four triple products, and of each of these: coordinates are below 4,
/// so that each of the 24 products of three is below 64, and takes part in less than 12 roundings of 2^-53.
pub(crate) const VOLUME_ERROR: f64 = 24.0 * 64.0 * 12.0 / (1u64 << 53) as f64;

/// The square of the sine of the angle between two edges, beyond which their product is as good a normal as that of the two
/// shortest edges: none of the three edges is then less than a quarter of the shorter of the two.
pub(crate) const SLIVER_SINE_SQUARED: f64 = 1.0 / 16.0;

/// The point of an edge closest to the origin, with the weights of its ends; or the end that it is at, 0 or 1.
#[inline]
pub(crate) fn within_edge([p, q]: [DVec3; 2]) -> Result<(DVec3, [f64; 2]), usize> {
    let pq = q - p;
    let (from_p, from_q) = (-p.dot(pq), q.dot(pq));
    if from_p <= 0.0 {
        return Err(0);
    }
    if from_q <= 0.0 {
        return Err(1);
    }
    let t = from_p / pq.length_squared();
    let v = perpendicular(if p.length_squared() <= q.length_squared() { p } else { q }, pq);
    Ok((v, [1.0 - t, t]))
}

/// Where the closest point of a face is.
pub(crate) enum Within {
    /// Inside of it: the point, and the weights of the corners.
    Face(DVec3, [f64; 3]),
    /// Beyond the edge opposite this corner: of two such edges, the one that is further away, on which the closest point is if it is no corner.
    Beyond(usize),
    /// Not known: the face is too thin for the usual means.
    Sliver,
}

/// The point of a face closest to the origin, to which its first corner should be the nearest. It is a sliver if the squared sine of the angle there
/// is at most this: the error of what is found is that of rounding over the sine.
#[inline(always)]
pub(crate) fn within_face([p, q, r]: [DVec3; 3], sliver_sine_squared: f64) -> Within {
    let (pq, pr) = (q - p, r - p);
    let n = pq.cross(pr);
    let n_squared = n.length_squared();
    if n_squared <= sliver_sine_squared * pq.length_squared() * pr.length_squared() {
        return Within::Sliver;
    }
    // -p = y pq + z pr + an offset along n; all times n^2.
    let across = p.cross(n);
    let (y, z) = (pr.dot(across), -pq.dot(across));
    let x = n_squared - y - z;
    if x > 0.0 && y > 0.0 && z > 0.0 {
        let inverse = 1.0 / n_squared;
        Within::Face(n * (n.dot(p) * inverse), [x * inverse, y * inverse, z * inverse])
    } else {
        Within::Beyond(least([
            x * x.abs() / (r - q).length_squared(),
            y * y.abs() / pr.length_squared(),
            z * z.abs() / pq.length_squared(),
        ]))
    }
}

/// The corner of a tetrahedron opposite the face that has the origin furthest outside, by on which side of each of its [`FACES`] it is: on that face the
/// closest point is, if it is inside of one, since from no face's plane the origin is further away than from the tetrahedron.
#[inline(always)]
pub(crate) fn opposite_of_furthest([p, q, r, s]: [DVec3; 4], sides: [f64; 4]) -> usize {
    let squares =
        [(q, r, s), (p, r, s), (p, q, s), (p, q, r)].map(|(p, q, r)| (q - p).cross(r - p).length_squared());
    let [pqs, qrs, rps, pqr] = sides.map(|side| side * side.abs());
    least([qrs / squares[0], rps / squares[1], pqs / squares[2], pqr / squares[3]])
}

/// The index of the least number.
#[inline(always)]
fn least<const N: usize>(numbers: [f64; N]) -> usize {
    let mut index = 0;
    for k in 1..N {
        index = if numbers[k] < numbers[index] { k } else { index };
    }
    index
}

/// On which side of each of the [`FACES`] of a tetrahedron the origin is, and the least magnitude of these and of the volume: for a
/// single branch. When it is more than [`VOLUME_ERROR`], all signs are right.
#[inline(always)]
pub(crate) fn sides_of_origin([p, q, r, s]: [DVec3; 4]) -> ([f64; 4], f64) {
    let (pq, qr, rp) = (p.cross(q), q.cross(r), r.cross(p));
    let parts = [-pq.dot(s), -qr.dot(s), -rp.dot(s), pq.dot(r)];
    let volume = parts[0] + parts[1] + parts[2] + parts[3];
    let sign = 1f64.copysign(volume);
    let [a, b, c, d] = parts;
    let least = a.abs().min(b.abs()).min(c.abs().min(d.abs())).min(volume.abs());
    ([a * sign, b * sign, c * sign, d * sign], least)
}

/// The weights of the corners of a tetrahedron in the origin, by on which side of each of its [`FACES`] that is.
#[inline(always)]
pub(crate) fn weights_of_origin(sides: [f64; 4]) -> [f64; 4] {
    let inverse = 1.0 / (sides[0] + sides[1] + sides[2] + sides[3]);
    // Of each corner the side of the face opposite.
    [sides[1] * inverse, sides[2] * inverse, sides[0] * inverse, sides[3] * inverse]
}

/// The point closest to the origin on the line through `p` along `edge`. `p` should be the nearer end of the edge, whose
/// rounding error is the smaller.
///
/// Projected twice: where the line passes the origin closely, once leaves a part along the edge that is small to the edge
/// but large to the result, and the result would not be the separating axis that it should.
pub(crate) fn perpendicular(p: DVec3, edge: DVec3) -> DVec3 {
    let along = |p: DVec3| edge * (p.dot(edge) / edge.length_squared());
    let v = p - along(p);
    v - along(v)
}

/// The normal of a triangle, from the edges that lead around it.
///
/// From the two shortest: in a sliver the two long edges are nearly parallel, and their product is tilted along them. Where all three
/// are, so is that of any two: what of it is along the longest is taken off.
pub(crate) fn normal([pq, qr, rp]: [DVec3; 3]) -> DVec3 {
    let [a, b, c] = [pq, qr, rp].map(|edge| edge.length_squared());
    if a >= b && a >= c {
        perpendicular(qr.cross(rp), pq)
    } else if b >= c {
        perpendicular(rp.cross(pq), qr)
    } else {
        perpendicular(pq.cross(qr), rp)
    }
}

#[cfg(test)]
mod tests {
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::testing::in_cube;

    /// Law: what the closest point is said to be beyond has it, when it is inside of a face of a tetrahedron, or of an edge of a face.
    #[test]
    fn the_furthest_plane_has_the_closest_point() {
        let mut rng = seeded(61);
        let (mut on_faces, mut on_edges) = (0, 0);
        for case in 0..4000 {
            let corners = [(); 4].map(|()| in_cube(&mut rng) + 0.4 * DVec3::X);
            let [p, q, r, s] = corners;
            let (sides, _) = sides_of_origin(corners);
            let inside = |corner: usize| {
                let face = [[q, r, s], [p, r, s], [p, q, s], [p, q, r]][corner];
                match within_face(face, 0.0) {
                    Within::Face(v, _) => {
                        corners.iter().all(|&w| v.dot(w) >= v.length_squared() * (1.0 - 1e-9))
                    }
                    _ => false,
                }
            };
            if let Some(corner) = (0..4).find(|&corner| inside(corner)) {
                assert_eq!(opposite_of_furthest(corners, sides), corner, "{case}: {corners:?}");
                on_faces += 1;
            }
            if let Within::Beyond(corner) = within_face([p, q, r], 0.0) {
                let nearest = [[q, r], [p, r], [p, q]].map(|edge| within_edge(edge).map(|(v, _)| v));
                let inside = (0..3).find(|&i| {
                    let others = [p, q, r];
                    nearest[i].is_ok_and(|v| v.dot(others[i]) >= v.length_squared() * (1.0 - 1e-9))
                });
                assert!(inside.is_none_or(|inside| inside == corner), "{case}: {corners:?}");
                on_edges += usize::from(inside.is_some());
            }
        }
        assert!(on_faces > 400 && on_edges > 400, "{on_faces} and {on_edges} of 4000: not representative");
    }
}
