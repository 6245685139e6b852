//! The check as JSON: the scene, its objects, every frame with its collisions, and a summary.
//!
//! ```json
//! {"scene":["ship.wrl"],
//!  "objects":[{"id":0,"name":"ship","kind":"mesh","primitives":322}],
//!  "frames":[{"frame":0,"time":0.0,"collisions":[{"a":"ship","b":"mine","point":[0,0,0],"normal":null}]}],
//!  "summary":{"frames":1,"colliding_frames":1,"collisions":1,"pairs":1}}
//! ```
//!
//! Of the response `depth` a collision also has `"depth":0.25,"point_a":[0,0,0],"point_b":[0,0.25,0]`: the points of each that are
//! deepest in the other. With a clearance a frame also has `"near"`, a list of
//! `{"a":"ship","b":"mine","distance":0.1,"point_a":[0,0,0],"point_b":[0,0.1,0],"normal":[0,-1,0]}`, and the summary `near_frames`,
//! `near_pairs` and `least_distance`; a negative distance is less the depth.
//!
//! Of the response `contacts` a collision also has the depth and points of the deepest contact, and all of them in regions:
//! `"contacts":[{"normal":[0,-1,0],"points":[{"point_a":[0,0,0],"point_b":[0,0.25,0],"depth":0.25,"primitives":[0,7],"features":[{"face":2},{"vertex":5}]}]}]`.
//!
//! With rays a frame also has `"rays"`, a list of
//! `{"ray":"barrier","object":"ship","primitive":7,"distance":2.5,"point":[0,0,0],"normal":[0,1,0]}`, the last and the primitive `null` where the
//! ray starts inside of a solid, and the summary `ray_frames` and `ray_meetings`.
//!
//! Of the response `curve` a collision also has `"curve":[[[0,0,0],[1,0,0]]]`: polylines of points; a closed one ends with its
//! first point. With `--continuous` it has `"contact_time":0.25`: when the two first touch, from the previous frame on.

use std::io::Write;

use anyhow::Result;
use serde::Serialize;
use solid_scene::Scene;
use solid3d::glam::DVec3;
use solid3d::query::{ContactPoint, Feature, IntersectionCurve, Manifold};

use super::{Depth, Frame, Hit, Pass, Recorder, Sighting, Summary};

/// Writes one JSON object, frame by frame.
pub struct JsonRecorder<W: Write> {
    writer: W,
    frames: u64,
}

#[derive(Serialize)]
struct ObjectEntry<'a> {
    id: usize,
    name: &'a str,
    kind: String,
    primitives: usize,
}

#[derive(Serialize)]
struct FrameEntry<'a> {
    frame: u64,
    time: f64,
    collisions: Vec<CollisionEntry<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    near: Option<Vec<PassEntry<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rays: Option<Vec<SightingEntry<'a>>>,
}

#[derive(Serialize)]
struct SightingEntry<'a> {
    ray: &'a str,
    object: &'a str,
    primitive: Option<u32>,
    distance: f64,
    point: [f64; 3],
    normal: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct PassEntry<'a> {
    a: &'a str,
    b: &'a str,
    distance: f64,
    #[serde(flatten)]
    points: PointsEntry,
    normal: [f64; 3],
}

/// The closest or deepest points.
#[derive(Serialize)]
struct PointsEntry {
    point_a: [f64; 3],
    point_b: [f64; 3],
}

#[derive(Serialize)]
struct DepthEntry {
    depth: f64,
    #[serde(flatten)]
    points: PointsEntry,
}

/// Contacts of one normal.
#[derive(Serialize)]
struct RegionEntry {
    normal: [f64; 3],
    points: Vec<ContactEntry>,
}

#[derive(Serialize)]
struct ContactEntry {
    #[serde(flatten)]
    points: PointsEntry,
    depth: f64,
    primitives: [u32; 2],
    features: [FeatureEntry; 2],
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum FeatureEntry {
    Vertex(u32),
    Edge([u32; 2]),
    Face(u32),
}

#[derive(Serialize)]
struct CollisionEntry<'a> {
    a: &'a str,
    b: &'a str,
    point: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<Vec<Vec<[f64; 3]>>>,
    #[serde(flatten)]
    depth: Option<DepthEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contacts: Option<Vec<RegionEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_time: Option<f64>,
}

impl<W: Write> JsonRecorder<W> {
    pub fn new(mut writer: W, scene: &Scene) -> Result<Self> {
        let files: Vec<_> = scene.files().iter().map(|file| file.to_string_lossy()).collect();
        write!(writer, "{{\"scene\":")?;
        serde_json::to_writer(&mut writer, &files)?;
        write!(writer, ",\n\"objects\":[")?;
        for (id, object) in scene.objects().iter().enumerate() {
            let shape = object.shape();
            let (kind, primitives) = (shape.kind().to_string(), shape.primitive_count());
            writer.write_all(separator(id == 0))?;
            serde_json::to_writer(&mut writer, &ObjectEntry { id, name: object.name(), kind, primitives })?;
        }
        write!(writer, "],\n\"frames\":[")?;
        Ok(JsonRecorder { writer, frames: 0 })
    }
}

impl<W: Write> Recorder for JsonRecorder<W> {
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()> {
        let collisions = frame.hits.iter().map(|hit| collision(scene, hit)).collect();
        self.writer.write_all(separator(self.frames == 0))?;
        self.frames += 1;
        let near = frame.near.map(|near| near.iter().map(|pass| self::pass(scene, pass)).collect());
        let sightings =
            || frame.sightings.iter().map(|sighting| self::sighting(scene, frame, sighting)).collect();
        let rays = (!frame.rays.is_empty()).then(sightings);
        let entry = FrameEntry { frame: frame.number, time: frame.time, collisions, near, rays };
        Ok(serde_json::to_writer(&mut self.writer, &entry)?)
    }

    fn finish(&mut self, summary: &Summary) -> Result<()> {
        write!(self.writer, "],\n\"summary\":")?;
        serde_json::to_writer(&mut self.writer, summary)?;
        writeln!(self.writer, "}}")?;
        Ok(self.writer.flush()?)
    }
}

fn collision<'a>(scene: &'a Scene, hit: &Hit) -> CollisionEntry<'a> {
    let [a, b] = [hit.a, hit.b].map(|object| scene.objects()[object].name());
    let [point, normal] = [hit.point, hit.normal].map(|v| v.map(|v| v.to_array()));
    let depth = hit.depth.map(|Depth { depth, points: p }| DepthEntry { depth, points: points(p) });
    let curve = hit.curve.as_deref().map(paths);
    let contacts = hit.contacts.as_deref().map(|manifolds| manifolds.iter().map(region).collect());
    CollisionEntry { a, b, point, normal, curve, depth, contacts, contact_time: hit.contact_time }
}

fn pass<'a>(scene: &'a Scene, pass: &Pass) -> PassEntry<'a> {
    let [a, b] = [pass.a, pass.b].map(|object| scene.objects()[object].name());
    let normal = pass.normal.to_array();
    PassEntry { a, b, distance: pass.distance, points: points(pass.points), normal }
}

fn sighting<'a>(scene: &'a Scene, frame: &Frame<'a>, sighting: &Sighting) -> SightingEntry<'a> {
    SightingEntry {
        ray: &frame.rays[sighting.ray].name,
        object: scene.objects()[sighting.object].name(),
        primitive: sighting.primitive,
        distance: sighting.distance,
        point: sighting.point.to_array(),
        normal: sighting.normal.map(|normal| normal.to_array()),
    }
}

fn points([on_a, on_b]: [DVec3; 2]) -> PointsEntry {
    PointsEntry { point_a: on_a.to_array(), point_b: on_b.to_array() }
}

fn region(manifold: &Manifold) -> RegionEntry {
    RegionEntry { normal: manifold.normal.to_array(), points: manifold.points.iter().map(contact).collect() }
}

fn contact(contact: &ContactPoint) -> ContactEntry {
    let &ContactPoint { point_on_a, point_on_b, depth, primitives, features } = contact;
    let features = features.map(|feature| match feature {
        Feature::Vertex(vertex) => FeatureEntry::Vertex(vertex),
        Feature::Edge(from, to) => FeatureEntry::Edge([from, to]),
        Feature::Face(face) => FeatureEntry::Face(face),
    });
    ContactEntry { points: points([point_on_a, point_on_b]), depth, primitives, features }
}

fn paths(curve: &IntersectionCurve) -> Vec<Vec<[f64; 3]>> {
    curve.polylines.iter().map(|polyline| polyline.path().map(|p| p.to_array()).collect()).collect()
}

/// What goes before an element of a list, which has a line of its own.
fn separator(first: bool) -> &'static [u8] {
    if first { b"\n" } else { b",\n" }
}
