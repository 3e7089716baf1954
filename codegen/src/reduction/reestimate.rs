//! The parameters that a simplified model would have for other inertial parameters of the arm, section 3.3 of the report.

use rayon::prelude::*;

use super::Reduced;
use super::minimax::{Columns, ROUNDING, combination, largest};
use crate::lagrangian::{Combination, Lagrangian};
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};
use crate::numerics::vector::dot;
use crate::spec::RefitSpec;

/// Lets every α̂_m follow the uncertain parameters: α̂_m + Σ_k u_k ∂α̂_m/∂u_k, where ∂α̂_m/∂u_k is what the kept
/// functions make of ∂α_m/∂u_k over `points`, by either refit. Where α̂_m is exact, so is its derivative.
///
/// The re-estimated model is affine in u as the exact one is, and so is what it leaves out: the bound on that stands at
/// a vertex of the box of u.
pub fn reestimate(
    lagrangian: &Lagrangian,
    mut reduced: Reduced,
    points: &[Vec<f64>],
    refit: RefitSpec,
) -> Reduced {
    let mut wanted: Vec<(usize, usize)> = Vec::new();
    reduced.variations = lagrangian.coefficients.iter().map(|c| c.variations.clone()).collect();
    for (m, coefficient) in lagrangian.coefficients.iter().enumerate().filter(|(m, _)| reduced.simplified[*m])
    {
        let varies = coefficient.variations.iter().enumerate().filter(|(_, terms)| !terms.is_empty());
        wanted.extend(varies.map(|(k, _)| (m, k)));
    }
    let exact: Vec<&Combination> =
        wanted.iter().map(|&(m, k)| &lagrangian.coefficients[m].variations[k]).collect();
    let values = Columns::new(lagrangian, &reduced.selected, &exact, points);
    let basis = Basis::new(&values.functions);
    let start = spanning_points(&basis);
    let fitted: Vec<Combination> = values
        .coefficients
        .par_iter()
        .map(|alpha| {
            let parameters = match refit {
                _ if largest(alpha) <= ROUNDING => vec![0.0; basis.directions.len()],
                RefitSpec::Minimax => fit(&basis, alpha, &start).parameters,
                RefitSpec::LeastSquares => {
                    basis.directions.iter().map(|e| dot(e, alpha) / alpha.len() as f64).collect()
                }
            };
            combination(&reduced.selected, &basis.over_columns(&parameters))
        })
        .collect();
    for ((m, k), terms) in wanted.into_iter().zip(fitted) {
        reduced.variations[m][k] = terms;
    }
    reduced
}
