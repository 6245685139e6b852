//! Rays against all objects of a world.

use glam::DVec3;

use super::{ObjectId, World};
use crate::bounds::Aabb;
use crate::broad::{Proxy, bound_along, matters};
use crate::error::Result;
use crate::pair::{Hits, Ray, RayHit, RayOptions, Scratch, Wanted, ray_hits, world_bounds};
use crate::tree::TreeRay;

/// Where a ray meets an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectHit {
    /// The object.
    pub object: ObjectId,
    /// Where, and which surface.
    pub hit: RayHit,
}

/// The way of a ray.
fn path(ray: &Ray) -> TreeRay {
    TreeRay { origin: ray.origin, direction: ray.direction, half_extents: DVec3::ZERO }
}

impl World {
    /// What a ray or segment meets first, among the objects that `counts` lets through; `None` when it meets nothing.
    /// Of objects that are met at the same `t`, the one that comes first in the order of pairs.
    ///
    /// See [`query::cast_ray`](crate::query::cast_ray) for what a hit is. Objects are met where they are now, whatever their
    /// response. Cost: follows the objects whose boxes the ray meets; those that were added or moved since the last test or
    /// [`refresh`](World::refresh) are looked at one by one.
    ///
    /// ```
    /// use solid3d::{Shape, World, glam::{DAffine3, DVec3}, query::{Ray, RayOptions}};
    /// let (mut world, ball) = (World::new(), Shape::sphere(1.0)?);
    /// let near = world.add(&ball, DAffine3::from_translation(DVec3::X * 5.0))?;
    /// let far = world.add(&ball, DAffine3::from_translation(DVec3::X * 9.0))?;
    /// let (ray, options) = (Ray::new(DVec3::ZERO, DVec3::X), RayOptions::default());
    /// let first = world.cast_ray(&ray, &options, |_| true)?.unwrap();
    /// assert_eq!((first.object, first.hit.t), (near, 4.0));
    /// let first = world.cast_ray(&ray, &options, |object| object != near)?.unwrap();
    /// assert_eq!((first.object, first.hit.t), (far, 8.0));
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn cast_ray(
        &self,
        ray: &Ray,
        options: &RayOptions,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Option<ObjectHit>> {
        let (ray, mut best) = (ray.checked()?, None::<ObjectHit>);
        self.along(&path(ray), ray.max, |object, until, scratch| {
            if counts(object) {
                let mut hits = Hits::new(ray, options, Wanted::First);
                hits.until = until;
                ray_hits(self.objects[object].placed(), &mut hits, scratch);
                let order = |id: ObjectId| self.objects[id].order;
                let better = |hit: &RayHit| {
                    best.is_none_or(|best| (hit.t, order(object)) < (best.hit.t, order(best.object)))
                };
                if let Some(hit) = hits.found.filter(better) {
                    best = Some(ObjectHit { object, hit });
                    return hit.t;
                }
            }
            until
        });
        Ok(best)
    }

    /// Everything that a ray or segment meets, among the objects that `counts` lets through: in the order of `t`, then of pairs,
    /// then of primitives. See [`query::cast_ray_all`](crate::query::cast_ray_all) and [`cast_ray`](World::cast_ray).
    pub fn cast_ray_all(
        &self,
        ray: &Ray,
        options: &RayOptions,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<Vec<ObjectHit>> {
        let (ray, mut all) = (ray.checked()?, Vec::new());
        self.along(&path(ray), ray.max, |object, until, scratch| {
            if counts(object) {
                let mut hits = Hits::new(ray, options, Wanted::All);
                ray_hits(self.objects[object].placed(), &mut hits, scratch);
                all.extend(hits.sorted().into_iter().map(|hit| ObjectHit { object, hit }));
            }
            until
        });
        let order = |hit: &ObjectHit| self.objects[hit.object].order;
        // Stable: the hits of one object stay in their order.
        all.sort_by(|x, y| x.hit.t.total_cmp(&y.hit.t).then(order(x).cmp(&order(y))));
        Ok(all)
    }

    /// Whether a ray or segment meets any of the objects that `counts` lets through: the first that is found ends the search. See
    /// [`cast_ray`](World::cast_ray).
    pub fn ray_meets(
        &self,
        ray: &Ray,
        options: &RayOptions,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Result<bool> {
        let (ray, mut met) = (ray.checked()?, false);
        self.along(&path(ray), ray.max, |object, until, scratch| {
            if !met && counts(object) {
                let mut hits = Hits::new(ray, options, Wanted::Any);
                ray_hits(self.objects[object].placed(), &mut hits, scratch);
                met = hits.found.is_some();
            }
            if met { f64::NEG_INFINITY } else { until }
        });
        Ok(met)
    }

    /// Visits the objects whose boxes a ray, or a box that moves along one, meets up to `until`, about from the nearest on, each with the
    /// greatest `t` that is of interest; each visit gives the new one.
    pub(super) fn along(
        &self,
        path: &TreeRay,
        mut until: f64,
        mut visit: impl FnMut(ObjectId, f64, &mut Scratch) -> f64,
    ) {
        let bound = bound_along(path);
        Scratch::with(|scratch| {
            for (id, bounds) in self.elsewhere() {
                if matters(bound(&bounds), until) {
                    until = visit(id, until, scratch);
                }
            }
            self.broad.for_each_along(path, until, &mut |proxy| {
                if let Some(id) = self.in_place(proxy) {
                    until = visit(id, until, scratch);
                }
                until
            });
        });
    }

    /// The objects whose boxes in the broad phase are out of date, and where their boxes are.
    pub(super) fn elsewhere(&self) -> impl Iterator<Item = (ObjectId, Aabb)> {
        self.stirred.elsewhere().map(|slot| {
            let object = self.objects.at(slot).expect("what is elsewhere is in the world");
            (self.objects.id_of(slot), world_bounds(object.placed()))
        })
    }

    /// The object whose box in the broad phase is up to date.
    pub(super) fn in_place(&self, proxy: Proxy) -> Option<ObjectId> {
        let is_there = self.objects.at(proxy).is_some() && !self.stirred.is_elsewhere(proxy);
        is_there.then(|| self.objects.id_of(proxy))
    }
}
