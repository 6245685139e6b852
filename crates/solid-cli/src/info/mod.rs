//! `solid info`: what is in the files.

use std::io::{IsTerminal, Write};

use anyhow::Result;
use solid_scene::{Pose, Scene, SceneObject};
use solid3d::{Error, Shape, ShapeKind, query};

use crate::args::InfoArgs;
use crate::table::{self, Column, Style};
use crate::{output, scene, words};

const OBJECT_COLUMNS: [Column; 6] = [
    Column::Left("object"),
    Column::Left("kind"),
    Column::Right("primitives"),
    Column::Left("closed"),
    Column::Right("degenerate"),
    Column::Left("file"),
];

const FILE_COLUMNS: [Column; 3] = [Column::Left("file"), Column::Left("unit"), Column::Right("objects")];

/// Says what is in the files.
pub fn run(args: &InfoArgs) -> Result<()> {
    let scene = scene::load(&args.scene)?;
    let style = Style::on(std::io::stdout().is_terminal());
    let mut output = output::stdout();
    output.write_all(text(&scene, style).as_bytes())?;
    Ok(output.flush()?)
}

fn text(scene: &Scene, style: Style) -> String {
    let objects = table::draw(style, &OBJECT_COLUMNS, scene.objects().iter().map(|o| object_row(scene, o)));
    let files = table::draw(style, &FILE_COLUMNS, (0..scene.files().len()).map(|file| file_row(scene, file)));
    let warnings = scene::warnings(scene).chain(absences(scene));
    let warnings: String = warnings.map(|warning| format!("warning: {warning}\n")).collect();
    let amount = scene::amount(scene);
    format!("{objects}\n{files}\n{amount}, {}\n{warnings}", animation(scene.duration()))
}

fn object_row(scene: &Scene, object: &SceneObject) -> Vec<String> {
    let shape = object.shape();
    vec![
        words::printable(object.name()),
        shape.kind().to_string(),
        shape.primitive_count().to_string(),
        closedness(shape),
        object.degenerate().to_string(),
        file_name(scene, object.file()),
    ]
}

fn file_row(scene: &Scene, file: usize) -> Vec<String> {
    let objects = scene.objects().iter().filter(|object| object.file() == file).count();
    vec![file_name(scene, file), scene.unit(file).to_owned(), objects.to_string()]
}

fn file_name(scene: &Scene, file: usize) -> String {
    words::printable(&scene.files()[file].to_string_lossy())
}

/// Whether a shape bounds a volume: of a mesh, whether `--solid` takes it. A soup of convex primitives may or may not; nobody asked
/// it to.
fn closedness(shape: &Shape) -> String {
    match (shape.kind(), shape.clone().into_solid()) {
        (ShapeKind::Mesh, Ok(_)) => "yes".to_owned(),
        (_, Err(Error::OpenMesh { edges })) => {
            format!("no, {}", words::count(words::size(edges.len()), "open edge"))
        }
        (_, Err(_)) => "-".to_owned(),
        (_, Ok(_)) => "solid".to_owned(),
    }
}

/// Which objects are not there at time 0, in words, a line each.
fn absences(scene: &Scene) -> impl Iterator<Item = String> {
    let mut pose = Pose::default();
    scene.sample(0.0, &mut pose);
    (0..).zip(pose.objects).filter_map(|(object, pose)| {
        let bounds = query::bounds(scene.objects()[object].shape(), &pose.placement);
        matches!(bounds, Err(Error::SingularPlacement { .. })).then(|| scene::absence(scene, object, 0.0))
    })
}

fn animation(duration: f64) -> String {
    if duration > 0.0 {
        format!("animation of {} s", words::seconds(duration))
    } else {
        "no animation".to_owned()
    }
}
