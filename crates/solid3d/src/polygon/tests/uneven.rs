//! Polygons turned in space, whose vertices rounding takes off their plane.

use glam::{DAffine3, DQuat, DVec3};
use rand::Rng;
use solid_oracle::generate::seeded;
use solid_oracle::mesh_distance;

use super::{assert_rate, cases};
use crate::polygon::{
    Counters, Intersection, Polygon, intersect_sorted, intersect_straightforward, intersect_triangulated,
};

/// Law 3, in general position: all algorithms agree, though no polygon is flat.
#[test]
fn algorithms_agree_on_rounded_polygons() {
    let seed = 50;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut flat) = (100_000, 0, 0);
    for case in 0..cases {
        // The large lattice; every fourth pair of cases() is coplanar, these are not.
        let pair = cases::pair(&mut rng, 5 * (4 * case + 1 + case % 3) + 4);
        let turn = DQuat::from_rotation_y(rng.random_range(0.1..6.0))
            * DQuat::from_rotation_x(rng.random_range(0.1..6.0));
        let [a, b] =
            pair.map(|p| p.transformed(&DAffine3::from_rotation_translation(turn, DVec3::ONE)).unwrap());
        flat += usize::from(a.is_flat()) + usize::from(b.is_flat());
        let counters = &mut Counters::default();
        let sorted = intersect_sorted(&a, &b, counters);
        assert_eq!(intersect_straightforward(&a, &b, counters), sorted, "case {case}");
        assert_eq!(intersect_triangulated(&a, &b), sorted, "case {case}");
        assert_eq!(a.intersects(&b), sorted, "case {case}");
        hits += usize::from(sorted);
    }
    println!("{flat} of {} polygons are flat", 2 * cases);
    assert_rate("rounded polygons", hits, cases);
}

/// Law 3, where it hurts: touching and coplanar polygons, unevened. What is wrong is wrong by no more than the deviation.
#[test]
fn unevenness_matters_only_near_touching() {
    let seed = 51;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut cases, mut hits, mut differ, mut apart) = (0, 0, 0, 0);
    for case in 0..20_000 {
        let pair = cases::pair(&mut rng, case);
        let noise = [1e-15, 1e-9, 1e-7][case % 3];
        let [a, b] = pair.map(|p| {
            let size = p.reach().max(1.0);
            let mut shake = |v: DVec3| {
                v + noise * size * DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..=1.0)))
            };
            let vertices: Vec<DVec3> = p.vertices().iter().map(|&v| shake(v)).collect();
            // What is so thin that its area is lost in the noise has no plane to speak of; shaken chains may cross themselves where they touched.
            Polygon::with_tolerance(vertices, 1e-5 * size).and_then(Polygon::simple)
        });
        let (Ok(a), Ok(b)) = (a, b) else { continue };
        let found = a.intersection(&b);
        assert_eq!(found != Intersection::Apart, a.intersects(&b), "case {case}: {found:?}");
        let limit = 2.0 * (a.plane().deviation + b.plane().deviation);
        let counters = &mut Counters::default();
        let exact = intersect_triangulated(&a, &b);
        let distance = if exact {
            0.0
        } else {
            mesh_distance(a.vertices(), &a.triangles(), b.vertices(), &b.triangles())
        };
        for answer in [intersect_sorted(&a, &b, counters), intersect_straightforward(&a, &b, counters)] {
            // Said to meet: the triangles are no farther apart than the deviations.
            assert!(!answer || distance <= limit, "case {case}: {distance:e} apart, {limit:e}");
            differ += usize::from(answer != exact);
            apart += usize::from(!answer && exact);
        }
        cases += 1;
        hits += usize::from(exact);
    }
    println!("{differ} answers differ from that of the triangles, {apart} of them say apart");
    assert_rate("shaken polygons", hits, cases);
}
