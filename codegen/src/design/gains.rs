//! The gain matrices of the laws.

use super::checked;
use super::linalg::{inverse, product};
use crate::check::matrix;
use crate::error::Error;
use crate::spec::ControlSpec;

/// Gain matrices, n×n by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Gains {
    /// P12 = Pqq⁻¹ Ω, 1/s.
    pub p12: Vec<Vec<f64>>,
    /// K = W + Pqq Ω⁻¹ Pqq, N·m·s/rad.
    pub damping: Vec<Vec<f64>>,
    /// Pqq, N·m/rad.
    pub pqq: Vec<Vec<f64>>,
}

impl Gains {
    /// The matrices for `n` joints from W, Pqq and Ω.
    ///
    /// # Errors
    /// [`Error::Internal`] where Pqq or Ω is singular; the specification's check refuses such matrices.
    pub fn new(control: &ControlSpec, n: usize) -> Result<Self, Error> {
        let singular = |name: &str| Error::Internal(format!("{name} is singular after its check"));
        let w = checked("control.W", matrix(&control.w, n))?;
        let pqq = checked("control.Pqq", matrix(&control.pqq, n))?;
        let omega = checked("control.Omega", matrix(&control.omega, n))?;
        let p12 = product(&inverse(&pqq).ok_or_else(|| singular("Pqq"))?, &omega);
        let back = product(&product(&pqq, &inverse(&omega).ok_or_else(|| singular("Omega"))?), &pqq);
        let damping =
            w.iter().zip(&back).map(|(w, b)| w.iter().zip(b).map(|(w, b)| w + b).collect()).collect();
        Ok(Self { p12, damping, pqq })
    }
}
