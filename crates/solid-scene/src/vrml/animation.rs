//! What moves and deforms the objects of a file.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::interpolator::Event;
use super::signal::{SignalId, Signals};
use super::transform::Transform;
use crate::part::Motion;
use crate::pose::ObjectPose;

/// The motion of a file.
#[derive(Debug)]
pub(super) struct Animation {
    pub signals: Signals,
    /// The Transforms that move, each after the one around it.
    pub frames: Vec<Frame>,
    pub objects: Vec<ObjectMotion>,
}

/// A Transform that moves, at one place of the tree.
#[derive(Debug)]
pub(super) struct Frame {
    pub around: Surrounding,
    /// The fields until a signal sends others.
    pub rest: Transform,
    pub drives: Drives,
}

/// Where something is: in a frame, or the world, by way of the Transforms in between that do not move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surrounding {
    pub frame: Option<usize>,
    pub offset: DAffine3,
}

/// The signals into the fields of a Transform.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Drives {
    pub translation: Option<SignalId>,
    pub rotation: Option<SignalId>,
    pub scale: Option<SignalId>,
    pub scale_orientation: Option<SignalId>,
    pub center: Option<SignalId>,
}

/// Where an object is, and what deforms it.
#[derive(Debug)]
pub(super) struct ObjectMotion {
    pub around: Surrounding,
    pub deformation: Option<Deformation>,
}

/// A signal of the positions of vertices.
#[derive(Clone, Debug)]
pub(super) struct Deformation {
    pub signal: SignalId,
    /// The positions until the signal sends others.
    pub rest: Arc<[DVec3]>,
}

impl Surrounding {
    /// The world.
    pub const WORLD: Surrounding = Surrounding { frame: None, offset: DAffine3::IDENTITY };

    fn to_world(self, frames: &[DAffine3]) -> DAffine3 {
        match self.frame {
            Some(frame) => frames[frame] * self.offset,
            None => self.offset,
        }
    }
}

impl Drives {
    /// The fields with what the signals have sent.
    fn apply(&self, rest: &Transform, events: &[Option<Event>]) -> Transform {
        let event = |signal: Option<SignalId>| signal.and_then(|signal| events[signal].as_ref());
        let vector = |signal, rest| match event(signal) {
            Some(Event::Vector(value)) => *value,
            _ => rest,
        };
        let rotation = |signal, rest| match event(signal) {
            Some(Event::Rotation(value)) => *value,
            _ => rest,
        };
        Transform {
            translation: vector(self.translation, rest.translation),
            rotation: rotation(self.rotation, rest.rotation),
            scale: vector(self.scale, rest.scale),
            scale_orientation: rotation(self.scale_orientation, rest.scale_orientation),
            center: vector(self.center, rest.center),
        }
    }
}

impl Deformation {
    fn write(&self, events: &[Option<Event>], positions: &mut Vec<DVec3>) {
        positions.clear();
        match &events[self.signal] {
            Some(Event::Points(points)) => positions.extend_from_slice(points),
            _ => positions.extend_from_slice(&self.rest),
        }
    }
}

impl Motion for Animation {
    fn sample(&self, time: f64, poses: &mut [ObjectPose]) {
        let events = self.signals.at(time);
        let mut frames = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            let local = frame.drives.apply(&frame.rest, &events).map();
            frames.push(frame.around.to_world(&frames) * local);
        }
        for (pose, object) in poses.iter_mut().zip(&self.objects) {
            pose.placement = object.around.to_world(&frames);
            match &object.deformation {
                Some(deformation) => deformation.write(&events, &mut pose.positions),
                None => pose.positions.clear(),
            }
        }
    }
}
