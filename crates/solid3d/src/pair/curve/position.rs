//! Where a node is.
//!
//! The weights are quotients of determinants that differ in sign, so that the denominator loses nothing. The determinants are
//! computed with twice the precision: when an edge passes a face at a very small angle, those of `f64` have few correct digits
//! or none. That is off only where a determinant is below 2^-100 of the products it is made of, which takes an adversary;
//! the point is on the edge then, wherever on it.

use glam::DVec3;

use super::double::Double;
use super::meeting::Node;
use super::sites::{Edge, Face, Sites};

impl Sites {
    /// The point of a node, in the common frame, to a few units in the last place of the frame.
    pub fn position(&self, node: &Node) -> DVec3 {
        match *node {
            Node::Corner(site) => self.at(site),
            Node::EdgeFace(edge, face) => self.through_face(edge, face),
            Node::Edges([e, f]) => self.through_edge(e, f),
        }
    }

    fn through_face(&self, [p, q]: Edge, face: Face) -> DVec3 {
        let [a, b, c] = face.map(|site| self.at(site));
        let (p, q) = (self.at(p), self.at(q));
        let height = |d: DVec3| dot(minus(a, d), cross(minus(b, d), minus(c, d)));
        between(p, q, height(p), height(q))
    }

    /// The edges lie in one plane; its coordinate plane of least distortion tells the point on `e`.
    fn through_edge(&self, [p, q]: Edge, [r, s]: Edge) -> DVec3 {
        let [p, q, r, s] = [p, q, r, s].map(|site| self.at(site));
        let along = minus(s, r);
        let (at_p, at_q) = (cross(minus(p, r), along), cross(minus(q, r), along));
        let spread = |axis: usize| (at_p[axis] - at_q[axis]).value().abs();
        let axis = (1..3).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
        between(p, q, at_p[axis], at_q[axis])
    }
}

/// The point between `p` and `q` where a linear function is zero that has values of different sign there.
fn between(p: DVec3, q: DVec3, at_p: Double, at_q: Double) -> DVec3 {
    let weight = at_p.value() / (at_p - at_q).value();
    // What underflows or is lost to rounding leaves 0/0, or a weight out of range.
    let weight = if weight.is_nan() { 0.5 } else { weight.clamp(0.0, 1.0) };
    p + weight * (q - p)
}

type Vector = [Double; 3];

fn minus(p: DVec3, q: DVec3) -> Vector {
    [0, 1, 2].map(|axis| Double::difference(p[axis], q[axis]))
}

fn cross(u: Vector, v: Vector) -> Vector {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| u[i] * v[j] - u[j] * v[i])
}

fn dot(u: Vector, v: Vector) -> Double {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}
