//! One mistake and the one line that must come of it.

use super::input::{Input, faults};

/// One mistake in an otherwise good input.
pub struct Case {
    name: &'static str,
    spoil: fn(&mut Input),
    file: &'static str,
    field: &'static str,
    words: &'static [&'static str],
}

/// A mistake in the specification: the message names `field` (empty: the file alone) and holds `words`, in order.
pub const fn case(
    name: &'static str,
    spoil: fn(&mut Input),
    field: &'static str,
    words: &'static [&'static str],
) -> Case {
    Case { name, spoil, file: "spec.json", field, words }
}

impl Case {
    /// The mistake is in `file`.
    pub const fn inside(mut self, file: &'static str) -> Self {
        self.file = file;
        self
    }
}

/// Every case gives its one line.
pub fn judge(cases: &[Case]) {
    let mut failures = Vec::new();
    for case in cases {
        let folder = tempfile::tempdir().expect("a folder");
        let mut input = Input::good();
        (case.spoil)(&mut input);
        let spec = input.write(folder.path(), "spec.json");
        let lines = faults(folder.path(), &[spec]);
        let field = if case.field.is_empty() { String::new() } else { format!("{}: ", case.field) };
        let start = format!("{}: {field}", folder.path().join(case.file).display());
        let lines: Vec<String> = lines.iter().map(|line| without_line(line, case)).collect();
        let good = matches!(lines.as_slice(), [line] if line.starts_with(&start)
            && in_order(&line[start.len()..], case.words)
            && line[start.len()..].contains("; "));
        if !good {
            let lines = lines.join("\n    ").replace(&folder.path().display().to_string(), "…");
            failures.push(format!("{}: {field}{:?}\n    {lines}", case.name, case.words));
        }
    }
    assert!(failures.is_empty(), "{} of {} cases:\n{}", failures.len(), cases.len(), failures.join("\n"));
}

/// A message without the line number behind a URDF file's name, which must be there where a field of it is named.
fn without_line(message: &str, case: &Case) -> String {
    let Some((file, rest)) = message.split_once(".urdf:").filter(|_| case.file.ends_with(".urdf")) else {
        return message.to_string();
    };
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    if digits == 0 && !case.field.is_empty() {
        return format!("no line in {message}");
    }
    format!(
        "{file}.urdf:{}",
        &rest[digits..].strip_prefix(':').filter(|_| digits > 0).map_or(rest, |rest| rest)
    )
}

fn in_order(mut text: &str, words: &[&str]) -> bool {
    words.iter().all(|word| match text.split_once(word) {
        Some((_, rest)) => {
            text = rest;
            true
        }
        None => false,
    })
}
