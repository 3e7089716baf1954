//! The gain matrices of the laws.

use super::linalg::{inverse, product};
use crate::error::Error;
use crate::spec::{ControlSpec, MatrixSpec};

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
        let w = control.w.expand(n);
        let pqq = control.pqq.expand(n);
        let omega = control.omega.expand(n);
        let p12 = product(&inverse(&pqq).ok_or_else(|| singular("Pqq"))?, &omega);
        let back = product(&product(&pqq, &inverse(&omega).ok_or_else(|| singular("Omega"))?), &pqq);
        let damping =
            w.iter().zip(&back).map(|(w, b)| w.iter().zip(b).map(|(w, b)| w + b).collect()).collect();
        Ok(Self { p12, damping, pqq })
    }
}

impl MatrixSpec {
    /// The full n×n matrix, by rows.
    pub fn expand(&self, n: usize) -> Vec<Vec<f64>> {
        let diagonal = |entry: &dyn Fn(usize) -> f64| -> Vec<Vec<f64>> {
            (0..n).map(|i| (0..n).map(|j| if i == j { entry(i) } else { 0.0 }).collect()).collect()
        };
        match self {
            MatrixSpec::Scalar(x) => diagonal(&|_| *x),
            MatrixSpec::Diagonal(list) => diagonal(&|i| list.get(i).copied().unwrap_or_default()),
            MatrixSpec::Full(rows) => rows.clone(),
        }
    }
}
