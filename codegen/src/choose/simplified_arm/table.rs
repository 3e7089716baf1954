//! What every inertial parameter adds to every coefficient at points of the domain.

use super::ArmProblem;
use crate::arm::{Arm, Inertial};
use crate::dynamics::{gravity, mass_matrix, passivity_torque, positions};
use crate::lagrangian::{Entry, Lagrangian};
use crate::parallel::Parallelize;

/// Values at the points of a [`ArmProblem`].
pub(super) struct Table {
    /// The parameters' own values θ.
    pub own: Vec<f64>,
    /// ∂α_m/∂θ_p by parameter; coefficient m at point k stands at k r + m.
    pub effects: Vec<Vec<f64>>,
    /// Number of coefficients r.
    pub coefficients: usize,
    /// By joint the coefficients that enter its torque, with the most that multiplies them over its peak torque.
    pub shares: Vec<Vec<(usize, f64)>>,
    /// Scalar products of the effects, each coefficient weighed by its shares.
    pub gram: Vec<Vec<f64>>,
    /// Number of points.
    pub points: usize,
    /// The largest error that a change by 1 makes, by parameter.
    pub sizes: Vec<f64>,
}

impl Table {
    /// For the parameters of the regrouped arm.
    pub fn new(problem: &ArmProblem, arm: &Arm, parameters: &[Inertial]) -> Self {
        let lagrangian = problem.lagrangian;
        let coefficients = lagrangian.coefficients.len();
        let alone = |p: &Inertial| {
            let mut alone = arm.without_inertia();
            alone.set_inertial(*p, 1.0);
            problem.points.iter().flat_map(|q| values(&alone, lagrangian, q)).collect()
        };
        let effects: Vec<Vec<f64>> = parameters.par_iter().map(alone).collect();
        let shares: Vec<Vec<(usize, f64)>> = problem
            .shares
            .iter()
            .map(|row| row.iter().copied().enumerate().filter(|share| share.1 > 0.0).collect())
            .collect();
        let mut weights = vec![0.0; coefficients];
        for &(m, share) in shares.iter().flatten() {
            weights[m] += share * share;
        }
        let product = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).zip(weights.iter().cycle()).fold(0.0, |sum, ((a, b), w)| sum + w * a * b)
        };
        let gram = effects.par_iter().map(|a| effects.iter().map(|b| product(a, b)).collect()).collect();
        let own = parameters.iter().map(|&p| arm.inertial(p)).collect();
        let points = problem.points.len();
        let mut table = Self { own, effects, coefficients, shares, gram, points, sizes: Vec::new() };
        table.sizes = table.effects.par_iter().map(|effect| largest(&table.errors_of(effect))).collect();
        table
    }

    /// What all coefficients at all points lack with other values of the parameters.
    pub fn residuals(&self, theta: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.effects.first().map_or(0, Vec::len)];
        for ((effect, own), value) in self.effects.iter().zip(&self.own).zip(theta) {
            let lost = own - value;
            if lost != 0.0 {
                out.iter_mut().zip(effect).for_each(|(sum, a)| *sum += lost * a);
            }
        }
        out
    }

    /// Torque errors for given residuals, as fractions of the peaks; joint i at point k stands at k n + i.
    pub fn errors_of(&self, residuals: &[f64]) -> Vec<f64> {
        let joint = |point: &[f64], shares: &Vec<(usize, f64)>| {
            shares.iter().fold(0.0, |sum, &(m, share)| sum + share * point[m].abs())
        };
        residuals
            .chunks_exact(self.coefficients.max(1))
            .flat_map(|point| self.shares.iter().map(move |shares| joint(point, shares)))
            .collect()
    }

    /// Root of the squares, over joints and points, by which two choices of values differ.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        let row = |g: &Vec<f64>| g.iter().zip(&off).fold(0.0, |sum, (g, o)| sum + g * o);
        let square = self.gram.iter().zip(&off).fold(0.0, |sum, (g, o)| sum + o * row(g));
        libm::sqrt(square.max(0.0))
    }

    /// As [`Table::error`], each coefficient at its own worst point.
    pub fn separate(&self, theta: &[f64]) -> f64 {
        let mut worst = vec![0.0; self.coefficients];
        for point in self.residuals(theta).chunks_exact(self.coefficients.max(1)) {
            worst.iter_mut().zip(point).for_each(|(worst, r): (&mut f64, &f64)| *worst = worst.max(r.abs()));
        }
        largest(&self.errors_of(&worst))
    }

    /// The largest torque error with other values of the parameters.
    pub fn error(&self, theta: &[f64]) -> f64 {
        largest(&self.errors_of(&self.residuals(theta)))
    }
}

/// The largest of numbers that are not negative.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, &x| most.max(x))
}

/// The coefficients of `arm` at `q`, by the entry where each stands first.
fn values(arm: &Arm, lagrangian: &Lagrangian, q: &[f64]) -> Vec<f64> {
    let n = arm.dof();
    let at = positions(arm, q);
    let rest = vec![0.0; n];
    let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
    let weightless = [0.0; 3];
    let (d, g) = (mass_matrix(arm, q), gravity(arm, q));
    let h: Vec<Vec<Vec<f64>>> = (0..n)
        .map(|j| (0..=j).map(|k| passivity_torque(arm, weightless, &at, &unit(j), &unit(k), &rest)).collect())
        .collect();
    let value = |coefficient: &crate::lagrangian::Coefficient| {
        coefficient.places.first().map_or(0.0, |place| {
            place.sign
                * match place.entry {
                    Entry::D(i, j) => d[i][j],
                    Entry::H(i, j, k) => h[j.max(k)][j.min(k)][i],
                    Entry::G(i) => g[i],
                }
        })
    };
    lagrangian.coefficients.iter().map(value).collect()
}
