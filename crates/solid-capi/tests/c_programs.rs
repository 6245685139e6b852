//! Programs in C and C++ against the shared and the static library: every function, appendix B of the thesis, the headers in
//! every dialect, what is exported, and valgrind's opinion.
#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod common;

use std::path::PathBuf;
use std::process::Command;

use common::{Linking, compile, crate_folder, has, library_folder, run, succeed, text, to_load_from};

const PROGRAMS: [&str; 9] = [
    "shapes.c",
    "objects.c",
    "responses.c",
    "deformation.c",
    "callbacks.c",
    "errors.c",
    "frames.c",
    "ending.c",
    "manual.c",
];

/// The 39 functions of SOLID 2.0, that of 2.1, and the extension of `SOLID/error.h`.
const FUNCTIONS: [&str; 43] = [
    "dtBegin",
    "dtBox",
    "dtChangeVertexBase",
    "dtClearDefaultResponse",
    "dtClearError",
    "dtClearObjectResponse",
    "dtClearPairResponse",
    "dtCone",
    "dtCreateObject",
    "dtCylinder",
    "dtDeleteObject",
    "dtDeleteShape",
    "dtDisableCaching",
    "dtEnableCaching",
    "dtEnd",
    "dtEndComplexShape",
    "dtGetError",
    "dtGetErrorMessage",
    "dtLoadIdentity",
    "dtLoadMatrixd",
    "dtLoadMatrixf",
    "dtMultMatrixd",
    "dtMultMatrixf",
    "dtNewComplexShape",
    "dtProceed",
    "dtResetObjectResponse",
    "dtResetPairResponse",
    "dtRotate",
    "dtScale",
    "dtSelectObject",
    "dtSetDefaultResponse",
    "dtSetObjectResponse",
    "dtSetPairResponse",
    "dtSetTolerance",
    "dtSphere",
    "dtTest",
    "dtTestObjects",
    "dtTranslate",
    "dtVertex",
    "dtVertexBase",
    "dtVertexIndex",
    "dtVertexIndices",
    "dtVertexRange",
];

#[test]
fn programs_pass() {
    if !has("cc") {
        return;
    }
    for program in PROGRAMS {
        for linking in [Linking::Shared, Linking::Static] {
            run(compile(program, linking, &["-std=c89", "-pedantic"]));
        }
    }
}

#[test]
fn headers_suit_every_dialect() {
    if has("cc") {
        for dialect in ["-std=c89", "-std=c99", "-std=c11"] {
            run(compile("header.c", Linking::Shared, &[dialect, "-pedantic", "-Wshadow", "-Wconversion"]));
        }
    }
    if has("c++") {
        for dialect in ["-std=c++98", "-std=c++11", "-std=c++14", "-std=c++17", "-std=c++20", "-std=c++2b"] {
            for program in ["header.c", "classes.cpp", "original.cpp"] {
                run(compile(program, Linking::Shared, &[dialect, "-pedantic", "-Wshadow", "-Wconversion"]));
            }
        }
        for program in ["classes.cpp", "original.cpp"] {
            run(compile(program, Linking::Static, &["-std=c++98", "-pedantic"]));
        }
    }
}

/// The shared library exports its functions and nothing else, under the name that programs of 1999 look for.
#[test]
fn nothing_else_is_exported() {
    if !(has("nm") && has("readelf")) {
        return;
    }
    let library = library_folder().join("libsolid.so");
    let symbols = succeed(Command::new("nm").args(["-D", "--defined-only", "--format=posix"]).arg(&library));
    let mut names: Vec<String> = text(&symbols.stdout)
        .lines()
        .filter_map(|line| line.split_whitespace().next().map(String::from))
        .collect();
    names.sort();
    assert_eq!(names, FUNCTIONS);
    let dynamic = succeed(Command::new("readelf").arg("-d").arg(&library));
    assert!(text(&dynamic.stdout).contains("Library soname: [libsolid.so]"));
}

/// Every function is declared in a header, and called by a program above.
#[test]
fn every_function_is_declared_and_called() {
    let read = |path: &str| std::fs::read_to_string(crate_folder().join(path)).unwrap();
    let headers = read("include/SOLID/solid.h") + &read("include/SOLID/error.h");
    let programs: String = PROGRAMS.map(|program| read(&format!("tests/c/{program}"))).concat();
    for function in FUNCTIONS {
        assert!(headers.contains(&format!(" {function}(")) || headers.contains(&format!("*{function}(")));
        assert!(programs.contains(&format!("{function}(")), "{function} is not called");
    }
}

/// No error, and nothing left after everything is deleted. As the README has it, for an optimised library has instructions that
/// valgrind does not know.
#[test]
fn valgrind_has_nothing_to_say() {
    if !(has("cc") && has("valgrind")) {
        return;
    }
    for program in PROGRAMS {
        let program = compile(program, Linking::Shared, &["-std=c99"]);
        let mut valgrind = Command::new("valgrind");
        if !cfg!(debug_assertions) {
            valgrind.env("SOLID_SIMD", "scalar");
        }
        valgrind.args([
            "--error-exitcode=9",
            "--leak-check=full",
            "--errors-for-leak-kinds=definite,indirect,possible",
        ]);
        succeed(valgrind.arg("--quiet").arg(program));
    }
}

/// `SOLID_ERRORS` prints what is wrong; without it the library is silent.
#[test]
fn the_environment_variable_prints() {
    if !has("cc") {
        return;
    }
    let program = compile("errors.c", Linking::Shared, &["-std=c99", "-O0"]);
    let stderr = |value: Option<&str>| {
        let mut command = Command::new(&program);
        match value {
            Some(value) => command.env("SOLID_ERRORS", value),
            None => command.env_remove("SOLID_ERRORS"),
        };
        text(&succeed(&mut command).stderr)
    };
    assert_eq!(stderr(None), "");
    assert_eq!(stderr(Some("0")), "");
    assert_eq!(stderr(Some("")), "");
    let printed = stderr(Some("1"));
    assert!(printed.starts_with("libsolid: dtBox: x is -1.0; it must be from 0 to 1e100\n"), "{printed}");
    assert!(printed.lines().all(|line| line.starts_with("libsolid: dt")), "{printed}");
}

/// The program of the README prints what the README says.
#[test]
fn the_readme_is_right() {
    if !has("cc") {
        return;
    }
    let readme = std::fs::read_to_string(crate_folder().join("README.md")).unwrap();
    let block = |fence: &str, word: &str| {
        let blocks = readme.split("```").filter_map(|block| block.strip_prefix(fence));
        blocks.into_iter().find(|block| block.contains(word)).unwrap().to_string()
    };
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let (source, program) = (folder.join("readme.c"), folder.join("readme"));
    std::fs::write(&source, block("c\n", "int main")).unwrap();
    let mut cc = Command::new("cc");
    cc.arg("-I").arg(crate_folder().join("include")).arg(source).arg("-o").arg(&program);
    cc.arg("-L").arg(library_folder()).arg("-lsolid");
    succeed(cc.arg(to_load_from(&library_folder())));
    assert_eq!(text(&run(program).stdout), block("text\n", "ouch"));
}
