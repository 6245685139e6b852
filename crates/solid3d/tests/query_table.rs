//! The tables of `docs/queries.md`: every public query, asked of every pair of kinds, or of every kind.
//!
//! The page is what the queries answer: a difference fails. `SOLID_WRITE_TABLE=1 cargo test -p solid3d --test query_table` writes
//! it anew. A query more is a line more in [`OF_TWO`] or [`OF_ONE`].
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use common::{at, cube};
use glam::{DAffine3, DVec3};
use solid3d::query::{self, ContactOptions, ImpactOptions, PairCache, Ray, RayOptions};
use solid3d::{ComplexShapeBuilder, Error, Result, Shape, ShapeKind, glam};

/// A shape at a place.
type Placed<'a> = (&'a Shape, &'a DAffine3);
/// A query of two placed shapes, with its answer in a word.
type OfTwo = (&'static str, fn(Placed, Placed) -> String);
/// A query of one placed shape and a point or ray from there, with its answer in a word.
type OfOne = (&'static str, fn(Placed, DVec3) -> String);

const OF_TWO: &[OfTwo] = &[
    ("intersects", |a, b| said(query::intersects(a.0, a.1, b.0, b.1), yes_or_no)),
    ("common_point", |a, b| said(query::common_point(a.0, a.1, b.0, b.1), |p| some(p, "point"))),
    ("separating_axis", |a, b| said(query::separating_axis(a.0, a.1, b.0, b.1), |v| some(v, "axis"))),
    ("distance", |a, b| said(query::distance(a.0, a.1, b.0, b.1), |d| figure(d.distance))),
    ("distance_within 1", |a, b| {
        said(query::distance_within(a.0, a.1, b.0, b.1, 1.0), |d| some_figure(d.map(|d| d.distance)))
    }),
    ("penetration", |a, b| said(query::penetration(a.0, a.1, b.0, b.1), |p| some_figure(p.map(|p| p.depth)))),
    ("intersection_curve", |a, b| {
        said(query::intersection_curve(a.0, a.1, b.0, b.1), |c| match c.polylines.len() {
            0 => "empty".to_owned(),
            _ => "curve".to_owned(),
        })
    }),
    ("contacts", |a, b| {
        said(query::contacts(a.0, a.1, b.0, b.1, &ContactOptions::default()), |c| match c.len() {
            0 => "none".to_owned(),
            _ => "contacts".to_owned(),
        })
    }),
    ("intersecting_primitives", |a, b| {
        let mut count = 0;
        let found = |_, _| {
            count += 1;
            ControlFlow::Continue(())
        };
        let asked = query::intersecting_primitives(a.0, a.1, b.0, b.1, found);
        said(asked, |()| format!("{count} pairs"))
    }),
    ("PairCache::distance", |a, b| said(PairCache::new(a.0, b.0).distance(a.1, b.1), |d| figure(d.distance))),
    ("cast_shape", |a, b| {
        let cast = query::cast_shape(a.0, a.1, DVec3::X * 4.0, b.0, b.1, DVec3::ZERO);
        said(cast, |c| some_figure(c.map(|c| c.time)))
    }),
    ("time_of_impact", |a, b| {
        let to = at(4.0, 0.0, 0.0) * *a.1 * DAffine3::from_rotation_z(1.0);
        let impact = query::time_of_impact(a.0, a.1, &to, b.0, b.1, b.1, &ImpactOptions::default());
        said(impact, |i| some_figure(i.map(|i| i.time)))
    }),
];

const OF_ONE: &[OfOne] = &[
    ("bounds", |a, _| said(query::bounds(a.0, a.1), |b| format!("{} wide", figure(b.max.x - b.min.x)))),
    ("contains_point", |a, p| said(query::contains_point(a.0, a.1, p), yes_or_no)),
    ("closest_point", |a, p| said(query::closest_point(a.0, a.1, p), |c| figure(c.distance))),
    ("signed_distance", |a, p| said(query::signed_distance(a.0, a.1, p), |s| figure(s.distance))),
    ("winding_number", |a, p| said(query::winding_number(a.0, a.1, p), figure)),
    ("cast_ray", |a, p| {
        said(query::cast_ray(a.0, a.1, &ray(p), &RayOptions::default()), |hit| {
            some_figure(hit.map(|hit| hit.t))
        })
    }),
    ("cast_ray_all", |a, p| {
        said(query::cast_ray_all(a.0, a.1, &ray(p), &RayOptions::default()), |hits| {
            format!("{} hits", hits.len())
        })
    }),
    ("ray_meets", |a, p| said(query::ray_meets(a.0, a.1, &ray(p), &RayOptions::default()), yes_or_no)),
];

/// In a direction that meets no edge of the shapes.
fn ray(from: DVec3) -> Ray {
    Ray::new(from, DVec3::new(1.0, -0.015625, -0.0078125))
}

fn said<T>(answer: Result<T>, in_a_word: impl FnOnce(T) -> String) -> String {
    match answer {
        Ok(answer) => in_a_word(answer),
        Err(error) => format!("`{}`", name(&error)),
    }
}

/// The variant of an error.
fn name(error: &Error) -> String {
    format!("{error:?}").chars().take_while(|c| c.is_alphanumeric()).collect()
}

fn yes_or_no(answer: bool) -> String {
    if answer { "yes" } else { "no" }.to_owned()
}

fn some<T>(answer: Option<T>, word: &str) -> String {
    answer.map_or("none".to_owned(), |_| word.to_owned())
}

fn some_figure(answer: Option<f64>) -> String {
    answer.map_or("none".to_owned(), figure)
}

fn figure(x: f64) -> String {
    let text = format!("{x:.2}");
    text.strip_prefix("-").filter(|rest| rest.trim_matches(['0', '.']).is_empty()).unwrap_or(&text).to_owned()
}

/// A shape of each kind, all about 2 in size; a mesh both as a surface and as a solid.
fn shapes() -> Vec<(String, Shape)> {
    let cube = cube(1.0);
    let (mesh, corners) = (cube.shape(), cube.vertices);
    let of = |kind: ShapeKind| match kind {
        ShapeKind::Sphere => Shape::sphere(1.0),
        ShapeKind::Cuboid => Shape::cuboid([2.0, 2.0, 2.0]),
        ShapeKind::Cone => Shape::cone(1.0, 2.0),
        ShapeKind::Cylinder => Shape::cylinder(1.0, 2.0),
        ShapeKind::Capsule => Shape::capsule(0.75, 1.0),
        ShapeKind::ConvexHull => Shape::convex_hull(&corners[1..]),
        ShapeKind::Mesh => Ok(mesh.clone()),
        ShapeKind::Complex => {
            ComplexShapeBuilder::new(corners.clone()).tetrahedron([0, 3, 5, 6]).segment([1, 6]).build()
        }
    };
    let mut shapes: Vec<_> =
        ShapeKind::ALL.iter().map(|&kind| (kind.to_string(), of(kind).unwrap())).collect();
    shapes.push(("solid mesh".to_owned(), mesh.into_solid().unwrap()));
    shapes
}

/// A table of the answers in two cases, each row a case of `names`.
fn table(
    first: &[&str],
    queries: &[&str],
    rows: impl Iterator<Item = (Vec<String>, Vec<[String; 2]>)>,
) -> String {
    let mut text = String::new();
    writeln!(text, "| {} | {} |", first.join(" | "), queries.join(" | ")).unwrap();
    writeln!(text, "|{}", "---|".repeat(first.len() + queries.len())).unwrap();
    for (names, cells) in rows {
        let cell = |[one, other]: &[String; 2]| match one == other {
            true if one.starts_with('`') => one.clone(),
            _ => format!("{one}, {other}"),
        };
        let cells: Vec<String> = cells.iter().map(cell).collect();
        writeln!(text, "| {} | {} |", names.join(" | "), cells.join(" | ")).unwrap();
    }
    text
}

fn page() -> String {
    let shapes = shapes();
    // So that surfaces cross, wherever the shapes have theirs; and apart by no more than the bound of `distance_within`, or not.
    let (here, crossing, apart) = (DAffine3::IDENTITY, at(0.75, 0.375, 0.25), at(2.5, 0.375, 0.25));
    let pairs = (0..shapes.len()).flat_map(|i| (i..shapes.len()).map(move |j| (i, j)));
    let of_two = pairs.map(|(i, j)| {
        let (a, b) = (&shapes[i], &shapes[j]);
        let cells =
            OF_TWO.iter().map(|(_, ask)| [&crossing, &apart].map(|there| ask((&a.1, &here), (&b.1, there))));
        (vec![a.0.clone(), b.0.clone()], cells.collect())
    });
    let of_one = shapes.iter().map(|(kind, shape)| {
        let points = [DVec3::new(0.125, 0.0625, 0.25), DVec3::new(-3.0, 0.0625, 0.25)];
        let cells = OF_ONE.iter().map(|(_, ask)| points.map(|point| ask((shape, &here), point)));
        (vec![kind.clone()], cells.collect())
    });
    let names_of_two: Vec<&str> = OF_TWO.iter().map(|(name, _)| *name).collect();
    let names_of_one: Vec<&str> = OF_ONE.iter().map(|(name, _)| *name).collect();
    format!(
        "# Every query, asked of every kind\n\n\
         Written by the test `crates/solid3d/tests/query_table.rs`, which asks each and fails when an answer is another than here:\n\
         `SOLID_WRITE_TABLE=1 cargo test -p solid3d --test query_table` writes the page anew.\n\n\
         Shapes are about 2 in size. A cell has two answers, or one error for both. An error is named by its variant of `Error`; `none`\n\
         is the answer that there is nothing. A mesh is a surface, and so is asked for twice: also as a solid.\n\n\
         ## Of two shapes\n\n\
         First of two whose surfaces cross, then of two that are apart. `distance_within` has the bound 1; `cast_shape` moves the first\n\
         shape by 4 towards the second, `time_of_impact` also turns it by one radian, and their answer is the time from 0 to 1. Each pair is asked\n\
         for both ways round, with the same answers. A query that takes a `PairCache`, or that lets shapes deform, has the answers of the\n\
         one without.\n\n\
         {}\n## Of one shape\n\n\
         First at a point in the middle, then at one outside on the left; rays go to the right from there.\n\n{}",
        table(&["a", "b"], &names_of_two, of_two),
        table(&["kind"], &names_of_one, of_one),
    )
}

#[test]
fn the_page_of_queries_is_what_they_answer() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/queries.md");
    let page = page();
    if std::env::var_os("SOLID_WRITE_TABLE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
    for (number, (is, should)) in (1..).zip(written.lines().zip(page.lines())) {
        assert_eq!(is, should, "docs/queries.md:{number}");
    }
    assert_eq!(written, page);
}

/// Swapping the shapes changes no answer, but for what names one of them.
#[test]
fn every_pair_answers_the_same_both_ways_round() {
    let shapes = shapes();
    let there = [at(0.75, 0.375, 0.25), at(2.5, 0.375, 0.25)];
    let directed = ["cast_shape", "time_of_impact"];
    let mut asked = 0;
    for (a, b) in shapes.iter().flat_map(|a| shapes.iter().map(move |b| (a, b))) {
        for (name, ask) in OF_TWO.iter().filter(|(name, _)| !directed.contains(name)) {
            for there in &there {
                let (one, other) = (
                    ask((&a.1, &DAffine3::IDENTITY), (&b.1, there)),
                    ask((&b.1, there), (&a.1, &DAffine3::IDENTITY)),
                );
                assert_eq!(one, other, "{name} of {} and {}", a.0, b.0);
                asked += 1;
            }
        }
    }
    assert_eq!(asked, shapes.len() * shapes.len() * there.len() * (OF_TWO.len() - directed.len()));
}

/// What is said of every pair, in whichever kinds: they intersect where they cross, have a depth there, and a distance elsewhere.
#[test]
fn no_pair_is_without_an_answer() {
    for line in page().lines().filter(|line| line.starts_with("| ")).skip(1) {
        let cells: Vec<&str> = line.trim_matches(['|', ' ']).split(" | ").collect();
        if cells.len() != 2 + OF_TWO.len() {
            break;
        }
        assert_eq!(&cells[2..5], ["yes, no", "point, none", "none, axis"], "{line}");
        assert!(cells[5].starts_with("0.00, ") && !cells[5].ends_with(" 0.00"), "{line}");
        assert!(!cells[7].starts_with("none") && cells[7].ends_with(", none"), "{line}");
        assert_eq!(cells[9], "contacts, none", "{line}");
        assert!(cells[11].starts_with("0.00, ") && cells[11] == cells[5], "{line}");
        for cast in &cells[12..14] {
            assert!(!cast.contains("none") && cast.starts_with("0.00, "), "{line}");
        }
    }
}
