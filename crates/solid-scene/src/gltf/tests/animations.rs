//! Animations and skins: what has no effect, and what is refused.

use super::*;

#[test]
fn an_animation_that_has_no_effect_is_warned_of() {
    let mut file = everything();
    file.0["nodes"][1] = json!({"children": [2], "matrix": glam::Mat4::IDENTITY.to_cols_array()});
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["node 1 has a matrix, so that its animation has no effect"]);
    // The weights of a node with a matrix change.
    let mut file = everything();
    let placed = file.0["nodes"][3].as_object_mut().unwrap();
    placed.remove("scale");
    placed.insert("matrix".to_owned(), json!(glam::Mat4::IDENTITY.to_cols_array()));
    assert_eq!(file.parse().unwrap().warnings.len(), 1);
}

/// A channel may leave it to an extension to say what it changes (glTF 2.0, section 5.8).
#[test]
fn a_channel_without_a_node_is_passed_over() {
    let mut file = everything();
    let without =
        json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {}}}});
    file.0["animations"][0]["channels"].as_array_mut().unwrap().insert(1, without.clone());
    let expected = pose(&everything().parse().unwrap(), 2.0);
    for (text, bytes) in [(true, file.0.to_string().into_bytes()), (false, binary(&file))] {
        let part = parse(&bytes, Path::new(""), None).unwrap();
        assert_eq!(
            part.warnings[1..],
            ["animation `all`: 1 channel that names no node is passed over"],
            "{text}"
        );
        assert_eq!(pose(&part, 2.0), expected);
    }
    file.0["animations"][0]["channels"].as_array_mut().unwrap().push(without);
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["animation `all`: 2 channels that name no node are passed over"]);
    assert_eq!(file.parse_animation(Some("1")).unwrap().warnings, [""; 0]);
}

/// A mistake elsewhere in such a file is told by its line, too.
#[test]
fn a_channel_without_a_node_leaves_lines_as_they_are() {
    let mut file = everything();
    set(&mut file, "/accessors/0/count", json!("x"));
    let told = |file: &File| {
        let text = serde_json::to_string_pretty(&file.0).unwrap();
        parse(text.as_bytes(), Path::new(""), None).map(|_| ()).unwrap_err().message().to_owned()
    };
    assert!(told(&file).starts_with("not glTF 2.0: invalid type: string \"x\""), "{}", told(&file));
    let expected = told(&file);
    assert!(expected.contains(" at line "), "{expected}");
    file.0["animations"][0]["channels"][0]["target"].as_object_mut().unwrap().remove("node");
    assert_eq!(told(&file), expected);
}

/// A scene need not have nodes.
#[test]
fn an_empty_scene_is_one() {
    let mut file = everything();
    let expected = pose(&file.parse().unwrap(), 2.0);
    file.add("scenes", json!({"name": "empty"}));
    assert_eq!(pose(&file.parse().unwrap(), 2.0), expected);
}

/// A name that is a number, too, is a name first.
#[test]
fn an_animation_is_chosen_by_name_before_number() {
    let mut file = everything();
    file.0["animations"][0]["name"] = json!("1");
    assert_eq!(file.parse_animation(Some("1")).unwrap().duration, 3.0);
    file.0["animations"][0]["name"] = json!("2");
    assert_eq!(file.parse_animation(Some("1")).unwrap().duration, 0.0);
}

/// Exporters round weights, each on its own.
#[test]
fn weights_count_by_their_parts_of_the_sum() {
    let with = |weights: [f32; 4]| {
        let mut file = everything();
        let weights = file.floats("VEC4", 4, &weights.repeat(4));
        set(&mut file, "/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
        pose(&file.parse().unwrap(), 2.0)
    };
    assert_eq!(with([0.25, 0.25, 0.0, 0.0]), with([0.5, 0.5, 0.0, 0.0]));
}

/// A skin has no effect where no vertex follows a joint, and why is said.
#[test]
fn a_mesh_that_follows_no_joint_is_warned_of() {
    let mut file = everything();
    let weights = file.floats("VEC4", 4, &[0.0; 16]);
    set(&mut file, "/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["all weights of mesh 0 are 0, so skin 0 has no effect on it"]);
    let attributes = file.0["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap();
    attributes.retain(|name, _| name == "POSITION");
    let warnings = file.parse().unwrap().warnings;
    assert_eq!(warnings[1..], ["mesh 0 has no JOINTS_0, so skin 0 has no effect on it"]);
}

#[test]
fn an_animation_ends_with_its_last_key() {
    let mut file = everything();
    let longer = file.floats("SCALAR", 2, &[0.0, 7.0]);
    for sampler in 0..3 {
        let mut file = File(file.0.clone());
        set(&mut file, &format!("/animations/0/samplers/{sampler}/input"), json!(longer));
        assert_eq!(file.parse().unwrap().duration, 7.0, "{sampler}");
    }
}

#[test]
fn keys_are_finite_and_in_order() {
    let scalars = [
        ("input", [3.0, 1.0], "channel 2 has a key at 1 after one at 3"),
        ("input", [1.0, f32::INFINITY], "channel 2 has a key at inf; expected a finite time"),
        ("output", [0.0, f32::NAN], "channel 2 has the value NaN; expected finite numbers"),
    ];
    for (name, values, message) in scalars {
        let mut file = everything();
        let accessor = file.floats("SCALAR", 2, &values);
        file.is_refused_with(&format!("/animations/0/samplers/2/{name}"), json!(accessor), message);
    }
    let mut file = everything();
    let turns = file.floats("VEC4", 2, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let message = "channel 0: the rotation of key 1 has length 0";
    file.is_refused_with("/animations/0/samplers/0/output", json!(turns), message);
}

#[test]
fn skins_and_animations_are_checked() {
    let changes = [
        ("/skins/0/joints/1", json!(9), "skin 0: node 9 is named, but there are 4"),
        ("/skins/0/joints", json!([1]), "a vertex follows joint 1, but there is 1"),
        ("/skins/0/joints", json!([0, 1, 2]), "skin 0 has 3 joints, but 2 inverseBindMatrices"),
        ("/nodes/3/skin", json!(2), "skin 2 is named, but there is 1"),
        ("/accessors/1/count", json!(3), "target 0 has 3 elements; expected 4, one for each vertex"),
        ("/accessors/2/count", json!(3), "JOINTS has 3 elements; expected 4, one for each vertex"),
        ("/accessors/3/count", json!(3), "WEIGHTS has 3 elements; expected 4, one for each vertex"),
        ("/animations/0/channels/0/sampler", json!(3), "animation `all`, channel 0: sampler 3 is named"),
        ("/animations/0/channels/0/target/node", json!(4), "animation `all`, channel 0: node 4 is named"),
        (
            "/animations/0/samplers/0/output",
            json!(4),
            "channel 0, output: accessor 4 is of type Scalar; expected Vec4",
        ),
        ("/animations/0/samplers/0/interpolation", json!("CURVE"), "channel 0 has an unknown interpolation"),
        ("/animations/0/samplers/1/interpolation", json!("LINEAR"), "channel 1 has 2 keys, but 6 values"),
        (
            "/meshes/0/primitives/0/targets",
            json!([{}, {}]),
            "animation `all`, channel 2: a key has 1 weight, but the mesh of node 3 has 2 targets",
        ),
    ];
    for (path, value, message) in changes {
        everything().is_refused_with(path, value, message);
    }
    let mut file = everything();
    let refused = file.parse_animation(Some("x")).unwrap_err();
    assert_eq!(refused, "there is no animation `x`; the animations of the file are `all`, 1");
    file.0["animations"].as_array_mut().unwrap().truncate(1);
    let refused = file.parse_animation(Some("1")).unwrap_err();
    assert_eq!(refused, "there is no animation `1`; the only one of the file is `all`");
    file.0["animations"] = json!([]);
    let refused = file.parse_animation(Some("0")).unwrap_err();
    assert_eq!(refused, "there is no animation `0`; the file has none");
}
