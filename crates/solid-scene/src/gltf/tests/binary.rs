//! Files that are binary, or neither.

use super::*;

#[test]
fn text_that_is_not_gltf_is_refused() {
    let deep = "[".repeat(1 << 20);
    for bytes in [&b""[..], b"{", b"glTF", b"glTF\x02\0\0\0\x0b\0\0\0", b"\xff\xfe", deep.as_bytes()] {
        assert!(parse(bytes, Path::new(""), None).is_err());
    }
}

#[test]
fn binary_files_are_read() {
    let part = parse(&binary(&everything()), Path::new(""), None).unwrap();
    assert_eq!(part.objects.len(), 2);
    let text = everything().parse().unwrap();
    assert_eq!(pose(&part, 1.5), pose(&text, 1.5));
}

/// The binary part is the first buffer and no other.
#[test]
fn only_the_first_buffer_may_be_the_binary_part() {
    let mut file = everything();
    let next = file.add("buffers", json!({"byteLength": 1}));
    let refused =
        |bytes: &[u8]| parse(bytes, Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned();
    assert_eq!(refused(&binary(&file)), format!("buffer {next} has no URI"));
    // Where the first has a URI the part is nobody's.
    let mut bytes = file.0.to_string().into_bytes();
    bytes.resize(bytes.len().next_multiple_of(4), b' ');
    let chunks =
        [&(bytes.len() as u32).to_le_bytes()[..], b"JSON", &bytes, &4u32.to_le_bytes(), b"BIN\0abcd"]
            .concat();
    let bytes = [&b"glTF\x02\0\0\0"[..], &(chunks.len() as u32 + 12).to_le_bytes(), &chunks].concat();
    assert_eq!(refused(&bytes), format!("buffer {next} has no URI"));
}

#[test]
fn a_binary_file_that_was_cut_off_says_so() {
    let bytes = binary(&everything());
    let refused =
        |end: usize| parse(&bytes[..end], Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned();
    assert_eq!(refused(11), "the file ends in its header, of 12 bytes; it has 11");
    let length = bytes.len();
    for present in [12, 100, length - 1] {
        assert_eq!(
            refused(present),
            format!("the header tells a length of {length} bytes; the file has {present}, so it was cut off")
        );
    }
}

#[test]
fn a_binary_file_of_another_version_says_so() {
    let mut bytes = binary(&everything());
    bytes[4] = 1;
    let message = parse(&bytes, Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned();
    assert_eq!(message, "the file is of glTF 1, in its binary form; expected 2");
}
