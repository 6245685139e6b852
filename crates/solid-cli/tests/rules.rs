//! `--rules`, from the outside.

#![allow(clippy::unwrap_used, reason = "a test that can't go on shall stop")]

mod harness;

use harness::{BOX, Desk, Run};

/// Three boxes in one place.
fn run(rules: &str, more: &str) -> Run {
    let desk = Desk::with_boxes().file("mine1.obj", BOX).file("r.toml", rules);
    desk.run(&format!("check a.obj b.obj mine1.obj --rules r.toml --json - {more}"))
}

/// The pairs that collide, each with what is known: nothing (simple), a point (witness).
fn pairs(rules: &str, more: &str) -> Vec<String> {
    let json = run(rules, more).json();
    let collisions = json["frames"][0]["collisions"].as_array().unwrap().clone();
    let word = |c: &serde_json::Value| {
        let known = if c["point"].is_null() { "simple" } else { "point" };
        format!("{} {} {known}", c["a"].as_str().unwrap(), c["b"].as_str().unwrap())
    };
    collisions.iter().map(word).collect()
}

fn object(name: &str, response: &str) -> String {
    format!("[[object]]\nname = \"{name}\"\nresponse = \"{response}\"\n")
}

fn pair(a: &str, b: &str, response: &str) -> String {
    format!("[[pair]]\na = \"{a}\"\nb = \"{b}\"\nresponse = \"{response}\"\n")
}

#[test]
fn pair_goes_before_object_and_object_before_default() {
    assert_eq!(pairs("", ""), ["a b point", "a mine1 point", "b mine1 point"]);
    let rules =
        format!("default = \"simple\"\n{}{}", object("mine*", "ignore"), pair("mine?", "b", "witness"));
    assert_eq!(pairs(&rules, ""), ["a b simple", "b mine1 point"]);
    assert_eq!(pairs(&rules, "--response witness"), ["a b point", "b mine1 point"]);
    assert!(pairs(&pair("*", "*", "ignore"), "").is_empty());
}

#[test]
fn ignoring_everything_makes_status_0() {
    run("default = \"ignore\"", "").assert_status(0);
}

#[test]
fn a_pattern_that_matches_nothing_is_warned_of() {
    let run = run(&object("mine2", "ignore"), "");
    assert_eq!(run.stderr, "warning: r.toml:2: \"mine2\" matches no object; did you mean \"mine1\"?\n");
    run.assert_status(1);
}

#[test]
fn with_strict_a_warning_is_an_error() {
    let warned = run(&object("mine2", "ignore"), "--strict");
    assert_eq!(warned.json()["frames"][0]["collisions"].as_array().unwrap().len(), 3);
    assert!(
        warned.stderr.ends_with("error: there is 1 warning, which --strict does not allow\n"),
        "{}",
        warned.stderr
    );
    warned.assert_status(2);
    run("", "--strict").assert_status(1);
    let desk = Desk::new().file("two.obj", format!("o a\n{BOX}"));
    let alone = desk.run("check two.obj");
    assert!(
        alone.stderr.contains("one object alone") && alone.stderr.contains("--split"),
        "{}",
        alone.stderr
    );
    alone.assert_status(0);
}

#[test]
fn a_pair_may_have_a_clearance_and_no_response() {
    let apart = pair("b", "*", "ignore") + &pair("a", "*", "ignore");
    let near = format!("{apart}[[pair]]\na = \"a\"\nb = \"mine1\"\nclearance = 1.0\n");
    assert!(pairs(&near, "").is_empty());
    let near = "[[pair]]\na = \"a\"\nb = \"mine1\"\nclearance = 1.0\n";
    assert_eq!(pairs(near, ""), ["a b point", "a mine1 point", "b mine1 point"]);
    // What collides is near.
    assert_eq!(run(near, "").json()["frames"][0]["near"].as_array().unwrap().len(), 3);
    assert!(run("", "").json()["frames"][0]["near"].is_null());
}

#[test]
fn mistakes_name_file_and_line() {
    run("default = \"loud\"", "").assert_fails(&[
        "r.toml:1: ",
        "`loud`",
        "`ignore`, `simple`, `witness`, `smart`, `curve`, `depth`, `contacts`",
    ]);
    run("\n\n[[objects]]\n", "").assert_fails(&["r.toml:3: ", "`objects`", "`object`"]);
    run("[[object]]\nname = \"a\"\nresponse = \"simple\"\ncolour = 1\n", "")
        .assert_fails(&["r.toml:4: ", "`colour`"]);
    run("[[object]]\nname = [\n", "").assert_fails(&["r.toml:"]);
    run(&"[".repeat(100_000), "").assert_fails(&["r.toml:"]);
    run(&format!("default = {}", "[".repeat(100_000)), "").assert_fails(&["r.toml:"]);
    Desk::with_boxes().run("check a.obj --rules none.toml").assert_fails(&["none.toml"]);
}
