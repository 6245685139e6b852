//! The part of a face of many sides that a triangle may reach.
//!
//! Where no corner of the triangle is beyond the straight way from one corner of the face to another, what of the face is beyond that has nothing in common with it: the way
//! stands for the sides that it cuts off, and few are left.

use glam::DVec3;
use smallvec::SmallVec;

/// A face of no more sides is taken as it is.
const FEW: usize = 64;

/// A convex polygon as it is seen along an axis, and a triangle.
struct Seen<'a, F> {
    count: usize,
    corner: F,
    axis: DVec3,
    triangle: &'a [DVec3],
    kept: usize,
}

/// Which corners of a convex polygon, seen counter-clockwise against an axis, to leave: what is left has as much in common with a triangle, and the sides beside a corner that
/// is `kept`. Ascending. Cost: in proportion to the sides that come near the triangle and the logarithm of the count.
pub fn part(
    count: usize,
    corner: impl Fn(usize) -> DVec3,
    axis: DVec3,
    triangle: &[DVec3],
    kept: usize,
) -> SmallVec<[usize; 16]> {
    if count <= FEW {
        return (0..count).collect();
    }
    let mut left = SmallVec::new();
    Seen { count, corner, axis, triangle, kept }.take(0, count, &mut left);
    left
}

impl<F: Fn(usize) -> DVec3> Seen<'_, F> {
    /// Takes of the sides between two corners the first corners of those that are left, or of the way that stands for them.
    fn take(&self, from: usize, to: usize, left: &mut SmallVec<[usize; 16]>) {
        if to - from == 1 || self.is_beyond(from, to) {
            left.push(from);
        } else {
            let middle = from.midpoint(to);
            self.take(from, middle, left);
            self.take(middle, to, left);
        }
    }

    /// Whether all sides between two corners are beyond the way from one to the other, seen from the triangle, and none is beside the corner that is kept.
    fn is_beyond(&self, from: usize, to: usize) -> bool {
        let is_beside = (from..=to).contains(&self.kept) || to == self.kept + self.count;
        let [start, end] = [from, to].map(|i| (self.corner)(i % self.count));
        let inward = self.axis.cross(end - start);
        !is_beside && self.triangle.iter().all(|&corner| inward.dot(corner - start) >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::f64::consts::TAU;

    use glam::{DVec2, Vec3Swizzles};
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::super::clip::{Clipped, Origin, clip};
    use super::*;

    /// Points on a stretched circle in a slanted plane, counter-clockwise seen from above; evenly or not.
    fn polygon(rng: &mut StdRng, count: usize) -> Vec<DVec3> {
        let even = rng.random_bool(0.5);
        let angle = |i: usize| if even { i as f64 / count as f64 * TAU } else { rng.random_range(0.0..TAU) };
        let mut angles: Vec<f64> = (0..count).map(angle).collect();
        angles.sort_by(f64::total_cmp);
        let (thin, slope) = (10f64.powf(rng.random_range(-2.0..0.0)), in_cube(rng).xy());
        let place = |angle: f64| {
            let at = DVec2::from_angle(angle) * DVec2::new(1.0, thin);
            at.extend(at.dot(slope))
        };
        angles.into_iter().map(place).collect()
    }

    /// Law: what is left has as much in common with the triangle as the whole, made of the same corners and sides, whichever of the two is cut by the other; and has the corner
    /// that is kept between its neighbours.
    #[test]
    fn as_much_in_common_as_the_whole() {
        let mut rng = seeded(183);
        let (mut cut, mut few) = (0, 0);
        for case in 0..20_000 {
            let count = rng.random_range(FEW + 1..400);
            let whole = polygon(&mut rng, count);
            let (size, middle) = (10f64.powf(rng.random_range(-3.0..0.5)), whole[case % count]);
            let triangle = [(); 3].map(|()| middle + in_cube(&mut rng) * size);
            let kept = rng.random_range(0..count);
            let left = part(count, |i| whole[i], DVec3::Z, &triangle, kept);
            assert!(left.is_sorted());
            for beside in [kept + count - 1, kept, kept + 1] {
                assert!(left.contains(&(beside % count)), "case {case}: {kept} of {count}, {left:?}");
            }
            let seen: Vec<DVec2> = whole.iter().map(|corner| corner.xy()).collect();
            let part: Vec<DVec2> = left.iter().map(|&i| seen[i]).collect();
            let triangle = triangle.map(|corner| corner.xy());
            let place = |i: usize| left[i % left.len()];
            let of_whole = |origin: Origin| match origin {
                Origin::OfA(i) => Origin::OfA(i),
                Origin::OfB(j) => Origin::OfB(place(j)),
                Origin::Crossing(i, j) => Origin::Crossing(i, place(j)),
            };
            let (expected, found) = (clip(&triangle, &seen), clip(&triangle, &part));
            let same =
                |x: &Clipped, y: &Clipped| x.origin == of_whole(y.origin) && x.at.distance(y.at) < 1e-12;
            assert_eq!(expected.len(), found.len(), "case {case}");
            assert!(expected.iter().all(|x| found.iter().any(|y| same(x, y))), "case {case}");
            let in_turn = clip(&part, &triangle);
            let near = |x: &Clipped| in_turn.iter().any(|y| x.at.distance(y.at) < 1e-7);
            assert!(expected.iter().all(near), "case {case}");
            cut += usize::from(!found.is_empty());
            few += usize::from(left.len() < count / 2);
        }
        assert!(cut > 10_000 && few > 10_000, "{cut}, {few}");
    }
    /// Law: of many sides few corners are looked at, where the triangle is in the face or near its outline.
    #[test]
    fn few_corners_are_looked_at() {
        let (mut rng, count) = (seeded(184), 100_000);
        for reach in [0.0, 0.5, 0.999, 1.0] {
            let middle = DVec2::from_angle(rng.random_range(0.0..TAU)).extend(0.0) * reach;
            let triangle = [(); 3].map(|()| middle + in_cube(&mut rng) * 1e-4);
            let looks = Cell::new(0);
            let corner = |i: usize| {
                looks.set(looks.get() + 1);
                DVec2::from_angle(i as f64 / count as f64 * TAU).extend(0.0)
            };
            let left = part(count, corner, DVec3::Z, &triangle, 0);
            assert!(looks.get() < 300 && left.len() < 100, "{reach}: {looks:?}, {} left", left.len());
        }
    }
}
