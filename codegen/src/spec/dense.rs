//! Scalars, lists and tables as vectors and matrices of the arm's size.

use super::{MatrixSpec, VectorSpec};

impl VectorSpec {
    /// One number for each of `n` joints: a scalar stands for all; `None` where a list has another length.
    pub fn by_joint(&self, n: usize) -> Option<Vec<f64>> {
        match self {
            VectorSpec::Scalar(value) => Some(vec![*value; n]),
            VectorSpec::List(list) => (list.len() == n).then(|| list.clone()),
        }
    }
}

impl MatrixSpec {
    /// The n×n matrix by rows: a scalar is a multiple of the identity, a list a diagonal; `None` where the size differs.
    pub fn by_rows(&self, n: usize) -> Option<Vec<Vec<f64>>> {
        let diagonal = |entry: &dyn Fn(usize) -> f64| {
            let row = |i: usize| (0..n).map(|j| if i == j { entry(i) } else { 0.0 }).collect();
            (0..n).map(row).collect()
        };
        match self {
            MatrixSpec::Scalar(value) => Some(diagonal(&|_| *value)),
            MatrixSpec::Diagonal(list) => {
                (list.len() == n).then(|| diagonal(&|i| list.get(i).copied().unwrap_or(0.0)))
            }
            MatrixSpec::Full(rows) => {
                (rows.len() == n && rows.iter().all(|row| row.len() == n)).then(|| rows.clone())
            }
        }
    }
}
