//! One period of the sampled loop: the set of errors at its end from that at its start.
//!
//! With x = (q_e, v) at the sample, q̈_e(t) = −P12 v + D(t)⁻¹ w(t) + (q̈_d − q̈_d(t)), w = u + what is wrong + what the held torque
//! lags behind, and u = Pqq q_e − (K + C) s − σρ. See `docs/method.md`, section 9.

use super::local::Local;
use super::problem::{Magnitudes, Problem, Switching};
use super::set::{ErrorSet, Image};
use crate::numerics::Interval;
use crate::numerics::linalg::weighed;

/// Most rounds in which |q̈_e| within a period must be enclosed.
const ROUNDS: usize = 12;
/// D may differ from that at the start by less than this, relative.
const MOST: f64 = 0.98;
/// What sums and products of the few numbers of a period round by, relative, with room to spare.
const ROUNDED: f64 = 1e-13;

/// Why a set at the end of a period is not known.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stop {
    /// The displacements may leave the box that the dynamics were enclosed for: of q, then of q̇.
    Beyond(Vec<f64>),
    /// D may change too much over the set.
    Inertia,
    /// No bound on the acceleration of the errors is found.
    Acceleration,
}

/// What happens during a period.
#[derive(Clone, Debug)]
pub(super) struct During {
    /// Bound on |q̈_e|.
    pub(super) acceleration: Vec<f64>,
    /// Range of the torque that the law asks for, by joint, N·m or N.
    pub(super) torque: Vec<[f64; 2]>,
}

/// The set at a sample and what follows from it alone.
struct Sample<'a> {
    problem: &'a Problem<'a>,
    local: &'a Local,
    n: usize,
    /// Bounds on |q_e| and |v|, one list.
    x: Vec<f64>,
    /// Bounds on the displacements from the target.
    away: Vec<f64>,
    /// u = `control` x, with the switching term as a line.
    control: Vec<Vec<f64>>,
    /// D⁻¹u of the start.
    pushed: Image,
    pushed_size: Vec<f64>,
    /// Torque that is wrong and held for the period.
    wrong: Vec<f64>,
    /// Gains of the line through the switching term, and what that differs from it by.
    line: Vec<f64>,
    off_line: Vec<f64>,
    /// Coulomb friction that is compensated.
    fed: Vec<f64>,
}

/// What pushes the errors about during a period, in torque.
struct Load {
    /// Bound on the mean of what is not in the centre, by joint.
    mean: Vec<f64>,
    /// Bound on it at any time, and on the part of it that changes.
    most: Vec<f64>,
    changing: Vec<f64>,
    /// Known to be there for the whole period: the middle of Coulomb friction.
    middle: Vec<f64>,
}

impl ErrorSet {
    /// The set after the period of `local`; `guess` is a guess of |q̈_e|.
    pub(super) fn advance(
        &mut self,
        problem: &Problem,
        local: &Local,
        guess: &[f64],
    ) -> Result<During, Stop> {
        let sample = Sample::new(problem, local, self)?;
        let torque = sample.torque(self);
        let (acceleration, load, turned) = sample.enclosed(self, guess)?;
        sample.moved(self, &load, &turned);
        Ok(During { acceleration, torque })
    }

    /// The linear map from sample to sample in the period of `local`, with the switching term as for this set.
    pub(super) fn frozen(&self, problem: &Problem, local: &Local) -> Vec<Vec<f64>> {
        let n = problem.arm.dof();
        let (x, s) = (self.hull(), self.turned_hull(problem.gains).split_off(n));
        let line = switched(problem, local, &x, &s).0;
        held(problem, &product(&local.inverse, &control(problem, local, &line)))
    }
}

impl<'a> Sample<'a> {
    fn new(problem: &'a Problem<'a>, local: &'a Local, set: &ErrorSet) -> Result<Self, Stop> {
        let n = problem.arm.dof();
        let x = set.hull();
        let s = set.turned_hull(problem.gains).split_off(n);
        let away: Vec<f64> = x.iter().zip(&local.course.apart).map(|(x, apart)| UP * (x + apart)).collect();
        let lambda = scale(&away, &local.half);
        if lambda > 1.0 {
            return Err(Stop::Beyond(away));
        }
        let (line, off_line) = switched(problem, local, &x, &s);
        let control = control(problem, local, &line);
        let pushed = set.image(&product(&local.inverse, &control));
        let coriolis = &local.arm.coriolis;
        let turned =
            |i: usize| -> f64 { (0..n).map(|j| coriolis.change(i * n + j, &away, lambda) * s[j]).sum() };
        let added = |i: usize| -> f64 {
            let each = problem.numbers.iter().zip(&local.added);
            each.map(|(number, added)| number.most() * added.enclosure.torque.change(i, &away, lambda)).sum()
        };
        let wrong = (0..n).map(|i| problem.torque_error[i] + off_line[i] + turned(i) + added(i)).collect();
        let fed = (0..n).map(|i| compensation(problem.compensated[i], local.course.target.qd[i])).collect();
        let pushed_size = pushed.sizes();
        Ok(Self { problem, local, n, x, away, control, pushed, pushed_size, wrong, line, off_line, fed })
    }

    /// Range of the torque that the law asks for.
    fn torque(&self, set: &ErrorSet) -> Vec<[f64; 2]> {
        let Self { problem, local, n, .. } = *self;
        let torque = &local.arm.torque;
        let lambda = scale(&self.away, &local.half);
        let row = |i: usize| -> Vec<f64> {
            let mut row = torque.slopes(i).to_vec();
            for j in 0..n {
                let damping = problem.damping[i][j] + if i == j { self.line[i] } else { 0.0 };
                row[j] += problem.gains.pqq[i][j];
                row[n + j] -= damping;
                for k in 0..n {
                    row[k] -= damping * problem.gains.p12[j][k];
                }
            }
            row[n + i] += problem.arm.joints[i].viscous_friction;
            row
        };
        let rows: Vec<Vec<f64>> = (0..n).map(row).collect();
        let around = set.image(&rows).sizes();
        (0..n)
            .map(|i| {
                let friction = problem.arm.joints[i].viscous_friction * local.course.target.qd[i];
                let middle = torque.centre[i] + friction + self.fed[i];
                let half = around[i]
                    + torque.beyond(i, lambda)
                    + weighed(torque.slopes(i), &local.course.apart)
                    + self.off_line[i]
                    + problem.torque_error[i]
                    + ROUNDED * (middle.abs() + weighed(&rows[i], &self.x));
                [middle - half, middle + half]
            })
            .collect()
    }

    /// A bound on |q̈_e| during the period that holds by itself, what pushes, and what the change of D makes of it.
    fn enclosed(&self, set: &ErrorSet, guess: &[f64]) -> Result<(Vec<f64>, Load, Vec<f64>), Stop> {
        let Self { problem, local, n, .. } = *self;
        let pulled: Vec<Vec<f64>> = product(&local.inverse, &self.control)
            .into_iter()
            .zip(&problem.gains.p12)
            .map(|(mut row, p12)| {
                row[n..].iter_mut().zip(p12).for_each(|(x, p)| *x -= p);
                row
            })
            .collect();
        let straight = set.image(&pulled).sizes();
        let by_slopes = self.pushed.sizes_under(&local.slopes, &mut Vec::new());
        let by_numbers: Vec<Vec<f64>> =
            local.added.iter().map(|added| self.pushed.sizes_under(&added.turned, &mut Vec::new())).collect();
        let mut acceleration: Vec<f64> = (0..n).map(|i| 1.2 * guess[i].max(straight[i])).collect();
        for _ in 0..ROUNDS {
            let within = self.within(&acceleration)?;
            let load = self.load(&acceleration, &within);
            let turned = self.turned(&within, &load, &by_slopes, &by_numbers)?;
            let target = &local.course.target;
            let next: Vec<f64> = (0..n)
                .map(|i| {
                    let late = (local.course.span.qdd[i] - point(target.qdd[i])).magnitude();
                    let pushed = straight[i] + weighed(&local.inverse[i], &load.most);
                    UP * (pushed + weighed(&local.w[i], &turned) + late + self.rounded(i))
                })
                .collect();
            if next.iter().zip(&acceleration).all(|(next, bound)| next <= bound) {
                return Ok((acceleration, load, turned));
            }
            if !next.iter().all(|x| x.is_finite()) {
                return Err(Stop::Acceleration);
            }
            for (bound, next) in acceleration.iter_mut().zip(next) {
                *bound = 1.2 * bound.max(next);
            }
        }
        Err(Stop::Acceleration)
    }

    /// How far the state may be from the desired one of the start while |q̈_e| is below this, and how far the errors go.
    fn within(&self, acceleration: &[f64]) -> Result<Within, Stop> {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let span = &local.course.span;
        let mut errors = self.x.clone();
        let mut away = vec![0.0; 2 * n];
        for i in 0..n {
            errors[i] += t * self.x[n + i] + 0.5 * t * t * acceleration[i];
            errors[n + i] += t * acceleration[i];
            let target = &local.course.target;
            away[i] = UP * errors[i] + (span.q[i] - point(target.q[i])).magnitude();
            away[n + i] = UP * errors[n + i] + (span.qd[i] - point(target.qd[i])).magnitude();
        }
        let lambda = scale(&away, &local.half);
        let lambda_q = scale(&away[..n], &local.half);
        if lambda > 1.0 { Err(Stop::Beyond(away)) } else { Ok(Within { errors, away, lambda, lambda_q }) }
    }

    fn load(&self, acceleration: &[f64], within: &Within) -> Load {
        let Self { problem, local, n, .. } = *self;
        let t = problem.period;
        let mut load = Load {
            mean: Vec::with_capacity(n),
            most: Vec::with_capacity(n),
            changing: Vec::with_capacity(n),
            middle: Vec::with_capacity(n),
        };
        let own = self.change(&local.arm, acceleration, within, true);
        let numbers = problem.numbers.iter().zip(&local.added);
        let added: Vec<Vec<f64>> = numbers
            .map(|(number, added)| {
                let change = self.change(&added.enclosure, acceleration, within, false);
                let whole = |(change, rate): (f64, &f64)| number.most() * (change + rate);
                change.into_iter().zip(&added.lag_rate).map(whole).collect()
            })
            .collect();
        for i in 0..n {
            let rate = own[i] + added.iter().map(|added| added[i]).sum::<f64>();
            let bend = local.lag.rate[i].high - local.lag.rate[i].low;
            let [low, high] = self.coulomb(i, within);
            let speed = local.course.span.qd[i].magnitude() + within.errors[n + i];
            let half = 0.5 * (high - low) + problem.viscous[i] * speed;
            let (mean, most) = (0.5 * t * rate + 0.125 * t * bend, t * rate + 0.25 * t * bend);
            let numbers = of_numbers(problem, local, i);
            let lagged = t * local.lag.rate[i].magnitude();
            let middle = self.fed[i] - 0.5 * (low + high);
            load.mean.push(UP * (self.wrong[i] + half + mean + ends(local.lag.end[i])));
            load.most.push(UP * (self.wrong[i] + half + most + lagged + numbers + middle.abs()));
            load.changing.push(UP * (2.0 * half + most));
            load.middle.push(middle);
        }
        load
    }

    /// Bound on what d/dt(D a_r + n) differs by from that of the desired motion, by joint.
    fn change(
        &self,
        arm: &super::enclosure::Enclosure,
        acceleration: &[f64],
        within: &Within,
        own: bool,
    ) -> Vec<f64> {
        let Self { problem, local, n, .. } = *self;
        let Within { errors, away, lambda, .. } = within;
        let late: Vec<f64> = (0..n)
            .map(|j| (local.course.span.qdd[j] - point(local.course.target.qdd[j])).magnitude())
            .collect();
        let moved = |i: usize, j: usize| arm.coriolis.change(i * n + j, away, *lambda);
        let size = |i: usize, j: usize| arm.coriolis.centre[i * n + j].abs() + moved(i, j);
        let row = |i: usize| {
            // The rate at the state less that on the desired motion: what is beyond the line counts for both.
            let slopes: f64 = arm.rate.slopes(i).iter().zip(errors).map(|(a, x)| a.abs() * x).sum();
            let mut sum = slopes + 2.0 * arm.rate.beyond(i, *lambda);
            for j in 0..n {
                let (ij, ji) = (size(i, j), size(j, i));
                let slowed = weighed(&problem.gains.p12[j], &self.x[n..]);
                sum += 2.0 * ij * acceleration[j] + 4.0 * moved(i, j) * late[j] + (ij + ji) * slowed;
            }
            let friction = if own { problem.arm.joints[i].viscous_friction } else { 0.0 };
            sum + friction * acceleration[i]
        };
        (0..n).map(row).collect()
    }

    /// Range of the Coulomb friction of joint `i` during the period, N·m or N.
    fn coulomb(&self, i: usize, within: &Within) -> [f64; 2] {
        let [forwards, backwards] = self.problem.arm.joints[i].coulomb_friction;
        let (speed, error) = (self.local.course.span.qd[i], within.errors[self.n + i]);
        if speed.low > error {
            [forwards; 2]
        } else if speed.high < -error {
            [backwards; 2]
        } else {
            [backwards.min(forwards), forwards.max(backwards)]
        }
    }

    /// Bound on |y|, D⁻¹w = W Wᵀ w − W y, by eigenvector of D at the start.
    fn turned(
        &self,
        within: &Within,
        load: &Load,
        by_slopes: &[f64],
        by_numbers: &[Vec<f64>],
    ) -> Result<Vec<f64>, Stop> {
        let Self { problem, local, n, .. } = *self;
        let Within { away, lambda_q: lambda, .. } = within;
        let mut lengths = Vec::with_capacity(n);
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
            lengths.push(slopes + bent + local.unit_lengths[i] + added);
        }
        let r = norm(&lengths);
        if r.is_nan() || r >= MOST {
            return Err(Stop::Inertia);
        }
        let column = |i: usize| -> Vec<f64> { (0..n).map(|k| local.w[k][i]).collect() };
        let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let others: Vec<f64> = columns.iter().map(|column| weighed(column, &load.most)).collect();
        let others = norm(&others);
        let asked: Vec<f64> = self.control.iter().map(|row| weighed(row, &self.x)).collect();
        let asked = norm(&columns.iter().map(|column| weighed(column, &asked)).collect::<Vec<f64>>());
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
            slopes + bends.sum::<f64>() + added + weighed(&columns[i], &beyond) + unit + lengths[i] * others
        };
        let first: Vec<f64> = (0..n).map(first).collect();
        let whole = norm(&first) / (1.0 - r);
        Ok(first.iter().zip(&lengths).map(|(first, length)| UP * (first + length * whole)).collect())
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

    /// What −P12 v + D⁻¹u of the start rounds by.
    fn rounded(&self, i: usize) -> f64 {
        let Self { problem, local, n, .. } = *self;
        let sizes = &local.inverse_size[i];
        let pushed: f64 = sizes.iter().zip(&self.control).map(|(m, row)| m * weighed(row, &self.x)).sum();
        ROUNDED * (pushed + weighed(&problem.gains.p12[i], &self.x[n..]))
    }

    /// The set becomes that at the end of the period.
    fn moved(&self, set: &mut ErrorSet, load: &Load, turned: &[f64]) {
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
        let middles: Vec<f64> =
            (0..n).map(|i| load.middle[i] + middle_of_numbers(problem, local, i)).collect();
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

/// Displacements during a period.
struct Within {
    /// Bounds on |q_e|, then on |q̇_e|.
    errors: Vec<f64>,
    /// The same of (q, q̇) from the desired state of the start.
    away: Vec<f64>,
    lambda: f64,
    /// The λ of the displacements of q alone.
    lambda_q: f64,
}

/// More than what the roundings of a bound take off it.
const UP: f64 = 1.0 + 1e-12;

/// The smallest λ with x ≤ λ `half`.
fn scale(x: &[f64], half: &[f64]) -> f64 {
    x.iter().zip(half).map(|(x, half)| x / half).fold(0.0, f64::max)
}

fn norm(x: &[f64]) -> f64 {
    UP * libm::sqrt(x.iter().map(|x| x * x).sum())
}

fn point(x: f64) -> Interval {
    Interval::point(x)
}

fn middle(x: Interval) -> f64 {
    0.5 * (x.low + x.high)
}

/// Half the width of an interval, and what its middle rounds by.
fn ends(x: Interval) -> f64 {
    let middle = middle(x);
    UP * (x.high - middle).max(middle - x.low)
}

/// M N by rows.
fn product(m: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let row = |m: &Vec<f64>| -> Vec<f64> {
        let mut out = vec![0.0; other.first().map_or(0, Vec::len)];
        for (weight, row) in m.iter().zip(other) {
            out.iter_mut().zip(row).for_each(|(out, x)| *out += weight * x);
        }
        out
    };
    m.iter().map(row).collect()
}

/// u as rows on x: Pqq q_e − (K + C + line) s, with C of the desired motion.
fn control(problem: &Problem, local: &Local, line: &[f64]) -> Vec<Vec<f64>> {
    let n = line.len();
    let row = |i: usize| {
        let mut row = vec![0.0; 2 * n];
        row[..n].copy_from_slice(&problem.gains.pqq[i]);
        for j in 0..n {
            let slope = if i == j { line[i] } else { 0.0 };
            let damping = problem.damping[i][j] + local.arm.coriolis.centre[i * n + j] + slope;
            row[n + j] -= damping;
            for k in 0..n {
                row[k] -= damping * problem.gains.p12[j][k];
            }
        }
        row
    };
    (0..n).map(row).collect()
}

/// The linear map of the errors over a period with q̈_e held at `pushed` x − P12 v.
fn held(problem: &Problem, pushed: &[Vec<f64>]) -> Vec<Vec<f64>> {
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

/// The slope of the line that stands for the switching term of each joint, N·m·s/rad, and what the term differs from it by, N·m.
fn switched(problem: &Problem, local: &Local, x: &[f64], s: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = s.len();
    let Switching::Robust(gain, layer) = problem.switching else { return (vec![0.0; n], vec![0.0; n]) };
    let target = &local.course.target;
    let [low, high] = [-1.0, 1.0].map(|side| {
        let about = |value: f64, error: f64| (value.abs() + side * error).max(0.0);
        let pulled = |i: usize, x: &[f64]| weighed(&problem.gains.p12[i], x);
        let end = |error: f64| if side > 0.0 { error } else { 0.0 };
        gain.at(&Magnitudes {
            speed: (0..n).map(|i| about(target.qd[i], x[n + i])).collect(),
            reference_speed: (0..n).map(|i| about(target.qd[i], pulled(i, &x[..n]))).collect(),
            desired_acceleration: target.qdd.iter().map(|a| a.abs()).collect(),
            reference_acceleration: (0..n).map(|i| about(target.qdd[i], pulled(i, &x[n..]))).collect(),
            velocity_error: x[n..].iter().map(|&error| end(error)).collect(),
            s: s.iter().map(|&s| end(s)).collect(),
        })
    });
    let mut out = (Vec::with_capacity(n), Vec::with_capacity(n));
    for i in 0..n {
        let (rho, spread) = (0.5 * (low[i] + high[i]), 0.5 * (high[i] - low[i]));
        let phi = layer.map_or(0.0, |layer| layer[i]);
        let most = s[i].max(phi);
        // Steeper than this the sampled loop would not be stable.
        let steepest = STEEPEST / (problem.period * local.inverse[i][i] * rho);
        let slope = (2.0 / (phi + most)).min(steepest);
        let off = if s[i] <= phi && slope * phi >= 1.0 {
            0.0
        } else {
            (1.0 - slope * phi).abs().max((1.0 - slope * most).abs())
        };
        let share = if phi > 0.0 { (s[i] / phi).min(1.0) } else { 1.0 };
        let error = problem.s_error[i] * if phi > 0.0 { 1.0 / phi } else { slope };
        out.0.push(if rho > 0.0 { rho * slope } else { 0.0 });
        out.1.push(UP * (rho * (off + error + ROUNDED) + spread * (share + error)));
    }
    out
}

/// What a line of the switching term may add to the loop in a period, relative.
const STEEPEST: f64 = 0.5;

/// Coulomb friction that the command compensates where the desired speed is this.
fn compensation([forwards, backwards]: [f64; 2], speed: f64) -> f64 {
    if speed > 0.0 {
        forwards
    } else if speed < 0.0 {
        backwards
    } else {
        0.0
    }
}

/// What the uncertain numbers may do to the torque of joint `i` on the desired motion at most.
fn of_numbers(problem: &Problem, local: &Local, i: usize) -> f64 {
    let each = problem.numbers.iter().zip(&local.added);
    each.map(|(number, added)| number.most() * added.enclosure.torque.centre[i].abs()).sum()
}

/// The same at the middle of their intervals, with its sign.
fn middle_of_numbers(problem: &Problem, local: &Local, i: usize) -> f64 {
    let each = problem.numbers.iter().zip(&local.added);
    each.map(|(number, added)| -number.middle * added.enclosure.torque.centre[i]).sum()
}
