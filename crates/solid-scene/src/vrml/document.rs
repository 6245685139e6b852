//! A parsed file. The only place that knows the parser, the crate vrml97.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use vrml97::fields::{FieldValue, access};
use vrml97::scene::{FieldLoc, FieldRef, Node, NodeKind, ProtoRef, ROOT, Scene};

use super::scan::{MARK, Mark, as_written, handed_on, scan};
use super::{vectors, wide};
use crate::error::SceneError;
use crate::text::{quoted, with_words_cut};

/// A node as written in a file, by its place in the file.
pub(super) type Syntax = u32;

/// A part of a file with names of its own: the file itself, or the body of a PROTO.
pub(super) type Context = usize;

/// The context of the file itself.
pub(super) const FILE: Context = ROOT;

/// A PROTO of a file.
pub(super) type Proto = usize;

/// What kind of node it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind<'a> {
    /// A node of the standard, by the name of its type.
    Builtin(&'a str),
    /// An instance of a PROTO of the same file.
    Instance(Proto),
    /// An instance of an EXTERNPROTO, by where it is declared.
    Extern(&'a [String]),
    /// Nothing known.
    Unknown,
}

/// The value of a field, as written or by default.
pub(super) type Value = FieldValue;

/// A field of a node.
#[derive(Debug)]
pub(super) struct Field<'a> {
    pub value: &'a Value,
    /// Whether the file gives it a value.
    pub written: bool,
    /// The name in the interface of the PROTO around that it has its value from by IS. An eventIn or eventOut has none to give: where
    /// these alone are connected, the value is that of the field itself.
    pub is: Option<&'a str>,
}

/// A ROUTE between two nodes of one context, by the plain names of the fields ("translation", not "set_translation").
#[derive(Clone, Debug)]
pub(super) struct Route {
    pub from: (Syntax, String),
    pub to: (Syntax, String),
}

/// A parsed file.
#[derive(Debug)]
pub(super) struct Document {
    file: PathBuf,
    scene: Scene,
    /// How many nodes are written in it.
    pub written: usize,
    /// The line and name of each node that is written; empty when they can't be told.
    marks: Vec<Option<Mark>>,
    /// The fields that are connected to a name of a PROTO's interface.
    connected: HashMap<(Proto, String), Vec<(Syntax, String)>>,
}

impl Document {
    /// Parses a file's text, where so many nodes were written in files before, and warns of what is passed over.
    pub fn parse(
        file: &Path,
        text: &str,
        nodes_before: usize,
        mut warn: impl FnMut(String),
    ) -> Result<Document, SceneError> {
        let scanned = scan(file, text, nodes_before)?;
        let written = scanned.nodes.len();
        let parse = |text: &str| vrml97::Parser::new(text, "").parse();
        let mut scene = parse(&scanned.text).map_err(|error| {
            let stops_at = |text: &str| parse(text).err().map(|error| error.line);
            let message = wide::message(&scanned, error.line, stops_at)
                .unwrap_or_else(|| with_words_cut(&in_our_words(&as_written(&error.message))));
            SceneError::new(file, Some(error.line), message)
        })?;
        for warning in std::mem::take(&mut scene.warnings) {
            warn(with_words_cut(&warning_in_our_words(&as_written(&warning))));
        }
        vectors::uneven(&scanned.text, warn);
        let marks = marks(scanned.nodes, &scene);
        let connected = connections(&scene);
        Ok(Document { file: file.to_owned(), scene, written, marks, connected })
    }

    /// The file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The nodes at the top of a context; `None` for a NULL or an unknown one.
    pub fn roots(&self, context: Context) -> &[Option<Syntax>] {
        &self.scene.ctx(context).root_nodes
    }

    /// The ROUTEs of a context.
    pub fn routes(&self, context: Context) -> impl Iterator<Item = Route> {
        let name = |node, loc: FieldLoc| self.scene.field(node, loc).name.clone();
        self.scene.ctx(context).routes.iter().map(move |route| Route {
            from: (route.source_node, name(route.source_node, route.source_loc)),
            to: (route.destination_node, name(route.destination_node, route.destination_loc)),
        })
    }

    /// What kind of node it is.
    pub fn kind(&self, node: Syntax) -> Kind<'_> {
        match self.scene.node(node).kind {
            NodeKind::Builtin(index) => Kind::Builtin(&self.scene.table.types[index].name),
            NodeKind::Instance(ProtoRef::Proto(proto)) => Kind::Instance(proto),
            NodeKind::Instance(ProtoRef::Extern(proto)) => Kind::Extern(&self.scene.externprotos[proto].url),
            NodeKind::Placeholder | NodeKind::Internal(_) => Kind::Unknown,
        }
    }

    /// The name of the node's type or PROTO.
    pub fn type_name(&self, node: Syntax) -> String {
        as_written(&self.scene.type_name(node))
    }

    /// The name that DEF gives.
    pub fn name(&self, node: Syntax) -> Option<&str> {
        match self.marks.get(node as usize) {
            Some(mark) => mark.as_ref()?.name.as_deref(),
            None => Some(self.scene.node(node).name.trim_start_matches(MARK)).filter(|name| !name.is_empty()),
        }
    }

    /// The line on which the node begins.
    pub fn line(&self, node: Syntax) -> Option<usize> {
        Some(self.marks.get(node as usize)?.as_ref()?.line)
    }

    /// A field of a node, by its name in the standard.
    pub fn field(&self, node: Syntax, name: &str) -> Option<Field<'_>> {
        let index = self.scene.get_predefined_field(node, name)?;
        let field = &self.scene.node(node).fields[index];
        let gives_value =
            |&reference: &&FieldRef| self.interface(*reference).access & access::INITIALIZE_ONLY != 0;
        let is = field.references.iter().find(gives_value);
        let is = is.map(|reference| self.interface(*reference).name.as_str());
        Some(Field { value: &field.value, written: field.modified, is })
    }

    /// Whether the events that a field receives leave it again: an exposedField.
    pub fn passes_events(&self, node: Syntax, name: &str) -> bool {
        let field = self.scene.get_predefined_field(node, name);
        field.is_some_and(|index| self.scene.node(node).fields[index].access == access::INPUT_OUTPUT)
    }

    /// The body of a PROTO.
    pub fn body(&self, proto: Proto) -> Context {
        self.scene.protos[proto].body
    }

    /// The default of a field in the interface of a PROTO.
    pub fn default(&self, proto: Proto, name: &str) -> Option<&Value> {
        self.scene.protos[proto].fields.iter().find(|field| field.name == name).map(|field| &field.value)
    }

    /// The fields inside of a PROTO that are connected to a name of its interface.
    pub fn connected(&self, proto: Proto, name: &str) -> &[(Syntax, String)] {
        self.connected.get(&(proto, name.to_owned())).map_or(&[], Vec::as_slice)
    }

    /// The PROTO of a name, or the first one for no name.
    pub fn find_proto(&self, name: Option<&str>) -> Option<Proto> {
        let protos = &self.scene.ctx(FILE).protos;
        match name {
            Some(name) => protos.get(&handed_on(name)),
            None => protos.values().first().copied(),
        }
    }

    /// The node as messages name it: its type and its name.
    pub fn describe(&self, node: Syntax) -> String {
        match self.name(node) {
            Some(name) => format!("{} {}", quoted(&self.type_name(node)), quoted(name)),
            None => quoted(&self.type_name(node)),
        }
    }

    /// An error about a node.
    pub fn error(&self, node: Syntax, message: impl std::fmt::Display) -> SceneError {
        SceneError::new(&self.file, self.line(node), format!("{}: {message}", self.describe(node)))
    }

    fn interface(&self, reference: FieldRef) -> &vrml97::scene::Field {
        &self.scene.protos[reference.proto].fields[reference.index]
    }
}

/// The mark of each node of a scene, of those that the scan found; none of one that stands where USE names what is not known.
fn marks(found: Vec<Mark>, scene: &Scene) -> Vec<Option<Mark>> {
    let is_written = |node: &Node| !matches!(node.kind, NodeKind::Placeholder);
    if scene.nodes.iter().filter(|node| is_written(node)).count() != found.len() {
        return Vec::new();
    }
    let mut found = found.into_iter();
    scene.nodes.iter().map(|node| if is_written(node) { found.next() } else { None }).collect()
}

/// Which fields are connected to which names of interfaces.
fn connections(scene: &Scene) -> HashMap<(Proto, String), Vec<(Syntax, String)>> {
    let mut connected: HashMap<_, Vec<_>> = HashMap::new();
    for (node, syntax) in scene.nodes.iter().zip(0..) {
        for field in &node.fields {
            for reference in &field.references {
                let name = scene.protos[reference.proto].fields[reference.index].name.clone();
                connected.entry((reference.proto, name)).or_default().push((syntax, field.name.clone()));
            }
        }
    }
    connected
}

/// The parser's errors say what it could not do; this says what was expected.
fn in_our_words(message: &str) -> String {
    let message = message.trim_end_matches('.');
    if let Some(field) = message.strip_prefix("Couldn't read value for field ") {
        return format!("expected a value for the field {field}");
    }
    if let Some((field, class)) = of_class(message, " in class ") {
        return format!("{field} is no field of {class}; expected one of its fields or '}}'");
    }
    if let Some(message) = of_connection(message) {
        return message;
    }
    match message {
        "Unknown statement" => "expected a node, DEF, USE, PROTO or ROUTE".into(),
        "Expected ']'" => "expected one more value or ']'".into(),
        "No name given after DEF" => "expected a name after DEF".into(),
        "No name given after USE" => "expected a name after USE".into(),
        "No name give after IS statement" => "expected a name after IS".into(),
        "Invalid PROTO definition name" => "expected a name after PROTO".into(),
        "Invalid EXTERNPROTO definition name" => "expected a name after EXTERNPROTO".into(),
        "IS statement outside PROTO definition" => "IS stands outside of a PROTO; expected a value".into(),
        "Invalid color name" => "expected a colour of three numbers".into(),
        _ => message.replacen("Expected", "expected", 1),
    }
}

/// What is wrong with an IS, in a message that names a field and the name of an interface.
fn of_connection(message: &str) -> Option<String> {
    let (names, wrong) = message.strip_prefix("Field ")?.split_once(" in PROTO ")?;
    let (field, name) = names.split_once(" and ")?;
    let expected = if wrong.ends_with("have different types") {
        "two of one type"
    } else if wrong.ends_with("are incompatible as an IS mapping") {
        "two of one kind (field, eventIn, eventOut or exposedField), or an exposedField before IS"
    } else {
        return None;
    };
    Some(format!("{field} IS {name}: expected {expected}"))
}

/// The parser's warnings say what it does not know; this says what becomes of it.
fn warning_in_our_words(warning: &str) -> String {
    let rest = warning.strip_prefix("Parser error at ").unwrap_or(warning);
    let rest = rest.split(". You probably have insufficient").next().unwrap_or(rest);
    let warning = rest.replacen(". Error: ", ": ", 1).trim_end_matches('.').to_owned();
    if let Some(name) = warning.strip_prefix("Parser: Named or imported node ") {
        let name = name.strip_suffix(" not found").unwrap_or(name);
        return format!("USE {name}: the node of that name is not known; passed over");
    }
    let Some((place, what)) = warning.split_once(": ") else { return warning };
    let what = if let Some((name, _)) =
        what.strip_prefix("No such event or field ").and_then(|rest| rest.split_once(" inside PROTO"))
    {
        format!("{name} is no field or event of the PROTO around; the IS is passed over")
    } else if let Some((access, field)) =
        what.strip_prefix("Couldn't assign value to ").and_then(|rest| rest.split_once(" field "))
    {
        let event = if access == "outputOnly" { "an eventOut" } else { "an eventIn" };
        format!("{field} is {event}, which has no value; passed over")
    } else if let Some(name) = what.strip_prefix("Unknown node type or proto ") {
        format!("{name} is no node of VRML97, and no PROTO before; passed over")
    } else if let Some(name) = what.strip_prefix("Unknown named or imported node ") {
        format!("no DEF before gives the name {name}; the ROUTE is passed over")
    } else if let Some((field, class)) = of_class(what, " in node class ") {
        format!("{class} has no field or event {field}; the ROUTE is passed over")
    } else if let Some((field, class)) = of_class(what, " in class ") {
        format!("{class} has no field {field}; passed over")
    } else {
        return warning;
    };
    format!("{place}: {what}")
}

/// The field and the node in a message about one that is not known.
fn of_class<'a>(message: &'a str, between: &str) -> Option<(&'a str, &'a str)> {
    message.strip_prefix("Unknown field ")?.split_once(between)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(body: &str) -> Result<Document, SceneError> {
        Document::parse(Path::new("a.wrl"), &format!("#VRML V2.0 utf8\n{body}"), 0, |_| {})
    }

    #[test]
    fn a_connection_of_what_does_not_fit_is_told() {
        let message = |interface: &str, field: &str| {
            parse(&format!("PROTO P [ {interface} ]\n{{ Collision {{ {field} }} }}")).unwrap_err().to_string()
        };
        let kinds =
            "two of one kind (field, eventIn, eventOut or exposedField), or an exposedField before IS";
        assert_eq!(
            message("exposedField SFNode p NULL", "proxy IS p"),
            format!("a.wrl:3: 'proxy' IS 'p': expected {kinds}")
        );
        assert_eq!(
            message("field SFFloat p 1", "bboxSize IS p"),
            "a.wrl:3: 'bboxSize' IS 'p': expected two of one type"
        );
    }

    #[test]
    fn errors_tell_the_line_and_what_was_expected() {
        let message = |body| parse(body).unwrap_err().to_string();
        assert_eq!(
            message("Shape {\n geometry Box { size 1 1 }\n}"),
            "a.wrl:3: expected a value for the field 'size'"
        );
        assert_eq!(
            message("Box {\n Sphere {} }"),
            "a.wrl:3: 'Sphere' is no field of 'Box'; expected one of its fields or '}'"
        );
        assert_eq!(message("Coordinate { point [ 1 2 x ] }"), "a.wrl:2: expected one more value or ']'");
        assert_eq!(message("\n7"), "a.wrl:3: expected a node, DEF, USE, PROTO or ROUTE");
    }

    #[test]
    fn what_is_missing_is_told() {
        let message = |body: &str| parse(body).unwrap_err().to_string();
        for word in ["DEF", "USE", "PROTO", "EXTERNPROTO"] {
            assert_eq!(message(&format!("\n{word} 1a")), format!("a.wrl:3: expected a name after {word}"));
        }
        assert_eq!(
            message("PROTO P [ field SFVec3f s 1 1 1 ] { Box { size IS 1 } }"),
            "a.wrl:2: expected a name after IS"
        );
        assert_eq!(message("Box { size IS s }"), "a.wrl:2: IS stands outside of a PROTO; expected a value");
        assert_eq!(
            message("Material { diffuseColor 1 }"),
            "a.wrl:2: expected a value for the field 'diffuseColor'"
        );
        assert_eq!(
            message("Material { diffuseColor nosuch }"),
            "a.wrl:2: expected a colour of three numbers"
        );
    }

    #[test]
    fn warnings_say_what_becomes_of_it() {
        let warning = |body: &str| {
            let mut warnings = Vec::new();
            let text = format!("#VRML V2.0 utf8\n{body}");
            Document::parse(Path::new("a.wrl"), &text, 0, |warning| warnings.push(warning)).unwrap();
            warnings.pop().unwrap()
        };
        for (body, expected) in [
            (
                "PROTO P [] { Box { size IS s } }",
                "line 2: 's' is no field or event of the PROTO around; the IS is passed over",
            ),
            (
                "PROTO P [] { Script { field SFBool a IS s } }",
                "line 2: 's' is no field or event of the PROTO around; the IS is passed over",
            ),
            (
                "\nGroup { addChildren Box {} }",
                "line 3: 'addChildren' is an eventIn, which has no value; passed over",
            ),
            ("TimeSensor { time 1 }", "line 2: 'time' is an eventOut, which has no value; passed over"),
            ("DEF X Other {} USE X", "USE 'X': the node of that name is not known; passed over"),
        ] {
            assert_eq!(warning(body), expected);
        }
    }

    #[test]
    fn integers_of_more_than_32_bits_are_told_as_written() {
        let message = |body: &str| parse(body).unwrap_err().to_string();
        let most = "expected an integer of at most 2147483647";
        assert_eq!(
            message("ElevationGrid {\n xDimension 3000000000 zDimension 2 }"),
            format!("a.wrl:3: xDimension holds 3000000000; {most}")
        );
        assert_eq!(
            message("Shape { geometry IndexedFaceSet {\ncoordIndex [ 0, 1 2 -1\n 1 +4294967298 -1 ] } }"),
            format!("a.wrl:4: coordIndex holds +4294967298; {most}")
        );
        assert_eq!(
            message("Switch { whichChoice -2147483649 }"),
            "a.wrl:2: whichChoice holds -2147483649; expected an integer of at least -2147483648"
        );
        let long = "9".repeat(1000);
        assert_eq!(
            message(&format!("Switch {{ whichChoice {long} }}")),
            format!("a.wrl:2: whichChoice holds {}...; {most}", &long[..80])
        );
        // Of several in a line, the one at which an integer is wanted.
        let point = "Coordinate { point [ 3000000000 -99999999999e2,5-3000000000 ";
        assert_eq!(
            message(&format!("Group {{}} {point} ] }} Switch {{ whichChoice 4000000000 }}")),
            format!("a.wrl:2: whichChoice holds 4000000000; {most}")
        );
        assert_eq!(message(&format!("{point} x ] }}")), "a.wrl:2: expected one more value or ']'");
        assert!(parse(&format!("{point} ] }}")).is_ok());
    }

    #[test]
    fn nodes_know_their_lines() {
        let document = parse("Group {\nchildren [\nNonsense { a 1 }\nDEF S Shape {\n} ] }").unwrap();
        let lines: Vec<_> = (0..3).map(|node| document.line(node)).collect();
        assert_eq!(lines, [Some(2), Some(4), Some(5)]);
        assert_eq!(document.describe(2), "Shape S");
        // What USE has of a node that is not known stands between.
        let document = parse("DEF X Other {} DEF A Group { children [ USE X\nDEF A Shape {} ] }").unwrap();
        assert_eq!((document.line(3), document.describe(3)), (Some(3), "Shape A".into()));
    }

    #[test]
    fn a_proto_connects_its_interface() {
        let document =
            parse("PROTO P [ field SFVec3f s 1 1 1 ] { DEF B Box { size IS s } } P { s 2 2 2 }").unwrap();
        let proto = document.find_proto(Some("P")).unwrap();
        assert_eq!(document.connected(proto, "s"), [(0, "size".to_owned())]);
        assert_eq!(document.field(0, "size").unwrap().is, Some("s"));
        assert!(document.field(1, "s").unwrap().written);
        assert_eq!(document.kind(1), Kind::Instance(proto));
    }

    /// Far too large an image made the parser panic.
    #[test]
    fn an_image_of_absurd_size_is_an_error() {
        assert!(parse("PixelTexture { image -2147483649 2147483647 1 }").is_err());
    }
}
