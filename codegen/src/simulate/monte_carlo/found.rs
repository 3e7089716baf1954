//! The largest of all runs.

use serde::Serialize;

use super::run::{Instants, Outcome};

/// The largest errors and torques that any run has shown, by joint: found, not proved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MonteCarlo {
    /// Number of runs.
    pub runs: usize,
    /// Largest |q_e| at any control instant, rad or m.
    pub reach: Vec<f64>,
    /// Largest |q_e| from the first of [`MonteCarlo::times`] on, rad or m.
    pub settled_error: Vec<f64>,
    /// Largest |q_e| where the motion ends, rad or m.
    pub end_error: Vec<f64>,
    /// Largest |τ| that was commanded, N·m or N, within the limits.
    pub torque_max: Vec<f64>,
    /// Runs that could not go on to their end; the errors above hold what they came to.
    #[serde(skip_serializing_if = "is_zero")]
    pub lost: usize,
    /// Runs in which a torque limit has cut a command.
    #[serde(skip)]
    pub cut: usize,
    /// Runs in which the model was wrong by more than its bound: outside the domain, or at higher rates.
    #[serde(skip)]
    pub beyond: usize,
    /// From when on an error counts as settled, when the motion ends, and how long a run lasts, s.
    #[serde(skip)]
    pub times: [f64; 3],
    /// For a picture.
    #[serde(skip)]
    pub picture: Picture,
}

/// Errors over time, in parts of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Where each part begins, s.
    pub time: Vec<f64>,
    /// By part and joint, the largest |q_e| of all runs, rad or m.
    pub largest: Vec<Vec<f64>>,
    /// By joint the runs with the largest |q_e| of all and from settling on: by part and joint the q_e of largest
    /// magnitude, rad or m.
    pub runs: Vec<[Vec<Vec<f64>>; 2]>,
}

/// True for no run.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl MonteCarlo {
    /// Of no run yet, for `n` joints and control periods of `period`, s.
    pub(super) fn new(n: usize, instants: &Instants, period: f64) -> Self {
        let parts = instants.steps / instants.part + 1;
        let at = |step: usize| step as f64 * period;
        Self {
            runs: 0,
            reach: vec![0.0; n],
            settled_error: vec![0.0; n],
            end_error: vec![0.0; n],
            torque_max: vec![0.0; n],
            lost: 0,
            cut: 0,
            beyond: 0,
            times: [at(instants.settle), at(instants.end), at(instants.steps)],
            picture: Picture {
                time: (0..parts).map(|part| at(part * instants.part)).collect(),
                largest: vec![vec![0.0; n]; parts],
                runs: vec![[const { Vec::new() }; 2]; n],
            },
        }
    }

    /// Takes in one run more.
    pub(super) fn take<const N: usize>(&mut self, outcome: &Outcome<N>) {
        let first = self.runs == 0;
        self.runs += 1;
        self.lost += usize::from(outcome.lost);
        self.cut += usize::from(outcome.cut);
        self.beyond += usize::from(outcome.beyond);
        for i in 0..N {
            let larger = [outcome.reach[i] > self.reach[i], outcome.settled[i] > self.settled_error[i]];
            for (kept, larger) in self.picture.runs[i].iter_mut().zip(larger) {
                if larger || first {
                    *kept = outcome.peaks.iter().map(|peaks| peaks.to_vec()).collect();
                }
            }
        }
        for (all, one) in [
            (&mut self.reach, &outcome.reach),
            (&mut self.settled_error, &outcome.settled),
            (&mut self.end_error, &outcome.end),
            (&mut self.torque_max, &outcome.torque),
        ] {
            raise(all, one);
        }
        self.picture.largest.iter_mut().zip(&outcome.peaks).for_each(|(all, one)| raise(all, one));
    }
}

/// The larger of both by joint.
fn raise(all: &mut [f64], one: &[f64]) {
    all.iter_mut().zip(one).for_each(|(all, one)| *all = all.max(one.abs()));
}
