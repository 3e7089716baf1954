//! How far errors and speeds can go under a law, equations (12)–(18) and (41)–(43).

use nalgebra::DMatrix;

use super::adaptation::Learning;
use super::gains::Gains;
use super::inertia::{Cell, Inertia};
use super::linalg::{dense, inverse, rows};
use crate::bounds::{Bounds, Rates};
use crate::error::Error;
use crate::spec::{CoriolisTermSpec, LawSpec};

/// Relative gap at which the search for extremes of D ends.
pub(super) const TOLERANCE: f64 = 0.05;
/// Vertices at which a search over a domain may look, for an arm of one joint; the cost of each grows with n².
pub(super) const BUDGET: usize = 200_000;
/// The same for the positions about the start.
const START_BUDGET: usize = 2_000;
/// Rounds in which the level of V must settle.
const ROUNDS: usize = 300;

/// What D can do over a set of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct InertiaBounds {
    /// λ_min(D) from below, kg·m².
    pub least: f64,
    /// (D⁻¹)_ii from above, 1/(kg·m²).
    pub mobility: Vec<f64>,
    /// λ_max(M⁻¹ diag(D, Pqq)) from above, s: 2V ≤ this zᵀMz.
    pub time: f64,
    /// False where the search ended early, and the numbers are only what was seen.
    pub certified: bool,
}

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
    /// The largest switching gain ρ, N·m; for law (16) what the model leaves out.
    pub(super) gain: Vec<f64>,
    /// sup|Yθ_e|, N·m: what a layer that teaches nothing leaves of the wrong parameters.
    pub(super) taught: Vec<f64>,
    /// The part of zᵀMz that the Euler steps of the learning take back.
    step: f64,
}

/// M of equation (17), inverted, with what follows from it.
pub(super) struct Form {
    inverse: DMatrix<f64>,
    root_inverse: DMatrix<f64>,
}

impl Form {
    /// `None` where rounding has cost M its definiteness: gains some fifteen powers of ten apart.
    pub(super) fn new(gains: &Gains) -> Option<Self> {
        let n = gains.pqq.len();
        let omega = dense(&gains.pqq) * dense(&gains.p12);
        let m = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => gains.damping[i][j],
            (true, false) => -gains.pqq[i][j - n],
            (false, true) => -gains.pqq[i - n][j],
            (false, false) => omega[(i - n, j - n)],
        });
        let factor = m.cholesky()?;
        let root_inverse = factor.l().try_inverse()?;
        Some(Self { inverse: factor.inverse(), root_inverse })
    }
}

/// Bounds on D over `cells`.
pub(super) fn inertia_bounds(
    inertia: &Inertia,
    cells: Vec<Cell>,
    gains: &Gains,
    form: &Form,
) -> InertiaBounds {
    let n = gains.pqq.len();
    let pqq = dense(&gains.pqq);
    let root = &form.root_inverse;
    let extremes = inertia.largest(cells, TOLERANCE, BUDGET / (n * n), |low, high| {
        let mut out = match low.clone().cholesky() {
            Some(factor) => {
                let inverse = factor.inverse();
                let top = inverse.symmetric_eigenvalues().max();
                std::iter::once(top).chain((0..n).map(|i| inverse[(i, i)])).collect()
            }
            None => vec![f64::INFINITY; n + 1],
        };
        let mut energy = DMatrix::zeros(2 * n, 2 * n);
        energy.view_mut((0, 0), (n, n)).copy_from(high);
        energy.view_mut((n, n), (n, n)).copy_from(&pqq);
        out.push((root * energy * root.transpose()).symmetric_eigenvalues().max());
        out
    });
    let certified = extremes.bound.iter().all(|b| b.is_finite());
    let values = if certified { extremes.bound } else { extremes.seen };
    InertiaBounds { least: 1.0 / values[0], mobility: values[1..=n].to_vec(), time: values[n + 1], certified }
}

/// A law at work: everything but the initial error.
pub(super) struct Course<'a> {
    pub(super) law: LawSpec,
    pub(super) term: CoriolisTermSpec,
    pub(super) gains: &'a Gains,
    pub(super) form: &'a Form,
    pub(super) bounds: &'a Bounds,
    pub(super) inertia: &'a InertiaBounds,
    /// Largest |q̇_d| and |q̈_d|.
    pub(super) speed: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    pub(super) disturbance: &'a [f64],
    pub(super) layer: Option<&'a [f64]>,
    pub(super) period: f64,
    /// Change of the feedforward torque during one period.
    pub(super) lag: Vec<f64>,
    /// What the law learns.
    pub(super) learning: Option<Learning<'a>>,
}

impl Course<'_> {
    /// Largest |q_e| and |q̇_e| below the level `v` from the errors `start`.
    ///
    /// |s_i| ≤ √(2V (D⁻¹)_ii) and |q_e,i| ≤ √(2V (Pqq⁻¹)_ii) by (12); q̇_e = −P12 q_e + s is a stable filter, so
    /// |q_e,i| ≤ max(|q_e,i(0)|, |s_i|/P12_ii) where P12 is diagonal, and the lengths stand in the same relation with
    /// λ_min(P12) where it is not.
    pub(super) fn errors(&self, v: f64, start: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let n = start.len();
        let p12 = &self.gains.p12;
        let singular = || Error::Internal("Pqq is singular after its check".to_string());
        let compliance = inverse(&self.gains.pqq).ok_or_else(singular)?;
        let diagonal = (0..n).all(|i| (0..n).all(|j| i == j || p12[i][j].abs() < 1e-12 * p12[i][i]));
        let s: Vec<f64> = self.inertia.mobility.iter().map(|m| libm::sqrt(2.0 * v * m)).collect();
        let length = |x: f64| libm::sqrt(2.0 * v / self.inertia.least) / x;
        let slowest = dense(p12).symmetric_eigenvalues().min();
        let together = libm::sqrt(start.iter().map(|e| e * e).sum()).max(length(slowest));
        let position: Vec<f64> = (0..n)
            .map(|i| {
                let level = libm::sqrt(2.0 * v * compliance[i][i]);
                level.min(if diagonal { start[i].max(s[i] / p12[i][i]) } else { together })
            })
            .collect();
        let velocity = (0..n).map(|i| s[i] + weighed(&p12[i], &position)).collect();
        Ok((position, velocity))
    }

    /// The largest rates that multiply the model while the errors stay below these, and the largest |s|.
    pub(super) fn rates(&self, position: &[f64], velocity: &[f64]) -> (Rates, Vec<f64>) {
        let n = position.len();
        let p12 = &self.gains.p12;
        let rates = Rates {
            speed: self.speed.iter().zip(velocity).map(|(d, e)| d + e).collect(),
            reference_speed: (0..n).map(|i| self.speed[i] + weighed(&p12[i], position)).collect(),
            reference_acceleration: (0..n)
                .map(|i| self.acceleration[i] + weighed(&p12[i], velocity))
                .collect(),
        };
        (rates, (0..n).map(|i| velocity[i] + weighed(&p12[i], position)).collect())
    }

    /// The load for errors up to these.
    pub(super) fn load(&self, position: &[f64], velocity: &[f64], delta_c: &[Vec<f64>]) -> Load {
        let n = position.len();
        let (rates, s) = self.rates(position, velocity);
        let Rates { speed, reference_speed: v_r, reference_acceleration: a_r } = &rates;
        let coriolis = |i: usize| match self.term {
            CoriolisTermSpec::Matrix if self.law.has_bracket() => weighed(&delta_c[i], speed),
            CoriolisTermSpec::Switching if self.law.has_bracket() => {
                weighed(&delta_c[i], speed) + weighed(&delta_c[i], &s)
            }
            _ => (0..n).map(|j| weighed(&self.bounds.h[i][j], speed) * v_r[j]).sum(),
        };
        let friction = |i: usize| self.bounds.b[i] * speed[i] + self.disturbance[i];
        let gain = (0..n)
            .map(|i| weighed(&self.bounds.d[i], a_r) + coriolis(i) + self.bounds.g[i] + friction(i))
            .collect();
        let learning = self.learning.as_ref();
        Load {
            gain,
            taught: learning.map_or(vec![0.0; n], |learning| learning.torque(&rates)),
            step: learning.map_or(0.0, |learning| {
                learning.step(&rates, |i, j| self.form.inverse[(i, j)].abs(), self.period)
            }),
        }
    }

    /// The level of V above which V̇ < 0 (for a law that learns V̇1 < 0), J.
    ///
    /// V̇ ≤ −zᵀMz + c + hᵀ|s| with c = Σρ_iφ_i/4 from the layer and h the torque that nothing outweighs: the lag of a
    /// held torque, and under law (16) the whole error of the model. So V̇ < 0 where √(zᵀMz) > x, x² = c + xη,
    /// η² = hᵀ|(M⁻¹)_ss|h, and 2V ≤ λ_max(M⁻¹ diag(D, Pqq)) zᵀMz. Where Euler steps take back a part ε of zᵀMz,
    /// (1 − ε)x² = c + xη.
    ///
    /// A joint inside its layer teaches nothing, so there s_i(Yθ_e)_i stays: with y = sup|Yθ_e|_i the layer costs
    /// max (ρ + y)|s| − ρs²/φ over |s| ≤ φ, which is φ(ρ + y)²/4ρ, or φy where y > ρ.
    pub(super) fn ball(&self, load: &Load, chatter: bool) -> f64 {
        let Load { gain, taught, step } = load;
        let mut c = 0.0;
        let mut h = self.lag.clone();
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
            (_, None) if chatter => c = self.chatter(gain),
            (_, None) => {}
        }
        let row =
            |i: usize| h.iter().enumerate().map(|(j, h)| self.form.inverse[(i, j)].abs() * h).sum::<f64>();
        let eta = libm::sqrt(h.iter().enumerate().map(|(i, h)| h * row(i)).sum::<f64>());
        let left = 1.0 - step;
        if left <= 0.0 {
            return f64::INFINITY;
        }
        let x = 0.5 * (eta + libm::sqrt(eta * eta + 4.0 * c * left)) / left;
        0.5 * self.inertia.time * x * x
    }

    /// The power that a held sign function may put into V, W: it is wrong for at most a period, in which it moves s_j
    /// by T Σ|D⁻¹|_jk 2ρ_k.
    pub(super) fn chatter(&self, gain: &[f64]) -> f64 {
        let mobility = &self.inertia.mobility;
        let sum: f64 = gain.iter().zip(mobility).map(|(rho, m)| rho * libm::sqrt(*m)).sum();
        4.0 * self.period * sum * sum
    }

    /// The level that V never leaves and what follows, with ΔC of that level; `None` where no level holds it.
    ///
    /// V1 = V + ½θ_eᵀPθθθ_e falls wherever V is outside the ball, so V ≤ V1 ≤ max(V1(0), ball + max ½θ_eᵀPθθθ_e).
    pub(super) fn settle(&self, v_max: f64, start: &[f64]) -> Result<Option<Envelope>, Error> {
        let mut level = v_max + self.learning.as_ref().map_or(0.0, |learning| learning.start);
        for _ in 0..ROUNDS {
            let (position_error, velocity_error) = self.errors(level, start)?;
            let speed: Vec<f64> = self.speed.iter().zip(&velocity_error).map(|(d, e)| d + e).collect();
            let load = self.load(&position_error, &velocity_error, &self.bounds.coriolis(&speed));
            let ball = self.ball(&load, false) + self.parameter_energy();
            if ball <= level {
                return Ok(Some(Envelope { v_max, level, position_error, velocity_error, speed }));
            }
            // A step too far ends the approach to the fixed point, and any level above it holds too.
            level = ball * (1.0 + 1e-3);
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
            let next = self.ball(&self.load(&position, &velocity, delta_c), true) + self.parameter_energy();
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

/// V_max(0): max ½ sᵀDs + ½ q_eᵀ Pqq q_e over the initial errors, J, for positions in `cell`.
pub(super) fn initial_level(
    inertia: &Inertia,
    gains: &Gains,
    cell: Cell,
    position: &[f64],
    velocity: &[f64],
) -> f64 {
    let n = position.len();
    let s: Vec<f64> = (0..n).map(|i| velocity[i] + weighed(&gains.p12[i], position)).collect();
    let elastic = largest_form(&dense(&gains.pqq), position);
    if s.iter().all(|&s| s == 0.0) {
        return elastic;
    }
    let extremes = inertia.largest(vec![cell], 1e-3, START_BUDGET, |_, high| vec![largest_form(high, &s)]);
    extremes.bound[0] + elastic
}

/// The largest λ_max(D⁻¹K), 1/s, over `cells`; infinite where K has overflowed.
pub(super) fn fastest(inertia: &Inertia, cells: Vec<Cell>, damping: &[Vec<f64>]) -> f64 {
    let Some(factor) = dense(damping).cholesky() else { return f64::INFINITY };
    let root = factor.l();
    let extremes = inertia.largest(cells, TOLERANCE, BUDGET / damping.len().pow(2), |low, _| {
        let Some(factor) = low.clone().cholesky() else { return vec![f64::INFINITY] };
        vec![(root.transpose() * factor.solve(&root)).symmetric_eigenvalues().max()]
    });
    let (bound, seen) = (extremes.bound[0], extremes.seen[0]);
    if bound.is_finite() { bound } else { seen }
}

/// K with the slope of the robust terms.
pub(super) fn total(damping: &[Vec<f64>], more: &[Vec<f64>], slope: &[f64]) -> Vec<Vec<f64>> {
    let n = slope.len();
    let mut sum = dense(damping) + dense(more);
    for i in 0..n {
        sum[(i, i)] += slope[i];
    }
    rows(&sum)
}

/// max ½ xᵀ M x over |x_i| ≤ b_i: the form is convex, so a corner attains it, and the opposite one too. The corners are
/// visited so that each differs from the one before in one sign, and the rounding that gathers on the way is added.
fn largest_form(m: &DMatrix<f64>, b: &[f64]) -> f64 {
    const GATHERED: f64 = 1e-12;
    let n = b.len();
    let mut x = b.to_vec();
    let mut rows: Vec<f64> = (0..n).map(|i| (0..n).map(|j| m[(i, j)] * x[j]).sum()).collect();
    let value = |x: &[f64], rows: &[f64]| 0.5 * x.iter().zip(rows).map(|(x, row)| x * row).sum::<f64>();
    let mut most = value(&x, &rows).max(0.0);
    for corner in 1..1_usize << n.saturating_sub(1) {
        let i = corner.trailing_zeros() as usize;
        x[i] = -x[i];
        for (j, row) in rows.iter_mut().enumerate() {
            *row += 2.0 * m[(j, i)] * x[i];
        }
        most = most.max(value(&x, &rows));
    }
    most * (1.0 + GATHERED)
}

/// Σ |a_i| b_i.
pub(super) fn weighed(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.abs() * b).sum()
}
