//! A box on its way.

use crate::bounds::Aabb;

/// A box that moves, each of its sides at constant speed.
pub(super) struct MovingBox {
    pub from: Aabb,
    pub to: Aabb,
}

impl MovingBox {
    /// The box around the whole way.
    pub fn bounds(&self) -> Aabb {
        self.from.union(&self.to)
    }

    /// Whether it touches a box that stands still at some time, up to rounding: along each axis it does so in an interval of
    /// time, and these have a time in common. Measured with two meshes of 80,000 triangles that pass each other by, a radius
    /// in a frame along a diagonal: 10 ms; with the box around the way alone 5.7 s, for 5.4 million tests of primitives.
    pub fn meets(&self, still: &Aabb) -> bool {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        let mut while_positive = |at_start: f64, at_end: f64| {
            let crossing = || at_start / (at_start - at_end);
            match (at_start >= 0.0, at_end >= 0.0) {
                (true, true) => {}
                (false, true) => first = first.max(crossing()),
                (true, false) => last = last.min(crossing()),
                (false, false) => last = -1.0,
            }
        };
        for axis in 0..3 {
            let below = |moving: &Aabb| still.max[axis] - moving.min[axis];
            let above = |moving: &Aabb| moving.max[axis] - still.min[axis];
            while_positive(below(&self.from), below(&self.to));
            while_positive(above(&self.from), above(&self.to));
        }
        first <= last
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use rand::Rng;
    use solid_oracle::generate::seeded;

    /// The slow twin looks at many times.
    #[test]
    fn a_moving_box_meets_what_it_touches_at_some_time() {
        let mut rng = seeded(910);
        let (cases, mut hits) = (4000, 0);
        for _ in 0..cases {
            let mut corner =
                |size: f64| DVec3::from_array(std::array::from_fn(|_| size * rng.random::<f64>()));
            let [from, to, still] = [6.0, 6.0, 6.0].map(|room| {
                let min = corner(room);
                Aabb::new(min, min + corner(3.0))
            });
            let at = |t: f64| Aabb::new(from.min.lerp(to.min, t), from.max.lerp(to.max, t));
            let expected = (0..=1000).any(|i| at(f64::from(i) / 1000.0).overlaps(&still));
            let found = MovingBox { from, to }.meets(&still);
            // Between two of these times it may only just touch.
            let nearly = (0..=1000).any(|i| at(f64::from(i) / 1000.0).overlaps(&still.inflated(3e-3)));
            assert!(found || !expected);
            assert!(nearly || !found);
            hits += usize::from(found);
        }
        assert!((cases / 5..4 * cases / 5).contains(&hits), "{hits}");
    }
}
