//! What every command takes: how much is said, in which colours, on how many threads.

use std::io::{IsTerminal, stderr};
use std::path::Path;
use std::sync::OnceLock;

use clap::{Args, ValueEnum};

use crate::error::Error;

/// How a command behaves, whichever it is.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "All commands")]
pub(super) struct Settings {
    /// Show no warnings and no progress.
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Number of threads; the results are the same for every number. Default: one a processor.
    #[arg(long, global = true, value_name = "N")]
    threads: Option<u16>,
    /// Colours in messages; `auto` asks whether a terminal shows them, and heeds the variable NO_COLOR.
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    color: Color,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Color {
    Auto,
    Always,
    Never,
}

static SETTINGS: OnceLock<Settings> = OnceLock::new();

impl Settings {
    /// Puts the settings into force, once for the process.
    pub(super) fn set(self) -> Result<(), Error> {
        let _ = SETTINGS.set(self);
        let Some(threads) = self.threads else { return Ok(()) };
        let refused = |problem: String| {
            Error::input(Path::new("command line"), "--threads", problem, "write a number from 1 to 1024")
        };
        if !(1..=1024).contains(&threads) {
            return Err(refused(format!("is {threads}")));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().map_err(|error| refused(format!("is {threads}, which cannot be had ({error})")))
    }
}

/// Whether warnings and progress are left out.
pub(super) fn quiet() -> bool {
    SETTINGS.get().is_some_and(|settings| settings.quiet)
}

/// Whether messages on standard error are in colour.
pub(super) fn colored_errors() -> bool {
    match SETTINGS.get().map_or(Color::Auto, |settings| settings.color) {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        }
    }
}
