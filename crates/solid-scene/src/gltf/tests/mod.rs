//! Whole files, small ones: what they mean, and that nothing in them does harm.

mod animations;
mod binary;
mod hostile;
mod instances;
mod refused;

use std::f64::consts::FRAC_1_SQRT_2;
use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::{DAffine3, DMat3, DVec3};
use serde_json::{Value, json};
use solid3d::ShapeKind;

use super::graph::{DEPTH_MAX, PATHS_MAX};
use super::parse;
use super::text::NODES_MAX;
use crate::part::Part;
use crate::pose::ObjectPose;

const BYTE: u32 = 5120;
const UNSIGNED_BYTE: u32 = 5121;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
const FLOAT: u32 = 5126;

/// A file under construction: accessors are added, each with a buffer of its own.
struct File(Value);

impl File {
    fn new() -> File {
        File(json!({
            "asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "buffers": [], "nodes": [], "meshes": [],
        }))
    }

    fn add(&mut self, array: &str, value: Value) -> usize {
        let array = self.0[array].as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let uri = format!("data:;base64,{}", BASE64_STANDARD.encode(bytes));
        let buffer = self.add("buffers", json!({"byteLength": bytes.len(), "uri": uri}));
        self.add("bufferViews", json!({"buffer": buffer, "byteLength": bytes.len()}))
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "type": kind, "componentType": component, "count": count});
        self.add("accessors", accessor)
    }

    fn floats(&mut self, kind: &str, count: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(kind, FLOAT, count, &bytes)
    }

    /// A mesh of one triangle, at the origin and on the axes x and y.
    fn triangle(&mut self) -> usize {
        let positions = self.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        self.add("meshes", json!({"name": "tri", "primitives": [{"attributes": {"POSITION": positions}}]}))
    }

    fn parse(&self) -> Result<Part, String> {
        self.parse_animation(None)
    }

    fn parse_animation(&self, animation: Option<&str>) -> Result<Part, String> {
        parse(self.0.to_string().as_bytes(), Path::new("no such folder"), animation)
            .map_err(|fault| fault.message().to_owned())
    }

    fn refused(&self) -> String {
        self.parse().map(|_| ()).unwrap_err()
    }

    /// With another value at a path it is refused with a message.
    #[track_caller]
    fn is_refused_with(&self, path: &str, value: Value, message: &str) {
        let mut file = File(self.0.clone());
        set(&mut file, path, value);
        let refused = file.refused();
        assert!(refused.contains(message), "{path}: {refused}");
    }
}

/// Sets a value at a path, which may be new in an object.
fn set(file: &mut File, path: &str, value: Value) {
    let (parent, key) = path.rsplit_once('/').unwrap();
    match file.0.pointer_mut(parent).unwrap() {
        Value::Array(array) => array[key.parse::<usize>().unwrap()] = value,
        object => object[key] = value,
    }
}

fn pose(part: &Part, time: f64) -> Vec<ObjectPose> {
    let mut poses =
        vec![ObjectPose { placement: DAffine3::IDENTITY, positions: vec![DVec3::NAN] }; part.objects.len()];
    part.motion.sample(time, &mut poses);
    poses
}

/// A file with one of everything: a skinned strip with a morph target on a moving node, below another with the same
/// triangle; sparse and quantized numbers; two animations.
fn everything() -> File {
    let mut file = File::new();
    let sparse = file.view(&[2]);
    let moved = file.view(&[1.0f32, 1.0, 0.0].map(f32::to_le_bytes).concat());
    let base = file.floats("VEC3", 4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 9.0, 9.0, 1.0, 1.0, 0.0]);
    file.0["accessors"][base]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": sparse, "componentType": UNSIGNED_BYTE}, "values": {"bufferView": moved},
    });
    let target = file.floats("VEC3", 4, &[0.0, 0.0, 1.0].repeat(4));
    let joints = file.accessor("VEC4", UNSIGNED_BYTE, 4, &[0, 1, 0, 0].repeat(4));
    let weights = file.accessor("VEC4", UNSIGNED_BYTE, 4, &[255, 0, 0, 0, 127, 128, 0, 0].repeat(2));
    file.0["accessors"][weights]["normalized"] = json!(true);
    let indices = file.accessor("SCALAR", UNSIGNED_SHORT, 4, &[0, 0, 1, 0, 2, 0, 3, 0]);
    let attributes = json!({"POSITION": base, "JOINTS_0": joints, "WEIGHTS_0": weights});
    let skinned = file.add(
        "meshes",
        json!({"weights": [0.5], "primitives": [
            {"attributes": attributes, "indices": indices, "mode": 5, "targets": [{"POSITION": target}]},
        ]}),
    );
    let triangle = file.triangle();
    let binds = file.floats("MAT4", 2, &glam::Mat4::IDENTITY.to_cols_array().repeat(2));
    file.0["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": binds}]);
    file.0["nodes"] = json!([
        {"name": "root", "mesh": triangle, "children": [1, 3], "translation": [1, 2, 3]},
        {"children": [2], "rotation": [0, 0, 0, 1]},
        {"matrix": glam::Mat4::IDENTITY.to_cols_array()},
        {"mesh": skinned, "skin": 0, "scale": [2, 2, 2]},
    ]);
    file.0["scenes"] = json!([{"nodes": [0]}]);
    file.0["scene"] = json!(0);
    let times = file.floats("SCALAR", 2, &[1.0, 3.0]);
    let turns = file.floats("VEC4", 2, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let path = file.floats("VEC3", 6, &[0.0; 18]);
    let grows = file.floats("SCALAR", 2, &[0.0, 1.0]);
    file.0["animations"] = json!([
        {"name": "all", "samplers": [
            {"input": times, "output": turns},
            {"input": times, "output": path, "interpolation": "CUBICSPLINE"},
            {"input": times, "output": grows, "interpolation": "STEP"},
        ], "channels": [
            {"sampler": 0, "target": {"node": 1, "path": "rotation"}},
            {"sampler": 1, "target": {"node": 0, "path": "translation"}},
            {"sampler": 2, "target": {"node": 3, "path": "weights"}},
        ]},
        {"samplers": [], "channels": []},
    ]);
    file
}
/// A file with a node that moves to the right in a second and has three instances of a triangle, and a child.
fn instances() -> File {
    let mut file = File::new();
    let mesh = file.triangle();
    let half = FRAC_1_SQRT_2 as f32;
    let translations = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 7.0]);
    let rotations = file.floats("VEC4", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half, 0.0, 0.0, 0.0, 2.0]);
    let scales = file.floats("VEC3", 3, &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 1.0, 1.0]);
    let ids = file.accessor("SCALAR", UNSIGNED_BYTE, 3, &[7, 8, 9]);
    let attributes = json!({"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales, "_ID": ids});
    let extensions = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    file.0["nodes"] = json!([
        {"mesh": mesh, "name": "tree", "extensions": extensions, "children": [1]},
        {"mesh": mesh, "name": "bird"},
    ]);
    let times = file.floats("SCALAR", 2, &[0.0, 1.0]);
    let path = file.floats("VEC3", 2, &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0]);
    file.0["animations"] = json!([{
        "samplers": [{"input": times, "output": path}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
    }]);
    file.0["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    file
}

/// The file as a `.glb`, its first buffer in the binary part.
fn binary(file: &File) -> Vec<u8> {
    let mut file = file.0.clone();
    let uri = file["buffers"][0]["uri"].take();
    file["buffers"][0].as_object_mut().unwrap().remove("uri");
    let binary = BASE64_STANDARD.decode(uri.as_str().unwrap().rsplit(',').next().unwrap()).unwrap();
    let mut chunks = Vec::new();
    for (kind, mut bytes) in [(b"JSON", file.to_string().into_bytes()), (b"BIN\0", binary)] {
        bytes.resize(bytes.len().next_multiple_of(4), b' ');
        chunks.extend((bytes.len() as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(bytes);
    }
    [&b"glTF\x02\0\0\0"[..], &(chunks.len() as u32 + 12).to_le_bytes(), &chunks].concat()
}

#[test]
fn everything_is_sampled() {
    let part = everything().parse().unwrap();
    assert_eq!(part.warnings, ["plays the animation `all`, not 1"]);
    assert_eq!((part.duration, part.unit), (3.0, "metre"));
    let names: Vec<_> = part.objects.iter().map(|o| (&o.name[..], o.path.clone())).collect();
    assert_eq!(names, [("root", vec![0]), ("node3", vec![0, 3])]);
    let poses = pose(&part, 0.0);
    assert_eq!(part.objects[1].shape.vertices().unwrap(), poses[1].positions);
    // The sparse vertex is where the sparse values have it; the root's path is all at the origin.
    assert_eq!(
        poses[1].positions,
        [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)]
    );
    assert_eq!((poses[0].placement, poses[1].placement), (DAffine3::IDENTITY, DAffine3::IDENTITY));
    assert!(poses[0].positions.is_empty());
    // Both joints have turned by a quarter at 2, by a half at 3, when the target counts in full.
    let quarter = pose(&part, 2.0)[1].positions[1];
    assert!(quarter.abs_diff_eq(DVec3::Y, 1e-12), "{quarter}");
    for time in [3.0, 1e9] {
        let half = pose(&part, time)[1].positions[1];
        assert!(half.abs_diff_eq(DVec3::new(-1.0, 0.0, 1.0), 1e-7), "{half}");
    }
}

#[test]
fn without_an_animation_the_form_stays() {
    let part = everything().parse_animation(Some("1")).unwrap();
    assert_eq!(part.duration, 0.0);
    let poses = pose(&part, 0.0);
    assert!(poses[1].positions.is_empty());
    // The mesh's own weight, and the joints on the root, which is at 1 2 3.
    assert_eq!(part.objects[1].shape.vertices().unwrap()[0], DVec3::new(1.0, 2.0, 3.5));
    assert_eq!(poses[0].placement.translation, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn names_come_from_the_node_then_the_mesh() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.0["nodes"] = json!([{"mesh": mesh, "name": "a"}, {"mesh": mesh}, {"mesh": mesh, "name": ""}]);
    let part = file.parse().unwrap();
    assert_eq!(part.objects.iter().map(|o| &o.name[..]).collect::<Vec<_>>(), ["a", "tri", "tri"]);
    file.0["meshes"][mesh]["name"] = Value::Null;
    assert_eq!(file.parse().unwrap().objects[1].name, "node1");
}

#[test]
fn nodes_scale_then_rotate_then_translate() {
    let mut file = File::new();
    let mesh = file.triangle();
    let half = FRAC_1_SQRT_2;
    file.0["nodes"] = json!([
        {"children": [1], "translation": [0, 0, 1]},
        {"mesh": mesh, "translation": [1, 0, 0], "rotation": [0, 0, half, half], "scale": [2, 3, 0]},
    ]);
    let part = file.parse().unwrap();
    assert_eq!(part.warnings, [""; 0]);
    let placement = pose(&part, 0.0)[0].placement;
    let x = DMat3::from_cols(DVec3::new(0.0, 2.0, 0.0), DVec3::new(-3.0, 0.0, 0.0), DVec3::ZERO);
    let expected = DAffine3::from_mat3_translation(x, DVec3::new(1.0, 0.0, 1.0));
    assert!(placement.abs_diff_eq(expected, 1e-7), "{placement}");
}

#[test]
fn quantized_positions_are_read() {
    let mut file = File::new();
    let mesh = file.triangle();
    let bytes = [127u8, 0, 128, 9, 0, 127, 0, 9, 0, 0, 127, 9];
    let positions = file.accessor("VEC3", BYTE, 3, &bytes);
    let view = file.0["accessors"][positions]["bufferView"].as_u64().unwrap() as usize;
    file.0["bufferViews"][view]["byteStride"] = json!(4);
    file.0["accessors"][positions]["normalized"] = json!(true);
    file.0["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
    file.0["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    file.add("nodes", json!({"mesh": mesh}));
    let part = file.parse().unwrap();
    assert_eq!(part.objects[0].shape.vertices().unwrap(), [DVec3::new(1.0, 0.0, -1.0), DVec3::Y, DVec3::Z]);
}

/// The greatest of a type is 1, and what is below less that is no less than -1 (glTF 2.0, section 3.6.2.2).
#[test]
fn normalized_integers_of_any_width_are_fractions() {
    let signed = [0x7fff, 0, 0x8000, 0, 0x7fff, 0, 0, 0, 0x8001];
    let unsigned = [0xffff, 0, 0, 0, 0xffff, 0, 0, 0, 0x3333];
    for (component, numbers, expected) in [
        (SHORT, signed, [DVec3::new(1.0, 0.0, -1.0), DVec3::Y, -DVec3::Z]),
        (UNSIGNED_SHORT, unsigned, [DVec3::X, DVec3::Y, 0.2 * DVec3::Z]),
    ] {
        let mut file = File::new();
        let mesh = file.triangle();
        let bytes: Vec<u8> = numbers.iter().flat_map(|number: &u16| number.to_le_bytes()).collect();
        let positions = file.accessor("VEC3", component, 3, &bytes);
        file.0["accessors"][positions]["normalized"] = json!(true);
        file.0["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
        file.add("nodes", json!({"mesh": mesh}));
        assert_eq!(file.parse().unwrap().objects[0].shape.vertices().unwrap(), expected);
    }
    // Numbers of joints and vertices are none.
    let message = "indices: accessor 4 has no unsigned integers";
    everything().is_refused_with("/accessors/4/normalized", json!(true), message);
}

#[test]
fn primitives_of_a_mesh_are_one_shape_and_share_vertices() {
    let mut file = File::new();
    let mesh = file.triangle();
    let position = file.0["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].clone();
    let other = file.floats("VEC3", 2, &[5.0, 0.0, 0.0, 6.0, 0.0, 0.0]);
    let primitives = file.0["meshes"][mesh]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"POSITION": other}, "mode": 1}));
    primitives.push(json!({"attributes": {"POSITION": position}, "mode": 0}));
    primitives.push(json!({"attributes": {}}));
    file.add("nodes", json!({"mesh": mesh}));
    let part = file.parse().unwrap();
    let shape = &part.objects[0].shape;
    assert_eq!((shape.kind(), shape.primitive_count()), (ShapeKind::Complex, 5));
    assert_eq!(shape.vertices().unwrap().len(), 5);
}

#[test]
fn a_scene_is_chosen() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.0["nodes"] = json!([{"mesh": mesh, "name": "a", "children": [2]}, {"mesh": mesh, "name": "b"},
        {"mesh": mesh, "name": "c"}]);
    let names =
        |file: &File| file.parse().unwrap().objects.iter().map(|o| o.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&file), ["a", "c", "b"]);
    file.0["scenes"] = json!([{"nodes": [1, 1]}, {"nodes": [2]}]);
    assert_eq!(names(&file), ["b"]);
    file.0["scene"] = json!(1);
    assert_eq!(names(&file), ["c"]);
    assert_eq!(file.parse().unwrap().objects[0].path, [0, 2]);
    file.0["scene"] = json!(2);
    assert_eq!(file.refused(), "scene 2 is named, but there are 2");
}

#[test]
fn a_text_that_is_no_object_is_refused() {
    let refused = |text: &str| {
        parse(text.as_bytes(), Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned()
    };
    let texts = [
        ("[]", "an array"),
        ("\n [{\"asset\": {\"version\": \"2.0\"}}]", "an array"),
        ("null", "null"),
        ("-1.5", "a number"),
        ("7", "a number"),
        ("true", "a truth value"),
        ("false", "a truth value"),
        ("\"glTF\"", "a string"),
    ];
    for (text, found) in texts {
        let message = format!("not glTF 2.0: expected a JSON object, but the text is {found}");
        assert_eq!(refused(text), message, "{text}");
    }
    // What is no JSON at all is told by its line.
    for (text, message) in [
        ("[1,\n2", "not glTF 2.0: EOF while parsing a list at line 2 column 1"),
        ("nothing", "not glTF 2.0: expected ident at line 1 column 2"),
        ("", "not glTF 2.0: EOF while parsing a value at line 1 column 0"),
    ] {
        assert_eq!(refused(text), message, "{text}");
    }
}

#[test]
fn extras_may_be_anything() {
    for extras in
        [json!("a note"), json!(5), json!([1, {"a": [null]}]), json!({"made by": "me"}), json!(true)]
    {
        let mut file = File::new();
        file.triangle();
        file.0["extras"] = extras.clone();
        file.0["asset"]["extras"] = extras.clone();
        file.0["nodes"] = json!([{"mesh": 0, "extras": extras}]);
        file.0["meshes"][0]["extras"] = extras;
        assert_eq!(file.parse().unwrap().objects.len(), 1);
    }
}
