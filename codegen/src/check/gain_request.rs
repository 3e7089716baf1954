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
    starts_outside(control, spec, joints, faults);
    let Some(tube) = &request.tube else { return };
    entries("control.design.tube", tube, joints, |v| v >= LEAST, "a number of at least 1e-6", faults);
    let both = |n| Some((tube.by_joint(n)?, measured(spec)?.by_joint(n)?));
    let Some((wanted, widest)) = joints.and_then(both) else { return };
    let beyond = wanted.iter().zip(&widest).enumerate().filter(|(_, (wanted, widest))| wanted > widest);
    // One number for all joints is one mistake.
    let told = if matches!(tube, VectorSpec::Scalar(_)) { 1 } else { wanted.len() };
    for (i, (wanted, widest)) in beyond.take(told) {
        let field = match tube {
            VectorSpec::Scalar(_) => "control.design.tube".to_string(),
            VectorSpec::List(_) => format!("control.design.tube[{i}]"),
        };
        let problem = format!(
            "is {}, and the bounds hold only up to {} of joint {}",
            scientific(*wanted),
            scientific(*widest),
            i + 1
        );
        faults.push(
            field,
            problem,
            format!("write at most {widest}, or widen `measure.tube.position_error`"),
        );
    }
}

/// The tube for which the bounds hold; `None` where they hold for another domain.
fn measured(spec: &Spec) -> Option<&VectorSpec> {
    match &spec.measure {
        Some(MeasureSpec::Tube { position_error }) => Some(position_error),
        None if spec.motion.is_some() => Some(&VectorSpec::Scalar(crate::domain::DEFAULT_TUBE)),
        _ => None,
    }
}

/// An arm that may start outside the tube has no gains, which need not be sought.
fn starts_outside(control: &ControlSpec, spec: &Spec, joints: Option<usize>, faults: &mut Diagnostics) {
    let both = |n| Some((control.initial_error.position.by_joint(n)?, measured(spec)?.by_joint(n)?));
    let Some((start, tube)) = joints.and_then(both) else { return };
    let beyond = start.iter().zip(&tube).position(|(start, tube)| start > tube);
    if let Some(i) = beyond {
        let (start, tube) = (scientific(start[i]), scientific(tube[i]));
        faults.push(
            "control.initial_error.position",
            format!("is {start} of joint {}, and the bounds hold only up to {tube}", i + 1),
            "take a smaller initial error, in rad or m, or widen `measure.tube.position_error`",
        );
    }
}
