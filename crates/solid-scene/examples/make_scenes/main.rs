//! Writes the generated example scenes into a folder: `cargo run -p solid-scene --example make_scenes -- scenes`.
//!
//! The same bytes on every machine; `tests/scenes.rs` compares them with what is in `scenes/`.

mod generate;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("usage: make_scenes FOLDER");
        return ExitCode::from(2);
    };
    match generate::write_all(Path::new(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", Path::new(&folder).display());
            ExitCode::from(2)
        }
    }
}
