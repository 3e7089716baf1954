//! Certified bounds on what a reduced model leaves out.
//!
//! Every residual α_m − α̂_m is a polynomial in sines, cosines and prismatic coordinates with known coefficients.
//! Branch and bound over boxes of position errors and time encloses it to second order with a bound on its third
//! derivatives, until the bound is close above the largest value that a search finds. What is published holds at
//! every point of the domain, rounding included.

mod ascent;
mod branch;
mod estimate;
mod polynomial;
mod recursion;
mod region;
mod residual;
mod rounding;
mod sines;
mod tensors;
#[cfg(test)]
mod tests;
mod torque;

pub use estimate::estimate;
pub use recursion::recursion;
pub use region::reach;
pub use sines::with_sines;
pub use torque::{Rates, peak_torque, torque_error};

use rayon::prelude::*;

use crate::lagrangian::{Coefficient, Entry, Lagrangian};
use crate::measure::Domain;
use crate::motion::Motion;
use crate::reduction::Reduced;
use polynomial::Polynomial;
use region::Region;
use residual::Residual;

/// A residual below this fraction of its coefficient's Σ|k_l| need not be bounded more sharply than by half.
const FLOOR: f64 = 1e-6;

/// Terms of a residual beyond which its boxes grow fewer.
pub const LONG: usize = 1000;

/// How much work a certificate may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Where bound and largest value found differ by less than this fraction, branch and bound stops.
    pub tolerance: f64,
    /// Boxes for each residual of up to [`LONG`] terms, for longer ones accordingly fewer; when they are spent, the
    /// bound found so far stands. A box that waits takes 200 bytes.
    pub boxes: usize,
    /// Starts of the search from below.
    pub starts: usize,
    /// Whether the design also seeks the smallest sufficient tube, which costs more than all its other numbers; it does
    /// so in any case where a required guarantee fails.
    pub seek_tube: bool,
}

impl Default for Effort {
    /// What generation spends.
    fn default() -> Self {
        Self { tolerance: 0.01, boxes: 100_000, starts: 12, seek_tube: false }
    }
}

impl Effort {
    /// Boxes for a residual of `terms` terms.
    fn budget(&self, terms: usize) -> usize {
        if terms > LONG { self.boxes / (2 * terms.div_ceil(LONG)) } else { self.boxes }
    }
}

/// A bound on one coefficient, and how sharp it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certificate {
    /// |α_m − α̂_m| exceeds this nowhere in the domain, evaluation in f64 included.
    pub bound: f64,
    /// The largest |α_m − α̂_m| that a search found.
    pub found: f64,
    /// The position of all joints where it found it, rad or m; empty for an exact coefficient.
    pub witness: Vec<f64>,
    /// The instant of the motion to which that position belongs, s; `None` over a workspace.
    pub time: Option<f64>,
    /// Boxes that branch and bound enclosed.
    pub boxes: usize,
    /// The part of the bound that stands for sines and cosines off by more than an ulp.
    pub sines: f64,
}

impl Certificate {
    /// bound/found; 1 for a coefficient that is not simplified.
    pub fn ratio(&self) -> f64 {
        if self.boxes == 0 || self.bound == 0.0 { 1.0 } else { self.bound / self.found }
    }
}

/// A certificate for each coefficient; zero for those that are not simplified. The same on any number of threads.
pub fn certified(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
    effort: &Effort,
) -> Vec<Certificate> {
    let reach = reach(domain, motion);
    residuals(lagrangian, reduced, domain, motion)
        .into_par_iter()
        .enumerate()
        .map(|(m, residual)| {
            let Some(residual) = residual else { return Certificate::default() };
            let region = Region::new(domain, motion, &residual.polynomial.joints);
            let size: f64 = lagrangian.coefficients[m].terms.iter().map(|(_, k)| k.abs()).sum();
            let proof = branch::maximum(&residual, &region, effort, FLOOR * size);
            let rounding = rounding::published(lagrangian, m, &reduced.combinations[m], &reach);
            let bound = (proof.upper + rounding).next_up();
            let (time, witness) = region.position(lagrangian.dof, &proof.found.x);
            Certificate { bound, found: proof.found.height, witness, time, boxes: proof.boxes, sines: 0.0 }
        })
        .collect()
}

/// The residuals of the simplified coefficients, in order; `None` for the others.
fn residuals(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
) -> Vec<Option<Residual>> {
    let reach = reach(domain, motion);
    (0..lagrangian.coefficients.len())
        .into_par_iter()
        .map(|m| {
            if !reduced.simplified[m] {
                return None;
            }
            let terms = reduced.residual(lagrangian, m);
            let polynomial = Polynomial::new(terms.iter().map(|&(l, k)| (&lagrangian.functions[l], k)));
            Some(Residual::new(polynomial, domain, motion, &reach))
        })
        .collect()
}

/// Element-by-element bounds (26)–(28) over a domain, zero where the model is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// ΔD, n×n.
    pub d: Vec<Vec<f64>>,
    /// Δh_ijk, n×n×n.
    pub h: Vec<Vec<Vec<f64>>>,
    /// ΔG, n.
    pub g: Vec<f64>,
}

impl Bounds {
    /// True where every bound is a finite number.
    pub fn is_finite(&self) -> bool {
        let h = self.h.iter().flatten();
        self.d.iter().chain(h).chain([&self.g]).flatten().all(|v| v.is_finite())
    }

    /// Spreads one bound for each coefficient over the places where it stands.
    pub fn new(lagrangian: &Lagrangian, deltas: &[f64]) -> Self {
        let n = lagrangian.dof;
        let mut out = Self { d: vec![vec![0.0; n]; n], h: vec![vec![vec![0.0; n]; n]; n], g: vec![0.0; n] };
        for (coefficient, &delta) in lagrangian.coefficients.iter().zip(deltas) {
            for place in &coefficient.places {
                match place.entry {
                    Entry::D(i, j) => {
                        out.d[i][j] = delta;
                        out.d[j][i] = delta;
                    }
                    Entry::H(i, j, k) => {
                        out.h[i][j][k] = delta;
                        out.h[i][k][j] = delta;
                    }
                    Entry::G(i) => out.g[i] = delta,
                }
            }
        }
        out
    }

    /// For each coefficient the largest bound of its places, nothing searched.
    pub fn certificates(&self, lagrangian: &Lagrangian) -> Vec<Certificate> {
        let at = |entry: Entry| match entry {
            Entry::D(i, j) => self.d[i][j].max(self.d[j][i]),
            Entry::H(i, j, k) => self.h[i][j][k],
            Entry::G(i) => self.g[i],
        };
        let largest =
            |c: &Coefficient| c.places.iter().fold(0.0, |most: f64, place| most.max(at(place.entry)));
        let certificate = |bound: f64| Certificate { bound, sines: bound, ..Certificate::default() };
        lagrangian.coefficients.iter().map(|c| certificate(largest(c))).collect()
    }

    /// Bound on |δD a_r + δC v_r + δG| by joint, N·m or N, for rates up to `rates`: every entry at its largest.
    pub fn torque(&self, rates: &Rates) -> Vec<f64> {
        let (a, v, w) = (&rates.reference_acceleration, &rates.speed, &rates.reference_speed);
        let sum = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(e, x)| e * x).sum::<f64>();
        let coriolis = |plane: &[Vec<f64>]| plane.iter().zip(w).map(|(row, w)| sum(row, v) * w).sum::<f64>();
        let torque = |i: usize| sum(&self.d[i], a) + coriolis(&self.h[i]) + self.g[i];
        (0..self.g.len()).map(|i| torque(i) * (1.0 + rounding::gamma(1024.0))).collect()
    }

    /// Equation (30): ΔC_ij = Σ_k Δh_ijk max|q̇_k|, with the largest speeds given.
    pub fn coriolis(&self, speed: &[f64]) -> Vec<Vec<f64>> {
        let row =
            |row: &Vec<Vec<f64>>| row.iter().map(|h| h.iter().zip(speed).map(|(h, v)| h * v).sum()).collect();
        self.h.iter().map(row).collect()
    }
}
