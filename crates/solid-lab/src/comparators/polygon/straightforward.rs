use solid3d::glam::DVec3;

use super::{FlatPolygon, closest_axis};

/// Whether two polygons intersect: each edge of one against the other (thesis, section 3.2.1). Cost: O(n^2).
pub fn straightforward(a: &FlatPolygon, b: &FlatPolygon) -> bool {
    a.crossings(b).any(|p| contains(a, p)) || b.crossings(a).any(|p| contains(b, p))
}

/// Whether a polygon contains a point of its plane, by counting how often a ray crosses its chain.
fn contains(polygon: &FlatPolygon, p: DVec3) -> bool {
    let axis = closest_axis(polygon.normal);
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut inside = false;
    let mut from = *polygon.vertices.last().expect("a polygon has vertices");
    for &to in &polygon.vertices {
        if (from[y] > p[y]) != (to[y] > p[y]) {
            let crossing = from[x] + (to[x] - from[x]) * ((p[y] - from[y]) / (to[y] - from[y]));
            inside ^= p[x] < crossing;
        }
        from = to;
    }
    inside
}
