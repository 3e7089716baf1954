//! Numbers as linear functions of a few unknowns, with what is of second order and what rounds apart.

use std::ops::{Add, Mul, Neg, Sub};

/// centre + Σ_k slopes_k x_k ± rest ± rounding with |x_k| ≤ 1.
///
/// Holds: every operation gives a form that holds the exact result for the same x. Where all |x_k| ≤ λ ≤ 1, λ² rest is enough:
/// each part of it is a product of at least two unknowns.
#[derive(Clone, Copy, Debug)]
pub struct Linear<const V: usize> {
    /// The value where all unknowns are 0.
    pub centre: f64,
    /// The derivatives by the unknowns.
    pub slopes: [f64; V],
    /// Bound on what is of second order.
    pub rest: f64,
    /// Bound on what computing the rest of this form has rounded.
    pub rounding: f64,
    /// Whether it depends on any unknown: a constant is multiplied faster.
    varies: bool,
}

/// Unit roundoff.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// More than what the few roundings of a bound take off it.
const UP: f64 = 1.0 + 64.0 * f64::EPSILON;

impl<const V: usize> Linear<V> {
    /// The number `x`.
    pub fn point(x: f64) -> Self {
        Self { centre: x, slopes: [0.0; V], rest: 0.0, rounding: 0.0, varies: false }
    }

    /// `x` and what unknown `k` adds, at most `radius`.
    pub fn unknown(x: f64, k: usize, radius: f64) -> Self {
        let mut out = Self::point(x);
        if let Some(slope) = out.slopes.get_mut(k) {
            *slope = radius;
            out.varies = true;
        }
        out
    }

    /// The same and anything up to `off` more or less, which no λ makes smaller.
    #[must_use]
    pub fn about(mut self, off: f64) -> Self {
        self.rounding += off;
        self
    }

    /// Σ_k |slopes_k|.
    pub fn spread(&self) -> f64 {
        self.slopes.iter().map(|slope| slope.abs()).sum()
    }

    /// Sine and cosine of an angle in rad: the second derivatives are at most 1.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = libm::sincos(self.centre);
        let away = self.spread() + self.rest;
        let bent = UP * 0.5 * away * away;
        let made = |value: f64, slope: f64| {
            let slopes = self.slopes.map(|s| slope * s);
            let turned = slope.abs() + away + self.rounding;
            let rounding = turned * self.rounding + 4.0 * UNIT * (1.0 + away);
            let rest = UP * (slope.abs() * self.rest + bent);
            Self { centre: value, slopes, rest, rounding: UP * rounding, varies: self.varies }
        };
        (made(sin, cos), made(cos, -sin))
    }

    /// x c for a number c.
    fn scaled(mut self, c: f64) -> Self {
        self.centre *= c;
        for slope in &mut self.slopes {
            *slope *= c;
        }
        let c = c.abs();
        self.rest *= UP * c;
        self.rounding = UP * c * self.rounding + UNIT * (self.centre.abs() + self.spread());
        self
    }
}

impl<const V: usize> Add for Linear<V> {
    type Output = Self;
    fn add(mut self, b: Self) -> Self {
        if !b.varies && b.centre == 0.0 && b.rounding == 0.0 {
            return self;
        }
        if !self.varies && self.centre == 0.0 && self.rounding == 0.0 {
            return b;
        }
        self.centre += b.centre;
        let mut spread = 0.0;
        if b.varies {
            for (slope, b) in self.slopes.iter_mut().zip(&b.slopes) {
                *slope += b;
                spread += slope.abs();
            }
        }
        self.rest = UP * (self.rest + b.rest);
        self.rounding = UP * (self.rounding + b.rounding) + UNIT * UP * (self.centre.abs() + spread);
        self.varies |= b.varies;
        self
    }
}

impl<const V: usize> Neg for Linear<V> {
    type Output = Self;
    fn neg(mut self) -> Self {
        self.centre = -self.centre;
        for slope in &mut self.slopes {
            *slope = -*slope;
        }
        self
    }
}

impl<const V: usize> Sub for Linear<V> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<const V: usize> Mul for Linear<V> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let exact = |x: &Self| !x.varies && x.rounding == 0.0;
        if exact(&self) {
            return if self.centre == 0.0 { Self::point(0.0) } else { b.scaled(self.centre) };
        }
        if exact(&b) {
            return if b.centre == 0.0 { Self::point(0.0) } else { self.scaled(b.centre) };
        }
        let (x, y) = (self.centre, b.centre);
        let mut slopes = [0.0; V];
        let (mut s, mut t) = (0.0, 0.0);
        for (slope, (a, b)) in slopes.iter_mut().zip(self.slopes.iter().zip(&b.slopes)) {
            *slope = x * b + y * a;
            s += a.abs();
            t += b.abs();
        }
        let (x_size, y_size) = (x.abs(), y.abs());
        let (around, b_around) = (s + self.rest, t + b.rest);
        let rest = x_size * b.rest + y_size * self.rest + s * b_around + self.rest * b_around;
        let rounding = (x_size + around) * b.rounding
            + (y_size + b_around + b.rounding) * self.rounding
            + UNIT * (x_size * y_size + 2.0 * (x_size * t + y_size * s));
        Self { centre: x * y, slopes, rest: UP * rest, rounding: UP * rounding, varies: true }
    }
}

#[cfg(test)]
mod tests {
    use super::Linear;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    #[test]
    fn members_stay_members_and_the_rest_falls_with_the_square() {
        let points = LowDiscrepancy::new(3);
        let given = [(0.7, 0.2), (-1.5, 0.3), (4.0, 0.1)];
        let [x, y, z] = [0, 1, 2].map(|k| Linear::<3>::unknown(given[k].0, k, given[k].1));
        let (sin, cos) = (x * y + z).sin_cos();
        let made = sin * x - cos * Linear::point(1.7) * y + z * sin;
        for index in 0..20_000 {
            let u = points.point(index);
            for size in [1.0, 0.1, 0.01] {
                let unit: [f64; 3] = std::array::from_fn(|k| size * (2.0 * u[k] - 1.0));
                let [a, b, c] = std::array::from_fn(|k| given[k].0 + given[k].1 * unit[k]);
                let (sin, cos) = (a * b + c).sin_cos();
                let exact = sin * a - cos * 1.7 * b + c * sin;
                let linear: f64 = made.slopes.iter().zip(unit).map(|(slope, x)| slope * x).sum();
                let off = (exact - made.centre - linear).abs();
                assert!(off <= size * size * made.rest + made.rounding + 1e-15, "{off} {size}");
            }
        }
        assert!(made.rounding < 1e-13 && made.rest < 20.0, "{made:?}");
    }
}
