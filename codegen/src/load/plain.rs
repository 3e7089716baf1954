//! The one place where text enters: names, paths and keys are what they look like, or are refused.

use std::path::Path;

use serde_json::Value;

use super::wording::{entry, member};
use crate::error::Diagnostics;
use crate::text::is_hidden;

/// Whether `value`, a name or path that stands at `field` of `file`, in `line` where that is known, holds no hidden character (see
/// [`crate::text::is_hidden`]); adds a fault where it does.
pub fn plain(value: &str, file: &Path, line: Option<usize>, field: &str, faults: &mut Diagnostics) -> bool {
    let hidden = value.chars().find(|c| is_hidden(*c));
    if let Some(c) = hidden {
        let problem = format!("is {value:?}, with the hidden character U+{:04X}", u32::from(c));
        let help = "write it without control characters, line breaks and marks of writing direction";
        faults.push_at(file, line, field, problem, help);
    }
    hidden.is_none()
}

/// Adds a fault for every text and every key of `value` that is not plain.
pub(super) fn check(value: &Value, faults: &mut Diagnostics) {
    let file = faults.file().to_path_buf();
    walk(value, "", &file, faults);
}

fn walk(value: &Value, field: &str, file: &Path, faults: &mut Diagnostics) {
    match value {
        Value::String(text) => {
            plain(text, file, None, field, faults);
        }
        Value::Array(list) => {
            for (index, value) in list.iter().enumerate() {
                walk(value, &entry(field, index), file, faults);
            }
        }
        Value::Object(map) => {
            for (key, value) in map {
                let field = member(field, key);
                plain(key, file, None, &field, faults);
                walk(value, &field, file, faults);
            }
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}
