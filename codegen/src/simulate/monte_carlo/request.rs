//! What many runs are asked to seek.

use super::family::Family;
use super::push::{Against, BoundAtState, ModelErrorBound};
use crate::pipeline::Generation;
use crate::spec::{LawSpec, ScalarSpec};

/// Time after which an error counts as settled where nothing else is said, s.
pub const SETTLE: f64 = 2.0;

/// What many runs are asked to seek.
#[derive(Clone, Debug)]
pub struct MonteCarloRequest<'a> {
    /// Number of runs; the first of a longer list are those of a shorter one.
    pub runs: usize,
    /// Time after which an error counts as settled, s.
    pub settle: f64,
    /// The arms that a run may meet.
    pub family: Family<'a>,
    /// What the emitted model is wrong by at most.
    pub model_error: ModelErrorBound,
}

impl<'a> MonteCarloRequest<'a> {
    /// `runs` runs with what `generation` publishes: its family, and the torque error of its model at the rates that the
    /// law meets, or where nothing holds the errors, at the motion's own; where the entries of D, h and G tell less at the
    /// state of the instant, that, and never more than the guarantee was made for. An exact model errs by rounding alone: what
    /// uncertain numbers do, the arms of the family do themselves. No disturbance is added for a law that learns: its
    /// model has no fixed error.
    pub fn of(generation: &'a Generation, runs: usize, settle: f64) -> Self {
        let (arm, uncertainty) = (generation.given(), generation.given_uncertainty());
        let spec = generation.spec().control.as_ref().and_then(|control| control.uncertainty.as_ref());
        let viscous = spec.map_or(&[][..], |spec| &spec.viscous_friction);
        let change = |(range, joint): (&Option<[f64; 2]>, &crate::arm::Joint)| {
            range.map_or([0.0; 2], |range| range.map(|value| value - joint.viscous_friction))
        };
        let learns = generation.design().is_some_and(|design| design.law == LawSpec::Adaptive);
        let exact =
            generation.reduced().is_exact() && generation.code().sines.rounds() && generation.arm() == arm;
        let (met, torque) = (generation.met(), generation.torque());
        let published = match exact {
            true => torque.map(|torque| &torque.rounding),
            false => met.map(|met| &met.error).or(torque.map(|torque| &torque.error)),
        };
        let sampled = generation.statement().and_then(|statement| statement.sampled.as_ref());
        Self {
            runs,
            settle,
            model_error: ModelErrorBound {
                followed: sampled.map_or_else(Vec::new, |sampled| sampled.torque_error.clone()),
                at_state: torque.filter(|_| !exact && !learns).map(|torque| BoundAtState {
                    entries: generation.bounds().clone(),
                    rounding: torque.rounding.clone(),
                }),
                torque: published.filter(|_| !learns).cloned().unwrap_or_else(|| vec![0.0; arm.dof()]),
                against: match (exact, generation.spec().emit.scalar) {
                    _ if learns => Against::Exact,
                    (true, ScalarSpec::F64) => Against::Exact,
                    (true, ScalarSpec::F32) => Against::Specified,
                    (false, _) => Against::Family,
                },
            },
            family: Family {
                arm,
                uncertainty,
                viscous: viscous.iter().zip(&arm.joints).map(change).collect(),
            },
        }
    }
}
