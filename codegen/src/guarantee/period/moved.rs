//! The set at the end of a period.

use super::super::numbers::{ROUNDED, UP, ends, middle, product, times};
use super::super::problem::Problem;
use super::super::set::{ErrorSet, Known};
use super::family::Family;
use super::load::Load;
use super::sample::Sample;
use super::trend::rounded;
use crate::numerics::linalg::weighed;

impl Sample<'_> {
    /// The set becomes that at the end of the period.
    pub(super) fn moved(&self, set: &mut ErrorSet, load: &Load, turned: &[f64]) {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let half_square = 0.5 * t * t;
        let pushed = product(&local.inverse, &self.control);
        let mut map = vec![vec![0.0; 2 * n]; 2 * n];
        let mut rounded = vec![0.0; 2 * n];
        for i in 0..n {
            for k in 0..2 * n {
                let slowed = if k >= n { problem.gains.p12[i][k - n] } else { 0.0 };
                let (push, turning) = (pushed[i][k] - slowed, t * self.trend.acceleration[i][k]);
                map[i][k] = half_square * (push - turning / 3.0)
                    + if i == k { 1.0 } else { 0.0 }
                    + if k == n + i { t } else { 0.0 };
                map[n + i][k] = t * (push - 0.5 * turning) + if k == n + i { 1.0 } else { 0.0 };
            }
            let size = self.rounded(i) + t * self.trend.rounded[i];
            rounded[i] = half_square * size;
            rounded[n + i] = t * size;
        }
        set.mapped(&map);
        set.boxed.iter_mut().zip(&rounded).for_each(|(boxed, more)| *boxed += more);
        self.known(set, load);
        self.shared(set);
        self.generators(set, load, turned);
    }

    /// What is known of the period whatever the errors are moves the centre.
    fn known(&self, set: &mut ErrorSet, load: &Load) {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let half_square = 0.5 * t * t;
        // Where the rate of the lag changes evenly, its mean is off half of that at the end by a sixth of what the rate adds.
        let middles: Vec<f64> = (0..n).map(|i| load.middle[i] - t / 6.0 * local.lag.turn[i]).collect();
        let lags: Vec<f64> = local.lag.end.iter().map(|x| middle(*x)).collect();
        let [constant, lag, bent] = [&middles, &lags, &self.trend.bent].map(|x| times(&local.inverse, x));
        let turned = times(&local.w, &self.trend.lag);
        let size = |i: usize| middles[i].abs() + lags[i].abs() + t * t * self.trend.bent[i].abs();
        let sizes: Vec<f64> = (0..n).map(size).collect();
        for i in 0..n {
            let [speed, position] = [0, 1].map(|k| local.course.drift[k][i]);
            let bent = t * t * (bent[i] + turned[i]);
            set.centre[i] += half_square * (constant[i] + lag[i] / 3.0 - bent / 6.0) + middle(position);
            set.centre[n + i] += t * (constant[i] + 0.5 * lag[i] - bent / 3.0) + middle(speed);
            let size = ROUNDED * (weighed(&local.inverse_size[i], &sizes) + bent.abs());
            set.boxed[i] += ends(position) + half_square * size;
            set.boxed[n + i] += ends(speed) + t * size;
        }
    }

    /// The means of q̈_e that count for position and for speed, where `pushed` is held from the start on.
    fn pushed_by(&self, pushed: &[f64]) -> [Vec<f64>; 2] {
        let Self { problem, local, n, .. } = *self;
        let turned: Vec<Vec<f64>> = self.trend.inertia.chunks(n).map(<[f64]>::to_vec).collect();
        let turned = times(&local.w, &times(&turned, pushed));
        let slowed = times(&local.inverse, &times(&self.trend.along, pushed));
        [3.0, 2.0].map(|part| {
            let mean = |i: usize| pushed[i] - problem.period / part * (turned[i] + slowed[i]);
            (0..n).map(mean).collect()
        })
    }

    /// What the uncertain numbers do, the same ones at every sample.
    fn shared(&self, set: &mut ErrorSet) {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        for (m, (number, moved)) in problem.numbers.iter().zip(&self.family.moved).enumerate() {
            let torque = &local.added[m].enclosure.torque.centre;
            let sizes: Vec<f64> = torque.iter().map(|x| number.most() * x.abs()).collect();
            let sizes: Vec<f64> = local.inverse_size.iter().map(|row| weighed(row, &sizes)).collect();
            let rounded = rounded(problem, local, &sizes, &vec![0.0; 2 * n]);
            let rounded: Vec<f64> = (0..n).map(|i| ROUNDED * sizes[i] + t * rounded[i]).collect();
            for (factor, at) in [(number.middle, 0), (number.half, m + 1)] {
                let pushed: Vec<f64> = moved.iter().map(|x| -factor * x).collect();
                self.pushes(set, at, &self.pushed_by(&pushed), &rounded);
            }
        }
        let Family { torque, turned, .. } = &self.family;
        for at in 0..=set.shared.len() {
            let part =
                |known: &[Known]| -> Vec<f64> { known.iter().map(|known| known.weights[at]).collect() };
            let (torque, turned) = (part(torque), part(turned));
            let size = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| x.abs()).collect() };
            let (torques, turns) = (size(&torque), size(&turned));
            let rounded = |i: usize| {
                ROUNDED * (weighed(&local.inverse_size[i], &torques) + weighed(&local.w[i], &turns))
            };
            let rounded: Vec<f64> = (0..n).map(rounded).collect();
            let (pushed, turned) = (times(&local.inverse, &torque), times(&local.w, &turned));
            let mean: Vec<f64> = pushed.iter().zip(turned).map(|(push, turned)| push - turned).collect();
            self.pushes(set, at, &[mean.clone(), mean], &rounded);
        }
    }

    /// Moves the centre, for 0, or a shared generator by a period of these mean accelerations for position and speed.
    fn pushes(&self, set: &mut ErrorSet, at: usize, mean: &[Vec<f64>; 2], rounded: &[f64]) {
        let (n, t) = (self.n, self.problem.period);
        let out = at.checked_sub(1).map_or(&mut set.centre, |m| &mut set.shared[m]);
        for i in 0..n {
            for (k, factor) in [(0, 0.5 * t * t), (1, t)] {
                out[k * n + i] += factor * mean[k][i];
                set.boxed[k * n + i] += factor * rounded[i];
            }
        }
    }

    /// What is not in the centre becomes new generators.
    fn generators(&self, set: &mut ErrorSet, load: &Load, turned: &[f64]) {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let mut add = |direction: &dyn Fn(usize) -> f64, size: f64| {
            if size > 0.0 {
                let part = |i: usize| if i < n { 0.5 * t * t * direction(i) } else { t * direction(i - n) };
                set.add((0..2 * n).map(|i| size * part(i)));
            }
        };
        for j in 0..n {
            add(&|i| local.inverse[i][j], load.mean[j]);
            add(&|i| local.w[i][j], turned[j]);
        }
        // The mean of what changes within the period and the mean that counts for the position differ.
        for i in 0..n {
            let uneven = weighed(&local.inverse[i], &load.changing) + weighed(&local.w[i], turned);
            set.add_axis(i, UP * 0.25 * t * t * uneven);
        }
    }
}

/// The linear map of the errors over a period with q̈_e held at `pushed` x − P12 v.
pub(super) fn held(problem: &Problem, pushed: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (n, t) = (pushed.len(), problem.period);
    let mut map = vec![vec![0.0; 2 * n]; 2 * n];
    for i in 0..n {
        for k in 0..2 * n {
            let slowed = if k >= n { problem.gains.p12[i][k - n] } else { 0.0 };
            let push = pushed[i][k] - slowed;
            map[i][k] = 0.5 * t * t * push;
            map[n + i][k] = t * push;
        }
        map[i][i] += 1.0;
        map[i][n + i] += t;
        map[n + i][n + i] += 1.0;
    }
    map
}
