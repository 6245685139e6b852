//! Laws of the queries, and closed forms they must agree with.

#![allow(clippy::print_stdout, reason = "tests print their seeds and their counts, from helpers too")]

use glam::{DAffine3, DMat3, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{
    Pair, PlacementKind, Regime, random_pair, random_placement, random_shape, seeded,
};
use solid_oracle::{
    Convex, Verdict, contains_within, distance_bounds, hulls_intersect_exact, penetration_bounds, verdict,
    verify_axis,
};

const REGIMES: [Regime; 8] = [
    Regime::Random,
    Regime::NearTouching { relative_gap: 1e-4 },
    Regime::NearTouching { relative_gap: 1e-10 },
    Regime::SizeRatio,
    Regime::Flat,
    Regime::Concentric,
    Regime::Sliver,
    Regime::FarFromOrigin,
];

fn judge(p: &Pair) -> Verdict {
    verdict(&p.a, &p.pa, &p.b, &p.pb)
}

fn distance(p: &Pair) -> (f64, f64) {
    distance_bounds(&p.a, &p.pa, &p.b, &p.pb)
}

/// Runs `check` on pairs of every regime, and says which seed.
fn for_pairs(seed: u64, per_regime: usize, mut check: impl FnMut(&Pair)) {
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for regime in REGIMES {
        for _ in 0..per_regime {
            check(&random_pair(&mut rng, regime));
        }
    }
}

#[test]
fn swapping_keeps_the_verdict() {
    for_pairs(1, 150, |p| {
        let swapped = verdict(&p.b, &p.pb, &p.a, &p.pa);
        if let (Some(s), Some(t)) = (judge(p).shares_point(), swapped.shares_point()) {
            assert_eq!(s, t, "{p:?}");
        }
    });
}

/// Scaling the placements by a power of two scales every exact quantity exactly.
#[test]
fn a_power_of_two_scale_scales_gaps() {
    for_pairs(2, 100, |p| {
        let scale =
            |m: &DAffine3, s: f64| DAffine3 { matrix3: m.matrix3 * s, translation: m.translation * s };
        for s in [1.0 / 1024.0, 65536.0] {
            let scaled = verdict(&p.a, &scale(&p.pa, s), &p.b, &scale(&p.pb, s));
            match (judge(p), scaled) {
                (Verdict::Separated { gap: g }, Verdict::Separated { gap: h }) => {
                    assert_eq!(g * s, h, "{p:?}")
                }
                (Verdict::Intersecting { depth: g }, Verdict::Intersecting { depth: h }) => {
                    assert!((g * s - h).abs() <= 1e-9 * h, "{p:?}");
                }
                (u, v) => assert_eq!(u.shares_point(), v.shares_point(), "{p:?}"),
            }
        }
    });
}

#[test]
fn distances_are_narrow_and_agree_with_the_verdict() {
    let mut apart = 0;
    for_pairs(3, 150, |p| {
        let (low, high) = distance(p);
        match judge(p) {
            Verdict::Separated { gap } => {
                apart += 1;
                assert!(gap <= high && low > 0.0, "{p:?}");
                // What all but touches is known to the last digits of its coordinates.
                let rounding = 1e-16 * p.size;
                assert!(high - low <= 1e-9 * high + rounding, "{low} {high} {p:?}");
                assert!(gap >= high * (1.0 - 1e-7) - rounding, "{gap} {high} {p:?}");
            }
            Verdict::Intersecting { .. } => assert_eq!((low, high), (0.0, 0.0), "{p:?}"),
            Verdict::Uncertain { gap_max } => assert!(high <= gap_max),
        }
    });
    println!("{apart} apart");
}

/// Moving A out by the upper bound parts the shapes; the lower bound never exceeds the overlap along any axis.
#[test]
fn depth_is_bounded_by_every_axis() {
    let mut rng = seeded(40);
    let (mut tight, mut all) = (0, 0);
    for_pairs(4, 100, |p| {
        let Some((low, high)) = penetration_bounds(&p.a, &p.pa, &p.b, &p.pb) else { return };
        assert!(0.0 <= low && low <= high, "{low} {high} {p:?}");
        all += 1;
        tight += usize::from(high - low <= 1e-6 * high + 1e-12 * p.pa.translation.length());
        for _ in 0..20 {
            let axis = DVec3::new(
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
            );
            assert!(low <= -verify_axis(&p.a, &p.pa, &p.b, &p.pb, axis), "{p:?}");
        }
        let Verdict::Intersecting { depth } = judge(p) else { panic!("depth without a common point: {p:?}") };
        assert!(depth <= high, "{depth} {high} {p:?}");
        assert!(depth >= 0.9 * low || depth == 0.0, "{depth} {low} {p:?}");
    });
    println!("{tight} of {all} known to a millionth");
    assert!(tight * 10 >= all * 9);
}

#[test]
fn spheres_agree_with_the_closed_form() {
    let seed = 5;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hit, mut flat, mut open) = (1000, 0, 0, 0);
    for _ in 0..cases {
        // Numbers with few bits: the closed form below is then free of rounding.
        let mut few = |m: i32| f64::from(rng.random_range(-m..=m)) / 8.0;
        let (p, q, r, s) = (
            DVec3::new(few(12), few(12), few(12)),
            DVec3::new(few(12), few(12), few(12)),
            few(16).abs(),
            few(16).abs(),
        );
        let (a, b) = (Convex::Sphere { radius: r }, Convex::Sphere { radius: s });
        let v = verdict(&a, &DAffine3::from_translation(p), &b, &DAffine3::from_translation(q));
        let squared = (p - q).length_squared();
        let touching = squared == (r + s) * (r + s);
        match v {
            Verdict::Intersecting { depth } => {
                hit += 1;
                assert!(squared <= (r + s) * (r + s));
                assert!(depth <= r + s - squared.sqrt() + 1e-14, "{depth}");
                // Where the common point was found on a flat simplex, nothing is known of the depth.
                flat += usize::from(depth == 0.0 && !touching);
                let known = 0.94 * (r + s - squared.sqrt()) - 1e-12;
                assert!(depth == 0.0 || depth >= known, "{depth} {p} {q} {r} {s}");
            }
            Verdict::Separated { gap } => {
                assert!((gap - (squared.sqrt() - r - s)).abs() < 1e-12);
                assert!(squared > (r + s) * (r + s));
            }
            Verdict::Uncertain { gap_max } => {
                open += 1;
                assert!(touching && gap_max < 1e-15, "{gap_max}");
            }
        }
    }
    println!("{hit} hits, {flat} of unknown depth, and {open} undecided touches of {cases}");
    assert!((300..=700).contains(&hit) && flat <= 5);
}

/// The greatest gap over the fifteen axes of two boxes; positive when one of them separates.
fn box_gap(ha: DVec3, pa: &DAffine3, hb: DVec3, pb: &DAffine3) -> f64 {
    let columns = |m: &DMat3| [m.x_axis, m.y_axis, m.z_axis];
    let (ca, cb) = (columns(&pa.matrix3), columns(&pb.matrix3));
    let normals = |c: [DVec3; 3]| [c[0].cross(c[1]), c[1].cross(c[2]), c[2].cross(c[0])];
    let crosses = ca.iter().flat_map(|u| cb.map(|v| u.cross(v)));
    let extent = |h: DVec3, c: [DVec3; 3], n: DVec3| {
        h.x * n.dot(c[0]).abs() + h.y * n.dot(c[1]).abs() + h.z * n.dot(c[2]).abs()
    };
    normals(ca)
        .into_iter()
        .chain(normals(cb))
        .chain(crosses)
        .filter_map(DVec3::try_normalize)
        .map(|n| n.dot(pa.translation - pb.translation).abs() - extent(ha, ca, n) - extent(hb, cb, n))
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn boxes_agree_with_the_separating_axis_test() {
    let seed = 6;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hit) = (2000, 0);
    for _ in 0..cases {
        let mut half = || DVec3::new(rng.random(), rng.random(), rng.random());
        let (ha, hb) = (half(), half());
        let mut place = || {
            let kind = PlacementKind::ALL[rng.random_range(0..5)];
            let mut placement = random_placement(&mut rng, kind);
            placement.translation *= 0.9;
            placement
        };
        let (pa, pb) = (place(), place());
        let sat = box_gap(ha, &pa, hb, &pb);
        let (a, b) = (Convex::Cuboid { half: ha }, Convex::Cuboid { half: hb });
        match verdict(&a, &pa, &b, &pb) {
            Verdict::Intersecting { .. } => {
                hit += 1;
                assert!(sat < 1e-13);
                let (low, high) = penetration_bounds(&a, &pa, &b, &pb).expect("they intersect");
                assert!(
                    low <= -sat + 1e-13 && -sat <= high + 1e-13 && high - low <= 1e-12,
                    "{low} {high} {sat}"
                );
            }
            Verdict::Separated { gap } => assert!(sat > 0.0 && gap >= sat - 1e-13),
            Verdict::Uncertain { .. } => panic!("boxes are always decided"),
        }
    }
    println!("{hit} hits of {cases}");
    assert!((600..=1400).contains(&hit));
}

/// Points on a coarse grid: touching, coplanar, collinear and equal points abound.
fn grid_points(rng: &mut StdRng) -> Vec<DVec3> {
    let shift = DVec3::X * f64::from(rng.random_range(-1..=1));
    let count = rng.random_range(1..=8);
    let mut coordinate = || f64::from(rng.random_range(0..=4)) - 2.0;
    (0..count).map(|_| DVec3::new(coordinate(), coordinate(), coordinate()) + shift).collect()
}

#[test]
fn hulls_agree_with_the_exact_program() {
    let seed = 7;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hit) = (4000, 0);
    for _ in 0..cases {
        let (p, q) = (grid_points(&mut rng), grid_points(&mut rng));
        let exact = hulls_intersect_exact(&p, &q);
        hit += u32::from(exact);
        let hull = |points: &[DVec3]| Convex::Hull { points: points.to_vec() };
        let v = verdict(&hull(&p), &DAffine3::IDENTITY, &hull(&q), &DAffine3::IDENTITY);
        assert_eq!(v.shares_point(), Some(exact), "{p:?} {q:?}");
    }
    println!("{hit} hits of {cases}");
    assert!((cases * 3 / 10..=cases * 7 / 10).contains(&hit));
}

#[test]
fn points_of_a_shape_lie_within_it() {
    let seed = 8;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for _ in 0..300 {
        let shape = random_shape(&mut rng, 1.0);
        let placement = random_placement(&mut rng, PlacementKind::Rigid);
        let direction = random_placement(&mut rng, PlacementKind::Rigid).matrix3.x_axis;
        // A plane that the shape just touches, and a point beyond it.
        let point = Convex::Hull { points: vec![placement.translation + 10.0 * direction] };
        let (low, high) = distance_bounds(&shape, &placement, &point, &DAffine3::IDENTITY);
        let Convex::Hull { points } = &point else { unreachable!() };
        assert!(contains_within(&shape, &placement, points[0], high));
        assert!(!contains_within(&shape, &placement, points[0], low * (1.0 - 2e-9)));
    }
    let cone = Convex::Cone { radius: 1.0, half_height: 1.0 };
    assert!(contains_within(&cone, &DAffine3::IDENTITY, DVec3::Y, 0.0));
    assert!(contains_within(&cone, &DAffine3::IDENTITY, DVec3::ZERO, 0.0));
    assert!(!contains_within(&cone, &DAffine3::IDENTITY, DVec3::new(0.75, 0.0, 0.0), 0.1));
}

/// Placements that flatten a shape to a plane, a line or a point are affine maps like any other.
#[test]
fn singular_placements_are_judged() {
    let ball = Convex::Sphere { radius: 1.0 };
    let flattened = |d: DVec3, t: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(d), translation: t };
    let judge = |p: &DAffine3, q: &DAffine3| verdict(&ball, p, &ball, q);
    let disc = flattened(DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO);
    let beside = |z: f64| flattened(DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.5, 0.0, z));
    assert_eq!(judge(&disc, &beside(0.0)).shares_point(), Some(true));
    assert_eq!(judge(&disc, &beside(0.25)), Verdict::Separated { gap: 0.25 });
    let point = flattened(DVec3::ZERO, DVec3::new(0.0, 1.0, 0.0));
    assert_eq!(judge(&disc, &point), Verdict::Intersecting { depth: 0.0 });
    assert_eq!(judge(&point, &point), Verdict::Intersecting { depth: 0.0 });
}

/// Touches of round shapes at a known point, opened and closed by far less than an ulp of the coordinates.
#[test]
fn gaps_far_below_an_ulp_are_decided() {
    let ball = |radius: f64| Convex::Sphere { radius };
    let cases = [
        (Convex::Capsule { radius: 2.5, half_height: 1.0 }, ball(2.5), DVec3::new(3.0, 5.0, 0.0)),
        (Convex::Cylinder { radius: 3.0, half_height: 1.0 }, ball(5.0), DVec3::new(6.0, 5.0, 0.0)),
        (Convex::Cone { radius: 3.0, half_height: 1.0 }, ball(5.0), DVec3::new(6.0, -5.0, 0.0)),
        (Convex::Cone { radius: 1.0, half_height: 1.0 }, ball(5.0), DVec3::new(3.0, 5.0, 0.0)),
    ];
    for (shape, ball, centre) in &cases {
        for exponent in [30, 50, 60, 66, 73, 80] {
            for sign in [1.0, -1.0] {
                let gap = sign * 2f64.powi(-exponent);
                let away = DAffine3::from_translation(-gap * DVec3::new(3.0, 4.0 * centre.y.signum(), 0.0));
                let placement = DAffine3::from_translation(*centre);
                let v = verdict(shape, &away, ball, &placement);
                assert_eq!(v.shares_point(), Some(gap < 0.0), "{gap:e} {shape:?} {v:?}");
            }
        }
    }
}

/// Law: the generator leaves the gap it was asked for.
#[test]
fn near_touching_pairs_have_their_gap() {
    let seed = 9;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut apart, mut kept) = (0, 0);
    for _ in 0..500 {
        let p = random_pair(&mut rng, Regime::NearTouching { relative_gap: 1e-6 });
        let (low, high) = distance(&p);
        if low > 0.0 {
            apart += 1;
            kept += usize::from((0.5 * (low + high) / p.size - 1e-6).abs() < 1e-9);
        }
    }
    println!("{kept} of {apart} separated pairs have the gap asked for");
    assert!((150..=350).contains(&apart) && kept * 100 >= apart * 90);
}
