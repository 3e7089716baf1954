//! The parameters that stay, fitted anew.
//!
//! The error of a joint at a point is a sum of absolute values, the largest of as many linear functions as there are
//! choices of signs. Few of them matter: those with the signs that the residuals have there, at the points with the largest
//! errors. They are taken in round by round, and each round is a best uniform approximation.

use super::table::{Table, largest};
use crate::reduction::{solved, uniform};

/// Rounds at most.
const ROUNDS: usize = 4;
/// Sums taken in at each.
const ROWS: usize = 60;
/// Of the first round.
const FIRST_ROWS: usize = 200;
/// Sums below this part of the largest are not taken in.
const HIGH: f64 = 0.7;
/// What a change of one parameter does at its worst may be as many times the error that remains.
const FREEDOM: f64 = 30.0;
/// A round that comes nearer than this to what is possible is the last.
const NEAR: f64 = 0.02;
/// Part of the Gram matrix's diagonal that is added to it, so that parameters that no point tells apart stay small.
const RIDGE: f64 = 1e-6;

/// A model on the way: groups of parameters with one common value each; the rest are zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kept {
    /// Indices of parameters.
    pub groups: Vec<Vec<usize>>,
    /// All values.
    pub theta: Vec<f64>,
}

impl Kept {
    /// The same groups with the values that change the model least from `target`, by least squares over the groups that
    /// are `free`.
    pub fn near(
        &self,
        table: &Table,
        target: &[f64],
        free: impl Fn(&Vec<usize>) -> bool,
    ) -> Option<Vec<f64>> {
        let groups: Vec<&Vec<usize>> = self.groups.iter().filter(|group| free(group)).collect();
        let sum = |a: &[usize], b: &[usize]| {
            a.iter().flat_map(|&p| b.iter().map(move |&q| (p, q))).fold(0.0, |s, (p, q)| s + table.gram[p][q])
        };
        let start = self.start(target);
        let off: Vec<f64> = target.iter().zip(&start).map(|(t, s)| t - s).collect();
        let mut matrix: Vec<Vec<f64>> =
            groups.iter().map(|a| groups.iter().map(|b| sum(a, b)).collect()).collect();
        let along = |group: &&Vec<usize>| {
            group
                .iter()
                .fold(0.0, |s, &p| s + table.gram[p].iter().zip(&off).fold(0.0, |s, (g, o)| s + g * o))
        };
        // Scaled to a diagonal of 1: parameters have many units.
        let scales: Vec<f64> = (0..matrix.len())
            .map(|i| if matrix[i][i] > 0.0 { 1.0 / libm::sqrt(matrix[i][i]) } else { 0.0 })
            .collect();
        for (i, row) in matrix.iter_mut().enumerate() {
            for (x, scale) in row.iter_mut().zip(&scales) {
                *x *= scales[i] * scale;
            }
            row[i] = 1.0 + RIDGE;
        }
        let right: Vec<f64> = groups.iter().zip(&scales).map(|(group, scale)| scale * along(group)).collect();
        let step = solved(matrix, &right)?;
        let mut theta = start;
        for ((group, step), scale) in groups.iter().zip(step).zip(&scales) {
            group.iter().for_each(|&p| theta[p] += scale * step);
        }
        Some(theta)
    }

    /// The values of `target` where a parameter stays, the mean where several share one.
    pub fn start(&self, target: &[f64]) -> Vec<f64> {
        let mut theta = vec![0.0; target.len()];
        for group in &self.groups {
            let mean = group.iter().fold(0.0, |sum, &p| sum + target[p]) / group.len().max(1) as f64;
            group.iter().for_each(|&p| theta[p] = mean);
        }
        theta
    }

    /// Values for which the largest error is smaller than for the present ones, if there are any, and that error.
    pub fn refitted(&self, table: &Table) -> (Vec<f64>, f64) {
        let mut residuals = table.residuals(&self.theta);
        let mut errors = table.errors_of(&residuals);
        let mut best = (self.theta.clone(), largest(&errors));
        let mut now = best.0.clone();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        let mut values: Vec<f64> = Vec::new();
        for group in &self.groups {
            // A change against the trust in the values as they are.
            let size = group.iter().fold(0.0, |sum, &p| sum + table.sizes[p]) / FREEDOM;
            rows.push(self.groups.iter().map(|other| if other == group { size } else { 0.0 }).collect());
            values.push(0.0);
        }
        for round in 0..ROUNDS {
            let mut order: Vec<usize> = (0..errors.len()).collect();
            order.sort_by(|&a, &b| errors[b].total_cmp(&errors[a]).then(a.cmp(&b)));
            let high = HIGH * largest(&errors);
            let count = if round == 0 { FIRST_ROWS } else { ROWS };
            for &index in order.iter().take(count).filter(|&&index| errors[index] >= high) {
                let (row, value) = self.sum(table, &residuals, index, &now);
                rows.push(row);
                values.push(value);
            }
            let columns: Vec<Vec<f64>> =
                (0..self.groups.len()).map(|g| rows.iter().map(|row| row[g]).collect()).collect();
            let (steps, level) = uniform(&columns, &values);
            now.clone_from(&self.theta);
            for (group, step) in self.groups.iter().zip(steps) {
                group.iter().for_each(|&p| now[p] -= step);
            }
            residuals = table.residuals(&now);
            errors = table.errors_of(&residuals);
            let error = largest(&errors);
            if error < best.1 {
                best = (now.clone(), error);
            }
            if best.1 <= level * (1.0 + NEAR) {
                break;
            }
        }
        best
    }

    /// One error as a linear function of the changes: its slopes by group, and its value for the present parameters.
    fn sum(&self, table: &Table, residuals: &[f64], index: usize, now: &[f64]) -> (Vec<f64>, f64) {
        let n = table.shares.len();
        let (point, joint) = (index / n, index % n);
        let from = point * table.coefficients;
        let signed: Vec<(usize, f64)> = table.shares[joint]
            .iter()
            .map(|&(m, share)| (from + m, if residuals[from + m] < 0.0 { -share } else { share }))
            .collect();
        let along =
            |p: usize| signed.iter().fold(0.0, |sum, &(at, share)| sum + share * table.effects[p][at]);
        let row: Vec<f64> =
            self.groups.iter().map(|group| group.iter().fold(0.0, |sum, &p| sum + along(p))).collect();
        let here = signed.iter().fold(0.0, |sum, &(at, share)| sum + share * residuals[at]);
        // `residuals` are those of `now`.
        let moved = self.groups.iter().zip(&row).fold(0.0, |sum, (group, slope)| {
            sum + group.first().map_or(0.0, |&p| slope * (now[p] - self.theta[p]))
        });
        (row, here + moved)
    }
}
