//! Reading the data folder.

use std::collections::HashMap;
use std::path::Path;
use std::str::FromStr;

use csv::StringRecord;
use glam::{DAffine3, DMat3, DVec3};
use serde_json::Value;
pub(crate) use solid_oracle::known_answers as folder;
use solid_scene::{LoadOptions, Scene};
use solid3d::Shape;

/// A JSON file.
pub(crate) fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// A row of a CSV file.
pub(crate) struct Row<'a> {
    columns: &'a HashMap<String, usize>,
    record: &'a StringRecord,
}

impl Row<'_> {
    /// The text in a column.
    pub fn text(&self, column: &str) -> &str {
        let index = self.columns.get(column).unwrap_or_else(|| panic!("no column {column}"));
        &self.record[*index]
    }

    /// The number in a column; `None` where it is empty.
    pub fn number<T: FromStr>(&self, column: &str) -> Option<T> {
        let text = self.text(column);
        (!text.is_empty()).then(|| text.parse().unwrap_or_else(|_| panic!("{column} is {text}")))
    }

    /// The number in a column that always has one.
    pub fn real(&self, column: &str) -> f64 {
        self.number(column).unwrap_or_else(|| panic!("{column} is empty"))
    }

    /// Whether a column of 0 and 1 is 1.
    pub fn flag(&self, column: &str) -> bool {
        self.number::<u8>(column) == Some(1)
    }

    /// Three numbers, in the columns `prefix` + x, y, z + `suffix`.
    pub fn vector(&self, prefix: &str, suffix: &str) -> DVec3 {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.real(&format!("{prefix}{axis}{suffix}")));
        DVec3::new(x, y, z)
    }

    /// A unit quaternion q and a translation t, whose column names go on with `object`.
    pub fn placement(&self, object: &str) -> DAffine3 {
        let w = self.real(&format!("q{object}w"));
        let DVec3 { x, y, z } = self.vector(&format!("q{object}"), "");
        DAffine3 { matrix3: rotation([w, x, y, z]), translation: self.vector(&format!("t{object}"), "") }
    }
}

/// The rotation of a unit quaternion, by the formula in the data's README.
fn rotation([w, x, y, z]: [f64; 4]) -> DMat3 {
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// Calls `visit` with every row of a CSV file.
pub(crate) fn for_each_row(path: &Path, mut visit: impl FnMut(Row)) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let columns =
        reader.headers().unwrap().iter().enumerate().map(|(i, name)| (name.to_owned(), i)).collect();
    for record in reader.records() {
        visit(Row { columns: &columns, record: &record.unwrap() });
    }
}

/// A file that holds one mesh.
pub(crate) fn mesh(path: &Path) -> Shape {
    let scene = Scene::load(&[path], &LoadOptions::default()).unwrap();
    assert_eq!(scene.objects().len(), 1, "{}", path.display());
    scene.objects()[0].shape().clone()
}

/// A model of the reports on rigid motion, casts and queries, by the name that they use.
pub(crate) fn model(name: &str) -> Option<Shape> {
    let file = match name {
        "env.obj" => "fcl_env.obj",
        "rob.obj" => "fcl_rob.obj",
        "bunny.ply" => "bunny5k.ply",
        "torus.obj" => "ipc_torus.obj",
        same => same,
    };
    Some(mesh(&folder("models")?.join(file)))
}
