//! One form for a group of coefficients, fitted to points of the domain.

use super::SparseProblem;
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit, spanning_points};
use crate::numerics::vector::dot;

/// Forms with more functions than this are fitted by least squares: there the search throws out what hardly matters.
pub(super) const LARGE: usize = 6;

/// Values at the points of a [`SparseProblem`].
pub(super) struct Table {
    /// One column for each candidate.
    pub functions: Vec<Vec<f64>>,
    /// One column for each coefficient.
    pub coefficients: Vec<Vec<f64>>,
    /// For each coefficient the joints whose torque it enters, and Ū over the joint's torque.
    pub shares: Vec<Vec<(usize, f64)>>,
    /// The largest share of each coefficient.
    pub weights: Vec<f64>,
}

impl Table {
    pub fn points(&self) -> usize {
        self.coefficients.first().map_or(0, Vec::len)
    }

    pub fn new(problem: &SparseProblem, functions: Vec<Vec<f64>>, coefficients: Vec<Vec<f64>>) -> Self {
        let shares: Vec<Vec<(usize, f64)>> = (0..coefficients.len())
            .map(|m| {
                let share = |(i, row): (usize, &Vec<f64>)| (row[m] > 0.0).then_some((i, row[m]));
                problem.shares.iter().enumerate().filter_map(share).collect()
            })
            .collect();
        let largest = |s: &Vec<(usize, f64)>| s.iter().fold(0.0, |m: f64, x| m.max(x.1));
        Self { functions, coefficients, weights: shares.iter().map(largest).collect(), shares }
    }
}

/// A fitted form.
#[derive(Clone, Debug)]
pub(super) struct Form {
    /// Coefficients with the signs of the form there.
    pub members: Vec<(usize, f64)>,
    /// The candidates it keeps, ascending.
    pub kept: Vec<usize>,
    /// Their parameters.
    pub parameters: Vec<f64>,
    /// What it leaves of each member.
    pub residuals: Vec<Vec<f64>>,
    /// Its part of the torque errors, relative to the joints' torques, summed over joints: mean of the largest and the
    /// mean over the points.
    pub burden: f64,
}

impl Form {
    /// Where nothing is left of a group.
    pub fn nothing() -> Self {
        let (members, kept, parameters, residuals) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { members, kept, parameters, residuals, burden: 0.0 }
    }

    /// The parameters that minimise the largest residual, weighed by the members' weights or, for a single member, by
    /// `room`⁻¹.
    pub fn fitted(
        table: &Table,
        members: Vec<(usize, f64)>,
        kept: Vec<usize>,
        inverse_room: Option<&[f64]>,
    ) -> Self {
        let scaled = |column: &[f64], m: usize, sign: f64| -> Vec<f64> {
            let factor = if members.len() == 1 { sign } else { sign * table.weights[m] };
            match inverse_room {
                Some(weights) => column.iter().zip(weights).map(|(x, w)| factor * w * x).collect(),
                None => column.iter().map(|x| factor * x).collect(),
            }
        };
        let stacked = |f: &dyn Fn(usize, f64) -> Vec<f64>| -> Vec<f64> {
            members.iter().flat_map(|&(m, sign)| f(m, sign)).collect()
        };
        let parameters = if kept.is_empty() {
            Vec::new()
        } else {
            let columns: Vec<Vec<f64>> =
                kept.iter().map(|&f| stacked(&|m, sign| scaled(&table.functions[f], m, sign))).collect();
            let values = stacked(&|m, _| scaled(&table.coefficients[m], m, 1.0));
            let basis = Basis::new(&columns);
            let along = if kept.len() > LARGE {
                basis.directions.iter().map(|e| dot(e, &values) / values.len() as f64).collect()
            } else {
                fit(&basis, &values, &spanning_points(&basis)).parameters
            };
            basis.over_columns(&along)
        };
        Self::with(table, members, kept, parameters)
    }

    /// The form with given parameters.
    pub fn with(table: &Table, members: Vec<(usize, f64)>, kept: Vec<usize>, parameters: Vec<f64>) -> Self {
        let mut burden = 0.0;
        let residuals = members
            .iter()
            .map(|&(m, sign)| {
                let mut left = table.coefficients[m].clone();
                for (&f, k) in kept.iter().zip(&parameters) {
                    for (r, psi) in left.iter_mut().zip(&table.functions[f]) {
                        *r -= sign * k * psi;
                    }
                }
                let (mut largest, mut sum) = (0.0_f64, 0.0);
                for r in &left {
                    largest = largest.max(r.abs());
                    sum += r.abs();
                }
                let share: f64 = table.shares[m].iter().map(|s| s.1).sum();
                burden += 0.5 * share * (largest + sum / left.len().max(1) as f64);
                left
            })
            .collect();
        Self { members, kept, parameters, residuals, burden }
    }
}
