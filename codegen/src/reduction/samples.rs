//! Functions and coefficients as vectors over the points of a measure.

use crate::lagrangian::Lagrangian;
use crate::measure::Measure;
use crate::parallel::Parallelize;

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

/// a += k b.
pub(super) fn add_scaled(a: &mut [f64], k: f64, b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += k * b;
    }
}

/// a · b in a fixed order: eight running sums, so that the order does not forbid vector units.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_blocks, a_rest) = a.as_chunks::<8>();
    let (b_blocks, b_rest) = b.as_chunks::<8>();
    for (a, b) in a_blocks.iter().zip(b_blocks) {
        for i in 0..8 {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7])) + rest
}
