//! Where a field stands in the text of a specification.

use std::ops::Range;

use super::comments::string;
use super::wording::{entry, member};

/// Where a field stands, bytes of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Found {
    /// Its name; empty for an entry of a list.
    pub name: Range<usize>,
    /// What it holds.
    pub value: Range<usize>,
    /// Whether the whole path was found; otherwise this is the innermost part of it that is there.
    pub whole: bool,
}

/// The place of the field `path`, such as `arm.dh.links[1].mass`, in `text`, JSON without comments. Of a name that occurs twice the last counts, as
/// in reading. `None` where the text is no object.
pub(super) fn find(text: &str, path: &str) -> Option<Found> {
    let start = space(text, 0);
    let mut found =
        Found { name: start..start, value: start..end_of_value(text, start)?, whole: path.is_empty() };
    let mut walked = String::new();
    while !found.whole {
        let Some((name, at, now)) = step(text, found.value.start, &walked, path) else { break };
        let Some(end) = end_of_value(text, at) else { break };
        found = Found { name, value: at..end, whole: now == path };
        walked = now;
    }
    Some(found)
}

/// One step on the way to `path`: from the object or list that begins at `start` and whose path is `walked` to the member or
/// entry that leads on; its name, where its value begins, and its path.
fn step(text: &str, start: usize, walked: &str, path: &str) -> Option<(Range<usize>, usize, String)> {
    let object = match text.as_bytes().get(start)? {
        b'{' => true,
        b'[' => false,
        _ => return None,
    };
    let mut taken = None;
    let (mut at, mut index) = (space(text, start + 1), 0);
    while !matches!(text.as_bytes().get(at), None | Some(b'}' | b']')) {
        let (name, value, below) = if object {
            let end = at + string(text.get(at..).filter(|rest| rest.starts_with('"'))?);
            let key: String = serde_json::from_str(text.get(at..end)?).ok()?;
            let colon = space(text, end);
            (at..end, space(text, colon + 1), member(walked, &key))
        } else {
            (at..at, at, entry(walked, index))
        };
        if leads(&below, path) {
            taken = Some((name, value, below));
        }
        let comma = space(text, end_of_value(text, value)?);
        if text.as_bytes().get(comma) != Some(&b',') {
            break;
        }
        (at, index) = (space(text, comma + 1), index + 1);
    }
    taken
}

/// Whether `path` is `part` or lies inside it.
fn leads(part: &str, path: &str) -> bool {
    path.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// The first byte from `at` on that is not white space.
fn space(text: &str, at: usize) -> usize {
    let rest = text.as_bytes().get(at..).unwrap_or_default();
    at + rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count()
}

/// The byte behind the value that begins at `start`.
fn end_of_value(text: &str, start: usize) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = start;
    loop {
        match text.as_bytes().get(at)? {
            b'"' => at += string(text.get(at..)?),
            b'{' | b'[' => (depth, at) = (depth + 1, at + 1),
            b'}' | b']' => (depth, at) = (depth.checked_sub(1)?, at + 1),
            _ if depth > 0 => at += 1,
            _ => {
                let rest = text.as_bytes().get(at..)?;
                let scalar = |byte: &&u8| !byte.is_ascii_whitespace() && !matches!(byte, b',' | b'}' | b']');
                at += rest.iter().take_while(scalar).count();
                return (at > start).then_some(at);
            }
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::find;

    const TEXT: &str = r#"{ "name": "a{b", "arm": { "dh": { "links": [ { "mass": 1.5 }, { "mass" : -2 , "x.y": [3, 4] } ] } },
        "name": "c" }"#;

    #[track_caller]
    fn shows(path: &str, name: &str, value: &str, whole: bool) {
        let found = find(TEXT, path).unwrap();
        assert_eq!((&TEXT[found.name], &TEXT[found.value], found.whole), (name, value, whole));
    }

    #[test]
    fn fields_are_found_by_their_paths() {
        shows("arm.dh.links[1].mass", "\"mass\"", "-2", true);
        shows("arm.dh.links[0]", "", "{ \"mass\": 1.5 }", true);
        shows("arm.dh.links[1].x.y[1]", "", "4", true);
        shows("name", "\"name\"", "\"c\"", true);
    }

    #[test]
    fn of_a_field_that_is_missing_the_object_is_found() {
        shows("arm.dh.links[0].com[2]", "", "{ \"mass\": 1.5 }", false);
        shows("arm.dh.linksX", "\"dh\"", &TEXT[32..97], false);
        assert_eq!(&TEXT[32..34], "{ ");
    }

    #[test]
    fn a_text_that_is_no_json_has_no_places() {
        for text in ["", "{ \"a\": ", "{ \"a\" 1", "[", "\"", "{ a: 1 }", "}", "{\"a\":}"] {
            let found = find(text, "a");
            assert!(found.is_none_or(|found| !found.whole), "{text}");
        }
    }
}
