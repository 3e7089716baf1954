//! How long the joints take, each by itself and all together: the coupled loop D ṡ = −K s + Pqq q_e, q̇_e = −P12 q_e + s with a constant D.

use super::gains::Gains;
use super::search::{GainCandidate, Scene, Target};
use crate::arm::Arm;
use crate::check::Tuning;
use crate::dynamics::mass_matrix;
use crate::error::Error;
use crate::motion::Motion;
use crate::numerics::linalg::{inverse, product};

/// Positions of the motion from which D is taken.
const POSITIONS: u32 = 5;
/// What counts as settled, relative to the largest initial error.
const SETTLED: f64 = 0.05;
/// Steps in the shortest time constant, and most steps of all.
const STEPS: f64 = 4.0;
const MOST_STEPS: f64 = 200_000.0;

/// Times that are tried for each joint by itself, and the share of the time in which all together must be done: what D
/// does while it moves takes the rest.
const PACES: usize = 6;
const MARGIN: f64 = 0.93;

impl Scene<'_> {
    /// Gains for `period` that hold and with which the joints together are fast enough, or those that come nearest;
    /// `None` where none are fast enough. The search ends where its first errors reach `give_up` rooms.
    pub(super) fn find(&self, period: f64, give_up: Option<f64>) -> Result<Option<GainCandidate>, Error> {
        let super::DesignProblem { arm, motion, .. } = *self.stage.problem;
        let wanted = self.target.time;
        let mut time = wanted;
        for _ in 0..PACES {
            let target = Target { time, room: self.target.room.clone() };
            let Some(candidate) = self.for_target(&target).find_each(period, give_up)? else {
                return Ok(None);
            };
            if !candidate.holds {
                return Ok(Some(candidate));
            }
            let taken = settling(
                arm,
                motion,
                &candidate.tuning,
                &self.stage.problem.control.initial_error.position,
                4.0 * wanted,
            );
            if taken <= MARGIN * wanted {
                return Ok(Some(candidate));
            }
            // Each joint by itself must be faster, for those that pull it to be outrun.
            time *= (0.97 * MARGIN * wanted / taken).max(0.5);
        }
        Ok(None)
    }
}

/// The time after which no |q_e,i| exceeds 1/20 of the largest initial error, s, for initial errors of any signs and
/// these sizes, at rest, under law (16); the longest over some positions of the motion. Infinite where it is beyond `most`.
pub(super) fn settling(arm: &Arm, motion: Option<&Motion>, tuning: &Tuning, start: &[f64], most: f64) -> f64 {
    let positions: Vec<Vec<f64>> = match motion {
        Some(motion) => (0..POSITIONS)
            .map(|k| motion.at(motion.duration() * f64::from(k) / f64::from(POSITIONS - 1)).q)
            .collect(),
        None => vec![arm.joint_box().iter().map(|[low, high]| 0.5 * (low + high)).collect()],
    };
    let start = if start.iter().all(|e| *e == 0.0) { vec![1.0; start.len()] } else { start.to_vec() };
    let gains = Gains::new(tuning);
    positions.iter().map(|q| at(arm, q, &gains, &start, most)).fold(0.0, f64::max)
}

/// The loop is linear, so the worst signs of the initial errors are known from the answers to errors of one joint each.
fn at(arm: &Arm, q: &[f64], gains: &Gains, start: &[f64], most: f64) -> f64 {
    let n = start.len();
    let Some(mobility) = inverse(&mass_matrix(arm, q)) else { return f64::INFINITY };
    let damping = product(&mobility, &gains.damping);
    let spring = product(&mobility, &gains.pqq);
    let largest =
        |m: &[Vec<f64>]| m.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let fastest = largest(&damping) + largest(&gains.p12);
    let steps = (most * fastest * STEPS).clamp(100.0, MOST_STEPS);
    let h = most / steps;
    // Columns: the answer to one joint's error; rows: q_e, then s.
    let mut state: Vec<Vec<f64>> = (0..n)
        .map(|j| {
            let e = |i: usize| if i == j { start[j] } else { 0.0 };
            (0..n).map(e).chain((0..n).map(|i| gains.p12[i][j] * start[j])).collect()
        })
        .collect();
    let rate = |x: &[f64]| -> Vec<f64> {
        let (e, s) = x.split_at(n);
        let of =
            |m: &[Vec<f64>], x: &[f64], i: usize| -> f64 { m[i].iter().zip(x).map(|(m, x)| m * x).sum() };
        let position = (0..n).map(|i| s[i] - of(&gains.p12, e, i));
        position.chain((0..n).map(|i| of(&spring, e, i) - of(&damping, s, i))).collect()
    };
    let along =
        |x: &[f64], h: f64, v: &[f64]| -> Vec<f64> { x.iter().zip(v).map(|(x, v)| x + h * v).collect() };
    let settled = SETTLED * start.iter().fold(0.0_f64, |m, e| m.max(*e));
    let mut last = 0.0;
    let count = steps as u32;
    for k in 1..=count {
        for x in &mut state {
            // Heun's method: second order is enough for a time to a percent.
            let first = rate(x);
            let second = rate(&along(x, h, &first));
            let mean: Vec<f64> = first.iter().zip(&second).map(|(a, b)| 0.5 * (a + b)).collect();
            *x = along(x, h, &mean);
        }
        let worst = |i: usize| state.iter().map(|x| x[i].abs()).sum::<f64>();
        if (0..n).any(|i| worst(i) > settled) {
            last = h * f64::from(k);
        }
    }
    if last >= most * (1.0 - 1e-9) { f64::INFINITY } else { last }
}

/// Time until q_e of one joint, at rest at the start, is at 1/20 of its initial value: d ṡ = −K s + Pqq q_e,
/// q̇_e = −λ q_e + s with K/d = `rate`, P12 = λ = `pull` and Pqq Ω⁻¹ Pqq the share `stiff` of K, s.
pub(super) fn settling_time(rate: f64, pull: f64, stiff: f64) -> f64 {
    let between = libm::sqrt((rate - pull) * (rate - pull) + 4.0 * rate * pull * stiff);
    let fast = 0.5 * (rate + pull + between);
    // The difference of the roots' sum and `between` would cancel.
    let slow = rate * pull * (1.0 - stiff) / fast;
    libm::log(20.0 * fast / (fast - slow)) / slow
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::example::three_link;

    #[test]
    fn a_joint_by_itself_settles_as_computed() {
        // A stretched arm about its upright first axis: D is diagonal in joint 1.
        let mut arm = three_link();
        arm.joints.truncate(1);
        arm.joints[0].armature = 2.0;
        let d = mass_matrix(&arm, &[0.0])[0][0];
        let (k, pull, stiff) = (40.0, 3.0, 0.3);
        let pqq = stiff * k * pull;
        let tuning = Tuning {
            w: vec![vec![k - pqq / pull]],
            pqq: vec![vec![pqq]],
            omega: vec![vec![pull * pqq]],
            boundary_layer: None,
            period: 1e-3,
        };
        let found = settling(&arm, None, &tuning, &[0.1], 10.0);
        let wanted = settling_time(k / d, pull, stiff);
        assert!((found - wanted).abs() < 0.05 * wanted, "{found} {wanted}");
        assert!(settling(&arm, None, &tuning, &[0.1], 0.5 * wanted).is_infinite());
    }

    #[test]
    fn the_settling_time_is_that_of_the_joint() {
        for (rate, pull, stiff) in [(40.0, 2.0, 0.25), (12.0, 3.0, 0.5), (400.0, 1.0, 0.1), (5.0, 5.0, 0.4)] {
            let time = settling_time(rate, pull, stiff);
            // q_e and s = q̇_e + λ q_e by small steps, from rest.
            let steps = 200_000;
            let h = time / f64::from(steps);
            let (mut q, mut s) = (1.0, pull);
            for _ in 0..steps {
                let (dq, ds) = (s - pull * q, rate * (stiff * pull * q - s));
                let (mq, ms) = (q + 0.5 * h * dq, s + 0.5 * h * ds);
                (q, s) = (q + h * (ms - pull * mq), s + h * rate * (stiff * pull * mq - ms));
            }
            println!("K/d {rate}, λ {pull}, share {stiff}: 1/20 after {time:.3} s, there {q:.5}");
            assert!((0.04..=0.05 + 1e-4).contains(&q), "{q}");
        }
    }
}
