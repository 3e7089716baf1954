//! The largest torque over a workspace, from below.

use rayon::prelude::*;

use super::Rates;
use crate::arm::Arm;
use crate::dynamics::{gravity, inverse_dynamics, mass_matrix};
use crate::spread::{Spread, corner, in_box};

/// Positions looked at, besides the corners.
const POSITIONS: usize = 512;
/// Steps of the search from the best position, as fractions of the joints' ranges.
const STEPS: [f64; 5] = [0.125, 0.0625, 0.03125, 0.0078125, 0.001953125];

/// Largest |τ_i| found by joint, N·m or N, without friction: over positions in `limits` and all speeds and accelerations
/// up to `rates`. A search, whose result is attained: the true maximum may be larger, never smaller.
pub fn workspace_peak_torque(arm: &Arm, limits: &[[f64; 2]], rates: &Rates) -> Vec<f64> {
    let n = arm.dof();
    let spread = Spread::new(n);
    let units: Vec<Vec<f64>> = (0..POSITIONS)
        .map(|index| spread.point(index))
        .chain((0..1 << n).map(|index| corner(index, n)))
        .collect();
    let torque = |unit: &[f64]| largest(arm, &in_box(limits, unit), rates);
    let seen: Vec<Vec<f64>> = units.par_iter().map(|unit| torque(unit)).collect();
    (0..n)
        .into_par_iter()
        .map(|i| {
            let mut best = 0;
            for (index, peaks) in seen.iter().enumerate() {
                if peaks[i] > seen[best][i] {
                    best = index;
                }
            }
            let (mut at, mut peak) = (units[best].clone(), seen[best][i]);
            for step in STEPS {
                for j in 0..n {
                    for turn in [step, -step] {
                        let mut next = at.clone();
                        next[j] = (next[j] + turn).clamp(0.0, 1.0);
                        let there = torque(&next)[i];
                        if there > peak {
                            (at, peak) = (next, there);
                        }
                    }
                }
            }
            peak
        })
        .collect()
}

/// At one position: accelerations in the worst corner of their box, speeds in the worst of the corners of theirs.
fn largest(arm: &Arm, q: &[f64], rates: &Rates) -> Vec<f64> {
    let n = arm.dof();
    let (d, g) = (mass_matrix(arm, q), gravity(arm, q));
    let rest = vec![0.0; n];
    let mut peak: Vec<f64> = g.iter().map(|g| g.abs()).collect();
    // A turn of all speeds changes nothing.
    for signs in 0..1_usize << (n - 1) {
        let speed: Vec<f64> =
            (0..n).map(|i| if signs >> i & 1 == 1 { -rates.speed[i] } else { rates.speed[i] }).collect();
        let torque = inverse_dynamics(arm, q, &speed, &rest);
        peak.iter_mut().zip(torque).for_each(|(peak, tau)| *peak = peak.max(tau.abs()));
    }
    for i in 0..n {
        peak[i] += (0..n).map(|j| d[i][j].abs() * rates.reference_acceleration[j]).sum::<f64>();
    }
    peak
}
