//! What the generated code looks like.

use serde::{Deserialize, Serialize};

use crate::numerics::rounded::Format;

/// What the generated code looks like.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EmitSpec {
    /// Number type of the generated code.
    #[serde(default)]
    pub scalar: ScalarSpec,
    /// How sines and cosines are taken; by default `libm` in f64 and `polynomial` in f32.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trig: Option<TrigSpec>,
    /// How the law is written.
    #[serde(default, skip_serializing_if = "LawCodeSpec::is_default")]
    pub law: LawCodeSpec,
    /// Write a C header and a crate that gives a C library beside the module.
    #[serde(default, skip_serializing_if = "is_false")]
    pub c_api: bool,
    /// Report a fault where the desired motion given to the step is beyond the limits for which the controller was judged; without
    /// `motion`.
    #[serde(default, skip_serializing_if = "is_false")]
    pub check_reference: bool,
    /// Multiply and add in one operation that rounds once, where a sum is of a product; for processors that have the instruction, with
    /// the feature `std` of `gramforge-runtime`. The module does not compile elsewhere.
    #[serde(default, skip_serializing_if = "is_false")]
    pub fma: bool,
}

/// True for what an absent field means.
fn is_false(value: &bool) -> bool {
    !*value
}

impl EmitSpec {
    /// How sines and cosines are taken.
    pub fn sines(&self) -> TrigSpec {
        self.trig.unwrap_or(self.scalar.sines())
    }

    /// Two specifications that ask for the same are the same.
    pub(crate) fn leave_out_default(&mut self) {
        self.trig = self.trig.filter(|trig| *trig != self.scalar.sines());
    }
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TrigSpec {
    /// The crate `libm`; the default in f64.
    Libm,
    /// Polynomials, as good as rounding and faster; the default in f32.
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

/// Number type of the generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ScalarSpec {
    /// IEEE double.
    #[default]
    F64,
    /// IEEE single.
    F32,
}

impl ScalarSpec {
    /// The name of the type.
    pub fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }

    /// How its sines and cosines are taken where nothing else is asked for.
    fn sines(self) -> TrigSpec {
        match self {
            Self::F64 => TrigSpec::Libm,
            // In f32 `libm` computes in f64, which costs thousands of instructions on a processor without double.
            Self::F32 => TrigSpec::Polynomial,
        }
    }

    /// How it rounds.
    pub(crate) fn format(self) -> Format {
        match self {
            Self::F64 => Format::DOUBLE,
            Self::F32 => Format::SINGLE,
        }
    }
}
