//! Certified bounds on what a reduced model leaves out.
//!
//! Every residual α_m − α̂_m is a polynomial in sines, cosines and prismatic coordinates with known coefficients.
//! Branch and bound over boxes of position errors and time encloses it to second order with a bound on its third
//! derivatives, until the bound is close above the largest value that a search finds; long residuals are first
//! expanded about a few points. What is published holds at every point of the domain, rounding included.

mod ascent;
mod branch;
mod code_rounding;
mod composite;
mod effort;
mod entries;
mod envelope;
mod estimate;
mod expansion;
mod factor;
mod grid;
mod lattice;
mod model_error;
mod peak;
mod polynomial;
mod queue;
mod rates;
mod recursion;
mod region;
mod residual;
mod rounding;
mod sum;
mod taylor;
mod tensors;
#[cfg(test)]
mod tests;
mod tolerance;
mod torque;
mod torque_scale;
mod trig;
mod weighted;

pub(crate) use code_rounding::{Instant, code_rounding, largest};
pub use effort::Effort;
pub use entries::{Bounds, six_digits_up};
pub use estimate::estimate;
pub use factor::{factor, factor_bounds};
pub(crate) use model_error::ModelError;
pub use peak::workspace_peak_torque;
pub use rates::Rates;
pub use recursion::{beside_expansion, recursion, recursion_rounding, rounded_angles};
pub use region::position_bound;
pub(crate) use rounding::{
    down, percent_up, printed_above, printed_below, printed_down, printed_up, published, vanishing,
};
pub use torque::{Met, Torque, peak_torque, separate_error, torque_error, torque_exceeds};
pub(crate) use torque_scale::SCATTERED;
pub use torque_scale::TorqueScale;
pub(crate) use trig::largest_growth;
pub use trig::with_sines;

use serde::{Deserialize, Serialize};

use crate::domain::Domain;
use crate::lagrangian::{Coefficient, Combination, Lagrangian};
use crate::parallel::Parallelize;
use crate::progress::{Progress, Silent, Stage};
use crate::reduction::{Reduced, plus};
use polynomial::Polynomial;
use region::Region;
use residual::Residual;

/// A residual below this fraction of its coefficient's Σ|k_l| need not be bounded more sharply than by half.
const FLOOR: f64 = 1e-6;

/// Terms of a residual beyond which enclosing a box term by term counts for more than one box.
pub const LONG: usize = 1000;

/// A bound on one coefficient, and how sharp it is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// The part of the bound that stands for sines and cosines off by more than an ulp.
    pub sines: f64,
}

impl Certificate {
    /// bound/found; 1 for a coefficient that is not simplified.
    pub fn ratio(&self) -> f64 {
        if self.boxes == 0 || self.bound == 0.0 { 1.0 } else { self.bound / self.found }
    }
}

/// The largest bound/found of all certificates. Residuals that are negligible beside their coefficient do not count: they
/// need not be bounded sharply.
pub fn worst_ratio(lagrangian: &Lagrangian, certificates: &[Certificate]) -> f64 {
    let matters = |(certificate, coefficient): &(&Certificate, &Coefficient)| {
        certificate.bound > 2.0 * FLOOR * size(coefficient)
    };
    let pairs = certificates.iter().zip(&lagrangian.coefficients).filter(matters);
    pairs.map(|(certificate, _)| certificate.ratio()).fold(1.0, f64::max)
}

/// Σ|k_l| of a coefficient and of its derivatives by the uncertain parameters.
fn size(coefficient: &Coefficient) -> f64 {
    let terms = coefficient.terms.iter().chain(coefficient.variations.iter().flatten());
    terms.map(|(_, k)| k.abs()).sum()
}

/// A certificate for each coefficient over the domain and all uncertain parameters; zero for those that are exact. The
/// same on any number of threads.
pub fn certified(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    effort: &Effort,
) -> Vec<Certificate> {
    certified_beside(lagrangian, reduced, domain, effort, |_| None)
}

/// As [`certified`], telling `progress` of every coefficient done.
pub fn certified_telling(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    effort: &Effort,
    progress: &dyn Progress,
) -> Vec<Certificate> {
    certify(lagrangian, reduced, domain, effort, |_| None, progress)
}

/// As [`certified`], where some coefficients' certificates are known already.
pub fn certified_beside(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    effort: &Effort,
    known: impl Fn(usize) -> Option<Certificate> + Sync,
) -> Vec<Certificate> {
    certify(lagrangian, reduced, domain, effort, known, &Silent)
}

fn certify(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    effort: &Effort,
    known: impl Fn(usize) -> Option<Certificate> + Sync,
    progress: &dyn Progress,
) -> Vec<Certificate> {
    let position_bound = position_bound(domain);
    let residuals = residuals(lagrangian, reduced, domain);
    let simplified = residuals.iter().filter(|residuals| !residuals.is_empty()).count();
    let stage = Stage::new(progress, "certification of coefficients", simplified);
    residuals
        .into_par_iter()
        .enumerate()
        .map(|(m, residuals)| {
            if residuals.is_empty() {
                return Certificate::default();
            }
            let _part = stage.part();
            if let Some(certificate) = known(m) {
                return certificate;
            }
            let size = size(&lagrangian.coefficients[m]);
            let proof = branch::maximum(&residuals, domain, effort, FLOOR * size);
            let rounding = rounding::published(lagrangian, m, reduced, &position_bound);
            let bound = (proof.upper + rounding).next_up();
            let region = Region::new(domain, &residuals[proof.residual].polynomial.joints);
            let (time, witness) = region.position(lagrangian.dof, &proof.found.x);
            let parameters = vertex(&active(lagrangian, reduced, m), lagrangian, proof.residual);
            let (found, boxes) = (proof.found.height, proof.boxes);
            Certificate { bound, found, witness, time, parameters, boxes, sines: 0.0 }
        })
        .collect()
}

/// What is left out of each coefficient, in order, at every vertex of the box of the uncertain parameters on which that
/// depends; nothing for coefficients that are exact.
fn residuals(lagrangian: &Lagrangian, reduced: &Reduced, domain: &Domain) -> Vec<Vec<Residual>> {
    let position_bound = position_bound(domain);
    (0..lagrangian.coefficients.len())
        .into_par_iter()
        .map(|m| {
            let prepare = |terms: Combination| {
                let polynomial = Polynomial::new(terms.iter().map(|&(l, k)| (&lagrangian.functions[l], k)));
                Residual::new(polynomial, domain, &position_bound)
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
