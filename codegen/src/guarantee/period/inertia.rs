//! What the change of D over the errors makes of what pushes.

use super::super::numbers::{ROUNDED, UP, norm};
use super::Stop;
use super::load::{Load, Within};
use super::moved::of_numbers;
use super::sample::Sample;
use crate::numerics::linalg::weighed;

/// D may differ from that at the start by less than this, relative.
const MOST: f64 = 0.98;

impl Sample<'_> {
    /// Bound on |y|, D⁻¹w = W Wᵀ w − W y, by eigenvector of D at the start.
    pub(super) fn turned(
        &self,
        within: &Within,
        load: &Load,
        by_slopes: &[f64],
        by_numbers: &[Vec<f64>],
    ) -> Result<Vec<f64>, Stop> {
        let Self { problem, local, n, .. } = *self;
        let Within { away, lambda_q: lambda, .. } = within;
        let (mut lengths, mut beyond_slopes) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for i in 0..n {
            let slopes: f64 = (0..n).map(|k| away[k] * local.slope_lengths[k][i]).sum();
            let bends =
                local.bends.iter().map(|bend| away[bend.pair.0] * away[bend.pair.1] * bend.lengths[i]);
            let third = lambda * lambda * lambda * local.rest_lengths[i];
            let bent = bends.sum::<f64>() + third + local.rounding_lengths[i];
            let added: f64 = problem
                .numbers
                .iter()
                .zip(&local.added)
                .map(|(number, added)| {
                    number.most() * (added.lengths[i] + added.changed_length(&local.w, i, away, *lambda))
                })
                .sum();
            beyond_slopes.push(bent + local.unit_lengths[i] + added);
            lengths.push(slopes + beyond_slopes[i]);
        }
        let r = norm(&lengths);
        if r.is_nan() || r >= MOST {
            return Err(Stop::Inertia);
        }
        let column = |i: usize| -> Vec<f64> { (0..n).map(|k| local.w[k][i]).collect() };
        let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let others: Vec<f64> = columns.iter().map(|column| weighed(column, &load.others)).collect();
        let others = norm(&others);
        let numbers = (0..n).map(|i| of_numbers(problem, local, i));
        let asked: Vec<f64> =
            self.control.iter().zip(numbers).map(|(row, number)| weighed(row, &self.x) + number).collect();
        let asked = norm(&columns.iter().map(|column| weighed(column, &asked)).collect::<Vec<f64>>());
        let lag = self.lagging(&columns, &load.lag, away, &beyond_slopes);
        let beyond: Vec<f64> = (0..n).map(|i| self.beyond(i, away, *lambda)).collect();
        let first = |i: usize| {
            let slopes: f64 = (0..n).map(|k| away[k] * by_slopes[k * n + i]).sum();
            let numbers = problem.numbers.iter().zip(by_numbers);
            let added: f64 = numbers.map(|(number, sizes)| number.most() * sizes[i]).sum();
            let bends = local.bends.iter().map(|bend| {
                let turned = &bend.turned[i * n..(i + 1) * n];
                away[bend.pair.0] * away[bend.pair.1] * weighed(turned, &self.pushed_size)
            });
            let unit = (local.unit_lengths[i] + ROUNDED) * asked;
            slopes
                + bends.sum::<f64>()
                + added
                + weighed(&columns[i], &beyond)
                + unit
                + lag[i]
                + lengths[i] * others
        };
        let first: Vec<f64> = (0..n).map(first).collect();
        let whole = norm(&first) / (1.0 - r);
        Ok(first.iter().zip(&lengths).map(|(first, length)| UP * (first + length * whole)).collect())
    }

    /// Bound on Wᵀ ΔD D⁻¹ of what the held torque lags behind, by eigenvector: D⁻¹ of the whole vector is small where that of its parts
    /// is not.
    fn lagging(&self, columns: &[Vec<f64>], lag: &[f64], away: &[f64], beyond_slopes: &[f64]) -> Vec<f64> {
        let Self { local, n, .. } = *self;
        let along = |row: &[f64], x: &[f64]| -> f64 { row.iter().zip(x).map(|(a, x)| a * x).sum() };
        let moved: Vec<f64> = local.inverse.iter().map(|row| along(row, lag)).collect();
        let sizes: Vec<f64> = lag.iter().map(|x| x.abs()).collect();
        let size: Vec<f64> = local.inverse_size.iter().map(|row| weighed(row, &sizes)).collect();
        let length = norm(&columns.iter().map(|column| along(column, lag)).collect::<Vec<f64>>());
        let row = |i: usize| {
            let slope = |k: usize| {
                let slopes = &local.slopes[(k * n + i) * n..(k * n + i + 1) * n];
                away[k] * (along(slopes, &moved).abs() + ROUNDED * weighed(slopes, &size))
            };
            (0..n).map(slope).sum::<f64>() + (beyond_slopes[i] + ROUNDED) * length
        };
        (0..n).map(row).collect()
    }

    /// Bound on what D D⁻¹u changes by beyond what is linear in the displacement of q, by joint.
    fn beyond(&self, i: usize, away: &[f64], lambda: f64) -> f64 {
        let Self { problem, local, n, .. } = *self;
        let row = |j: usize| {
            let own = local.arm.mass_matrix.beyond(i * n + j, lambda);
            let added = problem.numbers.iter().zip(&local.added).map(|(number, added)| {
                number.most() * added.enclosure.mass_matrix.change(i * n + j, away, lambda)
            });
            (own + added.sum::<f64>()) * self.pushed_size[j]
        };
        (0..n).map(row).sum()
    }
}
