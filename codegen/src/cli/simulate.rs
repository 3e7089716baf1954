//! `gramforge simulate`: the closed loop under the exact law and the specification's.

use std::path::PathBuf;

use clap::{Args, value_parser};
use serde::Serialize;

use super::progress::{generated, watched};
use super::{json, show_warnings};
use crate::arm::Joint;
use crate::error::Error;
use crate::guarantee::Sampled;
use crate::output::write_if_changed;
use crate::pipeline::Generation;
use crate::progress::Stage;
use crate::report::{CertifiedErrors, chatter_table, funnel_plot, metrics_table, monte_carlo_table, plot};
use crate::simulate::{
    Chatter, Metrics, MonteCarlo, MonteCarloRequest, SETTLE, Scenario, chatter, monte_carlo, simulate,
};
use crate::spec::LawSpec;

/// Simulates the exact arm under equation (16) with the exact model, and under the specification's law.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge simulate ur5.jsonc --runs 100 --plot ur5.svg")]
pub(super) struct Simulate {
    /// The specification file; it needs `motion` and `control`.
    spec: PathBuf,
    /// Also draw errors, torques and V over time into this SVG file, or with `--runs` the largest errors found inside those that
    /// are certified; folders that are missing are made.
    #[arg(long)]
    plot: Option<PathBuf>,
    /// Also run the loop this many times from the worst initial errors, with uncertain numbers and the error of the model
    /// at their limits, and print the largest errors and torques found.
    #[arg(long, value_parser = value_parser!(u32).range(1..))]
    runs: Option<u32>,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Serialize)]
struct Summary<'a> {
    exact: &'a Metrics,
    law: &'a Metrics,
    law_kind: LawSpec,
    boundary_layer: &'a Option<Vec<f64>>,
    measured_chatter: &'a [Chatter],
    #[serde(skip_serializing_if = "Option::is_none")]
    monte_carlo: Option<&'a MonteCarlo>,
}

impl Simulate {
    pub(super) fn run(&self) -> Result<String, Error> {
        let generation = generated(&self.spec)?;
        show_warnings(generation.warnings());
        self.simulated(&generation).map_err(|error| error.pointing_into_files(generation.loaded()))
    }

    fn simulated(&self, generation: &Generation) -> Result<String, Error> {
        let scenario = Scenario::of(generation)?;
        let (comparison, chatter) = watched(|progress| {
            let _stage = Stage::new(progress, "simulation", 1);
            let comparison = simulate(&scenario)?;
            let chatter = chatter(generation, &comparison)?;
            Ok::<_, Error>((comparison, chatter))
        })?;
        let found = self.runs.map(|runs| sought(generation, &scenario, runs as usize)).transpose()?;
        let joints = &generation.arm().joints;
        let sampled = generation.statement().and_then(|statement| statement.promised());
        if let Some(path) = &self.plot {
            let picture = match (&found, sampled) {
                (Some(found), Some(sampled)) => funnel_plot(sampled, found, joints)?,
                _ => plot(&comparison, joints)?,
            };
            write_if_changed(path, &picture)?;
        }
        if !self.json {
            let drawn = self.plot.as_ref().map(|path| format!("\n{}: written\n", path.display()));
            let mut out = metrics_table(&comparison, joints);
            if !chatter.is_empty() {
                out += &format!("\n{}", chatter_table(&chatter, comparison.exact.relative_step()));
            }
            if let Some(found) = &found {
                out += &format!("\n{}", beside(found, sampled, joints));
            }
            return Ok(out + &drawn.unwrap_or_default());
        }
        json(&Summary {
            exact: &comparison.exact.metrics,
            law: &comparison.law.metrics,
            law_kind: comparison.law_kind,
            boundary_layer: &comparison.boundary_layer,
            measured_chatter: &chatter,
            monte_carlo: found.as_ref(),
        })
    }
}

/// What was found beside what is certified, where anything is.
pub(super) fn beside(found: &MonteCarlo, sampled: Option<&Sampled>, joints: &[Joint]) -> String {
    let Some(sampled) = sampled else { return monte_carlo_table(found, None, joints) };
    let [low, high] = sampled.torque_range();
    let torque_max: Vec<f64> = low.iter().zip(&high).map(|(low, high)| high.max(-low)).collect();
    let certified = CertifiedErrors {
        reach: &sampled.reach,
        settled_error: sampled.settled_error.as_ref().unwrap_or(&sampled.reach),
        end_error: &sampled.end_error,
        torque_max: &torque_max,
    };
    monte_carlo_table(found, Some(&certified), joints)
}

/// The largest errors and torques of that many runs, settled where the guarantee says.
pub(super) fn sought(generation: &Generation, scenario: &Scenario, runs: usize) -> Result<MonteCarlo, Error> {
    let asked = generation.control().and_then(|control| control.settle);
    let proved = generation.statement().and_then(|statement| statement.sampled.as_ref());
    let settle = asked.or(proved.map(|sampled| sampled.settle)).unwrap_or(SETTLE);
    let request = MonteCarloRequest::of(generation, runs, settle);
    watched(|progress| monte_carlo(scenario, &request, progress))
}
