//! The search for the earliest zero over boxes of parameters.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

/// A function of a time and two more parameters, each from 0 to 1, and linear in each.
pub(super) trait Trilinear {
    /// Its value, up to a rounding error of [`EVALUATION_ERROR`].
    fn value(&self, parameters: [f64; 3]) -> DVec3;

    /// A bound on how much its coordinates change over the whole range of each parameter.
    fn change(&self) -> [f64; 3];

    /// A direction of unit length, or zero, along which zeros are easily excluded; the axes are looked at, too.
    fn normal(&self) -> DVec3;

    /// Whether a box is outside of what the parameters may be.
    fn outside(&self, least: [f64; 3]) -> bool;
}

/// A bound on the rounding error of a value, when the differences of all positions are at most 2 in magnitude: differences to the
/// origin, of the ends of the way, of two vertices, each at most 8, and three products and sums with parameters, which have no error:
/// at most 14 roundings of 2^-53 of at most 8 each.
pub(super) const EVALUATION_ERROR: f64 = 128.0 / (1u64 << 53) as f64;

/// The same of a value along a unit vector: the error of the value, times the sum of the vector's coordinates, which is below 1.8, and
/// three products and sums.
const ERROR_ALONG: f64 = 4.0 * EVALUATION_ERROR;

/// The values in a cell.
struct Values {
    min: DVec3,
    max: DVec3,
    /// Along the function's normal.
    min_along: f64,
    max_along: f64,
}

impl Values {
    /// Whether none is zero.
    fn exclude_zero(&self) -> bool {
        let error = DVec3::splat(EVALUATION_ERROR);
        self.min.cmpgt(error).any()
            || self.max.cmplt(-error).any()
            || self.min_along > ERROR_ALONG
            || self.max_along < -ERROR_ALONG
    }
}

/// A box of the parameters: its corner and sides, powers of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub least: [f64; 3],
    sides: [f64; 3],
}

/// The earliest comes first; of those the smallest, so that the search goes down before it goes on.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        let volume = |cell: &Cell| cell.sides.iter().product::<f64>();
        let earlier = other.least[0].total_cmp(&self.least[0]);
        let smaller = earlier.then_with(|| volume(other).total_cmp(&volume(self)));
        let left = |axis: usize| other.least[axis].total_cmp(&self.least[axis]);
        smaller.then_with(|| left(1)).then_with(|| left(2))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Cell {}

impl Cell {
    const WHOLE: Cell = Cell { least: [0.0; 3], sides: [1.0; 3] };

    pub fn middle(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.least[k] + 0.5 * self.sides[k])
    }

    /// The box of all values: that of the values at the corners, for the function is linear in each parameter.
    fn values(&self, function: &impl Trilinear, normal: DVec3) -> Values {
        let corner =
            |i: u32| [0, 1, 2].map(|k| self.least[k] + if i >> k & 1 == 1 { self.sides[k] } else { 0.0 });
        let mut values = Values {
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
            min_along: f64::INFINITY,
            max_along: f64::NEG_INFINITY,
        };
        for value in (0..8).map(|i| function.value(corner(i))) {
            let along = value.dot(normal);
            (values.min, values.max) = (values.min.min(value), values.max.max(value));
            values.min_along = values.min_along.min(along);
            values.max_along = values.max_along.max(along);
        }
        values
    }

    /// Cut through the middle of the side along which the function changes most.
    fn halves(&self, change: [f64; 3]) -> [Cell; 2] {
        let by = [0, 1, 2].map(|k| self.sides[k] * change[k]);
        let axis = (0..3).max_by(|&i, &j| by[i].total_cmp(&by[j])).expect("there are three");
        let mut low = *self;
        low.sides[axis] *= 0.5;
        let mut high = low;
        high.least[axis] += low.sides[axis];
        [low, high]
    }
}

/// What the search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Search {
    /// There is no zero.
    None,
    /// No zero is before this cell, in which all values are within the tolerance of zero.
    Found(Cell),
    /// No zero is before this cell; the search ended there.
    GivenUp(Cell),
}

/// The earliest box of parameters in which a function may be zero, of those that are so small that all values in it are within
/// `tolerance`.
pub(super) fn earliest(function: &impl Trilinear, tolerance: f64, boxes_max: u32) -> Search {
    let (change, normal) = (function.change(), function.normal());
    let mut cells = BinaryHeap::from([Cell::WHOLE]);
    for _ in 0..boxes_max {
        let Some(cell) = cells.pop() else { return Search::None };
        let values = cell.values(function, normal);
        if values.exclude_zero() {
            continue;
        }
        if values.min.abs().max(values.max.abs()).max_element() <= tolerance {
            return Search::Found(cell);
        }
        cells.extend(cell.halves(change).into_iter().filter(|half| !function.outside(half.least)));
    }
    cells.pop().map_or(Search::None, Search::GivenUp)
}
