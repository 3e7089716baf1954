//! Small sums, products and intervals.

use crate::numerics::Interval;

/// What sums and products of the few numbers of a period round by, relative, with room to spare.
pub(super) const ROUNDED: f64 = 1e-13;
/// More than what the roundings of a bound take off it.
pub(super) const UP: f64 = 1.0 + 1e-12;

/// The smallest λ with x ≤ λ `half`.
pub(super) fn scale(x: &[f64], half: &[f64]) -> f64 {
    x.iter().zip(half).map(|(x, half)| x / half).fold(0.0, f64::max)
}

/// Euclidean norm, rounded up.
pub(super) fn norm(x: &[f64]) -> f64 {
    UP * libm::sqrt(x.iter().map(|x| x * x).sum())
}

/// The number `x`.
pub(super) fn point(x: f64) -> Interval {
    Interval::point(x)
}

/// The middle of an interval.
pub(super) fn middle(x: Interval) -> f64 {
    0.5 * (x.low + x.high)
}

/// Half the width of an interval, and what its middle rounds by.
pub(super) fn ends(x: Interval) -> f64 {
    let middle = middle(x);
    UP * (x.high - middle).max(middle - x.low)
}

/// M N by rows.
pub(super) fn product(m: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let row = |m: &Vec<f64>| -> Vec<f64> {
        let mut out = vec![0.0; other.first().map_or(0, Vec::len)];
        for (weight, row) in m.iter().zip(other) {
            out.iter_mut().zip(row).for_each(|(out, x)| *out += weight * x);
        }
        out
    };
    m.iter().map(row).collect()
}

/// M x by rows.
pub(super) fn times(m: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    m.iter().map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum()).collect()
}
