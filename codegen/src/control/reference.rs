//! What a desired motion must keep where the specification has none.

use super::region::turns;
use crate::arm::Arm;
use crate::domain::Domain;

/// Limits of the desired motions that a program makes by itself: what is proved of the controller supposes them.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceLimits {
    /// Lowest and highest q_d by joint, rad or m: with the largest position error the joint stays inside the workspace.
    pub position: Vec<[f64; 2]>,
    /// Largest |q̇_d| by joint, rad/s or m/s: that of the joint.
    pub velocity: Vec<f64>,
    /// Largest |q̈_d| by joint, rad/s² or m/s²: that of the joint.
    pub acceleration: Vec<f64>,
}

impl ReferenceLimits {
    /// Over a workspace whose joints all have limits of velocity and acceleration, with position errors up to `error`; `None` elsewhere.
    /// Where the errors leave no room, the position may be anywhere in the workspace, and nothing is promised.
    pub(super) fn of(arm: &Arm, domain: &Domain, error: &[f64]) -> Option<Self> {
        let Domain::Workspace(box_) = domain else { return None };
        let [velocity, acceleration] = largest(arm)?;
        let inner = |i: usize| match turns(arm, box_, i) {
            true => box_[i],
            // A unit in the last place more, so that rounding does not lead out.
            false => [(box_[i][0] + error[i]).next_up(), (box_[i][1] - error[i]).next_down()],
        };
        let inner: Vec<[f64; 2]> = (0..arm.dof()).map(inner).collect();
        let position = if inner.iter().all(|[low, high]| low <= high) { inner } else { box_.clone() };
        Some(Self { position, velocity, acceleration })
    }
}

/// The joints' limits of velocity and of acceleration; `None` where one is missing.
pub(super) fn largest(arm: &Arm) -> Option<[Vec<f64>; 2]> {
    let limits = || arm.joints.iter().map(|joint| joint.limits);
    let velocity = limits().map(|limits| limits.velocity).collect::<Option<_>>()?;
    Some([velocity, limits().map(|limits| limits.acceleration).collect::<Option<_>>()?])
}
