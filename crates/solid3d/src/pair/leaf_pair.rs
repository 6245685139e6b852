//! Which primitives of two leaves meet.

use fearless_simd::Simd;
use solid_convex::gjk;

use super::row::{Row, verdict};
use super::table::PlacedComplex;
use super::triangle_triangle;
use crate::tree::{LEAF_SIZE, bits};

/// Holds primitives of one leaf, one by one, against those of another, eight at a time.
pub(super) struct LeafTest<'s> {
    pub a: PlacedComplex<'s>,
    pub b: PlacedComplex<'s>,
    /// Whether those of `b` are the ones.
    pub swapped: bool,
    /// Whether the first of the ones that meets any is all that is wanted.
    pub wants_first: bool,
}

impl LeafTest<'_> {
    /// Which of the ones meet which of the others, in lanes that are given by bits: eight bits for each of the ones, one for each of the others.
    #[inline(always)]
    pub fn meeting<S: Simd>(
        &self,
        simd: S,
        (ones, of_ones): (&Row, u32),
        (others, of_others): (&Row, u32),
        primitive_tests: &mut u64,
    ) -> u64 {
        let mut meeting = 0;
        let mut left = bits(of_ones);
        // Two of the ones at a time, of both of which it is first found out what is certain: each branch on that waits for it.
        while let Some(first) = next_near(simd, (ones, &mut left), (others, of_others)) {
            let second = next_near(simd, (ones, &mut left), (others, of_others));
            // What is not there is near none, whatever is said of it.
            let two = [first, second.unwrap_or((first.0, 0))];
            let triangles = two.map(|(i, near)| match ones.triangles() >> i & 1 {
                0 => 0,
                _ => near & others.triangles(),
            });
            let of_first = verdict(simd, (ones, first.0), others, triangles[0]);
            let of_second = match second {
                Some((i, _)) => verdict(simd, (ones, i), others, triangles[1]),
                None => of_first,
            };
            for (((i, near), triangles), sure) in two.into_iter().zip(triangles).zip([of_first, of_second]) {
                *primitive_tests += u64::from(near.count_ones());
                let mut meet = sure.meet & near;
                for j in bits(near & !(sure.apart | sure.meet)) {
                    let is_met = if triangles >> j & 1 == 1 {
                        triangle_triangle::intersect(&ones.triangle(i), &others.triangle(j))
                    } else {
                        self.hulls_meet(ones.primitive(i), others.primitive(j))
                    };
                    meet |= u32::from(is_met) << j;
                }
                meeting |= u64::from(meet) << (LEAF_SIZE * i);
                if self.wants_first && meet != 0 {
                    return meeting;
                }
            }
        }
        meeting
    }

    fn hulls_meet(&self, one: u32, other: u32) -> bool {
        let (a, b) = (self.a, self.b);
        let (i, j) = if self.swapped { (other, one) } else { (one, other) };
        gjk::intersection(&a.0.primitive_hull(i), a.1, &b.0.primitive_hull(j), b.1).witness().is_some()
    }
}

/// The pairs of primitives of two leaves that meet, one at least.
pub(super) struct MeetingLeaves<'r> {
    pub ones: &'r Row,
    pub others: &'r Row,
    /// Whether the ones are those of the second shape.
    pub swapped: bool,
    /// Which of the ones meet which of the others: eight bits for each of the ones, one for each of the others.
    pub meeting: u64,
}

impl<'r> MeetingLeaves<'r> {
    /// The pairs, the primitive of the first shape first, in the order of the ones.
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> {
        bits(self.meeting).map(|place| {
            let one = self.ones.primitive(place / LEAF_SIZE);
            let other = self.others.primitive(place % LEAF_SIZE);
            if self.swapped { (other, one) } else { (one, other) }
        })
    }

    /// The leaves of the first shape and the second, and which of the first meet which of the second.
    pub fn by_first(&self) -> ([&'r Row; 2], u64) {
        match self.swapped {
            true => ([self.others, self.ones], transposed(self.meeting)),
            false => ([self.ones, self.others], self.meeting),
        }
    }
}

/// The next of the ones whose box overlaps those of some of the others, and of which.
#[inline(always)]
fn next_near<S: Simd>(
    simd: S,
    (ones, left): (&Row, &mut impl Iterator<Item = usize>),
    (others, of_others): (&Row, u32),
) -> Option<(usize, u32)> {
    // A loop: what an adapter is given is not always inlined.
    for i in left {
        let near = others.overlapping(simd, &ones.bounds(i)) & of_others;
        if near != 0 {
            return Some((i, near));
        }
    }
    None
}

/// The same by columns that was by rows, or the reverse: blocks of bits beside the diagonal change places, in three steps (Warren, *Hacker's
/// Delight*, section 7-3).
#[inline(always)]
pub(super) fn transposed(mut square: u64) -> u64 {
    for (shift, mask) in
        [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)]
    {
        let changed = (square ^ square >> shift) & mask;
        square ^= changed ^ changed << shift;
    }
    square
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Complex;
    use glam::{DAffine3, DVec3};
    use rand::Rng;
    use solid_convex::simd::{alike, dispatch};
    use solid_oracle::generate::seeded;

    #[test]
    fn a_square_is_transposed() {
        let mut rng = seeded(11);
        for _ in 0..100 {
            let square: u64 = rng.random();
            for (i, j) in (0..64).map(|place| (place / 8, place % 8)) {
                assert_eq!(transposed(square) >> (8 * i + j) & 1, square >> (8 * j + i) & 1);
            }
        }
    }

    /// Law: whichever leaf is gone through, the same pairs meet, as many are tested, and the first row in which any does is that of the first
    /// pair.
    #[test]
    fn either_leaf_may_be_gone_through() {
        let seed = 12;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut pairs, mut meet) = (0, 0);
        for case in 0..1000 {
            // Those on a lattice often touch.
            let mut point = || {
                let coordinate = |_| {
                    if case % 2 == 0 {
                        f64::from(rng.random_range(0..=3))
                    } else {
                        rng.random_range(0.0..2.0)
                    }
                };
                DVec3::from_array(std::array::from_fn(coordinate))
            };
            let indices = || (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let [a, b] = [(); 2]
                .map(|()| Complex::mesh((0..24).map(|_| point()).collect(), indices()).expect("it is valid"));
            let map = DAffine3::IDENTITY;
            let [of_a, of_b]: [u32; 2] = [rng.random_range(1..256), rng.random_range(1..256)];
            let (mut rows, leaf) = ([Row::default(), Row::default()], [0, 1, 2, 3, 4, 5, 6, 7]);
            let found = alike(|level| {
                dispatch!(widest level, simd => {
                    rows[0].place(simd, &a, &leaf, &map);
                    rows[1].place(simd, &b, &leaf, &map);
                    let (in_a, in_b) = ((&rows[0], of_a), (&rows[1], of_b));
                    let mut test = LeafTest { a: (&a, &map), b: (&b, &map), swapped: false, wants_first: false };
                    let mut tests = [0; 2];
                    let meeting = test.meeting(simd, in_a, in_b, &mut tests[0]);
                    test.swapped = true;
                    assert_eq!(transposed(test.meeting(simd, in_b, in_a, &mut tests[1])), meeting, "case {case}");
                    assert_eq!(tests[0], tests[1]);
                    test = LeafTest { swapped: false, wants_first: true, ..test };
                    let first = test.meeting(simd, in_a, in_b, &mut tests[0]);
                    assert_eq!(first.trailing_zeros(), meeting.trailing_zeros());
                    meeting
                })
            });
            for (i, j) in bits(of_a).flat_map(|i| bits(of_b).map(move |j| (i, j))) {
                let expected = triangle_triangle::intersect(&rows[0].triangle(i), &rows[1].triangle(j));
                assert_eq!(found >> (8 * i + j) & 1 == 1, expected, "case {case}");
                pairs += 1;
                meet += u32::from(expected);
            }
        }
        println!("{meet} of {pairs} meet");
        assert!(10 * meet > 3 * pairs && 10 * meet < 7 * pairs);
    }
}
