//! Compiling and running C and C++ programs against the library that these tests were built with.
#![allow(dead_code, reason = "not every test uses all of it")]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// How a program is linked.
#[derive(Clone, Copy, Debug)]
pub enum Linking {
    Shared,
    Static,
}

/// What Rust's standard library needs from the system, when it is linked into a C program; compilers name what unwinds themselves.
const SYSTEM_LIBRARIES: [&str; 3] = ["-lpthread", "-ldl", "-lm"];

pub fn crate_folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where cargo puts what these tests depend on: the libraries among it.
pub fn library_folder() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows its own path");
    test.parent().expect("it lies in a folder").to_path_buf()
}

/// Whether a program can be run; a word when not.
pub fn has(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok();
    if !found {
        eprintln!("skipped: there is no `{program}` on this machine");
    }
    found
}

/// What tells the linker where a program finds its library: before it looks into the folders that cargo names, where an older one may lie.
pub fn to_load_from(folder: &Path) -> String {
    format!("-Wl,--disable-new-dtags,-rpath,{}", folder.display())
}

/// Compiles a source of `tests/c`, and returns the program.
pub fn compile(source: &str, linking: Linking, flags: &[&str]) -> PathBuf {
    let path = crate_folder().join("tests/c").join(source);
    let name: String = flags.concat().chars().filter(char::is_ascii_alphanumeric).collect();
    let program = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{source}.{linking:?}.{name}"));
    let is_cpp = source.ends_with(".cpp") || flags.iter().any(|flag| flag.starts_with("-std=c++"));
    let mut compiler = Command::new(if is_cpp { "c++" } else { "cc" });
    compiler.args(flags).args(["-O1", "-g", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function"]);
    compiler.arg("-I").arg(crate_folder().join("include")).arg(&path).arg("-o").arg(&program);
    let libraries = library_folder();
    match linking {
        Linking::Shared => {
            compiler.arg("-L").arg(&libraries).arg("-lsolid").arg("-lm");
            compiler.arg(to_load_from(&libraries));
        }
        Linking::Static => {
            compiler.arg(libraries.join("libsolid.a")).args(SYSTEM_LIBRARIES);
        }
    }
    succeed(&mut compiler);
    program
}

/// Runs a command that must succeed.
pub fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{stdout}\n{stderr}", output.status);
    output
}

pub fn run(program: impl AsRef<OsStr>) -> Output {
    succeed(&mut Command::new(program))
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
