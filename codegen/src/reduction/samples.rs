//! Functions and coefficients as vectors over the points of a measure.

use rayon::prelude::*;

use crate::domain::Measure;
use crate::lagrangian::Lagrangian;
use crate::numerics::vector::add_scaled;

/// Values at the points, each times the square root of the point's weight, so that ∫ a b is a dot product.
#[derive(Clone, Debug)]
pub struct Samples {
    /// One vector for each ψ_l.
    pub functions: Vec<Vec<f64>>,
    /// One vector for each α_m.
    pub coefficients: Vec<Vec<f64>>,
}

impl Samples {
    /// Evaluates everything in the model at the points of the measure.
    pub fn new(lagrangian: &Lagrangian, measure: &Measure) -> Self {
        let roots: Vec<f64> = measure.weights.iter().map(|&w| libm::sqrt(w)).collect();
        let functions: Vec<Vec<f64>> = lagrangian
            .functions
            .par_iter()
            .map(|psi| measure.points.iter().zip(&roots).map(|(q, root)| root * psi.evaluate(q)).collect())
            .collect();
        let coefficients = lagrangian
            .coefficients
            .par_iter()
            .map(|alpha| {
                let mut sum = vec![0.0; roots.len()];
                for &(l, k) in &alpha.terms {
                    add_scaled(&mut sum, k, &functions[l]);
                }
                sum
            })
            .collect();
        Self { functions, coefficients }
    }
}
