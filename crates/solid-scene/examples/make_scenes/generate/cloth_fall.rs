//! A cloth that falls over a ball on a table: position based dynamics (Müller et al. 2007), with nothing but additions,
//! multiplications, divisions and square roots, which every machine rounds in the same way.

use glam::DVec3;

use super::mesh::Mesh;

/// The cloth is a square of 2 m in so many cells a side.
pub const CELLS: u16 = 12;

pub const BALL_RADIUS: f64 = 0.5;
pub const BALL_CENTRE: DVec3 = DVec3::new(0.0, TABLE_TOP + 0.52, 0.0);
pub const TABLE_RADIUS: f64 = 1.5;
pub const TABLE_TOP: f64 = 0.7;

/// Where the middle of the cloth is at first: off the axis, so that it does not fall like a flower.
const START: DVec3 = DVec3::new(0.025, TABLE_TOP + 1.2, -0.015);

/// How deep the vertices sink into ball and table: the solver of this scene is a little off.
const SINK: f64 = 0.004;

const STEPS_PER_SECOND: u32 = 240;
const ITERATIONS: usize = 24;
const GRAVITY: f64 = 9.81;
/// What is left of a velocity after a step.
const DRAG: f64 = 0.992;
/// What each iteration leaves of the movement of a vertex that touches something.
const SLIP: f64 = 0.97;
/// Strengths of the links across the cells, and of those against folding.
const SHEAR: f64 = 0.1;
const BEND: f64 = 0.003;

/// Two vertices, how far apart they want to be, and how much: from 0 to 1.
struct Link {
    a: usize,
    b: usize,
    length: f64,
    strength: f64,
}

/// The vertices of the cloth at given times, in seconds, ascending.
pub fn fall(times: &[f64]) -> Vec<Vec<DVec3>> {
    let mut now: Vec<DVec3> = Mesh::grid(CELLS).vertices.iter().map(|v| *v + START).collect();
    let mut before = now.clone();
    let links = links(&now);
    let (mut keys, mut step) = (Vec::new(), 0);
    for time in times {
        while f64::from(step) < time * f64::from(STEPS_PER_SECOND) {
            advance(&mut now, &mut before, &links);
            step += 1;
        }
        keys.push(now.clone());
    }
    keys
}

/// Along the cells, across them, and, against folding, over two of them.
fn links(vertices: &[DVec3]) -> Vec<Link> {
    let side = usize::from(CELLS) + 1;
    let mut links = Vec::new();
    for (i, j) in (0..side * side).map(|v| (v % side, v / side)) {
        for (di, dj, strength) in
            [(1, 0, 1.0), (0, 1, 1.0), (1, 1, SHEAR), (-1, 1, SHEAR), (2, 0, BEND), (0, 2, BEND)]
        {
            let (Some(k), l) = (i.checked_add_signed(di), j + dj) else { continue };
            if k < side && l < side {
                let (a, b) = (i + j * side, k + l * side);
                links.push(Link { a, b, length: (vertices[a] - vertices[b]).length(), strength });
            }
        }
    }
    links
}

fn advance(now: &mut [DVec3], before: &mut [DVec3], links: &[Link]) {
    let dt = 1.0 / f64::from(STEPS_PER_SECOND);
    for (now, before) in now.iter_mut().zip(before.iter_mut()) {
        let velocity = DRAG * (*now - *before) / dt - DVec3::Y * GRAVITY * dt;
        *before = *now;
        *now += velocity * dt;
    }
    for _ in 0..ITERATIONS {
        for &Link { a, b, length, strength } in links {
            let between = now[b] - now[a];
            let apart = between.length();
            // Two cells may come closer, one may not.
            let shift = 0.5 * strength * between * (1.0 - length / apart);
            now[a] += shift;
            now[b] -= shift;
        }
        for (now, before) in now.iter_mut().zip(before.iter()) {
            *now = outside(*now, *before);
        }
    }
}

/// Out of the ball and the table, with some friction.
fn outside(point: DVec3, before: DVec3) -> DVec3 {
    let mut point = point;
    let from_centre = point - BALL_CENTRE;
    let distance = from_centre.length();
    if distance < BALL_RADIUS - SINK {
        point = before.lerp(BALL_CENTRE + from_centre / distance * (BALL_RADIUS - SINK), SLIP);
    }
    let over_table = point.x * point.x + point.z * point.z < TABLE_RADIUS * TABLE_RADIUS;
    if over_table && point.y < TABLE_TOP - SINK {
        point = before.lerp(DVec3::new(point.x, TABLE_TOP - SINK, point.z), SLIP);
    }
    point
}
