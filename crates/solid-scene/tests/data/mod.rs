//! The folder of test files that the environment variable `SOLID_DATA` names.

use std::path::{Path, PathBuf};

use solid_scene::{LoadOptions, Scene, SceneError};

/// The folder; without it the test prints a line and passes.
pub fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("SOLID_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("passed over: SOLID_DATA does not name the folder of test files");
    }
    folder
}

/// Loads a file with options as they come.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    Scene::load(&[path], &LoadOptions::default())
}

/// All files below a folder with one of the extensions, in order.
pub fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
            if path.is_dir() {
                waiting.push(path);
            } else if extension.is_some_and(|extension| extensions.contains(&extension.as_str())) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}
