//! Shapes that move and turn: by laws, and against small steps.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its hit rate"
)]

mod common;

use common::{
    are_convex, assert_rate, direction, in_cube, overlap_along, placement, random_mesh, some_shape, torus,
};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::seeded;
use solid3d::query::{self, Impact, ImpactOptions, Path};
use solid3d::{Error, Motion, Shape, World, WorldOptions, glam};

const OPTIONS: ImpactOptions = ImpactOptions { path: Path::Turning, tolerance: 1e-8 };

/// A rigid motion: a turn by a vector, about the local origin, and a translation.
#[derive(Clone, Copy, Debug)]
struct Rigid {
    from: DAffine3,
    turn: DVec3,
    way: DVec3,
}

impl Rigid {
    fn at(&self, t: f64) -> DAffine3 {
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(self.turn * t));
        DAffine3 { matrix3: turn * self.from.matrix3, translation: self.from.translation + self.way * t }
    }
}

fn rigid(rng: &mut StdRng, origin: DVec3, way: DVec3) -> Rigid {
    let mut from = placement(rng, 1.0);
    from.translation = origin;
    // At most half a turn, so that the shorter way is this.
    let turn = direction(rng) * rng.random_range(0.0..3.1);
    Rigid { from, turn, way }
}

fn impact(a: &Shape, way_a: &Rigid, b: &Shape, way_b: &Rigid, options: &ImpactOptions) -> Option<Impact> {
    query::time_of_impact(a, &way_a.at(0.0), &way_a.at(1.0), b, &way_b.at(0.0), &way_b.at(1.0), options)
        .unwrap()
}

/// A pair that passes near each other.
fn passing(rng: &mut StdRng, size: f64) -> [Rigid; 2] {
    let away = direction(rng) * rng.random_range(2.0..5.0);
    let mut ways = [DVec3::ZERO, away].map(|origin| {
        let way = in_cube(rng);
        rigid(rng, origin, way)
    });
    ways[0].way = ways[1].way + (away + in_cube(rng) * 2.5) * rng.random_range(0.4..1.4);
    ways.map(|Rigid { mut from, turn, way }| {
        from = DAffine3::from_scale(DVec3::splat(size)) * from;
        Rigid { from, turn, way: way * size }
    })
}

/// Steps along the way, of which none may find what was not found before.
const STEPS: u32 = 60;

/// Law: before the time of impact shapes are apart, at it they are as near as the tolerance says, and without one they never meet. Convex ones are then on
/// either side of a plane across the normal.
#[test]
fn no_contact_comes_before_the_time_of_impact() {
    let seed = 2001;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, mut worst, cases) = (0, 0.0f64, 1200);
    for case in 0..cases {
        let size = 10f64.powi(rng.random_range(-5..6));
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let [way_a, way_b] = passing(&mut rng, size);
        let found = impact(&a, &way_a, &b, &way_b, &OPTIONS);
        let context = || format!("case {case}: {} {} {way_a:?} {way_b:?} {found:?}", a.kind(), b.kind());
        let meet = |t: f64| query::intersects(&a, &way_a.at(t), &b, &way_b.at(t)).unwrap();
        let until = found.map_or(1.0, |impact| impact.time);
        for step in 0..STEPS {
            let t = until * f64::from(step) / f64::from(STEPS);
            assert!(t >= until || !meet(t), "{}: they meet at {t}", context());
        }
        let Some(found) = found else {
            assert!(!meet(1.0), "{}", context());
            continue;
        };
        hits += 1;
        if found.time == 0.0 && found.normal.is_none() {
            assert!(meet(0.0), "{}", context());
            continue;
        }
        let [at_a, at_b] = [&way_a, &way_b].map(|way| way.at(found.time));
        let gap = query::distance(&a, &at_a, &b, &at_b).unwrap();
        worst = worst.max(gap.distance / size);
        assert!(gap.distance < 1e-7 * size, "{}: {}", context(), gap.distance / size);
        let normal = found.normal.unwrap();
        assert!((normal.length() - 1.0).abs() < 1e-12);
        let overlap = overlap_along(normal, &a, &at_a, &b, &at_b) / size;
        assert!(!are_convex(&a, &b) || overlap < 1e-6, "{}: {overlap} along the normal", context());
        let point = Shape::convex_hull(&[found.point]).unwrap();
        for (shape, at) in [(&a, &at_a), (&b, &at_b)] {
            let off = query::distance(shape, at, &point, &DAffine3::IDENTITY).unwrap().distance;
            assert!(off < 1e-7 * size, "{}: {off}", context());
        }
        // Who is which makes no difference but for the sign.
        let swapped = impact(&b, &way_b, &a, &way_a, &OPTIONS);
        assert!(swapped.is_some(), "{}", context());
    }
    println!("the widest gap is {worst:e}");
    assert_rate("turning pairs", hits, cases as usize);
}

/// Half way from a placement to a mirrored one a mesh is flat, and just there a piece of the other's turn ends.
#[test]
fn what_is_turned_inside_out_is_met_before_it_is_flat() {
    let corners = [DVec3::X, DVec3::NEG_X, DVec3::Y - DVec3::X, DVec3::Z - DVec3::X];
    let arrow = Shape::mesh(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).unwrap();
    let disc =
        Shape::mesh([DVec3::Y, DVec3::Z, -DVec3::ONE].map(|p| p * DVec3::new(0.0, 9.0, 9.0)), [[0, 1, 2]]);
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    let (from, to) = (at(-3.0), at(3.0) * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
    // The tip is at -2 + 4 t.
    for (wall, x) in [(disc.unwrap(), -0.25), (Shape::cuboid([0.5, 9.0, 9.0]).unwrap(), 0.0)] {
        let turned = at(x) * DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2);
        let found = query::time_of_impact(&arrow, &from, &to, &wall, &at(x), &turned, &OPTIONS).unwrap();
        assert!((found.unwrap().time - 0.4375).abs() < 1e-6, "{}: {found:?}", wall.kind());
        let swapped = query::time_of_impact(&wall, &at(x), &turned, &arrow, &from, &to, &OPTIONS).unwrap();
        assert!((swapped.unwrap().time - 0.4375).abs() < 1e-6, "{}: {swapped:?}", wall.kind());
    }
}

/// Whatever the tolerance, the gap at the time of impact is less than it, or than what rounding leaves of directions.
#[test]
fn the_gap_is_within_the_tolerance_or_what_rounding_leaves() {
    let mut rng = seeded(2007);
    let (mut hits, mut beyond, cases) = (0, 0, 1500);
    for case in 0..cases {
        let tolerance = 10f64.powi(-(case as i32 % 8) - 3);
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let [way_a, way_b] = passing(&mut rng, 1.0);
        let Some(found) = impact(&a, &way_a, &b, &way_b, &ImpactOptions { tolerance, ..OPTIONS }) else {
            continue;
        };
        hits += 1;
        let reach = |shape: &Shape, way: &Rigid| {
            let local = query::bounds(shape, &DAffine3::IDENTITY).unwrap();
            // No direction is stretched by more, however it turns.
            let entries = way.from.matrix3.to_cols_array();
            let stretch = entries.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            local.min.abs().max(local.max.abs()).length() * stretch
        };
        let reaches = reach(&a, &way_a) + reach(&b, &way_b);
        let apart = [0.0, 1.0].map(|t| way_a.at(t).translation.distance(way_b.at(t).translation));
        let gap = query::distance(&a, &way_a.at(found.time), &b, &way_b.at(found.time)).unwrap().distance;
        let rounding = 1e-7 * (reaches + apart[0].max(apart[1]));
        assert!(gap <= (1.01 * tolerance * reaches).max(rounding), "case {case}: {gap:e} for {tolerance:e}");
        beyond += usize::from(gap > tolerance * reaches);
    }
    println!("{beyond} of {hits} are beyond their tolerance");
    assert!(beyond > hits / 50, "the tolerance would do");
    assert_rate("tolerances", hits, cases as usize);
}

/// On a straight way only what collides has a time of impact, or comes nearer than the tolerance.
#[test]
fn what_passes_within_the_tolerance_has_a_time_but_no_collision() {
    let block = Shape::cuboid([1.0, 1.0, 1.0]).unwrap();
    let at = |x: f64, y: f64| DAffine3::from_translation(DVec3::new(x, y, 0.0));
    for (gap, comes_near) in [(1e-9, true), (1e-6, false)] {
        let mut world =
            World::with_options(&WorldOptions { motion: Motion::Swept, ..WorldOptions::default() });
        let [still, passing] = [at(0.0, 0.0), at(-3.0, 1.0 + gap)].map(|at| world.add(&block, at).unwrap());
        world.set_placement(passing, at(3.0, 1.0 + gap)).unwrap();
        assert!(world.test().is_empty());
        let options = ImpactOptions { path: Path::Straight, ..OPTIONS };
        let impact = world.time_of_impact(still, passing, &options).unwrap();
        assert_eq!(impact.is_some(), comes_near, "{gap} {impact:?}");
    }
}

/// Law: a unit of length that is a power of two larger changes nothing but lengths.
#[test]
fn scaling_by_a_power_of_two_changes_no_time() {
    let mut rng = seeded(2002);
    for case in 0..200 {
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let [way_a, way_b] = passing(&mut rng, 1.0);
        let path = if case % 2 == 0 { Path::Turning } else { Path::Straight };
        let options = ImpactOptions { path, ..OPTIONS };
        let times = [1.0, 1024.0, 2f64.powi(-80)].map(|unit| {
            let ends = [&way_a, &way_b].map(|way| {
                [0.0, 1.0].map(|t| {
                    let at = way.at(t);
                    DAffine3 { matrix3: at.matrix3 * unit, translation: at.translation * unit }
                })
            });
            let [[from_a, to_a], [from_b, to_b]] = &ends;
            let found = query::time_of_impact(&a, from_a, to_a, &b, from_b, to_b, &options).unwrap();
            found.map(|impact| (impact.time, impact.normal, impact.point / unit))
        });
        assert!(times[0] == times[1] && times[0] == times[2], "case {case}: {times:?}");
    }
}

/// A straight path is that of a cast, when nothing turns.
#[test]
fn translation_alone_agrees_with_the_cast() {
    let mut rng = seeded(2003);
    let (mut hits, cases) = (0, 400);
    for case in 0..cases {
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let [mut way_a, mut way_b] = passing(&mut rng, 1.0);
        (way_a.turn, way_b.turn) = (DVec3::ZERO, DVec3::ZERO);
        let found = impact(&a, &way_a, &b, &way_b, &OPTIONS);
        let cast = query::cast_shape(&a, &way_a.from, way_a.way, &b, &way_b.from, way_b.way).unwrap();
        hits += usize::from(cast.is_some());
        match (found, cast) {
            (None, None) => {}
            (Some(found), Some(cast)) => {
                // Near to the tolerance a grazing motion goes a long way.
                assert!(found.time <= cast.time + 1e-9, "case {case}: {found:?} {cast:?}");
                assert!(cast.time - found.time < 1e-3, "case {case}: {found:?} {cast:?}");
            }
            (Some(found), None) => {
                let [at_a, at_b] = [&way_a, &way_b].map(|way| way.at(found.time));
                let gap = query::distance(&a, &at_a, &b, &at_b).unwrap().distance;
                assert!(gap < 1e-7, "case {case}: {gap}");
            }
            (None, Some(_)) => panic!("case {case}: {cast:?} was missed"),
        }
    }
    assert_rate("translations", hits, cases as usize);
}

/// A small ball that flies past a box which spins fast. A time of impact that looks at the ends of the way, or advances along a fixed
/// normal, misses some; none that overlaps for a twentieth of the way is missed here.
#[test]
fn a_ball_against_a_spinning_box_is_never_missed() {
    const SAMPLES: u32 = 200;
    let mut rng = seeded(2004);
    let (mut hits, mut short, cases) = (0, 0, 1500);
    let (ball, block) = (Shape::sphere(0.1).unwrap(), Shape::cuboid([2.0, 0.2, 0.6]).unwrap());
    for case in 0..cases {
        let turn = direction(&mut rng) * rng.random_range(1.0..3.1);
        let spinning = Rigid { from: placement_rigid(&mut rng), turn, way: DVec3::ZERO };
        let start = direction(&mut rng) * rng.random_range(0.8..1.6);
        let way = (direction(&mut rng) * 0.6 - start) * rng.random_range(0.5..1.5);
        let flying = Rigid { from: DAffine3::from_translation(start), turn: DVec3::ZERO, way };
        let found = impact(&ball, &flying, &block, &spinning, &OPTIONS);
        let met = (0..=SAMPLES)
            .map(|i| f64::from(i) / f64::from(SAMPLES))
            .filter(|&t| query::intersects(&ball, &flying.at(t), &block, &spinning.at(t)).unwrap());
        let met: Vec<f64> = met.collect();
        if let Some(&first) = met.first() {
            hits += 1;
            short += usize::from(met.len() < SAMPLES as usize / 2);
            let found = found.unwrap_or_else(|| panic!("case {case}: missed, for {} samples", met.len()));
            assert!(found.time <= first, "case {case}: {} {first}", found.time);
        }
    }
    println!("{short} overlap for less than half of the way");
    assert!(short > 100);
    assert_rate("spinning boxes", hits, cases);
}

fn placement_rigid(rng: &mut StdRng) -> DAffine3 {
    let turn = DQuat::from_scaled_axis(direction(rng) * rng.random_range(0.0..3.1));
    DAffine3::from_quat(turn)
}

/// Meshes of which every vertex moves: against small steps, and against the placements that do the same.
#[test]
fn no_contact_of_deforming_meshes_is_missed() {
    let mut rng = seeded(2005);
    let (mut hits, cases) = (0, 300);
    for case in 0..cases {
        let soups = [torus(9, 6, 0.3), random_mesh(&mut rng, 60)];
        let shift = direction(&mut rng) * 2.6;
        let ways = [0.0, 1.0].map(|part| {
            [placement(&mut rng, 0.1), placement(&mut rng, 0.1)].map(|mut at| {
                at.translation = shift * part;
                at
            })
        });
        let ends: [[Vec<DVec3>; 2]; 2] = std::array::from_fn(|i| {
            let onward =
                shift * if i == 0 { 1.0 } else { 0.0 } * rng.random_range(0.4..1.2) + in_cube(&mut rng) * 0.5;
            let moved = soups[i].vertices.iter().map(|&v| v + onward + 0.2 * in_cube(&mut rng));
            [soups[i].vertices.clone(), moved.collect()]
        });
        let shapes = [0, 1].map(|i| {
            let was = soups[i].shape();
            let mut is = was.clone();
            is.deform(&ends[i][1]).unwrap();
            [was, is]
        });
        let [a, b] = [0, 1].map(|i| [0, 1].map(|end| (&shapes[i][end], &ways[i][end])));
        let found = query::time_of_impact_deforming(a, b, &OPTIONS).unwrap();
        let world = |i: usize, t: f64| {
            let corners = |end: usize| ends[i][end].iter().map(move |&v| (end, v));
            let placed = |(end, v): (usize, DVec3)| ways[i][end].transform_point3(v);
            let at = corners(0).zip(corners(1)).map(|(p, q)| placed(p).lerp(placed(q), t));
            Shape::mesh(at.collect::<Vec<_>>(), soups[i].triangles()).unwrap()
        };
        let here = DAffine3::IDENTITY;
        let until = found.map_or(1.0, |impact| impact.time);
        for step in 0..24 {
            let t = until * f64::from(step) / 24.0;
            let meet = t < until && query::intersects(&world(0, t), &here, &world(1, t), &here).unwrap();
            assert!(!meet, "case {case}: they meet at {t}, {found:?}");
        }
        let Some(found) = found else { continue };
        hits += 1;
        let gap = query::distance(&world(0, found.time), &here, &world(1, found.time), &here).unwrap();
        assert!(gap.distance < 1e-6, "case {case}: {} {found:?}", gap.distance);
    }
    assert_rate("deforming meshes", hits, cases);
}

/// Law: two meshes meet when the first two of their triangles do.
#[test]
fn meshes_meet_when_the_first_of_their_triangles_do() {
    let seed = 2012;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, mut worst, cases) = (0, 0.0f64, 60);
    for case in 0..cases {
        let soups = [torus(8, 6, 0.3), random_mesh(&mut rng, 30)];
        let [a, b] = soups.each_ref().map(|soup| soup.shape());
        let [way_a, way_b] = passing(&mut rng, 1.0);
        let options = ImpactOptions { path: [Path::Turning, Path::Straight][case % 2], ..OPTIONS };
        let Some(found) = impact(&a, &way_a, &b, &way_b, &options) else { continue };
        let [of_a, of_b] = soups.each_ref().map(|soup| {
            let hull = |p: &Vec<u32>| p.iter().map(|&i| soup.vertices[i as usize]).collect::<Vec<_>>();
            let hulls = soup.primitives.iter().map(|p| Shape::convex_hull(&hull(p)).unwrap());
            hulls.collect::<Vec<_>>()
        });
        let pairs = of_a.iter().flat_map(|x| of_b.iter().map(move |y| (x, y)));
        let times = pairs.filter_map(|(x, y)| Some(impact(x, &way_a, y, &way_b, &options)?.time));
        let first = times.fold(f64::INFINITY, f64::min);
        worst = worst.max((found.time - first).abs());
        hits += 1;
    }
    println!("times differ by up to {worst:e}");
    assert!(worst < 1e-6, "what grazes may be told by a gap");
    assert_rate("meshes on their way", hits, cases);
}

/// Law: vertices far from the local origin, as in coordinates of the earth, change the time by no more than their rounding does.
#[test]
fn far_from_local_origins_the_time_is_the_same() {
    let mut rng = seeded(1107);
    let (mut hits, cases) = (0, 600);
    for case in 0..cases {
        let far = direction(&mut rng) * [3e3, 5e6][case % 2];
        // The same shape around its origin and far from it, and what brings it back.
        let shape = |rng: &mut StdRng| {
            let hull = rng.random_bool(0.5);
            let soup = random_mesh(rng, 40);
            let here = &soup.vertices;
            let there: Vec<DVec3> = here.iter().map(|vertex| *vertex + far).collect();
            if hull {
                return [Shape::convex_hull(here).unwrap(), Shape::convex_hull(&there).unwrap()];
            }
            [Shape::mesh(&here[..], soup.triangles()).unwrap(), Shape::mesh(there, soup.triangles()).unwrap()]
        };
        let ([a, far_a], [b, far_b]) = (shape(&mut rng), shape(&mut rng));
        let back = DAffine3::from_translation(-far);
        let way = in_cube(&mut rng) * 3.0;
        let from = DAffine3::from_translation(in_cube(&mut rng) * 2.5) * placement(&mut rng, 1.0);
        let to = DAffine3 { translation: from.translation + way, ..from };
        let still = placement(&mut rng, 1.0);
        let time = |a: &Shape, b: &Shape, from: DAffine3, to: DAffine3, still: DAffine3| {
            query::time_of_impact(a, &from, &to, b, &still, &still, &OPTIONS)
                .unwrap()
                .map(|impact| impact.time)
        };
        let here = time(&a, &b, from, to, still);
        let there = time(&far_a, &far_b, from * back, to * back, still * back);
        hits += usize::from(here.is_some());
        match (here, there) {
            (None, None) => {}
            // What just grazes is a matter of rounding.
            (Some(here), Some(there)) => assert!((here - there).abs() < 1e-3, "{case}: {here} and {there}"),
            _ => panic!("{case}: {here:?} and {there:?}"),
        }
    }
    assert_rate("pairs", hits, cases);
}

/// Law: nor do they change the normal, which is sought where the hulls are all but in touch.
#[test]
fn far_from_local_origins_the_normal_is_the_same() {
    let far = DVec3::new(1e6, -7e5, 3e5);
    let corners: Vec<DVec3> = common::cube(0.5).vertices.iter().map(|&corner| corner + far).collect();
    let (hull, back) = (Shape::convex_hull(&corners).unwrap(), DAffine3::from_translation(-far));
    let turned = DAffine3::from_rotation_z(0.3) * DAffine3::from_rotation_x(0.5);
    for turn in [DAffine3::IDENTITY, turned] {
        let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.1, 0.2)) * turn * back;
        let found = query::time_of_impact(&hull, &at(-3.0), &at(1.0), &hull, &back, &back, &OPTIONS).unwrap();
        let normal = found.unwrap().normal.unwrap();
        assert!((normal + DVec3::X).length() < 1e-6, "{turn}: {normal}");
    }
}

/// What starts nearly in touch and leaves, or slides, does not meet.
#[test]
fn what_leaves_does_not_meet_at_the_start() {
    let block = Shape::cuboid([1.0, 1.0, 1.0]).unwrap();
    let at = |x: f64, y: f64| DAffine3::from_translation(DVec3::new(x, y, 0.0));
    let here = at(0.0, 0.0);
    for gap in [1e-9, 1e-8, 1e-3] {
        let start = at(1.0 + gap, 0.0);
        for (to, meets) in [(at(2.0, 0.0), false), (at(1.0 + gap, 1.5), false), (at(0.5, 0.0), true)] {
            let found = query::time_of_impact(&block, &start, &to, &block, &here, &here, &OPTIONS).unwrap();
            assert_eq!(found.is_some(), meets, "{gap} {to:?} {found:?}");
        }
    }
}

/// What is round may turn about its axis, or its middle, as near as it likes to what is beside it: a wheel and a ball that roll, a pin in a hole.
#[test]
fn what_is_round_rolls_and_spins_beside_what_it_nearly_touches() {
    let here = DAffine3::IDENTITY;
    let tile = [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]].map(DVec3::from);
    let floor = Shape::mesh(tile, [[0, 2, 1], [0, 3, 2]]).unwrap();
    let [ball, wheel] = [Shape::sphere(1.0).unwrap(), Shape::cylinder(1.0, 0.5).unwrap()];
    let upright = DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2);
    for gap in [1e-2, 1e-4, 1e-6, 1e-7] {
        let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 1.0 + gap, 0.0));
        for (round, start, turn) in [
            (&ball, here, DAffine3::from_rotation_z(-1.5)),
            (&ball, here, DAffine3::from_axis_angle(DVec3::ONE.normalize(), 3.0)),
            (&wheel, upright, DAffine3::from_rotation_z(-1.5)),
        ] {
            let (from, to) = (at(0.0) * start, at(1.5) * turn * start);
            let forth = query::time_of_impact(round, &from, &to, &floor, &here, &here, &OPTIONS).unwrap();
            let back = query::time_of_impact(&floor, &here, &here, round, &from, &to, &OPTIONS).unwrap();
            assert_eq!((forth, back), (None, None), "{} {gap}", round.kind());
        }

        let pin = Shape::cylinder(1.0, 3.0).unwrap();
        let side = 2.0 * (1.0 + gap) * (std::f64::consts::PI / 32.0).tan();
        let slab = Shape::cuboid([1.0, 2.0, side]).unwrap();
        for i in 0..32 {
            let around = DAffine3::from_rotation_y(f64::from(i) * std::f64::consts::PI / 16.0)
                * DAffine3::from_translation(DVec3::X * (1.5 + gap));
            let spun = DAffine3::from_rotation_y(3.0);
            let found = query::time_of_impact(&pin, &here, &spun, &slab, &around, &around, &OPTIONS).unwrap();
            assert_eq!(found, None, "{i} {gap}");
        }
    }
}

/// A unit cube as a body, as a hull and as a mesh, whose surface alone is met.
fn cubes() -> [Shape; 3] {
    let mesh = common::cube(0.5).shape();
    let corners: Vec<DVec3> = mesh.vertices().unwrap().to_vec();
    [Shape::cuboid([1.0; 3]).unwrap(), Shape::convex_hull(&corners).unwrap(), mesh]
}

/// Law: the normal leads from the second shape to the first, of whatever class they are.
#[test]
fn the_normal_leads_from_the_second_to_the_first() {
    let at = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.1, -0.2));
    let [here, from, to] = [0.0, -3.0, 1.0].map(at);
    for moving in cubes() {
        for still in cubes() {
            let forth = query::time_of_impact(&moving, &from, &to, &still, &here, &here, &OPTIONS).unwrap();
            let back = query::time_of_impact(&still, &here, &here, &moving, &from, &to, &OPTIONS).unwrap();
            for (found, normal) in [(forth, DVec3::NEG_X), (back, DVec3::X)] {
                let Impact { time, normal: found, .. } = found.unwrap();
                assert!((time - 0.5).abs() < 1e-7, "{} {}: {time}", moving.kind(), still.kind());
                assert!(
                    (found.unwrap() - normal).length() < 1e-6,
                    "{} {}: {found:?}",
                    moving.kind(),
                    still.kind()
                );
            }
        }
    }
}

/// Small triangles, one beside the other along z, as far from that axis as their tips, which lead away from it.
fn comb(tip: f64, root: f64, unit: f64) -> Shape {
    let corners = (0..40).flat_map(|i| {
        let z = 0.1 * f64::from(i - 20);
        [DVec3::new(tip, 0.0, z), DVec3::new(root, 0.0, z - 0.01), DVec3::new(root, 0.0, z + 0.01)]
    });
    let triangles: Vec<[u32; 3]> = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::mesh(corners.map(|corner| corner * unit).collect::<Vec<_>>(), triangles).unwrap()
}

/// What turns goes along an arc, which boxes that follow its chord do not reach: also of a mesh whose own unit of length is another, and of
/// one that grows on the way.
#[test]
fn what_only_an_arc_reaches_is_met() {
    const HALF_ANGLE: f64 = 0.095;
    for unit in [1.0, 1024.0, 1.0 / 1024.0] {
        for growth in [1.0, 3.0] {
            let at = |angle: f64, size: f64| {
                DAffine3::from_rotation_z(angle) * DAffine3::from_scale(DVec3::splat(size / unit))
            };
            let (from, to) = (at(-HALF_ANGLE, 1.0), at(HALF_ANGLE, growth));
            // Half way the tips are there.
            let reach = 0.5 * (1.0 + growth);
            let (turning, wall) = (comb(1.0, 0.99, unit), comb(0.9995 * reach, 2.0 * reach, 1.0));
            let corners: Vec<DVec3> = wall.vertices().unwrap()[60..63].to_vec();
            let here = DAffine3::IDENTITY;
            for still in [
                &wall,
                &Shape::mesh(corners.clone(), [[0, 1, 2]]).unwrap(),
                &Shape::convex_hull(&corners).unwrap(),
            ] {
                let forth =
                    query::time_of_impact(&turning, &from, &to, still, &here, &here, &OPTIONS).unwrap();
                let back =
                    query::time_of_impact(still, &here, &here, &turning, &from, &to, &OPTIONS).unwrap();
                for found in [forth, back] {
                    let time = found.unwrap_or_else(|| panic!("{unit} {growth} {}", still.kind())).time;
                    assert!((time - 0.5).abs() < 0.01, "{unit} {growth} {}: {time}", still.kind());
                }
            }
        }
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let (ball, mesh) = (Shape::sphere(1.0).unwrap(), torus(3, 3, 0.5).shape());
    let here = DAffine3::IDENTITY;
    for tolerance in [f64::NAN, 0.0, 9e-11, 1.1, f64::INFINITY] {
        let options = ImpactOptions { tolerance, ..OPTIONS };
        let error = query::time_of_impact(&ball, &here, &here, &ball, &here, &here, &options).unwrap_err();
        assert!(error.to_string().starts_with("tolerance is "), "{error}");
    }
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let wild = DAffine3::from_translation(DVec3::splat(f64::NAN));
    for bad in [flat, wild] {
        for [from, to] in [[&bad, &here], [&here, &bad]] {
            assert!(query::time_of_impact(&ball, from, to, &ball, &here, &here, &OPTIONS).is_err());
            assert!(query::time_of_impact(&ball, &here, &here, &ball, from, to, &OPTIONS).is_err());
        }
    }
    let other = torus(3, 3, 0.5).shape();
    let error =
        query::time_of_impact_deforming([(&mesh, &here), (&other, &here)], [(&ball, &here); 2], &OPTIONS);
    assert!(matches!(error, Err(Error::NotADeformation { argument: "a", .. })), "{error:?}");
}

/// Wild but allowed numbers neither panic nor hang.
#[test]
fn wild_placements_are_survived() {
    let mut rng = seeded(2006);
    let wild = [0.0, 5e-324, 1e-100, 1e-30, 1.0, -3.0, 1e16, 1e100, -1e100];
    let mut answered = 0;
    for case in 0..600 {
        let (a, b) = (some_shape(&mut rng, case), some_shape(&mut rng, case / 4));
        let mut pick = || DVec3::from_array(std::array::from_fn(|_| wild[rng.random_range(0..wild.len())]));
        let [p, q, r, s] = [(); 4].map(|()| DAffine3 {
            matrix3: match case % 3 {
                0 => DMat3::IDENTITY,
                1 => DMat3::from_diagonal(pick()),
                _ => DMat3::from_cols(pick(), pick(), pick()),
            },
            translation: pick(),
        });
        let Ok(found) = query::time_of_impact(&a, &p, &q, &b, &r, &s, &OPTIONS) else { continue };
        answered += 1;
        assert!(found.is_none_or(|impact| (0.0..=1.0).contains(&impact.time)), "{found:?}");
    }
    assert!(answered > 150, "{answered}");
}
