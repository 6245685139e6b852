//! Splitting a face into triangles.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// How far a corner of a convex face may turn inwards, as the sine of the angle: that of coordinates in single
/// precision on a straight edge.
const INWARD: f64 = 1e-6;

/// Splits faces into triangles.
#[derive(Default)]
pub(super) struct Splitter {
    earcut: Earcut<f64>,
    flat: Vec<DVec2>,
    cut: Vec<u32>,
}

/// A face by its corners: indices into a buffer of points.
#[derive(Clone, Copy)]
pub(super) struct Face<'a> {
    pub points: &'a [DVec3],
    /// At least three.
    pub corners: &'a [u32],
}

impl Face<'_> {
    fn point(&self, corner: usize) -> DVec3 {
        self.points[self.corners[corner % self.corners.len()] as usize]
    }

    /// The normal by Newell's method: twice the area long, along the mean normal.
    fn normal(&self) -> DVec3 {
        let origin = self.point(0);
        let edge = |i| (self.point(i) - origin).cross(self.point(i + 1) - origin);
        (0..self.corners.len()).map(edge).sum()
    }

    /// The corners in the plane of the two axes across which the normal is longest, counter-clockwise as the face is.
    fn flatten(&self, normal: DVec3, flat: &mut Vec<DVec2>) {
        let size = normal.abs();
        let project = |p: DVec3| match size {
            _ if size.x >= size.y && size.x >= size.z => {
                DVec2::new(p.y, p.z) * DVec2::new(normal.x.signum(), 1.0)
            }
            _ if size.y >= size.z => DVec2::new(p.z, p.x) * DVec2::new(normal.y.signum(), 1.0),
            _ => DVec2::new(p.x, p.y) * DVec2::new(normal.z.signum(), 1.0),
        };
        flat.clear();
        flat.extend((0..self.corners.len()).map(|corner| project(self.point(corner))));
    }
}

impl Splitter {
    /// Whether fanning out from the first corner does: the face is convex, or has no area.
    pub fn is_convex(&mut self, face: Face<'_>) -> bool {
        let normal = face.normal();
        if face.corners.len() == 3 || normal == DVec3::ZERO {
            return true;
        }
        face.flatten(normal, &mut self.flat);
        turns_once(&self.flat)
    }

    /// Adds the triangles of a face. A convex one is fanned out from its first corner; of another, ears are cut.
    pub fn split(&mut self, face: Face<'_>, triangles: &mut Vec<[u32; 3]>) {
        if !self.is_convex(face) && self.cut(face, triangles) {
            return;
        }
        let corners = face.corners;
        triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
    }

    /// Cuts ears; `false` when none is found.
    fn cut(&mut self, face: Face<'_>, triangles: &mut Vec<[u32; 3]>) -> bool {
        let points = self.flat.iter().map(|p| p.to_array());
        self.earcut.earcut(points, &[], &mut self.cut);
        triangles
            .extend(self.cut.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|i| face.corners[i as usize])));
        !self.cut.is_empty()
    }
}

/// Whether a counter-clockwise polygon turns left at each corner, and once around in all. Corners may coincide.
fn turns_once(polygon: &[DVec2]) -> bool {
    let next = |i: usize| polygon[(i + 1) % polygon.len()];
    let edges = polygon.iter().enumerate().map(|(i, &p)| next(i) - p).filter(|&edge| edge != DVec2::ZERO);
    let Some(mut before) = edges.clone().last() else { return true };
    let mut rises = 0;
    for after in edges {
        if before.perp_dot(after) < -INWARD * before.length() * after.length() {
            return false;
        }
        // A spike turns back on itself without turning left or right.
        if before.perp_dot(after).abs() <= INWARD * before.length() * after.length()
            && before.dot(after) < 0.0
        {
            return false;
        }
        rises += usize::from(ascends(before) != ascends(after));
        before = after;
    }
    rises <= 2
}

/// Whether a direction is in the upper half plane: a convex polygon changes between the halves twice.
fn ascends(direction: DVec2) -> bool {
    direction.y > 0.0 || (direction.y == 0.0 && direction.x > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(points: &[DVec3]) -> Vec<[u32; 3]> {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        Splitter::default().split(Face { points, corners: &corners }, &mut triangles);
        triangles
    }

    fn area(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let corner = |t: &[u32; 3], i: usize| points[t[i] as usize];
        let twice = |t| (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).length();
        triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    fn in_the_planes(polygon: &[[f64; 2]]) -> [Vec<DVec3>; 4] {
        let place = |f: fn([f64; 2]) -> DVec3| polygon.iter().map(|&p| f(p)).collect();
        [
            place(|[x, y]| DVec3::new(x, y, 1.0)),
            place(|[x, y]| DVec3::new(x, 1.0, y)),
            place(|[x, y]| DVec3::new(1.0, x, y)),
            place(|[x, y]| DVec3::new(-x, y, x)),
        ]
    }

    #[test]
    fn a_convex_face_is_a_fan() {
        for square in in_the_planes(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) {
            assert_eq!(split(&square), [[0, 1, 2], [0, 2, 3]]);
        }
    }

    #[test]
    fn a_concave_face_keeps_its_area() {
        let notch = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
        for (face, stretch) in in_the_planes(&notch).iter().zip([1.0, 1.0, 1.0, 2f64.sqrt()]) {
            let triangles = split(face);
            assert_eq!(triangles.len(), 3);
            assert!((area(face, &triangles) - 2.5 * stretch).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_is_joined_by_a_bridge() {
        let outer = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
        let hole = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0]];
        for face in in_the_planes(&[outer, hole].concat()).iter().take(3) {
            assert!((area(face, &split(face)) - 8.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_star_is_not_convex_though_it_only_turns_left() {
        let turn = |i: f64| DVec2::from_angle(i * 0.8 * std::f64::consts::PI);
        let star: Vec<DVec2> = (0..5).map(|i| turn(f64::from(i))).collect();
        assert!(!turns_once(&star));
    }

    #[test]
    fn corners_that_coincide_make_degenerate_triangles() {
        let square = [DVec3::ZERO, DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::ZERO];
        assert_eq!(split(&square).len(), 4);
    }

    #[test]
    fn a_face_without_area_is_a_fan() {
        assert_eq!(split(&[DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, 3.0 * DVec3::X]).len(), 2);
    }
}
