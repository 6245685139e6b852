//! Real files and what other programs make of them: the folder `vrml` in the one that SOLID_DATA names.

use std::path::{Path, PathBuf};

use glam::DVec3;
use solid_oracle::known_answers;
use solid_scene::Scene;
use solid3d::Aabb;

use crate::bounds;
use crate::files::{load_file, pose};

/// The files that are refused, and a part of the reason. They are not VRML97: numbers in place of a Color node, a node in
/// place of a field, fragments of files without a header, a DEF without a type. No other program's bounds are known.
const REFUSED: [(&str, &str); 13] = [
    ("vrml/VrmlParser/PointSet.wrl", "expected a value for the field 'color'"),
    ("vrml/VrmlParser/house.wrl", "'DEF' is no field of 'Transform'"),
    ("vrml/choreonoid/PA10/BASE.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/HAND_L.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/HAND_R.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J1.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J2.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J3.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J4.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J5.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J6.wrl", "no VRML97 header"),
    ("vrml/choreonoid/PA10/J7.wrl", "no VRML97 header"),
    ("vrml/choreonoid/Tank/tank.wrl", "expected one more value or ']'"),
];

/// All files with the ending .wrl below a folder, in order.
fn files_below(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).expect("the data folder can be read");
    let mut entries: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            files_below(&entry, files);
        } else if entry.extension().is_some_and(|extension| extension == "wrl") {
            files.push(entry);
        }
    }
}

#[test]
fn exactly_the_listed_files_are_refused() {
    let Some(folder) = known_answers("") else { return };
    let mut files = Vec::new();
    files_below(&folder.join("vrml"), &mut files);
    let mut refused = Vec::new();
    for file in &files {
        let name = file.strip_prefix(&folder).expect("it is below").display().to_string();
        match load_file(file) {
            Ok(scene) => report(&name, &scene),
            Err(error) => {
                println!("{name}: refused: {}", error.message);
                refused.push((name, error.message));
            }
        }
    }
    println!("{} files, {} refused", files.len(), refused.len());
    let names: Vec<&str> = refused.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, REFUSED.map(|(name, _)| name));
    assert!(refused.iter().zip(REFUSED).all(|((_, message), (_, part))| message.contains(part)));
}

fn report(name: &str, scene: &Scene) {
    let degenerate: usize = scene.objects().iter().map(|object| object.degenerate()).sum();
    let (objects, duration) = (scene.objects().len(), scene.duration());
    println!("{name}: {objects} objects, {degenerate} degenerate primitives, {duration} s");
    for (_, warning) in scene.warnings() {
        println!("    {warning}");
    }
}

/// A row of expected.csv.
struct Expected {
    file: String,
    bounds: Aabb,
    area: Option<f64>,
    triangles: Option<usize>,
}

fn expected(folder: &Path) -> Vec<Expected> {
    let mut reader = csv::Reader::from_path(folder.join("vrml/expected.csv")).expect("it is there");
    let rows = reader.records().map(|row| {
        let row = row.expect("it is well-formed");
        let number = |column: usize| row[column].parse::<f64>().ok();
        let vector = |first: usize| {
            let coordinate = |i: usize| number(first + i).expect("a number");
            DVec3::new(coordinate(0), coordinate(1), coordinate(2))
        };
        let bounds = Aabb::new(vector(2), vector(5));
        Expected { file: row[0].to_owned(), bounds, area: number(8), triangles: row[9].parse().ok() }
    });
    rows.collect()
}

#[test]
fn bounds_areas_and_triangles_agree_with_other_programs() {
    let Some(folder) = known_answers("") else { return };
    let mut wrong = Vec::new();
    for row in expected(&folder) {
        match load_file(&folder.join(&row.file)) {
            Ok(scene) => wrong.extend(differences(&row, &scene)),
            Err(error) => wrong.push(format!("{}: {error}", row.file)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn differences(row: &Expected, scene: &Scene) -> Vec<String> {
    /// The programs agree with each other up to this part of the extent.
    const PRECISION: f64 = 1e-4;
    let mut differences = Vec::new();
    let pose = pose(scene, 0.0);
    let bounds = bounds::of_scene(scene, &pose);
    let tolerance = PRECISION * (row.bounds.max - row.bounds.min).max_element();
    let error = (bounds.min - row.bounds.min).abs().max((bounds.max - row.bounds.max).abs());
    if error.max_element().is_nan() || error.max_element() > tolerance {
        differences.push(format!("{}: bounds {bounds:?}, expected {:?}", row.file, row.bounds));
    }
    let each = scene.objects().iter().zip(&pose.objects);
    let triangles: Option<Vec<_>> =
        each.map(|(object, pose)| bounds::triangles(object.shape(), &pose.placement)).collect();
    let triangles = triangles.map(|lists| lists.concat());
    let count = triangles.as_ref().map(Vec::len);
    if row.triangles.is_some() && row.triangles != count && count.is_some() {
        differences.push(format!("{}: {count:?} triangles, expected {:?}", row.file, row.triangles));
    }
    if let (Some(expected), Some(triangles)) = (row.area, &triangles) {
        let area: f64 = triangles.iter().map(bounds::area).sum();
        if (area - expected).abs() > PRECISION * expected {
            differences.push(format!("{}: area {area}, expected {expected}", row.file));
        }
    }
    differences
}
