//! D, C, h and G of the code that is emitted.

use crate::graph::{Graph, Variable};
use crate::lagrangian::Values;

/// D, h and G at `q` (rad or m) as the passivity torque `code` of `n` joints computes with them.
pub fn matrices(code: &Graph, n: usize, q: &[f64]) -> Values {
    let rest = vec![0.0; n];
    let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
    let mut out = Values {
        mass_matrix: vec![vec![0.0; n]; n],
        christoffel: vec![vec![vec![0.0; n]; n]; n],
        gravity: code.interpret(q, &rest, &rest, &rest),
    };
    for j in 0..n {
        let column = code.slopes(q, &rest, &rest, &rest, Variable::Ar(j));
        out.mass_matrix.iter_mut().zip(column).for_each(|(row, entry)| row[j] = entry);
        for k in 0..n {
            let column = code.slopes(q, &unit(k), &rest, &rest, Variable::Vr(j));
            out.christoffel.iter_mut().zip(column).for_each(|(plane, entry)| plane[j][k] = entry);
        }
    }
    out
}
