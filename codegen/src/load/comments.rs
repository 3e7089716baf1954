//! Comments in specifications: `// to the end of the line` and `/* between marks */`, as editors know them from JSONC.

use crate::error::Diagnostics;

/// `text` with a space for every byte of a comment, so that each place keeps its line and column; `None` after the fault of a
/// comment that does not end.
pub(super) fn blanked(text: &str, faults: &mut Diagnostics) -> Option<String> {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(['"', '/']) {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let end = if from.starts_with('"') {
            let end = string(from);
            out.push_str(from.get(..end)?);
            end
        } else if let Some(end) = comment(from) {
            let Some(end) = end else {
                endless(text, text.len() - from.len(), faults);
                return None;
            };
            out.extend(from.get(..end)?.chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
            end
        } else {
            out.push('/');
            1
        };
        rest = from.get(end..)?;
    }
    out.push_str(rest);
    Some(out)
}

/// Length of the string that `from` begins with, bytes; all of it where the string does not end.
pub(super) fn string(from: &str) -> usize {
    let mut escaped = false;
    for (at, byte) in from.bytes().enumerate().skip(1) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return at + 1,
            _ => {}
        }
    }
    from.len()
}

/// Length of the comment that `from` begins with, bytes: `None` where it begins with none, `Some(None)` where the comment
/// does not end.
fn comment(from: &str) -> Option<Option<usize>> {
    if from.starts_with("//") {
        return Some(Some(from.find('\n').unwrap_or(from.len())));
    }
    let inside = from.strip_prefix("/*")?;
    Some(inside.find("*/").map(|end| end + 4))
}

fn endless(text: &str, at: usize, faults: &mut Diagnostics) {
    let before = text.get(..at).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    let file = faults.file().to_path_buf();
    faults.push_at(&file, Some(line), "", "is a comment that does not end", "end it with */");
    if let Some(fault) = faults.list_mut().last_mut() {
        fault.column = Some(column);
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::blanked;
    use crate::error::Diagnostics;

    fn without(text: &str) -> Option<String> {
        blanked(text, &mut Diagnostics::of(Path::new("arm.jsonc")))
    }

    #[test]
    fn comments_become_spaces_and_strings_stay() {
        let text = "{ // a \"b\n \"u\": \"http://x /* y */\", /* 1\n2 */ \"q\\\"//\": 1 } / // end";
        let blank = without(text).unwrap();
        assert_eq!(blank, "{        \n \"u\": \"http://x /* y */\",     \n     \"q\\\"//\": 1 } /       ");
        assert_eq!(without("no comment"), Some("no comment".into()));
    }

    #[test]
    fn every_place_keeps_its_line_and_column() {
        // Columns count characters, so a comment of two-byte characters becomes as many spaces as it has characters.
        let blank = without("/* ψ */ 1").unwrap();
        assert_eq!(blank.chars().count(), "/* ψ */ 1".chars().count());
    }

    #[test]
    fn a_comment_without_end_is_told_where_it_begins() {
        let mut faults = Diagnostics::of(Path::new("arm.jsonc"));
        assert_eq!(blanked("{\n  /* x }", &mut faults), None);
        assert_eq!(
            faults.list()[0].to_string(),
            "arm.jsonc:2:3: is a comment that does not end; end it with */"
        );
    }
}
