//! What rounding in f64 does to the torque of a law.
//!
//! The model rounds by what its bounds say. The law around it rounds by a few units of the last place of each part that it
//! adds. Positions and speeds come to it rounded: a speed that is taken from two positions a period apart is off by the
//! rounding of a position over the period, and so is the motion that a simulation adds up in short steps.

use super::{DesignProblem, Gains};
use crate::bounds::{Bounds, Rates, position_bound};
use crate::dynamics::Sizes;
use crate::numerics::linalg::weighed;

/// Half a unit of the last place of 1.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings of a position or a speed on the way into the law, a period of a simulation included.
const MEASURED: f64 = 16.0;
/// Roundings of a part of the law's torque on the way into the sum, times what the model may exceed that of the arm as
/// specified by.
const SUMMED: f64 = 64.0;

/// Bounds on what rounds, while the joints stay inside the domain.
pub(super) struct Rounding<'a> {
    /// Of the model's code.
    model: &'a Bounds,
    /// On the entries of D, h and G themselves.
    size: Bounds,
    /// On |q_j|, rad or m.
    position: Vec<f64>,
    /// Of the friction in the command, viscous by speed and Coulomb.
    viscous: Vec<f64>,
    coulomb: Vec<f64>,
}

/// The state in which a law rounds: bounds on its rates and by joint on |s|, |q_e| and ρ.
pub(super) struct Working<'a> {
    pub(super) gains: &'a Gains,
    pub(super) period: f64,
    pub(super) rates: &'a Rates,
    pub(super) s: &'a [f64],
    pub(super) position_error: &'a [f64],
    pub(super) robust_gain: &'a [f64],
}

impl<'a> Rounding<'a> {
    pub(super) fn new(problem: &DesignProblem<'a>, coulomb: &[[f64; 2]]) -> Self {
        let DesignProblem { arm, domain, rounding, .. } = *problem;
        let position = position_bound(domain);
        Self {
            model: rounding,
            size: Bounds::of_sizes(&Sizes::new(arm, &position)),
            viscous: arm.joints.iter().map(|joint| joint.viscous_friction).collect(),
            coulomb: coulomb.iter().map(|[forwards, backwards]| forwards.max(-backwards)).collect(),
            position,
        }
    }

    /// Bound on what rounding changes the law's torque by, by joint, N·m or N.
    pub(super) fn torque(&self, working: &Working) -> Vec<f64> {
        let Working { gains, period, rates, s, position_error, robust_gain } = *working;
        let n = self.position.len();
        let sum = |m: &[Vec<f64>], x: &[f64]| -> Vec<f64> { (0..n).map(|i| weighed(&m[i], x)).collect() };
        let off = |x: f64| MEASURED * UNIT * x;
        let q: Vec<f64> = self.position.iter().map(|&q| off(q)).collect();
        let qd: Vec<f64> =
            self.position.iter().zip(&rates.speed).map(|(q, speed)| off(q / period + speed)).collect();
        let pulled = sum(&gains.p12, &q);
        // s is off by this, and so is v_r.
        let s_off: Vec<f64> = qd.iter().zip(pulled).map(|(qd, pulled)| qd + pulled).collect();
        let a_off = sum(&gains.p12, &qd);
        let (along, across) = (self.size.coriolis(&rates.speed), self.size.coriolis(&rates.reference_speed));
        let model = self.model.torque(rates);
        // A position that is off by a part of itself turns what the model adds up by as much.
        let turned = 1.0 + self.position.iter().sum::<f64>();
        let parts = self.size.torque(rates);
        let of = |i: usize| {
            let friction = self.viscous[i].abs() * rates.speed[i] + self.coulomb[i];
            let fed = weighed(&gains.damping[i], s) + weighed(&gains.pqq[i], position_error);
            let summed = SUMMED * UNIT * (parts[i] * turned + fed + friction + robust_gain[i]);
            let measured = weighed(&gains.damping[i], &s_off)
                + weighed(&gains.pqq[i], &q)
                + weighed(&self.size.d[i], &a_off)
                + weighed(&along[i], &s_off)
                + weighed(&across[i], &qd);
            model[i] + summed + measured
        };
        (0..n).map(of).collect()
    }
}
