//! Where the descent starts: each coefficient without the terms that hardly matter, by least squares.

use super::STRICTEST;
use super::fitting::{Form, Table};
use super::squares::{Squares, independent};
use crate::lagrangian::Lagrangian;

/// What one coefficient may add to the error, as a fraction of the first step's.
const PART: f64 = 0.15;
/// What its smallest terms may add together before any fit.
const TRUNCATED: f64 = 0.05;

/// One form for each coefficient.
pub(super) fn forms(lagrangian: &Lagrangian, table: &Table, m: usize) -> Form {
    let weight = table.weights[m];
    let mut terms = lagrangian.coefficients[m].terms.clone();
    terms.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()).then(a.0.cmp(&b.0)));
    let mut dropped = 0.0;
    let small = terms.iter().take_while(|term| {
        dropped += term.1.abs() * weight;
        dropped <= TRUNCATED * STRICTEST
    });
    let from = small.count();
    let mut kept: Vec<usize> = terms[from..].iter().map(|term| term.0).collect();
    kept.sort_unstable();
    let parameters = eliminated(table, m, &mut kept);
    match parameters {
        Some(parameters) if !kept.is_empty() => Form::with(table, vec![(m, 1.0)], kept, parameters),
        _ => Form::fitted(table, vec![(m, 1.0)], kept, None),
    }
}

/// Takes out function after function, each time the one whose loss adds least to the squares, as long as the largest
/// residual stays small; the parameters left.
fn eliminated(table: &Table, m: usize, kept: &mut Vec<usize>) -> Option<Vec<f64>> {
    let alpha = &table.coefficients[m];
    let of = |kept: &[usize]| -> Vec<&Vec<f64>> { kept.iter().map(|&f| &table.functions[f]).collect() };
    let mut columns = of(kept);
    let mut squares = match Squares::new(&columns, alpha) {
        Some(squares) => squares,
        None => {
            *kept = independent(&columns).into_iter().map(|i| kept[i]).collect();
            columns = of(kept);
            Squares::new(&columns, alpha)?
        }
    };
    let most = PART * STRICTEST / table.weights[m];
    while let Some(out) = squares.left().min_by(|&a, &b| squares.loss(a).total_cmp(&squares.loss(b))) {
        let new = squares.without(out);
        let mut residual = alpha.clone();
        for i in squares.left().filter(|&i| i != out) {
            for (r, x) in residual.iter_mut().zip(columns[i]) {
                *r -= new[i] * x;
            }
        }
        if residual.iter().any(|r| r.abs() > most) {
            break;
        }
        squares.remove(out, new);
    }
    let left: Vec<usize> = squares.left().collect();
    *kept = left.iter().map(|&i| kept[i]).collect();
    Some(left.iter().map(|&i| squares.parameters[i]).collect())
}
