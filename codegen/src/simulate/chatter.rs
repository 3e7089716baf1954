//! How much a robust law chatters with each robust gain: measured in one simulation, not a bound.

use serde::Serialize;

use super::{Comparison, Scenario, simulate_law};
use crate::control::RobustGain;
use crate::error::{Error, problems};
use crate::pipeline::Generation;
use crate::spec::RobustGainSpec;

/// The chatter of a robust law with one robust gain, measured in the simulation of the specification.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chatter {
    /// The robust gain, `state` or `constant`.
    pub robust_gain: RobustGainSpec,
    /// Whether the controller of the specification has this one.
    pub used: bool,
    /// [`super::Run::relative_step`] of the run with it; `None` where the controller is refused with it.
    pub relative_step: Option<f64>,
    /// When that run ended, as [`super::Metrics::diverged_at`], s.
    pub diverged_at: Option<f64>,
    /// Why the controller is refused with it.
    pub refused: Option<String>,
}

/// The chatter of the law of `generation` with each robust gain, all else being equal: first the state's, then the
/// constant one. Empty for laws other than `report` and `tight`. `comparison` is the simulation of `generation`.
///
/// # Errors
/// As [`super::simulate`].
pub fn chatter(generation: &Generation, comparison: &Comparison) -> Result<Vec<Chatter>, Error> {
    let scenario = Scenario::of(generation)?;
    if !scenario.design.law.has_choice() {
        return Ok(Vec::new());
    }
    let constant_used = matches!(scenario.design.robust_gain, RobustGain::Constant(_));
    let measured = |constant: bool| {
        let robust_gain = if constant { RobustGainSpec::Constant } else { RobustGainSpec::State };
        let used = constant == constant_used;
        let run = |run: &super::Run| Chatter {
            robust_gain,
            used,
            relative_step: Some(run.relative_step()),
            diverged_at: run.metrics.diverged_at,
            refused: None,
        };
        if used {
            return Ok(run(&comparison.law));
        }
        match generation.design_with(constant) {
            Ok(design) => Ok(run(&simulate_law(&Scenario { design: &design, ..scenario })?)),
            Err(Error::Input(faults)) => Ok(Chatter {
                robust_gain,
                used,
                relative_step: None,
                diverged_at: None,
                refused: Some(problems(&faults)),
            }),
            Err(error) => Err(error),
        }
    };
    [false, true].into_iter().map(measured).collect()
}
