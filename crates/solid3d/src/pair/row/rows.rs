//! Rows that are kept.

use fearless_simd::Simd;
use glam::DAffine3;

use super::Row;
use crate::shape::Complex;

/// How many rows are kept: as many as the innermost memory of a processor holds.
const SLOTS: usize = 32;

/// Leaves begin at least so far apart, mostly: those of one neighbourhood then have slots of their own.
const STRIDE: usize = 4;

/// The rows of one shape placed lately: where two trees meet, each leaf of one meets several of the other, soon after each other.
#[derive(Debug)]
pub(crate) struct Rows {
    /// As many as were ever needed at once; those in use stand first.
    rows: Vec<Row>,
    used: u8,
    /// By the place of a leaf: which row it has, counted from 1; 0 for none.
    row_of: [u8; SLOTS],
}

impl Default for Rows {
    fn default() -> Self {
        Rows { rows: Vec::new(), used: 0, row_of: [0; SLOTS] }
    }
}

impl Rows {
    /// The memory that they own, in bytes.
    pub fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<Row>()
    }

    /// Forgets all: before another shape is placed, or the same elsewhere.
    pub fn clear(&mut self) {
        (self.used, self.row_of) = (0, [0; SLOTS]);
    }

    /// The primitives of a leaf of a shape, placed now or before.
    #[inline(always)]
    pub fn place<S: Simd>(&mut self, simd: S, complex: &Complex, leaf: &[u32], map: &DAffine3) -> &mut Row {
        let from_first = leaf.as_ptr().addr().wrapping_sub(complex.tree().order().as_ptr().addr());
        let slot = &mut self.row_of[from_first / size_of::<u32>() / STRIDE % SLOTS];
        if *slot == 0 {
            if usize::from(self.used) == self.rows.len() {
                self.rows.reserve_exact(SLOTS - self.rows.len());
                self.rows.push(Row::default());
            }
            self.rows[usize::from(self.used)].clear();
            self.used += 1;
            *slot = self.used;
        }
        let row = &mut self.rows[usize::from(*slot) - 1];
        row.place(simd, complex, leaf, map);
        row
    }
}
