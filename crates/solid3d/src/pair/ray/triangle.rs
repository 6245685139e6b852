//! A ray against triangles, watertight.
//!
//! Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection*, 2013: space is sheared so that the ray runs along an axis from the
//! origin, and the question is whether a triangle of the plane has the origin in it. Each corner is sheared by itself, so triangles
//! that share it see the same point of the plane; then the signs of the edges are exact. So whatever surrounds the ray is hit:
//! none slips between triangles that share an edge or a corner, nor through a closed mesh.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};
use glam::{DVec2, DVec3};
use solid_convex::determinant::difference_of_products;
use solid_convex::simd::{dispatch, each};
use solid_convex::unit_scale;

use super::super::crossing::{sign, winding};
use crate::triangle_triangle::Triangle;

/// Space as a ray sees it.
pub(super) struct Shear {
    pub origin: DVec3,
    /// The axes: the last is the one along which the ray runs most. A cyclic order, reversed when it runs backward.
    pub axes: [usize; 3],
    /// How far the ray runs along the first two axes, for each unit along the last: at most one.
    pub shear: DVec2,
    /// Local lengths along the axes, once sheared, times these are those of the sheared space: powers of two, so that no product overflows or vanishes.
    scales: [f64; 3],
    /// Depths in the sheared space times this are parameters of the ray.
    depth_to_t: f64,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TriangleHit {
    pub t: f64,
    /// The weights of the corners.
    pub barycentric: [f64; 3],
    /// Whether the side is the back; `None` seen edge on.
    pub back: Option<bool>,
}

/// Triangles that are looked at together.
pub(super) const LANES: usize = 8;

/// The corners of eight triangles: for each corner and each axis of their space, the coordinates.
pub(super) type Corners = [[[f64; LANES]; 3]; 3];

/// Puts a triangle into a lane.
#[inline]
pub(super) fn put(corners: &mut Corners, lane: usize, triangle: [&DVec3; 3]) {
    for ([x, y, z], corner) in corners.iter_mut().zip(triangle) {
        (x[lane], y[lane], z[lane]) = (corner.x, corner.y, corner.z);
    }
}

/// Rounding of a determinant of two products is below this times the sum of their magnitudes.
const DETERMINANT_ERROR: f64 = 2.0 * f64::EPSILON;

/// Where the rounding of areas may be above this share of the area of their triangle, they are found to the last bits: they are the
/// weights of the corners.
const WEIGHT_ERROR: f64 = 32.0 * f64::EPSILON;

/// Where what is across a ray is below this part of the size of the data, it has a unit of its own: in the unit of that size products of two such lengths,
/// 1e-120 and less, would soon have no digits, nor would what rounding takes from them.
const UNEVEN: f64 = 1e-60;

impl Shear {
    /// The data lies no further than about `reach` from the origin, along each axis.
    pub fn new(origin: DVec3, direction: DVec3, reach: DVec3) -> Shear {
        let magnitude = direction.abs();
        // Without branches, which would be foretold wrongly.
        let second = usize::from(magnitude.y > magnitude.x);
        let main = if magnitude.z > magnitude.x.max(magnitude.y) { 2 } else { second };
        let (next, last) = ((main + 1) % 3, (main + 2) % 3);
        let axes = if direction[main] < 0.0 { [last, next, main] } else { [next, last, main] };
        let shear = DVec2::new(direction[axes[0]], direction[axes[1]]) / direction[main];
        let reach_across = |i: usize| reach[axes[i]] + shear[i].abs() * reach[main];
        let (size, across) = (reach.max_element(), [reach_across(0), reach_across(1)]);
        let scales = if across[0].min(across[1]) < UNEVEN * size {
            [across[0], across[1], reach[main]].map(unit_scale)
        } else {
            [unit_scale(size); 3]
        };
        Shear { origin, axes, shear, scales, depth_to_t: 1.0 / scales[2] / direction[main] }
    }

    /// The triangles that may be hit, as bits: of the others two edges surely pass the ray on different sides.
    #[inline]
    pub fn candidates(&self, corners: &Corners) -> u32 {
        dispatch!(simd => self.candidates_on(simd, corners))
    }

    #[inline(always)]
    fn candidates_on<S: Simd>(&self, simd: S, corners: &Corners) -> u32 {
        // Loops, not closures: what is called from a closure is compiled for the baseline, and nothing of it is inlined.
        let error = f64x8::splat(simd, DETERMINANT_ERROR);
        let zero = f64x8::splat(simd, 0.0);
        // The same operations as for one.
        let mut points = [[zero; 2]; 3];
        for (point, rows) in points.iter_mut().zip(corners) {
            let mut local = [zero; 3];
            for axis in 0..3 {
                let origin = f64x8::splat(simd, self.origin[self.axes[axis]]);
                local[axis] = f64x8::from_slice(simd, &rows[self.axes[axis]]) - origin;
            }
            for axis in 0..2 {
                let sheared = local[axis] - f64x8::splat(simd, self.shear[axis]) * local[2];
                point[axis] = sheared * f64x8::splat(simd, self.scales[axis]);
            }
        }
        let none = zero.simd_gt(zero);
        let (mut left, mut right) = (none, none);
        for [i, j] in [[1, 2], [2, 0], [0, 1]] {
            let (x, y) = (points[i][0] * points[j][1], points[i][1] * points[j][0]);
            let (area, doubt) = (x - y, error * (x.abs() + y.abs()));
            left |= area.simd_gt(doubt);
            right |= (-area).simd_gt(doubt);
        }
        let missed = left & right;
        !(missed.to_bitmask() as u32) & ((1 << LANES) - 1)
    }

    #[inline]
    fn point(&self, p: DVec3) -> DVec3 {
        let p = p - self.origin;
        let [x, y, z] = self.axes;
        let sheared = DVec3::new(p[x] - self.shear.x * p[z], p[y] - self.shear.y * p[z], p[z]);
        sheared * DVec3::from_array(self.scales)
    }

    /// Where the ray, from its origin on, meets a triangle.
    #[inline]
    pub fn hit(&self, triangle: &Triangle) -> Option<TriangleHit> {
        let [a, b, c] = each(*triangle, |p| self.point(p));
        // Of each corner twice the area that the origin makes with the edge opposite to it.
        let edges = [[b, c], [c, a], [a, b]];
        let products = each(edges, |[p, q]| (p.x * q.y, p.y * q.x));
        let mut areas = each(products, |(x, y)| x - y);
        let doubts = each(products, |(x, y)| DETERMINANT_ERROR * (x.abs() + y.abs()));
        let sure = |sign: f64| (0..3).any(|i| sign * areas[i] > doubts[i]);
        if sure(1.0) && sure(-1.0) {
            return None;
        }
        let exactly = |[p, q]: [DVec3; 2]| difference_of_products(p.x, q.y, p.y, q.x);
        for ((area, doubt), edge) in areas.iter_mut().zip(doubts).zip(edges) {
            if area.abs() <= doubt {
                *area = exactly(edge);
            }
        }
        let turns = |sign: f64| areas.iter().any(|area| sign * area > 0.0);
        let (left, right) = (turns(1.0), turns(-1.0));
        if left && right {
            return None;
        }
        let mut sum = areas[0] + areas[1] + areas[2];
        if !(left || right) || sum == 0.0 {
            return self.edge_on([a, b, c]);
        }
        // A sliver, or a triangle that is seen nearly edge on.
        if doubts.iter().any(|&doubt| doubt > WEIGHT_ERROR * sum.abs()) {
            areas = edges.map(exactly);
            sum = areas[0] + areas[1] + areas[2];
        }
        let barycentric = each(areas, |area| area / sum);
        // Divided last: from a triangle on a lattice a ray that starts on it has no way to go, exactly.
        let depth = (areas[0] * a.z + areas[1] * b.z + areas[2] * c.z) / sum;
        let t = depth * self.depth_to_t;
        (t >= 0.0).then_some(TriangleHit { t, barycentric, back: Some(left) })
    }

    /// How a triangle winds around the line of the ray, seen along it: the signs are those of [`hit`](Shear::hit), but a line that meets an edge or
    /// a corner is moved, so that of a closed mesh the sum is 0.
    pub fn winding(&self, triangle: &Triangle) -> i64 {
        let [a, b, c] = each(*triangle, |p| self.point(p).truncate());
        let edges = [[b, c], [c, a], [a, b]];
        winding(each(edges, |[p, q]| sign(difference_of_products(p.x, q.y, p.y, q.x))), edges)
    }

    /// A triangle in a plane with the ray, of which some edge meets the line of the ray, exactly: from the first point of it
    /// on. Segments and points, as degenerate triangles, are hit like this.
    fn edge_on(&self, corners: [DVec3; 3]) -> Option<TriangleHit> {
        let (mut first, mut last): (Option<TriangleHit>, Option<TriangleHit>) = (None, None);
        for [i, j] in [[0, 1], [1, 2], [2, 0]] {
            let (p, q) = (corners[i], corners[j]);
            if p.x * q.x > 0.0 || p.y * q.y > 0.0 {
                continue;
            }
            let [of_p, of_q] = [p, q].map(|p| p.truncate().abs().max_element());
            let both = of_p + of_q;
            // Along the ray both ends count, across it the point between: with one division, so that what is 0 stays so.
            let between = || ((p.z * of_q + q.z * of_p) / both, of_p / both);
            for (depth, of_j) in if both == 0.0 { [(p.z, 0.0), (q.z, 1.0)] } else { [between(); 2] } {
                let mut barycentric = [0.0; 3];
                (barycentric[i], barycentric[j]) = (1.0 - of_j, of_j);
                let t = depth * self.depth_to_t;
                let hit = TriangleHit { t, barycentric, back: None };
                first = first.filter(|first| first.t <= t).or(Some(hit));
                last = last.filter(|last| last.t >= t).or(Some(hit));
            }
        }
        let (first, last) = (first?, last?);
        if last.t < 0.0 {
            return None;
        }
        if first.t >= 0.0 {
            return Some(first);
        }
        // The ray starts in the triangle.
        let share = -first.t / (last.t - first.t);
        let weight = |i: usize| first.barycentric[i] * (1.0 - share) + last.barycentric[i] * share;
        Some(TriangleHit { t: 0.0, barycentric: [weight(0), weight(1), weight(2)], back: None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::orient2d;
    use rand::Rng;
    use solid_convex::simd::levels;
    use solid_oracle::generate::seeded;
    use solid_oracle::triangles_intersect;

    /// On a lattice, where rays meet edges, corners and planes exactly, and hit if and only if a segment does. Its sheared
    /// coordinates are exact: directions have a greatest coordinate of 1, 2 or 4.
    #[test]
    fn lattice_rays_agree_with_the_oracle() {
        let seed = 81;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (cases, mut hits, mut edge_on) = (60_000u32, 0, 0);
        for case in 0..cases {
            let mut lattice = |end: i32| {
                DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-end..=end))))
            };
            let triangle = [lattice(2), lattice(2), lattice(2)];
            let mut direction = if case % 4 == 0 { triangle[1] - triangle[0] } else { lattice(4) };
            let greatest = direction.abs().max_element();
            if ![1.0, 2.0, 4.0].contains(&greatest) {
                direction = DVec3::new(1.0, -0.5, 0.25);
            }
            // Half of them at a point of the triangle: a corner, on an edge, inside.
            let [mut target, back] = [lattice(3), lattice(2)];
            if case % 2 == 0 {
                let weights = [[4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [2.0, 1.0, 1.0]][case as usize / 2 % 3];
                target = (0..3).map(|i| triangle[i] * (weights[i] / 4.0)).sum();
            }
            let origin = target - direction * back.x.abs();
            let end = origin + direction * 16.0;
            let expected = triangles_intersect(&triangle, &[origin, end, end]);
            let found = Shear::new(origin, direction, DVec3::ONE).hit(&triangle);
            assert_eq!(found.is_some(), expected, "{triangle:?} {origin} {direction} {found:?}");
            if let Some(hit) = found {
                hits += 1;
                edge_on += u32::from(hit.back.is_none());
                let at = origin + direction * hit.t;
                let weighed: DVec3 = (0..3).map(|i| triangle[i] * hit.barycentric[i]).sum();
                assert!((at - weighed).length() < 1e-12, "{triangle:?} {origin} {direction} {hit:?}");
                let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
                match hit.back {
                    Some(back) => assert_eq!(back, normal.dot(direction) > 0.0),
                    None => assert!(normal.dot(direction).abs() < 1e-12),
                }
            }
        }
        println!("{hits} of {cases} hit, {edge_on} edge on");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))) && edge_on > 1000);
    }

    /// Law: around the line of a ray the windings of a closed mesh sum to 0, also where it runs through corners, along edges and in faces; and what winds
    /// around it is hit.
    #[test]
    fn windings_of_a_closed_mesh_sum_to_zero() {
        let seed = 85;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (cases, mut wound) = (40_000u32, 0);
        for case in 0..cases {
            let grid = if case % 2 == 0 { 2.0 } else { 1e9 };
            let mut random = || {
                let coordinate = |_| f64::round(rng.random_range(-1.0..1.0) * grid) / grid;
                DVec3::from_array(std::array::from_fn(coordinate))
            };
            let [a, b, c, d, target, to] = std::array::from_fn(|_| random());
            let target = [target, a, a.lerp(b, 0.5), (a + b + c + d) / 4.0][case as usize / 2 % 4];
            let direction = if case % 3 == 0 { b - a } else { to - target };
            if direction == DVec3::ZERO {
                continue;
            }
            // Before them all.
            let shear =
                Shear::new(target - direction / direction.abs().max_element() * 8.0, direction, DVec3::ONE);
            let faces = [[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
            let windings = faces.map(|face| shear.winding(&face));
            assert_eq!(windings.iter().sum::<i64>(), 0, "case {case}: {faces:?} {target} {direction}");
            for (face, winding) in faces.iter().zip(windings) {
                assert!(
                    winding == 0 || shear.hit(face).is_some(),
                    "case {case}: {face:?} {target} {direction}"
                );
            }
            wound += u32::from(windings != [0; 4]);
        }
        println!("{wound} of {cases} lines are wound around");
        assert!((0.3..=0.7).contains(&(f64::from(wound) / f64::from(cases))));
    }

    /// Law: edges have exact signs, also where products of corners in line with the ray are rounded to the wrong order, or to one number.
    #[test]
    fn an_edge_next_to_the_ray_passes_it_on_the_side_where_it_is() {
        let mut rng = seeded(86);
        let shear = Shear::new(DVec3::NEG_Z, DVec3::Z, DVec3::ONE);
        let (cases, mut hits, mut misleading) = (4000, 0, 0);
        for case in 0..cases {
            let mut part = || rng.random_range(0.1..1.0);
            let p = DVec2::new(part(), part());
            let (q, r) = (p * -part(), p.perp() * part());
            let areas = [[q, r], [r, p], [p, q]].map(|[u, v]| orient2d(DVec2::ZERO, u, v));
            let turns = |sign: f64| areas.iter().any(|area| sign * area > 0.0);
            let triangle = [p, q, r].map(|corner| corner.extend(0.0));
            let is_hit = shear.hit(&triangle).is_some();
            assert_eq!(is_hit, !(turns(1.0) && turns(-1.0)), "case {case}: {triangle:?}");
            hits += u32::from(is_hit);
            misleading += u32::from(sign(p.x * q.y - p.y * q.x) != sign(areas[2]));
        }
        println!("{hits} of {cases} hit; of {misleading} products mislead");
        assert!((0.3..=0.7).contains(&(f64::from(hits) / f64::from(cases))) && misleading > cases / 20);
    }

    /// A third of an edge has no exact weights, but the ray starts there all the same; both ways.
    #[test]
    fn a_ray_in_the_plane_that_starts_on_an_edge_hits_there() {
        let (a, b, c) = (DVec3::new(-1.0, 2.0, 0.0), DVec3::new(1.0, 1.0, -1.0), DVec3::new(-2.0, -2.0, 2.0));
        for triangle in [[a, b, c], [b, c, a], [c, b, a]] {
            for direction in [DVec3::new(1.0, -2.0, 0.0), DVec3::new(-1.0, 2.0, 0.0)] {
                let hit = Shear::new(DVec3::ZERO, direction, DVec3::ONE).hit(&triangle);
                assert_eq!(hit.map(|hit| hit.t), Some(0.0), "{triangle:?} {direction}");
            }
        }
    }

    /// Slivers and grazing rays too: a hit is on the ray and on the triangle, up to the rounding of positions.
    #[test]
    fn a_sliver_is_hit_where_it_is() {
        let mut rng = seeded(84);
        let mut hits = 0;
        for case in 0..40_000 {
            let mut random = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let [a, b, beside, off] = std::array::from_fn(|_| random());
            let (thin, grazing) = (10f64.powi(-(case % 18)), 10f64.powi(-(case / 18 % 18)));
            let triangle = [a, b, a.lerp(b, 0.3) + beside * thin];
            let target = triangle[0] * 0.2 + triangle[1] * 0.3 + triangle[2] * 0.5;
            let direction = (target - a) + off * grazing;
            let origin = target - direction * f64::from(case / 324 % 2);
            let Some(hit) = Shear::new(origin, direction, DVec3::ONE).hit(&triangle) else { continue };
            hits += 1;
            let at = origin + direction * hit.t;
            let weighed: DVec3 = (0..3).map(|i| triangle[i] * hit.barycentric[i]).sum();
            let apart = (at - weighed).length();
            assert!(apart < 1e-14, "case {case}: {apart:e}, {triangle:?} {origin} {direction} {hit:?}");
        }
        println!("{hits} of 40000 hit");
        assert!(hits > 10_000);
    }

    /// Eight at once, on every level of instructions, are those that one by one may be hit.
    #[test]
    fn candidates_are_the_same_on_every_level() {
        let mut rng = seeded(83);
        let (mut candidates, mut hits) = (0, 0);
        for case in 0..5000 {
            let grid = if case % 2 == 0 { 2.0 } else { 1e9 };
            let mut random = || {
                let coordinate = |_| f64::round(rng.random_range(-1.0..1.0) * grid) / grid;
                DVec3::from_array(std::array::from_fn(coordinate))
            };
            let triangles: [Triangle; LANES] = std::array::from_fn(|_| [random(), random(), random()]);
            let [a, b, c] = triangles[case as usize % LANES];
            let origin = random() * 3.0;
            let shear = Shear::new(origin, (a + b + c) / 3.0 - origin, DVec3::ONE);
            let mut corners = Corners::default();
            for (lane, triangle) in triangles.iter().enumerate() {
                put(&mut corners, lane, triangle.each_ref());
            }
            let found = levels().map(|level| dispatch!(level, simd => shear.candidates_on(simd, &corners)));
            assert!(found.iter().all(|mask| *mask == found[0]));
            for (lane, triangle) in triangles.iter().enumerate() {
                let hit = shear.hit(triangle).is_some();
                let candidate = found[0] >> lane & 1 == 1;
                assert!(candidate || !hit, "case {case}: {triangle:?}");
                candidates += u32::from(candidate);
                hits += u32::from(hit);
            }
        }
        println!("{candidates} of 40000 are candidates, {hits} hit");
        assert!(hits > 5000 && candidates < 20_000);
    }

    /// Rays at the shared corner and the edges of a fan: one of the triangles is hit, always, however the ray is rounded.
    #[test]
    fn no_ray_slips_through_a_fan() {
        let mut rng = seeded(82);
        for case in 0..2000 {
            let mut random = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let (apex, offset) = (random(), random() * 10f64.powi(case % 9));
            let count = 3 + case as usize % 7;
            let rim: Vec<DVec3> = (0..count)
                .map(|i| {
                    let angle = std::f64::consts::TAU * i as f64 / count as f64;
                    apex + DVec3::new(angle.cos(), angle.sin(), 0.0) + 0.2 * random()
                })
                .collect();
            for i in 0..count {
                let along = rng.random_range(0.0..0.5) * f64::from(case % 3 != 0);
                let target = apex.lerp(rim[i], along);
                let from = target + DVec3::new(0.3, -0.2, 1.0 + rng.random_range(0.0..1.0));
                let shift = |p: DVec3| p + offset;
                let shear = Shear::new(shift(from), shift(target) - shift(from), DVec3::ONE);
                let hit = |i: usize| shear.hit(&[apex, rim[i], rim[(i + 1) % count]].map(shift)).is_some();
                assert!((0..count).any(hit), "case {case}, {i} of {count}");
            }
        }
    }
}
