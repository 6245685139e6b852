//! Random polygons that are exactly flat, with everything that can be degenerate.

use glam::{DVec2, DVec3};
use rand::Rng;
use rand::rngs::StdRng;

use crate::polygon::exact::{segments_cross, segments_meet};
use crate::polygon::{Polygon, holes, planar};

/// A plane through lattice points: combinations of these with small whole numbers are exact.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub origin: DVec3,
    pub axes: [DVec3; 2],
}

impl Frame {
    pub fn random(rng: &mut StdRng, reach: i32, steepness: i32) -> Frame {
        let mut whole =
            |end: i32| DVec3::from_array(std::array::from_fn(|_| f64::from(rng.random_range(-end..=end))));
        loop {
            let frame = Frame { origin: whole(reach), axes: [whole(steepness), whole(steepness)] };
            if frame.axes[0].cross(frame.axes[1]) != DVec3::ZERO {
                return frame;
            }
        }
    }

    pub fn lift(&self, p: DVec2) -> DVec3 {
        self.origin + p.x * self.axes[0] + p.y * self.axes[1]
    }
}

fn point(rng: &mut StdRng, side: i32) -> DVec2 {
    DVec2::new(f64::from(rng.random_range(0..=side)), f64::from(rng.random_range(0..=side)))
}

/// A polygon whose edges touch only where they are joined: random points, untangled.
fn simple(rng: &mut StdRng, corners: usize, side: i32) -> Vec<DVec2> {
    'attempt: loop {
        let mut chain: Vec<DVec2> = (0..corners).map(|_| point(rng, side)).collect();
        for _ in 0..1000 {
            let Some([i, j]) = planar::crossing(&chain) else { break };
            chain[i + 1..=j].reverse();
        }
        let n = chain.len();
        let edge = |i: usize| (chain[i], chain[(i + 1) % n]);
        for i in 0..n {
            let ((p, q), (_, r)) = (edge(i), edge((i + 1) % n));
            // Neighbours must not fold back onto each other.
            if p == q || (planar_turn(p, q, r) == 0.0 && (p - q).dot(r - q) > 0.0) {
                continue 'attempt;
            }
            for j in i + 2..n {
                let neighbours = i == 0 && j == n - 1;
                if !neighbours && segments_meet(p, q, edge(j).0, edge(j).1) {
                    continue 'attempt;
                }
            }
        }
        return chain;
    }
}

fn planar_turn(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    crate::polygon::exact::turn(p, q, r)
}

/// A weakly simple chain: sometimes with holes, slits, antennae, collinear and repeated vertices.
pub fn chain(rng: &mut StdRng, side: i32) -> Vec<DVec2> {
    let most = if side < 4 { 5 } else { 10 };
    let corners = rng.random_range(3..=most);
    let mut chain = simple(rng, corners, side);
    if rng.random_range(0..3) == 0 {
        chain = with_hole(rng, &chain, side).unwrap_or(chain);
    }
    if rng.random_range(0..3) == 0 {
        with_slit(rng, &mut chain, side);
    }
    if rng.random_range(0..4) == 0 {
        // A vertex in the middle of an edge, where the lattice has one; else a repeated vertex.
        let i = rng.random_range(0..chain.len());
        let middle = (chain[i] + chain[(i + 1) % chain.len()]) / 2.0;
        chain.insert(i + 1, if middle == middle.round() { middle } else { chain[i] });
    }
    if rng.random() {
        chain.reverse();
    }
    let turn = rng.random_range(0..chain.len());
    chain.rotate_left(turn);
    chain
}

fn with_hole(rng: &mut StdRng, outer: &[DVec2], side: i32) -> Option<Vec<DVec2>> {
    let hole = (0..20).find_map(|_| {
        let hole = simple(rng, 3, side);
        let strictly_inside = hole.iter().all(|&x| planar::contains(outer, x))
            && !planar::edges(outer)
                .any(|(p, q)| planar::edges(&hole).any(|(r, s)| segments_meet(p, q, r, s)));
        strictly_inside.then_some(hole)
    })?;
    let points: Vec<DVec2> = outer.iter().chain(&hole).copied().collect();
    let outer: Vec<usize> = (0..outer.len()).collect();
    let hole: Vec<usize> = (outer.len()..points.len()).collect();
    let joined = holes::join(&points, &outer, &[hole]).unwrap();
    Some(joined.into_iter().map(|i| points[i]).collect())
}

/// A doubled edge from a corner to anywhere that crosses nothing: a slit inside, an antenna outside.
fn with_slit(rng: &mut StdRng, chain: &mut Vec<DVec2>, side: i32) {
    let (i, tip) = (rng.random_range(0..chain.len()), point(rng, side));
    let from = chain[i];
    // It may touch nothing but its own corner, and that corner must be passed once.
    let clear = planar::edges(chain).all(|(p, q)| {
        if p == from || q == from {
            let other = if p == from { q } else { p };
            planar_turn(from, tip, other) != 0.0 && !segments_cross(from, tip, p, q)
        } else {
            !segments_meet(from, tip, p, q)
        }
    });
    if clear && tip != from && chain.iter().filter(|&&p| p == from).count() == 1 {
        chain.splice(i + 1..i + 1, [tip, from]);
    }
}

pub fn polygon(chain: &[DVec2], frame: &Frame) -> Polygon {
    let vertices: Vec<DVec3> = chain.iter().map(|&p| frame.lift(p)).collect();
    let polygon = Polygon::new(vertices).unwrap();
    assert!(polygon.is_flat());
    polygon
}

/// A pair of polygons within a few sizes of each other.
pub fn pair(rng: &mut StdRng, case: usize) -> [Polygon; 2] {
    // A small lattice makes everything touch; a large one is general position.
    let side = [2, 3, 5, 9, 1000][case % 5];
    let (reach, steepness) =
        if side == 1000 { (800, 1) } else { (side / 2 + 1, 1 + i32::from(case.is_multiple_of(3))) };
    let frame = Frame::random(rng, 0, steepness);
    let (first, second) = (chain(rng, side), chain(rng, side));
    let other = if case.is_multiple_of(4) {
        // In the same plane, or a parallel one.
        let shift = |rng: &mut StdRng| f64::from(rng.random_range(-side..=side));
        let origin = shift(rng) * frame.axes[0] + shift(rng) * frame.axes[1];
        let lift = if rng.random_range(0..8) == 0 { DVec3::X } else { DVec3::ZERO };
        Frame { origin: origin + lift, axes: frame.axes }
    } else {
        let mut other = Frame::random(rng, 0, steepness);
        // A point of the one near a point of the other.
        let on_a = frame.lift(DVec2::splat(f64::from(side / 2)));
        let off = Frame::random(rng, reach, 1).origin * if side == 1000 { 0.3 } else { 0.5 };
        other.origin = (on_a + off - other.lift(DVec2::splat(f64::from(side / 2)))).round();
        other
    };
    [polygon(&first, &frame), polygon(&second, &other)]
}
