//! glTF files of others, against what two other programs computed of them.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test")]

mod data;

use std::path::Path;

use glam::DVec3;
use solid_scene::{LoadOptions, Pose, Scene, SceneError};
use solid3d::{Aabb, ShapeKind};

/// The reference was computed in single precision in places.
const RELATIVE: f64 = 1e-5;

fn load_animation(path: &Path, animation: &str) -> Result<Scene, SceneError> {
    let mut options = LoadOptions::default();
    options.animation = Some(animation.to_owned()).filter(|name| !name.is_empty());
    Scene::load(&[path], &options)
}

/// The vertices of all objects at a time, in world space.
fn world_vertices(scene: &Scene, time: f64) -> Vec<DVec3> {
    let mut pose = Pose::default();
    scene.sample(time, &mut pose);
    let mut vertices = Vec::new();
    for (object, pose) in scene.objects().iter().zip(&pose.objects) {
        let own = object.shape().vertices().unwrap();
        let positions = if pose.positions.is_empty() { own } else { &pose.positions };
        assert_eq!(positions.len(), own.len());
        vertices.extend(positions.iter().map(|&p| pose.placement.transform_point3(p)));
    }
    vertices
}

fn mean(vertices: &[DVec3]) -> DVec3 {
    vertices.iter().sum::<DVec3>() / vertices.len() as f64
}

#[test]
fn vertices_are_where_other_programs_have_them() {
    let Some(folder) = data::folder() else { return };
    let mut worst = (0.0f64, String::new());
    let mut rows = 0;
    for row in csv::Reader::from_path(folder.join("gltf/expected.csv")).unwrap().into_records() {
        let row = row.unwrap();
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let vector = |column: usize| DVec3::new(number(column), number(column + 1), number(column + 2));
        let time = if row[3].is_empty() { 0.0 } else { number(3) };
        let scene = load_animation(&folder.join(&row[0]), &row[1]).unwrap();
        let vertices = world_vertices(&scene, time);
        // Primitives that name the same positions share them here; the reference repeats them.
        assert_eq!(row[4].parse::<usize>().unwrap() % vertices.len(), 0, "{row:?}");
        let bounds = Aabb::of_points(vertices.iter().copied());
        let rms = mean(&vertices.iter().map(|v| v * v).collect::<Vec<_>>()).element_sum().sqrt();
        let differences = [
            (bounds.min - vector(5)).length(),
            (bounds.max - vector(8)).length(),
            (mean(&vertices) - vector(11)).length(),
            (rms - number(14)).abs(),
        ];
        let difference = differences.into_iter().fold(0.0, f64::max) / number(14);
        assert!(difference < RELATIVE, "{difference:e}: {row:?}");
        if difference > worst.0 {
            worst = (difference, format!("{} at {time}", &row[0]));
        }
        rows += 1;
    }
    println!("{rows} rows; the worst relative difference is {:.1e}, of {}", worst.0, worst.1);
    assert!(rows > 100);
}

#[test]
fn primitives_have_their_modes() {
    let Some(folder) = data::folder() else { return };
    // By the first of points, lines, loop, strip, triangle strip, fan and triangles; then the same with indices.
    let expected = [1024, 4, 4, 4, 2, 2, 2, 1024, 4, 4, 4, 2, 2, 2, 2, 2];
    for (number, expected) in expected.into_iter().enumerate() {
        let path = folder.join(format!("gltf/primitive_modes/Mesh_PrimitiveMode_{number:02}.gltf"));
        let scene = data::load(&path).unwrap();
        let shape = scene.objects()[0].shape();
        assert_eq!(shape.primitive_count(), expected, "mode {number}");
        let is_mesh = matches!(number, 4..=6 | 11..);
        assert_eq!(shape.kind(), if is_mesh { ShapeKind::Mesh } else { ShapeKind::Complex }, "mode {number}");
    }
}

#[test]
fn only_the_bad_files_are_refused() {
    let Some(folder) = data::folder() else { return };
    let mut refused = Vec::new();
    for path in data::files(&folder.join("gltf"), &["gltf", "glb"]) {
        if let Err(error) = data::load(&path) {
            println!("{error}");
            refused.push(path.strip_prefix(&folder).unwrap().to_str().unwrap().replace('\\', "/"));
        }
    }
    let expected = [
        "gltf/bad/AllIndicesOutOfRange.gltf",
        "gltf/bad/BoxWithInfinites.glb",
        "gltf/bad/IndexOutOfRange.gltf",
    ];
    assert_eq!(refused, expected);
}

#[test]
fn instances_share_their_shape() {
    let Some(folder) = data::folder() else { return };
    let scene = data::load(&folder.join("gltf/SimpleMeshes/SimpleMeshes.gltf")).unwrap();
    let [a, b] = scene.objects() else { panic!("expected two objects") };
    assert_eq!(a.shape().vertices().unwrap().as_ptr(), b.shape().vertices().unwrap().as_ptr());
    assert!(!a.on_root_path_with(b));
    assert_eq!(scene.unit(0), "metre");
}

#[test]
fn the_choice_of_an_animation() {
    let Some(folder) = data::folder() else { return };
    let fox = folder.join("gltf/Fox.glb");
    let first = data::load(&fox).unwrap();
    let warnings: Vec<_> = first.warnings().map(|(_, warning)| warning).collect();
    assert_eq!(warnings, ["plays the animation `Survey`, not `Walk`, `Run`"]);
    let run = load_animation(&fox, "Run").unwrap();
    assert_eq!(run.warnings().count(), 0);
    assert_eq!(run.duration(), load_animation(&fox, "2").unwrap().duration());
    assert!(run.duration() < first.duration());
    let error = load_animation(&fox, "Swim").unwrap_err();
    let expected = "there is no animation `Swim`; the animations of the file are `Survey`, `Walk`, `Run`";
    assert_eq!(error.message, expected);
}

/// The pair that was baked in single precision: 16 frames over two rounds of the fox's run, the last as the first.
#[test]
fn the_baked_fox_runs() {
    let Some(folder) = data::folder() else { return };
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().unwrap()));
    let bytes = std::fs::read(folder.join("deform/fox_vs_bunny_A.f32.bin")).unwrap();
    let baked: Vec<f64> = bytes.chunks_exact(4).map(number).collect();
    let bytes = std::fs::read(folder.join("deform/fox_vs_bunny_A_tris.u32.bin")).unwrap();
    let indices: Vec<u32> =
        bytes.chunks_exact(4).map(|index| u32::from_le_bytes(index.try_into().unwrap())).collect();
    let scene = load_animation(&folder.join("gltf/Fox.glb"), "Run").unwrap();
    assert_eq!(scene.objects()[0].shape().triangles().unwrap().as_flattened(), indices);
    for (frame, baked) in baked.chunks_exact(3 * 1728).enumerate() {
        let time = (frame as f64 * 2.0 / 15.0).fract() * scene.duration();
        let vertices = world_vertices(&scene, time);
        let baked = baked.chunks_exact(3).map(DVec3::from_slice);
        let distance = vertices.iter().zip(baked).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        // The fox is 155 long, so that a unit in the last place of its baked coordinates is 8e-6.
        assert!(distance < 2e-5, "frame {frame}: {distance}");
    }
}

#[test]
fn truncated_files_are_refused() {
    let Some(folder) = data::folder() else { return };
    for path in data::files(&folder.join("gltf"), &["glb", "gltf"]) {
        assert_eq!(data::load_truncated("gltf", &path, 40), 0, "{}", path.display());
    }
}
