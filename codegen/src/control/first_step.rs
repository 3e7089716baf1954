//! The torque that the first step asks of the joints, for all initial errors that the specification allows.
//!
//! As a function of x = (q_e, q̇_e) it is enclosed by the mean value theorem: its value without errors, and its slopes over
//! the whole box of errors, from the recursion on intervals with forward derivatives.

use crate::arm::Arm;
use crate::dynamics::{Jet, enclosed_positions, passivity_torque};
use crate::motion::Target;
use crate::numerics::Interval;

use super::Gains;

/// A start: the desired state there and the box of the errors.
pub(super) struct Start<'a> {
    pub(super) target: &'a Target,
    /// |q_e| ≤ this, rad or m.
    pub(super) position: &'a [f64],
    /// |q̇_e| ≤ this, rad/s or m/s.
    pub(super) velocity: &'a [f64],
}

/// Bounds by joint, N·m or N, on |D a_r + C v_r + G + B q̇ − (K + ΔC1) s + Pqq q_e| of the arm as specified, for all errors
/// of `start`; `more` is ΔC1.
pub(super) fn asked(arm: &Arm, gains: &Gains, more: &[Vec<f64>], start: &Start) -> Vec<f64> {
    let n = arm.dof();
    let Start { position, velocity, .. } = *start;
    let still = vec![0.0; n];
    let centre = torque(arm, gains, start.target, [&still, &still], None);
    let mut most: Vec<f64> = centre.iter().map(|jet| jet.value.magnitude()).collect();
    for k in 0..2 * n {
        let width = if k < n { position[k] } else { velocity[k - n] };
        if width == 0.0 {
            continue;
        }
        let slopes = torque(arm, gains, start.target, [position, velocity], Some(k));
        for (i, (most, slope)) in most.iter_mut().zip(slopes).enumerate() {
            let total = slope.rate + feedback(gains, more, i, k);
            *most = (*most + width * total.magnitude()).next_up();
        }
    }
    most
}

/// The slope of −(K + ΔC1) s + Pqq q_e in row `i` by variable `k`.
fn feedback(gains: &Gains, more: &[Vec<f64>], i: usize, k: usize) -> Interval {
    let n = more.len();
    let damping = |j: usize| Interval::point(gains.damping[i][j]) + Interval::point(more[i][j]);
    if k >= n {
        return -damping(k - n);
    }
    let pull = |sum: Interval, j: usize| sum + damping(j) * Interval::point(gains.p12[j][k]);
    Interval::point(gains.pqq[i][k]) - (0..n).fold(Interval::ZERO, pull)
}

/// D a_r + C v_r + G + B q̇ over the box of errors, with its slope by variable `by` of (q_e, q̇_e).
fn torque(
    arm: &Arm,
    gains: &Gains,
    target: &Target,
    [position, velocity]: [&[f64]; 2],
    by: Option<usize>,
) -> Vec<Jet<Interval>> {
    let n = arm.dof();
    let seed = |k: usize| if by == Some(k) { Interval::point(1.0) } else { Interval::ZERO };
    let error = |k: usize| {
        let half = if k < n { position[k] } else { velocity[k - n] };
        Jet { value: Interval { low: -half, high: half }, rate: seed(k) }
    };
    let desired = |x: f64| Jet { value: Interval::point(x), rate: Interval::ZERO };
    let pulled = |i: usize, from: usize| {
        let term = |sum: Jet<Interval>, j: usize| sum + desired(gains.p12[i][j]) * error(from + j);
        (0..n).fold(desired(0.0), term)
    };
    let q: Vec<_> = (0..n).map(|i| desired(target.q[i]) + error(i)).collect();
    let q = enclosed_positions(arm, &q);
    let qd: Vec<_> = (0..n).map(|i| desired(target.qd[i]) + error(n + i)).collect();
    let v_r: Vec<_> = (0..n).map(|i| desired(target.qd[i]) - pulled(i, 0)).collect();
    let a_r: Vec<_> = (0..n).map(|i| desired(target.qdd[i]) - pulled(i, n)).collect();
    let model = passivity_torque(arm, arm.gravity, &q, &qd, &v_r, &a_r);
    let viscous =
        |(torque, i): (Jet<Interval>, usize)| torque + desired(arm.joints[i].viscous_friction) * qd[i];
    model.into_iter().zip(0..n).map(viscous).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{coriolis, gravity, mass_matrix};
    use crate::numerics::low_discrepancy::{LowDiscrepancy, corner};
    use crate::simulate::example::three_link;

    fn dot(row: &[f64], x: &[f64]) -> f64 {
        row.iter().zip(x).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn no_initial_error_asks_more() {
        let arm = three_link();
        let full = |diagonal: [f64; 3], side: f64| -> Vec<Vec<f64>> {
            (0..3).map(|i| (0..3).map(|j| if i == j { diagonal[i] } else { side }).collect()).collect()
        };
        let gains = Gains {
            p12: full([4.0, 5.0, 6.0], 0.5),
            damping: full([40.0, 50.0, 20.0], 1.0),
            pqq: full([9.0; 3], 0.2),
        };
        let more = full([2.0, 1.0, 0.5], 0.0);
        let target = Target { q: vec![0.2, 0.5, -1.4], qd: vec![0.4, -0.3, 0.5], qdd: vec![1.0, -0.5, 0.2] };
        let (position, velocity) = ([0.05, 0.08, 0.1], [0.1, 0.0, 0.2]);
        let start = Start { target: &target, position: &position, velocity: &velocity };
        let bound = asked(&arm, &gains, &more, &start);
        let spread = LowDiscrepancy::new(6);
        let mut seen = [0.0_f64; 3];
        for unit in (0..64).map(|index| corner(index, 6)).chain((0..5_000).map(|index| spread.point(index))) {
            let e: Vec<f64> = (0..3).map(|i| position[i] * (2.0 * unit[i] - 1.0)).collect();
            let ed: Vec<f64> = (0..3).map(|i| velocity[i] * (2.0 * unit[3 + i] - 1.0)).collect();
            let sum = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
            let times = |x: &[f64]| -> Vec<f64> { gains.p12.iter().map(|row| dot(row, x)).collect() };
            let (q, qd, s) = (sum(&target.q, &e), sum(&target.qd, &ed), sum(&ed, &times(&e)));
            let less = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
            let (v_r, a_r) = (less(&target.qd, &times(&e)), less(&target.qdd, &times(&ed)));
            let (d, c, g) = (mass_matrix(&arm, &q), coriolis(&arm, &q, &qd), gravity(&arm, &q));
            for i in 0..3 {
                let friction = arm.joints[i].viscous_friction * qd[i];
                let law = dot(&gains.pqq[i], &e) - dot(&gains.damping[i], &s) - dot(&more[i], &s);
                let tau = dot(&d[i], &a_r) + dot(&c[i], &v_r) + g[i] + friction + law;
                seen[i] = seen[i].max(tau.abs());
            }
        }
        println!("{bound:.3?} above {seen:.3?}");
        assert!(bound.iter().zip(seen).all(|(bound, seen)| *bound >= seen && *bound < 1.15 * seen));
    }
}
