//! What the recursion computes with.

use std::ops::{Add, Mul, Neg, Sub};

use crate::numerics::Interval;
use crate::numerics::linear::Linear;
use crate::numerics::quadratic::Quadratic;

/// A commutative ring with f64 constants: f64 itself, a node of an expression graph, or an enclosure.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The constant `x` in the ring that `self` belongs to.
    fn constant(self, x: f64) -> Self;
}

impl Scalar for f64 {
    fn constant(self, x: f64) -> Self {
        x
    }
}

impl Scalar for Interval {
    fn constant(self, x: f64) -> Self {
        Self::point(x)
    }
}

impl<const V: usize> Scalar for Linear<V> {
    fn constant(self, x: f64) -> Self {
        Self::point(x)
    }
}

impl<const V: usize, const B: usize> Scalar for Quadratic<V, B> {
    fn constant(self, x: f64) -> Self {
        Self::point(x)
    }
}

/// A scalar that can be an angle.
pub trait Angle: Scalar {
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
}

impl Angle for Interval {
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

impl<const V: usize> Angle for Linear<V> {
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

impl<const V: usize, const B: usize> Angle for Quadratic<V, B> {
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

/// A vector of the moved frame.
pub(super) type Vector<S> = [S; 3];

/// a + b.
pub(super) fn add<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    std::array::from_fn(|i| a[i] + b[i])
}

/// a × b.
pub(super) fn cross<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a · b, summed in order.
pub(super) fn dot<S: Scalar>(a: Vector<S>, b: Vector<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// M x.
pub(super) fn apply<S: Scalar>(m: &[Vector<S>; 3], x: Vector<S>) -> Vector<S> {
    std::array::from_fn(|i| dot(m[i], x))
}

/// The constant vector `x`, in the ring of `like`.
pub(super) fn lift<S: Scalar>(like: S, x: [f64; 3]) -> Vector<S> {
    x.map(|value| like.constant(value))
}
