//! `gramforge report`: all figures of a specification on one page.

use std::path::PathBuf;

use clap::Args;

use super::progress::watched;
use super::show_warnings;
use crate::check::read;
use crate::error::Error;
use crate::load::Loaded;
use crate::output::write_if_changed;
use crate::progress::{Progress, Stage};
use crate::report::{ReportEffort, Study, html_report};
use crate::sizes::{Size, default_sizes};
use crate::spec::ModelSpec;

/// Writes one HTML file with every figure of a specification: the arm, its motion, bounds, costs, the guarantee and the loop in
/// time, with a slider over model sizes.
///
/// The file holds all of its data and loads nothing: open it in any browser, print it, or send it.
/// Example: gramforge report specs/arm.json --out arm.html
#[derive(Debug, Args)]
pub(super) struct Report {
    /// The specification file.
    spec: PathBuf,
    /// The HTML file; folders that are missing are made.
    #[arg(long, value_name = "FILE.html")]
    out: PathBuf,
    /// Show the size of the specification alone, without a slider.
    #[arg(long)]
    one_size: bool,
    /// Runs that seek the largest errors of each size.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(..=10_000))]
    runs: u32,
}

impl Report {
    pub(super) fn run(&self) -> Result<String, Error> {
        let loaded = read(&self.spec)?;
        let studies = watched(|progress| self.studies(&loaded, progress))?;
        let own = studies.iter().position(|study| study.label == Size::default().label()).unwrap_or(0);
        if let Some(study) = studies.get(own) {
            show_warnings(study.generation.warnings());
        }
        let page = html_report(&studies, own)?;
        let written = write_if_changed(&self.out, &page)?;
        let state = if written { "written" } else { "unchanged" };
        let path = self.out.display();
        Ok(format!("{path}: {state}, {} bytes, {} model sizes\n", page.len(), studies.len()))
    }

    /// All sizes, from the loosest to the exact one. The specification's own must succeed; one of the others that cannot be had
    /// is left out.
    fn studies(&self, loaded: &Loaded, progress: &dyn Progress) -> Result<Vec<Study>, Error> {
        let effort = ReportEffort { runs: self.runs as usize, guarantee: true };
        let others = if self.one_size { Vec::new() } else { others(loaded)? };
        let stage = Stage::new(progress, "model sizes", others.len() + 1);
        let one = |size: &Size| {
            let _part = stage.part();
            Study::new(loaded, size, effort, progress)
        };
        let mut studies = vec![one(&Size::default())?];
        studies.extend(others.iter().filter_map(|size| one(size).ok()));
        Ok(studies)
    }
}

/// The other sizes of the slider.
fn others(loaded: &Loaded) -> Result<Vec<Size>, Error> {
    let own = &loaded.spec.model;
    let sizes = default_sizes(loaded)?;
    let wanted = |size: &Size| match &size.model {
        Some(ModelSpec::Tolerance { torque }) => *torque >= 0.01 && own.tolerance() != Some(*torque),
        Some(model) => model != own,
        None => false,
    };
    Ok(sizes.into_iter().filter(wanted).collect())
}
