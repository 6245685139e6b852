use solid3d::query;

use super::*;

/// Law: the same seed gives the same input.
#[test]
fn a_seed_repeats() {
    let draw = |seed| {
        let mut rng = seeded(seed);
        let polyhedron = Polyhedron::random(&mut rng, 20);
        let mut simulation = ICollide::new(&mut rng, &Settings::default());
        simulation.step([(0, 1)]);
        (polyhedron.vertices, simulation.poses(), Mesh::terrain(&mut rng, 200))
    };
    assert_eq!(draw(SEED), draw(SEED));
    assert_ne!(draw(SEED).0, draw(SEED + 1).0);
}

/// Law: grids have the number of triangles asked for, and a torus is closed.
#[test]
fn meshes_have_the_count_asked_for() {
    for n in [18, 5_000, 100_000] {
        let torus = Mesh::torus(n);
        assert_eq!(torus.triangles.len(), n);
        assert_eq!(2 * torus.vertices.len(), n);
        assert!(torus.shape().into_solid().is_ok());
    }
    assert_eq!(Mesh::terrain(&mut seeded(SEED), 5_000).triangles.len(), 5_000);
}

/// Law: pairs and tracks meet the overlap asked for.
#[test]
fn overlap_is_as_asked() {
    let mut rng = seeded(SEED);
    let shape = Polyhedron::random(&mut rng, 20).shape();
    let hit = |pair: &PairPose| {
        query::intersects(&shape, &pair[0].affine(), &shape, &pair[1].affine()).expect("poses are valid")
    };
    for rate in [0.1, 0.5, 0.9] {
        let pairs = pairs_at_overlap(&mut rng, 1000, rate, 20.0, |_, pair| hit(pair));
        let hits = pairs.iter().filter(|pair| hit(pair)).count();
        assert!((hits as f64 / 1000.0 - rate).abs() < 0.01, "{hits} of 1000 instead of {rate}");
    }
    let track = track_at_overlap(&mut rng, 20_000, 0.5, 20.0, hit);
    let hits = track.iter().filter(|pair| hit(pair)).count();
    assert!((0.3..0.7).contains(&(hits as f64 / 20_000.0)), "{hits} of 20000");
}

/// Law: a swarm has about half as many overlapping pairs as boxes, also after it has moved.
#[test]
fn a_swarm_overlaps_as_asked() {
    let mut swarm = Swarm::random(&mut seeded(SEED), 2000);
    for _ in 0..2 {
        let boxes: Vec<_> = (0..swarm.count()).map(|i| swarm.bounds(i)).collect();
        let pairs = (0..boxes.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let overlaps = pairs.filter(|&(i, j)| boxes[i].overlaps(&boxes[j])).count();
        assert!((800..1300).contains(&overlaps), "{overlaps}");
        (0..50).for_each(|_| swarm.step(2000));
    }
}

/// Law: the polyhedra of the simulation fill the share of the cube that was asked for, and stay in it.
#[test]
fn i_collide_keeps_its_density() {
    let settings = Settings { objects: 50, ..Settings::default() };
    let mut simulation = ICollide::new(&mut seeded(SEED), &settings);
    let volume: f64 = (0..50).map(|i| simulation.shape_of(i).volume()).sum();
    assert!((volume / (2.0 * simulation.side).powi(3) - 0.05).abs() < 1e-12);
    (0..1000).for_each(|frame| simulation.step([(frame % 50, (frame + 7) % 50)]));
    let reach = simulation.side + settings.translation + 1e-9;
    assert!(simulation.poses().iter().all(|pose| pose.translation.abs().max_element() <= reach));
}
