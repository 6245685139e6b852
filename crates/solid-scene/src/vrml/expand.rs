//! Writing out the instances of PROTOs and Inlines.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::document::{Document, FILE, Kind};
use super::graph::{Call, Graph, Node, Scope};
use super::library::{Library, Located};
use super::limits::{DEPTH_MAX, INLINE_DEPTH_MAX, NODES_MAX, URL_BYTES, URLS_MAX};
use crate::error::SceneError;
use crate::file::canonical;
use crate::text::quoted;
use crate::warnings::Warnings;

/// The fields through which nodes hold others that matter to collisions.
const CHILD_FIELDS: [&str; 6] = ["children", "choice", "level", "proxy", "geometry", "coord"];

/// All nodes of a file and of what it inlines, and the files that these are in. The first scope is the file.
pub(super) fn expand(file: &Path, warnings: &mut Warnings) -> Result<(Graph, Vec<PathBuf>), SceneError> {
    let mut library = Library::default();
    let key: Rc<Path> = canonical(file).into();
    let document = library.open(file, &key, warnings)?;
    let mut expansion = Expansion {
        graph: Graph::default(),
        library,
        warnings,
        seen: HashSet::new(),
        open: vec![key],
        nodes: 0,
        urls: 0,
        depth: 0,
    };
    let scope = expansion.graph.add(Scope { document, context: FILE, call: None });
    expansion.scope(scope)?;
    Ok((expansion.graph, expansion.library.into_files()))
}

/// A file that a node names, and what follows the `#`.
struct Opened {
    document: Rc<Document>,
    fragment: Option<String>,
}

struct Expansion<'a> {
    graph: Graph,
    library: Library,
    warnings: &'a mut Warnings,
    seen: HashSet<Node>,
    /// The files around, from the outermost.
    open: Vec<Rc<Path>>,
    nodes: usize,
    urls: usize,
    depth: usize,
}

impl Expansion<'_> {
    fn scope(&mut self, scope: usize) -> Result<(), SceneError> {
        let roots: Vec<Node> = self.graph.roots(scope).collect();
        roots.into_iter().try_for_each(|root| self.visit(root))
    }

    fn visit(&mut self, node: Node) -> Result<(), SceneError> {
        if !self.seen.insert(node) {
            return Ok(());
        }
        self.nodes += 1;
        if self.nodes > NODES_MAX {
            return Err(self
                .graph
                .error(node, format!("PROTOs and Inlines make more than {NODES_MAX} nodes")));
        }
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            return Err(self.graph.error(node, format!("nodes nest deeper than {DEPTH_MAX}")));
        }
        match self.graph.kind(node) {
            Kind::Builtin("Inline") => self.inline(node)?,
            Kind::Builtin("TimeSensor") => self.graph.sensors.push(node),
            Kind::Builtin(_) => self.children(node)?,
            Kind::Instance(proto) => {
                let document = self.graph.document(node).clone();
                self.instance(node, document, proto, node.scope)?;
            }
            Kind::Extern(urls) => {
                let urls = urls.to_vec();
                self.extern_instance(node, &urls)?;
            }
            Kind::Unknown => {}
        }
        self.depth -= 1;
        Ok(())
    }

    fn children(&mut self, node: Node) -> Result<(), SceneError> {
        for field in CHILD_FIELDS {
            self.graph.nodes(node, field).into_iter().try_for_each(|child| self.visit(child))?;
        }
        Ok(())
    }

    fn instance(
        &mut self,
        node: Node,
        document: Rc<Document>,
        proto: usize,
        defaults: usize,
    ) -> Result<(), SceneError> {
        let context = document.body(proto);
        let call = Some(Call { instance: node, proto, defaults });
        let scope = self.graph.add(Scope { document, context, call });
        self.graph.fill(node, scope);
        self.scope(scope)
    }

    fn extern_instance(&mut self, node: Node, urls: &[String]) -> Result<(), SceneError> {
        let Some(Opened { document, fragment }) = self.open(node, urls)? else { return Ok(()) };
        match document.find_proto(fragment.as_deref()) {
            Some(proto) => {
                let defaults =
                    self.graph.add(Scope { document: document.clone(), context: FILE, call: None });
                self.instance(node, document, proto, defaults)?;
            }
            None => {
                let name = quoted(&fragment.unwrap_or_default());
                let file = document.file().display();
                self.warn(node, format!("there is no PROTO {name} in {file}; passed over"));
            }
        }
        self.open.pop();
        Ok(())
    }

    fn inline(&mut self, node: Node) -> Result<(), SceneError> {
        let urls = self.graph.strings(node, "url").to_vec();
        let Some(Opened { document, .. }) = self.open(node, &urls)? else { return Ok(()) };
        let scope = self.graph.add(Scope { document, context: FILE, call: None });
        self.graph.fill(node, scope);
        self.scope(scope)?;
        self.open.pop();
        Ok(())
    }

    /// Opens the file that a node names, if it can be found, until it is popped from `open`.
    fn open(&mut self, node: Node, urls: &[String]) -> Result<Option<Opened>, SceneError> {
        self.urls += urls.iter().map(|url| 1 + url.len() / URL_BYTES).sum::<usize>();
        if self.urls > URLS_MAX {
            let message =
                format!("PROTOs and Inlines make more than {URLS_MAX} URLs; a long one counts several times");
            return Err(self.graph.error(node, message));
        }
        let Located { file, key, fragment } =
            match self.library.locate(self.graph.document(node).file(), urls) {
                Ok(located) => located,
                Err(reason) => {
                    self.warn(node, format!("{reason}; passed over"));
                    return Ok(None);
                }
            };
        if self.open.contains(&key) {
            let message = format!("{} holds itself by way of this", file.display());
            return Err(self.graph.error(node, message));
        }
        if self.open.len() > INLINE_DEPTH_MAX {
            return Err(self.graph.error(node, format!("files inline files deeper than {INLINE_DEPTH_MAX}")));
        }
        let document = self.library.open(&file, &key, self.warnings)?;
        self.open.push(key);
        Ok(Some(Opened { document, fragment }))
    }

    fn warn(&mut self, node: Node, message: String) {
        self.warnings.add(format!("{}: {message}", self.graph.describe(node)));
    }
}
