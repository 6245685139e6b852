//! The scene: objects out of files, sampled at a time.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use solid3d::Shape;

use crate::error::SceneError;
use crate::load::{LoadOptions, load};
use crate::part::{Part, PartObject};
use crate::pose::Pose;

/// An animated scene.
#[derive(Debug)]
pub struct Scene {
    files: Vec<PathBuf>,
    objects: Vec<SceneObject>,
    /// What is left of the files' shares, without their objects.
    parts: Vec<Part>,
}

/// A node with geometry.
#[derive(Clone, Debug)]
pub struct SceneObject {
    name: String,
    shape: Shape,
    file: usize,
    path: Vec<u32>,
    degenerate: usize,
}

impl SceneObject {
    /// The node's name, made unique in the scene by a number where needed; the same for the same files.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The shape at time 0.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Which of the scene's files it comes from.
    pub fn file(&self) -> usize {
        self.file
    }

    /// How many of its primitives have no length, area or volume.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// The nodes from the root of its file to this one, as numbers of the file's own.
    pub fn path(&self) -> &[u32] {
        &self.path
    }

    /// Whether the two nodes lie on one root path: one holds the other, so that they are one thing, and are not tested
    /// against each other (thesis, section 2.2).
    pub fn on_root_path_with(&self, other: &SceneObject) -> bool {
        self.file == other.file && (self.path.starts_with(&other.path) || other.path.starts_with(&self.path))
    }
}

impl Scene {
    /// Loads files into one scene, in the order given. Of VRML and glTF a file may have no objects; its warnings may say why.
    pub fn load<P: AsRef<Path>>(files: &[P], options: &LoadOptions) -> Result<Scene, SceneError> {
        let files: Vec<PathBuf> = files.iter().map(|file| file.as_ref().to_owned()).collect();
        let mut parts = files.iter().map(|file| load(file, options)).collect::<Result<Vec<_>, _>>()?;
        let mut names = Names::default();
        let mut objects = Vec::new();
        for (file, part) in parts.iter_mut().enumerate() {
            for PartObject { name, shape, path, degenerate } in std::mem::take(&mut part.objects) {
                objects.push(SceneObject { name: names.unique(&name), shape, file, path, degenerate });
            }
        }
        Ok(Scene { files, objects, parts })
    }

    /// The files.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// All files that were read: those that were loaded, and what they name: buffers, inlined files, PROTOs in files.
    pub fn files_read(&self) -> impl Iterator<Item = &PathBuf> + Clone {
        self.files.iter().chain(self.parts.iter().flat_map(|part| &part.files))
    }

    /// The objects, file by file, in the order in which the nodes stand there.
    pub fn objects(&self) -> &[SceneObject] {
        &self.objects
    }

    /// Seconds until the longest animation ends or repeats; 0 when nothing moves.
    pub fn duration(&self) -> f64 {
        self.parts.iter().map(|part| part.duration).fold(0.0, f64::max)
    }

    /// A file's unit of length: "metre", or "unspecified".
    pub fn unit(&self, file: usize) -> &'static str {
        self.parts[file].unit
    }

    /// What was passed over or guessed in the files, each with its file.
    pub fn warnings(&self) -> impl Iterator<Item = (&Path, &str)> {
        let files = self.files.iter().zip(&self.parts);
        files.flat_map(|(file, part)| {
            part.warnings.iter().map(move |warning| (file.as_path(), warning.as_str()))
        })
    }

    /// Where everything is at a time, in seconds from the start.
    pub fn sample(&self, time: f64, pose: &mut Pose) {
        pose.objects.resize_with(self.objects.len(), Default::default);
        let mut rest = pose.objects.as_mut_slice();
        for objects in self.objects.chunk_by(|a, b| a.file == b.file) {
            let (poses, others) = rest.split_at_mut(objects.len());
            self.parts[objects[0].file].motion.sample(time, poses);
            rest = others;
        }
    }
}

/// Hands out names that have not been used before.
#[derive(Default)]
struct Names {
    used: HashMap<String, usize>,
}

impl Names {
    /// `name`, or `name#2`, `name#3`, ... when it was used; "object" for an empty one.
    fn unique(&mut self, name: &str) -> String {
        let name = if name.is_empty() { "object" } else { name };
        let mut candidate = name.to_owned();
        while self.used.contains_key(&candidate) {
            let count = self.used.entry(name.to_owned()).or_insert(1);
            *count += 1;
            candidate = format!("{name}#{count}");
        }
        self.used.insert(candidate.clone(), 1);
        candidate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_also_where_they_look_like_numbered_ones() {
        let mut names = Names::default();
        let given = ["a", "a", "a#2", "a", "", "object", "a#2"].map(|name| names.unique(name));
        assert_eq!(given, ["a", "a#2", "a#2#2", "a#3", "object", "object#2", "a#2#3"]);
    }
}
