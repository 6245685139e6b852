//! Reading a file from disk.

use std::path::Path;

use crate::error::SceneError;

/// The bytes of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    std::fs::read(path).map_err(|error| SceneError::new(path, None, format!("can't be read: {error}")))
}

/// The file's name without folder and extension, for objects that the file gives no name.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
