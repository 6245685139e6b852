//! Files written for a test.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use solid_scene::{LoadOptions, Pose, Scene, SceneError};

/// A folder of its own, gone when dropped.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Folder {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("solid-vrml-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).expect("the temporary folder can be written");
        Folder(path)
    }

    /// Writes a file of VRML97, given without its header.
    pub fn write(&self, name: &str, body: &str) -> PathBuf {
        self.write_bytes(name, format!("#VRML V2.0 utf8\n{body}").as_bytes())
    }

    pub fn write_bytes(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).expect("the temporary folder can be written");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Loads a file. The reader makes an error of a panic, which here is a panic again.
pub fn load_file(path: &Path) -> Result<Scene, SceneError> {
    let loaded = Scene::load(&[path], &LoadOptions::default());
    if let Err(error) = &loaded {
        assert!(!error.message.contains("the parser failed"), "{error}");
    }
    loaded
}

/// Loads a text of VRML97, given without its header; its first line is line 2.
pub fn load(body: &str) -> Result<Scene, SceneError> {
    load_file(&Folder::new().write("a.wrl", body))
}

pub fn scene(body: &str) -> Scene {
    load(body).unwrap_or_else(|error| panic!("{error}"))
}

/// The line and the message of the error that a text makes.
pub fn error(body: &str) -> (Option<usize>, String) {
    let error = load(body).expect_err("expected an error");
    (error.line, error.message)
}

pub fn pose(scene: &Scene, time: f64) -> Pose {
    let mut pose = Pose::default();
    scene.sample(time, &mut pose);
    pose
}

/// Where the origin of the first object is at a time.
pub fn origin(scene: &Scene, time: f64) -> DVec3 {
    pose(scene, time).objects[0].placement.translation
}

pub fn names(scene: &Scene) -> Vec<&str> {
    scene.objects().iter().map(|object| object.name()).collect()
}

pub fn warnings(scene: &Scene) -> Vec<&str> {
    scene.warnings().map(|(_, warning)| warning).collect()
}

#[track_caller]
pub fn assert_near(a: DVec3, b: DVec3) {
    assert!(a.distance(b) < 1e-6, "{a} is not {b}");
}
