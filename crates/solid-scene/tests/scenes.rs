//! The example scenes of the project: they are as generated, and collide as `scenes/README.md` says.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

#[path = "../examples/make_scenes/generate/mod.rs"]
mod generate;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use solid_scene::{LoadOptions, Pose, Scene, SceneObject};
use solid3d::{ObjectId, Response, World};

const FPS: f64 = 30.0;

/// Two names.
type Pair = (String, String);

/// What collides at least once, each pair by the names of its objects in the order of the scene.
struct Played {
    duration: f64,
    names: Vec<String>,
    collided: BTreeSet<Pair>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// Plays a scene frame by frame through its duration, both ends included.
fn play(name: &str) -> Played {
    let scene = Scene::load(&[folder().join(name)], &LoadOptions::default()).unwrap();
    assert_eq!(scene.warnings().collect::<Vec<_>>(), [], "{name}");
    assert!(scene.objects().iter().all(|object| object.degenerate() == 0), "{name}");
    let names: Vec<String> = scene.objects().iter().map(|object| object.name().to_owned()).collect();
    let (mut pose, mut collided) = (Pose::default(), BTreeSet::new());
    scene.sample(0.0, &mut pose);
    let (mut world, ids) = world(&scene, &pose);
    let name_of = |id: ObjectId| names[ids.iter().position(|&other| other == id).unwrap()].clone();
    for frame in 0..=(scene.duration() * FPS).round() as u32 {
        scene.sample(f64::from(frame) / FPS, &mut pose);
        for (&id, object) in ids.iter().zip(&pose.objects) {
            world.set_placement(id, object.placement).unwrap();
            if !object.positions.is_empty() {
                world.deform(id, &object.positions).unwrap();
            }
        }
        collided.extend(world.test().iter().map(|collision| (name_of(collision.a), name_of(collision.b))));
        world.proceed();
    }
    Played { duration: scene.duration(), names, collided }
}

/// A world of the scene's objects, without the pairs on one root path.
fn world(scene: &Scene, pose: &Pose) -> (World, Vec<ObjectId>) {
    let mut world = World::new();
    let objects = scene.objects();
    let placed = objects.iter().zip(&pose.objects);
    let ids: Vec<_> =
        placed.map(|(object, pose)| world.add(object.shape(), pose.placement).unwrap()).collect();
    for (i, a) in objects.iter().enumerate() {
        for (j, _) in objects[..i].iter().enumerate().filter(|(_, b)| a.on_root_path_with(b)) {
            world.set_pair_response(ids[i], ids[j], Response::Ignore).unwrap();
        }
    }
    (world, ids)
}

/// Checks what a scene holds, and that exactly these pairs collide: all others never do.
fn check(name: &str, duration: f64, objects: &[&str], pairs: &[(&str, &str)]) {
    let played = play(name);
    assert_eq!(played.duration, duration, "{name}");
    assert_eq!(played.names, objects, "{name}");
    let expected: BTreeSet<_> = pairs.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect();
    assert_eq!(played.collided, expected, "{name}");
}

#[test]
fn generated_scenes_are_as_generated() {
    let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scenes");
    generate::write_all(&fresh).unwrap();
    for (name, text) in generate::all() {
        let [written, shipped] = [&fresh, &folder()].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(written == text.as_bytes() && written == shipped, "{name} differs; run make_scenes");
    }
}

#[test]
fn gltf_scenes_are_valid() {
    for name in ["robot_cell.gltf", "deform.gltf"] {
        // Opening validates.
        gltf::Gltf::open(folder().join(name)).unwrap();
    }
}

/// But for the robot cell, where the next part comes, the shooting range, where the next shot is fired, and the channel, where the
/// next marble is.
#[test]
fn a_scene_ends_as_it_began() {
    for name in ["naval_warfare.wrl", "cloth.wrl", "deform.gltf", "blocks.wrl"] {
        let scene = Scene::load(&[folder().join(name)], &LoadOptions::default()).unwrap();
        let mut poses = [Pose::default(), Pose::default()];
        scene.sample(0.0, &mut poses[0]);
        scene.sample(scene.duration(), &mut poses[1]);
        let [first, last] = poses;
        for ((object, a), b) in scene.objects().iter().zip(&first.objects).zip(&last.objects) {
            assert!(a.placement.abs_diff_eq(b.placement, 1e-4), "{name}: {}", object.name());
            let mut positions = a.positions.iter().zip(&b.positions);
            assert!(positions.all(|(a, b)| a.abs_diff_eq(*b, 1e-4)), "{name}: {}", object.name());
        }
    }
}

#[test]
fn naval_warfare() {
    let objects = [
        "cruiser",
        "destroyer",
        "frigate",
        "sweeper",
        "mine_1",
        "mine_2",
        "mine_3",
        "mine_4",
        "mine_5",
        "iceberg_1",
        "iceberg_2",
    ];
    let pairs = [
        ("cruiser", "destroyer"),
        ("cruiser", "mine_1"),
        ("frigate", "iceberg_1"),
        ("sweeper", "mine_2"),
        ("sweeper", "mine_3"),
        ("mine_4", "mine_5"),
        ("mine_4", "iceberg_2"),
    ];
    check("naval_warfare.wrl", 10.0, &objects, &pairs);
}

#[test]
fn robot_cell() {
    let objects = [
        "table",
        "conveyor",
        "fence_side",
        "fence_back",
        "part",
        "base",
        "turret",
        "upper_arm",
        "forearm",
        "forearm_roll",
        "wrist",
        "flange",
        "gripper",
        "finger_left",
        "finger_right",
    ];
    let pairs = [("fence_side", "finger_left"), ("fence_side", "finger_right")];
    check("robot_cell.gltf", 8.0, &objects, &pairs);
}

#[test]
fn cloth() {
    check("cloth.wrl", 6.0, &["table", "ball", "cloth"], &[("ball", "cloth"), ("table", "cloth")]);
}

#[test]
fn deform() {
    let objects = ["wall", "block", "beam", "drumskin", "spike", "frame"];
    check("deform.gltf", 4.0, &objects, &[("block", "beam"), ("drumskin", "spike")]);
}

#[test]
fn shooting_range() {
    // The glass is hit between frames.
    let objects = ["pane_1", "pane_2", "bottle", "plate", "bullet"];
    check("shooting_range.wrl", 2.0, &objects, &[("plate", "bullet")]);
}

#[test]
fn blocks() {
    let objects = ["floor", "block", "pillar", "plank", "ball", "rafter"];
    let pairs = [
        ("floor", "block"),
        ("floor", "pillar"),
        ("floor", "ball"),
        ("floor", "rafter"),
        ("block", "plank"),
        ("pillar", "plank"),
    ];
    check("blocks.wrl", 4.0, &objects, &pairs);
}

#[test]
fn channel() {
    check("channel.wrl", 4.0, &["channel", "marble"], &[("channel", "marble")]);
}

/// What is on one root path in a file has nothing to do with another file, if only another copy.
#[test]
fn root_paths_are_of_one_file() {
    let file = folder().join("robot_cell.gltf");
    let scene = Scene::load(&[&file, &file], &LoadOptions::default()).unwrap();
    let (one, other) = scene.objects().split_at(scene.objects().len() / 2);
    let related = |a: &[SceneObject], b: &[SceneObject]| {
        a.iter().map(|a| b.iter().filter(|b| a.on_root_path_with(b)).count()).sum::<usize>()
    };
    assert!(related(one, one) > one.len() && related(one, one) == related(other, other));
    assert_eq!(related(one, other), 0);
}
