//! What the thesis sets aside without a measurement: a common point by linear programming (section 4.1), and polyhedra as BSP trees
//! (section 5.1.3).

use anyhow::Result;
use serde::Serialize;
use solid3d::glam::{DAffine3, DVec3};

use super::chart::{Labels, Series, lines_of_ratios};
use super::clock::seconds;
use super::output::write_csv;
use super::random::stream;
use super::{Claim, Kind, Report, Settings};
use crate::comparators::bsp::{BspTree, Merge};
use crate::comparators::convex::{
    BspTrees, ConvexTest, IsaGjk, LinCanny, LinearProgram, Memory, Pair, Polytope,
};
use crate::comparators::tree::{AlignedBox, Sat, Traversal, Tree};
use crate::inputs::{Mesh, PairPose, Polyhedron, pairs_at_overlap};

/// Numbers of vertices of the convex polyhedra.
const VERTICES: [usize; 5] = [8, 16, 32, 64, 128];

/// Numbers of triangles of the tori: squares of cells.
const TRIANGLES: [usize; 4] = [50, 200, 800, 3_200];

/// So many pairs of convex polyhedra, each placed many times.
const SHAPES: usize = 20;

/// The share of the pairs that intersect.
const RATE: f64 = 0.5;

/// Translations at which hardly any two intersect: some radii.
const REACH: f64 = 20.0;

#[derive(Serialize)]
struct ConvexRow {
    vertices: usize,
    test: &'static str,
    pairs: usize,
    intersecting_percent: f64,
    iterations_a_test: f64,
    /// Answers that are not those of ISA-GJK.
    disagreements: usize,
    microseconds_a_test: f64,
}

#[derive(Serialize)]
struct TorusRow {
    triangles: usize,
    pairs: usize,
    intersecting_percent: f64,
    bsp_nodes: usize,
    bsp_bytes_a_triangle: f64,
    bsp_planes_a_test: f64,
    bsp_cuts_a_test: f64,
    bsp_build_milliseconds: f64,
    bsp_microseconds_a_test: f64,
    aabb_bytes_a_triangle: f64,
    aabb_box_tests_a_test: f64,
    aabb_triangle_tests_a_test: f64,
    aabb_build_milliseconds: f64,
    aabb_microseconds_a_test: f64,
    disagreements: usize,
}

/// Runs it.
pub fn run(settings: &Settings) -> Result<Report> {
    let convex: Vec<ConvexRow> = VERTICES.iter().flat_map(|&n| polyhedra(settings, n)).collect();
    let tori: Vec<TorusRow> = TRIANGLES.iter().map(|&n| two_tori(settings, n)).collect();
    write_csv(settings, "solids-convex", &convex)?;
    write_csv(settings, "solids-tori", &tori)?;
    Ok(Report { claims: claims(&convex, &tori), charts: charts(settings, &convex, &tori)? })
}

fn polyhedra(settings: &Settings, vertices: usize) -> Vec<ConvexRow> {
    let count = settings.sample(2_000, 400);
    let mut rng = stream(settings.seed, &format!("solids of {vertices} vertices"));
    let polytope = |rng: &mut _| {
        Polytope::hull_of(&Polyhedron::random(rng, vertices).vertices).expect("there are vertices")
    };
    let shapes: Vec<[Polytope; 2]> = (0..SHAPES).map(|_| [polytope(&mut rng), polytope(&mut rng)]).collect();
    let ask = |test: &mut dyn ConvexTest, i: usize, poses: &PairPose| {
        let [a, b] = &shapes[i % SHAPES];
        let [placement_a, placement_b] = &poses.map(|pose| pose.affine());
        test.intersects(&Pair { a, placement_a, b, placement_b }, &mut Memory::default())
    };
    // ISA-GJK leads, as its answers are right: see its test.
    let mut leader = IsaGjk::default();
    let pairs = pairs_at_overlap(&mut rng, count, RATE, REACH, |i, poses| ask(&mut leader, i, poses));
    let tests: [Box<dyn ConvexTest>; 4] = [
        Box::new(IsaGjk::default()),
        Box::new(LinCanny::default()),
        Box::new(LinearProgram::default()),
        Box::new(BspTrees::default()),
    ];
    let mut expected: Option<Vec<bool>> = None;
    tests
        .into_iter()
        .map(|mut test| {
            // What a shape keeps for a test is made before.
            for (i, poses) in pairs.iter().enumerate().take(SHAPES) {
                ask(&mut *test, i, poses);
            }
            let before = test.counters();
            let (time, found) = seconds(|| -> Vec<bool> {
                pairs.iter().enumerate().map(|(i, poses)| ask(&mut *test, i, poses)).collect()
            });
            let expected = expected.get_or_insert_with(|| found.clone());
            ConvexRow {
                vertices,
                test: test.name(),
                pairs: count,
                intersecting_percent: percent(found.iter().filter(|&&hit| hit).count(), count),
                iterations_a_test: (test.counters().iterations - before.iterations) as f64 / count as f64,
                disagreements: expected.iter().zip(&found).filter(|(x, y)| x != y).count(),
                microseconds_a_test: time * 1e6 / count as f64,
            }
        })
        .collect()
}

fn two_tori(settings: &Settings, triangles: usize) -> TorusRow {
    let count = settings.sample(1_000, 100);
    let mesh = Mesh::torus(triangles);
    let corners: Vec<[DVec3; 3]> =
        mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices[v as usize])).collect();
    let (bsp_build, solid) = seconds(|| BspTree::of_triangles(corners.iter().copied()));
    let (aabb_build, surface) = seconds(|| Tree::<AlignedBox>::build(corners.clone(), ()));
    let relative = |[a, b]: &PairPose| a.affine().inverse() * b.affine();
    let mut rng = stream(settings.seed, &format!("solids of {triangles} triangles"));
    let mut leader = Traversal::new(Sat::Lite);
    let pairs = pairs_at_overlap(&mut rng, count, RATE, REACH, |_, poses| {
        leader.intersects(&surface, &surface, &relative(poses))
    });
    let placements: Vec<DAffine3> = pairs.iter().map(relative).collect();
    // Two equal tori are never one within the other, so their solids intersect where their surfaces do.
    let mut traversal = Traversal::new(Sat::Lite);
    let (aabb_time, expected) = seconds(|| -> Vec<bool> {
        placements.iter().map(|b_to_a| traversal.intersects(&surface, &surface, b_to_a)).collect()
    });
    let mut merge = Merge::default();
    let (bsp_time, found) = seconds(|| -> Vec<bool> {
        placements.iter().map(|b_to_a| merge.intersect(&solid, &solid, b_to_a)).collect()
    });
    let a_test = |x: u64| x as f64 / count as f64;
    let a_triangle = |bytes: usize| bytes as f64 / triangles as f64;
    TorusRow {
        triangles,
        pairs: count,
        intersecting_percent: percent(expected.iter().filter(|&&hit| hit).count(), count),
        bsp_nodes: solid.nodes().len(),
        bsp_bytes_a_triangle: a_triangle(size_of_val(solid.nodes())),
        bsp_planes_a_test: a_test(merge.counters().planes),
        bsp_cuts_a_test: a_test(merge.counters().cuts),
        bsp_build_milliseconds: bsp_build * 1e3,
        bsp_microseconds_a_test: bsp_time * 1e6 / count as f64,
        aabb_bytes_a_triangle: a_triangle(surface.bytes()),
        aabb_box_tests_a_test: a_test(traversal.counters.box_tests),
        aabb_triangle_tests_a_test: a_test(traversal.counters.triangle_tests),
        aabb_build_milliseconds: aabb_build * 1e3,
        aabb_microseconds_a_test: aabb_time * 1e6 / count as f64,
        disagreements: expected.iter().zip(&found).filter(|(x, y)| x != y).count(),
    }
}

fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole as f64
}

fn claims(convex: &[ConvexRow], tori: &[TorusRow]) -> Vec<Claim> {
    let row = |test: &str, vertices: usize| {
        let found = convex.iter().find(|row| row.test == test && row.vertices == vertices);
        found.expect("every test is measured at every number of vertices")
    };
    let [isa, program, trees] =
        [IsaGjk::default().name(), LinearProgram::default().name(), BspTrees::default().name()];
    let [least, most] = [VERTICES[0], VERTICES[VERTICES.len() - 1]];
    let claim = |what: String, thesis, ours, kind| Claim { what, thesis, ours, unit: "", kind };
    let mut claims = Vec::new();
    for test in [program, trees] {
        for vertices in [least, most] {
            let ours = row(test, vertices).microseconds_a_test / row(isa, vertices).microseconds_a_test;
            let what = format!("{vertices} vertices: time of the {test}, of that of {isa}");
            claims.push(claim(what, f64::NAN, ours, Kind::Time));
        }
    }
    // Table 4.1: expected time linear in the number of halfspaces, two fewer than twice the vertices on each side.
    claims.push(claim(
        format!("{program}: time for {most} vertices, of that for {least}"),
        (2 * most - 4) as f64 / (2 * least - 4) as f64,
        row(program, most).microseconds_a_test / row(program, least).microseconds_a_test,
        Kind::Time,
    ));
    let differing: usize = convex.iter().map(|row| row.disagreements).sum();
    let what = "convex polyhedra: answers that differ from those of ISA-GJK".to_owned();
    claims.push(claim(what, 0.0, differing as f64, Kind::Count { error: 0.0 }));
    let differing: usize = tori.iter().map(|row| row.disagreements).sum();
    let what = "tori: answers of BSP trees that differ from those of AABB trees".to_owned();
    claims.push(claim(what, 0.0, differing as f64, Kind::Count { error: 0.0 }));
    for pair in tori.windows(2) {
        let growth = pair[1].triangles as f64 / pair[0].triangles as f64;
        claims.push(claim(
            format!(
                "nodes of the BSP tree for {} triangles, of those for {} (thesis: at most)",
                pair[1].triangles, pair[0].triangles
            ),
            growth * growth,
            pair[1].bsp_nodes as f64 / pair[0].bsp_nodes as f64,
            Kind::Model,
        ));
    }
    for row in tori {
        let what = format!("tori of {} triangles: time of BSP trees, of that of AABB trees", row.triangles);
        let ours = row.bsp_microseconds_a_test / row.aabb_microseconds_a_test;
        claims.push(claim(what, f64::NAN, ours, Kind::Time));
    }
    claims
}

fn charts(settings: &Settings, convex: &[ConvexRow], tori: &[TorusRow]) -> Result<Vec<(String, String)>> {
    let tests: Vec<&str> =
        convex.iter().take_while(|row| row.vertices == VERTICES[0]).map(|row| row.test).collect();
    let of = |test: &&str| -> Series {
        let points = convex.iter().filter(|row| row.test == *test);
        ((*test).to_owned(), points.map(|row| (row.vertices as f64, row.microseconds_a_test)).collect())
    };
    let series: Vec<Series> = tests.iter().map(of).collect();
    let title = "Two convex polyhedra, half of the pairs intersecting";
    let labels = Labels { title, x: "vertices", y: "microseconds a test" };
    lines_of_ratios(settings, "solids-convex.svg", &labels, &series)?;
    let of = |name: &str, value: fn(&TorusRow) -> f64| -> Series {
        (name.to_owned(), tori.iter().map(|row| (row.triangles as f64, value(row))).collect())
    };
    let tori_title = "Two tori, half of the pairs intersecting";
    lines_of_ratios(
        settings,
        "solids-tori.svg",
        &Labels { title: tori_title, x: "triangles", y: "microseconds a test" },
        &[of("BSP trees", |r| r.bsp_microseconds_a_test), of("AABB trees", |r| r.aabb_microseconds_a_test)],
    )?;
    Ok(vec![
        ("solids-convex.svg".to_owned(), title.to_owned()),
        ("solids-tori.svg".to_owned(), tori_title.to_owned()),
    ])
}
