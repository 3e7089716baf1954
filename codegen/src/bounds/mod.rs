//! Certified bounds on what a reduced model leaves out.
//!
//! Every residual α_m − α̂_m is a polynomial in sines, cosines and prismatic coordinates with known coefficients.
//! Branch and bound over boxes of position errors and time encloses it to second order with a bound on its third
//! derivatives, until the bound is close above the largest value that a search finds. What is published holds at
//! every point of the domain, rounding included.

mod ascent;
mod branch;
mod estimate;
mod factor;
mod polynomial;
mod region;
mod residual;
mod rounding;
mod tensors;
#[cfg(test)]
mod tests;
mod torque;

pub use estimate::estimate;
pub use factor::{factor, factor_bounds};
pub use torque::{Rates, largest_torque, peak_torque, torque_error};

use rayon::prelude::*;

use crate::lagrangian::{Combination, Entry, Lagrangian};
use crate::measure::Domain;
use crate::motion::Motion;
use crate::reduction::{Reduced, plus};
use polynomial::Polynomial;
use region::{Region, reach};
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
    /// The uncertain parameters there, counted from the arm's own.
    pub parameters: Vec<f64>,
    /// Boxes that branch and bound enclosed.
    pub boxes: usize,
}

impl Certificate {
    /// bound/found; 1 for an exact coefficient.
    pub fn ratio(&self) -> f64 {
        if self.bound == 0.0 { 1.0 } else { self.bound / self.found }
    }
}

/// A certificate for each coefficient over the domain and all uncertain parameters; zero for those that are exact. The
/// same on any number of threads.
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
        .map(|(m, residuals)| {
            let coefficient = &lagrangian.coefficients[m];
            let terms = coefficient.terms.iter().chain(coefficient.variations.iter().flatten());
            let size: f64 = terms.map(|(_, k)| k.abs()).sum();
            let prove = |residual: &Residual| {
                let region = Region::new(domain, motion, &residual.polynomial.joints);
                let proof = branch::maximum(residual, &region, effort, FLOOR * size);
                let (time, witness) = region.position(lagrangian.dof, &proof.found.x);
                (proof, time, witness)
            };
            let proofs: Vec<_> = residuals.iter().map(prove).collect();
            let Some(upper) = proofs.iter().map(|(proof, ..)| proof.upper).reduce(f64::max) else {
                return Certificate::default();
            };
            let boxes = proofs.iter().map(|(proof, ..)| proof.boxes).sum();
            let rounding = rounding::published(lagrangian, m, reduced, &reach);
            let bound = (upper + rounding).next_up();
            let best = proofs.into_iter().enumerate().reduce(|best, other| {
                if other.1.0.found.height > best.1.0.found.height { other } else { best }
            });
            let Some((index, (proof, time, witness))) = best else { return Certificate::default() };
            let parameters = vertex(&active(lagrangian, reduced, m), lagrangian, index);
            Certificate { bound, found: proof.found.height, witness, time, parameters, boxes }
        })
        .collect()
}

/// What is left out of each coefficient, in order, at every vertex of the box of the uncertain parameters on which that
/// depends; nothing for coefficients that are exact.
fn residuals(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
) -> Vec<Vec<Residual>> {
    let reach = reach(domain, motion);
    (0..lagrangian.coefficients.len())
        .into_par_iter()
        .map(|m| {
            let prepare = |terms: Combination| {
                let polynomial = Polynomial::new(terms.iter().map(|&(l, k)| (&lagrangian.functions[l], k)));
                Residual::new(polynomial, domain, motion, &reach)
            };
            at_vertices(lagrangian, reduced, m).into_iter().map(prepare).collect()
        })
        .collect()
}

/// α_m − α̂_m at the vertices of the box of the uncertain parameters on which it depends. As it is affine in these, its
/// largest absolute value over the box stands at one of them, whatever q.
pub fn at_vertices(lagrangian: &Lagrangian, reduced: &Reduced, m: usize) -> Vec<Combination> {
    let active = active(lagrangian, reduced, m);
    if !reduced.simplified[m] && active.is_empty() {
        return Vec::new();
    }
    let own = reduced.residual(lagrangian, m);
    (0..1_usize << active.len())
        .map(|index| {
            let u = vertex(&active, lagrangian, index);
            active
                .iter()
                .fold(own.clone(), |sum, &k| plus(&sum, u[k], &reduced.residual_variation(lagrangian, m, k)))
        })
        .collect()
}

/// The uncertain parameters on which α_m − α̂_m depends.
fn active(lagrangian: &Lagrangian, reduced: &Reduced, m: usize) -> Vec<usize> {
    let varies = |&k: &usize| {
        let [low, high] = lagrangian.ranges[k];
        low < high && !reduced.residual_variation(lagrangian, m, k).is_empty()
    };
    (0..lagrangian.ranges.len()).filter(varies).collect()
}

/// Vertex number `index` of the box of the `active` parameters; the others stay at 0.
fn vertex(active: &[usize], lagrangian: &Lagrangian, index: usize) -> Vec<f64> {
    let mut u = vec![0.0; lagrangian.ranges.len()];
    for (bit, &k) in active.iter().enumerate() {
        u[k] = lagrangian.ranges[k][index >> bit & 1];
    }
    u
}

/// Element-by-element bounds (26)–(28) over a domain, zero where the model is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// ΔD, n×n.
    pub d: Vec<Vec<f64>>,
    /// Δh_ijk, n×n×n.
    pub h: Vec<Vec<Vec<f64>>>,
    /// ΔB of the diagonal viscous friction, n.
    pub b: Vec<f64>,
    /// ΔG, n.
    pub g: Vec<f64>,
}

impl Bounds {
    /// True where every bound is a finite number.
    pub fn is_finite(&self) -> bool {
        let h = self.h.iter().flatten();
        self.d.iter().chain(h).chain([&self.b, &self.g]).flatten().all(|v| v.is_finite())
    }

    /// Spreads one bound for each coefficient over the places where it stands; ΔB = 0.
    pub fn new(lagrangian: &Lagrangian, deltas: &[f64]) -> Self {
        let n = lagrangian.dof;
        let zero = vec![0.0; n];
        let mut out =
            Self { d: vec![zero.clone(); n], h: vec![vec![zero.clone(); n]; n], b: zero.clone(), g: zero };
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

    /// Equation (30): ΔC_ij = Σ_k Δh_ijk max|q̇_k|, with the largest speeds given.
    pub fn coriolis(&self, speed: &[f64]) -> Vec<Vec<f64>> {
        let row =
            |row: &Vec<Vec<f64>>| row.iter().map(|h| h.iter().zip(speed).map(|(h, v)| h * v).sum()).collect();
        self.h.iter().map(row).collect()
    }
}
