//! The arm: its table or URDF, inertias, drives, limits, payload.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The arm: either `dh` or `urdf`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArmSpec {
    /// Acceleration of gravity in the base frame, m/s². Default [0, 0, −9.81].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
    /// Denavit–Hartenberg table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dh: Option<DhSpec>,
    /// Path of a URDF file, relative to the specification.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub urdf: Option<String>,
    /// URDF only: the link at which the arm ends. Default: the only leaf.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<String>,
    /// URDF only: joints held at a position (rad or m), merged like fixed ones.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub lock: BTreeMap<String, f64>,
    /// URDF only: drive data and limits by joint name, over those of the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub joints: BTreeMap<String, DriveSpec>,
    /// Rotations of the description that are this near to a right angle, rad, are taken to be that right angle, as a
    /// whole; what that changes is part of every published bound. 0 to 0.1, default 1e-9; 0 for none beyond 2 ulp.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub round_angles: Option<f64>,
    /// A body carried at the tip, in the tip frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload: Option<PayloadSpec>,
}

/// A Denavit–Hartenberg table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DhSpec {
    /// Which of the two conventions the table follows.
    pub convention: Convention,
    /// One row a joint, base first; 1 to 8 rows.
    pub links: Vec<LinkSpec>,
}

/// Denavit–Hartenberg convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// Frame i at the far end of link i: T = Rz(θ) Tz(d) Tx(a) Rx(α).
    Standard,
    /// Craig's: frame i on joint i: T = Rx(α) Tx(a) Rz(θ) Tz(d), α and a of the link before.
    Modified,
}

/// Kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Turns about its axis; q in rad.
    Revolute,
    /// Slides along its axis; q in m.
    Prismatic,
}

impl JointKind {
    /// Unit of the joint's position.
    pub fn position_unit(self) -> &'static str {
        match self {
            Self::Revolute => "rad",
            Self::Prismatic => "m",
        }
    }

    /// Unit of the joint's torque or force.
    pub fn torque_unit(self) -> &'static str {
        match self {
            Self::Revolute => "N·m",
            Self::Prismatic => "N",
        }
    }
}

/// One row of a Denavit–Hartenberg table with the link's inertia and drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LinkSpec {
    /// Kind of the joint.
    pub joint: JointKind,
    /// Link twist α, rad.
    pub alpha: f64,
    /// Link length a, m.
    pub a: f64,
    /// Link offset d, m; for a prismatic joint the constant added to q.
    pub d: f64,
    /// Joint angle θ, rad; for a revolute joint the constant added to q.
    #[serde(default)]
    pub theta: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Mass times centre of mass, kg·m, link frame; goes with `pseudo_inertia`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[f64; 3]>,
    /// ∫xx dm … about the link frame's origin, kg·m²; goes with `first_moment`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pseudo_inertia: Option<SymmetricSpec>,
    /// Centre of mass, m, link frame; goes with `inertia`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com: Option<[f64; 3]>,
    /// Inertia tensor about the centre of mass, link frame's axes, kg·m²; goes with `com`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<SymmetricSpec>,
    /// Reflected rotor inertia, joint side, kg·m² (kg for a prismatic joint); excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub armature: Option<f64>,
    /// Viscous friction, joint side, N·m·s/rad; excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscous_friction: Option<f64>,
    /// Coulomb friction, joint side, N·m; excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coulomb_friction: Option<CoulombSpec>,
    /// The same quantities on the motor side of a gear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor: Option<MotorSpec>,
    /// Limits of the joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<LimitsSpec>,
}

/// Drive data of a URDF joint that the file cannot say, or says wrongly.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DriveSpec {
    /// Reflected rotor inertia, joint side, kg·m² (kg for a prismatic joint); excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub armature: Option<f64>,
    /// Viscous friction, joint side, N·m·s/rad; excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscous_friction: Option<f64>,
    /// Coulomb friction, joint side, N·m; excludes `motor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coulomb_friction: Option<CoulombSpec>,
    /// The same quantities on the motor side of a gear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor: Option<MotorSpec>,
    /// Limits; each one given replaces the file's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<LimitsSpec>,
}

/// A symmetric 3×3 matrix by its six entries; the products default to zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SymmetricSpec {
    /// Entry (1,1).
    pub xx: f64,
    /// Entry (2,2).
    pub yy: f64,
    /// Entry (3,3).
    pub zz: f64,
    /// Entry (1,2).
    #[serde(default)]
    pub xy: f64,
    /// Entry (1,3).
    #[serde(default)]
    pub xz: f64,
    /// Entry (2,3).
    #[serde(default)]
    pub yz: f64,
}

/// Motor-side quantities behind a gear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MotorSpec {
    /// Rotor inertia, kg·m²; reaches the joint times gear².
    pub inertia: f64,
    /// Gear ratio, motor turns per joint turn; its sign does not matter.
    pub gear_ratio: f64,
    /// Viscous friction, N·m·s/rad; reaches the joint times gear².
    #[serde(default)]
    pub viscous_friction: f64,
    /// Coulomb friction, N·m; reaches the joint times |gear|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coulomb_friction: Option<CoulombSpec>,
}

/// Coulomb friction: one number for both directions, or [positive, negative] with the second ≤ 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum CoulombSpec {
    /// The same torque against both directions.
    Symmetric(f64),
    /// Torque while moving forwards (≥ 0) and backwards (≤ 0).
    Directed([f64; 2]),
}

/// Limits of a joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LimitsSpec {
    /// [lowest, highest] position, rad or m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 2]>,
    /// Largest speed, rad/s or m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<f64>,
    /// Largest acceleration, rad/s² or m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// Largest torque (force), N·m or N; the controller saturates there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
}

/// A rigid body fixed to the tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PayloadSpec {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the tip frame, m. Default: the frame's origin.
    #[serde(default)]
    pub com: [f64; 3],
    /// Inertia about the centre of mass, tip frame's axes, kg·m². Default: a point mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<SymmetricSpec>,
}
