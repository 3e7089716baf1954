//! What a specification asks of the gains instead of giving them.

use super::shape::{entries, vector};
use crate::error::Faults;
use crate::spec::{ControlSpec, MeasureSpec, Spec, VectorSpec};

/// Checks that the gains are either given or asked for, and that what is asked for lies inside the measure.
pub(super) fn check(control: &ControlSpec, spec: &Spec, joints: Option<usize>, faults: &mut Faults) {
    let given = [
        ("period", control.period.is_some()),
        ("W", control.w.is_some()),
        ("Pqq", control.pqq.is_some()),
        ("Omega", control.omega.is_some()),
        ("boundary_layer", control.boundary_layer.is_some()),
    ];
    let Some(wish) = &control.design else {
        for (name, _) in given.iter().take(4).filter(|(_, given)| !given) {
            let mend = "write it, or ask for all gains with `control.design`";
            faults.push(format!("control.{name}"), "is missing", mend);
        }
        return;
    };
    for (name, _) in given.iter().filter(|(_, given)| *given) {
        let mend = if *name == "period" {
            "write it as `control.design.period`, or remove `control.design` and give the gains"
        } else {
            "remove it, or remove `control.design` and give all gains"
        };
        faults.push(format!("control.{name}"), "is given while `control.design` asks for it", mend);
    }
    if wish.convergence_time <= 0.0 {
        let problem = format!("is {}", wish.convergence_time);
        faults.push("control.design.convergence_time", problem, "write a number above 0, in s");
    }
    if let Some(period) = wish.period.filter(|period| *period <= 0.0) {
        faults.push("control.design.period", format!("is {period}"), "write a number above 0, in s");
    }
    if spec.measure == Some(MeasureSpec::Trajectory) {
        let mend = "take the measure `tube`, or `workspace`";
        faults.push("control.design", "finds no room for errors in the measure `trajectory`", mend);
    }
    let Some(tube) = &wish.tube else { return };
    entries("control.design.tube", tube, joints, |v| v > 0.0, "a number above 0", faults);
    let widest = match &spec.measure {
        Some(MeasureSpec::Tube { position_error }) => position_error,
        None if spec.motion.is_some() => &VectorSpec::Scalar(crate::pipeline::DEFAULT_TUBE),
        _ => return,
    };
    let Some((wanted, widest)) = joints.and_then(|n| Some((vector(tube, n)?, vector(widest, n)?))) else {
        return;
    };
    let beyond = wanted.iter().zip(&widest).enumerate().filter(|(_, (wanted, widest))| wanted > widest);
    // One number for all joints is one mistake.
    let told = if matches!(tube, VectorSpec::Scalar(_)) { 1 } else { wanted.len() };
    for (i, (wanted, widest)) in beyond.take(told) {
        let field = match tube {
            VectorSpec::Scalar(_) => "control.design.tube".to_string(),
            VectorSpec::List(_) => format!("control.design.tube[{i}]"),
        };
        let problem = format!("is {wanted}, and the bounds hold only up to {widest} of joint {}", i + 1);
        faults.push(
            field,
            problem,
            format!("write at most {widest}, or widen `measure.tube.position_error`"),
        );
    }
}
