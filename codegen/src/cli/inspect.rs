//! `gramforge inspect`: what a specification amounts to.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{json, show_warnings};
use crate::bounds::{Bounds, Effort, estimate, factor_bounds};
use crate::design::Envelope;
use crate::emit::{domain_in_words, functions, torque_in_words, verdict};
use crate::error::Error;
use crate::graph::Operations;
use crate::load::load;
use crate::measure::Domain;
use crate::pipeline::{Generation, dictionary};
use crate::spec::{MatrixSpec, ModelSpec};

/// Shows the expansion, the chosen functions, bounds, gains and operation counts of a specification.
#[derive(Debug, Args)]
pub(super) struct Inspect {
    /// The specification file.
    spec: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
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
    bounds: BoundsView<'a>,
    /// Certified bound on the torque error by joint, N·m or N, for rates up to the motion's own, over a workspace
    /// up to the joints' limits.
    torque_error: Option<Vec<f64>>,
    /// Largest torque by joint, N·m or N: along the motion, over a workspace the largest found within the joints' limits.
    peak_torque: Option<Vec<f64>>,
    domain: DomainView,
    form: &'static str,
    operations: Costs,
    verdict: String,
    /// The uncertain numbers of inertia, each with its range.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    uncertainty: Vec<RangeView<'a>>,
    /// What law `adaptive` learns.
    #[serde(skip_serializing_if = "Option::is_none")]
    adaptation: Option<AdaptationView<'a>>,
    control: Option<ControlView<'a>>,
    #[serde(flatten)]
    guarantee: Option<GuaranteeView<'a>>,
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
    /// Largest bound/found over the simplified coefficients.
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
    period: f64,
    k_star: f64,
    v_max: f64,
    /// What V stays below, J.
    level: f64,
    position_error: &'a [f64],
    velocity_error: &'a [f64],
    speed: &'a [f64],
}

#[derive(Serialize)]
struct GuaranteeView<'a> {
    guaranteed: bool,
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
        let generation = Generation::with_effort(load(&self.spec)?, &effort)?;
        show_warnings(&generation.warnings);
        let view = view(&generation);
        if self.json { json(&view) } else { Ok(text(&view, &generation)) }
    }
}

fn view(generation: &Generation) -> Inspection<'_> {
    let Generation { arm, lagrangian, reduced, bounds, code, exact_code, design, .. } = generation;
    let operations = Costs { reduced: code.operations(), exact: exact_code.operations() };
    let control = design.as_ref().map(|design| {
        let Envelope { v_max, level, position_error, velocity_error, speed } = &design.envelope;
        ControlView {
            W: as_written(&design.w),
            Pqq: as_written(&design.gains.pqq),
            Omega: as_written(&design.omega),
            boundary_layer: design.boundary_layer.as_deref(),
            period: design.period,
            k_star: design.k_star,
            v_max: *v_max,
            level: *level,
            position_error,
            velocity_error,
            speed,
        }
    });
    let guarantee = design.as_ref().map(|design| {
        let promised = &design.guarantee;
        GuaranteeView {
            guaranteed: promised.holds,
            reasons: &promised.reasons,
            initial_error_max: &promised.initial_error_max,
            period_max: promised.period_max,
            final_error: &promised.final_error,
            tube_needed: promised.tube_needed.as_deref(),
            inertia_min: promised.inertia.least,
            inertia_certified: promised.inertia.certified,
        }
    });
    let uncertainty = generation.uncertainty.parameters.iter().map(|p| RangeView {
        name: &p.name,
        nominal: p.nominal,
        low: p.nominal + p.low,
        high: p.nominal + p.high,
    });
    Inspection {
        uncertainty: uncertainty.collect(),
        adaptation: adaptation(generation),
        name: &generation.loaded.spec.name,
        joints: arm.dof(),
        joint_names: arm.joints.iter().map(|joint| joint.name.as_str()).collect(),
        functions: lagrangian.functions.len(),
        candidates: dictionary(&generation.loaded.spec).functions(lagrangian).len(),
        coefficients: lagrangian.coefficients.len(),
        terms: lagrangian.terms(),
        selected: functions(lagrangian, reduced),
        bounds: BoundsView {
            kind: "certified",
            D: &bounds.d,
            H: &bounds.h,
            G: &bounds.g,
            B: diagonal(&bounds.b),
            C: design.as_ref().map(|design| design.delta_c.as_slice()),
            worst_ratio: generation.certificates.iter().map(|c| c.ratio()).fold(1.0, f64::max),
            estimate: estimated(generation),
            factor: by_factor(generation),
        },
        torque_error: generation.torque.as_ref().map(|torque| torque.error.clone()),
        peak_torque: generation.torque.as_ref().map(|torque| torque.peak.clone()),
        domain: domain_view(&generation.domain),
        form: generation.form.name(),
        verdict: if reduced.is_exact() {
            exact_in_words(&generation.loaded.spec.model).to_string()
        } else if !reduced.simplified.contains(&true) {
            "no coefficient has more functions than are kept, so nothing was simplified.".to_string()
        } else {
            verdict(&operations.reduced, &operations.exact)
        },
        operations,
        control,
        guarantee,
        warnings: &generation.warnings,
    }
}

/// The verdict on an exact model.
pub(super) fn exact_in_words(model: &ModelSpec) -> &'static str {
    match model.tolerance() {
        Some(_) => {
            "no reduced model within the tolerance is cheaper than the exact one, so this is the exact model."
        }
        None => "this is the exact model.",
    }
}

fn adaptation(generation: &Generation) -> Option<AdaptationView<'_>> {
    let adaptation = generation.design.as_ref()?.adaptation.as_ref()?;
    let regressor = generation.regressor.as_ref()?;
    let mut operations = regressor.code.operations();
    if regressor.own_base {
        let own = generation.code.operations();
        operations.mul += own.mul;
        operations.add += own.add;
        operations.trig_pairs = operations.trig_pairs.max(own.trig_pairs);
    }
    let parameter = |k: usize| RangeView {
        name: &adaptation.names[k],
        nominal: adaptation.initial[k],
        low: adaptation.low[k],
        high: adaptation.high[k],
    };
    let parameters = (0..adaptation.names.len()).map(parameter).collect();
    Some(AdaptationView { parameters, rate: &adaptation.rate, operations })
}

fn diagonal(values: &[f64]) -> Vec<Vec<f64>> {
    let row = |i: usize| (0..values.len()).map(|j| if i == j { values[i] } else { 0.0 }).collect();
    (0..values.len()).map(row).collect()
}

fn estimated(generation: &Generation) -> Option<EstimateView> {
    let Generation { lagrangian, reduced, domain, motion, .. } = generation;
    let deltas = estimate(lagrangian, reduced, domain, motion.as_ref())?;
    let Bounds { d, h, g, .. } = Bounds::new(lagrangian, &deltas);
    Some(EstimateView { D: d, H: h, G: g })
}

fn by_factor(generation: &Generation) -> Option<EstimateView> {
    let Generation { lagrangian, reduced, uncertainty, domain, motion, regression, .. } = generation;
    regression.as_ref()?;
    let motion = motion.as_ref();
    let deltas = factor_bounds(lagrangian, reduced, uncertainty, domain, motion, &Effort::default());
    let Bounds { d, h, g, .. } = Bounds::new(lagrangian, &deltas);
    Some(EstimateView { D: d, H: h, G: g })
}

fn domain_view(domain: &Domain) -> DomainView {
    let (kind, position_error, position) = match domain {
        Domain::Trajectory => ("trajectory", None, None),
        Domain::Tube(errors) => ("tube", Some(errors.clone()), None),
        Domain::Workspace(limits) => ("workspace", None, Some(limits.clone())),
    };
    DomainView { kind, position_error, position }
}

fn text(view: &Inspection, generation: &Generation) -> String {
    let mut lines = vec![
        format!("{}: {} joints ({})", view.name, view.joints, view.joint_names.join(", ")),
        format!(
            "exact model: {} functions, {} distinct coefficients, {} terms",
            view.functions, view.coefficients, view.terms
        ),
    ];
    for (number, psi) in (1..).zip(&view.selected) {
        lines.push(format!("  psi_{number} = {psi}"));
    }
    let cost = |o: &Operations| format!("{} mul, {} add, {} sin-cos pairs", o.mul, o.add, o.trig_pairs);
    lines.push(format!("emitted ({}): {}", view.form, cost(&view.operations.reduced)));
    lines.push(format!("exact:   {}", cost(&view.operations.exact)));
    lines.push(format!("verdict: {}", view.verdict));
    let bounded = !generation.reduced.is_exact() || !generation.code.sines.rounds();
    if bounded {
        let largest = |values: &mut dyn Iterator<Item = &f64>| values.fold(0.0_f64, |a, &b| a.max(b));
        lines.push(format!(
            "bounds ({}) over {}: dD <= {}, dh <= {}, dG <= {}",
            view.bounds.kind,
            domain_in_words(&generation.domain),
            up(largest(&mut view.bounds.D.iter().flatten())),
            up(largest(&mut view.bounds.H.iter().flatten().flatten())),
            up(largest(&mut view.bounds.G.iter())),
        ));
    }
    if let Some(torque) = generation.torque.as_ref().filter(|_| bounded) {
        lines.push(torque_in_words(torque));
    }
    for p in &view.uncertainty {
        lines.push(format!("uncertain: {} in [{}, {}], here {}", p.name, p.low, p.high, p.nominal));
    }
    if let Some(adaptation) = &view.adaptation {
        let count = adaptation.parameters.len();
        lines.push(format!("parameters adapted: {count}; base and Y in {}", cost(&adaptation.operations)));
    }
    if let Some(control) = &view.control {
        lines.push(gains(control));
        lines.push(format!("control: k* = {:.4}, V_max(0) = {:.4} J", control.k_star, control.v_max));
        lines.push(format!(
            "largest errors: position ({}), velocity ({})",
            list(control.position_error),
            list(control.velocity_error)
        ));
    }
    if let Some(promised) = &view.guarantee {
        lines.extend(guarantee(promised));
    }
    lines.join("\n") + "\n"
}

/// A gain as one would write it: its diagonal, where that is all.
fn as_written(gain: &[Vec<f64>]) -> MatrixSpec {
    let n = gain.len();
    let diagonal = (0..n).all(|i| (0..n).all(|j| i == j || gain[i][j] == 0.0));
    if diagonal {
        MatrixSpec::Diagonal((0..n).map(|i| gain[i][i]).collect())
    } else {
        MatrixSpec::Full(gain.to_vec())
    }
}

fn gains(control: &ControlView) -> String {
    let show = |gain: &MatrixSpec| match gain {
        MatrixSpec::Scalar(value) => format!("{value:.4}"),
        MatrixSpec::Diagonal(list) => format!("{list:.4?}"),
        MatrixSpec::Full(rows) => format!("{rows:.4?}"),
    };
    let layer = control.boundary_layer.map_or("none".to_string(), |phi| format!("{phi:.4?}"));
    format!(
        "gains: W = {}, Pqq = {}, Omega = {}, boundary layer = {layer}, period = {} s",
        show(&control.W),
        show(&control.Pqq),
        show(&control.Omega),
        control.period
    )
}

fn list(x: &[f64]) -> String {
    x.iter().map(|&e| up(e)).collect::<Vec<_>>().join(", ")
}

/// Four digits, never below the number: what is printed of a bound is one, too.
fn up(x: f64) -> String {
    if x == 0.0 { "0".to_string() } else { format!("{:.3e}", x + 5e-4 * x.abs()) }
}

/// Four digits, never above the number.
fn down(x: f64) -> String {
    if x == 0.0 { "0".to_string() } else { format!("{:.3e}", x - 5e-4 * x.abs()) }
}

fn guarantee(promised: &GuaranteeView) -> Vec<String> {
    let kind = if promised.inertia_certified { "certified" } else { "sampled" };
    let mut lines = vec![
        format!(
            "final error: ({}){}",
            list(promised.final_error),
            if promised.guaranteed { "" } else { ", which means nothing without the guarantee" }
        ),
        format!(
            "largest initial error: ({})",
            promised.initial_error_max.iter().map(|&e| down(e)).collect::<Vec<_>>().join(", ")
        ),
        format!("smallest sufficient tube: {}", promised.tube_needed.map_or("none found".to_string(), list)),
        format!(
            "longest period: {} s, at every D of the domain held still; lambda_min(D) >= {} ({kind})",
            down(promised.period_max),
            down(promised.inertia_min)
        ),
        format!(
            "guaranteed: {}{}",
            promised.guaranteed,
            if promised.guaranteed {
                ", as long as the planned motion lasts and no torque limit cuts in"
            } else {
                ""
            }
        ),
    ];
    lines.extend(promised.reasons.iter().map(|reason| format!("  {reason}")));
    lines
}
