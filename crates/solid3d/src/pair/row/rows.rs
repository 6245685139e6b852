//! Rows that are kept.

use fearless_simd::Simd;
use glam::DAffine3;

use super::Row;
use crate::shape::Complex;

/// How many rows are kept: nearly all leaves of a mesh that meet another mesh, mostly.
const ROWS: usize = 64;

/// For how many places of leaves it is noted which row they have.
const SLOTS: usize = 256;

/// Leaves begin at least so far apart, mostly: those of one neighbourhood then have slots of their own.
const STRIDE: usize = 4;

/// The rows of one shape placed lately: where two trees meet, each leaf of one meets several of the other, soon after each other.
#[derive(Debug)]
pub(crate) struct Rows {
    /// As many as were ever needed at once.
    rows: Vec<Row>,
    /// By the place of a leaf: the row that it has, if it has one.
    row_of: [u8; SLOTS],
    /// What is in each row: where in the order its leaf begins, and above these bits the age in which it was placed. It stands apart from the
    /// row, which is large.
    key_of: [u64; ROWS],
    /// How often all was forgotten, from 1 on: what is in a row of another age is of another shape, or was elsewhere.
    age: u32,
    /// The row that is written next: they take turns.
    next: u8,
}

impl Default for Rows {
    fn default() -> Self {
        Rows { rows: Vec::new(), row_of: [0; SLOTS], key_of: [0; ROWS], age: 1, next: 0 }
    }
}

impl Rows {
    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<Row>()
    }

    /// Forgets all: before another shape is placed, or the same elsewhere.
    pub fn clear(&mut self) {
        self.next = 0;
        match self.age.checked_add(1) {
            Some(age) => self.age = age,
            None => (self.key_of, self.age) = ([0; ROWS], 1),
        }
    }

    /// The primitives of a leaf of a shape, placed now or before.
    #[inline(always)]
    pub fn place<S: Simd>(&mut self, simd: S, complex: &Complex, leaf: &[u32], map: &DAffine3) -> &mut Row {
        let from_first = leaf.as_ptr().addr().wrapping_sub(complex.tree().order().as_ptr().addr());
        let start = from_first / size_of::<u32>();
        let key = u64::from(self.age) << u32::BITS | start as u64;
        let row = &mut self.row_of[start / STRIDE % SLOTS];
        let mut at = usize::from(*row);
        if self.key_of[at % ROWS] != key {
            *row = self.next;
            at = usize::from(self.next);
            self.next = (self.next + 1) % ROWS as u8;
            self.key_of[at % ROWS] = key;
            if at == self.rows.len() {
                self.rows.reserve_exact(ROWS - at);
                self.rows.push(Row::default());
            }
            self.rows[at].take(simd, complex, leaf, map);
        }
        &mut self.rows[at]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use rand::Rng;
    use solid_convex::simd::dispatch;
    use solid_oracle::generate::seeded;

    /// Law: a row has the leaf asked for, as it is placed now, however many were asked for and how often all was forgotten; and few are placed
    /// that were lately.
    #[test]
    fn what_is_kept_is_what_was_asked_for() {
        let mut rng = seeded(13);
        let side = 60;
        let at = |i: u32| DVec3::new(f64::from(i % side), f64::from(i / side), f64::from(i * i % 7) * 0.1);
        let indices = (0..side * (side - 1) - 1).map(|i| [i, i + 1, i + side]).collect();
        let complex = Complex::mesh((0..side * side).map(at).collect(), indices).expect("it is valid");
        let leaves: Vec<&[u32]> = complex.tree().leaves().map(|leaf| leaf.primitives).collect();
        assert!(leaves.len() > SLOTS);
        let mut rows = Rows { age: u32::MAX - 5, ..Rows::default() };
        let mut placed = 0;
        for round in 0..10 {
            let map = DAffine3::from_rotation_x(f64::from(round)) * DAffine3::from_scale(DVec3::splat(0.01));
            rows.clear();
            let mut around = 0;
            for step in 0..2000 {
                if step % 50 == 0 {
                    around = rng.random_range(0..leaves.len() - 20);
                }
                let leaf = leaves[around + rng.random_range(0..20)];
                let (mut alone, before) = (Row::default(), rows.key_of);
                let row = dispatch!(simd => {
                    alone.place(simd, &complex, leaf, &map);
                    &*rows.place(simd, &complex, leaf, &map)
                });
                assert_eq!(row.union(), alone.union());
                for (lane, &primitive) in leaf.iter().enumerate() {
                    assert_eq!((row.primitive(lane), row.triangle(lane)), (primitive, alone.triangle(lane)));
                }
                placed += usize::from(rows.key_of != before);
            }
        }
        println!("{placed} of 20000 are placed");
        assert!(rows.rows.len() == ROWS && placed < 10_000);
    }
}
