//! One size of the model with all that its figures need.

use crate::error::Error;
use crate::guarantee::Sampled;
use crate::load::Loaded;
use crate::pipeline::Generation;
use crate::progress::{Progress, Stage};
use crate::simulate::{
    Comparison, MonteCarlo, MonteCarloRequest, SETTLE, Scenario, largest_torque_error, monte_carlo, simulate,
};
use crate::sizes::{Row, Size, run};
use crate::spec::{DictionarySpec, ModelSpec};

/// How much is computed for a report.
#[derive(Clone, Copy, Debug)]
pub struct ReportEffort {
    /// Runs that seek the largest errors of each size.
    pub runs: usize,
    /// Whether the sampled loop is followed for each size.
    pub guarantee: bool,
}

/// One size of the model, generated, simulated and searched.
#[derive(Clone, Debug)]
pub struct Study {
    /// A short name, such as `exact` or `xi 6`.
    pub label: String,
    /// Everything that follows from the specification at this size.
    pub generation: Generation,
    /// Its figures in short.
    pub(super) row: Row,
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
    /// Generates `loaded` at `size`, simulates it and seeks its largest errors.
    ///
    /// # Errors
    /// As [`run`] and [`simulate`].
    pub fn new(
        loaded: &Loaded,
        size: &Size,
        effort: ReportEffort,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let (row, generation) = run(loaded, size, effort.guarantee, progress)?;
        let _stage = Stage::new(progress, "simulation for the report", 1);
        let module = generation.module()?;
        let closed = generation.motion().is_some() && generation.design().is_some();
        let scenario = if closed { Some(Scenario::of(&generation)?) } else { None };
        let comparison = scenario.as_ref().map(simulate).transpose()?;
        let found = match &scenario {
            Some(scenario) if effort.runs > 0 => {
                let request = MonteCarloRequest::of(&generation, effort.runs, settle(&generation));
                Some(monte_carlo(scenario, &request, progress)?)
            }
            _ => None,
        };
        let torque_found = largest_torque_error(&generation);
        Ok(Self { label: size.label(), row, module, comparison, found, torque_found, generation })
    }

    /// What is promised of the sampled loop.
    pub(super) fn promised(&self) -> Option<&Sampled> {
        self.generation.statement().and_then(|statement| statement.promised())
    }

    /// The largest torque error found, as a part of the peak torque of its joint.
    pub(super) fn worst_found(&self) -> Option<f64> {
        let (torque, found) = (self.generation.torque()?, self.torque_found.as_ref()?);
        let part = |i: usize| (!torque.is_still(i)).then(|| found[i] / torque.peak[i]);
        let parts: Option<Vec<f64>> = (0..found.len()).map(part).collect();
        Some(parts?.into_iter().fold(0.0, f64::max))
    }

    /// ξ, where this size keeps so many of the exact model's own functions for all coefficients.
    pub(super) fn functions(&self) -> Option<usize> {
        let spec = self.generation.spec();
        match spec.model {
            ModelSpec::Shared { functions } if spec.dictionary == DictionarySpec::Harmonic => Some(functions),
            _ => None,
        }
    }
}

/// When errors count as settled, s.
fn settle(generation: &Generation) -> f64 {
    let asked = generation.control().and_then(|control| control.settle);
    let proved = generation.statement().and_then(|statement| statement.sampled.as_ref());
    asked.or(proved.map(|sampled| sampled.settle)).unwrap_or(SETTLE)
}
