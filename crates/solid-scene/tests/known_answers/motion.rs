//! Recorded motions of two bodies. The matrices have six digits and are taken as they are, not orthogonalised.

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use solid3d::{BroadPhaseKind, World, WorldOptions, query};

use crate::data::{Row, folder, for_each_row, json, mesh};
use crate::tally::Tally;

/// The recorded distance is parry's; this is what the tools differ by in general.
const TOOL_ERROR: f64 = 1e-9;

#[test]
fn gear_lowres() {
    check("fcl_gear_lowres_51");
}

#[test]
fn manyframes_model_1() {
    check("fcl_manyframes_model1_501");
}

#[test]
fn model_1_scenario_1() {
    check("fcl_model1_scenario1");
}

#[test]
fn model_1_scenario_2() {
    check("fcl_model1_scenario2");
}

fn check(name: &str) {
    let Some(folder) = folder("motion") else { return };
    let facts = json(&folder.join(format!("{name}.json")));
    let spread = facts["max_tool_spread"].as_f64().unwrap();
    check_motion(&folder, name, TOOL_ERROR + spread);
}

fn check_motion(folder: &Path, name: &str, limit: f64) {
    let shape = |body: &str| mesh(&folder.join(format!("{name}_{body}.obj")));
    let (a, b) = (shape("A"), shape("B"));
    let mut worlds = [BroadPhaseKind::DynamicTree, BroadPhaseKind::SweepAndPrune].map(|broad_phase| {
        let mut world = World::with_options(&WorldOptions { broad_phase, ..WorldOptions::default() });
        let ids = [&a, &b].map(|shape| world.add(shape, DAffine3::IDENTITY).unwrap());
        (world, ids)
    });
    let mut tally = Tally::new(name);
    for_each_row(&folder.join(format!("{name}.csv")), |row| {
        let (label, collide) = (format!("frame {}", row.text("frame")), row.flag("collide"));
        let (at_a, at_b) = (placement(&row, "A"), placement(&row, "B"));
        if !row.flag("all_tools_agree") {
            println!("{name}: {label} is ambiguous");
            return;
        }
        tally.hit(&label, collide, query::intersects(&a, &at_a, &b, &at_b).unwrap());
        let distance = query::distance(&a, &at_a, &b, &at_b).unwrap().distance;
        tally.error(&label, (distance - row.real("distance")).abs(), limit);
        for (world, [a, b]) in &mut worlds {
            world.set_placement(*a, at_a).unwrap();
            world.set_placement(*b, at_b).unwrap();
            let found = world.test().len();
            world.proceed();
            tally.check(found == usize::from(collide), || format!("{label}: {found} collisions in a world"));
        }
    });
    tally.finish();
}

fn placement(row: &Row, body: &str) -> DAffine3 {
    let line = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|j| row.real(&format!("{body}_r{i}{j}")));
        DVec3::new(x, y, z)
    };
    let rows = DMat3::from_cols(line(0), line(1), line(2));
    DAffine3 { matrix3: rows.transpose(), translation: row.vector(&format!("{body}_t"), "") }
}
