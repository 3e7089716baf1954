//! Numbers that know what they may have rounded by (running error analysis, Wilkinson 1986).

use std::ops::{Add, Mul, Neg, Sub};

use super::Scalar;
use super::model::positions;
use super::recursion::{Position, passivity_torque};
use crate::arm::Arm;

/// Unit roundoff of f64.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// A computed number and a bound, to first order in the unit roundoff, on how far it is from the exact one.
#[derive(Clone, Copy, Debug)]
struct Running {
    value: f64,
    error: f64,
}

impl Running {
    fn rounded(value: f64, error: f64) -> Self {
        Self { value, error: error + UNIT * value.abs() }
    }
}

impl Add for Running {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::rounded(self.value + b.value, self.error + b.error)
    }
}

impl Sub for Running {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::rounded(self.value - b.value, self.error + b.error)
    }
}

impl Mul for Running {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let error = self.value.abs() * b.error + self.error * b.value.abs();
        Self::rounded(self.value * b.value, error)
    }
}

impl Neg for Running {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

impl Scalar for Running {
    fn constant(self, x: f64) -> Self {
        Self { value: x, error: 0.0 }
    }
}

/// What D (n×n) and G (n) at `q` (rad or m) may be off by when the recursion computes them in f64.
pub fn rounding(arm: &Arm, q: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = arm.dof();
    // Sines and cosines are good to an ulp.
    let off = |x: f64| Running { value: x, error: f64::EPSILON * x.abs() };
    let lifted = |position: Position<f64>| match position {
        Position::Revolute { sin, cos } => Position::Revolute { sin: off(sin), cos: off(cos) },
        Position::Prismatic(q) => Position::Prismatic(Running { value: q, error: 0.0 }),
    };
    let q: Vec<_> = positions(arm, q).into_iter().map(lifted).collect();
    let unit = |j: usize| -> Vec<Running> {
        (0..n).map(|i| Running { value: if i == j { 1.0 } else { 0.0 }, error: 0.0 }).collect()
    };
    let rest = unit(n);
    let errors = |gravity: [f64; 3], a_r: &[Running]| -> Vec<f64> {
        passivity_torque(arm, gravity, &q, &rest, &rest, a_r).iter().map(|tau| tau.error).collect()
    };
    let columns: Vec<Vec<f64>> = (0..n).map(|j| errors([0.0; 3], &unit(j))).collect();
    let d = (0..n).map(|i| columns.iter().map(|column| column[i]).collect()).collect();
    (d, errors(arm.gravity, &rest))
}

#[cfg(test)]
mod tests {
    use super::rounding;
    use crate::dynamics::{gravity, mass_matrix};
    use crate::simulate::example::three_link;

    /// At angles whose sines are exact, so that nothing but the constants rounds: the arm turned by a multiple of 2π computes
    /// the same with other roundings.
    #[test]
    fn errors_are_above_what_is_seen_and_not_far_above() {
        let arm = three_link();
        let turn = std::f64::consts::TAU;
        let mut seen = 0.0_f64;
        for k in 0..200 {
            let q = [0.1 * f64::from(k), 0.37 * f64::from(k), -0.71 * f64::from(k)];
            let other: Vec<f64> = q.iter().map(|q| q.rem_euclid(turn)).collect();
            let (d, g) = rounding(&arm, &q);
            // The angle itself moves by an ulp of 2π times the turns.
            let moved = 40.0 * f64::EPSILON * 16.0;
            for (i, (a, b)) in gravity(&arm, &q).iter().zip(gravity(&arm, &other)).enumerate() {
                assert!((a - b).abs() <= 2.0 * g[i] + 100.0 * moved, "{k}");
                seen = seen.max(g[i]);
            }
            for (i, row) in mass_matrix(&arm, &q).iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    assert!((entry - mass_matrix(&arm, &other)[i][j]).abs() <= 2.0 * d[i][j] + 20.0 * moved);
                }
            }
        }
        assert!(seen > 0.0 && seen < 1e-12, "{seen:e}");
    }
}
