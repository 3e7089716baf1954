//! Joints that follow another: q = multiplier · q_master + offset.

use std::collections::{BTreeMap, BTreeSet};

use super::robot::{Joint, Kind, number};
use super::tree::Role;
use super::xml::Element;
use crate::error::Diagnostics;
use crate::spec::ArmSpec;

/// Most joints in a line in which each follows the next.
const LONGEST_LINE: usize = 100;

/// How a joint follows one that moves by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Follow<'a> {
    /// The joint that it follows, which follows none.
    pub master: &'a str,
    /// Its rate over the master's, of the same kind.
    pub multiplier: f64,
    /// Its position where the master is at 0, rad or m.
    pub offset: f64,
}

/// The role of `joint`, whose `<mimic>` is `element`: it follows, or stands where a master stands that is held.
pub(super) fn role<'a>(
    joint: &'a Joint<'a>,
    element: &'a Element,
    all: &BTreeMap<&str, &'a Joint<'a>>,
    chain: &BTreeSet<&str>,
    spec: &ArmSpec,
    faults: &mut Diagnostics,
) -> Option<Role<'a>> {
    let (master, follow) = followed(joint, element, all, spec, faults)?;
    let held = match master.kind {
        Kind::Fixed => Some(0.0),
        _ => spec.lock.get(master.name).copied(),
    };
    if let Some(position) = held {
        return Some(Role::Welded(follow.multiplier * position + follow.offset));
    }
    if follow.multiplier == 0.0 {
        return Some(Role::Welded(follow.offset));
    }
    let place = joint.place.at("mimic").on(element.line);
    if !chain.contains(master.name) {
        let help = format!(
            "give the position of {} as `arm.lock.{}`, or that of {} as `arm.lock.{}`",
            master.name, master.name, joint.name, joint.name
        );
        place.fault(faults, format!("follows {:?}, which is off the chain to the tip", master.name), help);
        return None;
    }
    if !chain.contains(joint.name) {
        faults.push(
            format!("arm.lock.{}", joint.name),
            format!("is missing: this joint follows {} off the chain to the tip, and branches that move are not supported", master.name),
            "give the position (rad or m) at which it is held",
        );
        return None;
    }
    if master.kind.moving() != joint.kind.moving() {
        place.fault(
            faults,
            format!("lets a {} joint follow the {} joint {:?}", joint.kind.name(), master.kind.name(), master.name),
            "only joints of one kind, both turning or both sliding, may follow one another; hold one by `arm.lock`",
        );
        return None;
    }
    Some(Role::Follows(follow))
}

/// The joint at the end of the line of masters, and how `joint` follows it.
fn followed<'a>(
    joint: &'a Joint<'a>,
    element: &'a Element,
    all: &BTreeMap<&str, &'a Joint<'a>>,
    spec: &ArmSpec,
    faults: &mut Diagnostics,
) -> Option<(&'a Joint<'a>, Follow<'a>)> {
    let (mut own, mut element) = (joint, element);
    let (mut multiplier, mut offset) = (1.0, 0.0);
    // A line of masters that is longer than the robot has joints goes round in a circle.
    for _ in 0..=all.len().min(LONGEST_LINE) {
        let place = own.place.at("mimic").on(element.line);
        let mut given = |name: &str, otherwise: f64| match element.attribute(name) {
            None => Some(otherwise),
            Some(_) => number(element, name, &place, faults).and_then(|v| place.at(name).finite(v, faults)),
        };
        let (factor, shift) = (given("multiplier", 1.0), given("offset", 0.0));
        let Some(name) = element.attribute("joint") else {
            place.at("joint").fault(faults, "is missing", "name the joint that it follows");
            return None;
        };
        let Some(&master) = all.get(name.value.as_str()) else {
            let problem = format!("is {:?}, which is not a joint", name.value);
            let help = "name the joint that it follows, or hold this one by `arm.lock`";
            place.at("joint").on(name.line).fault(faults, problem, help);
            return None;
        };
        (multiplier, offset) = (multiplier * factor?, multiplier * shift? + offset);
        let next = (!spec.lock.contains_key(master.name))
            .then(|| master.element.one("mimic", &master.place, faults));
        match next.flatten() {
            Some(next) if master.kind != Kind::Fixed => (own, element) = (master, next),
            _ => return Some((master, Follow { master: master.name, multiplier, offset })),
        }
    }
    let place = joint.place.at("mimic");
    if all.len() > LONGEST_LINE {
        let problem = format!("follows itself, or another by way of more than {LONGEST_LINE} joints");
        place.fault(faults, problem, "let it follow a joint that moves by itself");
    } else {
        place.fault(faults, "follows itself, by way of other joints", "let one of them move by itself");
    }
    None
}
