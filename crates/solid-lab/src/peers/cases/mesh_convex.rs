//! A mesh against convex shapes, from small beside it to half as wide.

use solid3d::glam::DVec3;

use super::pairs::{Scene, distance, intersection};
use super::with_commas;
use crate::inputs::{Mesh, PairPose, Polyhedron, Pose, Primitive, direction};
use crate::peers::Bench;
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Ours, Primitives, each};

const TRIANGLES: usize = 100_000;

/// The radii of the shapes, or about that, with how wide they are beside the terrain, which is 2 wide.
const SIZES: [(f64, &str); 3] =
    [(0.05, "a twentieth as wide"), (0.2, "a fifth as wide"), (0.5, "half as wide")];

/// How far above or below the surface the shapes are at most, in their own sizes: half of them meet it.
const LIFT: f64 = 2.0;

/// How many places.
const PAIRS: usize = 200;

/// Vertices of the hull.
const HULL_VERTICES: usize = 40;

/// What is put beside the mesh.
#[derive(Clone)]
enum Convex {
    Primitive(Primitive),
    Hull(Polyhedron),
}

/// Races.
pub fn measure(bench: &mut Bench) {
    let name = format!("mesh of {} triangles", with_commas(TRIANGLES));
    let mut rng = bench.rng(&name);
    let terrain = Mesh::terrain(&mut rng, bench.effort.size(TRIANGLES));
    let hull = Polyhedron::random(&mut rng, HULL_VERTICES);
    for (size, width) in SIZES {
        let shapes = [
            ("sphere", Convex::Primitive(Primitive::Sphere(size))),
            ("box", Convex::Primitive(Primitive::Cuboid(DVec3::new(1.4, 1.0, 1.2) * size))),
            ("hull", Convex::Hull(hull.scaled(size))),
        ];
        let poses = poses(bench, &terrain, size);
        for (what, shape) in shapes {
            let entries = each!(questions: Ours, double::Parry, single::Parry; (&terrain, &shape, &poses));
            let (intersections, distances) = entries.into_iter().unzip();
            for (question, entries) in [("intersection", intersections), ("distance", distances)] {
                let work = format!("{name} and {what}, {question}, {width}");
                bench.race(&work, poses.len(), Unit::Micro, entries);
            }
        }
    }
}

/// Near random vertices of the terrain.
fn poses(bench: &Bench, terrain: &Mesh, size: f64) -> Vec<PairPose> {
    let mut rng = bench.rng("places on the terrain");
    (0..bench.effort.sample(PAIRS))
        .map(|i| {
            let vertex = terrain.vertices[(i * 7919) % terrain.vertices.len()];
            let lift = DVec3::Z * direction(&mut rng).z * LIFT * size;
            [Pose::IDENTITY, Pose::random_at(&mut rng, vertex + lift)]
        })
        .collect()
}

fn questions<L: Primitives>(terrain: &Mesh, shape: &Convex, poses: &[PairPose]) -> (Entry, Entry) {
    let convex = match shape {
        Convex::Primitive(primitive) => L::primitive(*primitive),
        Convex::Hull(hull) => L::polyhedron(hull),
    };
    let scene = &Scene::<L>::new([L::mesh(L::buffers(terrain)), convex], poses);
    (intersection(scene), distance(scene))
}

#[cfg(test)]
mod tests {
    use solid3d::{Shape, query};

    use super::*;
    use crate::inputs::seeded;
    use crate::peers::Effort;

    /// Law: about half of the places meet the terrain.
    #[test]
    fn half_of_the_places_meet() {
        let terrain = Mesh::terrain(&mut seeded(1), 20_000);
        let mesh = terrain.shape();
        for (size, width) in SIZES {
            let ball = Shape::sphere(size).expect("the radius is valid");
            let poses = poses(&Bench::new(Effort::Full, 1), &terrain, size);
            let meet = |pair: &&PairPose| {
                query::intersects(&mesh, &pair[0].affine(), &ball, &pair[1].affine()) == Ok(true)
            };
            let hits = poses.iter().filter(meet).count();
            assert!((PAIRS * 3 / 10..PAIRS * 7 / 10).contains(&hits), "{hits} of {PAIRS}, {width}");
        }
    }
}
