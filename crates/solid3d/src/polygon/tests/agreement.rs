//! The three algorithms and the oracle agree on flat polygons, to the last bit.

use glam::{DVec2, DVec3};
use solid_oracle::generate::seeded;
use solid_oracle::{hulls_intersect_exact, triangles_intersect};

use super::assert_rate;
use super::cases;
use crate::polygon::{
    Counters, Intersection, Polygon, exact, intersect_sorted, intersect_straightforward,
    intersect_triangulated, planar, triangulation,
};

/// By the oracle's exact test of triangles, over our triangulation.
fn oracle(a: &Polygon, b: &Polygon) -> bool {
    let corners = |polygon: &Polygon| -> Vec<[DVec3; 3]> {
        polygon.triangles().into_iter().map(|t| t.map(|i| polygon.vertices()[i as usize])).collect()
    };
    let of_b = corners(b);
    corners(a).iter().any(|x| of_b.iter().any(|y| triangles_intersect(x, y)))
}

fn check(a: &Polygon, b: &Polygon, context: &str) -> bool {
    let expected = intersect_triangulated(a, b);
    let show = || format!("{context}\na: {:?}\nb: {:?}", a.vertices(), b.vertices());
    let counters = &mut Counters::default();
    for (x, y) in [(a, b), (b, a)] {
        assert_eq!(intersect_sorted(x, y, counters), expected, "sorted, {}", show());
        assert_eq!(intersect_straightforward(x, y, counters), expected, "straightforward, {}", show());
        assert_eq!(x.intersects(y), expected, "{}", show());
        let found = x.intersection(y);
        assert_eq!(found != Intersection::Apart, expected, "{}", show());
        if let Intersection::Segments(segments) = found {
            check_segments(&segments, [x, y], &show);
        }
    }
    expected
}

/// How far beside a segment is looked, in sizes of the polygons.
const BESIDE: f64 = 1e-4;

/// The segments are sorted, disjoint, lie in both polygons as far as rounding lets them, and are all that do.
fn check_segments(segments: &[[DVec3; 2]], polygons: [&Polygon; 2], show: &dyn Fn() -> String) {
    let size = polygons[0].reach().max(polygons[1].reach());
    for polygon in polygons {
        let bounds = polygon.bounds().inflated(1e-9 * size);
        for &[begin, end] in segments {
            assert!(bounds.contains(&crate::Aabb::of_points([begin, end])), "{}", show());
            let middle = 0.5 * (begin + end);
            assert!(polygon.meets_sphere(middle, 1e-9 * size).unwrap(), "{begin} {end} {}", show());
        }
    }
    // They are all: just before and behind each at least one of the polygons is not.
    let along = polygons[0].plane().normal.cross(polygons[1].plane().normal).normalize();
    let beside = BESIDE * size * along * along.dot(segments.last().unwrap()[1] - segments[0][0]).signum();
    let gaps = segments.windows(2).map(|pair| pair[0][1].distance(pair[1][0]));
    let gaps: Vec<f64> = [f64::INFINITY].into_iter().chain(gaps).chain([f64::INFINITY]).collect();
    for (&[begin, end], near) in segments.iter().zip(gaps.windows(2)) {
        for (place, gap) in [(begin - beside, near[0]), (end + beside, near[1])] {
            let is_common = polygons.iter().all(|it| it.meets_sphere(place, 1e-14 * size).unwrap());
            assert!(gap < 2.0 * BESIDE * size || !is_common, "{place} is in both, {}", show());
        }
    }
    let line = segments.last().unwrap()[1] - segments[0][0];
    let along: Vec<f64> = segments.iter().flatten().map(|p| p.dot(line)).collect();
    let slack = 1e-9 * size * size;
    assert!(along.windows(2).all(|pair| pair[0] <= pair[1] + slack), "{along:?} {}", show());
}

#[test]
fn algorithms_agree_on_flat_polygons() {
    let seed = 30;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut by_oracle, mut segments, mut convex) = (120_000, 0, 0, 0, 0);
    for case in 0..cases {
        let [a, b] = cases::pair(&mut rng, case);
        let expected = check(&a, &b, &format!("case {case}"));
        hits += usize::from(expected);
        segments += usize::from(matches!(a.intersection(&b), Intersection::Segments(_)));
        if case % 8 == 1 {
            by_oracle += 1;
            assert_eq!(oracle(&a, &b), expected, "case {case}: {:?} {:?}", a.vertices(), b.vertices());
        }
        if a.is_convex() && b.is_convex() && case % 2 == 0 {
            convex += 1;
            assert_eq!(hulls_intersect_exact(a.vertices(), b.vertices()), expected, "case {case}");
        }
    }
    println!("{segments} in segments, {by_oracle} confirmed by the oracle, {convex} as convex hulls");
    assert_rate("flat polygons", hits, cases);
    assert!(convex > 500);
}

/// Law: what meets in a point is one segment: edges on the line in which the planes meet, and the inside beside them.
#[test]
fn segments_that_touch_are_one() {
    let flat = |corners: &[[f64; 2]]| -> Vec<DVec3> {
        corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    };
    let wall = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let wall = Polygon::new(wall).unwrap();
    let joined = [
        flat(&[[1.0, 0.0], [2.0, 0.0], [2.0, -1.0], [3.0, -1.0], [3.0, 1.0], [1.0, 1.0]]),
        flat(&[[1.0, 0.0], [1.5, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0]]),
        flat(&[[1.0, 0.0], [2.0, -1.0], [2.0, 0.0], [3.0, 0.0], [2.0, 1.0]]),
    ];
    for chain in joined {
        for turned in 0..2 * chain.len() {
            let mut chain = chain.clone();
            let first = turned % chain.len();
            chain.rotate_left(first);
            if turned < chain.len() {
                chain.reverse();
            }
            let polygon = Polygon::new(chain).unwrap();
            let Intersection::Segments(segments) = polygon.intersection(&wall) else { panic!("they meet") };
            let ends = segments.concat().into_iter().map(|p| p.x);
            let [least, greatest] = [ends.clone().fold(9.0, f64::min), ends.fold(-9.0, f64::max)];
            assert_eq!((segments.len(), least, greatest), (1, 1.0, 3.0), "{segments:?}");
        }
    }
}

/// Law: coordinates that are too small beside others for exact signs count as zero, also where only one of two polygons has such: what has an area
/// by these alone is its edges.
#[test]
fn what_is_too_thin_for_signs_is_its_edges() {
    let triangle = |corners: [[f64; 3]; 3]| Polygon::new(corners.map(DVec3::from_array)).unwrap();
    let sliver = triangle([[0.0; 3], [1.0, 0.0, 1.0], [2.0, 1e-250, 2.0]]);
    for (needle, meets) in [
        ([[0.0, 0.0, 2.0], [0.25, 0.0, 1.75], [0.25, 0.0, 1.75]], false),
        ([[0.5, 0.0, 0.75], [0.75, 0.0, 0.5], [0.75, 0.0, 0.5]], true),
        ([[0.5, -1.0, 0.75], [0.75, 1.0, 0.5], [0.75, 1.0, 0.5]], true),
        ([[0.5, -1.0, 0.75], [0.75, 2.0, 0.5], [0.75, 2.0, 0.5]], false),
        ([[1.25, -1.0, 1.75], [1.75, 1.0, 1.25], [1.75, 1.0, 1.25]], true),
    ] {
        assert_eq!(check(&sliver, &triangle(needle), "needle"), meets, "{needle:?}");
    }
    // The smallest beside the largest.
    let [small, large] = [1e-95, 1e95];
    let large = triangle([[-large, -large, 0.0], [large, -large, 0.0], [0.0, large, 0.0]]);
    let small = triangle([[0.0, small, -small], [small, 0.0, small], [-small, 0.0, small]]);
    assert!(check(&small, &large, "small and large"));
}

/// Law 4. Powers of two, reversed and rotated chains.
#[test]
fn scale_and_the_chain_s_start_change_nothing() {
    let seed = 31;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (5000, 0);
    for case in 0..cases {
        let [a, b] = cases::pair(&mut rng, case);
        let expected = a.intersects(&b);
        hits += usize::from(expected);
        let mut turned = a.vertices().to_vec();
        turned.rotate_left(case % a.vertices().len());
        turned.reverse();
        check(&Polygon::new(turned).unwrap(), &b, "turned");
        for scale in [2f64.powi(320), 2f64.powi(-325)] {
            let [x, y] =
                [&a, &b].map(|p| Polygon::new(p.vertices().iter().map(|&v| v * scale).collect::<Vec<_>>()));
            let (x, y) = (x.unwrap(), y.unwrap());
            assert!(x.is_flat() && !x.fits_predicates);
            assert_eq!(check(&x, &y, "scaled"), expected, "case {case}, {scale:e}");
            assert_eq!(x.triangles(), a.triangles());
        }
    }
    assert_rate("scaled polygons", hits, cases);
}

/// Collinear polygons are segments, coincident ones points.
#[test]
fn degenerate_polygons_are_their_edges() {
    let seed = 32;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (20_000, 0);
    for case in 0..cases {
        let [a, b] = cases::pair(&mut rng, 5 * (case / 2));
        let corners = b.vertices();
        let p = corners[0];
        // Every third goes through the middle of an edge.
        let q =
            if case % 3 == 0 { a.vertices()[0] + a.vertices()[1] - p } else { corners[case % corners.len()] };
        let thin = Polygon::new([p, q, (p + q) / 2.0, p]).unwrap();
        assert_eq!(thin.area(), 0.0);
        hits += usize::from(check(&a, &thin, "segment"));
        check(&thin, &Polygon::new([a.vertices()[0], a.vertices()[1], a.vertices()[0]]).unwrap(), "segments");
        check(&a, &Polygon::new([p; 3]).unwrap(), "point");
    }
    assert_rate("degenerate polygons", hits, cases);
}

/// The triangles cover the polygon: the same points are in both, and their areas add up.
#[test]
fn triangles_cover_the_polygon() {
    let seed = 33;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, mut cases) = (0, 0);
    for case in 0..3000 {
        let side = [2, 3, 5, 9][case % 4];
        let chain = cases::chain(&mut rng, side);
        assert_eq!(planar::crossing(&chain), None);
        let triangles = triangulation::triangulate(&chain);
        assert_eq!(triangles.len(), chain.len() - 2);
        let corners: Vec<[DVec2; 3]> = triangles.iter().map(|t| t.map(|i| chain[i as usize])).collect();
        let sum: f64 = corners.iter().map(|t| planar::doubled_area(t).abs()).sum();
        assert_eq!(sum, planar::doubled_area(&chain).abs(), "{chain:?} {triangles:?}");
        for i in 0..=2 * side {
            for j in 0..=2 * side {
                let x = DVec2::new(f64::from(i), f64::from(j)) / 2.0;
                let inside = planar::contains(&chain, x);
                let in_triangle = |t: &[DVec2; 3]| {
                    let turns = [0, 1, 2].map(|k| exact::turn(t[k], t[(k + 1) % 3], x));
                    let flat = exact::turn(t[0], t[1], t[2]) == 0.0;
                    let on = (0..3).any(|k| exact::segment_contains(t[k], t[(k + 1) % 3], x));
                    on || !flat && (turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0))
                };
                assert_eq!(corners.iter().any(in_triangle), inside, "{x} {chain:?} {triangles:?}");
                hits += usize::from(inside);
                cases += 1;
            }
        }
    }
    assert_rate("points in polygons", hits, cases);
}
