//! The command line: one file a subcommand, each a thin shell over the library.

mod demo;
mod diff;
mod errors;
mod evaluate;
mod generate;
mod init;
mod inspect;
mod manual;
mod print;
mod progress;
mod report;
mod reproduce;
mod settings;
mod simulate;
mod sweep;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::Serialize;

use crate::error::Error;
use crate::text::{escaped, escaped_json};
use settings::Settings;

/// Generates reduced robot dynamics and tracking controllers as flat, allocation-free no_std Rust.
///
/// Without a subcommand: a demonstration on a three-link arm. What lasts more than a second shows its stage on standard
/// error, if that is a terminal.
/// Exit codes: 0 done, 1 check failed, 2 bad input, 3 internal error.
#[derive(Debug, Parser)]
#[command(name = "gramforge", version, after_help = "Begin with `gramforge init ROBOT.urdf`.")]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    settings: Settings,
}

#[derive(Debug, Subcommand)]
enum Command {
    Init(init::Init),
    Inspect(inspect::Inspect),
    Evaluate(evaluate::Evaluate),
    Generate(generate::Generate),
    Simulate(simulate::Simulate),
    Sweep(sweep::Sweep),
    Diff(diff::Diff),
    Report(report::Report),
    Reproduce(reproduce::Reproduce),
    /// Prints the JSON Schema of specification files.
    #[command(after_help = "Example: gramforge schema > gramforge.schema.json")]
    Schema,
    Completions(manual::Completions),
    Man(manual::Man),
}

/// What a command ends with.
struct Done {
    /// What is printed.
    text: String,
    /// Exit code.
    code: u8,
}

impl From<String> for Done {
    fn from(text: String) -> Self {
        Self { text, code: 0 }
    }
}

impl Command {
    fn run(&self) -> Result<Done, Error> {
        let text = match self {
            Command::Init(command) => command.run(),
            Command::Inspect(command) => command.run(),
            Command::Evaluate(command) => command.run(),
            Command::Generate(command) => command.run(),
            Command::Simulate(command) => command.run(),
            Command::Sweep(command) => command.run(),
            Command::Diff(command) => {
                return command.run().map(|(text, differs)| Done { text, code: u8::from(differs) });
            }
            Command::Report(command) => command.run(),
            Command::Reproduce(command) => command.run(),
            Command::Schema => crate::load::schema().and_then(json),
            Command::Completions(command) => command.run(),
            Command::Man(command) => command.run(),
        };
        text.map(Done::from)
    }

    /// Whether the result, and then faults too, is wanted as JSON.
    fn json(&self) -> bool {
        match self {
            Command::Init(_)
            | Command::Report(_)
            | Command::Schema
            | Command::Completions(_)
            | Command::Man(_) => false,
            Command::Inspect(command) => command.json,
            Command::Evaluate(command) => command.json,
            Command::Generate(command) => command.json,
            Command::Simulate(command) => command.json,
            Command::Sweep(command) => command.json,
            Command::Diff(command) => command.json,
            Command::Reproduce(command) => command.json,
        }
    }
}

/// Runs the command that the process arguments name.
pub fn run() -> ExitCode {
    let Cli { command, settings } = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return print::usage(error),
    };
    let outcome = settings.set().and_then(|()| match &command {
        None => demo::run().map(Done::from),
        Some(command) => command.run(),
    });
    let outcome = outcome.and_then(|done| print::result(&done.text).map(|()| done.code));
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            if command.is_some_and(|command| command.json()) {
                // Where it cannot be printed, the text below says what is wrong.
                let _ = errors::json(&error).and_then(|text| print::result(&text));
            }
            // Where even this cannot be said, the exit code says it.
            let _ =
                writeln!(std::io::stderr().lock(), "{}", errors::shown(&error, settings::colored_errors()));
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
    if settings::quiet() {
        return;
    }
    for warning in warnings {
        let _ = writeln!(std::io::stderr().lock(), "warning: {}", escaped(warning));
    }
}
