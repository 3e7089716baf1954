//! The name of a size.

use std::fmt;

use super::Size;
use crate::number::percent;
use crate::spec::{DictionarySpec, ModelSpec, RobustGainSpec};

impl fmt::Display for Size {
    /// A short name that stays the same, such as `exact`, `xi 6` or `1 %, constant gain, f32`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            self.model.as_ref().map(model),
            self.dictionary.map(|dictionary| dictionary_name(dictionary).to_string()),
            self.robust_gain.map(|gain| format!("{} gain", gain_name(gain))),
            self.scalar.map(|scalar| scalar.name().to_string()),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        f.write_str(if parts.is_empty() { "as specified" } else { "" })?;
        f.write_str(&parts.join(", "))
    }
}

impl Size {
    /// The name of this size, as it is displayed.
    pub fn label(&self) -> String {
        self.to_string()
    }
}

fn model(model: &ModelSpec) -> String {
    match model {
        ModelSpec::Auto => "auto".to_string(),
        ModelSpec::Exact => "exact".to_string(),
        ModelSpec::Shared { functions } => format!("xi {functions}"),
        ModelSpec::Separate { functions } => format!("xi {functions} each"),
        ModelSpec::Tolerance { torque } => percent(100.0 * torque),
    }
}

fn dictionary_name(dictionary: DictionarySpec) -> &'static str {
    match dictionary {
        DictionarySpec::Harmonic => "harmonic",
        DictionarySpec::Product => "product",
        DictionarySpec::Union => "union",
    }
}

fn gain_name(gain: RobustGainSpec) -> &'static str {
    match gain {
        RobustGainSpec::State => "state",
        RobustGainSpec::Constant => "constant",
        RobustGainSpec::Auto => "auto",
    }
}
