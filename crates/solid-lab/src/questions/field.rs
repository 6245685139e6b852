use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry3d_f64::query::{Ray as ParryRay, intersection_test};
use rand::Rng;
use rand::rngs::StdRng;
use solid3d::World;
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query::{Ray, RayOptions};

use super::asked::{Asker, SUPPORTED, VALID};
use super::kinds::Kind;
use crate::inputs::{ICollide, Settings, direction};
use crate::peers::Effort;
use crate::peers::contestants::Library;
use crate::peers::contestants::parry::double::{self, vector};

/// Objects of a field, at most.
pub const OBJECTS: [usize; 3] = [1_000, 10_000, 100_000];

/// Objects that are at rest, in the trees of both libraries, as dense as the polyhedra of I-COLLIDE are.
pub struct Field<'k> {
    /// The kinds, in turns.
    kinds: Vec<&'k Kind>,
    world: World,
    tree: Bvh,
    poses: Vec<ParryPose>,
    /// From where it is asked, and whither.
    views: Vec<[DVec3; 2]>,
}

/// A question to ours, and to parry.
type OfField = for<'q> fn(&'q Field) -> (Asker<'q>, Option<Asker<'q>>);

/// Of a world at rest.
pub const OF_FIELDS: [(&str, OfField); 2] = [
    ("first hit of a ray", |field| {
        let ours = |i: usize| {
            let [from, along] = field.views[i];
            let hit = field.world.cast_ray(&Ray::new(from, along), &RayOptions::default(), |_| true);
            hit.expect(VALID).map_or(-1.0, |hit| hit.hit.t)
        };
        let theirs = |i: usize| {
            let [from, along] = field.views[i].map(vector);
            let ray = ParryRay::new(from, along);
            let cast = |i: u32, until| field.theirs(i).0.cast_ray(field.theirs(i).1, &ray, until, true);
            field.tree.cast_ray(&ray, f64::MAX, cast).map_or(-1.0, |(_, t)| t)
        };
        (Box::new(ours), Some(Box::new(theirs)))
    }),
    ("objects that meet a ball", |field| {
        let ball = field.kinds[0];
        let ours = move |i: usize| {
            let at = DAffine3::from_translation(field.views[i][0]);
            field.world.objects_in(&ball.ours, &at).expect(VALID).len() as f64
        };
        let theirs = move |i: usize| {
            let at = ParryPose::from_translation(vector(field.views[i][0]));
            let meets = |&i: &u32| {
                let (shape, pose) = field.theirs(i);
                intersection_test(&at, &*ball.theirs, pose, shape).expect(SUPPORTED).intersecting
            };
            field.tree.intersect_aabb(&ball.theirs.compute_aabb(&at)).filter(meets).count() as f64
        };
        (Box::new(ours), Some(Box::new(theirs)))
    }),
];

impl<'k> Field<'k> {
    pub fn new(effort: Effort, rng: &mut StdRng, kinds: Vec<&'k Kind>, objects: usize) -> Self {
        let settings = Settings { objects: effort.size(objects), ..Settings::default() };
        let simulation = ICollide::new(rng, &settings);
        let mut world = World::new();
        for (pose, kind) in simulation.poses().iter().zip(kinds.iter().cycle()) {
            world.add(&kind.ours, pose.affine()).expect(VALID);
        }
        // Else each question would look at all objects: none would be in the tree.
        world.refresh();
        let poses: Vec<ParryPose> = simulation.poses().iter().map(double::Parry::pose).collect();
        let boxes: Vec<_> = poses
            .iter()
            .zip(kinds.iter().cycle())
            .map(|(pose, kind)| kind.theirs.compute_aabb(pose))
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let inside = |rng: &mut StdRng| {
            DVec3::from_array([(); 3].map(|()| rng.random_range(-simulation.side..simulation.side)))
        };
        let views = (0..effort.sample(500)).map(|_| [inside(rng), direction(rng)]).collect();
        Field { kinds, world, tree, poses, views }
    }

    /// How many questions there are.
    pub fn len(&self) -> usize {
        self.views.len()
    }

    fn theirs(&self, object: u32) -> (&dyn parry3d_f64::shape::Shape, &ParryPose) {
        let object = object as usize;
        (&*self.kinds[object % self.kinds.len()].theirs, &self.poses[object])
    }
}

#[cfg(test)]
mod tests {
    use super::super::kinds;
    use super::*;
    use crate::inputs::seeded;

    #[test]
    fn both_give_the_same_answers() {
        let mut rng = seeded(1999);
        let kinds = kinds::all(Effort::Smoke, &mut rng);
        let convex = kinds.iter().filter(|kind| kind.theirs.as_trimesh().is_none()).collect();
        let field = Field::new(Effort::Quick, &mut rng, convex, OBJECTS[0]);
        for (question, ask) in OF_FIELDS {
            let (ours, theirs) = ask(&field);
            let theirs = theirs.expect("parry has an answer");
            let mut found = 0;
            for i in 0..field.len() {
                let (ours, theirs) = (ours(i), theirs(i));
                assert!((ours - theirs).abs() < 1e-6, "{question}: {ours}, {theirs}");
                found += usize::from(ours > 0.0);
            }
            assert!(found > field.len() / 20, "{question}: {found} answers");
        }
    }
}
