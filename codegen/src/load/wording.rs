//! How fields, values and expectations are put into words.

use serde_json::Value;

/// Most characters of a key that a field path shows.
const LONGEST_KEY: usize = 100;

/// Field path of `key` inside `path`; a key of more than 100 characters is cut.
pub(super) fn member(path: &str, key: &str) -> String {
    let cut: String;
    let key = match key.char_indices().nth(LONGEST_KEY) {
        Some((end, _)) => {
            cut = format!("{}…", key.get(..end).unwrap_or_default());
            &cut
        }
        None => key,
    };
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

/// Field path of entry `index` of the list `path`.
pub(super) fn entry(path: &str, index: usize) -> String {
    format!("{path}[{index}]")
}

/// `value` as the user wrote it, cut where it is long.
pub(super) fn show(value: &Value) -> String {
    const LONGEST: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        return text;
    }
    let head: String = text.chars().take(LONGEST).collect();
    format!("{head}…")
}

/// What the part `schema` of the schema `root` asks for, such as "a list of 3 numbers".
pub(super) fn describe(root: &Value, schema: &Value) -> String {
    let schema = resolve(root, schema);
    let one = options(root, schema);
    if !one.is_empty() {
        return either(&one);
    }
    if let Some(branches) = schema.get("anyOf").and_then(Value::as_array) {
        let all: Vec<String> = branches.iter().filter(|s| !is_null(s)).map(|s| describe(root, s)).collect();
        return all.join(" or ");
    }
    match kind(schema) {
        Some("number") => "a number".into(),
        Some("integer") => "a whole number".into(),
        Some("string") => "a text in double quotes".into(),
        Some("boolean") => "true or false".into(),
        Some("array") => {
            let items = schema.get("items").map_or_else(|| "values".into(), |s| plural(root, s));
            match (bound(schema, "minItems"), bound(schema, "maxItems")) {
                (Some(least), Some(most)) if least == most => format!("a list of {least} {items}"),
                _ => format!("a list of {items}"),
            }
        }
        Some("object") => {
            let required: Vec<String> = strings(schema.get("required"));
            if required.is_empty() {
                "an object { … }".into()
            } else {
                format!("an object with {}", quoted(&required))
            }
        }
        _ => "another value".into(),
    }
}

fn plural(root: &Value, schema: &Value) -> String {
    let schema = resolve(root, schema);
    match kind(schema) {
        Some("number") => "numbers".into(),
        Some("integer") => "whole numbers".into(),
        Some("string") => "texts".into(),
        Some("array") => {
            format!("lists of {}", schema.get("items").map_or_else(|| "values".into(), |s| plural(root, s)))
        }
        Some("object") => "objects".into(),
        _ => "values".into(),
    }
}

/// The alternatives of an enumeration as one would write them: `"exact"`, `{ "shared": … }`.
pub(super) fn options(root: &Value, schema: &Value) -> Vec<String> {
    let mut out: Vec<String> = words(schema).iter().map(Value::to_string).collect();
    for branch in schema.get("oneOf").and_then(Value::as_array).into_iter().flatten() {
        let branch = resolve(root, branch);
        out.extend(words(branch).iter().map(Value::to_string));
        out.extend(tag(branch).map(|tag| format!("{{ \"{tag}\": … }}")));
    }
    out
}

fn words(schema: &Value) -> Vec<Value> {
    let list = schema.get("enum").and_then(Value::as_array).cloned().unwrap_or_default();
    list.into_iter().chain(schema.get("const").cloned()).collect()
}

/// The key that names the variant which this branch of an enumeration describes.
pub(super) fn tag(branch: &Value) -> Option<&str> {
    branch.get("required")?.as_array()?.first()?.as_str()
}

/// `a`, `b or c` as a choice.
pub(super) fn either(options: &[String]) -> String {
    match options {
        [only] => only.clone(),
        [head @ .., last] => format!("{} or {last}", head.join(", ")),
        [] => String::new(),
    }
}

/// Names in back quotes, separated by commas.
pub(super) fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The name in `known` that `word` was probably meant to be.
pub(super) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = word.chars().count();
    // What differs by more in length is not near.
    let known = known.into_iter().filter(|name| name.chars().count().abs_diff(length) <= 3);
    let closest = known.map(|name| (distance(word, name), name)).min()?;
    let tolerated = (word.chars().count().min(closest.1.chars().count()) / 3).clamp(1, 3);
    (closest.0 <= tolerated).then_some(closest.1)
}

/// Number of inserted, deleted, replaced and swapped characters from `a` to `b`, letter case aside.
fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|word| word.to_lowercase().chars().collect::<Vec<char>>());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = match (i, j) {
                (0, _) => j,
                (_, 0) => i,
                _ => {
                    let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                    let swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                    let swapped = if swap { rows[i - 2][j - 2] + 1 } else { replaced };
                    replaced.min(swapped).min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1)
                }
            };
        }
    }
    rows[a.len()][b.len()]
}

/// Follows a `$ref` inside `root`.
pub(super) fn resolve<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
    let target = schema.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix('#'));
    target.and_then(|pointer| root.pointer(pointer)).unwrap_or(schema)
}

fn kind(schema: &Value) -> Option<&str> {
    match schema.get("type")? {
        Value::String(one) => Some(one),
        Value::Array(several) => several.iter().filter_map(Value::as_str).find(|t| *t != "null"),
        _ => None,
    }
}

fn is_null(schema: &Value) -> bool {
    schema.get("type").and_then(Value::as_str) == Some("null")
}

fn bound(schema: &Value, key: &str) -> Option<u64> {
    schema.get(key).and_then(Value::as_u64)
}

/// The texts of a list.
pub(super) fn strings(list: Option<&Value>) -> Vec<String> {
    let entries = list.and_then(Value::as_array).into_iter().flatten();
    entries.filter_map(Value::as_str).map(str::to_string).collect()
}
