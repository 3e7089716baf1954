//! Scalars, lists and tables where a vector or a matrix is meant.

use crate::error::Diagnostics;
use crate::spec::{MatrixSpec, VectorSpec};

/// One number for each of `n` joints: a scalar stands for all; `None` where a list has another length.
pub fn vector(spec: &VectorSpec, n: usize) -> Option<Vec<f64>> {
    match spec {
        VectorSpec::Scalar(value) => Some(vec![*value; n]),
        VectorSpec::List(list) => (list.len() == n).then(|| list.clone()),
    }
}

/// The n×n matrix by rows: a scalar is a multiple of the identity, a list a diagonal; `None` where the size differs.
pub fn matrix(spec: &MatrixSpec, n: usize) -> Option<Vec<Vec<f64>>> {
    let diagonal = |entry: &dyn Fn(usize) -> f64| {
        let row = |i: usize| (0..n).map(|j| if i == j { entry(i) } else { 0.0 }).collect();
        (0..n).map(row).collect()
    };
    match spec {
        MatrixSpec::Scalar(value) => Some(diagonal(&|_| *value)),
        MatrixSpec::Diagonal(list) => {
            (list.len() == n).then(|| diagonal(&|i| list.get(i).copied().unwrap_or(0.0)))
        }
        MatrixSpec::Full(rows) => {
            (rows.len() == n && rows.iter().all(|row| row.len() == n)).then(|| rows.clone())
        }
    }
}

/// "has 1 entry", "has 2 entries".
pub(crate) fn has(count: usize) -> String {
    format!("has {count} {}", if count == 1 { "entry" } else { "entries" })
}

/// A fault where a list has not one entry for each of `joints`; true where it has, or the number is unknown.
pub(super) fn length(field: &str, found: usize, joints: Option<usize>, faults: &mut Diagnostics) -> bool {
    match joints {
        Some(n) if found != n => {
            faults.push(field, has(found), format!("write {n}, one for each joint"));
            false
        }
        _ => true,
    }
}

/// Faults where a scalar or list has the wrong length or entries that are not `good`; `wanted` says what is.
pub(super) fn entries(
    field: &str,
    spec: &VectorSpec,
    joints: Option<usize>,
    good: impl Fn(f64) -> bool,
    wanted: &str,
    faults: &mut Diagnostics,
) {
    match spec {
        VectorSpec::Scalar(value) if !good(*value) => {
            faults.push(field, format!("is {value}"), format!("write {wanted}"));
        }
        VectorSpec::Scalar(_) => {}
        VectorSpec::List(list) => {
            length(field, list.len(), joints, faults);
            for (i, value) in list.iter().enumerate().filter(|(_, v)| !good(**v)) {
                faults.push(format!("{field}[{i}]"), format!("is {value}"), format!("write {wanted}"));
            }
        }
    }
}
