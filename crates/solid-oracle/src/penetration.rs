use glam::{DAffine3, DVec3};

use crate::decide::{Decision, decide};
use crate::double_double::{DoubleDouble, Vec3};
use crate::placed::{PlacedPair, Vertex};
use crate::search::Limits;
use crate::shape::Convex;

/// How long the ball is improved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    relative_width: f64,
    expansions_max: usize,
}

impl Effort {
    pub(crate) const QUICK: Self = Self { relative_width: 0.05, expansions_max: 60 };
    const THOROUGH: Self = Self { relative_width: 1e-7, expansions_max: 400 };
}

/// A ball around the origin that lies in A-B, up to rounding, and a direction in which A-B ends soon.
pub(crate) struct Inscribed {
    pub(crate) radius: f64,
    /// Outward normal of the face that held the ball last.
    normal: Vec3,
}

/// Taken off the radius, relative to the greatest coordinate: the `f64` the ball is reported in are coarser.
const MARGIN_RELATIVE: f64 = 1e-14;

/// Bounds `(lower, upper)` of the penetration depth: the least translation that parts two shapes. `None` unless
/// they are proven to share a point.
///
/// `upper` is rigorous: a translation by it along a verified axis leaves no overlap. `lower` is the ball of an
/// expanding polytope (van den Bergen 2001), searched to 1e-7 of the depth where 400 faces suffice and computed with
/// rounding, less a margin of 1e-14 of the largest coordinate.
pub fn penetration_bounds(a: &Convex, pa: &DAffine3, b: &Convex, pb: &DAffine3) -> Option<(f64, f64)> {
    let pair = PlacedPair::new(a, pa, b, pb);
    let Decision::Common(vertices) = decide(&pair, Limits { relative_width: 1e-9, iterations_max: 400 })
    else {
        return None;
    };
    let ball = inscribed(&pair, &vertices, Effort::THOROUGH);
    // A must move along the outward normal of B-A, the negated one of A-B.
    let upper = -pair.gap_along(&(-ball.normal).to_exact());
    Some((ball.radius.min(upper), upper))
}

/// What double-double coordinates and their products cannot tell from zero, relative to their size.
const NOISE_RELATIVE: f64 = 1e-28;

/// Grows a polytope inside A-B from `vertices`, whose hull holds the origin, towards the face nearest to it.
pub(crate) fn inscribed(pair: &PlacedPair, vertices: &[Vertex], effort: Effort) -> Inscribed {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut points: Vec<Vec3> = vertices.iter().map(|vertex| vertex.w).collect();
    points.extend(axes.iter().flat_map(|&d| [d, -d]).map(|d| pair.support(Vec3::from_f64(d)).w));
    let scale = points.iter().map(|p| p.to_f64().abs().max_element()).fold(0.0, f64::max);
    let flat = |normal| Inscribed { radius: 0.0, normal };
    let mut polytope = match Polytope::spanned_by(&points) {
        Ok(polytope) => polytope,
        Err(normal) => return flat(normal),
    };
    for &p in &points {
        polytope.insert(p);
    }
    for _ in 0..effort.expansions_max {
        let face = *polytope.nearest();
        if face.offset.is_negative() || face.offset.is_zero() {
            // The origin lies on the boundary of the polytope, or rounding says so: look beyond that face once more.
            if !polytope.insert(pair.support(face.normal).w) {
                return flat(face.normal);
            }
            continue;
        }
        let w = pair.support(face.normal).w;
        let reach = face.normal.dot(w);
        if reach.to_f64() - face.offset.to_f64() <= effort.relative_width * reach.to_f64()
            || !polytope.insert(w)
        {
            break;
        }
    }
    let face = polytope.nearest();
    Inscribed { radius: (face.offset.to_f64() - MARGIN_RELATIVE * scale).max(0.0), normal: face.normal }
}

/// A triangle of the polytope, counterclockwise from outside.
#[derive(Clone, Copy)]
struct Face {
    corners: [usize; 3],
    /// Outward, of unit length.
    normal: Vec3,
    /// Distance of the plane from the origin, along the normal.
    offset: DoubleDouble,
}

/// A convex polytope that grows by inserting points.
struct Polytope {
    points: Vec<Vec3>,
    faces: Vec<Face>,
}

impl Polytope {
    /// A tetrahedron of four of the points; `Err` with the direction in which they do not extend when they are flat.
    fn spanned_by(points: &[Vec3]) -> Result<Self, Vec3> {
        let farthest = |measure: &dyn Fn(Vec3) -> DoubleDouble| {
            points
                .iter()
                .copied()
                .max_by(|p, q| measure(*p).partial_cmp(&measure(*q)).expect("finite"))
                .expect("six")
        };
        let a = points[0];
        let b = farthest(&|p| (p - a).length_squared());
        let c = farthest(&|p| (b - a).cross(p - a).length_squared());
        let normal = (b - a).cross(c - a);
        let d = farthest(&|p| {
            let height = normal.dot(p - a);
            if height.is_negative() { -height } else { height }
        });
        let height = normal.dot(d - a);
        // Flat up to the digits kept: the volume is lost in the rounding of its terms.
        let edges = (b - a).length_squared().sqrt() * (c - a).length_squared().sqrt();
        let noise = edges.to_f64() * (d - a).length_squared().sqrt().to_f64() * NOISE_RELATIVE;
        if height.to_f64().abs() <= noise {
            return Err(if normal.is_zero() { perpendicular(b - a) } else { normal });
        }
        let corners = if height.is_negative() { [a, b, c, d] } else { [a, c, b, d] };
        let mut polytope = Self { points: corners.to_vec(), faces: Vec::new() };
        for corners in [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]] {
            polytope.add_face(corners);
        }
        Ok(polytope)
    }

    /// Adds a face unless it has no area.
    fn add_face(&mut self, corners: [usize; 3]) {
        let [a, b, c] = corners.map(|i| self.points[i]);
        let normal = (b - a).cross(c - a);
        let length = normal.length_squared().sqrt();
        if length.is_zero() {
            return;
        }
        let normal = normal * (DoubleDouble::ONE / length);
        self.faces.push(Face { corners, normal, offset: normal.dot(a) });
    }

    fn nearest(&self) -> &Face {
        self.faces
            .iter()
            .min_by(|f, g| f.offset.partial_cmp(&g.offset).expect("offsets are finite"))
            .expect("a polytope has faces")
    }

    /// Replaces the faces that see `p` by a cone to it.
    ///
    /// False, and nothing changes, when no face sees it, or when rounding makes the faces that do something else
    /// than one patch: growing on such a patch would multiply faces without end.
    fn insert(&mut self, p: Vec3) -> bool {
        let noise = NOISE_RELATIVE * p.to_f64().length();
        let (seeing, rest): (Vec<Face>, Vec<Face>) =
            self.faces.iter().partition(|f| (f.normal.dot(p) - f.offset).to_f64() > noise);
        let horizon = horizon(&seeing);
        if !is_one_cycle(&horizon) {
            return false;
        }
        self.faces = rest;
        self.points.push(p);
        for &(i, j) in &horizon {
            self.add_face([i, j, self.points.len() - 1]);
        }
        true
    }
}

/// The directed edges of the faces without those that two of them share.
fn horizon(faces: &[Face]) -> Vec<(usize, usize)> {
    let edges: Vec<(usize, usize)> =
        faces.iter().flat_map(|f| [0, 1, 2].map(|i| (f.corners[i], f.corners[(i + 1) % 3]))).collect();
    edges.iter().copied().filter(|&(i, j)| !edges.contains(&(j, i))).collect()
}

/// Whether directed edges form one closed walk that visits no vertex twice. No edges do not.
fn is_one_cycle(edges: &[(usize, usize)]) -> bool {
    let Some(&(start, mut at)) = edges.first() else { return false };
    let mut length = 1;
    while at != start {
        let mut next = edges.iter().filter(|e| e.0 == at);
        let (Some(&(_, end)), None) = (next.next(), next.next()) else { return false };
        at = end;
        length += 1;
        if length > edges.len() {
            return false;
        }
    }
    length == edges.len()
}

/// A vector at a right angle to `v`, or x when `v` is zero.
fn perpendicular(v: Vec3) -> Vec3 {
    v.to_f64()
        .try_normalize()
        .map_or(Vec3::from_f64(DVec3::X), |unit| v.cross(Vec3::from_f64(unit.any_orthonormal_vector())))
}
