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
    /// A square matrix as one would write it: its diagonal, where that is all.
    pub fn of(rows: &[Vec<f64>]) -> Self {
        let n = rows.len();
        let diagonal = (0..n).all(|i| (0..n).all(|j| i == j || rows[i][j] == 0.0));
        if diagonal {
            MatrixSpec::Diagonal((0..n).map(|i| rows[i][i]).collect())
        } else {
            MatrixSpec::Full(rows.to_vec())
        }
    }

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
