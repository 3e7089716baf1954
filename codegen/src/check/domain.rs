//! Measures: what each needs of the motion and of the joint limits.

use super::shape::entries;
use crate::arm::{Arm, Limits};
use crate::error::Diagnostics;
use crate::spec::{MeasureSpec, ModelSpec, Spec};

/// Checks `spec.measure`; absent it is a tube, which needs a motion.
pub(super) fn check(spec: &Spec, arm: Option<&Arm>, joints: Option<usize>, faults: &mut Diagnostics) {
    match &spec.measure {
        Some(MeasureSpec::Workspace) => {
            // An exact model leaves nothing out, so that its dynamics need no limits.
            let exact = spec.model == ModelSpec::Exact && spec.control.is_none();
            if let Some(arm) = arm.filter(|_| !exact) {
                limits(spec, arm, faults);
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
        let problem = format!("is missing, but the measure {word} needs it");
        faults.push("motion", problem, "add a motion, or write \"measure\": \"workspace\"");
    }
}

/// Time in which a joint reaches its top speed at the acceleration that is proposed for it, s.
const RISE: f64 = 0.2;

fn limits(spec: &Spec, arm: &Arm, faults: &mut Diagnostics) {
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
        let problem = format!("is \"workspace\", but of the joint limits {}", lacking.join(", "));
        faults.push("measure", problem, help(spec, arm));
    }
}

/// Where the limits are written, with an acceleration to begin with for the first joint that lacks one.
fn help(spec: &Spec, arm: &Arm) -> String {
    let otherwise = "or choose `tube` or `trajectory`";
    let field = |i: usize, name: &str| match spec.arm.urdf {
        Some(_) => format!("arm.joints.{name}.limits"),
        None => format!("arm.dh.links[{i}].limits"),
    };
    let mut joints = arm.joints.iter().enumerate();
    let Some((i, joint)) = joints.find(|(_, joint)| joint.limits.acceleration.is_none()) else {
        let mut joints = arm.joints.iter().enumerate();
        let lacking = |limits: &Limits| limits.position.is_none() || limits.velocity.is_none();
        let place = joints.find(|(_, joint)| lacking(&joint.limits)).map(|(i, j)| field(i, &j.name));
        return format!("add the limits as `{}`, {otherwise}", place.unwrap_or_default());
    };
    let start = joint.limits.velocity.map_or(String::new(), |speed| {
        format!(
            " (if it is not known, begin with {:.3}, which reaches the top speed in {RISE} s)",
            speed / RISE
        )
    });
    format!("add the limits, such as `{}.acceleration`{start}, {otherwise}", field(i, &joint.name))
}
