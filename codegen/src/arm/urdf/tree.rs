//! The kinematic tree of a URDF: one root, every link reached, one chain from root to tip that moves.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use urdf_rs::{Joint, JointType, Robot};

use super::super::place::Place;
use crate::error::Faults;
use crate::spec::ArmSpec;

/// What a joint does in the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Moves; on the chain.
    Moves,
    /// Welded at this position (rad or m; 0 for fixed joints).
    Welded(f64),
}

/// A checked tree: joints ordered so that a parent link always comes before its children.
pub(super) struct Tree<'a> {
    /// The link that no joint carries.
    pub root: &'a str,
    /// The link at which the arm ends.
    pub tip: &'a str,
    /// Every joint with its role, root first, in the file's order where there is a choice.
    pub joints: Vec<(&'a Joint, Role)>,
}

/// The tree of `robot`; `None` where its shape is at fault.
pub(super) fn tree<'a>(
    robot: &'a Robot,
    spec: &'a ArmSpec,
    file: &Path,
    faults: &mut Faults,
) -> Option<Tree<'a>> {
    let before = faults.count();
    let whole = Place::new(file, "");
    if robot.links.is_empty() {
        whole.fault(faults, "has no <link>", "give the URDF of an arm");
        return None;
    }
    unique(robot.links.iter().map(|l| l.name.as_str()), "link", &whole, faults);
    unique(robot.joints.iter().map(|j| j.name.as_str()), "joint", &whole, faults);
    let links: BTreeSet<&str> = robot.links.iter().map(|l| l.name.as_str()).collect();
    let carrier = carriers(robot, &links, file, faults);
    if faults.count() > before {
        return None;
    }
    let root = root(robot, &carrier, &whole, faults)?;
    let ordered = ordered(robot, root);
    let reached: BTreeSet<&str> =
        ordered.iter().map(|j| j.child.link.as_str()).chain(std::iter::once(root)).collect();
    let cut_off: Vec<&str> = links.difference(&reached).copied().collect();
    if !cut_off.is_empty() {
        let problem = format!("has a loop: {} cannot be reached from the root {root}", cut_off.join(", "));
        whole.fault(faults, problem, "make the joints a tree");
        return None;
    }
    let tip = tip(robot, spec, &links, file, faults)?;
    let chain = chain(tip, &carrier);
    let joints = roles(&ordered, &chain, spec, file, faults);
    (faults.count() == before).then_some(Tree { root, tip, joints })
}

fn unique<'a>(names: impl Iterator<Item = &'a str>, kind: &str, place: &Place, faults: &mut Faults) {
    let mut seen = BTreeSet::new();
    let twice: BTreeSet<&str> = names.filter(|name| !seen.insert(*name)).collect();
    for name in twice {
        place.at(&format!("{kind}[{name}]")).fault(faults, "stands twice", "give each its own name");
    }
}

/// The joint that carries each link.
fn carriers<'a>(
    robot: &'a Robot,
    links: &BTreeSet<&str>,
    file: &Path,
    faults: &mut Faults,
) -> BTreeMap<&'a str, &'a Joint> {
    let mut out = BTreeMap::new();
    for joint in &robot.joints {
        let place = Place::new(file, format!("joint[{}]", joint.name));
        for (end, link) in [("parent", &joint.parent.link), ("child", &joint.child.link)] {
            if !links.contains(link.as_str()) {
                let mend = format!("name one of the links {}", list(links.iter().copied()));
                place.at(end).fault(faults, format!("is {link:?}, which is not a link"), mend);
            }
        }
        if let Some(other) = out.insert(joint.child.link.as_str(), joint) {
            let problem =
                format!("is {:?}, which the joint {:?} carries already", joint.child.link, other.name);
            place.at("child").fault(faults, problem, "let one joint carry each link");
        }
    }
    out
}

fn root<'a>(
    robot: &'a Robot,
    carrier: &BTreeMap<&str, &Joint>,
    whole: &Place,
    faults: &mut Faults,
) -> Option<&'a str> {
    let roots: Vec<&str> =
        robot.links.iter().map(|l| l.name.as_str()).filter(|name| !carrier.contains_key(name)).collect();
    match roots.as_slice() {
        [root] => Some(root),
        [] => {
            whole.fault(faults, "has a loop: every link is carried by a joint", "make the joints a tree");
            None
        }
        several => {
            let problem = format!("falls apart: {} are carried by no joint", several.join(", "));
            whole.fault(faults, problem, "join the parts, or remove all but the arm");
            None
        }
    }
}

/// Joints reachable from `root`, breadth first.
fn ordered<'a>(robot: &'a Robot, root: &str) -> Vec<&'a Joint> {
    let from = |link: &str| robot.joints.iter().filter(|j| j.parent.link == link).collect::<Vec<_>>();
    let mut out = from(root);
    let mut next = 0;
    while let Some(joint) = out.get(next) {
        let children = from(&joint.child.link);
        out.extend(children);
        next += 1;
    }
    out
}

fn tip<'a>(
    robot: &'a Robot,
    spec: &'a ArmSpec,
    links: &BTreeSet<&str>,
    file: &Path,
    faults: &mut Faults,
) -> Option<&'a str> {
    if let Some(tip) = &spec.tip {
        if !links.contains(tip.as_str()) {
            let mend = format!("name one of the links {}", list(links.iter().copied()));
            faults.push("arm.tip", format!("is {tip:?}, which is not a link of {}", file.display()), mend);
            return None;
        }
        return Some(tip);
    }
    let parents: BTreeSet<&str> = robot.joints.iter().map(|j| j.parent.link.as_str()).collect();
    let leaves: Vec<&str> =
        robot.links.iter().map(|l| l.name.as_str()).filter(|name| !parents.contains(name)).collect();
    match leaves.as_slice() {
        [leaf] => Some(leaf),
        several => {
            let problem = format!("is missing, and {} ends in {} links", file.display(), several.len());
            faults.push("arm.tip", problem, format!("name one of {}", several.join(", ")));
            None
        }
    }
}

/// Names of the joints between root and tip.
fn chain<'a>(tip: &str, carrier: &BTreeMap<&str, &'a Joint>) -> BTreeSet<&'a str> {
    let mut out = BTreeSet::new();
    let mut link = tip;
    while let Some(joint) = carrier.get(link) {
        out.insert(joint.name.as_str());
        link = &joint.parent.link;
    }
    out
}

fn roles<'a>(
    ordered: &[&'a Joint],
    chain: &BTreeSet<&str>,
    spec: &ArmSpec,
    file: &Path,
    faults: &mut Faults,
) -> Vec<(&'a Joint, Role)> {
    let movable: Vec<&str> = ordered.iter().filter(|j| slides_or_turns(j)).map(|j| j.name.as_str()).collect();
    for name in spec.lock.keys().filter(|name| !movable.contains(&name.as_str())) {
        let mend = format!("name one of the movable joints {}", list(movable.iter().copied()));
        faults.push(
            format!("arm.lock.{name}"),
            format!("is not a movable joint of {}", file.display()),
            mend,
        );
    }
    let mut out = Vec::new();
    for joint in ordered {
        let role = match (&joint.joint_type, spec.lock.get(&joint.name)) {
            (JointType::Fixed, _) => Some(Role::Welded(0.0)),
            (JointType::Floating | JointType::Planar | JointType::Spherical, _) => {
                let problem = format!("is {:?}", joint.joint_type).to_lowercase();
                Place::new(file, format!("joint[{}].type", joint.name)).fault(
                    faults,
                    problem,
                    "an arm takes revolute, continuous and prismatic joints; make it one of these or fixed",
                );
                None
            }
            (_, Some(position)) => Some(Role::Welded(*position)),
            (_, None) if !chain.contains(joint.name.as_str()) => {
                faults.push(
                    format!("arm.lock.{}", joint.name),
                    "is missing: this joint moves a branch off the chain to the tip",
                    "give the position (rad or m) at which it is held",
                );
                None
            }
            (_, None) => match &joint.mimic {
                Some(mimic) => {
                    Place::new(file, format!("joint[{}].mimic", joint.name)).fault(
                        faults,
                        format!("couples the joint to {:?}, which is not supported", mimic.joint),
                        "remove it where the joint has its own drive, or hold the joint by `arm.lock`",
                    );
                    None
                }
                None => Some(Role::Moves),
            },
        };
        out.extend(role.map(|role| (*joint, role)));
    }
    let moving: Vec<&str> =
        out.iter().filter(|(_, role)| *role == Role::Moves).map(|(j, _)| j.name.as_str()).collect();
    for name in spec.joints.keys().filter(|name| !moving.contains(&name.as_str())) {
        let mend = format!("name one of {}", list(moving.iter().copied()));
        faults.push(format!("arm.joints.{name}"), "is not a joint of the arm", mend);
    }
    out
}

fn slides_or_turns(joint: &Joint) -> bool {
    matches!(joint.joint_type, JointType::Revolute | JointType::Continuous | JointType::Prismatic)
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    if names.is_empty() { "(there is none)".into() } else { names.join(", ") }
}
