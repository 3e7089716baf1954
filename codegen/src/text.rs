//! Characters that must not leave as they are: control characters, and those that break or turn round a line.
//!
//! Names and paths that hold them are refused where they enter ([`crate::load::plain`]); whatever is printed is escaped
//! here where it leaves: messages, warnings, directives to cargo, documentation of generated code, JSON.

use std::fmt::{self, Write as _};

/// Whether `c` moves the cursor, ends a line or turns the direction of writing instead of being seen.
///
/// These are Unicode's control characters (category Cc), its line and paragraph separator, and its marks,
/// embeddings, overrides and isolates of direction (property Bidi_Control).
pub fn is_hidden(c: char) -> bool {
    let direction =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || direction || matches!(c, '\u{2028}' | '\u{2029}')
}

/// Shows `text` on one line: hidden characters as Rust writes them, such as `\n` and `\u{202e}`, all others as they are.
pub fn escaped(text: &str) -> Escaped<'_> {
    Escaped(text)
}

/// See [`escaped`].
#[derive(Clone, Copy, Debug)]
pub struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| {
            if !is_hidden(c) {
                return f.write_char(c);
            }
            match c {
                '\n' | '\r' | '\t' => write!(f, "{}", c.escape_default()),
                _ => write!(f, "{}", c.escape_unicode()),
            }
        })
    }
}

/// `text` of several lines, each of them escaped.
pub fn escaped_lines(text: &str) -> String {
    text.split('\n').map(|line| escaped(line).to_string()).collect::<Vec<_>>().join("\n")
}

/// JSON with its hidden characters written as `\uXXXX`; the value that it stands for is the same.
///
/// serde_json escapes what JSON demands, and leaves marks of direction and the controls from U+007F on.
pub fn escaped_json(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        // Outside strings, where serde_json leaves none of the others, a line break is white space.
        if c != '\n' && is_hidden(c) {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                out.push_str(&format!("\\u{unit:04x}"));
            }
        } else {
            out.push(c);
        }
    }
    out
}

/// Most names that a message lists.
const MOST_LISTED: usize = 20;

/// Names separated by commas; of more than 20 the rest is counted.
pub(crate) fn listed(names: &[&str]) -> String {
    let shown: Vec<&str> = names.iter().take(MOST_LISTED).copied().collect();
    match names.len() - shown.len() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// "has 1 entry", "has 2 entries".
pub(crate) fn has(count: usize) -> String {
    format!("has {count} {}", if count == 1 { "entry" } else { "entries" })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: &str = "a\nb\r\t\0\x1b[31m\x7f\u{85}\u{61c}\u{200e}\u{202e}\u{2028}\u{2066}é∫";

    #[test]
    fn nothing_hidden_is_left_and_the_rest_is_kept() {
        let shown = escaped(HOSTILE).to_string();
        assert!(!shown.chars().any(is_hidden), "{shown:?}");
        assert_eq!(
            shown,
            "a\\nb\\r\\t\\u{0}\\u{1b}[31m\\u{7f}\\u{85}\\u{61c}\\u{200e}\\u{202e}\\u{2028}\\u{2066}é∫"
        );
    }

    #[test]
    fn escaped_json_stands_for_the_same_value() {
        let value = serde_json::json!({ HOSTILE: [HOSTILE, 1.5] });
        let json = escaped_json(&serde_json::to_string_pretty(&value).unwrap());
        assert!(!json.chars().any(|c| c != '\n' && is_hidden(c)), "{json:?}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&json).unwrap(), value);
    }

    #[test]
    fn long_lists_are_counted() {
        let names: Vec<String> = (0..23).map(|i| format!("n{i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        assert_eq!(listed(&names[..2]), "n0, n1");
        assert!(listed(&names[..20]).ends_with("n18, n19"));
        assert!(listed(&names).ends_with("n18, n19 and 3 more"));
    }

    #[test]
    fn lines_stay_lines() {
        assert_eq!(escaped_lines("one\ntwo\x1b\n"), "one\ntwo\\u{1b}\n");
    }
}
