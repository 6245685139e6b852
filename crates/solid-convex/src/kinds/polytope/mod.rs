//! The convex hull of many points, laid out for speed.

mod balls;
mod direction_map;
mod plane;
mod planes;
mod rows;

use fearless_simd::Simd;
use glam::{DMat3, DVec3};

use super::points::{mean, reach};
use crate::Support;
use crate::difference::Vertex;
use crate::gjk::{Ball, Balls};
use crate::simd::{self, dispatch};
use crate::support::bounds_by_supports;
use direction_map::DirectionMap;
use plane::Plane;
pub use planes::FaceTowards;
pub(crate) use planes::{Passage, Planes};
use rows::Rows;

/// Points beyond which support points are looked up by direction first. Below, comparing all of them is as fast.
const SCAN_MAX: usize = 192;

/// Points beyond which the bounds of an image are found by support points. Below, mapping all of them takes fewer instructions.
const IMAGE_MAX: usize = 400;

/// Planes of so many faces are kept, of 192 points: among more, a search takes hardly longer than to look at all of them.
const PLANES_MAX: usize = 384;

/// The convex hull of points, as [`Points`](super::Points), with the same answers to the bit, found faster: up to 192 points by
/// comparing all of them with vector instructions; more by comparing those few that can be the furthest in directions near the
/// one asked for.
///
/// Memory: 48 bytes a point; of more than 192 points some 50 more, and at most 200; 40 for each of up to 384 faces that are known. Cost of a support point: some 25 ns, however many
/// points there are, where the hull is round; where many points are about as far as each other, as the rim of a
/// drum is along its axis, as long as it takes to compare these.
///
/// ```
/// use solid_convex::{Polytope, Support};
/// use glam::DVec3;
/// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
/// assert_eq!(corner.support(DVec3::new(1.0, 2.0, 3.0)), DVec3::Z);
/// assert!(Polytope::new(Vec::new()).is_none());
/// ```
#[derive(Clone, Debug)]
pub struct Polytope {
    points: Vec<DVec3>,
    rows: Rows,
    map: Option<DirectionMap>,
    reach: DVec3,
    /// The mean.
    center: DVec3,
    /// How far the farthest point is from the local origin.
    farthest: f64,
    balls: Balls,
    /// Those of the balls.
    sure_radii: [f64; 2],
    /// Of all faces, where these are known, and few.
    planes: Option<Planes>,
}

impl Polytope {
    /// The hull of `points`; `None` for no points. Cost: O(n), of more than 192 points O(n log n) where the hull is round.
    pub fn new(points: Vec<DVec3>) -> Option<Self> {
        let rows = Rows::new(&points)?;
        let (reach, center) = (reach(points.iter().copied()), mean(points.iter().copied()));
        let farthest = balls::farthest(&points, DVec3::ZERO);
        let map = (points.len() > SCAN_MAX).then(|| DirectionMap::new(&points, reach)).flatten();
        let balls = Balls { inner: Ball { center, radius: 0.0 }, outer: balls::around(&points, center) };
        let sure_radii = balls.sure_radii();
        Some(Polytope { points, rows, map, reach, center, farthest, balls, sure_radii, planes: None })
    }

    /// The memory that it owns, in bytes.
    ///
    /// ```
    /// use solid_convex::Polytope;
    /// use glam::DVec3;
    /// let points: Vec<DVec3> = (0..96).map(|i| DVec3::new(1.0, 0.1 * f64::from(i), 0.0)).collect();
    /// assert_eq!(Polytope::new(points).unwrap().bytes(), 48 * 96);
    /// ```
    pub fn bytes(&self) -> usize {
        let map = self.map.as_ref().map_or(0, DirectionMap::bytes);
        self.points.capacity() * size_of::<DVec3>()
            + self.rows.bytes()
            + map
            + self.planes.as_ref().map_or(0, Planes::bytes)
    }

    /// The same, where the faces of the hull are known: the triangles `faces` of its points, which close it, counter-clockwise seen from outside. Many
    /// pairs that are deep in each other are then found without a search. Of faces that leave a hole, the answers may be wrong. Cost: O(n).
    ///
    /// # Panics
    /// If a face names a point that there is not.
    ///
    /// ```
    /// use solid_convex::{Polytope, Support};
    /// use glam::DVec3;
    /// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    /// let corner = corner.with_faces(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    /// let radius = corner.balls().unwrap().inner.radius; // at most 1 / (3 + sqrt(3))
    /// assert!((0.2..0.2114).contains(&radius));
    /// ```
    pub fn with_faces(mut self, faces: &[[u32; 3]]) -> Self {
        let planes = Plane::all(&self.points, faces);
        self.balls.inner = balls::inside(&self.points, self.center, &planes);
        self.sure_radii = self.balls.sure_radii();
        let are_few = planes.len() <= PLANES_MAX;
        self.planes = are_few.then(|| Planes::new(&planes, &self.points, self.center)).flatten();
        self
    }

    /// The planes of its faces, where these are known, and few.
    pub(crate) fn planes(&self) -> Option<&Planes> {
        self.planes.as_ref()
    }

    /// The face that is towards a point. `None` where faces are unknown, or more than 384, or rounding may decide which it is, among slivers. Cost:
    /// O(faces), some 15 ns where there are 36, and as much again outside.
    ///
    /// ```
    /// use solid_convex::Polytope;
    /// use glam::DVec3;
    /// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    /// let corner = corner.with_faces(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    /// let below = corner.face_towards(DVec3::new(0.25, 0.25, -2.0)).unwrap();
    /// assert_eq!((below.distance, below.normal, below.is_nearest), (2.0, DVec3::NEG_Z, true));
    /// let inside = corner.face_towards(DVec3::new(0.25, 0.25, 0.125)).unwrap();
    /// assert_eq!((inside.distance, inside.normal, inside.is_nearest), (-0.125, DVec3::NEG_Z, true));
    /// let beside = corner.face_towards(DVec3::new(2.0, 0.0, -3.0)).unwrap();
    /// assert_eq!((beside.distance, beside.is_nearest), (3.0, false));
    /// ```
    pub fn face_towards(&self, point: DVec3) -> Option<FaceTowards> {
        let planes = self.planes.as_ref()?;
        let way = point - self.center;
        dispatch!(simd => planes.towards(simd, way))
    }

    /// The balls around and in it.
    #[inline]
    pub(crate) fn own_balls(&self) -> &Balls {
        &self.balls
    }

    /// How far its farthest point is from the local origin.
    #[inline]
    #[doc(hidden)]
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// What [`Balls::sure_radii`] gives of them.
    #[inline]
    pub(crate) fn sure_radii(&self) -> [f64; 2] {
        self.sure_radii
    }

    /// The support point, for searches that are compiled into one piece with it: but for those without vectors, of which each copy would be
    /// long, and which nobody is in a hurry for.
    #[inline(always)]
    pub(crate) fn furthest<S: Simd>(&self, simd: S, direction: DVec3) -> Vertex {
        simd::part!(simd => self.furthest_within(simd, direction))
    }

    #[inline(always)]
    fn furthest_within<S: Simd>(&self, simd: S, direction: DVec3) -> Vertex {
        match self.furthest_mapped(direction) {
            Some(furthest) => Vertex::new(self.point_at(furthest), furthest),
            None => self.vertex_in_rows(self.rows.furthest(simd, direction)),
        }
    }

    /// The point of an index; of one past the end, the last.
    #[inline(always)]
    pub(crate) fn vertex(&self, index: u16) -> DVec3 {
        self.rows.point_at(usize::from(index))
    }

    /// Of a direction that is no number, none is the furthest: the index is past the end.
    #[inline(always)]
    fn point_at(&self, furthest: usize) -> DVec3 {
        self.points[furthest.min(self.points.len() - 1)]
    }

    /// The same from the rows, after all of them were compared.
    #[inline(always)]
    fn vertex_in_rows(&self, furthest: usize) -> Vertex {
        Vertex::new(self.rows.point_at(furthest), furthest)
    }

    /// The index of the furthest point, where there are so many that they are mapped.
    #[inline(always)]
    fn furthest_mapped(&self, direction: DVec3) -> Option<usize> {
        self.map.as_ref().and_then(|map| map.furthest(&self.points, direction))
    }

    /// The support points of two, each along a direction of its own, for kernels with vectors.
    #[inline(always)]
    pub(crate) fn furthest_of_both<S: Simd>(
        simd: S,
        [a, b]: [&Polytope; 2],
        along: [DVec3; 2],
    ) -> [Vertex; 2] {
        // Those that are mapped are many.
        if Polytope::are_few([a, b]) {
            let [on_a, on_b] = Rows::furthest_of_both(simd, [&a.rows, &b.rows], along);
            return [a.vertex_in_rows(on_a), b.vertex_in_rows(on_b)];
        }
        [a.furthest_of_many(simd, along[0]), b.furthest_of_many(simd, along[1])]
    }

    /// The products of those with their directions; and the points themselves, unless they [`are_few`](Polytope::are_few).
    #[inline(always)]
    pub(crate) fn greatest_of_both<S: Simd>(
        simd: S,
        [a, b]: [&Polytope; 2],
        along: [DVec3; 2],
        furthest: &mut [DVec3; 2],
    ) -> [f64; 2] {
        if Polytope::are_few([a, b]) {
            return Rows::greatest_of_both(simd, [&a.rows, &b.rows], along);
        }
        let [on_a, on_b] = [a.furthest_of_many(simd, along[0]), b.furthest_of_many(simd, along[1])];
        *furthest = [on_a.point, on_b.point];
        [on_a.point.dot(along[0]), on_b.point.dot(along[1])]
    }

    /// Whether the points of both are so few that all products stay in registers.
    #[inline(always)]
    pub(crate) fn are_few([a, b]: [&Polytope; 2]) -> bool {
        a.rows.are_few() && b.rows.are_few()
    }

    #[inline(always)]
    fn furthest_of_many<S: Simd>(&self, simd: S, direction: DVec3) -> Vertex {
        match self.furthest_mapped(direction) {
            Some(furthest) => Vertex::new(self.point_at(furthest), furthest),
            None => self.vertex_in_rows(self.rows.furthest_of_many(simd, direction)),
        }
    }

    /// The [`image_bounds`](Support::image_bounds), for kernels that they are a part of.
    #[doc(hidden)]
    #[inline(always)]
    pub fn image_bounds_by<S: Simd>(&self, simd: S, linear: &DMat3) -> [DVec3; 2] {
        if self.points.len() > IMAGE_MAX && self.map.is_some() {
            return bounds_by_supports(self, linear);
        }
        self.rows.image_bounds(simd, linear)
    }

    /// The points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Which of the [`points`](Polytope::points) is the furthest along a direction, the first of equals: the index of the support point, at the same
    /// cost.
    ///
    /// ```
    /// use solid_convex::Polytope;
    /// use glam::DVec3;
    /// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    /// assert_eq!(corner.support_index(DVec3::new(1.0, 2.0, 3.0)), 3);
    /// ```
    pub fn support_index(&self, direction: DVec3) -> usize {
        let in_rows = || dispatch!(simd => self.rows.furthest(simd, direction));
        self.furthest_mapped(direction).unwrap_or_else(in_rows).min(self.points.len() - 1)
    }
}

impl Support for Polytope {
    #[inline]
    fn support(&self, direction: DVec3) -> DVec3 {
        dispatch!(simd => self.furthest(simd, direction).point)
    }

    fn image_bounds(&self, linear: &DMat3) -> [DVec3; 2] {
        dispatch!(simd => self.image_bounds_by(simd, linear))
    }

    fn as_polytope(&self) -> Option<&Polytope> {
        Some(self)
    }

    fn reach(&self) -> DVec3 {
        self.reach
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    #[inline]
    fn balls(&self) -> Option<Balls> {
        Some(self.balls)
    }

    fn contains_ball(&self, ball: Ball) -> bool {
        self.balls.inner.contains(ball)
            || self.planes.as_ref().is_some_and(|planes| {
                let way = ball.center - self.center;
                dispatch!(simd => planes.contain(simd, way, ball.radius))
            })
    }

    fn is_polytope(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;
    use crate::Points;

    /// Random numbers in [-1, 1).
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut rng = seeded(seed);
        move || rng.random_range(-1.0..1.0)
    }

    /// Balls, boxes of points, drums, plates and lines, with duplicates.
    fn clouds(count: usize) -> Vec<Vec<DVec3>> {
        let mut next = numbers(count as u64);
        let any: Vec<DVec3> = (0..count).map(|_| DVec3::new(next(), next(), next())).collect();
        let angle = |i: usize| 7.0 * i as f64 / count as f64;
        vec![
            any.iter().map(|p| p.normalize()).collect(),
            any.iter().map(|p| (p * 4.0).round()).collect(),
            (0..count).map(|i| DVec3::new(angle(i).cos(), (i % 2) as f64, angle(i).sin())).collect(),
            any.iter().map(|p| p.normalize() * DVec3::new(1.0, 1e-9, 1e-3) + DVec3::splat(5.0)).collect(),
            any.iter().map(|p| DVec3::new(p.x, 0.0, 0.0) * 1e80).collect(),
        ]
    }

    fn directions(seed: u64) -> Vec<DVec3> {
        let mut next = numbers(seed);
        let grid = (0..125).map(|d| DVec3::new((d % 5) as f64, (d / 5 % 5) as f64, (d / 25) as f64) - 2.0);
        let mut all: Vec<DVec3> = grid.collect();
        all.extend((0..200).map(|_| DVec3::new(next(), next(), next())));
        // Next to the axes and to the diagonals, where the faces of the map meet.
        all.extend((0..200).map(|_| {
            DVec3::new(next(), next(), next()).round() + 1e-16 * DVec3::new(next(), next(), next())
        }));
        all.extend((0..20).map(|_| DVec3::new(next(), next(), next()) * 1e-290));
        all.extend([DVec3::splat(5e-324), DVec3::splat(f64::NAN), DVec3::INFINITY]);
        all
    }

    /// The slow twin is the scan over the points in order; grids have many ties.
    #[test]
    fn same_as_the_scan() {
        for count in (1..60).chain([65, 100, 193, 201, 500, 3_000]) {
            for (kind, points) in clouds(count).into_iter().enumerate() {
                let polytope = Polytope::new(points.clone()).unwrap();
                let scan = Points::new(&points).unwrap();
                for direction in directions(count as u64) {
                    if direction.is_finite() {
                        let found = polytope.support(direction);
                        let context = format!("{count} of kind {kind}, along {direction}");
                        assert_eq!(found, scan.support(direction), "{context}");
                        let index = polytope.support_index(direction);
                        let is_first = |&i: &usize| points[i].dot(direction) == found.dot(direction);
                        assert_eq!(Some(index), (0..points.len()).find(is_first), "{context}");
                    } else {
                        assert!(points.contains(&polytope.support(direction)));
                        assert!(polytope.support_index(direction) < points.len());
                    }
                }
            }
        }
    }

    #[test]
    fn round_hulls_are_mapped_and_lists_stay_short() {
        for count in [300, 1_000, 10_000] {
            let polytope = Polytope::new(clouds(count).swap_remove(0)).unwrap();
            let map = polytope.map.expect("there are many points");
            assert!(map.mean_length() < 24.0, "{} of {count}", map.mean_length());
            assert!(map.entries() <= 20 * count, "{} of {count}", map.entries());
        }
    }
}
