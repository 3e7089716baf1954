//! What is said about faulty URDF files.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::urdf::{ARM, folder, outcome, spec, usual};
use super::{built, loaded};

/// The one fault of the small arm after `edit` holds `part`, and names the line of the first edit where `part` names the
/// file.
fn refused(name: &str, edit: &[(&str, &str)], arm: Value, part: &str) {
    let line = edit.first().map_or(0, |(from, _)| line_of(from));
    refused_in(line, name, edit, arm, part);
}

/// The same, naming `line`; 0 where the whole file is meant.
fn refused_in(line: usize, name: &str, edit: &[(&str, &str)], arm: Value, part: &str) {
    let mut urdf = ARM.to_string();
    for (from, to) in edit {
        assert!(urdf.contains(from), "{from}");
        urdf = urdf.replacen(from, to, 1);
    }
    let message = outcome(name, &urdf, arm).expect_err(name);
    assert_eq!(message.lines().count(), 1, "{name}: {message}");
    let part = match part.strip_prefix("arm.urdf: ") {
        Some(rest) if line > 0 => format!("arm.urdf:{line}: {rest}"),
        _ => part.to_string(),
    };
    assert!(message.contains(&part), "{name}: {message:?} lacks {part:?}");
}

/// The line of the small arm's file in which `text` begins.
fn line_of(text: &str) -> usize {
    let before = ARM.split(text).next().expect("a part before");
    1 + before.matches('\n').count()
}

#[test]
fn faults_name_file_place_value_and_help() {
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
        "arm.urdf: joint[swing].mimic: lets a revolute joint follow the prismatic joint \"reach\"",
    );
    refused(
        "twice",
        &[("<link name=\"tool\"/>", "<link name=\"tool\"/><link name=\"tool\"/>")],
        u(),
        "arm.urdf: link[tool]: occurs twice",
    );
    refused_in(
        line_of("<joint name=\"end\""),
        "joint-twice",
        &[("name=\"mount\"", "name=\"end\"")],
        u(),
        "arm.urdf: joint[end]: occurs twice, first in line 17; give each a different name",
    );
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
        "arm.urdf: is not connected: no joint carries base, table",
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
    refused(
        "nul",
        &[("name=\"tool\"", "name=\"to&#0;ol\"")],
        u(),
        "arm.urdf: is not a URDF file that can be read",
    );
    refused_in(
        line_of("<robot"),
        "malformed",
        &[("</robot>", "")],
        u(),
        "arm.urdf: is not a URDF file that can be read (<robot> is not closed)",
    );
    refused(
        "no-parent",
        &[("<parent link=\"base\"/>", "")],
        u(),
        "arm.urdf: joint[swing].parent: is missing; write <parent link=\"…\"/>",
    );
    refused(
        "two-inertials",
        &[("izz=\"0.25\"/></inertial>", "izz=\"0.25\"/></inertial><inertial/>")],
        u(),
        "arm.urdf: link[upper].inertial: occurs twice, first in line 5; keep one <inertial>",
    );
    let empty = outcome("empty", "", u()).expect_err("empty");
    assert!(empty.contains("arm.urdf: has no XML element"), "{empty}");
    let bare = outcome("bare", "<robot name=\"x\"/>", u()).expect_err("bare");
    assert!(bare.contains("arm.urdf:1: has no <link>"), "{bare}");
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
