//! The torque as sums of ψ functions.

use super::harmonics::Harmonics;
use crate::arm::Arm;
use crate::graph::{Builder, Expr, Graph, Variable};
use crate::lagrangian::{Entry, Lagrangian};
use crate::reduction::Reduced;

/// Coefficients from the ψ they keep, then τ_i = Σ_j d_ij a_r,j + Σ_{j≤k} h_ijk v_jk + g_i, where
/// v_jk = q̇_j v_r,k + q̇_k v_r,j and v_jj = q̇_j v_r,j. One line a ψ and one a coefficient, under stable names.
pub fn expanded(arm: &Arm, lagrangian: &Lagrangian, reduced: &Reduced) -> Graph {
    let builder = Builder::new();
    let mut harmonics = Harmonics::new(&builder);
    let mut rows: Vec<Vec<Expr>> = vec![Vec::new(); arm.dof()];
    for (coefficient, terms) in lagrangian.coefficients.iter().zip(&reduced.combinations) {
        let alpha = terms
            .iter()
            .map(|&(l, k)| builder.constant(k) * harmonics.function(&lagrangian.functions[l]))
            .reduce(|sum, term| sum + term);
        let Some(alpha) = alpha else { continue };
        if terms.len() > 1 {
            alpha.named(&coefficient.name(), true);
        }
        for place in &coefficient.places {
            let signed = builder.constant(place.sign) * alpha;
            match place.entry {
                Entry::D(i, j) => {
                    rows[i].push(signed * builder.input(Variable::Ar(j)));
                    if i != j {
                        rows[j].push(signed * builder.input(Variable::Ar(i)));
                    }
                }
                Entry::H(i, j, k) => rows[i].push(signed * velocity_product(&builder, j, k)),
                Entry::G(i) => rows[i].push(signed),
            }
        }
    }
    let outputs: Vec<_> = (1..)
        .zip(rows)
        .map(|(i, row)| {
            let torque = row.into_iter().reduce(|sum, term| sum + term);
            torque.unwrap_or(builder.constant(0.0)).named(&format!("tau{i}"), true).id()
        })
        .collect();
    drop(harmonics);
    builder.finish(&outputs)
}

fn velocity_product(builder: &Builder, j: usize, k: usize) -> Expr<'_> {
    let product = |a, b| builder.input(Variable::Qd(a)) * builder.input(Variable::Vr(b));
    let value = if j == k { product(j, j) } else { product(j, k) + product(k, j) };
    value.named(&format!("v{}{}", j + 1, k + 1), true)
}
