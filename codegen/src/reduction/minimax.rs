//! Parameters that minimise the largest residual over points of the domain.
//!
//! The bounds (9) and (10) are maxima, so the least squares of (4) is the wrong last step.

use rayon::prelude::*;

use super::Reduced;
use crate::lagrangian::{Combination, Lagrangian, evaluate};
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};

/// Residuals below this fraction of the coefficient are rounding: nothing to refit.
pub(super) const ROUNDING: f64 = 1e-12;

/// Refits every simplified α̂_m over the functions that were selected so that max |α_m − α̂_m| over `points` is the
/// least possible, and keeps the parameters it had wherever the new ones are not better at those points.
pub fn minimax(lagrangian: &Lagrangian, mut reduced: Reduced, points: &[Vec<f64>]) -> Reduced {
    let simplified: Vec<usize> = (0..reduced.simplified.len()).filter(|&m| reduced.simplified[m]).collect();
    if points.is_empty() || reduced.selected.is_empty() || simplified.is_empty() {
        return reduced;
    }
    let exact: Vec<&Combination> = simplified.iter().map(|&m| &lagrangian.coefficients[m].terms).collect();
    let values = Columns::new(lagrangian, &reduced.selected, &exact, points);
    let basis = Basis::new(&values.functions);
    let start = spanning_points(&basis);
    let refitted: Vec<Option<Combination>> = simplified
        .par_iter()
        .zip(&values.coefficients)
        .map(|(&m, alpha)| {
            let kept = parameters(&reduced, m);
            let residual = values.residual(alpha, &kept);
            let before = largest(&residual);
            if before <= ROUNDING * largest(alpha) {
                return None;
            }
            let change = basis.over_columns(&fit(&basis, &residual, &start).parameters);
            let new: Vec<f64> = kept.iter().zip(&change).map(|(k, change)| k + change).collect();
            // As they will be evaluated, after the change of basis.
            let after = largest(&values.residual(alpha, &new));
            (after < before).then(|| combination(&reduced.selected, &new))
        })
        .collect();
    for (&m, refitted) in simplified.iter().zip(refitted) {
        if let Some(terms) = refitted {
            reduced.combinations[m] = terms;
        }
    }
    reduced
}

/// Values at the points.
pub(super) struct Columns {
    /// One column for each selected function.
    pub functions: Vec<Vec<f64>>,
    /// One column for each combination to approximate.
    pub coefficients: Vec<Vec<f64>>,
}

impl Columns {
    /// Point by point, because a large arm has too many functions to keep them all at all points.
    pub fn new(
        lagrangian: &Lagrangian,
        selected: &[usize],
        combinations: &[&Combination],
        points: &[Vec<f64>],
    ) -> Self {
        let rows: Vec<(Vec<f64>, Vec<f64>)> = points
            .par_iter()
            .map(|q| {
                let psi = lagrangian.evaluate_functions(q);
                let functions = selected.iter().map(|&l| psi[l]).collect();
                (functions, combinations.iter().map(|terms| evaluate(terms, &psi)).collect())
            })
            .collect();
        let functions = (0..selected.len()).map(|j| rows.iter().map(|row| row.0[j]).collect()).collect();
        let coefficients =
            (0..combinations.len()).map(|j| rows.iter().map(|row| row.1[j]).collect()).collect();
        Self { functions, coefficients }
    }

    /// α − Σ_j k_j ψ_j.
    fn residual(&self, alpha: &[f64], parameters: &[f64]) -> Vec<f64> {
        residual(&self.functions, alpha, parameters)
    }
}

/// α − Σ_j k_j ψ_j, given one column for each function.
pub(super) fn residual(functions: &[Vec<f64>], alpha: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut out = alpha.to_vec();
    for (psi, k) in functions.iter().zip(parameters) {
        for (r, psi) in out.iter_mut().zip(psi) {
            *r -= k * psi;
        }
    }
    out
}

/// Parameters of α̂_m in the order of selection.
fn parameters(reduced: &Reduced, m: usize) -> Vec<f64> {
    let of =
        |l: &usize| reduced.combinations[m].iter().find(|(other, _)| other == l).map_or(0.0, |&(_, k)| k);
    reduced.selected.iter().map(of).collect()
}

pub(super) fn combination(selected: &[usize], parameters: &[f64]) -> Combination {
    let mut terms: Combination =
        selected.iter().copied().zip(parameters.iter().copied()).filter(|&(_, k)| k != 0.0).collect();
    terms.sort_by_key(|&(l, _)| l);
    terms
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}
