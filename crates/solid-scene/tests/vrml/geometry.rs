//! Geometry nodes as shapes.

use glam::DVec3;
use solid3d::ShapeKind;

use crate::bounds::{area, of_scene, sizes, triangles};
use crate::files::{assert_near, error, pose, scene, warnings};

fn shape(geometry: &str) -> String {
    format!("Shape {{ geometry {geometry} }}")
}

/// The number of primitives, and the bounds.
fn made(geometry: &str) -> (usize, DVec3, DVec3) {
    let scene = scene(&shape(geometry));
    let bounds = of_scene(&scene, &pose(&scene, 0.0));
    (scene.objects()[0].shape().primitive_count(), bounds.min, bounds.max)
}

fn total_area(geometry: &str) -> f64 {
    let scene = scene(&shape(geometry));
    let placement = pose(&scene, 0.0).objects[0].placement;
    let triangles = triangles(scene.objects()[0].shape(), &placement).expect("a mesh");
    triangles.iter().map(area).sum()
}

#[test]
fn primitives_are_exact() {
    let cases = [
        ("Box {}", ShapeKind::Cuboid, vec![1.0, 1.0, 1.0]),
        ("Box { size 1 2 3 }", ShapeKind::Cuboid, vec![0.5, 1.0, 1.5]),
        ("Sphere {}", ShapeKind::Sphere, vec![1.0]),
        ("Sphere { radius .25 }", ShapeKind::Sphere, vec![0.25]),
        ("Cone { bottomRadius 2 height 6 }", ShapeKind::Cone, vec![2.0, 3.0]),
        ("Cylinder { radius 2 height 6 }", ShapeKind::Cylinder, vec![2.0, 3.0]),
    ];
    for (geometry, kind, expected) in cases {
        let scene = scene(&shape(geometry));
        let made = scene.objects()[0].shape();
        assert_eq!((made.kind(), sizes(made)), (kind, expected), "{geometry}");
        assert!(warnings(&scene).is_empty());
    }
}

#[test]
fn open_primitives_are_solid_with_a_warning() {
    let scene = scene(&shape("DEF C Cylinder { top FALSE }"));
    assert_eq!(warnings(&scene), ["Cylinder C: top is FALSE, but it is taken as solid"]);
}

#[test]
fn sizes_out_of_range_name_the_node() {
    let (line, message) = error(&shape("\nDEF Ball Sphere { radius -1 }"));
    assert_eq!(line, Some(3));
    assert!(message.starts_with("Sphere Ball: radius is -1"), "{message}");
    assert!(error(&shape("Box { size 1 0 1 }")).1.starts_with("Box: "));
    assert!(error(&shape("Sphere { radius NaN }")).1.contains("radius holds NaN"));
    assert!(error(&shape("Cone { height INF }")).1.contains("height holds inf"));
}

#[test]
fn face_sets_are_triangulated_over_their_own_points() {
    let square = "coord Coordinate { point [ 9 9 9, 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] } coordIndex [ 1 2 3 4 ]";
    let scene = scene(&shape(&format!("IndexedFaceSet {{ {square} }}")));
    let made = scene.objects()[0].shape();
    assert_eq!(made.vertices().map(<[DVec3]>::len), Some(5));
    assert_eq!(made.triangles(), Some(&[[1, 2, 3], [1, 3, 4]][..]));
}

#[test]
fn concave_faces_and_holes_keep_their_area() {
    let arrow = "IndexedFaceSet { convex FALSE coordIndex [ 0 1 2 3 -1 ]
        coord Coordinate { point [ 0 0 0, 2 0 0, .5 .5 0, 0 2 0 ] } }";
    assert!((total_area(arrow) - 1.0).abs() < 1e-12);
    let frame = "IndexedFaceSet { convex FALSE coordIndex [ 0 1 2 3 0 4 7 6 5 4 -1 ] coord Coordinate {
        point [ 0 0 0, 3 0 0, 3 0 3, 0 0 3, 1 0 1, 2 0 1, 2 0 2, 1 0 2 ] } }";
    assert!((total_area(frame) - 8.0).abs() < 1e-12);
}

#[test]
fn degenerate_primitives_are_counted() {
    let points = "coord Coordinate { point [ 0 0 0, 1 0 0, 2 0 0, 0 1 0, 0 0 0 ] }";
    let faces =
        scene(&shape(&format!("IndexedFaceSet {{ {points} coordIndex [ 0 1 2 -1 0 1 3 -1 0 0 1 -1 ] }}")));
    assert_eq!(faces.objects()[0].degenerate(), 2);
    let lines = scene(&shape(&format!("IndexedLineSet {{ {points} coordIndex [ 0 1 2 -1 0 4 -1 ] }}")));
    assert_eq!(lines.objects()[0].degenerate(), 1);
}

#[test]
fn lines_and_points_are_complex_shapes() {
    let points = "coord Coordinate { point [ 0 0 0, 1 0 0, 1 2 0, 5 5 5 ] }";
    let lines = scene(&shape(&format!("IndexedLineSet {{ {points} coordIndex [ 0 1 2 -1 -1 2 0 -1 3 ] }}")));
    let lines = lines.objects()[0].shape();
    assert_eq!((lines.kind(), lines.primitive_count()), (ShapeKind::Complex, 3));
    let (count, min, max) = made(&format!("PointSet {{ {points} }}"));
    assert_eq!((count, min, max), (4, DVec3::ZERO, DVec3::splat(5.0)));
}

#[test]
fn indices_are_checked() {
    let set = |index: &str| {
        format!(
            "DEF F IndexedFaceSet {{ coord Coordinate {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }} coordIndex [ {index} ] }}"
        )
    };
    let message = |index: &str| error(&shape(&set(index))).1;
    assert_eq!(
        message("0 1 3 -1"),
        "IndexedFaceSet F: coordIndex holds 3; expected -1, or less than 3, the number of points"
    );
    assert!(message("0 1 -2").contains("coordIndex holds -2"));
    assert!(message("0 1 2147483647").contains("coordIndex holds 2147483647"));
    // Not by its lowest 32 bits, which name the third point, or end a face.
    for index in ["4294967298", "4294967295"] {
        assert_eq!(
            message(&format!("0 1 {index} -1")),
            format!("coordIndex holds {index}; expected an integer of at most 2147483647")
        );
    }
}

#[test]
fn empty_geometry_is_passed_over_with_a_warning() {
    for geometry in [
        "IndexedFaceSet {}",
        "IndexedFaceSet { coord Coordinate { point [ 0 0 0 ] } coordIndex [ 0 0 -1 ] }",
        "IndexedLineSet { coord Coordinate {} }",
        "PointSet { coord NULL }",
        "ElevationGrid {}",
        "Extrusion { spine [] }",
        "Text { string \"no\" }",
        "NULL",
    ] {
        let scene = scene(&shape(geometry));
        assert!(scene.objects().is_empty(), "{geometry}");
        assert!(warnings(&scene).iter().any(|warning| warning.ends_with("passed over")), "{geometry}");
    }
}

#[test]
fn an_elevation_grid_spreads_along_x_and_z() {
    let grid = "ElevationGrid { xDimension 3 zDimension 2 xSpacing 2 zSpacing 5 height [ 0 1 2 3 4 5 ] }";
    assert_eq!(made(grid), (4, DVec3::ZERO, DVec3::new(4.0, 5.0, 5.0)));
    let message = |fields: &str| error(&shape(&format!("ElevationGrid {{ {fields} }}"))).1;
    assert_eq!(
        message("xDimension 2147483647 zDimension 2147483647 height [ 1 ]"),
        "ElevationGrid: height holds 1 number; expected 2147483647 by 2147483647"
    );
    assert!(message("xDimension -1 zDimension 1").contains("xDimension is -1"));
    assert!(message("xDimension 2 zDimension 1 height [ 0 0 ] xSpacing 0").contains("xSpacing is 0"));
}

#[test]
fn an_extrusion_is_scaled_turned_and_capped() {
    let (count, min, max) = made("Extrusion {}");
    assert_eq!((count, min, max), (12, DVec3::new(-1.0, 0.0, -1.0), DVec3::ONE));
    assert_eq!(made("Extrusion { beginCap FALSE endCap FALSE }").0, 8);
    let (_, min, max) = made("Extrusion { scale [ 1 1, 3 2 ] }");
    assert_near(min, DVec3::new(-3.0, 0.0, -2.0));
    assert_near(max, DVec3::new(3.0, 1.0, 2.0));
    let (_, _, max) = made("Extrusion { orientation 0 1 0 .785398163 }");
    assert_near(max, DVec3::new(2f64.sqrt(), 1.0, 2f64.sqrt()));
}

#[test]
fn caps_of_a_concave_section_keep_their_area() {
    let arrow = "crossSection [ 0 0, 2 0, .5 .5, 0 2, 0 0 ]";
    let open = total_area(&format!("Extrusion {{ {arrow} beginCap FALSE endCap FALSE }}"));
    let closed = total_area(&format!("Extrusion {{ {arrow} }}"));
    assert!((closed - open - 2.0).abs() < 1e-6);
}

/// Sides and both caps face outwards; were it not so, no extrusion would be closed.
#[test]
fn a_closed_extrusion_bounds_a_solid() {
    let arrow = "crossSection [ 0 0, 2 1, 0 2, 1 1, 0 0 ]";
    let bent = "spine [ 0 0 0, 0 2 0, 3 2 0, 3 2 3 ]";
    let around = "spine [ 9 0 0, 0 0 9, -9 0 0, 0 0 -9, 9 0 0 ]";
    for fields in ["", arrow, bent, around, &format!("{arrow} {bent} scale [ 1 1, 2 1, 1 3, .5 .5 ]")] {
        let scene = scene(&shape(&format!("Extrusion {{ {fields} }}")));
        let solid = scene.objects()[0].shape().clone().into_solid();
        assert!(solid.is_ok(), "{fields}: {solid:?}");
    }
    let cut = scene(&shape("Extrusion { beginCap FALSE }"));
    assert!(cut.objects()[0].shape().clone().into_solid().is_err());
}

#[test]
fn an_extrusion_along_a_circle_is_a_torus() {
    let spine: Vec<String> = (0..=64)
        .map(|i| std::f64::consts::TAU * f64::from(i % 64) / 64.0)
        .map(|angle| format!("{} 0 {}", 5.0 * angle.cos(), 5.0 * angle.sin()))
        .collect();
    let torus = format!("Extrusion {{ spine [ {} ] beginCap FALSE endCap FALSE }}", spine.join(", "));
    let (count, min, max) = made(&torus);
    assert_eq!(count, 64 * 4 * 2);
    assert!(max.distance(DVec3::new(6.0, 1.0, 6.0)) < 1e-5, "{max}");
    assert!(min.distance(DVec3::new(-6.0, -1.0, -6.0)) < 1e-5, "{min}");
}

/// The parser leaves out the last of three and a third points.
#[test]
fn missing_numbers_are_told() {
    let scene = scene(
        "Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ] coord Coordinate { point [ 0 0, 1 0 0, 0 1 0, 1 1 ] } } }",
    );
    assert_eq!(
        warnings(&scene),
        ["line 2: point has 10 numbers; expected 3 for each value, what is over is left out"]
    );
}
