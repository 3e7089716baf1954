//! The C interface of a module: a header, and a crate that gives the library.
//!
//! The texts stand in files of their own beside this one, with `{{word}}` for what depends on the module.

mod header;
mod limits;
mod shim;

use super::Module;
use crate::error::Error;
use crate::spec::ScalarSpec;

/// The crate's manifest.
///
/// Its profiles put all into one object of which only the functions of the header can be seen: two such archives go into one
/// program, whatever compilers made them.
const MANIFEST: &str = include_str!("manifest.toml.in");

/// A file of the C interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CFile {
    /// Its path from the folder that the module is in, with `/` between names.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// What the C interface depends on.
#[derive(Clone, Copy, Debug)]
struct Interface<'a> {
    name: &'a str,
    hash: &'a str,
    scalar: Scalar,
    joints: usize,
    parameters: usize,
    /// Control period, s.
    period: f64,
    /// Time that the desired motion takes, s; `None` where there is no motion.
    duration: Option<f64>,
    /// Whether the step reports a desired motion beyond its limits.
    checked: bool,
}

/// The number type, in Rust and in C.
#[derive(Clone, Copy, Debug)]
struct Scalar {
    rust: &'static str,
    c: &'static str,
    /// Its size, which is that of the words that a controller is kept in, bytes.
    size: usize,
}

impl Scalar {
    fn of(spec: ScalarSpec) -> Self {
        match spec {
            ScalarSpec::F64 => Self { rust: "f64", c: "double", size: 8 },
            ScalarSpec::F32 => Self { rust: "f32", c: "float", size: 4 },
        }
    }
}

/// What the desired motion is asked by.
struct Instant {
    reference: &'static str,
    name: &'static str,
    words: &'static str,
    rust: &'static str,
    c: &'static str,
}

impl Instant {
    /// In f32 a time would lose its digits.
    fn of(scalar: Scalar) -> Self {
        match scalar.size {
            4 => Self {
                reference: "TickReference",
                name: "tick",
                words: "at the start of control period `tick`, counted from 0, also after the end",
                rust: "u32",
                c: "uint32_t",
            },
            _ => Self {
                reference: "Reference",
                name: "time",
                words: "at `time`, s, which may be before 0 or after the end; NaN may give NaN, which {{name}}_step answers with a fault",
                rust: "f64",
                c: "double",
            },
        }
    }
}

impl Interface<'_> {
    /// Words of a controller: its mark, θ̂ and what is below its last digit, the last command, the last position, and whether there
    /// was one.
    fn words(&self) -> usize {
        2 * self.parameters + 2 * self.joints + 2
    }

    /// `text` with the words that every file has in common.
    fn fill(&self, text: &str) -> String {
        let upper = self.name.to_uppercase();
        let (words, size) = (self.words(), self.scalar.size);
        let instant = Instant::of(self.scalar);
        let limits = limits::words(self.checked).map(|(word, value)| (word, value.to_string()));
        let own = [
            ("reference", instant.reference.to_string()),
            ("instant_words", instant.words.replace("{{name}}", self.name)),
            ("instant", instant.name.to_string()),
            ("rust_instant", instant.rust.to_string()),
            ("c_instant", instant.c.to_string()),
            ("name", self.name.to_string()),
            ("NAME", upper),
            ("hash", self.hash.to_string()),
            ("version", env!("CARGO_PKG_VERSION").to_string()),
            ("model", super::type_name(self.name)),
            ("joints", self.joints.to_string()),
            ("parameters", self.parameters.to_string()),
            ("words", words.to_string()),
            ("size", (words * size).to_string()),
            ("align", size.to_string()),
            ("bits", (8 * size).to_string()),
            ("rust_scalar", self.scalar.rust.to_string()),
            ("c_scalar", self.scalar.c.to_string()),
            ("period", self.number(self.period)),
            ("duration", self.number(self.duration.unwrap_or(0.0))),
        ];
        // Those that hold other words first.
        let all = limits.into_iter().chain(own);
        all.fold(text.to_string(), |text, (word, value)| text.replace(&format!("{{{{{word}}}}}"), &value))
    }

    /// `x` in C, with the bits that it has in the module.
    fn number(&self, x: f64) -> String {
        match self.scalar.size {
            4 => format!("{:?}f", x as f32),
            _ => format!("{x:?}"),
        }
    }
}

/// The files of the C interface of a module with a step that is written out: the header, the crate's manifest and source.
///
/// # Errors
/// [`Error::Internal`] where the module has no such step.
pub fn c_interface(module: &Module) -> Result<Vec<CFile>, Error> {
    let (Some(design), Some(step)) = (module.design, module.step) else {
        return Err(Error::Internal("a C interface was asked for without a control step".to_string()));
    };
    let interface = Interface {
        name: module.name,
        hash: module.hash,
        scalar: Scalar::of(module.scalar),
        joints: step.joints,
        parameters: step.parameters,
        period: design.period,
        duration: module.motion.map(crate::motion::Motion::duration),
        checked: module.check_reference,
    };
    let file = |path: String, text: String| CFile { path, text };
    let name = module.name;
    Ok(vec![
        file(format!("{name}.h"), header::text(&interface)),
        file(format!("{name}_c/Cargo.toml"), interface.fill(MANIFEST)),
        file(format!("{name}_c/src/lib.rs"), shim::text(&interface)),
    ])
}

#[cfg(test)]
mod tests;
