//! What a check of the desired motion needs.

use crate::arm::Arm;
use crate::error::Diagnostics;
use crate::spec::{LawCodeSpec, Spec};

/// Adds a fault for everything that `emit.check_reference` cannot be had with.
pub(super) fn check(spec: &Spec, arm: Option<&Arm>, faults: &mut Diagnostics) {
    if !spec.emit.check_reference {
        return;
    }
    let mut fault = |problem: String, help: &str| faults.push("emit.check_reference", problem, help);
    if spec.control.is_none() {
        let problem = "asks the controller to check the desired motion, but there is no `control`";
        fault(problem.to_string(), "add `control`, or remove `emit.check_reference`");
    }
    if spec.motion.is_some() {
        let problem = "asks for a check of the program's own motions, but what is promised is about `motion`";
        fault(problem.to_string(), "remove `motion` or `emit.check_reference`");
    }
    if spec.emit.law == LawCodeSpec::Runtime {
        let problem =
            "asks for a check that is part of a step that is written out, but `emit.law` is `runtime`";
        fault(problem.to_string(), "remove `emit.law` or `emit.check_reference`");
    }
    let lacks =
        |joint: &&crate::arm::Joint| joint.limits.velocity.is_none() || joint.limits.acceleration.is_none();
    let without: Vec<&str> = arm
        .into_iter()
        .flat_map(|arm| arm.joints.iter())
        .filter(lacks)
        .map(|joint| joint.name.as_str())
        .collect();
    if !without.is_empty() {
        let problem = format!(
            "needs the limits of velocity and acceleration of every joint, which are missing for {}",
            without.join(", ")
        );
        fault(problem, "add them under `limits` of the joints");
    }
}
