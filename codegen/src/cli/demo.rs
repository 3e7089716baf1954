//! Without a subcommand: the three-link arm of the 1992 report, generated, simulated and judged.

use std::path::Path;

use super::progress::watched;
use crate::bounds::Effort;
use crate::error::Error;
use crate::load::{Loaded, parse};
use crate::output::write_all;
use crate::pipeline::Generation;
use crate::progress::Stage;
use crate::report::{bounds_table, claims, claims_table, metrics_table, operations_table, plot};
use crate::simulate::{Scenario, simulate};
use crate::spec::VectorSpec;

const SPEC: &str = include_str!("../../specs/arm3.json");
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

    let module = folder.join("arm3.rs");
    let picture = folder.join("arm3.svg");
    write_all(&[(&module, &sign.module()?), (&picture, &plot(&with, joints)?)])?;

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
    ];
    for (title, table) in sections {
        out.push_str(&format!("{title}\n\n{table}\n"));
    }
    out.push_str(&format!(
        "Generated module: {}\nPlot:             {}\n",
        module.display(),
        picture.display()
    ));
    Ok(out)
}

fn with_boundary_layer(mut loaded: Loaded) -> Loaded {
    if let Some(control) = &mut loaded.spec.control {
        control.boundary_layer = Some(VectorSpec::Scalar(BOUNDARY_LAYER));
        // The report's period is too long for so narrow a layer; the comparison is its own all the same.
        control.allow_long_period = true;
    }
    loaded
}
