//! Writing glTF 2.0 as one text, its numbers in a buffer within it.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::DVec3;

use super::decimal::{self, round};
use super::mesh::Mesh;

/// Decimals of a length in metres and of a quaternion's components.
const DECIMALS: i32 = 5;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_BYTE: u32 = 5121;

/// A file that grows. What is added is named by its number.
#[derive(Default)]
pub struct Gltf {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    materials: Vec<String>,
    meshes: Vec<String>,
    skins: Vec<String>,
    nodes: Vec<String>,
    roots: Vec<usize>,
    samplers: Vec<String>,
    channels: Vec<String>,
}

/// The joints of a skin that a vertex follows, and how much each.
pub type Influence = ([u8; 4], [f64; 4]);

/// A node; what is left out is not written.
#[derive(Default)]
pub struct Node<'a> {
    pub name: &'a str,
    pub translation: [f64; 3],
    pub rotation: Option<[f64; 4]>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub children: Vec<usize>,
}

/// What is between keys.
#[derive(Clone, Copy)]
pub enum Curve {
    Linear,
    /// A cubic spline that comes to rest at each key.
    Eased,
}

/// A value of an animation over time, of so many numbers a key.
pub struct Keys<'a, const N: usize> {
    pub curve: Curve,
    pub times: &'a [f64],
    pub values: &'a [[f64; N]],
}

impl Gltf {
    pub fn material(&mut self, [r, g, b]: [f64; 3]) -> usize {
        let color = decimal::list([r, g, b, 1.0], 3, ", ");
        let text = format!(
            r#"{{ "pbrMetallicRoughness": {{ "baseColorFactor": [{color}], "metallicFactor": 0 }}, "doubleSided": true }}"#
        );
        push(&mut self.materials, text)
    }

    pub fn mesh(&mut self, mesh: &Mesh, material: usize) -> usize {
        let primitive = self.primitive(mesh, material, "", "");
        push(&mut self.meshes, format!(r#"{{ "primitives": [{primitive}] }}"#))
    }

    /// A mesh with morph targets: displacements of the vertices.
    pub fn morphing_mesh(&mut self, mesh: &Mesh, material: usize, targets: &[Vec<DVec3>]) -> usize {
        let positions = targets.iter().map(|target| {
            let accessor = self.vectors(target);
            format!(r#"{{ "POSITION": {accessor} }}"#)
        });
        let positions = positions.collect::<Vec<_>>().join(", ");
        let primitive = self.primitive(mesh, material, "", &format!(r#", "targets": [{positions}]"#));
        let weights = vec!["0"; targets.len()].join(", ");
        let text = format!(r#"{{ "primitives": [{primitive}], "weights": [{weights}] }}"#);
        push(&mut self.meshes, text)
    }

    /// A mesh whose vertices follow joints of a skin, each up to four.
    pub fn skinned_mesh(&mut self, mesh: &Mesh, material: usize, influences: &[Influence]) -> usize {
        let joints = influences.iter().flat_map(|(joints, _)| *joints).collect();
        let joints = self.accessor(joints, UNSIGNED_BYTE, "VEC4", influences.len(), "");
        let weights: Vec<[f64; 4]> = influences.iter().map(|(_, weights)| *weights).collect();
        let weights = self.floats(&weights, "VEC4", "");
        let attributes = format!(r#", "JOINTS_0": {joints}, "WEIGHTS_0": {weights}"#);
        let primitive = self.primitive(mesh, material, &attributes, "");
        push(&mut self.meshes, format!(r#"{{ "primitives": [{primitive}] }}"#))
    }

    /// A skin whose joints were at these points, unrotated, when the mesh was bound to them.
    pub fn skin(&mut self, joints: &[(usize, DVec3)]) -> usize {
        let inverse = |at: &DVec3| {
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -at.x, -at.y, -at.z, 1.0]
        };
        let matrices: Vec<[f64; 16]> = joints.iter().map(|(_, at)| inverse(at)).collect();
        let matrices = self.floats(&matrices, "MAT4", "");
        let nodes: Vec<usize> = joints.iter().map(|(node, _)| *node).collect();
        push(&mut self.skins, format!(r#"{{ "joints": {nodes:?}, "inverseBindMatrices": {matrices} }}"#))
    }

    pub fn node(&mut self, node: Node) -> usize {
        let mut text = format!(r#"{{ "name": "{}""#, node.name);
        if node.translation != [0.0; 3] {
            text += &format!(r#", "translation": [{}]"#, decimal::list(node.translation, DECIMALS, ", "));
        }
        if let Some(rotation) = node.rotation {
            text += &format!(r#", "rotation": [{}]"#, decimal::list(rotation, DECIMALS, ", "));
        }
        for (key, value) in [("mesh", node.mesh), ("skin", node.skin)] {
            text += &value.map_or(String::new(), |value| format!(r#", "{key}": {value}"#));
        }
        if !node.children.is_empty() {
            text += &format!(r#", "children": {:?}"#, node.children);
        }
        push(&mut self.nodes, text + " }")
    }

    /// A node at the top of the scene.
    pub fn root(&mut self, node: Node) -> usize {
        let node = self.node(node);
        self.roots.push(node);
        node
    }

    /// Animates a node's `translation`, `rotation` or `weights`.
    pub fn animate<const N: usize>(&mut self, node: usize, path: &str, keys: &Keys<N>) {
        let (first, last) = (keys.times[0], keys.times[keys.times.len() - 1]);
        let times: Vec<[f64; 1]> = keys.times.iter().map(|&time| [time]).collect();
        let input = self.floats(&times, "SCALAR", &bounds([first], [last]));
        let (interpolation, values): (_, Vec<[f64; N]>) = match keys.curve {
            Curve::Linear => ("LINEAR", keys.values.to_vec()),
            Curve::Eased => {
                let values = keys.values.iter().flat_map(|&value| [[0.0; N], value, [0.0; N]]);
                ("CUBICSPLINE", values.collect())
            }
        };
        let output = match path {
            "translation" => self.floats(&values, "VEC3", ""),
            "rotation" => self.floats(&values, "VEC4", ""),
            _ => {
                let weights: Vec<[f64; 1]> = values.iter().flatten().map(|&weight| [weight]).collect();
                self.floats(&weights, "SCALAR", "")
            }
        };
        let sampler = push(
            &mut self.samplers,
            format!(r#"{{ "input": {input}, "interpolation": "{interpolation}", "output": {output} }}"#),
        );
        let target = format!(r#"{{ "node": {node}, "path": "{path}" }}"#);
        self.channels.push(format!(r#"{{ "sampler": {sampler}, "target": {target} }}"#));
    }

    /// The file.
    pub fn text(&self, animation: &str) -> String {
        let mut parts = vec![
            r#"  "asset": { "version": "2.0", "generator": "make_scenes, of solid-scene" }"#.to_owned(),
            r#"  "scene": 0"#.to_owned(),
            format!(r#"  "scenes": [{{ "nodes": {:?} }}]"#, self.roots),
        ];
        let mut part = |name: &str, lines: &[String]| {
            if !lines.is_empty() {
                parts.push(format!("  \"{name}\": [\n    {}\n  ]", lines.join(",\n    ")));
            }
        };
        part("nodes", &self.nodes);
        part("meshes", &self.meshes);
        part("skins", &self.skins);
        part("materials", &self.materials);
        let inner = |lines: &[String]| lines.join(",\n        ");
        let (channels, samplers) = (inner(&self.channels), inner(&self.samplers));
        part(
            "animations",
            &[format!(
                "{{\n      \"name\": \"{animation}\",\n      \"channels\": [\n        {channels}\n      ],\n      \
                 \"samplers\": [\n        {samplers}\n      ]\n    }}"
            )],
        );
        part("accessors", &self.accessors);
        part("bufferViews", &self.views);
        let data = BASE64_STANDARD.encode(&self.bytes);
        let uri = format!("data:application/octet-stream;base64,{data}");
        part("buffers", &[format!(r#"{{ "byteLength": {}, "uri": "{uri}" }}"#, self.bytes.len())]);
        format!("{{\n{}\n}}\n", parts.join(",\n"))
    }

    fn primitive(&mut self, mesh: &Mesh, material: usize, attributes: &str, rest: &str) -> String {
        let positions = self.vectors(&mesh.vertices);
        let indices = mesh.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        let indices = self.accessor(indices, UNSIGNED_SHORT, "SCALAR", 3 * mesh.triangles.len(), "");
        format!(
            r#"{{ "attributes": {{ "POSITION": {positions}{attributes} }}, "indices": {indices}, "material": {material}{rest} }}"#
        )
    }

    fn vectors(&mut self, vectors: &[DVec3]) -> usize {
        let rounded: Vec<DVec3> =
            vectors.iter().map(|v| DVec3::from(v.to_array().map(|x| round(x, DECIMALS)))).collect();
        let least = rounded.iter().fold(DVec3::INFINITY, |least, v| least.min(*v));
        let largest = rounded.iter().fold(DVec3::NEG_INFINITY, |largest, v| largest.max(*v));
        let arrays: Vec<[f64; 3]> = rounded.iter().map(DVec3::to_array).collect();
        self.floats(&arrays, "VEC3", &bounds(least.to_array(), largest.to_array()))
    }

    fn floats<const N: usize>(&mut self, values: &[[f64; N]], kind: &str, rest: &str) -> usize {
        let bytes =
            values.iter().flatten().flat_map(|&x| (round(x, DECIMALS) as f32).to_le_bytes()).collect();
        self.accessor(bytes, FLOAT, kind, values.len(), rest)
    }

    fn accessor(&mut self, bytes: Vec<u8>, component: u32, kind: &str, count: usize, rest: &str) -> usize {
        let offset = self.bytes.len();
        let view = push(
            &mut self.views,
            format!(r#"{{ "buffer": 0, "byteOffset": {offset}, "byteLength": {} }}"#, bytes.len()),
        );
        self.bytes.extend(bytes);
        // Every accessor begins at a multiple of the largest component.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let text = format!(
            r#"{{ "bufferView": {view}, "componentType": {component}, "type": "{kind}", "count": {count}{rest} }}"#
        );
        push(&mut self.accessors, text)
    }
}

fn bounds<const N: usize>(least: [f64; N], largest: [f64; N]) -> String {
    let list = |numbers| decimal::list(numbers, DECIMALS, ", ");
    format!(r#", "min": [{}], "max": [{}]"#, list(least), list(largest))
}

fn push(list: &mut Vec<String>, text: String) -> usize {
    list.push(text);
    list.len() - 1
}
