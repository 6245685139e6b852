//! The faces of what is flat: boxes, hulls, and the primitives of complex shapes.

use glam::DVec3;
use smallvec::{SmallVec, smallvec};
use solid_convex::Cuboid;

use super::super::map::unit;
use super::{Corner, Corners, FACING_COSINE, Face, Placed, is_aligned, is_level, part};
use crate::shape::Hulled;

impl Placed<'_> {
    pub(super) fn side_of_box(&self, cuboid: &Cuboid, direction: DVec3, local: DVec3) -> Face {
        let half = 0.5 * cuboid.size();
        let signs = DVec3::ONE.copysign(local);
        let (axis, normal, cosine) = match self.map.stretch() {
            // The sides of a cube are turned as its axes are.
            Some(stretch) => {
                let axis = local.abs().max_position();
                let normal = self.map.linear().col(axis) * (signs[axis] / stretch);
                (axis, normal, local[axis].abs() / stretch)
            }
            None => {
                let rows = self.map.inverse().transpose();
                let normals = [0, 1, 2].map(|axis| unit(rows.col(axis) * signs[axis]));
                let cosine = |axis: &usize| normals[*axis].dot(direction);
                let best_but = |axis: usize| {
                    let others = (0..3).filter(|&other| other != axis);
                    others.max_by(|x, y| cosine(x).total_cmp(&cosine(y))).expect("a box has three axes")
                };
                let mut axis = best_but(3);
                // As of a hull: the edge that ends on this side may lie across the direction.
                if !is_aligned(cosine(&axis))
                    && is_level(self.map.linear().col(axis) * -signs[axis], direction)
                {
                    axis = best_but(axis);
                }
                (axis, normals[axis], cosine(&axis))
            }
        };
        let sign = signs[axis];
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let way = |k: usize| self.map.linear().col(k) * half[k];
        let (center, along_i, along_j) = (self.map.affine.translation + way(axis) * sign, way(i), way(j));
        let corner = |i_is_up: bool, j_is_up: bool| {
            let signed = |way: DVec3, is_up: bool| if is_up { way } else { -way };
            Corner {
                point: center + signed(along_i, i_is_up) + signed(along_j, j_is_up),
                vertex: u32::from(sign > 0.0) << axis | u32::from(i_is_up) << i | u32::from(j_is_up) << j,
            }
        };
        let corners =
            smallvec![corner(true, true), corner(false, true), corner(false, false), corner(true, false)];
        Face { corners, normal, number: 2 * axis as u32 + u32::from(sign < 0.0), cosine }
    }

    pub(super) fn facet(
        &self,
        hull: &Hulled,
        names: Option<&[u32]>,
        direction: DVec3,
        local: DVec3,
        reach: &[DVec3],
    ) -> Face {
        let (points, facets) = (hull.points(), hull.facets());
        let named = |i: u32| names.map_or(i, |names| names[i as usize]);
        let corner = |&i: &u32| self.corner(points[i as usize], named(i));
        let furthest = hull.polytope().support_index(local);
        let Some(number) = self.best_facet(hull, direction, furthest) else {
            return Face::slight(facets.extreme().iter().map(corner).collect(), direction);
        };
        let facet = facets.get(number);
        let normal = self.map.normal(facet.normal);
        let cosine = normal.dot(direction);
        let whole = facet.corners.iter();
        let corners = match whole.clone().position(|&i| i as usize == furthest) {
            Some(kept) if reach.len() == 3 && cosine >= FACING_COSINE => {
                let place = |i: usize| self.map.point(points[facet.corners[i] as usize]);
                let axis = direction * self.map.linear().determinant().signum();
                let left = part(facet.corners.len(), place, axis, reach, kept);
                left.iter().map(|&i| corner(&facet.corners[i])).collect()
            }
            _ => whole.map(corner).collect(),
        };
        Face { corners, normal, number, cosine }
    }

    /// The facet of a hull that faces a direction best, of those at the furthest point; if an edge there lies across the direction, of the two beside
    /// it, as another one that ends there may face it better.
    fn best_facet(&self, hull: &Hulled, direction: DVec3, furthest: usize) -> Option<u32> {
        let facets = hull.facets();
        let seen = |facet: u32| (self.map.normal(facets.get(facet).normal).dot(direction), facet);
        let better = |x: &(f64, u32), y: &(f64, u32)| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1));
        let there: SmallVec<[_; 8]> = facets.at(furthest).iter().map(|&facet| seen(facet)).collect();
        let Some(&(cosine, best)) = there.iter().max_by(|x, y| better(x, y)) else {
            // The furthest point was flattened out of an edge.
            return (0..facets.len()).map(seen).max_by(better).map(|(_, facet)| facet);
        };
        if is_aligned(cosine) {
            return Some(best);
        }
        let way = |end: u32| self.map.linear() * (hull.points()[end as usize] - hull.points()[furthest]);
        let ends = there.iter().map(|&(_, facet)| facets.get(facet).after(furthest as u32));
        let level = ends.map(|end| (end, way(end))).filter(|&(_, way)| is_level(way, direction));
        let Some((end, _)) = level.max_by(|(_, x), (_, y)| x.dot(direction).total_cmp(&y.dot(direction)))
        else {
            return Some(best);
        };
        let has_edge = |(_, facet): &(f64, u32)| facets.get(*facet).corners.contains(&end);
        there.into_iter().filter(has_edge).max_by(better).map(|(_, facet)| facet)
    }

    /// Both sides of a triangle are its face. One without area is a segment.
    pub(super) fn simplex(&self, vertices: &[u32], direction: DVec3) -> Face {
        let corner = |i: usize| Corner { point: self.corners[i], vertex: vertices[i] };
        if let Some(normal) = self.plane {
            let corners = smallvec![corner(0), corner(1), corner(2)];
            let cosine = normal.dot(direction);
            let number = u32::from(cosine < 0.0);
            return Face { corners, normal: normal * cosine.signum(), number, cosine: cosine.abs() };
        }
        let mut corners: Corners = (0..vertices.len()).map(corner).collect();
        if let [p, q, r] = corners[..] {
            let length = |pair: &[Corner; 2]| pair[0].point.distance_squared(pair[1].point);
            let longest = [[p, q], [q, r], [p, r]].into_iter().max_by(|x, y| length(x).total_cmp(&length(y)));
            corners = longest.expect("a triangle has edges")[..].into();
        }
        corners.dedup_by(|x, y| x.point == y.point);
        Face::slight(corners, direction)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::{DAffine3, DMat3, DQuat, DVec2};
    use rand::Rng;
    use solid_oracle::generate::{direction, in_cube, seeded};

    use super::super::super::clip::{Clipped, clip};
    use super::super::super::map::Map;
    use super::*;
    use crate::shape::{Body, Shape};

    /// Law: where a box stays one, its sides are those that the inverse tells.
    #[test]
    fn sides_of_a_box_that_stays_one() {
        let mut rng = seeded(176);
        let shape = Shape::cuboid([1.2, 1.0, 0.8]).unwrap();
        let body = shape.body().unwrap();
        for case in 0..3_000 {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(in_cube(&mut rng) * 3.0));
            let mirror = DVec3::new([1.0, -1.0][case % 2], 1.0, 1.0) * rng.random_range(0.01..1.0);
            let at =
                DAffine3 { matrix3: turn * DMat3::from_diagonal(mirror), translation: in_cube(&mut rng) };
            let (quick, slow) = (Map::new(at), Map::of_any_shape(at));
            assert!(quick.stretch().is_some());
            let toward = direction(&mut rng);
            let [x, y] = [&quick, &slow].map(|map| Placed::new(&body, map).face(toward));
            assert_eq!(x.number, y.number, "{at}, {toward}");
            assert!((x.normal - y.normal).length() < 1e-14 && (x.cosine - y.cosine).abs() < 1e-14, "{at}");
            for (p, q) in x.corners.iter().zip(&y.corners) {
                assert!(p.vertex == q.vertex && (p.point - q.point).length() < 1e-14, "{at}, {toward}");
            }
        }
    }
    /// Law: beside a triangle a face of many sides is a part of itself, with as much in common with the triangle, under any map, and as high.
    #[test]
    fn beside_a_triangle_a_face_of_many_sides_is_a_part() {
        let mut rng = seeded(185);
        let rim = |i: u32| DVec2::from_angle(f64::from(i) / 100.0 * TAU);
        let ends = |i: u32| [1.0, -1.0].map(|y| DVec3::new(rim(i).x, y, rim(i).y));
        let shape = Shape::convex_hull(&(0..100).flat_map(ends).collect::<Vec<_>>()).unwrap();
        let body = shape.body().unwrap();
        let (mut fewer, mut common) = (0, 0);
        for case in 0..2_000 {
            let matrix3 = DMat3::from_cols(in_cube(&mut rng), in_cube(&mut rng), in_cube(&mut rng));
            let map = Map::new(DAffine3 { matrix3, translation: in_cube(&mut rng) });
            let placed = Placed::new(&body, &map);
            let toward = (map.normal(DVec3::Y) + in_cube(&mut rng) * 0.3).normalize();
            let whole = placed.face(toward);
            let middle = whole.corners[case % whole.corners.len()].point;
            let size = 10f64.powf(rng.random_range(-3.0..0.0));
            let corners = [(); 3].map(|()| middle + matrix3 * in_cube(&mut rng) * size);
            let triangle = Body::Simplex(&[0, 1, 2]);
            let part = placed.face_beside(toward, &Placed::of_primitive(&triangle, 0, &map, &corners));
            let highest = |face: &Face| {
                let heights = face.corners.iter().map(|corner| corner.point.dot(toward));
                heights.reduce(f64::max)
            };
            assert_eq!((part.number, highest(&part)), (whole.number, highest(&whole)), "case {case}");
            let (u, v) = toward.any_orthonormal_pair();
            let flat = |point: DVec3| DVec2::new(u.dot(point - middle), v.dot(point - middle)) / size;
            let seen = |face: &Face| face.corners.iter().map(|corner| flat(corner.point)).collect::<Vec<_>>();
            let in_common = |face: &Face| clip(&corners.map(flat), &seen(face));
            let (expected, found) = (in_common(&whole), in_common(&part));
            let is_told = |x: &Clipped| found.iter().any(|y| x.at.distance(y.at) < 1e-6);
            assert!(expected.len() == found.len() && expected.iter().all(is_told), "case {case}");
            fewer += usize::from(whole.corners.len() > 64 && 2 * part.corners.len() < whole.corners.len());
            common += usize::from(!found.is_empty());
        }
        assert!(fewer > 800 && common > 800, "{fewer}, {common}");
    }
}
