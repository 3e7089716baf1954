//! In what a size differs from its specification.

use crate::load::Loaded;
use crate::spec::{DictionarySpec, ModelSpec, RobustGainSpec, ScalarSpec};

/// A size of a model: what it changes of the specification; `None` leaves that as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Size {
    /// Form of the model, with its number of functions or its tolerance.
    pub model: Option<ModelSpec>,
    /// The candidate functions.
    pub dictionary: Option<DictionarySpec>,
    /// What a robust law switches with.
    pub robust_gain: Option<RobustGainSpec>,
    /// Number type of the code.
    pub scalar: Option<ScalarSpec>,
}

impl Size {
    /// The size that differs in the form of its model alone.
    pub fn of(model: ModelSpec) -> Self {
        Self { model: Some(model), ..Self::default() }
    }

    /// The specification at this size. A dictionary that the form of the model does not take is left out, unless this size
    /// names it; a specification without a controller stays without one.
    pub fn apply(&self, loaded: &Loaded) -> Loaded {
        let mut sized = loaded.clone();
        let spec = &mut sized.spec;
        if let Some(model) = &self.model {
            spec.model = model.clone();
            if !matches!(model, ModelSpec::Shared { .. } | ModelSpec::Separate { .. }) {
                spec.dictionary = DictionarySpec::default();
            }
        }
        spec.dictionary = self.dictionary.unwrap_or(spec.dictionary);
        spec.emit.scalar = self.scalar.unwrap_or(spec.emit.scalar);
        spec.emit.leave_out_default();
        if let (Some(gain), Some(control)) = (self.robust_gain, &mut spec.control) {
            control.robust_gain = gain;
        }
        sized
    }
}
