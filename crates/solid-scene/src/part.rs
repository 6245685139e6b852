//! What a reader makes of a file.

use std::path::PathBuf;

use solid3d::Shape;

use crate::pose::ObjectPose;

/// Bytes in the names of all objects of a file together: each keeps its own, which many may have of one node or mesh.
const NAMES_MAX: usize = 1 << 28;

/// Objects of a file: each takes a kilobyte and more, where the text need not have more than ten bytes.
const OBJECTS_MAX: usize = 1_000_000;

/// How many objects a file has so far, and how many bytes their names.
#[derive(Debug, Default)]
pub(crate) struct ObjectCount {
    objects: usize,
    in_names: usize,
}

impl ObjectCount {
    /// Counts another object, by its name; what is wrong, where it is one too many.
    pub fn add(&mut self, name: &str) -> Result<(), String> {
        self.objects += 1;
        self.in_names += name.len();
        match self {
            ObjectCount { in_names, .. } if *in_names > NAMES_MAX => {
                Err(format!("the names of the objects have more than {NAMES_MAX} bytes in all"))
            }
            ObjectCount { objects, .. } if *objects > OBJECTS_MAX => {
                Err(format!("the file makes more than {OBJECTS_MAX} objects"))
            }
            _ => Ok(()),
        }
    }
}

/// A file's share of a scene.
#[derive(Debug)]
pub(crate) struct Part {
    pub objects: Vec<PartObject>,
    /// Moves and deforms the objects.
    pub motion: Box<dyn Motion>,
    /// Seconds until the animation ends or repeats; 0 for none.
    pub duration: f64,
    /// The unit of length, "metre" or "unspecified".
    pub unit: &'static str,
    /// What was passed over or guessed, in words for the user.
    pub warnings: Vec<String>,
    /// The files that were read beside the one that is loaded; it may be among them.
    pub files: Vec<PathBuf>,
}

/// A node with geometry.
#[derive(Clone, Debug)]
pub(crate) struct PartObject {
    /// The node's name, not yet unique; empty for none.
    pub name: String,
    /// The shape at time 0.
    pub shape: Shape,
    /// The nodes from the root to this one, itself included, as numbers of the file's own. An object whose path begins
    /// with the path of another is on one root path with it (thesis, section 2.2), and is not tested against it.
    pub path: Vec<u32>,
    /// How many of its primitives are degenerate: without length, area or volume.
    pub degenerate: usize,
}

/// An animation. Time in seconds from the start of the scene.
pub(crate) trait Motion: Send + Sync + std::fmt::Debug {
    /// Writes where each of the part's objects is; `poses` has one entry per object, in the part's order, from an
    /// earlier sample or fresh.
    fn sample(&self, time: f64, poses: &mut [ObjectPose]);
}

/// Nothing moves: every object stays where its placement says.
#[derive(Debug)]
pub(crate) struct Still(pub Vec<glam::DAffine3>);

impl Motion for Still {
    fn sample(&self, _time: f64, poses: &mut [ObjectPose]) {
        for (pose, placement) in poses.iter_mut().zip(&self.0) {
            pose.placement = *placement;
        }
    }
}
