//! What is known of the arm only to intervals, and how a law learns it.

use serde::{Deserialize, Serialize};

use super::VectorSpec;

/// Parameters that are known only to intervals, each `[lowest, highest]` with the arm's own value between them.
///
/// Every interval given stands for one uncertain number, and they vary independently: at most 10 of inertia.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct UncertaintySpec {
    /// The body carried at the tip, in the tip frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload: Option<PayloadUncertaintySpec>,
    /// Links.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<LinkUncertaintySpec>,
    /// Viscous friction by joint, joint side, N·m·s/rad; `null` where it is known.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub viscous_friction: Vec<Option<[f64; 2]>>,
}

/// One link whose inertia is uncertain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LinkUncertaintySpec {
    /// Name of the joint that moves the link: `joint1`, `joint2`, … of a DH table, the file's names of a URDF.
    pub joint: String,
    /// Mass of the link and of everything that is fixed to it, the payload included, kg. What it differs by from the
    /// arm's own sits as a point at `at`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<[f64; 2]>,
    /// Where the uncertain mass sits, link frame, m. Default: the frame's origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// Mass times centre of mass, link frame, kg·m, at the arm's own mass; `null` for components that are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[Option<[f64; 2]>; 3]>,
    /// ∫xx dm … about the link frame's origin, kg·m², at the arm's own mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pseudo_inertia: Option<SymmetricIntervalsSpec>,
}

/// A payload whose inertia is uncertain; its parameters stand in the tip frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PayloadUncertaintySpec {
    /// Mass, kg, 0 without `arm.payload`. What it differs by from the arm's own sits as a point at `at`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<[f64; 2]>,
    /// Where the uncertain mass sits, m. Default: `arm.payload.com`, or the tip frame's origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// Mass times centre of mass, kg·m, at the arm's own mass; `null` for components that are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[Option<[f64; 2]>; 3]>,
    /// ∫xx dm … about the frame's origin, kg·m², at the arm's own mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pseudo_inertia: Option<SymmetricIntervalsSpec>,
}

/// Intervals of the entries of a symmetric 3×3 matrix; what is absent is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SymmetricIntervalsSpec {
    /// Entry (1,1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub xx: Option<[f64; 2]>,
    /// Entry (2,2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yy: Option<[f64; 2]>,
    /// Entry (3,3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zz: Option<[f64; 2]>,
    /// Entry (1,2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub xy: Option<[f64; 2]>,
    /// Entry (1,3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub xz: Option<[f64; 2]>,
    /// Entry (2,3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yz: Option<[f64; 2]>,
}

/// How law `adaptive` learns, equation (49).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AdaptationSpec {
    /// Which parameters are θ.
    #[serde(default)]
    pub parameters: ParametersSpec,
    /// Diagonal of Pθθ: one number, or one for each parameter. The larger, the slower.
    #[serde(rename = "Ptheta", default = "one")]
    pub p_theta: VectorSpec,
}

impl Default for AdaptationSpec {
    fn default() -> Self {
        Self { parameters: ParametersSpec::default(), p_theta: one() }
    }
}

/// The parameters θ of the adaptive law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ParametersSpec {
    /// The uncertain numbers of inertia: few, and physically consistent.
    #[default]
    Uncertain,
    /// Every parameter of the simplified model.
    All,
}

fn one() -> VectorSpec {
    VectorSpec::Scalar(1.0)
}
