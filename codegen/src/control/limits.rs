//! Whether the period and the drives bear what a guarantee supposes, and what is said where they do not.

use super::DesignProblem;
use super::error_envelope::ClosedLoop;
use super::first_step::{Start, asked};
use super::form::{Fastest, fastest, total};
use super::guarantee::Parts;
use super::inertia::{Cell, Inertia};
use super::verified::largest_eigenvalue;
use crate::number::{scientific, short};
use crate::numerics::linalg::dense;

/// The longest period, s, and whether nothing in the domain is faster than it supposes.
pub(super) struct Longest {
    pub(super) period: f64,
    pub(super) certified: bool,
}

impl Parts<'_> {
    /// What is said of bounds on D that are not certified and of the period.
    pub(super) fn period_reasons(&self, inertia_certified: bool, longest: &Longest) -> Vec<String> {
        let (period, most) = (self.tuning.period, longest.period);
        let narrow = "narrow the tube or the intervals of uncertainty";
        let said = [
            (!inertia_certified)
                .then(|| format!("the bounds on D over the domain could not be certified: {narrow}")),
            (period >= most).then(|| {
                let most = short(most);
                format!(
                    "the period of {} s is longer than {most} s, up to which the loop is shown to be stable at every D of the domain",
                    scientific(period)
                )
            }),
            (!longest.certified).then(|| {
                format!(
                    "the longest period of {} s could not be certified over the domain: {narrow}",
                    short(most)
                )
            }),
            self.feedforward.is_none().then(|| {
                "without a motion, limits of velocity and acceleration of each joint must say how fast the torque changes that \
                 is held for a period"
                    .to_string()
            }),
        ];
        said.into_iter().flatten().collect()
    }

    /// The largest share of a torque limit that the first step may ask of a joint, and what is said where a limit is below
    /// that or below what the motion itself takes.
    ///
    /// The first step asks the torque of the arm as specified, what its model is off by, and the switching terms.
    pub(super) fn drives(
        &self,
        closed_loop: &ClosedLoop,
        delta_c: &[Vec<f64>],
        delta_c1: &[Vec<f64>],
    ) -> (f64, Vec<String>) {
        let DesignProblem { arm, motion, bounds, control, .. } = *self.problem;
        let mut reasons = self.feedforward.map_or(Vec::new(), |taken| taken.beyond_limits(arm, self.coulomb));
        let limited = arm.joints.iter().any(|joint| joint.limits.torque.is_some());
        let Some(motion) = motion.filter(|_| limited) else { return (0.0, reasons) };
        let n = arm.dof();
        let crate::check::InitialError { position, velocity } = &self.problem.control.initial_error;
        let zero = vec![vec![0.0; n]; n];
        let more = if self.has_matrix() { delta_c1 } else { &zero };
        let target = motion.at(0.0);
        let start = Start { target: &target, position, velocity };
        let most = |x: &[f64]| x.iter().map(|x| x.abs()).collect::<Vec<_>>();
        let (rates, s) = closed_loop.rates_about(&most(&target.qd), &most(&target.qdd), position, velocity);
        let model = bounds.torque(&rates);
        let rho = match &closed_loop.fixed {
            Some(fixed) => fixed.rho.clone(),
            None => closed_loop.robust_gain(&rates, &s, delta_c),
        };
        let switching = |i: usize| match self.layer() {
            _ if !control.law.is_robust() => 0.0,
            Some(phi) => rho[i] * (s[i] / phi[i]).min(1.0),
            None => rho[i],
        };
        let friction = |i: usize| self.coulomb[i][0].max(-self.coulomb[i][1]);
        let total = |(i, asked): (usize, f64)| asked + model[i] + switching(i) + friction(i);
        let asked = asked(arm, self.gains, more, &start).into_iter().enumerate().map(total);
        let mut share = 0.0_f64;
        for (number, (asked, joint)) in (1..).zip(asked.zip(&arm.joints)) {
            let Some(limit) = joint.limits.torque else { continue };
            share = share.max(asked / limit);
            // What the motion itself takes beyond the limit has been said.
            let said = self
                .feedforward
                .is_some_and(|taken| taken.torque[number - 1] + friction(number - 1) >= limit);
            if asked >= limit && !said {
                reasons.push(format!(
                    "the initial errors may ask {} of joint {number} in the first step, its torque limit is {} {}",
                    short(asked),
                    scientific(limit),
                    joint.kind.torque_unit()
                ));
            }
        }
        (share, reasons)
    }

    /// The longest period that the whole gain on s and P12 allow.
    pub(super) fn longest_period(
        &self,
        inertia: &Inertia,
        over: Vec<Cell>,
        delta_c1: &[Vec<f64>],
        closed_loop: &ClosedLoop,
        gain: &[f64],
    ) -> Longest {
        let control = self.problem.control;
        let n = gain.len();
        let mut slope: Vec<f64> = match self.layer() {
            Some(phi) if control.law.is_robust() => {
                gain.iter().zip(phi).map(|(rho, phi)| rho / phi).collect()
            }
            _ => vec![0.0; n],
        };
        if let Some(learning) = &closed_loop.learning {
            // Stability of small motions: what learning does in large ones counts in the ultimate bound.
            let (rates, _) = closed_loop.rates(&vec![0.0; n], &vec![0.0; n]);
            let more = learning.gain(&rates, self.tuning.period);
            slope.iter_mut().zip(more).for_each(|(slope, more)| *slope += more);
        }
        let zero = vec![vec![0.0; n]; n];
        let more = if self.has_matrix() { delta_c1 } else { &zero };
        let pull = largest_eigenvalue(&dense(&self.gains.p12));
        let Fastest { rate, certified } = fastest(inertia, over, &total(&self.gains.damping, more, &slope));
        Longest { period: 2.0 / (rate + pull), certified }
    }
}
