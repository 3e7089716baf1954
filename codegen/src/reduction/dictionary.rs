//! Reductions over dictionaries with products of functions.

use super::minimax::{largest, residual};
use super::sparse::{CandidateFunction, Group, Sparse, products};
use super::{GramSchmidt, Samples, weight};
use crate::domain::Measure;
use crate::lagrangian::{Function, Lagrangian, evaluate};
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};
use crate::parallel::Parallelize;
use crate::spec::DictionarySpec;

/// The functions among which a reduction chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dictionary {
    /// The ψ of the exact model.
    Harmonic,
    /// 1, the functions of first degree, and products of two of them; linearly dependent in general.
    Product,
    /// Both.
    Union,
}

impl Dictionary {
    /// The one that a specification names.
    pub fn of(spec: DictionarySpec) -> Self {
        match spec {
            DictionarySpec::Harmonic => Self::Harmonic,
            DictionarySpec::Product => Self::Product,
            DictionarySpec::Union => Self::Union,
        }
    }

    /// Its functions.
    pub fn functions(self, lagrangian: &Lagrangian) -> Vec<CandidateFunction> {
        let plain = |l: &usize| {
            let psi = &lagrangian.functions[*l];
            self != Self::Product || *psi == Function::ONE || psi.is_first_degree()
        };
        let harmonic = (0..lagrangian.functions.len()).filter(plain).map(CandidateFunction::harmonic);
        let more = if self == Self::Harmonic { Vec::new() } else { products(lagrangian, 2) };
        harmonic.chain(more).collect()
    }
}

/// Keeps `functions` (ξ) functions of the dictionary in every coefficient that has more, by equations (3)–(8): the same
/// ones for all, or its own for each where `separate`.
///
/// A candidate that depends on the chosen ones is passed over, as dictionaries with products have many.
pub fn over_dictionary(
    lagrangian: &Lagrangian,
    measure: &Measure,
    dictionary: Vec<CandidateFunction>,
    functions: usize,
    separate: bool,
) -> Sparse {
    let samples = Samples::new(lagrangian, measure);
    let column = |candidate: &CandidateFunction| {
        let mut sum = vec![0.0; measure.points.len()];
        for &(l, k) in &candidate.expansion {
            crate::numerics::vector::add_scaled(&mut sum, k, &samples.functions[l]);
        }
        sum
    };
    let columns: Vec<Vec<f64>> = dictionary.par_iter().map(column).collect();
    let slices = || columns.iter().map(Vec::as_slice).collect::<Vec<_>>();
    let count = lagrangian.coefficients.len();
    let long: Vec<usize> =
        (0..count).filter(|&m| lagrangian.coefficients[m].terms.len() > functions).collect();
    let run = |mut selection: GramSchmidt, weights: &[f64]| {
        for _ in 0..functions {
            if selection.step(weights).is_none() {
                break;
            }
        }
        let picked: Vec<usize> = selection.picks().iter().map(|pick| pick.function).collect();
        let terms = |k: Vec<f64>| picked.iter().copied().zip(k).filter(|term| term.1 != 0.0).collect();
        selection.parameters().into_iter().map(terms).collect::<Vec<Vec<(usize, f64)>>>()
    };
    let kept: Vec<Vec<(usize, f64)>> = if separate {
        let own = |&m: &usize| {
            let alpha = std::slice::from_ref(&samples.coefficients[m]);
            run(GramSchmidt::over(slices(), alpha), &[1.0]).concat()
        };
        long.par_iter().map(own).collect()
    } else {
        let alphas: Vec<Vec<f64>> = long.iter().map(|&m| samples.coefficients[m].clone()).collect();
        let weights: Vec<f64> = long.iter().map(|&m| weight(&lagrangian.coefficients[m], measure)).collect();
        run(GramSchmidt::over(slices(), &alphas), &weights)
    };
    let mut model = Sparse { functions: dictionary, groups: Vec::new(), absolute: None };
    let mut kept = long.iter().zip(kept).peekable();
    for m in 0..count {
        let terms = match kept.next_if(|(long, _)| **long == m) {
            Some((_, terms)) => terms,
            // What is short stays as it is.
            None => {
                let exact = &lagrangian.coefficients[m].terms;
                exact.iter().map(|&(l, k)| (model.index_of_harmonic(l), k)).collect()
            }
        };
        model.groups.push(Group { members: vec![(m, 1.0)], terms });
    }
    model.compacted()
}

/// Refits every coefficient with more than `functions` ψ over the functions it keeps so that the largest residual over
/// `points` is the least possible; what it had stays where that is not better.
pub fn minimax_sparse(
    lagrangian: &Lagrangian,
    mut model: Sparse,
    functions: usize,
    points: &[Vec<f64>],
) -> Sparse {
    if points.is_empty() {
        return model;
    }
    let values = |q: &Vec<f64>| {
        let psi = lagrangian.evaluate_functions(q);
        let kept: Vec<f64> = model.functions.iter().map(|c| evaluate(&c.expansion, &psi)).collect();
        let alpha: Vec<f64> = lagrangian.coefficients.iter().map(|c| evaluate(&c.terms, &psi)).collect();
        (kept, alpha)
    };
    let rows: Vec<(Vec<f64>, Vec<f64>)> = points.par_iter().map(values).collect();
    let refitted: Vec<Option<Vec<f64>>> = model
        .groups
        .par_iter()
        .map(|group| {
            let &[(m, _)] = group.members.as_slice() else { return None };
            if lagrangian.coefficients[m].terms.len() <= functions || group.terms.is_empty() {
                return None;
            }
            let columns: Vec<Vec<f64>> =
                group.terms.iter().map(|&(f, _)| rows.iter().map(|row| row.0[f]).collect()).collect();
            let alpha: Vec<f64> = rows.iter().map(|row| row.1[m]).collect();
            let before: Vec<f64> = group.terms.iter().map(|term| term.1).collect();
            let left = residual(&columns, &alpha, &before);
            let basis = Basis::new(&columns);
            let change = basis.over_columns(&fit(&basis, &left, &spanning_points(&basis)).parameters);
            let after: Vec<f64> = before.iter().zip(&change).map(|(k, change)| k + change).collect();
            (largest(&residual(&columns, &alpha, &after)) < largest(&left)).then_some(after)
        })
        .collect();
    for (group, parameters) in model.groups.iter_mut().zip(refitted) {
        for (term, k) in group.terms.iter_mut().zip(parameters.into_iter().flatten()) {
            term.1 = k;
        }
    }
    model
}
