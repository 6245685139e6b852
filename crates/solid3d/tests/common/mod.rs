//! What the integration tests share: random meshes, complex shapes and placements, and the oracle's view of them.
#![allow(dead_code, reason = "every test file uses a part of it")]
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests may panic and print")]

use std::collections::HashSet;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::Convex;
use solid_oracle::generate::{
    Pair, PlacementKind, Regime, random_pair, random_placement, random_shape, seeded,
};
pub use solid_oracle::generate::{direction, in_cube, log_uniform};
use solid3d::{Aabb, ComplexShapeBuilder, Shape, ShapeKind, glam, query};

/// A union of hulls of vertices, as the oracle sees it.
#[derive(Clone, Debug)]
pub struct Soup {
    pub vertices: Vec<DVec3>,
    pub primitives: Vec<Vec<u32>>,
    pub is_mesh: bool,
}

impl Soup {
    pub fn mesh(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Soup {
        Soup { vertices, primitives: triangles.into_iter().map(|t| t.to_vec()).collect(), is_mesh: true }
    }

    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.primitives.iter().map(|p| [p[0], p[1], p[2]]).collect()
    }

    pub fn shape(&self) -> Shape {
        if self.is_mesh {
            return Shape::mesh(self.vertices.clone(), self.triangles()).unwrap();
        }
        let builder = ComplexShapeBuilder::new(self.vertices.clone());
        self.primitives.iter().fold(builder, |builder, p| builder.polyhedron(p)).build().unwrap()
    }

    pub fn placed(&self, at: &DAffine3) -> Vec<DVec3> {
        self.vertices.iter().map(|&v| at.transform_point3(v)).collect()
    }

    /// The vertices of each primitive, placed.
    pub fn hulls(&self, at: &DAffine3) -> Vec<Vec<DVec3>> {
        let placed = self.placed(at);
        self.primitives.iter().map(|p| p.iter().map(|&i| placed[i as usize]).collect()).collect()
    }

    pub fn scaled(mut self, size: f64) -> Soup {
        self.vertices.iter_mut().for_each(|v| *v *= size);
        self
    }
}

/// Two placed soups near each other, and the extent of both.
pub struct Case {
    pub a: Soup,
    pub at_a: DAffine3,
    pub b: Soup,
    pub at_b: DAffine3,
    pub size: f64,
}

impl Case {
    /// B's origin is put near a vertex of A, up to `away` sizes of B off; in one case of three B is smaller or larger, by up to `ratio`.
    pub fn new(rng: &mut StdRng, a: Soup, b: Soup, away: f64, ratio: f64) -> Case {
        let size = log_uniform(rng, 1e-6, 1e6);
        let ratio = if rng.random_range(0..3) == 0 { log_uniform(rng, 1.0 / ratio, ratio) } else { 1.0 };
        let (a, b) = (a.scaled(size), b.scaled(size * ratio));
        let (at_a, mut at_b) = (placement(rng, 3.0 * size), placement(rng, size));
        let vertex = at_a.transform_point3(a.vertices[rng.random_range(0..a.vertices.len())]);
        let off = away * rng.random_range(0.0..=1.0) * size * ratio;
        at_b.translation = vertex + off * direction(rng);
        Case { size: size * (stretch(&at_a) + ratio * stretch(&at_b)), a, at_a, b, at_b }
    }
}

/// At a point, unturned.
pub fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// A placement of any kind, translated by about `size`.
pub fn placement(rng: &mut StdRng, size: f64) -> DAffine3 {
    let kind = PlacementKind::ALL[rng.random_range(0..PlacementKind::ALL.len())];
    let mut at = random_placement(rng, kind);
    at.translation *= size;
    at
}

/// A rectangle of `rows * columns` vertices, mapped; `wrapped` joins its ends in both directions.
pub fn sheet(rows: u32, columns: u32, wrapped: [bool; 2], map: impl FnMut(f64, f64) -> DVec3) -> Soup {
    let mut map = map;
    let mut vertices = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let part =
                |k: u32, of: u32, wrapped: bool| f64::from(k) / f64::from(if wrapped { of } else { of - 1 });
            vertices.push(map(part(i, rows, wrapped[0]), part(j, columns, wrapped[1])));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..(if wrapped[0] { rows } else { rows - 1 }) {
        for j in 0..(if wrapped[1] { columns } else { columns - 1 }) {
            let at = |di: u32, dj: u32| (i + di) % rows * columns + (j + dj) % columns;
            triangles.push([at(0, 0), at(1, 0), at(1, 1)]);
            triangles.push([at(0, 0), at(1, 1), at(0, 1)]);
        }
    }
    Soup::mesh(vertices, triangles)
}

/// The box between two corners, outside out.
pub fn block(min: DVec3, max: DVec3) -> Soup {
    let corner = |i: u32| DVec3::select(glam::BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), max, min);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Soup::mesh((0..8).map(corner).collect(), triangles.collect())
}

/// The same around the origin, as large in all directions.
pub fn cube(half: f64) -> Soup {
    block(DVec3::splat(-half), DVec3::splat(half))
}

pub fn torus(rows: u32, columns: u32, tube: f64) -> Soup {
    use std::f64::consts::TAU;
    sheet(rows, columns, [true, true], |u, v| {
        let radius = 1.0 + tube * (TAU * v).cos();
        DVec3::new(radius * (TAU * u).cos(), tube * (TAU * v).sin(), radius * (TAU * u).sin()) / (1.0 + tube)
    })
}

/// The topology of a sphere, around the axis y; the vertices are what `map` gives.
pub fn globe(rows: u32, columns: u32, mut map: impl FnMut(DVec3) -> DVec3) -> Soup {
    use std::f64::consts::{PI, TAU};
    let mut vertices = vec![map(DVec3::Y)];
    for i in 1..rows {
        for j in 0..columns {
            let (polar, round) =
                (PI * f64::from(i) / f64::from(rows), TAU * f64::from(j) / f64::from(columns));
            vertices.push(map(DVec3::new(polar.sin() * round.cos(), polar.cos(), polar.sin() * round.sin())));
        }
    }
    vertices.push(map(-DVec3::Y));
    let (at, last) = (|i: u32, j: u32| 1 + (i - 1) * columns + j % columns, vertices.len() as u32 - 1);
    let mut triangles = Vec::new();
    for j in 0..columns {
        triangles.push([0, at(1, j + 1), at(1, j)]);
        triangles.push([last, at(rows - 1, j), at(rows - 1, j + 1)]);
        for i in 1..rows - 1 {
            triangles.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    Soup::mesh(vertices, triangles)
}

/// The cells of a lattice that are filled, and the faces between filled and empty ones: edges of four triangles, cavities and
/// several parts included. No two triangles share the index of a vertex.
pub fn voxels(rng: &mut StdRng, side: i32) -> (HashSet<[i32; 3]>, Soup) {
    let fill = rng.random_range(0.2..0.7);
    let range = || 0..side;
    let cells = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
    let filled: HashSet<[i32; 3]> = cells.filter(|_| rng.random_bool(fill)).collect();
    let mut sorted: Vec<_> = filled.iter().copied().collect();
    sorted.sort_unstable();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for cell in sorted {
        let min = DVec3::from_array(cell.map(f64::from));
        let unit = block(min, min + 1.0);
        for face in unit.triangles().chunks(2) {
            let corners = face.as_flattened().iter().map(|&i| unit.vertices[i as usize]);
            let center = Aabb::of_points(corners.clone()).center();
            let neighbour = (min + 2.0 * (center - (min + 0.5))).to_array().map(|x| x as i32);
            if !filled.contains(&neighbour) {
                let first = vertices.len() as u32;
                triangles.extend([[first, first + 1, first + 2], [first + 3, first + 4, first + 5]]);
                vertices.extend(corners);
            }
        }
    }
    (filled, Soup::mesh(vertices, triangles))
}

/// Several meshes as one.
pub fn joined(soups: impl IntoIterator<Item = Soup>) -> Soup {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for soup in soups {
        let first = vertices.len() as u32;
        triangles.extend(soup.triangles().iter().map(|t| t.map(|i| i + first)));
        vertices.extend(soup.vertices);
    }
    Soup::mesh(vertices, triangles)
}

pub fn bumpy_sphere(rng: &mut StdRng, rows: u32, columns: u32) -> Soup {
    use std::f64::consts::{PI, TAU};
    sheet(rows, columns, [false, true], |u, v| {
        let (polar, round) = (PI * u, TAU * v);
        let radius = rng.random_range(0.7..=1.0);
        radius * DVec3::new(polar.sin() * round.cos(), polar.cos(), polar.sin() * round.sin())
    })
}

pub fn grid(rng: &mut StdRng, rows: u32, columns: u32) -> Soup {
    let bump = rng.random_range(0.0..=0.3);
    sheet(rows, columns, [false, false], |u, v| {
        DVec3::new(2.0 * u - 1.0, bump * rng.random_range(-1.0..=1.0), 2.0 * v - 1.0)
    })
}

/// Random triangles in the cube, a few of them degenerate.
pub fn triangle_soup(rng: &mut StdRng, count: u32) -> Soup {
    let size = rng.random_range(0.05..=0.5);
    let mut vertices = Vec::new();
    for _ in 0..count {
        let center = in_cube(rng);
        let corners: [DVec3; 3] = std::array::from_fn(|_| center + size * in_cube(rng));
        vertices.extend(match rng.random_range(0..12) {
            0 => [corners[0]; 3],
            1 => [corners[0], corners[1], corners[1]],
            _ => corners,
        });
    }
    Soup::mesh(vertices, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A mesh of about `count` triangles, at most about 1 from its origin.
pub fn random_mesh(rng: &mut StdRng, count: u32) -> Soup {
    let side = (f64::from(count) / 2.0).sqrt();
    let (rows, columns) = ((side as u32).max(3), (f64::from(count) / 2.0 / side).ceil().max(3.0) as u32);
    match rng.random_range(0..4) {
        0 => {
            let tube = rng.random_range(0.2..=0.8);
            torus(rows, columns, tube)
        }
        1 => bumpy_sphere(rng, rows, columns),
        2 => grid(rng, rows, columns),
        _ => triangle_soup(rng, count),
    }
}

/// Points, segments, triangles, tetrahedra, polygons and polyhedra, which share some vertices.
pub fn random_complex(rng: &mut StdRng, count: u32) -> Soup {
    let size = rng.random_range(0.1..=0.5);
    let (mut vertices, mut primitives) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let first = vertices.len() as u32;
        let center = in_cube(rng);
        let corners = match rng.random_range(0..6) {
            polygon @ 4 => {
                let (u, v) = (direction(rng), direction(rng));
                let n = polygon + rng.random_range(0..5);
                let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
                (0..n).map(|i| center + size * (angle(i).cos() * u + angle(i).sin() * v)).collect()
            }
            5 => (0..rng.random_range(5..=12)).map(|_| center + size * in_cube(rng)).collect(),
            few => (0..=few).map(|_| center + size * in_cube(rng)).collect::<Vec<_>>(),
        };
        vertices.extend(corners);
        let mut primitive: Vec<u32> = (first..vertices.len() as u32).collect();
        if rng.random_range(0..8) == 0 {
            primitive[0] = rng.random_range(0..vertices.len() as u32);
        }
        primitives.push(primitive);
    }
    Soup { vertices, primitives, is_mesh: false }
}

/// A convex shape of one of six kinds, by its number from 0 to 5, and its sizes; of a hull the radius.
pub fn convex_of_kind(rng: &mut StdRng, kind: u32, sizes: [f64; 3], radius: f64) -> Shape {
    let made = match kind {
        0 => Shape::sphere(sizes[0]),
        1 => Shape::capsule(sizes[0], sizes[1]),
        2 => Shape::cuboid(sizes),
        3 => Shape::cone(sizes[0], sizes[1]),
        4 => Shape::cylinder(sizes[0], sizes[1]),
        _ => Shape::convex_hull(&(0..20).map(|_| direction(rng) * radius).collect::<Vec<_>>()),
    };
    made.unwrap()
}

/// A small mesh or complex shape, or a convex shape, of about unit size; by the number of a case.
pub fn some_shape(rng: &mut StdRng, case: u32) -> Shape {
    match case % 4 {
        0 => random_mesh(rng, 50).shape(),
        1 => random_complex(rng, 10).shape(),
        _ => shape_of(&random_shape(rng, 1.0)),
    }
}

/// A length that bounds the extents of both shapes and the distance of their origins.
pub fn size_of(a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> f64 {
    let extent = |shape: &Shape, at: &DAffine3| {
        let here = DAffine3 { translation: DVec3::ZERO, ..*at };
        let bounds = query::bounds(shape, &here).unwrap();
        bounds.min.abs().max(bounds.max.abs()).max_element()
    };
    extent(a, pa) + extent(b, pb) + (pa.translation - pb.translation).abs().max_element()
}

/// Whether two shapes are of convex kinds.
pub fn are_convex(a: &Shape, b: &Shape) -> bool {
    [a, b].iter().all(|shape| !matches!(shape.kind(), ShapeKind::Mesh | ShapeKind::Complex))
}

/// How far two shapes, as wholes, are in each other along a normal from the second to the first.
pub fn overlap_along(normal: DVec3, a: &Shape, pa: &DAffine3, b: &Shape, pb: &DAffine3) -> f64 {
    let turn = DAffine3::from_quat(DQuat::from_rotation_arc(normal, DVec3::X));
    let bounds = |shape: &Shape, at: &DAffine3| query::bounds(shape, &(turn * *at)).unwrap();
    bounds(b, pb).max.x - bounds(a, pa).min.x
}

/// The library's shape for one of the oracle's.
pub fn shape_of(convex: &Convex) -> Shape {
    try_shape_of(convex).unwrap()
}

/// The same, a box without thickness as the hull of its corners; an error for a round shape without thickness.
pub fn try_shape_of(convex: &Convex) -> solid3d::Result<Shape> {
    match convex {
        Convex::Cuboid { half } if half.min_element() == 0.0 => {
            Shape::convex_hull(&block(*half, -*half).vertices)
        }
        Convex::Sphere { radius } => Shape::sphere(*radius),
        Convex::Cuboid { half } => Shape::cuboid(2.0 * *half),
        Convex::Cone { radius, half_height } => Shape::cone(*radius, 2.0 * half_height),
        Convex::Cylinder { radius, half_height } => Shape::cylinder(*radius, 2.0 * half_height),
        Convex::Capsule { radius, half_height } => Shape::capsule(*radius, 2.0 * half_height),
        Convex::Hull { points } => Shape::convex_hull(points),
    }
}

/// Random pairs of a regime, each with its number, as ours, and in words; without those that have a round shape without thickness.
pub fn each_pair(
    regime: Regime,
    seed: u64,
    count: usize,
    mut judge: impl FnMut(usize, &Pair, [&Shape; 2], &str),
) {
    let mut rng = seeded(seed);
    for i in 0..count {
        let pair = random_pair(&mut rng, regime);
        let (Ok(a), Ok(b)) = (try_shape_of(&pair.a), try_shape_of(&pair.b)) else { continue };
        let context = format!("{regime:?}, seed {seed}, pair {i} ({} and {})", a.kind(), b.kind());
        judge(i, &pair, [&a, &b], &context);
    }
}

/// Both factors of a placement times a power of two: the world in another unit of length.
pub fn rescaled(at: &DAffine3, factor: f64) -> DAffine3 {
    DAffine3 { matrix3: at.matrix3 * factor, translation: at.translation * factor }
}

/// How long an axis of a placement is at most.
pub fn stretch(at: &DAffine3) -> f64 {
    let DMat3 { x_axis, y_axis, z_axis } = at.matrix3;
    (x_axis.length_squared() + y_axis.length_squared() + z_axis.length_squared()).sqrt()
}

pub fn assert_rate(what: &str, hits: usize, cases: usize) {
    let rate = hits as f64 / cases as f64;
    println!("{what}: {hits} of {cases} hit");
    assert!((0.3..=0.7).contains(&rate), "{what}: a hit rate of {rate} tests little");
}
