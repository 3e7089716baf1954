//! `gramforge reproduce`: section 4 of the 1992 report.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::json;
use super::progress::watched;
use crate::error::Error;
use crate::output::{Wanted, write_all};
use crate::report::{Claim, Figures, claims_table, figures};
use crate::reproduce::{claims, run};

/// Runs the report's example under all its laws, draws its figures 2 to 6 and judges its claims.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge reproduce --out report")]
pub(super) struct Reproduce {
    /// Folder for the figures and the table of claims; made where it is missing.
    #[arg(long, default_value = "target/gramforge/report")]
    out: PathBuf,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Serialize)]
struct Summary<'a> {
    claims: &'a [Claim],
    files: Vec<String>,
}

impl Reproduce {
    pub(super) fn run(&self) -> Result<String, Error> {
        let cases = watched(run)?;
        let motion = cases.nominal.motion();
        let motion =
            motion.ok_or_else(|| Error::Internal("the built-in example has no motion".to_string()))?;
        let mut files = figures(&Figures {
            joints: &cases.nominal.arm().joints,
            motion,
            exact: &cases.simplified.exact,
            simplified: &cases.simplified.law,
            // The shorter period: with the report's own the robust law only oscillates.
            robust: &cases.loaded[1].robust[1].law,
            adaptive: &cases.loaded[1].adaptive[1].law,
        })?;
        let claims = claims(&cases);
        let table = claims_table(&claims);
        files.push(("claims.txt".to_string(), table.clone()));
        let paths: Vec<PathBuf> = files.iter().map(|(name, _)| self.out.join(name)).collect();
        let wanted: Vec<Wanted> =
            paths.iter().zip(&files).map(|(path, (_, text))| (path.as_path(), text.as_str())).collect();
        write_all(&wanted)?;
        let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        if self.json {
            return json(&Summary { claims: &claims, files: names });
        }
        Ok(format!(
            "Section 4 of TR-EE 92-21, with Pqq = 0.25I and P12 = 4I: the report prints them the other way round,\n\
             and then nothing converges within the 1.5 s that its figures show.\n\n{table}\n{}\n",
            names.join("\n")
        ))
    }
}
