//! Instances of a mesh.

use super::*;

#[test]
fn each_instance_of_a_mesh_is_an_object() {
    let part = instances().parse().unwrap();
    let seen: Vec<_> = part.objects.iter().map(|o| (&o.name[..], &o.path[..])).collect();
    assert_eq!(seen, [("tree", &[0, 2][..]), ("tree", &[0, 3]), ("tree", &[0, 4]), ("bird", &[0, 1])]);
    assert_eq!(part.warnings, [""; 0]);
    let poses = pose(&part, 1.0);
    let at = |object: usize, point: DVec3| poses[object].placement.transform_point3(point);
    assert!(at(0, DVec3::X).abs_diff_eq(DVec3::new(11.0, 0.0, 0.0), 1e-6));
    assert!(at(1, DVec3::X).abs_diff_eq(DVec3::new(10.0, 7.0, 0.0), 1e-6));
    assert!(at(2, DVec3::X).abs_diff_eq(DVec3::new(13.0, 0.0, 7.0), 1e-6));
    assert!(at(3, DVec3::X).abs_diff_eq(DVec3::new(11.0, 0.0, 0.0), 1e-6));
    // What is not told is as in a node.
    let mut file = instances();
    let attributes = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    set(&mut file, attributes, json!({"_ID": 4}));
    let part = file.parse().unwrap();
    assert_eq!((part.objects.len(), pose(&part, 0.0)[2].placement), (4, DAffine3::IDENTITY));
    set(&mut file, attributes, json!({}));
    assert_eq!(file.parse().unwrap().objects.len(), 2);
}

#[test]
fn instances_are_checked() {
    let attributes = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    let changes = [
        (
            format!("{attributes}/SCALE"),
            json!(0),
            "node 0: instances, TRANSLATION has 3 elements, but ROTATION 4",
        ),
        (
            format!("{attributes}/SCALE"),
            json!(9),
            "node 0: instances, SCALE: accessor 9 is named, but there are 7",
        ),
        (
            format!("{attributes}/ROTATION"),
            json!(1),
            "node 0: instances, ROTATION: accessor 1 is of type Vec3; expected Vec4",
        ),
        (
            format!("{attributes}/TRANSLATION"),
            json!("x"),
            "not glTF 2.0: invalid type: string \"x\", expected usize",
        ),
        (
            "/accessors/4/count".to_owned(),
            json!(1_000_000_000),
            "numbers are more than a file of this size may hold",
        ),
    ];
    for (path, value, message) in changes {
        let mut file = instances();
        if message.ends_with("ROTATION 4") {
            let rotations = file.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0].repeat(4));
            set(&mut file, &format!("{attributes}/ROTATION"), json!(rotations));
        }
        if message.ends_with("may hold") {
            set(&mut file, attributes, json!({"_ID": 4}));
        }
        set(&mut file, &path, value);
        let refused = file.refused();
        assert!(refused.contains(message), "{path}: {refused}");
    }
    let mut file = instances();
    let zero = file.floats("VEC4", 3, &[0.0; 12]);
    set(&mut file, &format!("{attributes}/ROTATION"), json!(zero));
    assert_eq!(file.refused(), "node 0: instance 0 has a rotation of length 0");
    // A skin places the vertices in the world.
    let mut file = everything();
    file.0["nodes"][3]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    let part = file.parse_animation(Some("1")).unwrap();
    assert_eq!(
        (part.objects.len(), &part.warnings[..]),
        (2, &["`node3` has a skin, so that its instances are passed over".to_owned()][..])
    );
}

/// Each instance keeps the name, and the positions where the mesh changes its form.
#[test]
fn instances_take_no_memory_without_end() {
    let of_instances = |count: usize| {
        let mut file = instances();
        let translations = file.floats("VEC3", count, &vec![0.0; 3 * count]);
        set(
            &mut file,
            "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes",
            json!({"TRANSLATION": translations}),
        );
        file
    };
    let mut file = of_instances(257);
    file.0["nodes"][0]["name"] = json!("n".repeat(1 << 20));
    assert_eq!(file.refused(), "node 0: the names of the objects have more than 268435456 bytes in all");
    // A mesh of many vertices, which grows.
    let growing = |count: usize| {
        let mut file = of_instances(count);
        let positions = file.floats(
            "VEC3",
            1000,
            &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0].repeat(250),
        );
        let primitive = json!({"attributes": {"POSITION": positions}, "targets": [{"POSITION": positions}]});
        let mesh = file.add("meshes", json!({"primitives": [primitive]}));
        file.0["nodes"][0]["mesh"] = json!(mesh);
        let times = file.floats("SCALAR", 2, &[0.0, 1.0]);
        file.0["animations"] = json!([{
            "samplers": [{"input": times, "output": times}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        }]);
        file
    };
    assert_eq!(growing(300).parse().unwrap().objects.len(), 301);
    assert_eq!(
        growing(400).refused(),
        "node 0: positions of what deforms: 3000 numbers are more than a file of this size may hold"
    );
}
