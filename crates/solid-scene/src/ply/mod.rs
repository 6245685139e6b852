//! PLY, ASCII and binary of either byte order: the positions of `vertex`, the polygons of `face` and the strips of
//! `tristrips`. Other elements and properties are passed over.
//!
//! A reader of our own rather than the crate `ply-rs-bw`: that refuses numbers such as `1.`, `.5` and `nan` in ASCII
//! even where they are colours, misreads properties of equal names, and counts to the end of an element without
//! properties, however many the header tells.

mod geometry;
mod header;
mod payload;

use std::path::Path;

use crate::error::SceneError;
use crate::fault::Result;
use crate::file;
use crate::part::Part;
use crate::soup::still_part;

/// Reads a PLY file: one object, named by the file.
pub(crate) fn load(path: &Path) -> std::result::Result<Part, SceneError> {
    let bytes = file::read(path)?;
    parse(&bytes, &file::stem(path)).map_err(|fault| fault.in_file(path))
}

fn parse(bytes: &[u8], stem: &str) -> Result<Part> {
    let (header, payload) = header::read(bytes)?;
    let (soup, warnings) = geometry::read(&header, payload)?;
    if soup.is_empty() {
        return Err("the file has no geometry: no face".into());
    }
    Ok(still_part(vec![soup.into_object(stem, 1)?], warnings))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    const TEXT: &str = "ply\r\nformat ascii 1.0\r\ncomment a\r\nelement lamp 1\r\nproperty list uchar float glow\r\n\
                        element vertex 4\r\nproperty double y\r\nproperty float x\r\nproperty uchar red\r\n\
                        property int z\r\nelement face 2\r\nproperty list uchar int vertex_index\r\nend_header\r\n\
                        2 .5 nan\r\n0. 0 255 0\r\n0 1 9 0\r\n1 1 9 0\r\n1 0 9 0\r\n4 0 1 2 3\r\n2 0 1\r\n";

    fn binary(order: &str) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty short x\nproperty float y\n\
             property double z\nproperty list uint8 uint16 junk\nelement tristrips 1\n\
             property list int int vertex_indices\nend_header\n"
        )
        .into_bytes();
        let little = order == "little";
        let mut push = |value: &[u8]| {
            let reversed = value.iter().rev().copied();
            if little { bytes.extend(value) } else { bytes.extend(reversed) }
        };
        for vertex in 0..3i16 {
            push(&vertex.to_le_bytes());
            push(&(f32::from(vertex) * 0.1).to_le_bytes());
            push(&1e-300f64.to_le_bytes());
            push(&[1]);
            push(&[9, 9]);
        }
        for number in [4i32, 2, 1, 0, -1] {
            push(&number.to_le_bytes());
        }
        bytes
    }

    fn refused(bytes: &[u8]) -> (Option<usize>, String) {
        let fault = parse(bytes, "stem").unwrap_err();
        (fault.line(), fault.message().to_owned())
    }

    #[test]
    fn text_is_read() {
        let part = parse(TEXT.as_bytes(), "stem").unwrap();
        assert_eq!(part.warnings, ["1 face with fewer than 3 corners is passed over"]);
        let shape = &part.objects[0].shape;
        assert_eq!(shape.triangles().unwrap(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(shape.vertices().unwrap()[1], DVec3::X);
    }

    /// As old programs write them.
    #[test]
    fn lines_may_end_with_cr_alone() {
        let text = TEXT.replace("\r\n", "\r");
        let part = parse(text.as_bytes(), "stem").unwrap();
        assert_eq!(part.objects[0].shape.triangles().unwrap(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(refused(text.replace("2 0 1", "2 0 9").as_bytes()).0, Some(20));
        // What follows the header may be either end of a line.
        for end in ["\r", "\n", "\r\n"] {
            let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n\
                          property uchar z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n";
            for first in *b"\r\n" {
                let bytes =
                    [header.replace('\n', end).as_bytes(), &[first, 0, 0, 0, 10, 0, 0, 13, 0, 3, 0, 1, 2]]
                        .concat();
                let part = parse(&bytes, "stem").unwrap();
                let vertices = part.objects[0].shape.vertices().unwrap();
                assert_eq!(vertices[0], DVec3::X * f64::from(first), "{end:?}");
            }
        }
    }

    #[test]
    fn of_two_lists_of_corners_one_is_taken() {
        let lists = ["vertex_index", "vertex_indices"];
        for [first, second] in [[0, 1], [1, 0]] {
            let corners = |list: usize| ["3 0 1 2", "3 2 1 0"][list];
            let text = format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                 property list uchar int {}\nproperty list uchar int {}\nend_header\n0 0 0\n1 0 0\n0 1 0\n{} {}\n",
                lists[first],
                lists[second],
                corners(first),
                corners(second)
            );
            let part = parse(text.as_bytes(), "stem").unwrap();
            assert_eq!(part.objects[0].shape.triangles().unwrap(), [[2, 1, 0]]);
        }
    }

    #[test]
    fn both_byte_orders_are_read() {
        for order in ["little", "big"] {
            let part = parse(&binary(order), "stem").unwrap();
            let shape = &part.objects[0].shape;
            assert_eq!(shape.triangles().unwrap(), [[2, 1, 0]]);
            assert_eq!(shape.vertices().unwrap()[2], DVec3::new(2.0, f64::from(0.2f32), 1e-300));
        }
    }

    /// Integers whose bits are all set: what they are depends on their type alone.
    #[test]
    fn integers_of_every_type_are_read() {
        let types = [
            ("char", 1, -1.0),
            ("int8", 1, -1.0),
            ("uchar", 1, 255.0),
            ("uint8", 1, 255.0),
            ("short", 2, -1.0),
            ("int16", 2, -1.0),
            ("ushort", 2, 65_535.0),
            ("uint16", 2, 65_535.0),
            ("int", 4, -1.0),
            ("int32", 4, -1.0),
            ("uint", 4, 4_294_967_295.0),
            ("uint32", 4, 4_294_967_295.0),
        ];
        for ((name, size, expected), order) in
            types.into_iter().flat_map(|one| [(one, "little"), (one, "big")])
        {
            let header = format!(
                "ply\nformat binary_{order}_endian 1.0\nelement vertex 1\nproperty {name} x\nproperty uchar y\n\
                 property uchar z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n"
            );
            let bytes = [header.as_bytes(), &vec![0xff; size], &[0, 0, 3, 0, 0, 0]].concat();
            let part = parse(&bytes, "stem").unwrap();
            assert_eq!(part.objects[0].shape.vertices().unwrap(), [DVec3::X * expected], "{name}, {order}");
        }
    }

    #[test]
    fn a_face_that_crosses_itself_is_warned_of() {
        let text = TEXT.replace("1 0 9 0\r\n4 0 1 2 3", "3 0 9 0\r\n4 0 2 1 3");
        let warnings = parse(text.as_bytes(), "stem").unwrap().warnings;
        assert!(warnings.len() == 2 && warnings[1].starts_with("1 polygon"), "{warnings:?}");
    }

    #[test]
    fn counts_beyond_the_file_are_refused() {
        let head = "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\n\
                    property float z\nend_header\n1 2 3\n";
        let message =
            "the header tells 1000000000 of `vertex`, of 6000000000 bytes in all; the file has 6 for them";
        assert_eq!(refused(head.as_bytes()), (Some(3), message.to_owned()));
        let idle = "ply\nformat ascii 1.0\nelement idle 99999999999\nend_header\n1 2 3\n";
        assert_eq!(
            refused(idle.as_bytes()).1,
            "the header tells 99999999999 of `idle`, which has no property"
        );
        let list = "ply\nformat binary_little_endian 1.0\nelement face 1\n\
                    property list int int vertex_index\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}";
        assert_eq!(
            refused(list.as_bytes()).1,
            "the file ends in `face` 0: expected 2139062143 numbers of `vertex_index`"
        );
    }

    #[test]
    fn mistakes_are_named() {
        let header =
            |vertex: &str, rest: &str| format!("ply\nformat ascii 1.0\nelement vertex 1\n{vertex}{rest}");
        let xyz = "property float x\nproperty float y\nproperty float z\n";
        let face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        let mistakes = [
            ("plx\n".to_owned(), Some(1), "expected `ply`"),
            (
                "ply\nformat ascii 2.0\n".to_owned(),
                Some(2),
                "expected `format`, an encoding and the version 1.0",
            ),
            ("ply\nproperty int x\n".to_owned(), Some(2), "a property stands before the first element"),
            ("ply\nelement vertex -1\n".to_owned(), Some(2), "expected `element`, a name and a count"),
            (
                "ply\nelement a 1\nproperty string x\n".to_owned(),
                Some(3),
                "expected a type, but there is `string`",
            ),
            (
                "ply\nfoo\n".to_owned(),
                Some(2),
                "expected `element`, `property` or `end_header`, but there is `foo`",
            ),
            (
                "ply\nformat ascii 1.0\n".to_owned(),
                Some(2),
                "the file ends in its header; expected `end_header`",
            ),
            ("ply\nend_header\n".to_owned(), Some(2), "the header has no `format`"),
            (
                header("property float x\n", "end_header\n0 0\n"),
                Some(3),
                "`vertex` has no scalar property `y`",
            ),
            (
                header(
                    &xyz.replace("property float x", "property list uchar float x"),
                    "end_header\n0 0 0\n",
                ),
                Some(3),
                "`vertex` has no scalar property `x`",
            ),
            (
                header(xyz, &format!("{face}0 0 0\n3 0 0 0.5\n")),
                Some(11),
                "`face` 0 names vertex 0.5, but there is 1",
            ),
            (
                header(xyz, &format!("{face}0 0 0\n9 0\n0\n0\n")),
                Some(11),
                "the file ends in `face` 0: expected 9 numbers of `vertex_indices`",
            ),
            (
                header(xyz, &format!("{}0 0 0\n3 0 0 0\n", face.replace("indices", "indexes"))),
                Some(7),
                "`face` has no list `vertex_indices` or `vertex_index`",
            ),
            // Each of the two has room, but not both.
            (
                header(xyz, &format!("{}0 0 0\n", face.replace("face 1", "face 2"))),
                Some(7),
                "the header tells 2 of `face`, of 4 bytes in all; the file has 0 for them",
            ),
            // Nothing is after the last number.
            (header(xyz, &format!("{face}0 0 0 0")), None, "the file has no geometry: no face"),
            (
                header(xyz, &format!("{face}0 0 0\n3 0 0 1\n")),
                Some(11),
                "`face` 0 names vertex 1, but there is 1",
            ),
            (
                header(xyz, &format!("{face}0 0 0\n3 0 0 -1\n")),
                Some(11),
                "`face` 0 names vertex -1, but there is 1",
            ),
            (
                header(xyz, &format!("{face}0 0 0\n-3 0 0\n")),
                Some(11),
                "`face` 0 has a list `vertex_indices` of length -3",
            ),
            (
                header(xyz, &format!("{face}0 inf 0\n1 0 0\n")),
                Some(10),
                "`vertex` 0 is [0, inf, 0]; expected finite numbers",
            ),
            (
                header(&xyz.replace("float", "double"), &format!("{face}0 -1e101 0\n1 0 0\n")),
                Some(10),
                "`vertex` 0 has the coordinate -1e101; it must be at most 1e100 in magnitude",
            ),
            (
                header(xyz, &format!("{face}0\n0 one\n3 0 0\n")),
                Some(11),
                "expected a number, but there is `one`",
            ),
            (header(xyz, "end_header\n0 0 0\n"), None, "the file has no geometry: no face"),
        ];
        for (text, line, message) in mistakes {
            assert_eq!(refused(text.as_bytes()), (line, message.to_owned()), "{text}");
        }
    }

    proptest! {
        #[test]
        fn truncation_never_panics(end in 0..TEXT.len()) {
            let _ = parse(&TEXT.as_bytes()[..end], "stem");
        }

        #[test]
        fn truncated_binary_is_refused(big: bool, cut in 1usize..250) {
            let bytes = binary(if big { "big" } else { "little" });
            prop_assert!(parse(&bytes[..bytes.len() - cut], "stem").is_err());
        }

        #[test]
        fn changed_bytes_never_panic(at in 0usize..270, byte: u8) {
            let mut bytes = binary("little");
            let last = bytes.len() - 1;
            bytes[at.min(last)] = byte;
            let _ = parse(&bytes, "stem");
        }
    }
}
