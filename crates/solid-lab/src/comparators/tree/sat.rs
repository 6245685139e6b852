use std::ops::{Add, Mul, Sub};

use solid3d::glam::{DMat3, DVec3};

/// Which axes the separating-axes test of two boxes looks at (thesis, section 5.2.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sat {
    /// All 15: those of the facets, and one for each pair of edge directions.
    Full,
    /// The six of the facets: some boxes that are apart are taken to overlap.
    Lite,
}

/// The orientation of box B in the frame of box A: `r[i][j]` is axis i of A times axis j of B.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    r: [[f64; 3]; 3],
    abs: [[f64; 3]; 3],
}

/// Added to each magnitude, so that rounding separates no boxes with nearly parallel edges: some hundred roundings of a
/// number near 1.
const PARALLEL: f64 = 1e-14;

/// What the test computes with: `f64`, or a number that counts operations.
pub trait Scalar: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + PartialOrd {
    /// The magnitude.
    fn abs(self) -> Self;
}

impl Scalar for f64 {
    fn abs(self) -> f64 {
        f64::abs(self)
    }
}

impl Orientation {
    /// From the rotation that takes B's frame to A's.
    pub fn new(b_to_a: &DMat3) -> Self {
        let r: [[f64; 3]; 3] = b_to_a.transpose().to_cols_array_2d();
        Orientation { r, abs: r.map(|row| row.map(|x| x.abs() + PARALLEL)) }
    }

    /// The axis that separates two boxes whose half sizes are `a` and `b`, the centre of B at `t` in the frame of A.
    pub fn exit_axis(&self, a: DVec3, b: DVec3, t: DVec3, sat: Sat) -> usize {
        exit_axis(&self.r, &self.abs, a.to_array(), b.to_array(), t.to_array(), sat)
    }
}

/// The axis, 1 to 15, that separates two boxes; 0 for none. In the order of RAPID: facet axes A0, B0, A1, A2, B1, B2, then A0 x B0
/// to A2 x B2. `abs` holds the magnitudes of `r`.
pub fn exit_axis<T: Scalar>(
    r: &[[T; 3]; 3],
    abs: &[[T; 3]; 3],
    a: [T; 3],
    b: [T; 3],
    t: [T; 3],
    sat: Sat,
) -> usize {
    let facet_a = |i: usize| t[i].abs() > a[i] + b[0] * abs[i][0] + b[1] * abs[i][1] + b[2] * abs[i][2];
    let facet_b = |j: usize| {
        let along = t[0] * r[0][j] + t[1] * r[1][j] + t[2] * r[2][j];
        along.abs() > b[j] + a[0] * abs[0][j] + a[1] * abs[1][j] + a[2] * abs[2][j]
    };
    if facet_a(0) {
        return 1;
    }
    if facet_b(0) {
        return 2;
    }
    if facet_a(1) {
        return 3;
    }
    if facet_a(2) {
        return 4;
    }
    if facet_b(1) {
        return 5;
    }
    if facet_b(2) {
        return 6;
    }
    if sat == Sat::Lite {
        return 0;
    }
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            let along = t[i2] * r[i1][j] - t[i1] * r[i2][j];
            let reach = a[i1] * abs[i2][j] + a[i2] * abs[i1][j] + b[j1] * abs[i][j2] + b[j2] * abs[i][j1];
            if along.abs() > reach {
                return 7 + 3 * i + j;
            }
        }
    }
    0
}
