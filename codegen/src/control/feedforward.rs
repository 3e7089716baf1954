//! The torque that the desired motion itself takes, of every arm of a family, and how fast it changes: enclosed over the
//! whole motion, never sampled.
//!
//! The recursion runs on intervals of time: with the ranges of q_d, q̇_d, q̈_d and the jerk over a piece of the motion it
//! gives ranges of τ and of dτ/dt. Pieces are halved until the largest bound is near the largest value seen.

use crate::arm::{Arm, Uncertainty};
use crate::dynamics::{Jet, enclosed_positions, passivity_torque};
use crate::motion::{Motion, Span};
use crate::number::{decimal, scientific};
use crate::numerics::Interval;
use crate::parallel::Parallelize;

/// Pieces of the motion to begin with.
const PIECES: u32 = 32;
/// Pieces that may be looked at, for an arm of one joint: then the bounds found so far stand. What one costs grows with n.
pub(super) const BUDGET: usize = 60_000;
/// Part of the duration below which a piece is not halved any more: its bound will not come down.
const NARROWEST: f64 = 1e-9;
/// Distance of bound and largest value at which halving ends, relative: of the torque, and of its rate, which converges an
/// order more slowly.
const TOLERANCE: [f64; 2] = [2e-3, 0.02];
/// A torque below this part of the largest joint's is not worth halving for.
const SMALL: f64 = 1e-4;

/// What the desired motion asks of the joints.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Feedforward {
    /// |τ_d| of any arm of the family by joint, viscous friction included, N·m or N: no instant exceeds it.
    pub(super) torque: Vec<f64>,
    /// The largest that was seen at some instant.
    pub(super) seen: Vec<f64>,
    /// |dτ_d/dt|, N·m/s or N/s: no instant exceeds it. Times the period it is what a held torque lags, with `jump`.
    pub(super) rate: Vec<f64>,
    /// What steps of q̈_d may change τ_d by within any time, N·m or N; 0 along a planned motion, whose rate has it.
    pub(super) jump: Vec<f64>,
}

/// The arms of a family: τ is affine in the uncertain parameters.
pub(super) struct Family<'a> {
    pub(super) arm: &'a Arm,
    pub(super) uncertainty: &'a Uncertainty,
    /// The arms whose torques are ∂τ/∂u_k.
    pub(super) alone: Vec<Arm>,
}

/// A piece of the motion, with bounds and values seen: torques of all joints, then rates.
struct Piece {
    ends: [f64; 2],
    bound: Vec<f64>,
    seen: Vec<f64>,
}

impl Feedforward {
    /// Of the arm with its `uncertainty` along `motion`.
    pub(super) fn new(arm: &Arm, uncertainty: &Uncertainty, motion: &Motion) -> Self {
        let n = arm.dof();
        let alone = (0..uncertainty.parameters.len()).map(|k| uncertainty.alone(arm, k)).collect();
        let family = Family { arm, uncertainty, alone };
        let times: Vec<f64> =
            (0..=PIECES).map(|k| motion.duration() * f64::from(k) / f64::from(PIECES)).collect();
        let whole: Vec<[f64; 2]> = times.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        let mut open: Vec<Piece> = whole.into_par_iter().map(|ends| family.judge(motion, ends)).collect();
        let mut closed: Vec<Piece> = Vec::new();
        let mut seen = vec![0.0_f64; 2 * n];
        let mut left = BUDGET / (n * (1 + family.alone.len()));
        let narrowest = NARROWEST * motion.duration();
        loop {
            let new = largest(&open, n, |piece| &piece.seen);
            seen.iter_mut().zip(new).for_each(|(seen, new)| *seen = seen.max(new));
            let targets = targets(&seen, n);
            let excess = |piece: &Piece| {
                let entries = piece.bound.iter().zip(&targets).map(|(bound, target)| bound / target);
                entries.fold(0.0, f64::max)
            };
            let wide = |piece: &Piece| excess(piece) > 1.0 && piece.ends[1] - piece.ends[0] > narrowest;
            // What is closed stays so: the values seen only grow.
            let (mut halved, done): (Vec<Piece>, Vec<Piece>) = open.into_iter().partition(wide);
            closed.extend(done);
            // Stable, so that the order never depends on threads; the worst first, where the budget runs short.
            halved.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
            closed.extend(halved.split_off(halved.len().min(left / 2)));
            if halved.is_empty() {
                let bound = largest(&closed, n, |piece| &piece.bound);
                let (torque, rate) = bound.split_at(n);
                let (torque, rate) = (torque.to_vec(), rate.to_vec());
                return Self { torque, seen: seen[..n].to_vec(), rate, jump: vec![0.0; n] };
            }
            left -= 2 * halved.len();
            let halves = halved.iter().flat_map(|parent| {
                let [from, to] = parent.ends;
                let cut = motion.cut(from, to);
                [(parent, [from, cut]), (parent, [cut, to])]
            });
            let halves: Vec<(&Piece, [f64; 2])> = halves.collect();
            let judged =
                halves.into_par_iter().map(|(parent, ends)| family.judge(motion, ends).within(parent));
            open = judged.collect();
        }
    }

    /// What a torque that is held for `period` may lag behind, by joint, N·m or N.
    pub(super) fn lag(&self, period: f64) -> Vec<f64> {
        self.rate.iter().zip(&self.jump).map(|(rate, jump)| rate * period + jump).collect()
    }

    /// The joints whose torque limit is less than what the desired motion alone may take of some arm of the family,
    /// compensated Coulomb friction included.
    pub(super) fn beyond_limits(&self, arm: &Arm, coulomb: &[[f64; 2]]) -> Vec<String> {
        let friction = coulomb.iter().map(|[forwards, backwards]| forwards.max(-backwards));
        let takes = self.torque.iter().zip(&self.seen).zip(friction).map(|((b, s), f)| (b + f, s + f));
        (1..)
            .zip(takes.zip(&arm.joints))
            .filter_map(|(number, ((bound, seen), joint))| {
                let limit = joint.limits.torque.filter(|&limit| bound >= limit)?;
                let (may, taken) = if seen >= limit { ("takes", seen) } else { ("may take", bound) };
                Some(format!(
                    "the desired motion {may} {} of joint {number}, its torque limit is {} {}",
                    decimal(taken, 4),
                    scientific(limit),
                    joint.kind.torque_unit()
                ))
            })
            .collect()
    }
}

impl Family<'_> {
    fn judge(&self, motion: &Motion, ends: [f64; 2]) -> Piece {
        let middle = 0.5 * (ends[0] + ends[1]);
        let half = 0.5 * (ends[1] - ends[0]) * (1.0 + 1e-12);
        let (wide, narrow) =
            (self.along(&motion.span(ends[0], ends[1])), self.along(&motion.span(middle, middle)));
        let torques = wide.iter().zip(&narrow).map(|(wide, narrow)| {
            // By the mean value theorem, and by the ranges themselves: both hold.
            let near = narrow.value.magnitude() + half * wide.rate.magnitude();
            (near * (1.0 + f64::EPSILON)).min(wide.value.magnitude())
        });
        let rates = wide.iter().map(|wide| wide.rate.magnitude());
        let least = |range: Interval| range.low.max(-range.high).max(0.0);
        let seen = narrow.iter().map(|narrow| least(narrow.value));
        let seen = seen.chain(narrow.iter().map(|narrow| least(narrow.rate))).collect();
        let known = |bound: f64| if bound.is_nan() { f64::INFINITY } else { bound };
        Piece { ends, bound: torques.chain(rates).map(known).collect(), seen }
    }

    /// Ranges of τ and dτ/dt by joint, of all arms of the family.
    pub(super) fn along(&self, span: &Span) -> Vec<Jet<Interval>> {
        let mut total = torque(self.arm, span);
        for ((sum, joint), (qd, qdd)) in
            total.iter_mut().zip(&self.arm.joints).zip(span.qd.iter().zip(&span.qdd))
        {
            let viscous = Interval::point(joint.viscous_friction);
            *sum = *sum + Jet { value: viscous * *qd, rate: viscous * *qdd };
        }
        for (parameter, alone) in self.uncertainty.parameters.iter().zip(&self.alone) {
            let u = Interval { low: parameter.low, high: parameter.high };
            for (sum, slope) in total.iter_mut().zip(torque(alone, span)) {
                *sum = *sum + Jet { value: u * slope.value, rate: u * slope.rate };
            }
        }
        for ((sum, width), (qd, qdd)) in
            total.iter_mut().zip(&self.uncertainty.viscous).zip(span.qd.iter().zip(&span.qdd))
        {
            let off = Interval { low: -width, high: *width };
            *sum = *sum + Jet { value: off * *qd, rate: off * *qdd };
        }
        total
    }
}

impl Piece {
    /// What held for the parent holds for its halves.
    fn within(mut self, parent: &Self) -> Self {
        self.bound.iter_mut().zip(&parent.bound).for_each(|(own, parent)| *own = own.min(*parent));
        self
    }
}

/// τ_d and its rate of one arm, without friction.
fn torque(arm: &Arm, span: &Span) -> Vec<Jet<Interval>> {
    let with = |value: &[Interval], rate: &[Interval]| -> Vec<Jet<Interval>> {
        value.iter().zip(rate).map(|(&value, &rate)| Jet { value, rate }).collect()
    };
    let q = enclosed_positions(arm, &with(&span.q, &span.qd));
    let (qd, qdd) = (with(&span.qd, &span.qdd), with(&span.qdd, &span.jerk));
    passivity_torque(arm, arm.gravity, &q, &qd, &qd, &qdd)
}

fn largest(pieces: &[Piece], n: usize, of: impl Fn(&Piece) -> &Vec<f64>) -> Vec<f64> {
    let larger = |mut most: Vec<f64>, piece: &Piece| {
        most.iter_mut().zip(of(piece)).for_each(|(most, own)| *most = most.max(*own));
        most
    };
    pieces.iter().fold(vec![0.0; 2 * n], larger)
}

/// What no piece's bound needs to come below.
fn targets(seen: &[f64], n: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(2 * n);
    for (seen, tolerance) in seen.chunks(n).zip(TOLERANCE) {
        let floor = SMALL * seen.iter().fold(0.0_f64, |most, x| most.max(*x));
        out.extend(seen.iter().map(|x| x.max(floor) * (1.0 + tolerance) + f64::MIN_POSITIVE));
    }
    out
}

#[cfg(test)]
mod tests {
    use gramforge_runtime::reference::Sinusoid;

    use super::*;
    use crate::dynamics::inverse_dynamics;
    use crate::simulate::example::{three_link, two_of_three};

    fn wobble(frequency: f64, duration: f64) -> Motion {
        let term = |amplitude| vec![Sinusoid { amplitude, frequency, phase: 0.0 }];
        Motion::Sinusoids {
            offset: vec![0.0, 0.3, -1.2],
            terms: vec![term(0.01), term(0.02), term(0.01)],
            duration,
        }
    }

    /// Torques and their rates by differences at `count` instants that no period divides.
    fn seen(arm: &Arm, motion: &Motion, count: u32) -> [Vec<f64>; 2] {
        let n = arm.dof();
        let mut most = [vec![0.0_f64; n], vec![0.0_f64; n]];
        let at = |t: f64| {
            let target = motion.at(t);
            inverse_dynamics(arm, &target.q, &target.qd, &target.qdd)
        };
        let h = 1e-5;
        for k in 0..count {
            let t = h + (motion.duration() - 2.0 * h) * f64::from(k) / f64::from(count) * 0.999_999;
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            for i in 0..n {
                most[0][i] = most[0][i].max(now[i].abs());
                most[1][i] = most[1][i].max((after[i] - before[i]).abs() / (2.0 * h));
            }
        }
        most
    }

    #[test]
    fn the_change_of_a_torque_is_enclosed_whatever_the_rhythm() {
        let arm = three_link();
        // 400 and 1000 equal steps of the long motion hold whole periods of 2 Hz: samples see a constant torque.
        let quintic = Motion::Quintic { from: vec![0.0, 0.3, -1.2], to: vec![1.5, 1.2, -2.2], duration: 5.0 };
        let two_hertz = 4.0 * std::f64::consts::PI;
        for (motion, most) in
            [(quintic, 1.03), (wobble(two_hertz, 2.0), 1.03), (wobble(two_hertz, 200.0), 1.5)]
        {
            let bounds = Feedforward::new(&arm, &Uncertainty::default(), &motion);
            let [torque, rate] = seen(&arm, &motion, 20_011);
            println!("{:?} of {torque:?}, rates {:?} of {rate:?}", bounds.torque, bounds.rate);
            for i in 0..3 {
                assert!(bounds.torque[i] >= torque[i] && bounds.rate[i] >= rate[i] * (1.0 - 1e-6));
                assert!(bounds.seen[i] <= torque[i] * 1.001 + 1e-9);
                assert!(
                    bounds.torque[i] <= 1.003 * torque[i] + 1e-2 && bounds.rate[i] <= most * rate[i] + 1e-2
                );
            }
        }
    }

    #[test]
    fn joints_that_follow_others_count() {
        let arm = two_of_three();
        let motion = Motion::Quintic { from: vec![0.0, 0.3], to: vec![1.5, 1.2], duration: 2.0 };
        let bounds = Feedforward::new(&arm, &Uncertainty::default(), &motion);
        let [torque, rate] = seen(&arm, &motion, 5_003);
        println!("{:?} of {torque:?}, rates {:?} of {rate:?}", bounds.torque, bounds.rate);
        for i in 0..2 {
            assert!(bounds.torque[i] >= torque[i] && bounds.rate[i] >= rate[i] * (1.0 - 1e-6));
            assert!(bounds.torque[i] <= 1.01 * torque[i] && bounds.rate[i] <= 1.05 * rate[i]);
        }
    }
}
