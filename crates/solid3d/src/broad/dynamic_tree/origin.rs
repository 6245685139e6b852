//! Where the coordinates of the tree begin.
//!
//! Numbers of `f32` are 2^-24 of themselves apart. Where boxes are further from the origin than that many times their size, as the parts of a
//! plan in coordinates of the earth are, fat boxes from there would all overlap: so they are given from among the boxes.

use glam::DVec3;

use super::fat_box::FatBox;
use crate::bounds::Aabb;
use crate::broad::{Proxy, is_ordered};

/// Boxes that are looked at, at most.
const SAMPLE: usize = 64;

/// A box is coarse when it is further from the origin than this many times its longest side: rounding then adds up to a sixteenth of that to
/// its fat box, as much as its margin.
const COARSE: f64 = (1 << 19) as f64;

/// Where the coordinates of fat boxes begin; nowhere else than those of boxes, mostly.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Origin(Option<DVec3>);

impl Origin {
    /// A box from the origin. Monotone: where a coordinate is not below another it is not below it from here either, so no overlap is lost.
    #[inline(always)]
    pub fn local(self, bounds: &Aabb) -> Aabb {
        let Some(origin) = self.0 else { return *bounds };
        let from = |point: DVec3| (point - origin).clamp(DVec3::MIN, DVec3::MAX);
        Aabb::new(from(bounds.min), from(bounds.max))
    }

    /// Where it is.
    pub fn point(self) -> DVec3 {
        self.0.unwrap_or_default()
    }

    /// Whether it is that of the world: then boxes from it are the boxes.
    #[inline(always)]
    pub fn is_of_world(self) -> bool {
        self.0.is_none()
    }

    /// Whether a box is not empty, and lies in a fat box from the origin.
    #[inline(never)]
    pub fn is_held(self, fat: &FatBox, bounds: &Aabb) -> bool {
        // What is not ordered may be from here, since it is rounded.
        is_ordered(bounds) && fat.holds(&self.local(bounds))
    }

    /// A box that holds all that a box from the origin holds. To the next numbers outside: sums and differences are rounded.
    #[inline]
    pub fn world(self, bounds: &Aabb) -> Aabb {
        let Some(origin) = self.0 else { return *bounds };
        let outward = |local: DVec3, next: fn(f64) -> f64| {
            let sum = (local.map(next) + origin).map(next);
            DVec3::select(local.abs().cmpge(DVec3::MAX), local, sum)
        };
        Aabb::new(outward(bounds.min, f64::next_down), outward(bounds.max, f64::next_up))
    }

    /// Moves to where most of the boxes of so many proxies are, judged by some of them, if they are far; whether it did.
    pub fn approach(
        &mut self,
        count: usize,
        proxies: impl Iterator<Item = Proxy>,
        bounds: impl Fn(Proxy) -> Aabb,
    ) -> bool {
        let (mut sample, mut len) = ([Aabb::EMPTY; SAMPLE], 0);
        for (to, proxy) in sample.iter_mut().zip(proxies.step_by(count.div_ceil(SAMPLE).max(1))) {
            *to = bounds(proxy);
            len += 1;
        }
        let better = better_origin(self.0.unwrap_or_default(), &sample[..len]);
        self.0 = better.or(self.0);
        better.is_some()
    }
}

/// Another origin, if from the one there is most of some boxes are coarse, and by far fewer from it: the middle of them by each coordinate.
fn better_origin(origin: DVec3, boxes: &[Aabb]) -> Option<DVec3> {
    let is_coarse = |bounds: &Aabb, origin: DVec3| {
        let extent = 2.0 * bounds.half_extents().max_element();
        (bounds.center() - origin).abs().max_element() > COARSE * extent
    };
    let coarse = |origin: DVec3| boxes.iter().filter(|bounds| is_coarse(bounds, origin)).count();
    let count = coarse(origin);
    if 2 * count <= boxes.len() {
        return None;
    }
    let mut coordinates = [0.0; SAMPLE];
    let coordinates = &mut coordinates[..boxes.len()];
    let middle = DVec3::from_array(std::array::from_fn(|axis| {
        for (coordinate, bounds) in coordinates.iter_mut().zip(boxes) {
            *coordinate = bounds.center()[axis];
        }
        coordinates.sort_unstable_by(f64::total_cmp);
        coordinates[coordinates.len() / 2]
    }));
    (2 * coarse(middle) < count).then_some(middle)
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    fn boxes(offset: f64) -> Vec<Aabb> {
        let at = |i: usize| DVec3::new(offset + 2.0 * i as f64, -offset, 0.0);
        (0..SAMPLE).map(|i| Aabb::new(at(i), at(i) + 1.0)).collect()
    }

    /// Law: what is outside of a box in the world is outside of it from the origin, or in its rounding, wherever the origin is.
    #[test]
    fn there_and_back_a_box_grows() {
        let mut rng = seeded(819);
        for _ in 0..10_000 {
            let mut vector =
                |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
            let at = Origin(Some(vector(1e12)));
            let min = vector(1e12) * f64::from(10.0_f32.powi(vector(20.0).x as i32));
            let bounds = Aabb::new(min, min + vector(1.0).abs());
            let local = at.local(&bounds);
            let world = at.world(&local);
            assert!(
                world.min.cmple(bounds.min).all() && world.max.cmpge(bounds.max).all(),
                "{at:?} {bounds:?}"
            );
        }
        let far = Origin(Some(DVec3::splat(-1e308)));
        let all = Aabb::new(DVec3::splat(1e308), DVec3::splat(1.5e308));
        assert_eq!(far.local(&all), Aabb::new(DVec3::MAX, DVec3::MAX));
        assert_eq!(far.world(&far.local(&all)).max, DVec3::MAX);
    }

    /// Law: the origin moves to where most boxes are, if they are far, and stays there.
    #[test]
    fn it_moves_once() {
        assert_eq!(better_origin(DVec3::ZERO, &boxes(1e5)), None);
        let mut far = boxes(1e9);
        far[..SAMPLE / 3].copy_from_slice(&boxes(0.0)[..SAMPLE / 3]);
        let origin = better_origin(DVec3::ZERO, &far).expect("most are far");
        assert!((origin.x - 1e9).abs() < 200.0 && (origin.y + 1e9).abs() < 200.0, "{origin}");
        assert_eq!(better_origin(origin, &far), None);
    }

    /// Law: nothing is gained where boxes are far from each other, or points.
    #[test]
    fn it_stays_where_no_other_is_better() {
        let apart: Vec<_> = (0..SAMPLE)
            .map(|i| DVec3::splat(1e9 * (1 + i) as f64))
            .map(|at| Aabb::new(at, at + 1.0))
            .collect();
        assert_eq!(better_origin(DVec3::ZERO, &apart), None);
        let points: Vec<_> = boxes(1.0).iter().map(|bounds| Aabb::new(bounds.min, bounds.min)).collect();
        assert_eq!(better_origin(DVec3::ZERO, &points), None);
        assert_eq!(better_origin(DVec3::ZERO, &[]), None);
    }
}
