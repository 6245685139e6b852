//! What becomes of the collisions: each recorder makes one thing of the frames as they are tested, holding none of them.

mod csv;
mod encounters;
mod json;
mod near;
mod pairs;
mod rays;

use std::sync::Arc;

use anyhow::Result;
use solid_scene::Scene;
use solid3d::glam::DVec3;
use solid3d::query::{IntersectionCurve, Manifold};

pub use self::csv::{CsvColumns, CsvRecorder};
pub use json::JsonRecorder;
pub use near::NearRecorder;
pub use pairs::PairRecorder;
pub use rays::RayRecorder;

use crate::rays::NamedRay;

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
    /// How deep they are in each other, if the response tells, with the deepest points.
    pub depth: Option<Depth>,
    /// All points of contact, if the response tells. Space: world.
    pub contacts: Option<Arc<[Manifold]>>,
    /// When they first touch, from the previous frame on, if it was asked. Seconds from the start of the scene.
    pub contact_time: Option<f64>,
}

/// How deep two objects are in each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// World units.
    pub depth: f64,
    /// The deepest point of each. Space: world.
    pub points: [DVec3; 2],
}

/// Two objects that are nearer than their clearance, by their place in the scene; `a` comes before `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    pub a: usize,
    pub b: usize,
    /// Their distance; less the depth where they intersect. World units.
    pub distance: f64,
    /// The closest, or deepest, point of each. Space: world.
    pub points: [DVec3; 2],
    /// From `b` to `a`. Space: world.
    pub normal: DVec3,
}

/// Where a ray first meets an object, by their places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    pub ray: usize,
    pub object: usize,
    /// That of the object which it meets; `None` where it starts inside of a solid.
    pub primitive: Option<u32>,
    /// From the origin of the ray. World units.
    pub distance: f64,
    /// Space: world.
    pub point: DVec3,
    /// On the side that the ray comes from; `None` where it starts inside of a solid. Space: world.
    pub normal: Option<DVec3>,
}

/// A tested frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<'a> {
    pub number: u64,
    /// Seconds from the start of the scene.
    pub time: f64,
    /// In the order of the scene, by the first object, then by the second.
    pub hits: &'a [Hit],
    /// What is nearer than its clearance, in the same order; `None` when no clearance is asked for.
    pub near: Option<&'a [Pass]>,
    /// The rays that are cast.
    pub rays: &'a [NamedRay],
    /// What they meet, ray by ray, nearest first.
    pub sightings: &'a [Sighting],
}

/// The whole, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    pub frames: u64,
    pub colliding_frames: u64,
    pub collisions: u64,
    /// Different pairs that collide at some time.
    pub pairs: u64,
    /// What is nearer than its clearance, if one is asked for.
    #[serde(flatten)]
    pub near: Option<NearSummary>,
    /// What rays meet, if any is cast.
    #[serde(flatten)]
    pub rays: Option<RaySummary>,
}

/// What rays meet, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct RaySummary {
    /// Frames in which some ray meets something.
    pub ray_frames: u64,
    /// Different pairs of a ray and an object that it meets at some time.
    pub ray_meetings: u64,
}

/// What is nearer than its clearance, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct NearSummary {
    pub near_frames: u64,
    /// Different pairs that are near at some time.
    pub near_pairs: u64,
    /// The least distance of any; none without a pair. World units.
    pub least_distance: Option<f64>,
}

/// Makes something of the frames.
pub trait Recorder {
    /// Takes a frame; they come in order.
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()>;

    /// There are no more.
    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(())
    }
}
