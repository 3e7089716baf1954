//! Numbers of some 30 digits, in pairs of f64 (Dekker 1971).

use std::ops::{Add, Mul, Neg, Sub};

/// An unevaluated sum of a number and what it rounded away.
#[derive(Clone, Copy, Debug)]
pub struct Double(pub f64, pub f64);

fn two_sum(a: f64, b: f64) -> Double {
    let s = a + b;
    let t = s - a;
    Double(s, (a - (s - t)) + (b - t))
}

fn two_product(a: f64, b: f64) -> Double {
    let p = a * b;
    Double(p, a.mul_add(b, -p))
}

impl Double {
    /// 0.
    pub const ZERO: Self = Self(0.0, 0.0);
    /// 1.
    pub const ONE: Self = Self(1.0, 0.0);

    fn plus(self, b: Self) -> Self {
        let (s, t) = (two_sum(self.0, b.0), two_sum(self.1, b.1));
        let s = two_sum(s.0, s.1 + t.0);
        two_sum(s.0, s.1 + t.1)
    }

    fn times(self, b: Self) -> Self {
        let p = two_product(self.0, b.0);
        two_sum(p.0, p.1 + (self.0 * b.1 + self.1 * b.0))
    }

    fn minus(self) -> Self {
        Self(-self.0, -self.1)
    }

    /// self/n.
    fn over(self, n: f64) -> Self {
        let q = self.0 / n;
        let p = two_product(q, n);
        two_sum(q, ((self.0 - p.0) - p.1 + self.1) / n)
    }

    /// √self of a number above 0, one step of Newton's from that of its head.
    pub fn sqrt(self) -> Self {
        let x = self.0.sqrt();
        let rest = self.plus(two_product(-x, x));
        two_sum(x, rest.0 / (2.0 * x))
    }

    /// |self − x|.
    pub fn off(self, x: f64) -> f64 {
        ((self.0 - x) + self.1).abs()
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.plus(b)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.plus(b.minus())
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        self.times(b)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        self.minus()
    }
}

impl From<f64> for Double {
    fn from(x: f64) -> Self {
        Self(x, 0.0)
    }
}

/// π/2 in three parts, to 160 bits.
const QUARTER: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591698e-33];

/// (sin x, cos x) for |x| below 2³⁰: Taylor's series after reduction to |r| ≤ π/4.
pub fn sin_cos(x: f64) -> (Double, Double) {
    let k = (x * std::f64::consts::FRAC_2_PI).round();
    let mut r = Double(x, 0.0);
    for part in QUARTER {
        r = r.plus(two_product(-k, part));
    }
    let square = r.times(r).minus();
    let (mut sin, mut cos) = (r, Double(1.0, 0.0));
    let (mut odd, mut even) = (sin, cos);
    for n in 1..16 {
        let m = f64::from(2 * n);
        even = even.times(square).over(m * (m - 1.0));
        odd = odd.times(square).over(m * (m + 1.0));
        cos = cos.plus(even);
        sin = sin.plus(odd);
    }
    match k.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, sin.minus()),
        2 => (sin.minus(), cos.minus()),
        _ => (cos.minus(), sin),
    }
}
