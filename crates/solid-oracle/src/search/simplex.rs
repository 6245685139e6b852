use crate::double_double::{DoubleDouble, Vec3};
use crate::placed::Vertex;

/// Up to four vertices of A-B and the weights of the point of their hull that is closest to the origin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Simplex {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) weights: Vec<DoubleDouble>,
}

/// A point, its squared length, the feature that holds it and its weights there.
type Candidate = (DoubleDouble, Vec3, &'static [usize], Vec<DoubleDouble>);

/// The candidate features that contain the newest vertex, for every number of vertices; the newest comes last.
const FEATURES: [&[&[usize]]; 5] = [
    &[],
    &[&[0]],
    &[&[1], &[0, 1]],
    &[&[2], &[0, 2], &[1, 2], &[0, 1, 2]],
    &[&[3], &[0, 3], &[1, 3], &[2, 3], &[0, 1, 3], &[0, 2, 3], &[1, 2, 3]],
];

impl Simplex {
    pub(crate) fn contains(&self, w: Vec3) -> bool {
        self.vertices.iter().any(|vertex| vertex.w == w)
    }

    /// Whether four vertices enclose the origin, up to rounding; if so the weights become those of the origin.
    pub(crate) fn encloses_origin(&mut self) -> bool {
        let [a, b, c, d] = self.vertices.as_slice() else { return false };
        let (a, b, c, d) = (a.w, b.w, c.w, d.w);
        let det = |x: Vec3, y: Vec3, z: Vec3| x.dot(y.cross(z));
        let volume = det(b - a, c - a, d - a);
        if volume.is_zero() {
            return false;
        }
        // The weight of a vertex is the volume of the tetrahedron with that vertex replaced by the origin.
        let weights = [det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)].map(|part| part / volume);
        let encloses = !weights.iter().any(|weight| weight.is_negative());
        if encloses {
            self.weights = weights.to_vec();
        }
        encloses
    }

    /// Keeps the least feature that holds the point closest to the origin, and returns that point.
    ///
    /// Only features with the newest vertex are tried: the previous closest point was the best of the others.
    pub(crate) fn reduce(&mut self) -> Vec3 {
        let mut best: Option<Candidate> = None;
        for feature in FEATURES[self.vertices.len()] {
            let points: Vec<Vec3> = feature.iter().map(|&i| self.vertices[i].w).collect();
            let Some((v, weights)) = closest_on_affine_hull(&points) else { continue };
            let length = v.length_squared();
            if best.as_ref().is_none_or(|b| length < b.0) {
                best = Some((length, v, feature, weights));
            }
        }
        let (_, v, feature, weights) = best.expect("a single vertex is always a candidate");
        self.vertices = feature.iter().map(|&i| self.vertices[i]).collect();
        self.weights = weights;
        v
    }
}

/// The point of the affine hull of one to three points closest to the origin, if it lies in their convex hull.
pub(crate) fn closest_on_affine_hull(points: &[Vec3]) -> Option<(Vec3, Vec<DoubleDouble>)> {
    let one = DoubleDouble::ONE;
    match *points {
        [a] => Some((a, vec![one])),
        [a, b] => {
            let edge = b - a;
            let length_squared = edge.length_squared();
            let along = -a.dot(edge);
            if along.is_negative() || along > length_squared || length_squared.is_zero() {
                return None;
            }
            let t = along / length_squared;
            // From the nearer end, so that the sum cancels least.
            let v = if t.to_f64() < 0.5 { a + edge * t } else { b - edge * (one - t) };
            Some((v, vec![one - t, t]))
        }
        [a, b, c] => {
            let normal = (b - a).cross(c - a);
            let length_squared = normal.length_squared();
            if length_squared.is_zero() {
                return None;
            }
            let weights = [(b, c), (c, a), (a, b)].map(|(p, q)| normal.dot(p.cross(q)));
            if weights.iter().any(|w| w.is_negative()) {
                return None;
            }
            let sum = weights[0] + weights[1] + weights[2];
            if sum.is_zero() {
                return None;
            }
            let v = normal * (normal.dot(a) / length_squared);
            Some((v, weights.map(|w| w / sum).to_vec()))
        }
        _ => None,
    }
}
