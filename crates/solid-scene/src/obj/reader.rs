//! Reading the statements of an OBJ file.

use std::collections::HashMap;

use glam::DVec3;

use super::lines::statements;
use crate::fault::{Fault, Result};
use crate::polygon::short_warning;
use crate::text::{quoted, there_are, vertex};

/// What the statements say, in their order.
#[derive(Debug, Default)]
pub(super) struct Statements {
    pub vertices: Vec<DVec3>,
    /// The names of the groups, in order of first appearance; the first is for what stands before any.
    pub groups: Vec<String>,
    pub elements: Vec<Element>,
    /// The corners of all elements, one after the other. Invariant: each names a vertex.
    pub corners: Vec<u32>,
    short_faces: usize,
    free_forms: usize,
}

/// A face, line or point set.
#[derive(Debug)]
pub(super) struct Element {
    pub kind: ElementKind,
    /// Which of the groups it is in.
    pub group: usize,
    /// How many corners it has.
    pub corners: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ElementKind {
    Face,
    Line,
    Points,
}

/// Reads a file; what stands before any group is in a group of the given name.
pub(super) fn read(text: &str, first_group: &str) -> Result<Statements> {
    let mut reader = Reader::new(first_group);
    for (line, statement) in statements(text) {
        reader.statement(line, &statement)?;
    }
    reader.finish()
}

struct Reader {
    read: Statements,
    group: usize,
    /// The group that is the object which goes on, and may have others; before the first object that of the file.
    object: usize,
    /// Objects by their names, and groups by those of their objects and their own.
    group_named: HashMap<(Option<usize>, String), usize>,
    /// The greatest index so far and its line: vertices may follow the faces that name them.
    greatest: (u32, usize),
}

impl Reader {
    fn new(first_group: &str) -> Self {
        let read = Statements { groups: vec![first_group.to_owned()], ..Statements::default() };
        Reader { read, group: 0, object: 0, group_named: HashMap::new(), greatest: (0, 0) }
    }

    fn statement(&mut self, line: usize, statement: &str) -> Result<()> {
        let mut words = statement.split_whitespace();
        match words.next() {
            Some("v") => self.read.vertices.push(vertex(&mut words, line)?),
            Some("f" | "fo") => self.element(ElementKind::Face, words, line)?,
            Some("l") => self.element(ElementKind::Line, words, line)?,
            Some("p") => self.element(ElementKind::Points, words, line)?,
            Some("o") => {
                self.enter_group(None, words);
                self.object = self.group;
            }
            Some("g") => self.enter_group(Some(self.object), words),
            Some("curv" | "curv2" | "surf") => self.read.free_forms += 1,
            _ => {}
        }
        Ok(())
    }

    fn element<'a>(
        &mut self,
        kind: ElementKind,
        words: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<()> {
        let before = self.read.corners.len();
        for word in words {
            let corner = self.corner(word, line)?;
            self.read.corners.push(corner);
        }
        let corners = self.read.corners.len() - before;
        if kind == ElementKind::Face && corners < 3 {
            self.read.short_faces += 1;
        }
        self.read.elements.push(Element { kind, group: self.group, corners });
        Ok(())
    }

    /// The vertex, from 0, that `7`, `7/1`, `7//3`, `7/1/3` or, counted from the last one, `-7` names.
    fn corner(&mut self, word: &str, line: usize) -> Result<u32> {
        let index = word.split('/').next().unwrap_or(word);
        let expected = || format!("expected a vertex index, but there is `{}`", quoted(index));
        match index.parse::<i64>() {
            Ok(0) => Err(Fault::at(line, format!("{}; indices count from 1", expected()))),
            Ok(index) if index < 0 => {
                let count = self.read.vertices.len();
                let back =
                    usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back));
                let vertex = back.and_then(|vertex| u32::try_from(vertex).ok());
                vertex.ok_or_else(|| {
                    Fault::at(
                        line,
                        format!("the index {index} names no vertex; {} before it", there_are(count)),
                    )
                })
            }
            Ok(index) => {
                let index = u32::try_from(index).map_err(|_| Fault::at(line, expected()))?;
                self.greatest = self.greatest.max((index, line));
                Ok(index - 1)
            }
            Err(_) => Err(Fault::at(line, expected())),
        }
    }

    /// Goes on with a group of an object, or with an object.
    fn enter_group<'a>(&mut self, of: Option<usize>, words: impl Iterator<Item = &'a str>) {
        let groups = &mut self.read.groups;
        let name = words.collect::<Vec<_>>().join(" ");
        self.group = *self.group_named.entry((of, name.clone())).or_insert_with(|| {
            groups.push(name);
            groups.len() - 1
        });
    }

    fn finish(self) -> Result<Statements> {
        let count = self.read.vertices.len();
        match self.greatest {
            (index, line) if index as usize > count => {
                Err(Fault::at(line, format!("the index {index} names no vertex; the file has {count}")))
            }
            _ => Ok(self.read),
        }
    }
}

impl Statements {
    /// What was passed over.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::from_iter(short_warning(self.short_faces));
        if self.free_forms > 0 {
            let what = match self.free_forms {
                1 => "1 free-form curve or surface is".to_owned(),
                n => format!("{n} free-form curves or surfaces are"),
            };
            warnings.push(format!("{what} passed over"));
        }
        warnings
    }
}
