//! The model's matrices at one position.

use super::{Combination, Entry, Lagrangian, evaluate};

/// D, h and G at one position.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// D, n×n.
    pub mass_matrix: Vec<Vec<f64>>,
    /// h_ijk, n×n×n.
    pub christoffel: Vec<Vec<Vec<f64>>>,
    /// G, n.
    pub gravity: Vec<f64>,
}

impl Values {
    /// C_ij = Σ_k h_ijk q̇_k, n×n.
    pub fn coriolis(&self, qd: &[f64]) -> Vec<Vec<f64>> {
        let entry = |h: &Vec<f64>| h.iter().zip(qd).map(|(h, qd)| h * qd).sum();
        self.christoffel.iter().map(|plane| plane.iter().map(entry).collect()).collect()
    }
}

impl Lagrangian {
    /// The exact model at `q`.
    pub fn at(&self, q: &[f64]) -> Values {
        self.spread(q, |m| &self.coefficients[m].terms)
    }

    /// The model with other combinations in place of the coefficients', at `q`.
    pub fn at_with(&self, combinations: &[Combination], q: &[f64]) -> Values {
        self.spread(q, |m| &combinations[m])
    }

    fn spread<'a>(&self, q: &[f64], terms: impl Fn(usize) -> &'a Combination) -> Values {
        let n = self.dof;
        let psi = self.evaluate_functions(q);
        let mut out = Values {
            mass_matrix: vec![vec![0.0; n]; n],
            christoffel: vec![vec![vec![0.0; n]; n]; n],
            gravity: vec![0.0; n],
        };
        for (m, coefficient) in self.coefficients.iter().enumerate() {
            let alpha = evaluate(terms(m), &psi);
            for place in &coefficient.places {
                let value = place.sign * alpha;
                match place.entry {
                    Entry::D(i, j) => {
                        out.mass_matrix[i][j] = value;
                        out.mass_matrix[j][i] = value;
                    }
                    Entry::H(i, j, k) => {
                        out.christoffel[i][j][k] = value;
                        out.christoffel[i][k][j] = value;
                    }
                    Entry::G(i) => out.gravity[i] = value,
                }
            }
        }
        out
    }
}
