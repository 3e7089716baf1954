//! How faults are shown: for people with the line and a mark under the fault, for programs as JSON.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use serde::Serialize;

use crate::error::{Diagnostic, Error, Excerpt, MOST_TOLD};
use crate::text::escaped;

/// Columns that a line with its mark may take: an excerpt is short, but for hidden characters that are written out.
const WIDTH: usize = 1000;

/// The text of `error`: each fault in one line, under it the place where that is known.
pub(super) fn shown(error: &Error, colored: bool) -> String {
    let Error::Input(faults) = error else { return error.to_string() };
    let mut out: Vec<String> = faults.iter().take(MOST_TOLD).map(|fault| one(fault, colored)).collect();
    if faults.len() > MOST_TOLD {
        out.push(format!("and {} more", faults.len() - MOST_TOLD));
    }
    out.join("\n")
}

fn one(fault: &Diagnostic, colored: bool) -> String {
    let line = fault.to_string();
    let Some(excerpt) = &fault.excerpt else { return line };
    let Excerpt { text, range } = plain(excerpt);
    let renderer = if colored { Renderer::styled() } else { Renderer::plain() };
    let place = Snippet::source(text.as_str())
        .line_start(fault.line.unwrap_or(1))
        .annotation(AnnotationKind::Primary.span(range));
    let report = [Level::ERROR.no_name().primary_title(line.as_str()).element(place)];
    renderer.term_width(WIDTH).render(&report)
}

/// The same excerpt with its hidden characters written out.
fn plain(excerpt: &Excerpt) -> Excerpt {
    let part = |from: usize, to: usize| {
        let part = excerpt.text.get(from..to).unwrap_or_default().replace('\t', "    ");
        escaped(&part).to_string()
    };
    let before = part(0, excerpt.range.start);
    let at_fault = part(excerpt.range.start, excerpt.range.end);
    let after = part(excerpt.range.end, excerpt.text.len());
    let range = before.len()..before.len() + at_fault.len();
    Excerpt { text: before + &at_fault + &after, range }
}

#[derive(Serialize)]
struct Faults<'a> {
    errors: Vec<Fault<'a>>,
}

/// One fault; lines and columns count from 1, columns in characters. The end is behind the last character.
#[derive(Serialize)]
struct Fault<'a> {
    file: String,
    line: Option<usize>,
    column: Option<usize>,
    end_column: Option<usize>,
    field: &'a str,
    problem: &'a str,
    help: &'a str,
}

/// All faults of `error` as JSON.
///
/// # Errors
/// [`Error::Internal`] for defects.
pub(super) fn json(error: &Error) -> Result<String, Error> {
    let whole = error.to_string();
    let errors = match error {
        Error::Input(faults) => faults.iter().map(fault).collect(),
        Error::Stale(files) => files
            .iter()
            .map(|file| Fault {
                file: file.path.display().to_string(),
                problem: "differs from what its specification gives",
                help: &file.command,
                ..nowhere()
            })
            .collect(),
        Error::Internal(_) => vec![Fault { problem: &whole, ..nowhere() }],
    };
    super::json(&Faults { errors })
}

fn nowhere<'a>() -> Fault<'a> {
    Fault {
        file: String::new(),
        line: None,
        column: None,
        end_column: None,
        field: "",
        problem: "",
        help: "",
    }
}

fn fault(fault: &Diagnostic) -> Fault<'_> {
    let width = fault.excerpt.as_ref().and_then(|excerpt| excerpt.text.get(excerpt.range.clone()));
    let width = width.map(|text| text.chars().count());
    Fault {
        file: fault.file.display().to_string(),
        line: fault.line,
        column: fault.column,
        end_column: fault.column.zip(width).map(|(column, width)| column + width),
        field: &fault.field,
        problem: &fault.problem,
        help: &fault.help,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{json, shown};
    use crate::load::parse;

    const TEXT: &str = "{\n  \"arm\": { \"urdf\": \"a.urdf\" },\n  \"modell\": \"exact\"\n}";

    #[test]
    fn a_fault_stands_over_the_line_that_holds_it() {
        let error = parse(TEXT, Path::new("a.json")).expect_err("a fault");
        let text = shown(&error, false);
        let mut lines = text.lines();
        assert!(
            lines
                .next()
                .is_some_and(|line| line.starts_with("a.json:3:3: modell: is not a field; did you mean"))
        );
        let rest: Vec<&str> = lines.map(str::trim_end).collect();
        assert_eq!(rest, ["  |", "3 |   \"modell\": \"exact\"", "  |   ^^^^^^^^"]);
        assert!(shown(&error, true).contains("\u{1b}["));
    }

    #[test]
    fn faults_as_json_have_the_same_places() {
        let error = parse(TEXT, Path::new("a.json")).expect_err("a fault");
        let value: serde_json::Value = serde_json::from_str(&json(&error).expect("JSON")).expect("JSON");
        let fault = &value["errors"][0];
        assert_eq!(fault["line"], 3);
        assert_eq!((&fault["column"], &fault["end_column"]), (&3.into(), &11.into()));
        assert_eq!(fault["field"], "modell");
    }
}
