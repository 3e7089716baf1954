//! `gramforge inspect`: what a specification amounts to.

mod text;
mod view;

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use self::text::text;
use self::view::view;
use super::progress::watched;
use super::{json, show_warnings};
use crate::bounds::Effort;
use crate::check::read;
use crate::error::Error;
use crate::graph::Operations;
use crate::pipeline::Generation;
use crate::progress::Stage;
use crate::spec::MatrixSpec;

/// Shows the expansion, the chosen functions, bounds, gains and operation counts of a specification.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  gramforge inspect ur5.jsonc\n  gramforge inspect ur5.jsonc --limits --json"
)]
pub(super) struct Inspect {
    /// The specification file.
    spec: PathBuf,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
    /// Seek the longest period and the largest initial error for which the guarantee of the sampled loop holds.
    #[arg(long)]
    limits: bool,
}

#[derive(Serialize)]
struct Inspection<'a> {
    name: &'a str,
    joints: usize,
    joint_names: Vec<&'a str>,
    functions: usize,
    /// Functions among which the reduction chooses.
    candidates: usize,
    coefficients: usize,
    terms: usize,
    selected: Vec<String>,
    /// Inertial parameters left out, where the model is the exact one of a simpler arm.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    simplified_arm: &'a [String],
    bounds: BoundsView<'a>,
    /// Certified bound on the torque error by joint, N·m or N, for rates up to the motion's own, over a workspace
    /// up to the joints' limits.
    torque_error: Option<Vec<f64>>,
    /// Largest torque by joint, N·m or N: along the motion, over a workspace the largest found within the joints' limits.
    peak_torque: Option<Vec<f64>>,
    /// The rates for which `torque_error` holds.
    torque_rates: Option<RatesView<'a>>,
    /// The same error at the rates that the law meets, its feedback included; `null` without a controller, or where nothing
    /// holds the errors.
    torque_error_of_law: Option<&'a [f64]>,
    /// These rates.
    law_rates: Option<RatesView<'a>>,
    domain: DomainView,
    form: &'static str,
    operations: Costs,
    /// Of a whole control step.
    step_operations: Option<StepCosts>,
    /// What a control step rounds by at most, by joint, N·m or N.
    step_rounding: Option<&'a [f64]>,
    /// Of the module, bytes.
    size: usize,
    verdict: String,
    /// The uncertain numbers of inertia, each with its range.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    uncertainty: Vec<RangeView<'a>>,
    /// What law `adaptive` learns.
    #[serde(skip_serializing_if = "Option::is_none")]
    adaptation: Option<AdaptationView<'a>>,
    control: Option<ControlView<'a>>,
    /// What is promised; `null` without a controller.
    guarantee: Option<PromiseView<'a>>,
    /// What a desired motion of the program's own must keep; `null` with a motion, without a controller, or where a limit is missing.
    reference: Option<ReferenceView<'a>>,
    /// What is promised of the continuous law; `null` without a controller.
    continuous: Option<GuaranteeView<'a>>,
    warnings: &'a [String],
}

#[derive(Serialize)]
#[allow(non_snake_case, reason = "the report's letters are the keys")]
struct BoundsView<'a> {
    kind: &'static str,
    D: &'a [Vec<f64>],
    H: &'a [Vec<Vec<f64>>],
    G: &'a [f64],
    B: Vec<Vec<f64>>,
    /// ΔC of equation (30); absent without a controller.
    C: Option<&'a [Vec<f64>]>,
    /// Largest bound/found over the simplified coefficients, negligible ones apart.
    worst_ratio: f64,
    /// Equation (11); absent over a workspace.
    estimate: Option<EstimateView>,
    /// The report's bounds for law `adaptive`, by a factor on those of the arm itself: not certified, and at times too
    /// small. `null` where a number is uncertain that the arm itself has at zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    factor: Option<EstimateView>,
}

/// Another account of the same quantities, not certified.
#[derive(Serialize)]
#[allow(non_snake_case, reason = "the report's letters are the keys")]
struct EstimateView {
    D: Vec<Vec<f64>>,
    H: Vec<Vec<Vec<f64>>>,
    G: Vec<f64>,
}

/// Largest rates by joint, rad/s or m/s and rad/s² or m/s².
#[derive(Serialize)]
struct RatesView<'a> {
    speed: &'a [f64],
    reference_speed: &'a [f64],
    reference_acceleration: &'a [f64],
}

#[derive(Serialize)]
struct DomainView {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    position_error: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<Vec<[f64; 2]>>,
}

#[derive(Serialize)]
struct Costs {
    reduced: Operations,
    exact: Operations,
}

#[derive(Serialize)]
struct StepCosts {
    reduced: Operations,
    /// The same law with the exact model; none for a law that learns.
    exact: Option<Operations>,
}

#[derive(Serialize)]
struct RangeView<'a> {
    name: &'a str,
    nominal: f64,
    low: f64,
    high: f64,
}

#[derive(Serialize)]
struct AdaptationView<'a> {
    /// Parameters θ with their boxes; uncertain numbers count from the arm's own.
    parameters: Vec<RangeView<'a>>,
    /// Diagonal of Pθθ⁻¹.
    rate: &'a [f64],
    /// Of base and Y together.
    operations: Operations,
}

#[derive(Serialize)]
#[allow(non_snake_case, reason = "the specification's letters are the keys")]
struct ControlView<'a> {
    /// The gains, given or found, as a specification takes them.
    W: MatrixSpec,
    Pqq: MatrixSpec,
    Omega: MatrixSpec,
    /// Absent for the sign function.
    boundary_layer: Option<&'a [f64]>,
    /// A constant switching gain by joint, N·m or N; absent for the law's own.
    robust_gain: Option<&'a [f64]>,
    period: f64,
    k_star: f64,
    v_max: f64,
    /// What V stays below, J.
    level: f64,
    position_error: &'a [f64],
    velocity_error: &'a [f64],
    speed: &'a [f64],
}

/// What is promised of the loop that runs; what is not known is `null`.
#[derive(Serialize)]
struct PromiseView<'a> {
    /// `sampled`, `continuous` or `none`.
    kind: &'static str,
    reasons: &'a [String],
    /// Bounds on |q − q_d| by joint: at any time, from `settle` on, at the end of the motion.
    reach: Option<Vec<f64>>,
    settle: Option<f64>,
    settled_error: Option<Vec<f64>>,
    end_error: Option<Vec<f64>>,
    /// Time until which that holds, s; `null` for ever.
    valid_until: Option<f64>,
    /// Range of the torque that the law asks for, by joint.
    torque_min: Option<Vec<f64>>,
    torque_max: Option<Vec<f64>>,
    /// With `--limits`: the longest period and the largest initial position errors for which `sampled` was found to hold.
    period_max: Option<f64>,
    initial_error_max: Option<Vec<f64>>,
}

#[derive(Serialize)]
struct ReferenceView<'a> {
    /// Lowest and highest desired position by joint, rad or m.
    position: &'a [[f64; 2]],
    /// Largest desired speed and acceleration by joint.
    velocity: &'a [f64],
    acceleration: &'a [f64],
    /// Whether the step reports a fault beyond these, and what that takes beside the operations of the step.
    checked: bool,
    comparisons: usize,
    absolute_values: usize,
}

#[derive(Serialize)]
struct GuaranteeView<'a> {
    holds: bool,
    reasons: &'a [String],
    /// By joint.
    initial_error_max: &'a [f64],
    period_max: f64,
    /// By joint.
    final_error: &'a [f64],
    tube_needed: Option<&'a [f64]>,
    inertia_min: f64,
    inertia_certified: bool,
}

impl Inspect {
    pub(super) fn run(&self) -> Result<String, Error> {
        let effort = Effort { seek_tube: true, ..Effort::default() };
        let loaded = read(&self.spec)?;
        let generation = watched(|progress| Generation::with_progress(loaded, &effort, progress))?;
        show_warnings(generation.warnings());
        let size = generation.module()?.len();
        let limits = match self.limits {
            true => watched(|progress| {
                let _stage = Stage::new(progress, "limits of the guarantee", 1);
                generation.limits()
            }),
            false => None,
        };
        let view = watched(|progress| {
            let _stage = Stage::new(progress, "comparison of bounds", 1);
            view(&generation, size, limits)
        });
        if self.json { json(&view) } else { Ok(text(&view, &generation)) }
    }
}
