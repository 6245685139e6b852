use super::{FlatPolygon, closest_axis};

/// Whether two polygons intersect: the segments in which each meets the other's plane, sorted along the line in which the planes
/// meet, and scanned together (thesis, section 3.2.2 and Algorithm 3.1). Cost: O(n log n).
pub fn sorted(a: &FlatPolygon, b: &FlatPolygon) -> bool {
    let axis = closest_axis(a.normal.cross(b.normal));
    let ends_of = |polygon: &FlatPolygon, other: &FlatPolygon| {
        let mut ends: Vec<f64> = other.crossings(polygon).map(|p| p[axis]).collect();
        ends.sort_unstable_by(f64::total_cmp);
        ends
    };
    let sigma = ends_of(a, b);
    if sigma.is_empty() {
        return false;
    }
    let tau = ends_of(b, a);
    let (mut i, mut j) = (0, 0);
    while i + 1 < sigma.len() && j + 1 < tau.len() {
        if sigma[i + 1] < tau[j] {
            i += 2;
        } else if tau[j + 1] < sigma[i] {
            j += 2;
        } else {
            return true;
        }
    }
    false
}
