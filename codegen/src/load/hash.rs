//! The fingerprint of a specification, in the header of what is generated from it.

use std::fmt::Write as _;

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::Loaded;
use crate::error::{Diagnostics, Error};

/// SHA-256, in hexadecimal, of the specification and the files that it names.
///
/// Spacing, the order of keys, defaults written out, number spellings (`5`, `5.0`) and where the file lies do not
/// matter: what is hashed is the canonical form (keys sorted, as read) and, after it, length and bytes of each file, as
/// they were read with the specification.
///
/// # Errors
/// [`Error::Input`] where a named file cannot be read.
pub fn spec_hash(loaded: &Loaded) -> Result<String, Error> {
    let value = serde_json::to_value(&loaded.spec).map_err(|e| Error::Internal(e.to_string()))?;
    let text = canonical(&value);
    let mut hasher = Sha256::new();
    hasher.update(text.as_bytes());
    let mut faults = Diagnostics::of(&loaded.path);
    for named in &loaded.named {
        match &named.content {
            Ok(bytes) => {
                hasher.update((bytes.len() as u64).to_le_bytes());
                hasher.update(bytes);
            }
            Err(error) => faults.push(
                named.field,
                format!("names {:?}, which cannot be read ({error})", named.name),
                "write a path relative to the specification",
            ),
        }
    }
    let digest = hasher.finalize();
    let mut hex = String::with_capacity(64);
    for byte in digest.iter() {
        let _ = write!(hex, "{byte:02x}");
    }
    faults.finish(hex)
}

/// `value` in the one form that does not depend on spacing or on the order of keys.
///
/// Keys are sorted here and not left to the map type, whose order is a feature flag of serde_json.
pub(crate) fn canonical(value: &Value) -> String {
    let mut text = String::new();
    write(value, &mut text);
    text
}

fn write(value: &Value, out: &mut String) {
    match value {
        Value::Object(map) => {
            let mut members: Vec<_> = map.iter().collect();
            members.sort_by_key(|(key, _)| key.as_str());
            out.push('{');
            for (key, value) in members {
                out.push_str(&Value::from(key.as_str()).to_string());
                out.push(':');
                write(value, out);
                out.push(',');
            }
            out.push('}');
        }
        Value::Array(list) => {
            out.push('[');
            for value in list {
                write(value, out);
                out.push(',');
            }
            out.push(']');
        }
        scalar => out.push_str(&scalar.to_string()),
    }
}
