//! A robot that gauges a part on a conveyor, and on its way back reaches into the fence.
//!
//! Lengths are in metres, y is up. The arm has six axes: turret, shoulder, elbow, and three of the wrist.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};

use super::gltf::{Curve, Gltf, Keys, Node};
use super::mesh::Mesh;

/// Shapes that touch collide, so what stands on something stands this much above it.
const GAP: f64 = 0.005;

const FLOOR: f64 = -0.4;

/// Poses of the arm: when, and the angles of turret, shoulder, elbow and wrist in degrees. The tool points down in all
/// but the one at 5 s, where it is still stretched out when it comes round to the fence.
const POSES: [(f64, [f64; 4]); 8] = [
    (0.0, [0.0, 20.0, -20.0, -90.0]),   // home
    (1.5, [0.0, -25.0, 4.2, -69.2]),    // above the part
    (2.2, [0.0, -35.8, -5.0, -49.2]),   // about the part
    (3.0, [0.0, -35.8, -5.0, -49.2]),   // still there
    (3.7, [0.0, -25.0, 4.2, -69.2]),    // above the part
    (5.0, [-90.0, -25.0, 4.2, 20.8]),   // into the fence
    (6.0, [-90.0, 20.0, -20.0, -90.0]), // drawn back
    (8.0, [0.0, 20.0, -20.0, -90.0]),   // home
];

pub fn text() -> String {
    let mut file = Gltf::default();
    let grey = file.material([0.45, 0.47, 0.5]);
    let yellow = file.material([0.9, 0.7, 0.1]);
    surroundings(&mut file, grey, yellow);
    part(&mut file);
    arm(&mut file);
    file.text("gauge")
}

fn surroundings(file: &mut Gltf, grey: usize, yellow: usize) {
    let height = -GAP - FLOOR;
    let table = Mesh::cuboid([0.6, height, 0.6], [0.0, FLOOR + 0.5 * height, 0.0]);
    let mesh = Some(file.mesh(&table, grey));
    file.root(Node { name: "table", mesh, ..Node::default() });

    let mut conveyor = Mesh::cuboid([0.4, 0.1, 1.7], [0.75, 0.05, 0.0]);
    for (x, z) in [(0.58, -0.8), (0.92, -0.8), (0.58, 0.8), (0.92, 0.8)] {
        conveyor = conveyor.and(Mesh::cuboid([0.05, -FLOOR, 0.05], [x, 0.5 * FLOOR, z]));
    }
    let mesh = Some(file.mesh(&conveyor, grey));
    file.root(Node { name: "conveyor", mesh, ..Node::default() });

    let mesh = Some(file.mesh(&fence(), yellow));
    file.root(Node { name: "fence_side", translation: [0.0, FLOOR, 1.0], mesh, ..Node::default() });
    let rotation = Some(DQuat::from_rotation_y(FRAC_PI_2).to_array());
    let translation = [-1.15, FLOOR, -0.2];
    file.root(Node { name: "fence_back", translation, rotation, mesh, ..Node::default() });
}

/// Bars between two rails and two posts, in the plane z = 0, standing on y = 0.
fn fence() -> Mesh {
    let mut fence = Mesh::default();
    for x in [-1.1, 1.1] {
        fence = fence.and(Mesh::cuboid([0.05, 1.8, 0.05], [x, 0.9, 0.0]));
    }
    for y in [0.1, 1.7] {
        fence = fence.and(Mesh::cuboid([2.2, 0.04, 0.03], [0.0, y, 0.0]));
    }
    for bar in -10..=10 {
        fence = fence.and(Mesh::cuboid([0.02, 1.6, 0.02], [0.1 * f64::from(bar), 0.9, 0.0]));
    }
    fence
}

/// It comes along the conveyor, waits to be gauged, and goes on.
fn part(file: &mut Gltf) {
    let red = file.material([0.8, 0.2, 0.15]);
    let mesh = Some(file.mesh(&Mesh::cuboid([0.1, 0.08, 0.14], [0.0; 3]), red));
    let at = |z| [0.75, 0.1 + GAP + 0.04, z];
    let part = file.root(Node { name: "part", translation: at(-0.7), mesh, ..Node::default() });
    let (times, values) = (&[0.0, 2.0, 3.2, 6.0, 8.0], &[-0.7, 0.0, 0.0, 0.7, 0.7].map(at));
    file.animate(part, "translation", &Keys { curve: Curve::Eased, times, values });
}

/// From the tool back to the base, since a node names its children.
fn arm(file: &mut Gltf) {
    let orange = file.material([0.95, 0.45, 0.1]);
    let dark = file.material([0.2, 0.2, 0.22]);

    let open = [[0.0, -0.09, 0.0], [0.0, 0.09, 0.0]];
    let mesh = Some(file.mesh(&Mesh::cuboid([0.12, 0.02, 0.03], [0.11, 0.0, 0.0]), dark));
    let fingers = [("finger_left", open[0]), ("finger_right", open[1])];
    let fingers =
        fingers.map(|(name, translation)| file.node(Node { name, translation, mesh, ..Node::default() }));
    let gripper = Mesh::cuboid([0.05, 0.22, 0.06], [0.025, 0.0, 0.0]);
    let gripper = link(file, "gripper", [0.03, 0.0, 0.0], &gripper, dark, &fingers);
    let flange = along_x(Mesh::cylinder(0.04, 0.03, [0.0; 3]));
    let flange = link(file, "flange", [0.08, 0.0, 0.0], &flange, dark, &[gripper]);
    let wrist = Mesh::cuboid([0.1, 0.07, 0.07], [0.03, 0.0, 0.0]);
    let wrist = link(file, "wrist", [0.35, 0.0, 0.0], &wrist, orange, &[flange]);
    let roll = along_x(Mesh::cylinder(0.05, 0.32, [0.0; 3]));
    let roll = link(file, "forearm_roll", [0.15, 0.0, 0.0], &roll, orange, &[wrist]);
    let forearm = Mesh::cuboid([0.2, 0.14, 0.12], [0.05, 0.0, 0.0]);
    let forearm = link(file, "forearm", [0.0, 0.55, 0.0], &forearm, orange, &[roll]);
    let upper_arm = Mesh::cuboid([0.12, 0.6, 0.1], [0.0, 0.275, 0.0]);
    let upper_arm = link(file, "upper_arm", [0.05, 0.2, 0.0], &upper_arm, orange, &[forearm]);
    let turret = Mesh::cylinder(0.15, 0.1, [0.0; 3])
        .and(Mesh::cuboid([0.16, 0.18, 0.04], [0.05, 0.18, 0.08]))
        .and(Mesh::cuboid([0.16, 0.18, 0.04], [0.05, 0.18, -0.08]));
    let turret = link(file, "turret", [0.0, 0.12, 0.0], &turret, orange, &[upper_arm]);
    let mesh = Some(file.mesh(&Mesh::cylinder(0.18, 0.12, [0.0; 3]), dark));
    file.root(Node { name: "base", mesh, children: vec![turret], ..Node::default() });

    for (axis, node) in [turret, upper_arm, forearm, wrist].into_iter().enumerate() {
        let about = if axis == 0 { DVec3::Y } else { DVec3::Z };
        let curve = if axis == 3 { Curve::Linear } else { Curve::Eased };
        let rotation = |angle: f64| DQuat::from_axis_angle(about, angle.to_radians()).to_array();
        let values = POSES.map(|(_, angles)| rotation(angles[axis]));
        file.animate(node, "rotation", &Keys { curve, times: &POSES.map(|(time, _)| time), values: &values });
    }
    for (node, turn) in [(roll, 0.0), (flange, 90.0f64)] {
        let times = &[0.0, 3.7, 5.0, 6.0, 8.0];
        let turns = [0.0, 0.0, turn, turn, 0.0];
        let values = &turns.map(|angle| DQuat::from_rotation_x(angle.to_radians()).to_array());
        file.animate(node, "rotation", &Keys { curve: Curve::Linear, times, values });
    }
    for (finger, [x, y, z]) in fingers.into_iter().zip(open) {
        let closed = y.signum() * (0.05 + GAP + 0.01);
        let values = &[y, y, closed, closed, y, y].map(|y| [x, y, z]);
        let times = &[0.0, 2.2, 2.5, 2.7, 3.0, 8.0];
        file.animate(finger, "translation", &Keys { curve: Curve::Linear, times, values });
    }
}

fn link(
    file: &mut Gltf,
    name: &str,
    translation: [f64; 3],
    mesh: &Mesh,
    material: usize,
    children: &[usize],
) -> usize {
    let mesh = Some(file.mesh(mesh, material));
    file.node(Node { name, translation, mesh, children: children.to_vec(), ..Node::default() })
}

/// What stands along y, laid along x.
fn along_x(mesh: Mesh) -> Mesh {
    mesh.placed(DAffine3::from_rotation_z(-FRAC_PI_2))
}
