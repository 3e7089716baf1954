//! Rotations that are nearly right angles: where taking them for right angles would save operations.

use crate::arm::{Arm, ROUND_ANGLES, distance};
use crate::bounds::printed_up;
use crate::graph::Graph;
use crate::lagrangian::expand;
use crate::load::Loaded;
use crate::torque;

/// Values of `arm.round_angles` that are tried: beyond the last an angle is not a right one written with few digits.
const LEVELS: [f64; 6] = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

/// What is said where a larger `arm.round_angles` would make the exact code cheaper: joint, angle, operations, the field.
///
/// `exact` is the exact code of `arm`, and `given` the arm whose rotations have not been rounded.
pub(super) fn advice(loaded: &Loaded, arm: &Arm, given: &Arm, exact: &Graph) -> Option<String> {
    let own = loaded.spec.arm.round_angles.unwrap_or(ROUND_ANGLES);
    let mut last = arm.clone();
    let mut best: Option<(usize, f64, Arm)> = None;
    for level in LEVELS.into_iter().filter(|level| *level > own) {
        let (rounded, _) = Arm::rounded_to(loaded, level)?;
        if rounded == last {
            continue;
        }
        last = rounded.clone();
        let operations = torque::exact(&rounded, &expand(&rounded)).1.operations().arithmetic();
        if operations < best.as_ref().map_or(exact.operations().arithmetic(), |best| best.0) {
            best = Some((operations, level, rounded));
        }
    }
    let (operations, level, rounded) = best?;
    let now = exact.operations().arithmetic();
    let off = |(joint, other): (&crate::arm::Joint, &crate::arm::Joint)| {
        let angle = distance(&joint.pose.rotation, &other.pose.rotation);
        (angle > own).then(|| format!("{} by {} rad", joint.name, printed_up(angle)))
    };
    let joints: Vec<String> = given.moving().iter().zip(rounded.moving()).filter_map(off).collect();
    let whose = match joints.as_slice() {
        [] => "frames of links that no joint moves".to_string(),
        joints => format!("rotations of joints ({})", joints.join(", ")),
    };
    Some(format!(
        "{}: arm.round_angles: {whose} are nearly right angles; write {level:e} to take them for right angles, which saves {} of {now} operations \
         of the exact model and becomes part of every bound",
        loaded.path.display(),
        now - operations
    ))
}
