//! Random arms whose angles lie beside multiples of π/2, as a specification and as the oracle takes them.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

use gramforge_tests::oracle::{Fixed, Link};
use gramforge_tests::random::Random;
use serde_json::{Value, json};

/// An arm.
pub struct Case {
    /// What its angles are off by, as a power of ten.
    pub exponent: i32,
    /// Where the specification comes from: `standard`, `modified` or `urdf`.
    pub source: &'static str,
    /// The specification.
    pub spec: Value,
    /// The URDF that it names.
    pub urdf: Option<String>,
    /// The arm.
    pub links: Vec<Link>,
}

/// Limits of the rates, the same for every joint.
pub const SPEED: f64 = 2.0;
pub const ACCELERATION: f64 = 6.0;
/// Range of positions, rad or m.
pub const RANGE: f64 = 2.4;

/// Beside a multiple of π/2, or anything.
fn angle(random: &mut Random, off: f64) -> f64 {
    let quarters = (4.0 * random.signed()).floor();
    let side = if random.signed() < 0.0 { -1.0 } else { 1.0 };
    match (2.5 * (random.signed() + 1.0)) as u8 {
        0 => quarters * FRAC_PI_2,
        1..4 => quarters * FRAC_PI_2 + side * off * (1.0 + 0.5 * random.signed()),
        _ => 0.25 * TAU * random.signed(),
    }
}

fn body(random: &mut Random, link: &mut Link) {
    // A light hand on a heavy arm, too.
    let scale = 10.0_f64.powf(random.signed() - 0.5);
    link.mass = 4.0 * scale;
    link.com = std::array::from_fn(|_| 0.2 * random.signed());
    let mut entry = |most: f64| scale * most * random.signed();
    let diagonal: [f64; 3] = std::array::from_fn(|_| 0.05 * scale + entry(0.01));
    let products: [f64; 3] = std::array::from_fn(|_| entry(0.01));
    link.inertia = [diagonal[0], diagonal[1], diagonal[2], products[0], products[1], products[2]];
}

/// Arm number `index`, with `joints` joints and angles off by about 10^`exponent`.
pub fn case(index: u64, joints: usize, exponent: i32) -> Case {
    let mut random = Random::new(1000 + index);
    let off = 10.0_f64.powi(exponent);
    let source = ["standard", "urdf", "modified", "urdf"][index as usize % 4];
    let mut rows = Vec::new();
    let mut links = Vec::new();
    for number in 0..joints {
        let turns = random.signed() > -0.5;
        let empty = Link {
            before: Vec::new(),
            turns,
            axis: [0.0, 0.0, 1.0],
            after: Vec::new(),
            mass: 0.0,
            com: [0.0; 3],
            inertia: [0.0; 6],
        };
        let mut link = empty;
        body(&mut random, &mut link);
        if source == "urdf" {
            joint(&mut random, off, &mut link);
        } else {
            let numbers = [
                angle(&mut random, off),
                0.4 * random.signed(),
                0.3 * random.signed(),
                angle(&mut random, off),
            ];
            row(source, numbers, &mut link);
            rows.push(written(numbers, &link));
        }
        if index % 7 == 3 && number + 1 == joints {
            // Beside such an arm this hand weighs nothing, and its joint still has a torque.
            link.mass *= 1e-9;
            link.inertia.iter_mut().for_each(|entry| *entry *= 1e-9);
            if let Some(row) = rows.last_mut() {
                weighed(row, &link);
            }
        }
        links.push(link);
    }
    let name = format!("twist{index}");
    let mut spec =
        json!({ "name": name, "arm": { "round_angles": 0.0 }, "measure": "workspace", "model": "exact" });
    let mut urdf = None;
    if source == "urdf" {
        spec["arm"]["urdf"] = json!(format!("{name}.urdf"));
        let limits = json!({ "limits": { "position": [-RANGE, RANGE], "velocity": SPEED, "acceleration": ACCELERATION } });
        let named = (1..=joints).map(|i| (format!("j{i}"), limits.clone()));
        spec["arm"]["joints"] = Value::Object(named.collect());
        urdf = Some(robot(&links));
    } else {
        spec["arm"]["dh"] = json!({ "convention": source, "links": rows });
    }
    Case { exponent, source, spec, urdf, links }
}

/// α, a, d and θ of a row of a table.
fn row(convention: &str, [alpha, a, d, theta]: [f64; 4], link: &mut Link) {
    let (twist, length) = (Fixed::Turn(0, alpha), Fixed::Shift([a, 0.0, 0.0]));
    let (angle, offset) = (Fixed::Turn(2, theta), Fixed::Shift([0.0, 0.0, d]));
    if convention == "standard" {
        link.before = vec![angle, offset];
        link.after = vec![length, twist];
    } else {
        link.before = vec![twist, length, angle, offset];
    }
}

fn weighed(row: &mut Value, link: &Link) {
    let [xx, yy, zz, xy, xz, yz] = link.inertia;
    row["mass"] = json!(link.mass);
    row["inertia"] = json!({ "xx": xx, "yy": yy, "zz": zz, "xy": xy, "xz": xz, "yz": yz });
}

fn written([alpha, a, d, theta]: [f64; 4], link: &Link) -> Value {
    let mut row = json!({
        "joint": if link.turns { "revolute" } else { "prismatic" },
        "alpha": alpha, "a": a, "d": d, "theta": theta,
        "com": link.com,
        "limits": { "position": [-RANGE, RANGE], "velocity": SPEED, "acceleration": ACCELERATION },
    });
    weighed(&mut row, link);
    row
}

/// An arm of two joints with forty fixed ones before each, all turned by `off` the same way.
pub fn welded(off: f64) -> Case {
    let mut case = case(1, 2, -12);
    for link in &mut case.links {
        let weld =
            [Fixed::Shift([0.01, 0.0, 0.0]), Fixed::Turn(2, 0.0), Fixed::Turn(1, off), Fixed::Turn(0, off)];
        link.before = std::iter::repeat_n(weld, 41).flatten().collect();
        link.axis = [0.0, 0.0, 1.0];
    }
    case.urdf = Some(robot(&case.links));
    case
}

/// Origin and axis of a joint of a URDF, and perhaps a fixed joint before it.
fn joint(random: &mut Random, off: f64, link: &mut Link) {
    for _ in 0..if random.signed() > 0.4 { 2 } else { 1 } {
        link.before.push(Fixed::Shift(std::array::from_fn(|_| 0.3 * random.signed())));
        // One or two angles: three make no structure that could be lost.
        let turned = [2, 1, 0].map(|axis| (axis, random.signed() > 0.0, angle(random, off)));
        link.before
            .extend(turned.map(|(axis, used, angle)| Fixed::Turn(axis, if used { angle } else { 0.0 })));
    }
    let tilt = if random.signed() > 0.5 { off } else { 0.0 };
    link.axis = [[0.0, 0.0, 1.0], [0.0, 1.0, tilt], [-1.0, tilt, 0.0], [tilt, 0.0, -1.0], [1.0, 1.0, 0.0]]
        [(2.5 * (random.signed() + 1.0)) as usize % 5];
}

fn robot(links: &[Link]) -> String {
    let mut text = String::from("<robot name=\"r\">\n<link name=\"l0\"/>\n");
    for (i, link) in (1..).zip(links) {
        let mut parent = format!("l{}", i - 1);
        let origins = link.before.chunks(4).enumerate();
        let count = link.before.len() / 4;
        for (k, steps) in origins {
            let [Fixed::Shift([x, y, z]), Fixed::Turn(_, yaw), Fixed::Turn(_, pitch), Fixed::Turn(_, roll)] =
                steps
            else {
                panic!("a shift and three turns")
            };
            let origin = format!("<origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/>");
            let child = if k + 1 == count { format!("l{i}") } else { format!("f{i}_{k}") };
            let ends = format!("<parent link=\"{parent}\"/><child link=\"{child}\"/>");
            if k + 1 < count {
                writeln!(text, "<link name=\"{child}\"/>\n<joint name=\"weld{i}_{k}\" type=\"fixed\">{origin}{ends}</joint>")
            } else {
                let kind = if link.turns { "revolute" } else { "prismatic" };
                let [x, y, z] = link.axis;
                writeln!(
                    text,
                    "<joint name=\"j{i}\" type=\"{kind}\">{origin}{ends}<axis xyz=\"{x} {y} {z}\"/><limit effort=\"0\" velocity=\"{SPEED}\"/></joint>"
                )
            }
            .expect("text");
            parent = child;
        }
        let ([x, y, z], [xx, yy, zz, xy, xz, yz]) = (link.com, link.inertia);
        writeln!(
            text,
            "<link name=\"l{i}\"><inertial><origin xyz=\"{x} {y} {z}\"/><mass value=\"{}\"/><inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"{xy}\" ixz=\"{xz}\" iyz=\"{yz}\"/></inertial></link>",
            link.mass
        )
        .expect("text");
    }
    text + "</robot>\n"
}
