//! The torques and rates that torque errors are compared with.

use super::{
    Bounds, Rates, code_rounding, largest_growth, published, recursion_rounding, workspace_peak_torque,
};
use crate::arm::Arm;
use crate::domain::Domain;
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::numerics::rounded::Format;
use crate::reduction;
use crate::trig::Trig;

/// What the torque error is measured with: rates and the largest torques that they lead to.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueScale {
    /// Over a workspace the joints' limits, around a motion the motion's own.
    pub rates: Rates,
    /// Largest |τ| by joint, N·m or N: along the motion, or the largest found over the workspace with the same rates,
    /// which is attained there.
    pub peak: Vec<f64>,
    /// What rounding, of the arm's rotations and in f64, and sines take of a tolerance before a model is sought, N·m or N.
    pub reserve: Vec<f64>,
}

/// Over workspaces of more turns than this, positions are taken from one turn: points of the whole width would fall on the turn at
/// random, and leave gaps.
pub(crate) const SCATTERED: f64 = 2.0;
/// Reduced coefficients may be larger than the exact ones, and so may what they round by.
const LARGER: f64 = 4.0;
/// What the code of a model rounds by at most, of what the exact one rounds by.
const CODE: f64 = 2.0;
/// Part of a tolerance that is kept for the roundings of adding up what is left out.
const SPARE: f64 = 1e-9;

impl TorqueScale {
    /// `None` over a workspace where a joint lacks a limit.
    pub fn new(arm: &Arm, domain: &Domain) -> Option<Self> {
        let (rates, peak) = match &domain.within_a_turn(arm, SCATTERED) {
            Domain::Workspace(limits) => {
                let rates = Rates::limits(arm)?;
                let peak = workspace_peak_torque(arm, limits, &rates);
                (rates, peak)
            }
            Domain::Path(motion) | Domain::Tube(motion, _) => {
                (Rates::of(motion), crate::bounds::peak_torque(arm, motion))
            }
        };
        Some(Self { rates, reserve: vec![0.0; peak.len()], peak })
    }

    /// The same with what has to be taken off a tolerance: what rounding the rotations has changed, and what `sines` and
    /// f64 can do to the model of `arm` where |q_j| ≤ `position_bound`.
    #[must_use]
    pub fn reserving(
        mut self,
        (arm, lagrangian): (&Arm, &Lagrangian),
        position_bound: &[f64],
        angles: Option<&Bounds>,
        sines: &Trig,
    ) -> Self {
        let growth = largest_growth(lagrangian, position_bound, sines.beyond_ulp());
        let exact = reduction::exact(lagrangian);
        let rounds =
            |(m, growth): (usize, f64)| LARGER * (growth + published(lagrangian, m, &exact, position_bound));
        let each: Vec<f64> = growth.into_iter().enumerate().map(rounds).collect();
        let recursion = recursion_rounding(arm, position_bound).torque(&self.rates);
        let turned = angles.map(|angles| angles.torque(&self.rates));
        for (i, reserve) in self.reserve.iter_mut().enumerate() {
            let multipliers = self.rates.multipliers(lagrangian, i);
            let terms: f64 = multipliers.iter().zip(&each).map(|(u, rounding)| u * rounding).sum();
            *reserve = terms + 2.0 * recursion[i] + turned.as_ref().map_or(0.0, |turned| turned[i]);
        }
        self
    }

    /// The same, with what the code of a model may round by, where its number type rounds more than the bounds allow for. The
    /// code of the model to come is not known yet: it is taken to round by no more than twice what the `exact` one does.
    #[must_use]
    pub fn reserving_code(mut self, exact: &Graph, domain: &Domain, format: Format) -> Self {
        let code = code_rounding(exact, domain, &self.rates, format);
        for (reserve, code) in self.reserve.iter_mut().zip(code) {
            *reserve += CODE * code;
        }
        self
    }

    /// What a model may leave out by joint, N·m or N, for the whole torque error to stay within `fraction` of the peak.
    pub fn limits(&self, fraction: f64) -> Vec<f64> {
        let limit = |(peak, reserve): (&f64, &f64)| fraction * peak * (1.0 - SPARE) - reserve;
        self.peak.iter().zip(&self.reserve).map(limit).collect()
    }
}

impl TorqueScale {
    /// By joint, Ū over the joint's torque.
    pub(crate) fn shares(&self, multipliers: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        let of = |(i, peak): (usize, &f64)| multipliers(i).into_iter().map(|u| u / peak).collect();
        self.peak.iter().enumerate().map(of).collect()
    }
}
