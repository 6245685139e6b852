//! Files that are named twice.

use std::path::Path;

use anyhow::{Result, bail};

use crate::args::CheckArgs;
use crate::output::is_stdout;

/// Refuses two outputs to one place, and outputs that would overwrite what is read.
pub fn refuse_clashes(args: &CheckArgs) -> Result<()> {
    if let (Some(json), Some(csv)) = (&args.json, &args.csv)
        && is_same(json, csv)
    {
        bail!("--json and --csv both write to {}; expected different files", json.display());
    }
    for output in [&args.json, &args.csv].into_iter().flatten().filter(|path| !is_stdout(path)) {
        let mut inputs = args.scene.files.iter().chain(&args.rules).chain(&args.placements);
        if inputs.any(|input| is_same(input, output)) {
            bail!("{}: would be overwritten, but is read; expected another output", output.display());
        }
    }
    Ok(())
}

/// Whether two paths name one file, as far as can be seen before it is there.
fn is_same(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b && a.is_file())
}
