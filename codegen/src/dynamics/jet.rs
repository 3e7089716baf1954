//! A value with its rate of change, for derivatives that follow from the recursion itself.

use std::ops::{Add, Mul, Neg, Sub};

use super::scalar::Scalar;

/// A value and its derivative by one variable: forward differentiation in the ring `S`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S> {
    /// The value.
    pub value: S,
    /// Its derivative.
    pub rate: S,
}

impl<S: Scalar> Add for Jet<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, rate: self.rate + b.rate }
    }
}

impl<S: Scalar> Sub for Jet<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self { value: self.value - b.value, rate: self.rate - b.rate }
    }
}

impl<S: Scalar> Mul for Jet<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self { value: self.value * b.value, rate: self.value * b.rate + self.rate * b.value }
    }
}

impl<S: Scalar> Neg for Jet<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
}

impl<S: Scalar> Scalar for Jet<S> {
    fn constant(self, x: f64) -> Self {
        Self { value: self.value.constant(x), rate: self.value.constant(0.0) }
    }
}
