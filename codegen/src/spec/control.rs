//! The tracking law and its numbers.

use serde::{Deserialize, Serialize};

use super::{AdaptationSpec, MatrixSpec, UncertaintySpec, VectorSpec};

/// The tracking law and its numbers: those of the gains are given, or `design` asks for them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend(
    "if" = { "not": { "required": ["design"] } },
    "then" = { "required": ["period", "W", "Pqq", "Omega"] }
)))]
pub struct ControlSpec {
    /// Which law.
    pub law: LawSpec,
    /// Asks for period, gains and boundary layer instead of giving them: excludes `period`, `W`, `Pqq`, `Omega` and
    /// `boundary_layer`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<DesignSpec>,
    /// Control period, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// W of equation (16): symmetric positive definite, N·m·s/rad.
    #[serde(rename = "W", default, skip_serializing_if = "Option::is_none")]
    pub w: Option<MatrixSpec>,
    /// Pqq of equation (12): symmetric positive definite, N·m/rad.
    #[serde(rename = "Pqq", default, skip_serializing_if = "Option::is_none")]
    pub pqq: Option<MatrixSpec>,
    /// Ω of equation (16): symmetric positive definite; P12 = Pqq⁻¹Ω must be symmetric and element-wise nonnegative.
    #[serde(rename = "Omega", default, skip_serializing_if = "Option::is_none")]
    pub omega: Option<MatrixSpec>,
    /// φ of the boundary layer, unit of s (rad/s or m/s); absent: the sign function.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary_layer: Option<VectorSpec>,
    /// How law `report` outweighs the Coriolis torque of s: `matrix` (−ΔC1 s) or `switching` (−diag(sgn s) ΔC|s|).
    #[serde(default)]
    pub coriolis_term: CoriolisTermSpec,
    /// ΔC1 of equation (34), N·m·s/rad: symmetric, and verified to outweigh every |δC| ≤ ΔC. Default: k*·I.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delta_c1: Option<MatrixSpec>,
    /// What a robust law switches with. Default: `auto`.
    #[serde(default, skip_serializing_if = "RobustGainSpec::is_default")]
    pub robust_gain: RobustGainSpec,
    /// Largest initial error.
    #[serde(default)]
    pub initial_error: InitialErrorSpec,
    /// What is known of the arm only to intervals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<UncertaintySpec>,
    /// How law `adaptive` learns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<AdaptationSpec>,
    /// Take a period longer than the sampled loop admits; nothing is guaranteed then.
    #[serde(default)]
    pub allow_long_period: bool,
    /// Refuse a specification whose guarantee does not hold. `true` asks for `sampled` with a motion and for `continuous` without one.
    #[serde(default, skip_serializing_if = "RequireGuaranteeSpec::is_default")]
    pub require_guarantee: RequireGuaranteeSpec,
    /// Time from which errors count as settled, s. Default: eight time constants of the slowest error at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settle: Option<f64>,
    /// Add the Coulomb friction of the desired direction to the command.
    #[serde(default)]
    pub compensate_coulomb: bool,
    /// What the controller commands when a measurement is not finite.
    #[serde(default)]
    pub on_fault: OnFaultSpec,
}

/// What the gains are to achieve; diagonal W, Pqq, Ω and the layer φ are chosen so that the guarantee holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DesignSpec {
    /// Time in which position errors fall to 1/20 of the largest initial one, s.
    ///
    /// From rest, whatever their signs, under the exact model and outside the robust term: each joint by itself with the
    /// largest inertia that it can have in the domain, and all together with D(q) constant at its values on the motion.
    pub convergence_time: f64,
    /// What |q_e| must never leave, rad or m. Default: the tube of the measure, which it must not exceed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tube: Option<VectorSpec>,
    /// Control period, s. Default: the longest of 10, 5, 2, 1, 0.5, 0.2 and 0.1 ms for which there are gains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
}

/// Tracking laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LawSpec {
    /// Equation (16): no robust term.
    Exact,
    /// Equation (34).
    Report,
    /// Equation (34) with the model's error bounded at the state at hand in place of its bracket, without ΔC1.
    Tight,
    /// Equation (46): (34) with parameters that are learnt on the way, (49); for `shared` and `exact` models of the harmonic
    /// dictionary.
    Adaptive,
}

/// The variants of equation (34).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CoriolisTermSpec {
    /// −ΔC1 s.
    #[default]
    Matrix,
    /// −diag(sgn s) ΔC|s|.
    Switching,
}

/// What a robust law switches with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RobustGainSpec {
    /// The law's own bracket, at the state of the instant.
    State,
    /// One number by joint: what the model can be off by at most while the errors stay below their bounds.
    Constant,
    /// Of both the one whose step takes fewer operations among those whose guarantee holds, or of all where none holds.
    #[default]
    Auto,
}

impl RobustGainSpec {
    /// True for what an absent field means.
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Which guarantee must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum RequireGuaranteeSpec {
    /// Whether one must hold.
    Any(bool),
    /// This one.
    Named(GuaranteeSpec),
}

/// A kind of guarantee.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GuaranteeSpec {
    /// Of the loop that runs, from sample to sample along the motion.
    Sampled,
    /// Of the continuous law, by a level of V.
    Continuous,
}

impl Default for RequireGuaranteeSpec {
    fn default() -> Self {
        Self::Any(false)
    }
}

impl RequireGuaranteeSpec {
    /// True for what an absent field means.
    fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The guarantee that must hold, along a motion or without one; `None` where none must.
    pub fn wanted(self, motion: bool) -> Option<GuaranteeSpec> {
        match self {
            Self::Any(false) => None,
            Self::Any(true) if motion => Some(GuaranteeSpec::Sampled),
            Self::Any(true) => Some(GuaranteeSpec::Continuous),
            Self::Named(kind) => Some(kind),
        }
    }
}

/// What the controller commands when a measurement is not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum OnFaultSpec {
    /// The last command that was computed from a good measurement.
    #[default]
    Hold,
    /// No torque.
    Zero,
    /// The torque that holds the arm at the last good position.
    Gravity,
}

/// Largest initial error, per joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InitialErrorSpec {
    /// Position error, rad or m.
    #[serde(default)]
    pub position: VectorSpec,
    /// Velocity error, rad/s or m/s.
    #[serde(default)]
    pub velocity: VectorSpec,
}

impl Default for InitialErrorSpec {
    fn default() -> Self {
        Self { position: VectorSpec::Scalar(0.0), velocity: VectorSpec::Scalar(0.0) }
    }
}

impl LawSpec {
    /// Whether the law outweighs what its model leaves out.
    pub fn is_robust(self) -> bool {
        self != LawSpec::Exact
    }

    /// Whether ρ can be the law's own or a constant.
    pub fn has_choice(self) -> bool {
        matches!(self, Self::Report | Self::Tight)
    }

    /// Whether the law has the bracket of equation (34).
    pub fn has_bracket(self) -> bool {
        matches!(self, LawSpec::Report | LawSpec::Adaptive)
    }
}
