//! The install step: a prefix from which pkg-config and CMake build clients, and a static library that shows nothing but its
//! functions.
#![cfg(target_os = "linux")]

mod common;

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{crate_folder, has, library_folder, run, succeed, text, to_load_from};

/// Installs the library that the tests were built with.
fn install(name: &str) -> PathBuf {
    let prefix = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&prefix);
    let mut script = Command::new("sh");
    script.arg(crate_folder().join("install.sh")).arg(&prefix).arg(library_folder()).env_remove("DESTDIR");
    succeed(&mut script);
    prefix
}

fn flags(prefix: &Path, options: &[&str]) -> Vec<String> {
    let mut pkg_config = Command::new("pkg-config");
    pkg_config.args(options).arg("solid").env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    text(&succeed(&mut pkg_config).stdout).split_whitespace().map(String::from).collect()
}

/// Whether programs can be linked without any shared library; a word when not.
fn has_static_libc() -> bool {
    let path = text(&succeed(Command::new("cc").arg("-print-file-name=libc.a")).stdout);
    // Where there is none, the name comes back as it is.
    let found = Path::new(path.trim()).is_absolute();
    if !found {
        eprintln!("skipped: there is no static C library on this machine");
    }
    found
}

#[test]
fn pkg_config_builds_clients() {
    if !(has("cc") && has("pkg-config")) {
        return;
    }
    let prefix = install("pkg_config_prefix");
    let source = crate_folder().join("tests/c/manual.c");
    let shared = prefix.join("shared");
    let mut cc = Command::new("cc");
    cc.arg(&source).args(flags(&prefix, &["--cflags", "--libs"])).arg("-lm").arg("-o").arg(&shared);
    succeed(cc.arg(to_load_from(&prefix.join("lib"))));
    run(&shared);

    let alone = prefix.join("static");
    let mut cc = Command::new("cc");
    let libraries = flags(&prefix, &["--cflags", "--static", "--libs"]);
    cc.arg(&source).args(libraries.iter().map(|flag| flag.replace("-lsolid", "-l:libsolid.a")));
    succeed(cc.arg("-o").arg(&alone));
    run(&alone);

    if has_static_libc() {
        let whole = prefix.join("whole");
        let mut cc = Command::new("cc");
        succeed(cc.arg("-static").arg(&source).args(&libraries).arg("-o").arg(&whole));
        run(&whole);
    }
}

#[test]
fn the_static_library_shows_its_functions_only() {
    if !(has("nm") && has("objcopy") && has("ld")) {
        return;
    }
    let library = install("nm_prefix").join("lib/libsolid.a");
    let symbols = succeed(Command::new("nm").args(["-g", "--defined-only", "--format=posix"]).arg(library));
    let symbols = text(&symbols.stdout);
    let names: Vec<&str> = symbols
        .lines()
        .filter(|line| !line.ends_with(':'))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert_eq!(names.len(), 43, "{names:?}");
    assert!(names.iter().all(|name| name.starts_with("dt")), "{names:?}");
}

#[test]
fn cmake_builds_clients() {
    if !(has("cc") && has("cmake")) {
        return;
    }
    let prefix = install("cmake_prefix");
    let build = prefix.join("build");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(crate_folder().join("tests/cmake")).arg("-B").arg(&build);
    succeed(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display())));
    succeed(Command::new("cmake").arg("--build").arg(&build));
    run(build.join("client_solid"));
    run(build.join("client_solid_static"));
    if has_static_libc() {
        run(build.join("client_whole"));
    }
}

/// Installs below a folder, which is made anew, what cargo is told to build from there.
fn install_from(caller: &str, settings: &[(&str, &str)]) -> PathBuf {
    /// In place of cargo, which would take minutes: puts the libraries where cargo does, and tells it as cargo does.
    const CARGO: &str = r#"#!/bin/sh
target=$CARGO_TARGET_DIR
while [ $# -gt 0 ]; do
    if [ "$1" = --target-dir ]; then target=$2; fi
    shift
done
built=$target/${CARGO_BUILD_TARGET:+$CARGO_BUILD_TARGET/}release
mkdir -p "$built"
cp "$LIBRARIES/libsolid.so" "$LIBRARIES/libsolid.a" "$built/"
echo '{"reason":"compiler-artifact","filenames":["'"$target"'/release/deps/libsolid3d.rlib"],"fresh":true}'
echo '{"reason":"compiler-artifact","filenames":["'"$built"'/libsolid.so","'"$built"'/libsolid.a"],"fresh":true}'
echo '{"reason":"build-finished","success":true}'
"#;
    let caller = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(caller);
    let _ = fs::remove_dir_all(&caller);
    fs::create_dir_all(caller.join("bin")).expect("the folder can be made");
    fs::write(caller.join("bin/cargo"), CARGO).expect("the folder can be written");
    fs::set_permissions(caller.join("bin/cargo"), Permissions::from_mode(0o755)).expect("it is ours");
    let path = std::env::var("PATH").expect("there is a path");

    let mut script = Command::new("sh");
    script.arg(crate_folder().join("install.sh")).arg("prefix").current_dir(&caller);
    script.env("PATH", format!("{}:{path}", caller.join("bin").display())).env("LIBRARIES", library_folder());
    script.env_remove("DESTDIR").env_remove("CARGO_BUILD_TARGET").envs(settings.iter().copied());
    succeed(&mut script);
    caller
}

#[test]
fn a_relative_target_folder_is_one_of_the_caller() {
    let caller = install_from("caller", &[("CARGO_TARGET_DIR", "target folder")]);
    for file in ["target folder/release/libsolid.so", "prefix/lib/libsolid.so", "prefix/lib/libsolid.a"] {
        assert!(caller.join(file).is_file(), "{file}");
    }
}

#[test]
fn what_is_built_for_a_configured_target_is_installed() {
    let settings = [("CARGO_TARGET_DIR", "target"), ("CARGO_BUILD_TARGET", "some-target")];
    let caller = install_from("caller_with_target", &settings);
    for file in ["target/some-target/release/libsolid.so", "prefix/lib/libsolid.so", "prefix/lib/libsolid.a"]
    {
        assert!(caller.join(file).is_file(), "{file}");
    }
}
