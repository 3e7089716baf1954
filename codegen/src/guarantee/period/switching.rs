//! The switching term as a line with an error, and the friction that the command compensates.

use super::super::local::Local;
use super::super::numbers::{ROUNDED, UP};
use super::super::problem::{Magnitudes, Problem, Switching, Wrong};
use crate::numerics::linalg::weighed;

/// What a line of the switching term may add to the loop in a period, relative.
const STEEPEST: f64 = 0.5;

/// The slope of the line that stands for the switching term of each joint, N·m·s/rad, and what the term differs from it by, N·m.
pub(super) fn switched(
    problem: &Problem,
    step: &Wrong,
    local: &Local,
    x: &[f64],
    s: &[f64],
) -> (Vec<f64>, Vec<f64>) {
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
        let error = step.s[i] * if phi > 0.0 { 1.0 / phi } else { slope };
        out.0.push(if rho > 0.0 { rho * slope } else { 0.0 });
        out.1.push(UP * (rho * (off + error + ROUNDED) + spread * (share + error)));
    }
    out
}

/// Least and largest Coulomb friction that the command compensates where the desired speed is within `apart` of this.
pub(super) fn compensation([forwards, backwards]: [f64; 2], speed: f64, apart: f64) -> [f64; 2] {
    if speed > apart {
        [forwards; 2]
    } else if speed < -apart {
        [backwards; 2]
    } else if apart == 0.0 {
        [0.0; 2]
    } else {
        [backwards.min(forwards).min(0.0), forwards.max(backwards).max(0.0)]
    }
}
