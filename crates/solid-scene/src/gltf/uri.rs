//! Where a buffer's bytes are: in the text itself, or in a file beside it.

use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

/// Base64 with or without the `=` at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// What a URI stands for.
#[derive(Debug, PartialEq)]
pub(super) enum Source {
    Bytes(Vec<u8>),
    /// A path in the file's folder.
    File(PathBuf),
}

/// Reads a URI; the error says what is wrong with it.
pub(super) fn resolve(uri: &str) -> Result<Source, String> {
    match uri.split_once(':') {
        Some((scheme, data)) if scheme.eq_ignore_ascii_case("data") => data_bytes(data).map(Source::Bytes),
        _ => relative_path(uri).map(Source::File),
    }
}

fn data_bytes(data: &str) -> Result<Vec<u8>, String> {
    let (kind, payload) = data.split_once(',').ok_or("is a data URI without a comma")?;
    if !kind.ends_with(";base64") {
        return Err("is a data URI that is not base64".into());
    }
    BASE64.decode(payload.trim_ascii()).map_err(|error| format!("has bad base64: {error}"))
}

/// A path that stays in the folder it starts from.
fn relative_path(uri: &str) -> Result<PathBuf, String> {
    let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| "has a URI that is not UTF-8")?;
    let path = Path::new(&*decoded);
    let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    let scheme = uri.split('/').next().is_some_and(|first| first.contains(':'));
    if scheme || path.as_os_str().is_empty() || !path.components().all(inside) {
        return Err(format!("is at `{}`; expected a path in the file's folder", crate::text::quoted(uri)));
    }
    Ok(Path::new("").join(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_is_decoded() {
        let bytes = Ok(Source::Bytes(vec![0, 1, 2, 3]));
        assert_eq!(resolve("data:application/octet-stream;base64,AAECAw=="), bytes);
        assert_eq!(resolve("DATA:;base64,AAECAw"), bytes);
        assert!(resolve("data:;base64,A!EC").unwrap_err().starts_with("has bad base64: "));
        assert!(resolve("data:text/plain,hello").unwrap_err().contains("not base64"));
        assert!(resolve("data:").unwrap_err().contains("comma"));
    }

    #[test]
    fn paths_stay_in_the_folder() {
        assert_eq!(resolve("a%20b/c%zz.bin"), Ok(Source::File("a b/c%zz.bin".into())));
        for uri in ["../a.bin", "a/../../b", "/etc/passwd", "%2e%2e/a", "http://a/b", "C:/a", ""] {
            assert!(resolve(uri).unwrap_err().contains("folder"), "{uri}");
        }
    }
}
