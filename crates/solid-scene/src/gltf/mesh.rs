//! Meshes: vertices, primitives, and what deforms them.

use std::collections::BTreeMap;

use glam::DVec3;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

use super::accessor::Numbers;
use super::document::{Document, compressed};
use super::morph::Targets;
use super::primitive;
use super::skin::Influences;
use crate::fault::Result;
use crate::soup::Soup;
use crate::text::{counted, quoted, there_are};

/// A mesh of the file: all its primitives over one vertex buffer.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub soup: Soup,
    pub targets: Targets,
    pub influences: Influences,
}

/// The accessors of a primitive's vertices. Primitives that name the same ones share vertices.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Attributes {
    positions: usize,
    /// The displacements of each morph target, where it has some.
    targets: Vec<Option<usize>>,
    /// Joints and weights, set by set.
    influences: Vec<(usize, usize)>,
}

/// How errors and warnings call a mesh.
pub(super) fn name(document: &Document, index: usize) -> Result<String> {
    Ok(match &document.mesh(index)?.name {
        Some(name) => format!("mesh {index} (`{}`)", quoted(name)),
        None => format!("mesh {index}"),
    })
}

impl Geometry {
    /// Reads a mesh.
    pub fn read(document: &Document, index: usize) -> Result<Geometry> {
        let name = name(document, index)?;
        let mut geometry = Geometry::default();
        let mut firsts = BTreeMap::new();
        for (number, primitive) in document.mesh(index)?.primitives.iter().enumerate() {
            let what = format!("{name}, primitive {number}");
            let Some(attributes) = Attributes::of(primitive, &what)? else { continue };
            let (first, count) = match firsts.get(&attributes) {
                Some(&shared) => shared,
                None => {
                    let added = geometry.add_vertices(document, &attributes, &what)?;
                    *firsts.entry(attributes).or_insert(added)
                }
            };
            geometry.add_primitive(document, primitive, first, count, &what)?;
        }
        let vertices = geometry.soup.vertices.len();
        geometry.influences.grow(vertices);
        Ok(geometry)
    }

    /// Adds vertices; gives the first and how many they are.
    fn add_vertices(
        &mut self,
        document: &Document,
        attributes: &Attributes,
        what: &str,
    ) -> Result<(usize, usize)> {
        let first = self.soup.vertices.len();
        let accessor = document.accessor(attributes.positions).map_err(|fault| fault.of(what))?;
        if let (None, None, Some(extension)) =
            (accessor.buffer_view, &accessor.sparse, document.compression())
        {
            return Err(format!("{what}: {}", compressed(extension)).into());
        }
        let positions = vectors(document, attributes.positions, &format!("{what}, POSITION"))?;
        let count = positions.len();
        self.soup.vertices.extend(positions);
        for (number, &target) in attributes.targets.iter().enumerate() {
            let Some(accessor) = target else { continue };
            let what = format!("{what}, target {number}");
            let displacements = vectors(document, accessor, &what)?;
            expect_count(displacements.len(), count, &what)?;
            self.targets.add(number, first, displacements);
        }
        let mut sets = Vec::new();
        for &(joints, weights) in &attributes.influences {
            let joints = document.integers(joints, Type::Vec4, &format!("{what}, JOINTS"))?;
            let weights = document.numbers(weights, Type::Vec4, &format!("{what}, WEIGHTS"))?;
            expect_count(joints.len() / 4, count, &format!("{what}, JOINTS"))?;
            expect_count(weights.len(), count, &format!("{what}, WEIGHTS"))?;
            sets.push((joints, weights.values));
        }
        self.influences.add(first, count, &sets, what)?;
        Ok((first, count))
    }

    fn add_primitive(
        &mut self,
        document: &Document,
        primitive: &Primitive,
        first: usize,
        count: usize,
        what: &str,
    ) -> Result<()> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(format!("{what} is of an unknown mode").into());
        };
        let mut indices = match primitive.indices {
            Some(indices) => document.integers(indices.value(), Type::Scalar, &format!("{what}, indices"))?,
            None => {
                document.spend(count as u64, what)?;
                (0..count as u32).collect()
            }
        };
        for (place, index) in indices.iter_mut().enumerate() {
            if *index as usize >= count {
                let message = format!("{what}: index {place} names vertex {index}, but {}", there_are(count));
                return Err(message.into());
            }
            *index += first as u32;
        }
        primitive::add(mode, &indices, &mut self.soup);
        Ok(())
    }
}

impl Attributes {
    /// The attributes; `None` where there are no positions, and so nothing to read.
    fn of(primitive: &Primitive, what: &str) -> Result<Option<Attributes>> {
        let named = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
        let Some(positions) = named(Semantic::Positions) else { return Ok(None) };
        let targets = primitive.targets.iter().flatten();
        let targets = targets.map(|target| target.positions.map(|index| index.value())).collect();
        let mut influences = Vec::new();
        for set in 0.. {
            match (named(Semantic::Joints(set)), named(Semantic::Weights(set))) {
                (Some(joints), Some(weights)) => influences.push((joints, weights)),
                (None, None) => break,
                _ => return Err(format!("{what} has only one of JOINTS_{set} and WEIGHTS_{set}").into()),
            }
        }
        Ok(Some(Attributes { positions, targets, influences }))
    }
}

fn vectors(document: &Document, accessor: usize, what: &str) -> Result<Vec<DVec3>> {
    let numbers: Numbers = document.numbers(accessor, Type::Vec3, what)?;
    let vectors = numbers.elements().map(DVec3::from_slice);
    let vectors = vectors.enumerate().map(|(vertex, vector)| {
        let wrong = || format!("{what}: vertex {vertex} is {vector}; expected finite numbers");
        if vector.is_finite() { Ok(vector) } else { Err(wrong().into()) }
    });
    vectors.collect()
}

fn expect_count(found: usize, expected: usize, what: &str) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    let found = counted(found, "element");
    Err(format!("{what} has {found}; expected {expected}, one for each vertex").into())
}
