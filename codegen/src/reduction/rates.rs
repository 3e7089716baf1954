//! What multiplies the coefficients in the rows of the torque.

use std::collections::{BTreeMap, BTreeSet};

use crate::lagrangian::{Entry, Lagrangian, MAX_JOINTS};

/// What multiplies a coefficient in a row of the torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rate {
    /// 1, for gravity.
    One,
    /// a_r,j.
    Acceleration(usize),
    /// v_jk = q̇_j v_r,k + q̇_k v_r,j with j < k, or q̇_j v_r,j.
    Velocities(usize, usize),
}

/// A rate and its sign.
pub type Term = (Rate, i8);

/// A sum of rates whose first term is positive, and the sign that this cost.
pub type Turned = (Vec<Term>, i8);

/// Columns of a symmetric matrix of signs, each with the k and s_k where it stands.
pub type Columns = BTreeMap<[i8; MAX_JOINTS], Vec<(usize, i8)>>;

impl Rate {
    /// Operations that it takes.
    pub fn cost(self) -> usize {
        match self {
            Rate::One | Rate::Acceleration(_) => 0,
            Rate::Velocities(j, k) => 1 + 2 * usize::from(j != k),
        }
    }
}

/// The rates of coefficient `m` by row.
pub fn rates(lagrangian: &Lagrangian, m: usize) -> Vec<Vec<Term>> {
    let mut rows = vec![Vec::new(); lagrangian.dof];
    for place in &lagrangian.coefficients[m].places {
        let sign = if place.sign < 0.0 { -1 } else { 1 };
        match place.entry {
            Entry::D(i, j) => {
                rows[i].push((Rate::Acceleration(j), sign));
                if i != j {
                    rows[j].push((Rate::Acceleration(i), sign));
                }
            }
            Entry::H(i, j, k) => rows[i].push((Rate::Velocities(j, k), sign)),
            Entry::G(i) => rows[i].push((Rate::One, sign)),
        }
    }
    rows
}

/// The sum of the rates of several coefficients in one row, its first term positive, and the sign that this cost.
pub fn summed(mut terms: Vec<Term>) -> Turned {
    terms.sort_unstable();
    let first = terms.first().map_or(1, |term| term.1);
    terms.iter_mut().for_each(|term| term.1 *= first);
    (terms, first)
}

/// A sum of velocity products as Σ (Σ_j c_j q̇_j)(Σ_k s_k v_r,k): equal columns c of its symmetric matrix taken
/// together, each with its k and s_k; `None` where the sum holds other rates.
pub fn columns(sum: &[Term]) -> Option<Columns> {
    let mut matrix = [[0_i8; MAX_JOINTS]; MAX_JOINTS];
    for &(rate, sign) in sum {
        let Rate::Velocities(j, k) = rate else { return None };
        matrix[j][k] = sign;
        matrix[k][j] = sign;
    }
    let mut out = Columns::new();
    for (k, column) in matrix.into_iter().enumerate() {
        let Some(&first) = column.iter().find(|&&x| x != 0) else { continue };
        out.entry(column.map(|x| x * first)).or_default().push((k, first));
    }
    Some(out)
}

/// Operations of all sums together, given the rates that are needed alone, and the sums that are cheaper by columns.
pub fn grouped(sums: &BTreeSet<Vec<Term>>, mut single: BTreeSet<Rate>) -> (usize, BTreeSet<Vec<Term>>) {
    let mut cost = single.iter().map(|rate| rate.cost()).sum();
    let mut out = BTreeSet::new();
    for sum in sums {
        let missing: usize =
            sum.iter().filter(|term| !single.contains(&term.0)).map(|term| term.0.cost()).sum();
        let apart = sum.len() - 1 + missing;
        let together = columns(sum).map(|columns| {
            let one = |(column, ends): (&[i8; MAX_JOINTS], &Vec<(usize, i8)>)| {
                column.iter().filter(|&&x| x != 0).count() - 1 + ends.len()
            };
            columns.iter().map(one).sum::<usize>() + columns.len() - 1
        });
        match together {
            Some(together) if together < apart => {
                cost += together;
                out.insert(sum.clone());
            }
            _ => {
                cost += apart;
                single.extend(sum.iter().map(|term| term.0));
            }
        }
    }
    (cost, out)
}
