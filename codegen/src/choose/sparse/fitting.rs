//! One form for a group of coefficients, fitted to points of the domain.

use super::SparseProblem;
use crate::numerics::basis::Basis;
use crate::numerics::chebyshev::{fit_below, spanning_points};
use crate::numerics::vector::dot;

/// Forms with more functions than this are fitted by least squares: there the search throws out what hardly matters.
pub(super) const LARGE: usize = 6;

/// Residuals in units of the room for them that no parameters bring below this are above the room for all rounding.
const HOPELESS: f64 = 1.0 + 1e-6;

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
    /// For each member the point where that is most.
    pub worst: Vec<usize>,
    /// Its part of the torque errors, relative to the joints' torques, summed over joints: mean of the largest and the
    /// mean over the points.
    pub burden: f64,
}

impl Form {
    /// Where nothing is left of a group.
    pub fn nothing() -> Self {
        Self {
            members: Vec::new(),
            kept: Vec::new(),
            parameters: Vec::new(),
            residuals: Vec::new(),
            worst: Vec::new(),
            burden: 0.0,
        }
    }

    /// The parameters that minimise the largest residual, weighed by the members' weights or, for a single member, by
    /// `room`⁻¹.
    pub fn fitted(
        table: &Table,
        members: Vec<(usize, f64)>,
        kept: Vec<usize>,
        inverse_room: Option<&[f64]>,
    ) -> Self {
        let parameters = parameters(table, &members, &kept, inverse_room, f64::INFINITY).unwrap_or_default();
        Self::with(table, members, kept, parameters)
    }

    /// The same of a single member with no residual above the room that `inverse_room` is of; `None` where no parameters
    /// do that.
    pub fn within(
        table: &Table,
        members: Vec<(usize, f64)>,
        kept: Vec<usize>,
        inverse_room: &[f64],
    ) -> Option<Self> {
        let parameters = parameters(table, &members, &kept, Some(inverse_room), HOPELESS)?;
        Some(Self::with(table, members, kept, parameters))
    }

    /// The form with given parameters.
    pub fn with(table: &Table, members: Vec<(usize, f64)>, kept: Vec<usize>, parameters: Vec<f64>) -> Self {
        let mut burden = 0.0;
        let mut worst = Vec::with_capacity(members.len());
        let residuals = members
            .iter()
            .map(|&(m, sign)| {
                let mut left = table.coefficients[m].clone();
                for (&f, k) in kept.iter().zip(&parameters) {
                    for (r, psi) in left.iter_mut().zip(&table.functions[f]) {
                        *r -= sign * k * psi;
                    }
                }
                let (mut largest, mut at, mut sum) = (0.0_f64, 0, 0.0);
                for (point, r) in left.iter().enumerate() {
                    if r.abs() > largest {
                        (largest, at) = (r.abs(), point);
                    }
                    sum += r.abs();
                }
                worst.push(at);
                let share: f64 = table.shares[m].iter().map(|s| s.1).sum();
                burden += 0.5 * share * (largest + sum / left.len().max(1) as f64);
                left
            })
            .collect();
        Self { members, kept, parameters, residuals, worst, burden }
    }
}

/// The parameters of [`Form::fitted`]; `None` where every choice leaves a residual above `most`.
fn parameters(
    table: &Table,
    members: &[(usize, f64)],
    kept: &[usize],
    inverse_room: Option<&[f64]>,
    most: f64,
) -> Option<Vec<f64>> {
    if kept.is_empty() {
        return Some(Vec::new());
    }
    // A column for every member, one below the other.
    let stacked = |columns: &mut dyn Iterator<Item = (&[f64], f64, usize)>| -> Vec<f64> {
        let mut out = Vec::with_capacity(members.len() * table.points());
        for (column, sign, m) in columns {
            let factor = if members.len() == 1 { sign } else { sign * table.weights[m] };
            match inverse_room {
                Some(weights) => out.extend(column.iter().zip(weights).map(|(x, w)| factor * w * x)),
                None => out.extend(column.iter().map(|x| factor * x)),
            }
        }
        out
    };
    let function =
        |&f: &usize| stacked(&mut members.iter().map(|&(m, sign)| (table.functions[f].as_slice(), sign, m)));
    let columns = kept.iter().map(function).collect();
    let values = stacked(&mut members.iter().map(|&(m, _)| (table.coefficients[m].as_slice(), 1.0, m)));
    let basis = Basis::of(columns);
    let along = if kept.len() > LARGE {
        basis.directions.iter().map(|e| dot(e, &values) / values.len() as f64).collect()
    } else {
        let fit = fit_below(&basis, &values, &spanning_points(&basis), most);
        if fit.level > most {
            return None;
        }
        fit.parameters
    };
    Some(basis.over_columns(&along))
}
