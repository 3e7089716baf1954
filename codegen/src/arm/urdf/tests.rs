//! URDF features and faults, on a small arm written here.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{built, loaded, near};
use crate::arm::{JointKind, Transform};

/// A turning and a sliding joint, a camera welded to the first link, a finger on the second.
const ARM: &str = r#"<?xml version="1.0"?>
<robot name="small">
  <link name="base"><inertial><mass value="9"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="upper"><inertial><origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial></link>
  <link name="camera"><inertial><mass value="0.5"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="slide"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <link name="finger"><inertial><mass value="0.25"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="tool"/>
  <joint name="swing" type="revolute"><origin xyz="0 0 1"/><parent link="base"/><child link="upper"/>
    <axis xyz="0 2 0"/><limit lower="-1" upper="2" effort="0" velocity="3"/>
    <dynamics damping="0.5" friction="0.25"/></joint>
  <joint name="mount" type="fixed"><origin xyz="0 0 0.3"/><parent link="upper"/><child link="camera"/></joint>
  <joint name="reach" type="prismatic"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="slide"/>
    <limit lower="0" upper="0.4" effort="80" velocity="1"/></joint>
  <joint name="grip" type="prismatic"><origin xyz="0 0 0"/><parent link="slide"/><child link="finger"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><origin xyz="0.2 0 0"/><parent link="slide"/><child link="tool"/></joint>
</robot>
"#;

/// Writes `urdf` into a folder of its own and gives the folder back.
fn folder(name: &str, urdf: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gramforge-urdf-{}-{name}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("arm.urdf"), urdf).expect("a file");
    folder
}

fn spec(arm: Value) -> Value {
    let mut arm = arm;
    arm["urdf"] = json!("arm.urdf");
    json!({ "name": "small", "arm": arm, "model": "exact" })
}

fn usual() -> Value {
    json!({ "tip": "tool", "lock": { "grip": 0.04 } })
}

fn outcome(name: &str, urdf: &str, arm: Value) -> Result<crate::arm::Built, String> {
    let folder = folder(name, urdf);
    let out = built(&loaded(&spec(arm), &folder.join("a.json"))).map_err(|e| e.to_string());
    let shown = folder.display().to_string() + "/";
    let _ = fs::remove_dir_all(&folder);
    out.map_err(|e| e.replace(&shown, ""))
}

/// The one fault of the small arm after `edit` holds `part`.
fn refused(name: &str, edit: &[(&str, &str)], arm: Value, part: &str) {
    let mut urdf = ARM.to_string();
    for (from, to) in edit {
        assert!(urdf.contains(from), "{from}");
        urdf = urdf.replacen(from, to, 1);
    }
    let message = outcome(name, &urdf, arm).expect_err(name);
    assert_eq!(message.lines().count(), 1, "{name}: {message}");
    assert!(message.contains(part), "{name}: {message:?} lacks {part:?}");
}

#[test]
fn bodies_behind_fixed_and_locked_joints_ride_along() {
    let arm = outcome("ride", ARM, usual()).expect("an arm").arm;
    assert_eq!(arm.dof(), 2);
    let [swing, reach] = arm.joints.as_slice() else { panic!("two joints") };
    assert_eq!((swing.kind, reach.kind), (JointKind::Revolute, JointKind::Prismatic));
    assert_eq!(swing.body.mass, 2.5);
    assert_eq!(reach.body.mass, 1.25);
    // In the URDF frame of the upper link; the joint frame's z is that frame's y.
    let turn = Transform::z_to([0.0, 1.0, 0.0]);
    near("upper", &turn.turn(swing.body.first_moment), &[0.2, 0.0, 0.15], 1e-15);
    // The finger, held 0.04 m along y; the default axis x slides.
    let turn = Transform::z_to([1.0, 0.0, 0.0]);
    near("slide", &turn.turn(reach.body.first_moment), &[0.0, 0.01, 0.0], 1e-15);
    near("tool", &turn.apply(arm.tip.translation), &[0.2, 0.0, 0.0], 1e-15);
    assert_eq!(swing.viscous_friction, 0.5);
    assert_eq!(swing.coulomb_friction, [0.25, -0.25]);
    assert_eq!(swing.limits.torque, None);
    assert_eq!(swing.limits.velocity, Some(3.0));
    assert_eq!(reach.limits.position, Some([0.0, 0.4]));
}

#[test]
fn the_inertial_frame_is_turned_by_its_own_angles() {
    let arm = outcome("turned", &ARM.replace("value=\"0.5\"", "value=\"0\""), usual()).expect("an arm").arm;
    let turn = Transform::z_to([0.0, 1.0, 0.0]);
    let body = arm.joints[0].body.moved(&turn);
    let expected = [[0.2, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.25]];
    near("inertia", body.inertia_at_com().as_flattened(), expected.as_flattened(), 1e-14);
}

#[test]
fn the_specification_overrides_the_file() {
    let mut arm = usual();
    arm["joints"] = json!({ "swing": { "armature": 0.3, "limits": { "torque": 50.0 } } });
    let arm = outcome("override", ARM, arm).expect("an arm").arm;
    assert_eq!(arm.joints[0].armature, 0.3);
    assert_eq!(arm.joints[0].limits.torque, Some(50.0));
    assert_eq!(arm.joints[0].limits.position, Some([-1.0, 2.0]));
    assert_eq!(arm.joints[0].viscous_friction, 0.5);
}

#[test]
fn missing_limits_are_unknown_and_said_so() {
    let urdf = ARM.replace(r#"<limit lower="-1" upper="2" effort="0" velocity="3"/>"#, "");
    let built = outcome("limitless", &urdf, usual()).expect("an arm");
    assert_eq!(built.arm.joints[0].limits, crate::arm::Limits::default());
    assert!(built.warnings.iter().any(|w| w.contains("joint[swing].limit: gives no position limits")));
    let urdf = ARM.replace(r#"name="swing" type="revolute""#, r#"name="swing" type="continuous""#);
    let built = outcome("continuous", &urdf, usual()).expect("an arm");
    assert_eq!(built.arm.joints[0].limits.position, None);
    assert!(built.warnings.is_empty());
}

#[test]
fn pictures_never_matter() {
    let picture = r#"<link name="tool"><visual><origin xyz="none"/><geometry><mesh filename="package://$(find x)/a.dae" scale="1"/>
        </geometry></visual><collision/></link><gazebo><x v="${y}"/></gazebo>"#;
    let plain = outcome("plain", ARM, usual());
    assert_eq!(outcome("picture", &ARM.replace(r#"<link name="tool"/>"#, picture), usual()), plain);
}

#[test]
fn faults_name_file_place_value_and_mend() {
    let u = usual;
    let swing = r#"<joint name="swing" type="revolute">"#;
    refused("two-tips", &[], json!({ "lock": { "grip": 0.0 } }), "name one of camera, finger, tool");
    refused("tip", &[], json!({ "tip": "hand", "lock": { "grip": 0.0 } }), "a.json: arm.tip: is \"hand\"");
    refused(
        "branch",
        &[],
        json!({ "tip": "tool" }),
        "a.json: arm.lock.grip: is missing: this joint moves a branch",
    );
    let lock = json!({ "tip": "tool", "lock": { "grip": 0.0, "grab": 0.0 } });
    refused(
        "lock",
        &[],
        lock,
        "a.json: arm.lock.grab: is not a movable joint of arm.urdf; name one of the movable joints swing, reach, grip",
    );
    let mut over = u();
    over["joints"] = json!({ "swung": { "armature": 1.0 } });
    refused(
        "joints",
        &[],
        over,
        "a.json: arm.joints.swung: is not a joint of the arm; name one of swing, reach",
    );
    refused(
        "all-locked",
        &[],
        json!({ "tip": "base", "lock": { "grip": 0.0, "swing": 0.0, "reach": 0.0 } }),
        "a.json: arm.urdf: leaves 0 movable joints",
    );
    refused(
        "axis",
        &[("0 2 0", "0 0 0")],
        u(),
        "arm.urdf: joint[swing].axis: is [0.0, 0.0, 0.0]; write a direction",
    );
    refused(
        "axis-text",
        &[("0 2 0", "0 2 up 0")],
        u(),
        "arm.urdf: joint[swing].axis.xyz: is \"0 2 up 0\"; write three numbers",
    );
    refused(
        "comma",
        &[("<mass value=\"2\"", "<mass value=\"2,5\"")],
        u(),
        "arm.urdf: link[upper].mass.value: is \"2,5\"; write a number",
    );
    refused(
        "nan",
        &[("<mass value=\"2\"", "<mass value=\"nan\"")],
        u(),
        "arm.urdf: link[upper].inertial: has inertial data that are not finite",
    );
    refused(
        "mass",
        &[("<mass value=\"2\"", "<mass value=\"-2\"")],
        u(),
        "arm.urdf: link[upper].inertial.mass: is -2; write",
    );
    refused(
        "inertia",
        &[("iyy=\"0.2\"", "iyy=\"-0.2\"")],
        u(),
        "arm.urdf: link[upper].inertial.inertia: gives the principal moment",
    );
    refused(
        "no-ixy",
        &[("ixx=\"0.1\" ixy=\"0\"", "ixx=\"0.1\"")],
        u(),
        "arm.urdf: link[upper].inertia.ixy: is missing",
    );
    refused(
        "origin",
        &[("xyz=\"0 0 1\"", "xyz=\"0 0 inf\"")],
        u(),
        "arm.urdf: joint[swing].origin: holds a number that is not finite",
    );
    refused(
        "limits",
        &[("lower=\"-1\"", "lower=\"5\"")],
        u(),
        "arm.urdf: joint[swing].limit.position: is [5.0, 2.0]",
    );
    refused(
        "damping",
        &[("damping=\"0.5\"", "damping=\"-1\"")],
        u(),
        "arm.urdf: joint[swing].dynamics.damping: is -1",
    );
    refused(
        "type",
        &[(swing, r#"<joint name="swing" type="hinge">"#)],
        u(),
        "arm.urdf: joint[swing].type: is \"hinge\"; write one of revolute",
    );
    refused(
        "planar",
        &[(swing, r#"<joint name="swing" type="planar">"#)],
        u(),
        "arm.urdf: joint[swing].type: is planar; an arm takes revolute",
    );
    refused(
        "mimic",
        &[("<axis xyz=\"0 2 0\"/>", "<mimic joint=\"reach\"/>")],
        u(),
        "arm.urdf: joint[swing].mimic: couples the joint to \"reach\"",
    );
    refused(
        "twice",
        &[("<link name=\"tool\"/>", "<link name=\"tool\"/><link name=\"tool\"/>")],
        u(),
        "arm.urdf: link[tool]: stands twice",
    );
    refused("joint-twice", &[("name=\"mount\"", "name=\"end\"")], u(), "arm.urdf: joint[end]: stands twice");
    refused(
        "unknown-link",
        &[("<child link=\"camera\"/>", "<child link=\"cam\"/>")],
        u(),
        "arm.urdf: joint[mount].child: is \"cam\", which is not a link; name one of the links base, camera",
    );
    refused(
        "two-parents",
        &[("<child link=\"camera\"/>", "<child link=\"slide\"/>")],
        u(),
        "joint[reach].child: is \"slide\", which the joint \"mount\" carries already",
    );
    refused(
        "roots",
        &[("<link name=\"tool\"/>", "<link name=\"tool\"/><link name=\"table\"/>")],
        u(),
        "falls apart: base, table are carried by no joint",
    );
    refused(
        "loop",
        &[
            ("<parent link=\"base\"/>", "<parent link=\"tool\"/>"),
            ("<link name=\"base\">", "<link name=\"tool2\"/><link name=\"base\">"),
            (
                "<joint name=\"mount\" type=\"fixed\">",
                "<joint name=\"m2\" type=\"fixed\"><parent link=\"base\"/><child link=\"tool2\"/></joint><joint name=\"mount\" type=\"fixed\">",
            ),
        ],
        u(),
        "has a loop: camera, finger, slide, tool, upper cannot be reached from the root base",
    );
    refused(
        "quaternion",
        &[("<origin xyz=\"0 0 1\"/>", "<origin xyz=\"0 0 1\" quat_xyzw=\"0 0 0 1\"/>")],
        u(),
        "arm.urdf: joint[swing].origin.quat_xyzw: is a quaternion",
    );
    refused(
        "xacro",
        &[("<link name=\"tool\"/>", "<link name=\"tool\"/><xacro:arm/>")],
        u(),
        "arm.urdf: holds xacro macros, which are not URDF; expand it first",
    );
    refused("xacro-value", &[("value=\"9\"", "value=\"${m}\"")], u(), "holds xacro macros");
    refused(
        "root",
        &[("<robot", "<sdf"), ("</robot", "</sdf")],
        u(),
        "arm.urdf: has the root element <sdf>; give a URDF file",
    );
    refused("malformed", &[("</robot>", "")], u(), "arm.urdf: is not a URDF file that can be read");
    refused(
        "no-parent",
        &[("<parent link=\"base\"/>", "")],
        u(),
        "arm.urdf: is not a URDF file that can be read",
    );
    let empty = outcome("empty", "", u()).expect_err("empty");
    assert!(empty.contains("arm.urdf: has no XML element"), "{empty}");
    let bare = outcome("bare", "<robot name=\"x\"/>", u()).expect_err("bare");
    assert!(bare.contains("arm.urdf: has no <link>"), "{bare}");
    let gone = built(&loaded(&spec(u()), Path::new("/nowhere/a.json"))).expect_err("gone").to_string();
    assert!(
        gone.starts_with("/nowhere/a.json: arm.urdf: names /nowhere/arm.urdf, which cannot be read"),
        "{gone}"
    );
}

#[test]
fn no_damage_to_a_file_ends_in_a_panic() {
    let folder = folder("damage", ARM);
    let loaded = loaded(&spec(usual()), &folder.join("a.json"));
    for at in (0..ARM.len()).step_by(7) {
        for damage in ["", "<", ">", "\"", "/", "&", "é", "0"] {
            let cut = if damage.is_empty() {
                ARM[..at].to_string()
            } else {
                format!("{}{damage}{}", &ARM[..at], &ARM[at + 1..])
            };
            fs::write(folder.join("arm.urdf"), cut).expect("a file");
            let _ = built(&loaded);
        }
    }
    let _ = fs::remove_dir_all(&folder);
}
