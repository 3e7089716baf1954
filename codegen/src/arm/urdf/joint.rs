//! What a joint and its link say in numbers: pose, axis, inertia, limits.

use std::path::Path;

use super::super::body::Matrix;
use super::super::drive::{Drive, drive, limits};
use super::super::place::Place;
use super::super::{Body, JointKind, Limits, Transform, validate};
use super::robot::{Joint, Kind, Link, number, required, triple};
use super::xml::Element;
use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::{ArmSpec, DriveSpec, LimitsSpec};

/// The pose that `<origin>` inside `element` gives, rounded by up to `angle` rad; the identity without one. `place` is the
/// element's.
pub(super) fn pose(
    element: &Element,
    angle: f64,
    place: &Place,
    faults: &mut Diagnostics,
) -> Option<Transform> {
    let Some(origin) = element.one("origin", place, faults) else { return Some(Transform::IDENTITY) };
    let place = place.at("origin").on(origin.line);
    if let Some(quaternion) = origin.attribute("quat_xyzw") {
        let place = place.at("quat_xyzw").on(quaternion.line);
        place.fault(faults, "is a quaternion, which is not supported", "write the rotation as `rpy`");
        return None;
    }
    let (xyz, rpy) =
        (triple(origin, "xyz", [0.0; 3], &place, faults), triple(origin, "rpy", [0.0; 3], &place, faults));
    let (xyz, rpy) = (xyz?, rpy?);
    if !xyz.iter().chain(&rpy).all(|v| v.is_finite()) {
        place.fault(faults, "holds a number that is not finite", "write finite numbers");
        return None;
    }
    Some(Transform::translation(xyz).then(&Transform::roll_pitch_yaw(rpy)).rounded(angle))
}

/// The rotation from the joint's URDF frame to one whose z is the axis.
pub(super) fn axis(element: &Element, place: &Place, faults: &mut Diagnostics) -> Option<Transform> {
    let otherwise = [1.0, 0.0, 0.0];
    let (xyz, place) = match element.one("axis", place, faults) {
        None => (otherwise, place.at("axis")),
        Some(axis) => {
            let place = place.at("axis").on(axis.line);
            (triple(axis, "xyz", otherwise, &place, faults)?, place)
        }
    };
    let largest = xyz.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if largest == 0.0 || !xyz.iter().all(|v| v.is_finite()) {
        let help = "write a direction, such as 0 0 1";
        place.fault(faults, format!("is {xyz:?}"), help);
        return None;
    }
    // Scaled first: the squares of very small or large numbers leave the range of f64.
    let scaled = xyz.map(|v| v / largest);
    let norm = libm::sqrt(scaled.iter().map(|v| v * v).sum());
    Some(Transform::z_to(scaled.map(|v| v / norm)))
}

/// A link's body in the link frame.
pub(super) fn body(
    link: &Link<'_>,
    angle: f64,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Body {
    inertia(link, angle, faults, warnings).unwrap_or_default()
}

fn inertia(
    link: &Link<'_>,
    angle: f64,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Option<Body> {
    let inertial = link.element.one("inertial", &link.place, faults)?;
    let place = link.place.at("inertial").on(inertial.line);
    let pose = pose(inertial, angle, &place, faults);
    let mut inside = |name: &str| {
        let element = inertial.one(name, &place, faults);
        if element.is_none() {
            place.at(name).fault(faults, "is missing", format!("write <{name} …/>, or remove <inertial>"));
        }
        element.map(|element| (element, link.place.at(name).on(element.line)))
    };
    let (mass, tensor) = (inside("mass"), inside("inertia"));
    let written = tensor.as_ref().map_or(place.clone(), |(element, _)| place.on(element.line)).at("inertia");
    let mass = mass.and_then(|(element, place)| required(element, "value", &place, faults));
    let tensor = tensor.map(|(element, place)| {
        ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].map(|name| required(element, name, &place, faults))
    });
    let [ixx, iyy, izz, ixy, ixz, iyz] = tensor?;
    let (ixx, iyy, izz, ixy, ixz, iyz) = (ixx?, iyy?, izz?, ixy?, ixz?, iyz?);
    let tensor: Matrix = [[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]];
    let body = Body::from_com(mass?, [0.0; 3], tensor);
    validate::body(&body, &written, &place, faults, warnings);
    let moved = body.moved(&pose?);
    if body.is_finite() && !moved.is_finite() {
        place.fault(faults, "overflows", "write masses and lengths in SI units");
    }
    Some(moved)
}

/// Warns where a joint is held at a position beyond its limits; `file` is the specification.
pub(super) fn lock(joint: &Joint<'_>, position: f64, file: &Path, warnings: &mut Vec<String>) {
    let mut unheard = Diagnostics::of(file);
    let Some(limit) = joint.element.all("limit").next() else { return };
    let mut end = |name: &str| number(limit, name, &joint.place, &mut unheard).unwrap_or(0.0);
    let range = [end("lower"), end("upper")];
    if range[0] < range[1] && (position < range[0] || range[1] < position) {
        let lock = Place::new(file, format!("arm.lock.{}", joint.name));
        lock.warn(warnings, &format!("is {}, beyond the limits {range:?} of the file", scientific(position)));
    }
}

/// What the specification says of a joint in place of the file.
#[derive(Clone, Copy, Debug, Default)]
struct Replaced {
    armature: bool,
    viscous: bool,
    coulomb: bool,
    position: bool,
    velocity: bool,
    acceleration: bool,
    torque: bool,
}

impl Replaced {
    fn by(given: &DriveSpec) -> Self {
        let limit = |has: fn(&LimitsSpec) -> bool| given.limits.as_ref().is_some_and(has);
        let motor = given.motor.as_ref();
        Self {
            armature: given.armature.is_some() || motor.is_some(),
            viscous: given.viscous_friction.is_some() || motor.is_some(),
            coulomb: given.coulomb_friction.is_some() || motor.is_some_and(|m| m.coulomb_friction.is_some()),
            position: limit(|limits| limits.position.is_some()),
            velocity: limit(|limits| limits.velocity.is_some()),
            acceleration: limit(|limits| limits.acceleration.is_some()),
            torque: limit(|limits| limits.torque.is_some()),
        }
    }
}

/// The file's damping, friction and limits, and the rotor inertia of its transmission, under what the specification
/// says of the joint. What the specification replaces is not read.
pub(super) fn merged(
    joint: &Joint<'_>,
    kind: JointKind,
    spec: &ArmSpec,
    armature: Option<&(f64, String)>,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Drive {
    let place = &joint.place;
    let given = spec.joints.get(joint.name);
    let over = given.map_or_else(Drive::default, |given| {
        drive(given, kind, &Place::new(faults.file(), format!("arm.joints.{}", joint.name)), faults)
    });
    let own = given.map_or_else(Replaced::default, Replaced::by);
    let (mut viscous, mut coulomb) = (0.0, 0.0);
    if let Some(dynamics) = joint.element.one("dynamics", place, faults) {
        let place = place.at("dynamics").on(dynamics.line);
        let mut read = |name: &str, unit: &str| {
            let value = number(dynamics, name, &place, faults)?;
            place.at(name).not_negative(value, unit, faults)
        };
        let (damping, friction) = match kind {
            JointKind::Revolute => ("N·m·s/rad", "N·m"),
            JointKind::Prismatic => ("N·s/m", "N"),
        };
        if !own.viscous {
            viscous = read("damping", damping).unwrap_or(0.0);
        }
        if !own.coulomb {
            coulomb = read("friction", friction).unwrap_or(0.0);
        }
    }
    let file = file_limits(joint, kind, &own, faults);
    let limits = Limits {
        position: over.limits.position.or(file.position),
        velocity: over.limits.velocity.or(file.velocity),
        acceleration: over.limits.acceleration.or(file.acceleration),
        torque: over.limits.torque.or(file.torque),
    };
    if limits.position.is_none() && joint.kind != Kind::Continuous && !own.position {
        place.at("limit").warn(warnings, "gives no position limits; none are assumed");
    }
    let mut rotor = over.armature;
    if let (false, Some((inertia, told))) = (own.armature, armature) {
        rotor = Some(*inertia);
        warnings.push(told.clone());
    }
    Drive {
        armature: rotor,
        viscous_friction: over.viscous_friction.or(Some(viscous)),
        coulomb_friction: over.coulomb_friction.or(Some([coulomb, 0.0 - coulomb])),
        limits,
    }
}

/// The limits of the file that nothing replaces.
fn file_limits(joint: &Joint<'_>, kind: JointKind, replaced: &Replaced, faults: &mut Diagnostics) -> Limits {
    let Some(limit) = joint.element.one("limit", &joint.place, faults) else { return Limits::default() };
    let place = joint.place.at("limit").on(limit.line);
    let mut read = |name: &str, replaced: bool| match replaced {
        true => None,
        false => number(limit, name, &place, faults),
    };
    let endless = joint.kind == Kind::Continuous || replaced.position;
    let range = [read("lower", endless).unwrap_or(0.0), read("upper", endless).unwrap_or(0.0)];
    // NaN is kept so that it is refused.
    let unlimited = endless || range == [0.0; 2] || range.iter().any(|v| v.is_infinite());
    let known = |v: &f64| *v != 0.0 && *v != f64::INFINITY;
    let given = LimitsSpec {
        position: (!unlimited).then_some(range),
        velocity: read("velocity", replaced.velocity).filter(known),
        acceleration: read("acceleration", replaced.acceleration).filter(known),
        torque: read("effort", replaced.torque).filter(known),
    };
    limits(&given, kind, &place, faults)
}
