//! The URDF text before its reader sees it: what the reader would drop or misread without a word is refused here,
//! and what has nothing to do with dynamics is cut out.

use std::path::Path;

use super::super::place::Place;
use crate::error::Faults;

/// Elements without meaning for the dynamics. Their content varies and must not make a file unreadable.
const IGNORED: [&str; 7] =
    ["visual", "collision", "material", "gazebo", "transmission", "ros2_control", "sensor"];

/// Numeric attributes by element: those it must have, those it may have.
const NUMBERS: [(&str, &[&str], &[&str]); 4] = [
    ("mass", &["value"], &[]),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], &[]),
    ("limit", &["velocity"], &["lower", "upper", "effort"]),
    ("dynamics", &[], &["damping", "friction"]),
];

const TYPES: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];

/// One tag of the text.
struct Tag<'a> {
    name: &'a str,
    attributes: Vec<(&'a str, &'a str)>,
    closes: bool,
    empty: bool,
    start: usize,
    end: usize,
}

/// `text` without the elements that do not matter, after faults for macros, malformed numbers and rotations
/// written as quaternions.
pub(super) fn prepare(text: &str, file: &Path, faults: &mut Faults) -> String {
    let tags = tags(text);
    let (kept, out) = cut(text, &tags);
    match kept.first() {
        Some(root) if root.name == "robot" => {}
        Some(root) => {
            let problem = format!("has the root element <{}>", root.name);
            Place::new(file, "").fault(faults, problem, "give a URDF file, whose root is <robot>");
            return out;
        }
        None => {
            Place::new(file, "").fault(
                faults,
                "has no XML element",
                "give a URDF file, whose root is <robot>",
            );
            return out;
        }
    }
    let macros = kept.iter().any(|tag| {
        tag.name.starts_with("xacro:")
            || tag.attributes.iter().any(|(_, value)| value.contains("${") || value.contains("$("))
    });
    if macros {
        Place::new(file, "").fault(
            faults,
            "holds xacro macros, which are not URDF",
            "expand it first: `xacro arm.xacro > arm.urdf`, and name the result",
        );
        return out;
    }
    let version = kept.first().and_then(|root| root.attributes.iter().find(|(key, _)| *key == "version"));
    let may_omit = version.is_some_and(|(_, version)| speed_is_optional(version));
    let mut owner = Place::new(file, "robot");
    for tag in kept.iter().filter(|tag| !tag.closes) {
        let value = |name: &str| tag.attributes.iter().find(|(key, _)| *key == name).map(|(_, value)| *value);
        if let ("link" | "joint", Some(name)) = (tag.name, value("name")) {
            owner = Place::new(file, format!("{}[{name}]", tag.name));
        }
        let here = if tag.name == "joint" { owner.clone() } else { owner.at(tag.name) };
        check(tag, value("type"), may_omit, &here, faults);
    }
    out
}

/// From version 1.2 on `<limit>` need not give the velocity.
fn speed_is_optional(version: &str) -> bool {
    let parts = version.trim().split_once('.');
    let numbers = parts.and_then(|(a, b)| Some((a.parse::<u32>().ok()?, b.parse::<u32>().ok()?)));
    numbers.is_some_and(|numbers| numbers >= (1, 2))
}

fn check(tag: &Tag<'_>, kind: Option<&str>, may_omit: bool, here: &Place, faults: &mut Faults) {
    if let (Some(word), "joint") = (kind.filter(|word| !TYPES.contains(word)), tag.name) {
        let mend = format!("write one of {}", TYPES.join(", "));
        here.at("type").fault(faults, format!("is {word:?}"), mend);
    }
    for (name, value) in &tag.attributes {
        let vector = matches!((tag.name, *name), ("origin", "xyz" | "rpy") | ("axis", "xyz"));
        let numbers: Vec<Option<f64>> = value.split_whitespace().map(|v| v.parse().ok()).collect();
        if vector && (numbers.len() != 3 || numbers.contains(&None)) {
            here.at(name).fault(faults, format!("is {value:?}"), "write three numbers separated by spaces");
        }
        if *name == "quat_xyzw" {
            here.at(name).fault(faults, "is a quaternion, which is not read", "write the rotation as `rpy`");
        }
    }
    for (_, required, optional) in NUMBERS.iter().filter(|(element, ..)| *element == tag.name) {
        for name in required.iter().chain(*optional) {
            match tag.attributes.iter().find(|(key, _)| key == name) {
                Some((_, value)) if value.trim().parse::<f64>().is_err() => {
                    here.at(name).fault(faults, format!("is {value:?}"), "write a number");
                }
                None if required.contains(name) && !(may_omit && *name == "velocity") => {
                    here.at(name).fault(faults, "is missing", "write a number");
                }
                _ => {}
            }
        }
    }
}

/// The tags outside ignored elements, and the text without these.
fn cut<'t, 'a>(text: &str, tags: &'t [Tag<'a>]) -> (Vec<&'t Tag<'a>>, String) {
    let mut kept = Vec::new();
    let mut out = String::with_capacity(text.len());
    let mut copied = 0;
    let mut ignored: Option<(&str, usize, usize)> = None;
    for tag in tags {
        match &mut ignored {
            Some((name, start, depth)) if *name == tag.name && !tag.empty => {
                *depth = if tag.closes { *depth - 1 } else { *depth + 1 };
                if *depth == 0 {
                    out.push_str(text.get(copied..*start).unwrap_or_default());
                    copied = tag.end;
                    ignored = None;
                }
            }
            Some(_) => {}
            None if IGNORED.contains(&tag.name) && !tag.closes => {
                if tag.empty {
                    out.push_str(text.get(copied..tag.start).unwrap_or_default());
                    copied = tag.end;
                } else {
                    ignored = Some((tag.name, tag.start, 1));
                }
            }
            None => kept.push(tag),
        }
    }
    out.push_str(text.get(copied..).unwrap_or_default());
    (kept, out)
}

/// All tags in order; comments, declarations and CDATA are passed over, a malformed rest is left out.
fn tags(text: &str) -> Vec<Tag<'_>> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(start) = text.get(at..).and_then(|rest| rest.find('<')).map(|i| at + i) {
        let rest = text.get(start..).unwrap_or_default();
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">")]
            .iter()
            .find(|(opening, _)| rest.starts_with(opening));
        if let Some((_, closing)) = skipped {
            let Some(length) = rest.find(closing) else { break };
            at = start + length + closing.len();
            continue;
        }
        let Some(length) = length(rest) else { break };
        let inner = rest.get(1..length - 1).unwrap_or_default();
        let closes = inner.starts_with('/');
        let empty = inner.ends_with('/');
        let inner = inner.trim_start_matches('/').trim_end_matches('/');
        let name = inner.split_whitespace().next().unwrap_or_default();
        let attributes = attributes(inner.get(name.len()..).unwrap_or_default());
        at = start + length;
        out.push(Tag { name, attributes, closes, empty, start, end: at });
    }
    out
}

/// Length of the tag at the start of `rest`, up to its `>` outside quotes.
fn length(rest: &str) -> Option<usize> {
    let mut quote = None;
    for (i, c) in rest.char_indices() {
        match (quote, c) {
            (None, '>') => return Some(i + 1),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), c) if c == open => quote = None,
            _ => {}
        }
    }
    None
}

fn attributes(mut rest: &str) -> Vec<(&str, &str)> {
    let mut out = Vec::new();
    while let Some((name, after)) = rest.split_once('=') {
        let after = after.trim_start();
        let Some(quote) = after.chars().next().filter(|c| matches!(c, '"' | '\'')) else { break };
        let Some((value, tail)) = after.get(1..).and_then(|s| s.split_once(quote)) else { break };
        out.push((name.trim(), value));
        rest = tail;
    }
    out
}
