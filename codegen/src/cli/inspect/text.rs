//! Puts it into words.

use super::{ControlView, GuaranteeView, Inspection, PromiseView, ReferenceView};
use crate::bounds::{printed_above, printed_below, printed_down, printed_up};
use crate::emit::{domain_in_words, met_in_words, rates_in_words, torque_in_words};
use crate::number::short;
use crate::pipeline::Generation;
use crate::spec::MatrixSpec;

pub(super) fn text(view: &Inspection, generation: &Generation) -> String {
    let mut lines = vec![
        format!("{}: {} joints ({})", view.name, view.joints, view.joint_names.join(", ")),
        format!(
            "exact model: {} functions, {} distinct coefficients, {} terms",
            view.functions, view.coefficients, view.terms
        ),
    ];
    if let Some(linkage) = &generation.arm().linkage {
        lines.push(format!("followers: {}", linkage.equations(generation.arm()).join(", ")));
    }
    for (number, psi) in (1..).zip(&view.selected) {
        lines.push(format!("  psi_{number} = {psi}"));
    }
    if let Some(simplified_arm) = generation.reduced().simplified_arm() {
        lines.push(format!("a simpler arm, without {}", simplified_arm.lost()));
    }
    lines.push(format!("emitted ({}): {}", view.form, view.operations.reduced));
    lines.push(format!("exact:   {}", view.operations.exact));
    lines.push(format!("module:  {} bytes", view.size));
    lines.push(format!("verdict: {}", view.verdict));
    let bounded = !generation.reduced().is_exact() || !generation.code().sines.rounds();
    if bounded {
        let largest = |values: &mut dyn Iterator<Item = &f64>| values.fold(0.0_f64, |a, &b| a.max(b));
        lines.push(format!(
            "bounds ({}) over {}: dD <= {}, dh <= {}, dG <= {}",
            view.bounds.kind,
            domain_in_words(generation.domain()),
            printed_up(largest(&mut view.bounds.D.iter().flatten())),
            printed_up(largest(&mut view.bounds.H.iter().flatten().flatten())),
            printed_up(largest(&mut view.bounds.G.iter())),
        ));
    }
    if let Some(torque) = generation.torque() {
        lines.push(torque_in_words(torque));
        lines.push(rates_in_words(torque));
        lines.push(met_in_words(generation.met(), generation.design().is_some()));
    }
    for p in &view.uncertainty {
        lines.push(format!("uncertain: {} in [{}, {}], here {}", p.name, p.low, p.high, p.nominal));
    }
    if let Some(adaptation) = &view.adaptation {
        let count = adaptation.parameters.len();
        lines.push(format!("parameters adapted: {count}; base and Y in {}", adaptation.operations));
    }
    if let Some(control) = &view.control {
        lines.push(gains(control));
        lines.push(robust_gain(control));
        lines.push(format!("control: k* = {}, V_max(0) = {} J", short(control.k_star), short(control.v_max)));
    }
    if let Some(promised) = &view.guarantee {
        lines.extend(guarantee(promised));
    }
    if let (Some(control), Some(promised)) = (&view.control, &view.continuous) {
        let sampled = view.guarantee.as_ref().is_some_and(|promised| promised.kind == "sampled");
        lines.extend(continuous(promised, control, sampled));
    }
    if let Some(limits) = &view.reference {
        lines.extend(reference(limits));
    }
    lines.join("\n") + "\n"
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

fn robust_gain(control: &ControlView) -> String {
    let constant = |gain| format!("constant, ({})", list(gain));
    format!("robust gain: {}", control.robust_gain.map_or("the law's own".to_string(), constant))
}

fn list(x: &[f64]) -> String {
    x.iter().map(|&e| printed_up(e)).collect::<Vec<_>>().join(", ")
}

fn continuous(promised: &GuaranteeView, control: &ControlView, sampled: bool) -> Vec<String> {
    let kind = if promised.inertia_certified { "certified" } else { "sampled" };
    let most = promised.initial_error_max.iter().map(|&e| printed_down(e)).collect::<Vec<_>>().join(", ");
    let holds = match (promised.holds, sampled) {
        (true, _) => "holds, as long as no torque limit cuts in",
        (false, true) => "does not hold; the guarantee above stands without it",
        (false, false) => "does not hold",
    };
    let mut lines = vec![
        format!("level of V, a proof for the continuous law: {holds}"),
        format!(
            "  errors while V stays below its level: position ({}) rad or m, velocity ({}) rad/s or m/s",
            list(control.position_error),
            list(control.velocity_error)
        ),
        format!("  final error: ({}), once the initial errors have died away", list(promised.final_error)),
        format!("  largest initial error: ({most})"),
        format!(
            "  smallest sufficient tube: {}",
            promised.tube_needed.map_or("none found".to_string(), list)
        ),
        format!(
            "  longest period: {} s, at every D of the domain, each D constant; lambda_min(D) >= {} ({kind})",
            printed_down(promised.period_max),
            printed_down(promised.inertia_min)
        ),
    ];
    lines.extend(promised.reasons.iter().map(|reason| format!("  {reason}")));
    lines
}

fn reference(limits: &ReferenceView) -> Vec<String> {
    // Inwards, so that what is shown is inside.
    let range = |[low, high]: &[f64; 2]| format!("[{}, {}]", printed_above(*low), printed_below(*high));
    let down = |x: &[f64]| x.iter().map(|&x| printed_down(x)).collect::<Vec<_>>().join(", ");
    let checked = match limits.checked {
        true => format!(
            "the step reports a fault beyond these: {} comparisons and {} absolute values beside its operations",
            limits.comparisons, limits.absolute_values
        ),
        false => {
            "the step does not look at these: `emit.check_reference` makes it report a fault".to_string()
        }
    };
    vec![
        "a desired motion must keep:".to_string(),
        format!("  position in ({})", limits.position.iter().map(range).collect::<Vec<_>>().join(", ")),
        format!("  speed at most ({})", down(limits.velocity)),
        format!("  acceleration at most ({})", down(limits.acceleration)),
        format!("  {checked}"),
    ]
}

fn guarantee(promised: &PromiseView) -> Vec<String> {
    let mut lines = vec![format!("guarantee: {}", promised.kind)];
    let mut bound = |what: &str, x: &Option<Vec<f64>>| {
        if let Some(x) = x {
            lines.push(format!("  {what}: ({})", list(x)));
        }
    };
    bound("largest error at any time, rad or m", &promised.reach);
    if let Some(settle) = promised.settle {
        bound(&format!("largest error from {} s on", printed_up(settle)), &promised.settled_error);
    }
    bound("largest error at the end of the motion", &promised.end_error);
    bound("largest initial error", &promised.initial_error_max);
    if promised.reach.is_some() {
        let until = promised
            .valid_until
            .map_or("for ever".to_string(), |end| format!("until {} s", printed_down(end)));
        lines.push(format!("  holds {until}"));
    }
    if let (Some(low), Some(high)) = (&promised.torque_min, &promised.torque_max) {
        let shown =
            |x: &[f64], of: fn(f64) -> String| x.iter().map(|x| of(*x)).collect::<Vec<_>>().join(", ");
        let (low, high) = (shown(low, printed_below), shown(high, printed_above));
        lines.push(format!("  torque asked for, N·m or N: from ({low}) to ({high})"));
    }
    if let Some(period) = promised.period_max {
        lines.push(format!("  longest period: {} s", printed_down(period)));
    }
    lines.extend(promised.reasons.iter().map(|reason| format!("  {reason}")));
    lines
}
