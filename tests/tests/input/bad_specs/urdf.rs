//! Mistakes in URDF files and in what the specification says about them.

use serde_json::json;

use super::case::{Case, case, judge};
use super::input::{Input, urdf_joint as joint, urdf_link as link};

/// base – turn – arm, with further elements.
fn one_joint(i: &mut Input, more: &str) {
    i.urdf(
        &[link("base"), link("arm"), joint("turn", "revolute", "base", "arm", ""), more.to_string()].concat(),
    );
}

/// The same with another joint.
fn with_joint(i: &mut Input, joint: String) {
    i.urdf(&[link("base"), link("arm"), joint].concat());
}

const CASES: &[Case] = &[
    case(
        "unreadable",
        |i| {
            i.set("/arm", json!({ "urdf": "nowhere.urdf" }));
        },
        "arm.urdf",
        &["nowhere.urdf", "cannot be read", "write the path of a URDF file"],
    ),
    case(
        "malformed",
        |i| {
            i.urdf("<link name=\"base\">");
        },
        "",
        &["is not a URDF file", "robot", "correct the XML there"],
    )
    .inside("arm.urdf"),
    case(
        "no XML",
        |i| {
            i.urdf_text("joint: 1");
        },
        "",
        &["has no XML element", "give a URDF file"],
    )
    .inside("arm.urdf"),
    case(
        "other XML",
        |i| {
            i.urdf_text("<sdf></sdf>");
        },
        "",
        &["root element <sdf>", "root is <robot>"],
    )
    .inside("arm.urdf"),
    case(
        "xacro",
        |i| {
            i.urdf("<xacro:include filename=\"a\"/>");
        },
        "",
        &["xacro macros", "expand it first"],
    )
    .inside("arm.urdf"),
    case(
        "cycle",
        |i| {
            let (there, back) = (joint("t", "revolute", "a", "b", ""), joint("u", "revolute", "b", "a", ""));
            i.urdf(&[link("a"), link("b"), there, back].concat());
        },
        "",
        &["has a loop", "make the joints a tree"],
    )
    .inside("arm.urdf"),
    case(
        "cycle off the root",
        |i| {
            let (there, back) = (joint("t", "revolute", "a", "b", ""), joint("u", "revolute", "b", "a", ""));
            one_joint(i, &[link("a"), link("b"), there, back].concat());
        },
        "",
        &["has a loop", "a, b", "make the joints a tree"],
    )
    .inside("arm.urdf"),
    case(
        "two leaves without tip",
        |i| one_joint(i, &(link("tool") + &joint("mount", "fixed", "base", "tool", ""))),
        "arm.tip",
        &["is missing", "ends in 2 links", "name one of arm, tool"],
    ),
    case(
        "unknown tip",
        |i| {
            one_joint(i, "");
            i.set("/arm/tip", json!("hand"));
        },
        "arm.tip",
        &["\"hand\", which is not a link", "name one of the links arm, base"],
    ),
    case(
        "unknown lock",
        |i| {
            one_joint(i, "");
            i.set("/arm/lock", json!({ "finger": 0.0 }));
        },
        "arm.lock.finger",
        &["not a movable joint", "turn"],
    ),
    case(
        "unknown joint data",
        |i| {
            one_joint(i, "");
            i.set("/arm/joints", json!({ "finger": { "armature": 0.1 } }));
        },
        "arm.joints.finger",
        &["is not a joint of the arm", "turn"],
    ),
    case(
        "movable branch",
        |i| {
            let finger = link("finger") + &link("tool") + &joint("mount", "fixed", "arm", "tool", "");
            one_joint(i, &(finger + &joint("grip", "revolute", "arm", "finger", "")));
            i.set("/arm/tip", json!("tool"));
        },
        "arm.lock.grip",
        &["is missing", "branch", "give the position"],
    ),
    case(
        "mimic joint",
        |i| {
            let mimic = joint("follow", "revolute", "arm", "hand", "<mimic joint=\"turning\"/>");
            one_joint(i, &(link("hand") + &mimic));
        },
        "joint[follow].mimic.joint",
        &["is \"turning\", which is not a joint", "name the joint that it follows", "arm.lock"],
    )
    .inside("arm.urdf"),
    case(
        "floating joint",
        |i| with_joint(i, joint("turn", "floating", "base", "arm", "")),
        "joint[turn].type",
        &["is floating", "revolute, continuous and prismatic"],
    )
    .inside("arm.urdf"),
    case(
        "unknown joint type",
        |i| with_joint(i, joint("turn", "helical", "base", "arm", "")),
        "joint[turn].type",
        &["is \"helical\"", "write one of revolute"],
    )
    .inside("arm.urdf"),
    case(
        "zero axis",
        |i| with_joint(i, joint("turn", "revolute", "base", "arm", "").replace("0 0 1", "0 0 0")),
        "joint[turn].axis",
        &["is [0.0, 0.0, 0.0]", "write a direction"],
    )
    .inside("arm.urdf"),
    case(
        "unknown parent",
        |i| with_joint(i, joint("turn", "revolute", "floor", "arm", "")),
        "joint[turn].parent",
        &["\"floor\", which is not a link", "arm, base"],
    )
    .inside("arm.urdf"),
    case(
        "negative mass",
        |i| {
            let heavy = link("arm").replace("mass value=\"1\"", "mass value=\"-1\"");
            i.urdf(&[link("base"), heavy, joint("turn", "revolute", "base", "arm", "")].concat());
        },
        "link[arm].inertial.mass",
        &["is -1", "at least 0, in kg"],
    )
    .inside("arm.urdf"),
    case(
        "everything is fixed",
        |i| with_joint(i, joint("turn", "fixed", "base", "arm", "")),
        "arm.urdf",
        &["0 movable joints", "1 to 8 remain"],
    ),
    case(
        "a motion of three joints",
        |i| {
            one_joint(i, "");
            i.set("/motion/quintic/from", json!([0.0, 0.0, 0.0]));
        },
        "motion.quintic.from",
        &["has 3 entries", "write 1, one for each joint"],
    ),
];

#[test]
fn urdf() {
    judge(CASES);
}
