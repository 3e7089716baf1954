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
        let products = |a: &Vec<f64>| -> Vec<f64> {
            let weighed: Vec<f64> = a.iter().zip(weights.iter().cycle()).map(|(a, w)| w * a).collect();
            let (fours, rest) = effects.as_chunks::<4>();
            let fours = fours.iter().flat_map(|some| dots(&weighed, some.each_ref()));
            fours.chain(rest.iter().flat_map(|one| dots(&weighed, [one]))).collect()
        };
        let gram = effects.par_iter().map(products).collect();
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

    /// [`Table::error`] where it is no more than `most`, otherwise the first point of `order` where it is more.
    pub fn error_within(&self, theta: &[f64], order: &[usize], most: f64) -> Result<f64, usize> {
        let lost: Vec<(f64, &Vec<f64>)> = self
            .own
            .iter()
            .zip(theta)
            .zip(&self.effects)
            .map(|((own, value), effect)| (own - value, effect))
            .filter(|(lost, _)| *lost != 0.0)
            .collect();
        let mut row = vec![0.0; self.coefficients];
        let mut worst = 0.0;
        for &point in order {
            row.fill(0.0);
            let range = point * self.coefficients..(point + 1) * self.coefficients;
            for (lost, effect) in &lost {
                row.iter_mut().zip(&effect[range.clone()]).for_each(|(sum, a)| *sum += lost * a);
            }
            worst = self.shares.iter().fold(worst, |worst: f64, shares| worst.max(joint(&row, shares)));
            if worst > most {
                return Err(point);
            }
        }
        Ok(worst)
    }

    /// The largest error of any joint by point.
    pub fn error_by_point(&self, theta: &[f64]) -> Vec<f64> {
        let errors = self.errors_of(&self.residuals(theta));
        errors.chunks_exact(self.shares.len().max(1)).map(largest).collect()
    }

    /// Torque errors for given residuals, as fractions of the peaks; joint i at point k stands at k n + i.
    pub fn errors_of(&self, residuals: &[f64]) -> Vec<f64> {
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

/// Scalar products of one column with others, each summed in order: several sums do not wait for one another.
fn dots<const COUNT: usize>(a: &[f64], others: [&Vec<f64>; COUNT]) -> [f64; COUNT] {
    let mut sums = [0.0; COUNT];
    let others = others.map(|other| &other[..a.len()]);
    for (i, a) in a.iter().enumerate() {
        for (sum, other) in sums.iter_mut().zip(others) {
            *sum += a * other[i];
        }
    }
    sums
}

/// The torque error of one joint for the residuals at a point.
fn joint(point: &[f64], shares: &[(usize, f64)]) -> f64 {
    shares.iter().fold(0.0, |sum, &(m, share)| sum + share * point[m].abs())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalar_products_are_summed_in_order() {
        let column = |k: usize| (0..101).map(|i| libm::sin((i * (k + 2)) as f64)).collect::<Vec<f64>>();
        let columns: [Vec<f64>; 4] = [0, 1, 2, 3].map(column);
        let alone = |b: &Vec<f64>| columns[0].iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b);
        assert_eq!(dots(&columns[0], columns.each_ref()), columns.each_ref().map(alone));
    }

    #[test]
    fn an_error_is_the_same_in_any_order_of_the_points_and_none_above_the_most() {
        let at = |x: usize| libm::sin(1.7 * x as f64 + 0.3);
        let (points, coefficients, parameters) = (9, 5, 4);
        let column = |p: usize| (0..points * coefficients).map(|i| at(i + 100 * p)).collect::<Vec<f64>>();
        let table = Table {
            own: (0..parameters).map(|p| at(p + 7)).collect(),
            effects: (0..parameters).map(column).collect(),
            coefficients,
            shares: (0..3).map(|i| (i..coefficients).map(|m| (m, at(i + m).abs())).collect()).collect(),
            gram: Vec::new(),
            points,
            sizes: Vec::new(),
        };
        for shift in 0..6 {
            let mut theta: Vec<f64> = (0..parameters).map(|p| at(3 * p + shift)).collect();
            theta[shift % parameters] = table.own[shift % parameters];
            let error = table.error(&theta);
            let at = table.error_by_point(&theta);
            assert_eq!(largest(&at), error);
            let order: Vec<usize> = (0..points).map(|i| (i * 4 + shift) % points).collect();
            assert_eq!(table.error_within(&theta, &order, error), Ok(error));
            let below = error.next_down();
            let first = order.iter().copied().find(|&point| at[point] > below);
            assert_eq!(table.error_within(&theta, &order, below).err(), first);
            let half = order.iter().copied().find(|&point| at[point] > 0.5 * error);
            assert_eq!(table.error_within(&theta, &order, 0.5 * error).err(), half);
        }
    }
}
