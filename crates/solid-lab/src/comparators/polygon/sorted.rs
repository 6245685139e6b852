use super::{FlatPolygon, closest_axis};

/// The test by sorted segments, with room for them.
#[derive(Clone, Debug, Default)]
pub struct Sorted {
    sigma: Vec<f64>,
    tau: Vec<f64>,
}

impl Sorted {
    /// Whether two polygons intersect: the segments in which each meets the other's plane, sorted along the line in which the planes
    /// meet, and scanned together (thesis, section 3.2.2 and Algorithm 3.1). Cost: O(n log n).
    pub fn intersect(&mut self, a: &FlatPolygon, b: &FlatPolygon) -> bool {
        let axis = closest_axis(a.normal.cross(b.normal));
        fill(&mut self.sigma, b, a, axis);
        if self.sigma.is_empty() {
            return false;
        }
        fill(&mut self.tau, a, b, axis);
        let (sigma, tau) = (&self.sigma, &self.tau);
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
}

/// The ends of the segments of `polygon` in the plane of `other`, in order along an axis.
fn fill(ends: &mut Vec<f64>, other: &FlatPolygon, polygon: &FlatPolygon, axis: usize) {
    ends.clear();
    ends.extend(other.crossings(polygon).map(|p| p[axis]));
    ends.sort_unstable_by(f64::total_cmp);
}
