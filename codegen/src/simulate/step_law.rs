//! The step graph as a law that the runtime's loop can drive.

use std::array::from_fn;

use gramforge_runtime::law::{Law, Sample};
use gramforge_runtime::{Estimate, Model};

use crate::control::{Adaptation, StepGraph};
use crate::graph::Tape;
use crate::trig::Angle;

/// Most parameters of a law that learns in a simulation.
pub const MOST_LEARNT: usize = 512;

/// A control step in the form of its graph, interpreted in `T`: the numbers of the generated code, bit by bit.
#[derive(Clone)]
pub(super) struct StepLaw<T> {
    /// Outputs: the torques before they are limited, which the loop does, then what the period takes off the parameters.
    code: Tape<T>,
    /// Lowest, highest and first θ̂, padded with zeros.
    low: Padded<T>,
    high: Padded<T>,
    initial: Padded<T>,
}

type Padded<T> = [T; MOST_LEARNT];

impl<T: Angle> StepLaw<T> {
    /// The law of `step`, which learns at most [`MOST_LEARNT`] parameters.
    pub(super) fn new(step: &StepGraph, adaptation: Option<&Adaptation>) -> Self {
        let mut code = step.code.clone();
        code.outputs.truncate(step.joints + step.parameters);
        code.outputs.splice(..step.joints, step.asked());
        let of = |list: fn(&Adaptation) -> &Vec<f64>| padded(adaptation.map_or(&[], |all| list(all)));
        Self {
            code: Tape::new(&code),
            low: of(|a| &a.low),
            high: of(|a| &a.high),
            initial: of(|a| &a.initial),
        }
    }
}

fn padded<T: Angle>(x: &[f64]) -> Padded<T> {
    from_fn(|k| x.get(k).map_or(T::ZERO, |&x| T::from_f64(x)))
}

impl<T: Angle, M: Model<N, Scalar = f64>, const N: usize> Law<M, N> for StepLaw<T> {
    type State = Estimate<T, MOST_LEARNT>;

    fn initial_state(&self) -> Self::State {
        Estimate::new(self.initial)
    }

    fn torque(&self, _model: &M, state: &mut Self::State, sample: &Sample<f64, N>) -> [f64; N] {
        let own = |x: &[f64; N]| x.map(T::from_f64);
        let desired = [&sample.desired.q, &sample.desired.qd, &sample.desired.qdd].map(own);
        let desired = desired.each_ref().map(<[T; N]>::as_slice);
        let out = self.code.interpret_step(&own(&sample.q), &own(&sample.qd), desired, state.theta());
        let correction = from_fn(|k| out.get(N + k).copied().unwrap_or(T::ZERO));
        state.correct(&correction, &self.low, &self.high);
        from_fn(|i| out.get(i).map_or(f64::NAN, |x| x.to_f64()))
    }

    // The design was checked when it was made.
    fn check(&self) -> Result<(), gramforge_runtime::ConfigError> {
        Ok(())
    }
}
