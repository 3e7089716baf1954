//! Measures: what each needs of the motion and of the joint limits.

use super::shape::entries;
use crate::arm::Arm;
use crate::error::Faults;
use crate::spec::{MeasureSpec, Spec};

/// Checks `spec.measure`; absent it is a tube, which needs a motion.
pub(super) fn check(spec: &Spec, arm: Option<&Arm>, joints: Option<usize>, faults: &mut Faults) {
    match &spec.measure {
        Some(MeasureSpec::Workspace) => {
            if let Some(arm) = arm {
                limits(arm, faults);
            }
            return;
        }
        Some(MeasureSpec::Tube { position_error }) => {
            let field = "measure.tube.position_error";
            entries(
                field,
                position_error,
                joints,
                |v| v >= 0.0,
                "a number of at least 0, in rad or m",
                faults,
            );
        }
        Some(MeasureSpec::Trajectory) | None => {}
    }
    if spec.motion.is_none() {
        let word = match &spec.measure {
            Some(MeasureSpec::Trajectory) => "`trajectory`",
            Some(_) => "`tube`",
            None => "`tube`, the default,",
        };
        let problem = format!("is missing, and the measure {word} follows it");
        faults.push("motion", problem, "add a motion, or write \"measure\": \"workspace\"");
    }
}

fn limits(arm: &Arm, faults: &mut Faults) {
    let lacking: Vec<String> = arm
        .joints
        .iter()
        .filter_map(|joint| {
            let limits = &joint.limits;
            let known = [
                ("position", limits.position.is_some()),
                ("velocity", limits.velocity.is_some()),
                ("acceleration", limits.acceleration.is_some()),
            ];
            let names: Vec<&str> = known.iter().filter(|(_, is)| !is).map(|(name, _)| *name).collect();
            (!names.is_empty()).then(|| format!("{} lacks {}", joint.name, names.join(" and ")))
        })
        .collect();
    if !lacking.is_empty() {
        faults.push(
            "measure",
            format!("is \"workspace\", but of the joint limits {}", lacking.join(", ")),
            "add the limits, or choose `tube` or `trajectory`",
        );
    }
}
