//! The primitives of a leaf in the common frame of a pair, as structure of arrays: eight triangles at a time.
//!
//! | file | holds |
//! |---|---|
//! | `verdict` | the lanes that meet a triangle, and that do not, certainly |
//! | `rows` | the rows placed lately |
//! | `distance` | the distances of a triangle, a segment or a point, and eight, each with a lower bound |
//! | `depth` | how deep a triangle and eight are in each other, each with a lower bound |
//! | `unit_box` | the lanes that meet a box, and that do not, certainly |
//! | `vector` | points in vectors as wide as the level has |

mod depth;
mod distance;
mod rows;
mod unit_box;
mod vector;
mod verdict;

use fearless_simd::Simd;
use fearless_simd::prelude::*;
use glam::{DAffine3, DVec3};
use solid_convex::simd::each;

pub(super) use depth::{CROSS_ERROR, PARALLEL_SINE, SQUARED_MIN, depths};
pub(super) use distance::{CONFIRMED, Near, distances, distances_of_core};
pub(crate) use rows::Rows;
pub(super) use unit_box::{Cube, stretch_max};
use vector::{Vector, Wide, dot, load, one, splat, steps, store};
pub(super) use verdict::{Verdict, verdict};

use super::triangle_triangle::Triangle;
use crate::bounds::Aabb;
use crate::shape::Complex;
use crate::tree::{LEAF_SIZE, bits};

/// A coordinate of eight points.
pub(super) type Lanes = [f64; LEAF_SIZE];

/// Up to eight primitives. Lanes beyond them repeat the first.
#[derive(Clone, Debug)]
#[repr(C, align(64))] // no vector is in two lines of a cache
pub(crate) struct Row {
    /// By corner and axis. A point or a segment repeats its last corner; a primitive of more vertices has none that mean
    /// anything.
    corners: [[Lanes; 3]; 3],
    /// The boxes of the primitives.
    min: [Lanes; 3],
    max: [Lanes; 3],
    /// The box around them all.
    union: Aabb,
    /// The layer in which they lie, if it is measured: a direction across them, zero if not all are triangles, and their least and greatest
    /// heights along it, widened by [`HEIGHT_ERROR`].
    across: DVec3,
    heights: [f64; 2],
    is_measured: bool,
    primitives: [u32; LEAF_SIZE],
    /// The lanes in use, and those of them that are triangles, as bits.
    used: u32,
    triangles: u32,
    /// The leaf that is here: where it begins in memory, and how long it is.
    leaf: (usize, usize),
}

impl Default for Row {
    fn default() -> Self {
        Row {
            corners: Default::default(),
            min: Default::default(),
            max: Default::default(),
            union: Aabb::EMPTY,
            across: DVec3::ZERO,
            heights: [0.0; 2],
            is_measured: false,
            primitives: [0; LEAF_SIZE],
            used: 0,
            triangles: 0,
            leaf: (0, 0),
        }
    }
}

impl Row {
    /// Forgets what is here: before another shape is placed.
    pub fn clear(&mut self) {
        self.leaf = (0, 0);
    }

    /// Takes in the primitives of a leaf. The same leaf twice, with the same map, costs nothing the second time.
    #[inline(always)]
    pub fn place<S: Simd>(&mut self, simd: S, complex: &Complex, leaf: &[u32], map: &DAffine3) {
        let key = (leaf.as_ptr().addr(), leaf.len());
        if key == self.leaf {
            return;
        }
        self.leaf = key;
        self.take(simd, complex, leaf, map);
    }

    /// The same, without a look at what is here.
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, complex: &Complex, leaf: &[u32], map: &DAffine3) {
        self.used = (1 << leaf.len()) - 1;
        for (lane, primitive) in self.primitives.iter_mut().enumerate() {
            *primitive = leaf[if lane < leaf.len() { lane } else { 0 }];
        }
        match complex.triangles() {
            Some(triangles) => {
                self.triangles = self.used;
                let mut corners = [[0; 3]; LEAF_SIZE];
                for (corners, &primitive) in corners.iter_mut().zip(&self.primitives) {
                    *corners = triangles[primitive as usize];
                }
                self.place_triangles(simd, complex.vertices(), &corners, map);
            }
            None => self.place_mixed(simd, complex, map),
        }
        self.union = self.union_of_lanes(simd);
        self.is_measured = false;
    }

    #[inline(never)] // see `distances`
    fn place_triangles<S: Simd>(
        &mut self,
        simd: S,
        vertices: &[DVec3],
        indices: &[[u32; 3]; LEAF_SIZE],
        map: &DAffine3,
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.place_triangles_on(simd, vertices, indices, map),
        );
    }

    #[inline(always)]
    fn place_triangles_on<S: Simd>(
        &mut self,
        simd: S,
        vertices: &[DVec3],
        indices: &[[u32; 3]; LEAF_SIZE],
        map: &DAffine3,
    ) {
        let rows = map.matrix3.transpose().to_cols_array_2d();
        for corner in 0..3 {
            let mut local = [[0.0; LEAF_SIZE]; 3];
            for lane in 0..LEAF_SIZE {
                let point = vertices[indices[lane][corner] as usize];
                [local[0][lane], local[1][lane], local[2][lane]] = point.to_array();
            }
            for from in steps::<S>() {
                let x = load(simd, &local[0], from);
                let y = load(simd, &local[1], from);
                let z = load(simd, &local[2], from);
                for (axis, &[a, b, c]) in rows.iter().enumerate() {
                    // In the order of `DAffine3::transform_point3`, so that its bits come out.
                    let linear = one(simd, a) * x + one(simd, b) * y + one(simd, c) * z;
                    let placed = linear + one(simd, map.translation[axis]);
                    store(simd, placed, &mut self.corners[corner][axis], from);
                }
            }
        }
        for axis in 0..3 {
            for from in steps::<S>() {
                let p = load(simd, &self.corners[0][axis], from);
                let q = load(simd, &self.corners[1][axis], from);
                let r = load(simd, &self.corners[2][axis], from);
                store(simd, p.min(q).min(r), &mut self.min[axis], from);
                store(simd, p.max(q).max(r), &mut self.max[axis], from);
            }
        }
    }

    /// Primitives of any number of vertices.
    fn place_mixed<S: Simd>(&mut self, simd: S, complex: &Complex, map: &DAffine3) {
        let corners = each(self.primitives, |primitive| match *complex.primitive(primitive) {
            [i, j, k] => [i, j, k],
            [i, j] => [i, j, j],
            ref indices => [indices[0]; 3],
        });
        self.place_triangles(simd, complex.vertices(), &corners, map);
        self.triangles = 0;
        for lane in 0..LEAF_SIZE {
            let indices = complex.primitive(self.primitives[lane]);
            if indices.len() <= 3 {
                self.triangles |= self.used & 1 << lane;
                continue;
            }
            let vertex = |&index: &u32| map.transform_point3(complex.vertices()[index as usize]);
            let bounds = Aabb::of_points(indices.iter().map(vertex));
            for axis in 0..3 {
                self.min[axis][lane] = bounds.min[axis];
                self.max[axis][lane] = bounds.max[axis];
            }
        }
    }

    /// The number of the primitive in a lane.
    pub fn primitive(&self, lane: usize) -> u32 {
        self.primitives[lane]
    }

    /// The lanes that hold triangles, degenerate ones too, as bits.
    pub fn triangles(&self) -> u32 {
        self.triangles
    }

    /// The corners of the triangle in a lane.
    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> Triangle {
        let [p, q, r] = &self.corners;
        [at(p, lane), at(q, lane), at(r, lane)]
    }

    /// The box in a lane.
    #[inline(always)]
    pub fn bounds(&self, lane: usize) -> Aabb {
        Aabb::new(at(&self.min, lane), at(&self.max, lane))
    }

    /// The box around all lanes.
    #[inline(always)]
    pub fn union(&self) -> &Aabb {
        &self.union
    }

    #[inline(always)]
    fn union_of_lanes<S: Simd>(&self, simd: S) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for axis in 0..3 {
            let mut least = load(simd, &self.min[axis], 0);
            let mut greatest = load(simd, &self.max[axis], 0);
            for from in steps::<S>().skip(1) {
                least = least.min(load(simd, &self.min[axis], from));
                greatest = greatest.max(load(simd, &self.max[axis], from));
            }
            bounds.min[axis] = least.reduce_min();
            bounds.max[axis] = greatest.reduce_max();
        }
        bounds
    }

    /// Finds the layer in which the triangles lie, if that is not yet known: before [`level_with`](Row::level_with).
    #[inline(always)]
    pub fn measure<S: Simd>(&mut self, simd: S) {
        if self.is_measured {
            return;
        }
        self.is_measured = true;
        self.across = DVec3::ZERO;
        if self.triangles == self.used {
            // Of a smooth surface two normals are nearly the mean of all.
            for lane in [0, self.used.count_ones() as usize / 2] {
                let [p, q, r] = self.triangle(lane);
                self.across += (q - p).cross(r - p);
            }
        }
        let along = splat(simd, self.across);
        let mut least = one(simd, f64::INFINITY);
        let mut greatest = one(simd, f64::NEG_INFINITY);
        for from in steps::<S>() {
            let [low, high] = self.heights(simd, along, from);
            least = least.min(low);
            greatest = greatest.max(high);
        }
        let error = HEIGHT_ERROR * self.across.abs().element_sum() + f64::MIN_POSITIVE;
        self.heights = [least.reduce_min() - error, greatest.reduce_max() + error];
    }

    /// The least and the greatest of the corners of some triangles along a direction.
    #[inline(always)]
    fn heights<S: Simd>(&self, simd: S, along: Vector<S>, from: usize) -> [Wide<S>; 2] {
        let [p, q, r] = self.corners(simd, from);
        let (p, q, r) = (dot(p, along), dot(q, along), dot(r, along));
        [p.min(q).min(r), p.max(q).max(r)]
    }

    /// The lanes in use but for the triangles that are certainly above or below the layer of others, which is measured; as bits.
    #[inline(always)]
    pub fn level_with<S: Simd>(&self, simd: S, others: &Row) -> u32 {
        let along = splat(simd, others.across);
        let mut lanes = 0;
        for from in steps::<S>() {
            let [least, greatest] = self.heights(simd, along, from);
            let on =
                least.simd_le(one(simd, others.heights[1])) & greatest.simd_ge(one(simd, others.heights[0]));
            lanes |= (on.to_bitmask() as u32) << from;
        }
        (lanes | !self.triangles) & self.used
    }

    /// The lanes in use whose box overlaps another, as bits: exactly.
    #[inline(always)]
    pub fn overlapping<S: Simd>(&self, simd: S, other: &Aabb) -> u32 {
        let mut lanes = 0;
        for from in steps::<S>() {
            let mut on = S::mask64s::splat(simd, true);
            for axis in 0..3 {
                on = on
                    & load(simd, &self.min[axis], from).simd_le(one(simd, other.max[axis]))
                    & load(simd, &self.max[axis], from).simd_ge(one(simd, other.min[axis]));
            }
            lanes |= (on.to_bitmask() as u32) << from;
        }
        lanes & self.used
    }

    /// The lanes in use whose box is nearer to another than the square root of `limit_squared`, as bits.
    #[inline(always)]
    pub fn nearer<S: Simd>(&self, simd: S, other: &Aabb, limit_squared: f64) -> u32 {
        let mut lanes = 0;
        for from in steps::<S>() {
            let mut squared = one(simd, 0.0);
            for axis in 0..3 {
                let below = load(simd, &self.min[axis], from) - one(simd, other.max[axis]);
                let above = one(simd, other.min[axis]) - load(simd, &self.max[axis], from);
                let gap = below.max(above).max(one(simd, 0.0));
                squared += gap * gap;
            }
            let near = squared.simd_lt(one(simd, limit_squared));
            lanes |= (near.to_bitmask() as u32) << from;
        }
        lanes & self.used
    }

    /// The least coordinates along an axis, or a bound below.
    #[inline(always)]
    pub fn least_along<S: Simd>(&self, simd: S, axis: DVec3) -> Lanes {
        let mut least = [0.0; LEAF_SIZE];
        for from in steps::<S>() {
            let [p, q, r] = self.corners(simd, from);
            let along = splat(simd, axis);
            let (p, q, r) = (dot(p, along), dot(q, along), dot(r, along));
            store(simd, p.min(q).min(r), &mut least, from);
        }
        for lane in bits(self.used & !self.triangles) {
            let bounds = self.bounds(lane);
            least[lane] = bounds.center().dot(axis) - bounds.half_extents().dot(axis.abs());
        }
        least
    }

    /// The corners of some triangles.
    #[inline(always)]
    fn corners<S: Simd>(&self, simd: S, from: usize) -> [Vector<S>; 3] {
        [self.corner(simd, 0, from), self.corner(simd, 1, from), self.corner(simd, 2, from)]
    }

    #[inline(always)]
    fn corner<S: Simd>(&self, simd: S, corner: usize, from: usize) -> Vector<S> {
        let [x, y, z] = &self.corners[corner];
        Vector([load(simd, x, from), load(simd, y, from), load(simd, z, from)])
    }
}

/// The error of the difference of two heights along a direction, relative to the sum of its coordinates. Points of the common frame have
/// coordinates below 2, and a product takes part in three roundings by 2^-53: each height is off by 3 epsilons, and a widened one is
/// rounded once more, by one.
const HEIGHT_ERROR: f64 = 8.0 * f64::EPSILON;

/// The point in a lane.
#[inline(always)]
fn at([x, y, z]: &[Lanes; 3], lane: usize) -> DVec3 {
    DVec3::new(x[lane], y[lane], z[lane])
}

/// The lanes that are at least a limit, as bits.
#[inline(always)]
pub(super) fn exceed<S: Simd>(simd: S, lanes: &Lanes, limit: f64) -> u32 {
    let mut bits = 0;
    for from in steps::<S>() {
        let exceed = load(simd, lanes, from).simd_ge(one(simd, limit));
        bits |= (exceed.to_bitmask() as u32) << from;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ComplexShapeBuilder;
    use crate::shape::Class;
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_convex::simd::{alike, dispatch};
    use solid_oracle::generate::seeded;

    fn point(rng: &mut StdRng) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
    }

    /// Eight triangles as a leaf.
    pub fn row_of(triangles: &[Triangle; 8]) -> Row {
        let vertices = triangles.as_flattened().to_vec();
        let indices: Vec<[u32; 3]> = (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let complex = Complex::mesh(vertices, indices).unwrap();
        let mut row = Row::default();
        let leaf = [0, 1, 2, 3, 4, 5, 6, 7];
        dispatch!(simd => row.place(simd, &complex, &leaf, &DAffine3::IDENTITY));
        row
    }

    /// Law: what is not level with the layer of others meets none of them; many are told, every level of instructions says the same, and
    /// what touches the layer is kept.
    #[test]
    fn what_is_not_level_meets_nothing() {
        let mut rng = seeded(61);
        let (mut told, mut lanes, mut meet) = (0, 0, 0);
        for round in 0..3000 {
            // Two patches, flat but for a thickness.
            let thickness = [0.0, 1e-12, 0.1][round % 3];
            let mut patch = |normal: DVec3, offset: DVec3| -> [Triangle; 8] {
                std::array::from_fn(|_| {
                    [(); 3].map(|()| {
                        let p = point(&mut rng);
                        offset + p - normal * p.dot(normal) * (1.0 - thickness)
                    })
                })
            };
            let of_a = patch(DVec3::Z, DVec3::ZERO);
            let mut of_b = patch(DVec3::X, DVec3::new(0.2, 0.0, 0.8));
            of_b[0] = [DVec3::ZERO, DVec3::new(0.1, 0.3, 0.5), DVec3::Z]; // stands on the layer
            let [level_a, level_b] = alike(|level| {
                let (mut a, mut b) = (row_of(&of_a), row_of(&of_b));
                dispatch!(widest level, simd => {
                    a.measure(simd);
                    b.measure(simd);
                    [a.level_with(simd, &b), b.level_with(simd, &a)]
                })
            });
            assert!(thickness > 0.0 || level_b & 1 == 1);
            for (i, x) in of_a.iter().enumerate() {
                for (j, y) in of_b.iter().enumerate() {
                    let is_told = level_a >> i & 1 == 0 || level_b >> j & 1 == 0;
                    let meets = super::super::triangle_triangle::intersect(x, y);
                    assert!(!(is_told && meets), "{x:?} {y:?}");
                    told += usize::from(is_told);
                    meet += usize::from(meets);
                    lanes += 1;
                }
            }
        }
        println!("of {lanes} pairs {told} are told apart, {meet} meet");
        assert!((3 * lanes / 10..7 * lanes / 10).contains(&told) && 100 * meet > lanes);
    }

    /// Corners, boxes and the lanes that are near: as each primitive placed by itself.
    #[test]
    fn a_row_is_its_primitives_one_by_one() {
        let seed = 60;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut overlaps, mut lanes) = (0, 0);
        for round in 0..600 {
            let vertices: Vec<DVec3> = (0..12).map(|_| point(&mut rng)).collect();
            let mut builder = ComplexShapeBuilder::new(vertices.clone());
            let count = rng.random_range(1..=8);
            let primitives: Vec<Vec<u32>> = (0..count)
                .map(|_| (0..rng.random_range(1..=5)).map(|_| rng.random_range(0..12)).collect())
                .collect();
            for primitive in &primitives {
                builder = builder.polyhedron(primitive);
            }
            let shape = builder.build().unwrap();
            let Class::Complex(complex) = shape.class() else { unreachable!() };
            let map = DAffine3::from_cols(point(&mut rng), point(&mut rng), point(&mut rng), point(&mut rng));
            let placed = |i: usize| primitives[i].iter().map(|&v| map.transform_point3(vertices[v as usize]));
            let leaf: Vec<u32> = (0..count as u32).collect();
            let center = 0.5 * point(&mut rng);
            let query = Aabb::new(center - 0.6, center + 0.6);
            let axis = point(&mut rng);
            let mut row = Row::default();
            let (overlapping, nearer, least, _) = alike(|level| {
                row.clear();
                dispatch!(widest level, simd => {
                    row.place(simd, complex, &leaf, &map);
                    let least = row.least_along(simd, axis);
                    (row.overlapping(simd, &query), row.nearer(simd, &query, 0.01), least, [row.min, row.max])
                })
            });
            for i in 0..count {
                let bounds = Aabb::of_points(placed(i));
                assert_eq!(row.bounds(i), bounds, "round {round}");
                assert_eq!(row.primitive(i), i as u32);
                assert_eq!(overlapping >> i & 1 == 1, bounds.overlaps(&query));
                assert_eq!(nearer >> i & 1 == 1, bounds.gap(&query).length_squared() < 0.01);
                let exact = placed(i).map(|p| p.dot(axis)).fold(f64::INFINITY, f64::min);
                let is_triangle = primitives[i].len() <= 3;
                assert_eq!(row.triangles() >> i & 1 == 1, is_triangle);
                if is_triangle {
                    assert_eq!(least[i], exact);
                    let corners: Vec<DVec3> = placed(i).collect();
                    assert!(row.triangle(i).iter().all(|corner| corners.contains(corner)));
                } else {
                    assert!(least[i] <= exact + 1e-15);
                }
                overlaps += u32::from(bounds.overlaps(&query));
                lanes += 1;
            }
            assert_eq!((overlapping | nearer) >> count, 0, "unused lanes");
        }
        println!("{overlaps} of {lanes} overlap");
        assert!(10 * overlaps > 3 * lanes && 10 * overlaps < 7 * lanes);
    }
}
