//! A size as it is written on the command line.

use std::str::FromStr;

use super::Size;
use crate::spec::{DictionarySpec, ModelSpec, RobustGainSpec, ScalarSpec};

const HELP: &str = "write `exact`, `auto`, `xi6` (6 functions), `xi6each` (6 for each coefficient) or `1%`, and more with a plus, such \
                    as `1%+constant+f32`: `harmonic`, `product`, `union`; `state`, `constant`; `f64`, `f32`";

impl FromStr for Size {
    type Err = String;

    /// Parts with a plus between them, each of another kind: `exact`, `xi6`, `xi6each`, `1%`, `union`, `constant`, `f32`.
    ///
    /// # Errors
    /// What is wrong, and what to write instead.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut size = Self::default();
        for part in text.split('+') {
            let word: String = part.chars().filter(|c| !c.is_whitespace()).collect();
            let fresh = if let Some(model) = model(&word) {
                size.model.replace(model).is_none()
            } else if let Some(dictionary) = dictionary(&word) {
                size.dictionary.replace(dictionary).is_none()
            } else if let Some(gain) = gain(&word) {
                size.robust_gain.replace(gain).is_none()
            } else if let Some(scalar) = scalar(&word) {
                size.scalar.replace(scalar).is_none()
            } else {
                return Err(format!("{word:?} is no part of a size; {HELP}"));
            };
            if !fresh {
                return Err(format!("{word:?} comes after another part of its kind; {HELP}"));
            }
        }
        Ok(size)
    }
}

fn model(word: &str) -> Option<ModelSpec> {
    match word {
        "exact" => return Some(ModelSpec::Exact),
        "auto" => return Some(ModelSpec::Auto),
        _ => {}
    }
    if let Some(percent) = word.strip_suffix('%') {
        let percent: f64 = percent.parse().ok()?;
        return Some(ModelSpec::Tolerance { torque: percent / 100.0 });
    }
    let count = word.strip_prefix("xi")?;
    let (count, each) = count.strip_suffix("each").map_or((count, false), |count| (count, true));
    let functions: usize = count.parse().ok()?;
    Some(if each { ModelSpec::Separate { functions } } else { ModelSpec::Shared { functions } })
}

fn dictionary(word: &str) -> Option<DictionarySpec> {
    match word {
        "harmonic" => Some(DictionarySpec::Harmonic),
        "product" => Some(DictionarySpec::Product),
        "union" => Some(DictionarySpec::Union),
        _ => None,
    }
}

fn gain(word: &str) -> Option<RobustGainSpec> {
    match word {
        "state" => Some(RobustGainSpec::State),
        "constant" => Some(RobustGainSpec::Constant),
        _ => None,
    }
}

fn scalar(word: &str) -> Option<ScalarSpec> {
    match word {
        "f64" => Some(ScalarSpec::F64),
        "f32" => Some(ScalarSpec::F32),
        _ => None,
    }
}
