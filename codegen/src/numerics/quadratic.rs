//! Numbers as quadratic functions of a few unknowns, with what is of third order and what rounds apart.

use std::ops::{Add, Mul, Neg, Sub};

/// Unit roundoff.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// More than what the few roundings of a bound take off it.
const UP: f64 = 1.0 + 128.0 * f64::EPSILON;

/// centre + Σ_k slopes_k x_k + Σ_(k≤l) bends_kl x_k x_l ± rest ± rounding with |x_k| ≤ 1, where B = V(V + 1)/2.
///
/// Holds: every operation gives a form that holds the exact result for the same x. Where all |x_k| ≤ λ ≤ 1, λ³ rest is enough:
/// each part of it is a product of at least three unknowns.
#[derive(Clone, Copy, Debug)]
pub struct Quadratic<const V: usize, const B: usize> {
    /// The value where all unknowns are 0.
    pub centre: f64,
    /// The derivatives by the unknowns.
    pub slopes: [f64; V],
    /// The factors of x_k x_l, row by row of the upper triangle.
    pub bends: [f64; B],
    /// Bound on what is of third order.
    pub rest: f64,
    /// Bound on what computing the rest of this form has rounded.
    pub rounding: f64,
    /// Whether it depends on any unknown: a constant is multiplied faster.
    varies: bool,
}

/// Σ |x_k|.
fn size(x: &[f64]) -> f64 {
    x.iter().map(|x| x.abs()).sum()
}

impl<const V: usize, const B: usize> Quadratic<V, B> {
    /// The number `x`.
    pub fn point(x: f64) -> Self {
        Self { centre: x, slopes: [0.0; V], bends: [0.0; B], rest: 0.0, rounding: 0.0, varies: false }
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

    /// Adds `factor` (Σ a_k x_k)(Σ b_k x_k) to the bends.
    fn bend(&mut self, factor: f64, a: &[f64; V], b: &[f64; V]) {
        let mut bends = self.bends.iter_mut();
        for k in 0..V {
            let (a_k, b_k) = (factor * a[k], factor * b[k]);
            if let Some(square) = bends.next() {
                *square += a_k * b[k];
            }
            for (l, bend) in (k + 1..V).zip(bends.by_ref()) {
                *bend += a_k * b[l] + a[l] * b_k;
            }
        }
    }

    /// Sine and cosine of an angle in rad: no derivative exceeds 1.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = libm::sincos(self.centre);
        let (line, bent) = (size(&self.slopes), size(&self.bends));
        let away = line + bent + self.rest;
        // ½d² is ½(line)² and what is left of it; then |d|³/6.
        let left = bent + self.rest;
        let third = 0.5 * left * (2.0 * line + left) + away * away * away / 6.0;
        let made = |value: f64, slope: f64| {
            let mut out = Self {
                centre: value,
                slopes: self.slopes.map(|x| slope * x),
                bends: self.bends.map(|x| slope * x),
                rest: UP * (slope.abs() * self.rest + third),
                rounding: 0.0,
                varies: self.varies,
            };
            out.bend(-0.5 * value, &self.slopes, &self.slopes);
            let turned = slope.abs() + away + self.rounding;
            out.rounding = UP * (turned * self.rounding + 8.0 * UNIT * (1.0 + away + away * away));
            out
        };
        (made(sin, cos), made(cos, -sin))
    }

    /// x c for a number c.
    fn scaled(mut self, c: f64) -> Self {
        self.centre *= c;
        self.slopes.iter_mut().chain(&mut self.bends).for_each(|x| *x *= c);
        let c = c.abs();
        self.rest *= UP * c;
        let sizes = self.centre.abs() + size(&self.slopes) + size(&self.bends);
        self.rounding = UP * (c * self.rounding + UNIT * sizes);
        self
    }

    fn is_exact(&self) -> bool {
        !self.varies && self.rounding == 0.0
    }
}

impl<const V: usize, const B: usize> Add for Quadratic<V, B> {
    type Output = Self;
    fn add(mut self, b: Self) -> Self {
        if b.is_exact() && b.centre == 0.0 {
            return self;
        }
        if self.is_exact() && self.centre == 0.0 {
            return b;
        }
        self.centre += b.centre;
        if b.varies {
            self.slopes.iter_mut().zip(&b.slopes).for_each(|(x, b)| *x += b);
            self.bends.iter_mut().zip(&b.bends).for_each(|(x, b)| *x += b);
        }
        self.rest = UP * (self.rest + b.rest);
        let sizes = self.centre.abs() + size(&self.slopes) + size(&self.bends);
        self.rounding = UP * (self.rounding + b.rounding + UNIT * sizes);
        self.varies |= b.varies;
        self
    }
}

impl<const V: usize, const B: usize> Neg for Quadratic<V, B> {
    type Output = Self;
    fn neg(mut self) -> Self {
        self.centre = -self.centre;
        self.slopes.iter_mut().chain(&mut self.bends).for_each(|x| *x = -*x);
        self
    }
}

impl<const V: usize, const B: usize> Sub for Quadratic<V, B> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<const V: usize, const B: usize> Mul for Quadratic<V, B> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        if self.is_exact() {
            return if self.centre == 0.0 { Self::point(0.0) } else { b.scaled(self.centre) };
        }
        if b.is_exact() {
            return if b.centre == 0.0 { Self::point(0.0) } else { self.scaled(b.centre) };
        }
        let (x, y) = (self.centre, b.centre);
        let mut out = Self::point(x * y);
        for (out, (a, b)) in out.slopes.iter_mut().zip(self.slopes.iter().zip(&b.slopes)) {
            *out = x * b + y * a;
        }
        for (out, (a, b)) in out.bends.iter_mut().zip(self.bends.iter().zip(&b.bends)) {
            *out = x * b + y * a;
        }
        out.bend(1.0, &self.slopes, &b.slopes);
        let (s, t) = (size(&self.slopes), size(&b.slopes));
        let (u, v) = (size(&self.bends), size(&b.bends));
        let (x, y) = (x.abs(), y.abs());
        let third = s * v + t * u + u * v + self.rest * (t + v) + b.rest * (s + u) + self.rest * b.rest;
        out.rest = UP * (x * b.rest + y * self.rest + third);
        let (around, b_around) = (x + s + u + self.rest, y + t + v + b.rest);
        out.rounding = UP
            * (around * b.rounding
                + (b_around + b.rounding) * self.rounding
                + 8.0 * UNIT * (x + s + u) * (y + t + v));
        out.varies = true;
        out
    }
}

#[cfg(test)]
mod tests {
    use super::Quadratic;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    #[test]
    fn members_stay_members_and_the_rest_falls_with_the_cube() {
        let points = LowDiscrepancy::new(3);
        let given = [(0.7, 0.2), (-1.5, 0.3), (4.0, 0.1)];
        let [x, y, z] = [0, 1, 2].map(|k| Quadratic::<3, 6>::unknown(given[k].0, k, given[k].1));
        let (sin, cos) = (x * y + z).sin_cos();
        let made = sin * x - cos * Quadratic::point(1.7) * y + z * sin;
        for index in 0..20_000 {
            let u = points.point(index);
            for size in [1.0, 0.1, 0.01] {
                let unit: [f64; 3] = std::array::from_fn(|k| size * (2.0 * u[k] - 1.0));
                let [a, b, c] = std::array::from_fn(|k| given[k].0 + given[k].1 * unit[k]);
                let (sin, cos) = (a * b + c).sin_cos();
                let exact = sin * a - cos * 1.7 * b + c * sin;
                let mut known = made.centre;
                let mut bends = made.bends.iter();
                for k in 0..3 {
                    known += made.slopes[k] * unit[k];
                    for l in k..3 {
                        known += bends.next().unwrap() * unit[k] * unit[l];
                    }
                }
                let off = (exact - known).abs();
                assert!(off <= size * size * size * made.rest + made.rounding + 1e-15, "{off} {size}");
            }
        }
        assert!(made.rounding < 1e-13 && made.rest < 20.0, "{made:?}");
    }
}
