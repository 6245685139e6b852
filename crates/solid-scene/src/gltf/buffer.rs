//! Loading buffers.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use gltf::json::Buffer;

use super::uri::{Source, resolve};
use crate::fault::Result;
use crate::file::{IS_POINTER, is_pointer};
use crate::text::{counted, quoted};

/// The bytes of a buffer, `byteLength` of them. `binary` is the binary part of a `.glb`, which buffer 0 is when it has
/// no URI. A file that it is in is added to `files`.
pub(super) fn load(
    index: usize,
    buffer: &Buffer,
    binary: &mut Option<Vec<u8>>,
    folder: &Path,
    files: &mut Vec<PathBuf>,
) -> Result<Vec<u8>> {
    let mut name = name(index, buffer);
    let needed = buffer.byte_length.0;
    let mut bytes = match &buffer.uri {
        None if index == 0 => binary.take().ok_or_else(|| format!("{name} has no URI and no binary part"))?,
        None => return Err(format!("{name} has no URI").into()),
        Some(uri) => match resolve(uri).map_err(|wrong| format!("{name} {wrong}"))? {
            Source::Bytes(bytes) => bytes,
            Source::File(path) => {
                // A data URI without its first letters is long.
                name = format!("{name}: `{}`", quoted(&path.to_string_lossy()));
                let file = folder.join(&path);
                let bytes = read(&file, needed).map_err(|error| format!("{name} can't be read: {error}"))?;
                files.push(file);
                bytes
            }
        },
    };
    if is_pointer(&bytes) {
        return Err(format!("{name} {IS_POINTER}").into());
    }
    if (bytes.len() as u64) < needed {
        return Err(format!("{name} has {}; it should have {needed}", counted(bytes.len(), "byte")).into());
    }
    // The rest is padding.
    bytes.truncate(needed as usize);
    Ok(bytes)
}

/// At most `limit` bytes of a file; a pipe, which could keep us waiting, is none.
fn read(path: &Path, limit: u64) -> std::io::Result<Vec<u8>> {
    if !path.metadata()?.is_file() {
        return Err(std::io::Error::other("not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(limit).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn name(index: usize, buffer: &Buffer) -> String {
    match &buffer.name {
        Some(name) => format!("buffer {index} (`{}`)", quoted(name)),
        None => format!("buffer {index}"),
    }
}
