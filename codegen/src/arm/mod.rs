//! The arm: validated joints and inertias in one normal form, whatever file they came from.

mod base_parameters;
mod body;
mod definite;
mod dh;
mod drive;
mod frames;
mod inertial;
mod intervals;
// URDF files alone have joints that follow others, and lines.
#[cfg_attr(not(feature = "urdf"), allow(dead_code))]
mod linkage;
mod massless;
#[cfg_attr(not(feature = "urdf"), allow(dead_code))]
mod place;
mod round;
mod transform;
mod uncertainty;
#[cfg(feature = "urdf")]
mod urdf;
#[cfg(not(feature = "urdf"))]
#[path = "urdf_absent.rs"]
mod urdf;
mod validate;

pub use crate::spec::JointKind;
pub(crate) use base_parameters::{Along, Kept, Mass, Offset};
pub use definite::{Indefinite, indefinite, indefinite_among};
pub(crate) use frames::Origin;
pub use inertial::{Inertial, Quantity};
pub use linkage::{Coupling, Linkage};
pub(crate) use round::{NOISE, distance};
pub use transform::Transform;
pub use uncertainty::{MOST_PARAMETERS, Parameter, Uncertainty};
#[cfg(feature = "urdf")]
pub use urdf::{Survey, Tip, survey};

use crate::error::Diagnostics;
use crate::load::Loaded;
use crate::number::scientific;
use crate::spec::ArmSpec;
use crate::text::listed;
use place::Place;

/// A serial arm of 1 to 8 joints.
///
/// Holds after construction: every number is finite, every joint moves about or along the z axis of
/// its own frame, masses are not negative, inertias are positive semidefinite, fixed bodies and the
/// payload are merged into the moving ones. That D(q) is positive definite over the joint limits
/// takes the dynamics to see: [`indefinite`].
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [f64; 3],
    /// The joints, base first: those that have a coordinate of their own. Where others follow them, all bodies stand in
    /// [`Arm::linkage`].
    pub joints: Vec<Joint>,
    /// Pose of the tip frame in the last joint's moved frame.
    pub tip: Transform,
    /// The whole chain, where some of its joints follow others.
    pub linkage: Option<Box<Linkage>>,
}

/// One joint with the body it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name, `joint1`… for DH tables, the file's for URDF.
    pub name: String,
    /// Turns about, or slides along, the z axis of its frame.
    pub kind: JointKind,
    /// Pose of the joint frame at q = 0 in the moved frame of the joint before (the base for the first).
    pub pose: Transform,
    /// Everything that moves with this joint, in its moved frame.
    pub body: Body,
    /// Pose of the link frame of the file (DH frame, URDF child link) in the moved frame.
    pub link: Transform,
    /// Reflected rotor inertia, joint side, kg·m² (kg for a prismatic joint).
    pub armature: f64,
    /// Viscous friction B_ii, N·m·s/rad (N·s/m).
    pub viscous_friction: f64,
    /// Coulomb friction while moving forwards (≥ 0) and backwards (≤ 0), N·m or N.
    pub coulomb_friction: [f64; 2],
    /// Limits.
    pub limits: Limits,
}

/// Inertial parameters of a rigid body about the origin of its joint frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Mass times centre of mass, kg·m.
    pub first_moment: [f64; 3],
    /// Pseudo-inertia Σ = ∫ x xᵀ dm about the frame's origin, kg·m²; the inertia tensor is tr(Σ)·1 − Σ.
    pub pseudo_inertia: [[f64; 3]; 3],
}

/// Limits of a joint; `None` where unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// [lowest, highest] position, rad or m.
    pub position: Option<[f64; 2]>,
    /// Largest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// Largest acceleration, rad/s² or m/s².
    pub acceleration: Option<f64>,
    /// Largest torque or force, N·m or N.
    pub torque: Option<f64>,
}

/// An arm, and what is odd about its description without being wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The arm.
    pub arm: Arm,
    /// All arms that its controller must bear.
    pub uncertainty: Uncertainty,
    /// The arm with no rotation rounded: what the specification says.
    pub given: Arm,
    /// The family of that arm.
    pub uncertain: Uncertainty,
    /// One sentence each, naming file, field and value.
    pub warnings: Vec<String>,
}

/// `arm.round_angles` where the specification is silent, rad: 1.57079632679 means a right angle.
pub const ROUND_ANGLES: f64 = 1e-9;

/// The largest `arm.round_angles`, rad.
const MOST_ROUNDED: f64 = 0.1;

/// Largest number of joints.
pub const MOST_JOINTS: usize = 8;

impl Arm {
    /// Builds the arm of a specification from its DH table or its URDF file.
    ///
    /// Everything that is wrong goes to `faults`; `None` where something is.
    pub fn from_spec(loaded: &Loaded, faults: &mut Diagnostics) -> Option<Built> {
        let mut warnings = Vec::new();
        let angle = loaded.spec.arm.round_angles.unwrap_or(ROUND_ANGLES);
        if !(0.0..=MOST_ROUNDED).contains(&angle) {
            faults.push(
                "arm.round_angles",
                format!("is {}", scientific(angle)),
                "write an angle from 0 to 0.1 rad",
            );
        }
        let (arm, uncertainty) = Self::described(loaded, angle, faults, &mut warnings)?;
        let still = massless::massless(&arm);
        if !still.is_empty() {
            warnings.push(format!(
                "{}: arm: joints that move no mass: {}; their torque is zero. Give mass and inertia to the links that they \
                 carry (<inertial> in a URDF file), or `armature` to the joints",
                loaded.path.display(),
                listed(&still)
            ));
        }
        let (given, uncertain) = match angle {
            0.0 => (arm.clone(), uncertainty.clone()),
            _ => Self::rounded_to(loaded, 0.0)?,
        };
        Some(Built { arm, uncertainty, given, uncertain, warnings })
    }

    /// The arm and the family of a specification that [`Arm::from_spec`] has accepted, with rotations up to `angle` rad off a
    /// right angle taken to be that right angle.
    pub fn rounded_to(loaded: &Loaded, angle: f64) -> Option<(Self, Uncertainty)> {
        Self::described(loaded, angle, &mut Diagnostics::of(&loaded.path), &mut Vec::new())
    }

    fn described(
        loaded: &Loaded,
        angle: f64,
        faults: &mut Diagnostics,
        warnings: &mut Vec<String>,
    ) -> Option<(Self, Uncertainty)> {
        let before = faults.count();
        let spec = &loaded.spec.arm;
        let arm = match (&spec.dh, &spec.urdf) {
            (Some(table), None) => {
                refuse_urdf_fields(spec, faults);
                dh::build(table, angle, &loaded.path, faults, warnings)
            }
            (None, Some(file)) => urdf::build(spec, angle, &loaded.named("arm.urdf", file), faults, warnings),
            (Some(_), Some(_)) => {
                faults.push("arm", "has both `dh` and `urdf`", "keep the one that describes the arm");
                None
            }
            (None, None) => {
                faults.push(
                    "arm",
                    "has neither `dh` nor `urdf`",
                    "add a DH table or the path of a URDF file",
                );
                None
            }
        };
        let payload = spec.payload.as_ref().map(|payload| {
            let place = Place::new(&loaded.path, "arm.payload");
            validate::payload(payload, &place, faults, warnings)
        });
        let mut arm = arm?;
        if let Some(gravity) = spec.gravity {
            arm.gravity = gravity;
        }
        if let Some(linkage) = &mut arm.linkage {
            linkage.chain.gravity = arm.gravity;
        }
        let tip = arm.tip;
        if let (Some(payload), Some(last)) = (payload, arm.last_moving()) {
            last.body = last.body.plus(&payload.moved(&tip));
        }
        let sane = |t: &Transform| t.translation.iter().all(|v| v.is_finite());
        if !arm.moving().iter().all(|j| j.body.is_finite() && sane(&j.pose)) || !sane(&arm.tip) {
            faults.push("arm", "has lengths and masses whose products overflow", "write them in SI units");
        }
        if faults.count() > before {
            return None;
        }
        let ranges = loaded.spec.control.as_ref().and_then(|control| control.uncertainty.as_ref());
        let uncertainty = ranges
            .map(|ranges| Uncertainty::new(ranges, &arm, spec, &loaded.path, faults))
            .unwrap_or_default();
        (faults.count() == before).then_some((arm, uncertainty))
    }

    /// Number of joints n.
    pub fn dof(&self) -> usize {
        self.joints.len()
    }

    /// The joint box: position limits by joint, a period for an unlimited revolute joint (a full turn, but for joints that
    /// others follow at part of their rate), ±1 m for a prismatic one.
    pub fn joint_box(&self) -> Vec<[f64; 2]> {
        let unlimited = |(j, joint): (usize, &Joint)| match joint.kind {
            JointKind::Revolute => [-0.5 * self.period(j), 0.5 * self.period(j)],
            JointKind::Prismatic => [-1.0, 1.0],
        };
        let side = |(j, joint): (usize, &Joint)| joint.limits.position.unwrap_or(unlimited((j, joint)));
        self.joints.iter().enumerate().map(side).collect()
    }
}

/// Acceleration of gravity where the specification is silent, m/s².
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

fn refuse_urdf_fields(spec: &ArmSpec, faults: &mut Diagnostics) {
    let given =
        [("tip", spec.tip.is_some()), ("lock", !spec.lock.is_empty()), ("joints", !spec.joints.is_empty())];
    for (name, present) in given {
        if present {
            faults.push(
                format!("arm.{name}"),
                "applies only to `urdf`, but the arm is a DH table",
                "remove it; in a DH table the links hold these values",
            );
        }
    }
}

#[cfg(test)]
mod tests;
