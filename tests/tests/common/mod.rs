//! The command as a process, and folders to run it in.

#![allow(dead_code, unused_imports, reason = "no test uses all of it")]

use std::path::{Path, PathBuf};
use std::process::Command;

pub use gramforge_tests::unplaced;

/// What a finished process left.
#[derive(Debug)]
pub struct Outcome {
    /// Exit code.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Outcome {
    /// Standard output as JSON.
    pub fn json(&self) -> serde_json::Value {
        assert_eq!(self.code, Some(0), "{self:#?}");
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error} in {self:#?}"))
    }

    /// Asserts the exit code, and where it is not 0 nothing on standard output but the faults that `--json` asks for.
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        assert!(code == 0 || self.stdout.is_empty() || !self.errors().is_empty(), "{self:#?}");
        self
    }

    /// The faults on standard output, as `--json` prints them.
    pub fn errors(&self) -> Vec<serde_json::Value> {
        let value: Option<serde_json::Value> = serde_json::from_str(&self.stdout).ok();
        value.and_then(|value| value["errors"].as_array().cloned()).unwrap_or_default()
    }

    /// The faults on standard error: one line each, without the places that are shown under them.
    pub fn faults(&self) -> Vec<String> {
        let shown = |line: &&str| {
            let behind = line.trim_start().trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
            !behind.starts_with('|')
        };
        self.stderr.lines().filter(shown).map(str::to_string).collect()
    }
}

/// The command, ready for arguments.
pub fn gramforge() -> Command {
    Command::new(env!("CARGO_BIN_EXE_gramforge-under-test"))
}

/// Runs `command` to its end.
pub fn finish(command: &mut Command) -> Outcome {
    let output = command.output().expect("the command starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Runs the command with `arguments`.
pub fn run<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Outcome {
    finish(gramforge().args(arguments))
}

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A committed specification.
pub fn committed(name: &str) -> PathBuf {
    root().join("generated/specs").join(name).with_extension("json")
}

/// Its JSON.
pub fn value(name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(committed(name)).expect("a committed specification");
    serde_json::from_str(&text).expect("JSON")
}

/// `path` as an argument.
pub fn text(path: &Path) -> String {
    path.to_str().expect("UTF-8").to_string()
}
