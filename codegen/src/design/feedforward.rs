//! The torque that the desired motion takes, of every arm of a family.

use crate::arm::{Arm, Uncertainty};
use crate::bounds::largest_torque;
use crate::dynamics::inverse_dynamics;
use crate::motion::Motion;

/// Instants at which the feedforward torque is looked at for its change.
const INSTANTS: u32 = 400;

/// The most by which the torque along the motion itself changes during one period, by joint, N·m or N: what a held
/// torque lags. The change is affine in the uncertain parameters, so that of the worst arm is known at once; a law that
/// learns may hold the torque of any of them.
pub(super) fn lag(arm: &Arm, uncertainty: &Uncertainty, motion: &Motion, period: f64) -> Vec<f64> {
    let n = arm.dof();
    let step = motion.duration() / f64::from(INSTANTS);
    let alone: Vec<Arm> = (0..uncertainty.parameters.len()).map(|k| uncertainty.alone(arm, k)).collect();
    // τ of the arm itself, ∂τ/∂u_k, and q̇.
    let at = |k: u32| -> (Vec<f64>, Vec<Vec<f64>>, Vec<f64>) {
        let target = motion.at(step * f64::from(k));
        let torque = |arm: &Arm| inverse_dynamics(arm, &target.q, &target.qd, &target.qdd);
        let friction = arm.joints.iter().zip(&target.qd).map(|(joint, qd)| joint.viscous_friction * qd);
        let own = torque(arm).iter().zip(friction).map(|(torque, friction)| torque + friction).collect();
        (own, alone.iter().map(torque).collect(), target.qd)
    };
    let change = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| b - a).collect() };
    let mut most = vec![0.0_f64; n];
    let mut before = at(0);
    for k in 1..=INSTANTS {
        let now = at(k);
        let slopes: Vec<Vec<f64>> = before.1.iter().zip(&now.1).map(|(a, b)| change(a, b)).collect();
        let moved = uncertainty.largest(&change(&before.0, &now.0), &slopes);
        let faster = change(&before.2, &now.2);
        for i in 0..n {
            let rubbed = uncertainty.viscous.get(i).map_or(0.0, |v| v * faster[i].abs());
            most[i] = most[i].max(moved[i] + rubbed);
        }
        before = now;
    }
    most.iter().map(|most| most * period / step).collect()
}

/// The joints whose torque limit is less than what the desired motion alone takes of some arm of the family.
///
/// That no limit cuts in during a transient is not judged: the guarantee supposes it.
pub(super) fn beyond_torque_limits(arm: &Arm, uncertainty: &Uncertainty, motion: &Motion) -> Vec<String> {
    let limits = arm.joints.iter().map(|joint| joint.limits.torque);
    (1..)
        .zip(largest_torque(arm, uncertainty, motion).into_iter().zip(limits))
        .filter_map(|(number, (peak, limit))| {
            let limit = limit.filter(|&limit| peak >= limit)?;
            Some(format!("the desired motion takes {peak:.4} of joint {number}, its torque limit is {limit}"))
        })
        .collect()
}
