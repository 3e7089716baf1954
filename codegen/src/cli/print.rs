//! What goes to standard output, and what happens where it cannot.

use std::ffi::OsString;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

use super::Cli;
use crate::error::Error;
use crate::text::{escaped, escaped_lines};

/// Prints the result of a command.
///
/// # Errors
/// [`Error::Input`] where standard output does not take it, as on a full disk.
pub(super) fn result(text: &str) -> Result<(), Error> {
    write(&mut io::stdout().lock(), &escaped_lines(text))
}

fn write(out: &mut impl Write, text: &str) -> Result<(), Error> {
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        // A reader that has seen enough closes the pipe; that is no error of ours.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => {
            let problem = format!("cannot be written ({error})");
            Err(Error::input(
                Path::new("standard output"),
                "",
                problem,
                "free some space, or write to another place",
            ))
        }
        Ok(()) => Ok(()),
    }
}

/// Prints help, the version, or what is wrong with the arguments.
pub(super) fn usage(error: clap::Error) -> ExitCode {
    let error = with_plain_arguments(error);
    let code = u8::try_from(error.exit_code()).unwrap_or(2);
    let text = error.render();
    if error.use_stderr() {
        let text = if io::stderr().is_terminal() { text.ansi().to_string() } else { text.to_string() };
        let _ = io::stderr().lock().write_all(text.as_bytes());
        return ExitCode::from(code);
    }
    let text = if io::stdout().is_terminal() { text.ansi().to_string() } else { text.to_string() };
    match write(&mut io::stdout().lock(), &text) {
        Ok(()) => ExitCode::from(code),
        Err(error) => {
            let _ = writeln!(io::stderr().lock(), "{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// The same error about the arguments with hidden characters escaped: it quotes them.
fn with_plain_arguments(error: clap::Error) -> clap::Error {
    let plain =
        std::env::args_os().map(|argument| OsString::from(escaped(&argument.to_string_lossy()).to_string()));
    Cli::try_parse_from(plain).err().unwrap_or(error)
}
