//! The boxes of proxies, as they are told.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;
use solid_convex::simd::prefetch;

use super::Proxy;
use super::room::resize_on_threads;
use crate::bounds::Aabb;

/// The numbers of a box: its least coordinates, then its greatest.
pub(super) type Row = [f64; ROW];

const ROW: usize = 6;

/// Of the bits that say on which axes boxes are [apart](Boxes::apart_with), those that do.
pub(super) const AXES: u64 = 0b111;

/// Boxes by proxy, one after the other. After the last is room for one more, so that from each number of a box four can be read at once.
#[derive(Clone, Debug)]
pub(super) struct Boxes(Vec<Row>);

const EMPTY: Row = row(&Aabb::EMPTY);

impl Default for Boxes {
    fn default() -> Self {
        Boxes(vec![EMPTY])
    }
}

/// The numbers of a box.
#[inline(always)]
pub(super) const fn row(Aabb { min, max }: &Aabb) -> Row {
    [min.x, min.y, min.z, max.x, max.y, max.z]
}

/// The box of such numbers.
pub(super) fn of_row([a, b, c, d, e, f]: Row) -> Aabb {
    Aabb::new(DVec3::new(a, b, c), DVec3::new(d, e, f))
}

impl Boxes {
    /// How many proxies there is room for.
    pub fn len(&self) -> usize {
        self.0.len() - 1
    }

    /// Makes room for proxies below `proxies`; their boxes are empty.
    pub fn grow(&mut self, proxies: usize) {
        resize_on_threads(&mut self.0, proxies + 1, EMPTY);
    }

    /// Gives back what room there is for more proxies.
    pub fn trim(&mut self) {
        self.0.shrink_to_fit();
    }

    pub fn get(&self, proxy: Proxy) -> Aabb {
        of_row(self.0[proxy as usize])
    }

    /// Asks for the memory of a box.
    #[inline(always)]
    pub fn prefetch(&self, proxy: Proxy) {
        prefetch(&self.0[proxy as usize]);
    }

    /// The numbers of the boxes, by proxy.
    pub fn rows_mut(&mut self) -> &mut [Row] {
        let proxies = self.len();
        &mut self.0[..proxies]
    }

    /// Whether the boxes of two proxies share a point.
    pub fn overlap(&self, a: Proxy, b: Proxy) -> bool {
        let (a, b) = (&self.0[a as usize], &self.0[b as usize]);
        (0..3).fold(true, |is, k| is & (a[k] <= b[k + 3]) & (b[k] <= a[k + 3]))
    }

    /// In vectors, on which axes they do not: a bit for each, and a fourth that is of no account. `FAR` is for boxes that are not in the
    /// caches; it changes nothing but the time.
    #[inline(always)]
    pub fn apart_with<S: Simd, const FAR: bool>(&self, simd: S, a: Proxy, b: Proxy) -> u64 {
        let [a_min, a_max] = self.corners::<S, FAR>(simd, a);
        let [b_min, b_max] = self.corners::<S, FAR>(simd, b);
        (a_min.simd_gt(b_max) | b_min.simd_gt(a_max)).to_bitmask()
    }

    /// The least and the greatest coordinates of a box, and something more in the last lanes.
    #[inline(always)]
    fn corners<S: Simd, const FAR: bool>(&self, simd: S, proxy: Proxy) -> [f64x4<S>; 2] {
        let at = proxy as usize;
        if FAR {
            let row = &self.0[at];
            let last = f64x4::from_slice(simd, &row[2..]);
            [f64x4::from_slice(simd, &row[..4]), last.slide::<1>(last)]
        } else {
            // One instruction less. But the number after a box is in a line of memory of its own for a quarter of all boxes.
            let numbers = self.0[at..at + 2].as_flattened();
            [f64x4::from_slice(simd, &numbers[..4]), f64x4::from_slice(simd, &numbers[3..7])]
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_convex::simd::{dispatch, levels};
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: at any level, boxes are apart that do not overlap; those that touch are not, and an empty one is apart from all.
    #[test]
    fn boxes_are_apart_or_overlap() {
        let mut rng = seeded(812);
        let count = 100;
        let mut boxes = Boxes::default();
        boxes.grow(count + 1);
        for numbers in &mut boxes.rows_mut()[..count] {
            let mut any = |most: i32| f64::from(rng.random_range(0..=most));
            let min = DVec3::new(any(3), any(3), any(3));
            *numbers = row(&Aabb::new(min, min + DVec3::new(any(3), any(3), any(3))));
        }
        let (mut hits, proxies) = (0, 0..boxes.len() as Proxy);
        assert_eq!(boxes.len(), count + 1);
        for (a, b) in proxies.clone().flat_map(|a| proxies.clone().map(move |b| (a, b))) {
            let expected = boxes.get(a).overlaps(&boxes.get(b));
            assert_eq!(boxes.overlap(a, b), expected);
            for level in levels() {
                let near = dispatch!(level, simd => boxes.apart_with::<_, false>(simd, a, b));
                let far = dispatch!(level, simd => boxes.apart_with::<_, true>(simd, a, b));
                assert_eq!(
                    [near, far].map(|apart| apart & AXES == 0),
                    [expected; 2],
                    "{level:?}, {a} and {b}"
                );
            }
            hits += usize::from(expected);
        }
        assert!((3000..7000).contains(&hits), "{hits} pairs overlap");
    }
}
