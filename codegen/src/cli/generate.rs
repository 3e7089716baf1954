//! `gramforge generate`: modules from specifications.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{json, show_warnings};
use crate::config::{Config, Output};
use crate::emit::verdict;
use crate::error::Error;
use crate::graph::Operations;

/// Writes DIR/NAME.rs for each specification, or with --check compares without writing.
#[derive(Debug, Args)]
pub(super) struct Generate {
    /// The specification files.
    #[arg(required = true)]
    specs: Vec<PathBuf>,
    /// The folder that the modules go to.
    #[arg(long)]
    out: PathBuf,
    /// Write nothing; exit with 1 where a file differs from what its specification gives.
    #[arg(long)]
    check: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Written<'a> {
    path: String,
    written: bool,
    form: &'static str,
    bytes: usize,
    operations: Operations,
    exact_operations: Operations,
    warnings: &'a [String],
}

impl Generate {
    pub(super) fn run(&self) -> Result<String, Error> {
        let config =
            self.specs.iter().fold(Config::new(), |config, spec| config.spec(spec)).out_dir(&self.out);
        let outputs = if self.check { config.check()? } else { config.generate()? };
        for output in &outputs {
            show_warnings(&output.generation.warnings);
        }
        if self.json {
            return json(&outputs.iter().map(written).collect::<Vec<_>>());
        }
        Ok(outputs.iter().map(|output| self.line(output)).collect())
    }

    fn line(&self, output: &Output) -> String {
        let view = written(output);
        let state = match (self.check, output.written) {
            (true, _) => "current",
            (false, true) => "written",
            (false, false) => "unchanged",
        };
        let verdict = if output.generation.reduced.selected.is_empty() {
            "exact model".to_string()
        } else {
            verdict(&view.operations, &view.exact_operations)
        };
        let cost = format!("{} mul, {} add", view.operations.mul, view.operations.add);
        format!("{}: {state}, {} bytes, {cost}; {verdict}\n", view.path, view.bytes)
    }
}

fn written(output: &Output) -> Written<'_> {
    Written {
        path: output.path.display().to_string(),
        written: output.written,
        form: output.generation.form.name(),
        bytes: output.text.len(),
        operations: output.generation.code.operations(),
        exact_operations: output.generation.exact_code.operations(),
        warnings: &output.generation.warnings,
    }
}
