//! The largest torque over a workspace, from below: what errors are measured by, never what limits are judged by.

use super::Rates;
use crate::arm::Arm;
use crate::dynamics::{gravity, inverse_dynamics, mass_matrix};
use crate::numerics::low_discrepancy::{LowDiscrepancy, corner, in_box};
use crate::parallel::Parallelize;

/// Positions looked at, besides the corners.
const POSITIONS: usize = 1024;
/// The best of them from which a search starts, no two of them nearer than this part of the joints' ranges, and how many
/// of the searches are followed to the end.
const STARTS: usize = 12;
const APART: f64 = 0.15;
const FINALISTS: usize = 3;
/// Steps of a search as fractions of the joints' ranges: those that all starts take, and those that the best end with.
const COARSE: [f64; 2] = [0.125, 0.0625];
const FINE: [f64; 6] = [0.03125, 0.0078125, 0.001953125, 4.8828125e-4, 1.220703125e-4, 3.0517578125e-5];
/// Rounds over all joints with one step.
const ROUNDS: usize = 6;

/// Largest |τ_i| found by joint, N·m or N, without friction: over positions in `limits` and all speeds and accelerations
/// up to `rates`.
///
/// A search, whose result is attained: the true maximum may be larger, never smaller. So what is allowed as a part of this
/// peak is no larger a part of the true one.
pub fn workspace_peak_torque(arm: &Arm, limits: &[[f64; 2]], rates: &Rates) -> Vec<f64> {
    let n = arm.dof();
    let spread = LowDiscrepancy::new(n);
    let units: Vec<Vec<f64>> = (0..POSITIONS)
        .map(|index| spread.point(index))
        .chain((0..1 << n).map(|index| corner(index, n)))
        .collect();
    let torque = |unit: &[f64]| largest(arm, &in_box(limits, unit), rates);
    let seen: Vec<Vec<f64>> = units.par_iter().map(|unit| torque(unit)).collect();
    let value = |unit: &[f64], i: usize| torque(unit)[i];
    (0..n)
        .into_par_iter()
        .map(|i| {
            let starts = apart(&units, |index| seen[index][i]);
            let climb =
                |&index: &usize| climb((units[index].clone(), seen[index][i]), &COARSE, |u| value(u, i));
            let mut summits: Vec<(Vec<f64>, f64)> = starts.par_iter().map(climb).collect();
            summits.sort_by(|a, b| b.1.total_cmp(&a.1));
            summits.truncate(FINALISTS);
            let ends = summits.into_par_iter().map(|start| self::climb(start, &FINE, |u| value(u, i)).1);
            ends.collect::<Vec<f64>>().into_iter().fold(0.0, f64::max)
        })
        .collect()
}

/// The indices of the highest of `units`, none near another.
fn apart(units: &[Vec<f64>], height: impl Fn(usize) -> f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..units.len()).collect();
    order.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
    let mut chosen: Vec<usize> = Vec::new();
    for index in order {
        let near =
            |&other: &usize| units[index].iter().zip(&units[other]).all(|(a, b)| (a - b).abs() < APART);
        if !chosen.iter().any(near) {
            chosen.push(index);
        }
        if chosen.len() == STARTS {
            break;
        }
    }
    chosen
}

/// Climbs along the axes of the unit cube, with each step until it brings nothing more.
fn climb(
    (mut at, mut peak): (Vec<f64>, f64),
    steps: &[f64],
    value: impl Fn(&[f64]) -> f64,
) -> (Vec<f64>, f64) {
    for step in steps {
        for _ in 0..ROUNDS {
            let before = peak;
            for j in 0..at.len() {
                for turn in [*step, -step] {
                    let mut next = at.clone();
                    next[j] = (next[j] + turn).clamp(0.0, 1.0);
                    let there = value(&next);
                    if there > peak {
                        (at, peak) = (next, there);
                    }
                }
            }
            if peak <= before {
                break;
            }
        }
    }
    (at, peak)
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::check::prepare;

    /// Another search: random positions, and from the best of them random steps that shrink.
    fn other(arm: &Arm, limits: &[[f64; 2]], rates: &Rates, i: usize) -> f64 {
        let n = arm.dof();
        let spread = LowDiscrepancy::new(2 * n);
        let value = |unit: &[f64]| largest(arm, &in_box(limits, unit), rates)[i];
        let mut seen: Vec<(Vec<f64>, f64)> = (0..1500)
            .map(|index| {
                let unit = spread.point(7 * index + 3)[n..].to_vec();
                let height = value(&unit);
                (unit, height)
            })
            .collect();
        seen.sort_by(|a, b| b.1.total_cmp(&a.1));
        let climb = |(mut at, mut peak): (Vec<f64>, f64)| {
            let mut step = 0.3;
            for index in 0..250 {
                let u = spread.point(11 * index);
                let next: Vec<f64> =
                    at.iter().zip(&u).map(|(x, u)| (x + step * (2.0 * u - 1.0)).clamp(0.0, 1.0)).collect();
                let there = value(&next);
                if there > peak {
                    (at, peak) = (next, there);
                }
                step *= 0.98;
            }
            peak
        };
        seen.into_iter().take(8).map(climb).fold(0.0, f64::max)
    }

    #[test]
    fn another_search_finds_no_more() {
        for name in ["puma3", "stanford"] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../tests/data/{name}.json"));
            let arm = prepare(&path).expect("a sound specification").built.arm;
            let n = arm.dof();
            let rates = Rates {
                speed: vec![2.0; n],
                reference_speed: vec![2.0; n],
                reference_acceleration: vec![5.0; n],
            };
            let limits = arm.joint_box();
            let peaks = workspace_peak_torque(&arm, &limits, &rates);
            for i in 0..n.min(4) {
                let found = other(&arm, &limits, &rates, i);
                println!("{name}, joint {}: {:.6}, another search {found:.6}", i + 1, peaks[i]);
                assert!(peaks[i] >= 0.995 * found, "{name}, joint {}", i + 1);
            }
        }
    }
}
