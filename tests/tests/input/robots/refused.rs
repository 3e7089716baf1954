//! Files that describe no arm: one line each, with the place in the file as it is.

use serde_json::json;

use super::case::{Case, END};

const LIMIT: &str = r#"<limit lower="-2" upper="2" effort="100" velocity="2"/>"#;

#[test]
fn values_that_nothing_replaces_are_judged_in_their_line() {
    Case::new("reversed limits").edit(LIMIT, "<limit\n      lower=\"1\"\n      upper=\"-1\"/>").refused(
        Some("<limit"),
        "joint[j1].limit.position",
        &["is [1.0, -1.0]", "; "],
    );
    Case::new("an effort in words")
        .edit(LIMIT, "<limit lower=\"-2\" upper=\"2\" velocity=\"2\"\n      effort=\"strong\"/>")
        .refused(Some("effort=\"strong\""), "joint[j1].limit.effort", &["is \"strong\"", "write a number"]);
    Case::new("negative damping").edit(LIMIT, format!("{LIMIT}\n    <dynamics damping=\"-1\"/>")).refused(
        Some("<dynamics"),
        "joint[j1].dynamics.damping",
        &["is -1", "at least 0"],
    );
    Case::new("a mass of letters").edit("<mass value=\"0.7\"/>", "<mass\n value=\"0,7\"/>").refused(
        Some("value=\"0,7\""),
        "link[l2].mass.value",
        &["is \"0,7\"", "write a number"],
    );
    Case::new("a negative moment").edit("ixx=\"0.05\"", "ixx=\"-0.05\"").refused(
        Some("ixx=\"-0.05\""),
        "link[l2].inertial.inertia",
        &["principal moment -"],
    );
}

#[test]
fn lines_are_those_of_the_file() {
    let picture = "<link name=\"base\"><visual>\n<origin xyz=\"0 0 0\"/>\n\n<geometry/>\n</visual>\n</link>";
    Case::new("behind a picture")
        .edit("<link name=\"base\"/>", picture)
        .edit("<child link=\"l2\"/>", "<child link=\"l2\">")
        .refused(
            Some("</joint>\n</robot>"),
            "",
            &["is not a URDF file that can be read", "correct the XML there"],
        );
    Case::new("behind a comment")
        .edit("<link name=\"base\"/>", "<!-- \n\n\n --><link name=\"base\"/>")
        .edit("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>")
        .refused(Some("<axis xyz=\"0 0 0\"/>"), "joint[j1].axis", &["write a direction"]);
    Case::new("a link twice").with("<link name=\"l1\"/>").refused(
        Some("<link name=\"l1\"/>"),
        "link[l1]",
        &["occurs twice, first in line 4"],
    );
    Case::new("two origins").edit("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/>\n    <origin/>").refused(
        Some("<origin/>"),
        "joint[j1].origin",
        &["occurs twice, first in line 21", "keep one <origin>"],
    );
    Case::new("no child").edit("<child link=\"l2\"/>", "").refused(
        Some("<joint name=\"j2\""),
        "joint[j2].child",
        &["is missing", "<child link="],
    );
    Case::new("no mass").edit("<mass value=\"0.7\"/>", "").refused(
        Some("<inertial>\n      <origin xyz=\"0.15"),
        "link[l2].inertial.mass",
        &["is missing"],
    );
    Case::new("a link that is not there").edit("<parent link=\"l1\"/>", "<parent link=\"l7\"/>").refused(
        Some("<joint name=\"j2\""),
        "joint[j2].parent",
        &["is \"l7\", which is not a link"],
    );
}

#[test]
fn encodings_that_are_not_read_are_named() {
    let latin = Case::new("Latin-1 without a declaration");
    let text = latin.text().replace("two", "zw\u{f6}lf");
    let bytes: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
    let message = latin.run(&bytes).map(|_| ()).expect_err("not UTF-8");
    assert!(
        message.starts_with("arm.urdf:2: holds the byte 0xf6, which is not UTF-8; save the file as"),
        "{message}"
    );
    Case::new("another encoding").edit("version=\"1.0\"", "version=\"1.0\" encoding=\"Shift_JIS\"").refused(
        Some("<?xml"),
        "",
        &["declares the encoding \"Shift_JIS\"", "save the file as UTF-8"],
    );
}

#[test]
fn joints_that_an_arm_cannot_have() {
    for kind in ["floating", "planar"] {
        Case::new(kind)
            .edit("<joint name=\"j2\" type=\"revolute\">", format!("<joint name=\"j2\" type=\"{kind}\">"))
            .refused(Some("<joint name=\"j2\""), "joint[j2].type", &[kind, "write 0 as `arm.lock.j2`"]);
    }
    let camera =
        r#"<link name="cam"/><joint name="c" type="floating"><parent link="l1"/><child link="cam"/></joint>"#;
    Case::new("a carried camera").with(camera).refused(
        Some("<joint name=\"c\""),
        "joint[c].type",
        &["is floating", "arm.lock.c"],
    );
    Case::new("a camera held where it cannot be").with(camera).arm("lock", json!({ "c": 0.3 })).refused(
        None,
        "arm.json: arm.lock.c",
        &["is 0.3", "write 0"],
    );
    Case::new("a carried wheel").with(&camera.replace("floating", "continuous")).refused(
        None,
        "arm.json: arm.lock.c",
        &["is missing", "moves a branch"],
    );
}

#[test]
fn followers_that_cannot_follow() {
    let second = "<origin xyz=\"0.3 0 0\" rpy=\"0.2 0 0.1\"/>";
    let mimic = |text: &str| format!("{second}\n    <mimic {text}/>");
    let case = |name: &'static str, text: &str| Case::new(name).edit(second, mimic(text));
    case("an unknown master", "joint=\"j9\"").refused(
        Some("<mimic"),
        "joint[j2].mimic.joint",
        &["is \"j9\""],
    );
    case("no master", "multiplier=\"2\"").refused(Some("<mimic"), "joint[j2].mimic.joint", &["is missing"]);
    case("a third", "joint=\"j1\" multiplier=\"0.333\"").refused(
        Some("<joint name=\"j2\""),
        "joint[j2].mimic",
        &["has the multiplier 0.333", "a whole number of quarters"],
    );
    case("itself", "joint=\"j2\"").refused(
        Some("<joint name=\"j2\""),
        "joint[j2].mimic",
        &["follows itself"],
    );
    case("a master that slides", "joint=\"j1\"")
        .edit("<joint name=\"j1\" type=\"revolute\">", "<joint name=\"j1\" type=\"prismatic\">")
        .refused(Some("<mimic"), "joint[j2].mimic", &["revolute joint follow the prismatic joint \"j1\""]);
    let finger = r#"<link name="f"/><joint name="g" type="revolute"><parent link="l2"/><child link="f"/><mimic joint="j1"/></joint>"#;
    Case::new("a branch that moves").with(finger).refused(
        None,
        "arm.json: arm.lock.g",
        &["is missing", "follows j1 off the chain"],
    );
}

#[test]
fn deep_and_large_files_are_refused() {
    let deep = Case::new("deep").edit(END, format!("{}{}{END}", "<a>".repeat(20_000), "</a>".repeat(20_000)));
    deep.refused(Some("<a>"), "", &["nests more than 100 elements", "; "]);
    let open = Case::new("deep and open").edit(END, "<a>".repeat(200_000));
    open.refused(Some("<a>"), "", &["nests more than 100 elements"]);
    let name = "n".repeat(10_000);
    Case::new("a long name").with(&format!("<link name=\"{name}\"/>")).refused(
        Some("<link name=\"nnn"),
        "link.name",
        &["has 10000 characters", "at most 200"],
    );
    let many = (0..500).map(|i| format!("<link name=\"x{i}\"/><link name=\"x{i}\"/>\n")).collect::<String>();
    let case = Case::new("many faults").with(&many);
    let message = case.run(case.text().as_bytes()).map(|_| ()).expect_err("faults");
    assert_eq!((message.lines().count(), message.lines().last()), (101, Some("and 400 more")));
}

#[test]
fn numbers_of_things_beyond_any_robot_are_refused() {
    let attributes: String = (0..50_000).map(|i| format!(" a{i}=\"1\"")).collect();
    Case::new("attributes").with(&format!("<gadget{attributes}/>")).refused(
        Some("<gadget"),
        "",
        &["an element with more than 1000 attributes", "; "],
    );
    let links: String = (0..100_000).map(|i| format!("<link name=\"x{i}\"/>\n")).collect();
    Case::new("links").with(&links).refused(
        Some("<link name=\"x1997\""),
        "",
        &["has 100003 elements <link>, and at most 2000 are read"],
    );
    let weld = |i: i32| {
        format!("<joint name=\"w{i}\" type=\"fixed\"><parent link=\"l2\"/><child link=\"l2\"/></joint>\n")
    };
    Case::new("welds").with(&(0..3_000).map(weld).collect::<String>()).refused(
        Some("<joint name=\"w1998\""),
        "",
        &["has 3002 elements <joint>, and at most 2000 are read"],
    );
}

/// Each of a line of joints follows the next.
#[test]
fn a_long_line_of_followers_is_refused() {
    let follower = |i: usize| {
        format!(
            "<link name=\"f{i}\"/><joint name=\"g{i}\" type=\"revolute\"><parent link=\"{}\"/><child link=\"f{i}\"/>\
             <axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2\"/>{}</joint>\n",
            if i == 0 { "l2".to_string() } else { format!("f{}", i - 1) },
            if i == 0 { String::new() } else { format!("<mimic joint=\"g{}\"/>", i - 1) }
        )
    };
    let case =
        Case::new("followers").with(&(0..1_900).map(follower).collect::<String>()).arm("tip", json!("f1899"));
    let message = case.run(case.text().as_bytes()).map(|_| ()).expect_err("too long a line");
    let first = message.lines().next().expect("a line");
    assert!(
        first.contains("joint[g102].mimic: follows itself, or another by way of more than 100 joints; "),
        "{first}"
    );
    assert_eq!(message.lines().last(), Some("and 1698 more"));
}

#[test]
fn names_and_text_that_cannot_be_meant_are_refused() {
    for name in ["", "  "] {
        let case = Case::new("a joint without a name").edit("name=\"j2\"", format!("name=\"{name}\""));
        let at = format!("<joint name=\"{name}\"");
        case.refused(Some(&at), "joint.name", &["is \"", "give the joint a name"]);
    }
    Case::new("text behind").edit(END, format!("{END}\n\nand more")).refused(
        Some("and more"),
        "",
        &["has text behind </robot>", "; "],
    );
}

#[test]
fn a_file_that_is_no_tree_is_told_with_a_line() {
    let more: String = (0..30).map(|i| format!("<link name=\"part{i:02}\"/>\n")).collect();
    Case::new("parts").with(&more).refused(
        Some("<link name=\"part00\""),
        "",
        &["is not connected: no joint carries base, part00, part01,", "part18 and 11 more"],
    );
    let ring = "<link name=\"a\"/><link name=\"b\"/>\n\
        <joint name=\"ab\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n\
        <joint name=\"ba\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>";
    Case::new("a ring").with(ring).refused(
        Some("<joint name=\"ab\""),
        "",
        &["has a loop: a, b cannot be reached from the root base"],
    );
}

#[test]
fn limits_that_a_robot_file_cannot_state_have_a_place() {
    // The exact model needs no limits.
    let workspace = |name| Case::new(name).more("measure", json!("workspace")).more("model", json!("auto"));
    workspace("no accelerations").refused(
        None,
        "arm.json: measure",
        &["lacks acceleration", "`arm.joints.j1.limits.acceleration`", "begin with 10.000", "in 0.2 s"],
    );
    workspace("accelerations of the first alone")
        .arm("joints", json!({ "j1": { "limits": { "acceleration": 5.0 } } }))
        .refused(
            None,
            "arm.json: measure",
            &["j2 lacks acceleration", "`arm.joints.j2.limits.acceleration`"],
        );
}

#[test]
fn a_joint_that_moves_no_mass_is_named() {
    let control = json!({ "law": "exact", "period": 0.001, "W": 10.0, "Pqq": 4.0, "Omega": 16.0 });
    let massless = Case::new("a massless last link")
        .edit("<mass value=\"0.7\"/>", "<mass value=\"0\"/>")
        .edit("ixx=\"0.05\" iyy=\"0.06\" izz=\"0.04\"", "ixx=\"0\" iyy=\"0\" izz=\"0\"");
    // Without a controller nobody needs D to be invertible.
    assert!(massless.run(massless.text().as_bytes()).is_ok());
    massless.more("control", control).refused(
        None,
        "arm.json: arm",
        &["smallest eigenvalue", "the joint j2 moves almost no mass", "add `armature` to it"],
    );
}
