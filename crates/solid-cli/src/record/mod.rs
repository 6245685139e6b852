//! What becomes of the collisions: each recorder makes one thing of the frames as they are tested, holding none of them.

mod csv;
mod json;
mod pairs;

use std::sync::Arc;

use anyhow::Result;
use solid_scene::Scene;
use solid3d::glam::DVec3;
use solid3d::query::IntersectionCurve;

pub use self::csv::{Columns, CsvRecorder};
pub use json::JsonRecorder;
pub use pairs::PairRecorder;

/// A collision, of objects by their place in the scene; `a` comes before `b`.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    pub a: usize,
    pub b: usize,
    /// Where, if the response tells. Space: world.
    pub point: Option<DVec3>,
    /// The approximate normal from `b` to `a`, if the response tells. Space: world.
    pub normal: Option<DVec3>,
    /// Where the surfaces meet, if the response tells. Space: world.
    pub curve: Option<Arc<IntersectionCurve>>,
    /// When they first touch, from the previous frame on, if it was asked. Seconds from the start of the scene.
    pub contact_time: Option<f64>,
}

/// A tested frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<'a> {
    pub number: u64,
    /// Seconds from the start of the scene.
    pub time: f64,
    /// In the order of the scene, by the first object, then by the second.
    pub hits: &'a [Hit],
}

/// The whole, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Summary {
    pub frames: u64,
    pub colliding_frames: u64,
    pub collisions: u64,
    /// Different pairs that collide at some time.
    pub pairs: u64,
}

/// Makes something of the frames.
pub trait Recorder {
    /// Takes a frame; they come in order.
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()>;

    /// There are no more.
    fn finish(&mut self, summary: &Summary) -> Result<()>;
}
