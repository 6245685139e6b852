//! Points and rays against a mesh: as such, and as shapes. A point is the hull of itself; a ray is then asked about as two segments,
//! one that ends just before the hit and one that ends just after it.

use glam::{DAffine3, DVec3};
use solid3d::query::{self, Ray, RayOptions};
use solid3d::{ComplexShapeBuilder, Error, Shape};

use crate::data::{folder, for_each_row, json, model};
use crate::tally::Tally;

/// The error of a distance relative to the extent of the mesh.
const DISTANCE_ERROR: f64 = 1e-12;

/// The error of a hit relative to the extent of the mesh and the distance of the ray's origin.
const HIT_ERROR: f64 = 1e-12;

/// How far before and after the hit the segments end, relative to the extent of the mesh.
const RAY_ERROR: f64 = 1e-9;

/// A ray that misses is asked about up to so many extents of the mesh.
const RAY_LENGTH: f64 = 10.0;

#[test]
fn bunny() {
    check("bunny5k");
}

#[test]
fn fcl_env() {
    check("fcl_env");
}

#[test]
fn teapot() {
    check("teapot");
}

fn check(name: &str) {
    let Some(folder) = folder("queries") else { return };
    let facts = json(&folder.join(format!("{name}_raypt.json")));
    let mesh = model(facts["mesh"].as_str().unwrap()).unwrap();
    let size = mesh.vertices().unwrap().iter().map(|v| v.length()).fold(0.0, f64::max);
    check_points(&mesh, size, name, &folder.join(format!("{name}_points.csv")));
    if facts["watertight_inside_given"] == true {
        check_inside(&mesh.clone().into_solid().unwrap(), name, &folder.join(format!("{name}_points.csv")));
    } else {
        assert!(matches!(mesh.clone().into_solid(), Err(Error::OpenMesh { .. })), "{name} is open");
    }
    check_rays(&mesh, size, name, &folder.join(format!("{name}_rays.csv")));
}

fn check_points(mesh: &Shape, size: f64, name: &str, path: &std::path::Path) {
    let mut tally = Tally::new(format!("{name} points"));
    for_each_row(path, |row| {
        let (label, here) = (format!("point {}", row.text("id")), DAffine3::IDENTITY);
        let (point, distance) = (row.vector("", ""), row.real("distance"));
        let at = DAffine3::from_translation(point);
        // As a hull where it is, as a point that is placed, and as a complex shape of one point.
        let hull = query::distance(mesh, &here, &Shape::convex_hull(&[point]).unwrap(), &here).unwrap();
        let placed = query::distance(mesh, &here, &Shape::convex_hull(&[DVec3::ZERO]).unwrap(), &at).unwrap();
        let complex = ComplexShapeBuilder::new([point]).point(0).build().unwrap();
        let complex = query::distance(&complex, &here, mesh, &here).unwrap();
        let reach = size + point.length();
        for found in [hull, placed, complex] {
            tally.error(&label, (found.distance - distance).abs() / reach, DISTANCE_ERROR);
        }
        let closest = query::closest_point(mesh, &here, point).unwrap();
        tally.error(&label, (closest.distance - distance).abs() / reach, DISTANCE_ERROR);
        tally.error(&label, (closest.point.distance(point) - distance).abs() / reach, DISTANCE_ERROR);
        tally.hit(&label, distance == 0.0, query::contains_point(mesh, &here, point).unwrap());
    });
    tally.finish();
}

/// A point that is inside the solid, by its winding number, is at distance 0 of it.
fn check_inside(solid: &Shape, name: &str, path: &std::path::Path) {
    let mut tally = Tally::new(format!("{name} inside"));
    for_each_row(path, |row| {
        let (label, here) = (format!("point {}", row.text("id")), DAffine3::IDENTITY);
        let inside = row.flag("inside") || row.real("distance") == 0.0;
        let point = row.vector("", "");
        // On the surface it is between two whole numbers.
        let winding = query::winding_number(solid, &here, point).unwrap();
        tally.check((winding > 0.5) == inside || row.real("distance") < 1e-9, || {
            format!("{label}: winds {winding}")
        });
        let hull = Shape::convex_hull(&[point]).unwrap();
        let complex = ComplexShapeBuilder::new([point]).point(0).build().unwrap();
        for shape in [hull, complex] {
            tally.hit(&label, inside, query::intersects(&shape, &here, solid, &here).unwrap());
            tally.hit(&label, inside, query::contains_point(solid, &here, point).unwrap());
            let distance = query::distance(solid, &here, &shape, &here).unwrap().distance;
            tally.check((distance == 0.0) == inside, || format!("{label}: a distance of {distance}"));
        }
    });
    tally.finish();
}

/// Whether a ray meets a face at this place too, that is, on an edge.
fn shared(mesh: &Shape, ray: &Ray, t: f64, face: u32) -> bool {
    let all = query::cast_ray_all(mesh, &DAffine3::IDENTITY, ray, &RayOptions::default()).unwrap();
    all.iter()
        .any(|hit| (hit.t - t).abs() < 1e-12 && hit.surface.is_some_and(|surface| surface.primitive == face))
}

fn check_rays(mesh: &Shape, size: f64, name: &str, path: &std::path::Path) {
    let mut tally = Tally::new(format!("{name} rays"));
    for_each_row(path, |row| {
        let label = format!("ray {}", row.text("id"));
        let (origin, direction) = (row.vector("o", ""), row.vector("d", ""));
        let meets = |t: f64| {
            let ends = [origin, origin + direction * t];
            let hull = Shape::convex_hull(&ends).unwrap();
            let complex = ComplexShapeBuilder::new(ends).segment([0, 1]).build().unwrap();
            let here = DAffine3::IDENTITY;
            [hull, complex].map(|segment| query::intersects(mesh, &here, &segment, &here).unwrap())
        };
        let ray = Ray::new(origin, direction);
        let hit = query::cast_ray(mesh, &DAffine3::IDENTITY, &ray, &RayOptions::default()).unwrap();
        tally.hit(&label, row.flag("hit"), hit.is_some());
        if let (Some(hit), Some(t)) = (hit, row.number::<f64>("t")) {
            let reach = size + origin.length();
            tally.error(&label, (hit.t - t).abs() / reach, HIT_ERROR);
            let (face, found) = (row.number::<u32>("face").unwrap(), hit.surface.unwrap().primitive);
            tally.check(face == found || shared(mesh, &ray, hit.t, face), || {
                format!("{label}: face {found}, expected {face}")
            });
        }
        match row.number::<f64>("t") {
            Some(t) => {
                let (before, after) = (meets(t - RAY_ERROR * size), meets(t + RAY_ERROR * size));
                tally.hit(&label, true, after == [true; 2]);
                tally.check(before == [false; 2] || t < 1e-6 * size, || {
                    format!("{label}: {before:?} before {t}")
                });
            }
            None => {
                let met = meets(RAY_LENGTH * size);
                tally.hit(&label, false, met != [false; 2]);
            }
        }
        tally.check(row.flag("hit") == row.number::<f64>("t").is_some(), || format!("{label}: bad data"));
    });
    tally.finish();
}
