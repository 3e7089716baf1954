//! The `gramforge` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    gramforge::internals::cli::run()
}
