//! URDF features, on a small arm written here.

use std::fs;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::{built, loaded, near};
use crate::arm::{JointKind, Transform};

/// A turning and a sliding joint, a camera welded to the first link, a finger on the second.
pub(super) const ARM: &str = r#"<?xml version="1.0"?>
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
pub(super) fn folder(name: &str, urdf: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gramforge-urdf-{}-{name}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("arm.urdf"), urdf).expect("a file");
    folder
}

pub(super) fn spec(arm: Value) -> Value {
    let mut arm = arm;
    arm["urdf"] = json!("arm.urdf");
    json!({ "name": "small", "arm": arm, "model": "exact" })
}

pub(super) fn usual() -> Value {
    json!({ "tip": "tool", "lock": { "grip": 0.04 } })
}

pub(super) fn outcome(name: &str, urdf: &str, arm: Value) -> Result<crate::arm::Built, String> {
    let folder = folder(name, urdf);
    let out = built(&loaded(&spec(arm), &folder.join("a.json"))).map_err(|e| e.to_string());
    let shown = folder.display().to_string() + "/";
    let _ = fs::remove_dir_all(&folder);
    out.map_err(|e| e.replace(&shown, ""))
}

#[test]
fn bodies_behind_fixed_and_locked_joints_ride_along() {
    let arm = outcome("ride", ARM, usual()).expect("an arm").arm;
    assert_eq!(arm.dof(), 2);
    let [swing, position_bound] = arm.joints.as_slice() else { panic!("two joints") };
    assert_eq!((swing.kind, position_bound.kind), (JointKind::Revolute, JointKind::Prismatic));
    assert_eq!(swing.body.mass, 2.5);
    assert_eq!(position_bound.body.mass, 1.25);
    // In the URDF frame of the upper link; the joint frame's z is that frame's y.
    let turn = Transform::z_to([0.0, 1.0, 0.0]);
    near("upper", &turn.turn(swing.body.first_moment), &[0.2, 0.0, 0.15], 1e-15);
    // The finger, held 0.04 m along y; the default axis x slides.
    let turn = Transform::z_to([1.0, 0.0, 0.0]);
    near("slide", &turn.turn(position_bound.body.first_moment), &[0.0, 0.01, 0.0], 1e-15);
    near("tool", &turn.apply(arm.tip.translation), &[0.2, 0.0, 0.0], 1e-15);
    assert_eq!(swing.viscous_friction, 0.5);
    assert_eq!(swing.coulomb_friction, [0.25, -0.25]);
    assert_eq!(swing.limits.torque, None);
    assert_eq!(swing.limits.velocity, Some(3.0));
    assert_eq!(position_bound.limits.position, Some([0.0, 0.4]));
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
    let urdf = ARM.replace(r#"<robot name="small""#, r#"<robot name="small" version="1.2""#);
    let urdf = urdf.replace(r#"effort="0" velocity="3""#, r#"acceleration="7""#);
    let limits = outcome("version", &urdf, usual()).expect("an arm").arm.joints[0].limits;
    assert_eq!((limits.velocity, limits.acceleration, limits.torque), (None, Some(7.0), None));
}

#[test]
fn a_lock_beyond_the_limits_is_a_warning() {
    let built = outcome("beyond", ARM, json!({ "tip": "tool", "lock": { "grip": 4.0 } })).expect("an arm");
    assert!(built.warnings.iter().any(|w| w.contains("arm.lock.grip: is 4, beyond the limits [0.0, 0.1]")));
}

#[test]
fn pictures_never_matter() {
    let picture = r#"<link name="tool"><visual><origin xyz="none"/><geometry><mesh filename="package://$(find x)/a.dae" scale="1"/>
        </geometry></visual><collision/></link><gazebo><x v="${y}"/></gazebo>"#;
    let plain = outcome("plain", ARM, usual());
    assert_eq!(outcome("picture", &ARM.replace(r#"<link name="tool"/>"#, picture), usual()), plain);
}
