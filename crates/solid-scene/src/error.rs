//! What can be wrong with a scene file.

use std::fmt;
use std::path::{Path, PathBuf};

/// A scene that can't be loaded: which file, where in it, and what was expected.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1, where the format has lines and the reader knows it.
    pub line: Option<usize>,
    /// What is wrong and what was expected.
    pub message: String,
}

impl SceneError {
    pub(crate) fn new(file: &Path, line: Option<usize>, message: impl Into<String>) -> Self {
        SceneError { file: file.to_owned(), line, message: message.into() }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for SceneError {}
