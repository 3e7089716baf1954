//! Missing, unknown and mistyped fields: the schema's verdict, one plain message for each mistake.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use jsonschema::error::ValidationErrorKind as Kind;
use jsonschema::paths::{Location, LocationSegment};
use jsonschema::{ValidationError, Validator};
use serde_json::Value;

use super::repair::repaired;
use super::wording::{describe, either, entry, member, nearest, options, quoted, resolve, show, tag};
use crate::error::{Diagnostics, Error};
use crate::spec::Spec;

/// Largest whole number that a field takes.
const LARGEST: u32 = u32::MAX;

/// The JSON Schema of a specification file.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Spec).to_value();
    cap_integers(&mut schema);
    schema
}

/// JSON Schema's `integer` has no width: without a maximum 1e30 would pass here and fail without a field later.
fn cap_integers(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if map.get("format").and_then(Value::as_str) == Some("uint") {
                map.insert("maximum".into(), LARGEST.into());
            }
            map.values_mut().for_each(cap_integers);
        }
        Value::Array(list) => list.iter_mut().for_each(cap_integers),
        _ => {}
    }
}

// Compiling the schema costs more than checking a file, and build scripts check many.
static SCHEMA: LazyLock<Value> = LazyLock::new(schema);
static VALIDATOR: LazyLock<Result<Validator, String>> =
    LazyLock::new(|| jsonschema::validator_for(&SCHEMA).map_err(|error| error.to_string()));

fn validator() -> Result<&'static Validator, Error> {
    VALIDATOR.as_ref().map_err(|error| Error::Internal(error.clone()))
}

/// Brings `value` into the shape of a [`Spec`] where that can be done; the sections that had to be left out.
///
/// # Errors
/// [`Error::Internal`] where the schema itself is broken.
pub(super) fn repair(value: &mut Value) -> Result<Option<BTreeSet<String>>, Error> {
    Ok(repaired(value, validator()?, &SCHEMA))
}

/// Adds a fault for every place where `value` has not the shape of a [`Spec`].
///
/// # Errors
/// [`Error::Internal`] where the schema itself is broken.
pub(super) fn check(value: &Value, faults: &mut Diagnostics) -> Result<(), Error> {
    let validator = validator()?;
    let errors: Vec<_> = validator.iter_errors(value).collect();
    Explainer { schema: &SCHEMA, faults }.all(&errors);
    Ok(())
}

pub(super) struct Explainer<'a> {
    schema: &'a Value,
    faults: &'a mut Diagnostics,
}

impl<'a> Explainer<'a> {
    fn all(&mut self, errors: &[ValidationError<'_>]) {
        for error in errors {
            self.one(error, errors);
        }
    }

    /// Explains `error`; `others` are those found with it, in which a misspelt name shows as two.
    fn one(&mut self, error: &ValidationError<'_>, others: &[ValidationError<'_>]) {
        let field = field(error.instance_path());
        let instance: &Value = error.instance();
        let (parent, schema) = self.asked(error.schema_path());
        match error.kind() {
            Kind::AnyOf { context } => match meant(error, context) {
                Some(branch) => self.all(branch),
                None => self.wrong(field, instance, describe(self.schema, parent)),
            },
            Kind::OneOfNotValid { context } => self.variant(field, instance, schema, parent, context),
            Kind::AdditionalProperties { unexpected } => {
                let known: Vec<String> = properties(parent).map(str::to_string).collect();
                for name in unexpected {
                    let help = match nearest(name, properties(parent)) {
                        Some(near) => {
                            format!("did you mean `{near}`? The fields here are {}", quoted(&known))
                        }
                        None => format!("remove it; the fields here are {}", quoted(&known)),
                    };
                    self.faults.push(member(&field, name), "is not a field", help);
                }
            }
            Kind::Required { property } => {
                let name = property.as_str().unwrap_or_default();
                if misspelt(name, error.instance_path(), others) {
                    return;
                }
                let wanted = self
                    .unconditional(error.schema_path())
                    .pointer(&format!("/properties/{name}"))
                    .unwrap_or(&Value::Null);
                let meaning = wanted.get("description").and_then(Value::as_str).unwrap_or_default();
                let meaning = meaning.split("\n\n").next().unwrap_or_default().replace('\n', " ");
                let mut help = format!("write {}", describe(self.schema, wanted));
                if !meaning.is_empty() {
                    help.push_str(&format!(" ({})", meaning.trim_end_matches('.')));
                }
                self.faults.push(member(&field, name), "is missing", help);
            }
            Kind::MinItems { .. } | Kind::MaxItems { .. } => {
                let count = instance.as_array().map_or(0, Vec::len);
                let noun = if count == 1 { "entry" } else { "entries" };
                let problem = format!("has {count} {noun}: {}", show(instance));
                self.faults.push(field, problem, format!("write {}", describe(self.schema, parent)));
            }
            Kind::Minimum { limit } => {
                self.wrong(field, instance, format!("{} of at least {limit}", describe(self.schema, parent)));
            }
            Kind::Maximum { limit } => {
                self.wrong(field, instance, format!("{} of at most {limit}", describe(self.schema, parent)));
            }
            _ => self.wrong(field, instance, describe(self.schema, parent)),
        }
    }

    /// A value that is none of an enumeration's variants.
    fn variant(
        &mut self,
        field: String,
        instance: &Value,
        branches: &Value,
        parent: &Value,
        context: &[Vec<ValidationError<'static>>],
    ) {
        let allowed = options(self.schema, parent);
        let list: &[Value] = branches.as_array().map_or(&[], Vec::as_slice);
        let tags = list.iter().map(|branch| tag(resolve(self.schema, branch)));
        if let Value::Object(map) = instance {
            let found: Vec<(usize, &str)> = tags
                .enumerate()
                .filter_map(|(i, t)| Some((i, t.filter(|t| map.contains_key(*t))?)))
                .collect();
            match found.as_slice() {
                [(index, _)] => {
                    if let Some(errors) = context.get(*index) {
                        self.all(errors);
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
        if instance.is_string() || instance.is_object() {
            self.wrong(field, instance, either(&allowed));
        } else {
            self.wrong(field, instance, describe(self.schema, parent));
        }
    }

    fn wrong(&mut self, field: String, instance: &Value, wanted: String) {
        self.faults.push(field, format!("is {}", show(instance)), format!("write {wanted}"));
    }

    /// The part of the schema that holds the violated keyword, be it under a condition: `then` describes no fields.
    fn unconditional(&self, keyword: &Location) -> &'a Value {
        let (parent, _) = self.asked(keyword);
        let conditional = keyword.as_str().rsplit_once("/then/").map(|(head, _)| head);
        conditional.and_then(|head| self.schema.pointer(head)).unwrap_or(parent)
    }

    /// The fields of the object in which `keyword` was violated.
    pub(super) fn known(schema: &'a Value, keyword: &Location) -> Vec<String> {
        properties(asked(schema, keyword).0).map(str::to_string).collect()
    }

    /// The part of the schema that holds the violated keyword, and the keyword's own value.
    fn asked(&self, keyword: &Location) -> (&'a Value, &'a Value) {
        asked(self.schema, keyword)
    }
}

fn asked<'a>(schema: &'a Value, keyword: &Location) -> (&'a Value, &'a Value) {
    static NOTHING: Value = Value::Null;
    let pointer = keyword.as_str();
    let parent = pointer.rsplit_once('/').map_or("", |(head, _)| head);
    let at = |p: &str| schema.pointer(p).unwrap_or(&NOTHING);
    (at(parent), at(pointer))
}

/// The branch of an untagged union that the user evidently meant: right at its top, and least wrong below.
pub(super) fn meant<'a>(
    error: &ValidationError<'_>,
    context: &'a [Vec<ValidationError<'static>>],
) -> Option<&'a [ValidationError<'static>]> {
    let top = error.instance_path().as_str();
    let kept = context.iter().filter(|branch| {
        !branch.iter().any(|e| {
            matches!(e.kind(), Kind::Type { .. } | Kind::Constant { .. }) && e.instance_path().as_str() == top
        })
    });
    let depth = |branch: &[ValidationError<'_>]| {
        branch.iter().map(|e| e.instance_path().as_str().matches('/').count()).max().unwrap_or(0)
    };
    kept.min_by_key(|branch| (branch.len(), usize::MAX - depth(branch))).map(Vec::as_slice)
}

/// True where the missing `name` stands beside an unknown name that is nearly the same.
fn misspelt(name: &str, place: &Location, others: &[ValidationError<'_>]) -> bool {
    others.iter().any(|other| match other.kind() {
        Kind::AdditionalProperties { unexpected } if other.instance_path() == place => {
            unexpected.iter().any(|word| nearest(word, [name]).is_some())
        }
        _ => false,
    })
}

fn properties(schema: &Value) -> impl Iterator<Item = &str> {
    schema.get("properties").and_then(Value::as_object).into_iter().flatten().map(|(name, _)| name.as_str())
}

/// A JSON pointer as a field path.
fn field(location: &Location) -> String {
    let mut out = String::new();
    for segment in location {
        out = match segment {
            LocationSegment::Property(name) => member(&out, &name),
            LocationSegment::Index(index) => entry(&out, index),
        };
    }
    out
}
