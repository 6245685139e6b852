//! Reading a file from disk.

use std::fs::Metadata;
use std::path::{Path, PathBuf};

use crate::error::SceneError;

/// What a file has in its place when Git LFS has not fetched it.
pub(crate) const IS_POINTER: &str =
    "is a pointer of Git LFS; expected the file that it stands for, so fetch that first (git lfs pull)";

/// The bytes of a regular file, which are no text in UTF-16, and no pointer to what is elsewhere.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    metadata(path)?;
    let bytes = std::fs::read(path).map_err(|error| unreadable(path, &error))?;
    if is_utf16(&bytes) {
        return Err(SceneError::new(
            path,
            None,
            "is text in UTF-16; expected UTF-8, so save it as that first",
        ));
    }
    if is_pointer(&bytes) {
        return Err(SceneError::new(path, None, IS_POINTER));
    }
    Ok(bytes)
}

/// Whether bytes are a pointer of Git LFS: how its specification has each begin.
pub(crate) fn is_pointer(bytes: &[u8]) -> bool {
    bytes.starts_with(b"version https://git-lfs.github.com/spec/v1\n")
}

/// Whether bytes are a byte order mark of UTF-16 and then, as in all formats here that are text, a letter of ASCII; so that hardly
/// any header of a binary file is taken for it.
fn is_utf16(bytes: &[u8]) -> bool {
    matches!(bytes, [0xff, 0xfe, 1..0x80, 0, ..] | [0xfe, 0xff, 0, 1..0x80, ..])
}

/// What is known of a regular file. Others are refused: a pipe could keep us waiting, and a device may have no end.
pub(crate) fn metadata(path: &Path) -> Result<Metadata, SceneError> {
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    match () {
        _ if metadata.is_file() => Ok(metadata),
        _ if metadata.is_dir() => Err(SceneError::new(path, None, "is a folder; expected a file")),
        _ => Err(SceneError::new(path, None, "is not a regular file")),
    }
}

/// The same path for the same file.
pub(crate) fn canonical(file: &Path) -> PathBuf {
    file.canonicalize().unwrap_or_else(|_| file.to_owned())
}

fn unreadable(path: &Path, error: &std::io::Error) -> SceneError {
    SceneError::new(path, None, format!("can't be read: {error}"))
}

/// The file's name without folder and extension, for objects that the file gives no name.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
