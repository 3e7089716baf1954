//! What a specification asks of the gains instead of giving them.

use super::shape::entries;
use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::{ControlSpec, MeasureSpec, Spec, VectorSpec};

/// Convergence times and periods that an arm may have, s.
const TIMES: [f64; 2] = [1e-3, 1e4];
const PERIODS: [f64; 2] = [1e-6, 1.0];
/// Narrowest tube, rad or m.
const LEAST: f64 = 1e-6;

/// Checks that the gains are either given or asked for, and that what is asked for lies inside the measure.
pub(super) fn check(control: &ControlSpec, spec: &Spec, joints: Option<usize>, faults: &mut Diagnostics) {
    let given = [
        ("period", control.period.is_some()),
        ("W", control.w.is_some()),
        ("Pqq", control.pqq.is_some()),
        ("Omega", control.omega.is_some()),
        ("boundary_layer", control.boundary_layer.is_some()),
    ];
    let Some(request) = &control.design else {
        for (name, _) in given.iter().take(4).filter(|(_, given)| !given) {
            let help = "write it, or ask for all gains with `control.design`";
            faults.push(format!("control.{name}"), "is missing", help);
        }
        return;
    };
    for (name, _) in given.iter().filter(|(_, given)| *given) {
        let help = if *name == "period" {
            "write it as `control.design.period`, or remove `control.design` and give the gains"
        } else {
            "remove it, or remove `control.design` and give all gains"
        };
        faults.push(format!("control.{name}"), "is given while `control.design` asks for it", help);
    }
    let mut within = |field: &str, value: f64, [least, most]: [f64; 2]| {
        if !(least..=most).contains(&value) {
            let help = format!("write a number from {least:e} to {most:e}, in s");
            faults.push(format!("control.design.{field}"), format!("is {value:e}"), help);
        }
    };
    within("convergence_time", request.convergence_time, TIMES);
    if let Some(period) = request.period {
        within("period", period, PERIODS);
    }
    if spec.measure == Some(MeasureSpec::Trajectory) {
        let help = "take the measure `tube`, or `workspace`";
        faults.push("control.design", "needs room for errors, but the measure `trajectory` has none", help);
    }
    let initial = "control.initial_error.position";
    for (field, problem, _) in beyond_measure(initial, &control.initial_error.position, spec, joints) {
        let help = "take a smaller initial error, in rad or m, or widen `measure.tube.position_error`";
        faults.push(field, problem, help);
    }
    let Some(tube) = &request.tube else { return };
    entries("control.design.tube", tube, joints, |v| v >= LEAST, "a number of at least 1e-6", faults);
    for (field, problem, widest) in beyond_measure("control.design.tube", tube, spec, joints) {
        let help = format!("write at most {widest}, or widen `measure.tube.position_error`");
        faults.push(field, problem, help);
    }
}

/// Field, problem and what the measure's tube is, for each entry of the field that is larger.
fn beyond_measure(
    field: &str,
    wanted: &VectorSpec,
    spec: &Spec,
    joints: Option<usize>,
) -> Vec<(String, String, f64)> {
    let both = |n| Some((wanted.by_joint(n)?, measured(spec)?.by_joint(n)?));
    let Some((values, widest)) = joints.and_then(both) else { return Vec::new() };
    let beyond = values.iter().zip(&widest).enumerate().filter(|(_, (value, widest))| value > widest);
    let fault = |(i, (value, widest)): (usize, (&f64, &f64))| {
        let field = match wanted {
            VectorSpec::Scalar(_) => field.to_string(),
            VectorSpec::List(_) => format!("{field}[{i}]"),
        };
        let (value, most) = (scientific(*value), scientific(*widest));
        (field, format!("is {value}, and the bounds hold only up to {most} of joint {}", i + 1), *widest)
    };
    // One number for all joints is one mistake.
    let told = if matches!(wanted, VectorSpec::Scalar(_)) { 1 } else { values.len() };
    beyond.take(told).map(fault).collect()
}

/// The tube for which the bounds hold; `None` where they hold for another domain.
fn measured(spec: &Spec) -> Option<&VectorSpec> {
    match &spec.measure {
        Some(MeasureSpec::Tube { position_error }) => Some(position_error),
        None if spec.motion.is_some() => Some(&VectorSpec::Scalar(crate::domain::DEFAULT_TUBE)),
        _ => None,
    }
}
