//! Two placements that turn and scale alike: what a first hit is sought with follows from them at once, in the directions of the complex shape. The
//! inverses and maps that other placements need take as long as the walk down the tree.
//!
//! Numbers come from where they are, or in registers: what a call writes is read in other pieces, and waited for.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::gjk::Balls;
use solid_convex::simd::each;
use solid_convex::similarity::{SKEW_MAX, plain_squares};
use solid_convex::{Support, unit_scale};

use super::super::closed_form::{to_body, to_world};
use super::super::glance::{Body, Glance};
use super::super::row::Cube;
use super::super::table::{PlacedComplex, PlacedConvex};
use super::CLEARLY_APART;
use super::shadow::ROUND;
use super::sight::Sight;
use crate::bounds::Aabb;
use crate::tree::{Around, Normal};

/// How far a point of one shape may be from where it is computed in the space of the other, relative to the size of the data: the transpose is the
/// inverse but for some three times [`SKEW_MAX`]; roundings are a tenth of that.
const ERROR: f64 = 4.0 * SKEW_MAX;

/// By this part, lengths may be longer than the scale of a placement tells, or shorter.
const STRETCH: f64 = 2.0 * SKEW_MAX;

/// The sight of a first hit, where both placements turn and scale alike; `None` where they do not, and of a box that is too thin.
#[inline(always)]
pub(super) fn sight<S: Simd>(simd: S, complex: PlacedComplex, convex: PlacedConvex) -> Option<Sight> {
    let squares = plain_squares(simd, [complex.1, convex.1])?;
    let body = Outline::of(convex.0)?;
    let tree = complex.0.tree();
    let alike = Alike::new(tree.normal(), [complex.1, convex.1], squares, body.reach());
    let glance = alike.glance(&body, tree.normal())?;
    let (box_around, around) = alike.around(&body, convex.0);
    let metric = tree.folded_alike((1.0 - STRETCH) * alike.of_complex);
    Some(Sight {
        scale: alike.scale,
        query: tree.near_query(simd, box_around, around, metric),
        glance: Some(glance),
    })
}

/// What is known of a convex shape but its support mapping.
enum Outline {
    /// All within a radius of a segment on the axis y, about the origin; of a ball, of no length.
    Round {
        half_height: f64,
        radius: f64,
    },
    /// A box along the axes, about the origin: half of its edges, and half of its diagonal.
    Box {
        half: DVec3,
        length: f64,
    },
    Other(Balls),
}

impl Outline {
    #[inline(always)]
    fn of(shape: &dyn Support) -> Option<Outline> {
        let radius = shape.core_radius();
        if radius > 0.0 {
            return Some(Outline::Round { half_height: shape.core_support(DVec3::Y).y, radius });
        }
        if let Some([x, y, z]) = shape.half_edges() {
            let half = DVec3::new(x.x, y.y, z.z);
            return Some(Outline::Box { half, length: half.length() });
        }
        let balls = match shape.as_polytope() {
            Some(polytope) => polytope.balls(),
            None => shape.balls(),
        };
        balls.map(Outline::Other)
    }

    /// How far all of it is from the origin, at most.
    #[inline(always)]
    fn reach(&self) -> f64 {
        match self {
            Outline::Round { half_height, radius } => half_height + radius,
            Outline::Box { length, .. } => *length,
            Outline::Other(Balls { outer, .. }) => outer.center.abs().element_sum() + outer.radius,
        }
    }
}

/// A complex and a convex shape, so placed.
struct Alike<'s> {
    turn_complex: &'s DMat3,
    turn_convex: &'s DMat3,
    /// The square of the scale of the convex shape, and the inverse of that of the complex one.
    square_convex: f64,
    inverse_square: f64,
    /// The origin of the convex shape from that of the complex one, in the world, and where it is in the space of that.
    offset: DVec3,
    origin: DVec3,
    /// World lengths times this are lengths of the common frame.
    scale: f64,
    /// What a length in the space of each is there.
    of_complex: f64,
    of_convex: f64,
    /// How far points may be from where they are computed, there, and in the space of the complex shape.
    slack: f64,
    slack_in_complex: f64,
}

impl<'s> Alike<'s> {
    #[inline(always)]
    fn new(
        Normal { origin, scale: half, .. }: &Normal,
        [at_complex, at_convex]: [&'s DAffine3; 2],
        [square_complex, square_convex]: [f64; 2],
        reach: f64,
    ) -> Self {
        // Nothing waits for a root and a division one after the other.
        let inverse_square = square_complex.recip();
        let offset = at_convex.translation - at_complex.translation;
        let [of_complex, of_convex] = [square_complex.sqrt(), square_convex.sqrt()];
        // A tree is within twice this of its origin.
        let size = of_complex * (origin.abs().element_sum() + 2.0 * half)
            + of_convex * reach
            + offset.abs().element_sum();
        let scale = unit_scale(size);
        Alike {
            turn_complex: &at_complex.matrix3,
            turn_convex: &at_convex.matrix3,
            square_convex,
            inverse_square,
            offset,
            origin: to_body(&at_complex.matrix3, offset) * inverse_square,
            scale,
            of_complex: of_complex * scale,
            of_convex: of_convex * scale,
            slack: ERROR * size * scale,
            slack_in_complex: ERROR * size * (of_complex * inverse_square),
        }
    }

    /// A way in the space of the convex shape in that of the complex one.
    #[inline(always)]
    fn turned(&self, way: DVec3) -> DVec3 {
        to_body(self.turn_complex, to_world(self.turn_convex, way)) * self.inverse_square
    }

    /// Where the convex shape is, as [`Shadow::around`](super::shadow::Shadow::around) says.
    #[inline(always)]
    fn around(&self, body: &Outline, shape: &dyn Support) -> (Option<Aabb>, Around) {
        let within = {
            #[inline(always)]
            |middle: DVec3, half: DVec3, radius: f64| {
                let reach = half + self.slack_in_complex;
                Around { bounds: Aabb::new(middle - reach, middle + reach), radius }
            }
        };
        let radius_around = {
            #[inline(always)]
            |radius: f64| (1.0 + STRETCH) * radius * self.of_convex
        };
        let (is_round, ball) = match body {
            Outline::Round { half_height, radius } => {
                let half = match *half_height {
                    0.0 => DVec3::ZERO,
                    y => to_body(self.turn_complex, self.turn_convex.y_axis * (y * self.inverse_square)),
                };
                return (None, within(self.origin, half.abs(), radius_around(*radius)));
            }
            Outline::Box { half, length } => (
                half.min_element() >= ROUND * length,
                within(self.origin, DVec3::ZERO, radius_around(*length) + CLEARLY_APART),
            ),
            Outline::Other(Balls { inner, outer }) => {
                let middle = self.origin + self.turned(outer.center);
                (
                    inner.radius >= ROUND * outer.radius,
                    within(middle, DVec3::ZERO, radius_around(outer.radius) + CLEARLY_APART),
                )
            }
        };
        if is_round {
            return (None, ball);
        }
        let DMat3 { x_axis, y_axis, z_axis } = self.turn_convex;
        let [x, y, z] = each(
            [x_axis, y_axis, z_axis],
            #[inline(always)]
            |axis| to_body(self.turn_complex, *axis) * self.inverse_square,
        );
        let [min, max] = shape.image_bounds(&DMat3::from_cols(x, y, z));
        let middle = self.origin + 0.5 * (min + max);
        (Some(within(middle, 0.5 * (max - min), 0.0).bounds), ball)
    }

    /// What looks at images of triangles: in the space in which a box is a cube, or in the common frame turned into the directions of the complex shape.
    #[inline(always)]
    fn glance(&self, body: &Outline, normal: &Normal) -> Option<Glance> {
        let (body, middle) = match body {
            Outline::Box { half, .. } => {
                let cube = self.cube(*half)?;
                return Some(Glance::of(Body::cube(&cube), DVec3::ZERO, &cube.map, normal));
            }
            Outline::Round { half_height, radius } => {
                let radii = [*radius, radius + half_height];
                (Body::between_radii(radii, self.of_convex, CLEARLY_APART), self.origin)
            }
            Outline::Other(balls) => (
                Body::between(balls, self.of_convex, CLEARLY_APART),
                self.origin + self.turned(balls.inner.center),
            ),
        };
        Some(Glance::upright(body, middle * self.of_complex, self.of_complex, normal, self.slack))
    }

    /// The cube that a box is in a space of its own.
    #[inline(always)]
    fn cube(&self, half: DVec3) -> Option<Cube> {
        let DMat3 { x_axis, y_axis, z_axis } = self.turn_convex;
        let inverse = (self.square_convex * half).recip();
        let rows = [*x_axis * inverse.x, *y_axis * inverse.y, *z_axis * inverse.z];
        let [x, y, z] = each(
            rows,
            #[inline(always)]
            |row| to_body(self.turn_complex, row),
        );
        let matrix3 =
            DMat3::from_cols(DVec3::new(x.x, y.x, z.x), DVec3::new(x.y, y.y, z.y), DVec3::new(x.z, y.z, z.z));
        let translation = -to_body(&DMat3::from_cols(rows[0], rows[1], rows[2]), self.offset);
        let growth = (1.0 + STRETCH) / (self.of_convex * half.min_element());
        Cube::new(DAffine3 { matrix3, translation }, growth, CLEARLY_APART, self.slack * growth)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use rand::Rng;
    use solid_convex::simd::dispatch;
    use solid_convex::{Cylinder, Polytope, gjk};
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::meeting::walk;
    use super::*;
    use crate::pair::Scratch;
    use crate::pair::gaps::scenes::{convex, triangles, turned};

    /// Law: some triangle is found to meet the shape where GJK says so of one, and none else: under all similarities, of all sizes, near and far, and nearly
    /// touching. Most is told without a look at single triangles.
    #[test]
    fn what_is_placed_alike_is_met_as_gjk_says() {
        let seed = 97;
        println!("seed {seed}");
        let mut rng = seeded(seed);
        let (mut asked, mut meet, mut glances, mut led) = (0, 0, 0, 0);
        for case in 0..6000 {
            let size = 10f64.powi(rng.random_range(-20..20));
            let scale = 10f64.powi(rng.random_range(-5..5)) * if case % 4 == 0 { -1.0 } else { 1.0 };
            let far = if case % 7 == 0 { 1e4 * size * in_cube(&mut rng) } else { DVec3::ZERO };
            let most = if case % 8 == 0 { 1500 } else { 60 };
            let complex = triangles(&mut rng, case, most, size, far);
            led += u32::from(complex.images().is_some_and(|images| images.signposts().is_some()));
            let [turn, turn_body] = [turned(&mut rng, 1), turned(&mut rng, 1)].map(|(_, at)| at.matrix3);
            let at_complex =
                DAffine3 { matrix3: turn * scale, translation: in_cube(&mut rng) * size * scale };
            let half = size * scale.abs() * 10f64.powf(rng.random_range(-2.0..0.0));
            let body: Box<dyn Support> = match case % 9 {
                7 => Box::new(Cylinder::new(half, half).unwrap()),
                8 => Box::new(Polytope::new(vec![DVec3::splat(half)]).unwrap()),
                kind => convex(&mut rng, kind, half),
            };
            let vertex = complex.vertices()[rng.random_range(0..complex.vertices().len())];
            let mut at_body = DAffine3 {
                matrix3: turn_body * 10f64.powi(case as i32 % 3 - 1),
                translation: at_complex.transform_point3(vertex)
                    + 0.3 * size * scale.abs() * in_cube(&mut rng),
            };
            let shape = &*body;
            let distance = |primitive: u32, at: &DAffine3| {
                gjk::closest_points(&complex.primitive_hull(primitive), &at_complex, shape, at)
            };
            if case % 5 == 0 {
                // To where it nearly touches, or just does not.
                let gjk::Closest { distance, points } = distance(0, &at_body);
                let way = at_complex.transform_point3(points.on_a) - at_body.transform_point3(points.on_b);
                let near = 1.0 + [1e-3, -1e-3, 1e-6, -1e-6, 1e-9, -1e-9][case / 5 % 6];
                at_body.translation += if distance > 0.0 { way * near } else { DVec3::ZERO };
            }
            let (placed, convex) = ((&complex, &at_complex), (shape, &at_body));
            let Some(sight) = dispatch!(simd => sight(simd, placed, convex)) else { continue };
            let (mut details, mut scratch) = (None, Scratch::default());
            let mut found = |primitive: u32, _| {
                assert_eq!(
                    distance(primitive, &at_body).distance,
                    0.0,
                    "case {case}: {primitive} does not meet"
                );
                ControlFlow::Break(())
            };
            let is_met = walk(placed, convex, &sight, &mut details, &mut scratch, &mut found).is_break();
            let truth = (0..complex.primitive_count() as u32).any(|i| distance(i, &at_body).distance == 0.0);
            assert_eq!(is_met, truth, "case {case}");
            asked += 1;
            meet += u32::from(is_met);
            glances += u32::from(details.is_none());
        }
        println!("{meet} of {asked} meet, {glances} at a glance, {led} with signposts");
        assert!(asked > 5500 && (asked * 3 / 10..asked * 7 / 10).contains(&meet) && glances > asked / 2);
        assert!(led > 200);
    }
}
