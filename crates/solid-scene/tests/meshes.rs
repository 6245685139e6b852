//! OBJ, STL and PLY files of others, against exact statistics of them.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test")]

mod data;

use std::collections::HashSet;
use std::path::Path;

use solid_scene::Scene;
use solid3d::Shape;

/// What a reader can't make geometry of: nothing in it, or vertices only; and PLY with its faces in `vertex`.
const REFUSED: [&str; 8] = [
    "assimp/issue623.ply",
    "empty.obj",
    "empty.ply",
    "empty.stl",
    "face_in_group_name.obj",
    "ipc/point.obj",
    "ipc/pointPlane.obj",
    "points_emptyface.ply",
];

fn only_shape(scene: &Scene) -> &Shape {
    let [object] = scene.objects() else { panic!("expected one object") };
    object.shape()
}

fn triangles(path: &Path) -> usize {
    only_shape(&data::load(path).unwrap_or_else(|error| panic!("{error}"))).triangles().unwrap().len()
}

fn distinct(shape: &Shape) -> usize {
    let key = |v: &glam::DVec3| v.to_array().map(|x| (x + 0.0).to_bits());
    shape.vertices().unwrap().iter().map(key).collect::<HashSet<_>>().len()
}

#[test]
fn bad_meshes_are_read_or_refused() {
    let Some(folder) = data::folder() else { return };
    let folder = folder.join("bad_meshes");
    let mut refused = Vec::new();
    for path in data::files(&folder, &["obj", "stl", "ply"]) {
        match data::load(&path) {
            Ok(scene) => {
                println!("{}: {} primitives", path.display(), scene.objects()[0].shape().primitive_count())
            }
            Err(error) => {
                println!("{error}");
                refused.push(path.strip_prefix(&folder).unwrap().to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    assert_eq!(refused, REFUSED);
}

#[test]
fn bad_meshes_have_their_statistics() {
    let Some(folder) = data::folder() else { return };
    let folder = folder.join("bad_meshes");
    let mut rows = 0;
    for row in csv::Reader::from_path(folder.join("expected.csv")).unwrap().into_records() {
        let row = row.unwrap();
        if row[0].ends_with(".off") || row[1].is_empty() {
            continue;
        }
        let path = folder.join(&row[0]);
        let scene = data::load(&path).unwrap();
        let shape = only_shape(&scene);
        let vertices = shape.vertices().unwrap().len();
        let welded = path.extension().unwrap().eq_ignore_ascii_case("stl");
        let found = [vertices, shape.primitive_count(), distinct(shape), scene.objects()[0].degenerate()];
        let mut expected = [1, 2, 3, 4].map(|column| row[column].parse::<usize>().unwrap());
        if welded {
            expected[0] = expected[2];
        }
        assert_eq!(found, expected, "{}: vertices, triangles, distinct, degenerate", &row[0]);
        rows += 1;
    }
    assert!(rows > 40, "{rows}");
}

#[test]
fn models_have_their_triangles() {
    let Some(folder) = data::folder() else { return };
    let file = |name: &str| match name {
        "env.obj" | "rob.obj" => format!("models/fcl_{name}"),
        "bunny.ply" => "models/bunny5k.ply".to_owned(),
        "torus.obj" => "models/ipc_torus.obj".to_owned(),
        name => format!("models/{name}"),
    };
    for path in data::files(&folder.join("rigid"), &["json"]) {
        let facts: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
        for (mesh, count) in [("meshA", "trisA"), ("meshB", "trisB")] {
            let name = facts[mesh].as_str().unwrap();
            assert_eq!(triangles(&folder.join(file(name))) as u64, facts[count].as_u64().unwrap(), "{name}");
        }
    }
}

#[test]
fn all_models_load() {
    let Some(folder) = data::folder() else { return };
    let mut loaded = 0;
    for name in ["models", "motion", "robots", "ccd"] {
        for path in data::files(&folder.join(name), &["obj", "stl", "ply"]) {
            assert!(triangles(&path) > 0, "{}", path.display());
            loaded += 1;
        }
    }
    assert!(loaded > 100, "{loaded}");
}

#[test]
fn truncated_files_never_panic() {
    let Some(folder) = data::folder() else { return };
    for path in data::files(&folder.join("bad_meshes"), &["obj", "stl", "ply"]) {
        let loaded = data::load_truncated("meshes", &path, 40);
        // Between lines, or between the solids of a text, the cut can't be told.
        let name = path.file_name().unwrap().to_string_lossy();
        let may_load = name.ends_with(".obj") || name.contains("_solid");
        assert!(may_load || loaded == 0, "{name}: {loaded}");
    }
}
