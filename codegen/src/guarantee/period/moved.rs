//! The set at the end of a period.

use super::super::local::Local;
use super::super::numbers::{ROUNDED, UP, ends, middle, product};
use super::super::problem::Problem;
use super::super::set::ErrorSet;
use super::load::Load;
use super::sample::Sample;
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
                let push = pushed[i][k] - slowed;
                map[i][k] =
                    half_square * push + if i == k { 1.0 } else { 0.0 } + if k == n + i { t } else { 0.0 };
                map[n + i][k] = t * push + if k == n + i { 1.0 } else { 0.0 };
            }
            let size = self.rounded(i);
            rounded[i] = half_square * size;
            rounded[n + i] = t * size;
        }
        set.mapped(&map);
        set.boxed.iter_mut().zip(&rounded).for_each(|(boxed, more)| *boxed += more);
        let along = |torque: &[f64]| -> Vec<f64> {
            (0..n).map(|i| local.inverse[i].iter().zip(torque).map(|(m, x)| m * x).sum()).collect()
        };
        // Where the rate of the lag changes evenly, its mean is off half of that at the end by a sixth of what the rate adds.
        let middles: Vec<f64> = (0..n)
            .map(|i| load.middle[i] + middle_of_numbers(problem, local, i) - t / 6.0 * local.lag.turn[i])
            .collect();
        let (constant, lag) = (along(&middles), local.lag.end.iter().map(|x| 0.5 * (x.low + x.high)));
        let lag = along(&lag.collect::<Vec<f64>>());
        for i in 0..n {
            let [speed, position] = [0, 1].map(|k| local.course.drift[k][i]);
            set.centre[i] += half_square * constant[i] + t * t / 6.0 * lag[i] + middle(position);
            set.centre[n + i] += t * constant[i] + 0.5 * t * lag[i] + middle(speed);
            set.boxed[i] += ends(position) + ROUNDED * half_square * (constant[i].abs() + lag[i].abs());
            set.boxed[n + i] += ends(speed) + ROUNDED * t * (constant[i].abs() + lag[i].abs());
        }
        self.shared(set);
        self.generators(set, load, turned);
    }

    /// What the uncertain numbers do to the desired motion, the same ones at every sample.
    fn shared(&self, set: &mut ErrorSet) {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let mut torques: Vec<Vec<f64>> = Vec::new();
        for (number, added) in problem.numbers.iter().zip(&local.added) {
            torques.push(added.enclosure.torque.centre.iter().map(|x| -number.half * x).collect());
        }
        for (shared, torque) in set.shared.iter_mut().zip(&torques) {
            for i in 0..n {
                let push: f64 = local.inverse[i].iter().zip(torque).map(|(m, x)| m * x).sum();
                shared[i] += 0.5 * t * t * push;
                shared[n + i] += t * push;
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

/// What the uncertain numbers may do to the torque of joint `i` on the desired motion at most.
pub(super) fn of_numbers(problem: &Problem, local: &Local, i: usize) -> f64 {
    let each = problem.numbers.iter().zip(&local.added);
    each.map(|(number, added)| number.most() * added.enclosure.torque.centre[i].abs()).sum()
}

/// The same at the middle of their intervals, with its sign.
fn middle_of_numbers(problem: &Problem, local: &Local, i: usize) -> f64 {
    let each = problem.numbers.iter().zip(&local.added);
    each.map(|(number, added)| -number.middle * added.enclosure.torque.centre[i]).sum()
}
