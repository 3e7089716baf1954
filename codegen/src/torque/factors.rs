//! Common factors within a coefficient: k₁ f g + k₂ f h as f (k₁ g + k₂ h).

use std::collections::BTreeSet;

use crate::reduction::{Group, Sparse};

/// For each group the ψ that is taken out of its products of two; `None` where that saves nothing.
pub(super) fn common_factors(model: &Sparse) -> Vec<Option<usize>> {
    let mut chosen = vec![None; model.groups.len()];
    let plain = multiplications(model, &chosen);
    // A product that two groups need goes only when both have let go of it, so ties are taken, twice around.
    for _ in 0..2 {
        for g in 0..chosen.len() {
            let mut least = multiplications(model, &chosen);
            for factor in candidates(model, &model.groups[g]) {
                let before = chosen[g].replace(factor);
                let now = multiplications(model, &chosen);
                if now <= least {
                    least = now;
                } else {
                    chosen[g] = before;
                }
            }
        }
    }
    if multiplications(model, &chosen) < plain { chosen } else { vec![None; chosen.len()] }
}

/// The other factor of function `f` where it is a product of two with the factor `l`.
pub(super) fn cofactor(model: &Sparse, f: usize, l: usize) -> Option<usize> {
    match *model.functions[f].factors.as_slice() {
        [a, b] if a == l => Some(b),
        [a, b] if b == l => Some(a),
        _ => None,
    }
}

/// What at least two products of the group have in common.
fn candidates(model: &Sparse, group: &Group) -> BTreeSet<usize> {
    let pairs = || group.terms.iter().map(|&(f, _)| &model.functions[f].factors).filter(|f| f.len() == 2);
    let often = |l: &usize| pairs().filter(|factors| factors.contains(l)).count() >= 2;
    pairs().flatten().copied().filter(often).collect()
}

/// Multiplications that products of functions and common factors take.
fn multiplications(model: &Sparse, chosen: &[Option<usize>]) -> usize {
    let mut products: BTreeSet<Vec<usize>> = BTreeSet::new();
    for (group, factor) in model.groups.iter().zip(chosen) {
        for &(f, _) in &group.terms {
            if factor.is_some_and(|l| cofactor(model, f, l).is_some()) {
                continue;
            }
            let factors = &model.functions[f].factors;
            for from in 0..factors.len().saturating_sub(1) {
                let mut product = factors[from..].to_vec();
                if product.len() == 2 {
                    product.sort_unstable();
                }
                products.insert(product);
            }
        }
    }
    products.len() + chosen.iter().flatten().count()
}
