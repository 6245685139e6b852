//! A vertex against a triangle, and an edge against an edge.

use glam::DVec3;
use solid_convex::unit_scale;

use super::boxes::{Cell, EVALUATION_ERROR, Search, Trilinear, earliest};
use crate::error::{Error, Result, bounded};

/// Four vertices, at the start and at the end of their way.
///
/// Of [`vertex_face`], the vertex and the three corners of the triangle; of [`edge_edge`], the two ends of one edge and of the other.
/// Points may coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements {
    /// At time 0.
    pub from: [DVec3; 4],
    /// At time 1.
    pub to: [DVec3; 4],
}

/// How a contact of elements is to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How near elements may be that are reported as meeting: per coordinate, relative to the largest difference of coordinates of any
    /// two of the vertices at any time, up to a factor of two; from 1e-12 to 1. Default: 1e-6.
    pub tolerance: f64,
    /// The most boxes of parameters to be looked at; when they are used up, a contact is reported at the time up to which there is
    /// none. A contact takes some hundreds; elements that slide along each other may take all. Default: 100,000, for
    /// some 20 ms and 5 MB.
    pub boxes_max: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options { tolerance: 1e-6, boxes_max: 100_000 }
    }
}

/// When and where elements first meet, or come nearer than the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The time, from 0 to 1: never later than the first contact.
    pub time: f64,
    /// Where in the elements. Of [`vertex_face`] the weights of the triangle's second and third corner, whose sum is at most 1, of
    /// [`edge_edge`] how far along the first and along the second edge.
    pub parameters: [f64; 2],
    /// Whether it is nearer than the tolerance; else the search gave up there, and it may be further.
    pub near: bool,
}

/// The least tolerance: a hundred times the rounding error of what is compared with it.
const TOLERANCE_MIN: f64 = 1e-12;
const _: () = assert!(TOLERANCE_MIN > 64.0 * EVALUATION_ERROR);

/// When a moving vertex first meets a moving triangle; `None` when it does not. Every vertex moves straight at constant speed.
///
/// Conservative: no contact is missed, not even a single touch, and the time is never later than the first; rounding is counted.
/// What comes nearer than the tolerance may be reported, too. Degenerate triangles are segments or points.
///
/// ```
/// use solid3d::{ccd::{self, Elements, Options}, glam::DVec3};
/// let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let falling = |x: f64| {
///     let vertex = |z: f64| DVec3::new(x, 0.25, z);
///     let [p, q, r] = triangle;
///     Elements { from: [vertex(3.0), p, q, r], to: [vertex(-1.0), p, q, r] }
/// };
/// let impact = ccd::vertex_face(&falling(0.5), &Options::default())?.unwrap();
/// assert!(impact.time <= 0.75 && impact.time > 0.749999);
/// assert!((impact.parameters[0] - 0.5).abs() < 1e-5 && (impact.parameters[1] - 0.25).abs() < 1e-5);
/// assert_eq!(ccd::vertex_face(&falling(0.8), &Options::default())?, None);
/// # Ok::<(), solid3d::Error>(())
/// ```
///
/// # Errors
///
/// A coordinate that is not finite or too large; a tolerance out of range.
pub fn vertex_face(elements: &Elements, options: &Options) -> Result<Option<Impact>> {
    find(&VertexFace(Paths::new(elements)?), options)
}

/// When two moving edges first meet; `None` when they do not. As [`vertex_face`] otherwise.
///
/// ```
/// use solid3d::{ccd::{self, Elements, Options}, glam::DVec3};
/// let edge = [DVec3::NEG_X, DVec3::X];
/// let falling = |z: f64| [DVec3::new(0.0, -1.0, z), DVec3::new(0.0, 1.0, z)];
/// let elements = |from: [DVec3; 2], to: [DVec3; 2]| Elements {
///     from: [edge[0], edge[1], from[0], from[1]],
///     to: [edge[0], edge[1], to[0], to[1]],
/// };
/// let impact = ccd::edge_edge(&elements(falling(1.0), falling(-1.0)), &Options::default())?.unwrap();
/// assert!(impact.time <= 0.5 && impact.time > 0.499999);
/// assert_eq!(ccd::edge_edge(&elements(falling(1.0), falling(0.1)), &Options::default())?, None);
/// # Ok::<(), solid3d::Error>(())
/// ```
///
/// # Errors
///
/// A coordinate that is not finite or too large; a tolerance out of range.
pub fn edge_edge(elements: &Elements, options: &Options) -> Result<Option<Impact>> {
    find(&EdgeEdge(Paths::new(elements)?), options)
}

fn find(function: &impl Trilinear, options: &Options) -> Result<Option<Impact>> {
    let &Options { tolerance, boxes_max } = options;
    if !(TOLERANCE_MIN..=1.0).contains(&tolerance) {
        return Err(Error::Tolerance { argument: "tolerance", value: tolerance, least: TOLERANCE_MIN });
    }
    Ok(match earliest(function, tolerance, boxes_max) {
        Search::None => None,
        Search::Found(cell) => Some((cell, true)),
        Search::GivenUp(cell) => Some((cell, false)),
    }
    .map(|(cell, near)| Impact { time: cell.earliest, parameters: function.told(&cell), near }))
}

/// The ways of four vertices: seen from the first vertex at the start, in a unit of length in which no difference of two is more than
/// 2.
struct Paths {
    from: [DVec3; 4],
    way: [DVec3; 4],
}

impl Paths {
    fn new(elements: &Elements) -> Result<Paths> {
        for (argument, ends) in [("from", &elements.from), ("to", &elements.to)] {
            ends.iter().try_for_each(|&position| bounded(argument, position))?;
        }
        let all = || elements.from.iter().chain(&elements.to);
        let (min, max) =
            all().fold((elements.from[0], elements.from[0]), |(min, max), &p| (min.min(p), max.max(p)));
        let scale = unit_scale((max - min).max_element());
        let place = |p: DVec3| (p - elements.from[0]) * scale;
        let (from, to) = (elements.from.map(place), elements.to.map(place));
        Ok(Paths { from, way: std::array::from_fn(|i| to[i] - from[i]) })
    }

    fn at(&self, t: f64) -> [DVec3; 4] {
        std::array::from_fn(|i| self.from[i] + self.way[i] * t)
    }

    /// The largest difference of two vertices, at either end.
    fn apart(&self, i: usize, j: usize) -> f64 {
        let (start, way) = (self.from[i] - self.from[j], self.way[i] - self.way[j]);
        start.abs().max((start + way).abs()).max_element()
    }

    /// The largest difference that a unit of time makes to the difference of two vertices.
    fn drift(&self, i: usize, j: usize) -> f64 {
        (self.way[i] - self.way[j]).abs().max_element()
    }
}

/// Vertex 0 less the point of the triangle of vertices 1, 2 and 3.
struct VertexFace(Paths);

impl Trilinear for VertexFace {
    fn value(&self, [t, u, v]: [f64; 3]) -> DVec3 {
        let [p, a, b, c] = self.0.at(t);
        (p - a) - ((b - a) * u + (c - a) * v)
    }

    fn change(&self) -> [f64; 3] {
        let drift = [1, 2, 3].map(|corner| self.0.drift(0, corner)).into_iter().fold(0.0, f64::max);
        [drift, self.0.apart(1, 2), self.0.apart(1, 3)]
    }

    fn normal(&self) -> DVec3 {
        let [_, a, b, c] = self.0.at(0.5);
        (b - a).cross(c - a).normalize_or_zero()
    }

    fn outside(&self, [_, u, v]: [f64; 3]) -> bool {
        u + v > 1.0
    }

    /// The cell of a short edge is long across the triangle, and its middle may be far beyond the opposite edge.
    fn told(&self, cell: &Cell) -> [f64; 2] {
        let ([_, _, v_least], [_, u, v]) = (cell.least, cell.middle());
        let v = v.min(1.0 - u).max(v_least);
        [u.min(1.0 - v), v]
    }
}

/// A point of the edge of vertices 0 and 1 less one of the edge of vertices 2 and 3.
struct EdgeEdge(Paths);

impl Trilinear for EdgeEdge {
    fn value(&self, [t, u, v]: [f64; 3]) -> DVec3 {
        let [a, b, c, d] = self.0.at(t);
        (a - c) + ((b - a) * u - (d - c) * v)
    }

    fn change(&self) -> [f64; 3] {
        let pairs = [(0, 2), (0, 3), (1, 2), (1, 3)];
        let drift = pairs.map(|(i, j)| self.0.drift(i, j)).into_iter().fold(0.0, f64::max);
        [drift, self.0.apart(0, 1), self.0.apart(2, 3)]
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c, d] = self.0.at(0.5);
        (b - a).cross(d - c).normalize_or_zero()
    }

    fn outside(&self, _: [f64; 3]) -> bool {
        false
    }

    fn told(&self, cell: &Cell) -> [f64; 2] {
        let [_, u, v] = cell.middle();
        [u, v]
    }
}
