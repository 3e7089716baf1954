//! What can still be read of a specification of the wrong shape, so that the faults of its values are told with those of
//! its shape: unknown fields are taken for what they were meant to be or left out, sections that cannot be read are left
//! out as a whole.

use std::collections::BTreeSet;

use jsonschema::error::ValidationErrorKind as Kind;
use jsonschema::{ValidationError, Validator};
use serde_json::{Value, json};

use super::structure::{Explainer, meant};
use super::wording::nearest;

/// Rounds of repair: a field that was taken for another may be of the wrong type in turn.
const ROUNDS: usize = 4;

/// Brings `value` into the shape of a specification; the sections that had to be left out, or `None` where that does not
/// help.
pub(super) fn repaired(value: &mut Value, validator: &Validator, schema: &Value) -> Option<BTreeSet<String>> {
    let mut lost = BTreeSet::new();
    for _ in 0..ROUNDS {
        let mut changes = Vec::new();
        for error in validator.iter_errors(value) {
            gather(&error, schema, &mut changes);
        }
        if changes.is_empty() {
            return Some(lost);
        }
        for change in changes {
            change.make(value, &mut lost);
        }
    }
    validator.is_valid(value).then_some(lost)
}

/// A change of the value at a JSON pointer.
enum Change {
    /// Removes the member `from`, or calls it `to`.
    Rename { object: String, from: String, to: Option<String> },
    /// Leaves out the section in which the pointer lies.
    Cut { place: String },
}

impl Change {
    fn make(self, value: &mut Value, lost: &mut BTreeSet<String>) {
        match self {
            Self::Rename { object, from, to } => {
                let Some(map) = value.pointer_mut(&object).and_then(Value::as_object_mut) else { return };
                let Some(moved) = map.remove(&from) else { return };
                if let Some(to) = to.filter(|to| !map.contains_key(to)) {
                    map.insert(to, moved);
                }
            }
            Self::Cut { place } => {
                let Some(map) = value.as_object_mut() else { return };
                let section = place.split('/').nth(1).unwrap_or_default().to_string();
                match section.as_str() {
                    // The two that a specification cannot do without: nothing is said of what stands in for them.
                    "" => {
                        for (name, stand_in) in [("name", json!("arm")), ("arm", json!({}))] {
                            if !map.contains_key(name) {
                                map.insert(name.into(), stand_in);
                                lost.insert(name.into());
                            }
                        }
                        return;
                    }
                    "name" => drop(map.insert(section.clone(), json!("arm"))),
                    "arm" => drop(map.insert(section.clone(), json!({}))),
                    _ => drop(map.remove(&section)),
                }
                lost.insert(section);
            }
        }
    }
}

/// The changes that do away with `error`.
fn gather(error: &ValidationError<'_>, schema: &Value, changes: &mut Vec<Change>) {
    let place = error.instance_path().as_str().to_string();
    match error.kind() {
        Kind::AdditionalProperties { unexpected } => {
            let known = Explainer::known(schema, error.schema_path());
            for name in unexpected {
                let near = nearest(name, known.iter().map(String::as_str)).map(str::to_string);
                changes.push(Change::Rename { object: place.clone(), from: name.clone(), to: near });
            }
        }
        Kind::AnyOf { context } => match meant(error, context) {
            Some(branch) if !branch.is_empty() => {
                branch.iter().for_each(|error| gather(error, schema, changes))
            }
            _ => changes.push(Change::Cut { place }),
        },
        Kind::OneOfNotValid { context } => {
            // The variant that is least wrong: one with unknown fields only, if there is one.
            let unknown = |branch: &&Vec<ValidationError<'static>>| {
                !branch.is_empty()
                    && branch.iter().all(|e| matches!(e.kind(), Kind::AdditionalProperties { .. }))
            };
            let inside = |branch: &&Vec<ValidationError<'static>>| {
                branch.iter().all(|e| e.instance_path().as_str().len() > place.len())
            };
            match context.iter().filter(unknown).find(inside) {
                Some(branch) => branch.iter().for_each(|error| gather(error, schema, changes)),
                None => changes.push(Change::Cut { place }),
            }
        }
        // A required field that stands there misspelt comes back under its own name.
        Kind::Required { .. } if place.is_empty() => changes.push(Change::Cut { place }),
        Kind::Required { .. }
            if changes
                .iter()
                .any(|c| matches!(c, Change::Rename { object, to: Some(_), .. } if *object == place)) => {}
        _ => changes.push(Change::Cut { place }),
    }
}
