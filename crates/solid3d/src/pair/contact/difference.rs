//! A triangle and another, or a box, that have a point in common, in closed form.
//!
//! The difference of two polytopes is one whose facets are theirs, or spanned by an edge of each: the axes of the separating-axis theorem. How far it
//! reaches along the normal of the nearest is the depth. Where two edges are nearly parallel, rounding may tilt what they span: by how much bounds the
//! depth from below, as of [`depths`](super::super::row), and where that is too little EPA is asked.

use glam::DVec3;
use smallvec::{SmallVec, smallvec};
use solid_convex::simd::each;

use super::super::row::{CONFIRMED, CROSS_ERROR, PARALLEL_SINE, SQUARED_MIN};
use super::super::triangle_triangle::Triangle;
use super::ball::Way;
use super::face;
use super::map::Map;
use crate::shape::Body;

/// Heights that differ by no more than this along the normal of a facet are of its corners, in the unit of the pair.
const SAME_HEIGHT: f64 = 4.0 * CONFIRMED;

/// How far beyond the ends of edges they may cross, in parts of these.
const BEYOND_EDGE: f64 = 1e-9;

/// A triangle or a box, in the common frame.
pub(super) struct Polytope {
    /// From one of its corners on.
    edges: [DVec3; 3],
    form: Form,
    /// No two points of it are further from each other.
    extent: f64,
}

enum Form {
    Triangle(Triangle),
    /// By its centre.
    Box(DVec3),
}

/// The part of a polytope that is highest along a direction.
type Feature = SmallVec<[DVec3; 4]>;

impl Polytope {
    pub fn triangle(corners: Triangle) -> Polytope {
        let [p, q, r] = corners;
        let edges = [q - p, r - q, p - r];
        let extent = edges.map(DVec3::length_squared).into_iter().fold(0.0, f64::max).sqrt();
        Polytope { edges, form: Form::Triangle(corners), extent }
    }

    /// A box of a size around the origin of its space.
    pub fn cuboid(size: DVec3, map: &Map) -> Polytope {
        let m = map.linear();
        let edges = [m.x_axis * size.x, m.y_axis * size.y, m.z_axis * size.z];
        let extent = edges.map(DVec3::length).iter().sum();
        Polytope { edges, form: Form::Box(map.point(DVec3::ZERO)), extent }
    }

    /// A body that is a box.
    pub fn of(body: &face::Placed) -> Option<Polytope> {
        let Body::Cuboid(cuboid) = body.body() else { return None };
        Some(Polytope::cuboid(cuboid.size(), body.map))
    }

    /// Pairs of edges that span its facets.
    fn facets(&self) -> &'static [[usize; 2]] {
        match self.form {
            Form::Triangle(_) => &[[0, 1]],
            Form::Box(_) => &[[0, 1], [1, 2], [2, 0]],
        }
    }

    /// The least and the greatest height along a direction.
    #[inline]
    fn heights(&self, along: DVec3) -> [f64; 2] {
        match self.form {
            Form::Triangle(corners) => {
                let [p, q, r] = each(corners, |corner| along.dot(corner));
                [p.min(q).min(r), p.max(q).max(r)]
            }
            Form::Box(center) => {
                let [x, y, z] = each(self.edges, |edge| along.dot(edge).abs());
                let (middle, half) = (along.dot(center), 0.5 * (x + y + z));
                [middle - half, middle + half]
            }
        }
    }

    /// The corners that are highest along a unit vector: four at most, one after the other where they are a face.
    fn highest(&self, along: DVec3) -> Feature {
        match self.form {
            Form::Triangle(corners) => {
                let [_, top] = self.heights(along);
                corners.into_iter().filter(|corner| along.dot(*corner) >= top - SAME_HEIGHT).collect()
            }
            Form::Box(center) => {
                let mut corners: Feature = smallvec![center];
                for edge in self.edges {
                    let height = along.dot(edge);
                    let half = 0.5 * edge;
                    if height.abs() <= SAME_HEIGHT {
                        let others: Feature = corners.iter().rev().map(|corner| corner + half).collect();
                        corners.iter_mut().for_each(|corner| *corner -= half);
                        corners.extend(others);
                    } else {
                        corners.iter_mut().for_each(|corner| *corner += half * height.signum());
                    }
                }
                corners
            }
        }
    }
}

/// The shortest way of a polytope out of a triangle with which it has a point in common. `None` where rounding hides it, or which points touch last.
pub(super) fn way(triangle: &Polytope, other: &Polytope) -> Option<Way> {
    let mut nearest = Nearest {
        polytopes: [triangle, other],
        depth: f64::INFINITY,
        least: f64::INFINITY,
        out: DVec3::ZERO,
    };
    for polytope in [triangle, other] {
        for &[i, j] in polytope.facets() {
            nearest.take(polytope.edges[i], polytope.edges[j]);
        }
    }
    for e in triangle.edges {
        for f in other.edges {
            nearest.take(e, f);
        }
    }
    let Nearest { depth, out, .. } = nearest;
    nearest.is_confirmed().then_some(())?;
    let foot = match (&triangle.highest(out)[..], &other.highest(-out)[..]) {
        (&[corner], _) => corner,
        (_, &[corner]) => corner + out * depth,
        (&[p, q], &[r, s]) => crossing([p, q], [r, s], out)?,
        _ => return None,
    };
    Some(Way { out, depth, foot })
}

/// The nearest facet of a difference so far.
struct Nearest<'a> {
    polytopes: [&'a Polytope; 2],
    /// By how much the two overlap along its normal.
    depth: f64,
    /// By how much at least along any, if edges are as they seem.
    least: f64,
    /// Its unit normal, along which the second leaves the first.
    out: DVec3,
}

impl Nearest<'_> {
    /// Takes in the facet that two edges span, if they do.
    #[inline]
    fn take(&mut self, e: DVec3, f: DVec3) {
        let axis = e.cross(f);
        let (squared, lengths) = (axis.length_squared(), e.length_squared() * f.length_squared());
        if squared <= (lengths * (PARALLEL_SINE * PARALLEL_SINE)).max(SQUARED_MIN) {
            return;
        }
        let [[low, high], [other_low, other_high]] = self.polytopes.map(|polytope| polytope.heights(axis));
        let (forth, back) = (high - other_low, other_high - low);
        let per_length = 1.0 / squared.sqrt();
        let depth = forth.min(back) * per_length;
        let tilt = CROSS_ERROR * lengths.sqrt() * per_length;
        self.least = self.least.min(depth - tilt * self.reach());
        if depth < self.depth {
            self.depth = depth;
            self.out = axis * (if forth <= back { per_length } else { -per_length });
        }
    }

    /// No point of the difference is further from the origin, which is in it.
    fn reach(&self) -> f64 {
        let [a, b] = self.polytopes;
        a.extent + b.extent
    }

    /// Whether the depth is right up to rounding; edges that were taken for parallel may span facets that are as far off as this takes in.
    fn is_confirmed(&self) -> bool {
        self.depth - self.least + 4.0 * PARALLEL_SINE * self.reach() <= CONFIRMED
    }
}

/// Where an edge crosses another, seen along a unit vector: the point of the first. `None` where they are parallel, or do not.
fn crossing([p, q]: [DVec3; 2], [r, s]: [DVec3; 2], along: DVec3) -> Option<DVec3> {
    let (first, second, between) = (q - p, s - r, r - p);
    let across = along.dot(first.cross(second));
    let [t, u] = each([second, first], |edge| along.dot(between.cross(edge)) / across);
    let is_on = |part: f64| (-BEYOND_EDGE..=1.0 + BEYOND_EDGE).contains(&part);
    (is_on(t) && is_on(u)).then(|| p + first * t)
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DQuat};
    use solid_convex::{Cuboid, Points, Support, epa, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::ways::assert_is_shortest;
    use super::*;

    /// Law: where there is an answer it is within the bounds of EPA, and its points are each in their object. There is one of nearly all pairs but slivers,
    /// those in one plane, and those with parallel edges.
    #[test]
    fn the_way_out_is_the_shortest() {
        let mut rng = seeded(176);
        for is_box in [false, true] {
            let (mut answers, mut meet) = ([0; 4], [0; 4]);
            for case in 0..8_000 {
                let kind = case % 4;
                let mut triangle = || -> Triangle {
                    let [p, q, r] = [(); 3].map(|()| in_cube(&mut rng));
                    match kind {
                        0 => [p, q, r],
                        1 => [p, q, r].map(|corner| corner * 1e-3),
                        2 => [p, q, p.lerp(q, 0.3) + r * 1e-7],
                        _ => [p, p + DVec3::X, r],
                    }
                };
                let (x, y) = (triangle(), triangle());
                let y = if kind == 2 { [(); 3].map(|()| in_cube(&mut rng)) } else { y };
                let turn = match kind {
                    3 => DMat3::IDENTITY,
                    _ => DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0)),
                };
                let stretch = DVec3::new(1.0, [1.0, 0.2][case / 4 % 2], 1.0);
                let at = DAffine3 {
                    matrix3: turn * DMat3::from_diagonal(stretch) * [0.5, 1e-3][case % 2],
                    translation: x[0].lerp(x[1], 0.4) + in_cube(&mut rng) * [0.2, 1e-3][case % 2],
                };
                let size = DVec3::new(1.0, 0.7, 0.4);
                let (cuboid, points) = (Cuboid::new(size).unwrap(), Points::new(&y).unwrap());
                let (support, at): (&dyn Support, _) =
                    if is_box { (&cuboid, at) } else { (&points, DAffine3::IDENTITY) };
                let one = Points::new(&x).unwrap();
                let here = DAffine3::IDENTITY;
                if epa::penetration(support, &at, &one, &here).is_none_or(|found| found.depth < 1e-9) {
                    continue;
                }
                meet[kind] += 1;
                let other =
                    if is_box { Polytope::cuboid(size, &Map::new(at)) } else { Polytope::triangle(y) };
                let Some(found) = way(&Polytope::triangle(x), &other) else { continue };
                answers[kind] += 1;
                let context = format!("{is_box}, case {case}");
                assert_is_shortest(&found, &x, support, &at, &context);
                let Way { out, depth, foot } = found;
                let last = [(foot, &one as &dyn Support, here), (foot - out * depth, support, at)];
                for (point, object, at) in last {
                    let point_at = DAffine3::from_translation(point);
                    let off =
                        gjk::closest_points(&Points::new(&[DVec3::ZERO]).unwrap(), &point_at, object, &at);
                    assert!(off.distance < 1e-5, "{context}: {off:?}");
                }
            }
            println!("box {is_box}: {answers:?} of {meet:?}");
            assert!(meet.iter().all(|&meet| meet > 100) && answers[0] * 100 > meet[0] * 99);
        }
    }
}
