//! The specification file: one arm, one motion, one model, one controller, as JSON.
//!
//! Types and defaults only; [`crate::load`] reads and checks a file, the stages give the fields their meaning.
//! Units are SI throughout: m, kg, s, rad, N·m (N and m for prismatic joints).

mod control;
mod uncertainty;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use control::{ControlSpec, CoriolisTermSpec, DesignSpec, InitialErrorSpec, LawSpec, OnFaultSpec};
pub use uncertainty::{
    AdaptationSpec, LinkUncertaintySpec, ParametersSpec, PayloadUncertaintySpec, SymmetricIntervalsSpec,
    UncertaintySpec,
};

/// A whole specification file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// Name of the generated module and file: lower-case letters, digits and underscores.
    pub name: String,
    /// The arm.
    pub arm: ArmSpec,
    /// The desired motion; may be absent where the measure is `workspace`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSpec>,
    /// Where the reduction is judged. Default: a tube of 0.05 rad (or m) around the motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measure: Option<MeasureSpec>,
    /// Form of the model that is generated. Default: `auto`.
    #[serde(default)]
    pub model: ModelSpec,
    /// How the kept parameters are fitted.
    #[serde(default)]
    pub refit: RefitSpec,
    /// The candidate functions of `shared` and `separate`; `tolerance` has its own.
    #[serde(default)]
    pub dictionary: DictionarySpec,
    /// The tracking law; without it the module holds the model and its bounds alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub control: Option<ControlSpec>,
    /// What the generated code looks like.
    #[serde(default)]
    pub emit: EmitSpec,
    /// How `simulate` runs.
    #[serde(default)]
    pub simulation: SimulationSpec,
}

/// The arm: either `dh` or `urdf`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// A body carried at the tip, in the tip frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload: Option<PayloadSpec>,
}

/// A Denavit–Hartenberg table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DhSpec {
    /// Which of the two conventions the table follows.
    pub convention: Convention,
    /// One row a joint, base first; 1 to 8 rows.
    pub links: Vec<LinkSpec>,
}

/// Denavit–Hartenberg convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// Frame i at the far end of link i: T = Rz(θ) Tz(d) Tx(a) Rx(α).
    Standard,
    /// Craig's: frame i on joint i: T = Rx(α) Tx(a) Rz(θ) Tz(d), α and a of the link before.
    Modified,
}

/// Kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Turns about its axis; q in rad.
    Revolute,
    /// Slides along its axis; q in m.
    Prismatic,
}

/// One row of a Denavit–Hartenberg table with the link's inertia and drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CoulombSpec {
    /// The same torque against both directions.
    Symmetric(f64),
    /// Torque while moving forwards (≥ 0) and backwards (≤ 0).
    Directed([f64; 2]),
}

/// Limits of a joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// The desired motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum MotionSpec {
    /// Quintic polynomial, at rest at both ends.
    Quintic {
        /// Start, rad or m for each joint.
        from: Vec<f64>,
        /// End, rad or m for each joint.
        to: Vec<f64>,
        /// Duration, s.
        duration: f64,
    },
    /// C2 cubic spline through waypoints, at rest at both ends.
    Waypoints {
        /// Times of the waypoints, s, increasing, the first 0.
        times: Vec<f64>,
        /// One position vector a waypoint.
        positions: Vec<Vec<f64>>,
    },
    /// A sum of sinusoids for each joint: q_i = offset_i + Σ_k amplitude_ik sin(ω_ik t + phase_ik).
    Sinusoids {
        /// Offset of each joint, rad or m.
        offset: Vec<f64>,
        /// The sinusoids of each joint.
        terms: Vec<Vec<SinusoidSpec>>,
        /// Duration, s.
        duration: f64,
    },
    /// A table of times and positions, `t,q1,…,qn`, joined by a C2 spline.
    Csv {
        /// Path relative to the specification.
        file: String,
    },
}

/// One sinusoid of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SinusoidSpec {
    /// Amplitude, rad or m.
    pub amplitude: f64,
    /// Angular frequency ω, rad/s.
    pub frequency: f64,
    /// Phase at t = 0, rad.
    #[serde(default)]
    pub phase: f64,
}

/// Where the reduction is judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum MeasureSpec {
    /// Along the desired trajectory.
    Trajectory,
    /// Along the desired trajectory and over a box of position errors around it.
    Tube {
        /// Half-width ε of the box, rad or m.
        position_error: VectorSpec,
    },
    /// Over the joint limits; needs position, velocity and acceleration limits of every joint.
    Workspace,
}

/// Form of the generated model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ModelSpec {
    /// The cheapest model whose certified torque error stays below 1 % of each joint's peak torque.
    #[default]
    Auto,
    /// No reduction: zero bounds.
    Exact,
    /// The same ψ functions for all simplified coefficients.
    Shared {
        /// Number ξ of kept functions, 1 to p.
        functions: usize,
    },
    /// Every simplified coefficient has ψ functions of its own.
    Separate {
        /// Number ξ of functions that a coefficient keeps, 1 to p.
        functions: usize,
    },
    /// The model with the fewest operations whose certified torque error is small enough; the exact one if none is
    /// cheaper.
    Tolerance {
        /// Most torque error as a fraction of each joint's peak torque, above 0 and below 1: over a workspace of the
        /// largest torque within the joints' limits, around a motion of the largest along it.
        torque: f64,
    },
}

impl ModelSpec {
    /// The torque error that is allowed, as a fraction of each joint's peak torque.
    pub fn tolerance(&self) -> Option<f64> {
        match *self {
            ModelSpec::Auto => Some(0.01),
            ModelSpec::Tolerance { torque } => Some(torque),
            ModelSpec::Exact | ModelSpec::Shared { .. } | ModelSpec::Separate { .. } => None,
        }
    }
}

/// How the parameters of the kept functions are fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RefitSpec {
    /// Least largest residual, because the bounds (9) and (10) are maxima: the optimum of a linear programme over points of
    /// the domain and of its boundary, and never worse there than `least_squares`.
    #[default]
    Minimax,
    /// Least squares over the measure, equation (4).
    LeastSquares,
}

/// The candidate functions of the reduction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DictionarySpec {
    /// cos(κ·q) and sin(κ·q), times powers of prismatic coordinates.
    #[default]
    Harmonic,
    /// The report's: 1, the functions in which every joint occurs once at most, and products of two of these.
    Product,
    /// Both.
    Union,
}

/// A number for every joint, or one for each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum VectorSpec {
    /// The same for every joint.
    Scalar(f64),
    /// One for each joint.
    List(Vec<f64>),
}

impl Default for VectorSpec {
    fn default() -> Self {
        VectorSpec::Scalar(0.0)
    }
}

/// A multiple of the identity, a diagonal, or a full matrix by rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MatrixSpec {
    /// A multiple of the identity.
    Scalar(f64),
    /// The diagonal.
    Diagonal(Vec<f64>),
    /// All rows.
    Full(Vec<Vec<f64>>),
}

/// What the generated code looks like.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EmitSpec {
    /// Number type of the generated code.
    #[serde(default)]
    pub scalar: ScalarSpec,
    /// How sines and cosines are taken.
    #[serde(default, skip_serializing_if = "TrigSpec::is_default")]
    pub trig: TrigSpec,
}

/// How the generated code takes sines and cosines; the error counts in the bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TrigSpec {
    /// The crate `libm`.
    #[default]
    Libm,
    /// Polynomials, as good as rounding and faster.
    Polynomial,
    /// A table of one turn in the module, with second-order interpolation.
    Table {
        /// Largest error of a sine or cosine, 1e-10 to 0.1: the smallest table that keeps it is taken.
        error: f64,
    },
    /// The platform's, with the feature `std` of `gramforge-runtime`: not the same bits on every machine.
    Std,
}

impl TrigSpec {
    /// True for what an absent field means.
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Number type of the generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScalarSpec {
    /// IEEE double.
    #[default]
    F64,
}

/// How `simulate` runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulationSpec {
    /// Simulated time, s. Default: the motion's duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Runge–Kutta steps a control period. Default 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub substeps: Option<usize>,
}
