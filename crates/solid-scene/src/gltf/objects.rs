//! The objects of a file: its nodes with meshes.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine3;
use solid3d::Shape;

use super::animation::{Animation, list};
use super::document::Document;
use super::graph::{Graph, PATHS_MAX};
use super::instances;
use super::local::Local;
use super::mesh::{self, Geometry};
use super::motion::{Deformation, GltfMotion, Moved};
use super::skin::Skin;
use super::text::Node;
use crate::fault::Result;
use crate::part::{ObjectCount, Part, PartObject};
use crate::soup::Soup;
use crate::text::quoted;
use crate::warnings::Warnings;

/// The file's share of a scene.
pub(super) fn part(document: &Document, animation: Option<&str>) -> Result<Part> {
    let mut warnings = Warnings::default();
    let graph = Graph::new(document)?;
    let nodes = document.root.nodes.first.iter().enumerate();
    let locals = nodes.map(|(index, node)| Local::of(index, node)).collect::<Result<Vec<_>>>()?;
    let unknown = document.unknown_extensions();
    if !unknown.is_empty() {
        let names = list(&unknown);
        warnings
            .add(format!("uses extensions that are not supported ({names}): what they change is not seen"));
    }
    let animation = Animation::read(document, animation, &mut warnings)?;
    for node in animation.moved().filter(|&node| locals[node].is_matrix()) {
        warnings.add(format!("node {node} has a matrix, so that its animation has no effect"));
    }
    let motion = GltfMotion { graph, locals, animation, objects: Vec::new() };
    let mut reader = Reader::new(document, motion, warnings);
    for node in reader.motion.graph.scene.clone() {
        reader.node(node).map_err(|fault| fault.of(&format!("node {node}")))?;
    }
    let Reader { objects, motion, warnings, .. } = reader;
    let warnings = warnings.into_vec();
    let duration = motion.animation.duration;
    let files = document.files().to_owned();
    Ok(Part { objects, motion: Box::new(motion), duration, unit: "metre", warnings, files })
}

struct Reader<'a> {
    document: &'a Document,
    /// The nodes' maps to the world at time 0.
    worlds: Vec<DAffine3>,
    geometries: HashMap<usize, Arc<Geometry>>,
    skins: HashMap<usize, Arc<Skin>>,
    /// The shapes of meshes that nothing deforms, and how many of their primitives are degenerate.
    shapes: HashMap<usize, (Shape, usize)>,
    objects: Vec<PartObject>,
    /// Nodes in the paths of these.
    in_paths: usize,
    count: ObjectCount,
    motion: GltfMotion,
    warnings: Warnings,
}

impl<'a> Reader<'a> {
    fn new(document: &'a Document, motion: GltfMotion, warnings: Warnings) -> Self {
        let worlds = motion.worlds(0.0);
        let (geometries, skins, shapes) = Default::default();
        Reader {
            document,
            worlds,
            geometries,
            skins,
            shapes,
            objects: Vec::new(),
            in_paths: 0,
            count: ObjectCount::default(),
            motion,
            warnings,
        }
    }

    /// Makes an object of a node that has a mesh.
    fn node(&mut self, index: usize) -> Result<()> {
        let node = self.document.node(index)?;
        let Some(mesh) = node.mesh.map(|mesh| mesh as usize) else { return Ok(()) };
        let geometry = self.geometry(mesh)?;
        if geometry.soup.is_empty() {
            self.warnings.add(format!("{} has no geometry", mesh::name(self.document, mesh)?));
            return Ok(());
        }
        let deformation = self.deformation(node, mesh, &geometry)?;
        let (shape, degenerate) = self.shape(index, mesh, &deformation)?;
        let skinned = deformation.skin.is_some();
        let animation = &self.motion.animation;
        let changes = animation.morphs(index) && !geometry.targets.is_empty() || skinned && animation.moves();
        let object = PartObject {
            name: self.object_name(index, node, mesh)?,
            shape,
            path: self.motion.graph.path(index),
            degenerate,
        };
        let deformation = changes.then_some(deformation);
        let moved = Moved { node: index, instance: None, in_world: skinned, deformation };
        match instances::read(self.document, index)? {
            None => self.add(object, moved),
            Some(_) if skinned => {
                let name = quoted(&object.name);
                self.warnings.add(format!("`{name}` has a skin, so that its instances are passed over"));
                self.add(object, moved)
            }
            Some(instances) => self.add_instances(&object, &moved, &instances),
        }
    }

    /// Adds the instances of an object, as on children of its node, with numbers after those of the file's nodes.
    fn add_instances(&mut self, object: &PartObject, moved: &Moved, instances: &[DAffine3]) -> Result<()> {
        for (number, &instance) in (self.worlds.len() as u32..).zip(instances) {
            let path = [object.path.as_slice(), &[number]].concat();
            let object = PartObject { path, ..object.clone() };
            self.add(object, Moved { instance: Some(instance), ..moved.clone() })?;
        }
        Ok(())
    }

    fn add(&mut self, object: PartObject, moved: Moved) -> Result<()> {
        self.in_paths += object.path.len();
        if self.in_paths > PATHS_MAX {
            return Err(
                format!("the paths from the roots to the objects have more than {PATHS_MAX} nodes").into()
            );
        }
        self.count.add(&object.name)?;
        if let Some(deformation) = &moved.deformation {
            self.document.spend(deformation.numbers() as u64, "positions of what deforms")?;
        }
        self.objects.push(object);
        self.motion.objects.push(moved);
        Ok(())
    }

    fn object_name(&self, index: usize, node: &Node, mesh: usize) -> Result<String> {
        let names = [node.name.as_deref(), self.document.mesh(mesh)?.name.as_deref()];
        let name = names.into_iter().flatten().find(|name| !name.is_empty());
        Ok(name.map(str::to_owned).unwrap_or_else(|| format!("node{index}")))
    }

    fn geometry(&mut self, mesh: usize) -> Result<Arc<Geometry>> {
        if let Some(geometry) = self.geometries.get(&mesh) {
            return Ok(geometry.clone());
        }
        let geometry = Arc::new(Geometry::read(self.document, mesh)?);
        self.geometries.insert(mesh, geometry.clone());
        Ok(geometry)
    }

    /// What gives the mesh its form on a node: its skin, and the node's weights or else the mesh's.
    fn deformation(&mut self, node: &Node, mesh: usize, geometry: &Arc<Geometry>) -> Result<Deformation> {
        let skin = match node.skin.map(|skin| skin as usize) {
            None => None,
            Some(skin) if geometry.influences.is_empty() => {
                let name = mesh::name(self.document, mesh)?;
                let reason = match geometry.influences.has_joints() {
                    true => format!("all weights of {name} are 0"),
                    false => format!("{name} has no JOINTS_0"),
                };
                self.warnings.add(format!("{reason}, so skin {skin} has no effect on it"));
                None
            }
            Some(skin) => Some(self.skin(skin)?),
        };
        if let Some(skin) = &skin {
            geometry.influences.check(skin)?;
        }
        let mut weights = vec![0.0; geometry.targets.len()];
        let given = node.weights.as_deref().or(self.document.mesh(mesh)?.weights.as_deref());
        for (weight, &given) in weights.iter_mut().zip(given.into_iter().flatten()) {
            *weight = f64::from(given);
        }
        Ok(Deformation { geometry: geometry.clone(), skin, weights })
    }

    fn skin(&mut self, index: usize) -> Result<Arc<Skin>> {
        if let Some(skin) = self.skins.get(&index) {
            return Ok(skin.clone());
        }
        let skin = Arc::new(Skin::read(self.document, index)?);
        self.skins.insert(index, skin.clone());
        Ok(skin)
    }

    /// The shape at time 0, and how many of its primitives are degenerate. Nodes that only place a mesh share it.
    fn shape(&mut self, node: usize, mesh: usize, deformation: &Deformation) -> Result<(Shape, usize)> {
        let soup = &deformation.geometry.soup;
        let deformed = deformation.skin.is_some() || !deformation.geometry.targets.is_empty();
        if let (false, Some(shape)) = (deformed, self.shapes.get(&mesh)) {
            return Ok(shape.clone());
        }
        let primitives = 3 * soup.triangles.len() + 2 * soup.segments.len() + soup.points.len();
        self.document.spend((deformation.numbers() + primitives) as u64, "vertices and primitives")?;
        let mut soup: Soup = soup.clone();
        if deformed {
            self.motion.deform(deformation, node, 0.0, &self.worlds, &mut soup.vertices);
        }
        let degenerate = soup.degenerate();
        let name = mesh::name(self.document, mesh)?;
        let shape = soup.into_shape().map_err(|fault| fault.of(&name))?;
        if !deformed {
            self.shapes.insert(mesh, (shape.clone(), degenerate));
        }
        Ok((shape, degenerate))
    }
}
