//! Known answers: the folder of published cases and real models that the environment variable `SOLID_DATA` names.

use std::path::{Path, PathBuf};

/// A file or folder of the known answers, by its path in the folder that `SOLID_DATA` names; a relative folder is meant from
/// the root of the workspace. `None` when the variable is not set: then a line says what is not checked, and the test that
/// asked has nothing to do.
///
/// # Panics
/// When the variable is set and there is no such file: then nothing would be checked where something should be.
///
/// ```
/// use solid_oracle::known_answers;
/// assert_eq!(known_answers("convex").is_some(), std::env::var_os("SOLID_DATA").is_some());
/// ```
pub fn known_answers(name: &str) -> Option<PathBuf> {
    let Some(root) = std::env::var_os("SOLID_DATA") else {
        say(name);
        return None;
    };
    // Tests run in the folder of their crate.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(root).join(name);
    assert!(path.exists(), "SOLID_DATA is set, but there is no {}", path.display());
    Some(path)
}

#[allow(clippy::print_stdout, reason = "what a test passes over, its reader must see")]
fn say(name: &str) {
    println!("SOLID_DATA is not set: {name:?} is not checked");
}
