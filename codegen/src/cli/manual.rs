//! `gramforge completions` and `gramforge man`.

use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;

use super::Cli;
use crate::error::Error;

/// Prints completions for a shell.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: gramforge completions bash > ~/.local/share/bash-completion/completions/gramforge"
)]
pub(super) struct Completions {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    pub(super) fn run(&self) -> Result<String, Error> {
        let mut out = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "gramforge", &mut out);
        text(out)
    }
}

/// Prints the manual page of the command, or of one subcommand.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge man > gramforge.1; man ./gramforge.1")]
pub(super) struct Man {
    /// The subcommand.
    subcommand: Option<Page>,
}

/// Subcommands with a page.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Page {
    Init,
    Inspect,
    Evaluate,
    Generate,
    Simulate,
    Sweep,
    Diff,
    Report,
    Reproduce,
    Schema,
}

impl Man {
    pub(super) fn run(&self) -> Result<String, Error> {
        let mut whole = Cli::command();
        whole.build();
        let named = self.subcommand.and_then(|page| page.to_possible_value());
        let page = named.and_then(|value| whole.find_subcommand(value.get_name()).cloned()).unwrap_or(whole);
        let mut out = Vec::new();
        let rendered = clap_mangen::Man::new(page).render(&mut out);
        rendered.map_err(|error| Error::Internal(error.to_string()))?;
        text(out)
    }
}

fn text(bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|error| Error::Internal(error.to_string()))
}
