//! Where in the user's files something stands.

use std::path::{Path, PathBuf};

use crate::error::{Diagnostics, located};
use crate::number::scientific;

/// A field of a file, such as `arm.dh.links[1]` of a specification or `joint[elbow]` of a URDF.
#[derive(Clone, Debug)]
pub(super) struct Place {
    file: PathBuf,
    line: Option<usize>,
    field: String,
}

impl Place {
    /// The field `field` of `file`.
    pub fn new(file: &Path, field: impl Into<String>) -> Self {
        Self { file: file.to_path_buf(), line: None, field: field.into() }
    }

    /// The same field, in line `line` of its file.
    pub fn on(&self, line: usize) -> Self {
        Self { line: Some(line), ..self.clone() }
    }

    /// The file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The line, where it is known.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The field `name` inside this one.
    pub fn at(&self, name: &str) -> Self {
        let field = if self.field.is_empty() { name.to_string() } else { format!("{}.{name}", self.field) };
        Self { field, ..self.clone() }
    }

    /// Entry number `index` of this one.
    pub fn item(&self, index: usize) -> Self {
        Self { field: format!("{}[{index}]", self.field), ..self.clone() }
    }

    /// Adds a fault here.
    pub fn fault(&self, faults: &mut Diagnostics, problem: impl Into<String>, help: impl Into<String>) {
        faults.push_at(&self.file, self.line, &self.field, problem, help);
    }

    /// Adds a warning here.
    pub fn warn(&self, warnings: &mut Vec<String>, what: &str) {
        warnings.push(format!("{}: {what}", located(&self.file, self.line, &self.field)));
    }

    /// `value`, after a fault where it is not finite.
    pub fn finite(&self, value: f64, faults: &mut Diagnostics) -> Option<f64> {
        if value.is_finite() {
            return Some(value);
        }
        self.fault(faults, "is not finite", "write a finite number");
        None
    }

    /// `value`, after a fault where it is negative or not finite.
    pub fn not_negative(&self, value: f64, unit: &str, faults: &mut Diagnostics) -> Option<f64> {
        let value = self.finite(value, faults)?;
        if value >= 0.0 {
            return Some(value);
        }
        self.fault(
            faults,
            format!("is {}", scientific(value)),
            format!("write a number of at least 0, in {unit}"),
        );
        None
    }

    /// `value`, after a fault where it is not positive or not finite.
    pub fn positive(&self, value: f64, unit: &str, faults: &mut Diagnostics) -> Option<f64> {
        let value = self.finite(value, faults)?;
        if value > 0.0 {
            return Some(value);
        }
        self.fault(faults, format!("is {}", scientific(value)), format!("write a number above 0, in {unit}"));
        None
    }
}
