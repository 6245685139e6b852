//! Files that are named twice.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use solid_scene::Scene;

use crate::args::CheckArgs;
use crate::output::{destination, is_stdout};

/// Refuses two outputs to one place, and outputs that would overwrite what is read, as far as the command line tells.
pub fn refuse_clashes(args: &CheckArgs) -> Result<()> {
    if let (Some(json), Some(csv)) = (&args.json, &args.csv)
        && is_same(json, csv)
    {
        bail!("--json and --csv both write to {}; expected different files", json.display());
    }
    refuse_overwriting(args, args.scene.files.iter().chain(&args.rules).chain(&args.placements))
}

/// Refuses outputs that would overwrite what the files of the scene brought with them.
pub fn refuse_overwriting_parts(args: &CheckArgs, scene: &Scene) -> Result<()> {
    refuse_overwriting(args, scene.files_read())
}

fn refuse_overwriting<'a>(args: &CheckArgs, inputs: impl Iterator<Item = &'a PathBuf> + Clone) -> Result<()> {
    for output in [&args.json, &args.csv].into_iter().flatten().filter(|path| !is_stdout(path)) {
        if inputs.clone().any(|input| is_same(input, output)) {
            bail!("{}: would be overwritten, but is read; expected another output", output.display());
        }
    }
    Ok(())
}

/// Whether two paths lead to one file, also while that is not there. Another name of the same file (a hard link) counts as another
/// file, since it is left as it is when a file is written.
fn is_same(a: &Path, b: &Path) -> bool {
    a == b || file(a).is_some_and(|file_a| file(b) == Some(file_a))
}

/// The file that a path leads to; `None` for standard output, devices and folders.
fn file(path: &Path) -> Option<PathBuf> {
    let there = destination(path);
    (!is_stdout(path) && (there.is_file() || !there.exists())).then_some(there)
}
