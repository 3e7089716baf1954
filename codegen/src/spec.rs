//! The specification file: one arm, one motion, one model, one controller, as JSON.
//!
//! Types and defaults only; [`crate::load`] reads and checks a file, the stages give the fields their meaning.
//! Units are SI throughout: m, kg, s, rad, N·m (N and m for prismatic joints).

mod arm;
mod control;
mod dense;
mod emit;
mod model;
mod motion;
mod uncertainty;

use serde::{Deserialize, Serialize};

pub use arm::{
    ArmSpec, Convention, CoulombSpec, DhSpec, DriveSpec, JointKind, LimitsSpec, LinkSpec, MotorSpec,
    PayloadSpec, SymmetricSpec,
};
pub use control::{
    ControlSpec, CoriolisTermSpec, DesignSpec, GuaranteeSpec, InitialErrorSpec, LawSpec, OnFaultSpec,
    RequireGuaranteeSpec, RobustGainSpec,
};
pub use emit::{EmitSpec, LawCodeSpec, ScalarSpec, TrigSpec};
pub use model::{DictionarySpec, MeasureSpec, ModelSpec, RefitSpec};
pub use motion::{MotionSpec, SinusoidSpec};
pub use uncertainty::{
    AdaptationSpec, LinkUncertaintySpec, ParametersSpec, PayloadUncertaintySpec, SymmetricIntervalsSpec,
    UncertaintySpec,
};

/// A whole specification file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// Where the schema of this file is, for editors.
    #[serde(rename = "$schema", default, skip_serializing)]
    pub schema: Option<String>,
    /// Name of the generated module and file: lower-case letters, digits and underscores. Default: from the name of the
    /// specification file.
    #[serde(default)]
    pub name: String,
    /// The arm.
    pub arm: ArmSpec,
    /// The desired motion; may be absent where the measure is `workspace`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSpec>,
    /// Where the reduction is judged. Default: a tube of 0.05 rad (or m) around the motion; the workspace where there is neither
    /// motion nor control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measure: Option<MeasureSpec>,
    /// Form of the model that is generated. Default: `auto`; `exact` where there is neither motion, measure nor control.
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

/// A number for every joint, or one for each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum MatrixSpec {
    /// A multiple of the identity.
    Scalar(f64),
    /// The diagonal.
    Diagonal(Vec<f64>),
    /// All rows.
    Full(Vec<Vec<f64>>),
}

/// How `simulate` runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SimulationSpec {
    /// Simulated time, s. Default: the motion's duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Runge–Kutta steps a control period. Default 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub substeps: Option<usize>,
}
