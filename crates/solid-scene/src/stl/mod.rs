//! STL, ASCII and binary. Equal vertices are welded.
//!
//! A reader of our own rather than the crate `stl_io`: that takes a binary file whose header begins with "solid " for
//! text, reads only the first solid of a text, and its errors have no line.

mod ascii;
mod binary;

use std::path::Path;

use glam::DVec3;

use crate::error::SceneError;
use crate::fault::{Fault, Result};
use crate::file;
use crate::part::Part;
use crate::soup::{Soup, still_part};
use crate::text::without_mark;
use crate::weld::Weld;

/// Reads an STL file: one object, named by the file, of all its solids.
pub(crate) fn load(path: &Path) -> std::result::Result<Part, SceneError> {
    let bytes = file::read(path)?;
    parse(&bytes, &file::stem(path)).map_err(|fault| fault.in_file(path))
}

fn parse(bytes: &[u8], stem: &str) -> Result<Part> {
    let (triangles, warning) = match is_text(bytes) {
        true => (ascii::read(bytes)?, None),
        false => {
            let told = |fault| zero_in_text(bytes).or_else(|| other_text(bytes)).unwrap_or(fault);
            let triangles = binary::read(bytes).map_err(told)?;
            (triangles, binary::left_over(bytes))
        }
    };
    let soup = welded(&triangles);
    if soup.is_empty() {
        let why = warning.map(|warning| format!("; {warning}")).unwrap_or_default();
        return Err(format!("the file has no geometry: no facet{why}").into());
    }
    Ok(still_part(vec![soup.into_object(stem, 1)?], Vec::from_iter(warning)))
}

/// What to say of a file that begins as text, but has a zero byte, where it is no binary file either.
fn zero_in_text(bytes: &[u8]) -> Option<Fault> {
    let zero = bytes.iter().position(|&byte| byte == 0).filter(|_| begins_as_text(bytes))?;
    let line = 1 + bytes[..zero].iter().filter(|&&byte| byte == b'\n').count();
    let expected = "expected text, or a binary file as long as its header tells";
    Some(Fault::at(line, format!("there is a zero byte, which no text has; {expected}")))
}

/// What to say of a text that begins otherwise, as a page of the web does, where its letters make no count of triangles.
fn other_text(bytes: &[u8]) -> Option<Fault> {
    let is_of_text = |c: char| !c.is_control() || matches!(c, '\t' | '\n' | '\r');
    std::str::from_utf8(bytes)
        .ok()
        .filter(|text| !begins_as_text(bytes) && !bytes.is_empty() && text.chars().all(is_of_text))?;
    Some(Fault::at(1, "the file is text, but does not begin with \"solid\"; expected an STL file"))
}

fn begins_as_text(bytes: &[u8]) -> bool {
    let first_word = without_mark(bytes).trim_ascii_start().get(..5).unwrap_or_default().to_ascii_lowercase();
    first_word == b"solid" || first_word == b"facet"
}

/// Whether the file is text. The first word alone does not tell, since binary headers may begin with "solid" too: a
/// file that is as long as its binary triangle count says is binary, and so is one with a zero byte.
fn is_text(bytes: &[u8]) -> bool {
    begins_as_text(bytes) && !binary::has_exact_length(bytes) && !bytes.contains(&0)
}

fn welded(corners: &[[DVec3; 3]]) -> Soup {
    let mut weld = Weld::default();
    let triangles = corners.iter().map(|triangle| triangle.map(|corner| weld.number(corner))).collect();
    Soup { vertices: weld.into_vertices(), triangles, ..Soup::default() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TEXT: &str = "solid a\n facet normal nan 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
                        vertex 0 1 0\n  endloop\n endfacet\nendsolid a\nSOLID b\n\nendsolid\nsolid\nFacet Normal 0 0 1\n\
                        outer loop\nvertex 1 0 -0\nvertex 0 -0 0\nvertex 2 2 2e1\nendloop\nendfacet\nendsolid\n";

    fn binary(header: &[u8], count: u32, triangles: usize) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        for triangle in 0..triangles {
            for number in 0..12 {
                bytes.extend((if number == 3 + triangle { 1.0f32 } else { number as f32 }).to_le_bytes());
            }
            bytes.extend([7, 7]);
        }
        bytes
    }

    fn refused(bytes: &[u8]) -> (Option<usize>, String) {
        let fault = parse(bytes, "stem").unwrap_err();
        (fault.line(), fault.message().to_owned())
    }

    #[test]
    fn all_solids_of_a_text_are_one_object() {
        let part = parse(TEXT.as_bytes(), "stem").unwrap();
        assert_eq!(part.objects[0].name, "stem");
        let shape = &part.objects[0].shape;
        assert_eq!(shape.triangles().unwrap(), [[0, 1, 2], [1, 0, 3]]);
        assert_eq!(shape.vertices().unwrap()[3], DVec3::new(2.0, 2.0, 20.0));
    }

    #[test]
    fn a_text_may_begin_with_space_or_with_a_facet() {
        let without = TEXT.replacen("solid a\n", "", 1).replacen("endsolid a\n", "", 1);
        for text in [format!("\n \t{TEXT}"), without.trim_start().to_owned(), format!("\u{feff}{without}")] {
            let part = parse(text.as_bytes(), "stem").unwrap();
            assert_eq!(part.objects[0].shape.triangles().unwrap(), [[0, 1, 2], [1, 0, 3]], "{text}");
        }
    }

    /// Law: how a text is divided into lines makes no difference, but that a name ends with its line or before `facet normal`.
    #[test]
    fn a_line_may_hold_many_facets() {
        let triangles = |text: &str| {
            let part = parse(text.as_bytes(), "stem").unwrap();
            part.objects[0].shape.triangles().unwrap().to_vec()
        };
        let facets = TEXT.replace("\nendfacet", " endfacet").replace("\n endfacet", " endfacet");
        for text in [TEXT.replace('\n', " "), TEXT.replace('\n', "\t\r"), facets] {
            assert_eq!(triangles(&text), [[0, 1, 2], [1, 0, 3]], "{text}");
        }
        let named = TEXT
            .replace("solid a", "solid vertex of a facet")
            .replace("endsolid\n", "endsolid outer solid\n");
        assert_eq!(triangles(&named).len(), 2);
        assert_eq!(
            refused(b"solid\nfacet outer loop vertex 0 0 endloop"),
            (Some(2), "expected a finite number for the vertex's z, but there is `endloop`".to_owned())
        );
    }

    #[test]
    fn a_zero_byte_in_a_text_is_named() {
        let message = "there is a zero byte, which no text has; expected text, or a binary file as long as its \
                       header tells";
        assert_eq!(refused(TEXT.replace("SOLID b", "SOLID \0").as_bytes()), (Some(10), message.to_owned()));
        assert_eq!(refused(b"solid\0"), (Some(1), message.to_owned()));
    }

    #[test]
    fn a_binary_header_may_begin_with_solid() {
        for header in [&b"solid facet"[..], b"\0solid", b""] {
            let part = parse(&binary(header, 2, 2), "stem").unwrap();
            assert_eq!(part.objects[0].shape.primitive_count(), 2);
            assert_eq!(part.objects[0].shape.vertices().unwrap().len(), 4);
        }
    }

    #[test]
    fn bytes_after_the_last_triangle_are_passed_over() {
        let mut bytes = binary(b"\0", 1, 1);
        bytes.extend(b"trailer");
        let part = parse(&bytes, "stem").unwrap();
        assert_eq!((part.objects[0].shape.primitive_count(), part.warnings.len()), (1, 0));
    }

    /// Some programs do not come back to the count when they have written all triangles.
    #[test]
    fn triangles_that_the_header_does_not_tell_are_warned_of() {
        let part = parse(&binary(b"solid", 1, 3), "stem").unwrap();
        assert_eq!(part.objects[0].shape.primitive_count(), 1);
        assert_eq!(part.warnings, ["the header tells 1 triangle; the 100 bytes after that are passed over"]);
        let message = "the file has no geometry: no facet; the header tells 0 triangles; the 100 bytes after that are \
                       passed over";
        assert_eq!(refused(&binary(b"\0", 0, 2)).1, message);
        assert_eq!(refused(&binary(b"\0", 0, 0)).1, "the file has no geometry: no facet");
    }

    #[test]
    fn a_count_beyond_the_file_is_refused() {
        let message = "the header tells 1000000000 triangles, a file of 50000000084 bytes; the file has 134";
        assert_eq!(refused(&binary(b"\0", 1_000_000_000, 1)), (None, message.to_owned()));
        assert_eq!(
            refused(b"\x01hort").1,
            "neither text that begins with \"solid\" nor the 84 bytes of a binary header"
        );
    }

    #[test]
    fn other_texts_are_told() {
        for text in
            ["short\n", &format!("<!DOCTYPE html>\r\n{}", "\u{e9} ".repeat(100)), &format!("# {TEXT}")]
        {
            let message = "the file is text, but does not begin with \"solid\"; expected an STL file";
            assert_eq!(refused(text.as_bytes()), (Some(1), message.to_owned()), "{text}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        let mut bytes = binary(b"\0", 1, 1);
        bytes[84 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(
            refused(&bytes).1.starts_with("vertex 0 of triangle 0 is [NaN, 4, 5]"),
            "{:?}",
            refused(&bytes)
        );
    }

    #[test]
    fn mistakes_name_their_line() {
        let mistakes = [
            (
                "solid\nfacet\nvertex 1 2\n",
                3,
                "expected a finite number for the vertex's z, but the line ends",
            ),
            ("solid\nfacet\nendfacet\n", 3, "expected a facet of 3 vertices, but this one has 0"),
            ("solid\nfacet\nfacet\n", 3, "expected `endfacet`, but there is `facet`"),
            ("solid\nvertex 1 2 3\n", 2, "expected `facet`, but there is `vertex`"),
            ("solid\nfacet\n\n", 4, "expected `endfacet`, but the file ends"),
            ("solid\n", 2, "expected `endsolid`, but the file ends"),
            (
                "solid\nfrobnicate 1 2 3\nendsolid",
                2,
                "expected `facet` or `endsolid`, but there is `frobnicate`",
            ),
        ];
        for (text, line, message) in mistakes {
            assert_eq!(refused(text.as_bytes()), (Some(line), message.to_owned()), "{text}");
        }
        assert_eq!(refused(b"solid Empty\nendsolid").1, "the file has no geometry: no facet");
    }

    proptest! {
        #[test]
        fn truncation_never_panics(end in 0..TEXT.len()) {
            let _ = parse(&TEXT.as_bytes()[..end], "stem");
        }

        #[test]
        fn truncated_binary_is_refused(end in 0..184usize) {
            prop_assert!(parse(&binary(b"solid", 2, 2)[..end], "stem").is_err());
        }
    }
}
