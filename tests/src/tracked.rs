//! A number with a bound on what rounding has done to it: running error analysis, an oracle for what two ways of
//! computing the same may differ by.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use gramforge_runtime::Real;

/// Half a unit of the last place of 1, and the smallest number that is not rounded to 0.
const UNIT: f64 = 0.5 * f64::EPSILON;
const TINY: f64 = f64::from_bits(1);

/// A computed number, and how far it can be from the exact one.
#[derive(Clone, Copy, Debug)]
pub struct Tracked {
    /// As computed in f64.
    pub value: f64,
    /// Bound on |value − exact|.
    pub error: f64,
}

impl Tracked {
    /// A number that is exact.
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A constant that was rounded once.
    pub fn rounded(value: f64) -> Self {
        Self { value, error: UNIT * value.abs() }
    }

    /// With the rounding of the operation that gave it. The sums of errors round too: hence the factor.
    fn made(value: f64, error: f64) -> Self {
        Self { value, error: (error + UNIT * value.abs() + TINY) * (1.0 + 1e-12) }
    }
}

impl Add for Tracked {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::made(self.value + b.value, self.error + b.error)
    }
}

impl Sub for Tracked {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::made(self.value - b.value, self.error + b.error)
    }
}

impl Mul for Tracked {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let error = self.value.abs() * b.error + b.value.abs() * self.error + self.error * b.error;
        Self::made(self.value * b.value, error)
    }
}

impl Div for Tracked {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let quotient = self.value / b.value;
        let least = b.value.abs() - b.error;
        let error = (self.error + quotient.abs() * b.error) / least;
        Self::made(quotient, if least > 0.0 { error } else { f64::INFINITY })
    }
}

impl Neg for Tracked {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

impl AddAssign for Tracked {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl SubAssign for Tracked {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl PartialEq for Tracked {
    fn eq(&self, b: &Self) -> bool {
        self.value == b.value
    }
}

impl PartialOrd for Tracked {
    fn partial_cmp(&self, b: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&b.value)
    }
}

impl Real for Tracked {
    const ZERO: Self = Self { value: 0.0, error: 0.0 };
    const ONE: Self = Self { value: 1.0, error: 0.0 };
    fn from_f64(x: f64) -> Self {
        Self::exact(x)
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn sin_cos(self) -> (Self, Self) {
        // Both ways of computing start from the same sines.
        let (sin, cos) = self.value.sin_cos();
        (Self::exact(sin), Self::exact(cos))
    }
    fn sqrt(self) -> Self {
        Self::made(self.value.sqrt(), f64::INFINITY)
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
}
