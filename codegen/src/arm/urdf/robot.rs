//! Links and joints of a URDF file, as they are written: a number is judged where it is used.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::place::Place;
use super::xml::Element;
use crate::error::Diagnostics;
use crate::load::plain;
use crate::spec::JointKind;

/// The links and joints of a file.
pub(super) struct Robot<'a> {
    /// The links, in the file's order; names are unique.
    pub links: Vec<Link<'a>>,
    /// The joints, in the file's order; names are unique.
    pub joints: Vec<Joint<'a>>,
}

/// A link.
#[derive(Clone, Debug)]
pub(super) struct Link<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its element.
    pub element: &'a Element,
    /// Where it stands.
    pub place: Place,
}

/// A joint.
#[derive(Clone, Debug)]
pub(super) struct Joint<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its type.
    pub kind: Kind,
    /// The link before it.
    pub parent: &'a str,
    /// The link behind it.
    pub child: &'a str,
    /// Its element.
    pub element: &'a Element,
    /// Where it stands.
    pub place: Place,
}

/// Type of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Turns within limits.
    Revolute,
    /// Turns without limits.
    Continuous,
    /// Slides.
    Prismatic,
    /// Does not move.
    Fixed,
    /// Moves in all six ways.
    Floating,
    /// Moves in a plane.
    Planar,
    /// Turns about a point.
    Spherical,
}

const KINDS: [(&str, Kind); 7] = [
    ("revolute", Kind::Revolute),
    ("continuous", Kind::Continuous),
    ("prismatic", Kind::Prismatic),
    ("fixed", Kind::Fixed),
    ("floating", Kind::Floating),
    ("planar", Kind::Planar),
    ("spherical", Kind::Spherical),
];

impl Kind {
    /// As the file writes it.
    pub fn name(self) -> &'static str {
        KINDS.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// What the joint is for the arm; `None` for a joint that has not one coordinate.
    pub fn moving(self) -> Option<JointKind> {
        match self {
            Self::Revolute | Self::Continuous => Some(JointKind::Revolute),
            Self::Prismatic => Some(JointKind::Prismatic),
            Self::Fixed | Self::Floating | Self::Planar | Self::Spherical => None,
        }
    }
}

/// Most links, and most joints, of a file: a humanoid has about a hundred.
const MOST: usize = 2000;
/// Longest name of a link or joint, characters.
const LONGEST_NAME: usize = 200;

/// The elements that are read, and thus those in which a macro matters.
const READ: [&str; 12] = [
    "link", "joint", "inertial", "origin", "mass", "inertia", "parent", "child", "axis", "limit", "dynamics",
    "mimic",
];

impl<'a> Robot<'a> {
    /// The robot of the root element; `None` where it is none or two things have one name.
    pub fn read(root: &'a Element, file: &Path, faults: &mut Diagnostics) -> Option<Self> {
        let before = faults.count();
        let whole = Place::new(file, "");
        if root.name != "robot" {
            let problem = format!("has the root element <{}>", root.name);
            whole.on(root.line).fault(faults, problem, "give a URDF file, whose root is <robot>");
            return None;
        }
        if let Some(line) = root.children.iter().find_map(macros) {
            let help = "expand it first: `xacro arm.xacro > arm.urdf`, and name the result";
            whole.on(line).fault(faults, "holds xacro macros, which are not URDF", help);
            return None;
        }
        for kind in ["link", "joint"] {
            let count = root.all(kind).count();
            if let Some(first) = root.all(kind).nth(MOST) {
                let problem = format!("has {count} elements <{kind}>, and at most {MOST} are read");
                whole.on(first.line).fault(faults, problem, "give the URDF file of one arm");
            }
        }
        if faults.count() > before {
            return None;
        }
        let links: Vec<Link<'_>> = root
            .all("link")
            .filter_map(|element| {
                let (name, place) = named(element, "link", &whole, faults)?;
                Some(Link { name, element, place })
            })
            .collect();
        let joints: Vec<Joint<'_>> =
            root.all("joint").filter_map(|element| joint(element, &whole, faults)).collect();
        if links.is_empty() && faults.count() == before {
            whole.on(root.line).fault(faults, "has no <link>", "give the URDF of an arm");
        }
        unique(links.iter().map(|link| (link.name, &link.place)), faults);
        unique(joints.iter().map(|joint| (joint.name, &joint.place)), faults);
        (faults.count() == before).then_some(Self { links, joints })
    }
}

/// The line of the first macro where it would matter.
fn macros(element: &Element) -> Option<usize> {
    if element.name.starts_with("xacro:") {
        return Some(element.line);
    }
    if !READ.contains(&element.name.as_str()) {
        return None;
    }
    let unexpanded = |value: &str| value.contains("${") || value.contains("$(");
    let own = element.attributes.iter().find(|attribute| unexpanded(&attribute.value));
    own.map(|attribute| attribute.line).or_else(|| element.children.iter().find_map(macros))
}

/// Name and place of a link or joint.
fn named<'a>(
    element: &'a Element,
    kind: &str,
    whole: &Place,
    faults: &mut Diagnostics,
) -> Option<(&'a str, Place)> {
    let Some(name) = element.attribute("name") else {
        let place = whole.at(kind).at("name").on(element.line);
        place.fault(faults, "is missing", format!("give the {kind} a name"));
        return None;
    };
    let file = whole.file();
    let field = format!("{kind}[{}].name", name.value);
    if !plain(&name.value, file, Some(name.line), &field, faults) {
        return None;
    }
    if name.value.trim().is_empty() {
        let place = whole.at(kind).at("name").on(name.line);
        place.fault(faults, format!("is {:?}", name.value), format!("give the {kind} a name"));
        return None;
    }
    let length = name.value.chars().count();
    if length > LONGEST_NAME {
        let place = whole.at(kind).at("name").on(name.line);
        let help = format!("write at most {LONGEST_NAME}: it is written into messages and into the module");
        place.fault(faults, format!("has {length} characters"), help);
        return None;
    }
    Some((&name.value, whole.at(&format!("{kind}[{}]", name.value)).on(element.line)))
}

fn joint<'a>(element: &'a Element, whole: &Place, faults: &mut Diagnostics) -> Option<Joint<'a>> {
    let (name, place) = named(element, "joint", whole, faults)?;
    let words = || KINDS.map(|(word, _)| word).join(", ");
    let kind = match element.attribute("type") {
        None => {
            place.at("type").fault(faults, "is missing", format!("write one of {}", words()));
            None
        }
        Some(word) => {
            let kind = KINDS.iter().find(|(known, _)| *known == word.value).map(|(_, kind)| *kind);
            if kind.is_none() {
                let place = place.at("type").on(word.line);
                place.fault(faults, format!("is {:?}", word.value), format!("write one of {}", words()));
            }
            kind
        }
    };
    let mut end = |which: &str| {
        let Some(end) = element.one(which, &place, faults) else {
            place.at(which).fault(faults, "is missing", format!("write <{which} link=\"…\"/>"));
            return None;
        };
        let link = end.attribute("link");
        if link.is_none() {
            place.at(which).at("link").on(end.line).fault(faults, "is missing", "name a link");
        }
        link.map(|link| link.value.as_str())
    };
    let (parent, child) = (end("parent"), end("child"));
    Some(Joint { name, kind: kind?, parent: parent?, child: child?, element, place })
}

fn unique<'a>(named: impl Iterator<Item = (&'a str, &'a Place)>, faults: &mut Diagnostics) {
    let mut seen: BTreeMap<&str, &Place> = BTreeMap::new();
    for (name, place) in named {
        if let Some(first) = seen.get(name) {
            let line = first.line().map_or(String::new(), |line| format!(", first in line {line}"));
            place.fault(faults, format!("occurs twice{line}"), "give each a different name");
        } else {
            seen.insert(name, place);
        }
    }
}

/// The number `name` of `element`; `None` where it is missing, and after a fault where it is no number. `place` is the
/// element's.
pub(super) fn number(element: &Element, name: &str, place: &Place, faults: &mut Diagnostics) -> Option<f64> {
    let attribute = element.attribute(name)?;
    let value = attribute.value.trim().parse().ok();
    if value.is_none() {
        let place = place.at(name).on(attribute.line);
        place.fault(faults, format!("is {:?}", attribute.value), "write a number");
    }
    value
}

/// The same, after a fault also where it is missing.
pub(super) fn required(
    element: &Element,
    name: &str,
    place: &Place,
    faults: &mut Diagnostics,
) -> Option<f64> {
    if element.attribute(name).is_none() {
        place.at(name).on(element.line).fault(faults, "is missing", "write a number");
    }
    number(element, name, place, faults)
}

/// Three numbers of the attribute `name`; `otherwise` where it is missing, `None` after a fault.
pub(super) fn triple(
    element: &Element,
    name: &str,
    otherwise: [f64; 3],
    place: &Place,
    faults: &mut Diagnostics,
) -> Option<[f64; 3]> {
    let Some(attribute) = element.attribute(name) else { return Some(otherwise) };
    let numbers: Option<Vec<f64>> =
        attribute.value.split_whitespace().map(|number| number.parse().ok()).collect();
    let triple = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    if triple.is_none() {
        let help = "write three numbers separated by spaces";
        place.at(name).on(attribute.line).fault(faults, format!("is {:?}", attribute.value), help);
    }
    triple
}
