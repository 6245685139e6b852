//! A file's text, with a check that it is VRML97.

use std::path::Path;

use super::limits::FILE_BYTES_MAX;
use crate::error::SceneError;
use crate::file;
use crate::text::decoded;

/// The first line of every VRML97 file begins with this.
const HEADER: &str = "#VRML V2.0 utf8";

/// Reads a file of VRML97. Bytes that are not UTF-8 are Latin-1, which old exporters wrote into comments and names.
pub(super) fn read(path: &Path) -> Result<String, SceneError> {
    let length = file::metadata(path)?.len();
    if length > FILE_BYTES_MAX {
        let message = format!("has {length} bytes; the limit is {FILE_BYTES_MAX}");
        return Err(SceneError::new(path, None, message));
    }
    decode(path, &file::read(path)?)
}

/// The text of a file's bytes.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<String, SceneError> {
    let fail = |message: &str| Err(SceneError::new(path, Some(1), message));
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return fail("is compressed with gzip; expected plain text, so decompress it first (gzip -dc)");
    }
    let mut text = decoded(bytes).into_owned();
    if text.starts_with("#VRML V1.0") {
        return fail("is VRML 1.0; expected VRML97, whose first line is \"#VRML V2.0 utf8\"");
    }
    if text.starts_with("#X3D") {
        return fail("is X3D; expected VRML97, whose first line is \"#VRML V2.0 utf8\"");
    }
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    if !text.strip_prefix(HEADER).is_some_and(ends) {
        return fail("has no VRML97 header; expected the first line \"#VRML V2.0 utf8\"");
    }
    if text.contains('\r') {
        // As all that follows counts lines.
        text = text.replace("\r\n", "\n").replace('\r', "\n");
    }
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        decode(Path::new("a.wrl"), bytes).unwrap_err().to_string()
    }

    #[test]
    fn every_other_format_is_named() {
        assert!(message(b"\x1f\x8b\x08").contains("gzip"));
        assert!(message(b"#VRML V1.0 ascii\n").contains("VRML 1.0"));
        assert!(message(b"#X3D V3.0 utf8\n").contains("X3D"));
        assert_eq!(
            message(b"Shape {}"),
            "a.wrl:1: has no VRML97 header; expected the first line \"#VRML V2.0 utf8\""
        );
        assert!(message(b"").contains("no VRML97 header"));
        assert!(message(b"#VRML V2.0 utf88").contains("no VRML97 header"));
    }

    #[test]
    fn lines_end_with_any_mark() {
        let text = decode(Path::new("a.wrl"), b"#VRML V2.0 utf8\r\nShape {\r}\n\r").unwrap();
        assert_eq!(text, "#VRML V2.0 utf8\nShape {\n}\n\n\n");
    }

    #[test]
    fn the_header_may_be_the_whole_file_and_follow_a_byte_order_mark() {
        assert_eq!(decode(Path::new("a.wrl"), b"\xef\xbb\xbf#VRML V2.0 utf8").unwrap(), "#VRML V2.0 utf8\n");
    }
}
