//! The arms of the sample specifications against independently computed reference values.

mod faults;
mod urdf;
mod urdf_faults;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{Arm, Built, JointKind, Transform};
use crate::error::{Diagnostics, Error};
use crate::load::{Loaded, load, parse};

type Vector = [f64; 3];
type Matrix = [[f64; 3]; 3];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn data(name: &str) -> PathBuf {
    root().join("tests/data").join(name)
}

fn build(path: &Path) -> Built {
    let loaded = load(path).unwrap_or_else(|e| panic!("{e}"));
    let mut faults = Diagnostics::of(&loaded.path);
    let built = Arm::from_spec(&loaded, &mut faults);
    built.unwrap_or_else(|| panic!("{}", faults.into_error()))
}

fn reference(name: &str) -> Value {
    let text = std::fs::read_to_string(data(&format!("truth/{name}.json"))).expect("the reference file");
    serde_json::from_str(&text).expect("JSON")
}

fn vector(value: &Value) -> Vector {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

fn matrix(value: &Value) -> Matrix {
    std::array::from_fn(|i| vector(&value[i]))
}

fn motion(kind: JointKind, q: f64) -> Transform {
    match kind {
        JointKind::Revolute => Transform::rotation(2, q),
        JointKind::Prismatic => Transform::translation([0.0, 0.0, q]),
    }
}

fn turned(r: &Matrix, m: &Matrix) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (0..3).flat_map(|k| (0..3).map(move |l| (k, l))).map(|(k, l)| r[i][k] * m[k][l] * r[j][l]).sum()
        })
    })
}

fn near(what: &str, ours: &[f64], theirs: &[f64], slack: f64) {
    for (a, b) in ours.iter().zip(theirs) {
        assert!((a - b).abs() <= slack * b.abs().max(1.0), "{what}: {ours:?} instead of {theirs:?}");
    }
}

/// Compares what no choice of frames can change: for several q the axes, centres of mass and inertias in the base.
fn agrees(path: &Path, name: &str, count: usize) {
    let arm = build(path).arm;
    let truth = reference(name);
    assert_eq!(arm.dof(), count);
    for sample in truth["samples"].as_array().expect("samples").iter().take(5) {
        let (mut ours, mut theirs) = (Transform::IDENTITY, Transform::IDENTITY);
        for (i, joint) in arm.joints.iter().enumerate() {
            let given = &truth["joints"][i];
            let q = sample["q"][i].as_f64().expect("a number");
            ours = ours.then(&joint.pose).then(&motion(joint.kind, q));
            let axis = vector(&given["axis"]);
            let align = Transform::z_to(axis);
            let placed = Transform { rotation: matrix(&given["R"]), translation: vector(&given["p"]) };
            let moved = align.then(&motion(joint.kind, q)).then(&align.inverse());
            theirs = theirs.then(&placed).then(&moved);
            let what = format!("{name}, joint {}", i + 1);
            // UR5 files write π/2 with 12 digits, which the reference keeps and the arm snaps.
            let slack = 1e-11;
            near(&what, &ours.turn([0.0, 0.0, 1.0]), &theirs.turn(axis), slack);
            near(&what, &ours.apply(joint.body.com()), &theirs.apply(vector(&given["com"])), slack);
            assert!((joint.body.mass - given["mass"].as_f64().expect("mass")).abs() < 1e-12, "{what}");
            let a = turned(&ours.rotation, &joint.body.inertia_at_com());
            let b = turned(&theirs.rotation, &matrix(&given["I_com"]));
            near(&what, a.as_flattened(), b.as_flattened(), slack);
            if let Some(limits) = joint.limits.position {
                let qlim = [&given["qlim"][0], &given["qlim"][1]].map(|v| v.as_f64().expect("a limit"));
                assert_eq!(limits, qlim, "{what}");
            }
            let prismatic = given["type"] == "P";
            assert_eq!(joint.kind == JointKind::Prismatic, prismatic);
        }
    }
}

/// Where the frames are the same by convention, every number is.
fn agrees_frame_by_frame(path: &Path, name: &str) {
    let arm = build(path).arm;
    let truth = reference(name);
    for (i, joint) in arm.joints.iter().enumerate() {
        let given = &truth["joints"][i];
        let what = format!("{name}, joint {}", i + 1);
        near(&what, joint.pose.rotation.as_flattened(), matrix(&given["R"]).as_flattened(), 1e-12);
        near(&what, &joint.pose.translation, &vector(&given["p"]), 1e-15);
        near(&what, &joint.body.com(), &vector(&given["com"]), 1e-14);
        near(
            &what,
            joint.body.inertia_at_com().as_flattened(),
            matrix(&given["I_com"]).as_flattened(),
            1e-13,
        );
    }
}

#[test]
fn every_sample_arm_is_the_reference_arm() {
    let specs = root().join("generated/specs");
    agrees(&specs.join("arm3_xi2.json"), "threedof", 3);
    agrees(&specs.join("puma560_xi12.json"), "puma560", 6);
    agrees(&data("puma3.json"), "puma560", 3);
    agrees(&data("stanford.json"), "stanford", 6);
    agrees(&data("ur5.json"), "ur5", 6);
    agrees(&data("panda.json"), "panda", 7);
    agrees_frame_by_frame(&specs.join("arm3_xi2.json"), "threedof");
    agrees_frame_by_frame(&specs.join("puma560_xi12.json"), "puma560");
    agrees_frame_by_frame(&data("stanford.json"), "stanford");
    agrees_frame_by_frame(&data("panda.json"), "panda");
}

#[test]
fn motors_reach_the_joints_by_the_square_of_their_gears() {
    let arm = build(&root().join("generated/specs/puma560_xi12.json")).arm;
    let truth = reference("puma560");
    for (i, joint) in arm.joints.iter().enumerate() {
        let armature = truth["motor_inertia"]["G2Jm"][i].as_f64().expect("a number");
        assert!((joint.armature - armature).abs() < 1e-14);
        let link = &truth["dh"]["links"][i];
        let gear = link["G"].as_f64().expect("a number").abs();
        let coulomb = [&link["Tc"][0], &link["Tc"][1]].map(|v| gear * v.as_f64().expect("a number"));
        assert_eq!(joint.coulomb_friction, coulomb);
    }
    let stanford = build(&data("stanford.json")).arm;
    assert_eq!(stanford.joints[2].armature, 0.782);
}

#[test]
fn the_broken_triangle_of_the_published_puma_is_a_warning() {
    let warnings = build(&root().join("generated/specs/puma560_xi12.json")).warnings;
    assert!(warnings.iter().any(|w| w.contains("arm.dh.links[2].inertia") && w.contains("triangle")));
    assert!(build(&root().join("generated/specs/arm3_xi2.json")).warnings.is_empty());
}

#[test]
fn the_tip_of_the_panda_is_the_flange() {
    let arm = build(&data("panda.json")).arm;
    assert_eq!(arm.tip, Transform::translation([0.0, 0.0, 0.107]));
    assert_eq!(arm.joints[0].limits.torque, Some(87.0));
    assert_eq!(arm.joints[6].limits.velocity, Some(2.61));
    assert_eq!(arm.joints[3].name, "panda_joint4");
}

#[test]
fn modified_tables_describe_the_same_arm_as_standard_ones() {
    // A planar pair of rods: Craig's a belongs to the link before, and frames sit on the joints.
    let link = |a: f64, com: f64| {
        json!({ "joint": "revolute", "alpha": 0.0, "a": a, "d": 0.0, "mass": 1.0, "com": [com, 0.0, 0.0],
                "inertia": { "xx": 0.0, "yy": 0.1, "zz": 0.1 } })
    };
    let arm = |convention: &str, links: [Value; 2]| {
        let spec = json!({ "name": "a", "arm": { "dh": { "convention": convention, "links": links } },
                           "model": "exact" });
        arm_of(&spec).expect("an arm").arm
    };
    let standard = arm("standard", [link(1.0, -0.5), link(0.8, -0.4)]);
    let modified = arm("modified", [link(0.0, 0.5), link(1.0, 0.4)]);
    for (s, m) in standard.joints.iter().zip(&modified.joints) {
        assert_eq!(s.pose, m.pose);
        assert_eq!(s.body.com(), m.body.com());
    }
}

#[test]
fn a_payload_joins_the_last_body() {
    let path = root().join("generated/specs/arm3_xi2.json");
    let bare = build(&path).arm;
    let mut value: Value =
        serde_json::from_str(&std::fs::read_to_string(&path).expect("a file")).expect("JSON");
    value["arm"]["payload"] = json!({ "mass": 2.0, "com": [0.1, 0.0, 0.0] });
    let laden = arm_of(&value).expect("an arm").arm;
    assert_eq!(laden.joints[2].body.mass, 5.5);
    // The tip stands 0.6 m from joint 3.
    let moment = bare.joints[2].body.first_moment[0] + 2.0 * 0.7;
    assert!((laden.joints[2].body.first_moment[0] - moment).abs() < 1e-15);
    assert_eq!(laden.joints[1], bare.joints[1]);
}

fn loaded(value: &Value, path: &Path) -> Loaded {
    parse(&value.to_string(), path).unwrap_or_else(|e| panic!("{e}"))
}

fn arm_of(value: &Value) -> Result<Built, Error> {
    built(&loaded(value, Path::new("specs/a.json")))
}

fn built(loaded: &Loaded) -> Result<Built, Error> {
    let mut faults = Diagnostics::of(&loaded.path);
    match Arm::from_spec(loaded, &mut faults) {
        Some(built) => faults.finish(built),
        None => Err(faults.into_error()),
    }
}
