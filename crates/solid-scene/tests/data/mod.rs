//! The folder of test files that the environment variable `SOLID_DATA` names.

use std::path::{Path, PathBuf};

use solid_scene::{LoadOptions, Scene, SceneError};

/// The folder; `None` when there is none.
pub fn folder() -> Option<PathBuf> {
    solid_oracle::known_answers("")
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

/// Cuts files off at places all over them and loads what is left. Gives how many of them load: no cut may panic.
#[allow(dead_code, reason = "each test file is a crate of its own")]
pub fn load_truncated(name: &str, path: &Path, cuts: usize) -> usize {
    let bytes = std::fs::read(path).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("cut").with_extension(path.extension().unwrap());
    let mut loaded = 0;
    for cut in 0..cuts {
        std::fs::write(&file, &bytes[..bytes.len() * cut / cuts]).unwrap();
        loaded += usize::from(load(&file).is_ok());
    }
    loaded
}
