//! The way from the root to every Shape.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::animation::{Animation, Drives, Frame, ObjectMotion, Surrounding};
use super::document::Kind;
use super::geometry::{Builder, Geometry};
use super::graph::{Graph, Node};
use super::limits::{DEPTH_MAX, NODES_MAX};
use super::transform::Transform;
use crate::error::SceneError;
use crate::part::{ObjectCount, PartObject};

/// Where a node is, on one of the ways to it.
#[derive(Clone)]
struct Place {
    around: Surrounding,
    /// The name of the nearest node around that has one.
    name: Option<Rc<str>>,
}

/// Collects objects.
pub(super) struct Walk<'a> {
    graph: &'a Graph,
    builder: Builder<'a>,
    geometries: HashMap<Node, Option<Geometry>>,
    objects: Vec<PartObject>,
    motions: Vec<ObjectMotion>,
    frames: Vec<Frame>,
    /// The numbers of the nodes on the way here.
    path: Vec<u32>,
    on_path: HashSet<Node>,
    visits: usize,
    count: ObjectCount,
}

impl<'a> Walk<'a> {
    /// Starts without objects.
    pub fn new(graph: &'a Graph, builder: Builder<'a>) -> Self {
        Walk {
            graph,
            builder,
            geometries: HashMap::new(),
            objects: Vec::new(),
            motions: Vec::new(),
            frames: Vec::new(),
            path: Vec::new(),
            on_path: HashSet::new(),
            visits: 0,
            count: ObjectCount::default(),
        }
    }

    /// The objects of the first scope, and what moves them.
    pub fn run(mut self) -> Result<(Vec<PartObject>, Animation), SceneError> {
        let place = Place { around: Surrounding::WORLD, name: None };
        self.all(self.graph.roots(0).collect(), &place)?;
        let signals = self.builder.signals.finish();
        Ok((self.objects, Animation { signals, frames: self.frames, objects: self.motions }))
    }

    fn all(&mut self, nodes: Vec<Node>, place: &Place) -> Result<(), SceneError> {
        nodes.into_iter().try_for_each(|node| self.visit(node, place))
    }

    fn visit(&mut self, node: Node, place: &Place) -> Result<(), SceneError> {
        self.visits += 1;
        if self.visits > NODES_MAX {
            return Err(self
                .graph
                .error(node, format!("the scene has more than {NODES_MAX} nodes with those of USE")));
        }
        if self.path.len() == DEPTH_MAX {
            return Err(self.graph.error(node, format!("nodes nest deeper than {DEPTH_MAX}")));
        }
        if !self.on_path.insert(node) {
            return Err(self.graph.error(node, "holds itself, by way of USE"));
        }
        // At most NODES_MAX, so that it fits.
        self.path.push(self.visits as u32);
        let mut place = place.clone();
        if let Some(name) = self.graph.document(node).name(node.syntax) {
            place.name = Some(name.into());
        }
        self.enter(node, place)?;
        self.path.pop();
        self.on_path.remove(&node);
        Ok(())
    }

    fn enter(&mut self, node: Node, place: Place) -> Result<(), SceneError> {
        let graph = self.graph;
        match graph.kind(node) {
            Kind::Builtin(type_name) => self.builtin(node, type_name, place),
            // A PROTO stands for the first node of its body (ISO/IEC 14772-1, 4.8.3).
            Kind::Instance(_) | Kind::Extern(_) => {
                let first = graph.contents(node).and_then(|scope| graph.roots(scope).next());
                self.all(first.into_iter().collect(), &place)
            }
            Kind::Unknown => Ok(()),
        }
    }

    fn builtin(&mut self, node: Node, type_name: &str, place: Place) -> Result<(), SceneError> {
        let graph = self.graph;
        match type_name {
            "Shape" => self.shape(node, &place),
            "Transform" => {
                let place = self.transform(node, place)?;
                self.all(graph.nodes(node, "children"), &place)
            }
            "Group" | "Anchor" | "StaticGroup" => self.all(graph.nodes(node, "children"), &place),
            "Billboard" => {
                self.builder.warnings.add("Billboard does not turn to a viewer; taken as a Group");
                self.all(graph.nodes(node, "children"), &place)
            }
            "Collision" => self.all(self.colliding(node), &place),
            "Switch" => {
                let choice = usize::try_from(graph.integer(node, "whichChoice"));
                let chosen = choice.ok().and_then(|choice| *graph.slots(node, "choice").get(choice)?);
                self.all(chosen.into_iter().collect(), &place)
            }
            "LOD" => {
                let nearest = graph.slots(node, "level").first().copied().flatten();
                self.all(nearest.into_iter().collect(), &place)
            }
            "Inline" => {
                let roots = graph.contents(node).map(|scope| graph.roots(scope).collect());
                self.all(roots.unwrap_or_default(), &place)
            }
            _ => {
                self.other(type_name);
                Ok(())
            }
        }
    }

    /// What stands for a Collision node in collisions: nothing, its proxy or its children.
    fn colliding(&self, node: Node) -> Vec<Node> {
        let proxy = self.graph.nodes(node, "proxy");
        match () {
            _ if !self.graph.flag(node, "collide") => Vec::new(),
            _ if !proxy.is_empty() => proxy,
            _ => self.graph.nodes(node, "children"),
        }
    }

    /// A node without a place for shapes.
    fn other(&mut self, type_name: &str) {
        let warning = match type_name {
            "Script" | "TouchSensor" | "PlaneSensor" | "SphereSensor" | "CylinderSensor"
            | "ProximitySensor" | "VisibilitySensor" => format!("{type_name} is not run: it sends no events"),
            "TimeSensor" | "Background" | "Fog" | "NavigationInfo" | "Viewpoint" | "WorldInfo" | "Sound"
            | "AudioClip" | "DirectionalLight" | "PointLight" | "SpotLight" => return,
            _ if type_name.ends_with("Interpolator") => return,
            _ => format!("{type_name} is passed over"),
        };
        self.builder.warnings.add(warning);
    }

    fn transform(&mut self, node: Node, place: Place) -> Result<Place, SceneError> {
        let rest = Transform::read(self.graph, node)?;
        let drives = self.drives(node)?;
        if drives != Drives::default() {
            self.frames.push(Frame { around: place.around, rest, drives });
            let around = Surrounding { frame: Some(self.frames.len() - 1), ..Surrounding::WORLD };
            return Ok(Place { around, ..place });
        }
        let offset = place.around.offset * rest.map();
        Ok(Place { around: Surrounding { offset, ..place.around }, ..place })
    }

    fn drives(&mut self, node: Node) -> Result<Drives, SceneError> {
        let Builder { signals, warnings, .. } = &mut self.builder;
        let mut signal = |field| signals.driving(node, field, warnings);
        Ok(Drives {
            translation: signal("translation")?,
            rotation: signal("rotation")?,
            scale: signal("scale")?,
            scale_orientation: signal("scaleOrientation")?,
            center: signal("center")?,
        })
    }

    fn shape(&mut self, node: Node, place: &Place) -> Result<(), SceneError> {
        let Some(source) = self.graph.node(node, "geometry") else {
            self.builder.warn(node, "has no geometry; passed over");
            return Ok(());
        };
        let geometry = match self.geometries.get(&source) {
            Some(geometry) => geometry.clone(),
            None => {
                let geometry = self.builder.geometry(source)?;
                self.geometries.insert(source, geometry.clone());
                geometry
            }
        };
        match geometry {
            Some(geometry) => self.object(node, source, geometry, place),
            None => Ok(()),
        }
    }

    fn object(
        &mut self,
        node: Node,
        source: Node,
        geometry: Geometry,
        place: &Place,
    ) -> Result<(), SceneError> {
        if !place.around.offset.is_finite() {
            return Err(self.graph.error(node, "the Transforms around put it infinitely far away"));
        }
        let positions = geometry.deformation.as_ref().map_or(0, |deformation| deformation.rest.len());
        let name = match &place.name {
            Some(name) => name.to_string(),
            None => self.graph.type_name(source).to_ascii_lowercase(),
        };
        self.builder.count(node, self.path.len() + positions)?;
        self.count.add(&name).map_err(|message| self.graph.error(node, message))?;
        let Geometry { shape, degenerate, deformation } = geometry;
        self.objects.push(PartObject { name, shape, path: self.path.clone(), degenerate });
        self.motions.push(ObjectMotion { around: place.around, deformation });
        Ok(())
    }
}
