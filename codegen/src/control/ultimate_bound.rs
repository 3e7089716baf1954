//! Where errors end: the filter q̇_e = −P12 q_e + s behind the energy of s alone.
//!
//! The level of V at which (17) ends charges the stiffness Pqq for everything that the layer lets pass. The kinetic part
//! V_s = ½ sᵀDs alone has V̇_s ≤ −Σ f_i(|s_i|) + c with f_i(x) = K_i x² − b_i x − ρ_i x (1 − x/φ_i)₊: b_i is the torque
//! that nothing outweighs (of a law that learns all that wrong parameters in their box do) and what Pqq pulls at the
//! errors there are, c the chatter of a held sign. So V_s ends below its largest value where Σ f_i ≤ c, each |q_e,i|
//! below |s_i|/P12_ii, and with smaller errors all of that shrinks again, down to what rounding leaves.

use nalgebra::DMatrix;

use super::error_envelope::{ClosedLoop, Envelope, Load};
use super::form::{BUDGET, TOLERANCE};
use super::inertia::{Cell, Inertia};
use super::verified::largest_eigenvalue;
use crate::error::Error;
use crate::numerics::linalg::{dense, weighed};

/// Rounds in which the errors shrink, and the relative gain below which a round was the last.
const ROUNDS: usize = 200;
const GAIN: f64 = 1e-4;
/// Multipliers that the dual of the largest V_s looks at, and the ratio of the last to the first.
const HALVINGS: usize = 60;
const WIDEST: f64 = 1e8;
/// Rounding of a level of V_s, relative.
const ROUNDING: f64 = 1e-9;

/// One joint: g x² is its share of sᵀDs at most, f(x) = K x² − b x − ρ x (1 − x/φ)₊ the power that it takes at least.
#[derive(Clone, Copy)]
struct Share {
    g: f64,
    k: f64,
    b: f64,
    rho: f64,
    phi: f64,
}

impl Share {
    /// max g x² − μ f(x) over x ≥ 0, for μ K > g.
    fn most(&self, mu: f64) -> f64 {
        let Share { g, k, b, rho, phi } = *self;
        let value = |x: f64| {
            let inside = if x < phi { rho * x * (1.0 - x / phi) } else { 0.0 };
            g * x * x - mu * (k * x * x - b * x - inside)
        };
        let outside = (mu * b / (2.0 * (mu * k - g))).max(phi);
        let bend = mu * (k + if phi > 0.0 { rho / phi } else { 0.0 }) - g;
        let inside = if phi > 0.0 { (mu * (b + rho) / (2.0 * bend)).min(phi) } else { 0.0 };
        value(outside).max(value(inside))
    }
}

/// A bound on ½ Σ g_i x_i² where Σ f_i(x_i) ≤ c: that of the dual problem, whose every multiplier gives one.
fn level(shares: &[Share], c: f64) -> f64 {
    let least = shares.iter().map(|s| s.g / s.k).fold(0.0, f64::max);
    let dual = |factor: f64| {
        let mu = least * factor;
        0.5 * (mu * c + shares.iter().map(|s| s.most(mu)).sum::<f64>())
    };
    // The dual is convex in μ, so unimodal in its logarithm.
    let (mut low, mut high) = (1.0 + 1e-6, WIDEST);
    for _ in 0..HALVINGS {
        let ratio = libm::cbrt(high / low);
        let (a, b) = (low * ratio, high / ratio);
        if dual(a) <= dual(b) { high = b } else { low = a }
    }
    dual(low).min(dual(high)) * (1.0 + ROUNDING)
}

impl ClosedLoop<'_> {
    /// |q_e| in the end by joint, rad or m: the better of the level of V and, for diagonal gains, that of V_s.
    pub(super) fn final_error(
        &self,
        inertia: &Inertia,
        over: Vec<Cell>,
        envelope: &Envelope,
        delta_c: &[Vec<f64>],
    ) -> Result<Vec<f64>, Error> {
        let (mut position, mut velocity) = self.final_errors(envelope, delta_c)?;
        let Some(shapes) = self.shapes(inertia, over) else { return Ok(position) };
        let n = position.len();
        let p12 = &self.gains.p12;
        for _ in 0..ROUNDS {
            let load = self.load(&position, &velocity, delta_c);
            let (shares, c) = self.shares(&position, &load);
            let with = |g: &Vec<f64>| {
                let shares: Vec<Share> = shares.iter().zip(g).map(|(s, &g)| Share { g, ..*s }).collect();
                level(&shares, c)
            };
            let level = shapes.iter().map(with).fold(f64::INFINITY, f64::min);
            if !level.is_finite() {
                break;
            }
            let s = |i: usize| libm::sqrt(2.0 * level * self.inertia.mobility[i]);
            let ends: Vec<f64> = (0..n).map(|i| position[i].min(s(i) / p12[i][i])).collect();
            let speeds: Vec<f64> = (0..n).map(|i| velocity[i].min(s(i) + p12[i][i] * ends[i])).collect();
            let shrinks = |new: &[f64], old: &[f64]| new.iter().zip(old).any(|(a, b)| *a < b * (1.0 - GAIN));
            let goes_on = shrinks(&ends, &position) || shrinks(&speeds, &velocity);
            (position, velocity) = (ends, speeds);
            if !goes_on {
                break;
            }
        }
        Ok(position)
    }

    /// What takes energy from each joint and what gives it, without its part in D, and the chatter.
    fn shares(&self, position: &[f64], load: &Load) -> (Vec<Share>, f64) {
        let Load { gain: rho, taught, rounding, .. } = load;
        let robust = self.law.is_robust();
        let share = |i: usize| {
            let pull = weighed(&self.gains.pqq[i], position) + self.lag[i] + rounding[i] + taught[i];
            let b = if robust { pull } else { pull + rho[i] };
            let (rho, phi) = match self.layer {
                Some(phi) if robust => (rho[i], phi[i]),
                _ => (0.0, 0.0),
            };
            Share { g: 0.0, k: self.gains.damping[i][i], b, rho, phi }
        };
        let c =
            if robust && self.layer.is_none() { self.chatter(rho) + self.switching_loss(load) } else { 0.0 };
        ((0..rho.len()).map(share).collect(), c)
    }

    /// Diagonals g with D ≼ diag(g) over the domain, in proportion to the joints' inertias and to K; `None` where the
    /// gains are not diagonal, or no such g could be certified.
    fn shapes(&self, inertia: &Inertia, over: Vec<Cell>) -> Option<[Vec<f64>; 2]> {
        let gains = self.gains;
        let n = gains.pqq.len();
        let diagonal = |m: &[Vec<f64>]| {
            (0..n).all(|i| (0..n).all(|j| i == j || m[i][j].abs() <= 1e-12 * libm::sqrt(m[i][i] * m[j][j])))
        };
        if ![&gains.p12, &gains.damping, &gains.pqq].into_iter().all(|m| diagonal(m)) {
            return None;
        }
        let inertias: Vec<f64> = self.inertia.mobility.iter().map(|m| 1.0 / m).collect();
        let damping: Vec<f64> = dense(&gains.damping).diagonal().iter().copied().collect();
        let largest = |d: &DMatrix<f64>, g: &[f64]| {
            let scaled = DMatrix::from_fn(n, n, |i, j| d[(i, j)] / libm::sqrt(g[i] * g[j]));
            largest_eigenvalue(&scaled)
        };
        let extremes = inertia.largest(over, TOLERANCE, BUDGET / (n * n), |_, high| {
            vec![largest(high, &inertias), largest(high, &damping)]
        });
        let scaled = |g: &[f64], factor: f64| g.iter().map(|g| g * factor).collect::<Vec<_>>();
        let [of_inertias, of_damping] = [extremes.bound.first()?, extremes.bound.get(1)?];
        (of_inertias.is_finite() && of_damping.is_finite())
            .then(|| [scaled(&inertias, *of_inertias), scaled(&damping, *of_damping)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    #[test]
    fn no_point_with_power_left_is_above_the_level() {
        let spread = LowDiscrepancy::new(3);
        for (shares, c) in [
            ([(1.0, 5.0, 0.2, 3.0, 0.1), (0.3, 2.0, 0.1, 1.0, 0.3), (2.0, 9.0, 0.0, 4.0, 0.05)], 0.0),
            ([(1.0, 5.0, 0.2, 0.0, 0.0), (0.3, 2.0, 0.1, 0.0, 0.0), (2.0, 9.0, 0.5, 0.0, 0.0)], 0.02),
        ] {
            let shares = shares.map(|(g, k, b, rho, phi)| Share { g, k, b, rho, phi });
            let bound = level(&shares, c);
            let mut most = 0.0_f64;
            for index in 0..400_000 {
                let x: Vec<f64> = spread.point(index).iter().map(|u| 0.8 * u).collect();
                let power = |(s, x): (&Share, &f64)| {
                    let inside = if *x < s.phi { s.rho * x * (1.0 - x / s.phi) } else { 0.0 };
                    s.k * x * x - s.b * x - inside
                };
                if shares.iter().zip(&x).map(power).sum::<f64>() <= c {
                    most = most.max(0.5 * shares.iter().zip(&x).map(|(s, x)| s.g * x * x).sum::<f64>());
                }
            }
            println!("level {bound:.5}, attained {most:.5}");
            assert!(most > 0.0 && most <= bound && bound < 1.5 * most);
        }
    }
}
