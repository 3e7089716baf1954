//! One period of the sampled loop: the set of errors at its end from that at its start.
//!
//! With x = (q_e, v) at the sample, q̈_e(t) = −P12 v + D(t)⁻¹ w(t) + (q̈_d − q̈_d(t)), w = u + what is wrong + what the held torque
//! lags behind, and u = Pqq q_e − (K + C) s − σρ. See `docs/method.md`, section 9.

mod family;
mod inertia;
mod load;
mod moved;
mod sample;
mod switching;
mod trend;

use super::local::Local;
use super::numbers::{ROUNDED, UP, product};
use super::problem::{Problem, Wrong};
use super::set::ErrorSet;
use crate::numerics::linalg::weighed;
use load::Load;
use sample::{Sample, control};
use switching::switched;

/// Most rounds in which |q̈_e| within a period must be enclosed.
const ROUNDS: usize = 12;

/// Why a set at the end of a period is not known.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stop {
    /// The displacements may leave the box that the dynamics were enclosed for: of q, then of q̇.
    Beyond(Vec<f64>),
    /// D may change too much over the set.
    Inertia,
    /// No bound on the acceleration of the errors is found.
    Acceleration,
}

/// What happens during a period.
#[derive(Clone, Debug)]
pub(super) struct During {
    /// Bound on |q̈_e|.
    pub(super) acceleration: Vec<f64>,
    /// Range of the torque that the law asks for, by joint, N·m or N.
    pub(super) torque: Vec<[f64; 2]>,
}

impl ErrorSet {
    /// The set after the period of `local`; `step` is what the torque of its start is wrong by, `guess` a guess of |q̈_e|.
    pub(super) fn advance(
        &mut self,
        problem: &Problem,
        step: &Wrong,
        local: &Local,
        guess: &[f64],
    ) -> Result<During, Stop> {
        let sample = Sample::new(problem, step, local, self)?;
        let torque = sample.torque(self);
        let (acceleration, load, turned) = sample.enclosed(self, guess)?;
        sample.moved(self, &load, &turned);
        Ok(During { acceleration, torque })
    }

    /// The linear map from sample to sample in the period of `local`, with the switching term as for this set.
    pub(super) fn frozen(&self, problem: &Problem, step: &Wrong, local: &Local) -> Vec<Vec<f64>> {
        let n = problem.arm.dof();
        let (x, s) = (self.hull(), self.turned_hull(problem.gains).split_off(n));
        let line = switched(problem, step, local, &x, &s).0;
        moved::held(problem, &product(&local.inverse, &control(problem, local, &line)))
    }
}

impl Sample<'_> {
    /// A bound on |q̈_e| during the period that holds by itself, what pushes, and what the change of D makes of it.
    fn enclosed(&self, set: &ErrorSet, guess: &[f64]) -> Result<(Vec<f64>, Load, Vec<f64>), Stop> {
        let Self { problem, local, n, .. } = *self;
        let pulled: Vec<Vec<f64>> = product(&local.inverse, &self.control)
            .into_iter()
            .zip(&problem.gains.p12)
            .map(|(mut row, p12)| {
                row[n..].iter_mut().zip(p12).for_each(|(x, p)| *x -= p);
                row
            })
            .collect();
        let mut straight = set.image(&pulled);
        self.family.drive(problem, &mut straight, None);
        let straight = straight.sizes();
        let by_slopes: Vec<Vec<f64>> =
            local.slopes.iter().map(|slopes| self.pushed.sizes_under(&slopes.left)).collect();
        let follows = |beyond: &[f64]| {
            let within = self.within(&straight, beyond)?;
            let load = self.load(&within);
            let turned = self.turned(&within, &load, &by_slopes)?;
            let next = (0..n).map(|i| self.beyond_start(i, &load, &turned));
            Ok((next.collect::<Vec<f64>>(), within.acceleration, load, turned))
        };
        let mut beyond: Vec<f64> =
            (0..n).map(|i| 1.2 * (guess[i] - straight[i]).max(0.1 * straight[i])).collect();
        for _ in 0..ROUNDS {
            let (next, ..) = follows(&beyond)?;
            if next.iter().zip(&beyond).all(|(next, bound)| next <= bound) {
                // The bound that follows holds as well, and what follows from that is smaller.
                let (_, acceleration, load, turned) = follows(&next)?;
                return Ok((acceleration, load, turned));
            }
            if !next.iter().all(|x| x.is_finite()) {
                return Err(Stop::Acceleration);
            }
            for (bound, next) in beyond.iter_mut().zip(next) {
                *bound = 1.2 * bound.max(next);
            }
        }
        Err(Stop::Acceleration)
    }

    /// Bound on what q̈_e differs from its value at the start, without products, and the trend of the desired motion by.
    fn beyond_start(&self, i: usize, load: &Load, turned: &[f64]) -> f64 {
        let Self { problem, local, .. } = *self;
        let (t, trend) = (problem.period, &self.trend);
        let known = |j: usize| t * self.rates[j] + t * t * trend.bent[j].abs();
        let torque: Vec<f64> = (0..self.n).map(|j| load.most[j] + known(j)).collect();
        let inertia: Vec<f64> = (0..self.n).map(|j| turned[j] + self.known_turned(j)).collect();
        let pushed = weighed(&local.inverse[i], &torque) + weighed(&local.w[i], &inertia);
        UP * (pushed + local.course.uneven[i] + self.rounded(i) + t * trend.rounded[i])
    }

    /// What −P12 v + D⁻¹u of the start rounds by.
    fn rounded(&self, i: usize) -> f64 {
        let Self { problem, local, n, .. } = *self;
        let sizes = &local.inverse_size[i];
        let pushed: f64 = sizes.iter().zip(&self.control).map(|(m, row)| m * weighed(row, &self.x)).sum();
        ROUNDED * (pushed + weighed(&problem.gains.p12[i], &self.x[n..]))
    }
}
