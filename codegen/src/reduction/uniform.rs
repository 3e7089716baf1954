//! Approximation and linear systems for others.

use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};
use crate::numerics::lu::Lu;

/// Parameters c that nearly minimise max_i |values_i − Σ_j c_j columns_j(i)|, and a lower bound on what any achieve;
/// columns that depend on those before get 0.
pub(crate) fn uniform(columns: &[Vec<f64>], values: &[f64]) -> (Vec<f64>, f64) {
    let basis = Basis::new(columns);
    let fitted = fit(&basis, values, &spanning_points(&basis));
    (basis.over_columns(&fitted.parameters), fitted.level)
}

/// x with M x = b; `None` where M is singular to rounding.
pub(crate) fn solved(matrix: Vec<Vec<f64>>, right: &[f64]) -> Option<Vec<f64>> {
    Lu::new(matrix).map(|lu| lu.solve(right))
}
