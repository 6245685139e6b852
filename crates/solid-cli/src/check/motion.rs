//! Where everything is in a frame: from the scene's animation, or from a table of placements.

use solid_scene::{Pose, Scene};

use crate::placements::Placements;

/// Moves the objects of a scene.
pub enum Motion<'a> {
    /// By the animation of the files.
    Animation(&'a Scene),
    /// By a table.
    Table(Table<'a>),
}

/// Placements, followed from frame to frame.
pub struct Table<'a> {
    scene: &'a Scene,
    placements: &'a Placements,
    /// How many rows have been applied.
    applied: usize,
    /// The line of the row that placed each object last.
    lines: Vec<Option<u64>>,
}

impl<'a> Motion<'a> {
    /// The motion by the scene's animation.
    pub fn animation(scene: &'a Scene) -> Self {
        Motion::Animation(scene)
    }

    /// The motion by a table.
    pub fn table(scene: &'a Scene, placements: &'a Placements) -> Self {
        let lines = vec![None; scene.objects().len()];
        Motion::Table(Table { scene, placements, applied: 0, lines })
    }

    /// Writes the pose of a frame. Frames come in order, `pose` is fresh or as the last one left it.
    pub fn pose(&mut self, frame: u64, time: f64, pose: &mut Pose) {
        match self {
            Motion::Animation(scene) => scene.sample(time, pose),
            Motion::Table(table) => table.pose(frame, pose),
        }
    }

    /// Whether an object may be hidden now, by a placement that is flat: animators do that. In a table it is a mistake, at a line.
    pub fn may_hide(&self, object: usize) -> bool {
        match self {
            Motion::Animation(_) => true,
            Motion::Table(table) => table.lines[object].is_none(),
        }
    }

    /// Where it is written how an object is placed now: a file and perhaps a line.
    pub fn place(&self, object: usize) -> String {
        match self {
            Motion::Animation(scene) => file(scene, object),
            Motion::Table(table) => match table.lines[object] {
                Some(line) => table.placements.place(line),
                None => file(table.scene, object),
            },
        }
    }
}

impl Table<'_> {
    fn pose(&mut self, frame: u64, pose: &mut Pose) {
        if pose.objects.is_empty() {
            self.scene.sample(0.0, pose);
        }
        let rest = &self.placements.rows()[self.applied..];
        for row in rest.iter().take_while(|row| row.frame <= frame) {
            pose.objects[row.object].placement = row.placement;
            self.lines[row.object] = Some(row.line);
            self.applied += 1;
        }
    }
}

fn file(scene: &Scene, object: usize) -> String {
    scene.files()[scene.objects()[object].file()].display().to_string()
}
