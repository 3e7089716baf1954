//! The command line: one file a subcommand, each a thin shell over the library.

mod demo;
mod evaluate;
mod generate;
mod inspect;
mod print;
mod progress;
mod report;
mod reproduce;
mod simulate;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::Serialize;

use crate::error::Error;
use crate::text::{escaped, escaped_json};

/// Generates reduced robot dynamics and tracking controllers as flat, allocation-free no_std Rust.
///
/// Without a subcommand: a demonstration on a three-link arm. What lasts more than a second shows its stage on standard
/// error, if that is a terminal.
/// Exit codes: 0 done, 1 check failed, 2 bad input, 3 internal error.
#[derive(Debug, Parser)]
#[command(name = "gramforge", version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Inspect(inspect::Inspect),
    Evaluate(evaluate::Evaluate),
    Generate(generate::Generate),
    Simulate(simulate::Simulate),
    Report(report::Report),
    Reproduce(reproduce::Reproduce),
    /// Prints the JSON Schema of specification files.
    Schema,
}

/// Runs the command that the process arguments name.
pub fn run() -> ExitCode {
    let command = match Cli::try_parse() {
        Ok(cli) => cli.command,
        Err(error) => return print::usage(error),
    };
    let outcome = match command {
        None => demo::run(),
        Some(Command::Inspect(command)) => command.run(),
        Some(Command::Evaluate(command)) => command.run(),
        Some(Command::Generate(command)) => command.run(),
        Some(Command::Simulate(command)) => command.run(),
        Some(Command::Report(command)) => command.run(),
        Some(Command::Reproduce(command)) => command.run(),
        Some(Command::Schema) => crate::load::schema().and_then(json),
    };
    match outcome.and_then(|text| print::result(&text)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where even this cannot be said, the exit code says it.
            let _ = writeln!(std::io::stderr().lock(), "{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// `value` as indented JSON with a final newline.
fn json(value: &impl Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Error::Internal(error.to_string()))?;
    Ok(escaped_json(&text) + "\n")
}

/// Shows the warnings of a specification on standard error.
fn show_warnings(warnings: &[String]) {
    for warning in warnings {
        let _ = writeln!(std::io::stderr().lock(), "warning: {}", escaped(warning));
    }
}
