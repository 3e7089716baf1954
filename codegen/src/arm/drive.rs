//! What the drive adds to a joint: rotor inertia, friction, limits.

use super::Limits;
use super::place::Place;
use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::{CoulombSpec, DriveSpec, JointKind, LimitsSpec, LinkSpec};

/// Joint-side drive data; `None` where the specification is silent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Drive {
    /// Reflected rotor inertia, kg·m² or kg.
    pub armature: Option<f64>,
    /// Viscous friction, N·m·s/rad or N·s/m.
    pub viscous_friction: Option<f64>,
    /// Coulomb friction forwards and backwards, N·m or N.
    pub coulomb_friction: Option<[f64; 2]>,
    /// Limits.
    pub limits: Limits,
}

/// The drive data of one row of a DH table.
pub(super) fn of_link(link: &LinkSpec) -> DriveSpec {
    DriveSpec {
        armature: link.armature,
        viscous_friction: link.viscous_friction,
        coulomb_friction: link.coulomb_friction,
        motor: link.motor.clone(),
        limits: link.limits.clone(),
    }
}

/// Brings drive data to the joint side: inertia and viscous friction times gear², Coulomb friction times |gear|.
pub(super) fn drive(spec: &DriveSpec, kind: JointKind, place: &Place, faults: &mut Diagnostics) -> Drive {
    let mut out = Drive::default();
    if let Some(limits_spec) = &spec.limits {
        out.limits = limits(limits_spec, kind, &place.at("limits"), faults);
    }
    let Some(motor) = &spec.motor else {
        out.armature = spec.armature.and_then(|v| place.at("armature").not_negative(v, "kg·m²", faults));
        out.viscous_friction = spec
            .viscous_friction
            .and_then(|v| place.at("viscous_friction").not_negative(v, "N·m·s/rad", faults));
        out.coulomb_friction =
            spec.coulomb_friction.and_then(|c| coulomb(c, &place.at("coulomb_friction"), faults));
        return out;
    };
    let joint_side = [
        ("armature", spec.armature.is_some()),
        ("viscous_friction", spec.viscous_friction.is_some()),
        ("coulomb_friction", spec.coulomb_friction.is_some()),
    ];
    for (name, present) in joint_side {
        if present {
            place.at(name).fault(
                faults,
                "is given together with `motor`, which gives the same on the motor side",
                format!("remove `{name}` or `motor`"),
            );
        }
    }
    let place = place.at("motor");
    let gear = motor.gear_ratio;
    if gear == 0.0 || !gear.is_finite() {
        place.at("gear_ratio").fault(
            faults,
            format!("is {}", scientific(gear)),
            "write the motor turns per joint turn",
        );
        return out;
    }
    let reflected = |v: f64| v * gear * gear;
    out.armature = place.at("inertia").not_negative(motor.inertia, "kg·m²", faults).map(reflected);
    out.viscous_friction =
        place.at("viscous_friction").not_negative(motor.viscous_friction, "N·m·s/rad", faults).map(reflected);
    out.coulomb_friction = motor
        .coulomb_friction
        .and_then(|c| coulomb(c, &place.at("coulomb_friction"), faults))
        .map(|c| c.map(|v| v * gear.abs()));
    let reached = [out.armature, out.viscous_friction].into_iter().flatten();
    if !reached.chain(out.coulomb_friction.into_iter().flatten()).all(f64::is_finite) {
        place.fault(
            faults,
            "overflows when it is converted to the joint side",
            "write the values in SI units",
        );
    }
    out
}

/// Friction forwards (≥ 0) and backwards (≤ 0).
fn coulomb(spec: CoulombSpec, place: &Place, faults: &mut Diagnostics) -> Option<[f64; 2]> {
    match spec {
        CoulombSpec::Symmetric(v) => place.not_negative(v, "N·m", faults).map(|v| [v, 0.0 - v]),
        CoulombSpec::Directed(pair @ [forwards, backwards]) => {
            if forwards >= 0.0 && backwards <= 0.0 && pair.iter().all(|v| v.is_finite()) {
                return Some(pair);
            }
            place.fault(
                faults,
                format!("is {pair:?}"),
                "write [torque forwards, torque backwards] with the first ≥ 0 and the second ≤ 0",
            );
            None
        }
    }
}

/// Limits with their order and signs checked.
pub(super) fn limits(spec: &LimitsSpec, kind: JointKind, place: &Place, faults: &mut Diagnostics) -> Limits {
    let (length, force) = match kind {
        JointKind::Revolute => ("rad", "N·m"),
        JointKind::Prismatic => ("m", "N"),
    };
    let position = spec.position.filter(|pair @ [low, high]| {
        let ordered = low < high && pair.iter().all(|v| v.is_finite());
        if !ordered {
            let help = format!("write [lowest, highest] with the first below the second, in {length}");
            place.at("position").fault(faults, format!("is {pair:?}"), help);
        }
        ordered
    });
    let mut positive = |name: &str, value: Option<f64>, unit: &str| {
        value.and_then(|v| place.at(name).positive(v, unit, faults))
    };
    Limits {
        position,
        velocity: positive("velocity", spec.velocity, &format!("{length}/s")),
        acceleration: positive("acceleration", spec.acceleration, &format!("{length}/s²")),
        torque: positive("torque", spec.torque, force),
    }
}
