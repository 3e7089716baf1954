//! Interval families of symmetric matrices: whether ΔC1 outweighs every δC with |δC| ≤ ΔC.

use super::verified::largest_eigenvalue;
use crate::numerics::linalg::{dense, symmetric_eigenvalues};

/// λ_min of ΔC1 + sym(δC) over all |δC| ≤ ΔC, N·m·s/rad.
///
/// λ_min is concave, and xᵀ sym(δC) x is least where every entry pulls against x_i x_j: at one of the matrices
/// ΔC1 − diag(z) sym(ΔC) diag(z), z a vector of signs (Hertz 1992, Rohn 1994), of which z and −z are the same.
pub fn least_eigenvalue(delta_c1: &[Vec<f64>], delta_c: &[Vec<f64>]) -> f64 {
    let n = delta_c.len();
    let half = symmetric_part(delta_c);
    let at = |signs: usize| {
        let z = |i: usize| if i > 0 && signs >> (i - 1) & 1 == 1 { -1.0 } else { 1.0 };
        let entry = |i: usize, j: usize| delta_c1[i][j] - z(i) * half[i][j] * z(j);
        let rows: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        symmetric_eigenvalues(&rows).first().copied().unwrap_or(0.0)
    };
    (0..1_usize << n.saturating_sub(1)).map(at).fold(f64::INFINITY, f64::min)
}

/// k* = λ_max(sym ΔC) from above, the smallest k for which k·I outweighs the family, N·m·s/rad: with ΔC ≥ 0 the all-plus vector
/// of signs is the worst.
pub fn smallest_multiple(delta_c: &[Vec<f64>]) -> f64 {
    if delta_c.iter().flatten().all(|entry| *entry == 0.0) {
        return 0.0;
    }
    largest_eigenvalue(&dense(&symmetric_part(delta_c)))
}

/// Whether `least`, from [`least_eigenvalue`], is not negative but for rounding.
pub fn outweighs(least: f64, delta_c: &[Vec<f64>]) -> bool {
    let scale = delta_c.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    least >= -1e-9 * scale
}

fn symmetric_part(m: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = m.len();
    (0..n).map(|i| (0..n).map(|j| 0.5 * (m[i][j] + m[j][i])).collect()).collect()
}

/// value·I.
pub fn multiple_of_identity(value: f64, n: usize) -> Vec<Vec<f64>> {
    (0..n).map(|i| (0..n).map(|j| if i == j { value } else { 0.0 }).collect()).collect()
}
