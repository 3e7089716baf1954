//! `gramforge sweep`: one specification, or many, at several model sizes.

use std::path::{Path, PathBuf};

use clap::{Args, value_parser};

use super::json;
use super::progress::{Bars, watched};
use crate::check::{Extent, checked, read};
use crate::error::Error;
use crate::load::Loaded;
use crate::output::{Growing, write_all};
use crate::report::{pareto_plot, size_line, sizes_csv, sizes_table};
use crate::sizes::{Entry, Kept, Plan, Shard, Size, default_sizes, merged, sweep, with_gains};
use crate::spec::ModelSpec;

/// Generates specifications at several model sizes and compares operations, certified torque errors, gains and code size.
///
/// Gains that `control.design` asks for are found once, for the model of the specification, and stay the same at every size.
///
/// With --out every row is in the file as soon as it and those before it are done: an interruption keeps them, and the same command
/// goes on from there.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge sweep arm.json --sizes exact,1%,xi6 --plot sizes.svg")]
pub(super) struct Sweep {
    /// The specification files; with --merge, files of shards.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Sizes such as exact, xi6, xi6each, 1%, or 1%+constant+f32. Default: about a dozen from small to exact.
    #[arg(long, value_delimiter = ',', conflicts_with = "merge")]
    sizes: Vec<Size>,
    /// Also these numbers of functions.
    #[arg(long, value_delimiter = ',', conflicts_with = "merge")]
    functions: Vec<usize>,
    /// Also these torque errors, as fractions of the peak torque.
    #[arg(long, value_delimiter = ',', conflicts_with = "merge")]
    tolerance: Vec<f64>,
    /// Also prove what is promised of the sampled loop; that takes seconds a row.
    #[arg(long, conflicts_with = "merge")]
    guarantee: bool,
    /// Sizes that are worked on at once. Default: one a thread.
    #[arg(long, value_parser = value_parser!(u16).range(1..), conflicts_with = "merge")]
    jobs: Option<u16>,
    /// Do only part i of n, which --merge joins with the others.
    #[arg(long, value_name = "i/n", requires = "out", conflicts_with = "merge")]
    shard: Option<Shard>,
    /// Join the files of shards instead of generating.
    #[arg(long)]
    merge: bool,
    /// With --merge: rows may be missing.
    #[arg(long, requires = "merge")]
    partial: bool,
    /// Write the rows to this file, a line each.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Write the rows to this file as CSV.
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Draw operations against torque error into this SVG file.
    #[arg(long)]
    plot: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

impl Sweep {
    pub(super) fn run(&self) -> Result<String, Error> {
        let kept = if self.merge { self.merged()? } else { self.swept()? };
        let entries: Vec<&Entry> = kept.entries.values().collect();
        let csv = self.csv.as_ref().map(|path| Ok::<_, Error>((path, sizes_csv(&entries)?))).transpose()?;
        let plot =
            self.plot.as_ref().map(|path| Ok::<_, Error>((path, pareto_plot(&entries)?))).transpose()?;
        let files = csv.iter().chain(&plot).map(|(path, text)| -> (&Path, &str) { (path, text) });
        write_all(&files.collect::<Vec<_>>())?;
        if self.json { json(&entries) } else { Ok(sizes_table(&entries, kept.has_guarantee())) }
    }

    fn merged(&self) -> Result<Kept, Error> {
        let kept = merged(&self.files, self.partial)?;
        if let Some(out) = &self.out {
            write_all(&[(out, &kept.text()?)])?;
        }
        Ok(kept)
    }

    fn swept(&self) -> Result<Kept, Error> {
        let plan = self.plan()?;
        let mut kept = Kept::new(&plan)?;
        let shard = self.shard.unwrap_or(Shard::WHOLE);
        let rows: Vec<usize> = shard.rows(plan.tasks.len()).collect();
        if let Some(out) = &self.out {
            kept.keep_from(out, &rows);
        }
        let mut file = self.out.as_ref().map(|out| Growing::start(out, &kept.text()?)).transpose()?;
        let rows: Vec<usize> = rows.into_iter().filter(|row| !kept.entries.contains_key(row)).collect();
        let jobs = self.jobs.map_or_else(rayon::current_num_threads, usize::from);
        let bars = Bars::new();
        sweep(&plan, &rows, jobs, &bars, &mut |entry| {
            if let Some(file) = &mut file {
                file.add(&entry.line()?)?;
            }
            bars.say(&size_line(entry));
            kept.entries.insert(entry.index, entry.clone());
            Ok(())
        })?;
        Ok(kept)
    }

    /// Every specification with its sizes; the faults of all of them are told at once.
    fn plan(&self) -> Result<Plan, Error> {
        let mut faults = Vec::new();
        let mut specs = Vec::new();
        for file in &self.files {
            match self.sized(file) {
                Ok(spec) => specs.push(spec),
                Err(Error::Input(more)) => faults.extend(more),
                Err(other) => return Err(other),
            }
        }
        if faults.is_empty() { Ok(Plan::new(&specs, self.guarantee)) } else { Err(Error::Input(faults)) }
    }

    /// The specification in `file` with its sizes.
    fn sized(&self, file: &Path) -> Result<(Loaded, Vec<Size>), Error> {
        let loaded = read(file)?;
        checked(loaded.clone(), Extent::Whole)?;
        let mut sizes = self.sizes.clone();
        sizes.extend(self.functions.iter().map(|&functions| Size::of(ModelSpec::Shared { functions })));
        sizes.extend(self.tolerance.iter().map(|&torque| Size::of(ModelSpec::Tolerance { torque })));
        if sizes.is_empty() {
            sizes = default_sizes(&loaded)?;
        }
        Ok((watched(|progress| with_gains(&loaded, progress))?, sizes))
    }
}
