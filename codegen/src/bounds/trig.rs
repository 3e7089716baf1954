//! What sines and cosines that are off by more than an ulp add to the bounds of an expanded model.
//!
//! Where sine and cosine of every q_j are off by ε at most, cos q_j + i sin q_j is off by √2 ε. The code builds cos
//! κ·q and sin κ·q as the parts of the product of |κ|₁ = Σ|κ_j| such numbers, or their conjugates, so they are off by
//! (1 + √2 ε)^|κ|₁ − 1, and α̂_m by
//!
//! S_m = Σ_l |k̂_l| sup|monomial of ψ_l| ((1 + √2 ε)^|κ_l|₁ − 1).
//!
//! A product ψ of a sparse form is a product of such parts: it is off by its own sup times (1 + √2 ε)^Σ|κ|₁ − 1, the sum
//! over its factors.
//!
//! The functions grow by the same power, and what their evaluation rounds with them: S_m (1 + γ_{64+ξ}). What a law
//! learns adds the same for every ∂α̂_m/∂u_k, times the largest |u_k|.

use super::Certificate;
use super::region::position_bound;
use super::rounding::{gamma, monomial, published};
use crate::domain::Domain;
use crate::lagrangian::{Combination, Lagrangian};
use crate::reduction::{Reduced, Sparse};
use crate::trig::Trig;

/// Adds to every certificate what `sines` can do to its coefficient in expanded form.
///
/// Coefficients that are not simplified count as exact as long as sines are as good as rounding; else they get a bound,
/// too: S_m and the roundings.
pub fn with_sines(
    mut certificates: Vec<Certificate>,
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    sines: &Trig,
) -> Vec<Certificate> {
    let position_bound = position_bound(domain);
    for (m, (certificate, terms)) in certificates.iter_mut().zip(&reduced.combinations).enumerate() {
        let grown = |terms| grown(lagrangian, terms, &position_bound, sines.beyond_ulp());
        let learnt = reduced.variations.get(m).map_or(0.0, |variations| {
            let widest = lagrangian.ranges.iter().map(|[low, high]| high.max(-low));
            variations.iter().zip(widest).map(|(terms, u)| u * grown(terms)).sum()
        });
        let own = match reduced.sparse() {
            Some(sparse) => products_grown(lagrangian, sparse, m, &position_bound, sines.beyond_ulp()),
            None => grown(terms),
        };
        let added = own + learnt;
        let bounded = certificate.bound > 0.0;
        if added == 0.0 || (!bounded && sines.rounds()) {
            continue;
        }
        let rounding = if bounded { 0.0 } else { published(lagrangian, m, reduced, &position_bound) };
        certificate.sines = (added + rounding).next_up();
        certificate.bound = (certificate.bound + certificate.sines).next_up();
    }
    certificates
}

/// By coefficient, what sines off by `beyond` more than an ulp can do to the exact α_m in expanded form.
pub fn largest_growth(lagrangian: &Lagrangian, position_bound: &[f64], beyond: f64) -> Vec<f64> {
    lagrangian.coefficients.iter().map(|c| grown(lagrangian, &c.terms, position_bound, beyond)).collect()
}

/// S_m (1 + γ_{64+ξ}), its own rounding included.
fn grown(lagrangian: &Lagrangian, terms: &Combination, position_bound: &[f64], sine: f64) -> f64 {
    let term = |&(l, k): &(usize, f64)| k.abs() * growth(lagrangian, &[l], position_bound, sine);
    let rounding = gamma(128.0 + 2.0 * terms.len() as f64);
    terms.iter().map(term).sum::<f64>() * (1.0 + rounding)
}

/// The same of a sparse form.
fn products_grown(
    lagrangian: &Lagrangian,
    sparse: &Sparse,
    m: usize,
    position_bound: &[f64],
    sine: f64,
) -> f64 {
    let terms = sparse.terms(m);
    let term = |&(f, k): &(usize, f64)| {
        k.abs() * growth(lagrangian, &sparse.functions[f].factors, position_bound, sine)
    };
    let rounding = gamma(512.0 + 2.0 * terms.len() as f64);
    terms.iter().map(term).sum::<f64>() * (1.0 + rounding)
}

/// What the product of the functions `factors` can be off by.
fn growth(lagrangian: &Lagrangian, factors: &[usize], position_bound: &[f64], sine: f64) -> f64 {
    let step = std::f64::consts::SQRT_2 * sine;
    let kappa = factors.iter().flat_map(|&l| lagrangian.functions[l].kappa);
    let turns: u32 = kappa.map(|k| u32::from(k.unsigned_abs())).sum();
    // (1 + x)^n − 1 without cancellation.
    let growth = (0..turns).fold(0.0, |e, _| e + step + e * step);
    factors.iter().fold(growth, |size, &l| size * monomial(lagrangian, l, position_bound))
}
