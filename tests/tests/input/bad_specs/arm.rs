//! Mistakes in the description of the arm, from DH tables.

use serde_json::{Value, json};

use super::case::{Case, case, judge};

const CASES: &[Case] = &[
    case(
        "negative mass",
        |i| {
            i.link(1, "mass", json!(-4.0));
        },
        "arm.dh.links[1].mass",
        &["is -4", "at least 0, in kg"],
    ),
    case(
        "massless link with a first moment",
        |i| {
            i.link(1, "mass", json!(0.0));
        },
        "arm.dh.links[1].first_moment",
        &["although the mass is 0", "write the mass"],
    ),
    case(
        "indefinite inertia",
        |i| {
            i.set("/arm/dh/links/0/pseudo_inertia/yy", json!(-0.208));
        },
        "arm.dh.links[0].pseudo_inertia",
        &["principal moment -", "check signs, units"],
    ),
    case(
        "motor beside armature",
        |i| {
            i.link(0, "armature", json!(0.1));
            i.link(0, "motor", json!({ "inertia": 0.001, "gear_ratio": 50.0 }));
        },
        "arm.dh.links[0].armature",
        &["together with `motor`", "remove `armature` or `motor`"],
    ),
    case(
        "gear ratio of zero",
        |i| {
            i.link(0, "motor", json!({ "inertia": 0.001, "gear_ratio": 0.0 }));
        },
        "arm.dh.links[0].motor.gear_ratio",
        &["is 0", "motor turns per joint turn"],
    ),
    case(
        "both inertial forms",
        |i| {
            i.link(0, "com", json!([0.0, 0.0, 0.0]));
            i.link(0, "inertia", json!({ "xx": 1.0, "yy": 1.0, "zz": 1.0 }));
        },
        "arm.dh.links[0]",
        &["mixes `first_moment`, `pseudo_inertia`, `com`, `inertia`", "keep"],
    ),
    case(
        "no inertial form",
        |i| {
            i.remove("/arm/dh/links/2/first_moment").remove("/arm/dh/links/2/pseudo_inertia");
        },
        "arm.dh.links[2]",
        &["no inertial data", "add `com` and `inertia`"],
    ),
    case(
        "half an inertial form",
        |i| {
            i.remove("/arm/dh/links/2/first_moment");
        },
        "arm.dh.links[2]",
        &["`pseudo_inertia` without `first_moment`", "add `first_moment`"],
    ),
    case(
        "no joints",
        |i| {
            i.set("/arm/dh/links", json!([]));
        },
        "arm.dh.links",
        &["has 0 links", "write 1 to 8"],
    ),
    case(
        "nine joints",
        |i| {
            let link = i.spec["arm"]["dh"]["links"][0].clone();
            i.set("/arm/dh/links", Value::Array(vec![link; 9]));
        },
        "arm.dh.links",
        &["has 9 links", "write 1 to 8"],
    ),
    case(
        "reversed limits",
        |i| {
            i.link(1, "limits", json!({ "position": [3.0, -3.0] }));
        },
        "arm.dh.links[1].limits.position",
        &["is [3.0, -3.0]", "[lowest, highest]"],
    ),
    case(
        "velocity limit of zero",
        |i| {
            i.link(1, "limits", json!({ "velocity": 0.0 }));
        },
        "arm.dh.links[1].limits.velocity",
        &["is 0", "above 0, in rad/s"],
    ),
    case(
        "negative torque limit",
        |i| {
            i.link(1, "limits", json!({ "torque": -5.0 }));
        },
        "arm.dh.links[1].limits.torque",
        &["is -5", "above 0, in N·m"],
    ),
    case(
        "sign of Coulomb friction",
        |i| {
            i.link(2, "coulomb_friction", json!([0.4, 0.4]));
        },
        "arm.dh.links[2].coulomb_friction",
        &["is [0.4, 0.4]", "the second ≤ 0"],
    ),
    case(
        "negative viscous friction",
        |i| {
            i.link(2, "viscous_friction", json!(-1.0));
        },
        "arm.dh.links[2].viscous_friction",
        &["is -1", "at least 0"],
    ),
    case(
        "negative payload",
        |i| {
            i.set("/arm/payload", json!({ "mass": -1.0 }));
        },
        "arm.payload.mass",
        &["is -1", "at least 0, in kg"],
    ),
    case(
        "dh and urdf",
        |i| {
            i.set("/arm/urdf", json!("arm.urdf"));
        },
        "arm",
        &["both `dh` and `urdf`", "keep the one"],
    ),
    case(
        "neither dh nor urdf",
        |i| {
            i.remove("/arm/dh");
        },
        "arm",
        &["neither `dh` nor `urdf`", "add a DH table"],
    ),
    case(
        "tip beside dh",
        |i| {
            i.set("/arm/tip", json!("hand"));
        },
        "arm.tip",
        &["applies only to `urdf`", "remove it"],
    ),
    case(
        "lock beside dh",
        |i| {
            i.set("/arm/lock", json!({ "joint1": 0.0 }));
        },
        "arm.lock",
        &["applies only to `urdf`", "remove it"],
    ),
    case(
        "singular inertia matrix",
        |i| {
            i.link(2, "mass", json!(0.0));
            i.link(2, "first_moment", json!([0.0, 0.0, 0.0]));
            i.link(2, "pseudo_inertia", json!({ "xx": 0.0, "yy": 0.0, "zz": 0.0 }));
        },
        "arm",
        &["inertia matrix D(q)", "smallest eigenvalue", "give every joint some inertia"],
    ),
    case(
        "masses that overflow",
        |i| {
            i.link(1, "a", json!(1e200));
        },
        "arm",
        &["overflow", "SI units"],
    ),
];

#[test]
fn arm() {
    judge(CASES);
}
