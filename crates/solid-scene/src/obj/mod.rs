//! Wavefront OBJ: positions, faces (`f`), lines (`l`) and points (`p`). Materials, normals and texture coordinates are
//! passed over in silence, and so is a material file that is missing.
//!
//! A reader of our own rather than the crate `tobj`: errors name the line and what was expected there, positions keep
//! double precision, and indices are checked against the vertices of the file.

mod geometry;
mod lines;
mod reader;

use std::path::Path;

use crate::error::SceneError;
use crate::fault::{Fault, Result};
use crate::file;
use crate::load::LoadOptions;
use crate::part::{ObjectCount, Part};
use crate::polygon::folded_warning;
use crate::soup::still_part;
use crate::text::{decoded, lines};

/// Reads an OBJ file: one object, named by the file, or with [`LoadOptions::split`] one for each group or object that
/// has primitives, named by it.
pub(crate) fn load(path: &Path, options: &LoadOptions) -> std::result::Result<Part, SceneError> {
    let bytes = file::read(path)?;
    parse(&bytes, &file::stem(path), options.split).map_err(|fault| fault.in_file(path))
}

fn parse(bytes: &[u8], stem: &str, split: bool) -> Result<Part> {
    let text = decoded(bytes);
    parse_text(&text, stem, split).map_err(|fault| not_text(&text).unwrap_or(fault))
}

/// What to say of a text that is none: where there is a character, not of a comment, that no text has. Where all else is right it does no harm.
fn not_text(text: &str) -> Option<Fault> {
    let is_of_no_text = |byte: &u8| matches!(byte, 0..=0x08 | 0x0e..=0x19 | 0x1b..=0x1f | 0x7f);
    lines(text).filter(|(_, text)| !text.starts_with('#')).find_map(|(line, text)| {
        let byte = text.bytes().find(is_of_no_text)?;
        let message =
            format!("there is the byte {byte:#04x}, which no text has; expected an OBJ file, which is text");
        Some(Fault::at(line, message))
    })
}

fn parse_text(text: &str, stem: &str, split: bool) -> Result<Part> {
    let statements = reader::read(text, stem)?;
    let mut warnings = statements.warnings();
    let soups = if split { statements.split()? } else { statements.whole(stem)? };
    warnings.extend(folded_warning(soups.folded));
    let mut count = ObjectCount::default();
    soups.named.iter().try_for_each(|(name, _)| count.add(name))?;
    let named = soups.named.into_iter().zip(1..);
    let objects = named.map(|((name, soup), number)| soup.into_object(&name, number));
    Ok(still_part(objects.collect::<Result<_>>()?, warnings))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;
    use solid3d::ShapeKind;

    use super::*;

    const TWO: &str = "# two\nmtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no left\nusemtl\nf 1/1/1 2//2 3\n\
                       g right\nv 5 5 5 0.1 nan 0.3\nv 6 5 5\nv 5 6 5\nf -3 -2 -1\nl 4 5 6\np 4\n";

    fn refused(text: &str) -> (Option<usize>, String) {
        let fault = parse(text.as_bytes(), "stem", false).unwrap_err();
        (fault.line(), fault.message().to_owned())
    }

    #[test]
    fn the_whole_file_is_one_object() {
        let part = parse(TWO.as_bytes(), "stem", false).unwrap();
        assert_eq!(part.objects.len(), 1);
        assert_eq!(part.objects[0].name, "stem");
        assert_eq!(part.objects[0].path, [0, 1]);
        assert_eq!(part.objects[0].shape.primitive_count(), 5);
        assert_eq!(part.objects[0].shape.vertices().unwrap()[3], DVec3::splat(5.0));
        assert_eq!((part.unit, part.duration, part.warnings.len()), ("unspecified", 0.0, 0));
    }

    #[test]
    fn split_makes_an_object_of_each_group() {
        let part = parse(TWO.as_bytes(), "stem", true).unwrap();
        let seen: Vec<_> =
            part.objects.iter().map(|o| (o.name.as_str(), o.shape.kind(), &o.path[..])).collect();
        let expected: [(_, _, &[u32]); 2] =
            [("left", ShapeKind::Mesh, &[0, 1]), ("right", ShapeKind::Complex, &[0, 2])];
        assert_eq!(seen, expected);
        assert_eq!(part.objects[1].shape.vertices().unwrap().len(), 3);
    }

    #[test]
    fn a_group_that_comes_again_goes_on() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng a\nf 1 2 3\ng b\nf 1 2 3\ng a\nf 3 2 1\n";
        let part = parse(text.as_bytes(), "stem", true).unwrap();
        let seen: Vec<_> = part.objects.iter().map(|o| (&o.name[..], o.shape.primitive_count())).collect();
        assert_eq!(seen, [("stem", 1), ("a", 2), ("b", 1)]);
    }

    /// The names of the objects that a text is split into, over one vertex, with how many points each has.
    fn split(text: &str) -> Vec<(String, usize)> {
        let part = parse(format!("v 0 0 0\n{text}").as_bytes(), "stem", true).unwrap();
        part.objects.into_iter().map(|object| (object.name, object.shape.primitive_count())).collect()
    }

    #[test]
    fn groups_of_two_objects_are_two() {
        let seen = split("o door\np 1\ng handle\np 1\no wall\ng handle\np 1 1\no door\np 1\ng handle\np 1\n");
        let expected = [("door", 2), ("handle", 2), ("handle", 2)];
        assert_eq!(seen, expected.map(|(name, count)| (name.to_owned(), count)));
        // A group that is named as its object is another part of it.
        assert_eq!(split("o a\np 1\ng a\np 1\n").len(), 2);
    }

    #[test]
    fn objects_have_a_limit() {
        let groups: String = (0..=1_000_000).map(|i| format!("g {i}\np 1\n")).collect();
        let fault = parse(format!("v 0 0 0\n{groups}").as_bytes(), "stem", true).unwrap_err();
        assert_eq!(fault.message(), "the file makes more than 1000000 objects");
    }

    #[test]
    fn names_may_be_of_latin_1() {
        let text = b"v 0 0 0\ng T\xfcr\np 1\ng T\xf6r\np 1 1\n";
        let part = parse(text, "stem", true).unwrap();
        let seen: Vec<_> = part.objects.iter().map(|o| o.name.as_str()).collect();
        assert_eq!(seen, ["T\u{fc}r", "T\u{f6}r"]);
    }

    #[test]
    fn a_name_may_hold_what_begins_a_comment() {
        let seen = split("g part#1\np 1#one\ng part#2 # two\np 1\no #3\np 1\n#g 4\n");
        assert_eq!(seen, ["part#1", "part#2", ""].map(|name| (name.to_owned(), 1)));
    }

    #[test]
    fn lines_continue() {
        let text = "v 0 0 0\nv 1 0 \\\n 0\nv 0 1 0\nf 1 2 \\\n3\nf 1 2 9\n";
        let (line, message) = refused(text);
        assert_eq!(line, Some(7));
        assert_eq!(message, "the index 9 names no vertex; the file has 3");
    }

    /// As old programs write faces.
    #[test]
    fn outlines_of_faces_are_faces() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nfo 1 2 3\n";
        let part = parse(text.as_bytes(), "stem", false).unwrap();
        assert_eq!(part.objects[0].shape.triangles().unwrap(), [[0, 1, 2]]);
    }

    #[test]
    fn faces_that_cross_themselves_are_warned_of() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 3 0\nf 1 3 2 4\nf 1 2 3 4\n";
        for split in [false, true] {
            let warnings = parse(text.as_bytes(), "stem", split).unwrap().warnings;
            assert!(warnings.len() == 1 && warnings[0].starts_with("1 polygon"), "{warnings:?}");
        }
    }

    #[test]
    fn free_forms_are_counted() {
        let text = "v 0 0 0\np 1\ncurv 0 1 1 1\ncurv2 1 1\nsurf 0 1 0 1 1\n";
        let warnings = parse(text.as_bytes(), "stem", false).unwrap().warnings;
        assert_eq!(warnings, ["3 free-form curves or surfaces are passed over"]);
    }

    #[test]
    fn short_faces_are_passed_over() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1// 2//\nf 1// 2// 3//\n";
        let part = parse(text.as_bytes(), "stem", false).unwrap();
        assert_eq!(part.warnings, ["1 face with fewer than 3 corners is passed over"]);
        assert_eq!(part.objects[0].shape.primitive_count(), 1);
    }

    #[test]
    fn mistakes_name_their_line() {
        let mistakes = [
            ("v 0 0\n", 1, "expected a finite number for the vertex's z, but the line ends"),
            ("v 0 0 0\nf 1 2 x\n", 2, "expected a vertex index, but there is `x`"),
            ("v 0 0 0\nf 0 1 1\n", 2, "expected a vertex index, but there is `0`; indices count from 1"),
            ("v 0 0 0\nf -2 1 1\n", 2, "the index -2 names no vertex; there is 1 before it"),
            (
                "v 0 0 0\np 99999999999999999999\n",
                2,
                "expected a vertex index, but there is `99999999999999999999`",
            ),
            ("v 0 1e200 0\np 1\n", 1, "the vertex's y is `1e200`; it must be at most 1e100 in magnitude"),
            // The greatest is told, whatever follows it.
            ("v 0 0 0\nf 1 1 9\nf 1 7 1\n", 2, "the index 9 names no vertex; the file has 1"),
            ("\n\nv 0 0 inf\n", 3, "expected a finite number for the vertex's z, but there is `inf`"),
        ];
        for (text, line, message) in mistakes {
            assert_eq!(refused(text), (Some(line), message.to_owned()));
        }
    }

    #[test]
    fn a_file_without_geometry_is_refused() {
        for text in ["", "# nothing\n", "v 1 2 3\n", "g f l p\nv 0 0 0\n", "\\"] {
            assert_eq!(refused(text).1, "the file has no geometry: no face, line or point");
        }
    }

    /// Bytes of which nothing can be made are named; in a comment they do no harm.
    #[test]
    fn what_is_no_text_is_named() {
        let message = |byte: &str| {
            format!("there is the byte {byte}, which no text has; expected an OBJ file, which is text")
        };
        assert_eq!(refused("\0\u{1}binary"), (Some(1), message("0x00")));
        assert_eq!(refused("\nx\r\nv 1 \u{1b}"), (Some(3), message("0x1b")));
        let (line, told) = refused("# caf\u{7f}\nv 0 0 0\nf 1 2 3\n");
        assert!(line == Some(3) && !told.contains("0x7f"), "{told}");
        assert_eq!(refused("v 0 0 0\rv\tx y\u{c}\nf \u{7f}"), (Some(3), message("0x7f")));
        assert!(parse(b"# \0\xff\nv 0 0 0\np 1\n\x1a", "stem", false).is_ok());
    }

    proptest! {
        #[test]
        fn truncation_never_panics(end in 0..TWO.len(), split: bool) {
            let _ = parse(&TWO.as_bytes()[..end], "stem", split);
        }

        #[test]
        fn noise_never_panics(lines in prop::collection::vec("[vflpgo#\\\\][ 0-9/.e-]{0,20}", 0..20), split: bool) {
            let _ = parse(lines.join("\n").as_bytes(), "stem", split);
        }
    }
}
