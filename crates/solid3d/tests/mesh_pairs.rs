//! Meshes and complex shapes against each other and against convex shapes, judged by brute force.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::ops::ControlFlow;

use common::{
    Case, Soup, assert_rate, direction, in_cube, log_uniform, placement, random_complex, random_mesh,
    rescaled, shape_of, sheet, stretch, torus,
};
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use rand::Rng;
use rand::rngs::StdRng;
use solid_oracle::generate::{random_shape, seeded};
use solid_oracle::{
    Convex, Verdict, distance_bounds, hulls_intersect_exact, mesh_distance, mesh_pairs, verdict,
};
use solid3d::{Aabb, Error, Shape, World, glam, query};

impl Case {
    fn pair_of_meshes(rng: &mut StdRng) -> Case {
        let count = |rng: &mut StdRng| log_uniform(rng, 20.0, 2000.0) as u32;
        let (n, m) = (count(rng), count(rng));
        let (a, b) = (random_mesh(rng, n), random_mesh(rng, m));
        Case::new(rng, a, b, 1.7, 1e3)
    }

    /// Complex against complex or mesh, either first.
    fn pair_of_soups(rng: &mut StdRng) -> Case {
        let count = |rng: &mut StdRng| log_uniform(rng, 1.0, 60.0) as u32;
        let (n, m) = (count(rng), count(rng));
        let a = random_complex(rng, n);
        let b = if rng.random() { random_complex(rng, m) } else { random_mesh(rng, m.max(20)) };
        let (a, b) = if rng.random() { (a, b) } else { (b, a) };
        Case::new(rng, a, b, 1.5, 1e3)
    }

    fn meshes_meet(&self) -> bool {
        let (placed_a, placed_b) = (self.a.placed(&self.at_a), self.b.placed(&self.at_b));
        !mesh_pairs(&placed_a, &self.a.triangles(), &placed_b, &self.b.triangles()).is_empty()
    }

    fn mesh_distance(&self) -> f64 {
        let (placed_a, placed_b) = (self.a.placed(&self.at_a), self.b.placed(&self.at_b));
        mesh_distance(&placed_a, &self.a.triangles(), &placed_b, &self.b.triangles())
    }

    fn soups_meet(&self) -> bool {
        let (hulls_a, hulls_b) = (self.a.hulls(&self.at_a), self.b.hulls(&self.at_b));
        let boxed = |hulls: &[Vec<DVec3>]| -> Vec<Aabb> {
            hulls.iter().map(|points| Aabb::of_points(points.iter().copied())).collect()
        };
        let (boxes_a, boxes_b) = (boxed(&hulls_a), boxed(&hulls_b));
        (0..hulls_a.len()).any(|i| {
            (0..hulls_b.len())
                .any(|j| boxes_a[i].overlaps(&boxes_b[j]) && hulls_intersect_exact(&hulls_a[i], &hulls_b[j]))
        })
    }

    fn soup_distance(&self) -> f64 {
        let (hulls_a, hulls_b) = (self.a.hulls(&self.at_a), self.b.hulls(&self.at_b));
        let mut least = f64::INFINITY;
        for a in &hulls_a {
            let box_a = Aabb::of_points(a.iter().copied());
            for b in &hulls_b {
                let gap = box_a.gap(&Aabb::of_points(b.iter().copied())).length();
                if gap * (1.0 - 1e-14) < least {
                    least = least.min(distance_of(a, b));
                }
            }
        }
        least
    }

    fn shapes(&self) -> (Shape, Shape) {
        (self.a.shape(), self.b.shape())
    }
}

fn distance_of(a: &[DVec3], b: &[DVec3]) -> f64 {
    let hull = |points: &[DVec3]| Convex::Hull { points: points.to_vec() };
    distance_bounds(&hull(a), &DAffine3::IDENTITY, &hull(b), &DAffine3::IDENTITY).1
}

fn distance_to(soup: &Soup, at: &DAffine3, point: DVec3) -> f64 {
    if soup.is_mesh {
        return mesh_distance(&soup.placed(at), &soup.triangles(), &[point], &[[0, 0, 0]]);
    }
    soup.hulls(at).iter().map(|hull| distance_of(hull, &[point])).fold(f64::INFINITY, f64::min)
}

/// What the library says must be `meet` and `distance`, in both orders, with points that bear it out.
fn check(case: &Case, meet: bool, distance: f64, context: &str) {
    let (a, b) = case.shapes();
    let (at_a, at_b, size) = (&case.at_a, &case.at_b, case.size);
    assert_eq!(query::intersects(&a, at_a, &b, at_b).unwrap(), meet, "{context}");
    assert_eq!(query::intersects(&b, at_b, &a, at_a).unwrap(), meet, "{context}, swapped");
    if let Some(point) = query::common_point(&a, at_a, &b, at_b).unwrap() {
        let off = distance_to(&case.a, at_a, point).max(distance_to(&case.b, at_b, point));
        assert!(off <= 1e-9 * size, "{context}: the common point is off by {off:e} of {size:e}");
    }
    for swapped in [false, true] {
        let found = if swapped {
            query::distance(&b, at_b, &a, at_a).unwrap()
        } else {
            query::distance(&a, at_a, &b, at_b).unwrap()
        };
        let error = (found.distance - distance).abs();
        assert!(error <= 1e-9 * distance + 1e-12 * size, "{context}: {} for {distance}", found.distance);
        assert_eq!(found.distance == 0.0, meet, "{context}: {} for {distance}", found.distance);
        let (on_a, on_b) =
            if swapped { (found.point_on_b, found.point_on_a) } else { (found.point_on_a, found.point_on_b) };
        let off = distance_to(&case.a, at_a, on_a).max(distance_to(&case.b, at_b, on_b));
        assert!(off <= 1e-9 * size, "{context}: closest points off by {off:e} of {size:e}");
        assert!((on_a.distance(on_b) - distance).abs() <= 1e-9 * (distance + 1e-3 * size), "{context}");
    }
}

#[test]
fn meshes_agree_with_brute_force() {
    let seed = 1;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (1500, 0);
    for i in 0..cases {
        let case = Case::pair_of_meshes(&mut rng);
        let meet = case.meshes_meet();
        let distance = if meet { 0.0 } else { case.mesh_distance() };
        check(&case, meet, distance, &format!("case {i}"));
        hits += usize::from(meet);
    }
    assert_rate("mesh against mesh", hits, cases);
}

#[test]
fn complex_shapes_agree_with_brute_force() {
    let seed = 2;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (2000, 0);
    for i in 0..cases {
        let case = Case::pair_of_soups(&mut rng);
        let meet = case.soups_meet();
        let distance = if meet { 0.0 } else { case.soup_distance() };
        check(&case, meet, distance, &format!("case {i}"));
        hits += usize::from(meet);
    }
    assert_rate("complex shape against complex shape or mesh", hits, cases);
}

/// The verdicts on all primitives together: `None` when it is too close to call.
fn soup_meets_convex(
    case: &Soup,
    at: &DAffine3,
    convex: &Convex,
    at_convex: &DAffine3,
    size: f64,
) -> Option<bool> {
    let mut open = false;
    for primitive in &case.primitives {
        let points = primitive.iter().map(|&i| case.vertices[i as usize]).collect();
        match verdict(&Convex::Hull { points }, at, convex, at_convex) {
            Verdict::Intersecting { .. } => return Some(true),
            Verdict::Separated { gap } => open |= gap < 1e-11 * size,
            Verdict::Uncertain { .. } => open = true,
        }
    }
    if open { None } else { Some(false) }
}

#[test]
fn meshes_and_complex_shapes_against_every_convex_kind_agree_with_brute_force() {
    let seed = 3;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut open) = (3000, 0, 0);
    for i in 0..cases {
        let count = log_uniform(&mut rng, 1.0, 80.0) as u32;
        let soup =
            if rng.random() { random_mesh(&mut rng, count) } else { random_complex(&mut rng, count.min(40)) };
        let convex = random_shape(&mut rng, 1.0);
        let one = Soup::mesh(vec![DVec3::ZERO], vec![[0; 3]]);
        let Case { a: soup, at_a, at_b, size, b: _ } = Case::new(&mut rng, soup, one, 1.6, 1e3);
        // The convex shape has unit size, so its own placement scales it.
        let at_b = DAffine3 { matrix3: at_b.matrix3 * (size / 4.0), translation: at_b.translation };
        let size = size + stretch(&at_b);
        let away = direction(&mut rng) * rng.random_range(0.0..=0.5) * stretch(&at_b);
        let at_b = DAffine3 { translation: at_b.translation + away, ..at_b };
        let Some(meet) = soup_meets_convex(&soup, &at_a, &convex, &at_b, size) else {
            open += 1;
            continue;
        };
        hits += usize::from(meet);
        let context = format!("case {i}, {convex:?}");
        let (a, b) = (soup.shape(), shape_of(&convex));
        let found = query::common_point(&a, &at_a, &b, &at_b).unwrap();
        assert_eq!(found.is_some(), meet, "{context}");
        assert_eq!(query::intersects(&b, &at_b, &a, &at_a).unwrap(), meet, "{context}, swapped");
        if let Some(point) = found {
            let on_b = Convex::Hull { points: vec![point] };
            let off = distance_bounds(&convex, &at_b, &on_b, &DAffine3::IDENTITY).1;
            let off = off.max(distance_to(&soup, &at_a, point));
            assert!(off <= 1e-9 * size, "{context}: the common point is off by {off:e} of {size:e}");
        }
        let (mut low, mut high) = (f64::INFINITY, f64::INFINITY);
        if meet {
            (low, high) = (0.0, 0.0);
        } else {
            for primitive in &soup.primitives {
                let points = primitive.iter().map(|&i| soup.vertices[i as usize]).collect();
                let bounds = distance_bounds(&Convex::Hull { points }, &at_a, &convex, &at_b);
                (low, high) = (low.min(bounds.0), high.min(bounds.1));
            }
        }
        for found in [query::distance(&a, &at_a, &b, &at_b), query::distance(&b, &at_b, &a, &at_a)] {
            let distance = found.unwrap().distance;
            let error = (distance - high).max(low - distance);
            assert!(error <= 1e-9 * high + 1e-12 * size, "{context}: {distance} not in {low}..{high}");
        }
    }
    println!("too close to call: {open}");
    assert!(open * 20 <= cases);
    assert_rate("soup against convex", hits, cases);
}

/// Soups of a few primitives with corners of a small lattice: coplanar, touching and degenerate ones abound. Placements
/// that move lattice points exactly leave no excuse for a wrong answer.
#[test]
fn touching_coplanar_and_degenerate_soups_are_decided_exactly() {
    let seed = 4;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits, mut touches) = (6000, 0, 0);
    for i in 0..cases {
        let flat = rng.random_range(0..4) == 0;
        let a = lattice_soup(&mut rng, flat);
        let b = lattice_soup(&mut rng, flat);
        let (at_a, mut at_b) = (lattice_placement(&mut rng), lattice_placement(&mut rng));
        if flat {
            at_b.translation = at_a.translation + at_a.matrix3 * DVec3::new(1.0, 2.0, 0.0);
            at_b.matrix3 = at_a.matrix3;
        } else {
            let mut vertex = |soup: &Soup| soup.vertices[rng.random_range(0..soup.vertices.len())];
            let (on_a, on_b) = (at_a.transform_point3(vertex(&a)), at_b.matrix3 * vertex(&b));
            at_b.translation = on_a - on_b;
            if rng.random_range(0..5) < 2 {
                at_b.translation[rng.random_range(0..3)] += [-0.5, 0.5][rng.random_range(0..2)];
            }
        }
        let size = 20.0;
        let case = Case { a, at_a, b, at_b, size };
        let meet = case.soups_meet();
        hits += usize::from(meet);
        if meet {
            let apart: Vec<DVec3> =
                [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|v| [v, -v]).collect();
            let moved = |v: &DVec3| {
                let at_b = DAffine3 { translation: case.at_b.translation + *v / 64.0, ..case.at_b };
                Case { a: case.a.clone(), at_a: case.at_a, b: case.b.clone(), at_b, size }.soups_meet()
            };
            touches += usize::from(!apart.iter().all(moved));
        }
        let distance = if meet { 0.0 } else { case.soup_distance() };
        check(&case, meet, distance, &format!("case {i}: {:?} {:?} {:?} {:?}", case.a, at_a, case.b, at_b));
    }
    println!("{touches} of them only touch");
    assert_rate("lattice soups", hits, cases);
    assert!(touches * 4 > hits);
}

fn lattice_point(rng: &mut StdRng, flat: bool) -> DVec3 {
    let mut k = || f64::from(rng.random_range(0..=4));
    DVec3::new(k(), k(), if flat { 0.0 } else { k() })
}

fn lattice_soup(rng: &mut StdRng, flat: bool) -> Soup {
    let vertices: Vec<DVec3> = (0..rng.random_range(1..=8)).map(|_| lattice_point(rng, flat)).collect();
    let is_mesh = rng.random();
    let primitives = (0..rng.random_range(1..=3))
        .map(|_| {
            let corners = if is_mesh { 3 } else { rng.random_range(1..=6) };
            (0..corners).map(|_| rng.random_range(0..vertices.len() as u32)).collect()
        })
        .collect();
    Soup { vertices, primitives, is_mesh }
}

/// A signed permutation of the axes, powers of two along them, a lattice translation.
fn lattice_placement(rng: &mut StdRng) -> DAffine3 {
    let turn = rng.random_range(0..3);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut factor = || [-2.0, -1.0, 0.5, 1.0, 2.0, 4.0][rng.random_range(0..6)];
    let columns: [DVec3; 3] = std::array::from_fn(|i| axes[(i + turn) % 3] * factor());
    let shift = lattice_point(rng, false) - lattice_point(rng, false);
    DAffine3 { matrix3: DMat3::from_cols(columns[0], columns[1], columns[2]), translation: shift }
}

#[test]
fn shared_vertices_shared_edges_and_t_junctions_touch() {
    let one = |corners: [[f64; 3]; 3]| Shape::mesh(corners.map(DVec3::from), [[0, 1, 2]]).unwrap();
    let base = one([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
    let touching = [
        ("shared vertex", [[0.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [-1.0, -1.0, 2.0]]),
        ("shared edge", [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, -4.0, 1.0]]),
        ("shared edge, coplanar", [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, -4.0, 0.0]]),
        ("vertex on an edge", [[1.0, 0.0, 0.0], [2.0, -3.0, 1.0], [0.0, -3.0, 1.0]]),
        ("vertex on an edge, coplanar", [[1.0, 0.0, 0.0], [2.0, -3.0, 0.0], [0.0, -3.0, 0.0]]),
        ("vertex on the face", [[1.0, 1.0, 0.0], [1.0, 1.0, 3.0], [2.0, 1.0, 3.0]]),
        ("edge within the face", [[1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [1.0, 1.0, 3.0]]),
        ("inside, coplanar", [[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, 1.5, 0.0]]),
        ("the same", [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]),
        ("a point on the face", [[1.0, 1.0, 0.0]; 3]),
        ("a segment across the face", [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 0.0]]),
    ];
    let at = DAffine3::IDENTITY;
    for (what, corners) in touching {
        let other = one(corners);
        assert!(query::intersects(&base, &at, &other, &at).unwrap(), "{what}");
        assert!(query::intersects(&other, &at, &base, &at).unwrap(), "{what}");
        assert_eq!(query::distance(&base, &at, &other, &at).unwrap().distance, 0.0, "{what}");
    }
}

#[test]
fn identical_meshes_on_top_of_each_other_intersect_everywhere() {
    let seed = 5;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    for i in 0..300 {
        let count = rng.random_range(20..500);
        let soup = random_mesh(&mut rng, count);
        let at = placement(&mut rng, 10.0);
        let shape = soup.shape();
        let again = soup.shape();
        assert!(query::intersects(&shape, &at, &shape, &at).unwrap(), "case {i}");
        assert!(query::intersects(&shape, &at, &again, &at).unwrap(), "case {i}");
        assert_eq!(query::distance(&shape, &at, &again, &at).unwrap().distance, 0.0, "case {i}");
        let point = query::common_point(&shape, &at, &again, &at).unwrap().unwrap();
        assert!(distance_to(&soup, &at, point) < 1e-12 * 20.0);
    }
}

fn any_case(rng: &mut StdRng) -> Case {
    if rng.random() {
        let (n, m) = (rng.random_range(20..400), rng.random_range(20..400));
        let (a, b) = (random_mesh(rng, n), random_mesh(rng, m));
        Case::new(rng, a, b, 1.7, 1e3)
    } else {
        Case::pair_of_soups(rng)
    }
}

/// Law: the unit of length changes no answer.
#[test]
fn a_power_of_two_changes_no_bit() {
    let seed = 6;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (1500, 0);
    for i in 0..cases {
        let mut case = any_case(&mut rng);
        let convex = random_shape(&mut rng, case.size / 5.0);
        let (a, b) = case.shapes();
        let b = if i % 3 == 0 { shape_of(&convex) } else { b };
        let before = query::distance(&a, &case.at_a, &b, &case.at_b).unwrap();
        hits += usize::from(before.distance == 0.0);
        for exponent in [-300, -97, -1, 1, 41, 300] {
            let factor = f64::exp2(f64::from(exponent));
            let (at_a, at_b) = (rescaled(&case.at_a, factor), rescaled(&case.at_b, factor));
            let after = query::distance(&a, &at_a, &b, &at_b).unwrap();
            assert_eq!(
                after.distance.to_bits(),
                (before.distance * factor).to_bits(),
                "case {i} 2^{exponent}"
            );
            let met = query::intersects(&a, &at_a, &b, &at_b).unwrap();
            assert_eq!(
                met,
                query::intersects(&a, &case.at_a, &b, &case.at_b).unwrap(),
                "case {i} 2^{exponent}"
            );
        }
        // The same by scaling the vertices instead of the placements.
        if i % 3 != 0 {
            for exponent in [-300, 300] {
                let factor = f64::exp2(f64::from(exponent));
                let (a, b) = (case.a.clone().scaled(factor).shape(), case.b.clone().scaled(factor).shape());
                case.at_a.translation *= factor;
                case.at_b.translation *= factor;
                let after = query::distance(&a, &case.at_a, &b, &case.at_b).unwrap();
                assert_eq!(
                    after.distance.to_bits(),
                    (before.distance * factor).to_bits(),
                    "case {i} 2^{exponent}"
                );
                case.at_a.translation /= factor;
                case.at_b.translation /= factor;
            }
        }
    }
    assert_rate("power of two", hits, cases);
}

/// Law: placing both by the same rigid map changes no answer beyond the error.
#[test]
fn a_common_rigid_placement_changes_nothing() {
    let seed = 7;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (cases, mut hits) = (3000, 0);
    for i in 0..cases {
        let case = any_case(&mut rng);
        let (a, b) = case.shapes();
        let before = query::distance(&a, &case.at_a, &b, &case.at_b).unwrap().distance;
        let turn = DQuat::from_axis_angle(direction(&mut rng), rng.random_range(0.0..6.0));
        let away = rng.random_range(0.0..100.0);
        let rigid = DAffine3::from_rotation_translation(turn, away * case.size * in_cube(&mut rng));
        let (at_a, at_b) = (rigid * case.at_a, rigid * case.at_b);
        let after = query::distance(&a, &at_a, &b, &at_b).unwrap().distance;
        assert!((after - before).abs() <= 1e-12 * case.size, "case {i}: {before} became {after}");
        let met = query::intersects(&a, &at_a, &b, &at_b).unwrap();
        assert_eq!(met, before == 0.0, "case {i}");
        hits += usize::from(met);
    }
    assert_rate("rigid", hits, cases);
}

/// Asserts that both shapes give the same answers against another, whichever trees they have.
fn assert_same_answers(x: &Shape, y: &Shape, at: &DAffine3, other: &Shape, at_other: &DAffine3) -> bool {
    let of = |shape: &Shape| {
        let distance = query::distance(shape, at, other, at_other).unwrap().distance;
        (query::intersects(shape, at, other, at_other).unwrap(), distance)
    };
    let (of_x, of_y) = (of(x), of(y));
    assert_eq!(of_x.0, of_y.0);
    assert!((of_x.1 - of_y.1).abs() <= 1e-12 * (of_y.1 + 10.0), "{} {}", of_x.1, of_y.1);
    of_x.0
}

/// Law: a deformed shape answers as one built from its positions does, and its clones keep theirs.
#[test]
fn deformed_shapes_answer_as_fresh_ones() {
    let seed = 8;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut cases, mut hits) = (0, 0);
    for round in 0..240 {
        let count = rng.random_range(20..600);
        let soup = match round % 3 {
            0 => torus(24, 12, 0.4),
            1 => random_mesh(&mut rng, count),
            _ => random_complex(&mut rng, count / 10),
        };
        let original = soup.shape();
        let mut shape = original.clone();
        let mut kept: Vec<(Shape, Soup)> = vec![(original, soup.clone())];
        for step in 1..=6 {
            let mut now = soup.clone();
            // Small waves; at last a twist by many turns, after which the old tree is good for nothing.
            let twist = if step > 4 { 3.0 * f64::from(step) } else { 0.1 * f64::from(step) };
            for v in &mut now.vertices {
                *v = DQuat::from_rotation_y(twist * v.length()) * *v + 0.02 * in_cube(&mut rng);
            }
            shape.deform(&now.vertices).unwrap();
            kept.push((shape.clone(), now));
        }
        let probe = random_mesh(&mut rng, 60).shape();
        let ball = Shape::sphere(0.3).unwrap();
        for (kept, soup) in &kept {
            assert_eq!(kept.vertices().unwrap(), soup.vertices);
            let (at, mut at_other) = (placement(&mut rng, 1.0), placement(&mut rng, 1.0));
            at_other.translation = at.translation + direction(&mut rng) * rng.random_range(0.3..3.0);
            let fresh = soup.shape();
            for other in [&probe, &ball] {
                hits += usize::from(assert_same_answers(kept, &fresh, &at, other, &at_other));
                cases += 1;
            }
        }
    }
    assert_rate("deformed", hits, cases);
}

#[test]
fn a_refused_deformation_leaves_the_shape_as_it_was() {
    let soup = torus(12, 8, 0.4);
    let mut shape = soup.shape();
    let wrong = vec![DVec3::ZERO; soup.vertices.len() - 1];
    assert!(matches!(shape.deform(&wrong), Err(Error::PositionCount { count: 95, expected: 96 })));
    let mut wild = vec![DVec3::ONE; soup.vertices.len()];
    for bad in [f64::NAN, f64::INFINITY, -1.0001e100] {
        wild[7].y = bad;
        let error = shape.deform(&wild).unwrap_err();
        assert!(matches!(error, Error::Vertex { index: 7, .. }), "{error}");
        assert!(error.to_string().contains("vertex 7"), "{error}");
    }
    assert_eq!(shape.vertices().unwrap(), soup.vertices);
    let ball = Shape::sphere(0.1).unwrap();
    let at = DAffine3::from_translation(DVec3::new(0.9, 0.3, 0.2));
    let of = |shape: &Shape| query::distance(shape, &DAffine3::IDENTITY, &ball, &at).unwrap();
    assert_eq!(of(&shape), of(&soup.shape()));
    let mut convex = Shape::cuboid(DVec3::ONE).unwrap();
    assert!(matches!(convex.deform(&[]), Err(Error::NotDeformable { .. })));
}

/// One triangle hovers a hair's breadth above the shape, where a search looks first; the other touches it at a corner.
#[test]
fn a_touch_is_not_hidden_by_what_is_a_hair_apart() {
    let at = DVec3::new;
    let corners: Vec<DVec3> =
        (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| f64::from(2 * bit - 1)).into()).collect();
    let shapes = [Shape::convex_hull(&corners).unwrap(), Shape::cuboid([2.0, 2.0, 2.0]).unwrap()];
    for hair in [1e-14, 5e-14, 1e-13, 3e-13, 1e-9] {
        let near = 1.0 + hair;
        let vertices = [
            [at(-0.2, near, -0.2), at(0.2, near, -0.2), at(0.0, near, 0.2)],
            [at(0.9, 1.0, 0.9), at(3.0, 3.0, 3.0), at(3.0, 3.0, 0.5)],
        ];
        let mesh = Shape::mesh(vertices.concat(), [[0, 1, 2], [3, 4, 5]]).unwrap();
        for shape in &shapes {
            let here = DAffine3::IDENTITY;
            assert!(query::intersects(&mesh, &here, shape, &here).unwrap());
            assert_eq!(query::distance(&mesh, &here, shape, &here).unwrap().distance, 0.0, "{hair:e}");
        }
    }
}

/// A mesh is looked at by images of its triangles, unless it was deformed: to the same positions, for the same answers, beside every
/// kind of convex shape, and where the two nearly touch.
#[test]
fn a_deformation_to_the_same_positions_answers_alike() {
    let mut rng = seeded(98);
    let (mut hits, cases) = (0, 3000);
    for case in 0..cases {
        let count = log_uniform(&mut rng, 20.0, 500.0) as u32;
        let soup = random_mesh(&mut rng, count).scaled(log_uniform(&mut rng, 1e-6, 1e6));
        let shape = soup.shape();
        let mut deformed = shape.clone();
        deformed.deform(&soup.vertices).unwrap();
        let at = placement(&mut rng, 1.0);
        let extent = query::bounds(&shape, &at).unwrap().half_extents().max_element();
        let size = extent * log_uniform(&mut rng, 0.02, 0.5);
        let vertex = at.transform_point3(soup.vertices[rng.random_range(0..soup.vertices.len())]);
        let mut at_small = DAffine3::from_quat(DQuat::from_rotation_x(rng.random_range(0.0..3.0)));
        at_small.translation = vertex + direction(&mut rng) * size * rng.random_range(0.5..3.0);
        let mut small = match case % 4 {
            0 => Shape::sphere(size),
            1 => Shape::cuboid(DVec3::new(1.0, 2.0, 1.5) * size),
            2 => Shape::capsule(0.5 * size, size),
            _ => Shape::cone(size, size),
        }
        .unwrap();
        if case % 8 == 0 {
            let near = 1.0 + [1e-3, -1e-3, 1e-5, -1e-5, 1e-7, -1e-7, 1e-12][case / 8 % 7];
            let point = Shape::convex_hull(&[DVec3::ZERO]).unwrap();
            let gap = query::distance(&shape, &at, &point, &at_small).unwrap().distance;
            small = Shape::sphere((gap * near).max(1e-3 * size)).unwrap();
        }
        let ask = |mesh: &Shape| {
            let mut found = Vec::new();
            query::intersecting_primitives(mesh, &at, &small, &at_small, |i, _| {
                found.push(i);
                ControlFlow::Continue(())
            })
            .unwrap();
            let closest = query::distance(mesh, &at, &small, &at_small).unwrap();
            // Of what intersects it is any common point.
            let apart = closest.point_on_a.distance(closest.point_on_b);
            let rounding = 1e-11 * extent + 1e-15 * closest.point_on_a.abs().max_element();
            assert!((apart - closest.distance).abs() <= rounding, "case {case}: {closest:?}");
            let points = (closest.distance > 0.0).then_some([closest.point_on_a, closest.point_on_b]);
            let meet = query::intersects(mesh, &at, &small, &at_small).unwrap();
            let common = query::common_point(mesh, &at, &small, &at_small).unwrap();
            (meet, common, closest.distance, points, found)
        };
        let answers = ask(&shape);
        assert_eq!(answers, ask(&deformed), "case {case}");
        assert_eq!(answers.0, !answers.4.is_empty(), "case {case}");
        hits += usize::from(answers.0);
    }
    assert_rate("meshes and convex shapes", hits, cases);
}

/// What tells soups apart where boxes overlap is used until they are deformed: to the same positions, for the same answers, also where they
/// nearly touch.
#[test]
fn soups_deformed_to_the_same_positions_answer_alike() {
    let mut rng = seeded(141);
    let (mut hits, cases) = (0, 400);
    for case in 0..cases {
        let mut soup = || match case % 4 {
            0 => random_complex(&mut rng, 300),
            _ => random_mesh(&mut rng, 2000),
        };
        let (a, b) = (soup(), soup());
        let Case { a, at_a, b, mut at_b, .. } = Case::new(&mut rng, a, b, 4.0, 10.0);
        let shapes = [a.shape(), b.shape()];
        if case % 3 == 0 {
            // Beside each other by next to nothing.
            let closest = query::distance(&shapes[0], &at_a, &shapes[1], &at_b).unwrap();
            let nearer = 1.0 - [0.0, 1e-3, 1e-6, -1e-6, 1e-9, 1e-13][case / 3 % 6];
            at_b.translation += (closest.point_on_a - closest.point_on_b) * nearer;
        }
        let mut deformed = shapes.clone();
        for (shape, soup) in deformed.iter_mut().zip([&a, &b]) {
            shape.deform(&soup.vertices).unwrap();
        }
        let answers = [&shapes, &deformed].map(|[a, b]| {
            let mut pairs = Vec::new();
            query::intersecting_primitives(a, &at_a, b, &at_b, |i, j| {
                pairs.push([i, j]);
                ControlFlow::Continue(())
            })
            .unwrap();
            (pairs, query::common_point(a, &at_a, b, &at_b).unwrap())
        });
        assert_eq!(answers[0], answers[1], "case {case}");
        hits += usize::from(answers[0].1.is_some());
    }
    assert_rate("soups", hits, cases);
}

/// Of two surfaces that lie close above each other, boxes overlap all along, and few nodes are opened all the same; once they are deformed, more,
/// as nothing is made then that the next deformation would undo.
#[test]
fn surfaces_close_above_each_other_open_few_nodes() {
    let sheet = sheet(129, 129, [false, false], |u, v| {
        DVec3::new(u, v, 0.3 * (4.0 * u).sin() * (3.0 * v).cos() + u + 0.5 * v)
    });
    let (shape, mut deformed) = (sheet.shape(), sheet.shape());
    deformed.deform(&sheet.vertices).unwrap();
    let memory = || [&shape, &deformed].map(|shape| shape.memory());
    let before = memory();
    let tests = [&shape, &deformed].map(|shape| {
        let mut world = World::new();
        let ids = [0.0, 1e-2].map(|up| world.add(shape, DAffine3::from_translation(DVec3::Z * up)).unwrap());
        assert_eq!(world.test_pair(ids[0], ids[1]).unwrap(), None);
        world.statistics().box_tests
    });
    println!("{tests:?} boxes tested");
    assert!(tests[0] < 2000 && tests[1] > 8 * tests[0], "{tests:?}");
    // Of the two, one has slabs now, and they count.
    let [grown, grown_deformed] = [0, 1].map(|k| memory()[k] - before[k]);
    assert!(grown > grown_deformed, "{grown} and {grown_deformed} bytes more");
}

/// Which of two meshes comes first changes nothing about which of their triangles meet, even where they touch up to rounding.
#[test]
fn either_order_says_the_same() {
    let seed = 99;
    println!("seed {seed}");
    let mut rng = seeded(seed);
    let (mut hits, cases) = (0, 4000);
    for case in 0..cases {
        let count = log_uniform(&mut rng, 20.0, 200.0) as u32;
        let soups = [random_mesh(&mut rng, count), random_mesh(&mut rng, count)];
        let mut at = [placement(&mut rng, 10.0), placement(&mut rng, 10.0)];
        // They touch at a vertex that is the last of each along some way, up to rounding; or overlap, with two vertices in one place.
        let way = direction(&mut rng);
        let mut point = |k: usize, way: DVec3| {
            let placed = soups[k].placed(&at[k]);
            let last = placed.iter().copied().max_by(|p, q| p.dot(way).total_cmp(&q.dot(way))).unwrap();
            if case % 4 == 0 { placed[rng.random_range(0..placed.len())] } else { last }
        };
        let (on_a, on_b) = (point(0, way), point(1, -way));
        at[1].translation += on_a - on_b;
        let [a, b] = [soups[0].shape(), soups[1].shape()];
        let pairs = |x: usize, y: usize| {
            let (shapes, mut found) = ([&a, &b], Vec::new());
            query::intersecting_primitives(shapes[x], &at[x], shapes[y], &at[y], |i, j| {
                found.push(if x == 0 { [i, j] } else { [j, i] });
                ControlFlow::Continue(())
            })
            .unwrap();
            found.sort_unstable();
            let meet = query::intersects(shapes[x], &at[x], shapes[y], &at[y]).unwrap();
            assert_eq!(meet, !found.is_empty(), "case {case}");
            found
        };
        let found = pairs(0, 1);
        assert_eq!(found, pairs(1, 0), "case {case}");
        hits += usize::from(!found.is_empty());
    }
    assert_rate("pairs that nearly touch", hits, cases);
}

/// Law: what is as wide as a terrain, tilted beside it, is told apart from it, or how far it is, by few boxes: of boxes along the axes of the
/// terrain many overlap that around it.
#[test]
fn what_is_as_wide_as_a_terrain_opens_few_nodes() {
    const FRAMES: u32 = 50;
    const SLOPE: f64 = 1.2;
    let terrain = sheet(129, 129, [false, false], |u, v| {
        let bumps = (31.0 * u).sin() * (23.0 * v).cos() + 0.5 * (67.0 * u + 41.0 * v).sin();
        DVec3::new(2.0 * u - 1.0, 0.03 * bumps + SLOPE * u, 2.0 * v - 1.0)
    });
    let normal = DVec3::new(-SLOPE, 2.0, 0.0).normalize();
    let corners = [0u32, 1, 2, 3, 4, 5, 6, 7]
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5);
    let hull = Shape::convex_hull(&corners);
    for (shape, most) in [(Shape::cuboid([1.0; 3]), [60, 50]), (hull, [60, 100])] {
        let mut world = World::new();
        let below = world.add(&terrain.shape(), DAffine3::IDENTITY).unwrap();
        let above = world.add(&shape.unwrap(), DAffine3::IDENTITY).unwrap();
        world.set_clearance(0.5).unwrap();
        let mut opened = [0; 2];
        for frame in 0..FRAMES {
            let turn = DQuat::from_euler(EulerRot::YZX, 0.12 * f64::from(frame), 0.9, 0.4);
            let lowest = corners.map(|corner| normal.dot(turn * corner)).into_iter().fold(0.0, f64::min);
            let up = DVec3::Y * 0.5 * SLOPE + normal * (0.05 - lowest);
            world.set_placement(above, DAffine3::from_rotation_translation(turn, up)).unwrap();
            let before = world.statistics().box_tests;
            assert_eq!(world.test_pair(below, above).unwrap(), None);
            let between = world.statistics().box_tests;
            assert_eq!(world.near().len(), 1);
            opened[0] += between - before;
            opened[1] += world.statistics().box_tests - between;
        }
        let mean = opened.map(|opened| opened / u64::from(FRAMES));
        println!("{mean:?} nodes, at most {most:?}");
        assert!(mean[0] < most[0] && mean[1] < most[1], "{mean:?}");
    }
}
