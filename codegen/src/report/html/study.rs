//! One size of the model with all that its figures need.

use crate::error::Error;
use crate::guarantee::Sampled;
use crate::pipeline::Generation;
use crate::progress::{Progress, Stage};
use crate::simulate::{
    Comparison, MonteCarlo, MonteCarloRequest, SETTLE, Scenario, largest_torque_error, monte_carlo, simulate,
};

/// One size of the model, generated, simulated and searched.
#[derive(Clone, Debug)]
pub struct Study {
    /// A short name, such as `exact` or `xi 6`.
    pub label: String,
    /// Everything that follows from the specification at this size.
    pub generation: Generation,
    /// The text of its module.
    pub(super) module: String,
    /// The closed loop; `None` without motion or controller.
    pub(super) comparison: Option<Comparison>,
    /// The largest errors of many runs; `None` without motion or controller, or where none were asked for.
    pub(super) found: Option<MonteCarlo>,
    /// The largest torque error found by joint, N·m or N.
    pub(super) torque_found: Option<Vec<f64>>,
}

impl Study {
    /// Simulates `generation` and seeks its largest errors in so many `runs`.
    ///
    /// # Errors
    /// As [`simulate`] and [`Generation::module`].
    pub fn new(
        label: String,
        generation: Generation,
        runs: usize,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let _stage = Stage::new(progress, "simulation for the report", 1);
        let module = generation.module()?;
        let closed = generation.motion().is_some() && generation.design().is_some();
        let scenario = if closed { Some(Scenario::of(&generation)?) } else { None };
        let comparison = scenario.as_ref().map(simulate).transpose()?;
        let found = match &scenario {
            Some(scenario) if runs > 0 => {
                let request = MonteCarloRequest::of(&generation, runs, settle(&generation));
                Some(monte_carlo(scenario, &request, progress)?)
            }
            _ => None,
        };
        let torque_found = largest_torque_error(&generation);
        Ok(Self { label, module, comparison, found, torque_found, generation })
    }

    /// What is promised of the sampled loop.
    pub(super) fn promised(&self) -> Option<&Sampled> {
        self.generation.statement().and_then(|statement| statement.promised())
    }
}

/// When errors count as settled, s.
fn settle(generation: &Generation) -> f64 {
    let asked = generation.control().and_then(|control| control.settle);
    let proved = generation.statement().and_then(|statement| statement.sampled.as_ref());
    asked.or(proved.map(|sampled| sampled.settle)).unwrap_or(SETTLE)
}
