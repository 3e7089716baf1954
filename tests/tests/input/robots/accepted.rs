//! Files that are not as they should be, and describe an arm all the same.

use serde_json::json;

use super::case::{Case, URDF, chain};

fn warned(made: &gramforge::Generation, part: &str) {
    assert!(
        made.warnings().iter().any(|warning| warning.contains(part)),
        "{:?} lacks {part:?}",
        made.warnings()
    );
}

/// Nothing is known of the masses: the model is zero, and that is said.
#[test]
fn links_without_inertia_are_warned_of() {
    let weightless = |name, from: &str, to: &str| {
        let text = URDF.split(from).next().expect("a part").len();
        let end = text + URDF[text..].find(to).expect("an end") + to.len();
        Case::new(name).edit(URDF.get(text..end).expect("a part of the file"), "")
    };
    let last = weightless("no inertia behind j2", "<inertial>\n      <origin xyz=\"0.15", "</inertial>");
    let made = last.run(last.text().as_bytes()).expect("an arm");
    warned(&made, "arm.json: arm: joints that move no mass: j2; their torque is zero");
    let none = last.edit(&URDF[URDF.find("<inertial>").unwrap()..URDF.find("</inertial>").unwrap() + 11], "");
    let made = none.run(none.text().as_bytes()).expect("an arm");
    warned(&made, "joints that move no mass: j1, j2;");
    assert_eq!(made.torque().expect("a motion").error, [0.0, 0.0]);
    assert!(!made.module().expect("a module").contains("e-32"), "no torque of 1e-322");
}

const LIMIT: &str = r#"<limit lower="-2" upper="2" effort="100" velocity="2"/>"#;
const DYNAMICS: &str = r#"<dynamics damping="-1" friction="-0.5"/>"#;

#[test]
fn the_specification_wins_over_wrong_values() {
    let limits = json!({ "j1": { "limits": { "position": [-2.0, 2.0], "torque": 50.0 } } });
    let made = Case::new("reversed limits and a negative effort")
        .edit(LIMIT, r#"<limit lower="1" upper="-1" effort="-5" velocity="2"/>"#)
        .arm("joints", limits)
        .accepted(&chain());
    let own = made.arm().joints[0].limits;
    assert_eq!((own.position, own.torque, own.velocity), (Some([-2.0, 2.0]), Some(50.0), Some(2.0)));
    let made = Case::new("limits that are no numbers")
        .edit(LIMIT, r#"<limit lower="left" upper="right" effort="strong" velocity="fast"/>"#)
        .arm(
            "joints",
            json!({ "j1": { "limits": { "position": [-1.0, 1.0], "torque": 5.0, "velocity": 2.0 } } }),
        )
        .accepted(&chain());
    assert_eq!(made.arm().joints[0].limits.velocity, Some(2.0));
    let made = Case::new("negative damping and friction")
        .edit(LIMIT, format!("{LIMIT}{DYNAMICS}"))
        .arm("joints", json!({ "j1": { "viscous_friction": 0.4, "coulomb_friction": [0.3, -0.2] } }))
        .accepted(&chain());
    assert_eq!(made.arm().joints[0].coulomb_friction, [0.3, -0.2]);
    Case::new("the same under a motor")
        .edit(LIMIT, format!("{LIMIT}{DYNAMICS}"))
        .arm(
            "joints",
            json!({ "j1": { "motor": { "inertia": 0.0, "gear_ratio": 10.0, "coulomb_friction": 0.1 } } }),
        )
        .accepted(&chain());
    Case::new("a negative speed")
        .edit(LIMIT, LIMIT.replace("velocity=\"2\"", "velocity=\"-2\""))
        .arm("joints", json!({ "j1": { "limits": { "velocity": 2.0 } } }))
        .accepted(&chain());
}

#[test]
fn a_missing_speed_is_unknown() {
    let without = LIMIT.replace(r#" velocity="2""#, "");
    let made = Case::new("no speed, which nothing needs").edit(LIMIT, &*without).accepted(&chain());
    assert_eq!(made.arm().joints[0].limits.velocity, None);
    let given = json!({ "j1": { "limits": { "velocity": 2.0 } } });
    let made = Case::new("no speed").edit(LIMIT, &*without).arm("joints", given).accepted(&chain());
    assert_eq!(made.arm().joints[0].limits.velocity, Some(2.0));
}

const PLATE: &str = r#"<link name="plate"><inertial><mass value="MASS"/><inertia ixx="IXX" iyy="1e-5" izz="1e-5" ixy="0"
    ixz="0" iyz="0"/></inertial></link><joint name="f" type="fixed"><parent link="base"/><child link="plate"/></joint>"#;

#[test]
fn links_that_nothing_carries_do_not_count() {
    let plate = |mass: &str, ixx: &str| PLATE.replace("MASS", mass).replace("IXX", ixx);
    let made = Case::new("a negative moment on the base").with(&plate("0.1", "-3e-8")).accepted(&chain());
    warned(&made, "link[plate].inertial.inertia: gives the principal moment -3.0");
    warned(&made, "no moving joint carries this link, so it is ignored");
    let made = Case::new("a negative mass on the base").with(&plate("-2", "1e-5")).accepted(&chain());
    warned(&made, "link[plate].inertial.mass: is -2; no moving joint carries this link");
    let made = Case::new("a mass that is no number").with(&plate("heavy", "1e-5")).accepted(&chain());
    warned(&made, "link[plate].mass.value: is \"heavy\"");
    let root = Case::new("a root with half an inertia")
        .edit("<link name=\"base\"/>", "<link name=\"base\"><inertial><mass value=\"1\"/></inertial></link>");
    warned(&root.accepted(&chain()), "link[base].inertial.inertia: is missing");
}

#[test]
fn rounding_in_inertias_passes() {
    let mut dust = chain();
    dust.links[0].inertia = [0.0, 0.0, 0.0, 0.0, 1e-20, 0.0];
    let tensor = r#"<inertia ixx="0.1" iyy="0.12" izz="0.11" ixy="0.002" ixz="0" iyz="0.001"/>"#;
    Case::new("a point mass with dust")
        .edit(tensor, r#"<inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="1e-20" iyz="0"/>"#)
        .accepted(&dust);
    let mut flat = chain();
    flat.links[0].inertia = [-1e-20, 0.12, 0.12, 0.0, 0.0, 0.0];
    Case::new("a rod with a moment below zero by rounding")
        .edit(tensor, r#"<inertia ixx="-1e-20" iyy="0.12" izz="0.12" ixy="0" ixz="0" iyz="0"/>"#)
        .accepted(&flat);
    let small = Case::new("small moments that break the triangle")
        .edit(tensor, r#"<inertia ixx="4e-8" iyy="1e-8" izz="1e-8" ixy="0" ixz="0" iyz="0"/>"#)
        .edit("<mass value=\"1.3\"/>", "<mass value=\"0\"/>");
    let made = small.run(small.text().as_bytes()).expect("an arm");
    warned(&made, "the principal moments 1.000e-8, 1.000e-8, 4.000e-8 kg·m² break the triangle inequality");
}

#[test]
fn definiteness_is_judged_where_the_arm_moves() {
    // Out at −860 km nothing but the lever counts; the motion never goes there.
    let control = json!({ "law": "exact", "period": 0.001, "W": 10.0, "Pqq": 4.0, "Omega": 16.0 });
    let mut sliding = chain();
    sliding.links[1].prismatic = true;
    for (name, lower) in [("an endless rail", "-860319"), ("a longer one", "-1e9")] {
        let rail = LIMIT.replace("-2", lower);
        Case::new(name)
            .edit(r#"<joint name="j2" type="revolute">"#, r#"<joint name="j2" type="prismatic">"#)
            .edit(
                "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-2\" upper=\"2\" effort=\"100\" velocity=\"2\"/>\n  </joint>\n</robot>",
                format!("<axis xyz=\"0 1 0\"/>\n    {rail}\n  </joint>\n</robot>"),
            )
            .more("control", control.clone())
            .accepted(&sliding);
    }
}

#[test]
fn what_is_foreign_is_ignored() {
    let foreign = LIMIT.replace("velocity=\"2\"", "velocity=\"2\" drake:acceleration=\"2.5\" safety:k=\"1\"");
    Case::new("undeclared prefixes").edit(LIMIT, foreign).accepted(&chain());
    Case::new("a frame").with(r#"<frame name="x" link="l9"><origin xyz="1 2"/></frame>"#).accepted(&chain());
    Case::new("elements of other tools")
        .with(r#"<drake:joint name="j1" type="screw"/><my:link/><group_state name="home"><joint name="j1"/></group_state>"#)
        .accepted(&chain());
    Case::new("entities of its own")
        .edit("<robot name=\"two\">", "<!DOCTYPE robot [<!ENTITY me \"x\">]>\n<robot name=\"&me;\">")
        .accepted(&chain());
    Case::new("pictures that cannot be read")
        .edit(
            "<link name=\"base\"/>",
            "<link name=\"base\"><visual><origin xyz=\"none\"/></visual><collision/></link>",
        )
        .accepted(&chain());
}

const CAMERA: &str =
    r#"<link name="cam"/><joint name="fl" type="KIND"><parent link="FROM"/><child link="cam"/></joint>"#;

#[test]
fn joints_off_the_chain_matter_only_where_they_are_carried() {
    let camera = |kind: &str, from: &str| CAMERA.replace("KIND", kind).replace("FROM", from);
    Case::new("a floating camera").with(&camera("floating", "base")).accepted(&chain());
    Case::new("a planar one").with(&camera("planar", "base")).accepted(&chain());
    let locked = json!({ "fl": 0.0 });
    Case::new("a carried one, held").with(&camera("floating", "l1")).arm("lock", locked).accepted(&chain());
    let wheel = r#"<link name="wheel"><inertial><mass value="3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
        </inertial></link><joint name="w" type="continuous"><parent link="base"/><child link="wheel"/></joint>"#;
    Case::new("a wheel on the base").with(wheel).accepted(&chain());
    Case::new("a wheel with a wrong axis and limits")
        .with(&wheel.replace("<child", "<axis xyz=\"0 0 0\"/><limit lower=\"x\"/><child"))
        .accepted(&chain());
    let cart = CAMERA.replace("KIND", "floating").replace("FROM", "world").replace("cam", "base");
    let cart = cart.replace("<link name=\"base\"/>", "<link name=\"world\"/>");
    Case::new("a floating base, held").with(&cart).arm("lock", json!({ "fl": 0.0 })).accepted(&chain());
}

const FINGER: &str = r#"<link name="f1"/><link name="f2"/>
  <joint name="g1" type="prismatic"><parent link="l2"/><child link="f1"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="g2" type="prismatic"><parent link="l2"/><child link="f2"/><mimic joint="g1" multiplier="-1"/></joint>"#;

#[test]
fn followers_of_what_is_held_are_held() {
    Case::new("fingers").with(FINGER).arm("lock", json!({ "g1": 0.02 })).accepted(&chain());
    let mut heavy = chain();
    // The second finger's 0.5 kg stand at −0.04 + 0.01 m along x of l2, by the master's lock.
    let m = 0.5;
    let (old, total) = (heavy.links[1].mass, heavy.links[1].mass + m);
    let at = [-0.03, 0.0, 0.0];
    let com = heavy.links[1].com;
    heavy.links[1].com = std::array::from_fn(|i| (old * com[i] + m * at[i]) / total);
    let apart: [f64; 3] = std::array::from_fn(|i| at[i] - com[i]);
    let reduced = old * m / total;
    let [x, y, z] = apart;
    let added = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
    for (own, more) in heavy.links[1].inertia.iter_mut().zip(added) {
        *own += reduced * more;
    }
    heavy.links[1].mass = total;
    let weight = r#"<link name="f2"><inertial><mass value="0.5"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>"#;
    let fingers = FINGER
        .replace("<link name=\"f2\"/>", weight)
        .replace("multiplier=\"-1\"", "multiplier=\"-2\" offset=\"0.01\"");
    Case::new("a heavy finger").with(&fingers).arm("lock", json!({ "g1": 0.02 })).accepted(&heavy);
}

#[test]
fn followers_on_the_chain_move_with_their_masters() {
    for (name, multiplier, offset) in [("half", -0.5, 0.1), ("a parallelogram", -1.0, 0.0)] {
        let mut coupled = chain();
        coupled.links[1].follows = (0, multiplier, offset);
        let mimic = format!(
            "<axis xyz=\"0 1 0\"/>\n    <mimic joint=\"j1\" multiplier=\"{multiplier}\" offset=\"{offset}\"/>\n"
        );
        let second = URDF.rfind("<axis xyz=\"0 1 0\"/>").expect("an axis");
        let text = format!("{}{mimic}{}", &URDF[..second], &URDF[second + "<axis xyz=\"0 1 0\"/>".len()..]);
        let control = json!({ "law": "exact", "period": 0.001, "W": 10.0, "Pqq": 4.0, "Omega": 16.0 });
        let made = Case::new(name)
            .more("dof", json!(1))
            .more("control", control)
            .accepted_as(text.as_bytes(), &coupled);
        // j2 may reach ±2, which holds j1 back where it turns as fast or slower.
        assert_eq!(made.arm().joints[0].limits.position, Some([-2.0, 2.0]));
    }
}

#[test]
fn rotors_are_read_from_transmissions() {
    let transmission = r#"<transmission name="t1"><type>transmission_interface/SimpleTransmission</type><joint name="j1">
      <hardwareInterface>EffortJointInterface</hardwareInterface></joint><actuator name="m1">
      <mechanicalReduction>50</mechanicalReduction><motorInertia>0.0001</motorInertia></actuator></transmission>"#;
    let mut geared = chain();
    geared.links[0].armature = 0.25;
    let made = Case::new("a rotor").with(transmission).accepted(&geared);
    warned(&made, "transmission[t1]: gives the joint j1 the rotor inertia 2.5e-1 kg·m²");
    let drake = transmission
        .replace("<mechanicalReduction>50</mechanicalReduction>", "<drake:gear_ratio value=\"50\"/>");
    let drake = drake.replace("<motorInertia>0.0001</motorInertia>", "<drake:rotor_inertia value=\"1e-4\"/>");
    Case::new("a rotor of Drake").with(&drake).accepted(&geared);
    let made = Case::new("one without a gear")
        .with(&transmission.replace("mechanicalReduction", "x"))
        .accepted(&chain());
    warned(&made, "gives a rotor inertia without mechanicalReduction, so its rotor inertia is left out");
    let two = transmission.replace("<joint name=\"j1\">", "<joint name=\"j2\"/><joint name=\"j1\">");
    warned(&Case::new("one of two joints").with(&two).accepted(&chain()), "moves 2 joints");
    let mut own = chain();
    own.links[0].armature = 0.1;
    Case::new("one that is replaced")
        .with(transmission)
        .arm("joints", json!({ "j1": { "armature": 0.1 } }))
        .accepted(&own);
    let plain = transmission.replace("<motorInertia>0.0001</motorInertia>", "");
    assert!(Case::new("a gear alone").with(&plain).accepted(&chain()).warnings().is_empty());
}

#[test]
fn loops_are_told() {
    let closed =
        r#"<loop_joint name="bar" type="revolute"><link1 link="l2"/><link2 link="base"/></loop_joint>"#;
    warned(
        &Case::new("a loop").with(closed).accepted(&chain()),
        "loop_joint[bar]: closes a loop, which is ignored",
    );
    let other = closed.replace("bar", "rod");
    warned(&Case::new("another loop").with(&other).accepted(&chain()), "arm.urdf:32: loop_joint[rod]");
}

#[test]
fn encodings_are_those_that_the_file_has() {
    let declared =
        |name: &str| URDF.replace("version=\"1.0\"", &format!("version=\"1.0\" encoding=\"{name}\""));
    let comment = |text: String| {
        text.replace("<link name=\"base\"/>", "<!-- Gelenk für Ärmchen --><link name=\"base\"/>")
    };
    let latin: Vec<u8> = comment(declared("ISO-8859-1"))
        .chars()
        .map(|c| u8::try_from(u32::from(c)).expect("Latin-1"))
        .collect();
    Case::new("Latin-1").accepted_as(&latin, &chain());
    let wide = |bytes: fn(u16) -> [u8; 2]| {
        comment(declared("UTF-16")).encode_utf16().flat_map(bytes).collect::<Vec<u8>>()
    };
    Case::new("UTF-16 little").accepted_as(&[vec![0xff, 0xfe], wide(u16::to_le_bytes)].concat(), &chain());
    Case::new("UTF-16 big").accepted_as(&[vec![0xfe, 0xff], wide(u16::to_be_bytes)].concat(), &chain());
    Case::new("a mark").accepted_as(&[b"\xef\xbb\xbf".as_slice(), URDF.as_bytes()].concat(), &chain());
    Case::new("other line ends").accepted_as(URDF.replace('\n', "\r\n").as_bytes(), &chain());
}
