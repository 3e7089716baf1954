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
    /// Not finite where the numbers of these leave the range of f64.
    ///
    /// # Errors
    /// [`Error::Internal`] where W, Pqq or Ω has the wrong size after its check.
    pub fn new(control: &ControlSpec, n: usize) -> Result<Self, Error> {
        // A positive definite matrix has an inverse, but its determinant may overflow or vanish.
        let inverse = |m: &[Vec<f64>]| inverse(m).unwrap_or_else(|| vec![vec![f64::INFINITY; n]; n]);
        let w = checked("control.W", matrix(&control.w, n))?;
        let pqq = checked("control.Pqq", matrix(&control.pqq, n))?;
        let omega = checked("control.Omega", matrix(&control.omega, n))?;
        let p12 = product(&inverse(&pqq), &omega);
        let back = product(&product(&pqq, &inverse(&omega)), &pqq);
        let damping =
            w.iter().zip(&back).map(|(w, b)| w.iter().zip(b).map(|(w, b)| w + b).collect()).collect();
        Ok(Self { p12, damping, pqq })
    }

    /// True where every entry is a finite number.
    pub fn is_finite(&self) -> bool {
        [&self.p12, &self.damping, &self.pqq].into_iter().flatten().flatten().all(|v| v.is_finite())
    }
}
