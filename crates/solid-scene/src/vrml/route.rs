//! ROUTEs, through the interfaces of PROTOs.

use std::collections::HashMap;

use super::document::Kind;
use super::graph::{Graph, Node, Slot};
use super::limits::{FILE_ROUTES_MAX, NODES_MAX};
use super::scan::as_written;
use crate::error::SceneError;

/// For every field that receives events, the fields that send them, in the order of the file.
#[derive(Debug, Default)]
pub(super) struct Routes {
    incoming: HashMap<Slot, Vec<Slot>>,
}

impl Routes {
    /// Collects the ROUTEs of all scopes.
    pub fn collect(graph: &Graph) -> Result<Routes, SceneError> {
        let mut routes = Routes::default();
        let mut total = 0;
        for (number, scope) in graph.scopes().iter().enumerate() {
            for route in scope.document.routes(scope.context) {
                let at = |(syntax, field)| (Node { scope: number, syntax }, field);
                let (from, to) = (ends(graph, at(route.from))?, ends(graph, at(route.to))?);
                total += 1 + from.len() + to.len() + from.len() * to.len();
                if total > NODES_MAX {
                    let file = scope.document.file();
                    return Err(SceneError::new(
                        file,
                        None,
                        format!("PROTOs make more than {NODES_MAX} ROUTEs"),
                    ));
                }
                for end in to {
                    routes.incoming.entry(end).or_default().extend(from.iter().cloned());
                }
            }
        }
        Ok(routes)
    }

    /// The fields that send to a field.
    pub fn sources(&self, slot: &Slot) -> &[Slot] {
        self.incoming.get(slot).map_or(&[], Vec::as_slice)
    }

    /// The fields that receive something.
    pub fn destinations(&self) -> impl Iterator<Item = &Slot> {
        self.incoming.keys()
    }
}

/// The fields of built-in nodes that a field of an instance of a PROTO stands for; any other field stands for itself.
fn ends(graph: &Graph, slot: Slot) -> Result<Vec<Slot>, SceneError> {
    let mut ends = Vec::new();
    let mut rest = vec![slot];
    while let Some((node, field)) = rest.pop() {
        if ends.len() + rest.len() > FILE_ROUTES_MAX {
            let field = as_written(&field);
            return Err(graph.error(node, format!("{field} stands for more than {FILE_ROUTES_MAX} fields")));
        }
        let call = graph.contents(node).and_then(|scope| Some((scope, graph.scopes()[scope].call.as_ref()?)));
        match (graph.kind(node), call) {
            (Kind::Builtin(_), _) => ends.push((node, field)),
            (_, Some((scope, call))) => {
                let inside = graph.scopes()[scope].document.connected(call.proto, &field);
                rest.extend(
                    inside.iter().map(|(syntax, field)| (Node { scope, syntax: *syntax }, field.clone())),
                );
            }
            (_, None) => {}
        }
    }
    Ok(ends)
}
