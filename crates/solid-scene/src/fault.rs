//! What is wrong in a file, before the file's name is put to it.

use std::path::Path;

use crate::error::SceneError;

/// A mistake in a file: the line, where the reader knows it, and what was expected there.
#[derive(Debug, PartialEq)]
pub(crate) struct Fault {
    line: Option<usize>,
    message: String,
}

impl Fault {
    /// A mistake at a line, counted from 1, where there are lines.
    pub fn new(line: Option<usize>, message: impl Into<String>) -> Self {
        Fault { line, message: message.into() }
    }

    /// A mistake at a line, counted from 1.
    pub fn at(line: usize, message: impl Into<String>) -> Self {
        Fault { line: Some(line), message: message.into() }
    }

    /// The mistake, in a part of the file.
    pub fn of(self, part: &str) -> Self {
        Fault { message: format!("{part}: {}", self.message), ..self }
    }

    /// The mistake, in a file.
    pub fn in_file(self, file: &Path) -> SceneError {
        SceneError::new(file, self.line, self.message)
    }

    #[cfg(test)]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    #[cfg(test)]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Fault { line: None, message }
    }
}

impl From<&str> for Fault {
    fn from(message: &str) -> Self {
        message.to_owned().into()
    }
}

/// A result whose error is without the file's name.
pub(crate) type Result<T> = std::result::Result<T, Fault>;
