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
        let on =
            |chain: &[DVec2], x: DVec2| planar::contains(chain, x) && !planar::contains_strictly(chain, x);
        let least = outer.len() + holes.iter().map(|h| h.len() + 2).sum::<usize>();
        // A chain that touches another between vertices may get some there.
        let more = polygon.vertices().len().checked_sub(least).expect("none is lost");
        let chains: Vec<&[DVec2]> = std::iter::once(&outer).chain(holes).map(Vec::as_slice).collect();
        let lean = |chain: &[DVec2], other: &[DVec2]| chain != other && chain.iter().any(|&x| on(other, x));
        let touch = chains.iter().any(|chain| chains.iter().any(|other| lean(chain, other)));
        assert!(more == 0 || touch, "{more} more: {outer:?} {holes:?}");
        let area = planar::doubled_area(&outer).abs()
            - holes.iter().map(|h| planar::doubled_area(h).abs()).sum::<f64>();
        assert!((2.0 * polygon.area() - area).abs() < 1e-9, "{outer:?} {holes:?}");
        let flat: Vec<DVec2> = polygon.vertices().iter().map(|p| p.truncate()).collect();
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

/// Law: holes may touch the boundary and each other at vertices, between them, and along edges. A square is cut into pieces of lattice
/// cells, of which all but one are holes in it.
#[test]
fn holes_may_fill_the_polygon() {
    let seed = 71;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut polygons, mut hits, mut cells) = (0, 0, 0);
    while polygons < 2_000 {
        let side = rng.random_range(2..=4);
        let mut piece_of = vec![0; (side * side) as usize];
        let cell =
            |x: i32, y: i32| ((0..side).contains(&x) && (0..side).contains(&y)).then_some(x + side * y);
        let pieces = rng.random_range(1..=4);
        for piece in 1..=pieces {
            let (mut x, mut y) = (rng.random_range(0..side), rng.random_range(0..side));
            for _ in 0..rng.random_range(1..=6) {
                match cell(x, y) {
                    Some(i) if piece_of[i as usize] % piece == 0 => piece_of[i as usize] = piece,
                    _ => break,
                }
                let step = rng.random_range(0..4);
                (x, y) = (x + [1, 0, -1, 0][step], y + [0, 1, 0, -1][step]);
            }
        }
        let is_in = |piece: i32, x: i32, y: i32| cell(x, y).is_some_and(|i| piece_of[i as usize] == piece);
        // The edges around a piece, which lies to their left; none where they are not one chain.
        let ring = |piece: i32, keep: bool| -> Option<Vec<DVec2>> {
            let mut next = std::collections::BTreeMap::new();
            for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
                let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
                for (k, (dx, dy)) in [(0, -1), (1, 0), (0, 1), (-1, 0)].into_iter().enumerate() {
                    if is_in(piece, x, y)
                        && !is_in(piece, x + dx, y + dy)
                        && next.insert(corners[k], corners[(k + 1) % 4]).is_some()
                    {
                        return None;
                    }
                }
            }
            let start = *next.keys().next()?;
            let around = std::iter::successors(Some(start), |at| Some(next[at]).filter(|&to| to != start));
            let ring: Vec<(i32, i32)> = around.collect();
            let turns = |i: usize| {
                let [a, b, c] = [ring.len() - 1, 0, 1].map(|k| ring[(i + k) % ring.len()]);
                (b.0 - a.0) * (c.1 - b.1) != (b.1 - a.1) * (c.0 - b.0)
            };
            let kept = (0..ring.len()).filter(|&i| keep || turns(i)).map(|i| ring[i]);
            let points = kept.map(|(x, y)| DVec2::new(x.into(), y.into())).collect();
            (ring.len() == next.len()).then_some(points)
        };
        let numbers: Vec<i32> = (1..=pieces).filter(|piece| piece_of.contains(piece)).collect();
        let holes: Option<Vec<_>> = numbers.iter().map(|&piece| ring(piece, rng.random())).collect();
        let left = piece_of.iter().filter(|&&piece| piece == 0).count();
        let Some(holes) = holes.filter(|_| left > 0) else { continue };
        polygons += 1;
        let far = f64::from(side);
        let outer = [(0.0, 0.0), (far, 0.0), (far, far), (0.0, far)].map(|(x, y)| DVec2::new(x, y));
        let polygon = Polygon::with_holes(raise(&outer), holes.iter().map(|hole| raise(hole)));
        let polygon = polygon.unwrap_or_else(|error| panic!("{error}: {holes:?}"));
        for turned in 0..4 {
            let mut chain = polygon.vertices().to_vec();
            let shift = turned * chain.len() / 4;
            chain.rotate_left(shift);
            let flat: Vec<DVec2> = chain.iter().map(|p| p.truncate()).collect();
            let triangles = Polygon::new(chain).unwrap().triangles();
            let areas = triangles.iter().map(|t| planar::doubled_area(&t.map(|i| flat[i as usize])));
            assert!(areas.clone().all(|area| area >= 0.0), "{turned} {holes:?}");
            assert_eq!(areas.sum::<f64>(), 2.0 * left as f64, "{turned} {holes:?}");
            for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
                let center = DVec2::new(x.into(), y.into()) + 0.5;
                assert_eq!(planar::contains(&flat, center), is_in(0, x, y), "{center} {holes:?}");
            }
        }
        hits += left;
        cells += piece_of.len();
    }
    assert_rate("cells that are left", hits, cells);
}

/// No vertex of such a hole sees one of the boundary.
#[test]
fn holes_may_touch_between_vertices() {
    let ring = |points: [(f64, f64); 4]| raise(&points.map(|(x, y)| DVec2::new(x, y)));
    let square = ring([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
    let diamond = ring([(2.0, 0.0), (4.0, 2.0), (2.0, 4.0), (0.0, 2.0)]);
    let corners = Polygon::with_holes(square, [diamond]).unwrap();
    assert_eq!(corners.area(), 8.0);
    let needle = |x: f64| Polygon::new([-1.0, 1.0, 1.0].map(|z| DVec3::new(x, 0.5, 3.0 + z))).unwrap();
    assert_eq!([0.5, 2.0, 3.5].map(|x| corners.intersects(&needle(x))), [true, false, true]);
}

/// Law: a boundary with slits has the holes that it has without them, also those that touch a slit: at its tip, beside it, or all along. An
/// antenna is no part of the inside.
#[test]
fn holes_may_touch_slits() {
    let chain = |points: &[(f64, f64)]| -> Vec<DVec3> {
        raise(&points.iter().map(|&point| DVec2::from(point)).collect::<Vec<_>>())
    };
    let with_slit = |to: &[(f64, f64)]| {
        let back = to.iter().rev().skip(1).copied();
        let slit: Vec<(f64, f64)> = to.iter().copied().chain(back).chain([(0.0, 2.0)]).collect();
        chain(&[&[(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0), (0.0, 2.0)][..], &slit].concat())
    };
    let hole = |low: (f64, f64), high: (f64, f64)| chain(&[low, (high.0, low.1), high, (low.0, high.1)]);
    let slits = [vec![(2.0, 2.0)], vec![(1.0, 2.0), (2.0, 2.0)], vec![(2.0, 2.0), (2.0, 3.0)]];
    let holes = [
        hole((2.0, 2.0), (3.0, 3.0)),
        hole((2.0, 1.0), (3.0, 3.0)),
        hole((1.0, 1.0), (3.0, 2.0)),
        hole((0.0, 1.0), (1.0, 2.0)),
        hole((1.0, 2.0), (2.0, 3.0)),
    ];
    for slit in &slits {
        for hole in &holes {
            for turned in 0..4 {
                let (mut outer, mut hole) = (with_slit(slit), hole.clone());
                hole.rotate_left(turned);
                if turned % 2 == 1 {
                    outer.reverse();
                }
                let size = (hole[0] - hole[2]).abs();
                let polygon = Polygon::with_holes(outer, [hole.clone()]);
                let polygon = polygon.unwrap_or_else(|error| panic!("{error}: {slit:?}, {hole:?}"));
                let flat: Vec<DVec2> = polygon.vertices().iter().map(|p| p.truncate()).collect();
                let triangles = polygon.triangles();
                let areas =
                    triangles.iter().map(|t| planar::doubled_area(&t.map(|i| flat[i as usize])).abs());
                assert_eq!([polygon.area(), areas.sum::<f64>() / 2.0], [24.0 - size.x * size.y; 2]);
            }
        }
    }
    let cut = Polygon::with_holes(with_slit(&slits[0]), [hole((1.0, 1.0), (3.0, 3.0))]);
    assert_eq!(cut.unwrap_err(), PolygonError::HoleOutside { hole: 0 });
    let antenna = with_slit(&[(-2.0, 2.0)]);
    for outside in
        [hole((-3.0, 2.0), (-2.0, 3.0)), hole((-2.0, 2.0), (0.0, 3.0)), hole((-1.0, 1.0), (0.0, 2.0))]
    {
        let apart = Polygon::with_holes(antenna.clone(), [outside]);
        assert_eq!(apart.unwrap_err(), PolygonError::HoleOutside { hole: 0 });
    }
}

/// Law: what is wrong with a vertex or an edge is told by its place among all that were given, wherever the joined chain has it.
#[test]
fn errors_name_what_was_given() {
    let ring = |corners: &[[f64; 2]]| raise(&corners.iter().map(|&p| DVec2::from(p)).collect::<Vec<_>>());
    let bow = |x: f64| ring(&[[x, 1.0], [x + 5.0, 6.0], [x + 5.0, 4.0], [x, 9.0]]);
    let turned = |bow: Vec<DVec3>| bow.into_iter().rev().collect::<Vec<_>>();
    let triangle = ring(&[[2.0, 4.0], [2.0, 6.0], [3.0, 5.0]]);
    let square = ring(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]);
    for (outer, hole, [first, second]) in [
        (bow(1.0), triangle.clone(), [0, 2]),
        (turned(bow(1.0)), triangle.clone(), [0, 2]),
        (square.clone(), bow(1.0), [4, 6]),
        (square.clone(), turned(bow(1.0)), [4, 6]),
    ] {
        let error = Polygon::with_holes(outer, [hole]).unwrap_err();
        assert_eq!(error, PolygonError::NotSimple { first, second });
    }
    for raised in 4..7 {
        let mut hole = triangle.clone();
        hole[raised - 4].z += 0.5;
        let error = Polygon::with_holes(square.clone(), [hole]).unwrap_err();
        assert!(matches!(error, PolygonError::NotFlat { index, .. } if index == raised), "{raised}: {error}");
    }
}
