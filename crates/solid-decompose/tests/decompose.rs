//! Decompositions of an L, a torus, a star, convex bodies, and whatever bad meshes there are: what they cover, and what they don't.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking and says what it did"
)]

use rand::Rng;
use rand::rngs::StdRng;
use solid_decompose::{Decomposition, Error, Options, PIECES_MAX, decompose};
use solid_oracle::generate::seeded;
use solid_oracle::known_answers;
use solid_scene::{LoadOptions, Scene};
use solid3d::glam::{DAffine3, DVec3};
use solid3d::query::{self, ContactOptions};
use solid3d::{ComplexShapeBuilder, Shape, ShapeKind};

const SEED: u64 = 20_264;
const HERE: DAffine3 = DAffine3::IDENTITY;

/// A prism over a chain of corners around the origin or a corner that sees all, from z = 0 to 1.
fn prism(outline: &[(f64, f64)], caps: &[[u32; 3]]) -> Shape {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |&(x, y)| DVec3::new(x, y, z));
    let vertices: Vec<DVec3> = at(0.0).chain(at(1.0)).collect();
    let mut triangles: Vec<[u32; 3]> =
        caps.iter().flat_map(|&[i, j, k]| [[i, k, j], [i + n, j + n, k + n]]).collect();
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, j, j + n], [i, j + n, i + n]]);
    }
    Shape::mesh(vertices, triangles).unwrap()
}

fn l_shape() -> Shape {
    let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
    prism(&outline, &[[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]])
}

/// Five spikes.
fn star() -> Shape {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / 10.0;
    let radius = |i: u32| if i.is_multiple_of(2) { 2.0 } else { 0.8 };
    let outline: Vec<_> = (0..10).map(|i| (radius(i) * angle(i).cos(), radius(i) * angle(i).sin())).collect();
    let mut caps: Vec<[u32; 3]> = (0..5).map(|i| [2 * i + 1, (2 * i + 2) % 10, (2 * i + 3) % 10]).collect();
    caps.extend([[1, 3, 5], [1, 5, 7], [1, 7, 9]]);
    prism(&outline, &caps)
}

/// A surface over two angles; `wrapped` closes it in the first, too.
fn turned(rows: u32, columns: u32, wrapped: bool, map: impl Fn(f64, f64) -> DVec3) -> Shape {
    use std::f64::consts::TAU;
    let of = |i: u32| f64::from(i) / f64::from(if wrapped { rows } else { rows - 1 });
    let vertices: Vec<DVec3> = (0..rows * columns)
        .map(|i| map(of(i / columns), TAU * f64::from(i % columns) / f64::from(columns)))
        .collect();
    let mut triangles = Vec::new();
    for i in 0..if wrapped { rows } else { rows - 1 } {
        for j in 0..columns {
            let at = |di: u32, dj: u32| (i + di) % rows * columns + (j + dj) % columns;
            triangles.extend([[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]);
        }
    }
    Shape::mesh(vertices, triangles).unwrap()
}

fn torus() -> Shape {
    turned(32, 16, true, |u, v| {
        let (around, radius) = (std::f64::consts::TAU * u, 1.0 + 0.4 * v.cos());
        DVec3::new(radius * around.cos(), 0.4 * v.sin(), radius * around.sin())
    })
}

fn ball() -> Shape {
    turned(13, 24, false, |u, v| {
        // The ends are just at the poles, so that the mesh is closed.
        let radius = if u == 0.0 || u == 1.0 { 0.0 } else { (std::f64::consts::PI * u).sin() };
        DVec3::new(radius * v.cos(), (std::f64::consts::PI * u).cos(), radius * v.sin())
    })
}

/// The size of a mesh.
fn size(mesh: &Shape) -> f64 {
    query::bounds(mesh, &HERE).unwrap().half_extents().max_element()
}

/// What the whole is made of, and that it covers the surface.
fn assert_covers_surface(mesh: &Shape, parts: &Decomposition, rng: &mut StdRng, what: &str) {
    let are_triangles = parts.pieces.iter().all(|piece| piece.vertices().unwrap().len() == 3);
    let kind = if are_triangles { ShapeKind::Mesh } else { ShapeKind::Complex };
    assert_eq!(parts.shape.kind(), kind, "{what}");
    assert_eq!(parts.shape.primitive_count(), parts.pieces.len(), "{what}");
    assert!(parts.pieces.iter().all(|piece| piece.kind() == ShapeKind::ConvexHull), "{what}");
    let (vertices, triangles) = (mesh.vertices().unwrap(), mesh.triangles().unwrap());
    let distance = |p: DVec3| query::closest_point(&parts.shape, &HERE, p).unwrap().distance;
    let reach = vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let error = 1e-11 * (size(mesh) + reach);
    let some = |count: usize| (count / 500).max(1);
    for &i in triangles.as_flattened().iter().step_by(some(3 * triangles.len())) {
        let d = distance(vertices[i as usize]);
        assert!(d <= error, "{what}: vertex {i} is {d:e} off all pieces");
    }
    for triangle in triangles.iter().step_by(some(triangles.len())) {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        let p = a.lerp(b, rng.random_range(0.0..1.0)).lerp(c, rng.random_range(0.0..1.0));
        assert!(distance(p) <= error, "{what}: a point of {triangle:?} is {:e} off all pieces", distance(p));
    }
}

/// By random points of the box: how much of the mesh the pieces leave out, and how much they have that it has not, in parts of the mesh.
fn difference(mesh: &Shape, parts: &Decomposition, rng: &mut StdRng) -> [f64; 2] {
    let solid = mesh.clone().into_solid().unwrap();
    let bounds = query::bounds(mesh, &HERE).unwrap();
    let (mut inside, mut missing, mut more, points) = (0, 0, 0, 20_000);
    for _ in 0..points {
        let part = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..1.0)));
        let p = bounds.min + part * (bounds.max - bounds.min);
        let of = |shape: &Shape| query::contains_point(shape, &HERE, p).unwrap();
        let (in_mesh, in_parts) = (of(&solid), of(&parts.shape));
        inside += usize::from(in_mesh);
        missing += usize::from(in_mesh && !in_parts);
        more += usize::from(in_parts && !in_mesh);
    }
    let rate = inside as f64 / points as f64;
    assert!((0.2..0.9).contains(&rate), "{rate} of the points are inside");
    [missing, more].map(|count| count as f64 / inside as f64)
}

#[test]
fn pieces_cover_the_mesh_and_little_more() {
    let mut rng = seeded(SEED);
    // How many pieces at most, and how much more they may have than the mesh.
    let cases = [("L", l_shape(), 2, 1e-9), ("star", star(), 12, 0.06), ("torus", torus(), 32, 0.12)];
    for (name, mesh, pieces_max, more_max) in cases {
        let parts = decompose(&mesh, &Options::default()).unwrap();
        let [missing, more] = difference(&mesh, &parts, &mut rng);
        println!("{name}: {} pieces, {missing} missing, {more} more, seed {SEED}", parts.pieces.len());
        assert_covers_surface(&mesh, &parts, &mut rng, name);
        assert!((2..=pieces_max).contains(&parts.pieces.len()), "{name}: {} pieces", parts.pieces.len());
        assert!(missing <= 1e-3, "{name}: {missing} is missing");
        assert!(more <= more_max, "{name}: {more} more");
    }
}

/// Voxels make a staircase of a ball; joining makes a ball of that again. One piece is always enough.
#[test]
fn what_is_convex_is_one_piece() {
    let options = Options::default();
    let turned = DAffine3::from_rotation_x(0.3) * DAffine3::from_rotation_y(0.7);
    let cube = prism(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], &[[0, 1, 2], [0, 2, 3]]);
    let tilted: Vec<DVec3> = cube.vertices().unwrap().iter().map(|&p| turned.transform_point3(p)).collect();
    let tilted = Shape::mesh(tilted, cube.triangles().unwrap()).unwrap();
    for (mesh, corners) in [(ball(), 11 * 24 + 2), (cube, 8), (tilted, 8)] {
        let parts = decompose(&mesh, &options).unwrap();
        assert_eq!(parts.pieces.len(), 1);
        assert_eq!(parts.pieces[0].vertices().unwrap().len(), corners, "no corner is made up");
    }
    for mesh in [l_shape(), star(), torus()] {
        for pieces_max in [1, 2, 3, 5] {
            let parts = decompose(&mesh, &Options { pieces_max, ..options }).unwrap();
            assert!(parts.pieces.len() <= pieces_max);
            assert_covers_surface(&mesh, &parts, &mut seeded(SEED), "few pieces");
        }
    }
}

/// A body in the notch of an L is in its hull, but not in its pieces; what is in a piece has a depth and contacts, as in a body of the
/// same parts put together by hand.
#[test]
fn pieces_give_depth_and_contacts() {
    let mut rng = seeded(SEED + 1);
    let mesh = l_shape();
    let parts = decompose(&mesh, &Options::default()).unwrap();
    let block = |min: DVec3, max: DVec3| -> Vec<DVec3> {
        (0..8)
            .map(|i| DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] })))
            .collect()
    };
    let at = |x: f64, y: f64| DVec3::new(x, y, 1.0);
    let by_hand = [
        [block(DVec3::ZERO, at(1.0, 3.0)), block(DVec3::X, at(2.0, 1.0))].concat(),
        [block(DVec3::ZERO, at(2.0, 1.0)), block(DVec3::Y, at(1.0, 3.0))].concat(),
    ];
    let by_hand = by_hand.map(|vertices| {
        let builder = ComplexShapeBuilder::new(vertices);
        builder
            .polyhedron(&[0, 1, 2, 3, 4, 5, 6, 7])
            .polyhedron(&[8, 9, 10, 11, 12, 13, 14, 15])
            .build()
            .unwrap()
    });
    let body = Shape::cuboid([0.4, 0.3, 0.2]).unwrap();
    let (mut hits, cases) = (0, 200);
    for case in 0..cases {
        let p =
            DVec3::new(rng.random_range(-0.4..2.4), rng.random_range(-0.4..3.4), rng.random_range(0.0..1.0));
        let there = DAffine3::from_translation(p) * DAffine3::from_rotation_z(rng.random_range(0.0..3.0));
        let depth =
            |shape: &Shape| query::penetration(&body, &there, shape, &HERE).unwrap().map_or(0.0, |p| p.depth);
        let found = depth(&parts.shape);
        let either = by_hand.each_ref().map(depth);
        assert!(
            either.iter().any(|depth| (depth - found).abs() < 1e-9),
            "case {case}: {found}, not one of {either:?}"
        );
        let contacts =
            query::contacts(&body, &there, &parts.shape, &HERE, &ContactOptions::default()).unwrap();
        assert_eq!(contacts.is_empty(), found == 0.0, "case {case}");
        hits += usize::from(found > 0.0);
    }
    assert!((cases * 3 / 10..=cases * 7 / 10).contains(&hits), "{hits} of {cases} hit");
}

/// In another unit of length, and far from the origin, the pieces are the same.
#[test]
fn the_unit_of_length_changes_nothing() {
    let mesh = star();
    let parts = decompose(&mesh, &Options::default()).unwrap();
    for power in [-300, -20, 1, 300] {
        let factor = 2f64.powi(power);
        let scaled: Vec<DVec3> = mesh.vertices().unwrap().iter().map(|&p| p * factor).collect();
        let scaled = Shape::mesh(scaled, mesh.triangles().unwrap()).unwrap();
        let scaled = decompose(&scaled, &Options::default()).unwrap();
        assert_eq!(scaled.pieces.len(), parts.pieces.len());
        for (piece, scaled) in parts.pieces.iter().zip(&scaled.pieces) {
            let back: Vec<DVec3> = scaled.vertices().unwrap().iter().map(|&p| p / factor).collect();
            assert_eq!(piece.vertices().unwrap(), back, "2^{power}");
        }
    }
    let options = Options { resolution: 16, ..Options::default() };
    for mesh in [mesh, torus()] {
        // In the end the mesh is a few steps of its coordinates wide.
        for far in [0.0, 1e6, -1e11, 1e13, -1e15, 3e15] {
            let moved: Vec<DVec3> = mesh.vertices().unwrap().iter().map(|&p| p + far).collect();
            let moved = Shape::mesh(moved, mesh.triangles().unwrap()).unwrap();
            let parts = decompose(&moved, &options).unwrap();
            assert_covers_surface(&moved, &parts, &mut seeded(SEED), "far away");
            // Where distances are not so rounded: coordinates that far away have exact differences.
            let back = |shape: &Shape| shape.vertices().unwrap().iter().map(|&p| p - far).collect::<Vec<_>>();
            let mut shape = parts.shape.clone();
            shape.deform(&back(&parts.shape)).unwrap();
            for p in back(&moved) {
                let d = query::closest_point(&shape, &HERE, p).unwrap().distance;
                assert!(d <= 1e-11 * size(&mesh), "{far:e} away: {p} is {d:e} off all pieces");
            }
        }
    }
}

#[test]
fn flat_and_tiny_meshes_have_pieces() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.4, 0.4, 0.0)];
    let meshes = [
        (vec![[0, 1, 3], [0, 3, 2]], "a plate that is not convex"),
        (vec![[0, 1, 2]], "a triangle"),
        (vec![[0, 1, 1]], "a segment"),
        (vec![[2, 2, 2]], "a point"),
    ];
    for (triangles, what) in meshes {
        let mesh = Shape::mesh(corners, triangles).unwrap();
        let parts = decompose(&mesh, &Options::default()).unwrap();
        assert_covers_surface(&mesh, &parts, &mut seeded(SEED), what);
    }
    // Segments, and triangles hardly wider.
    let mut rng = seeded(SEED + 3);
    for width in [0.0, 1e-17, 1e-12, 1e-7] {
        let point = |rng: &mut StdRng| DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.0..1.0)));
        let corners: Vec<DVec3> =
            (0..50).map(|_| point(&mut rng)).flat_map(|p| [p, p + width * DVec3::Z]).collect();
        let triangles: Vec<[u32; 3]> = (0..49).map(|i| [2 * i, 2 * i + 1, 2 * i + 2]).collect();
        let mesh = Shape::mesh(corners, triangles).unwrap();
        let parts = decompose(&mesh, &Options::default()).unwrap();
        for _ in 0..40 {
            assert_covers_surface(&mesh, &parts, &mut rng, &format!("segments {width:e} wide"));
        }
    }
    let far = Shape::mesh([DVec3::X * 1e100, DVec3::Y * 1e-100, DVec3::splat(-1e100)], [[0, 1, 2]]).unwrap();
    let parts = decompose(&far, &Options::default()).unwrap();
    assert_covers_surface(&far, &parts, &mut seeded(SEED), "huge");
}

/// What would have no volume is not put between pieces all the same: they are apart.
#[test]
fn plates_in_one_plane_that_are_apart_stay_apart() {
    let corners = [0.0, 5.0]
        .map(|x| [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(dx, y)| DVec3::new(x + dx, y, 0.0)));
    let plates = Shape::mesh(corners.concat(), [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]).unwrap();
    let parts = decompose(&plates, &Options::default()).unwrap();
    let ball = Shape::sphere(0.1).unwrap();
    let at = |x: f64| {
        let there = DAffine3::from_translation(DVec3::new(x, 0.5, 0.0));
        query::intersects(&parts.shape, &HERE, &ball, &there).unwrap()
    };
    assert_eq!([0.5, 3.0, 5.5].map(at), [true, false, true]);
}

/// A triangle in the plane in which two regions meet is in both, and may be left out elsewhere all the same.
#[test]
fn surfaces_in_planes_of_cuts_are_covered() {
    let lattice = [[2, 2, 0], [1, 2, 0], [0, 1, 0], [2, 2, 2], [0, 0, 0], [2, 2, 0], [0, 2, 2], [1, 0, 0]];
    let vertices = lattice.map(|p| DVec3::from(p.map(|x| f64::from(x) / 2.0 + 1000.0)));
    let triangles = [[6, 5, 7], [7, 0, 5], [5, 7, 7], [7, 5, 4], [4, 0, 6], [0, 4, 1]];
    let mesh = Shape::mesh(vertices, triangles).unwrap();
    let parts = decompose(&mesh, &Options { concavity: 0.001, resolution: 9, ..Options::default() }).unwrap();
    let mut rng = seeded(SEED);
    (0..100).for_each(|_| assert_covers_surface(&mesh, &parts, &mut rng, "a lattice"));
}

#[test]
fn bad_input_is_refused() {
    let error = |mesh: &Shape, options: &Options| decompose(mesh, options).unwrap_err().to_string();
    let (mesh, options) = (l_shape(), Options::default());
    assert_eq!(
        error(&Shape::sphere(1.0).unwrap(), &options),
        "a sphere cannot be decomposed; only meshes can"
    );
    for pieces_max in [0, PIECES_MAX + 1] {
        let expected = format!("pieces_max is {pieces_max}; it must be from 1 to 128");
        assert_eq!(error(&mesh, &Options { pieces_max, ..options }), expected);
    }
    for concavity in [-0.1, f64::NAN, 1.5] {
        let expected = format!("concavity is {concavity}; it must be from 0 to 1");
        assert_eq!(error(&mesh, &Options { concavity, ..options }), expected);
    }
    for resolution in [0, 7, 129] {
        let expected = format!("resolution is {resolution}; it must be from 8 to 128");
        assert_eq!(error(&mesh, &Options { resolution, ..options }), expected);
    }
    // Many large triangles on a fine grid.
    let triangles: Vec<[u32; 3]> = (0..4000).map(|i| [i % 6, (i + 1) % 6, 6 + i % 5]).collect();
    let heavy = Shape::mesh(mesh.vertices().unwrap(), triangles).unwrap();
    let found = decompose(&heavy, &Options { resolution: 128, ..options }).unwrap_err();
    assert!(matches!(found, Error::TooMuchWork { triangles: 4000, resolution: 128, .. }), "{found}");
    assert!(found.to_string().ends_with("lower the resolution, or simplify the mesh"), "{found}");
}

/// Whatever loads has pieces, or an error that says why not.
#[test]
fn bad_meshes() {
    let Some(folder) = known_answers("bad_meshes") else { return };
    let mut rng = seeded(SEED + 2);
    let options = Options { resolution: 32, ..Options::default() };
    let (mut decomposed, mut refused) = (0, 0);
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        let mut entries: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        entries.sort();
        folders.extend(entries.iter().filter(|path| path.is_dir()).cloned());
        for path in entries.iter().filter(|path| path.is_file()) {
            let Ok(scene) = Scene::load(std::slice::from_ref(path), &LoadOptions::default()) else {
                continue;
            };
            for mesh in scene.objects().iter().map(|object| object.shape()) {
                let what = path.display().to_string();
                match decompose(mesh, &options) {
                    Ok(parts) => {
                        decomposed += 1;
                        assert!(parts.pieces.len() <= options.pieces_max, "{what}");
                        assert_covers_surface(mesh, &parts, &mut rng, &what);
                    }
                    Err(error) => {
                        refused += 1;
                        println!("{what}: {error}");
                        assert!(
                            matches!(error, Error::NotAMesh { .. } | Error::TooMuchWork { .. }),
                            "{what}: {error}"
                        );
                    }
                }
            }
        }
    }
    println!("bad meshes: {decomposed} decomposed, {refused} refused, seed {}", SEED + 2);
    assert!(decomposed >= 20 && decomposed >= 10 * refused);
}
