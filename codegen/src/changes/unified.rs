//! The difference of two texts, as `diff -u` shows it.

use similar::TextDiff;

use super::ModuleText;

/// Lines shown around a change.
const AROUND: usize = 3;

pub(super) fn unified(before: &ModuleText, after: &ModuleText) -> String {
    if before.text == after.text {
        return String::new();
    }
    let diff = TextDiff::from_lines(&before.text, &after.text);
    diff.unified_diff().context_radius(AROUND).header(&before.name, &after.name).to_string()
}
