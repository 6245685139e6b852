//! A convex piece.

use solid3d::glam::{DAffine3, DVec3};
use solid3d::hull::Hull;
use solid3d::{Aabb, Shape, query};

/// A corner of a piece.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub at: DVec3,
    /// Whether it is where the mesh was cut, and not a vertex of it.
    pub is_cut: bool,
}

/// What is cut is this much off the edge or face that it was cut at, by rounding, where the size of the mesh is one to two: some
/// of that makes corners that no body has.
const CUT_ERROR: f64 = 4.0 * solid3d::convex::gjk::TOUCHING_ERROR;

/// The hull of points: its corners, its volume, and how much of that was added by joining.
#[derive(Clone, Debug)]
pub struct Piece {
    corners: Vec<Corner>,
    volume: f64,
    /// What it covers that the pieces that it was joined from did not.
    pub added: f64,
    pub bounds: Aabb,
}

impl Piece {
    /// `None` for no points.
    pub fn of(cloud: Vec<Corner>) -> Option<Piece> {
        let points: Vec<DVec3> = cloud.iter().map(|corner| corner.at).collect();
        let hull = Hull::of(&points)?;
        let point = |i: u32| points[i as usize];
        // Tetrahedra from one corner, which are all inside.
        let tip = point(hull.vertices()[0]);
        let six = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| point(i) - tip);
            a.dot(b.cross(c))
        };
        let volume =
            if hull.dimension() < 3 { 0.0 } else { hull.triangles().iter().map(six).sum::<f64>() / 6.0 };
        let corners = hull.vertices().iter().map(|&i| cloud[i as usize]).collect();
        let bounds = Aabb::of_points(hull.vertices().iter().map(|&i| point(i)));
        Some(Piece { corners, volume: volume.abs(), added: 0.0, bounds })
    }

    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The hull of both.
    pub fn joined(&self, other: &Piece) -> Piece {
        let mut piece =
            Piece::of([&self.corners[..], &other.corners[..]].concat()).expect("a piece has a corner");
        let more = piece.volume - self.volume - other.volume;
        piece.added = self.added + other.added + more.max(0.0);
        piece
    }

    /// The vertices of the mesh among the corners, and of what was cut that which is not in their hull.
    pub fn corners(&self) -> solid3d::Result<Vec<DVec3>> {
        let (cut, vertices): (Vec<Corner>, Vec<Corner>) =
            self.corners.iter().partition(|corner| corner.is_cut);
        let mut corners: Vec<DVec3> = vertices.iter().map(|corner| corner.at).collect();
        if corners.is_empty() {
            return Ok(cut.iter().map(|corner| corner.at).collect());
        }
        let hull = Shape::convex_hull(&corners)?;
        for Corner { at, .. } in cut {
            if query::closest_point(&hull, &DAffine3::IDENTITY, at)?.distance > CUT_ERROR {
                corners.push(at);
            }
        }
        Ok(corners)
    }
}
