//! One mistake and the one line that must come of it.

use crate::input::{Input, faults};

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

fn in_order(mut text: &str, words: &[&str]) -> bool {
    words.iter().all(|word| match text.split_once(word) {
        Some((_, rest)) => {
            text = rest;
            true
        }
        None => false,
    })
}
