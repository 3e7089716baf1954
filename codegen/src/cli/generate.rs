//! `gramforge generate`: modules from specifications.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use super::progress::Bars;
use super::{json, show_warnings};
use crate::config::{Config, Output, OutputFile};
use crate::emit::torque_in_words;
use crate::error::Error;
use crate::graph::Operations;

/// Writes DIR/NAME.rs for each specification, with DIR/NAME.h and DIR/NAME_c where it asks for a C interface, or with --check compares without writing.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  gramforge generate ur5.jsonc --out src\n  gramforge generate specs/*.json --out src --check"
)]
pub(super) struct Generate {
    /// The specification files.
    #[arg(required = true)]
    specs: Vec<PathBuf>,
    /// The folder that the modules go to; made where it is missing.
    #[arg(long)]
    out: PathBuf,
    /// Write nothing; exit with 1 where a file differs in any byte from what its specification gives.
    #[arg(long)]
    check: bool,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Serialize)]
struct Written<'a> {
    path: String,
    written: bool,
    /// The files of the C interface.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    c_files: Vec<Beside>,
    form: &'static str,
    bytes: usize,
    operations: Operations,
    exact_operations: Operations,
    verdict: String,
    /// Certified bound on the torque error by joint, N·m or N.
    torque_error: Option<&'a [f64]>,
    /// Largest torque by joint, N·m or N.
    peak_torque: Option<&'a [f64]>,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Beside {
    path: String,
    written: bool,
}

impl Generate {
    pub(super) fn run(&self) -> Result<String, Error> {
        let outputs = self.outputs()?;
        for output in &outputs {
            show_warnings(output.generation.warnings());
        }
        if self.json {
            return json(&outputs.iter().map(written).collect::<Vec<_>>());
        }
        Ok(outputs.iter().map(|output| self.line(output)).collect())
    }

    fn outputs(&self) -> Result<Vec<Output>, Error> {
        let config = Config::new().out_dir(&self.out).progress(Arc::new(Bars::new()));
        let config = self.specs.iter().fold(config, |config, spec| config.spec(spec));
        if self.check { config.check() } else { config.generate() }
    }

    fn line(&self, output: &Output) -> String {
        let view = written(output);
        let state = |written: bool| match (self.check, written) {
            (true, _) => "current",
            (false, true) => "written",
            (false, false) => "unchanged",
        };
        let torque = output.generation.torque();
        let error = torque.map_or(String::new(), |torque| format!(" {}", torque_in_words(torque)));
        let line = format!(
            "{}: {}, {} bytes, {}; exact {}; {}{error}\n",
            view.path,
            state(view.written),
            view.bytes,
            view.operations,
            view.exact_operations,
            view.verdict
        );
        let beside = view.c_files.iter().map(|file| format!("{}: {}\n", file.path, state(file.written)));
        std::iter::once(line).chain(beside).collect()
    }
}

fn written(output: &Output) -> Written<'_> {
    let generation = &output.generation;
    let (operations, exact) = (generation.code().operations(), generation.exact_code().operations());
    let torque = generation.torque();
    Written {
        verdict: generation.verdict(),
        torque_error: torque.map(|torque| torque.error.as_slice()),
        peak_torque: torque.map(|torque| torque.peak.as_slice()),
        path: output.path.display().to_string(),
        written: output.written,
        c_files: output.c_files.iter().map(beside).collect(),
        form: output.generation.form().name(),
        bytes: output.text.len(),
        operations,
        exact_operations: exact,
        warnings: output.generation.warnings(),
    }
}

fn beside(file: &OutputFile) -> Beside {
    Beside { path: file.path.display().to_string(), written: file.written }
}
