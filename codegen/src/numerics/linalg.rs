//! Small dense matrices, by rows, through nalgebra in its deterministic (no-std) form.

use nalgebra::DMatrix;

/// As nalgebra's matrix.
pub(crate) fn dense(m: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(m.len(), m.len(), |i, j| m[i][j])
}

/// ½(M + Mᵀ): the same quadratic form.
pub(crate) fn symmetric(m: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| 0.5 * (m[(i, j)] + m[(j, i)]))
}

/// By rows.
pub(crate) fn rows(m: &DMatrix<f64>) -> Vec<Vec<f64>> {
    (0..m.nrows()).map(|i| (0..m.ncols()).map(|j| m[(i, j)]).collect()).collect()
}

/// Σ |a_i| b_i.
pub(crate) fn weighed(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.abs() * b).sum()
}

/// Eigenvalues of a symmetric matrix, ascending; NaN where an entry is not finite.
pub(crate) fn symmetric_eigenvalues(m: &[Vec<f64>]) -> Vec<f64> {
    // The iteration need not end on NaN.
    if !m.iter().flatten().all(|v| v.is_finite()) {
        return vec![f64::NAN; m.len()];
    }
    let mut values: Vec<f64> = dense(m).symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Inverse of a square matrix; `None` where it is singular.
pub(crate) fn inverse(m: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    Some(rows(&dense(m).try_inverse()?))
}

/// a b, by rows.
pub(crate) fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = a.len();
    (0..n).map(|i| (0..n).map(|j| (0..n).map(|k| a[i][k] * b[k][j]).sum()).collect()).collect()
}
