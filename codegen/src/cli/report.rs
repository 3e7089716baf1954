//! `gramforge report`: all figures of a specification on one page.

use std::path::PathBuf;

use clap::Args;

use super::progress::watched;
use super::show_warnings;
use crate::check::read;
use crate::error::Error;
use crate::load::Loaded;
use crate::output::write_if_changed;
use crate::parallel::Parallelize;
use crate::progress::{Progress, Silent, Stage};
use crate::report::{ReportEffort, Study, counted, html_report};
use crate::sizes::{Size, default_sizes, with_gains_of};
use crate::spec::ModelSpec;

/// Writes one HTML file with every figure of a specification: the arm, its motion, bounds, costs, the guarantee and the loop in
/// time, with a slider over model sizes.
///
/// The file holds all of its data and loads nothing: open it in any browser, print it, or send it.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge report arm.json --out arm.html")]
pub(super) struct Report {
    /// The specification file.
    spec: PathBuf,
    /// The HTML file; folders that are missing are made.
    #[arg(long, value_name = "FILE.html")]
    out: PathBuf,
    /// Other sizes on the slider, such as exact, xi6 or 1%. Default: about eight from small to exact.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<Size>,
    /// Show the size of the specification alone, without a slider.
    #[arg(long, conflicts_with = "sizes")]
    one_size: bool,
    /// Runs that seek the largest errors of each size.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(..=10_000))]
    runs: u32,
}

impl Report {
    pub(super) fn run(&self) -> Result<String, Error> {
        let loaded = read(&self.spec)?;
        let (own, others) = watched(|progress| self.studies(&loaded, progress))?;
        show_warnings(own.generation.warnings());
        let (page, count) = html_report(own, others)?;
        let written = write_if_changed(&self.out, &page)?;
        let state = if written { "written" } else { "unchanged" };
        let path = self.out.display();
        Ok(format!("{path}: {state}, {} bytes, {}\n", page.len(), counted(count, "model size")))
    }

    /// The specification's own size, which must succeed, and the others that can be had.
    fn studies(&self, loaded: &Loaded, progress: &dyn Progress) -> Result<(Study, Vec<Study>), Error> {
        let effort = ReportEffort { runs: self.runs as usize, guarantee: true };
        let others = match (self.one_size, self.sizes.is_empty()) {
            (true, _) => Vec::new(),
            (false, true) => others(loaded)?,
            (false, false) => self.sizes.clone(),
        };
        let stage = Stage::new(progress, "model sizes", others.len() + 1);
        let one = |loaded: &Loaded, size: Size| {
            let _part = stage.part();
            // Stages of several sizes at once would be told in disorder.
            Study::new(loaded, &size, effort, &Silent)
        };
        let own = one(loaded, Size::default())?;
        let alike = with_gains_of(&own.generation);
        let others: Vec<Result<Study, Error>> =
            others.into_par_iter().map(|size| one(&alike, size)).collect();
        // A size that nobody has named may be one that the specification cannot have.
        let kept = others.into_iter().filter(|study| study.is_ok() || !self.sizes.is_empty());
        Ok((own, kept.collect::<Result<_, _>>()?))
    }
}

/// Most numbers of functions among the sizes.
const COUNTS: usize = 4;

/// The other sizes of the slider: the exact model, tolerances from 1 % on, and some numbers of functions, fewer than all.
fn others(loaded: &Loaded) -> Result<Vec<Size>, Error> {
    let own = Size::of(loaded.spec.model.clone());
    let is_own = |size: &Size| {
        *size == own
            || size.model.as_ref().map(ModelSpec::tolerance) == Some(loaded.spec.model.tolerance())
                && loaded.spec.model.tolerance().is_some()
    };
    let (mut counts, mut out) = (Vec::new(), Vec::new());
    for size in default_sizes(loaded)?.into_iter().filter(|size| !is_own(size)) {
        match size.model {
            Some(ModelSpec::Shared { functions }) => counts.push(functions),
            Some(ModelSpec::Tolerance { torque }) if torque < 0.01 => {}
            _ => out.push(size),
        }
    }
    // The last one keeps all functions.
    counts.pop();
    let every = counts.len().div_ceil(COUNTS).max(1);
    let counts = counts.into_iter().rev().step_by(every);
    out.extend(counts.map(|functions| Size::of(ModelSpec::Shared { functions })));
    Ok(out)
}
