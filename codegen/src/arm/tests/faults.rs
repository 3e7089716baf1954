//! What is said about faulty DH tables.

use serde_json::{Value, json};

use super::arm_of;

/// The faults of arm3.json after `edit`, which must be as many as `parts` and each hold its part.
fn expect(edit: impl Fn(&mut Value), parts: &[&str]) {
    let text = include_str!("../../../../generated/specs/arm3_xi2.json");
    let mut value: Value = serde_json::from_str(text).expect("JSON");
    edit(&mut value);
    let message = arm_of(&value).expect_err("a fault").to_string();
    assert_eq!(message.lines().count(), parts.len(), "{message}");
    for part in parts {
        assert!(message.contains(part), "{message:?} lacks {part:?}");
        assert!(message.starts_with("specs/a.json: arm"), "{message}");
    }
}

#[test]
fn faults_of_tables_name_field_value_and_help() {
    let link = |v: &mut Value, i: usize, name: &str, to: Value| v["arm"]["dh"]["links"][i][name] = to;
    let com = json!([0.0, 0.0, 0.0]);
    expect(
        |v| link(v, 1, "mass", json!(-4.0)),
        &["arm.dh.links[1].mass: is -4; write a number of at least 0"],
    );
    expect(|v| link(v, 1, "mass", json!(0.0)), &["links[1].first_moment: is [-0.375, 0.0, 0.0] although"]);
    expect(
        |v| link(v, 0, "com", com.clone()),
        &["links[0]: mixes `first_moment`, `pseudo_inertia`, `com`; keep"],
    );
    expect(
        |v| {
            let _ = v["arm"]["dh"]["links"][2].as_object_mut().expect("a link").remove("pseudo_inertia");
        },
        &["links[2]: has `first_moment` without `pseudo_inertia`; add `pseudo_inertia`"],
    );
    expect(
        |v| {
            let link = v["arm"]["dh"]["links"][2].as_object_mut().expect("a link");
            link.remove("pseudo_inertia");
            link.remove("first_moment");
        },
        &["links[2]: has no inertial data beside its mass; add `com` and `inertia`"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][2]["pseudo_inertia"]["xx"] = json!(-0.12),
        &["links[2].pseudo_inertia: gives the principal moment -1.45"],
    );
    expect(
        |v| {
            link(v, 0, "motor", json!({ "inertia": 1e-4, "gear_ratio": 0.0 }));
            link(v, 1, "motor", json!({ "inertia": -1e-4, "gear_ratio": 50.0 }));
            link(v, 2, "motor", json!({ "inertia": 1e-4, "gear_ratio": 50.0 }));
            link(v, 2, "armature", json!(0.1));
        },
        &[
            "links[0].motor.gear_ratio: is 0; write",
            "links[1].motor.inertia: is -0.0001; write a number of at least 0",
            "links[2].armature: is given together with `motor`",
        ],
    );
    expect(
        |v| {
            link(v, 0, "armature", json!(-0.1));
            link(v, 0, "viscous_friction", json!(-0.2));
            link(v, 1, "coulomb_friction", json!([-1.0, 1.0]));
            link(v, 2, "coulomb_friction", json!(-1.0));
        },
        &[
            "links[0].armature: is -0.1",
            "links[0].viscous_friction: is -0.2",
            "links[1].coulomb_friction: is [-1.0, 1.0]; write [torque forwards",
            "links[2].coulomb_friction: is -1;",
        ],
    );
    expect(
        |v| {
            link(v, 0, "limits", json!({ "position": [1.0, -1.0], "velocity": 0.0 }));
            link(v, 1, "limits", json!({ "acceleration": -1.0, "torque": -1.0 }));
        },
        &[
            "links[0].limits.position: is [1.0, -1.0]; write [lowest, highest]",
            "links[0].limits.velocity: is 0; write a number above 0, in rad/s",
            "links[1].limits.acceleration: is -1; write a number above 0, in rad/s²",
            "links[1].limits.torque: is -1; write a number above 0, in N·m",
        ],
    );
    expect(|v| v["arm"]["dh"]["links"] = json!([]), &["arm.dh.links: has 0 links; write 1 to 8 links"]);
    expect(|v| v["arm"]["tip"] = json!("hand"), &["arm.tip: applies only to `urdf`"]);
    expect(|v| v["arm"]["urdf"] = json!("x.urdf"), &["arm: has both `dh` and `urdf`; keep"]);
    expect(|v| link(v, 0, "a", json!(1e300)), &["arm: has lengths and masses whose products overflow"]);
    expect(|v| v["arm"] = json!({}), &["arm: has neither `dh` nor `urdf`; add"]);
    expect(
        |v| v["arm"]["payload"] = json!({ "mass": -1.0 }),
        &["arm.payload.mass: is -1; write a number of at least 0, in kg"],
    );
}
