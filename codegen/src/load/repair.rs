//! What can still be read of a specification of the wrong shape, so that the faults of its values are told with those of
//! its shape: unknown fields are taken for what they were meant to be or left out, sections that cannot be read are left
//! out as a whole.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::mismatch::{Kind, Mismatch, mismatches};
use super::schema::schema;
use super::structure::{meant, properties};
use super::wording::nearest;
use crate::error::Error;

/// Rounds of repair: a field that was taken for another may be of the wrong type in turn.
const ROUNDS: usize = 4;

/// Brings `value` into the shape of a specification; the sections that had to be left out, or `None` where that does not
/// help.
///
/// # Errors
/// [`Error::Internal`] where the schema itself is broken.
pub(super) fn repair(value: &mut Value) -> Result<Option<BTreeSet<String>>, Error> {
    let schema = schema()?;
    let mut lost = BTreeSet::new();
    for _ in 0..ROUNDS {
        let mut changes = Vec::new();
        mismatches(schema, value).iter().for_each(|mismatch| gather(mismatch, &mut changes));
        if changes.is_empty() {
            return Ok(Some(lost));
        }
        for change in changes {
            change.make(value, &mut lost);
        }
    }
    Ok(mismatches(schema, value).is_empty().then_some(lost))
}

/// A change of the value at a JSON pointer.
enum Change {
    /// Removes the member `from`, or calls it `to`.
    Rename { object: String, from: String, to: Option<String> },
    /// Leaves out this section; without one, puts in what a specification cannot do without.
    Cut { section: Option<String> },
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
            Self::Cut { section } => {
                let Some(map) = value.as_object_mut() else { return };
                let Some(section) = section else {
                    // Nothing is said of what stands in for these.
                    for (name, stand_in) in [("name", json!("arm")), ("arm", json!({}))] {
                        if !map.contains_key(name) {
                            map.insert(name.into(), stand_in);
                            lost.insert(name.into());
                        }
                    }
                    return;
                };
                match section.as_str() {
                    "name" => drop(map.insert(section.clone(), json!("arm"))),
                    "arm" => drop(map.insert(section.clone(), json!({}))),
                    _ => drop(map.remove(&section)),
                }
                lost.insert(section);
            }
        }
    }
}

/// The changes that do away with `mismatch`.
fn gather(mismatch: &Mismatch<'_>, changes: &mut Vec<Change>) {
    let place = &mismatch.place;
    let cut = || Change::Cut { section: place.section().map(str::to_string) };
    match &mismatch.kind {
        Kind::Unknown(names) => {
            for name in names {
                let to = nearest(name, properties(mismatch.part)).map(str::to_string);
                changes.push(Change::Rename { object: place.pointer(), from: (*name).to_string(), to });
            }
        }
        Kind::Alternatives(branches) => match meant(place, branches) {
            Some(branch) if !branch.is_empty() => {
                branch.iter().for_each(|mismatch| gather(mismatch, changes))
            }
            _ => changes.push(cut()),
        },
        Kind::Variants(branches) => {
            // The variant that is least wrong: one with unknown fields only, if there is one.
            let unknown = |branch: &&Vec<Mismatch<'_>>| {
                !branch.is_empty() && branch.iter().all(|m| matches!(m.kind, Kind::Unknown(_)))
            };
            let inside = |branch: &&Vec<Mismatch<'_>>| branch.iter().all(|m| m.place.depth() > place.depth());
            match branches.iter().filter(unknown).find(inside) {
                Some(branch) => branch.iter().for_each(|mismatch| gather(mismatch, changes)),
                None => changes.push(cut()),
            }
        }
        // A required field that stands there misspelt comes back under its own name.
        Kind::Missing(_) if place.depth() > 0 && renamed_in(&place.pointer(), changes) => {}
        _ => changes.push(cut()),
    }
}

fn renamed_in(place: &str, changes: &[Change]) -> bool {
    changes.iter().any(|c| matches!(c, Change::Rename { object, to: Some(_), .. } if object == place))
}
