//! What the generated code looks like.

use serde::{Deserialize, Serialize};

/// What the generated code looks like.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EmitSpec {
    /// Number type of the generated code.
    #[serde(default)]
    pub scalar: ScalarSpec,
    /// How sines and cosines are taken.
    #[serde(default, skip_serializing_if = "TrigSpec::is_default")]
    pub trig: TrigSpec,
    /// How the law is written.
    #[serde(default, skip_serializing_if = "LawCodeSpec::is_default")]
    pub law: LawCodeSpec,
    /// Write a C header and a crate that gives a C library beside the module.
    #[serde(default, skip_serializing_if = "is_false")]
    pub c_api: bool,
}

/// True for what an absent field means.
fn is_false(value: &bool) -> bool {
    !*value
}

/// How the generated module holds the tracking law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LawCodeSpec {
    /// Written out together with the model as one step, its constants folded.
    #[default]
    Inline,
    /// As constants of a law of the runtime, whose gains a program can change while it runs.
    Runtime,
}

impl LawCodeSpec {
    /// True for what an absent field means.
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// How the generated code takes sines and cosines; the error counts in the bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TrigSpec {
    /// The crate `libm`.
    #[default]
    Libm,
    /// Polynomials, as good as rounding and faster.
    Polynomial,
    /// A table of one turn in the module, with second-order interpolation; for `shared`, `separate` and `exact` models of
    /// the harmonic dictionary.
    Table {
        /// Largest error of a sine or cosine, 1e-10 to 0.1: the smallest table that keeps it is taken.
        error: f64,
    },
    /// The platform's, with the feature `std` of `gramforge-runtime`: not the same bits on every machine.
    Std,
}

impl TrigSpec {
    /// True for what an absent field means.
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Number type of the generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ScalarSpec {
    /// IEEE double.
    #[default]
    F64,
}
