//! Damaged robot files.

use super::specifications::Dice;

/// A robot of three joints with most of what a robot file may hold.
pub const ROBOT: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<robot name="r" xmlns:xacro="x">
  <link name="base"><inertial><mass value="3"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <link name="l1"><visual><geometry><box size="1 1 1"/></geometry></visual>
    <inertial><origin xyz="0.1 0.02 0.03" rpy="0 0.1 0"/><mass value="4.0"/>
    <inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.1" iyz="0" izz="0.08"/></inertial></link>
  <link name="l2"><inertial><origin xyz="0.1 0 0.03"/><mass value="3.0"/>
    <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.04"/></inertial></link>
  <link name="l3"><inertial><mass value="0.7"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="tool"/>
  <link name="finger"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0.3 0 0" rpy="0 0 1.5708"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="100" velocity="2"/><dynamics damping="0.5" friction="0.1"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.3 0 0" rpy="1.57079632679 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="100" velocity="2"/></joint>
  <joint name="j3" type="prismatic"><parent link="l2"/><child link="l3"/><origin xyz="0.2 0.1 0"/><axis xyz="0 0 1"/>
    <limit lower="-0.5" upper="0.5" effort="50" velocity="1"/></joint>
  <joint name="weld" type="fixed"><parent link="l3"/><child link="tool"/><origin xyz="0 0 0.1" rpy="3.14159 0 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="base"/><child link="finger"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.1" effort="5" velocity="1"/></joint>
  <transmission name="t"><joint name="j1"/><actuator name="m"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>
</robot>
"#;

/// The specifications that name it as `robot.urdf`, one after the other: the exact model alone; reduced, under a law, with
/// values over those of the file; two joints, one held.
pub const SPECS: [&str; 3] = [
    r#"{ "name": "robot", "arm": { "urdf": "robot.urdf", "tip": "tool" },
      "motion": { "quintic": { "from": [0.0, 0.3, 0.0], "to": [0.4, 0.5, 0.1], "duration": 2.0 } }, "model": "exact" }"#,
    r#"{ "name": "robot", "arm": { "urdf": "robot.urdf", "tip": "tool", "payload": { "mass": 0.5, "com": [0.0, 0.0, 0.05] },
        "joints": { "j1": { "armature": 0.5, "limits": { "velocity": 3.0 } }, "j2": { "armature": 0.4 }, "j3": { "armature": 1.0 } } },
      "motion": { "quintic": { "from": [0.0, 0.3, 0.0], "to": [0.4, 0.5, 0.1], "duration": 2.0 } },
      "measure": { "tube": { "position_error": 0.05 } }, "model": { "shared": { "functions": 3 } },
      "control": { "law": "tight", "period": 0.001, "W": 40.0, "Pqq": 1.0, "Omega": 4.0, "boundary_layer": 0.05 } }"#,
    r#"{ "name": "robot", "arm": { "urdf": "robot.urdf", "tip": "tool", "lock": { "j3": 0.1 } },
      "motion": { "sinusoids": { "offset": [0.1, 0.2], "duration": 2.0, "terms": [[{ "amplitude": 0.3, "frequency": 2.0, "phase": 0.0 }], []] } },
      "model": { "tolerance": { "torque": 0.05 } } }"#,
];

/// What an attribute's value is replaced with.
const VALUES: [&str; 32] = [
    "0.5",
    "2",
    "0.1 0.2 0.3",
    "0 1 0",
    "1e-3",
    "0.7071 0.7071 0",
    "10",
    "-0.3",
    "0",
    "-1",
    "1e300",
    "-1e300",
    "1e-300",
    "nan",
    "inf",
    "",
    "x",
    "0 0",
    "0 0 0",
    "1 0 0",
    "0 0 -1",
    "1e-9 0 1",
    "3.14159 0 0",
    "0.3 -0.4 1.2",
    "l1",
    "l2",
    "j1",
    "j2",
    "fixed",
    "continuous",
    "floating",
    "planar",
];

/// Elements that are put in.
const ELEMENTS: [&str; 12] = [
    r#"<mimic joint="j1" multiplier="-0.5" offset="0.1"/>"#,
    r#"<mimic joint="j2"/>"#,
    r#"<mimic joint="j9" multiplier="1e300"/>"#,
    r#"<limit lower="2" upper="-2" effort="-1" velocity="0"/>"#,
    r#"<axis xyz="0 0 0"/>"#,
    r#"<link name="l1"/>"#,
    r#"<joint name="extra" type="revolute"><parent link="tool"/><child link="base"/></joint>"#,
    r#"<loop_joint name="loop" type="revolute"/>"#,
    r#"<drake:joint name="d"/>"#,
    "<!-- a comment -->",
    "<![CDATA[ text & < ]]>",
    "&amp;&#65;&unknown;",
];

/// Elements and what lies between them.
fn pieces(text: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    for c in text.chars() {
        if c == '<' {
            out.push(String::new());
        }
        if let Some(last) = out.last_mut() {
            last.push(c);
        }
    }
    out.retain(|piece| !piece.is_empty());
    out
}

/// The values of all attributes of an element, as ranges of bytes.
fn values(piece: &str) -> Vec<std::ops::Range<usize>> {
    let quotes: Vec<usize> = piece.match_indices('"').map(|(at, _)| at).collect();
    quotes.chunks_exact(2).map(|pair| pair[0] + 1..pair[1]).collect()
}

/// Robot file number `number`, damaged.
pub fn mutant(number: usize) -> Vec<u8> {
    let mut dice = Dice(0x0b0e_u64.wrapping_mul(number as u64 + 1));
    let mut pieces = pieces(ROBOT);
    for _ in 0..=dice.below(3) {
        let at = dice.below(pieces.len());
        match dice.below(20) {
            0 => drop(pieces.remove(at)),
            1 => pieces.insert(at, pieces[at].clone()),
            2 => pieces.insert(at, ELEMENTS[dice.below(ELEMENTS.len())].to_string()),
            3 => {
                let other = dice.below(pieces.len());
                pieces.swap(at, other);
            }
            _ => {
                let with: Vec<usize> =
                    (0..pieces.len()).filter(|&i| !values(&pieces[i]).is_empty()).collect();
                let Some(&at) = with.get(dice.below(with.len().max(1))) else { continue };
                let all = values(&pieces[at]);
                let range = all[dice.below(all.len())].clone();
                pieces[at].replace_range(range, VALUES[dice.below(VALUES.len())]);
            }
        }
    }
    let text = pieces.concat();
    match dice.below(40) {
        0 => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        1 => text.bytes().chain([0xff, 0x00]).collect(),
        2 => {
            let cut = dice.below(text.len());
            text.bytes().take(cut).collect()
        }
        _ => text.into_bytes(),
    }
}
