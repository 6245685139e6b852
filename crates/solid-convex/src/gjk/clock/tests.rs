//! Tests of the clock: as long as it runs, the last answer is that of a search.

use glam::DQuat;

use super::*;
use crate::gjk::{Glance, Memory, intersects};
use crate::simd::{Level, dispatch, levels};
use crate::testing::{octahedron_faces, placement, shapes};
use crate::{Cuboid, Polytope};

/// A motion: in a frame it moves and turns by this, in sizes of the objects.
const STEPS: [f64; 4] = [1e-9, 0.004, 0.03, 0.3];
/// Units of length, and how far from the world's origin.
const UNITS: [(f64, f64); 5] = [(1.0, 0.0), (1e-9, 1e-9), (1e9, 1e8), (1.0, 1e6), (1e-3, 1e5)];
/// What a placement does to an object beside turning it.
const LINEARS: [DMat3; 4] = [
    DMat3::IDENTITY,
    DMat3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.0, 1.0)),
    DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.9, 0.7, 0.0), DVec3::new(-0.3, 0.8, 0.6)),
    DMat3::from_cols(DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1e-4, 0.0), DVec3::new(0.0, 0.0, 1.5)),
];

/// Law: it says nothing else than a search from nothing, whatever moves, by how little or much, in any unit, far from the origin, stretched,
/// sheared and flat. And where little moves, it does say something.
#[test]
fn it_says_what_a_search_from_nothing_says() {
    let far_off = (0..60).map(|i| placement(i).translation + DVec3::new(3.0, 0.0, 1.0)).collect();
    let far_off = Box::new(Polytope::new(far_off).unwrap()) as Box<dyn Support>;
    let shapes: Vec<_> = shapes().into_iter().chain([far_off]).collect();
    let (mut asked, mut hits, mut told) = (0, 0, [0; STEPS.len()]);
    for (i, a) in shapes.iter().enumerate() {
        for (j, b) in shapes.iter().enumerate() {
            for (k, (unit, far)) in UNITS.into_iter().enumerate() {
                for (s, step) in STEPS.into_iter().enumerate() {
                    let seed = (i + 7 * j + 31 * k + 173 * s) as u32;
                    let mut memory = Memory::default();
                    let linear = [LINEARS[(i + k + s) % 4], LINEARS[(j + k) % 4]];
                    let mut at = [placement(seed), placement(seed + 50)];
                    let spins =
                        [placement(seed + 1), placement(seed + 2)].map(|at| at.translation.normalize());
                    for frame in 0..40 {
                        let placed = [0, 1].map(|n| {
                            let linear = at[n].matrix3 * linear[n];
                            let center = [a.center(), b.center()][n];
                            let translation = at[n].translation * 1.0 - linear * center;
                            DAffine3 { matrix3: linear * unit, translation: (translation + far) * unit }
                        });
                        let [at_a, at_b] = &placed;
                        let expected = intersects(&**a, at_a, &**b, at_b);
                        let still = memory.still(at_a, at_b);
                        let context = format!("{i} and {j} in {unit:e} by {step:e}, frame {frame}");
                        assert!(still.is_none_or(|still| still == expected), "{context}: {still:?}");
                        assert_eq!(memory.intersects(&**a, at_a, &**b, at_b), expected, "{context}");
                        asked += 1;
                        hits += usize::from(expected);
                        told[s] += usize::from(still.is_some());
                        for n in 0..2 {
                            let turn = DMat3::from_quat(DQuat::from_axis_angle(spins[n], step));
                            at[n].matrix3 = turn * at[n].matrix3;
                            let way = placement(seed + frame / 20 + 3 * n as u32).translation.normalize();
                            at[n].translation += way * if frame % 10 < 5 { step } else { -step };
                        }
                    }
                }
            }
        }
    }
    assert!((30..=70).contains(&(100 * hits / asked)), "{hits} of {asked}: not representative");
    let rates = told.map(|told| 100 * told * STEPS.len() / asked);
    assert!(rates[0] >= 90 && rates[1] >= 85 && rates[2] >= 55, "{rates:?} % were told");
}

/// At the bound: blocks that come near, or turn towards each other, are told apart until just before they touch, and not after.
#[test]
fn it_runs_out_just_before_they_touch() {
    let block = Cuboid::new(DVec3::ONE).unwrap();
    for unit in [1e-9, 1.0, 1e9] {
        let at = |x: f64| DAffine3 {
            matrix3: DMat3::IDENTITY * unit,
            translation: DVec3::new(x, 0.1, -0.1) * unit,
        };
        let mut memory = Memory::default();
        assert!(!memory.intersects(&block, &at(0.0), &block, &at(2.0)));
        assert_eq!(memory.still(&at(0.0), &at(1.00001)), Some(false));
        assert_eq!(memory.still(&at(0.99999), &at(2.0)), Some(false));
        for gap in [1e-9, 0.0, -1e-9] {
            assert_eq!(memory.still(&at(0.0), &at(1.0 + gap)), None, "{gap:e}");
            assert_eq!(memory.still(&at(0.5), &at(1.5 + gap)), None, "{gap:e}");
        }
        // Their corners are 0.866 from their middles: with such a way to go, no turn is safe.
        let turned = |x: f64, angle: f64| {
            let at = at(x);
            DAffine3 { matrix3: at.matrix3 * DMat3::from_rotation_z(angle), ..at }
        };
        let chord = |angle: f64| 2.0 * (0.5 * angle).sin() * 0.75f64.sqrt();
        for angle in [0.05, 0.1, 0.2] {
            let near = 1.0 + chord(angle);
            assert_eq!(memory.still(&at(0.0), &turned(near + 1e-5, angle)), Some(false), "{angle}");
            assert_eq!(memory.still(&at(0.0), &turned(near - 1e-5, angle)), None, "{angle}");
            let near = 1.0 - chord(angle);
            assert_eq!(memory.still(&turned(near - 1e-5, angle), &at(2.0)), Some(false), "{angle}");
            assert_eq!(memory.still(&turned(near + 1e-5, angle), &at(2.0)), None, "{angle}");
        }
    }
}

/// The answer of a memory of two polytopes, where there is one without a search, and whether the clock gave it.
fn seen(level: Level, memory: &mut Memory, [a, b]: [(&Polytope, &DAffine3); 2]) -> (Glance, bool) {
    dispatch!(level, simd => match memory.still_by(simd, a.1, b.1) {
        Some(answer) => (Glance::Sure(answer), true),
        None => (memory.glance_by(simd, a, b), false),
    })
}

/// Law: what balls and the kept axis leave to the clock is what a search from nothing says, whatever moves, by how little or much, in any unit, far
/// from the origin; and every level of instructions says the same.
#[test]
fn what_a_glance_leaves_is_what_a_search_from_nothing_says() {
    let cloud = |seed: u32, count: u32, off: DVec3| {
        Polytope::new((0..count).map(|i| placement(seed + i).translation + off).collect()).unwrap()
    };
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
    let faces = (0..6).flat_map(|k| {
        let (axis, side) = (k / 2, k % 2);
        // The lower face is seen from below.
        let [u, v] = [[2, 1], [1, 2]][side as usize];
        let at = |a: u32, b: u32| side << axis | a << ((axis + u) % 3) | b << ((axis + v) % 3);
        [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]
    });
    let block = Polytope::new((0..8).map(corner).collect()).unwrap().with_faces(&faces.collect::<Vec<_>>());
    let objects = [block, cloud(3, 20, DVec3::ZERO), cloud(70, 40, DVec3::new(3.0, 0.0, 1.0))];
    let (mut asked, mut hits, mut told, mut glanced) = (0, 0, [0; STEPS.len()], 0);
    for (i, a) in objects.iter().enumerate() {
        for (j, b) in objects.iter().enumerate() {
            for (k, (unit, far)) in UNITS.into_iter().enumerate() {
                for (s, step) in STEPS.into_iter().enumerate() {
                    let seed = (i + 5 * j + 37 * k + 191 * s) as u32;
                    let mut memories = [Memory::default(); 2];
                    let mut at = [placement(seed), placement(seed + 50)];
                    for frame in 0..60 {
                        let [at_a, at_b] = [(a, at[0]), (b, at[1])].map(|(object, at)| {
                            let linear = at.matrix3 * unit * 0.7;
                            let translation = (at.translation * 0.8 + far) * unit;
                            DAffine3 { matrix3: linear, translation: translation - linear * object.center() }
                        });
                        let expected = intersects(a, &at_a, b, &at_b);
                        let context = format!("{i} and {j} in {unit:e} by {step:e}, frame {frame}");
                        let mut answers = [None; 2];
                        for (n, memory) in memories.iter_mut().enumerate() {
                            let answer = seen(levels()[n], memory, [(a, &at_a), (b, &at_b)]);
                            match answer.0 {
                                Glance::Sure(answer) => assert_eq!(answer, expected, "{context}"),
                                _ => assert_eq!(
                                    memory.intersects_anew(a, &at_a, b, &at_b),
                                    expected,
                                    "{context}"
                                ),
                            }
                            answers[n] = Some(answer);
                        }
                        assert_eq!(answers[0], answers[1], "{context}");
                        let (glance, clock) = answers[0].unwrap();
                        asked += 1;
                        hits += usize::from(expected);
                        told[s] += usize::from(clock);
                        glanced += usize::from(!clock && matches!(glance, Glance::Sure(_)));
                        for (n, at) in at.iter_mut().enumerate() {
                            let way = placement(seed + frame / 20 + 3 * n as u32).translation.normalize();
                            at.matrix3 = DMat3::from_quat(DQuat::from_axis_angle(way, step)) * at.matrix3;
                            at.translation += way * if frame % 20 < 10 { step } else { -step };
                        }
                    }
                }
            }
        }
    }
    assert!((30..=70).contains(&(100 * hits / asked)), "{hits} of {asked}: not representative");
    let rates = told.map(|told| 100 * told * STEPS.len() / asked);
    assert!(rates[0] >= 90 && rates[1] >= 80 && rates[2] >= 40, "{rates:?} % were told");
    assert!(glanced > 500, "{glanced}");
}

/// At the bound: balls that come near, or part, straight or by a turn about a point far off, are told until just before they touch, and not after.
#[test]
fn balls_run_out_just_before_they_touch() {
    let corners = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let rod = Polytope::new(corners[..5].to_vec()).unwrap();
    let block = Polytope::new(corners).unwrap().with_faces(&octahedron_faces());
    let [_, around] = rod.sure_radii();
    let [inside, _] = block.sure_radii();
    for (object, distance, room, meet) in
        [(&rod, 10.0, 10.0 - 2.0 * around, false), (&block, 0.5, 2.0 * inside - 0.5, true)]
    {
        let reach = object.farthest();
        // Which way it goes on.
        let sign = if meet { -1.0 } else { 1.0 };
        for unit in [1e-9, 1.0, 1e9] {
            let at = |x: f64| DAffine3 {
                matrix3: DMat3::IDENTITY * unit,
                translation: DVec3::new(x, 0.0, 0.0) * unit,
            };
            let mut memory = Memory::default();
            for level in levels() {
                let (here, there) = (at(0.0), at(distance));
                memory.rest();
                assert_eq!(
                    seen(level, &mut memory, [(object, &here), (object, &there)]),
                    (Glance::Sure(meet), false)
                );
                // Of the four lengths that sum to the room each may be half of it alone; and all a quarter.
                let half = 0.5 * room;
                let turn = |x: f64, part: f64| {
                    let change = DMat3::from_diagonal(DVec3::new(part / reach, 0.0, 0.0)) * unit;
                    DAffine3 { matrix3: at(x).matrix3 + change, ..at(x) }
                };
                for (part, told) in [(0.9999, Some(meet)), (1.0001, None)] {
                    assert_eq!(memory.still(&here, &at(distance - sign * half * part)), told);
                    assert_eq!(memory.still(&at(sign * half * part), &there), told);
                    // The axes may change by half at most.
                    let change = half.min(0.5 * reach) * part;
                    assert_eq!(memory.still(&here, &turn(distance, change)), told);
                }
            }
        }
    }
}

/// What is no placement has no answer, and what turned far none by this.
#[test]
fn wild_placements_stop_it() {
    let block = Cuboid::new(DVec3::ONE).unwrap();
    let here = DAffine3::IDENTITY;
    for x in [0.25, 50.0] {
        let there = DAffine3::from_translation(DVec3::new(x, 0.1, -0.05));
        let mut memory = Memory::default();
        assert_eq!(memory.still(&here, &there), None);
        let expected = memory.intersects(&block, &here, &block, &there);
        assert_eq!(memory.still(&here, &there), Some(expected));
        let wild = [
            DAffine3 { translation: DVec3::new(x, f64::NAN, 0.0), ..there },
            DAffine3 { translation: DVec3::new(x, 0.0, f64::INFINITY), ..there },
            DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, f64::NAN, 1.0)), ..there },
            DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)), ..there },
            DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1e9, 1.0)), ..there },
            DAffine3 { matrix3: DMat3::from_rotation_y(0.5), ..there },
        ];
        for wild in wild {
            assert_eq!(memory.still(&here, &wild), None, "{wild}");
            assert_eq!(memory.still(&wild, &there), None, "{wild}");
        }
        // Both so far off that nothing shows it in their offset.
        let far = DVec3::splat(1e120);
        let [here, there] = [here, there].map(|at| DAffine3 { translation: at.translation + far, ..at });
        assert_eq!(memory.still(&here, &there), None);
    }
}

/// It is not set of placements next to singular, nor where products of lengths might overflow or vanish.
#[test]
fn it_is_set_of_plain_sizes_alone() {
    let tell = |size: f64, scale: f64, way: f64, matrix3: DMat3| {
        let block = Cuboid::new(DVec3::splat(size)).unwrap();
        let here = DAffine3 { matrix3: matrix3 * scale, translation: DVec3::splat(way) };
        let there = DAffine3 { translation: here.translation + DVec3::X * (4.0 * scale * size), ..here };
        let mut memory = Memory::default();
        let found = memory.intersects(&block, &here, &block, &there);
        assert_eq!(found, intersects(&block, &here, &block, &there));
        let still = memory.still(&here, &there);
        assert!(still.is_none_or(|still| still == found));
        still.is_some()
    };
    let square = DMat3::IDENTITY;
    for unit in [1e-30, 1.0, 1e30] {
        assert!(tell(1.0, unit, 0.0, square) && tell(unit, 1.0, 0.0, square), "{unit:e}");
    }
    for unit in [1e-80, 1e-36, 1e36, 1e80] {
        assert!(!tell(1.0, unit, 0.0, square) && !tell(unit, 1.0, 0.0, square), "{unit:e}");
    }
    assert!(tell(1e34, 1.0, 1e34, square) && !tell(1e34, 1.0, 1e36, square));
    let slanted = |z: f64| DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(1.0, 0.0, z));
    assert!(tell(1.0, 1.0, 0.0, slanted(1e-5)) && !tell(1.0, 1.0, 0.0, slanted(1e-7)));
}

/// Law: what was asked of the same two in between makes no answer wrong.
#[test]
fn other_questions_in_between_leave_it_right() {
    let (mut told, mut parted) = (0, 0);
    for k in 0..4_000u32 {
        let cloud = |seed: u32| {
            let off = placement(seed + 9).translation * 3.0;
            Polytope::new((seed..seed + 6).map(|i| placement(i).translation + off).collect()).unwrap()
        };
        let (a, b) = (cloud(7 * k), cloud(11 * k + 3));
        let way = placement(k + 5).translation.normalize();
        let at = |object: &Polytope, x: f64| DAffine3::from_translation(way * x - object.center());
        let (at_a, at_b) = (at(&a, 0.0), at(&b, 0.05));
        let mut memory = Memory::default();
        if !memory.intersects(&a, &at_a, &b, &at_b) {
            continue;
        }
        let away = at(&b, 0.2 + 0.2 * f64::from(k % 8));
        if k % 2 == 0 {
            memory.closest_points(&a, &at_a, &b, &away);
        } else {
            memory.quickly_closest(&a, &at_a, &b, &away);
        }
        for x in [0.05, 0.3, 0.6, 1.0, 1.4] {
            let there = at(&b, x);
            let expected = intersects(&a, &at_a, &b, &there);
            let still = memory.still(&at_a, &there);
            assert!(still.is_none_or(|still| still == expected), "{k}, {x}: {still:?}");
            told += usize::from(still.is_some());
            parted += usize::from(!expected);
        }
    }
    assert!(told > 1_000 && parted > 1_000, "{told} told, {parted} apart");
}
