//! What deforms in glTF: a beam with a skin, which bends down onto a block, and a drumskin with morph targets, which
//! bulges up to a spike.

use glam::{DAffine3, DQuat, DVec3};

use super::gltf::{Curve, Gltf, Influence, Keys, Node};
use super::mesh::Mesh;

/// Joints of the beam, and how far apart they are.
const JOINTS: u8 = 4;
const JOINT_LENGTH: f64 = 0.4;

/// Cells of the drumskin.
const CELLS: u16 = 12;

pub fn text() -> String {
    let mut file = Gltf::default();
    beam(&mut file);
    drum(&mut file);
    file.text("bend and bulge")
}

fn beam(file: &mut Gltf) {
    let (grey, blue) = (file.material([0.5, 0.5, 0.5]), file.material([0.2, 0.4, 0.8]));
    let mut box_at = |name, size, translation| {
        let mesh = Some(file.mesh(&Mesh::cuboid(size, [0.0; 3]), grey));
        file.root(Node { name, translation, mesh, ..Node::default() });
    };
    box_at("wall", [0.2, 0.8, 0.6], [-0.12, 0.8, 0.0]);
    box_at("block", [0.3, 0.5, 0.5], [1.3, 0.25, 0.0]);

    // The joints, from the tip back to the wall: each holds the next.
    let mut joints: Vec<usize> = Vec::new();
    for i in (0..JOINTS).rev() {
        let translation = if i == 0 { [0.0, 0.8, 0.0] } else { [JOINT_LENGTH, 0.0, 0.0] };
        let node = Node {
            name: &format!("joint_{i}"),
            translation,
            children: joints.last().copied().into_iter().collect(),
            ..Node::default()
        };
        joints.push(if i == 0 { file.root(node) } else { file.node(node) });
    }
    joints.reverse();
    let at = |joint: u8| DVec3::new(JOINT_LENGTH * f64::from(joint), 0.0, 0.0);
    let bound: Vec<_> = joints.iter().zip(0..).map(|(&node, i)| (node, at(i))).collect();
    let skin = Some(file.skin(&bound));
    let (mesh, influences) = beam_mesh();
    let mesh = Some(file.skinned_mesh(&mesh, blue, &influences));
    file.root(Node { name: "beam", mesh, skin, ..Node::default() });

    for (joint, &node) in joints.iter().enumerate() {
        let curve = if joint % 2 == 0 { Curve::Linear } else { Curve::Eased };
        let bend = |angle: f64| DQuat::from_rotation_z(angle.to_radians()).to_array();
        let values = &[0.0, -5.5, -2.0, 0.0].map(bend);
        file.animate(node, "rotation", &Keys { curve, times: &[0.0, 1.5, 3.0, 4.0], values });
    }
}

/// A beam along x in 12 sections, of which each vertex follows the two joints that it is between.
fn beam_mesh() -> (Mesh, Vec<Influence>) {
    const SECTIONS: u16 = 12;
    let length = JOINT_LENGTH * f64::from(JOINTS);
    let (mut mesh, mut influences) = (Mesh::default(), Vec::new());
    for section in 0..=SECTIONS {
        let x = length * f64::from(section) / f64::from(SECTIONS);
        let along = (x / JOINT_LENGTH - 0.5).clamp(0.0, f64::from(JOINTS - 1));
        let joint = along.floor().min(f64::from(JOINTS - 2));
        let weight = along - joint;
        for (y, z) in [(-0.03, -0.08), (0.03, -0.08), (0.03, 0.08), (-0.03, 0.08)] {
            mesh.vertices.push(DVec3::new(x, y, z));
            influences.push(([joint as u8, joint as u8 + 1, 0, 0], [1.0 - weight, weight, 0.0, 0.0]));
        }
    }
    for section in 0..SECTIONS {
        for side in 0..4 {
            let [a, b] = [4 * section + side, 4 * section + (side + 1) % 4];
            mesh.triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
        }
    }
    let end = 4 * SECTIONS;
    mesh.triangles.extend([[0, 2, 1], [0, 3, 2], [end, end + 1, end + 2], [end, end + 2, end + 3]]);
    (mesh, influences)
}

fn drum(file: &mut Gltf) {
    let (red, dark) = (file.material([0.8, 0.25, 0.2]), file.material([0.25, 0.25, 0.3]));
    let skin = Mesh::grid(CELLS).placed(DAffine3::from_scale(DVec3::new(0.5, 1.0, 0.5)));
    let form = |height: fn(f64, f64) -> f64| {
        skin.vertices.iter().map(|v| DVec3::new(0.0, height(2.0 * v.x, 2.0 * v.z), 0.0)).collect()
    };
    let bulge: Vec<DVec3> = form(|u, v| 0.3 * (1.0 - u * u) * (1.0 - v * v));
    let ripple: Vec<DVec3> = form(|u, v| 0.2 * u * (1.0 - u * u) * (1.0 - v * v));
    let mesh = Some(file.morphing_mesh(&skin, red, &[bulge, ripple]));
    let drum = file.root(Node { name: "drumskin", translation: [0.6, 0.3, 1.2], mesh, ..Node::default() });
    // It bulges and sinks back, then ripples.
    let (times, values) = (
        &[0.0, 1.0, 2.0, 2.5, 3.0, 3.5, 4.0],
        &[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.0, 1.0], [0.0, 0.0]],
    );
    file.animate(drum, "weights", &Keys { curve: Curve::Eased, times, values });

    let spike = Mesh {
        vertices: vec![
            DVec3::ZERO,
            DVec3::new(0.08, 0.4, 0.08),
            DVec3::new(-0.08, 0.4, 0.08),
            DVec3::new(-0.08, 0.4, -0.08),
            DVec3::new(0.08, 0.4, -0.08),
        ],
        triangles: vec![[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4], [1, 2, 3], [1, 3, 4]],
    };
    let mesh = Some(file.mesh(&spike, dark));
    file.root(Node { name: "spike", translation: [0.6, 0.52, 1.2], mesh, ..Node::default() });
    let mut frame = Mesh::default();
    for side in [-0.54, 0.54] {
        frame = frame.and(Mesh::cuboid([1.12, 0.04, 0.04], [0.0, 0.0, side]));
        frame = frame.and(Mesh::cuboid([0.04, 0.04, 1.06], [side, 0.0, 0.0]));
    }
    let mesh = Some(file.mesh(&frame, dark));
    file.root(Node { name: "frame", translation: [0.6, 0.3, 1.2], mesh, ..Node::default() });
}
