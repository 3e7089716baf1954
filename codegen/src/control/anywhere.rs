//! The same of every motion inside a workspace and the limits of the joints, where the specification has none.

use super::DesignProblem;
use super::feedforward::{BUDGET, Family, Feedforward};
use super::reference::largest;
use crate::arm::{Arm, Uncertainty};
use crate::domain::Domain;
use crate::motion::Span;
use crate::numerics::Interval;
use crate::parallel::Parallelize;

/// What any motion inside the workspace and the limits of the joints takes; `None` elsewhere, or where a limit is missing.
pub(super) fn anywhere(problem: &DesignProblem) -> Option<Feedforward> {
    let Domain::Workspace(position) = problem.domain else { return None };
    let (own, family) = problem.given;
    let both = |most: Vec<f64>| -> Vec<[f64; 2]> { most.iter().map(|&x| [-x, x]).collect() };
    let [velocity, acceleration] = largest(problem.arm)?.map(both);
    Some(Feedforward::anywhere(own, family, [position, &velocity, &acceleration]))
}

impl Feedforward {
    /// Of the arm with its `uncertainty` along any motion whose position, speed and acceleration stay in these ranges,
    /// by joint. The acceleration may jump.
    pub(super) fn anywhere(
        arm: &Arm,
        uncertainty: &Uncertainty,
        [position, speed, acceleration]: [&[[f64; 2]]; 3],
    ) -> Self {
        let n = arm.dof();
        let alone: Vec<Arm> = (0..uncertainty.parameters.len()).map(|k| uncertainty.alone(arm, k)).collect();
        let still = vec![Interval::ZERO; n];
        let ranges = |of: &[[f64; 2]]| -> Vec<Interval> {
            of.iter().map(|&[low, high]| Interval { low, high }).collect()
        };
        let (speed, acceleration) = (ranges(speed), ranges(acceleration));
        let jump = |range: &Interval| Interval { low: range.low - range.high, high: range.high - range.low };
        let jump: Vec<Interval> = acceleration.iter().map(jump).collect();
        let budget = BUDGET / (n * (1 + alone.len()));
        let pieces = (1..=budget).take_while(|k| k.saturating_pow(n as u32) <= budget).last().unwrap_or(1);
        let family = Family { arm, uncertainty, alone };
        let bounds = |mut cell: usize| {
            let part = |[low, high]: &[f64; 2]| {
                let k = cell % pieces;
                cell /= pieces;
                let at = |k: usize| low + (high - low) * (k as f64 / pieces as f64);
                // The ends of neighbours are computed alike, and the last one is the range's own.
                Interval { low: at(k), high: if k + 1 == pieces { *high } else { at(k + 1) } }
            };
            let q: Vec<Interval> = position.iter().map(part).collect();
            let moves = Span { q, qd: speed.clone(), qdd: acceleration.clone(), jerk: still.clone() };
            let moving = family.along(&moves);
            // Without speed and acceleration the rate is D times the jerk.
            let jumps = Span { qd: still.clone(), qdd: still.clone(), jerk: jump.clone(), ..moves };
            let jumping = family.along(&jumps).into_iter().map(|jet| jet.rate);
            let known = |x: Interval| if x.magnitude().is_nan() { f64::INFINITY } else { x.magnitude() };
            let bound =
                moving.iter().map(|jet| jet.value).chain(moving.iter().map(|jet| jet.rate)).chain(jumping);
            bound.map(known).collect()
        };
        let cells: Vec<usize> = (0..pieces.pow(n as u32)).collect();
        let bounds: Vec<Vec<f64>> = cells.into_par_iter().map(bounds).collect();
        let mut most = vec![0.0_f64; 3 * n];
        for bounds in &bounds {
            most.iter_mut().zip(bounds).for_each(|(most, bound)| *most = most.max(*bound));
        }
        let [torque, rate, jump] = [0, 1, 2].map(|part| most[part * n..(part + 1) * n].to_vec());
        Self { torque, seen: vec![0.0; n], rate, jump }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::inverse_dynamics;
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use crate::simulate::example::three_link;

    #[test]
    fn a_held_torque_lags_no_more_than_any_motion_inside_the_limits_lets_it() {
        let arm = three_link();
        let position = [[-1.0, 1.0], [0.1, 0.8], [-1.6, -0.6]];
        let (speed, acceleration) =
            ([[-1.0, 1.0], [-0.8, 0.8], [-1.2, 1.2]], [[-4.0, 4.0], [-3.0, 3.0], [-5.0, 5.0]]);
        let bounds = Feedforward::anywhere(&arm, &Uncertainty::default(), [&position, &speed, &acceleration]);
        let period = 0.004;
        let (lag, spread) = (bounds.lag(period), LowDiscrepancy::new(12));
        let mut most = [vec![0.0_f64; 3], vec![0.0_f64; 3]];
        let pick = |ranges: &[[f64; 2]], x: &[f64]| -> Vec<f64> {
            ranges.iter().zip(x).map(|([low, high], x)| low + (high - low) * x).collect()
        };
        for k in 0..40_000 {
            let x: Vec<f64> =
                spread.point(k).iter().map(|x| if k % 2 == 0 { *x } else { x.round() }).collect();
            let (q, qd) = (pick(&position, &x), pick(&speed, &x[3..]));
            let (before, after) = (pick(&acceleration, &x[6..]), pick(&acceleration, &x[9..]));
            // The acceleration jumps at once, and the arm moves on for the rest of the period.
            let moved = |x: &[f64], rate: &[f64]| -> Vec<f64> {
                x.iter().zip(rate).map(|(x, rate)| x + period * rate).collect()
            };
            let (later, faster) = (moved(&q, &qd), moved(&qd, &after));
            let inside =
                |x: &[f64], ranges: &[[f64; 2]]| x.iter().zip(ranges).all(|(x, [l, h])| x >= l && x <= h);
            if !inside(&later, &position) || !inside(&faster, &speed) {
                continue;
            }
            let [held, needed] =
                [inverse_dynamics(&arm, &q, &qd, &before), inverse_dynamics(&arm, &later, &faster, &after)];
            for i in 0..3 {
                most[0][i] = most[0][i].max(held[i].abs());
                most[1][i] = most[1][i].max((needed[i] - held[i]).abs());
            }
        }
        println!("{:?} of {:?}, lag {lag:?} of {:?}", bounds.torque, most[0], most[1]);
        for i in 0..3 {
            assert!(most[0][i] <= bounds.torque[i] && bounds.torque[i] < 2.0 * most[0][i]);
            assert!(most[1][i] <= lag[i] && lag[i] < 2.0 * most[1][i]);
        }
    }
}
