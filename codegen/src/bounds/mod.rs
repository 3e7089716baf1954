//! Certified bounds on what a reduced model leaves out.
//!
//! Every residual α_m − α̂_m is a polynomial in sines, cosines and prismatic coordinates with known coefficients.
//! Branch and bound over boxes of position errors and time encloses it to second order with a bound on its third
//! derivatives, until the bound is close above the largest value that a search finds; long residuals are first
//! expanded about a few points. What is published holds at every point of the domain, rounding included.

mod ascent;
mod branch;
mod composite;
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

pub use estimate::estimate;
pub use factor::{factor, factor_bounds};
pub(crate) use model_error::ModelError;
pub use peak::workspace_peak_torque;
pub use rates::Rates;
pub use recursion::{beside_expansion, recursion, recursion_rounding, rounded_angles};
pub use region::position_bound;
pub(crate) use rounding::{percent_up, printed_down, printed_up, published, vanishing};
use serde::{Deserialize, Serialize};
pub use torque::{Met, Torque, peak_torque, separate_error, torque_error, torque_exceeds};
pub(crate) use torque_scale::SCATTERED;
pub use torque_scale::TorqueScale;
pub(crate) use trig::largest_growth;
pub use trig::with_sines;

use crate::domain::Domain;
use crate::dynamics::{Size, Sizes};
use crate::lagrangian::{Coefficient, Combination, Entry, Lagrangian};
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

/// Decimal digits of published bounds.
pub const DIGITS: usize = 6;

/// How much work a certificate may take.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Where bound and largest value found differ by less than this fraction, branch and bound stops.
    pub tolerance: f64,
    /// Boxes for each residual; of those that are enclosed term by term, a residual of more than [`LONG`] terms gets
    /// accordingly fewer. When they are spent, the bound found so far stands. A box that waits takes 200 bytes.
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
        Self { tolerance: 0.01, boxes: 300_000, starts: 12, seek_tube: false }
    }
}

impl Effort {
    /// The same with another number of boxes for each residual.
    #[must_use]
    pub fn boxes(self, boxes: usize) -> Self {
        Self { boxes, ..self }
    }

    /// The same with another number of starts of the search from below.
    #[must_use]
    pub fn starts(self, starts: usize) -> Self {
        Self { starts, ..self }
    }

    /// The same, where the smallest sufficient tube is sought or not.
    #[must_use]
    pub fn seek_tube(self, seek_tube: bool) -> Self {
        Self { seek_tube, ..self }
    }
}

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

/// The largest bound/found of all certificates but those of dust: residuals that are nothing beside their coefficient
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

/// Element-by-element bounds (26)–(28) over a domain, zero where the model is exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
                out.set(place.entry, delta);
            }
        }
        out
    }

    /// Sets the bound of one entry, and of that which is equal to it by symmetry.
    fn set(&mut self, entry: Entry, delta: f64) {
        match entry {
            Entry::D(i, j) => {
                self.d[i][j] = delta;
                self.d[j][i] = delta;
            }
            Entry::H(i, j, k) => {
                self.h[i][j][k] = delta;
                self.h[i][k][j] = delta;
            }
            Entry::G(i) => self.g[i] = delta,
        }
    }

    /// Those of the certificates; ΔB = 0.
    pub fn of(lagrangian: &Lagrangian, certificates: &[Certificate]) -> Self {
        let deltas: Vec<f64> = certificates.iter().map(|certificate| certificate.bound).collect();
        Self::new(lagrangian, &deltas)
    }

    /// What `bound` makes of the size of every entry; ΔB = 0.
    pub(super) fn from_sizes(sizes: &Sizes, bound: impl Fn(Size) -> f64) -> Self {
        let row = |sizes: &Vec<Size>| -> Vec<f64> { sizes.iter().map(|&size| bound(size)).collect() };
        Self {
            d: sizes.mass_matrix.iter().map(row).collect(),
            h: sizes.christoffel.iter().map(|plane| plane.iter().map(row).collect()).collect(),
            b: vec![0.0; sizes.gravity.len()],
            g: row(&sizes.gravity),
        }
    }

    /// The sizes themselves, as bounds on what stands there; ΔB = 0.
    pub(crate) fn of_sizes(sizes: &Sizes) -> Self {
        Self::from_sizes(sizes, |size| size.exact)
    }

    /// With [`DIGITS`] digits, rounded up: what has to be read by people and stored in firmware needs no more.
    #[must_use]
    pub fn rounded_up(mut self) -> Self {
        let all = self.d.iter_mut().chain(self.h.iter_mut().flatten()).chain([&mut self.b, &mut self.g]);
        all.flatten().for_each(|bound| *bound = rounding::up(*bound, DIGITS));
        self
    }

    /// Entry by entry the sum, rounded up.
    #[must_use]
    pub fn plus(self, other: &Self) -> Self {
        self.with(other, |own, more| if more == 0.0 { own } else { (own + more).next_up() })
    }

    /// Entry by entry the larger one.
    #[must_use]
    pub(super) fn largest(self, other: &Self) -> Self {
        self.with(other, f64::max)
    }

    fn with(mut self, other: &Self, join: impl Fn(f64, f64) -> f64) -> Self {
        let own = self.d.iter_mut().chain(self.h.iter_mut().flatten()).chain([&mut self.b, &mut self.g]);
        let more = other.d.iter().chain(other.h.iter().flatten()).chain([&other.b, &other.g]);
        for (own, more) in own.zip(more) {
            own.iter_mut().zip(more).for_each(|(own, &more)| *own = join(*own, more));
        }
        self
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
