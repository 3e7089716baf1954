//! The desired motion during one period, and what a torque that is held for it lags behind.

use super::numbers::{UP, ends, middle};
use crate::arm::Arm;
use crate::dynamics::{Jet, enclosed_positions, passivity_torque};
use crate::motion::{Motion, Span, Target};
use crate::numerics::Interval;
use crate::numerics::linear::Linear;

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
    /// About the rate of q̈_d, and a bound on what q̈_d differs from that of the start and this rate by.
    pub(super) jerk: Vec<f64>,
    pub(super) uneven: Vec<f64>,
    /// q_d and q̇_d at the start and at the end.
    ends: [[Vec<Interval>; 2]; 2],
    /// q̈_d at the start.
    acceleration: Vec<Interval>,
    /// Half the period, s, where q_d, q̇_d and q̈_d have a rate all the time: the motion does not stop in it.
    half: Option<f64>,
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
            .collect::<Vec<f64>>();
        let half = (!rests).then_some(0.5 * period);
        let jerk = |i: usize| if rests { 0.0 } else { middle(span.jerk[i]) };
        let jerk = (0..n).map(jerk).collect();
        let uneven = |i: usize| {
            let apart = (at.qdd[i] - Interval::point(target.qdd[i])).magnitude();
            if rests { late[i] } else { UP * (apart + period * ends(span.jerk[i])) }
        };
        let uneven = (0..n).map(uneven).collect();
        let last = (0..n).map(|i| still(i, &after.qd)).collect();
        let off = |range: &[Interval], x: &[f64]| -> Vec<f64> {
            range.iter().zip(x).map(|(range, &x)| (*range - Interval::point(x)).magnitude()).collect()
        };
        let mut apart = off(&at.q, &target.q);
        apart.extend(off(&at.qd, &target.qd));
        let ends = [[at.q, at.qd], [after.q, last]];
        Self { target, drift, span, apart, late, jerk, uneven, ends, acceleration: at.qdd, half }
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
        let [late, jerk, uneven] = [(); 3].map(|()| vec![0.0; n]);
        let apart = vec![0.0; 2 * n];
        let (drift, ends) = ([still.clone(), still.clone()], [state.clone(), state]);
        Self { target, drift, span, apart, late, jerk, uneven, ends, acceleration: still, half: None }
    }
}

/// What D q̈_d + n of the desired motion is at the start of a period less what it is later, with the q̈_d of the start.
#[derive(Clone, Debug)]
pub(super) struct Lag {
    /// At the end of the period, N·m or N.
    pub(super) end: Vec<Interval>,
    /// Its rate during the period, N·m/s or N/s.
    pub(super) rate: Vec<Interval>,
    /// What the rate adds from the middle of the period to its end on the line near it, and a bound on what it is off that line by.
    pub(super) turn: Vec<f64>,
    pub(super) off: Vec<f64>,
}

impl Lag {
    /// Of `arm`, whose joints have this viscous friction: none where the list is empty.
    pub(super) fn new(arm: &Arm, course: &Course, viscous: &[f64]) -> Self {
        let Course { target, span, ends, acceleration, .. } = course;
        let n = target.q.len();
        if course.is_still() {
            let (still, zero) = (vec![Interval::ZERO; n], vec![0.0; n]);
            return Self { end: still.clone(), rate: still, turn: zero.clone(), off: zero };
        }
        let over = |first: &[Interval], range: &[Interval], rate: &[Interval]| -> Vec<Linear<1>> {
            let line =
                |i: usize| course.half.map_or_else(|| wide(range[i]), |half| near(first[i], rate[i], half));
            (0..n).map(line).collect()
        };
        let [[q, qd], _] = ends;
        let q = over(q, &span.q, &span.qd);
        let qd = over(qd, &span.qd, &span.qdd);
        let qdd = over(acceleration, &span.qdd, &span.jerk);
        let with = |value: &[Linear<1>], rate: &[Linear<1>]| -> Vec<Jet<Linear<1>>> {
            value.iter().zip(rate).map(|(&value, &rate)| Jet { value, rate }).collect()
        };
        let held: Vec<Linear<1>> = target.qdd.iter().map(|&a| Linear::point(a)).collect();
        let still = vec![Linear::point(0.0); n];
        let positions = enclosed_positions(arm, &with(&q, &qd));
        let speed = with(&qd, &qdd);
        let torque = passivity_torque(arm, arm.gravity, &positions, &speed, &speed, &with(&held, &still));
        let friction = |i: usize| viscous.get(i).copied().unwrap_or(0.0);
        let rate = |i: usize| -(torque[i].rate + Linear::point(friction(i)) * qdd[i]);
        let rate: Vec<Linear<1>> = (0..n).map(rate).collect();
        Self {
            end: lagged(arm, course, &friction),
            turn: rate.iter().map(|rate| rate.slopes[0]).collect(),
            off: rate.iter().map(|rate| UP * (rate.rest + rate.rounding)).collect(),
            rate: rate
                .iter()
                .map(|rate| Interval::about(rate.centre, UP * (rate.spread() + rate.rest + rate.rounding)))
                .collect(),
        }
    }
}

/// D q̈_d + n at the start of the period less that at its end, with the q̈_d of the start.
fn lagged(arm: &Arm, course: &Course, friction: &dyn Fn(usize) -> f64) -> Vec<Interval> {
    let n = course.target.q.len();
    let held: Vec<Interval> = course.target.qdd.iter().map(|&a| Interval::point(a)).collect();
    let [first, last] = course.ends.each_ref().map(|[q, qd]| {
        let torque = passivity_torque(arm, arm.gravity, &enclosed_positions(arm, q), qd, qd, &held);
        (0..n).map(|i| torque[i] + Interval::point(friction(i)) * qd[i]).collect::<Vec<Interval>>()
    });
    first.into_iter().zip(last).map(|(first, last)| first - last).collect()
}

/// A number of `range`.
fn wide(range: Interval) -> Linear<1> {
    Linear::point(middle(range)).about(ends(range))
}

/// What is `first` at the start of a period and has a rate of `rate`, near a line: the unknown goes from −1 at the start to 1 at the end,
/// `half` s before and after the middle.
fn near(first: Interval, rate: Interval, half: f64) -> Linear<1> {
    let (start, rise) = (middle(first), half * middle(rate));
    let rounded = 4.0 * f64::EPSILON * (start.abs() + rise.abs());
    Linear::unknown(start + rise, 0, rise).about(UP * (ends(first) + 2.0 * half * ends(rate) + rounded))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::inverse_dynamics;
    use crate::simulate::example::three_link;

    /// The lag by the recursion, from the motion's own values at many instants.
    #[test]
    fn the_lag_is_near_its_line_and_its_mean_is_known() {
        let (arm, period) = (three_link(), 0.01);
        let motion = Motion::Quintic { from: vec![0.1, -0.4, 0.8], to: vec![1.3, 0.9, -0.7], duration: 0.7 };
        let (mut near, mut far) = (0.0, 0.0);
        for k in [0, 7, 23, 34, 51, 68] {
            let time = f64::from(k) * period;
            let course = Course::new(&motion, time, period, 0.0);
            let lag = Lag::new(&arm, &course, &[]);
            let nominal = |t: f64| {
                let at = motion.at(time + t);
                inverse_dynamics(&arm, &at.q, &at.qd, &course.target.qdd)
            };
            let (steps, first) = (200, nominal(0.0));
            let at = |j: i32| period * f64::from(j) / f64::from(steps);
            let values: Vec<Vec<f64>> = (0..=steps).map(|j| nominal(at(j))).collect();
            for i in 0..3 {
                let lagged = |j: i32| first[i] - values[j as usize][i];
                // Simpson's rule.
                let weight = |j: i32| if j == 0 || j == steps { 1.0 } else { f64::from(2 + 2 * (j % 2)) };
                let mean = (0..=steps).map(|j| weight(j) * lagged(j)).sum::<f64>() / f64::from(3 * steps);
                let end = 0.5 * (lag.end[i].low + lag.end[i].high);
                assert!((lagged(steps) - end).abs() <= ends(lag.end[i]) + 1e-12, "{k} {i}");
                let known = 0.5 * end - period / 6.0 * lag.turn[i];
                assert!((mean - known).abs() <= 0.25 * period * lag.off[i] + 1e-11, "{k} {i} {mean} {known}");
                (near, far) = (near + (mean - known).abs(), far + (mean - 0.5 * end).abs());
                for j in 0..steps {
                    let rate = (lagged(j + 1) - lagged(j)) / (period / f64::from(steps));
                    let time = (f64::from(2 * j + 1) / f64::from(steps)) - 1.0;
                    let line = middle(lag.rate[i]) + lag.turn[i] * time;
                    assert!((rate - line).abs() <= lag.off[i] + 1e-6, "{k} {i} {j} {rate} {line}");
                    assert!(lag.rate[i].low - 1e-6 <= rate && rate <= lag.rate[i].high + 1e-6);
                }
            }
        }
        // The line is worth having.
        assert!(near < 0.2 * far, "{near} {far}");
    }
}
