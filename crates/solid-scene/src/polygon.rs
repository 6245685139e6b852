//! Triangulating the polygons of mesh files.

use earcut::Earcut;
use glam::DVec3;
use solid3d::convex::unit_scale;

/// The most corners of a polygon that is cut by ears, which takes quadratic time at worst: 0.35 s for so many at random, which cross
/// each other everywhere; 0.01 s for 2,000 of a regular shape.
pub(crate) const EARCUT_CORNERS_MAX: usize = 5_000;

/// How far a triangle of a fan may face the wrong way and still count as rounding, relative to the polygon's area.
const FOLD_TOLERANCE: f64 = 1e-9;

/// What the rounding of each corner may add to an area vector, relative to the products of lengths that its cross products are of.
const COVER_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// How well triangles stand for their polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// They cover it.
    Faithful,
    /// They are a fan that is folded over, since the polygon has no area, crosses itself or has too many corners for better.
    Folded,
}

/// Triangulates a polygon over vertices that are there. The triangles name the polygon's own corners.
///
/// Three corners or more give a fan around the first, unless a triangle of the fan would be folded over, facing against
/// the polygon: then ears are cut, in the plane of the polygon's area vector. Where a part is left for which there is no ear, as of a
/// polygon that crosses itself, it is the fan after all: that keeps the edges, so that what was closed is. Fewer corners give nothing.
pub(crate) fn triangulate(corners: &[u32], vertices: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> Cut {
    let polygon = (corners.len() > 3).then(|| Polygon::new(corners, vertices));
    let Some(polygon) = polygon.filter(Polygon::is_fan_folded) else {
        triangles.extend(fan(corners));
        return Cut::Faithful;
    };
    let ears = if corners.len() <= EARCUT_CORNERS_MAX { polygon.ears() } else { Vec::new() };
    if !polygon.is_covered_by(&ears) {
        triangles.extend(fan(corners));
        return Cut::Folded;
    }
    triangles.extend(ears);
    Cut::Faithful
}

/// What to tell the user of polygons, where there were some, that were cut no better than folded.
pub(crate) fn folded_warning(count: usize) -> Option<String> {
    let which =
        format!("without an area, crossing itself, or concave with more than {EARCUT_CORNERS_MAX} corners,");
    match count {
        0 => None,
        1 => Some(format!("1 polygon {which} is a fan that is folded over")),
        n => Some(format!("{n} polygons {which} are fans that are folded over")),
    }
}

/// What to tell the user of faces, where there were some, that are no polygons.
pub(crate) fn short_warning(count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some("1 face with fewer than 3 corners is passed over".to_owned()),
        n => Some(format!("{n} faces with fewer than 3 corners are passed over")),
    }
}

fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]])
}

/// Three corners or more, seen from the first.
struct Polygon<'a> {
    corners: &'a [u32],
    vertices: &'a [DVec3],
    /// A power of two that brings it to a size of about one, where squares of areas neither overflow nor vanish.
    scale: f64,
    /// Twice its area, along its normal.
    normal: DVec3,
}

impl Polygon<'_> {
    fn new<'a>(corners: &'a [u32], vertices: &'a [DVec3]) -> Polygon<'a> {
        let unscaled = Polygon { corners, vertices, scale: 1.0, normal: DVec3::ZERO };
        let size = corners.iter().map(|&i| unscaled.at(i).abs().max_element()).fold(0.0, f64::max);
        let scaled = Polygon { scale: unit_scale(size), ..unscaled };
        Polygon { normal: scaled.fan_areas().sum(), ..scaled }
    }

    fn at(&self, vertex: u32) -> DVec3 {
        (self.vertices[vertex as usize] - self.vertices[self.corners[0] as usize]) * self.scale
    }

    /// Twice the areas of the triangles of the fan, along their normals.
    fn fan_areas(&self) -> impl Iterator<Item = DVec3> {
        fan(self.corners).map(|triangle| self.area(triangle))
    }

    /// Twice the area of a triangle, along its normal.
    fn area(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|corner| self.at(corner));
        (b - a).cross(c - a)
    }

    /// Whether triangles are all of the polygon: its area vector is the sum of theirs, as both are that of the edges around.
    fn is_covered_by(&self, triangles: &[[u32; 3]]) -> bool {
        let covered: DVec3 = triangles.iter().map(|&triangle| self.area(triangle)).sum();
        let products: f64 =
            fan(self.corners).map(|[_, b, c]| self.at(b).length() * self.at(c).length()).sum();
        let limit = COVER_TOLERANCE * self.corners.len() as f64 * products;
        !triangles.is_empty() && (self.normal - covered).length() <= limit
    }

    /// Whether a triangle of the fan faces against the polygon.
    fn is_fan_folded(&self) -> bool {
        let limit = -FOLD_TOLERANCE * self.normal.length_squared();
        self.fan_areas().any(|area| area.dot(self.normal) < limit)
    }

    /// The ears; none where the polygon has no area to speak of.
    fn ears(&self) -> Vec<[u32; 3]> {
        let Some(normal) = self.normal.try_normalize() else { return Vec::new() };
        let (u, v) = normal.any_orthonormal_pair();
        let plane = self.corners.iter().map(|&corner| self.at(corner)).map(|p| [p.dot(u), p.dot(v)]);
        let mut ears: Vec<u32> = Vec::new();
        Earcut::new().earcut(plane, &[], &mut ears);
        ears.chunks_exact(3).map(|ear| [0, 1, 2].map(|i| self.corners[ear[i] as usize])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangulated(vertices: &[DVec3]) -> Vec<[u32; 3]> {
        let corners: Vec<u32> = (0..vertices.len() as u32).collect();
        let mut triangles = Vec::new();
        assert_eq!(triangulate(&corners, vertices, &mut triangles), Cut::Faithful);
        triangles
    }

    fn total_area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let area = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| vertices[i as usize]);
            (b - a).cross(c - a).length() / 2.0
        };
        triangles.iter().map(area).sum()
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        assert_eq!(triangulated(&square), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(triangulated(&square[..2]), [[0; 3]; 0]);
    }

    /// Neither where ears are cut nor where corners lie on an edge.
    #[test]
    fn rounding_folds_nothing() {
        for points in [5, 50, 500] {
            let turn = std::f64::consts::PI / f64::from(points);
            let corner = |i: u32| {
                let (sin, cos) = (turn * f64::from(i)).sin_cos();
                DVec3::new(cos, sin, 0.3) * if i.is_multiple_of(2) { 1.0 } else { 0.4 }
            };
            let star: Vec<DVec3> = (0..2 * points).map(corner).map(|p| p.with_z(0.3)).collect();
            let area = total_area(&star, &triangulated(&star));
            assert!((area - f64::from(points) * 0.4 * turn.sin()).abs() < 1e-12, "{points}: {area}");
        }
        for slope in (1..200).map(|i| 0.1 * f64::from(i)) {
            let on_edge = [0.0, 0.1, 0.7, 1.0].map(|x| DVec3::new(x, slope * x, 0.0));
            let polygon = [&on_edge[..], &[DVec3::new(0.5, 99.0, 0.0)]].concat();
            assert_eq!(triangulated(&polygon), [[0, 1, 2], [0, 2, 3], [0, 3, 4]], "{slope}");
        }
    }

    /// Which takes quadratic time.
    #[test]
    fn ears_are_cut_of_so_many_corners_and_no_more() {
        let cut = |corners: usize| {
            let teeth = (0..corners - 2).map(|i| DVec3::new(-(i as f64), (i % 2) as f64, 0.0));
            let left = -(corners as f64);
            let comb: Vec<DVec3> = teeth.chain([left, 0.0].map(|x| DVec3::new(x, -1.0, 0.0))).collect();
            let numbers: Vec<u32> = (0..corners as u32).collect();
            triangulate(&numbers, &comb, &mut Vec::new())
        };
        assert_eq!([0, 1].map(|more| cut(EARCUT_CORNERS_MAX + more)), [Cut::Faithful, Cut::Folded]);
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
            assert!((total_area(&arrow, &triangles) - 1.0).abs() < 1e-12, "{turn}: {triangles:?}");
            for power in [-330, -260, 255, 330] {
                let scaled = arrow.map(|p| p * 2f64.powi(power));
                assert_eq!(triangulated(&scaled), triangles, "{turn}, in a unit of 2^{power}");
            }
        }
    }

    #[test]
    fn degenerate_polygons_survive() {
        assert_eq!(triangulated(&[DVec3::ONE; 5]).len(), 3);
        let bow = [DVec3::ZERO, DVec3::ONE, DVec3::X, DVec3::Y + DVec3::Z];
        assert!(!triangulated(&bow).is_empty());
    }

    /// Of a bow tie there is an ear, but none for the rest.
    #[test]
    fn polygons_that_cross_themselves_keep_their_edges() {
        let bow = [(0.0, 0.0), (4.0, 3.0), (4.0, 0.0), (0.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        for turn in 0..4 {
            let corners = [0, 1, 2, 3].map(|corner| (corner + turn) % 4);
            let mut triangles = Vec::new();
            assert_eq!(triangulate(&corners, &bow, &mut triangles), Cut::Folded);
            assert_eq!(triangles, fan(&corners).collect::<Vec<_>>());
        }
    }

    /// The worst that ears are cut of: corners at random, which cross each other everywhere.
    #[test]
    fn large_tangles_end() {
        let mut x = 1u32;
        let mut random = || {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(x >> 8)
        };
        let tangle: Vec<DVec3> =
            (0..=EARCUT_CORNERS_MAX).map(|_| DVec3::new(random(), random(), 0.0)).collect();
        for count in [EARCUT_CORNERS_MAX, EARCUT_CORNERS_MAX + 1] {
            let (corners, mut triangles) = ((0..count as u32).collect::<Vec<_>>(), Vec::new());
            assert_eq!(triangulate(&corners, &tangle, &mut triangles), Cut::Folded);
            assert_eq!(triangles.len(), count - 2);
        }
    }
}
