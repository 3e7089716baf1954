//! How much of a model stands on each of its functions.

use super::{Reduced, weight};
use crate::domain::Measure;
use crate::lagrangian::{Combination, Lagrangian};
use crate::parallel::Parallelize;

/// The share of each kept function, in their order, between 0 and 1: its part of Σ_l Σ_m w_m k_ml² ∫ψ_l² over the simplified
/// coefficients, with the weights w_m of equation (2). They add up to 1, or all are 0 where nothing is kept.
pub fn shares(lagrangian: &Lagrangian, reduced: &Reduced, measure: &Measure) -> Vec<f64> {
    let (functions, sizes) = match reduced.sparse() {
        Some(sparse) => {
            let functions: Vec<Combination> =
                sparse.functions.iter().map(|psi| psi.expansion.clone()).collect();
            let mut sizes = vec![0.0; functions.len()];
            let written = sparse.written_in(lagrangian);
            for group in &sparse.groups {
                let weights = group.members.iter().map(|&(m, _)| weight(&written.coefficients[m], measure));
                let sum: f64 = weights.sum();
                group.terms.iter().for_each(|&(f, k)| sizes[f] += sum * k * k);
            }
            (functions, sizes)
        }
        None => {
            let of = |l: usize| -> f64 {
                let terms = reduced.combinations.iter().enumerate().filter(|(m, _)| reduced.simplified[*m]);
                let own = terms.filter_map(|(m, terms)| Some((m, terms.iter().find(|term| term.0 == l)?.1)));
                own.map(|(m, k)| weight(&lagrangian.coefficients[m], measure) * k * k).sum()
            };
            let functions = reduced.selected.iter().map(|&l| vec![(l, 1.0)]).collect();
            (functions, reduced.selected.iter().map(|&l| of(l)).collect())
        }
    };
    let squares: Vec<f64> = functions.par_iter().map(|psi| mean_square(lagrangian, psi, measure)).collect();
    let parts: Vec<f64> = sizes.iter().zip(&squares).map(|(size, square)| size * square).collect();
    let total: f64 = parts.iter().sum();
    parts.iter().map(|part| if total > 0.0 { part / total } else { 0.0 }).collect()
}

/// ∫ψ² of the function that `psi` expands.
fn mean_square(lagrangian: &Lagrangian, psi: &Combination, measure: &Measure) -> f64 {
    let square = |q: &Vec<f64>| {
        let value: f64 = psi.iter().map(|&(l, k)| k * lagrangian.functions[l].evaluate(q)).sum();
        value * value
    };
    measure.points.iter().zip(&measure.weights).map(|(q, weight)| weight * square(q)).sum()
}
