//! The gain matrices of the laws.

use crate::check::Tuning;
use crate::numerics::linalg::{inverse, product};

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
    /// The matrices that follow from W, Pqq and Ω.
    ///
    /// Not finite where the numbers of these leave the range of f64.
    pub fn new(tuning: &Tuning) -> Self {
        let Tuning { w, pqq, omega, .. } = tuning;
        let n = w.len();
        // A positive definite matrix has an inverse, but its determinant may overflow or vanish.
        let inverse = |m: &[Vec<f64>]| inverse(m).unwrap_or_else(|| vec![vec![f64::INFINITY; n]; n]);
        let p12 = product(&inverse(pqq), omega);
        let back = product(&product(pqq, &inverse(omega)), pqq);
        let damping =
            w.iter().zip(&back).map(|(w, b)| w.iter().zip(b).map(|(w, b)| w + b).collect()).collect();
        Self { p12, damping, pqq: pqq.clone() }
    }

    /// True where every entry is a finite number.
    pub fn is_finite(&self) -> bool {
        [&self.p12, &self.damping, &self.pqq].into_iter().flatten().flatten().all(|v| v.is_finite())
    }
}
