//! What the change of D over the errors makes of what pushes.

use super::super::local::{Local, Turned};
use super::super::numbers::{ROUNDED, UP, norm, times};
use super::super::problem::Problem;
use super::Stop;
use super::load::{Load, Within};
use super::sample::Sample;
use crate::numerics::linalg::weighed;

/// D may differ from that at the start by less than this, relative.
const MOST: f64 = 0.98;

/// Bounds on E = Wᵀ D W − 1 and its parts, during the period.
struct Change {
    /// On the entries of what is linear, by rows, and the same times Wᵀ.
    entries: Vec<f64>,
    pulls: Vec<f64>,
    /// On the lengths of the rows of what is not linear, and of all.
    beyond: Vec<f64>,
    lengths: Vec<f64>,
    /// On ‖E‖.
    norm: f64,
}

impl Sample<'_> {
    /// Bound on |y| less what is known of it, D⁻¹w = W Wᵀ w − W y, by eigenvector of D at the start.
    pub(super) fn turned(
        &self,
        within: &Within,
        load: &Load,
        by_slopes: &[Vec<f64>],
    ) -> Result<Vec<f64>, Stop> {
        let Self { problem, local, n, .. } = *self;
        let Within { away, strayed, lambda_q: lambda, .. } = within;
        let change = self.changed(away, *lambda)?;
        let numbers = |i: usize| of_numbers(problem, local, i);
        let asked: Vec<f64> = (0..n).map(|i| weighed(&self.control[i], &self.x) + numbers(i)).collect();
        let columns: Vec<Vec<f64>> = (0..n).map(|i| local.w.iter().map(|row| row[i]).collect()).collect();
        let seen = |torque: &[f64]| {
            norm(&columns.iter().map(|column| weighed(column, torque)).collect::<Vec<f64>>())
        };
        let (asked, others) = (seen(&asked), seen(&load.others));
        let lag = self.lagging(&columns, &load.lag, strayed, &change.beyond);
        let beyond: Vec<f64> = (0..n).map(|i| self.beyond(i, away, *lambda)).collect();
        let first = |i: usize| {
            let slopes: f64 = strayed.iter().zip(by_slopes).map(|(x, sizes)| x * sizes[i]).sum();
            let added = self.family.turned[i].rest;
            let bends = local.bends.iter().map(|bend| {
                let turned = &bend.inertia.left[i * n..(i + 1) * n];
                away[bend.pair.0] * away[bend.pair.1] * weighed(turned, &self.pushed_size)
            });
            let unit = (local.unit_lengths[i] + ROUNDED) * asked;
            let pushed = slopes + bends.sum::<f64>() + added + weighed(&columns[i], &beyond) + unit;
            let row = i * n..(i + 1) * n;
            let others = weighed(&change.pulls[row], &load.others) + change.beyond[i] * others;
            pushed + lag[i] + others
        };
        let first: Vec<f64> = (0..n).map(first).collect();
        let whole: Vec<f64> = (0..n).map(|i| first[i] + self.known_turned(i)).collect();
        // (1 + E)⁻¹z = z − E z + E E (1 + E)⁻¹z.
        let length = norm(&whole);
        let again = |i: usize| {
            let row = i * n..(i + 1) * n;
            let once = weighed(&change.entries[row], &whole) + change.beyond[i] * length;
            once + change.lengths[i] * change.norm * length / (1.0 - change.norm)
        };
        Ok((0..n).map(|i| UP * (first[i] + again(i))).collect())
    }

    /// Bound on what is known of y.
    pub(super) fn known_turned(&self, i: usize) -> f64 {
        let t = self.problem.period;
        t * self.turning[i] + t * t * self.trend.lag[i].abs() + self.family.turned[i].size()
    }

    /// Bounds on E for displacements of q up to `away`.
    fn changed(&self, away: &[f64], lambda: f64) -> Result<Change, Stop> {
        let Self { problem, local, n, .. } = *self;
        let mut out = Change {
            entries: vec![0.0; n * n],
            pulls: vec![0.0; n * n],
            beyond: Vec::with_capacity(n),
            lengths: Vec::with_capacity(n),
            norm: 0.0,
        };
        let slopes = away.iter().copied().zip(&local.slopes);
        let numbers = problem.numbers.iter().zip(&local.added);
        let parts = slopes.chain(numbers.map(|(number, added)| (number.most(), &added.inertia)));
        let mut lengths = vec![0.0; n];
        for (size, part) in parts {
            let add =
                |out: &mut [f64], x: &[f64]| out.iter_mut().zip(x).for_each(|(out, x)| *out += size * x);
            add(&mut out.entries, &part.entries);
            add(&mut out.pulls, &part.pulls);
            add(&mut lengths, &part.lengths);
        }
        for (i, length) in lengths.into_iter().enumerate() {
            let bends = local
                .bends
                .iter()
                .map(|bend| away[bend.pair.0] * away[bend.pair.1] * bend.inertia.lengths[i]);
            let third = lambda * lambda * lambda * local.rest_lengths[i];
            let bent = bends.sum::<f64>() + third + local.rounding_lengths[i];
            let added: f64 = problem
                .numbers
                .iter()
                .zip(&local.added)
                .map(|(number, added)| number.most() * added.changed_length(&local.w, i, away, lambda))
                .sum();
            let beyond = bent + local.unit_lengths[i] + added;
            out.beyond.push(beyond);
            out.lengths.push(length + beyond);
        }
        out.norm = norm(&out.lengths);
        if out.norm.is_nan() || out.norm >= MOST { Err(Stop::Inertia) } else { Ok(out) }
    }

    /// Bound on Wᵀ ΔD D⁻¹ of what the held torque lags behind less what is known of it, by eigenvector: D⁻¹ of the whole vector is small
    /// where that of its parts is not.
    fn lagging(&self, columns: &[Vec<f64>], lag: &[f64], strayed: &[f64], beyond: &[f64]) -> Vec<f64> {
        let Self { problem, local, n, .. } = *self;
        let along = |row: &[f64], x: &[f64]| -> f64 { row.iter().zip(x).map(|(a, x)| a * x).sum() };
        let moved = times(&local.inverse, lag);
        let sizes: Vec<f64> = lag.iter().map(|x| x.abs()).collect();
        let size: Vec<f64> = local.inverse_size.iter().map(|row| weighed(row, &sizes)).collect();
        let length = norm(&columns.iter().map(|column| along(column, lag)).collect::<Vec<f64>>());
        let row = |i: usize| {
            let slope = |(x, slope): (&f64, &Turned)| {
                let left = &slope.left[i * n..(i + 1) * n];
                x * (along(left, &moved).abs() + ROUNDED * weighed(left, &size))
            };
            let numbers = problem.numbers.iter().zip(&local.added);
            let added: f64 = numbers.map(|(number, added)| slope((&number.most(), &added.inertia))).sum();
            strayed.iter().zip(&local.slopes).map(slope).sum::<f64>() + added + (beyond[i] + ROUNDED) * length
        };
        (0..n).map(row).collect()
    }

    /// Bound on what D D⁻¹u changes by beyond what is linear in the displacement of q, by joint.
    fn beyond(&self, i: usize, away: &[f64], lambda: f64) -> f64 {
        let Self { problem, local, n, .. } = *self;
        let row = |j: usize| {
            let own = local.mass_matrix.beyond(i * n + j, lambda);
            let added = problem
                .numbers
                .iter()
                .zip(&local.added)
                .map(|(number, added)| number.most() * added.mass_matrix.change(i * n + j, away, lambda));
            (own + added.sum::<f64>()) * self.pushed_size[j]
        };
        (0..n).map(row).sum()
    }
}

/// What the uncertain numbers may do to the torque of joint `i` on the desired motion at most.
fn of_numbers(problem: &Problem, local: &Local, i: usize) -> f64 {
    let each = problem.numbers.iter().zip(&local.added);
    each.map(|(number, added)| number.most() * added.enclosure.torque.centre[i].abs()).sum()
}
