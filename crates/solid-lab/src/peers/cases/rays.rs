//! Rays against a mesh.

use crate::inputs::{Mesh, direction};
use crate::peers::Bench;
use crate::peers::bench::{Entry, Unit};
use crate::peers::contestants::parry::{double, single};
use crate::peers::contestants::{Ours, Rays, each};
use solid3d::glam::DVec3;

use super::with_commas;

const TRIANGLES: usize = 100_000;

/// How many rays.
const RAYS: usize = 1000;

/// How far from the centre of the torus rays begin.
const FROM: f64 = 3.0;

/// Races.
pub fn measure(bench: &mut Bench) {
    let name = format!("closest ray, {} triangles", with_commas(TRIANGLES));
    let mut rng = bench.rng(&name);
    let torus = Mesh::torus(bench.effort.size(TRIANGLES));
    // From outside to points of the ball around the torus: about half of them hit.
    let rays: Vec<[DVec3; 2]> = (0..bench.effort.sample(RAYS))
        .map(|_| {
            let origin = direction(&mut rng) * FROM;
            [origin, (direction(&mut rng) - origin).normalize()]
        })
        .collect();
    let entries = each!(entry: Ours, double::Parry, single::Parry; (&torus, &rays));
    bench.race(&name, rays.len(), Unit::Nano, entries);
}

fn entry<L: Rays>(torus: &Mesh, rays: &[[DVec3; 2]]) -> Entry {
    let mesh = L::mesh(L::buffers(torus));
    let rays: Vec<L::Ray> = rays.iter().map(|[origin, direction]| L::ray(*origin, *direction)).collect();
    Entry::new(L::PEER, move || rays.iter().filter(|ray| L::closest(&mesh, ray).is_some()).count())
}
