//! The torque as sums of ψ functions.

use std::collections::{BTreeMap, BTreeSet};

use super::harmonics::Harmonics;
use crate::arm::Arm;
use crate::graph::{Builder, Expr, Graph, Variable};
use crate::lagrangian::{Entry, Lagrangian};
use crate::reduction::Reduced;

/// Coefficients from the ψ they keep, then τ_i = Σ_j d_ij a_r,j + Σ_{j≤k} h_ijk v_jk + g_i, where
/// v_jk = q̇_j v_r,k + q̇_k v_r,j and v_jj = q̇_j v_r,j. One line a ψ and one a coefficient, under stable names.
pub fn expanded(arm: &Arm, lagrangian: &Lagrangian, reduced: &Reduced) -> Graph {
    let builder = Builder::new();
    let psi = functions(&builder, lagrangian, reduced.combinations.iter().flatten());
    let alphas: Vec<_> = lagrangian
        .coefficients
        .iter()
        .zip(&reduced.combinations)
        .map(|(coefficient, terms)| alpha(&builder, &coefficient.name(), terms, &psi))
        .collect();
    let outputs = torque(&builder, arm.dof(), lagrangian, &alphas);
    let outputs: Vec<_> =
        (1..).zip(outputs).map(|(i, tau)| tau.named(&format!("tau{i}"), true).id()).collect();
    builder.finish(&outputs)
}

/// The torque whose coefficients are `alphas`, by row.
pub(super) fn torque<'g>(
    builder: &'g Builder,
    dof: usize,
    lagrangian: &Lagrangian,
    alphas: &[Option<Expr<'g>>],
) -> Vec<Expr<'g>> {
    let mut rows: Vec<Vec<Expr>> = vec![Vec::new(); dof];
    for (coefficient, alpha) in lagrangian.coefficients.iter().zip(alphas) {
        let Some(alpha) = *alpha else { continue };
        for place in &coefficient.places {
            let minus = place.sign < 0.0;
            match place.entry {
                Entry::D(i, j) => {
                    rows[i].push(signed(minus, alpha * builder.input(Variable::Ar(j))));
                    if i != j {
                        rows[j].push(signed(minus, alpha * builder.input(Variable::Ar(i))));
                    }
                }
                Entry::H(i, j, k) => rows[i].push(signed(minus, alpha * velocity_product(builder, j, k))),
                Entry::G(i) => rows[i].push(signed(minus, alpha)),
            }
        }
    }
    let sum = |row: Vec<Expr<'g>>| row.into_iter().reduce(|sum, term| sum + term);
    rows.into_iter().map(|row| sum(row).unwrap_or(builder.constant(0.0))).collect()
}

/// The functions that occur in `terms`, by index.
pub(super) fn functions<'g, 't>(
    builder: &'g Builder,
    lagrangian: &Lagrangian,
    terms: impl Iterator<Item = &'t (usize, f64)>,
) -> BTreeMap<usize, Expr<'g>> {
    let mut harmonics = Harmonics::new(builder);
    let used: BTreeSet<usize> = terms.map(|&(l, _)| l).collect();
    used.into_iter().map(|l| (l, harmonics.function(&lagrangian.functions[l]))).collect()
}

/// Σ k_l ψ_l, named; `None` for the empty sum.
pub(super) fn alpha<'g>(
    builder: &'g Builder,
    name: &str,
    terms: &[(usize, f64)],
    psi: &BTreeMap<usize, Expr<'g>>,
) -> Option<Expr<'g>> {
    // Where every k_l is negative the first keeps its sign as part of the literal: negating the sum would cost an
    // operation, and negating the name would make it depend on the reduction.
    let negative = terms.iter().all(|&(_, k)| k < 0.0);
    let term = |(number, &(l, k)): (usize, &(usize, f64))| {
        let psi = *psi.get(&l)?;
        Some(if negative && number == 0 { psi.scaled(k) } else { builder.constant(k) * psi })
    };
    let sum = terms.iter().enumerate().filter_map(term).reduce(|sum, term| sum + term)?;
    Some(if sum.is_constant() { sum } else { sum.named(name, true) })
}

/// The sign goes to the product and not to the coefficient: sums absorb it there.
pub(super) fn signed(minus: bool, product: Expr<'_>) -> Expr<'_> {
    if minus { -product } else { product }
}

pub(super) fn velocity_product(builder: &Builder, j: usize, k: usize) -> Expr<'_> {
    let product = |a, b| builder.input(Variable::Qd(a)) * builder.input(Variable::Vr(b));
    let value = if j == k { product(j, j) } else { product(j, k) + product(k, j) };
    value.named(&format!("v{}{}", j + 1, k + 1), true)
}
