//! One mistake and the one line that must come of it.

use super::input::{Input, faults};

/// One mistake in an otherwise good input.
pub struct Case {
    name: &'static str,
    spoil: fn(&mut Input),
    file: &'static str,
    field: &'static str,
    words: &'static [&'static str],
    line: Option<usize>,
}

/// A mistake in the specification: the message names `field` (empty: the file alone) and holds `words`, in order.
pub const fn case(
    name: &'static str,
    spoil: fn(&mut Input),
    field: &'static str,
    words: &'static [&'static str],
) -> Case {
    Case { name, spoil, file: "spec.json", field, words, line: None }
}

impl Case {
    /// The mistake is in `file`.
    pub const fn inside(mut self, file: &'static str) -> Self {
        self.file = file;
        self
    }

    /// The mistake is in this line.
    pub const fn line(mut self, line: usize) -> Self {
        self.line = Some(line);
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
        let file = folder.path().join(case.file).display().to_string();
        let lines: Vec<String> = lines.iter().map(|line| without_place(line, &file, case)).collect();
        let start = format!("{file}: {field}");
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

/// A message without line and column behind the name of `file`. Where a field is named, the line must be there, and in the
/// specification the column too.
fn without_place(message: &str, file: &str, case: &Case) -> String {
    let Some((place, rest)) = message.strip_prefix(file).and_then(|rest| rest.split_once(": ")) else {
        return message.to_string();
    };
    let numbers: Vec<&str> = place.split(':').filter(|part| !part.is_empty()).collect();
    let digits = numbers.iter().all(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
    let needed = match (case.field.is_empty(), case.file.ends_with(".json")) {
        (true, _) => usize::from(case.line.is_some()),
        (false, true) => 2,
        (false, false) => 1,
    };
    let wrong = case.line.is_some_and(|line| numbers.first() != Some(&line.to_string().as_str()));
    if !digits || wrong || numbers.len() < needed {
        return format!("no place in {message}");
    }
    format!("{file}: {rest}")
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
