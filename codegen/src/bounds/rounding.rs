//! The rounding budget: everything between a bound on a polynomial in exact arithmetic and the number that is printed.
//!
//! With u = 2⁻⁵³ and γ_k = k u/(1 − k u), a published bound is next_up(U + E + C + X), where
//!
//! - U, the largest upper bound of any cell, already holds the rounding of its own evaluation: a jet passes each
//!   term through at most 8 levels of a factor (≤ 4 roundings), a complex product (≤ 4) and a sum (≤ 5 children, at
//!   most 5 roundings), 104 in all, the enclosure sums at most 600 products of jet, tensor and widths after that.
//!   [`ENCLOSURE`] = γ_1024 of Σ|c| sup|ψ| and of its derivatives times the widths of the whole domain.
//!   A coefficient of order a of an expansion passes each term through at most 8 levels of a factor (≤ 8 roundings),
//!   the quotient of its derivative (≤ 10), a complex product (≤ 3), a product (1) and a sum (≤ 5), 216 in all, so it
//!   errs by ENCLOSURE Σ|c| rate^a/a!; with displacements up to δ that makes ENCLOSURE Σ|c| e^{rate δ} in the value,
//!   which is added to the remainder, and accordingly in the slopes. What is enclosed from there on is the polynomial
//!   with the coefficients as computed: its jet takes at most 7 levels of a power (≤ 5 roundings) and a Horner step or
//!   a sum (≤ 12), 119 in all, under the same [`ENCLOSURE`] of its own Σ|c| |δ|^a;
//! - E, evaluating α̂_m in generated f64 code: a sine or cosine of a joint errs by 1 ulp, building κ·q from them
//!   takes at most 4 roundings a joint and power, the sum one a term: γ_{64+ξ} Σ|k̂_l| sup|ψ_l|;
//! - C, the exact α_m as computed from the arm: the transform along each axis and what is done to its terms afterwards,
//!   γ_1024 Σ|k_l| sup|ψ_l|;
//! - X, what the expansion dropped as rounding, and the rounding of the samples: [`crate::lagrangian::Accuracy::error`]
//!   times the largest monomial.
//!
//! A sparse form evaluates Σ k_f ψ_f over products ψ_f of at most three functions: it adds γ_{256+ξ} Σ|k_f| sup|ψ_f|
//! to E.
//!
//! Where the model is the recursion of a simpler arm, [`super::beside_expansion`] adds what its code, its constants and its
//! expansion err by.
//!
//! Uncertain parameters add the same three for every ∂α_m/∂u_k and ∂α̂_m/∂u_k, times the largest |u_k|.

use crate::lagrangian::{Accuracy, Combination, Entry, Lagrangian};
use crate::number::{percent, short};
use crate::reduction::Reduced;

/// Relative rounding of one enclosure.
pub const ENCLOSURE: f64 = gamma(1024.0);

/// γ_k, the relative error of k roundings in a row.
pub const fn gamma(k: f64) -> f64 {
    let ku = k * 0.5 * f64::EPSILON;
    ku / (1.0 - ku)
}

/// E + C + X for coefficient `m` of the simplified model, where |q_j| ≤ `position_bound`.
pub fn published(lagrangian: &Lagrangian, m: usize, reduced: &Reduced, position_bound: &[f64]) -> f64 {
    let size = |l: usize| monomial(lagrangian, l, position_bound);
    let sum = |terms: &Combination| -> f64 { terms.iter().map(|&(l, k)| k.abs() * size(l)).sum() };
    let largest = position_bound.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    let kept = &reduced.combinations[m];
    let evaluation = |terms: &Combination| gamma(64.0 + terms.len() as f64) * sum(terms);
    let exact = |terms: &Combination| gamma(1024.0) * sum(terms);
    let coefficient = &lagrangian.coefficients[m];
    // Products take their parameters as they are, and these may cancel where the combination's do not.
    let products = reduced.sparse().map_or(0.0, |sparse| {
        let (sum, count) = sparse.magnitude(m);
        gamma(256.0 + count as f64) * sum * largest
    });
    let recursion = reduced.simplified_arm().map_or(0.0, |simplified_arm| simplified_arm.rounding[m]);
    let own = evaluation(kept)
        + products
        + recursion
        + exact(&coefficient.terms)
        + coefficient.accuracy().error * largest;
    let varied = lagrangian.ranges.iter().enumerate().map(|(k, [low, high])| {
        let learnt = reduced.variations.get(m).map_or(0.0, |v| evaluation(&v[k]));
        let rest = exact(&coefficient.variations[k]) + coefficient.variation_error(k) * largest;
        high.max(-low) * (learnt + rest)
    });
    own + varied.sum::<f64>()
}

/// What the entries that cannot be told from zero may be, whatever the uncertain parameters, where |q_j| ≤ `position_bound`.
pub fn vanishing(lagrangian: &Lagrangian, position_bound: &[f64]) -> Vec<(Entry, f64)> {
    let largest = position_bound.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    let widest = || std::iter::once(1.0).chain(lagrangian.ranges.iter().map(|[low, high]| high.max(-low)));
    let most = |errors: &[Accuracy]| errors.iter().zip(widest()).map(|(a, u)| u * a.error).sum::<f64>();
    lagrangian.vanishing.iter().map(|(entry, errors)| (*entry, most(errors) * largest)).collect()
}

/// sup|ψ_l|.
pub fn monomial(lagrangian: &Lagrangian, l: usize, position_bound: &[f64]) -> f64 {
    let power = &lagrangian.functions[l].power;
    position_bound.iter().zip(power).fold(1.0, |p, (&q, &e)| (0..e).fold(p, |p, _| p * q))
}

/// The least decimal number of `digits` digits that is not below `x`, or `x` itself where there is none.
pub fn up(x: f64, digits: usize) -> f64 {
    let out = neighbours(x, digits).into_iter().find(|&near| near >= x);
    out.filter(|near| near.is_finite()).unwrap_or(x)
}

/// The largest decimal number of `digits` digits that is not above `x`, or `x` itself where there is none.
pub fn down(x: f64, digits: usize) -> f64 {
    neighbours(x, digits).into_iter().rev().find(|&near| near <= x).unwrap_or(x)
}

/// The decimal number of `digits` digits that is nearest to `x` ≥ 0, between the ones beside it; nothing for what is no
/// number.
fn neighbours(x: f64, digits: usize) -> Vec<f64> {
    let written = format!("{:.*e}", digits.saturating_sub(1), x);
    let Some((mantissa, exponent)) = written.split_once('e') else { return Vec::new() };
    let whole = mantissa.replace('.', "").parse::<i64>().ok();
    let shifted = exponent.parse::<i64>().ok().zip(i64::try_from(digits).ok());
    let (Some(whole), Some((exponent, digits))) = (whole, shifted) else { return Vec::new() };
    let at = |whole: i64| format!("{whole}e{}", exponent - digits + 1).parse::<f64>().ok();
    (-1..=1).filter_map(|step| at(whole + step)).collect()
}

/// `x` ≥ 0 with four digits, never below: what is printed of a bound is one, too.
pub fn printed_up(x: f64) -> String {
    short(up(x, 4))
}

/// A fraction ≥ 0 as a percentage with four digits, never below.
pub fn percent_up(fraction: f64) -> String {
    percent(up(100.0 * fraction, 4))
}

/// `x` ≥ 0 with four digits, never above.
pub fn printed_down(x: f64) -> String {
    short(down(x, 4))
}

/// `x` of any sign with four digits, never below.
pub fn printed_above(x: f64) -> String {
    if x < 0.0 { format!("-{}", printed_down(-x)) } else { printed_up(x) }
}

/// `x` of any sign with four digits, never above.
pub fn printed_below(x: f64) -> String {
    if x < 0.0 { format!("-{}", printed_up(-x)) } else { printed_down(x) }
}

#[cfg(test)]
mod tests {
    use super::{printed_above, printed_below, printed_down, printed_up, up};

    #[test]
    fn four_digits_enclose_what_they_print() {
        assert_eq!((printed_down(82.839).as_str(), printed_up(82.839).as_str()), ("82.83", "82.84"));
        assert_eq!((printed_down(0.05).as_str(), printed_up(0.05).as_str()), ("0.05000", "0.05000"));
        assert_eq!((printed_down(0.0).as_str(), printed_up(0.0).as_str()), ("0", "0"));
        assert_eq!((printed_below(-82.839).as_str(), printed_above(-82.839).as_str()), ("-82.84", "-82.83"));
        let mut x = 1e-6_f64;
        while x < 1e6 {
            let (below, above) =
                (printed_down(x).parse::<f64>().unwrap(), printed_up(x).parse::<f64>().unwrap());
            assert!(below <= x && x <= above && above - below <= 1.001e-3 * x, "{below} {x} {above}");
            x *= 1.000_73;
        }
    }

    #[test]
    fn a_few_digits_never_lie_below() {
        assert_eq!(up(0.123_456_1, 6), 0.123_457);
        assert_eq!(up(0.123_456, 6), 0.123_456);
        assert_eq!(up(9.999_999_9e-7, 6), 1e-6);
        assert_eq!(up(0.0, 6), 0.0);
        assert_eq!(up(f64::INFINITY, 6), f64::INFINITY);
        assert_eq!(up(f64::MAX, 6), f64::MAX);
        assert!(up(5e-324, 6) >= 5e-324);
        let mut x = 1e-9_f64;
        while x < 1e9 {
            let above = up(x, 6);
            assert!(above >= x && above <= x * (1.0 + 1.1e-5), "{x} {above}");
            x *= 1.000_37;
        }
    }
}
