//! The rounding budget: everything between a bound on a polynomial in exact arithmetic and the number that is printed.
//!
//! With u = 2⁻⁵³ and γ_k = k u/(1 − k u), a published bound is next_up(U + E + C + X), where
//!
//! - U, the largest upper bound of any cell, already holds the rounding of its own evaluation: a jet passes each
//!   term through at most 8 levels of a factor (≤ 4 roundings), a complex product (≤ 4) and a sum (≤ 5 children, at
//!   most 5 roundings), 104 in all, the enclosure sums at most 600 products of jet, tensor and widths after that.
//!   [`ENCLOSURE`] = γ_1024 of Σ|c| sup|ψ| and of its derivatives times the widths of the whole domain;
//! - E, evaluating α̂_m in generated f64 code: a sine or cosine of a joint errs by 1 ulp, building κ·q from them
//!   takes at most 4 roundings a joint and power, the sum one a term: γ_{64+ξ} Σ|k̂_l| sup|ψ_l|;
//! - C, the exact α_m as computed from the arm: the recursion behind each sample (≤ 512 roundings), the transform
//!   along each axis: γ_1024 Σ|k_l| sup|ψ_l|;
//! - X, what the expansion dropped as rounding noise: [`Lagrangian::truncation`] times the largest monomial.

use crate::lagrangian::{Combination, Lagrangian};

/// Relative rounding of one enclosure.
pub const ENCLOSURE: f64 = gamma(1024.0);

/// γ_k, the relative error of k roundings in a row.
pub const fn gamma(k: f64) -> f64 {
    let ku = k * 0.5 * f64::EPSILON;
    ku / (1.0 - ku)
}

/// E + C + X for coefficient `m` with the simplified combination `kept`, where |q_j| ≤ `reach`.
pub fn published(lagrangian: &Lagrangian, m: usize, kept: &Combination, reach: &[f64]) -> f64 {
    let size = |l: usize| monomial(lagrangian, l, reach);
    let sum = |terms: &Combination| -> f64 { terms.iter().map(|&(l, k)| k.abs() * size(l)).sum() };
    let evaluation = gamma(64.0 + kept.len() as f64) * sum(kept);
    let exact = gamma(1024.0) * sum(&lagrangian.coefficients[m].terms);
    let largest = reach.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    evaluation + exact + lagrangian.truncation * largest
}

/// sup|ψ_l|.
pub fn monomial(lagrangian: &Lagrangian, l: usize, reach: &[f64]) -> f64 {
    let power = &lagrangian.functions[l].power;
    reach.iter().zip(power).fold(1.0, |p, (&q, &e)| (0..e).fold(p, |p, _| p * q))
}
