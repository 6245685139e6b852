//! The check as JSON: the scene, its objects, every frame with its collisions, and a summary.
//!
//! ```json
//! {"scene":["ship.wrl"],
//!  "objects":[{"id":0,"name":"ship","kind":"mesh","primitives":322}],
//!  "frames":[{"frame":0,"time":0.0,"collisions":[{"a":"ship","b":"mine","point":[0,0,0],"normal":null}]}],
//!  "summary":{"frames":1,"colliding_frames":1,"collisions":1,"pairs":1}}
//! ```
//!
//! Of the response `curve` a collision also has `"curve":[[[0,0,0],[1,0,0]]]`: polylines of points; a closed one ends with its
//! first point. With `--continuous` it has `"contact_time":0.25`: when the two first touch, from the previous frame on.

use std::io::Write;

use anyhow::Result;
use serde::Serialize;
use solid_scene::Scene;
use solid3d::query::IntersectionCurve;

use super::{Frame, Hit, Recorder, Summary};

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
}

#[derive(Serialize)]
struct CollisionEntry<'a> {
    a: &'a str,
    b: &'a str,
    point: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<Vec<Vec<[f64; 3]>>>,
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
        let entry = FrameEntry { frame: frame.number, time: frame.time, collisions };
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
    let curve = hit.curve.as_deref().map(paths);
    CollisionEntry { a, b, point, normal, curve, contact_time: hit.contact_time }
}

fn paths(curve: &IntersectionCurve) -> Vec<Vec<[f64; 3]>> {
    curve.polylines.iter().map(|polyline| polyline.path().map(|p| p.to_array()).collect()).collect()
}

/// What goes before an element of a list, which has a line of its own.
fn separator(first: bool) -> &'static [u8] {
    if first { b"\n" } else { b",\n" }
}
