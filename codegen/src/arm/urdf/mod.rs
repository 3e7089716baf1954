//! Arms from URDF files: fixed and locked joints merged, joint frames turned so that z is the axis.
//!
//! Visual and collision elements are ignored. A link without `<inertial>` has no mass; an `<inertial>` without
//! `<origin>` sits at the link frame. Limits of zero width at zero, and zero or infinite speed and effort, count as
//! unknown: exporters write them for lack of better.

mod text;
mod tree;

use std::collections::BTreeMap;
use std::path::Path;

use urdf_rs::{Inertial, JointLimit, JointType, Robot};

use super::body::Matrix;
use super::drive::{Drive, drive, limits};
use super::place::Place;
use super::{Arm, Body, GRAVITY, Joint, JointKind, Limits, MOST_JOINTS, Transform, validate};
use crate::error::Faults;
use crate::load::{Named, plain};
use crate::spec::{ArmSpec, LimitsSpec};
use tree::{Role, Tree};

/// The arm of the URDF file `named` with the additions of `spec`, its rotations rounded by up to `angle` rad.
pub(super) fn build(
    spec: &ArmSpec,
    angle: f64,
    named: &Named,
    faults: &mut Faults,
    warnings: &mut Vec<String>,
) -> Option<Arm> {
    let before = faults.count();
    let file = named.path.as_path();
    let text = match named.text() {
        Ok(text) => text,
        Err(error) => {
            let problem = format!("names {}, which cannot be read ({error})", file.display());
            faults.push("arm.urdf", problem, "write the path of a URDF file, relative to the specification");
            return None;
        }
    };
    let text = text::prepare(text, file, faults);
    if faults.count() > before {
        return None;
    }
    let robot = match urdf_rs::read_from_string(&text) {
        Ok(robot) => robot,
        Err(error) => {
            let problem = format!("is not a URDF file that can be read ({error})");
            faults.push_in(file, "", problem, "mend it; `check_urdf` of ROS names the place");
            return None;
        }
    };
    plain_names(&robot, file, faults);
    if faults.count() > before {
        return None;
    }
    let tree = tree::tree(&robot, spec, file, faults)?;
    let bodies: BTreeMap<&str, Body> = robot
        .links
        .iter()
        .map(|link| {
            let place = Place::new(file, format!("link[{}].inertial", link.name));
            (link.name.as_str(), body(&link.inertial, angle, &place, faults, warnings))
        })
        .collect();
    let arm = assemble(&tree, &bodies, (spec, angle), file, faults, warnings)?;
    (faults.count() == before).then_some(arm)
}

/// Adds a fault for every name of a link or joint that holds hidden characters; references to them name no link then.
fn plain_names(robot: &Robot, file: &Path, faults: &mut Faults) {
    let links = robot.links.iter().map(|link| ("link", &link.name));
    let joints = robot.joints.iter().map(|joint| ("joint", &joint.name));
    for (kind, name) in links.chain(joints) {
        plain(name, file, &format!("{kind}[{name}].name"), faults);
    }
}

/// Where a link is: fixed in the moved frame of this joint (none: the base) at this pose.
type Seat = (Option<usize>, Transform);

/// Walks the tree from its root and gathers on each moving joint what it carries.
fn assemble(
    tree: &Tree<'_>,
    bodies: &BTreeMap<&str, Body>,
    (spec, angle): (&ArmSpec, f64),
    file: &Path,
    faults: &mut Faults,
    warnings: &mut Vec<String>,
) -> Option<Arm> {
    let mut seats: BTreeMap<&str, Seat> = BTreeMap::from([(tree.root, (None, Transform::IDENTITY))]);
    let mut joints: Vec<Joint> = Vec::new();
    for (joint, role) in &tree.joints {
        let place = Place::new(file, format!("joint[{}]", joint.name));
        let &(owner, at) = seats.get(joint.parent.link.as_str())?;
        let here = at.then(&pose(&joint.origin, angle, &place.at("origin"), faults)?).rounded(angle);
        let seat = match role {
            Role::Welded(position) if joint.joint_type == JointType::Fixed || *position == 0.0 => {
                (owner, here)
            }
            Role::Welded(position) => {
                let range = [joint.limit.lower, joint.limit.upper];
                if range[0] < range[1] && (*position < range[0] || range[1] < *position) {
                    let lock = Place::new(faults.file(), format!("arm.lock.{}", joint.name));
                    lock.warn(warnings, &format!("is {position}, beyond the limits {range:?} of the file"));
                }
                let turn = axis(joint, &place, faults)?.rounded(angle);
                let moved = match kind(&joint.joint_type) {
                    JointKind::Revolute => Transform::rotation(2, *position).rounded(angle),
                    JointKind::Prismatic => Transform::translation([0.0, 0.0, *position]),
                };
                (owner, here.then(&turn).then(&moved).then(&turn.inverse()).rounded(angle))
            }
            Role::Moves => {
                let turn = axis(joint, &place, faults)?.rounded(angle);
                let kind = kind(&joint.joint_type);
                let drive = merged(joint, kind, spec, &place, faults, warnings);
                joints.push(Joint {
                    name: joint.name.clone(),
                    kind,
                    pose: here.then(&turn).rounded(angle),
                    body: Body::default(),
                    link: turn.inverse(),
                    armature: drive.armature.unwrap_or(0.0),
                    viscous_friction: drive.viscous_friction.unwrap_or(0.0),
                    coulomb_friction: drive.coulomb_friction.unwrap_or([0.0; 2]),
                    limits: drive.limits,
                });
                (Some(joints.len() - 1), turn.inverse())
            }
        };
        let link = joint.child.link.as_str();
        seats.insert(link, seat);
        let carrier = seat.0.and_then(|index| joints.get_mut(index));
        if let (Some(carrier), Some(body)) = (carrier, bodies.get(link)) {
            carrier.body = carrier.body.plus(&body.moved(&seat.1));
        }
    }
    if joints.is_empty() || joints.len() > MOST_JOINTS {
        let problem =
            format!("leaves {} movable joints between {} and {}", joints.len(), tree.root, tree.tip);
        let mend = format!("choose `arm.tip` and `arm.lock` so that 1 to {MOST_JOINTS} remain");
        faults.push("arm.urdf", problem, mend);
        return None;
    }
    let (_, tip) = *seats.get(tree.tip)?;
    Some(Arm { gravity: GRAVITY, joints, tip })
}

fn kind(joint: &JointType) -> JointKind {
    if *joint == JointType::Prismatic { JointKind::Prismatic } else { JointKind::Revolute }
}

fn pose(origin: &urdf_rs::Pose, angle: f64, place: &Place, faults: &mut Faults) -> Option<Transform> {
    let all = origin.xyz.iter().chain(origin.rpy.iter());
    if !all.clone().all(|v| v.is_finite()) {
        place.fault(faults, "holds a number that is not finite", "write finite numbers");
        return None;
    }
    Some(Transform::translation(*origin.xyz).then(&Transform::roll_pitch_yaw(*origin.rpy)).rounded(angle))
}

/// The rotation from the joint's URDF frame to one whose z is the axis.
fn axis(joint: &urdf_rs::Joint, place: &Place, faults: &mut Faults) -> Option<Transform> {
    let xyz: [f64; 3] = *joint.axis.xyz;
    let largest = xyz.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if largest == 0.0 || !xyz.iter().all(|v| v.is_finite()) {
        let mend = "write a direction, such as 0 0 1";
        place.at("axis").fault(faults, format!("is {xyz:?}"), mend);
        return None;
    }
    // Scaled first: the squares of very small or large numbers leave the range of f64.
    let scaled = xyz.map(|v| v / largest);
    let norm = libm::sqrt(scaled.iter().map(|v| v * v).sum());
    Some(Transform::z_to(scaled.map(|v| v / norm)))
}

/// A link's body in the link frame.
fn body(
    inertial: &Inertial,
    angle: f64,
    place: &Place,
    faults: &mut Faults,
    warnings: &mut Vec<String>,
) -> Body {
    let Some(pose) = pose(&inertial.origin, angle, &place.at("origin"), faults) else {
        return Body::default();
    };
    let i = &inertial.inertia;
    let tensor: Matrix = [[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]];
    let body = Body::from_com(inertial.mass.value, [0.0; 3], tensor);
    validate::body(&body, "inertia", place, faults, warnings);
    let moved = body.moved(&pose);
    if body.is_finite() && !moved.is_finite() {
        place.fault(faults, "overflows", "write masses and lengths in SI units");
    }
    moved
}

/// The file's damping, friction and limits, under what the specification says of the joint.
fn merged(
    joint: &urdf_rs::Joint,
    kind: JointKind,
    spec: &ArmSpec,
    place: &Place,
    faults: &mut Faults,
    warnings: &mut Vec<String>,
) -> Drive {
    let given = spec.joints.get(&joint.name);
    let over = given.map_or_else(Drive::default, |given| {
        drive(given, kind, &Place::new(faults.file(), format!("arm.joints.{}", joint.name)), faults)
    });
    let (mut viscous, mut coulomb) = (0.0, 0.0);
    if let Some(dynamics) = &joint.dynamics {
        let place = place.at("dynamics");
        let unit = if kind == JointKind::Revolute { "N·m·s/rad" } else { "N·s/m" };
        viscous = place.at("damping").not_negative(dynamics.damping, unit, faults).unwrap_or(0.0);
        let unit = if kind == JointKind::Revolute { "N·m" } else { "N" };
        coulomb = place.at("friction").not_negative(dynamics.friction, unit, faults).unwrap_or(0.0);
    }
    let file = file_limits(&joint.limit, joint.joint_type == JointType::Continuous, kind, place, faults);
    let limits = Limits {
        position: over.limits.position.or(file.position),
        velocity: over.limits.velocity.or(file.velocity),
        acceleration: over.limits.acceleration.or(file.acceleration),
        torque: over.limits.torque.or(file.torque),
    };
    if limits.position.is_none() && joint.joint_type != JointType::Continuous {
        place.at("limit").warn(warnings, "gives no position limits; none are assumed");
    }
    Drive {
        armature: over.armature,
        viscous_friction: over.viscous_friction.or(Some(viscous)),
        coulomb_friction: over.coulomb_friction.or(Some([coulomb, 0.0 - coulomb])),
        limits,
    }
}

fn file_limits(
    limit: &JointLimit,
    endless: bool,
    kind: JointKind,
    place: &Place,
    faults: &mut Faults,
) -> Limits {
    let range = [limit.lower, limit.upper];
    // NaN is kept so that it is refused.
    let unlimited = endless || range == [0.0; 2] || range.iter().any(|v| v.is_infinite());
    let known = |v: f64| (v != 0.0 && v != f64::INFINITY).then_some(v);
    let given = LimitsSpec {
        position: (!unlimited).then_some(range),
        velocity: known(limit.velocity),
        acceleration: known(limit.acceleration),
        torque: known(limit.effort),
    };
    limits(&given, kind, &place.at("limit"), faults)
}
