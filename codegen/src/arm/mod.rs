//! The arm: validated joints and inertias in one normal form, whatever file they came from.

mod transform;

pub use crate::spec::JointKind;
pub use transform::Transform;

/// A serial arm of 1 to 8 joints.
///
/// Holds after construction: every number is finite, every joint moves about or along the z axis of
/// its own frame, masses are not negative, inertias are positive semidefinite, D(q) is positive
/// definite over the joint limits, fixed bodies and the payload are merged into the moving ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [f64; 3],
    /// The joints, base first.
    pub joints: Vec<Joint>,
    /// Pose of the tip frame in the last joint's moved frame.
    pub tip: Transform,
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

impl Arm {
    /// Number of joints n.
    pub fn dof(&self) -> usize {
        self.joints.len()
    }
}
