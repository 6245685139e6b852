//! Whether a mesh is closed.

use std::collections::HashMap;

use solid3d::glam::DVec3;

/// How many edges of a mesh are open: not shared by exactly two triangles that run through them in opposite directions.
/// Vertices at equal positions count as one, and triangles with two of them as none. A mesh without open edges is closed.
///
/// Cost: O(n log n).
pub fn open_edges(vertices: &[DVec3], triangles: &[[u32; 3]]) -> usize {
    let welded = weld(vertices);
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| welded[vertex as usize]);
        if a != b && b != c && c != a {
            edges.extend([(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q), p < q)));
        }
    }
    edges.sort_unstable();
    edges.chunk_by(|e, f| (e.0, e.1) == (f.0, f.1)).filter(|uses| !is_shared_by_two(uses)).count()
}

/// Two uses, the backward one sorted first.
fn is_shared_by_two(uses: &[(u32, u32, bool)]) -> bool {
    matches!(uses, [(_, _, false), (_, _, true)])
}

/// For each vertex, the number of the first at its position.
fn weld(vertices: &[DVec3]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(vertices.len());
    // Adding 0 makes -0 and 0 the same bits.
    let bits = |v: &DVec3| v.to_array().map(|x| (x + 0.0).to_bits());
    (0..).zip(vertices).map(|(i, v)| *first.entry(bits(v)).or_insert(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_tetrahedron_is_closed_and_without_a_side_it_is_not() {
        assert_eq!(open_edges(&CORNERS, &TETRAHEDRON), 0);
        assert_eq!(open_edges(&CORNERS, &TETRAHEDRON[1..]), 3);
    }

    #[test]
    fn a_side_turned_over_opens_its_edges() {
        let mut turned = TETRAHEDRON;
        turned[0].swap(0, 1);
        assert_eq!(open_edges(&CORNERS, &turned), 3);
    }

    #[test]
    fn vertices_at_one_position_are_one() {
        let soup: Vec<DVec3> = TETRAHEDRON.iter().flatten().map(|&i| CORNERS[i as usize]).collect();
        let triangles: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        assert_eq!(open_edges(&soup, &triangles), 0);
        let mut negative_zero = soup;
        negative_zero[0] = -negative_zero[0];
        assert_eq!(open_edges(&negative_zero, &triangles), 0);
    }

    #[test]
    fn an_edge_of_three_triangles_is_open() {
        let mut fins = TETRAHEDRON.to_vec();
        fins.push([0, 1, 4]);
        let mut corners = CORNERS.to_vec();
        corners.push(-DVec3::Z);
        assert_eq!(open_edges(&corners, &fins), 3);
    }

    #[test]
    fn triangles_without_area_for_want_of_corners_do_not_count() {
        let mut more = TETRAHEDRON.to_vec();
        more.push([0, 1, 1]);
        assert_eq!(open_edges(&CORNERS, &more), 0);
        assert_eq!(open_edges(&[], &[]), 0);
    }
}
