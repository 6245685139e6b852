//! Writing: to a file or to standard output, where the reader may leave early.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

use anyhow::{Context, Result};

/// A buffered output, whose errors name it. To be flushed in the end, for the last of them.
pub type Output = BufWriter<Named<Box<dyn Write>>>;

/// Whether a path stands for standard output.
pub fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Opens a file for writing, or standard output for `-`.
pub fn open(path: &Path) -> Result<Output> {
    if is_stdout(path) {
        return Ok(stdout());
    }
    let name = path.display().to_string();
    let file = File::create(path).with_context(|| format!("{name}: can't be written"))?;
    Ok(output(name, Box::new(file)))
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

    #[test]
    fn other_errors_name_the_output() {
        let error = named(ErrorKind::StorageFull).write_all(b"text").expect_err("the disk is full");
        assert!(error.to_string().starts_with("out.json: "), "{error}");
    }
}
