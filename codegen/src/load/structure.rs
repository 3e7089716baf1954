//! Missing, unknown and mistyped fields: one plain message for each mistake.

use serde_json::Value;

use super::mismatch::{Kind, Mismatch, Place, mismatches};
use super::schema::schema;
use super::wording::{describe, either, member, nearest, options, quoted, resolve, show, tag};
use crate::error::{Diagnostics, Error};

/// Adds a fault for every place where `value` has not the shape of a [`crate::spec::Spec`].
///
/// # Errors
/// [`Error::Internal`] where the schema itself is broken.
pub(super) fn check(value: &Value, faults: &mut Diagnostics) -> Result<(), Error> {
    let schema = schema()?;
    Explainer { schema, faults }.all(&mismatches(schema, value));
    Ok(())
}

struct Explainer<'a> {
    schema: &'a Value,
    faults: &'a mut Diagnostics,
}

impl Explainer<'_> {
    fn all(&mut self, mismatches: &[Mismatch<'_>]) {
        for mismatch in mismatches {
            self.one(mismatch, mismatches);
        }
    }

    /// Explains `mismatch`; `others` are those found with it, in which a misspelt name shows as two.
    fn one(&mut self, mismatch: &Mismatch<'_>, others: &[Mismatch<'_>]) {
        let Mismatch { place, value, part, kind } = mismatch;
        let field = place.field();
        let wanted = || describe(self.schema, part);
        match kind {
            Kind::Value => {
                let wanted = wanted();
                self.wrong(field, value, wanted);
            }
            Kind::Alternatives(branches) => match meant(place, branches) {
                Some(branch) => self.all(branch),
                None => {
                    let wanted = wanted();
                    self.wrong(field, value, wanted);
                }
            },
            Kind::Variants(branches) => self.variant(field, value, part, branches),
            Kind::Unknown(names) => self.unknown(&field, part, names),
            Kind::Missing(name) => {
                if !misspelt(name, place, others) {
                    self.missing(&field, part, name);
                }
            }
            Kind::Count => {
                let count = value.as_array().map_or(0, Vec::len);
                let noun = if count == 1 { "entry" } else { "entries" };
                let help = format!("write {}", wanted());
                self.faults.push(field, format!("has {count} {noun}: {}", show(value)), help);
            }
            Kind::Below(limit) => {
                let wanted = format!("{} of at least {limit}", wanted());
                self.wrong(field, value, wanted);
            }
            Kind::Above(limit) => {
                let wanted = format!("{} of at most {limit}", wanted());
                self.wrong(field, value, wanted);
            }
        }
    }

    /// Members `names` of the object at `field` that are not fields of `part`.
    fn unknown(&mut self, field: &str, part: &Value, names: &[&str]) {
        let known: Vec<String> = properties(part).map(str::to_string).collect();
        for name in names {
            let help = match nearest(name, properties(part)) {
                Some(near) => format!("did you mean `{near}`? The fields here are {}", quoted(&known)),
                None => format!("remove it; the fields here are {}", quoted(&known)),
            };
            self.faults.push_name(member(field, name), "is not a field", help);
        }
    }

    /// A field `name` of `part` that the object at `field` has not.
    fn missing(&mut self, field: &str, part: &Value, name: &str) {
        let wanted = part.get("properties").and_then(|fields| fields.get(name)).unwrap_or(&Value::Null);
        let meaning = wanted.get("description").and_then(Value::as_str).unwrap_or_default();
        let meaning = meaning.split("\n\n").next().unwrap_or_default().replace('\n', " ");
        let mut help = format!("write {}", describe(self.schema, wanted));
        if !meaning.is_empty() {
            help.push_str(&format!(" ({})", meaning.trim_end_matches('.')));
        }
        self.faults.push(member(field, name), "is missing", help);
    }

    /// A value that is none of the variants of the enumeration `part`.
    fn variant(&mut self, field: String, value: &Value, part: &Value, branches: &[Vec<Mismatch<'_>>]) {
        let list: &[Value] = part.get("oneOf").and_then(Value::as_array).map_or(&[], Vec::as_slice);
        let tags = list.iter().map(|branch| tag(resolve(self.schema, branch)));
        if let Value::Object(map) = value {
            let found: Vec<(usize, &str)> = tags
                .enumerate()
                .filter_map(|(i, t)| Some((i, t.filter(|t| map.contains_key(*t))?)))
                .collect();
            match found.as_slice() {
                [(index, _)] => {
                    if let Some(branch) = branches.get(*index) {
                        self.all(branch);
                    }
                    return;
                }
                [] => {}
                several => {
                    let names: Vec<String> = several.iter().map(|(_, t)| (*t).to_string()).collect();
                    self.faults.push(field, format!("has {} at once", quoted(&names)), "keep one of them");
                    return;
                }
            }
        }
        let wanted = if value.is_string() || value.is_object() {
            either(&options(self.schema, part))
        } else {
            describe(self.schema, part)
        };
        self.wrong(field, value, wanted);
    }

    fn wrong(&mut self, field: String, value: &Value, wanted: String) {
        self.faults.push(field, format!("is {}", show(value)), format!("write {wanted}"));
    }
}

/// The alternative that the user evidently meant for the value at `top`: right at its top, and least wrong below.
pub(super) fn meant<'m, 'a>(
    top: &Place<'_>,
    branches: &'m [Vec<Mismatch<'a>>],
) -> Option<&'m [Mismatch<'a>]> {
    let kept =
        branches.iter().filter(|branch| !branch.iter().any(|m| m.kind == Kind::Value && m.place == *top));
    let depth = |branch: &[Mismatch<'_>]| branch.iter().map(|m| m.place.depth()).max().unwrap_or(0);
    kept.min_by_key(|branch| (branch.len(), usize::MAX - depth(branch))).map(Vec::as_slice)
}

/// True where the missing `name` stands beside an unknown name that is nearly the same.
fn misspelt(name: &str, place: &Place<'_>, others: &[Mismatch<'_>]) -> bool {
    others.iter().any(|other| match &other.kind {
        Kind::Unknown(words) if other.place == *place => {
            words.iter().any(|word| nearest(word, [name]).is_some())
        }
        _ => false,
    })
}

/// The names of the fields that `part` of the schema describes.
pub(super) fn properties(part: &Value) -> impl Iterator<Item = &str> {
    part.get("properties").and_then(Value::as_object).into_iter().flatten().map(|(name, _)| name.as_str())
}
