//! Where the descent starts: each coefficient without the terms that hardly matter, by least squares.

use super::STRICTEST;
use super::fitting::{Form, Table};
use crate::lagrangian::Lagrangian;
use crate::reduction::lu::Lu;
use crate::reduction::samples::dot;

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
    let columns: Vec<&Vec<f64>> = kept.iter().map(|&f| &table.functions[f]).collect();
    let gram: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
    let lu = Lu::new(gram)?;
    let count = kept.len();
    let unit = |i: usize| (0..count).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
    let mut inverse: Vec<Vec<f64>> = (0..count).map(|i| lu.solve(&unit(i))).collect();
    let mut k = lu.solve(&columns.iter().map(|a| dot(a, alpha)).collect::<Vec<f64>>());
    let mut alive = vec![true; count];
    let most = PART * STRICTEST / table.weights[m];
    loop {
        let loss = |i: usize| k[i] * k[i] / inverse[i][i];
        let next = (0..count).filter(|&i| alive[i]).min_by(|&a, &b| loss(a).total_cmp(&loss(b)));
        let Some(out) = next else { break };
        let factor = k[out] / inverse[out][out];
        let mut new: Vec<f64> = (0..count).map(|i| k[i] - factor * inverse[out][i]).collect();
        new[out] = 0.0;
        let mut residual = alpha.clone();
        for (i, column) in columns.iter().enumerate().filter(|&(i, _)| alive[i] && i != out) {
            for (r, x) in residual.iter_mut().zip(*column) {
                *r -= new[i] * x;
            }
        }
        if residual.iter().any(|r| r.abs() > most) {
            break;
        }
        k = new;
        alive[out] = false;
        let row = inverse[out].clone();
        for i in (0..count).filter(|&i| alive[i]) {
            let factor = inverse[i][out] / row[out];
            for j in 0..count {
                inverse[i][j] -= factor * row[j];
            }
        }
    }
    let left: Vec<f64> = (0..count).filter(|&i| alive[i]).map(|i| k[i]).collect();
    let mut place = 0;
    kept.retain(|_| {
        place += 1;
        alive[place - 1]
    });
    Some(left)
}
