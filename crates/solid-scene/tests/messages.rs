//! Messages are for people: however long a word of a file is, they quote its beginning.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::path::Path;

use solid_scene::{LoadOptions, Scene};

/// Stands for the long word.
const WORD: &str = "WORD";

/// Files with a word that a message tells, by how their names end.
const FILES: [(&str, &str); 23] = [
    ("wrl", "#VRML V2.0 utf8\nShape { geometry DEF WORD Box { size -1 1 1 } }"),
    ("wrl", "#VRML V2.0 utf8\nUSE WORD"),
    ("wrl", "#VRML V2.0 utf8\nShape { geometry Box { } } WORD { }"),
    ("wrl", "#VRML V2.0 utf8\nShape { geometry Box { } } Transform { WORD 1 2 3 }"),
    (
        "wrl",
        "#VRML V2.0 utf8\nPROTO P [ field SFVec3f WORD 1 1 1 ] { Transform { scale IS WORD } } P { WORD a }",
    ),
    (
        "wrl",
        "#VRML V2.0 utf8\nShape { geometry Box { } } DEF A Group { } DEF T TimeSensor { } ROUTE T.time TO A.WORD",
    ),
    (
        "wrl",
        "#VRML V2.0 utf8\nDEF S Script { eventOut SFVec3f WORD } DEF A Transform { children Shape { geometry Box { } } } \
         ROUTE S.WORD TO A.set_translation",
    ),
    ("wrl", "#VRML V2.0 utf8\nShape { geometry Box { } } EXTERNPROTO WORD [] \"WORD.wrl#WORD\" WORD { }"),
    ("wrl", "#VRML V2.0 utf8\nShape { geometry Box { } } Inline { url \"WORD\" }"),
    ("wrl", "#VRML V2.0 utf8\nShape { geometry Box { } } Inline { url \"http://WORD\" }"),
    ("obj", "v 0 0 WORD"),
    ("obj", "v 0 0 0\nf 1 1 WORD"),
    ("stl", "solid\nWORD"),
    ("ply", "ply\nformat ascii 1.0\nelement WORD 3\nproperty float x\nend_header\n"),
    ("ply", "ply\nformat ascii 1.0\nelement WORD 3\nend_header\n"),
    ("ply", "ply\nformat ascii 1.0\nelement WORD 1\nproperty list char int WORD\nend_header\n0.5\n"),
    ("ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty WORD x\nend_header\n"),
    ("gltf", r#"{"asset": {"version": "WORD"}}"#),
    ("gltf", r#"{"asset": {"version": "2.0"}, "extensionsRequired": ["WORD"]}"#),
    (
        "gltf",
        r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"name": "WORD", "primitives": [{"attributes": {"POSITION": 7}}]}]}"#,
    ),
    ("gltf", r#"{"asset": {"version": "2.0"}, "buffers": [{"name": "WORD", "byteLength": 4}]}"#),
    (
        "gltf",
        r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["WORD"], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"mode": 4, "attributes": {"POSITION": 0}}]}],
            "accessors": [{"count": 3, "componentType": 5126, "type": "VEC3"}]}"#,
    ),
    (
        "gltf",
        r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"mode": 4, "attributes": {"POSITION": 0}}]}],
            "accessors": [{"count": 3, "componentType": 5126, "type": "VEC3"}],
            "animations": [{"name": "WORD", "channels": [], "samplers": []}, {"channels": [], "samplers": []}]}"#,
    ),
];

/// What loading a file says, a line each.
fn messages(path: &Path, text: String) -> Vec<String> {
    std::fs::write(path, text).unwrap();
    match Scene::load(&[path], &LoadOptions::default()) {
        Ok(scene) => scene.warnings().map(|(_, warning)| warning.to_owned()).collect(),
        Err(error) => vec![error.message],
    }
}

#[test]
fn a_long_word_is_told_by_its_beginning() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (number, (end, text)) in FILES.iter().enumerate() {
        let path = folder.join(format!("message{number}.{end}"));
        let with = |length| messages(&path, text.replace(WORD, &"n".repeat(length)));
        let (short, long) = (with(9), with(10_000));
        assert_eq!(short.len(), long.len(), "{text}: {short:?}");
        let quotes = |word: &str, messages: &[String]| messages.iter().any(|message| message.contains(word));
        assert!(quotes(&"n".repeat(9), &short), "{text}: {short:?}");
        assert!(
            quotes("nnn...", &long) && long.iter().all(|message| message.len() < 400),
            "{text}: {long:?}"
        );
    }
}

#[test]
fn of_many_animations_the_first_are_told() {
    let animations = vec![r#"{"channels": [], "samplers": []}"#; 1000].join(", ");
    let text = format!(r#"{{"asset": {{"version": "2.0"}}, "animations": [{animations}]}}"#);
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("animations.gltf");
    std::fs::write(&path, text).unwrap();
    let mut options = LoadOptions::default();
    options.animation = Some("walk".to_owned());
    let error = Scene::load(&[path], &options).unwrap_err();
    assert!(
        error.message.starts_with("there is no animation `walk`; the animations of the file are 0, 1, 2, "),
        "{error}"
    );
    assert!(error.message.ends_with(", 19 and 980 more"), "{error}");
}
