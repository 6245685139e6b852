//! An animation of spheres, boxes, cones, cylinders, polyhedra and meshes, one of which deforms: the collisions that the C
//! functions report are the same with caching on and off, and those of `query::intersects` on every pair.
#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

use std::ffi::c_void;
use std::ptr;

use solid::*;
use solid3d::glam::{DAffine3, DQuat, DVec3};
use solid3d::{ComplexShapeBuilder, Shape, query};

const FRAMES: usize = 10_000;
const OBJECTS: usize = 16;

/// Which pairs collide: a bit for each.
type Pairs = u128;

fn bit(i: usize, j: usize) -> Pairs {
    let (i, j) = (i.min(j), i.max(j));
    1 << (j * (j - 1) / 2 + i)
}

/// The geometry, once for C and once for Rust.
struct Scene {
    references: Vec<DtShapeRef>,
    shapes: Vec<Shape>,
    cloth: Vec<DVec3>,
    cloth_triangles: Vec<[u32; 3]>,
}

/// The vertices of a soft ring of triangles, at a time.
fn ring(time: f64) -> Vec<DVec3> {
    let vertex = |i: usize, j: usize| {
        let (u, v) = (i as f64 * std::f64::consts::TAU / 12.0, j as f64 * std::f64::consts::TAU / 6.0);
        let thick = 0.35 + 0.1 * (3.0 * u + time).sin();
        let out = 1.2 + thick * v.cos();
        DVec3::new(out * u.cos(), thick * v.sin(), out * u.sin())
    };
    (0..12).flat_map(|i| (0..6).map(move |j| vertex(i, j))).collect()
}

fn ring_triangles() -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| (i % 12) * 6 + j % 6;
    let square =
        |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
    (0..12).flat_map(|i| (0..6).flat_map(move |j| square(i, j))).collect()
}

/// Points near a ball: a polyhedron of 20 vertices, some of them interior.
fn pebble() -> Vec<DVec3> {
    let vertex = |i: i32| {
        let (a, b) = (f64::from(i) * 2.4, f64::from(i) / 10.0 - 0.95);
        let r = if i % 5 == 0 { 0.4 } else { 1.0 };
        r * DVec3::new((1.0 - b * b).sqrt() * a.cos(), b, (1.0 - b * b).sqrt() * a.sin())
    };
    (0..20).map(vertex).collect()
}

fn complex(vertices: &[DVec3], polytopes: &[Vec<u32>], kind: DtPolyType) -> DtShapeRef {
    let reference = dtNewComplexShape();
    // SAFETY: `vertices` and the indices outlive the shape's construction, and the indices are in range.
    unsafe { dtVertexBase(vertices.as_ptr().cast()) };
    for polytope in polytopes {
        // SAFETY: as many indices as there are.
        unsafe { dtVertexIndices(kind, polytope.len() as u32, polytope.as_ptr()) };
    }
    // SAFETY: as above.
    unsafe { dtEndComplexShape() };
    reference
}

impl Scene {
    fn new() -> Scene {
        let (cloth, cloth_triangles, pebble) = (ring(0.0), ring_triangles(), pebble());
        let triangles: Vec<Vec<u32>> = cloth_triangles.iter().map(|t| t.to_vec()).collect();
        let all: Vec<u32> = (0..20).collect();
        let pieces = vec![(0..10).collect::<Vec<u32>>(), (8..20).collect(), vec![0, 19]];
        let soup = pieces.iter().fold(ComplexShapeBuilder::new(pebble.clone()), |b, p| b.polyhedron(p));
        Scene {
            references: vec![
                dtSphere(1.0),
                dtBox(1.0, 2.0, 1.5),
                dtCone(1.0, 2.0),
                dtCylinder(0.8, 1.6),
                complex(&pebble, &[all], 2),
                complex(&cloth, &triangles, 0),
                complex(&pebble, &pieces, 2),
                complex(&cloth, &triangles, 1),
            ],
            shapes: vec![
                Shape::sphere(1.0).unwrap(),
                Shape::cuboid([1.0, 2.0, 1.5]).unwrap(),
                Shape::cone(1.0, 2.0).unwrap(),
                Shape::cylinder(0.8, 1.6).unwrap(),
                Shape::convex_hull(&pebble).unwrap(),
                Shape::mesh(cloth.clone(), cloth_triangles.clone()).unwrap(),
                soup.build().unwrap(),
                Shape::mesh(cloth.clone(), cloth_triangles.clone()).unwrap(),
            ],
            cloth,
            cloth_triangles,
        }
    }

    /// The number of a shape that deforms.
    const DEFORMING: usize = 5;
}

fn placement(object: usize, frame: usize) -> DAffine3 {
    let (t, k) = (0.01 * frame as f64, object as f64);
    let position = DVec3::new(
        4.0 * (t * (1.0 + 0.07 * k) + k).sin(),
        4.0 * (t * (1.3 - 0.05 * k) + 2.0 * k).sin(),
        4.0 * (t * (0.8 + 0.03 * k) + 3.0 * k).cos(),
    );
    let rotation = DQuat::from_scaled_axis(DVec3::new(t, 0.5 * t * k.sin(), k));
    let scale = DVec3::new(1.0, 1.0 + 0.3 * (k + t).sin(), if object.is_multiple_of(3) { -1.0 } else { 1.0 });
    DAffine3::from_scale_rotation_translation(scale, rotation, position)
}

fn reference(object: usize) -> DtObjectRef {
    ptr::without_provenance_mut(object)
}

unsafe extern "C-unwind" fn record(
    pairs: *mut c_void,
    object1: DtObjectRef,
    object2: DtObjectRef,
    _: *const DtCollData,
) {
    // SAFETY: the pointer is the one that was given with this function, to a value that outlives the test.
    let pairs = unsafe { &mut *pairs.cast::<Pairs>() };
    let bit = bit(object1.addr(), object2.addr());
    assert_eq!(*pairs & bit, 0, "a pair comes once");
    *pairs |= bit;
}

/// The collisions of each frame, by the C functions.
fn play(scene: &Scene, kind: DtResponseType) -> Vec<Pairs> {
    let mut pairs: Pairs = 0;
    let pairs: *mut Pairs = &raw mut pairs;
    dtSetDefaultResponse(Some(record), kind, pairs.cast());
    for object in 0..OBJECTS {
        dtCreateObject(reference(object), scene.references[object % scene.references.len()]);
    }
    let mut frames = Vec::new();
    for frame in 0..FRAMES {
        for object in 0..OBJECTS {
            let m = placement(object, frame);
            let (x, y, z, t) = (m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation);
            #[rustfmt::skip]
            let m = [x.x, x.y, x.z, 0.0, y.x, y.y, y.z, 0.0, z.x, z.y, z.z, 0.0, t.x, t.y, t.z, 1.0];
            dtSelectObject(reference(object));
            // SAFETY: 16 numbers.
            unsafe { dtLoadMatrixd(m.as_ptr()) };
        }
        let vertices = ring(0.02 * frame as f64);
        // SAFETY: as many vertices as the shape was made of.
        unsafe { dtChangeVertexBase(scene.references[Scene::DEFORMING], vertices.as_ptr().cast()) };
        // SAFETY: nobody else uses it.
        unsafe { *pairs = 0 };
        let count = dtTest();
        // SAFETY: as above.
        let found = unsafe { *pairs };
        assert_eq!(count, found.count_ones());
        frames.push(found);
        dtProceed();
    }
    for object in 0..OBJECTS {
        dtDeleteObject(reference(object));
    }
    assert_eq!(dtGetError(), 0);
    frames
}

/// The collisions of a frame, by asking about every pair.
fn ask(scene: &mut Scene, frame: usize) -> Pairs {
    scene.shapes[Scene::DEFORMING] =
        Shape::mesh(ring(0.02 * frame as f64), scene.cloth_triangles.clone()).unwrap();
    let shapes = &scene.shapes;
    let placements: Vec<DAffine3> = (0..OBJECTS).map(|object| placement(object, frame)).collect();
    let mut pairs = 0;
    for j in 1..OBJECTS {
        for i in 0..j {
            let (a, b) = (&shapes[i % shapes.len()], &shapes[j % shapes.len()]);
            if query::intersects(a, &placements[i], b, &placements[j]).unwrap() {
                pairs |= bit(i, j);
            }
        }
    }
    pairs
}

#[test]
fn caching_and_the_broad_phase_change_no_answer() {
    let mut scene = Scene::new();
    assert_eq!(scene.cloth.len(), 72);
    let cached = play(&scene, 1);
    dtDisableCaching();
    let uncached = play(&scene, 1);
    dtEnableCaching();
    let smart = play(&scene, 2);
    assert!(cached == uncached, "caching changes answers");
    assert!(cached == smart, "the response changes answers");
    let mut collisions = 0;
    for (frame, &pairs) in cached.iter().enumerate() {
        assert_eq!(pairs, ask(&mut scene, frame), "frame {frame}");
        collisions += u64::from(pairs.count_ones());
    }
    // The animation is representative: neither empty nor a heap.
    let share = collisions as f64 / (FRAMES * OBJECTS * (OBJECTS - 1) / 2) as f64;
    assert!((0.03..0.5).contains(&share), "{share} of all pairs collide");
    for &shape in &scene.references {
        dtDeleteShape(shape);
    }
}
