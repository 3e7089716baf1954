//! The desired motion during one period, and what a torque that is held for it lags behind.

use crate::arm::Arm;
use crate::dynamics::{Jet, enclosed_positions, passivity_torque};
use crate::motion::{Motion, Span, Target};
use crate::numerics::Interval;

/// The desired motion during one period.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The desired state at the start.
    pub(super) target: Target,
    /// What the speed error changes by because q̈_d does: ∫(q̈_d(start) − q̈_d) dt, and the same of the position error.
    pub(super) drift: [Vec<Interval>; 2],
    /// Ranges during the period.
    pub(super) span: Span,
    /// Bound on what q_d and q̇_d at the start differ from the target's by.
    pub(super) apart: Vec<f64>,
    /// Bound on what q̈_d differs from that of the start by. A step of speed counts as 2/T times its height: that adds no less to
    /// speed and position within the period.
    pub(super) late: Vec<f64>,
    /// q_d and q̇_d at the start and at the end.
    ends: [[Vec<Interval>; 2]; 2],
}

impl Course {
    /// The period from `time` on, where each sinusoid of the motion may be early or late by up to `slack`, s. At and after its end the
    /// motion rests, if it is one that does.
    pub(super) fn new(motion: &Motion, time: f64, period: f64, slack: f64) -> Self {
        let end = motion.duration();
        if time >= end {
            return Self::rest(motion);
        }
        let target = motion.at(time);
        let next = (time + period).min(end);
        let about = |from: f64, to: f64| motion.span_late(from, to, slack);
        let [at, after] = [about(time, time), about(next, next)];
        let mut span = about(time, next);
        let t = Interval::point(period);
        let half_square = Interval::point(0.5) * t * t;
        let n = target.q.len();
        let rests = time + period >= end && motion.rests();
        let still = |i: usize, x: &[Interval]| if rests { Interval::ZERO } else { x[i] };
        let drift = [
            (0..n).map(|i| t * Interval::point(target.qdd[i]) - (still(i, &after.qd) - at.qd[i])).collect(),
            (0..n)
                .map(|i| half_square * Interval::point(target.qdd[i]) - (after.q[i] - at.q[i] - t * at.qd[i]))
                .collect(),
        ];
        // What rounding leaves of the speed at the end goes in a step.
        let step = |i: usize| if rests { after.qd[i].magnitude() } else { 0.0 };
        let step: Vec<f64> = (0..n).map(step).collect();
        if rests {
            for range in span.qd.iter_mut().chain(&mut span.qdd).chain(&mut span.jerk) {
                *range = range.hull(Interval::ZERO);
            }
        }
        let late = (0..n)
            .map(|i| (span.qdd[i] - Interval::point(target.qdd[i])).magnitude() + 2.0 * step[i] / period)
            .collect();
        let last = (0..n).map(|i| still(i, &after.qd)).collect();
        let off = |range: &[Interval], x: &[f64]| -> Vec<f64> {
            range.iter().zip(x).map(|(range, &x)| (*range - Interval::point(x)).magnitude()).collect()
        };
        let mut apart = off(&at.q, &target.q);
        apart.extend(off(&at.qd, &target.qd));
        Self { target, drift, span, apart, late, ends: [[at.q, at.qd], [after.q, last]] }
    }

    /// Whether nothing moves.
    pub(super) fn is_still(&self) -> bool {
        self.span.qd.iter().all(|speed| *speed == Interval::ZERO)
    }

    /// A period at rest at the end of the motion.
    fn rest(motion: &Motion) -> Self {
        let end = motion.at(motion.duration());
        let n = end.q.len();
        let still = vec![Interval::ZERO; n];
        let span = Span {
            q: end.q.iter().map(|&q| Interval::point(q)).collect(),
            qd: still.clone(),
            qdd: still.clone(),
            jerk: still.clone(),
        };
        let target = Target { q: end.q, qd: vec![0.0; n], qdd: vec![0.0; n] };
        let state = [span.q.clone(), still.clone()];
        let (apart, late) = (vec![0.0; 2 * n], vec![0.0; n]);
        Self { target, drift: [still.clone(), still], span, apart, late, ends: [state.clone(), state] }
    }
}

/// What D q̈_d + n of the desired motion is at the start of a period less what it is later, with the q̈_d of the start.
#[derive(Clone, Debug)]
pub(super) struct Lag {
    /// At the end of the period, N·m or N.
    pub(super) end: Vec<Interval>,
    /// Its rate during the period, N·m/s or N/s.
    pub(super) rate: Vec<Interval>,
}

impl Lag {
    /// Of `arm`, whose joints have this viscous friction: none where the list is empty.
    pub(super) fn new(arm: &Arm, course: &Course, viscous: &[f64]) -> Self {
        let Course { target, span, ends, .. } = course;
        let n = target.q.len();
        if course.is_still() {
            return Self { end: vec![Interval::ZERO; n], rate: vec![Interval::ZERO; n] };
        }
        let with = |value: &[Interval], rate: &[Interval]| -> Vec<Jet<Interval>> {
            value.iter().zip(rate).map(|(&value, &rate)| Jet { value, rate }).collect()
        };
        let held: Vec<Interval> = target.qdd.iter().map(|&a| Interval::point(a)).collect();
        let still = vec![Interval::ZERO; n];
        let positions = enclosed_positions(arm, &with(&span.q, &span.qd));
        let speed = with(&span.qd, &span.qdd);
        let torque = passivity_torque(arm, arm.gravity, &positions, &speed, &speed, &with(&held, &still));
        let friction = |i: usize| Interval::point(viscous.get(i).copied().unwrap_or(0.0));
        let rate = (0..n).map(|i| -(torque[i].rate + friction(i) * span.qdd[i])).collect();
        let [first, last] = ends.each_ref().map(|[q, qd]| {
            let torque = passivity_torque(arm, arm.gravity, &enclosed_positions(arm, q), qd, qd, &held);
            (0..n).map(|i| torque[i] + friction(i) * qd[i]).collect::<Vec<Interval>>()
        });
        Self { end: first.into_iter().zip(last).map(|(first, last)| first - last).collect(), rate }
    }
}
