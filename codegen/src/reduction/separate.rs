//! Mode `separate`: every coefficient picks ξ functions of its own, the closing remark of section 2 of the report.

use super::minimax::{Columns, ROUNDING, combination, largest, residual};
use super::{GramSchmidt, Kind, Reduced, Samples};
use crate::domain::Measure;
use crate::lagrangian::{Combination, Lagrangian};
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};
use crate::parallel::Parallelize;

/// Where the model has more functions than this, a coefficient chooses among those of its own exact form alone.
const MANY: usize = 1000;

/// Keeps `functions` (ξ) functions in every coefficient that has more, chosen by equations (3)–(8) for it alone.
///
/// The choice of ξ + 1 functions is that of ξ and one more, coefficient by coefficient: no weight (2) enters, since
/// nothing is shared. Where fewer than ξ functions are independent over the measure, a coefficient has fewer.
pub fn separate(lagrangian: &Lagrangian, measure: &Measure, functions: usize) -> Reduced {
    let samples = Samples::new(lagrangian, measure);
    let combinations: Vec<Combination> = lagrangian
        .coefficients
        .par_iter()
        .zip(&samples.coefficients)
        .map(|(coefficient, alpha)| {
            let exact = &coefficient.terms;
            if exact.len() <= functions {
                return exact.clone();
            }
            let candidates: Vec<usize> = if lagrangian.functions.len() > MANY {
                exact.iter().map(|&(l, _)| l).collect()
            } else {
                (0..lagrangian.functions.len()).collect()
            };
            chosen(&samples, &candidates, alpha, functions)
        })
        .collect();
    let simplified: Vec<bool> = lagrangian.coefficients.iter().map(|c| c.terms.len() > functions).collect();
    Reduced {
        selected: union(&combinations, &simplified),
        combinations,
        simplified,
        variations: Vec::new(),
        kind: Kind::Expanded,
    }
}

/// α̂ over at most `count` of the candidates.
fn chosen(samples: &Samples, candidates: &[usize], alpha: &Vec<f64>, count: usize) -> Combination {
    let columns = candidates.iter().map(|&l| samples.functions[l].as_slice()).collect();
    let mut selection = GramSchmidt::over(columns, std::slice::from_ref(alpha));
    for _ in 0..count {
        if selection.step(&[1.0]).is_none() {
            break;
        }
    }
    let picked: Vec<usize> = selection.picks().iter().map(|pick| candidates[pick.function]).collect();
    combination(&picked, &selection.parameters().concat())
}

/// The functions that the simplified coefficients keep.
pub(super) fn union(combinations: &[Combination], simplified: &[bool]) -> Vec<usize> {
    let kept = combinations.iter().zip(simplified).filter(|(_, simplified)| **simplified);
    let mut out: Vec<usize> = kept.flat_map(|(terms, _)| terms.iter().map(|&(l, _)| l)).collect();
    out.sort_unstable();
    out.dedup();
    out
}

/// As [`super::minimax()`], each coefficient over the functions that it has itself.
pub fn minimax_each(lagrangian: &Lagrangian, mut reduced: Reduced, points: &[Vec<f64>]) -> Reduced {
    let simplified: Vec<usize> = (0..reduced.simplified.len()).filter(|&m| reduced.simplified[m]).collect();
    if points.is_empty() || simplified.is_empty() {
        return reduced;
    }
    let exact: Vec<&Combination> = simplified.iter().map(|&m| &lagrangian.coefficients[m].terms).collect();
    let values = Columns::new(lagrangian, &reduced.selected, &exact, points);
    let refitted: Vec<Option<Combination>> = simplified
        .par_iter()
        .zip(&values.coefficients)
        .map(|(&m, alpha)| {
            let (own, kept): (Vec<usize>, Vec<f64>) = reduced.combinations[m].iter().copied().unzip();
            let slot = |l: &usize| reduced.selected.binary_search(l).ok();
            let columns: Vec<Vec<f64>> =
                own.iter().filter_map(slot).map(|j| values.functions[j].clone()).collect();
            let before = residual(&columns, alpha, &kept);
            if columns.is_empty() || largest(&before) <= ROUNDING * largest(alpha) {
                return None;
            }
            let basis = Basis::new(&columns);
            let change = basis.over_columns(&fit(&basis, &before, &spanning_points(&basis)).parameters);
            let new: Vec<f64> = kept.iter().zip(&change).map(|(k, change)| k + change).collect();
            // As they will be evaluated, after the change of basis.
            let better = largest(&residual(&columns, alpha, &new)) < largest(&before);
            better.then(|| combination(&own, &new))
        })
        .collect();
    for (&m, refitted) in simplified.iter().zip(refitted) {
        if let Some(terms) = refitted {
            reduced.combinations[m] = terms;
        }
    }
    reduced
}
