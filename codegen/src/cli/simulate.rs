//! `gramforge simulate`: the closed loop under the exact law and the specification's.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::progress::{generated, watched};
use super::{json, show_warnings};
use crate::error::Error;
use crate::output::write_if_changed;
use crate::progress::Stage;
use crate::report::{chatter_table, metrics_table, plot};
use crate::simulate::{Chatter, Metrics, Scenario, chatter, simulate};
use crate::spec::LawSpec;

/// Simulates the exact arm under equation (16) with the exact model, and under the specification's law.
#[derive(Debug, Args)]
pub(super) struct Simulate {
    /// The specification file; it needs `motion` and `control`.
    spec: PathBuf,
    /// Also draw errors, torques and V over time into this SVG file; folders that are missing are made.
    #[arg(long)]
    plot: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Summary<'a> {
    exact: &'a Metrics,
    law: &'a Metrics,
    law_kind: LawSpec,
    boundary_layer: &'a Option<Vec<f64>>,
    measured_chatter: &'a [Chatter],
}

impl Simulate {
    pub(super) fn run(&self) -> Result<String, Error> {
        let generation = generated(&self.spec)?;
        show_warnings(generation.warnings());
        let scenario = Scenario::of(&generation)?;
        let (comparison, chatter) = watched(|progress| {
            let _stage = Stage::new(progress, "simulation", 1);
            let comparison = simulate(&scenario)?;
            let chatter = chatter(&generation, &comparison)?;
            Ok::<_, Error>((comparison, chatter))
        })?;
        let joints = &generation.arm().joints;
        if let Some(path) = &self.plot {
            write_if_changed(path, &plot(&comparison, joints)?)?;
        }
        if !self.json {
            let mut out = metrics_table(&comparison, joints);
            if !chatter.is_empty() {
                out += &format!("\n{}", chatter_table(&chatter, comparison.exact.relative_step()));
            }
            return Ok(out);
        }
        json(&Summary {
            exact: &comparison.exact.metrics,
            law: &comparison.law.metrics,
            law_kind: comparison.law_kind,
            boundary_layer: &comparison.boundary_layer,
            measured_chatter: &chatter,
        })
    }
}
