//! The nodes of a scene: those that are written in its files, once for each instance of a PROTO or Inline around them.
//!
//! A node is named by where it is written and in which [`Scope`]; nothing is copied. A node that USE puts in several
//! places is one node.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DQuat, DVec2, DVec3};

use super::document::{Context, Document, Kind, Proto, Syntax, Value};
use crate::error::SceneError;
use crate::fault::Fault;

/// A node: a scope, and where in the scope's file it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Node {
    pub scope: usize,
    pub syntax: Syntax,
}

/// A field of a node, as routes name it.
pub(super) type Slot = (Node, String);

/// An instance of a file or of the body of a PROTO.
#[derive(Debug)]
pub(super) struct Scope {
    pub document: Rc<Document>,
    pub context: Context,
    /// For the body of a PROTO: whose instance it is.
    pub call: Option<Call>,
}

/// An instance of a PROTO.
#[derive(Debug)]
pub(super) struct Call {
    pub instance: Node,
    pub proto: Proto,
    /// The scope of the nodes that stand in the defaults of the interface.
    pub defaults: usize,
}

/// The nodes of a scene.
#[derive(Debug, Default)]
pub(super) struct Graph {
    scopes: Vec<Scope>,
    /// What is inside of an instance of a PROTO, and of an Inline.
    contents: HashMap<Node, usize>,
    /// The TimeSensors.
    pub sensors: Vec<Node>,
}

impl Graph {
    /// Adds a scope.
    pub fn add(&mut self, scope: Scope) -> usize {
        self.scopes.push(scope);
        self.scopes.len() - 1
    }

    /// Says what is inside of a node.
    pub fn fill(&mut self, node: Node, scope: usize) {
        self.contents.insert(node, scope);
    }

    /// The scopes by number.
    pub fn scopes(&self) -> &[Scope] {
        &self.scopes
    }

    /// What is inside of an instance of a PROTO or of an Inline; `None` when it could not be found.
    pub fn contents(&self, node: Node) -> Option<usize> {
        self.contents.get(&node).copied()
    }

    /// The file that a node is written in.
    pub fn document(&self, node: Node) -> &Rc<Document> {
        &self.scopes[node.scope].document
    }

    /// The kind of a node.
    pub fn kind(&self, node: Node) -> Kind<'_> {
        self.document(node).kind(node.syntax)
    }

    /// The nodes at the top of a scope.
    pub fn roots(&self, scope: usize) -> impl Iterator<Item = Node> {
        let Scope { document, context, .. } = &self.scopes[scope];
        document.roots(*context).iter().flatten().map(move |&syntax| Node { scope, syntax })
    }

    /// The node itself, or for an instance of a PROTO the first node of its body, which it stands for.
    pub fn actual(&self, node: Node) -> Option<Node> {
        match self.kind(node) {
            Kind::Builtin(_) => Some(node),
            Kind::Instance(_) | Kind::Extern(_) => self.actual(self.roots(self.contents(node)?).next()?),
            Kind::Unknown => None,
        }
    }

    /// The type of a node of the standard; empty for others.
    pub fn type_name(&self, node: Node) -> &str {
        match self.kind(node) {
            Kind::Builtin(name) => name,
            _ => "",
        }
    }

    /// The value of a field, through any IS, with the scope of the nodes in it.
    pub fn value(&self, node: Node, name: &str) -> Option<(usize, &Value)> {
        let field = self.scopes[node.scope].document.field(node.syntax, name)?;
        let (Some(is), Some(call)) = (field.is, &self.scopes[node.scope].call) else {
            return Some((node.scope, field.value));
        };
        let given = self.document(call.instance).field(call.instance.syntax, is);
        if given.is_some_and(|given| given.written || given.is.is_some()) {
            return self.value(call.instance, is);
        }
        let default = self.scopes[node.scope].document.default(call.proto, is)?;
        Some((call.defaults, default))
    }

    /// An error about a node.
    pub fn error(&self, node: Node, message: impl std::fmt::Display) -> SceneError {
        self.document(node).error(node.syntax, message)
    }

    /// A fault of a node as an error.
    pub fn fault(&self, node: Node, fault: Fault) -> SceneError {
        let document = self.document(node);
        let error = fault.of(&self.describe(node)).in_file(document.file());
        SceneError { line: document.line(node.syntax), ..error }
    }

    /// The node as messages name it.
    pub fn describe(&self, node: Node) -> String {
        self.document(node).describe(node.syntax)
    }

    /// The nodes of a field of type SFNode or MFNode.
    pub fn nodes(&self, node: Node, name: &str) -> Vec<Node> {
        self.slots(node, name).into_iter().flatten().collect()
    }

    /// The nodes of a field of type SFNode or MFNode, with a `None` for each NULL.
    pub fn slots(&self, node: Node, name: &str) -> Vec<Option<Node>> {
        let Some((scope, value)) = self.value(node, name) else { return Vec::new() };
        let listed = match value {
            Value::SFNode(child) => std::slice::from_ref(child),
            Value::MFNode(children) => children,
            _ => &[],
        };
        listed.iter().map(|child| child.map(|syntax| Node { scope, syntax })).collect()
    }

    /// The node of a field of type SFNode, through instances of PROTOs.
    pub fn node(&self, node: Node, name: &str) -> Option<Node> {
        self.nodes(node, name).first().and_then(|&child| self.actual(child))
    }

    /// A flag.
    pub fn flag(&self, node: Node, name: &str) -> bool {
        matches!(self.value(node, name), Some((_, Value::SFBool(true))))
    }

    /// An integer.
    pub fn integer(&self, node: Node, name: &str) -> i32 {
        match self.value(node, name) {
            Some((_, Value::SFInt32(value))) => *value,
            _ => 0,
        }
    }

    /// A number, or an error when it is not finite.
    pub fn number(&self, node: Node, name: &str) -> Result<f64, SceneError> {
        let value = match self.value(node, name) {
            Some((_, Value::SFFloat(value) | Value::SFTime(value) | Value::SFDouble(value))) => *value,
            _ => 0.0,
        };
        self.finite(node, name, &[value])?;
        Ok(value)
    }

    /// A vector, or an error when it is not finite.
    pub fn vector(&self, node: Node, name: &str) -> Result<DVec3, SceneError> {
        let value = match self.value(node, name) {
            Some((_, Value::SFVec3f(v) | Value::SFVec3d(v))) => DVec3::new(v.x, v.y, v.z),
            _ => DVec3::ZERO,
        };
        self.finite(node, name, &value.to_array())?;
        Ok(value)
    }

    /// A rotation, or an error when it is not finite.
    pub fn rotation(&self, node: Node, name: &str) -> Result<DQuat, SceneError> {
        let raw = match self.value(node, name) {
            Some((_, Value::SFRotation(rotation))) => rotation.raw(),
            _ => [0.0, 0.0, 1.0, 0.0],
        };
        self.finite(node, name, &raw)?;
        Ok(quaternion(raw))
    }

    /// Integers.
    pub fn integers(&self, node: Node, name: &str) -> &[i32] {
        match self.value(node, name) {
            Some((_, Value::MFInt32(values))) => values,
            _ => &[],
        }
    }

    /// Strings.
    pub fn strings(&self, node: Node, name: &str) -> &[String] {
        match self.value(node, name) {
            Some((_, Value::MFString(values))) => values,
            _ => &[],
        }
    }

    /// How many numbers a field holds.
    pub fn count(&self, node: Node, name: &str) -> usize {
        self.value(node, name).map_or(0, |(_, value)| value.len())
    }

    /// Numbers, or an error when one is not finite.
    pub fn numbers(&self, node: Node, name: &str) -> Result<Vec<f64>, SceneError> {
        let values = match self.value(node, name) {
            Some((_, Value::MFFloat(values) | Value::MFVec2f(values) | Value::MFVec3f(values))) => {
                values.iter().map(|&value| f64::from(value)).collect()
            }
            Some((_, Value::MFRotation(values))) => values.clone(),
            _ => Vec::new(),
        };
        self.finite(node, name, &values)?;
        Ok(values)
    }

    /// Vectors of two, or an error when one is not finite.
    pub fn vectors2(&self, node: Node, name: &str) -> Result<Vec<DVec2>, SceneError> {
        Ok(self.numbers(node, name)?.chunks_exact(2).map(DVec2::from_slice).collect())
    }

    /// Vectors, or an error when one is not finite.
    pub fn vectors(&self, node: Node, name: &str) -> Result<Vec<DVec3>, SceneError> {
        Ok(self.numbers(node, name)?.chunks_exact(3).map(DVec3::from_slice).collect())
    }

    /// Rotations, or an error when one is not finite.
    pub fn rotations(&self, node: Node, name: &str) -> Result<Vec<DQuat>, SceneError> {
        let raw = self.numbers(node, name)?;
        Ok(raw.chunks_exact(4).map(|r| quaternion([r[0], r[1], r[2], r[3]])).collect())
    }

    fn finite(&self, node: Node, name: &str, values: &[f64]) -> Result<(), SceneError> {
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(self.error(node, format!("{name} holds {value}; expected finite numbers"))),
            None => Ok(()),
        }
    }
}

/// The rotation of an axis and an angle. An axis of length zero, which exporters write for no rotation, is none.
fn quaternion([x, y, z, angle]: [f64; 4]) -> DQuat {
    let axis = DVec3::new(x, y, z);
    // Scaled first, so that the length of a tiny or huge axis neither vanishes nor overflows.
    let axis = (axis / axis.abs().max_element()).try_normalize();
    match axis {
        Some(axis) if angle != 0.0 => DQuat::from_axis_angle(axis, angle),
        _ => DQuat::IDENTITY,
    }
}
