//! The numbers that a law is tuned by.

use crate::spec::{ControlSpec, MatrixSpec};

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
    /// The specification's own numbers for `n` joints; `None` where one is missing or of the wrong size.
    pub(super) fn given(control: &ControlSpec, n: usize) -> Option<Self> {
        let gain = |spec: &Option<MatrixSpec>| spec.as_ref()?.by_rows(n);
        let layer = control.boundary_layer.as_ref();
        Some(Self {
            w: gain(&control.w)?,
            pqq: gain(&control.pqq)?,
            omega: gain(&control.omega)?,
            boundary_layer: layer.map_or(Some(None), |phi| phi.by_joint(n).map(Some))?,
            period: control.period?,
        })
    }
}
