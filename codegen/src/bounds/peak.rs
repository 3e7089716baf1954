//! The largest torque over a workspace, from below: what errors are measured by, never what limits are judged by.

use super::Rates;
use super::composite::{Composite, apart};
use crate::arm::Arm;
use crate::dynamics::{gravity, inverse_dynamics, mass_matrix, passivity_torque, positions};
use crate::lagrangian::MAX_JOINTS;
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
    let corners = Corners::new(arm, limits, rates);
    let seen: Vec<Vec<f64>> = units.par_iter().map(|unit| corners.all(&in_box(limits, unit))).collect();
    let higher = |unit: &[f64], i: usize, than: f64| corners.above(&in_box(limits, unit), i, than);
    (0..n)
        .into_par_iter()
        .map(|i| {
            let starts = scattered(&units, |index| seen[index][i]);
            let higher = |unit: &[f64], than: f64| higher(unit, i, than);
            let climb = |&index: &usize| climb((units[index].clone(), seen[index][i]), &COARSE, higher);
            let mut summits: Vec<(Vec<f64>, f64)> = starts.par_iter().map(climb).collect();
            summits.sort_by(|a, b| b.1.total_cmp(&a.1));
            summits.truncate(FINALISTS);
            let ends = summits.into_par_iter().map(|start| self::climb(start, &FINE, higher).1);
            ends.collect::<Vec<f64>>().into_iter().fold(0.0, f64::max)
        })
        .collect()
}

/// The indices of the highest of `units`, none near another.
fn scattered(units: &[Vec<f64>], height: impl Fn(usize) -> f64) -> Vec<usize> {
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

/// Climbs along the axes of the unit cube, with each step until it brings nothing more; `higher` gives the height of a place
/// that is higher than where it stands.
fn climb(
    (mut at, mut peak): (Vec<f64>, f64),
    steps: &[f64],
    higher: impl Fn(&[f64], f64) -> Option<f64>,
) -> (Vec<f64>, f64) {
    for step in steps {
        for _ in 0..ROUNDS {
            let before = peak;
            for j in 0..at.len() {
                for turn in [*step, -step] {
                    let mut next = at.clone();
                    next[j] = (next[j] + turn).clamp(0.0, 1.0);
                    if let Some(there) = higher(&next, peak) {
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

/// The largest torques at one position: accelerations in the worst corner of their box, speeds in the worst of the corners
/// of theirs.
struct Corners<'a> {
    arm: &'a Arm,
    rates: &'a Rates,
    /// How far what tells corners from one another may be off, by joint.
    apart: Vec<f64>,
}

/// |τ_i| at the corners of the box of speeds, without rounding as the recursion does.
struct Estimate {
    /// By corner: bit j says that joint j turns backwards; the last one never does, as a turn of all speeds changes nothing.
    torque: Vec<f64>,
    /// The largest of them.
    largest: f64,
    /// The largest |τ_i| at any speeds and accelerations.
    peak: f64,
}

impl<'a> Corners<'a> {
    fn new(arm: &'a Arm, limits: &[[f64; 2]], rates: &'a Rates) -> Self {
        let reach: Vec<f64> = limits.iter().map(|[low, high]| high.abs().max(low.abs())).collect();
        let speeds: f64 = rates.speed.iter().sum();
        let rises: f64 = rates.reference_acceleration.iter().sum();
        let pull: f64 = arm.gravity.iter().map(|g| g.abs()).sum();
        let unit = 3.0 * speeds * speeds + rises + pull;
        Self { arm, rates, apart: apart(arm, &reach).into_iter().map(|apart| unit * apart).collect() }
    }

    /// Of every joint.
    fn all(&self, q: &[f64]) -> Vec<f64> {
        let n = self.arm.dof();
        let Some(there) = self.composite(q) else { return largest(self.arm, q, self.rates) };
        let mut wanted = vec![false; 1 << (n - 1)];
        for i in 0..n {
            self.estimate(&there, i).near(self.apart[i]).for_each(|corner| wanted[corner] = true);
        }
        let at = positions(self.arm, q);
        let mut peak: Vec<f64> = gravity(self.arm, q).iter().map(|g| g.abs()).collect();
        for (corner, _) in wanted.iter().enumerate().filter(|(_, wanted)| **wanted) {
            let torque = self.torque(&at, corner);
            peak.iter_mut().zip(torque).for_each(|(peak, tau)| *peak = peak.max(tau.abs()));
        }
        accelerated(&mut peak, &mass_matrix(self.arm, q), self.rates);
        peak
    }

    /// Of joint i, where that is more than `peak`.
    fn above(&self, q: &[f64], i: usize, peak: f64) -> Option<f64> {
        let Some(there) = self.composite(q) else {
            return Some(largest(self.arm, q, self.rates)[i]).filter(|found| *found > peak);
        };
        let estimate = self.estimate(&there, i);
        if estimate.peak + 2.0 * self.apart[i] <= peak {
            return None;
        }
        let at = positions(self.arm, q);
        let still = gravity(self.arm, q)[i].abs();
        let torque = |corner: usize| self.torque(&at, corner)[i].abs();
        let mut found = vec![estimate.near(self.apart[i]).map(torque).fold(still, f64::max)];
        accelerated(&mut found, &mass_matrix(self.arm, q)[i..=i], self.rates);
        found.first().copied().filter(|found| *found > peak)
    }

    /// `None` where joints follow others.
    fn composite(&self, q: &[f64]) -> Option<Composite> {
        self.arm.linkage.is_none().then(|| Composite::new(self.arm, q))
    }

    /// τ of the recursion.
    fn torque(&self, at: &[crate::dynamics::Position<f64>], corner: usize) -> Vec<f64> {
        let speed = speeds(corner, &self.rates.speed);
        passivity_torque(self.arm, self.arm.gravity, at, &speed, &speed, &vec![0.0; speed.len()])
    }

    fn estimate(&self, there: &Composite, i: usize) -> Estimate {
        let n = self.arm.dof();
        let speed = &self.rates.speed;
        let (g, d, c) = there.row(i);
        // What goes with the speeds of two joints together, and the sum of all that does with those of one joint.
        let mut pairs = [[0.0; MAX_JOINTS]; MAX_JOINTS];
        let mut sum = g;
        for k in 0..n {
            sum += c[k][k] * speed[k] * speed[k];
            for j in 0..k {
                pairs[j][k] = c[j][k] * speed[j] * speed[k];
                pairs[k][j] = pairs[j][k];
                sum += pairs[j][k];
            }
        }
        let mut sign = [1.0; MAX_JOINTS];
        let mut along = pairs.map(|row| row.iter().sum::<f64>());
        let mut torque = vec![0.0; 1 << (n - 1)];
        torque[0] = f64::abs(sum);
        let mut corner = 0;
        // One joint after the other turns round, so that every corner is come to once.
        for step in 1..torque.len() {
            let j = step.trailing_zeros() as usize;
            sum -= 2.0 * sign[j] * along[j];
            sign[j] = -sign[j];
            for (along, pair) in along.iter_mut().zip(&pairs[j]) {
                *along += 2.0 * sign[j] * pair;
            }
            corner ^= 1 << j;
            torque[corner] = sum.abs();
        }
        let largest = torque.iter().fold(0.0, |most: f64, &tau| most.max(tau));
        let rises: f64 = d.iter().zip(&self.rates.reference_acceleration).map(|(d, a)| d.abs() * a).sum();
        Estimate { peak: largest.max(g.abs()) + rises, largest, torque }
    }
}

impl Estimate {
    /// The corners that may be the worst.
    fn near(&self, apart: f64) -> impl Iterator<Item = usize> {
        let least = self.largest - 2.0 * apart;
        // Where speeds overflow nothing is known of any corner.
        let far = move |torque: f64| torque < least;
        (0..self.torque.len()).filter(move |&corner| !far(self.torque[corner]))
    }
}

/// All corners by the recursion.
fn largest(arm: &Arm, q: &[f64], rates: &Rates) -> Vec<f64> {
    let rest = vec![0.0; arm.dof()];
    let mut peak: Vec<f64> = gravity(arm, q).iter().map(|g| g.abs()).collect();
    for corner in 0..1_usize << (arm.dof() - 1) {
        let torque = inverse_dynamics(arm, q, &speeds(corner, &rates.speed), &rest);
        peak.iter_mut().zip(torque).for_each(|(peak, tau)| *peak = peak.max(tau.abs()));
    }
    accelerated(&mut peak, &mass_matrix(arm, q), rates);
    peak
}

/// The speeds at a corner.
fn speeds(corner: usize, most: &[f64]) -> Vec<f64> {
    most.iter().enumerate().map(|(j, &speed)| if corner >> j & 1 == 1 { -speed } else { speed }).collect()
}

/// Adds what accelerations take at most, given the rows of D.
fn accelerated(peak: &mut [f64], d: &[Vec<f64>], rates: &Rates) {
    for (peak, row) in peak.iter_mut().zip(d) {
        *peak += row.iter().zip(&rates.reference_acceleration).map(|(d, a)| d.abs() * a).sum::<f64>();
    }
}

#[cfg(test)]
mod tests;
