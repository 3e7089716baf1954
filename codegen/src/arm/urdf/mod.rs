//! Arms from URDF files: fixed and locked joints merged, joint frames turned so that z is the axis.
//!
//! Visual and collision elements are ignored, and so is every element or attribute that is not URDF's. A link without
//! `<inertial>` has no mass; an `<inertial>` without `<origin>` sits at the link frame. Limits of zero width at zero, and
//! zero or infinite speed and effort, count as unknown: exporters write them for lack of better. What the specification
//! replaces is not judged, and neither is what no moving joint carries.

mod encoding;
mod joint;
mod mimic;
mod robot;
mod survey;
mod transmission;
mod tree;
mod xml;

pub use survey::{Survey, Tip, survey};

use std::collections::BTreeMap;
use std::path::Path;

use self::joint::{axis, body, lock, merged, pose};
use self::mimic::Follow;
use self::robot::{Link, Robot};
use self::tree::{Role, Tree};
use super::place::Place;
use super::{Arm, Body, GRAVITY, Joint, JointKind, MOST_JOINTS, Transform, linkage};
use crate::error::Diagnostics;
use crate::load::Named;
use crate::spec::ArmSpec;

/// The arm of the URDF file `named` with the additions of `spec`, its rotations rounded by up to `angle` rad.
pub(super) fn build(
    spec: &ArmSpec,
    angle: f64,
    named: &Named,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Option<Arm> {
    let before = faults.count();
    let file = named.path.as_path();
    let bytes = match &named.content {
        Ok(bytes) => bytes,
        Err(error) => {
            let problem = format!("names {}, which cannot be read ({error})", file.display());
            faults.push("arm.urdf", problem, "write the path of a URDF file, relative to the specification");
            return None;
        }
    };
    let text = match encoding::text(bytes) {
        Ok(text) => text,
        Err(encoding::Unreadable { line, problem, help }) => {
            faults.push_at(file, line, "", problem, help);
            return None;
        }
    };
    let root = xml::read(&text, file, faults)?;
    let robot = Robot::read(&root, file, faults)?;
    for element in root.all("loop_joint") {
        let name = element.attribute("name").map_or("", |name| &name.value);
        let place = Place::new(file, format!("loop_joint[{name}]")).on(element.line);
        place.warn(warnings, "closes a loop, which is ignored: the arm is the open tree without it");
    }
    let tree = tree::tree(&robot, spec, file, faults)?;
    let armatures = transmission::armatures(&root, &robot, file, warnings);
    let source = Source { spec, angle, robot: &robot, armatures: &armatures };
    let arm = source.assemble(&tree, faults, warnings)?;
    (faults.count() == before).then_some(arm)
}

/// Where a link is: fixed in the moved frame of this joint (none: the base) at this pose.
type Seat = (Option<usize>, Transform);

/// A joint that moves.
struct Moving<'a> {
    joint: Joint,
    /// How it follows another.
    follow: Option<Follow<'a>>,
    place: Place,
}

/// What an arm is assembled from.
struct Source<'a> {
    spec: &'a ArmSpec,
    /// Rotations are rounded by up to this, rad.
    angle: f64,
    robot: &'a Robot<'a>,
    /// Rotor inertias of the file, each with the warning that tells it.
    armatures: &'a BTreeMap<&'a str, (f64, String)>,
}

impl Source<'_> {
    /// Walks the tree from its root and gathers on each moving joint what it carries.
    fn assemble(&self, tree: &Tree<'_>, faults: &mut Diagnostics, warnings: &mut Vec<String>) -> Option<Arm> {
        let angle = self.angle;
        let mut seats: BTreeMap<&str, Seat> = BTreeMap::from([(tree.root, (None, Transform::IDENTITY))]);
        let mut joints: Vec<Moving<'_>> = Vec::new();
        for (joint, role) in &tree.joints {
            let place = &joint.place;
            // A link on an idle joint has no seat.
            let Some(&(owner, at)) = seats.get(joint.parent).filter(|_| *role != Role::Idle) else {
                continue;
            };
            let here = at.then(&pose(joint.element, angle, place, faults)?).rounded(angle);
            let seat = match role {
                Role::Idle => continue,
                Role::Welded(position) if *position == 0.0 => (owner, here),
                Role::Welded(position) => {
                    lock(joint, *position, faults.file(), warnings);
                    let turn = axis(joint.element, place, faults)?.rounded(angle);
                    let moved = match joint.kind.moving() {
                        Some(JointKind::Revolute) => Transform::rotation(2, *position).rounded(angle),
                        Some(JointKind::Prismatic) => Transform::translation([0.0, 0.0, *position]),
                        None => Transform::IDENTITY,
                    };
                    (owner, here.then(&turn).then(&moved).then(&turn.inverse()).rounded(angle))
                }
                Role::Moves | Role::Follows(_) => {
                    let turn = axis(joint.element, place, faults)?.rounded(angle);
                    let kind = joint.kind.moving()?;
                    let armature = self.armatures.get(joint.name);
                    let drive = merged(joint, kind, self.spec, armature, faults, warnings);
                    let follow = match role {
                        Role::Follows(follow) => Some(*follow),
                        _ => None,
                    };
                    let joint = Joint {
                        name: joint.name.to_string(),
                        kind,
                        pose: here.then(&turn).rounded(angle),
                        body: Body::default(),
                        link: turn.inverse(),
                        armature: drive.armature.unwrap_or(0.0),
                        viscous_friction: drive.viscous_friction.unwrap_or(0.0),
                        coulomb_friction: drive.coulomb_friction.unwrap_or([0.0; 2]),
                        limits: drive.limits,
                    };
                    joints.push(Moving { joint, follow, place: place.clone() });
                    (Some(joints.len() - 1), turn.inverse())
                }
            };
            seats.insert(joint.child, seat);
        }
        for link in &self.robot.links {
            let seat = seats.get(link.name).and_then(|(owner, at)| Some(((*owner)?, at)));
            match seat.and_then(|(owner, at)| Some((joints.get_mut(owner)?, at))) {
                Some((Moving { joint: carrier, .. }, at)) => {
                    carrier.body = carrier.body.plus(&body(link, angle, faults, warnings).moved(at));
                }
                None => idle(link, warnings),
            }
        }
        let moving = joints.iter().filter(|moving| moving.follow.is_none()).count();
        if moving == 0 || joints.len() > MOST_JOINTS {
            let problem =
                format!("leaves {} movable joints between {} and {}", joints.len(), tree.root, tree.tip);
            let help = format!("choose `arm.tip` and `arm.lock` so that 1 to {MOST_JOINTS} remain");
            faults.push("arm.urdf", problem, help);
            return None;
        }
        let (_, tip) = *seats.get(tree.tip)?;
        coupled(joints, tip, faults)
    }
}

/// Tells what is wrong with a link that no moving joint carries: it does not matter to the arm.
fn idle(link: &Link<'_>, warnings: &mut Vec<String>) {
    let mut faults = Diagnostics::of(Path::new(""));
    let mut odd = Vec::new();
    body(link, 0.0, &mut faults, &mut odd);
    for fault in faults.list() {
        let place = Place::new(&fault.file, fault.field.as_str());
        let place = fault.line.map_or(place.clone(), |line| place.on(line));
        place.warn(
            warnings,
            &format!("{}; no moving joint carries this link, so it is ignored", fault.problem),
        );
    }
}

/// The arm of `joints`, each with its place, of which some may follow others.
fn coupled(joints: Vec<Moving<'_>>, tip: Transform, faults: &mut Diagnostics) -> Option<Arm> {
    let places: Vec<Place> = joints.iter().map(|moving| moving.place.clone()).collect();
    let names: Vec<String> = joints.iter().map(|moving| moving.joint.name.clone()).collect();
    let follows = |follow: Follow<'_>| {
        let master = names.iter().position(|name| name == follow.master)?;
        Some((master, follow.multiplier, follow.offset))
    };
    let links = joints
        .into_iter()
        .map(|moving| linkage::Link { follows: moving.follow.and_then(follows), joint: moving.joint })
        .collect();
    match linkage::arm(links, GRAVITY, tip) {
        Ok(arm) => {
            let empty = |limits: Option<[f64; 2]>| limits.is_some_and(|[low, high]| low >= high);
            if let Some(joint) = arm.joints.iter().find(|joint| empty(joint.limits.position)) {
                let help =
                    format!("correct the limits, or write `arm.joints.{}.limits.position`", joint.name);
                let problem =
                    format!("leaves {} no room within the limits of the joints that follow it", joint.name);
                faults.push("arm.urdf", problem, help);
                return None;
            }
            Some(arm)
        }
        Err(linkage::Unsupported { joint, problem, help }) => {
            let place = places.get(joint).map(|place| place.at("mimic"));
            place.unwrap_or_else(|| Place::new(faults.file(), "arm.urdf")).fault(faults, problem, help);
            None
        }
    }
}
