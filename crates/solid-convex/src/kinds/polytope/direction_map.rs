//! Which points can be the furthest, by direction.

use glam::DVec3;

/// The six faces of a cube of directions, each cut into squares; for each square the points that can be the furthest along a
/// direction in it, ascending. One lookup then leaves a few points to compare, and because none that could win is left
/// out, the answer is that of comparing all of them, ties and all.
///
/// Not hill climbing along the edges of the hull from a mapped vertex: that needs the edges, stops early on the plateaus that
/// rounding makes of slivers, and each step waits for the one before.
///
/// Built by halving: what can win in a square can win in the square that it is a quarter of.
#[derive(Clone, Debug)]
pub(super) struct DirectionMap {
    /// Squares along an edge of the cube.
    side: usize,
    /// `candidates[starts[i]..starts[i + 1]]` belong to square `i`.
    starts: Vec<u32>,
    candidates: Vec<u32>,
    /// The least and the greatest magnitude that the largest coordinate of a mapped direction may have: scalar products with
    /// points do not lose digits by underflow, nor overflow.
    plain: [f64; 2],
}

/// Squares along an edge of the cube, at most: a power of two.
const SIDE_MAX: usize = 32;

/// The points are divided no finer once there are this many squares to a point, or candidates in the mean.
const SQUARES_PER_POINT_MAX: usize = 1;
const CANDIDATES_ENOUGH: usize = 6;

/// Candidates, in all, for each point, beyond which no square is divided any more: bounds the memory.
const ENTRIES_PER_POINT_MAX: usize = 32;

/// So that places in the lists are numbers of 32 bits.
const POINTS_MAX: usize = u32::MAX as usize / (2 * ENTRIES_PER_POINT_MAX);

/// Comparing this many candidates one by one takes longer than comparing all points by vector instructions, if these are
/// no more than [`SCAN_RATIO`] times as many.
const SCAN_RATIO: usize = 4;

/// The rounding of two scalar products and of the place of a direction in its square, relative to the points' reach and to the
/// largest coordinate of the direction: less than 16 roundings each of 2^-53.
const MARGIN: f64 = 64.0 / (1u64 << 53) as f64;

/// Scalar products beyond these, at the furthest point, lose no digits.
const PRODUCT_MIN: f64 = 1e-250;
const PRODUCT_MAX: f64 = 1e250;

/// A square of directions on a face of the cube.
#[derive(Clone, Copy)]
struct Square {
    face: usize,
    /// The lower corner, and the edge, in [-1, 1].
    low: [f64; 2],
    edge: f64,
}

impl DirectionMap {
    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        (self.starts.capacity() + self.candidates.capacity()) * size_of::<u32>()
    }

    /// `None` for points that all are at the origin, or that are too many.
    pub fn new(points: &[DVec3], reach: DVec3) -> Option<DirectionMap> {
        let extent = reach.max_element();
        let margin = MARGIN * reach.element_sum();
        if extent == 0.0 || points.len() > POINTS_MAX {
            return None;
        }
        let all: Vec<u32> = (0..points.len() as u32).collect();
        let mut side = 1;
        let mut lists = Lists::default();
        let mut scratch = Vec::new();
        for face in 0..6 {
            lists.push_winners(
                points,
                &all,
                Square { face, low: [-1.0; 2], edge: 2.0 },
                margin,
                &mut scratch,
            );
        }
        while side < SIDE_MAX
            && lists.len() < SQUARES_PER_POINT_MAX * points.len()
            && lists.candidates.len() > CANDIDATES_ENOUGH * lists.len()
        {
            let mut finer = Lists::default();
            let edge = 1.0 / side as f64;
            for place in 0..24 * side * side {
                let (square, parent) = Square::at(place, 2 * side, edge);
                finer.push_winners(points, lists.get(parent), square, margin, &mut scratch);
                if finer.candidates.len() > ENTRIES_PER_POINT_MAX * points.len() {
                    break;
                }
            }
            if finer.len() < 24 * side * side {
                break;
            }
            (lists, side) = (finer, 2 * side);
        }
        let plain = [(PRODUCT_MIN / extent).max(PRODUCT_MIN), PRODUCT_MAX / extent];
        let Lists { starts, candidates } = lists;
        Some(DirectionMap { side, starts, candidates, plain })
    }

    /// The index of the point furthest along a direction, the first of equals; `None` where comparing all of them is better.
    #[inline]
    pub fn furthest(&self, points: &[DVec3], direction: DVec3) -> Option<usize> {
        let (major, [s, t], face) = on_cube(direction);
        // Also for a direction that is not a number.
        if !(self.plain[0] <= major && major <= self.plain[1]) {
            return None;
        }
        let half = 0.5 * self.side as f64;
        let inverse = 1.0 / major;
        let along = |x: f64| ((x * inverse + 1.0) * half) as usize;
        let (u, v) = (along(s).min(self.side - 1), along(t).min(self.side - 1));
        let square = (face * self.side + v) * self.side + u;
        let candidates = &self.candidates[self.starts[square] as usize..self.starts[square + 1] as usize];
        if candidates.len() * SCAN_RATIO > points.len() {
            return None;
        }
        let (mut best, mut best_dot) = (0, f64::NEG_INFINITY);
        for &candidate in candidates {
            let dot = points[candidate as usize].dot(direction);
            best = if dot > best_dot { candidate } else { best };
            best_dot = if dot > best_dot { dot } else { best_dot };
        }
        Some(best as usize)
    }

    #[cfg(test)]
    pub fn entries(&self) -> usize {
        self.candidates.len()
    }

    #[cfg(test)]
    pub fn mean_length(&self) -> f64 {
        self.candidates.len() as f64 / (self.starts.len() - 1) as f64
    }
}

/// Where a direction meets the cube: its largest coordinate, in magnitude; the other two; the face.
#[inline]
fn on_cube(DVec3 { x, y, z }: DVec3) -> (f64, [f64; 2], usize) {
    let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
    let along_z = az > ax && az > ay;
    let along_y = !along_z && ay > ax;
    let axis = usize::from(along_y) + 2 * usize::from(along_z);
    let major = if along_z {
        z
    } else if along_y {
        y
    } else {
        x
    };
    let s = if along_z || along_y { x } else { y };
    let t = if along_z { y } else { z };
    (major.abs(), [s, t], 2 * axis + usize::from(major < 0.0))
}

impl Square {
    /// The square at a place in the order of the map, and the place of that which it is a quarter of.
    fn at(place: usize, side: usize, edge: f64) -> (Square, usize) {
        let (u, v, face) = (place % side, place / side % side, place / (side * side));
        let low = [u, v].map(|i| i as f64 * edge - 1.0);
        let half = side / 2;
        (Square { face, low, edge }, (face * half + v / 2) * half + u / 2)
    }

    /// The corners, as directions whose largest coordinate has magnitude 1.
    fn corners(&self) -> [DVec3; 4] {
        let Square { face, low: [s, t], edge } = *self;
        let major = if face % 2 == 0 { 1.0 } else { -1.0 };
        [[s, t], [s + edge, t], [s, t + edge], [s + edge, t + edge]].map(|[s, t]| match face / 2 {
            0 => DVec3::new(major, s, t),
            1 => DVec3::new(s, major, t),
            _ => DVec3::new(s, t, major),
        })
    }
}

/// Lists of candidates, one for each square.
struct Lists {
    starts: Vec<u32>,
    candidates: Vec<u32>,
}

impl Default for Lists {
    fn default() -> Self {
        Lists { starts: vec![0], candidates: Vec::new() }
    }
}

/// A point of a list, with how far it is along the four corners of a square.
#[derive(Clone, Copy)]
struct Height {
    point: u32,
    corners: [f64; 4],
}

impl Lists {
    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn get(&self, square: usize) -> &[u32] {
        &self.candidates[self.starts[square] as usize..self.starts[square + 1] as usize]
    }

    /// Appends those of `candidates` that can be the furthest along a direction in the square: not those that another
    /// exceeds at all four corners, and so, by linearity, everywhere between.
    fn push_winners(
        &mut self,
        points: &[DVec3],
        candidates: &[u32],
        square: Square,
        margin: f64,
        heights: &mut Vec<Height>,
    ) {
        let corners = square.corners();
        // The furthest at each corner and in the middle exceed most of the others, if anything does.
        let mut furthest = [(f64::NEG_INFINITY, [0.0; 4]); 5];
        heights.clear();
        heights.extend(candidates.iter().map(|&point| {
            let corners = corners.map(|corner| points[point as usize].dot(corner));
            let [p, q, r, s] = corners;
            for (best, height) in furthest.iter_mut().zip([p, q, r, s, p + q + r + s]) {
                if height >= best.0 {
                    *best = (height, corners);
                }
            }
            Height { point, corners }
        }));
        let exceeds = |x: &[f64; 4], y: &[f64; 4]| (0..4).fold(true, |all, k| all & (x[k] > y[k] + margin));
        heights.retain(|height| !furthest.iter().any(|(_, corners)| exceeds(corners, &height.corners)));
        self.candidates.extend(heights.iter().map(|height| height.point));
        self.starts.push(self.candidates.len() as u32);
    }
}
