//! The gain that each joint bears, shared out: W, Pqq, Ω and the layer that follow from the shares.

use super::search::{Scene, Target};
use super::settling::settling_time;
use crate::check::Tuning;

/// Share of the sampled loop's limit that gains aim at: ρ and ΔC1 are known afterwards.
const AIMED: f64 = 0.7;
/// A layer narrower than this share of what the errors make of s in the room brings nothing.
const NARROW: f64 = 0.01;
/// Ratio from one P12 that is tried to the next, and their number.
const STEP: f64 = 1.05;
const STEPS: i32 = 50;

/// How the gain that a joint bears is shared out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mix {
    /// Share of K; the rest is the slope of the layer.
    pub(super) linear: f64,
    /// Largest share of Pqq Ω⁻¹ Pqq in K.
    pub(super) stiff: f64,
    /// From 0, the same ½ q_eᵀPqq q_e at the ends of the room for all joints, to 1, Pqq in proportion to K.
    pub(super) graded: f64,
    /// Largest K_ii/d_ii, 1/s: heavy joints need not take all that they bear.
    pub(super) cap: f64,
}

/// The mix from which the search starts, and the values that it tries.
pub(super) const START: Mix = Mix { linear: 0.5, stiff: 0.25, graded: 0.5, cap: f64::INFINITY };
pub(super) const LINEAR: [f64; 4] = [0.35, 0.5, 0.65, 0.8];
pub(super) const STIFF: [f64; 4] = [0.12, 0.25, 0.4, 0.55];
pub(super) const GRADED: [f64; 3] = [0.0, 0.5, 1.0];

impl Scene<'_> {
    /// Gains with the smallest P12 = λI that is fast enough; `None` where there is none.
    pub(super) fn tuning(&self, period: f64, gain: f64, mix: Mix, rho: &[f64]) -> Option<Tuning> {
        let robust = self.stage.problem.control.law.is_robust();
        let linear = if robust { mix.linear } else { 1.0 };
        let slowest = 3.0 / self.target.time;
        let pull = (0..STEPS).map(|k| slowest * power(STEP, k)).find(|&pull| {
            let Some(kappa) = self.kappa(period, gain, pull) else { return false };
            let damping = self.linear(linear * kappa, mix);
            let pqq = self.stiffness(&damping, pull, mix);
            (0..damping.len()).all(|i| {
                settling_time(damping[i] / self.heaviest[i], pull, pqq[i] / (pull * damping[i]))
                    <= self.target.time
            })
        })?;
        let kappa = self.kappa(period, gain, pull)?;
        let damping = self.linear(linear * kappa, mix);
        let pqq = self.stiffness(&damping, pull, mix);
        let w: Vec<f64> = damping.iter().zip(&pqq).map(|(k, p)| k - p / pull).collect();
        let slope = self.borne((1.0 - linear) * kappa);
        let layer = |i: usize| (rho[i] / slope[i]).max(NARROW * pull * self.target.room[i]);
        Some(Tuning {
            w: diagonal(&w),
            omega: diagonal(&pqq.iter().map(|p| pull * p).collect::<Vec<_>>()),
            pqq: diagonal(&pqq),
            boundary_layer: robust.then(|| (0..w.len()).map(layer).collect()),
            period,
        })
    }

    /// κ, the gain on s relative to inertia, 1/s.
    fn kappa(&self, period: f64, gain: f64, pull: f64) -> Option<f64> {
        Some(gain * (2.0 * AIMED / period - pull) / self.coupling).filter(|kappa| *kappa > 0.0)
    }

    fn borne(&self, kappa: f64) -> Vec<f64> {
        self.mobility.iter().map(|m| kappa / m).collect()
    }

    fn linear(&self, kappa: f64, mix: Mix) -> Vec<f64> {
        self.borne(kappa).iter().zip(&self.heaviest).map(|(k, d)| k.min(mix.cap * d)).collect()
    }

    /// Pqq, such that Pqq Ω⁻¹ Pqq is at most the mix's share of `damping`.
    fn stiffness(&self, damping: &[f64], pull: f64, mix: Mix) -> Vec<f64> {
        let shape: Vec<f64> = (self.target.room.iter().zip(damping))
            .map(|(room, k)| libm::pow(*k, mix.graded) * libm::pow(room * room, mix.graded - 1.0))
            .collect();
        let room = shape.iter().zip(damping).map(|(s, k)| k / s).fold(f64::INFINITY, f64::min);
        shape.iter().map(|s| mix.stiff * pull * room * s).collect()
    }

    /// The shortest time for which `period` bears fast enough gains at all, s.
    pub(super) fn shortest_time(&self, period: f64) -> Option<f64> {
        let none = vec![0.0; self.mobility.len()];
        (1..200).map(|k| self.target.time * power(STEP, k)).find(|&time| {
            let target = Target { time, room: self.target.room.clone() };
            let scene = self.for_target(&target);
            STIFF.into_iter().any(|stiff| scene.tuning(period, 1.0, Mix { stiff, ..START }, &none).is_some())
        })
    }
}

/// base^k by multiplication, the same on every machine.
fn power(base: f64, k: i32) -> f64 {
    (0..k).fold(1.0, |product, _| product * base)
}

pub(super) fn diagonal(entries: &[f64]) -> Vec<Vec<f64>> {
    let n = entries.len();
    (0..n).map(|i| (0..n).map(|j| if i == j { entries[i] } else { 0.0 }).collect()).collect()
}
