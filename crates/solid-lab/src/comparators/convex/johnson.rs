use solid3d::glam::DVec3;

use super::SupportPoint;

/// Johnson's sub-algorithm: the point of a simplex closest to the origin by Cramer's rule, with what it computed kept from one
/// iteration to the next (thesis, sections 4.4.1 and 4.4.3).
///
/// Points live in four slots; a set of points is the number whose bits name its slots.
#[derive(Clone, Debug, Default)]
pub struct Johnson {
    y: [SupportPoint; 4],
    /// W: the simplex.
    bits: usize,
    /// W with the newest point, and the slot of that.
    all: usize,
    last: usize,
    /// `dot[i][j]` is the dot product of points i and j.
    dot: [[f64; 4]; 4],
    /// `det[x][i]` is the thesis's Delta_i(X).
    det: [[f64; 4]; 16],
}

/// All four slots taken.
const FULL: usize = 0b1111;

impl Johnson {
    /// Whether the simplex is a tetrahedron: then it contains the origin.
    pub fn is_full(&self) -> bool {
        self.bits == FULL
    }

    /// Whether `w` is among the points of the simplex or those it had before its last reduction.
    pub fn contains(&self, w: DVec3) -> bool {
        members(self.all).any(|i| self.y[i].w == w)
    }

    /// The greatest squared length of a point of the simplex: its size, to compare with.
    pub fn length_squared_max(&self) -> f64 {
        members(self.bits).map(|i| self.dot[i][i]).fold(0.0, f64::max)
    }

    /// Adds a point.
    ///
    /// # Panics
    /// When the simplex is full.
    pub fn push(&mut self, point: SupportPoint) {
        self.last = (!self.bits).trailing_zeros() as usize;
        assert!(self.last < 4, "a full simplex contains the origin");
        self.all = self.bits | 1 << self.last;
        self.y[self.last] = point;
        for i in members(self.all) {
            let product = self.y[i].w.dot(point.w);
            self.dot[i][self.last] = product;
            self.dot[self.last][i] = product;
        }
        for x in self.subsets_with_last() {
            self.compute(x);
        }
    }

    /// Reduces to the smallest subset whose hull has the point closest to the origin, and returns that. Only subsets with the
    /// newest point are looked at (Theorem 4.8). `None`, and nothing changes, when rounding leaves no subset.
    pub fn reduce(&mut self) -> Option<DVec3> {
        let x = self.subsets_with_last().find(|&x| self.is_closest(x))?;
        self.bits = x;
        Some(self.point(x))
    }

    /// The same over all subsets, and where none is right, the nearest of those whose weights are positive: the backup
    /// procedure of the original.
    pub fn reduce_with_backup(&mut self) -> DVec3 {
        let subsets = || (1..=self.all).filter(|x| x & !self.all == 0);
        let exact = subsets().find(|&x| self.is_closest(x));
        let positive = |&x: &usize| members(x).all(|i| self.det[x][i] > 0.0);
        let nearest = || {
            subsets()
                .filter(positive)
                .min_by(|&x, &y| self.point(x).length_squared().total_cmp(&self.point(y).length_squared()))
                .expect("the weight of a single point is one")
        };
        self.bits = exact.unwrap_or_else(nearest);
        self.point(self.bits)
    }

    /// The points of A and of B whose difference is the closest point.
    pub fn witness(&self) -> [DVec3; 2] {
        let sum: f64 = members(self.bits).map(|i| self.det[self.bits][i]).sum();
        let weighted = |of: fn(&SupportPoint) -> DVec3| {
            members(self.bits).map(|i| of(&self.y[i]) * (self.det[self.bits][i] / sum)).sum()
        };
        [weighted(|y| y.p), weighted(|y| y.q)]
    }

    fn subsets_with_last(&self) -> impl Iterator<Item = usize> + use<> {
        let (all, last) = (self.all, 1 << self.last);
        (last..=all).filter(move |x| x & !all == 0 && x & last != 0)
    }

    /// Delta_i(X) for all i of X, from those of the subsets with one point less.
    fn compute(&mut self, x: usize) {
        for j in members(x) {
            let rest = x & !(1 << j);
            self.det[x][j] = if rest == 0 {
                1.0
            } else {
                let k = rest.trailing_zeros() as usize;
                members(rest).map(|i| self.det[rest][i] * (self.dot[i][k] - self.dot[i][j])).sum()
            };
        }
    }

    /// The two conditions of section 4.4.1: positive weights within, none outside.
    fn is_closest(&self, x: usize) -> bool {
        members(self.all).all(|i| {
            let bit = 1 << i;
            if x & bit != 0 { self.det[x][i] > 0.0 } else { self.det[x | bit][i] <= 0.0 }
        })
    }

    fn point(&self, x: usize) -> DVec3 {
        let sum: f64 = members(x).map(|i| self.det[x][i]).sum();
        members(x).map(|i| self.y[i].w * self.det[x][i]).sum::<DVec3>() / sum
    }
}

fn members(x: usize) -> impl Iterator<Item = usize> {
    (0..4).filter(move |i| x & (1 << i) != 0)
}
