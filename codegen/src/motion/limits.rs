//! Does the motion keep to the joints' limits?

use super::Motion;
use crate::arm::Arm;
use crate::error::Faults;

/// Instants at which a motion is compared with the limits.
const INSTANTS: u32 = 2000;

/// Adds one fault for each limit of each joint that the motion breaks, with the worst instant; one alone where its
/// numbers overflow.
pub fn check_limits(motion: &Motion, arm: &Arm, faults: &mut Faults) {
    let times = (0..=INSTANTS).map(|k| motion.duration() * f64::from(k) / f64::from(INSTANTS));
    let targets: Vec<_> = times.map(|t| (t, motion.at(t))).collect();
    let finite = |target: &super::Target| {
        [&target.q, &target.qd, &target.qdd].into_iter().flatten().all(|v| v.is_finite())
    };
    if let Some((t, _)) = targets.iter().find(|(_, target)| !finite(target)) {
        let problem = format!("overflows at t = {t:.3e} s");
        faults.push("motion", problem, "write times and positions in SI units");
        return;
    }
    for (i, joint) in arm.joints.iter().enumerate() {
        let number = i + 1;
        let mut compare = |what: &str, value: fn(&super::Target) -> &[f64], low: f64, high: f64| {
            let excess = |x: f64| (x - high).max(low - x);
            let worst = targets
                .iter()
                .map(|(t, target)| (excess(value(target)[i]), *t, value(target)[i]))
                .fold((0.0, 0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst });
            // Limits are often printed with ten digits, and motions run up to them.
            if worst.0 > 1e-9 * high.abs().max(low.abs()) {
                faults.push(
                    "motion",
                    format!(
                        "{what} of joint {number} ({}) is {:.6} at t = {:.3} s, outside its limits [{low}, {high}]",
                        joint.name, worst.2, worst.1
                    ),
                    "keep the motion inside the joint limits, or correct the limits",
                );
            }
        };
        if let Some([low, high]) = joint.limits.position {
            compare("position", |target| &target.q, low, high);
        }
        if let Some(most) = joint.limits.velocity {
            compare("velocity", |target| &target.qd, -most, most);
        }
        if let Some(most) = joint.limits.acceleration {
            compare("acceleration", |target| &target.qdd, -most, most);
        }
    }
}
