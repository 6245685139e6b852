//! Writing: to a file or to standard output, where the reader may leave early.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use tempfile::NamedTempFile;

/// A buffered output, whose errors name it. To be flushed in the end, for the last of them.
pub type Output = BufWriter<Named<Box<dyn Write>>>;

/// How many links lead from one to the next: as many as Linux follows.
const LINKS_MAX: usize = 40;

/// Whether a path stands for standard output.
pub fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Opens a file for writing, or standard output for `-`. A file takes its name when it is flushed in the end: a run that
/// fails on the way leaves what was there before.
pub fn open(path: &Path) -> Result<Output> {
    if is_stdout(path) {
        return Ok(stdout());
    }
    let name = path.display().to_string();
    let inner = create(path).with_context(|| format!("{name}: can't be written"))?;
    Ok(output(name, inner))
}

/// Where what is written to a path comes to be: the file that it names, by way of links, also while it is not there.
pub fn destination(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..LINKS_MAX {
        let Ok(target) = path.read_link() else { break };
        path = folder(&path).join(target);
    }
    let new = || Some(folder(&path).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(new).unwrap_or_else(|| path.clone())
}

/// The folder that a path is in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Devices and pipes are written directly; anything else through a file beside it.
fn create(path: &Path) -> io::Result<Box<dyn Write>> {
    // Also finds out whether an existing file may be written.
    match OpenOptions::new().write(true).open(path) {
        Ok(file) if !file.metadata()?.is_file() => return Ok(Box::new(file)),
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let path = destination(path);
    let folder = folder(&path);
    if !folder.is_dir() {
        return Err(io::Error::new(ErrorKind::NotFound, format!("there is no folder {}", folder.display())));
    }
    // Its errors name the file beside it, which is no concern of the user.
    let file = Unfinished::in_folder(folder).map_err(|error| error.kind())?;
    Ok(Box::new(Staged { file: Some(file), path }))
}

/// A file that takes its name when it is flushed, once.
struct Staged {
    file: Option<Unfinished>,
    path: PathBuf,
}

impl Write for Staged {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.as_file_mut().write(buffer),
            None => Err(io::Error::other("written after its end")),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.take().map_or(Ok(()), |file| file.persist(&self.path))
    }
}

/// A file that has not got its name yet.
enum Unfinished {
    /// It has none at all: nothing is left of it, however the run ends.
    Unnamed(File),
    /// It has another, beside: where a file cannot be without. A run that is killed leaves it.
    Beside(NamedTempFile),
}

impl Unfinished {
    fn in_folder(folder: &Path) -> io::Result<Self> {
        unnamed(folder).map_or_else(
            || Ok(Unfinished::Beside(names_beside().tempfile_in(folder)?)),
            |file| Ok(Unfinished::Unnamed(file)),
        )
    }

    fn as_file_mut(&mut self) -> &mut File {
        match self {
            Unfinished::Unnamed(file) => file,
            Unfinished::Beside(file) => file.as_file_mut(),
        }
    }

    fn persist(self, path: &Path) -> io::Result<()> {
        match self {
            // Only a name takes the place of another.
            Unfinished::Unnamed(file) => {
                names_beside().make_in(folder(path), |beside| link(&file, beside))?.persist(path)?;
            }
            Unfinished::Beside(file) => drop(file.persist(path)?),
        }
        Ok(())
    }
}

fn names_beside() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".solid-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

/// Where the system lists what a process has open: by this a file without a name gets one.
#[cfg(target_os = "linux")]
const OPEN_FILES: &str = "/proc/self/fd";

/// A file in a folder, without a name; `None` where there is no such thing.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags};
    if !Path::new(OPEN_FILES).is_dir() {
        return None;
    }
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    Some(rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666)).ok()?.into())
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

/// Gives a file that has no name a new one.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD};
    let open = format!("{OPEN_FILES}/{}", std::os::fd::AsRawFd::as_raw_fd(file));
    Ok(rustix::fs::linkat(CWD, open, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

/// Standard output.
pub fn stdout() -> Output {
    output("standard output".to_owned(), Box::new(io::stdout().lock()))
}

/// Standard error.
pub fn stderr() -> Output {
    output("standard error".to_owned(), Box::new(io::stderr().lock()))
}

fn output(name: String, inner: Box<dyn Write>) -> Output {
    BufWriter::new(Named { name, inner, deserted: false })
}

/// Names what is written to in its errors. A reader that leaves is no error: what was found stays found, and the exit
/// status shall tell it, so the rest is written to nobody.
pub struct Named<W> {
    name: String,
    inner: W,
    deserted: bool,
}

impl<W: Write> Named<W> {
    fn attempt<T>(&mut self, otherwise: T, write: impl FnOnce(&mut W) -> io::Result<T>) -> io::Result<T> {
        if self.deserted {
            return Ok(otherwise);
        }
        match write(&mut self.inner) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.deserted = true;
                Ok(otherwise)
            }
            // A writer is called again after this one; it must keep its identity.
            Err(error) if error.kind() == ErrorKind::Interrupted => Err(error),
            Err(error) => Err(io::Error::new(error.kind(), format!("{}: {error}", self.name))),
            Ok(value) => Ok(value),
        }
    }
}

impl<W: Write> Write for Named<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.attempt(buffer.len(), |inner| inner.write(buffer))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.attempt((), W::flush)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_finished_leaves_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("out.json");
        std::fs::write(&path, "before").expect("a file");
        let read = || std::fs::read_to_string(&path).expect("a file");
        open(&path).expect("it opens").write_all(b"half").expect("it is written");
        assert_eq!(read(), "before");
        let mut output = open(&path).expect("it opens");
        output.write_all(b"after").and_then(|()| output.flush()).expect("it is written");
        assert_eq!(read(), "after");
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_is_not_finished_has_no_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("out.json");
        let files = || std::fs::read_dir(&folder).expect("a folder").count();
        if unnamed(folder.path()).is_none() {
            eprintln!("passed over: every file of {} has a name", folder.path().display());
            return;
        }
        let mut output = open(&path).expect("it opens");
        output.get_mut().write_all(b"whole").expect("it is written");
        assert_eq!(files(), 0);
        output.flush().expect("it is written");
        assert_eq!((files(), std::fs::read(&path).expect("a file").as_slice()), (1, b"whole".as_slice()));
    }

    struct Failing(ErrorKind);

    impl Write for Failing {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Err(self.0.into())
        }
    }

    fn named(kind: ErrorKind) -> Named<Failing> {
        Named { name: "out.json".to_owned(), inner: Failing(kind), deserted: false }
    }

    #[test]
    fn a_reader_that_leaves_is_no_error() {
        let mut output = named(ErrorKind::BrokenPipe);
        assert!(output.write_all(b"first").is_ok());
        assert!(output.write_all(b"second").is_ok());
        assert!(output.flush().is_ok());
    }

    /// It is not asked again: a new reader of a named pipe would get the rest without its beginning.
    #[test]
    fn what_comes_after_a_reader_that_left_is_written_to_nobody() {
        /// A pipe whose first reader leaves at once, and the second stays.
        #[derive(Default)]
        struct TwoReaders(Vec<Vec<u8>>);
        impl Write for TwoReaders {
            fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
                self.0.push(buffer.to_vec());
                if self.0.len() == 1 { Err(ErrorKind::BrokenPipe.into()) } else { Ok(buffer.len()) }
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut output = Named { name: "pipe".to_owned(), inner: TwoReaders::default(), deserted: false };
        for text in ["first", "second"] {
            output.write_all(text.as_bytes()).expect("a reader that leaves is no error");
        }
        assert_eq!(output.inner.0, [b"first"]);
    }

    #[test]
    fn other_errors_name_the_output() {
        let error = named(ErrorKind::StorageFull).write_all(b"text").expect_err("the disk is full");
        assert!(error.to_string().starts_with("out.json: "), "{error}");
    }
}
