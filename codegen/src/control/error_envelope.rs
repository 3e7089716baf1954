//! How far errors and speeds can go under a law, equations (12)–(18) and (41)–(43).

use super::adaptation::Learning;
use super::form::{Form, InertiaBounds};
use super::gains::Gains;
use super::rounding::{Rounding, Working};
use crate::bounds::{Bounds, Rates};
use crate::error::Error;
use crate::numerics::linalg::weighed;
use crate::spec::{CoriolisTermSpec, LawSpec};

/// Rounds in which the level of V must settle.
const ROUNDS: usize = 300;

/// Largest errors and speeds by joint while V does not grow above a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// V_max(0) of equation (41), J.
    pub v_max: f64,
    /// What V stays below, J: V_max(0), or the level to which layer and held torque let it rise.
    pub level: f64,
    /// Largest |q_e|, rad or m.
    pub position_error: Vec<f64>,
    /// Largest |q̇_e|, rad/s or m/s.
    pub velocity_error: Vec<f64>,
    /// Largest |q̇| = largest |q̇_d| + largest |q̇_e|, for equation (30).
    pub speed: Vec<f64>,
}

/// What works against the law while the errors stay below some bounds.
pub(super) struct Load {
    /// The switching gain ρ that is enough, N·m or N; for law (16) what the model leaves out.
    pub(super) gain: Vec<f64>,
    /// sup|Yθ_e|, N·m: what a layer that teaches nothing leaves of the wrong parameters.
    pub(super) taught: Vec<f64>,
    /// What rounding does to the torque, N·m or N: no switching gain outweighs it.
    pub(super) rounding: Vec<f64>,
    /// The largest |s| by joint, rad/s or m/s, of which a law that switches by the sign may take the wrong one.
    pub(super) wrong_sign: Vec<f64>,
    /// The part of zᵀMz that the Euler steps of the learning take back.
    step: f64,
}

/// A constant switching gain.
pub(super) struct Fixed {
    /// ρ by joint, N·m or N.
    pub(super) rho: Vec<f64>,
    /// The largest errors for which it outweighs the model's error.
    pub(super) position_error: Vec<f64>,
    pub(super) velocity_error: Vec<f64>,
}

impl Fixed {
    /// Whether ρ is enough for errors up to these.
    fn covers(&self, position_error: &[f64], velocity_error: &[f64]) -> bool {
        let below = |x: &[f64], most: &[f64]| x.iter().zip(most).all(|(x, most)| x <= most);
        below(position_error, &self.position_error) && below(velocity_error, &self.velocity_error)
    }
}

/// A law at work: everything but the initial error.
pub(super) struct ClosedLoop<'a> {
    pub(super) law: LawSpec,
    pub(super) term: CoriolisTermSpec,
    /// Whether ρ is one number by joint: the largest that the model is off by, with no ΔC1 beside it.
    pub(super) constant: bool,
    /// That number, once it is known, with the largest |q_e| and |q̇_e| for which it is enough.
    pub(super) fixed: Option<Fixed>,
    pub(super) gains: &'a Gains,
    pub(super) form: &'a Form,
    pub(super) bounds: &'a Bounds,
    pub(super) inertia: &'a InertiaBounds,
    /// Largest |q̇_d| and |q̈_d|.
    pub(super) speed: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    pub(super) disturbance: &'a [f64],
    pub(super) rounding: &'a Rounding<'a>,
    pub(super) layer: Option<&'a [f64]>,
    pub(super) period: f64,
    /// Change of the feedforward torque during one period.
    pub(super) lag: Vec<f64>,
    /// What the law learns.
    pub(super) learning: Option<Learning<'a>>,
}

impl ClosedLoop<'_> {
    /// The envelope below the level `v` of V from the errors `start`, whether or not V stays below it.
    pub(super) fn envelope_at(&self, v: f64, start: &[f64]) -> Result<Envelope, Error> {
        let (position_error, velocity_error) = self.errors(v, start)?;
        let speed = self.speed.iter().zip(&velocity_error).map(|(d, e)| d + e).collect();
        Ok(Envelope { v_max: v, level: v, position_error, velocity_error, speed })
    }

    /// Largest |q_e| and |q̇_e| below the level `v` from the errors `start`.
    ///
    /// |s_i| ≤ √(2V (D⁻¹)_ii) and |q_e,i| ≤ √(2V (Pqq⁻¹)_ii) by (12); q̇_e = −P12 q_e + s is a stable filter, so
    /// |q_e,i| ≤ max(|q_e,i(0)|, |s_i|/P12_ii) where P12 is diagonal, and the lengths stand in the same relation with
    /// λ_min(P12) where it is not.
    pub(super) fn errors(&self, v: f64, start: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let n = start.len();
        let p12 = &self.gains.p12;
        let diagonal = (0..n).all(|i| (0..n).all(|j| i == j || p12[i][j].abs() < 1e-12 * p12[i][i]));
        let s: Vec<f64> = self.inertia.mobility.iter().map(|m| libm::sqrt(2.0 * v * m)).collect();
        let length = |x: f64| libm::sqrt(2.0 * v / self.inertia.least) / x;
        let together = libm::sqrt(start.iter().map(|e| e * e).sum()).max(length(self.form.slowest));
        let position: Vec<f64> = (0..n)
            .map(|i| {
                let level = libm::sqrt(2.0 * v * self.form.compliance[i]);
                level.min(if diagonal { start[i].max(s[i] / p12[i][i]) } else { together })
            })
            .collect();
        let velocity = (0..n).map(|i| s[i] + weighed(&p12[i], &position)).collect();
        Ok((position, velocity))
    }

    /// The largest rates that multiply the model while the errors stay below these, and the largest |s|.
    pub(super) fn rates(&self, position: &[f64], velocity: &[f64]) -> (Rates, Vec<f64>) {
        self.rates_about(&self.speed, &self.acceleration, position, velocity)
    }

    /// The same where |q̇_d| ≤ `speed` and |q̈_d| ≤ `acceleration`.
    pub(super) fn rates_about(
        &self,
        speed: &[f64],
        acceleration: &[f64],
        position: &[f64],
        velocity: &[f64],
    ) -> (Rates, Vec<f64>) {
        let n = position.len();
        let p12 = &self.gains.p12;
        let rates = Rates {
            speed: speed.iter().zip(velocity).map(|(d, e)| d + e).collect(),
            reference_speed: (0..n).map(|i| speed[i] + weighed(&p12[i], position)).collect(),
            reference_acceleration: (0..n).map(|i| acceleration[i] + weighed(&p12[i], velocity)).collect(),
        };
        (rates, (0..n).map(|i| velocity[i] + weighed(&p12[i], position)).collect())
    }

    /// The load for errors up to these.
    pub(super) fn load(&self, position: &[f64], velocity: &[f64], delta_c: &[Vec<f64>]) -> Load {
        let n = position.len();
        let (rates, s) = self.rates(position, velocity);
        let gain = self.robust_gain(&rates, &s, delta_c);
        let learning = self.learning.as_ref();
        let working = Working {
            gains: self.gains,
            period: self.period,
            rates: &rates,
            s: &s,
            position_error: position,
            robust_gain: self.switched(&gain),
        };
        Load {
            rounding: self.rounding.torque(&working),
            wrong_sign: self.rounding.wrong_sign(self.gains, &rates),
            gain,
            taught: learning.map_or(vec![0.0; n], |learning| learning.torque(&rates)),
            step: learning
                .map_or(0.0, |learning| learning.step(&rates, |i, j| self.form.inverse[(i, j)], self.period)),
        }
    }

    /// The switching gain that works where this one would be enough.
    fn switched<'b>(&'b self, enough: &'b [f64]) -> &'b [f64] {
        self.fixed.as_ref().map_or(enough, |fixed| &fixed.rho)
    }

    /// The largest switching gain ρ by joint, N·m or N, that outweighs the model's error for rates up to `rates` and |s| up to `s`.
    pub(super) fn robust_gain(&self, rates: &Rates, s: &[f64], delta_c: &[Vec<f64>]) -> Vec<f64> {
        let n = s.len();
        let Rates { speed, reference_speed: v_r, reference_acceleration: a_r } = rates;
        let coriolis = |i: usize| match self.term {
            CoriolisTermSpec::Matrix if self.law.has_bracket() => weighed(&delta_c[i], speed),
            CoriolisTermSpec::Switching if self.law.has_bracket() => {
                weighed(&delta_c[i], speed) + weighed(&delta_c[i], s)
            }
            _ => (0..n).map(|j| weighed(&self.bounds.h[i][j], speed) * v_r[j]).sum(),
        };
        let friction = |i: usize| self.bounds.b[i] * speed[i] + self.disturbance[i];
        if self.constant {
            let model = self.bounds.torque(rates);
            return (0..n).map(|i| model[i] + friction(i)).collect();
        }
        (0..n)
            .map(|i| weighed(&self.bounds.d[i], a_r) + coriolis(i) + self.bounds.g[i] + friction(i))
            .collect()
    }

    /// The level of V above which V̇ < 0 (for a law that learns V̇1 < 0), J.
    ///
    /// V̇ ≤ −zᵀMz + c + hᵀ|s| with c = Σρ_iφ_i/4 from the layer and h the torque that nothing outweighs: the lag of a
    /// held torque, rounding, and under law (16) the whole error of the model. So V̇ < 0 where √(zᵀMz) > x, x² = c + xη,
    /// η² = hᵀ|(M⁻¹)_ss|h, and 2V ≤ λ_max(M⁻¹ diag(D, Pqq)) zᵀMz. Where Euler steps take back a part ε of zᵀMz,
    /// (1 − ε)x² = c + xη.
    ///
    /// A joint inside its layer teaches nothing, so there s_i(Yθ_e)_i stays: with y = sup|Yθ_e|_i the layer costs
    /// max (ρ + y)|s| − ρs²/φ over |s| ≤ φ, which is φ(ρ + y)²/4ρ, or φy where y > ρ.
    pub(super) fn ultimate_bound(&self, load: &Load, chatter: bool) -> f64 {
        let Load { gain, taught, rounding, step, .. } = load;
        let mut c = 0.0;
        let mut h: Vec<f64> = self.lag.iter().zip(rounding).map(|(lag, more)| lag + more).collect();
        match (self.law, self.layer) {
            (LawSpec::Exact, _) => h.iter_mut().zip(gain).for_each(|(h, rho)| *h += rho),
            (_, Some(phi)) => {
                let cost = |((rho, phi), y): ((&f64, &f64), &f64)| {
                    if y > rho {
                        phi * y
                    } else if *y == 0.0 {
                        0.25 * (rho * phi)
                    } else {
                        0.25 * phi * (rho + y) * (rho + y) / rho
                    }
                };
                c = gain.iter().zip(phi).zip(taught).map(cost).sum::<f64>();
            }
            (_, None) => {
                c = self.switching_loss(load) + if chatter { self.chatter(gain) } else { 0.0 };
            }
        }
        let row = |i: usize| h.iter().enumerate().map(|(j, h)| self.form.inverse[(i, j)] * h).sum::<f64>();
        let eta = libm::sqrt(h.iter().enumerate().map(|(i, h)| h * row(i)).sum::<f64>());
        let left = 1.0 - step;
        if left <= 0.0 {
            return f64::INFINITY;
        }
        let x = 0.5 * (eta + libm::sqrt(eta * eta + 4.0 * c * left)) / left;
        0.5 * self.inertia.time * x * x
    }

    /// The power that rounding may make a sign function put into V, W: a torque of the wrong sign puts in what it should take
    /// out.
    pub(super) fn switching_loss(&self, load: &Load) -> f64 {
        self.switched(&load.gain).iter().zip(&load.wrong_sign).map(|(rho, s)| 2.0 * rho * s).sum()
    }

    /// The power that a held sign function may put into V, W: it is wrong for at most a period, in which it moves s_j
    /// by T Σ|D⁻¹|_jk 2ρ_k.
    pub(super) fn chatter(&self, gain: &[f64]) -> f64 {
        let mobility = &self.inertia.mobility;
        let sum: f64 = self.switched(gain).iter().zip(mobility).map(|(rho, m)| rho * libm::sqrt(*m)).sum();
        4.0 * self.period * sum * sum
    }

    /// The level that V never leaves and what follows, with ΔC of that level; `None` where no level holds it.
    ///
    /// V1 = V + ½θ_eᵀPθθθ_e falls wherever V is above its ultimate bound V_u, so V ≤ V1 ≤ max(V1(0), V_u + max ½θ_eᵀPθθθ_e).
    pub(super) fn invariant_level(&self, v_max: f64, start: &[f64]) -> Result<Option<Envelope>, Error> {
        let mut level = v_max + self.learning.as_ref().map_or(0.0, |learning| learning.start);
        for _ in 0..ROUNDS {
            let (position_error, velocity_error) = self.errors(level, start)?;
            if self.fixed.as_ref().is_some_and(|fixed| !fixed.covers(&position_error, &velocity_error)) {
                return Ok(None);
            }
            let speed: Vec<f64> = self.speed.iter().zip(&velocity_error).map(|(d, e)| d + e).collect();
            let load = self.load(&position_error, &velocity_error, &self.bounds.coriolis(&speed));
            let ultimate_bound = self.ultimate_bound(&load, false) + self.parameter_energy();
            if ultimate_bound <= level {
                return Ok(Some(Envelope { v_max, level, position_error, velocity_error, speed }));
            }
            // A step too far ends the approach to the fixed point, and any level above it holds too.
            level = ultimate_bound * (1.0 + 1e-3);
            if !level.is_finite() || level > 1e12 {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// max ½θ_eᵀPθθθ_e, J.
    pub(super) fn parameter_energy(&self) -> f64 {
        self.learning.as_ref().map_or(0.0, |learning| learning.energy)
    }

    /// |q_e| and |q̇_e| in the end, equation (17) with a layer: the errors of the last level of V, started from
    /// `envelope`.
    pub(super) fn final_errors(
        &self,
        envelope: &Envelope,
        delta_c: &[Vec<f64>],
    ) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let rest = vec![0.0; self.speed.len()];
        let mut v = envelope.level;
        for _ in 0..ROUNDS {
            let (position, velocity) = self.errors(v, &rest)?;
            let next = self.ultimate_bound(&self.load(&position, &velocity, delta_c), true)
                + self.parameter_energy();
            if next >= v * (1.0 - 1e-6) {
                break;
            }
            v = next;
        }
        let (position, velocity) = self.errors(v, &rest)?;
        let least = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.min(*b)).collect();
        Ok((least(&position, &envelope.position_error), least(&velocity, &envelope.velocity_error)))
    }
}
