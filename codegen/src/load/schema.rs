//! The JSON Schema of specification files. It stands in `schema.json`, made from the types of [`crate::spec`]; a test
//! keeps it current, so that what makes it is compiled with the tests alone.

use std::sync::LazyLock;

use serde_json::Value;

use crate::error::Error;

/// The text of the JSON Schema of a specification file.
pub const SCHEMA: &str = include_str!("schema.json");

// Reading the schema costs more than checking a file, and build scripts check many.
static PARSED: LazyLock<Result<Value, String>> =
    LazyLock::new(|| serde_json::from_str(SCHEMA).map_err(|error| error.to_string()));

/// The JSON Schema of a specification file.
///
/// # Errors
/// [`Error::Internal`] where the schema itself is broken.
pub fn schema() -> Result<&'static Value, Error> {
    PARSED.as_ref().map_err(|error| Error::Internal(error.clone()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use serde_json::Value;

    use super::SCHEMA;
    use crate::load::mismatch::KEYWORDS;
    use crate::spec::Spec;

    /// Largest whole number that a field takes.
    const LARGEST: u32 = u32::MAX;

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

    /// The schema as the types have it.
    fn made() -> Value {
        let mut schema = schemars::schema_for!(Spec).to_value();
        cap_integers(&mut schema);
        schema
    }

    #[test]
    fn the_schema_is_that_of_the_types() {
        let made = made();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/load/schema.json");
        if std::env::var_os("UPDATE").is_some() {
            let text = serde_json::to_string_pretty(&made).expect("a value that is JSON") + "\n";
            std::fs::write(&path, text).expect("a schema that can be written");
            return;
        }
        let kept: Value = serde_json::from_str(SCHEMA).expect("JSON");
        assert!(
            kept == made,
            "schema.json is not what the types say; run `UPDATE=1 cargo test -p gramforge --lib schema`"
        );
    }

    /// A keyword that nothing checks would let values pass that the schema forbids.
    #[test]
    fn every_keyword_of_the_schema_is_checked() {
        fn keywords(schema: &Value, names: bool, found: &mut BTreeSet<String>) {
            match schema {
                Value::Object(map) => {
                    for (key, value) in map {
                        if !names {
                            found.insert(key.clone());
                        }
                        let data = !names && matches!(key.as_str(), "default" | "const" | "enum");
                        if !data {
                            let named = !names && matches!(key.as_str(), "properties" | "$defs");
                            keywords(value, named, found);
                        }
                    }
                }
                Value::Array(list) => list.iter().for_each(|value| keywords(value, false, found)),
                _ => {}
            }
        }
        let mut found = BTreeSet::new();
        keywords(&made(), false, &mut found);
        let notes = ["$schema", "$defs", "title", "description", "default", "format", "writeOnly"];
        found.retain(|key| !notes.contains(&key.as_str()) && !KEYWORDS.contains(&key.as_str()));
        assert!(found.is_empty(), "{found:?}");
    }
}
