//! The kinematic tree of a URDF: one root, every link reached, one chain from root to tip that moves.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::super::place::Place;
use super::mimic::{self, Follow};
use super::robot::{Joint, Kind, Robot};
use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::ArmSpec;
use crate::text::listed;

/// What a joint does in the arm.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Role<'a> {
    /// Moves; on the chain.
    Moves,
    /// Follows a joint that moves; on the chain.
    Follows(Follow<'a>),
    /// Welded at this position (rad or m; 0 for fixed joints).
    Welded(f64),
    /// Stands on the base, off the chain: no matter.
    Idle,
}

/// A checked tree: joints ordered so that a parent link always comes before its children.
pub(super) struct Tree<'a> {
    /// The link that no joint carries.
    pub root: &'a str,
    /// The link at which the arm ends.
    pub tip: &'a str,
    /// Every joint with its role, root first, in the file's order where there is a choice.
    pub joints: Vec<(&'a Joint<'a>, Role<'a>)>,
}

/// The tree of `robot`; `None` where its shape is at fault.
pub(super) fn tree<'a>(
    robot: &'a Robot<'a>,
    spec: &'a ArmSpec,
    file: &Path,
    faults: &mut Diagnostics,
) -> Option<Tree<'a>> {
    let before = faults.count();
    let whole = Place::new(file, "");
    let links: BTreeSet<&str> = robot.links.iter().map(|l| l.name).collect();
    let carrier = carriers(robot, &links, faults);
    if faults.count() > before {
        return None;
    }
    let root = root(robot, &carrier, &whole, faults)?;
    let ordered = ordered(robot, root);
    let reached: BTreeSet<&str> = ordered.iter().map(|j| j.child).chain(std::iter::once(root)).collect();
    let cut_off: Vec<&str> = links.difference(&reached).copied().collect();
    if !cut_off.is_empty() {
        let problem = format!("has a loop: {} cannot be reached from the root {root}", listed(&cut_off));
        let whole = at_first(
            robot.joints.iter().find(|joint| cut_off.contains(&joint.child)).map(|j| &j.place),
            &whole,
        );
        whole.fault(faults, problem, "make the joints a tree");
        return None;
    }
    let tip = tip(robot, spec, &links, file, faults)?;
    let chain = chain(tip, &carrier);
    let joints = roles(&ordered, &chain, spec, file, faults);
    (faults.count() == before).then_some(Tree { root, tip, joints })
}

/// The whole file, in the line of `first` where that is known.
fn at_first(first: Option<&Place>, whole: &Place) -> Place {
    first.and_then(Place::line).map_or_else(|| whole.clone(), |line| whole.on(line))
}

/// The joint that carries each link.
fn carriers<'a>(
    robot: &'a Robot<'a>,
    links: &BTreeSet<&str>,
    faults: &mut Diagnostics,
) -> BTreeMap<&'a str, &'a Joint<'a>> {
    let mut out: BTreeMap<&str, &Joint<'_>> = BTreeMap::new();
    for joint in &robot.joints {
        for (end, link) in [("parent", joint.parent), ("child", joint.child)] {
            if !links.contains(link) {
                let help = format!("name one of the links {}", list(links.iter().copied()));
                joint.place.at(end).fault(faults, format!("is {link:?}, which is not a link"), help);
            }
        }
        if let Some(other) = out.insert(joint.child, joint) {
            let problem = format!("is {:?}, which the joint {:?} carries already", joint.child, other.name);
            joint.place.at("child").fault(faults, problem, "let one joint carry each link");
        }
    }
    out
}

fn root<'a>(
    robot: &'a Robot<'a>,
    carrier: &BTreeMap<&str, &Joint<'_>>,
    whole: &Place,
    faults: &mut Diagnostics,
) -> Option<&'a str> {
    let roots: Vec<&str> =
        robot.links.iter().map(|l| l.name).filter(|name| !carrier.contains_key(name)).collect();
    match roots.as_slice() {
        [root] => Some(root),
        [] => {
            let whole = at_first(robot.joints.first().map(|joint| &joint.place), whole);
            whole.fault(faults, "has a loop: every link is carried by a joint", "make the joints a tree");
            None
        }
        several => {
            let problem = format!("is not connected: no joint carries {}", listed(several));
            let second = robot.links.iter().find(|link| several.get(1) == Some(&link.name));
            let whole = at_first(second.map(|link| &link.place), whole);
            whole.fault(faults, problem, "join the parts, or remove all but the arm");
            None
        }
    }
}

/// Joints reachable from `root`, breadth first.
fn ordered<'a>(robot: &'a Robot<'a>, root: &str) -> Vec<&'a Joint<'a>> {
    let mut behind: BTreeMap<&str, Vec<&Joint<'_>>> = BTreeMap::new();
    for joint in &robot.joints {
        behind.entry(joint.parent).or_default().push(joint);
    }
    let mut out = behind.remove(root).unwrap_or_default();
    let mut next = 0;
    while let Some(joint) = out.get(next) {
        out.extend(behind.remove(joint.child).unwrap_or_default());
        next += 1;
    }
    out
}

fn tip<'a>(
    robot: &'a Robot<'a>,
    spec: &'a ArmSpec,
    links: &BTreeSet<&str>,
    file: &Path,
    faults: &mut Diagnostics,
) -> Option<&'a str> {
    if let Some(tip) = &spec.tip {
        if !links.contains(tip.as_str()) {
            let help = format!("name one of the links {}", list(links.iter().copied()));
            faults.push("arm.tip", format!("is {tip:?}, which is not a link of {}", file.display()), help);
            return None;
        }
        return Some(tip);
    }
    let parents: BTreeSet<&str> = robot.joints.iter().map(|j| j.parent).collect();
    let leaves: Vec<&str> =
        robot.links.iter().map(|l| l.name).filter(|name| !parents.contains(name)).collect();
    match leaves.as_slice() {
        [leaf] => Some(leaf),
        several => {
            let problem = format!("is missing, and {} ends in {} links", file.display(), several.len());
            faults.push("arm.tip", problem, format!("name one of {}", listed(several)));
            None
        }
    }
}

/// Names of the joints between root and tip.
fn chain<'a>(tip: &str, carrier: &BTreeMap<&str, &'a Joint<'a>>) -> BTreeSet<&'a str> {
    let mut out = BTreeSet::new();
    let mut link = tip;
    while let Some(joint) = carrier.get(link) {
        out.insert(joint.name);
        link = joint.parent;
    }
    out
}

fn roles<'a>(
    ordered: &[&'a Joint<'a>],
    chain: &BTreeSet<&str>,
    spec: &ArmSpec,
    file: &Path,
    faults: &mut Diagnostics,
) -> Vec<(&'a Joint<'a>, Role<'a>)> {
    let movable: Vec<&str> = ordered.iter().filter(|j| j.kind != Kind::Fixed).map(|j| j.name).collect();
    let known: BTreeSet<&str> = movable.iter().copied().collect();
    for name in spec.lock.keys().filter(|name| !known.contains(name.as_str())) {
        let help = format!("name one of the movable joints {}", list(movable.iter().copied()));
        faults.push(
            format!("arm.lock.{name}"),
            format!("is not a movable joint of {}", file.display()),
            help,
        );
    }
    let all: BTreeMap<&str, &Joint<'_>> = ordered.iter().map(|joint| (joint.name, *joint)).collect();
    // Links that a moving joint carries.
    let mut carried: BTreeSet<&str> = BTreeSet::new();
    let mut out = Vec::new();
    for joint in ordered {
        let matters = chain.contains(joint.name) || carried.contains(joint.parent);
        let role = if matters { role(joint, &all, chain, spec, faults) } else { Some(Role::Idle) };
        let moves = matches!(role, Some(Role::Moves | Role::Follows(_)));
        if moves || carried.contains(joint.parent) {
            carried.insert(joint.child);
        }
        out.extend(role.map(|role| (*joint, role)));
    }
    let moving: Vec<&str> = out
        .iter()
        .filter(|(_, role)| matches!(role, Role::Moves | Role::Follows(_)))
        .map(|(j, _)| j.name)
        .collect();
    let known: BTreeSet<&str> = moving.iter().copied().collect();
    for name in spec.joints.keys().filter(|name| !known.contains(name.as_str())) {
        let help = format!("name one of {}", list(moving.iter().copied()));
        faults.push(format!("arm.joints.{name}"), "is not a joint of the arm", help);
    }
    out
}

/// The role of a joint that stands between base and tip or on a link that moves; `None` after a fault.
fn role<'a>(
    joint: &'a Joint<'a>,
    all: &BTreeMap<&str, &'a Joint<'a>>,
    chain: &BTreeSet<&str>,
    spec: &ArmSpec,
    faults: &mut Diagnostics,
) -> Option<Role<'a>> {
    let lock = spec.lock.get(joint.name).copied();
    match (joint.kind, joint.kind.moving(), lock) {
        (Kind::Fixed, ..) => Some(Role::Welded(0.0)),
        (_, None, Some(0.0)) => Some(Role::Welded(0.0)),
        (_, None, Some(position)) => {
            let problem = format!("is {}, and the joint is {}", scientific(position), joint.kind.name());
            let help = "write 0: such a joint is held where the file places it";
            faults.push(format!("arm.lock.{}", joint.name), problem, help);
            None
        }
        (_, None, None) => {
            let help = format!(
                "an arm takes revolute, continuous and prismatic joints; make it one of these or fixed, or write 0 \
                 as `arm.lock.{}` to hold it where it is",
                joint.name
            );
            joint.place.at("type").fault(faults, format!("is {}", joint.kind.name()), help);
            None
        }
        (_, Some(_), Some(position)) => Some(Role::Welded(position)),
        (_, Some(_), None) => match joint.element.one("mimic", &joint.place, faults) {
            Some(element) => mimic::role(joint, element, all, chain, spec, faults),
            None if chain.contains(joint.name) => Some(Role::Moves),
            None => {
                faults.push(
                    format!("arm.lock.{}", joint.name),
                    "is missing: this joint moves a branch off the chain to the tip",
                    "give the position (rad or m) at which it is held",
                );
                None
            }
        },
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    if names.is_empty() { "(there is none)".into() } else { listed(&names) }
}
