//! Loading buffers.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gltf::json::Buffer;

use super::document::find;
use super::uri::{Source, resolve};
use crate::fault::Result;
use crate::file::{IS_POINTER, canonical, is_pointer};
use crate::text::{counted, quoted};

/// The buffers of a file.
#[derive(Default)]
pub(super) struct Buffers {
    all: Vec<Bytes>,
    /// The files that they are in, each once.
    pub files: Vec<PathBuf>,
    /// How many bytes they take in memory.
    pub size: u64,
    /// What was read of files.
    read: HashMap<PathBuf, Rc<Vec<u8>>>,
}

/// The bytes of a buffer: the first so many of some, which buffers in one file share.
struct Bytes {
    bytes: Rc<Vec<u8>>,
    length: usize,
}

impl Buffers {
    /// Loads buffers, of each `byteLength` bytes. `binary` is the binary part of a `.glb`, which buffer 0 is when it has no URI. Those in
    /// files are looked for in `folder`; a file is read once, however many buffers name it.
    pub fn load(described: &[Buffer], binary: Option<Vec<u8>>, folder: &Path) -> Result<Buffers> {
        let sources = described.iter().enumerate().map(|(index, buffer)| source(index, buffer));
        let sources = sources.collect::<Result<Vec<_>>>()?;
        let mut lengths = HashMap::new();
        for (buffer, source) in described.iter().zip(&sources) {
            if let Some(Source::File(path)) = source {
                let length: &mut u64 = lengths.entry(canonical(&folder.join(path))).or_default();
                *length = buffer.byte_length.0.max(*length);
            }
        }
        let (mut buffers, mut binary) = (Buffers::default(), binary);
        for ((index, buffer), source) in described.iter().enumerate().zip(sources) {
            let mut name = name(index, buffer);
            let bytes = match source {
                None if index == 0 => {
                    let binary = binary.take();
                    buffers.keep(binary.ok_or_else(|| format!("{name} has no URI and no binary part"))?)
                }
                None => return Err(format!("{name} has no URI").into()),
                Some(Source::Bytes(bytes)) => buffers.keep(bytes),
                Some(Source::File(path)) => {
                    // A data URI without its first letters is long.
                    name = format!("{name}: `{}`", quoted(&path.to_string_lossy()));
                    let bytes = buffers.of_file(folder.join(&path), &lengths);
                    bytes.map_err(|error| format!("{name} can't be read: {error}"))?
                }
            };
            buffers.add(&name, bytes, buffer.byte_length.0)?;
        }
        Ok(buffers)
    }

    /// The bytes of a file, at most as many as is told of it.
    fn of_file(&mut self, file: PathBuf, lengths: &HashMap<PathBuf, u64>) -> std::io::Result<Rc<Vec<u8>>> {
        let key = canonical(&file);
        if let Some(bytes) = self.read.get(&key) {
            return Ok(bytes.clone());
        }
        let bytes = read(&file, lengths.get(&key).copied().unwrap_or(0))?;
        let bytes = self.keep(bytes);
        self.files.push(file);
        self.read.insert(key, bytes.clone());
        Ok(bytes)
    }

    /// Counts bytes that are kept.
    fn keep(&mut self, bytes: Vec<u8>) -> Rc<Vec<u8>> {
        self.size += bytes.len() as u64;
        bytes.into()
    }

    /// Adds a buffer that should have so many bytes; the rest is padding, or another's.
    fn add(&mut self, name: &str, bytes: Rc<Vec<u8>>, needed: u64) -> Result<()> {
        if is_pointer(&bytes) {
            return Err(format!("{name} {IS_POINTER}").into());
        }
        match usize::try_from(needed) {
            Ok(length) if length <= bytes.len() => self.all.push(Bytes { bytes, length }),
            _ => {
                let has = counted(bytes.len(), "byte");
                return Err(format!("{name} has {has}; it should have {needed}").into());
            }
        }
        Ok(())
    }

    /// The bytes of each.
    pub fn bytes(&self, index: usize) -> Result<&[u8]> {
        find("buffer", &self.all, index).map(|Bytes { bytes, length }| &bytes[..*length])
    }
}

/// Where the bytes of a buffer are, by its URI, if it has one.
fn source(index: usize, buffer: &Buffer) -> Result<Option<Source>> {
    let source = buffer.uri.as_deref().map(resolve).transpose();
    source.map_err(|wrong| format!("{} {wrong}", name(index, buffer)).into())
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
