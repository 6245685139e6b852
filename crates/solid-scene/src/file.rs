//! Reading a file from disk.

use std::fs::Metadata;
use std::path::Path;

use crate::error::SceneError;

/// The bytes of a regular file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    metadata(path)?;
    std::fs::read(path).map_err(|error| unreadable(path, &error))
}

/// What is known of a regular file. Others are refused: a pipe could keep us waiting, and a device may have no end.
pub(crate) fn metadata(path: &Path) -> Result<Metadata, SceneError> {
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    if metadata.is_file() { Ok(metadata) } else { Err(SceneError::new(path, None, "is not a regular file")) }
}

fn unreadable(path: &Path, error: &std::io::Error) -> SceneError {
    SceneError::new(path, None, format!("can't be read: {error}"))
}

/// The file's name without folder and extension, for objects that the file gives no name.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
