//! The commands on the page of the example scenes print what stands there.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

use std::path::Path;
use std::process::Command;

/// A command on the page, without `solid`, and what it prints.
struct Example<'a> {
    arguments: &'a str,
    printed: &'a str,
}

fn examples(page: &str) -> Vec<Example<'_>> {
    let blocks = page.split("```console\n$ solid ").skip(1);
    let blocks = blocks.filter_map(|block| block.split_once("```")?.0.split_once('\n'));
    blocks.map(|(arguments, printed)| Example { arguments, printed }).collect()
}

#[test]
fn what_the_page_says_is_what_is_printed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("scenes/README.md")).unwrap().replace("\r\n", "\n");
    let examples = examples(&page);
    assert_eq!(examples.len(), 14);
    for Example { arguments, printed } in examples {
        let mut command = Command::new(env!("CARGO_BIN_EXE_solid"));
        let output = command.args(arguments.split_whitespace()).current_dir(&root).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}");
        let text = String::from_utf8(output.stdout).unwrap();
        // But for the last line, which says how much work it was and how fast.
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[..lines.len() - 1], printed.lines().collect::<Vec<_>>(), "{arguments}");
    }
    // The first of them stands in the project's README too.
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap().replace("\r\n", "\n");
    let (_, shown) = readme.split_once("```text\n").unwrap();
    let (table, _) = shown.split_once("\n\n").unwrap();
    assert!(page.contains(table), "{table}");
}
