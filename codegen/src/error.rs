//! What can go wrong, as values: every message names the file, the field, the value and the help.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::text::escaped;

/// The largest number of faults that an error shows: a file may hold thousands of the same kind.
pub const MOST_TOLD: usize = 100;

/// One fault of the input. It is shown in one line, and a terminal shows the place under it.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file.
    pub file: PathBuf,
    /// The line of that file, from 1; `None` if the field is enough to find the place.
    pub line: Option<usize>,
    /// The column of that line, in characters from 1; `None` where only the line is known.
    pub column: Option<usize>,
    /// That line and the part of it that is at fault; `None` where the place is not known.
    pub excerpt: Option<Excerpt>,
    /// Path of the field inside the file, such as `arm.dh.links[1].mass`; empty if the fault is about the whole file.
    pub field: String,
    /// What is wrong, with the offending value.
    pub problem: String,
    /// What to write instead.
    pub help: String,
    /// Which part of a field is at fault.
    pub(crate) part: Part,
}

/// A line of a file and the part of it that is at fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The line, without its end; a part of it where it is very long.
    pub text: String,
    /// The bytes of `text` that are at fault.
    pub range: Range<usize>,
}

/// Which part of a field is at fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Part {
    /// What it holds.
    #[default]
    Value,
    /// Its name.
    Name,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = placed(&self.file, self.line, self.column, &self.field);
        write!(f, "{}: {}; {}", escaped(&place), escaped(&self.problem), escaped(&self.help))
    }
}

/// A place in words: `file: field`, or `file:line: field` where the line is known.
pub(crate) fn located(file: &Path, line: Option<usize>, field: &str) -> String {
    placed(file, line, None, field)
}

/// The same with the column, where that is known.
fn placed(file: &Path, line: Option<usize>, column: Option<usize>, field: &str) -> String {
    let mut out = file.display().to_string();
    for number in [line, column].into_iter().map_while(|number| number) {
        out.push_str(&format!(":{number}"));
    }
    if !field.is_empty() {
        out.push_str(&format!(": {field}"));
    }
    out
}

/// What is wrong, without the help: each field with its problem.
pub(crate) fn problems(faults: &[Diagnostic]) -> String {
    let said: Vec<String> = faults.iter().map(|fault| format!("{} {}", fault.field, fault.problem)).collect();
    said.join("; ")
}

/// Collects faults so that a user sees all of them at once.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    file: PathBuf,
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// An empty collection whose faults will name `file`.
    pub fn of(file: &Path) -> Self {
        Self { file: file.to_path_buf(), list: Vec::new() }
    }

    /// The file that new faults name.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Adds a fault in this collection's file.
    pub fn push(&mut self, field: impl Into<String>, problem: impl Into<String>, help: impl Into<String>) {
        let file = self.file.clone();
        self.push_in(&file, field, problem, help);
    }

    /// Adds a fault in another file, such as a URDF or CSV that the specification names.
    pub fn push_in(
        &mut self,
        file: &Path,
        field: impl Into<String>,
        problem: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push_at(file, None, field, problem, help);
    }

    /// Adds a fault in line `line`, where that is known, of another file.
    pub fn push_at(
        &mut self,
        file: &Path,
        line: Option<usize>,
        field: impl Into<String>,
        problem: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.list.push(Diagnostic {
            file: file.to_path_buf(),
            line,
            column: None,
            excerpt: None,
            field: field.into(),
            problem: problem.into(),
            help: help.into(),
            part: Part::Value,
        });
    }

    /// Adds a fault of the name of a field, in this collection's file.
    pub(crate) fn push_name(
        &mut self,
        field: impl Into<String>,
        problem: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push(field, problem, help);
        if let Some(fault) = self.list.last_mut() {
            fault.part = Part::Name;
        }
    }

    /// The faults so far, to say more about their places.
    pub(crate) fn list_mut(&mut self) -> &mut [Diagnostic] {
        &mut self.list
    }

    /// Adds faults found elsewhere.
    pub fn extend(&mut self, more: impl IntoIterator<Item = Diagnostic>) {
        self.list.extend(more);
    }

    /// True while nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The faults so far, in the order in which they were found.
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Number of faults so far.
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// `Ok(value)` while nothing is wrong, all faults otherwise.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault collected so far.
    pub fn finish<T>(self, value: T) -> Result<T, Error> {
        if self.list.is_empty() { Ok(value) } else { Err(Error::Input(self.list)) }
    }

    /// The collected faults as an error.
    pub fn into_error(self) -> Error {
        Error::Input(self.list)
    }
}

/// A generated file that differs from what its specification gives.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stale {
    /// The file that differs or is missing.
    pub path: PathBuf,
    /// The command that brings it up to date.
    pub command: String,
}

/// Why a stage could not deliver.
#[non_exhaustive]
#[derive(Debug)]
pub enum Error {
    /// The input is at fault: exit code 2.
    Input(Vec<Diagnostic>),
    /// Generated files on disk differ from what their specifications give: exit code 1.
    Stale(Vec<Stale>),
    /// A defect of Gramforge itself: exit code 3.
    Internal(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Input(faults) => f.write_str(&list(faults)),
            Error::Stale(files) => f.write_str(&stale(files)),
            Error::Internal(what) => {
                write!(f, "internal error: {}; please report it with the specification", escaped(what))
            }
        }
    }
}

impl std::error::Error for Error {}

impl Error {
    /// The exit code of the process for this error: 1 check failed, 2 bad input, 3 internal.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Stale(_) => 1,
            Error::Input(_) => 2,
            Error::Internal(_) => 3,
        }
    }

    /// A single fault as an error.
    pub fn input(file: &Path, field: &str, problem: impl Into<String>, help: impl Into<String>) -> Self {
        let mut faults = Diagnostics::of(file);
        faults.push(field, problem, help);
        faults.into_error()
    }
}

fn stale(files: &[Stale]) -> String {
    let line = |file: &Stale| {
        let path = file.path.to_string_lossy();
        format!(
            "{} differs from what its specification gives; run `{}`",
            escaped(&path),
            escaped(&file.command)
        )
    };
    files.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn list(faults: &[Diagnostic]) -> String {
    let mut lines: Vec<String> = faults.iter().take(MOST_TOLD).map(Diagnostic::to_string).collect();
    if let Some(more) = faults.len().checked_sub(MOST_TOLD).filter(|more| *more > 0) {
        lines.push(format!("and {more} more"));
    }
    lines.join("\n")
}

/// A message behind its file `a.json`, line and column, which it must name unless it is about the whole file.
#[cfg(test)]
pub(crate) fn unplaced(message: &str) -> &str {
    let rest = message.strip_prefix("a.json:").unwrap_or_else(|| panic!("no file in {message}"));
    if let Some(whole) = rest.strip_prefix(' ') {
        assert!(whole.starts_with("is "), "no place in {message}");
        return whole;
    }
    let (place, rest) = rest.split_once(": ").unwrap_or_else(|| panic!("no place in {message}"));
    let numbers: Vec<usize> = place.split(':').map(|number| number.parse().expect("a number")).collect();
    assert!(numbers.len() == 2 && numbers.iter().all(|number| *number > 0), "{message}");
    rest
}
