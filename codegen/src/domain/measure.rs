//! A domain as weighted points.

use super::Domain;
use crate::arm::Arm;
use crate::motion::Motion;
use crate::numerics::low_discrepancy::{LowDiscrepancy, in_box};

/// Intervals of the desired motion; even, for Simpson's rule.
const INTERVALS: u32 = 200;
/// Position errors sampled at each instant of a tube.
const ERRORS: usize = 16;
/// Points of a workspace.
const WORKSPACE_POINTS: usize = 4096;

/// The integral ∫ of equations (2)–(7) as a weighted sum over points.
///
/// Holds: weights are not negative and sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Positions q.
    pub points: Vec<Vec<f64>>,
    /// One weight a point.
    pub weights: Vec<f64>,
    /// Mean of q̈_dj² by joint, for the weights (2).
    pub acceleration_square: Vec<f64>,
    /// Mean of (q̇_dj q̇_dk)², n×n, for the weights (2).
    pub velocity_square: Vec<Vec<f64>>,
}

impl Measure {
    /// Points for a domain; over a workspace the rates are within the joints' limits of velocity and acceleration (a joint
    /// without limits counts as limited to 1).
    pub fn new(domain: &Domain, arm: &Arm) -> Self {
        match domain {
            Domain::Workspace(limits) => Self::workspace(limits, arm),
            Domain::Tube(motion, errors) => Self::tube(motion, errors),
            Domain::Path(motion) => Self::tube(motion, &[]),
        }
    }

    /// Simpson's rule over time; at every instant [`ERRORS`] position errors spread evenly over the box, each with
    /// the same weight. An empty box gives the trajectory form.
    fn tube(motion: &Motion, errors: &[f64]) -> Self {
        let n = motion.dof();
        let copies = if errors.iter().any(|&e| e > 0.0) { ERRORS } else { 1 };
        let mut out = Self {
            points: Vec::new(),
            weights: Vec::new(),
            acceleration_square: vec![0.0; n],
            velocity_square: vec![vec![0.0; n]; n],
        };
        let spread = LowDiscrepancy::new(n);
        for k in 0..=INTERVALS {
            let target = motion.at(motion.duration() * f64::from(k) / f64::from(INTERVALS));
            let simpson = if k == 0 || k == INTERVALS { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
            let weight = simpson / (3.0 * f64::from(INTERVALS));
            for copy in 0..copies {
                let unit = spread.point(k as usize * copies + copy);
                let shift = |i: usize| errors.get(i).map_or(0.0, |e| e * (2.0 * unit[i] - 1.0));
                out.points.push(target.q.iter().enumerate().map(|(i, q)| q + shift(i)).collect());
                out.weights.push(weight / copies as f64);
            }
            for j in 0..n {
                out.acceleration_square[j] += weight * target.qdd[j] * target.qdd[j];
                for l in 0..n {
                    let product = target.qd[j] * target.qd[l];
                    out.velocity_square[j][l] += weight * product * product;
                }
            }
        }
        out
    }

    /// Evenly spread points of the joint box; velocities and accelerations uniform within their limits.
    fn workspace(limits: &[[f64; 2]], arm: &Arm) -> Self {
        let n = limits.len();
        let spread = LowDiscrepancy::new(n);
        let point = |index| in_box(limits, &spread.point(index));
        let most = |limit: fn(&crate::arm::Limits) -> Option<f64>| -> Vec<f64> {
            arm.joints.iter().map(|joint| limit(&joint.limits).unwrap_or(1.0)).collect()
        };
        let velocity = most(|limits| limits.velocity);
        let acceleration = most(|limits| limits.acceleration);
        // Means over uniform intervals: x² gives a²/3, x⁴ gives a⁴/5.
        let product = |j: usize, k: usize| {
            let squares = velocity[j] * velocity[j] * velocity[k] * velocity[k];
            if j == k { squares / 5.0 } else { squares / 9.0 }
        };
        Self {
            points: (0..WORKSPACE_POINTS).map(point).collect(),
            weights: vec![1.0 / WORKSPACE_POINTS as f64; WORKSPACE_POINTS],
            acceleration_square: acceleration.iter().map(|a| a * a / 3.0).collect(),
            velocity_square: (0..n).map(|j| (0..n).map(|k| product(j, k)).collect()).collect(),
        }
    }
}
