//! A value with its rate of change, for derivatives that follow from the recursion itself.

use std::ops::{Add, Mul, Neg, Sub};

use super::recursion::Position;
use super::scalar::{Angle, Scalar};
use crate::arm::{Arm, JointKind};

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

impl<S: Angle> Angle for Jet<S> {
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (Self { value: sin, rate: cos * self.rate }, Self { value: cos, rate: -(sin * self.rate) })
    }
}

/// The joints that move, in the form that the recursion takes, where the coordinates are `q`, rad or m.
pub fn enclosed_positions<S: Angle>(arm: &Arm, q: &[S]) -> Vec<Position<S>> {
    let behind: Vec<S> = match &arm.linkage {
        None => q.to_vec(),
        Some(linkage) => {
            let follow = |c: &crate::arm::Coupling| {
                q.get(c.coordinate).map(|q| q.constant(c.multiplier) * *q + q.constant(c.offset))
            };
            linkage.couplings.iter().map_while(follow).collect()
        }
    };
    let place = |(joint, q): (&crate::arm::Joint, S)| match joint.kind {
        JointKind::Revolute => {
            let (sin, cos) = q.sin_cos();
            Position::Revolute { sin, cos }
        }
        JointKind::Prismatic => Position::Prismatic(q),
    };
    arm.moving().iter().zip(behind).map(place).collect()
}
