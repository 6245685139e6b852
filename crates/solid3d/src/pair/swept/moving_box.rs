//! A box on its way.

use crate::bounds::Aabb;

/// A box that moves, each of its sides at constant speed.
pub(super) struct MovingBox {
    pub from: Aabb,
    pub to: Aabb,
}

impl MovingBox {
    /// A box that does not move.
    pub fn still(bounds: Aabb) -> MovingBox {
        MovingBox { from: bounds, to: bounds }
    }

    /// The box around the whole way.
    pub fn bounds(&self) -> Aabb {
        self.from.union(&self.to)
    }

    /// The same grown to all sides.
    pub fn inflated(&self, by: f64) -> MovingBox {
        MovingBox { from: self.from.inflated(by), to: self.to.inflated(by) }
    }

    /// Whether it touches a box that stands still at some time, up to rounding. Measured with two meshes of 80,000 triangles that pass each
    /// other by, a radius in a frame along a diagonal: 10 ms; with the box around the way alone 5.7 s, for 5.4 million tests of primitives.
    pub fn meets(&self, still: &Aabb) -> bool {
        self.touches(&MovingBox::still(*still)).is_some()
    }

    /// From when on, of a way that takes the time 1, it touches another that moves, up to rounding: along each axis it does so in an interval
    /// of time, and these have a time in common, or none.
    pub fn touches(&self, other: &MovingBox) -> Option<f64> {
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
            let below = |of: fn(&MovingBox) -> &Aabb| of(other).max[axis] - of(self).min[axis];
            let above = |of: fn(&MovingBox) -> &Aabb| of(self).max[axis] - of(other).min[axis];
            while_positive(below(|moving| &moving.from), below(|moving| &moving.to));
            while_positive(above(|moving| &moving.from), above(|moving| &moving.to));
        }
        (first <= last).then_some(first)
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
