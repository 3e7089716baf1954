//! A walk over a value and the part of the schema that describes it: every place where the two differ, all at once.

use serde_json::{Map, Value};

use super::wording::{entry, member, resolve};

/// The keywords of JSON Schema that [`mismatches`] judges; all others are notes to it.
#[cfg(test)]
pub(super) const KEYWORDS: [&str; 17] = [
    "$ref",
    "additionalProperties",
    "anyOf",
    "const",
    "enum",
    "if",
    "items",
    "maxItems",
    "maximum",
    "minItems",
    "minimum",
    "not",
    "oneOf",
    "properties",
    "required",
    "then",
    "type",
];

/// A step from a value to one inside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// To the member of this name.
    Member(&'a str),
    /// To the entry of this index.
    Entry(usize),
}

/// The way from the whole value to one inside it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Place<'a>(Vec<Step<'a>>);

impl<'a> Place<'a> {
    fn then(&self, step: Step<'a>) -> Self {
        Self(self.0.iter().copied().chain([step]).collect())
    }

    /// Number of steps.
    pub(super) fn depth(&self) -> usize {
        self.0.len()
    }

    /// The member of the whole value in which the place lies, if there is one.
    pub(super) fn section(&self) -> Option<&'a str> {
        match self.0.first()? {
            Step::Member(name) => Some(name),
            Step::Entry(_) => None,
        }
    }

    /// The place as a field path, such as `arm.dh.links[1].mass`.
    pub(super) fn field(&self) -> String {
        self.0.iter().fold(String::new(), |path, step| match step {
            Step::Member(name) => member(&path, name),
            Step::Entry(index) => entry(&path, *index),
        })
    }

    /// The place as a JSON pointer.
    pub(super) fn pointer(&self) -> String {
        self.0.iter().fold(String::new(), |path, step| match step {
            Step::Member(name) => path + "/" + &name.replace('~', "~0").replace('/', "~1"),
            Step::Entry(index) => format!("{path}/{index}"),
        })
    }
}

/// What a value breaks.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind<'a> {
    /// It is of another type, or not the one value that is allowed.
    Value,
    /// It is none of the alternatives of `anyOf`; how it differs from each.
    Alternatives(Vec<Vec<Mismatch<'a>>>),
    /// It is none of the variants of `oneOf`, or several; how it differs from each.
    Variants(Vec<Vec<Mismatch<'a>>>),
    /// It has members that are not fields.
    Unknown(Vec<&'a str>),
    /// It has not the field of this name.
    Missing(&'a str),
    /// It is a list of too few or too many entries.
    Count,
    /// It is a number below this one.
    Below(&'a Value),
    /// It is a number above this one.
    Above(&'a Value),
}

/// A place where a value has not the shape that the schema describes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mismatch<'a> {
    /// Where in the whole value.
    pub(super) place: Place<'a>,
    /// What stands there.
    pub(super) value: &'a Value,
    /// The part of the schema that it breaks.
    pub(super) part: &'a Value,
    /// What it breaks.
    pub(super) kind: Kind<'a>,
}

/// Every mismatch of `value` with the schema `root`: inside an object first those of its members, then unknown members,
/// then missing ones.
pub(super) fn mismatches<'a>(root: &'a Value, value: &'a Value) -> Vec<Mismatch<'a>> {
    let mut found = Vec::new();
    Walk { root }.all(root, value, &Place::default(), &mut found);
    found
}

struct Walk<'a> {
    root: &'a Value,
}

impl<'a> Walk<'a> {
    /// Adds what `value` at `place` breaks of `part`.
    fn all(&self, part: &'a Value, value: &'a Value, place: &Place<'a>, found: &mut Vec<Mismatch<'a>>) {
        let part = resolve(self.root, part);
        let mut add = |kind: Kind<'a>| found.push(Mismatch { place: place.clone(), value, part, kind });
        if !of_type(part, value) || !among_constants(part, value) {
            add(Kind::Value);
        }
        if let Some(limit) = broken_limit(part, "minimum", value, |x, limit| x < limit) {
            add(Kind::Below(limit));
        }
        if let Some(limit) = broken_limit(part, "maximum", value, |x, limit| x > limit) {
            add(Kind::Above(limit));
        }
        if let Value::Array(list) = value {
            let bound = |key: &str| part.get(key).and_then(Value::as_u64);
            let count = list.len() as u64;
            if bound("minItems").is_some_and(|least| count < least)
                || bound("maxItems").is_some_and(|most| count > most)
            {
                add(Kind::Count);
            }
            if let Some(items) = part.get("items") {
                for (index, value) in list.iter().enumerate() {
                    self.all(items, value, &place.then(Step::Entry(index)), found);
                }
            }
        }
        if let Value::Object(members) = value {
            self.object(part, value, members, place, found);
        }
        self.choices(part, value, place, found);
    }

    /// Adds what is wrong with the `members` of the object `value`.
    fn object(
        &self,
        part: &'a Value,
        value: &'a Value,
        members: &'a Map<String, Value>,
        place: &Place<'a>,
        found: &mut Vec<Mismatch<'a>>,
    ) {
        let fields = part.get("properties").and_then(Value::as_object);
        let others = part.get("additionalProperties");
        let mut unknown = Vec::new();
        for (name, member) in members {
            match fields.and_then(|fields| fields.get(name)).or(others) {
                Some(Value::Bool(false)) => unknown.push(name.as_str()),
                Some(part) => self.all(part, member, &place.then(Step::Member(name)), found),
                None => {}
            }
        }
        let mut add = |kind| found.push(Mismatch { place: place.clone(), value, part, kind });
        if !unknown.is_empty() {
            add(Kind::Unknown(unknown));
        }
        let missing = required(part).filter(|name| !members.contains_key(*name));
        missing.for_each(|name| add(Kind::Missing(name)));
    }

    /// Adds what `value` breaks of the keywords that choose between parts of the schema.
    fn choices(&self, part: &'a Value, value: &'a Value, place: &Place<'a>, found: &mut Vec<Mismatch<'a>>) {
        let each = |key: &str| -> Option<Vec<Vec<Mismatch<'a>>>> {
            let branches = part.get(key)?.as_array()?;
            Some(branches.iter().map(|branch| self.within(branch, value, place)).collect())
        };
        let fitting = |branches: &[Vec<_>]| branches.iter().filter(|branch| branch.is_empty()).count();
        let mut add = |kind| found.push(Mismatch { place: place.clone(), value, part, kind });
        if let Some(branches) = each("anyOf").filter(|branches| fitting(branches) == 0) {
            add(Kind::Alternatives(branches));
        }
        if let Some(branches) = each("oneOf").filter(|branches| fitting(branches) != 1) {
            add(Kind::Variants(branches));
        }
        let holds = part.get("if").is_some_and(|condition| self.fits(condition, value));
        if let Some(then) = part.get("then").filter(|_| holds) {
            // The condition names fields that are described where it stands.
            found.extend(
                self.within(then, value, place).into_iter().map(|mismatch| Mismatch { part, ..mismatch }),
            );
        }
    }

    fn within(&self, part: &'a Value, value: &'a Value, place: &Place<'a>) -> Vec<Mismatch<'a>> {
        let mut found = Vec::new();
        self.all(part, value, place, &mut found);
        found
    }

    /// Whether `value` meets a condition, `not` included.
    fn fits(&self, condition: &'a Value, value: &'a Value) -> bool {
        let excluded = condition.get("not").is_some_and(|part| self.fits(part, value));
        !excluded && self.within(condition, value, &Place::default()).is_empty()
    }
}

/// The names that an object must have.
fn required(part: &Value) -> impl Iterator<Item = &str> {
    part.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
}

fn of_type(part: &Value, value: &Value) -> bool {
    let is = |name: &Value| match name.as_str() {
        Some("null") => value.is_null(),
        Some("boolean") => value.is_boolean(),
        Some("number") => value.is_number(),
        Some("integer") => is_whole(value),
        Some("string") => value.is_string(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        _ => false,
    };
    match part.get("type") {
        None => true,
        Some(Value::Array(several)) => several.iter().any(is),
        Some(one) => is(one),
    }
}

/// 2.0 is a whole number too.
fn is_whole(value: &Value) -> bool {
    value.is_i64() || value.is_u64() || value.as_f64().is_some_and(|x| x.fract() == 0.0)
}

fn among_constants(part: &Value, value: &Value) -> bool {
    part.get("const").is_none_or(|only| only == value)
        && part.get("enum").and_then(Value::as_array).is_none_or(|list| list.contains(value))
}

/// The limit `key` of `part` where the number `value` breaks it.
fn broken_limit<'a>(
    part: &'a Value,
    key: &str,
    value: &Value,
    breaks: impl Fn(f64, f64) -> bool,
) -> Option<&'a Value> {
    let limit = part.get(key)?;
    breaks(value.as_f64()?, limit.as_f64()?).then_some(limit)
}
