//! Mode `shared`: the same ξ functions for all simplified coefficients.

use super::{GramSchmidt, Kind, Pick, Reduced, Samples, weight};
use crate::domain::Measure;
use crate::lagrangian::Lagrangian;
use crate::numerics::vector::dot;

/// Keeps `functions` (ξ) functions, chosen by equations (3)–(8), for every coefficient that has more.
///
/// Step j weighs the coefficients with more than j functions. At j = ξ that is the report's set Ω; before
/// it Ω is wider, since a set that depended on the final ξ would change the early choices with ξ, and the
/// selection would not be nested. Where fewer than ξ functions are independent over the measure, the
/// model has fewer.
pub fn shared(lagrangian: &Lagrangian, measure: &Measure, functions: usize) -> Reduced {
    let samples = Samples::new(lagrangian, measure);
    let weights: Vec<f64> = lagrangian.coefficients.iter().map(|c| weight(c, measure)).collect();
    let selection = selection(lagrangian, &samples, &weights, functions);
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

/// The choice of up to `functions` functions by equations (3)–(8).
fn selection<'a>(
    lagrangian: &Lagrangian,
    samples: &'a Samples,
    weights: &[f64],
    functions: usize,
) -> GramSchmidt<'a> {
    let mut selection = GramSchmidt::new(samples);
    for j in 1..=functions {
        let counting: Vec<f64> = lagrangian
            .coefficients
            .iter()
            .zip(weights)
            .map(|(c, &w)| if c.width() > j { w } else { 0.0 })
            .collect();
        if counting.iter().all(|&w| w == 0.0) || selection.step(&counting).is_none() {
            break;
        }
    }
    selection
}

/// A function of the exact model with the part of the model that it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranked {
    /// Index into [`Lagrangian::functions`].
    pub function: usize,
    /// The part of Σ_m w_m ∫α_m² that it adds to those chosen before, from 0 to 1.
    pub share: f64,
}

/// The first `functions` functions in the order in which [`shared`] chooses them, each with its share.
pub fn ranked(lagrangian: &Lagrangian, measure: &Measure, functions: usize) -> Vec<Ranked> {
    let samples = Samples::new(lagrangian, measure);
    let weights: Vec<f64> = lagrangian.coefficients.iter().map(|c| weight(c, measure)).collect();
    let sum = |squares: &mut dyn Iterator<Item = f64>| -> f64 {
        squares.zip(&weights).map(|(square, weight)| weight * square).sum()
    };
    let whole = sum(&mut samples.coefficients.iter().map(|alpha| dot(alpha, alpha)));
    let selection = selection(lagrangian, &samples, &weights, functions);
    let share = |pick: &Pick| Ranked {
        function: pick.function,
        share: if whole > 0.0 { sum(&mut pick.projections.iter().map(|p| p * p)) / whole } else { 0.0 },
    };
    selection.picks().iter().map(share).collect()
}
