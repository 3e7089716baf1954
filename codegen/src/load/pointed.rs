//! The place of each fault: line, column and the text that is at fault.

use std::ops::Range;
use std::path::Path;

use super::comments::blanked;
use super::place::find;
use super::{Loaded, Named};
use crate::error::{Diagnostic, Diagnostics, Error, Excerpt, MOST_TOLD, Part};

/// Most characters of a line that are shown: JSON may stand on one line.
const WIDEST: usize = 96;

impl Error {
    /// The same faults, those of the specification `text` at `path` with their places.
    pub(crate) fn pointing_into(self, path: &Path, text: &str) -> Self {
        self.pointing(path, text, &[])
    }

    /// The same faults with their places in the specification and the files that it names.
    pub(crate) fn pointing_into_files(self, loaded: &Loaded) -> Self {
        self.pointing(&loaded.path, &loaded.text, &loaded.named)
    }

    fn pointing(mut self, path: &Path, text: &str, named: &[Named]) -> Self {
        if let Error::Input(faults) = &mut self {
            // What is not shown needs no place.
            let mut shown =
                faults.iter_mut().take(MOST_TOLD).filter(|fault| fault.excerpt.is_none()).peekable();
            if shown.peek().is_none() {
                return self;
            }
            let plain = blanked(text, &mut Diagnostics::of(path)).unwrap_or_default();
            shown.for_each(|fault| {
                if fault.file != path {
                    let file = named.iter().find(|named| named.path == fault.file);
                    if let Some(Ok(text)) = file.map(Named::text) {
                        point_by_line(fault, text);
                    }
                } else if fault.line.is_some() {
                    point_by_line(fault, text);
                } else {
                    point_by_field(fault, text, &plain);
                }
            });
        }
        self
    }
}

/// Finds the field of `fault` in `text`, whose comments are blanked in `plain`.
fn point_by_field(fault: &mut Diagnostic, text: &str, plain: &str) {
    if fault.field.is_empty() {
        return;
    }
    let Some(found) = find(plain, &fault.field) else { return };
    let range = match fault.part {
        Part::Name if found.whole && !found.name.is_empty() => found.name,
        // Of what is missing, the name of the object that lacks it.
        _ if !found.whole && !found.name.is_empty() => found.name,
        _ => found.value,
    };
    // Blanked comments have as many characters as the text, but not as many bytes.
    let characters = |end: usize| plain.get(..end).map(|before| before.chars().count());
    let (Some(start), Some(end)) = (characters(range.start), characters(range.end)) else { return };
    let byte = |count: usize| text.char_indices().nth(count).map_or(text.len(), |(at, _)| at);
    mark(fault, text, byte(start)..byte(end));
}

/// Finds in the line of `fault` what its field names.
fn point_by_line(fault: &mut Diagnostic, text: &str) {
    let Some(number) = fault.line else { return };
    let Some(line) = text.split('\n').nth(number.saturating_sub(1)) else { return };
    let line = line.trim_end();
    let start = line.len() - line.trim_start().len();
    let within = match fault.column {
        Some(column) => {
            let from = line.char_indices().nth(column.saturating_sub(1)).map_or(line.len(), |(at, _)| at);
            from..line.len().min(from + 1)
        }
        None => {
            attribute(line, fault.field.rsplit('.').next().unwrap_or_default()).unwrap_or(start..line.len())
        }
    };
    let offset: usize = text.split_inclusive('\n').take(number.saturating_sub(1)).map(str::len).sum();
    mark(fault, text, offset + within.start..offset + within.end);
}

/// Where the value of the XML attribute `name` stands in `line`.
fn attribute(line: &str, name: &str) -> Option<Range<usize>> {
    let start = line.find(&format!(" {name}=\""))? + name.len() + 3;
    let length = line.get(start..)?.find('"')?;
    (!name.is_empty() && length > 0).then_some(start..start + length)
}

/// Gives `fault` the line and column of `range` in `text`, and what stands there, to the end of its first line.
fn mark(fault: &mut Diagnostic, text: &str, range: Range<usize>) {
    let (Some(before), Some(rest)) = (text.get(..range.start), text.get(range.start..)) else { return };
    let begin = before.rfind('\n').map_or(0, |at| at + 1);
    let lead = text.get(begin..range.start).unwrap_or_default();
    let tail = rest.split('\n').next().unwrap_or_default().trim_end();
    let at_fault = tail.get(..range.len().min(tail.len())).unwrap_or(tail);
    fault.line = Some(before.matches('\n').count() + 1);
    fault.column = Some(lead.chars().count() + 1);
    fault.excerpt = Some(excerpt(lead, at_fault, tail.get(at_fault.len()..).unwrap_or_default()));
}

/// A line of three parts, of which the middle is at fault; the others are cut where the line is very long.
fn excerpt(lead: &str, at_fault: &str, tail: &str) -> Excerpt {
    let at_fault: String = at_fault.chars().take(WIDEST).collect();
    let room = WIDEST - at_fault.chars().count();
    let ahead = lead.chars().count();
    let kept = ahead.min(room.max(WIDEST / 4));
    let mut text: String = if kept < ahead { "…".into() } else { String::new() };
    text.extend(lead.chars().skip(ahead - kept));
    let start = text.len();
    text.push_str(&at_fault);
    let end = text.len();
    let left = room.saturating_sub(kept);
    text.extend(tail.chars().take(left));
    if tail.chars().count() > left {
        text.push('…');
    }
    Excerpt { text, range: start..end }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::error::{Diagnostic, Error};
    use crate::load::parse;

    fn first(text: &str) -> Diagnostic {
        match parse(text, Path::new("arm.jsonc")) {
            Err(Error::Input(faults)) => faults[0].clone(),
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    fn points(text: &str, place: (usize, usize), shown: &str) {
        let fault = first(text);
        assert_eq!((fault.line, fault.column), (Some(place.0), Some(place.1)), "{fault}");
        let excerpt = fault.excerpt.expect("an excerpt");
        assert_eq!(&excerpt.text[excerpt.range], shown);
    }

    #[test]
    fn a_fault_points_at_what_is_wrong() {
        points("{\n  \"arm\": 3\n}", (2, 10), "3");
        points("{\n  \"arm\": {}, \"colour\": 1\n}", (2, 14), "\"colour\"");
        points("{ \"arm\": {\"dh\":\n {\"convention\": \"standard\"} } }", (1, 11), "\"dh\"");
        points("{ /* ψ */ \"arm\": \"ψ\" }", (1, 18), "\"ψ\"");
        points("{\n \"arm\" {} }", (2, 8), "{");
    }

    #[test]
    fn a_long_line_is_cut_around_the_fault() {
        let text = format!(
            "{{ \"name\": \"{}\", \"arm\": 7, \"model\": \"exact\" {} }}",
            "n".repeat(300),
            " ".repeat(300)
        );
        let excerpt = first(&text).excerpt.expect("an excerpt");
        assert!(excerpt.text.chars().count() <= 100, "{}", excerpt.text);
        assert_eq!(&excerpt.text[excerpt.range], "7");
    }
}
