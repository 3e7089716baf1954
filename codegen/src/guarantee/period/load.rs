//! What pushes the errors about during a period.

use super::super::enclosure::Enclosure;
use super::super::numbers::{ROUNDED, UP, ends, point, scale};
use super::Stop;
use super::sample::Sample;
use crate::numerics::linalg::weighed;

/// What pushes the errors about during a period, in torque.
pub(super) struct Load {
    /// Bound on the mean of what is not in the centre, by joint.
    pub(super) mean: Vec<f64>,
    /// Bound on it at any time, with what is known besides u, the uncertain numbers on the desired motion, `lag` and the trend; on the
    /// part of it that changes; and on the first with the trend.
    pub(super) most: Vec<f64>,
    pub(super) changing: Vec<f64>,
    pub(super) others: Vec<f64>,
    /// What the held torque lags behind at the end of the period at the middle of its rates: at any time a part of that, with one
    /// factor for all joints.
    pub(super) lag: Vec<f64>,
    /// Known to be there for the whole period: the middle of Coulomb friction.
    pub(super) middle: Vec<f64>,
}

/// Displacements during a period.
pub(super) struct Within {
    /// Bounds on |q_e|, then on |q̇_e|.
    pub(super) errors: Vec<f64>,
    /// The same of (q, q̇) from the desired state of the start.
    pub(super) away: Vec<f64>,
    /// Bounds on what q differs from that desired state by, with its speed until then.
    pub(super) strayed: Vec<f64>,
    /// Bounds on |q̈_e|, and on what it differs from its value at the start and the trend of the desired motion by.
    pub(super) acceleration: Vec<f64>,
    beyond: Vec<f64>,
    lambda: f64,
    /// The λ of the displacements of q alone.
    pub(super) lambda_q: f64,
}

impl Sample<'_> {
    /// How far the state may be from the desired one of the start, and how far the errors go, while q̈_e differs by no more than
    /// `beyond` from its value at the start, which is below `straight`, and the trend of the desired motion.
    pub(super) fn within(&self, straight: &[f64], beyond: &[f64]) -> Result<Within, Stop> {
        let Self { problem, local, n, .. } = *self;
        let pulled = &self.trend.pulled;
        let whole = |i: usize| UP * (straight[i] + problem.period * pulled[i].abs() + beyond[i]);
        let acceleration: Vec<f64> = (0..n).map(whole).collect();
        let t = problem.period;
        let span = &local.course.span;
        let mut errors = self.x.clone();
        let (mut away, mut strayed) = (vec![0.0; 2 * n], vec![0.0; n]);
        for i in 0..n {
            errors[i] += t * self.x[n + i] + 0.5 * t * t * acceleration[i];
            errors[n + i] += t * acceleration[i];
            let target = &local.course.target;
            away[i] = UP * errors[i] + (span.q[i] - point(target.q[i])).magnitude();
            let faster = (span.qd[i] - point(target.qd[i])).magnitude();
            away[n + i] = UP * errors[n + i] + faster;
            strayed[i] = UP * (errors[i] + local.course.apart[i] + t * faster) + ROUNDED * target.q[i].abs();
        }
        let lambda = scale(&away, &local.half);
        let lambda_q = scale(&away[..n], &local.half);
        if lambda > 1.0 {
            return Err(Stop::Beyond(away));
        }
        Ok(Within { errors, away, strayed, acceleration, beyond: beyond.to_vec(), lambda, lambda_q })
    }

    /// What pushes meanwhile.
    pub(super) fn load(&self, within: &Within) -> Load {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let mut load = Load {
            mean: Vec::with_capacity(n),
            most: Vec::with_capacity(n),
            others: Vec::with_capacity(n),
            lag: Vec::with_capacity(n),
            changing: Vec::with_capacity(n),
            middle: Vec::with_capacity(n),
        };
        let own = self.own_change(within);
        let numbers = problem.numbers.iter().zip(&local.added);
        let added: Vec<Vec<f64>> = numbers
            .map(|(number, added)| {
                let change = self.change(&added.enclosure, within);
                let whole = |(change, rate): (f64, &f64)| number.most() * (change + rate);
                change.into_iter().zip(&added.lag_rate).map(whole).collect()
            })
            .collect();
        for i in 0..n {
            let rate = own[i] + added.iter().map(|added| added[i]).sum::<f64>();
            let bend = local.lag.rate[i].high - local.lag.rate[i].low;
            let [low, high] = self.coulomb(i, within);
            let speed = local.course.span.qd[i].magnitude() + within.errors[n + i];
            let half = 0.5 * (high - low) + problem.viscous[i] * speed;
            let (mean, most) = (0.5 * t * rate + 0.25 * t * local.lag.off[i], t * rate + 0.25 * t * bend);
            let products = self.family.torque[i].size();
            let middle_rate = 0.5 * (local.lag.rate[i].low + local.lag.rate[i].high);
            let fed = self.fed[i];
            let half = half + 0.5 * (fed[1] - fed[0]);
            let middle = 0.5 * (fed[0] + fed[1]) - 0.5 * (low + high);
            load.mean.push(UP * (self.wrong[i] + half + mean + ends(local.lag.end[i])));
            let others = self.wrong[i] + half + t * rate + middle.abs() + 0.5 * t * bend + products;
            let trend = t * self.rates[i] + t * t * self.trend.bent[i].abs();
            load.others.push(UP * (others + trend));
            load.lag.push(t * middle_rate);
            load.most.push(UP * others);
            load.changing.push(UP * (2.0 * half + most + ends(local.lag.end[i])));
            load.middle.push(middle);
        }
        load
    }

    /// Bound on what d/dt(D a_r + n) differs by from that of the desired motion and the trend, by joint.
    fn own_change(&self, within: &Within) -> Vec<f64> {
        let Self { problem, local, n, .. } = *self;
        let Within { errors, away, acceleration, beyond, lambda, .. } = within;
        let arm = &local.arm;
        let grown: Vec<f64> = errors.iter().zip(&self.x).map(|(later, first)| later - first).collect();
        let moved = |i: usize, j: usize| arm.coriolis.change(i * n + j, away, *lambda);
        let row = |i: usize| {
            // The rate at the state less that on the desired motion: what is beyond the line counts for both.
            let mut sum = weighed(arm.rate.slopes(i), &grown) + 2.0 * arm.rate.beyond(i, *lambda);
            for j in 0..n {
                let (ij, ji) = (moved(i, j), moved(j, i));
                let slowed = weighed(&problem.gains.p12[j], &self.x[n..]);
                let late = local.course.late[j];
                sum += 2.0 * arm.coriolis.centre[i * n + j].abs() * beyond[j];
                sum += 2.0 * ij * acceleration[j] + 4.0 * ij * late + (ij + ji) * slowed;
            }
            sum + problem.arm.joints[i].viscous_friction * beyond[i]
        };
        (0..n).map(row).collect()
    }

    /// The same of what an uncertain number adds, without a trend.
    fn change(&self, arm: &Enclosure, within: &Within) -> Vec<f64> {
        let Self { problem, local, n, .. } = *self;
        let Within { errors, away, acceleration, lambda, .. } = within;
        let late = &local.course.late;
        let moved = |i: usize, j: usize| arm.coriolis.change(i * n + j, away, *lambda);
        let size = |i: usize, j: usize| arm.coriolis.centre[i * n + j].abs() + moved(i, j);
        let row = |i: usize| {
            let mut sum = weighed(arm.rate.slopes(i), errors) + 2.0 * arm.rate.beyond(i, *lambda);
            for j in 0..n {
                let (ij, ji) = (size(i, j), size(j, i));
                let slowed = weighed(&problem.gains.p12[j], &self.x[n..]);
                sum += 2.0 * ij * acceleration[j] + 4.0 * moved(i, j) * late[j] + (ij + ji) * slowed;
            }
            sum
        };
        (0..n).map(row).collect()
    }

    /// Range of the Coulomb friction of joint `i` during the period, N·m or N.
    fn coulomb(&self, i: usize, within: &Within) -> [f64; 2] {
        let [forwards, backwards] = self.problem.arm.joints[i].coulomb_friction;
        let (speed, error) = (self.local.course.span.qd[i], within.errors[self.n + i]);
        if speed.low > error {
            [forwards; 2]
        } else if speed.high < -error {
            [backwards; 2]
        } else {
            [backwards.min(forwards), forwards.max(backwards)]
        }
    }
}
