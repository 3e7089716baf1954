//! Best uniform approximation over points: Stiefel's exchange, which is the dual simplex method on
//!
//! ```text
//! minimise h subject to |r_i − Σ_j c_j e_j(i)| ≤ h at every point i.
//! ```
//!
//! A reference of k + 1 points with signs carries multipliers λ ≥ 0 with Σ λ_i s_i e_j(i) = 0 and Σ λ_i = 1; its own
//! optimum, where all its residuals equal s_i h, is a lower bound h on what any parameters achieve. Each step
//! takes in the point with the largest residual and drops the one that keeps λ ≥ 0, so h only grows; it ends where no
//! residual exceeds h. Every sum has a fixed order and nothing but + − × ÷ and √ is used: the same bits on every machine.

use super::basis::Basis;
use super::lu::Lu;

/// Relative distance from the optimum at which the exchange stops.
const TOLERANCE: f64 = 1e-6;
/// Slack on λ ≥ 0 in the ratio test, so that among nearly tied points the best-conditioned one leaves.
const SLACK: f64 = 1e-10;
/// Points handled at a time, so that a block stays in the first-level cache.
const BLOCK: usize = 512;

/// Parameters that nearly minimise the largest residual.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fit {
    /// c_j over the directions.
    pub parameters: Vec<f64>,
    /// The largest residual over all points.
    pub deviation: f64,
    /// A lower bound on the largest residual of any parameters.
    pub level: f64,
    /// The last reference.
    pub reference: Vec<Active>,
}

/// A point of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Active {
    /// Index of the point.
    pub point: usize,
    /// Sign of its residual, +1 or −1.
    pub sign: f64,
}

/// As many points as directions over which these are well independent: elimination with row pivoting.
pub(crate) fn spanning_points(basis: &Basis) -> Vec<usize> {
    let mut columns = basis.directions.clone();
    let mut points = Vec::with_capacity(columns.len());
    for k in 0..columns.len() {
        let (done, rest) = columns.split_at_mut(k + 1);
        let pivot = largest(&done[k]).0;
        for column in rest {
            let factor = column[pivot] / done[k][pivot];
            for (x, y) in column.iter_mut().zip(&done[k]) {
                *x -= factor * y;
            }
        }
        points.push(pivot);
    }
    points
}

/// Approximates `values` by the directions of `basis`; `start` are its [`spanning_points`].
///
/// Never worse than all parameters 0, and ends after a number of steps that depends on the number of directions
/// alone: where rounding stops the exchange early, the best parameters so far are returned.
pub(crate) fn fit(basis: &Basis, values: &[f64], start: &[usize]) -> Fit {
    fit_below(basis, values, start, f64::INFINITY)
}

/// As [`fit`] where some parameters leave no residual above `most`; otherwise the exchange may end as soon as its level says
/// so.
pub(crate) fn fit_below(basis: &Basis, values: &[f64], start: &[usize], most: f64) -> Fit {
    let directions = &basis.directions;
    let count = directions.len();
    let (first, deviation) = largest(values);
    let mut best = Fit { parameters: vec![0.0; count], deviation, level: 0.0, reference: Vec::new() };
    let Some(mut reference) = first_reference(basis, values, start, first) else { return best };
    let mut residual = vec![0.0; values.len()];
    for _ in 0..100 + 40 * count {
        let Some(lu) = Lu::new(rows(directions, &reference)) else { break };
        let right: Vec<f64> = reference.iter().map(|active| active.sign * values[active.point]).collect();
        let mut parameters = lu.solve(&right);
        let Some(level) = parameters.pop() else { break };
        residuals(directions, values, &parameters, &mut residual);
        let (point, deviation) = largest(&residual);
        if level > best.level {
            best.level = level;
            best.reference.clone_from(&reference);
        }
        if deviation < best.deviation {
            best.deviation = deviation;
            best.parameters = parameters;
        }
        let hopeless = best.level > most && best.deviation > most;
        if hopeless
            || best.deviation <= best.level * (1.0 + TOLERANCE)
            || reference.iter().any(|a| a.point == point)
        {
            break;
        }
        let entering = Active { point, sign: residual[point].signum() };
        let Some(leaving) = leaving(&lu, &row(directions, entering)) else { break };
        reference[leaving] = entering;
    }
    best
}

/// The spanning points and the worst other one, with the signs that make λ ≥ 0 and h ≥ 0.
fn first_reference(basis: &Basis, values: &[f64], start: &[usize], worst: usize) -> Option<Vec<Active>> {
    let count = basis.directions.len();
    let rest = || (0..values.len()).filter(|i| !start.contains(i));
    let extra = if start.contains(&worst) {
        rest().fold(None, |best: Option<usize>, i| match best {
            Some(b) if values[b].abs() >= values[i].abs() => best,
            _ => Some(i),
        })?
    } else {
        worst
    };
    // With row `extra` = Σ μ_j row j, the multipliers are −μ on the spanning points and 1 on the extra one.
    let at = |i: usize| -> Vec<f64> { basis.directions.iter().map(|e| e[i]).collect() };
    let mut multipliers: Vec<f64> =
        Lu::new(start.iter().map(|&i| at(i)).collect())?.solve_transposed(&at(extra));
    multipliers.iter_mut().for_each(|x| *x = -*x);
    multipliers.push(1.0);
    let points: Vec<usize> = start.iter().copied().chain([extra]).collect();
    let level: f64 = points.iter().zip(&multipliers).map(|(&i, x)| x * values[i]).sum();
    let turn = if level < 0.0 { -1.0 } else { 1.0 };
    debug_assert_eq!(points.len(), count + 1);
    let active = |(&point, x): (&usize, &f64)| Active { point, sign: if *x < 0.0 { -turn } else { turn } };
    Some(points.iter().zip(&multipliers).map(active).collect())
}

/// Row (s e_1(i), …, s e_k(i), 1) of the system s (r − Σ c e) = h.
fn row(directions: &[Vec<f64>], active: Active) -> Vec<f64> {
    directions.iter().map(|e| active.sign * e[active.point]).chain([1.0]).collect()
}

fn rows(directions: &[Vec<f64>], reference: &[Active]) -> Vec<Vec<f64>> {
    reference.iter().map(|&active| row(directions, active)).collect()
}

/// Which member of the reference leaves when `entering` comes: the first whose λ falls to 0; of those that do so
/// within the slack, the one that leaves the best-conditioned reference.
fn leaving(lu: &Lu, entering: &[f64]) -> Option<usize> {
    let mut unit = vec![0.0; entering.len()];
    *unit.last_mut()? = 1.0;
    let multipliers = lu.solve_transposed(&unit);
    let change = lu.solve_transposed(entering);
    let smallest = 1e-11 * change.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let candidates = || (0..change.len()).filter(|&j| change[j] > smallest);
    let step =
        candidates().fold(f64::INFINITY, |s: f64, j| s.min((multipliers[j].max(0.0) + SLACK) / change[j]));
    candidates().filter(|&j| multipliers[j].max(0.0) / change[j] <= step).fold(None, |best, j| match best {
        Some(b) if change[b] >= change[j] => best,
        _ => Some(j),
    })
}

/// r_i − Σ_j c_j e_j(i).
fn residuals(directions: &[Vec<f64>], values: &[f64], parameters: &[f64], out: &mut [f64]) {
    for (block, out) in out.chunks_mut(BLOCK).enumerate() {
        let from = block * BLOCK;
        out.copy_from_slice(&values[from..from + out.len()]);
        for (direction, c) in directions.iter().zip(parameters) {
            for (r, e) in out.iter_mut().zip(&direction[from..]) {
                *r -= c * e;
            }
        }
    }
}

/// The first position of the largest absolute value, and that value; (0, 0) for nothing.
fn largest(values: &[f64]) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (i, x) in values.iter().enumerate() {
        if x.abs() > best.1 {
            best = (i, x.abs());
        }
    }
    best
}

#[cfg(test)]
mod tests;
