//! One arm under one law.

use gramforge_runtime::law::{Law, Sample, lyapunov};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::{ConfigError, Controller, Estimate, Gains, Model, Real, Settings};
use serde::Serialize;

use super::metrics::Metrics;
use super::models::ArmModel;
use super::reference::MotionReference;

/// What happened at the control instants k·T, k = 0, 1, …: all lists of a trace run parallel.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Trace {
    /// Time, s.
    pub time: Vec<f64>,
    /// q_e = q − q_d, one entry a joint, rad or m.
    pub position_error: Vec<Vec<f64>>,
    /// Torque or force held from this instant to the next, one entry a joint, N·m or N.
    pub torque: Vec<Vec<f64>>,
    /// V of equation (12) with the plant's own D, J.
    pub lyapunov: Vec<f64>,
    /// What the law has learnt before this instant, one entry a parameter; empty for a law that does not learn.
    pub parameters: Vec<Vec<f64>>,
}

/// What a law remembers, as numbers.
pub(super) trait Memory {
    fn parameters(&self) -> impl Iterator<Item = f64>;
}

impl Memory for () {
    fn parameters(&self) -> impl Iterator<Item = f64> {
        std::iter::empty()
    }
}

impl<T: Real, const P: usize> Memory for Estimate<T, P> {
    fn parameters(&self) -> impl Iterator<Item = f64> {
        self.theta().iter().map(|theta| theta.to_f64())
    }
}

/// A simulated run: the numbers that sum it up, and the trace they were taken from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Summary.
    pub metrics: Metrics,
    /// What happened at each control instant.
    pub trace: Trace,
}

impl Run {
    /// The mean of |τ_k+1 − τ_k| beside the largest |τ|, of the joint where that is most: what chatter raises.
    pub fn relative_step(&self) -> f64 {
        let steps = self.trace.time.len().max(2) as f64 - 1.0;
        let pairs = self.metrics.torque_total_variation.iter().zip(&self.metrics.peak_torque);
        pairs.map(|(variation, peak)| variation / steps / peak).fold(0.0, f64::max)
    }
}

/// The plant, and how it is driven, whatever the law.
pub(super) struct Rig<'a, const N: usize> {
    pub(super) plant: ArmModel<'a, N>,
    /// Coulomb friction of the plant, [forwards, backwards], N·m or N.
    pub(super) coulomb: [[f64; 2]; N],
    pub(super) reference: MotionReference<'a, N>,
    /// Errors at time 0.
    pub(super) initial: JointState<f64, N>,
    pub(super) gains: Gains<f64, N>,
    pub(super) settings: Settings<f64, N>,
    pub(super) substeps: u32,
    /// Control periods to simulate.
    pub(super) steps: u32,
}

/// A position error this much larger than the initial one, rad or m, is a lost arm: a full turn.
pub(super) const LOST: f64 = 2.0 * std::f64::consts::PI;

impl<const N: usize> Rig<'_, N> {
    /// Drives the plant by a law that knows `model` and learns `learnt` parameters.
    ///
    /// # Errors
    /// The runtime's, where a number of law, settings or substeps cannot be used.
    pub(super) fn run<M, L>(&self, model: M, law: L, learnt: usize) -> Result<Run, ConfigError>
    where
        M: Model<N, Scalar = f64>,
        L: Law<M, N, State: Memory>,
    {
        let mut controller = Controller::new(model, law, self.settings)?;
        let plant = RigidPlant { model: &self.plant, coulomb: self.coulomb };
        let desired = self.reference.at(0.0);
        let start = JointState {
            q: std::array::from_fn(|i| desired.q[i] + self.initial.q[i]),
            qd: std::array::from_fn(|i| desired.qd[i] + self.initial.qd[i]),
        };
        let mut simulation = Simulation::new(plant, start, self.settings.period, self.substeps)?;
        let mut trace = Trace::default();
        let (mut saturated_steps, mut faulted_steps, mut diverged_at) = (0, 0, None);
        let lost = self.initial.q.iter().fold(LOST, |lost, e| lost.max(LOST + e.abs()));
        // One instant more than there are periods, so that the trace ends at the end.
        for _ in 0..=self.steps {
            let now = simulation.time();
            let parameters = controller.law_state().parameters().take(learnt).collect();
            let Ok(record) = simulation.step(&mut controller, &self.reference) else {
                diverged_at = Some(now);
                break;
            };
            let error: [f64; N] = std::array::from_fn(|i| record.state.q[i] - record.desired.q[i]);
            let torque = match record.command {
                Ok(command) => {
                    saturated_steps += usize::from(command.saturated.contains(&true));
                    command.torque
                }
                Err(fault) => {
                    faulted_steps += 1;
                    fault.command
                }
            };
            let JointState { q, qd } = record.state;
            let sample = Sample { q, qd, desired: record.desired, period: self.settings.period };
            trace.time.push(record.time);
            trace.position_error.push(error.to_vec());
            trace.torque.push(torque.to_vec());
            trace.parameters.push(parameters);
            trace.lyapunov.push(lyapunov(&self.plant, &self.gains, &sample));
            if error.iter().any(|e| e.abs() > lost) {
                diverged_at = Some(now);
                break;
            }
        }
        let metrics = Metrics::new(&trace, N, saturated_steps, faulted_steps, diverged_at);
        Ok(Run { metrics, trace })
    }
}
