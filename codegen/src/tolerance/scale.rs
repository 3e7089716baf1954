//! What torque errors are measured with.

use super::SCATTERED;
use crate::arm::Arm;
use crate::bounds::{Rates, workspace_peak_torque};
use crate::measure::Domain;
use crate::motion::Motion;

/// What the torque error is measured with: rates and the largest torques that they lead to.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Over a workspace the joints' limits, around a motion the motion's own.
    pub rates: Rates,
    /// Largest |τ| by joint, N·m or N: along the motion, or the largest found over the workspace with the same rates,
    /// which is attained there.
    pub peak: Vec<f64>,
}

impl Scale {
    /// `None` over a workspace where a joint lacks a limit.
    pub fn new(arm: &Arm, domain: &Domain, motion: Option<&Motion>) -> Option<Self> {
        match (&domain.within_a_turn(arm, SCATTERED), motion) {
            (Domain::Workspace(limits), _) => {
                let rates = Rates::limits(arm)?;
                Some(Self { peak: workspace_peak_torque(arm, limits, &rates), rates })
            }
            (_, Some(motion)) => {
                Some(Self { rates: Rates::of(motion), peak: crate::bounds::peak_torque(arm, motion) })
            }
            (_, None) => None,
        }
    }
}

impl Scale {
    /// By joint, Ū over the joint's torque.
    pub(super) fn shares(&self, multipliers: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        let of = |(i, peak): (usize, &f64)| multipliers(i).into_iter().map(|u| u / peak).collect();
        self.peak.iter().enumerate().map(of).collect()
    }
}
