//! The numbers that a law is tuned by.

use super::checked;
use crate::check::{matrix, vector};
use crate::error::Error;
use crate::spec::ControlSpec;

/// Gains, boundary layer and period: those of the specification, or those found for what it asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuning {
    /// W of equation (16), n×n, N·m·s/rad.
    pub w: Vec<Vec<f64>>,
    /// Pqq of equation (12), n×n, N·m/rad.
    pub pqq: Vec<Vec<f64>>,
    /// Ω of equation (16), n×n, N·m/(rad·s).
    pub omega: Vec<Vec<f64>>,
    /// φ of the boundary layer by joint, rad/s or m/s; `None` for the sign function.
    pub boundary_layer: Option<Vec<f64>>,
    /// Control period, s.
    pub period: f64,
}

impl Tuning {
    /// The specification's own numbers for `n` joints.
    ///
    /// # Errors
    /// [`Error::Internal`] where one is missing or of the wrong size after its check.
    pub fn given(control: &ControlSpec, n: usize) -> Result<Self, Error> {
        let gain = |field, spec: &Option<_>| checked(field, spec.as_ref().and_then(|m| matrix(m, n)));
        let layer = |phi| checked("control.boundary_layer", vector(phi, n));
        Ok(Self {
            w: gain("control.W", &control.w)?,
            pqq: gain("control.Pqq", &control.pqq)?,
            omega: gain("control.Omega", &control.omega)?,
            boundary_layer: control.boundary_layer.as_ref().map(layer).transpose()?,
            period: checked("control.period", control.period)?,
        })
    }
}
