use rand::SeedableRng;
use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use solid3d::glam::{DMat3, DVec3};

use super::{ConvexTest, Counters, Memory, Pair, Polytope};

/// A common point by linear programming: a point in the halfspaces of all facets of both polytopes (thesis, section 4.1).
///
/// Source: Seidel, *Small-dimensional linear programming and convex hulls made easy*, 1991: constraints are added in random order,
/// and where one cuts the optimum off, the new one lies on its boundary: a problem with one dimension less. Expected linear time.
#[derive(Clone, Debug)]
pub struct LinearProgram {
    counters: Counters,
    rng: StdRng,
    halfspaces: Vec<Halfspace>,
}

/// The points x with `normal . x <= bound`.
#[derive(Clone, Copy, Debug)]
struct Halfspace {
    normal: DVec3,
    bound: f64,
}

/// The search is within a cube this many times as large as the distances of the corners of both objects from the origin.
const BOX: f64 = 4.0;

/// How far a point may be outside and count as in, in sizes of the objects: some roundings of each of the three reductions.
const FEASIBLE: f64 = 1e-12;

impl Default for LinearProgram {
    fn default() -> Self {
        // Any order will do; a fixed one repeats.
        LinearProgram {
            counters: Counters::default(),
            rng: StdRng::seed_from_u64(84),
            halfspaces: Vec::new(),
        }
    }
}

impl ConvexTest for LinearProgram {
    fn name(&self) -> &'static str {
        "linear program (Seidel)"
    }

    /// Needs solid polytopes, of dimension three; iterations are problems of lower dimension.
    fn intersects(&mut self, pair: &Pair, _: &mut Memory) -> bool {
        self.counters.tests += 1;
        self.halfspaces.clear();
        let mut size = 0.0f64;
        for (polytope, placement) in [(pair.a, pair.placement_a), (pair.b, pair.placement_b)] {
            let at = |i: u32| placement.transform_point3(polytope.vertices()[i as usize]);
            size = (0..polytope.vertices().len() as u32).fold(size, |size, i| size.max(at(i).length()));
            self.halfspaces.extend(facets(polytope).map(|corners| {
                let [p, q, r] = corners.map(at);
                let normal = (q - p).cross(r - p).normalize_or_zero();
                Halfspace { normal, bound: normal.dot(p) }
            }));
        }
        self.halfspaces.shuffle(&mut self.rng);
        let (solved, problems) = feasible(&self.halfspaces, BOX * size, FEASIBLE * size);
        self.counters.iterations += problems;
        solved
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

fn facets(polytope: &Polytope) -> impl Iterator<Item = [u32; 3]> + '_ {
    polytope.triangles().iter().copied()
}

/// Whether some x of the cube of half size `reach` is in all halfspaces, and how many planes were searched for it. The objective is
/// any; it is the direction (1, 1, 1).
fn feasible(halfspaces: &[Halfspace], reach: f64, slack: f64) -> (bool, u64) {
    let objective = DVec3::ONE;
    let mut x = DVec3::splat(reach);
    let mut problems = 1;
    for (i, h) in halfspaces.iter().enumerate() {
        if h.normal.dot(x) <= h.bound + slack {
            continue;
        }
        problems += 1;
        match on_plane(h, &halfspaces[..i], objective, reach, slack) {
            Some(optimum) => x = optimum,
            None => return (false, problems),
        }
    }
    (true, problems)
}

/// The optimum on the boundary of `h` within the other halfspaces and the cube, if there is any.
fn on_plane(h: &Halfspace, others: &[Halfspace], objective: DVec3, reach: f64, slack: f64) -> Option<DVec3> {
    // Coordinates in the plane: two directions, from the point of the plane nearest to the origin.
    let (u, v) = h.normal.any_orthonormal_pair();
    let frame = DMat3::from_cols(u, v, h.normal);
    let origin = h.normal * h.bound;
    let goal = [objective.dot(u), objective.dot(v)];
    let lines: Vec<([f64; 2], f64)> = others
        .iter()
        .copied()
        .chain(cube(reach))
        .map(|g| ([g.normal.dot(u), g.normal.dot(v)], g.bound - g.normal.dot(origin)))
        .collect();
    let corner = |c: f64| if c < 0.0 { -2.0 * reach } else { 2.0 * reach };
    let mut x = [corner(goal[0]), corner(goal[1])];
    for (i, (normal, bound)) in lines.iter().enumerate() {
        if normal[0] * x[0] + normal[1] * x[1] <= bound + slack {
            continue;
        }
        x = on_line(*normal, *bound, &lines[..i], goal, reach, slack)?;
    }
    Some(origin + frame * DVec3::new(x[0], x[1], 0.0))
}

/// The optimum on the boundary of a halfplane within the others and a square, if there is any.
fn on_line(
    normal: [f64; 2],
    bound: f64,
    others: &[([f64; 2], f64)],
    goal: [f64; 2],
    reach: f64,
    slack: f64,
) -> Option<[f64; 2]> {
    let squared = normal[0] * normal[0] + normal[1] * normal[1];
    if squared <= PARALLEL * PARALLEL {
        // The planes are parallel, and this one is beyond the other.
        return None;
    }
    let origin = [normal[0] * bound / squared, normal[1] * bound / squared];
    let along = [-normal[1] / squared.sqrt(), normal[0] / squared.sqrt()];
    let (mut low, mut high) = (-4.0 * reach, 4.0 * reach);
    for (n, b) in others {
        let (speed, rest) = (n[0] * along[0] + n[1] * along[1], b - n[0] * origin[0] - n[1] * origin[1]);
        if speed > PARALLEL {
            high = high.min(rest / speed);
        } else if speed < -PARALLEL {
            low = low.max(rest / speed);
        } else if rest < -slack {
            return None;
        }
    }
    if low > high + slack {
        return None;
    }
    let t = if goal[0] * along[0] + goal[1] * along[1] < 0.0 { low } else { high };
    Some([origin[0] + t * along[0], origin[1] + t * along[1]])
}

/// The sine of an angle at which planes are parallel: beyond it they meet farther away than the objects are.
const PARALLEL: f64 = 1e-13;

fn cube(reach: f64) -> impl Iterator<Item = Halfspace> {
    DVec3::AXES
        .into_iter()
        .flat_map(move |axis| [axis, -axis].map(|normal| Halfspace { normal, bound: reach }))
}
