//! Mode `shared`: the same ξ functions for all simplified coefficients.

use super::{GramSchmidt, Kind, Reduced, Samples, weight};
use crate::domain::Measure;
use crate::lagrangian::Lagrangian;

/// Keeps `functions` (ξ) functions, chosen by equations (3)–(8), for every coefficient that has more.
///
/// Step j weighs the coefficients with more than j functions. At j = ξ that is the report's set Ω; before
/// it Ω is wider, since a set that depended on the final ξ would change the early choices with ξ, and the
/// selection would not be nested. Where fewer than ξ functions are independent over the measure, the
/// model has fewer.
pub fn shared(lagrangian: &Lagrangian, measure: &Measure, functions: usize) -> Reduced {
    let samples = Samples::new(lagrangian, measure);
    let weights: Vec<f64> = lagrangian.coefficients.iter().map(|c| weight(c, measure)).collect();
    let mut selection = GramSchmidt::new(&samples);
    for j in 1..=functions {
        let counting: Vec<f64> = lagrangian
            .coefficients
            .iter()
            .zip(&weights)
            .map(|(c, &w)| if c.width() > j { w } else { 0.0 })
            .collect();
        if counting.iter().all(|&w| w == 0.0) || selection.step(&counting).is_none() {
            break;
        }
    }
    let selected: Vec<usize> = selection.picks().iter().map(|pick| pick.function).collect();
    let simplified: Vec<bool> = lagrangian.coefficients.iter().map(|c| c.width() > functions).collect();
    let combinations = lagrangian
        .coefficients
        .iter()
        .zip(selection.parameters())
        .zip(&simplified)
        .map(|((coefficient, parameters), &simplified)| {
            if !simplified {
                return coefficient.terms.clone();
            }
            let mut terms: Vec<(usize, f64)> =
                selected.iter().copied().zip(parameters).filter(|&(_, k)| k != 0.0).collect();
            terms.sort_by_key(|&(l, _)| l);
            terms
        })
        .collect();
    Reduced { selected, combinations, simplified, variations: Vec::new(), kind: Kind::Expanded }
}
