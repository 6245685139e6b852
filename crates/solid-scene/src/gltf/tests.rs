//! Whole files, small ones: what they mean, and that nothing in them does harm.

use std::f64::consts::FRAC_1_SQRT_2;
use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::{DAffine3, DMat3, DVec3};
use proptest::prelude::*;
use serde_json::{Value, json};
use solid3d::ShapeKind;

use super::graph::{DEPTH_MAX, PATHS_MAX};
use super::parse;
use crate::part::Part;
use crate::pose::ObjectPose;

const BYTE: u32 = 5120;
const UNSIGNED_BYTE: u32 = 5121;
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

#[test]
fn broken_hierarchies_are_refused() {
    let mut file = File::new();
    file.triangle();
    let hierarchies = [
        (json!([{"children": [0]}]), "node 0 is its own ancestor"),
        (json!([{}, {"children": [2]}, {"children": [1]}]), "node 2 is its own ancestor"),
        (json!([{"children": [2]}, {"children": [2]}, {}]), "node 2 is a child of both node 0 and node 1"),
        (json!([{"children": [7]}]), "child of node 0: node 7 is named, but there is 1"),
        (json!([{"mesh": 7}]), "node 0: mesh 7 is named, but there is 1"),
        (json!([{"mesh": 0, "rotation": [0, 0, 0, 0]}]), "node 0 has a rotation of length 0"),
        (
            json!([{"mesh": 0, "scale": [1e39, 1, 1]}]),
            "not glTF 2.0: number out of range at line 1 column 352",
        ),
        (json!([{"mesh": 0, "matrix": vec![1.0; 16]}]), "node 0 has a matrix that is not affine"),
    ];
    for (nodes, message) in hierarchies {
        file.0["nodes"] = nodes;
        assert_eq!(file.refused(), message);
    }
}

#[test]
fn depth_has_a_limit() {
    let mut file = File::new();
    let mesh = file.triangle();
    let chain = |length: usize| {
        let node =
            |i: usize| if i + 1 == length { json!({"mesh": mesh}) } else { json!({"children": [i + 1]}) };
        (0..length).map(node).collect::<Value>()
    };
    file.0["nodes"] = chain(DEPTH_MAX);
    assert_eq!(file.parse().unwrap().objects[0].path.len(), DEPTH_MAX);
    file.0["nodes"] = chain(DEPTH_MAX + 1);
    assert_eq!(file.refused(), "node 256 is deeper than 256 nodes");
}

/// A few bytes a node make no kilobyte of memory each without end.
#[test]
fn paths_have_a_limit() {
    let mut file = File::new();
    let mesh = file.triangle();
    let leaves = PATHS_MAX / DEPTH_MAX + 1;
    let chain = DEPTH_MAX - 2;
    let below = |i: usize| json!({"children": [i + 1]});
    let last = json!({"children": (chain + 1..=chain + leaves).collect::<Vec<_>>()});
    let nodes = (0..chain).map(below).chain([last]).chain((0..leaves).map(|_| json!({"mesh": mesh})));
    file.0["nodes"] = nodes.collect();
    let message = format!("the paths from the roots to the objects have more than {PATHS_MAX} nodes");
    assert_eq!(file.refused(), format!("node {}: {message}", chain + leaves));
}

#[test]
fn accessors_stay_in_their_buffers() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    let changes = [
        ("/accessors/0/count", json!(4), "accessor 0: goes to byte 48 of bufferView 0, which has 36"),
        (
            "/accessors/0/count",
            json!(u64::MAX),
            "accessor 0: elements: 18446744073709551615 numbers are more",
        ),
        ("/accessors/0/byteOffset", json!(1), "accessor 0: goes to byte 37 of bufferView 0, which has 36"),
        ("/accessors/0/bufferView", json!(9), "accessor 0: bufferView 9 is named, but there is 1"),
        ("/accessors/0/type", json!("VEC2"), "accessor 0 is of type Vec2; expected Vec3"),
        ("/accessors/0/type", json!("VEC9"), "accessor 0 is of an unknown type; expected Vec3"),
        ("/accessors/0/componentType", json!(1), "accessor 0 has an unknown componentType"),
        ("/bufferViews/0/byteLength", json!(37), "bufferView 0 goes to byte 37 of buffer 0, which has 36"),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "bufferView 0 goes to byte 18446744073709551615 of buffer 0",
        ),
        (
            "/bufferViews/0/byteStride",
            json!(0),
            "has elements of 12 bytes, but bufferView 0 a byteStride of 0",
        ),
        ("/bufferViews/0/buffer", json!(3), "buffer 3 is named, but there is 1"),
        ("/meshes/0/primitives/0/indices", json!(0), "indices: accessor 0 has no unsigned integers"),
        ("/meshes/0/primitives/0/mode", json!(7), "mesh 0 (`tri`), primitive 0 is of an unknown mode"),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(5),
            "primitive 0: accessor 5 is named, but there is 1",
        ),
        ("/meshes/0/primitives/0/attributes/JOINTS_0", json!(0), "has only one of JOINTS_0 and WEIGHTS_0"),
    ];
    for (path, value, message) in changes {
        let mut file = File(file.0.clone());
        set(&mut file, path, value);
        let refused = file.refused();
        assert!(refused.contains(message), "{path}: {refused}");
    }
}

/// Its warnings may say why.
#[test]
fn a_file_may_have_no_geometry() {
    let mut file = File::new();
    assert!(file.parse().unwrap().objects.is_empty());
    let mesh = file.add("meshes", json!({"primitives": [{"attributes": {}}]}));
    file.add("nodes", json!({"mesh": mesh}));
    let part = file.parse().unwrap();
    assert!(part.objects.is_empty() && part.warnings == ["mesh 0 has no geometry"], "{:?}", part.warnings);
}

/// What a small file names again and again takes memory each time; some sharing is fine.
#[test]
fn sharing_is_limited_in_proportion_to_the_file() {
    let vertices = 9000;
    let positions = |file: &mut File| file.floats("VEC3", vertices, &vec![0.0; 3 * vertices]);
    let meshes = |count: usize| {
        let mut file = File::new();
        let shared = positions(&mut file);
        for mesh in 0..count {
            file.add("meshes", json!({"primitives": [{"attributes": {"POSITION": shared}, "mode": 0}]}));
            file.add("nodes", json!({"mesh": mesh}));
        }
        file
    };
    let targets = |count: usize| {
        let mut file = meshes(1);
        let targets = vec![json!({"POSITION": 0}); count];
        file.0["meshes"][0]["primitives"][0]["targets"] = json!(targets);
        file
    };
    let channels = |count: usize| {
        let mut file = meshes(1);
        let times: Vec<f32> = (0..vertices as u16).map(f32::from).collect();
        let times = file.floats("SCALAR", vertices, &times);
        let channel = |sampler| json!({"sampler": sampler, "target": {"node": 0, "path": "translation"}});
        file.0["animations"] = json!([{
            "samplers": vec![json!({"input": times, "output": 0}); count],
            "channels": (0..count).map(channel).collect::<Vec<_>>(),
        }]);
        file
    };
    let files: [&dyn Fn(usize) -> File; 3] = [&meshes, &targets, &channels];
    for file in files {
        assert_eq!(file(20).parse().map(|_| ()), Ok(()));
        let refused = file(200).refused();
        assert!(refused.ends_with("numbers are more than a file of this size may hold"), "{refused}");
    }
}

/// Zeros need no bytes in the file, and so are counted.
#[test]
fn zeros_without_a_buffer_are_limited() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    file.0["accessors"][0] = json!({"type": "VEC3", "componentType": FLOAT, "count": 1000});
    assert_eq!(file.parse().unwrap().objects[0].degenerate, 333);
    file.0["accessors"][0]["count"] = json!(1_000_000_000);
    assert!(file.refused().ends_with("3000000000 numbers are more than a file of this size may hold"));
    file.0["accessors"][0]["count"] = json!(1000);
    file.0["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    assert!(
        file.refused().contains("the file is compressed (KHR_draco_mesh_compression); decompress it first")
    );
}

#[test]
fn positions_that_are_not_finite_are_refused() {
    let mut file = File::new();
    let mesh = file.triangle();
    let positions = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, f32::NAN, 0.0, 0.0, 1.0, 0.0]);
    file.0["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
    file.add("nodes", json!({"mesh": mesh}));
    let message =
        "node 0: mesh 0 (`tri`), primitive 0, POSITION: vertex 1 is [1, NaN, 0]; expected finite numbers";
    assert_eq!(file.refused(), message);
}

#[test]
fn buffers_that_are_not_there_are_named() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    let buffers = [
        (json!({"byteLength": 36, "uri": "a.bin"}), "buffer 0: `a.bin` can't be read: "),
        (
            json!({"byteLength": 36, "uri": "../a.bin", "name": "b"}),
            "buffer 0 (`b`) is at `../a.bin`; expected a path",
        ),
        (
            json!({"byteLength": 36, "uri": "AAAA".repeat(1000)}),
            &format!("buffer 0: `{}...` can't be read: ", "A".repeat(80)),
        ),
        (json!({"byteLength": 36, "uri": "data:;base64,!"}), "buffer 0 has bad base64: "),
        (json!({"byteLength": 36, "uri": "data:;base64,AAAA"}), "buffer 0 has 3 bytes; it should have 36"),
        (json!({"byteLength": 36}), "buffer 0 has no URI and no binary part"),
    ];
    for (buffer, message) in buffers {
        file.0["buffers"] = json!([buffer]);
        assert!(file.refused().starts_with(message), "{}", file.refused());
    }
}

#[test]
fn extensions_and_versions_are_checked() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    file.0["extensionsRequired"] = json!(["KHR_materials_unlit"]);
    assert!(file.parse().is_ok());
    file.0["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    assert!(
        file.refused().starts_with("the file is compressed (EXT_meshopt_compression); decompress it first")
    );
    file.0["extensionsRequired"] = json!(["KHR_implicit_shapes"]);
    assert_eq!(
        file.refused(),
        "the file requires the extension `KHR_implicit_shapes`, which is not supported"
    );
    file.0["asset"] = json!({"version": "1.0"});
    assert_eq!(file.refused(), "the file is of glTF 1.0; expected 2.0");
}

/// What may be missed is said, once.
#[test]
fn extensions_that_are_not_known_are_warned_of() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    file.0["extensionsUsed"] = json!([
        "KHR_materials_unlit",
        "EXT_meshopt_compression",
        "KHR_animation_pointer",
        "EXT_mesh_gpu_instancing"
    ]);
    assert_eq!(file.parse().unwrap().warnings, [""; 0]);
    file.0["extensionsUsed"] = json!(["AGI_articulations", "KHR_texture_transform", "KHR_implicit_shapes"]);
    let warning = "uses extensions that are not supported (`AGI_articulations`, `KHR_implicit_shapes`): what they \
                   change is not seen";
    assert_eq!(file.parse().unwrap().warnings, [warning]);
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

#[test]
fn each_instance_of_a_mesh_is_an_object() {
    let part = instances().parse().unwrap();
    let seen: Vec<_> = part.objects.iter().map(|o| (&o.name[..], &o.path[..])).collect();
    assert_eq!(seen, [("tree", &[0, 2][..]), ("tree", &[0, 3]), ("tree", &[0, 4]), ("bird", &[0, 1])]);
    assert_eq!(part.warnings, [""; 0]);
    let poses = pose(&part, 1.0);
    let at = |object: usize, point: DVec3| poses[object].placement.transform_point3(point);
    assert!(at(0, DVec3::X).abs_diff_eq(DVec3::new(11.0, 0.0, 0.0), 1e-6));
    assert!(at(1, DVec3::X).abs_diff_eq(DVec3::new(10.0, 7.0, 0.0), 1e-6));
    assert!(at(2, DVec3::X).abs_diff_eq(DVec3::new(13.0, 0.0, 7.0), 1e-6));
    assert!(at(3, DVec3::X).abs_diff_eq(DVec3::new(11.0, 0.0, 0.0), 1e-6));
    // What is not told is as in a node.
    let mut file = instances();
    let attributes = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    set(&mut file, attributes, json!({"_ID": 4}));
    let part = file.parse().unwrap();
    assert_eq!((part.objects.len(), pose(&part, 0.0)[2].placement), (4, DAffine3::IDENTITY));
    set(&mut file, attributes, json!({}));
    assert_eq!(file.parse().unwrap().objects.len(), 2);
}

#[test]
fn instances_are_checked() {
    let attributes = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    let changes = [
        (
            format!("{attributes}/SCALE"),
            json!(0),
            "node 0: instances, TRANSLATION has 3 elements, but ROTATION 4",
        ),
        (
            format!("{attributes}/SCALE"),
            json!(9),
            "node 0: instances, SCALE: accessor 9 is named, but there are 7",
        ),
        (
            format!("{attributes}/ROTATION"),
            json!(1),
            "node 0: instances, ROTATION: accessor 1 is of type Vec3; expected Vec4",
        ),
        (
            format!("{attributes}/TRANSLATION"),
            json!("x"),
            "not glTF 2.0: invalid type: string \"x\", expected usize",
        ),
        (
            "/accessors/4/count".to_owned(),
            json!(1_000_000_000),
            "numbers are more than a file of this size may hold",
        ),
    ];
    for (path, value, message) in changes {
        let mut file = instances();
        if message.ends_with("ROTATION 4") {
            let rotations = file.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0].repeat(4));
            set(&mut file, &format!("{attributes}/ROTATION"), json!(rotations));
        }
        if message.ends_with("may hold") {
            set(&mut file, attributes, json!({"_ID": 4}));
        }
        set(&mut file, &path, value);
        let refused = file.refused();
        assert!(refused.contains(message), "{path}: {refused}");
    }
    let mut file = instances();
    let zero = file.floats("VEC4", 3, &[0.0; 12]);
    set(&mut file, &format!("{attributes}/ROTATION"), json!(zero));
    assert_eq!(file.refused(), "node 0: instance 0 has a rotation of length 0");
    // A skin places the vertices in the world.
    let mut file = everything();
    file.0["nodes"][3]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    let part = file.parse_animation(Some("1")).unwrap();
    assert_eq!(
        (part.objects.len(), &part.warnings[..]),
        (2, &["`node3` has a skin, so that its instances are passed over".to_owned()][..])
    );
}

/// Each instance keeps the name, and the positions where the mesh changes its form.
#[test]
fn instances_take_no_memory_without_end() {
    let of_instances = |count: usize| {
        let mut file = instances();
        let translations = file.floats("VEC3", count, &vec![0.0; 3 * count]);
        set(
            &mut file,
            "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes",
            json!({"TRANSLATION": translations}),
        );
        file
    };
    let mut file = of_instances(257);
    file.0["nodes"][0]["name"] = json!("n".repeat(1 << 20));
    assert_eq!(file.refused(), "node 0: the names of the objects have more than 268435456 bytes in all");
    // A mesh of many vertices, which grows.
    let growing = |count: usize| {
        let mut file = of_instances(count);
        let positions = file.floats(
            "VEC3",
            1000,
            &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0].repeat(250),
        );
        let primitive = json!({"attributes": {"POSITION": positions}, "targets": [{"POSITION": positions}]});
        let mesh = file.add("meshes", json!({"primitives": [primitive]}));
        file.0["nodes"][0]["mesh"] = json!(mesh);
        let times = file.floats("SCALAR", 2, &[0.0, 1.0]);
        file.0["animations"] = json!([{
            "samplers": [{"input": times, "output": times}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        }]);
        file
    };
    assert_eq!(growing(300).parse().unwrap().objects.len(), 301);
    assert_eq!(
        growing(400).refused(),
        "node 0: positions of what deforms: 3000 numbers are more than a file of this size may hold"
    );
}

#[test]
fn an_animation_that_has_no_effect_is_warned_of() {
    let mut file = everything();
    file.0["nodes"][1] = json!({"children": [2], "matrix": glam::Mat4::IDENTITY.to_cols_array()});
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["node 1 has a matrix, so that its animation has no effect"]);
    // The weights of a node with a matrix change.
    let mut file = everything();
    let placed = file.0["nodes"][3].as_object_mut().unwrap();
    placed.remove("scale");
    placed.insert("matrix".to_owned(), json!(glam::Mat4::IDENTITY.to_cols_array()));
    assert_eq!(file.parse().unwrap().warnings.len(), 1);
}

/// A channel may leave it to an extension to say what it changes (glTF 2.0, section 5.8).
#[test]
fn a_channel_without_a_node_is_passed_over() {
    let mut file = everything();
    let without =
        json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {}}}});
    file.0["animations"][0]["channels"].as_array_mut().unwrap().insert(1, without.clone());
    let expected = pose(&everything().parse().unwrap(), 2.0);
    for (text, bytes) in [(true, file.0.to_string().into_bytes()), (false, binary(&file))] {
        let part = parse(&bytes, Path::new(""), None).unwrap();
        assert_eq!(
            part.warnings[1..],
            ["animation `all`: 1 channel that names no node is passed over"],
            "{text}"
        );
        assert_eq!(pose(&part, 2.0), expected);
    }
    file.0["animations"][0]["channels"].as_array_mut().unwrap().push(without);
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["animation `all`: 2 channels that name no node are passed over"]);
    assert_eq!(file.parse_animation(Some("1")).unwrap().warnings, [""; 0]);
}

/// A mistake elsewhere in such a file is told by its line, too.
#[test]
fn a_channel_without_a_node_leaves_lines_as_they_are() {
    let mut file = everything();
    set(&mut file, "/accessors/0/count", json!("x"));
    let told = |file: &File| {
        let text = serde_json::to_string_pretty(&file.0).unwrap();
        parse(text.as_bytes(), Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned()
    };
    assert!(told(&file).starts_with("not glTF 2.0: invalid type: string \"x\""), "{}", told(&file));
    let expected = told(&file);
    assert!(expected.contains(" at line "), "{expected}");
    file.0["animations"][0]["channels"][0]["target"].as_object_mut().unwrap().remove("node");
    assert_eq!(told(&file), expected);
}

/// A scene need not have nodes.
#[test]
fn an_empty_scene_is_one() {
    let mut file = everything();
    let expected = pose(&file.parse().unwrap(), 2.0);
    file.add("scenes", json!({"name": "empty"}));
    assert_eq!(pose(&file.parse().unwrap(), 2.0), expected);
}

/// A skin has no effect where no vertex follows a joint, and why is said.
#[test]
fn a_mesh_that_follows_no_joint_is_warned_of() {
    let mut file = everything();
    let weights = file.floats("VEC4", 4, &[0.0; 16]);
    set(&mut file, "/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["all weights of mesh 0 are 0, so skin 0 has no effect on it"]);
    let attributes = file.0["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap();
    attributes.retain(|name, _| name == "POSITION");
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["mesh 0 has no JOINTS_0, so skin 0 has no effect on it"]);
}

#[test]
fn skins_and_animations_are_checked() {
    let changes = [
        ("/skins/0/joints/1", json!(9), "skin 0: node 9 is named, but there are 4"),
        ("/skins/0/joints", json!([1]), "a vertex follows joint 1, but there is 1"),
        ("/skins/0/joints", json!([0, 1, 2]), "skin 0 has 3 joints, but 2 inverseBindMatrices"),
        ("/nodes/3/skin", json!(2), "skin 2 is named, but there is 1"),
        ("/animations/0/channels/0/sampler", json!(3), "animation `all`, channel 0: sampler 3 is named"),
        ("/animations/0/channels/0/target/node", json!(4), "animation `all`, channel 0: node 4 is named"),
        (
            "/animations/0/samplers/0/output",
            json!(4),
            "channel 0, output: accessor 4 is of type Scalar; expected Vec4",
        ),
        ("/animations/0/samplers/0/interpolation", json!("CURVE"), "channel 0 has an unknown interpolation"),
        ("/animations/0/samplers/1/interpolation", json!("LINEAR"), "channel 1 has 2 keys, but 6 values"),
        (
            "/meshes/0/primitives/0/targets",
            json!([{}, {}]),
            "animation `all`, channel 2: a key has 1 weight, but the mesh of node 3 has 2 targets",
        ),
    ];
    for (path, value, message) in changes {
        let mut file = everything();
        set(&mut file, path, value);
        let refused = file.refused();
        assert!(refused.contains(message), "{path}: {refused}");
    }
    let mut file = everything();
    let refused = file.parse_animation(Some("x")).unwrap_err();
    assert_eq!(refused, "there is no animation `x`; the animations of the file are `all`, 1");
    file.0["animations"].as_array_mut().unwrap().truncate(1);
    let refused = file.parse_animation(Some("1")).unwrap_err();
    assert_eq!(refused, "there is no animation `1`; the only one of the file is `all`");
    file.0["animations"] = json!([]);
    let refused = file.parse_animation(Some("0")).unwrap_err();
    assert_eq!(refused, "there is no animation `0`; the file has none");
}

#[test]
fn text_that_is_not_gltf_is_refused() {
    let deep = "[".repeat(1 << 20);
    for bytes in [&b""[..], b"{", b"glTF", b"glTF\x02\0\0\0\x0b\0\0\0", b"\xff\xfe", deep.as_bytes()] {
        assert!(parse(bytes, Path::new(""), None).is_err());
    }
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
fn binary_files_are_read() {
    let part = parse(&binary(&everything()), Path::new(""), None).unwrap();
    assert_eq!(part.objects.len(), 2);
    let text = everything().parse().unwrap();
    assert_eq!(pose(&part, 1.5), pose(&text, 1.5));
}

#[test]
fn a_binary_file_that_was_cut_off_says_so() {
    let bytes = binary(&everything());
    let refused =
        |end: usize| parse(&bytes[..end], Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned();
    assert_eq!(refused(11), "the file ends in its header, of 12 bytes; it has 11");
    let length = bytes.len();
    for present in [12, 100, length - 1] {
        assert_eq!(
            refused(present),
            format!("the header tells a length of {length} bytes; the file has {present}, so it was cut off")
        );
    }
}

/// All numbers of a value, to be changed.
fn numbers<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::Number(_) => found.push(value),
        Value::Array(values) => values.iter_mut().for_each(|value| numbers(value, found)),
        Value::Object(values) => values.values_mut().for_each(|value| numbers(value, found)),
        _ => {}
    }
}

fn sample_all(part: Result<Part, String>) {
    if let Ok(part) = part {
        for time in [-1.0, 0.0, 2.5, 1e300] {
            pose(&part, time);
        }
    }
}

proptest! {
    #[test]
    fn changed_instances_never_panic(at in any::<prop::sample::Index>(), value in 0u32..12) {
        let mut file = instances();
        let mut found = Vec::new();
        numbers(&mut file.0, &mut found);
        let at = at.index(found.len());
        *found[at] = json!(value);
        sample_all(file.parse());
    }

    #[test]
    fn changed_numbers_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), 0usize..10), 1..4)) {
        let values = [json!(0), json!(1), json!(2), json!(3), json!(5), json!(30), json!(-1), json!(u32::MAX),
            json!(u64::MAX), json!(1e38)];
        let mut file = everything();
        let mut found = Vec::new();
        numbers(&mut file.0, &mut found);
        for (index, value) in changes {
            let index = index.index(found.len());
            *found[index] = values[value].clone();
        }
        sample_all(file.parse());
        sample_all(file.parse_animation(Some("1")));
    }

    #[test]
    fn truncated_binary_files_are_refused(cut in any::<prop::sample::Index>()) {
        let bytes = binary(&everything());
        prop_assert!(parse(&bytes[..cut.index(bytes.len())], Path::new(""), None).is_err());
    }

    #[test]
    fn changed_bytes_never_panic(at in any::<prop::sample::Index>(), byte: u8) {
        let mut bytes = binary(&everything());
        let at = at.index(bytes.len());
        bytes[at] = byte;
        sample_all(parse(&bytes, Path::new(""), None).map_err(|fault| fault.message().to_owned()));
    }
}
