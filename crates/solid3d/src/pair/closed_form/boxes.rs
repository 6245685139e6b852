//! Two boxes, by the fifteen axes of the separating-axis theorem (Gottschalk, Lin and Manocha, *OBBTree*, 1996, section 5).

use glam::DVec3;
use solid_convex::simd::each;

use super::GAP_MIN;
use super::similarity::Similarity;

/// A box, in the space of the pair.
pub(super) struct PlacedBox {
    /// Half its size, in its own space.
    pub half: DVec3,
    pub at: Similarity,
    pub center: DVec3,
}

/// What the fifteen axes say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Separation {
    /// The boxes are apart along this unit vector, from `B` to `A`.
    Along(DVec3),
    /// They overlap along all.
    No,
    /// Too close to tell.
    Unknown,
}

impl Separation {
    pub fn intersects(self) -> Option<bool> {
        match self {
            Separation::Along(_) => Some(false),
            Separation::No => Some(true),
            Separation::Unknown => None,
        }
    }
}

/// Two edges whose cosine, squared, is more than this are taken for parallel: they are within 10^-6 of it.
const PARALLEL_COSINE_SQUARED: f64 = 1.0 - 1e-12;

/// An overlap along the product of two unit edges, or along a face's normal, that leaves no doubt about any axis: were the
/// edges that are nearly parallel made so, nothing would move by a tenth of it.
const OVERLAP_MIN: f64 = 1e-4;

/// Tries the axes in order: the faces of `A`, those of `B`, the products of their edges.
pub(super) fn separation(a: &PlacedBox, b: &PlacedBox) -> Separation {
    let (u, w) = (a.at.units(), b.at.units());
    let (half_a, half_b) = ((a.half * a.at.stretch).to_array(), (b.half * b.at.stretch).to_array());
    let from_b = a.center - b.center;
    let cosines = each(u, |u| each(w, |w| u.dot(w)));
    let magnitudes = each(cosines, |row| each(row, f64::abs));
    let (along_u, along_w) = (each(u, |u| u.dot(from_b)), each(w, |w| w.dot(from_b)));
    let mut least = f64::INFINITY;
    for i in 0..3 {
        let reach = half_a[i] + dot(magnitudes[i], half_b);
        let overlap = reach - along_u[i].abs();
        if overlap < -GAP_MIN {
            return Separation::Along(u[i] * along_u[i].signum());
        }
        least = least.min(overlap);
    }
    for j in 0..3 {
        let reach = half_b[j] + dot(each(magnitudes, |row| row[j]), half_a);
        let overlap = reach - along_w[j].abs();
        if overlap < -GAP_MIN {
            return Separation::Along(w[j] * along_w[j].signum());
        }
        least = least.min(overlap);
    }
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            // Along u[i] x w[j], whose scalar products with the axes of A are, up to sign, the cosines of the other two.
            let reach = half_a[i1] * magnitudes[i2][j]
                + half_a[i2] * magnitudes[i1][j]
                + half_b[j1] * magnitudes[i][j2]
                + half_b[j2] * magnitudes[i][j1];
            let apart = along_u[i2] * cosines[i1][j] - along_u[i1] * cosines[i2][j];
            let overlap = reach - apart.abs();
            let parallel = cosines[i][j] * cosines[i][j] > PARALLEL_COSINE_SQUARED;
            if overlap < -GAP_MIN && !parallel {
                let axis = u[i].cross(w[j]);
                return Separation::Along((axis * axis.dot(from_b).signum()).normalize());
            }
            least = if parallel { least } else { least.min(overlap) };
        }
    }
    if least > OVERLAP_MIN { Separation::No } else { Separation::Unknown }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
