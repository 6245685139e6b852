//! Boxes stacked on a floor of triangles. The contacts are the library's; the solver is this example's own: sequential impulses with
//! friction, warm-started from the last step by the names of the contacts.

use std::collections::HashMap;

use solid3d::glam::{DAffine3, DMat3, DQuat, DVec3};
use solid3d::query::{self, ContactOptions, Feature};
use solid3d::{Result, Shape};

const STEP: f64 = 1.0 / 60.0;
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
const FRICTION: f64 = 0.6;
const ITERATIONS: usize = 60;
/// How much of a depth beyond the slop is pushed out in a step.
const CORRECTION: f64 = 0.2;
const SLOP: f64 = 0.002;
/// Contacts are known this early, so that nothing falls through and resting contacts do not flicker.
const MARGIN: f64 = 0.02;

const EDGE: f64 = 1.0;
const BOXES: usize = 5;

/// A box of mass 1.
struct Body {
    position: DVec3,
    turn: DQuat,
    velocity: DVec3,
    spin: DVec3,
}

impl Body {
    /// Of a cube of mass 1 the inertia is the same about every axis.
    const INVERSE_INERTIA: f64 = 6.0 / (EDGE * EDGE);

    fn placement(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.turn, self.position)
    }

    fn velocity_at(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.spin.cross(arm)
    }

    fn push(&mut self, impulse: DVec3, arm: DVec3) {
        self.velocity += impulse;
        self.spin += Self::INVERSE_INERTIA * arm.cross(impulse);
    }

    fn advance(&mut self) {
        self.position += self.velocity * STEP;
        self.turn = (DQuat::from_scaled_axis(self.spin * STEP) * self.turn).normalize();
    }
}

/// What a contact is called from step to step.
type Name = (usize, Option<usize>, [u32; 2], [Feature; 2]);

/// A point where body `a` is pushed off body `b`, or off the floor.
struct Constraint {
    name: Name,
    a: usize,
    b: Option<usize>,
    arms: [DVec3; 2],
    /// The normal and two directions across it.
    axes: DMat3,
    depth: f64,
    /// So far in this step, along the axes.
    impulse: DVec3,
}

impl Constraint {
    /// How fast `a` moves relative to `b` along an axis.
    fn speed(&self, bodies: &[Body], axis: DVec3) -> f64 {
        let of_b = self.b.map_or(DVec3::ZERO, |b| bodies[b].velocity_at(self.arms[1]));
        (bodies[self.a].velocity_at(self.arms[0]) - of_b).dot(axis)
    }

    /// The mass that an impulse along an axis moves.
    fn mass(&self, axis: DVec3) -> f64 {
        let of = |arm: DVec3| 1.0 + Body::INVERSE_INERTIA * arm.cross(axis).length_squared();
        1.0 / (of(self.arms[0]) + self.b.map_or(0.0, |_| of(self.arms[1])))
    }

    fn apply(&self, bodies: &mut [Body], impulse: DVec3) {
        let impulse = self.axes * impulse;
        bodies[self.a].push(impulse, self.arms[0]);
        if let Some(b) = self.b {
            bodies[b].push(-impulse, self.arms[1]);
        }
    }

    /// One iteration: never pulls, and friction is at most a share of the push.
    fn solve(&mut self, bodies: &mut [Body]) {
        let before = self.impulse;
        // A gap may be closed in this step; a depth is pushed out slowly.
        let wanted = if self.depth < 0.0 {
            self.depth / STEP
        } else {
            CORRECTION * (self.depth - SLOP).max(0.0) / STEP
        };
        let normal = self.axes.x_axis;
        let push = (wanted - self.speed(bodies, normal)) * self.mass(normal);
        self.impulse.x = (before.x + push).max(0.0);
        self.apply(bodies, (self.impulse - before).with_y(0.0).with_z(0.0));

        let across = |axis: DVec3| -self.speed(bodies, axis) * self.mass(axis);
        let (y, z) = (across(self.axes.y_axis), across(self.axes.z_axis));
        let friction =
            DVec3::new(0.0, before.y + y, before.z + z).clamp_length_max(FRICTION * self.impulse.x);
        (self.impulse.y, self.impulse.z) = (friction.y, friction.z);
        self.apply(bodies, (self.impulse - before).with_x(0.0));
    }
}

/// The contacts of all pairs, with the impulses of the step before.
fn constraints(
    bodies: &[Body],
    cube: &Shape,
    floor: &Shape,
    before: &HashMap<Name, DVec3>,
) -> Result<Vec<Constraint>> {
    let options = ContactOptions { margin: MARGIN, max_points: Some(4) };
    let mut all = Vec::new();
    for a in 0..bodies.len() {
        for b in (0..a).map(Some).chain([None]) {
            let (other, at_other) = match b {
                Some(b) => (cube, bodies[b].placement()),
                None => (floor, DAffine3::IDENTITY),
            };
            for manifold in query::contacts(cube, &bodies[a].placement(), other, &at_other, &options)? {
                let (u, v) = manifold.normal.any_orthonormal_pair();
                for point in manifold.points {
                    let name = (a, b, point.primitives, point.features);
                    let arm_b = b.map_or(DVec3::ZERO, |b| point.point_on_b - bodies[b].position);
                    all.push(Constraint {
                        name,
                        a,
                        b,
                        arms: [point.point_on_a - bodies[a].position, arm_b],
                        axes: DMat3::from_cols(manifold.normal, u, v),
                        depth: point.depth,
                        impulse: before.get(&name).copied().unwrap_or_default(),
                    });
                }
            }
        }
    }
    Ok(all)
}

/// A floor of small triangles: no box stands on one alone.
fn floor() -> Result<Shape> {
    const SIDE: u32 = 24;
    let place = |i: u32| (f64::from(i) - 0.5 * f64::from(SIDE)) * 0.37;
    let vertices: Vec<DVec3> =
        (0..=SIDE).flat_map(|i| (0..=SIDE).map(move |j| DVec3::new(place(j), 0.0, place(i)))).collect();
    let corner = |i: u32, j: u32| i * (SIDE + 1) + j;
    let squares = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j)));
    let triangles: Vec<[u32; 3]> = squares
        .flat_map(|(i, j)| {
            let [p, q, r, s] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [[p, q, r], [p, r, s]]
        })
        .collect();
    Shape::mesh(vertices, triangles)
}

fn main() -> Result<()> {
    let (cube, floor) = (Shape::cuboid(DVec3::splat(EDGE))?, floor()?);
    // A little apart, each turned and shifted against the one below.
    let mut bodies: Vec<Body> = (0..BOXES)
        .map(|i| Body {
            position: DVec3::new(0.05 * (i % 2) as f64, (i as f64 + 0.5) * EDGE + 0.03 * (i + 1) as f64, 0.1),
            turn: DQuat::from_rotation_y(0.2 * i as f64),
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
        })
        .collect();
    let mut impulses = HashMap::new();
    for _ in 0..600 {
        bodies.iter_mut().for_each(|body| body.velocity += GRAVITY * STEP);
        let mut contacts = constraints(&bodies, &cube, &floor, &impulses)?;
        contacts.iter().for_each(|contact| contact.apply(&mut bodies, contact.impulse));
        for _ in 0..ITERATIONS {
            contacts.iter_mut().for_each(|contact| contact.solve(&mut bodies));
        }
        impulses = contacts.iter().map(|contact| (contact.name, contact.impulse)).collect();
        bodies.iter_mut().for_each(Body::advance);
    }
    let put = |i: usize| DVec3::new(0.05 * (i % 2) as f64, (i as f64 + 0.5) * EDGE, 0.1);
    for (i, body) in bodies.iter().enumerate() {
        let speed = body.velocity.length() + body.spin.length();
        println!(
            "box {i}: {:.4}, off its place by {:.4}, speed {speed:.1e}",
            body.position,
            body.position.distance(put(i))
        );
    }
    for (i, body) in bodies.iter().enumerate() {
        assert!((body.position.y - put(i).y).abs() < 0.02, "box {i} is at a height of {}", body.position.y);
        assert!(body.position.distance(put(i)) < 0.03, "box {i} slid to {}", body.position);
        assert!(body.velocity.length() + body.spin.length() < 1e-6, "box {i} still moves");
    }
    println!("{} contacts carry {BOXES} boxes", impulses.len());
    Ok(())
}
