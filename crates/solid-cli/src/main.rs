//! The command `solid`: every collision in an animated scene.
//!
//! `solid check` plays the animation of scene files frame by frame, tests every pair of objects in each frame, and reports
//! what collides: as a table, as JSON, as CSV. `solid info` says what is in the files. The exit status is that of a linter:
//! 0 for no collisions, 1 for collisions, 2 for bad input or usage, with one message on standard error.
//!
//! Here live arguments, files in and out, and words. Geometry is `solid3d`'s, file formats are `solid-scene`'s business.
//!
//! | module | concept |
//! |---|---|
//! | `args` | the command line |
//! | `check` | a scene, played and tested |
//! | `placements` | a motion from a table of placements, in place of the scene's own |
//! | `rules` | the response table from a TOML file |
//! | `rays` | what is cast in every frame |
//! | `record` | what becomes of the collisions: JSON, CSV, pairs |
//! | `warnings` | what was passed over or guessed |
//! | `info` | what is in the files |
//! | `output` | writing to files and pipes |

mod args;
mod check;
mod info;
mod output;
mod placements;
mod progress;
mod rays;
mod record;
mod rules;
mod scene;
mod suggest;
mod table;
mod text;
mod warnings;
mod words;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

/// What a run found out; an error is bad input or usage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Clean,
    Collisions,
}

/// The exit status for bad input or usage.
const FAILURE: u8 = 2;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let result = match &cli.command {
        Command::Check(args) => check::run(args),
        Command::Info(args) => info::run(args).map(|()| Verdict::Clean),
    };
    match result {
        Ok(Verdict::Clean) => ExitCode::SUCCESS,
        Ok(Verdict::Collisions) => ExitCode::from(1),
        Err(error) => {
            complain("error", format_args!("{error:#}"));
            ExitCode::from(FAILURE)
        }
    }
}

/// What clap has to say: help and the version on standard output, mistakes on standard error.
fn usage(error: &clap::Error) -> ExitCode {
    // There is nowhere to report that the message can't be written.
    let _ = error.print();
    if error.use_stderr() { ExitCode::from(FAILURE) } else { ExitCode::SUCCESS }
}

/// A line on standard error, in which nothing of a file or an argument moves the cursor. One that nobody reads is no failure.
fn complain(level: &str, message: impl std::fmt::Display) {
    let message = words::printable(&message.to_string());
    let _ = writeln!(std::io::stderr().lock(), "{level}: {message}");
}
