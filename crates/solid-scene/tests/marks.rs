//! A byte order mark before a text, as some editors write it, is no part of the text.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::path::Path;

use solid_scene::{LoadOptions, Scene};

const WRL: &str = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } \
                   coordIndex [0 1 2] } }";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const STL: &str = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                   element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// A point, which needs no buffer.
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
    "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
    "accessors": [{"count": 1, "componentType": 5126, "type": "VEC3"}]}"#;

#[test]
fn a_byte_order_mark_is_passed_over() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (name, text) in
        [("mark.wrl", WRL), ("mark.obj", OBJ), ("mark.stl", STL), ("mark.ply", PLY), ("mark.gltf", GLTF)]
    {
        let path = folder.join(name);
        let vertices = |text: String| {
            std::fs::write(&path, text).unwrap();
            let scene =
                Scene::load(&[&path], &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
            scene.objects()[0].shape().vertices().unwrap().to_vec()
        };
        assert_eq!(vertices(format!("\u{feff}{text}")), vertices(text.to_owned()), "{name}");
    }
}

/// Of text in UTF-16, of either byte order, it is said what it is.
#[test]
fn text_in_utf16_is_named() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (name, text) in
        [("wide.wrl", WRL), ("wide.obj", OBJ), ("wide.stl", STL), ("wide.ply", PLY), ("wide.gltf", GLTF)]
    {
        let path = folder.join(name);
        for bytes_of in [u16::to_le_bytes, u16::to_be_bytes] {
            let marked = format!("\u{feff}{text}");
            std::fs::write(&path, marked.encode_utf16().flat_map(bytes_of).collect::<Vec<u8>>()).unwrap();
            let error = Scene::load(&[&path], &LoadOptions::default()).map(|_| ()).unwrap_err().to_string();
            assert!(
                error.ends_with(": is text in UTF-16; expected UTF-8, so save it as that first"),
                "{error}"
            );
        }
    }
}
