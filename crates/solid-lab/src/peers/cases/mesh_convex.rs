//! A mesh against convex shapes that are small beside it.

use solid3d::glam::DVec3;

use super::pairs::{Scene, distance, intersection};
use super::with_commas;
use crate::inputs::{Mesh, PairPose, Polyhedron, Pose, Primitive, direction};
use crate::peers::Bench;
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Ours, Primitives, each};

const TRIANGLES: usize = 100_000;

/// The shapes are that large; the terrain is 2 wide.
const SIZE: f64 = 0.05;

/// How far above or below the surface the shapes are at most, in their own sizes: half of them meet it.
const LIFT: f64 = 2.0;

/// How many places.
const PAIRS: usize = 200;

/// Vertices of the hull.
const HULL_VERTICES: usize = 40;

/// What is put beside the mesh.
#[derive(Clone)]
enum Small {
    Primitive(Primitive),
    Hull(Polyhedron),
}

/// Races.
pub fn measure(bench: &mut Bench) {
    let name = format!("mesh of {} triangles", with_commas(TRIANGLES));
    let mut rng = bench.rng(&name);
    let terrain = Mesh::terrain(&mut rng, bench.effort.size(TRIANGLES));
    let smalls = [
        ("sphere", Small::Primitive(Primitive::Sphere(SIZE))),
        ("box", Small::Primitive(Primitive::Cuboid(DVec3::new(1.4, 1.0, 1.2) * SIZE))),
        ("hull", Small::Hull(Polyhedron::random(&mut rng, HULL_VERTICES).scaled(SIZE))),
    ];
    let poses = poses(bench, &terrain);
    for (what, small) in smalls {
        let work = format!("{name} and {what}");
        let entries = each!(questions: Ours, double::Parry, single::Parry; (&terrain, &small, &poses));
        let (intersections, distances) = entries.into_iter().unzip();
        bench.race(&format!("{work}, intersection"), poses.len(), Unit::Micro, intersections);
        bench.race(&format!("{work}, distance"), poses.len(), Unit::Micro, distances);
    }
}

/// Near random vertices of the terrain.
fn poses(bench: &Bench, terrain: &Mesh) -> Vec<PairPose> {
    let mut rng = bench.rng("places on the terrain");
    (0..bench.effort.sample(PAIRS))
        .map(|i| {
            let vertex = terrain.vertices[(i * 7919) % terrain.vertices.len()];
            let lift = DVec3::Z * direction(&mut rng).z * LIFT * SIZE;
            [Pose::IDENTITY, Pose::random_at(&mut rng, vertex + lift)]
        })
        .collect()
}

fn questions<L: Primitives>(terrain: &Mesh, small: &Small, poses: &[PairPose]) -> (Entry, Entry) {
    let small = match small {
        Small::Primitive(primitive) => L::primitive(*primitive),
        Small::Hull(hull) => L::polyhedron(hull),
    };
    let scene = &Scene::<L>::new([L::mesh(L::buffers(terrain)), small], poses);
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
        let (mesh, ball) = (terrain.shape(), Shape::sphere(SIZE).expect("the radius is valid"));
        let poses = poses(&Bench::new(Effort::Full, 1), &terrain);
        let meet = |pair: &&PairPose| {
            query::intersects(&mesh, &pair[0].affine(), &ball, &pair[1].affine()) == Ok(true)
        };
        let hits = poses.iter().filter(meet).count();
        assert!((PAIRS * 3 / 10..PAIRS * 7 / 10).contains(&hits), "{hits} of {PAIRS}");
    }
}
