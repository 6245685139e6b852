//! Loading the scene that the command line names.

use anyhow::{Result, ensure};
use solid_scene::{Format, LoadOptions, Scene};

use crate::args::SceneArgs;
use crate::{complain, progress, words};

/// Loads the files into one scene, which must have an object: a check of nothing finds nothing.
pub fn load(args: &SceneArgs) -> Result<Scene> {
    let there_is = |format| args.files.iter().any(|file| Format::of(file) == Some(format));
    ensure!(
        there_is(Format::Gltf) || args.animation.is_none(),
        "--animation chooses one of a glTF file; there is none among the files"
    );
    ensure!(
        there_is(Format::Obj) || !args.split,
        "--split divides an OBJ file into its groups; there is none among the files"
    );
    let mut options = LoadOptions::default();
    options.split = args.split;
    options.animation.clone_from(&args.animation);
    let loaded = progress::while_waiting("reading the scene", || Scene::load(&args.files, &options));
    let scene = loaded?;
    if scene.objects().is_empty() {
        // They say why, and nobody else will tell them.
        warnings(&scene).for_each(|warning| complain("warning", warning));
    }
    let files = || args.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ");
    ensure!(!scene.objects().is_empty(), "{}: there is no geometry; expected a node with a shape", files());
    Ok(scene)
}

/// What was passed over or guessed in the files, and which have no objects while others have, a line each.
pub fn warnings(scene: &Scene) -> impl Iterator<Item = String> {
    let has_objects = |file| scene.objects().iter().any(|object| object.file() == file);
    let files = scene.files().iter().enumerate();
    let empty = files.filter(move |&(file, _)| !scene.objects().is_empty() && !has_objects(file));
    let empty = empty.map(|(_, file)| (file.as_path(), "there is no geometry"));
    let all = scene.warnings().chain(empty);
    all.map(|(file, warning)| words::printable(&format!("{}: {warning}", file.display())))
}

/// That an object is not there at a time, in seconds, in words.
pub fn absence(scene: &Scene, object: usize, time: f64) -> String {
    let object = &scene.objects()[object];
    let (file, name) = (scene.files()[object.file()].display(), words::quoted(object.name()));
    let time = words::seconds(time);
    words::printable(&format!(
        "{file}: object {name} is scaled to nothing, or flat, at {time} s; it is not there in such frames"
    ))
}

/// How much geometry there is, in words: `3 objects, 5804 triangles, 2 other primitives`.
pub fn amount(scene: &Scene) -> String {
    let (mut triangles, mut others) = (0, 0);
    for object in scene.objects() {
        let primitives = object.shape().primitive_count();
        match object.shape().triangles() {
            Some(_) => triangles += primitives,
            None => others += primitives,
        }
    }
    let objects = words::count(words::size(scene.objects().len()), "object");
    let triangles = words::count(words::size(triangles), "triangle");
    match others {
        0 => format!("{objects}, {triangles}"),
        _ => format!("{objects}, {triangles}, {}", words::count(words::size(others), "other primitive")),
    }
}
