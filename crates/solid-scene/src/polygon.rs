//! Triangulating the polygons of mesh files.

use earcut::Earcut;
use glam::DVec3;

/// The most corners of a polygon that is cut by ears, which takes quadratic time at worst; larger ones become fans.
const EARCUT_CORNERS_MAX: usize = 10_000;

/// How far a triangle of a fan may face the wrong way and still count as rounding, relative to the polygon's area.
const FOLD_TOLERANCE: f64 = 1e-9;

/// Triangulates a polygon over vertices that are there. The triangles name the polygon's own corners.
///
/// Three corners or more give a fan around the first, unless a triangle of the fan would be folded over, facing against
/// the polygon: then ears are cut, in the plane of the polygon's area vector. Fewer corners give nothing.
pub(crate) fn triangulate(corners: &[u32], vertices: &[DVec3], triangles: &mut Vec<[u32; 3]>) {
    let may_cut = corners.len() > 3 && corners.len() <= EARCUT_CORNERS_MAX;
    match may_cut.then(|| ears_where_folded(corners, vertices)).flatten() {
        Some(ears) => triangles.extend(ears),
        None => triangles.extend(fan(corners)),
    }
}

fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]])
}

/// Ears, when the fan is folded and ears can be cut.
fn ears_where_folded(corners: &[u32], vertices: &[DVec3]) -> Option<Vec<[u32; 3]>> {
    let at = |i: u32| vertices[i as usize];
    let area = |[a, b, c]: [u32; 3]| (at(b) - at(a)).cross(at(c) - at(a));
    let normal: DVec3 = fan(corners).map(area).sum();
    let limit = -FOLD_TOLERANCE * normal.length_squared();
    if !fan(corners).any(|triangle| area(triangle).dot(normal) < limit) {
        return None;
    }
    let normal = normal.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    let plane = corners.iter().map(|&i| at(i) - at(corners[0])).map(|p| [p.dot(u), p.dot(v)]);
    let mut ears: Vec<u32> = Vec::new();
    Earcut::new().earcut(plane, &[], &mut ears);
    let named = ears.chunks_exact(3).map(|ear| [0, 1, 2].map(|i| corners[ear[i] as usize]));
    Some(named.collect()).filter(|ears: &Vec<_>| !ears.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangulated(vertices: &[DVec3]) -> Vec<[u32; 3]> {
        let corners: Vec<u32> = (0..vertices.len() as u32).collect();
        let mut triangles = Vec::new();
        triangulate(&corners, vertices, &mut triangles);
        triangles
    }

    fn area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let at = |i: u32| vertices[i as usize];
        triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)).length() / 2.0).sum()
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        assert_eq!(triangulated(&square), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(triangulated(&square[..2]), [[0; 3]; 0]);
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        // An arrowhead whose first corner does not see the third: the fan would cover 2 + 1 instead of 1.
        let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0)].map(|(x, z)| DVec3::new(x, 5.0, z));
        for turn in 0..4 {
            let mut arrow = arrow;
            arrow.rotate_left(turn);
            let triangles = triangulated(&arrow);
            assert_eq!(triangles.len(), 2);
            assert!((area(&arrow, &triangles) - 1.0).abs() < 1e-12, "{turn}: {triangles:?}");
        }
    }

    #[test]
    fn degenerate_polygons_survive() {
        assert_eq!(triangulated(&[DVec3::ONE; 5]).len(), 3);
        let bow = [DVec3::ZERO, DVec3::ONE, DVec3::X, DVec3::Y + DVec3::Z];
        assert!(!triangulated(&bow).is_empty());
    }
}
