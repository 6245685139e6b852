use std::cell::RefCell;

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::intersection_test;
use rand::rngs::StdRng;
use solid3d::glam::DAffine3;
use solid3d::{ObjectId, Response, World, WorldOptions};

use super::asked::{Asker, SUPPORTED, VALID, contact_points, number};
use super::kinds::Kind;
use crate::inputs::{ICollide, Pose, Settings};
use crate::peers::Effort;
use crate::peers::contestants::Library;
use crate::peers::contestants::parry::double;

/// Objects of a crowd.
pub const OBJECTS: usize = 1_000;

/// Objects that all move, as the polyhedra of I-COLLIDE do.
pub struct Crowd<'k> {
    /// The kinds, in turns.
    kinds: Vec<&'k Kind>,
    frames: Vec<Frame>,
}

/// Where the objects are, in the types of both libraries.
struct Frame {
    ours: Vec<DAffine3>,
    theirs: Vec<ParryPose>,
}

/// A question to ours, and to parry.
type OfCrowd = for<'q> fn(&'q Crowd) -> (Asker<'q>, Option<Asker<'q>>);

/// Of a frame: placing all, finding all, ending it.
pub const OF_CROWDS: [(&str, OfCrowd); 2] = [
    ("collisions", |crowd| {
        let meet = |[a, b]: [&Kind; 2], [at_a, at_b]: [&ParryPose; 2]| {
            number(intersection_test(at_a, &*a.theirs, at_b, &*b.theirs).expect(SUPPORTED).intersecting)
        };
        (crowd.ours(Response::Simple), Some(crowd.theirs(meet)))
    }),
    ("contacts", |crowd| (crowd.ours(Response::Contacts), Some(crowd.theirs(contact_points)))),
];

impl<'k> Crowd<'k> {
    pub fn new(effort: Effort, rng: &mut StdRng, kinds: Vec<&'k Kind>) -> Self {
        let settings = Settings { objects: effort.size(OBJECTS), ..Settings::default() };
        let mut simulation = ICollide::new(rng, &settings);
        let mut frame = |_| {
            let poses = simulation.poses();
            simulation.step([]);
            let (ours, theirs) = (poses.iter().map(Pose::affine), poses.iter().map(double::Parry::pose));
            Frame { ours: ours.collect(), theirs: theirs.collect() }
        };
        Crowd { kinds, frames: (0..effort.sample(20)).map(&mut frame).collect() }
    }

    /// How many frames are played: there and back.
    pub fn len(&self) -> usize {
        2 * self.frames.len()
    }

    fn frame(&self, i: usize) -> &Frame {
        &self.frames[i.min(self.len() - 1 - i)]
    }

    fn kind(&self, object: usize) -> &Kind {
        self.kinds[object % self.kinds.len()]
    }

    fn ours(&self, response: Response) -> Asker<'_> {
        let mut world =
            World::with_options(&WorldOptions { default_response: response, ..WorldOptions::default() });
        let add = |(i, at): (usize, &DAffine3)| world.add(&self.kind(i).ours, *at).expect(VALID);
        let ids: Vec<ObjectId> = self.frame(0).ours.iter().enumerate().map(add).collect();
        let (world, collisions) = (RefCell::new(world), RefCell::new(Vec::new()));
        Box::new(move |i| {
            let (mut world, mut collisions) = (world.borrow_mut(), collisions.borrow_mut());
            for (id, at) in ids.iter().zip(&self.frame(i).ours) {
                world.set_placement(*id, *at).expect(VALID);
            }
            world.test_into(&mut collisions);
            world.proceed();
            collisions.len() as f64
        })
    }

    /// With parry's tree, and what is asked of each pair of which the boxes overlap.
    fn theirs<'q>(&'q self, ask: impl Fn([&Kind; 2], [&ParryPose; 2]) -> f64 + 'q) -> Asker<'q> {
        let bounds = move |(i, at): (usize, &ParryPose)| self.kind(i).theirs.compute_aabb(at);
        let boxes = self.frame(0).theirs.iter().enumerate().map(bounds);
        let crowd = RefCell::new(double::Crowd::new(boxes));
        Box::new(move |i| {
            let at = &self.frame(i).theirs;
            let mut found = 0.0;
            crowd.borrow_mut().frame(at.iter().enumerate().map(bounds), |i, j| {
                let pair = [i as usize, j as usize];
                found += ask(pair.map(|i| self.kind(i)), pair.map(|i| &at[i]));
            });
            found
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::kinds;
    use super::*;
    use crate::inputs::seeded;

    #[test]
    fn both_find_as_many_collisions_in_each_frame() {
        let mut rng = seeded(1999);
        let kinds = kinds::all(Effort::Smoke, &mut rng);
        let convex = kinds.iter().filter(|kind| kind.theirs.as_trimesh().is_none()).collect();
        let crowd = Crowd::new(Effort::Smoke, &mut rng, convex);
        let (_, ask) = OF_CROWDS[0];
        let (ours, theirs) = ask(&crowd);
        let (found, expected): (Vec<f64>, Vec<f64>) =
            (0..crowd.len()).map(|i| (ours(i), theirs.as_ref().expect("parry has an answer")(i))).unzip();
        assert_eq!(found, expected);
        assert!(found.iter().sum::<f64>() > 0.0, "nothing collides");
    }
}
