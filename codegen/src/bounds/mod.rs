//! Bounds on what a reduced model leaves out.

mod sampled;

pub use sampled::sampled;

use crate::lagrangian::{Entry, Lagrangian};

/// Element-by-element bounds (26)–(28) over a domain, zero where the model is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// ΔD, n×n.
    pub d: Vec<Vec<f64>>,
    /// Δh_ijk, n×n×n.
    pub h: Vec<Vec<Vec<f64>>>,
    /// ΔG, n.
    pub g: Vec<f64>,
}

impl Bounds {
    /// True where every bound is a finite number.
    pub fn is_finite(&self) -> bool {
        let h = self.h.iter().flatten();
        self.d.iter().chain(h).chain([&self.g]).flatten().all(|v| v.is_finite())
    }

    /// Spreads one bound for each coefficient over the places where it stands.
    pub fn new(lagrangian: &Lagrangian, deltas: &[f64]) -> Self {
        let n = lagrangian.dof;
        let mut out = Self { d: vec![vec![0.0; n]; n], h: vec![vec![vec![0.0; n]; n]; n], g: vec![0.0; n] };
        for (coefficient, &delta) in lagrangian.coefficients.iter().zip(deltas) {
            for place in &coefficient.places {
                match place.entry {
                    Entry::D(i, j) => {
                        out.d[i][j] = delta;
                        out.d[j][i] = delta;
                    }
                    Entry::H(i, j, k) => {
                        out.h[i][j][k] = delta;
                        out.h[i][k][j] = delta;
                    }
                    Entry::G(i) => out.g[i] = delta,
                }
            }
        }
        out
    }

    /// Equation (30): ΔC_ij = Σ_k Δh_ijk max|q̇_k|, with the largest speeds given.
    pub fn coriolis(&self, speed: &[f64]) -> Vec<Vec<f64>> {
        let row =
            |row: &Vec<Vec<f64>>| row.iter().map(|h| h.iter().zip(speed).map(|(h, v)| h * v).sum()).collect();
        self.h.iter().map(row).collect()
    }
}
