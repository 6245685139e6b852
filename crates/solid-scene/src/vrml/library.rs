//! The files of a scene: the one that is loaded, and those that it inlines.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use percent_encoding::percent_decode_str;

use super::document::Document;
use super::text;
use crate::error::SceneError;
use crate::file::canonical;
use crate::text::quoted;
use crate::warnings::Warnings;

/// Parsed files, each once.
#[derive(Debug, Default)]
pub(super) struct Library {
    documents: HashMap<PathBuf, Rc<Document>>,
    /// What the URLs that were looked at lead to, by the folder that they are relative to; `None` for nothing. The disk is asked once for each, as
    /// one may be inlined a million times.
    located: HashMap<PathBuf, HashMap<String, Option<Located>>>,
}

/// The path that a URL names, and what follows the `#`.
#[derive(Clone, Debug, PartialEq)]
struct Target {
    file: PathBuf,
    fragment: Option<String>,
}

/// A [`Target`] that is there.
#[derive(Clone, Debug)]
pub(super) struct Located {
    /// The path, by way of the file that names it.
    pub file: Rc<Path>,
    /// The same path for the same file.
    pub key: Rc<Path>,
    pub fragment: Option<String>,
}

impl Library {
    /// The files, in the order of their paths.
    pub fn into_files(self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.documents.into_keys().collect();
        files.sort_unstable();
        files
    }

    /// A file, parsed; `key` is its canonical path.
    pub fn open(
        &mut self,
        file: &Path,
        key: &Path,
        warnings: &mut Warnings,
    ) -> Result<Rc<Document>, SceneError> {
        if let Some(document) = self.documents.get(key) {
            return Ok(document.clone());
        }
        let nodes_before = self.documents.values().map(|document| document.written).sum();
        // Whoever shows a warning shows the scene's file with it, which is the first.
        let warn = |warning: String| match self.documents.is_empty() {
            true => warnings.add(warning),
            false => warnings.add(format!("{}: {warning}", file.display())),
        };
        let document = Rc::new(Document::parse(file, &text::read(file)?, nodes_before, warn)?);
        self.documents.insert(key.to_owned(), document.clone());
        Ok(document)
    }

    /// The first of some URLs that names a local file that is there; relative to the file that names it. Otherwise why not.
    pub fn locate(&mut self, from: &Path, urls: &[String]) -> Result<Located, String> {
        let folder = from.parent().unwrap_or(Path::new(""));
        if let Some(located) = urls.iter().find_map(|url| self.find(folder, url)) {
            return Ok(located);
        }
        Err(match urls.last().map(|url| (relative(url), quoted(url))) {
            None => "it has no url".to_owned(),
            Some((Some(_), url)) => format!("there is no file \"{url}\""),
            Some((None, url)) => format!("\"{url}\" is not a relative path; only local files are read"),
        })
    }

    /// The local file that a URL names, if it is there; relative to a folder.
    fn find(&mut self, folder: &Path, url: &str) -> Option<Located> {
        if let Some(known) = self.located.get(folder).and_then(|urls| urls.get(url)) {
            return known.clone();
        }
        let located = relative(url).and_then(|Target { file, fragment }| {
            let file = folder.join(file);
            file.is_file().then(|| Located { key: canonical(&file).into(), file: file.into(), fragment })
        });
        self.located.entry(folder.to_owned()).or_default().insert(url.to_owned(), located.clone());
        located
    }
}

/// The relative path that a URL is, with its percent escapes decoded; `None` for other URLs and absolute paths, and where the escapes do not make UTF-8 or
/// hide a NUL.
fn relative(url: &str) -> Option<Target> {
    let (path, fragment) = match url.split_once('#') {
        Some((path, fragment)) => (path, Some(fragment.to_owned())),
        None => (url, None),
    };
    let has_scheme = path.split('/').next().is_some_and(|first| first.contains(':'));
    let decoded = percent_decode_str(path).decode_utf8().ok().filter(|path| !path.contains('\0'))?;
    let file = PathBuf::from(&*decoded);
    let is_relative = file.is_relative() && !path.is_empty() && !has_scheme && !path.starts_with('\\');
    is_relative.then_some(Target { file, fragment })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_relative_paths_are_local() {
        let target = |file: &str, fragment: Option<&str>| {
            Some(Target { file: file.into(), fragment: fragment.map(str::to_owned) })
        };
        assert_eq!(relative("a/b.wrl"), target("a/b.wrl", None));
        assert_eq!(relative("../b%20c.wrl#Name"), target("../b c.wrl", Some("Name")));
        assert_eq!(relative("http://a/b.wrl"), None);
        assert_eq!(relative("urn:a"), None);
        assert_eq!(relative("/etc/passwd"), None);
        assert_eq!(relative("%2Fetc/passwd"), None);
        assert_eq!(relative("a%00"), None);
        assert_eq!(relative("#Viewpoint"), None);
        assert_eq!(relative("100%"), target("100%", None));
        assert_eq!(relative("%+5"), target("%+5", None));
    }
}
