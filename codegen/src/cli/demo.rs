//! Without a subcommand: the three-link arm of the 1992 report, generated, simulated and judged; then the same arm with drives, whose
//! sampled loop is guaranteed, and runs that seek its largest errors.

use std::path::Path;

use super::progress::watched;
use super::simulate::{beside, sought};
use crate::bounds::Effort;
use crate::error::Error;
use crate::load::{Loaded, parse};
use crate::output::write_all;
use crate::pipeline::Generation;
use crate::progress::Stage;
use crate::report::{bounds_table, claims, claims_table, funnel_plot, metrics_table, operations_table};
use crate::simulate::{Scenario, simulate};
use crate::spec::VectorSpec;

const SPEC: &str = include_str!("../../specs/arm3.json");
/// The arm with armature, from smaller errors: its loop is guaranteed from sample to sample.
const SAMPLED: &str = include_str!("../../specs/arm3_sampled.json");
/// Runs of its loop.
const RUNS: usize = 100;
/// Where the demonstration leaves its files, below the working directory.
const FOLDER: &str = "target/gramforge";
/// φ of the second run, rad/s.
const BOUNDARY_LAYER: f64 = 0.05;

/// Generates and simulates the built-in arm, writes module and plot, and returns the report.
pub(super) fn run() -> Result<String, Error> {
    let folder = Path::new(FOLDER);
    let loaded = parse(SPEC, Path::new("arm3.json"))?;
    let (sign, without, with) = watched(|progress| {
        let generated = |loaded| Generation::with_progress(loaded, &Effort::default(), progress);
        let (sign, layer) = (generated(loaded.clone())?, generated(with_boundary_layer(loaded))?);
        let _stage = Stage::new(progress, "simulation", 1);
        let (without, with) = (simulate(&Scenario::of(&sign)?)?, simulate(&Scenario::of(&layer)?)?);
        Ok::<_, Error>((sign, without, with))
    })?;
    let joints = &sign.arm().joints;

    let funnel = funnel()?;
    let module = folder.join("arm3.rs");
    let sampled = folder.join("arm3_sampled.rs");
    let picture = folder.join("arm3.svg");
    write_all(&[(&module, &sign.module()?), (&sampled, &funnel.module), (&picture, &funnel.picture)])?;

    let selected: Vec<String> =
        sign.reduced().selected.iter().map(|&l| sign.lagrangian().functions[l].to_string()).collect();
    let mut out = format!(
        "The three-link arm of TR-EE 92-21, reduced to {} of its {} functions: {}\n\n",
        selected.len(),
        sign.lagrangian().functions.len(),
        selected.join(", ")
    );
    let operations = [("exact", sign.exact_code().operations()), ("reduced", sign.code().operations())];
    let sections = [
        ("Operations of one passivity torque D a_r + C v_r + G", operations_table(&operations)),
        (
            "Bounds on what the reduced model leaves out (certified over the tube)",
            bounds_table(sign.bounds()),
        ),
        ("Law (34) with the sign function against law (16)", metrics_table(&without, joints)),
        ("Law (34) with a boundary layer of 0.05 rad/s against law (16)", metrics_table(&with, joints)),
        ("The report's claims", claims_table(&claims(&without, &with))),
        (
            "The arm with drives, model within 1 %: certified errors of the sampled loop, and the largest found",
            funnel.table,
        ),
    ];
    for (title, table) in sections {
        out.push_str(&format!("{title}\n\n{table}\n"));
    }
    out.push_str(&format!(
        "Generated modules: {}, {}\nPlot:              {}\n",
        module.display(),
        sampled.display(),
        picture.display()
    ));
    Ok(out)
}

/// Runs inside what is certified of them.
struct Inside {
    module: String,
    picture: String,
    table: String,
}

/// Of the arm whose sampled loop is guaranteed.
fn funnel() -> Result<Inside, Error> {
    let loaded = parse(SAMPLED, Path::new("arm3_sampled.json"))?;
    let generation = watched(|progress| Generation::with_progress(loaded, &Effort::default(), progress))?;
    let statement = generation.statement().and_then(|statement| statement.promised());
    let lost = || Error::Internal("the sampled loop of the demonstration is not guaranteed".to_string());
    let sampled = statement.ok_or_else(lost)?;
    let found = sought(&generation, &Scenario::of(&generation)?, RUNS)?;
    let joints = &generation.arm().joints;
    Ok(Inside {
        module: generation.module()?,
        picture: funnel_plot(sampled, &found, joints)?,
        table: beside(&found, Some(sampled), joints),
    })
}

fn with_boundary_layer(mut loaded: Loaded) -> Loaded {
    if let Some(control) = &mut loaded.spec.control {
        control.boundary_layer = Some(VectorSpec::Scalar(BOUNDARY_LAYER));
        // The report's period is too long for so narrow a layer; the comparison is its own all the same.
        control.allow_long_period = true;
    }
    loaded
}
