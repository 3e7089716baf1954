//! JSON text to a value, with the faults that a plain reader lets pass: repeated and endless keys are refused.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::wording::{entry, member};
use crate::error::Diagnostics;

/// Longest key, characters: a name has 200 at most.
const LONGEST_KEY: usize = 1000;

/// The value that `text`, without comments, stands for; `None` after a syntax fault. Repeated keys are faults too, the last
/// one stands; what stands under a key that is too long is left out.
pub(super) fn read(text: &str, faults: &mut Diagnostics) -> Option<Value> {
    let mut wrong = Vec::new();
    let mut reader = serde_json::Deserializer::from_str(text);
    let node = Node { path: String::new(), wrong: &mut wrong };
    let result = node.deserialize(&mut reader).and_then(|value| reader.end().map(|()| value));
    for (field, key) in wrong {
        match key {
            Key::Repeated => {
                faults.push_name(field, "occurs twice in the same object", "keep one of the two")
            }
            Key::Long(length) => {
                let help = format!("write at most {LONGEST_KEY}, or remove it");
                faults.push_name(field, format!("is a key of {length} characters"), help);
            }
        }
    }
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            let (problem, help) = syntax(text, &error);
            let file = faults.file().to_path_buf();
            faults.push_at(&file, Some(error.line()), "", problem, help);
            if let Some(fault) = faults.list_mut().last_mut() {
                fault.column = Some(column(text, &error));
            }
            None
        }
    }
}

/// Turns `5.0` into `5`, which fields for numbers take as well and fields for whole numbers take alone.
pub(super) fn narrow(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(narrow),
        Value::Object(map) => map.values_mut().for_each(narrow),
        Value::Number(number) if number.is_f64() => {
            // Above 2^53 a float need not be the whole number that was written.
            let whole = |x: &f64| x.is_sign_positive() && x.fract() == 0.0 && *x < 9_007_199_254_740_992.0;
            if let Some(x) = number.as_f64().filter(whole) {
                *value = Value::from(x as u64);
            }
        }
        _ => {}
    }
}

/// The column of `error` in characters from 1: serde_json counts bytes.
fn column(text: &str, error: &serde_json::Error) -> usize {
    let line = text.split('\n').nth(error.line().saturating_sub(1)).unwrap_or_default();
    let before = line.char_indices().take_while(|(at, _)| at + 1 < error.column());
    before.count() + 1
}

/// Problem and help for a syntax error.
fn syntax(text: &str, error: &serde_json::Error) -> (String, &'static str) {
    let place = format!(" at line {} column {}", error.line(), error.column());
    let whole = error.to_string();
    let what = whole.strip_suffix(&place).unwrap_or(&whole);
    let help = if text.trim_start().starts_with('<') {
        "for a robot file run `gramforge init FILE` first: it writes a specification"
    } else if what == "number out of range" {
        "write a finite number, below 1.8e308 in magnitude"
    } else if error.is_eof() {
        "complete the file: a quote, bracket or brace is not closed"
    } else {
        "correct the JSON there: double quotes around names, commas between entries and none after the last"
    };
    (format!("is not JSON that can be read ({what})"), help)
}

/// What is wrong with a key.
enum Key {
    Repeated,
    /// Of so many characters.
    Long(usize),
}

struct Node<'a> {
    path: String,
    wrong: &'a mut Vec<(String, Key)>,
}

impl<'de> DeserializeSeed<'de> for Node<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Value, D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Node<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut out = Vec::new();
        loop {
            let seed = Node { path: entry(&self.path, out.len()), wrong: &mut *self.wrong };
            match list.next_element_seed(seed)? {
                Some(value) => out.push(value),
                None => return Ok(Value::Array(out)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Value, A::Error> {
        let mut out = Map::new();
        while let Some(key) = object.next_key::<String>()? {
            let path = member(&self.path, &key);
            if key.chars().nth(LONGEST_KEY).is_some() {
                self.wrong.push((path.clone(), Key::Long(key.chars().count())));
                object.next_value_seed(Node { path, wrong: &mut *self.wrong })?;
                continue;
            }
            if out.contains_key(&key) {
                self.wrong.push((path.clone(), Key::Repeated));
            }
            let value = object.next_value_seed(Node { path, wrong: &mut *self.wrong })?;
            out.insert(key, value);
        }
        Ok(Value::Object(out))
    }
}
