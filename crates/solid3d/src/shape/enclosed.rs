//! What a closed mesh bounds.

use glam::DVec3;
use solid_convex::unit_scale;

use super::convexity::{convex_facets, six_volumes};
use super::hulled::Hulled;
use super::parts::parts;
use super::topology::{Positioned, Topology, edges};
use crate::bounds::Aabb;

/// How far a neighbour may rise above the plane of a triangle in a surface that is convex, relative to its extent.
const FLATNESS: f64 = 1e-9;

/// What was found out about a mesh of which each edge has one triangle on either side. Triangles with two corners at one position do not count.
#[derive(Debug, Default)]
pub(crate) struct Enclosed {
    /// Of a solid, and of what is convex: 1 when the triangles run around counter-clockwise seen from outside, -1 when clockwise. Else 0.
    pub orientation: f64,
    /// The body that a convex mesh bounds, and which vertices its points are.
    pub convex: Option<(Hulled, Vec<u32>)>,
}

impl Enclosed {
    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        let of_convex =
            |(hull, names): &(Hulled, Vec<u32>)| hull.bytes() + names.capacity() * size_of::<u32>();
        self.convex.as_ref().map_or(0, of_convex)
    }

    /// `None` of a mesh that is not closed, and of one that is neither solid nor convex, which is mostly seen at the first few triangles. Cost: O(n), and
    /// O(n log n) of what is convex.
    pub fn of(topology: &Topology, mesh: Positioned, bounds: &Aabb, is_solid: bool) -> Option<Enclosed> {
        let Positioned { vertices, triangles } = mesh;
        let center = bounds.center();
        let scale = unit_scale(bounds.half_extents().max_element());
        // In a unit in which distances are about one.
        let at = |vertex: u32| (vertices[vertex as usize] - center) * scale;
        // Whether some neighbour is above the plane of a triangle, and some below, on the side from which its corners run clockwise.
        let [mut above, mut below] = [false; 2];
        for triangle in triangles.iter().filter_map(|&triangle| topology.spread(triangle)) {
            let [p, q, r] = triangle.map(at);
            let normal = (q - p).cross(r - p).normalize_or_zero();
            for edge in edges(triangle) {
                let height = normal.dot(at(topology.beyond(triangles, edge)?) - p);
                above |= height > FLATNESS;
                below |= height < -FLATNESS;
            }
            if above && below && !is_solid {
                return None;
            }
        }
        let volume: f64 = triangles.iter().map(|corners| six_volumes(corners.map(at))).sum();
        let orientation = if volume < 0.0 { -1.0 } else { 1.0 };
        let rises = if orientation > 0.0 { above } else { below };
        let convex = if rises { None } else { body(topology, mesh, at, orientation) };
        Some(Enclosed { orientation, convex })
    }
}

/// What a closed surface which rises at no edge bounds, if it is of one part that is a sphere, and convex. Euler's formula tells the sphere.
fn body(
    topology: &Topology,
    Positioned { vertices, triangles }: Positioned,
    at: impl Fn(u32) -> DVec3,
    orientation: f64,
) -> Option<(Hulled, Vec<u32>)> {
    let mut spread: Vec<[u32; 3]> =
        triangles.iter().filter_map(|&triangle| topology.spread(triangle)).collect();
    let mut corners = spread.as_flattened().to_vec();
    corners.sort_unstable();
    corners.dedup();
    let edge_count = 3 * spread.len() / 2;
    let twins: Vec<_> = (0..vertices.len() as u32).map(|i| [i, topology.welded(i)]).collect();
    let is_one = || parts(vertices.len(), triangles.iter().map(|t| t.as_slice()), &twins).len() == 1;
    let is_corner = |&i: &u32| corners.binary_search(&topology.welded(i)).is_ok();
    if corners.len() + spread.len() != edge_count + 2
        || !is_one()
        || !triangles.as_flattened().iter().all(is_corner)
    {
        return None;
    }
    // Counter-clockwise seen from outside, over the corners.
    let mut slots = vec![0; vertices.len()];
    (0u32..).zip(&corners).for_each(|(slot, &vertex)| slots[vertex as usize] = slot);
    for triangle in &mut spread {
        *triangle = triangle.map(|vertex| slots[vertex as usize]);
        if orientation < 0.0 {
            triangle.reverse();
        }
    }
    let unit: Vec<DVec3> = corners.iter().map(|&vertex| at(vertex)).collect();
    let facets = convex_facets(&unit, &spread)?;
    let points = corners.iter().map(|&vertex| vertices[vertex as usize]).collect();
    Some((Hulled::with_facets(points, facets)?, corners))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DQuat;
    use solid_oracle::generate::{direction, in_cube, seeded};

    use super::*;
    use crate::hull::Hull;
    use crate::shape::Complex;

    /// Law: a hull is convex, whichever way around, and whether triangles share vertices or positions; what is open, bent inward, of two parts, or has an
    /// edge that all its triangles run through alike is not. A solid has an orientation, convex or not.
    #[test]
    fn what_is_convex_is_known() {
        let mut rng = seeded(241);
        for case in 0..200 {
            let points: Vec<DVec3> = (0..5 + case % 20).map(|_| in_cube(&mut rng)).collect();
            let triangles = Hull::of(&points).unwrap().triangles().to_vec();
            let turned: Vec<_> = triangles.iter().map(|&[i, j, k]| [i, k, j]).collect();
            let apart = |triangles: &[[u32; 3]]| -> (Vec<DVec3>, Vec<[u32; 3]>) {
                let corners = triangles.as_flattened().iter().map(|&i| points[i as usize]).collect();
                (corners, (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
            };
            let found = |vertices: &[DVec3], triangles: &[[u32; 3]], solid: bool| {
                let mut mesh = Complex::mesh(vertices.to_vec(), triangles.to_vec()).unwrap();
                if solid {
                    mesh.solidify().unwrap();
                }
                let Enclosed { orientation, convex } = mesh.topology().enclosed();
                (*orientation, convex.is_some())
            };
            let (split, of_split) = apart(&triangles);
            assert_eq!(found(&points, &triangles, false), (1.0, true), "case {case}");
            assert_eq!(found(&points, &turned, case % 2 == 0), (-1.0, true), "case {case}");
            assert_eq!(found(&split, &of_split, case % 2 == 0), (1.0, true), "case {case}");
            let [i, j, _] = triangles[0];
            let collapsed = [&triangles[..], &[[i, i, j], [i, j, i], [j; 3]]].concat();
            assert_eq!(found(&points, &collapsed, case % 2 == 0), (1.0, true), "collapsed, case {case}");
            let spiked =
                [&triangles[..], &[[i, i, points.len() as u32], [i, points.len() as u32, i]]].concat();
            let beyond = [&points[..], &[points[i as usize] * 3.0]].concat();
            assert!(!found(&beyond, &spiked, case % 2 == 0).1, "with a spike, case {case}");

            assert_eq!(found(&points, &triangles[1..], false), (0.0, false), "open, case {case}");
            let one_turned: Vec<_> = turned[..1].iter().chain(&triangles[1..]).copied().collect();
            assert_eq!(found(&points, &one_turned, false), (0.0, false), "one turned, case {case}");
            let twice: Vec<DVec3> = split.iter().copied().chain(split.iter().map(|p| *p + 3.0)).collect();
            let count = split.len() as u32;
            let of_twice: Vec<_> = of_split.iter().flat_map(|t| [*t, t.map(|i| i + count)]).collect();
            assert!(!found(&twice, &of_twice, false).1, "two parts, case {case}");
            // A corner is pulled in, through the middle of the others.
            let mut bent = points.clone();
            let corner = triangles[0][0] as usize;
            let rest: Vec<DVec3> = triangles
                .as_flattened()
                .iter()
                .map(|&i| points[i as usize])
                .filter(|p| *p != points[corner])
                .collect();
            bent[corner] = rest.iter().sum::<DVec3>() / rest.len() as f64;
            if triangles.len() > 4 {
                assert!(!found(&bent, &triangles, false).1, "bent, case {case}");
                assert!(found(&bent, &triangles, true).0 != 0.0, "bent solid, case {case}");
            }
        }
    }

    /// Law: rounding bends nothing: a box of triangles is convex, however it is turned, and wherever it is.
    #[test]
    fn a_turned_box_is_convex() {
        let mut rng = seeded(433);
        let corner = |i: u32| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from)) - 0.5;
        let corners: Vec<DVec3> = (0..8).map(corner).collect();
        let triangles = Hull::of(&corners).unwrap().triangles().to_vec();
        for case in 0..100 {
            let turn = DQuat::from_axis_angle(direction(&mut rng), f64::from(case));
            let [size, place] = [in_cube(&mut rng).abs() + 0.1, 1e3 * in_cube(&mut rng)];
            let vertices = corners.iter().map(|&corner| turn * (size * corner) + place).collect();
            let mesh = Complex::mesh(vertices, triangles.clone()).unwrap();
            assert!(mesh.topology().enclosed().convex.is_some(), "case {case}");
        }
    }

    /// Law: what is flat is convex where its outline is: both sides of a square of which a corner is pulled in, whose triangles share no edge but that.
    #[test]
    fn a_notch_is_not_convex() {
        for (middle, is_convex) in [(5.0, true), (4.0, true), (3.0, false)] {
            let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, middle], [0.0, 4.0]];
            let vertices = corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
            let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [3, 2, 1], [4, 3, 1], [0, 4, 1]].to_vec();
            let mesh = Complex::mesh(vertices, triangles).unwrap();
            assert_eq!(mesh.topology().enclosed().convex.is_some(), is_convex, "{middle}");
        }
    }

    /// Law: a surface that goes around its corners twice, as that of a star does, is not convex, though it bends outward at each edge.
    #[test]
    fn a_star_is_not_convex() {
        for (tips, height, is_solid) in [(5, 0.01, false), (5, 1.0, true), (7, 1.0, false), (9, 100.0, true)]
        {
            for (turns, is_convex) in [(1, true), (2, false)] {
                let tip = |i: u32| {
                    let (sin, cos) = (TAU * f64::from(turns * i) / f64::from(tips)).sin_cos();
                    DVec3::new(cos, 0.0, -sin)
                };
                let vertices = (0..tips).map(tip).chain([DVec3::Y, DVec3::NEG_Y].map(|end| height * end));
                let sides = (0..tips).map(|i| [i, (i + 1) % tips]);
                let triangles = sides.flat_map(|[i, j]| [[i, j, tips], [j, i, tips + 1]]);
                let mut mesh = Complex::mesh(vertices.collect(), triangles.collect()).unwrap();
                if is_solid {
                    mesh.solidify().unwrap();
                }
                let Enclosed { orientation, convex } = mesh.topology().enclosed();
                assert_eq!((*orientation, convex.is_some()), (1.0, is_convex), "{tips} tips, {turns} turns");
            }
        }
    }
}
