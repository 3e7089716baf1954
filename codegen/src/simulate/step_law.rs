//! The step graph as a law that the runtime's loop can drive.

use std::array::from_fn;

use gramforge_runtime::Model;
use gramforge_runtime::law::{Law, Sample};

use super::run::Memory;
use crate::control::StepGraph;
use crate::graph::Tape;
use crate::spec::ScalarSpec;

/// Most parameters of a law that learns in a simulation.
pub const MOST_LEARNT: usize = 512;

/// A control step in the form of its graph, interpreted: the numbers of the generated code, bit by bit.
#[derive(Clone)]
pub(super) struct StepLaw {
    code: Interpreter,
    learnt: usize,
    initial: Learnt,
}

/// The graph in the number type of the module. Outputs: the torques before they are limited, which the loop does, then the
/// parameters after the period.
#[derive(Clone)]
enum Interpreter {
    Double(Tape<f64>),
    Single(Tape<f32>),
}

/// θ̂, padded with zeros.
#[derive(Clone, Copy)]
pub(super) struct Learnt([f64; MOST_LEARNT]);

impl Memory for Learnt {
    fn parameters(&self) -> &[f64] {
        &self.0
    }
}

impl StepLaw {
    /// The law of `step`, whose parameters start at `initial`: at most [`MOST_LEARNT`].
    pub(super) fn new(step: &StepGraph, initial: &[f64], scalar: ScalarSpec) -> Self {
        let mut code = step.code.clone();
        code.outputs.splice(..step.joints, step.asked());
        Self {
            code: match scalar {
                ScalarSpec::F64 => Interpreter::Double(Tape::new(&code)),
                ScalarSpec::F32 => Interpreter::Single(Tape::new(&code)),
            },
            learnt: step.parameters,
            initial: Learnt(from_fn(|k| initial.get(k).copied().unwrap_or(0.0))),
        }
    }
}

impl<M: Model<N, Scalar = f64>, const N: usize> Law<M, N> for StepLaw {
    type State = Learnt;

    fn initial_state(&self) -> Learnt {
        self.initial
    }

    fn torque(&self, _model: &M, state: &mut Learnt, sample: &Sample<f64, N>) -> [f64; N] {
        let desired = &sample.desired;
        let desired = [desired.q.as_slice(), &desired.qd, &desired.qdd];
        let out = match &self.code {
            Interpreter::Double(code) => code.interpret_step(&sample.q, &sample.qd, desired, &state.0),
            Interpreter::Single(code) => {
                let single = |x: &[f64]| -> Vec<f32> { x.iter().map(|&x| x as f32).collect() };
                let [q_d, qd_d, qdd_d] = desired.map(single);
                let desired = [q_d.as_slice(), &qd_d, &qdd_d];
                let theta = single(state.0.get(..self.learnt).unwrap_or(&state.0));
                let out = code.interpret_step(&single(&sample.q), &single(&sample.qd), desired, &theta);
                out.into_iter().map(f64::from).collect()
            }
        };
        for (theta, &next) in state.0.iter_mut().zip(out.iter().skip(N).take(self.learnt)) {
            // NaN is not taken.
            if next.is_finite() {
                *theta = next;
            }
        }
        from_fn(|i| out.get(i).copied().unwrap_or(f64::NAN))
    }

    // The design was checked when it was made.
    fn check(&self) -> Result<(), gramforge_runtime::ConfigError> {
        Ok(())
    }
}
