//! What rounding in f64 does to the torque of a law.
//!
//! The model rounds by what its bounds say. The law around it rounds by a few units of the last place of each part that it
//! adds. Positions and speeds come to it rounded: a speed that is taken from two positions a period apart is off by the
//! rounding of a position over the period, and so is the motion that a simulation adds up in short steps.

use super::{Design, DesignProblem, Gains};
use crate::arm::JointKind;
use crate::bounds::{Bounds, Rates, position_bound};
use crate::dynamics::Sizes;
use crate::motion::ReferenceError;
use crate::numerics::linalg::weighed;
use crate::numerics::rounded::Format;

/// Half a unit of the last place of 1.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings of a position or a speed on the way into the law, a period of a simulation included.
const MEASURED: f64 = 16.0;
/// Roundings of a part of the law's torque on the way into the sum, times what the model may exceed that of the arm as
/// specified by.
const SUMMED: f64 = 64.0;

/// Roundings of the model's torque by the rounding of a position: the order of D in sines and cosines of one joint, 2, times
/// what the model may exceed that of the arm as specified by.
const TURNED: f64 = 8.0;

/// What a step in f32 rounds by, beside what its law does in f64.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleRounding {
    /// The step itself, by joint, N·m or N.
    pub step: Vec<f64>,
    /// The largest |s| of which it may change the sign, rad/s or m/s.
    pub sign: f64,
    /// The desired motion.
    pub reference: ReferenceError,
}

/// Errors of a loop, and the rates that they go with.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopErrors {
    /// Largest |q̇|, |v_r| and |a_r|.
    pub rates: Rates,
    /// Largest |q_e| by joint, rad or m.
    pub position: Vec<f64>,
    /// Largest |s| by joint, rad/s or m/s.
    pub s: Vec<f64>,
}

/// Bounds on what rounding changes the torque of `design` by, by joint, N·m or N, and on what s is off by where the law takes its
/// side, rad/s or m/s, for errors up to these and a switching gain up to `robust_gain`.
pub fn loop_rounding(
    problem: &DesignProblem,
    design: &Design,
    errors: &LoopErrors,
    robust_gain: &[f64],
) -> [Vec<f64>; 2] {
    let rounding = Rounding::new(problem, &design.coulomb);
    let working = Working {
        gains: &design.gains,
        period: design.period,
        rates: &errors.rates,
        s: &errors.s,
        position_error: &errors.position,
        robust_gain,
    };
    [rounding.torque(&working), rounding.s_error(&working)]
}

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
    /// Of a step in f32.
    single: Option<&'a SingleRounding>,
    /// The same for a position that is off by one unit of f32, over its own torque.
    turned: f64,
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
        let DesignProblem { arm, domain, rounding, single, .. } = *problem;
        let position = position_bound(domain);
        let turned = arm.joints.iter().zip(&position).map(|(joint, q)| match joint.kind {
            JointKind::Revolute => *q,
            JointKind::Prismatic => 1.0,
        });
        Self {
            model: rounding,
            single,
            turned: turned.sum(),
            size: Bounds::of_sizes(&Sizes::new(arm, &position)),
            viscous: arm.joints.iter().map(|joint| joint.viscous_friction).collect(),
            coulomb: coulomb.iter().map(|[forwards, backwards]| forwards.max(-backwards)).collect(),
            position,
        }
    }

    /// Bound on what rounding changes the law's torque by, by joint, N·m or N.
    pub(super) fn torque(&self, working: &Working) -> Vec<f64> {
        let double = self.double(working);
        let Some(single) = self.single else { return double };
        let unit = Format::SINGLE.unit;
        let [q, qd] = self.inputs(single, working.rates);
        let measured = self.measured(working, &q, &qd, &single.reference[2]);
        let parts = self.size.torque(working.rates);
        let all = double.iter().zip(&single.step).zip(measured).zip(parts);
        all.map(|(((double, step), measured), parts)| {
            double + step + measured + TURNED * unit * self.turned * parts
        })
        .collect()
    }

    /// Bound by joint on |s| where a law may take the wrong sign of it, rad/s or m/s. In f64 0: the step and its inputs are as good
    /// as exact.
    pub(super) fn wrong_sign(&self, gains: &Gains, rates: &Rates) -> Vec<f64> {
        let Some(single) = self.single else { return vec![0.0; self.position.len()] };
        let [q, qd] = self.inputs(single, rates);
        let pulled = gains.p12.iter().map(|row| weighed(row, &q));
        qd.iter().zip(pulled).map(|(qd, pulled)| single.sign + qd + pulled).collect()
    }

    /// What q and q̇ are off by less than q_d and q̇_d: measurements are rounded once on the way into the step.
    fn inputs(&self, single: &SingleRounding, rates: &Rates) -> [Vec<f64>; 2] {
        let [q_d, qd_d, _] = &single.reference;
        let rounded = |x: &[f64], more: &[f64]| -> Vec<f64> {
            x.iter().zip(more).map(|(x, more)| Format::SINGLE.unit * x + more).collect()
        };
        [rounded(&self.position, q_d), rounded(&rates.speed, qd_d)]
    }

    /// What the law's torque changes by where q, q̇ and q̈_d are off by these, D, C and G as they are.
    fn measured(&self, working: &Working, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
        let Working { gains, rates, .. } = *working;
        let n = q.len();
        let sum = |m: &[Vec<f64>], x: &[f64]| -> Vec<f64> { (0..n).map(|i| weighed(&m[i], x)).collect() };
        // s is off by this, and so is v_r.
        let s: Vec<f64> = qd.iter().zip(sum(&gains.p12, q)).map(|(qd, pulled)| qd + pulled).collect();
        let a: Vec<f64> = sum(&gains.p12, qd).iter().zip(qdd).map(|(slowed, qdd)| slowed + qdd).collect();
        let (along, across) = (self.size.coriolis(&rates.speed), self.size.coriolis(&rates.reference_speed));
        let of = |i: usize| {
            weighed(&gains.damping[i], &s)
                + weighed(&gains.pqq[i], q)
                + weighed(&self.size.d[i], &a)
                + weighed(&along[i], &s)
                + weighed(&across[i], qd)
        };
        (0..n).map(of).collect()
    }

    /// Bound by joint on what s is off by where the law takes its side, rad/s or m/s.
    fn s_error(&self, working: &Working) -> Vec<f64> {
        let [q, qd] = self.double_inputs(working);
        let pulled = working.gains.p12.iter().map(|row| weighed(row, &q));
        let double = qd.iter().zip(pulled).map(|(qd, pulled)| qd + pulled);
        let single = self.wrong_sign(working.gains, working.rates);
        double.zip(single).map(|(double, single)| double + single).collect()
    }

    /// What q and q̇ are off by on the way into a law in f64.
    fn double_inputs(&self, working: &Working) -> [Vec<f64>; 2] {
        let off = |x: f64| MEASURED * UNIT * x;
        let speed = &working.rates.speed;
        let q = self.position.iter().map(|&q| off(q)).collect();
        [q, self.position.iter().zip(speed).map(|(q, speed)| off(q / working.period + speed)).collect()]
    }

    /// What rounding changes the torque of a law in f64 by.
    fn double(&self, working: &Working) -> Vec<f64> {
        let Working { gains, rates, s, position_error, robust_gain, .. } = *working;
        let n = self.position.len();
        let [q, qd] = self.double_inputs(working);
        let measured = self.measured(working, &q, &qd, &vec![0.0; n]);
        let model = self.model.torque(rates);
        // A position that is off by a part of itself turns what the model adds up by as much.
        let turned = 1.0 + self.position.iter().sum::<f64>();
        let parts = self.size.torque(rates);
        let of = |i: usize| {
            let friction = self.viscous[i].abs() * rates.speed[i] + self.coulomb[i];
            let fed = weighed(&gains.damping[i], s) + weighed(&gains.pqq[i], position_error);
            let summed = SUMMED * UNIT * (parts[i] * turned + fed + friction + robust_gain[i]);
            model[i] + summed + measured[i]
        };
        (0..n).map(of).collect()
    }
}
