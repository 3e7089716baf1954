//! Intervals with outward rounding: what a number is known to lie between.

use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval [low, high].
///
/// Holds: every operation gives an interval that contains the exact result for all members of its operands; one that
/// overflows is [−∞, ∞].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// More than one rounding of x, and more than an underflow.
fn slack(x: f64) -> f64 {
    f64::EPSILON * x.abs() + 1e-300
}

/// Errors of sine, cosine and of the ends of a period, with room to spare.
const SINE: f64 = 4.0 * f64::EPSILON;
const PERIODS: f64 = 1e-12;

impl Interval {
    /// The number 0.
    pub const ZERO: Self = Self { low: 0.0, high: 0.0 };

    /// The number `x`.
    pub fn point(x: f64) -> Self {
        Self { low: x, high: x }
    }

    /// All that is within `radius` of `x`.
    pub fn about(x: f64, radius: f64) -> Self {
        Self::outward(x - radius, x + radius)
    }

    /// The smallest interval that holds both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What lies in both. Of intervals that both hold one number, and so meet.
    #[must_use]
    pub fn meet(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// max |x|.
    pub fn magnitude(self) -> f64 {
        self.high.max(-self.low)
    }

    /// Sine and cosine of an angle in rad.
    pub fn sin_cos(self) -> (Self, Self) {
        let (turn, quarter) = (std::f64::consts::TAU, std::f64::consts::FRAC_PI_2);
        let whole = Self { low: -1.0, high: 1.0 };
        let width = self.high - self.low;
        if width.is_nan() || width >= turn {
            return (whole, whole);
        }
        let ((sin_low, cos_low), (sin_high, cos_high)) = (libm::sincos(self.low), libm::sincos(self.high));
        // Whether an angle at `at`, whole turns apart, lies in the interval; too often rather than too seldom.
        let holds = |at: f64| {
            let spare = PERIODS * self.magnitude().max(1.0);
            let first = libm::ceil((self.low - spare - at) / turn);
            first * turn + at <= self.high + spare
        };
        let between = |a: f64, b: f64, top: f64, bottom: f64| Self {
            low: if holds(bottom) { -1.0 } else { (a.min(b) - SINE).max(-1.0) },
            high: if holds(top) { 1.0 } else { (a.max(b) + SINE).min(1.0) },
        };
        (between(sin_low, sin_high, quarter, -quarter), between(cos_low, cos_high, 0.0, 2.0 * quarter))
    }

    fn outward(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        Self { low: low - slack(low), high: high + slack(high) }
    }

    fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        if self.is_zero() {
            return b;
        }
        if b.is_zero() {
            return self;
        }
        Self::outward(self.low + b.low, self.high + b.high)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        if self.is_zero() || b.is_zero() {
            return Self::ZERO;
        }
        let ends = [self.low * b.low, self.low * b.high, self.high * b.low, self.high * b.high];
        if ends.iter().any(|end| end.is_nan()) {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let low = ends[0].min(ends[1]).min(ends[2].min(ends[3]));
        let high = ends[0].max(ends[1]).max(ends[2].max(ends[3]));
        Self::outward(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    #[test]
    fn sums_products_and_sines_of_members_are_members() {
        let spread = LowDiscrepancy::new(6);
        let holds = |range: Interval, x: f64| assert!(range.low <= x && x <= range.high, "{x} in {range:?}");
        for index in 0..20_000 {
            let u = spread.point(index);
            let side = |at: f64, width: f64| {
                let (middle, half) = (12.0 * at - 6.0, 4.0 * width * width);
                Interval { low: middle - half, high: middle + half }
            };
            let (a, b) = (side(u[0], u[1]), side(u[2], u[3]));
            let member = |range: Interval, u: f64| range.low + (range.high - range.low) * u;
            for (s, t) in [(u[4], u[5]), (0.0, 1.0), (1.0, 0.0), (0.0, 0.0), (1.0, 1.0)] {
                let (x, y) = (member(a, s).min(a.high), member(b, t).min(b.high));
                holds(a + b, x + y);
                holds(a - b, x - y);
                holds(a * b, x * y);
                let (sin, cos) = a.sin_cos();
                holds(sin, x.sin());
                holds(cos, x.cos());
            }
        }
    }

    #[test]
    fn a_narrow_angle_has_a_narrow_sine() {
        let (sin, cos) = Interval::about(1.2, 0.01).sin_cos();
        assert!(sin.high - sin.low < 0.0073 && cos.high - cos.low < 0.0187, "{sin:?} {cos:?}");
        let (top, _) = Interval::about(std::f64::consts::FRAC_PI_2, 0.1).sin_cos();
        assert!(top.high == 1.0 && (top.low - 0.1_f64.cos()).abs() < 1e-14, "{top:?}");
    }
}
