//! A look through the text before it is parsed.
//!
//! The parser (the crate vrml97) is recursive, takes memory and time for granted, and does not say where a node stands.
//! This pass bounds the nesting, refuses what would cost it quadratic time or memory, and finds the line of every node.
//! It also hands on a text of the same lines that means the same in VRML97 and in the parser's dialect:
//!
//! * comments are blank, because `#/*` opens a comment over several lines in the dialect;
//! * a decimal integer below -2^31 or above 2^31 - 1, in an image above 2^32 - 1, gets a decimal point: it is a legal float, but
//!   the parser takes an integer by its lowest 32 bits, and one so low as the size of an image makes it panic. Where an integer is
//!   wanted the parser stops at the point, and [`super::wide`] says why. A hexadecimal one above 32 bits is refused here;
//! * a name that begins with a word of the language, as USER and ISLAND do, has a [`MARK`] before that, as the parser takes the word and
//!   goes on in the middle of the name. Where such a word follows a number without space it is refused.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::RangeInclusive;
use std::path::Path;

use super::limits::*;
use crate::error::SceneError;
use crate::text::quoted;

/// The types of nodes of the standard (ISO/IEC 14772-1, 6).
const STANDARD_NODES: [&str; 54] = [
    "Anchor",
    "Appearance",
    "AudioClip",
    "Background",
    "Billboard",
    "Box",
    "Collision",
    "Color",
    "ColorInterpolator",
    "Cone",
    "Coordinate",
    "CoordinateInterpolator",
    "Cylinder",
    "CylinderSensor",
    "DirectionalLight",
    "ElevationGrid",
    "Extrusion",
    "Fog",
    "FontStyle",
    "Group",
    "ImageTexture",
    "IndexedFaceSet",
    "IndexedLineSet",
    "Inline",
    "LOD",
    "Material",
    "MovieTexture",
    "NavigationInfo",
    "Normal",
    "NormalInterpolator",
    "OrientationInterpolator",
    "PixelTexture",
    "PlaneSensor",
    "PointLight",
    "PointSet",
    "PositionInterpolator",
    "ProximitySensor",
    "ScalarInterpolator",
    "Script",
    "Shape",
    "Sound",
    "Sphere",
    "SphereSensor",
    "SpotLight",
    "Switch",
    "Text",
    "TextureCoordinate",
    "TextureTransform",
    "TimeSensor",
    "TouchSensor",
    "Transform",
    "Viewpoint",
    "VisibilitySensor",
    "WorldInfo",
];

/// What an integer may be.
const INTEGERS: RangeInclusive<f64> = i32::MIN as f64..=i32::MAX as f64;

/// What an integer of an image may be, of which a pixel has no sign.
const PIXELS: RangeInclusive<f64> = i32::MIN as f64..=u32::MAX as f64;

/// Stands before what begins with a word of the language but is a name. No text has it.
pub(super) const MARK: char = '\u{ffff}';

/// Words of the language with which names may begin.
const KEYWORDS: [&str; 12] =
    ["DEF", "USE", "NULL", "null", "IS", "ROUTE", "PROTO", "EXTERNPROTO", "TRUE", "true", "FALSE", "false"];

/// Words of the parser's dialect alone, which are names as a whole, too.
const WORDS_OF_DIALECT: [&str; 2] = ["IMPORT", "EXPORT"];

/// With what a declaration begins; the parser wants no space after it.
const DECLARATIONS: [&str; 8] = [
    "field",
    "eventIn",
    "eventOut",
    "exposedField",
    "initializeOnly",
    "inputOnly",
    "outputOnly",
    "inputOutput",
];

/// How many digits of a hexadecimal integer 32 bits hold.
const HEX_DIGITS_MAX: usize = 8;

/// A text that is safe to parse.
#[derive(Debug)]
pub(super) struct Scanned {
    /// What to parse.
    pub text: String,
    /// Each node, in the order of the text.
    pub nodes: Vec<Mark>,
    /// Where integers that got a point begin in `text`, in order.
    pub wide: Vec<usize>,
}

/// Where a node stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// The line of its `{`.
    pub line: usize,
    /// The name that DEF gives it. The parser changes names that are given twice.
    pub name: Option<Box<str>>,
}

/// Checks a text; so many nodes were written in files before. Cost: O(n).
pub(super) fn scan(file: &Path, text: &str, nodes_before: usize) -> Result<Scanned, SceneError> {
    let mut scanner = Scanner { nodes_before, ..Scanner::new(file, text) };
    scanner.run()?;
    Ok(Scanned { text: scanner.out, nodes: scanner.nodes, wide: scanner.wide })
}

/// What an opening bracket opens.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Opened {
    Node,
    List,
    /// The interface of a PROTO, from a byte on.
    Interface(usize),
    /// The body of a PROTO whose interface takes so many bytes. It has names of its own.
    Body(usize),
}

/// A bracket that is open.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    opened: Opened,
    line: usize,
    /// Fields and events declared in it, not in those that it holds.
    declarations: usize,
}

/// What the next name is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expect {
    Anything,
    DefName,
    UseName,
    ProtoName,
    ExternProtoName,
    /// A name after ROUTE, TO and the like.
    OtherName,
}

/// A PROTO whose body has not begun, at a depth of brackets.
struct Declared<'a> {
    name: &'a str,
    depth: usize,
    interface: usize,
}

struct Scanner<'a> {
    file: &'a Path,
    text: &'a str,
    at: usize,
    line: usize,
    out: String,
    nodes: Vec<Mark>,
    /// Nodes of files that were read before.
    nodes_before: usize,
    wide: Vec<usize>,
    /// The last name that was no other's: before a number, that of its field.
    field: &'a str,
    /// The fields that hold images.
    images: HashSet<&'a str>,
    /// The name of a DEF whose node has not begun.
    def: Option<&'a str>,
    brackets: Vec<Bracket>,
    /// The names that DEF has given, one set for the file and one for each PROTO body around.
    names: Vec<HashSet<&'a str>>,
    declared: Vec<Declared<'a>>,
    /// The names that PROTO and EXTERNPROTO have given.
    protos: HashSet<&'a str>,
    /// Bytes of interface by the name of the PROTO.
    interfaces: HashMap<&'a str, usize>,
    copied: usize,
    routes: usize,
    declarations: usize,
    repeats: usize,
    proto_repeats: usize,
    /// The names that DEF gives to nodes of other types than those of the standard, until USE has them.
    others: HashSet<&'a str>,
    /// How many of these USE has had.
    others_used: usize,
    expect: Expect,
}

impl<'a> Scanner<'a> {
    fn new(file: &'a Path, text: &'a str) -> Self {
        Scanner {
            file,
            text,
            at: 0,
            line: 1,
            out: String::with_capacity(text.len()),
            nodes: Vec::new(),
            nodes_before: 0,
            wide: Vec::new(),
            field: "",
            images: HashSet::from(["image"]),
            def: None,
            brackets: Vec::new(),
            names: vec![HashSet::new()],
            declared: Vec::new(),
            protos: HashSet::new(),
            interfaces: HashMap::new(),
            copied: 0,
            routes: 0,
            declarations: 0,
            repeats: 0,
            proto_repeats: 0,
            others: HashSet::new(),
            others_used: 0,
            expect: Expect::Anything,
        }
    }

    fn run(&mut self) -> Result<(), SceneError> {
        self.header();
        while let Some(&byte) = self.text.as_bytes().get(self.at) {
            match byte {
                b'#' => self.comment(),
                b'"' => self.string()?,
                b'{' | b'[' => self.open(byte)?,
                b'}' | b']' => self.close(byte)?,
                _ if is_word(byte) => self.word()?,
                _ => self.other(byte),
            }
        }
        match self.brackets.last() {
            Some(&Bracket { line, .. }) => {
                let close = self.closing();
                self.fail(format!(
                    "the file ends where '{close}' was expected, for the bracket of line {line}"
                ))
            }
            None => self.check_counts(),
        }
    }

    /// The first line is a comment to VRML, but not to the parser.
    fn header(&mut self) {
        let end = self.text.find(['\r', '\n']).unwrap_or(self.text.len());
        self.copy(end);
    }

    fn comment(&mut self) {
        let rest = &self.text[self.at..];
        let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
        self.out.extend(std::iter::repeat_n(' ', end));
        self.at += end;
    }

    fn string(&mut self) -> Result<(), SceneError> {
        let Some(string) = string(&self.text[self.at..]) else {
            return self.fail("the string that begins here has no end; expected '\"'");
        };
        self.line += string.matches('\n').count();
        self.copy(self.at + string.len());
        self.expect = Expect::Anything;
        Ok(())
    }

    fn open(&mut self, byte: u8) -> Result<(), SceneError> {
        if self.brackets.len() == NESTING_MAX {
            return self.fail(format!("brackets nest deeper than {NESTING_MAX}"));
        }
        let opened = self.opened(byte);
        match opened {
            Opened::Body(_) => self.names.push(HashSet::new()),
            Opened::Node => {
                let name = self.def.take();
                self.others.extend(name.filter(|_| !STANDARD_NODES.contains(&self.field)));
                self.nodes.push(Mark { line: self.line, name: name.map(Box::from) });
            }
            Opened::List | Opened::Interface(_) => {}
        }
        if self.nodes_before + self.nodes.len() > WRITTEN_NODES_MAX {
            let which = if self.nodes_before == 0 { "the file has" } else { "with this file there are" };
            return self.fail(format!("{which} more than {WRITTEN_NODES_MAX} nodes"));
        }
        self.brackets.push(Bracket { opened, line: self.line, declarations: 0 });
        self.expect = Expect::Anything;
        self.copy(self.at + 1);
        Ok(())
    }

    fn opened(&mut self, byte: u8) -> Opened {
        let depth = self.brackets.len();
        let declares = self.declared.last().is_some_and(|declared| declared.depth == depth);
        match (byte, declares) {
            (b'{', true) => {
                let interface = self.declared.pop().map_or(0, |declared| {
                    self.interfaces.insert(declared.name, declared.interface);
                    declared.interface
                });
                Opened::Body(interface)
            }
            (b'{', false) => Opened::Node,
            (_, true) => Opened::Interface(self.at),
            (_, false) => Opened::List,
        }
    }

    fn close(&mut self, byte: u8) -> Result<(), SceneError> {
        let found = byte as char;
        let expected = self.closing();
        let Some(Bracket { opened, line, .. }) = self.brackets.pop() else {
            return self.fail(format!("'{found}' closes nothing; expected a node, PROTO or ROUTE"));
        };
        if found != expected {
            return self
                .fail(format!("expected '{expected}', for the bracket of line {line}, found '{found}'"));
        }
        match opened {
            Opened::Body(_) => drop(self.names.pop()),
            Opened::Interface(start) => {
                if let Some(declared) = self.declared.last_mut() {
                    declared.interface = self.at - start;
                }
            }
            Opened::Node | Opened::List => {}
        }
        self.expect = Expect::Anything;
        self.copy(self.at + 1);
        Ok(())
    }

    /// The bracket that closes the innermost open one.
    fn closing(&self) -> char {
        match self.brackets.last() {
            Some(Bracket { opened: Opened::List | Opened::Interface(_), .. }) => ']',
            _ => '}',
        }
    }

    fn word(&mut self) -> Result<(), SceneError> {
        let word = word(&self.text[self.at..]);
        if word.starts_with(|c: char| c.is_ascii_digit() || c == '+' || c == '-') {
            return self.number(word);
        }
        self.name(word)?;
        self.out.push_str(&handed_on(word));
        self.at += word.len();
        Ok(())
    }

    /// Copies a number, or several without space between.
    fn number(&mut self, word: &str) -> Result<(), SceneError> {
        let mut rest = word;
        // What follows a point is a fraction, no integer.
        let is_fraction = self.out.ends_with('.');
        if !is_fraction && has_wide_hex(word) {
            let message = format!("{} has more than 32 bits; expected at most 0xFFFFFFFF", quoted(word));
            return self.fail(message);
        }
        if let Some(keyword) = keyword_within(word) {
            let message =
                format!("{} holds {keyword}; expected a number, or space before that", quoted(word));
            return self.fail(message);
        }
        let range = if self.images.contains(self.field) { PIXELS } else { INTEGERS };
        let mut integer = if is_fraction { rest.find('-') } else { Some(0) };
        while let Some(start) = integer {
            let sign = usize::from(rest[start..].starts_with(['-', '+']));
            let digits = rest[start + sign..].bytes().take_while(u8::is_ascii_digit).count();
            let end = start + sign + digits;
            let begin = self.out.len() + start;
            self.out.push_str(&rest[..end]);
            if rest[start..end].parse::<f64>().is_ok_and(|value| !range.contains(&value)) {
                let next =
                    rest[end..].bytes().next().or(self.text.as_bytes().get(self.at + word.len()).copied());
                if next != Some(b'.') {
                    self.out.push('.');
                    self.wide.push(begin);
                }
            }
            rest = &rest[end..];
            integer = rest.find('-');
        }
        self.out.push_str(rest);
        self.at += word.len();
        self.expect = Expect::Anything;
        Ok(())
    }

    fn name(&mut self, word: &'a str) -> Result<(), SceneError> {
        let expect = std::mem::replace(&mut self.expect, Expect::Anything);
        match expect {
            Expect::DefName => {
                self.def = Some(word);
                let is_new = self.names.last_mut().is_some_and(|names| names.insert(word));
                self.repeats += usize::from(!is_new);
                return self.check_counts();
            }
            Expect::UseName => return self.check_use(word),
            Expect::ProtoName => {
                let depth = self.brackets.len();
                self.declared.push(Declared { name: word, depth, interface: 0 });
                return self.check_proto(word);
            }
            Expect::ExternProtoName => return self.check_proto(word),
            Expect::OtherName => {}
            Expect::Anything => return self.keyword_or_name(word),
        }
        Ok(())
    }

    fn keyword_or_name(&mut self, word: &'a str) -> Result<(), SceneError> {
        if std::mem::replace(&mut self.field, word) == "SFImage" {
            self.images.insert(word);
        }
        match word {
            "DEF" => self.expect = Expect::DefName,
            "USE" => self.expect = Expect::UseName,
            "PROTO" => self.expect = Expect::ProtoName,
            "EXTERNPROTO" => self.expect = Expect::ExternProtoName,
            "TO" => self.expect = Expect::OtherName,
            "ROUTE" => {
                self.expect = Expect::OtherName;
                self.routes += 1;
            }
            "IS" => {
                self.expect = Expect::OtherName;
                self.copied += self.body_interface();
            }
            _ if DECLARATIONS.iter().any(|begin| word.starts_with(begin)) => {
                self.declarations += 1;
                if let Some(bracket) = self.brackets.last_mut() {
                    bracket.declarations += 1;
                    if bracket.declarations > DECLARATIONS_MAX {
                        return self.fail(format!(
                            "the PROTO or Script has more than {DECLARATIONS_MAX} declared fields and events"
                        ));
                    }
                }
            }
            _ => self.copied += self.interfaces.get(word).copied().unwrap_or(0),
        }
        self.check_counts()
    }

    /// A node can be used after its DEF, in the same file or PROTO (ISO/IEC 14772-1, 4.4.4 and 4.6.2).
    fn check_use(&mut self, word: &str) -> Result<(), SceneError> {
        if !self.names.last().is_some_and(|names| names.contains(word)) {
            return self.fail(format!("USE {}: expected the name of a DEF that stands before", quoted(word)));
        }
        self.others_used += usize::from(self.others.remove(word));
        self.check_counts()
    }

    /// Counts a name that PROTO or EXTERNPROTO gives again, if in another PROTO.
    fn check_proto(&mut self, word: &'a str) -> Result<(), SceneError> {
        self.proto_repeats += usize::from(!self.protos.insert(word));
        self.check_counts()
    }

    fn check_counts(&self) -> Result<(), SceneError> {
        let counts = [
            (self.routes, FILE_ROUTES_MAX, "ROUTEs"),
            (self.declarations, FILE_DECLARATIONS_MAX, "declared fields and events"),
            (self.repeats, FILE_REPEATS_MAX, "names given again by DEF"),
            (self.proto_repeats, FILE_REPEATS_MAX, "names given again by PROTO and EXTERNPROTO"),
            (self.copied, COPIED_BYTES_MAX, "bytes of PROTO interfaces, counted for each instance"),
            (
                self.others_used.saturating_mul(self.nodes.len()),
                OTHERS_USED_MAX,
                "pairs of any node and one that USE names and that is of no type of VRML97",
            ),
        ];
        match counts.iter().find(|(count, most, _)| count > most) {
            Some((_, most, what)) => self.fail(format!("the file has more than {most} {what}")),
            None => Ok(()),
        }
    }

    /// The bytes of the interface of the PROTO whose body this is.
    fn body_interface(&self) -> usize {
        let body = |bracket: &Bracket| match bracket.opened {
            Opened::Body(interface) => Some(interface),
            _ => None,
        };
        self.brackets.iter().rev().find_map(body).unwrap_or(0)
    }

    fn other(&mut self, byte: u8) {
        if byte == b'\n' {
            self.line += 1;
        }
        self.copy(self.at + 1);
    }

    fn copy(&mut self, end: usize) {
        self.out.push_str(&self.text[self.at..end]);
        self.at = end;
    }

    fn fail<T>(&self, message: impl Into<String>) -> Result<T, SceneError> {
        Err(SceneError::new(self.file, Some(self.line), message))
    }
}

/// The string that begins here, with its quotes; `None` where it has no end.
pub(super) fn string(text: &str) -> Option<&str> {
    let (bytes, mut end) = (text.as_bytes(), 1);
    while *bytes.get(end)? != b'"' {
        end += if bytes[end] == b'\\' { 2 } else { 1 };
    }
    Some(&text[..=end])
}

/// The name, or number up to its point, that begins here.
pub(super) fn word(text: &str) -> &str {
    &text[..text.bytes().position(|byte| !is_word(byte)).unwrap_or(text.len())]
}

/// Whether a byte can be inside a name or a number without its point; all of any character outside of ASCII can.
pub(super) fn is_word(byte: u8) -> bool {
    !(byte <= 0x20
        || matches!(byte, b'"' | b'#' | b'\'' | b',' | b'.' | b'[' | b'\\' | b']' | b'{' | b'}' | 0x7f))
}

/// A name as the parser reads it: with a [`MARK`] where it begins with a word of the language, and `set_` before that begins no other name.
pub(super) fn handed_on(name: &str) -> Cow<'_, str> {
    let begin = if name.starts_with("set_") { "set_".len() } else { 0 };
    let (set, field) = name.split_at(begin);
    let goes_on = |word: &&str| field.len() > word.len() && field.starts_with(*word);
    match KEYWORDS.iter().any(goes_on) || WORDS_OF_DIALECT.iter().any(|word| field.starts_with(word)) {
        true => format!("{set}{MARK}{field}").into(),
        false => name.into(),
    }
}

/// What the parser or the graph say of names, with these as the file has them.
pub(super) fn as_written(text: &str) -> String {
    text.replace(MARK, "")
}

/// A word of the language that stands in a number, as the parser ends that before it.
fn keyword_within(number: &str) -> Option<&'static str> {
    let rest =
        hexadecimal(number).map_or(number, |rest| rest.trim_start_matches(|c: char| c.is_ascii_hexdigit()));
    KEYWORDS.into_iter().find(|keyword| rest.contains(keyword))
}

/// What follows the sign that a number is hexadecimal.
fn hexadecimal(word: &str) -> Option<&str> {
    word.strip_prefix("0x").or_else(|| word.strip_prefix("0X"))
}

/// Whether a hexadecimal integer that 32 bits do not hold begins here.
fn has_wide_hex(word: &str) -> bool {
    let Some(digits) = hexadecimal(word) else { return false };
    let digits = digits.trim_start_matches('0').bytes();
    digits.take_while(u8::is_ascii_hexdigit).count() > HEX_DIGITS_MAX
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(text: &str) -> Result<Scanned, SceneError> {
        scan(Path::new("a.wrl"), text, 0)
    }

    fn message(text: &str) -> String {
        run(text).unwrap_err().to_string()
    }

    #[test]
    fn comments_become_blank_and_strings_stay() {
        let scanned = run("#VRML V2.0 utf8\n#/* {\nWorldInfo { title \"# { \\\" [\" }").unwrap();
        assert_eq!(scanned.text, "#VRML V2.0 utf8\n     \nWorldInfo { title \"# { \\\" [\" }");
        assert_eq!(scanned.nodes, [Mark { line: 3, name: None }]);
    }

    #[test]
    fn the_body_of_a_proto_is_no_node_and_has_its_own_names() {
        let text = "#\nPROTO A [ field SFNode n NULL\n] {\nDEF X Group {} }\nA {}\n";
        let nodes = run(text).unwrap().nodes;
        assert_eq!(nodes, [Mark { line: 4, name: Some("X".into()) }, Mark { line: 5, name: None }]);
        let text = format!("{text}Group {{ children USE X }}");
        assert_eq!(message(&text), "a.wrl:6: USE X: expected the name of a DEF that stands before");
    }

    #[test]
    fn brackets_must_match() {
        assert_eq!(message("#\nA {\n[ }"), "a.wrl:3: expected ']', for the bracket of line 3, found '}'");
        assert_eq!(
            message("#\nA {\nb [ ]\n"),
            "a.wrl:4: the file ends where '}' was expected, for the bracket of line 2"
        );
        assert!(message("#\n}").contains("closes nothing"));
        assert!(message("#\nA { a \"x").contains("has no end"));
    }

    #[test]
    fn nesting_is_bounded() {
        let nested = |n: usize| format!("#\n{}{}", "A {".repeat(n), "}".repeat(n));
        assert!(run(&nested(NESTING_MAX)).is_ok());
        assert!(message(&nested(NESTING_MAX + 1)).contains("deeper than 256"));
    }

    #[test]
    fn integers_out_of_range_become_floats() {
        let text = "#\na -2147483649 -2147483648 5-99999999999 -99999999999.5 A-99999999999 -9999999999e2";
        let expected =
            "#\na -2147483649. -2147483648 5-99999999999. -99999999999.5 A-99999999999 -9999999999.e2";
        assert_eq!(run(text).unwrap().text, expected);
        let text =
            "#\na 2147483647 2147483648 +4294967298,4294967298.5 0.4294967298 99999999999e2 0xFFFFFFFF";
        let expected =
            "#\na 2147483647 2147483648. +4294967298.,4294967298.5 0.4294967298 99999999999.e2 0xFFFFFFFF";
        assert_eq!(run(text).unwrap().text, expected);
    }

    #[test]
    fn pixels_have_no_sign() {
        let text = |image: &str, other: &str| {
            format!(
                "#\nPixelTexture {{ image 1 1 4 {image} }} A {{ b {other} }}
                 PROTO P [ field SFImage a 1 1 4 {image} field SFFloat b {other} ] {{}} P {{ a 1 1 4 {image} b {other} }}"
            )
        };
        let scanned = run(&text("4294967295", "4294967295")).unwrap().text;
        assert_eq!(scanned, text("4294967295", "4294967295."));
        let scanned = run(&text("4294967296", "1")).unwrap().text;
        assert_eq!(scanned, text("4294967296.", "1"));
    }

    #[test]
    fn hexadecimal_integers_have_32_bits() {
        assert!(run("#\na 0x00000000FFFFFFFF 0XffffffffG 0.0x100000000 \"0x100000000\"").is_ok());
        for word in ["0x100000000", "0X0123456789"] {
            assert_eq!(
                message(&format!("#\na [ 0\n{word} ]")),
                format!("a.wrl:3: {word} has more than 32 bits; expected at most 0xFFFFFFFF")
            );
        }
    }

    #[test]
    fn copies_of_an_interface_are_bounded() {
        let interface = format!("field MFFloat a [{}]", " 1".repeat(1 << 16));
        let instances = "P {} ".repeat(1 << 12);
        let text = format!("#\nPROTO P [{interface}] {{}} {instances}");
        assert!(message(&text).contains("bytes of PROTO interfaces"));
    }
}
