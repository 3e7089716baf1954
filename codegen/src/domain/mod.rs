//! Where a model must be good: along a motion, around it, or over a workspace.

mod measure;

pub use measure::Measure;

use std::sync::Arc;

use crate::arm::{Arm, Joint, JointKind};
use crate::motion::Motion;

/// Which set of positions a model is made for.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// The desired trajectory q_d(t) itself.
    Path(Arc<Motion>),
    /// All q with |q − q_d(t)| ≤ ε for some t: the motion, and ε by joint, rad or m.
    Tube(Arc<Motion>, Vec<f64>),
    /// The joint box [low, high], rad or m.
    Workspace(Vec<[f64; 2]>),
}

/// Half-width of the tube where the specification names no measure, rad or m.
pub(crate) const DEFAULT_TUBE: f64 = 0.05;

impl Domain {
    /// The motion that the domain follows; `None` for a workspace.
    pub fn motion(&self) -> Option<&Motion> {
        match self {
            Self::Path(motion) | Self::Tube(motion, _) => Some(motion),
            Self::Workspace(_) => None,
        }
    }

    /// The motion as it is held; `None` for a workspace.
    pub(crate) fn motion_shared(&self) -> Option<Arc<Motion>> {
        match self {
            Self::Path(motion) | Self::Tube(motion, _) => Some(Arc::clone(motion)),
            Self::Workspace(_) => None,
        }
    }

    /// The half-width around the motion by joint, rad or m; `None` for a workspace.
    pub fn width(&self) -> Option<Vec<f64>> {
        match self {
            Self::Path(motion) => Some(vec![0.0; motion.dof()]),
            Self::Tube(_, errors) => Some(errors.clone()),
            Self::Workspace(_) => None,
        }
    }

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
