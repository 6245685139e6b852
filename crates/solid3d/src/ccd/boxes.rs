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

    /// The two parameters in a cell that are told: of those that may be, near its middle.
    fn told(&self, cell: &Cell) -> [f64; 2];
}

/// A bound on the rounding error of a value, when the differences of all positions are at most 2 in magnitude: differences to the
/// origin, of the ends of the way, of two vertices, each at most 8, and three products and sums with parameters, which have no error:
/// at most 14 roundings of 2^-53 of at most 8 each.
pub(super) const EVALUATION_ERROR: f64 = 128.0 / (1u64 << 53) as f64;

/// The same of a value along a unit vector: the error of the value, times the sum of the vector's coordinates, which is below 1.8, and
/// three products and sums.
const ERROR_ALONG: f64 = 4.0 * EVALUATION_ERROR;

/// The least and the largest value along one direction, at the start and at the end of a cell's time.
#[derive(Clone, Copy)]
struct Range {
    min: [f64; 2],
    max: [f64; 2],
}

/// Less than how long it takes to reach zero, by the rounding of the quotient. That of the time made of it is within what the error
/// bounds have to spare.
const SHORTENED: f64 = 1.0 - 8.0 * f64::EPSILON;

impl Range {
    const EMPTY: Range = Range { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };

    fn take(&mut self, end: usize, value: f64) {
        self.min[end] = self.min[end].min(value);
        self.max[end] = self.max[end].max(value);
    }

    /// The part of the time before which no value is zero, but for an error; `None` when none ever is. The least of functions that are
    /// linear in time is above its chord.
    fn entry(&self, error: f64) -> Option<f64> {
        let from_above = |[start, end]: [f64; 2]| match (start > error, end > error) {
            (false, _) => Some(0.0),
            (true, true) => None,
            (true, false) => Some((start - error) / (start - end) * SHORTENED),
        };
        Some(from_above(self.min)?.max(from_above(self.max.map(|max| -max))?))
    }

    fn largest(&self) -> f64 {
        (-self.min[0].min(self.min[1])).max(self.max[0].max(self.max[1]))
    }
}

/// The values in a cell: along the axes, and along the function's normal.
struct Values([Range; 4]);

impl Values {
    /// The part of the time before which the function is not zero; `None` when it never is.
    fn entry(&self) -> Option<f64> {
        let [x, y, z, along] = &self.0;
        let axes = x.entry(EVALUATION_ERROR)?.max(y.entry(EVALUATION_ERROR)?).max(z.entry(EVALUATION_ERROR)?);
        Some(axes.max(along.entry(ERROR_ALONG)?))
    }

    /// The largest magnitude of a coordinate.
    fn largest(&self) -> f64 {
        self.0[..3].iter().map(Range::largest).fold(0.0, f64::max)
    }
}

/// A box of the parameters: its corner and sides, powers of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub least: [f64; 3],
    sides: [f64; 3],
    /// No zero in it is before this time, which lies in the box.
    pub earliest: f64,
}

/// The earliest comes first; of those the smallest, so that the search goes down before it goes on.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        let volume = |cell: &Cell| cell.sides.iter().product::<f64>();
        let earlier = other.earliest.total_cmp(&self.earliest);
        let smaller = earlier.then_with(|| volume(other).total_cmp(&volume(self)));
        let left = |axis: usize| other.least[axis].total_cmp(&self.least[axis]);
        smaller.then_with(|| left(0)).then_with(|| left(1)).then_with(|| left(2))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Cell {}

impl Cell {
    const WHOLE: Cell = Cell { least: [0.0; 3], sides: [1.0; 3], earliest: 0.0 };

    pub fn middle(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.least[k] + 0.5 * self.sides[k])
    }

    /// Whether a zero may be before its end.
    fn in_time(&self) -> bool {
        self.earliest <= self.least[0] + self.sides[0]
    }

    /// The ranges of all values: those of the values at the corners, for the function is linear in each parameter.
    fn values(&self, function: &impl Trilinear, normal: DVec3) -> Values {
        let corner =
            |i: u32| [0, 1, 2].map(|k| self.least[k] + if i >> k & 1 == 1 { self.sides[k] } else { 0.0 });
        let mut ranges = [Range::EMPTY; 4];
        for i in 0..8 {
            let value = function.value(corner(i));
            for (range, x) in ranges.iter_mut().zip([value.x, value.y, value.z, value.dot(normal)]) {
                range.take((i & 1) as usize, x);
            }
        }
        Values(ranges)
    }

    /// Cut through the middle of the side along which the function changes most.
    fn halves(&self, change: [f64; 3]) -> [Cell; 2] {
        let by = [0, 1, 2].map(|k| self.sides[k] * change[k]);
        let axis = (0..3).max_by(|&i, &j| by[i].total_cmp(&by[j])).expect("there are three");
        let mut low = *self;
        low.sides[axis] *= 0.5;
        let mut high = low;
        high.least[axis] += low.sides[axis];
        high.earliest = high.earliest.max(high.least[0]);
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
        let Some(entry) = values.entry() else { continue };
        let cell = Cell { earliest: cell.earliest.max(cell.least[0] + entry * cell.sides[0]), ..cell };
        if values.largest() <= tolerance {
            // What the search knows of the other cells may be less.
            let others = cells.peek().map_or(f64::INFINITY, |other| other.earliest);
            return Search::Found(Cell { earliest: cell.earliest.min(others), ..cell });
        }
        let halves = cell.halves(change).into_iter();
        cells.extend(halves.filter(|half| half.in_time() && !function.outside(half.least)));
    }
    cells.pop().map_or(Search::None, Search::GivenUp)
}
