//! Sine and cosine by a table of both over one turn, and second-order interpolation.
//!
//! The angle is x = θ_k + δ, θ_k = 2πk/N the nearest node. The derivatives of a sine are in the table anyway, since
//! it holds the cosine, so interpolation takes Taylor's polynomial about the node:
//!
//! ```text
//! sin x ≈ sin θ_k (1 − δ²/2) + cos θ_k δ      cos x ≈ cos θ_k (1 − δ²/2) − sin θ_k δ
//! ```
//!
//! with an error of |δ|³/6, |δ| ≤ π/N, in either: sizes double for an error eight times less. δ comes from the
//! reduction of [`Polynomial`](super::Polynomial), its π/2 scaled by 4/N, which is exact.
//!
//! # Error
//!
//! With u = 2⁻⁵³ (2⁻²⁴):
//!
//! - *Interpolation*: 1.004 (π/N)³/6. The nearest node may be missed by the rounding of x N/2π, which is 2u|k|:
//!   5·10⁻⁴ of a step in f32, where |k| ≤ 2¹², 2.4·10⁻¹⁰ in f64, where |k| ≤ 2²⁰; three times twice that in the cube.
//! - *Entries*: 2u each as the generator computes them, from an angle below π/4 that is rounded and a sine within 1
//!   ulp.
//! - *Evaluation*: 1 − δ²/2 is off by u, its product with the entry by u/2, the other product and δ by 2u|δ| ≤ 0.8u,
//!   the sum by u at most; the reduction of f32 by 2.5·10⁻⁹·4/N, below 0.03u. With the entries, times 1 + |δ|, all
//!   that is below 8u.

use super::Trig;
use super::reduction::Reduction;

/// `N` pairs (sin 2πk/N, cos 2πk/N), k = 0 … N − 1; N a power of two from 8 to 4096.
///
/// ```
/// use gramforge_runtime::trig::{Table, Trig};
/// # fn pair(k: usize) -> (f64, f64) { (k as f64 * core::f64::consts::TAU / 64.0).sin_cos() }
/// static TABLE: std::sync::LazyLock<Table<f64, 64>> = // a generated module writes the numbers out
///     std::sync::LazyLock::new(|| Table::new(core::array::from_fn(pair)));
/// let (sin, cos) = TABLE.sin_cos(1.0);
/// assert!((sin - 1_f64.sin()).abs() < <Table<f64, 64> as Trig<f64>>::ERROR);
/// assert!((cos - 1_f64.cos()).abs() < 2e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<T, const N: usize> {
    pairs: [(T, T); N],
}

impl<T, const N: usize> Table<T, N> {
    /// The table of the nearest numbers to (sin 2πk/N, cos 2πk/N); other entries than those void the error bound.
    pub const fn new(pairs: [(T, T); N]) -> Self {
        const { assert!(N.is_power_of_two() && N >= 8 && N <= 4096) }
        Self { pairs }
    }
}

/// The sum of the three parts above for `unit` = u.
const fn error(entries: usize, unit: f64) -> f64 {
    let step = core::f64::consts::PI / entries as f64;
    1.004 * step * step * step / 6.0 + 8.0 * unit
}

macro_rules! table {
    ($t:ident) => {
        impl<const N: usize> Trig<$t> for Table<$t, N> {
            const ERROR: f64 = error(N, 0.5 * $t::EPSILON as f64);
            // Half a node less than the last that the reduction takes.
            const RANGE: f64 = ($t::MOST - 1) as f64 * core::f64::consts::TAU / N as f64;

            #[inline]
            fn sin_cos(&self, x: $t) -> ($t, $t) {
                let Some((k, d)) = x.reduce(4.0 / N as $t) else { return ($t::NAN, $t::NAN) };
                let (s, c) = self.pairs[k & (N - 1)];
                let e = 1.0 - 0.5 * d * d;
                (s * e + c * d, c * e - s * d)
            }
        }
    };
}

table! { f64 }
table! { f32 }
