//! What is refused, and the limits: of hierarchies, accessors, buffers and extensions.

use super::*;

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
        file.is_refused_with(path, value, message);
    }
    // What its bytes have beyond its length is padding.
    let message = "bufferView 0 goes to byte 36 of buffer 0, which has 35";
    file.is_refused_with("/buffers/0/byteLength", json!(35), message);
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
    let sparse = |count: usize| {
        let mut file = File::new();
        let many = 60_000;
        let places = file.view(&vec![0; many]);
        let values = file.view(&vec![0; 12 * many]);
        for mesh in 0..count {
            let sparse = json!({
                "count": many, "indices": {"bufferView": places, "componentType": UNSIGNED_BYTE},
                "values": {"bufferView": values},
            });
            let positions = json!({"type": "VEC3", "componentType": FLOAT, "count": 1, "sparse": sparse});
            let positions = file.add("accessors", positions);
            file.add("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}, "mode": 0}]}));
            file.add("nodes", json!({"mesh": mesh}));
        }
        file
    };
    let files: [&dyn Fn(usize) -> File; 4] = [&meshes, &targets, &channels, &sparse];
    for file in files {
        assert_eq!(file(20).parse().map(|_| ()), Ok(()));
        let refused = file(200).refused();
        assert!(refused.ends_with("numbers are more than a file of this size may hold"), "{refused}");
    }
}

/// Nodes of a byte or two take a kilobyte each.
#[test]
fn nodes_have_a_limit() {
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    let text = |others: usize| {
        let nodes = format!("\"nodes\":[{}", "{},".repeat(others));
        file.0.to_string().replace("\"nodes\":[", &nodes)
    };
    let parse = |others: usize| parse(text(others).as_bytes(), Path::new(""), None);
    assert_eq!(parse(NODES_MAX - 1).unwrap().objects.len(), 1);
    let fault = parse(NODES_MAX).unwrap_err();
    assert_eq!(fault.message(), "the file has 500001 nodes; the limit is 500000");
}

/// A target of some primitives has nothing to say of the vertices of others, however many.
#[test]
fn targets_take_memory_for_their_own_vertices() {
    let mut file = File::new();
    let triangle = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let many = json!({"type": "VEC3", "componentType": FLOAT, "count": 100_000});
    let many = file.add("accessors", many);
    let targets = vec![json!({"POSITION": triangle}); 20_000];
    let mesh = file.add(
        "meshes",
        json!({"weights": [1], "primitives": [
            {"attributes": {"POSITION": many}, "mode": 0},
            {"attributes": {"POSITION": triangle}, "targets": targets},
        ]}),
    );
    file.add("nodes", json!({"mesh": mesh}));
    let part = file.parse().unwrap();
    let vertices = part.objects[0].shape.vertices().unwrap();
    assert_eq!((vertices.len(), vertices[0], vertices[100_001]), (100_003, DVec3::ZERO, DVec3::X * 2.0));
}

/// What nodes share, each goes through on its own.
#[test]
fn many_nodes_may_not_share_many_targets_or_joints() {
    let count = 20_000;
    let morphed = |nodes: usize| {
        let mut file = File::new();
        let triangle = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let targets = vec![json!({"POSITION": triangle}); count];
        let primitive = json!({"attributes": {"POSITION": triangle}, "targets": targets});
        let mesh = file.add("meshes", json!({"weights": vec![1; count], "primitives": [primitive]}));
        file.0["nodes"] = json!(vec![json!({"mesh": mesh}); nodes]);
        file
    };
    let skinned = |nodes: usize| {
        let mut file = everything();
        file.0.as_object_mut().unwrap().retain(|name, _| !name.starts_with("scene"));
        let skin = file.add("skins", json!({"joints": vec![1; 5 * count]}));
        file.0["nodes"].as_array_mut().unwrap().extend(vec![json!({"mesh": 0, "skin": skin}); nodes]);
        file
    };
    let files: [&dyn Fn(usize) -> File; 2] = [&morphed, &skinned];
    for file in files {
        assert_eq!(file(10).parse().map(|_| ()), Ok(()));
        let refused = file(count).refused();
        assert!(refused.ends_with("numbers are more than a file of this size may hold"), "{refused}");
    }
}

/// What buffers name is read once, and counts once.
#[test]
fn a_file_of_many_buffers_is_read_once() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let length = folder.join("lib.rs").metadata().unwrap().len();
    let mut file = File::new();
    let mesh = file.triangle();
    file.add("nodes", json!({"mesh": mesh}));
    for uri in ["lib.rs", "./lib.rs", "%6cib.rs"].into_iter().cycle().take(3000) {
        file.add("buffers", json!({"byteLength": length, "uri": uri}));
    }
    file.add("buffers", json!({"byteLength": length - 1, "uri": "lib.rs"}));
    let parse = |file: &File| parse(file.0.to_string().as_bytes(), &folder, None);
    assert_eq!(parse(&file).unwrap().files, [folder.join("lib.rs")]);
    let zeros = json!({"type": "VEC3", "componentType": FLOAT, "count": 1000 * length});
    set(&mut file, "/accessors/0", zeros);
    let message = parse(&file).unwrap_err().message().to_owned();
    assert!(message.ends_with("numbers are more than a file of this size may hold"), "{message}");
    file.add("buffers", json!({"byteLength": length + 1, "uri": "lib.rs"}));
    let message = format!("buffer 3002: `lib.rs` has {length} bytes; it should have {}", length + 1);
    assert_eq!(parse(&file).unwrap_err().message(), message);
}

/// A warning is given once, and of many no more than anybody would read.
#[test]
fn warnings_have_a_limit() {
    let mut file = File::new();
    let empty = file.add("meshes", json!({"primitives": []}));
    file.0["nodes"] = json!(vec![json!({"mesh": empty}); 1000]);
    assert_eq!(file.parse().unwrap().warnings, ["mesh 0 has no geometry"]);
    file.0["meshes"] = json!(vec![json!({"primitives": []}); 1000]);
    file.0["nodes"] = (0..1000).map(|mesh| json!({"mesh": mesh})).collect();
    let warnings = file.parse().unwrap().warnings;
    assert_eq!((warnings.len(), warnings[200].as_str()), (201, "800 more warnings"));
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
    file.0["asset"] = json!({"version": "2.3", "minVersion": "2.0"});
    assert!(file.refused().contains("KHR_implicit_shapes"), "the version will do");
    file.0["asset"] = json!({"version": "2.3", "minVersion": "2.1"});
    assert_eq!(file.refused(), "the file is of glTF 2.1; expected 2.0");
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
