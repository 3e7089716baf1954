//! Where a model must be good: along a motion, around it, or over a workspace.

mod measure;

pub use measure::Measure;

use crate::arm::{Arm, Joint, JointKind};

/// Which set of positions a model is made for.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// The desired trajectory q_d(t).
    Trajectory,
    /// All q with |q − q_d(t)| ≤ ε for some t; ε by joint, rad or m.
    Tube(Vec<f64>),
    /// The joint box [low, high], rad or m.
    Workspace(Vec<[f64; 2]>),
}

impl Domain {
    /// Positions that stand for all: every function is periodic in a revolute joint's angle, so that of a workspace wider
    /// than `turns` ≥ 1 periods of it one, the nearest to 0, is enough.
    #[must_use]
    pub fn within_a_turn(&self, arm: &Arm, turns: f64) -> Self {
        let Self::Workspace(limits) = self else { return self.clone() };
        let within =
            |(j, (&[low, high], joint)): (usize, (&[f64; 2], &Joint))| match (joint.kind, arm.period(j)) {
                (JointKind::Revolute, turn) if high - low > turns * turn => {
                    let from = (-0.5 * turn).clamp(low, high - turn);
                    // A few ulps more, for the rounding of 2π and of the sum.
                    [from, high.min(from + turn + 4.0 * f64::EPSILON * (turn + from.abs()))]
                }
                _ => [low, high],
            };
        Self::Workspace(limits.iter().zip(&arm.joints).enumerate().map(within).collect())
    }
}
