//! Weighted Gram–Schmidt selection, equations (3)–(8).
//!
//! ψ_l and α_m are never orthogonalised one by one: with e the direction chosen last, (6) and (7) take
//! from every norm ∫ψ_l² and every correlation ∫α_m ψ_l a product of two dot products with e.

use rayon::prelude::*;

use super::samples::Samples;
use crate::numerics::vector::{add_scaled, dot};

/// Norms that have shrunk below this fraction of the original are recomputed before use: the running
/// difference has lost its digits.
const RECOMPUTE: f64 = 1e-6;
/// A function whose residual norm² is below this fraction of the original depends on the chosen ones.
const DEPENDENT: f64 = 1e-18;
/// Scores this near to the best one count as tied; the function that comes first wins.
const TIE: f64 = 1e-9;

/// One chosen function.
#[derive(Clone, Debug)]
pub struct Pick {
    /// Index u_j of the function.
    pub function: usize,
    /// The raw ψ_{u_j} over the orthonormal directions e_1 … e_j.
    pub components: Vec<f64>,
    /// Projection of every α_m on e_j.
    pub projections: Vec<f64>,
}

/// State of the selection after some steps.
pub struct GramSchmidt<'a> {
    functions: Vec<&'a [f64]>,
    coefficients: &'a [Vec<f64>],
    /// e_1 … e_j.
    directions: Vec<Vec<f64>>,
    original: Vec<f64>,
    norms: Vec<f64>,
    /// ∫ α_m^(j) ψ_l^(j), by m then l.
    correlations: Vec<Vec<f64>>,
    available: Vec<bool>,
    picks: Vec<Pick>,
}

impl<'a> GramSchmidt<'a> {
    /// Before the first step, j = 1.
    pub fn new(samples: &'a Samples) -> Self {
        Self::over(samples.functions.iter().map(Vec::as_slice).collect(), &samples.coefficients)
    }

    /// For some functions and some coefficients: [`Pick::function`] and [`Pick::projections`] count among these.
    pub fn over(functions: Vec<&'a [f64]>, coefficients: &'a [Vec<f64>]) -> Self {
        let norms: Vec<f64> = functions.par_iter().map(|psi| dot(psi, psi)).collect();
        let correlations = coefficients
            .par_iter()
            .map(|alpha| functions.iter().map(|psi| dot(alpha, psi)).collect())
            .collect();
        Self {
            functions,
            coefficients,
            directions: Vec::new(),
            original: norms.clone(),
            available: norms.iter().map(|&norm| norm > 0.0).collect(),
            norms,
            correlations,
            picks: Vec::new(),
        }
    }

    /// The functions chosen so far.
    pub fn picks(&self) -> &[Pick] {
        &self.picks
    }

    /// Takes one more function: the one that maximises R_l = Σ_m w_m Q_ml, where `weights` holds w_m and
    /// zero for coefficients that do not count. `None` where every function left depends on the chosen ones.
    pub fn step(&mut self, weights: &[f64]) -> Option<&Pick> {
        loop {
            self.refresh();
            let function = self.best(weights)?;
            self.available[function] = false;
            let (mut residual, mut components) = self.residual(function);
            let norm_square = dot(&residual, &residual);
            if norm_square <= DEPENDENT * self.original[function] {
                continue;
            }
            let norm = libm::sqrt(norm_square);
            residual.iter_mut().for_each(|x| *x /= norm);
            components.push(norm);
            let projections = self.project(&residual);
            self.directions.push(residual);
            self.picks.push(Pick { function, components, projections });
            return self.picks.last();
        }
    }

    /// Parameters of (8) for every α_m over the raw chosen functions, in the order of choice.
    pub fn parameters(&self) -> Vec<Vec<f64>> {
        let count = self.picks.len();
        (0..self.coefficients.len())
            .map(|m| {
                // Back substitution: the chosen functions are an upper triangle over the directions.
                let mut k: Vec<f64> = self.picks.iter().map(|pick| pick.projections[m]).collect();
                for j in (0..count).rev() {
                    k[j] /= self.picks[j].components[j];
                    for i in 0..j {
                        k[i] -= self.picks[j].components[i] * k[j];
                    }
                }
                k
            })
            .collect()
    }

    fn best(&self, weights: &[f64]) -> Option<usize> {
        let score = |l: usize| -> f64 {
            if !self.available[l] {
                return -1.0;
            }
            let mut sum = 0.0;
            for (correlations, w) in self.correlations.iter().zip(weights) {
                sum += w * correlations[l] * correlations[l];
            }
            sum / self.norms[l]
        };
        let scores: Vec<f64> = (0..self.norms.len()).into_par_iter().map(score).collect();
        let best = scores.iter().fold(-1.0, |best: f64, &s| best.max(s));
        scores.iter().position(|&s| s >= 0.0 && s >= best * (1.0 - TIE))
    }

    /// ψ_l^(j), orthogonalised twice for full accuracy, and the components that were taken out.
    fn residual(&self, l: usize) -> (Vec<f64>, Vec<f64>) {
        let mut vector = self.functions[l].to_vec();
        let mut components = vec![0.0; self.directions.len()];
        for _ in 0..2 {
            for (direction, component) in self.directions.iter().zip(&mut components) {
                let along = dot(direction, &vector);
                *component += along;
                add_scaled(&mut vector, -along, direction);
            }
        }
        (vector, components)
    }

    /// Recomputes what the rank-one updates have eaten, and retires what has vanished.
    fn refresh(&mut self) {
        let worn: Vec<usize> = (0..self.norms.len())
            .filter(|&l| self.available[l] && self.norms[l] <= RECOMPUTE * self.original[l])
            .collect();
        let fresh: Vec<_> = worn
            .par_iter()
            .map(|&l| {
                let (vector, _) = self.residual(l);
                let correlations: Vec<f64> =
                    self.coefficients.iter().map(|alpha| dot(alpha, &vector)).collect();
                (l, dot(&vector, &vector), correlations)
            })
            .collect();
        for (l, norm, correlations) in fresh {
            self.norms[l] = norm;
            self.available[l] = norm > DEPENDENT * self.original[l];
            for (row, value) in self.correlations.iter_mut().zip(correlations) {
                row[l] = value;
            }
        }
    }

    /// Rank-one updates (6), (7) for a new direction; returns the projections of the α_m.
    fn project(&mut self, direction: &[f64]) -> Vec<f64> {
        let along: Vec<f64> = self.functions.par_iter().map(|psi| dot(direction, psi)).collect();
        let projections: Vec<f64> = self.coefficients.iter().map(|alpha| dot(direction, alpha)).collect();
        for (norm, b) in self.norms.iter_mut().zip(&along) {
            *norm -= b * b;
        }
        self.correlations.par_iter_mut().zip(&projections).for_each(|(row, a)| {
            for (c, b) in row.iter_mut().zip(&along) {
                *c -= a * b;
            }
        });
        projections
    }
}
