//! Reading a text file that the command line names.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};

/// The text of a file, or of a pipe or device, which tells no size, of so many bytes at most.
pub fn read(path: &Path, bytes_max: u64) -> Result<String> {
    let name = path.display();
    let mut bytes = Vec::new();
    let file = File::open(path).with_context(|| format!("{name}: can't be read"))?;
    file.take(bytes_max + 1).read_to_end(&mut bytes).with_context(|| format!("{name}: can't be read"))?;
    ensure!(
        bytes.len() as u64 <= bytes_max,
        "{name}: there are more than {bytes_max} bytes, which is the limit"
    );
    let is_utf16 = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    ensure!(!is_utf16, "{name}: is text in UTF-16; expected UTF-8, so save it as that first");
    String::from_utf8(bytes).map_err(|error| {
        let line =
            1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        anyhow!("{name}:{line}: there are bytes that are no UTF-8; expected text in UTF-8")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_text_is_refused_with_its_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("rules.toml");
        std::fs::write(&path, b"a = 1\nb = \xff\n").expect("a file");
        let error = read(&path, 100).expect_err("it is no text").to_string();
        assert!(error.contains("rules.toml:2: "), "{error}");
        for utf16 in [b"\xff\xfea\0", b"\xfe\xff\0a"] {
            std::fs::write(&path, utf16).expect("a file");
            let error = read(&path, 100).expect_err("it is in UTF-16").to_string();
            assert!(
                error.ends_with("rules.toml: is text in UTF-16; expected UTF-8, so save it as that first"),
                "{error}"
            );
        }
        let error = read(&path, 3).expect_err("it is too large").to_string();
        assert!(error.contains("more than 3 bytes"), "{error}");
    }
}
