//! Sine and cosine by argument reduction and polynomials.
//!
//! The angle is x = k·π/2 + r with k the integer nearest to 2x/π, so that |r| ≤ π/4. π/2 is held in two parts: P₁ so
//! short that k P₁ and x − k P₁ are exact, and P₂ = π/2 − P₁ (Cody and Waite). With y = (x − k P₁) − k P₂ and z = y²,
//!
//! ```text
//! sin y ≈ y + y z S(z)      cos y ≈ 1 + z C(z)
//! ```
//!
//! where S and C make the largest error on |y| ≤ π/4 least (Remez, each coefficient rounded before the next is
//! fitted); k mod 4 says which of ±sin y and ±cos y is wanted. Multiplications and additions alone, in a fixed order.
//!
//! # Error in f64: below 1.8·10⁻¹⁶ for |x| ≤ 2²⁰ rad
//!
//! With u = 2⁻⁵³; a number below 1 rounds by u/2, one below ½ by u/4.
//!
//! - *Reduction.* |k| ≤ 667 545 < 2²⁰ and P₁ has 33 bits, so k P₁ is exact. For k ≠ 0 both x and k P₁ are multiples
//!   of 2⁻⁵³ and differ by less than 1: that difference is exact, too. 2x/π is off by 2u|k| before it is rounded to
//!   k, so |r| < π/4 + 3·10⁻¹⁰, which the polynomials were fitted for. P₁ + P₂ is π/2 within 3.6·10⁻²⁷, which costs k
//!   times that, and k P₂ < 2⁻¹⁴ rounds by 2⁻⁶⁸: 10⁻²⁰ together. What remains is the rounding of y itself, u/2, or
//!   u/4 for |y| < ½.
//! - *Truncation.* sin y and cos y differ from the polynomials with the coefficients as rounded by at most 1.6·10⁻¹⁸
//!   and 5·10⁻²⁰ (20 001 points in 60 digits).
//! - *Sine.* y z S(z) ≤ 0.0784 has a relative error of 3.9u (z, y z, the last sum of S, the product): 0.31u. At |y| ≥
//!   π/6 the sum with y rounds by u/2 and the error of y counts with cos y ≤ 0.867, 0.44u: together 1.25u. Below π/6
//!   the sum rounds by u/4 and y z S(z) is below 0.024: 0.8u.
//! - *Cosine.* C(z) within [−½, −0.474] is off by u/4 and 0.08u from what is below it, times z < 0.618: 0.21u. z <
//!   0.618 rounds by u/2, times |C|: 0.24u. z C(z) < 0.294 rounds by u/4, the sum with 1 by u/2, and the error of y
//!   counts with sin y ≤ 0.708: 0.36u. Together 1.56u.
//!
//! 1.57u = 1.75·10⁻¹⁶ with truncation. `tests/tests/emitted/trig.rs` searches for more, near all multiples of π/4 in range:
//! it finds 1.53·10⁻¹⁶.
//!
//! # Error in f32: below 1.2·10⁻⁷ for |x| ≤ 6400 rad
//!
//! P₁ = 3217/2048 has 12 bits and is within 4.5·10⁻⁶ of π/2, so |k| may reach 2¹². Certified by evaluating every f32
//! in range (`tests/tests/emitted/trig.rs`): the largest error is 1.166·10⁻⁷, at 3.8643 rad.

use super::Trig;
use super::reduction::Reduction;

/// Cody–Waite reduction and minimax polynomials: the fastest that is as good as rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Polynomial;

macro_rules! polynomial {
    ($t:ident, error $error:literal, range $range:literal, sine $($s:literal)*, cosine $($c:literal)*) => {
        impl Trig<$t> for Polynomial {
            const ERROR: f64 = $error;
            const RANGE: f64 = $range;

            #[inline]
            fn sin_cos(&self, x: $t) -> ($t, $t) {
                let Some((k, y)) = x.reduce(1.0) else { return ($t::NAN, $t::NAN) };
                let z = y * y;
                let sin = y + y * z * horner!(z; $($s)*);
                let cos = 1.0 + z * horner!(z; $($c)*);
                // Picking is cheaper than swapping and changing signs, and does not branch.
                let turned = [sin, cos, -sin, -cos];
                (turned[k & 3], turned[(k + 1) & 3])
            }
        }
    };
}

/// a + z (b + z (c + …)).
macro_rules! horner {
    ($z:ident; $a:literal) => { $a };
    ($z:ident; $a:literal $($rest:literal)+) => { $a + $z * horner!($z; $($rest)+) };
}

polynomial! {
    f64, error 1.8e-16, range 1048576.0,
    sine -0.166666666666666 0.008333333333316218 -0.0001984126982574267 2.7557312482333597e-6
        -2.505059085816096e-8 1.5888057378485348e-10,
    cosine -0.5 0.0416666666666666 -0.0013888888888874474 2.480158728967155e-5 -2.7557314401039235e-7
        2.087572928300391e-9 -1.1359934360882627e-11
}

polynomial! {
    f32, error 1.2e-7, range 6400.0,
    sine -0.16666651 0.0083319815 -0.00019495768,
    cosine -0.49999893 0.04165616 -0.0013595929
}
