//! Holes become part of one weakly simple chain.

use glam::{DVec2, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;

use super::assert_rate;
use crate::polygon::{Polygon, PolygonError, planar};

fn raise(chain: &[DVec2]) -> Vec<DVec3> {
    chain.iter().map(|p| DVec3::new(p.x, p.y, 3.0)).collect()
}

/// Points of a lattice are in the joined polygon exactly if they are in the outer one and not strictly in a hole. Holes may
/// touch the outer boundary and each other.
#[test]
fn a_polygon_with_holes_is_the_difference() {
    let seed = 70;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut polygons, mut hits, mut points, mut touching) = (0, 0, 0, 0);
    while polygons < 120 {
        let side = 12;
        let mut convex = |low: i32, high: i32, n: usize| -> Vec<DVec2> {
            let mut point = || f64::from(rng.random_range(low..=high));
            let cloud: Vec<DVec3> = (0..n).map(|_| DVec3::new(point(), point(), 0.0)).collect();
            crate::hull::Hull::of(&cloud).map_or(Vec::new(), |hull| {
                let front = hull.triangles().iter().filter(|t| t[1] < t[2] || hull.vertices().len() > 3);
                let mut ring: Vec<u32> = front.flat_map(|t| t.to_vec()).collect();
                ring.sort_unstable();
                ring.dedup();
                let center =
                    ring.iter().map(|&i| cloud[i as usize]).sum::<DVec3>() / ring.len().max(1) as f64;
                ring.sort_by(|&i, &j| {
                    let angle = |i: u32| (cloud[i as usize] - center).truncate().to_angle();
                    angle(i).total_cmp(&angle(j))
                });
                ring.iter().map(|&i| cloud[i as usize].truncate()).collect()
            })
        };
        let outer = convex(0, side, 12);
        let holes: Vec<Vec<DVec2>> =
            (0..4).map(|k| convex(1 + 3 * (k % 2) * 2, 5 + 6 * (k % 2), 4 + k as usize)).collect();
        let count = 1 + polygons % 4;
        let holes = &holes[..count];
        if holes.iter().any(|hole| hole.len() < 3 || planar::doubled_area(hole) == 0.0) || outer.len() < 3 {
            continue;
        }
        let raised = holes.iter().map(|hole| raise(hole));
        let polygon = match Polygon::with_holes(raise(&outer), raised) {
            Ok(polygon) => polygon,
            Err(PolygonError::HoleOutside { .. } | PolygonError::NotSimple { .. }) => continue,
            Err(error) => panic!("{error}"),
        };
        polygons += 1;
        assert_eq!(polygon.vertices().len(), outer.len() + holes.iter().map(|h| h.len() + 2).sum::<usize>());
        let area = planar::doubled_area(&outer).abs()
            - holes.iter().map(|h| planar::doubled_area(h).abs()).sum::<f64>();
        assert!((2.0 * polygon.area() - area).abs() < 1e-9, "{outer:?} {holes:?}");
        let flat: Vec<DVec2> = polygon.vertices().iter().map(|p| p.truncate()).collect();
        let on =
            |chain: &[DVec2], x: DVec2| planar::contains(chain, x) && !planar::contains_strictly(chain, x);
        touching += usize::from(holes.iter().flatten().any(|&x| on(&outer, x)));
        for i in 0..=2 * side {
            for j in 0..=2 * side {
                let x = DVec2::new(f64::from(i), f64::from(j)) / 2.0;
                let expected = planar::contains(&outer, x)
                    && !holes.iter().any(|hole| planar::contains_strictly(hole, x));
                if !on(&flat, x) || expected {
                    assert_eq!(planar::contains(&flat, x), expected, "{x} {outer:?} {holes:?} {flat:?}");
                }
                points += 1;
                hits += usize::from(expected);
            }
        }
        let by_triangles: f64 = polygon
            .triangles()
            .iter()
            .map(|t| planar::doubled_area(&t.map(|i| flat[i as usize])).abs())
            .sum();
        assert!((by_triangles - area).abs() < 1e-9, "{flat:?}");
    }
    println!("{touching} of {polygons} have a hole that touches the outer boundary");
    assert_rate("points in polygons with holes", hits, points);
}

/// Between the closest vertices of the two chains an edge of another hole passes.
#[test]
fn bridges_go_around_what_lies_between() {
    let ring =
        |points: &[(f64, f64)]| raise(&points.iter().map(|&(x, y)| DVec2::new(x, y)).collect::<Vec<_>>());
    let outer = ring(&[(0.0, -9.0), (20.0, -9.0), (20.0, 9.0), (0.0, 9.0), (0.0, 0.0)]);
    let needle = ring(&[(1.0, -8.0), (1.0, 8.0), (0.9, 8.0), (0.9, -8.0)]);
    let behind = ring(&[(2.0, 0.0), (3.0, 1.0), (3.0, -1.0)]);
    let polygon = Polygon::with_holes(outer, [behind, needle]).unwrap();
    assert_eq!(polygon.area(), 360.0 - 1.6 - 1.0);
    let apart =
        Polygon::with_holes(ring(&[(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)]), [ring(&[(1.0, 1.0), (2.0, 1.0)])]);
    assert_eq!(apart.unwrap_err().to_string(), "hole 0 has 2 vertices; a closed chain needs at least 3");
}
