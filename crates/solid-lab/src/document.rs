//! Documents whose prose is by hand and whose results are not.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// Puts each text into a document, between the marks `<!-- results of NAME -->` and `<!-- end of NAME -->`. What is around them stays; when
/// marks are missing, all stays.
pub fn fill(document: &Path, results: &[(&str, String)]) -> Result<()> {
    let mut text =
        fs::read_to_string(document).with_context(|| format!("cannot read {}", document.display()))?;
    for (name, result) in results {
        let [begin, end] = marks(name);
        let missing = || format!("{} has no marks for {name}", document.display());
        let start = text.find(&begin).with_context(missing)? + begin.len();
        let stop = start + text[start..].find(&end).with_context(missing)?;
        text.replace_range(start..stop, &format!("\n\n{result}\n\n"));
    }
    fs::write(document, text).with_context(|| format!("cannot write {}", document.display()))
}

/// Asks for the documents before anything is measured that is to be put into them.
///
/// # Errors
/// When one is not there.
pub fn expect_in(folder: &Path) -> Result<()> {
    for name in ["experiments.md", "peers.md"] {
        let document = folder.join(name);
        fs::metadata(&document).with_context(|| {
            format!("--docs names the folder of the documents: no {}", document.display())
        })?;
    }
    Ok(())
}

fn marks(name: &str) -> [String; 2] {
    [format!("<!-- results of {name} -->"), format!("<!-- end of {name} -->")]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::all;

    #[test]
    fn results_go_between_the_marks_and_prose_stays() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let document = folder.path().join("document.md");
        let [begin, end] = marks("hits");
        fs::write(&document, format!("before\n{begin}\nold\n{end}\nafter\n")).expect("it can be written");
        fill(&document, &[("hits", "41 %".into())]).expect("the marks are there");
        let text = fs::read_to_string(&document).expect("it can be read");
        assert_eq!(text, format!("before\n{begin}\n\n41 %\n\n{end}\nafter\n"));

        let error =
            fill(&document, &[("hits", "42 %".into()), ("misses", "1".into())]).expect_err("no marks");
        assert!(error.to_string().contains("no marks for misses"), "{error}");
        assert_eq!(fs::read_to_string(&document).expect("it can be read"), text, "half applied");
    }

    #[test]
    fn documents_that_are_not_there_are_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("experiments.md"), "").expect("it can be written");
        let error = expect_in(folder.path()).expect_err("one is missing");
        assert!(error.to_string().contains("peers.md"), "{error}");
        fs::write(folder.path().join("peers.md"), "").expect("it can be written");
        assert!(expect_in(folder.path()).is_ok());
    }

    #[test]
    fn the_documents_have_marks_for_everything() {
        let experiments = include_str!("../../../docs/experiments.md");
        let peers = include_str!("../../../docs/peers.md");
        let of_experiments = all().iter().map(|experiment| (experiments, experiment.name));
        for (document, name) in of_experiments
            .chain([(experiments, "shortfalls"), (experiments, "threads")])
            .chain([(peers, "peers"), (peers, "questions"), (peers, "grounds")])
        {
            let [begin, end] = marks(name);
            assert!(document.contains(&begin) && document.contains(&end), "{name}");
        }
    }
}
