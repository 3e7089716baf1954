//! f32 with its errors, as the number type of the runtime's motions: the bound is made by the code that runs.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use gramforge_runtime::Real;

use crate::numerics::interval::Interval;
use crate::numerics::rounded::{Format, Rounded};

/// An f32 whose values and errors are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Single(pub Rounded);

impl Single {
    /// A literal, rounded once.
    pub fn literal(x: f64) -> Self {
        Self(Rounded::constant(x, Format::SINGLE))
    }

    /// A literal that was rounded in f64 before: a quotient, a product or a difference.
    pub fn quotient(x: f64) -> Self {
        let Rounded { value, error, .. } = Rounded::constant(x, Format::SINGLE);
        Self(Rounded::within(value, error + 4.0 * f64::EPSILON * x.abs(), Format::SINGLE))
    }

    /// A number of f32.
    pub fn exact(value: Interval) -> Self {
        Self(Rounded::input(value, Format::SINGLE))
    }

    /// Nothing is known of what is computed.
    fn unknown() -> Self {
        let all = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
        Self(Rounded::within(all, f64::INFINITY, Format::SINGLE))
    }
}

macro_rules! operator {
    ($($trait:ident $function:ident $operator:tt),*) => {
        $(impl $trait for Single {
            type Output = Self;
            fn $function(self, b: Self) -> Self {
                Self(self.0 $operator b.0)
            }
        })*
    };
}

operator!(Add add +, Sub sub -, Mul mul *);

impl Neg for Single {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Div for Single {
    type Output = Self;
    fn div(self, _: Self) -> Self {
        Self::unknown()
    }
}

impl AddAssign for Single {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl SubAssign for Single {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl PartialOrd for Single {
    fn partial_cmp(&self, _: &Self) -> Option<Ordering> {
        None
    }
}

impl Real for Single {
    // Constants of a trait cannot call `literal`; no motion reads them but as 1 − x.
    const ZERO: Self = Self(Rounded::ZERO_SINGLE);
    const ONE: Self = Self(Rounded::ONE_SINGLE);

    fn from_f64(x: f64) -> Self {
        Self::literal(x)
    }

    fn from_u32(x: u32) -> Self {
        Self::literal(f64::from(x))
    }

    fn from_i32(x: i32) -> Self {
        Self::literal(f64::from(x))
    }

    fn to_f64(self) -> f64 {
        self.0.value.low
    }

    fn sin_cos(self) -> (Self, Self) {
        (Self::unknown(), Self::unknown())
    }

    fn sqrt(self) -> Self {
        Self::unknown()
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn is_finite(self) -> bool {
        self.0.error.is_finite()
    }
}
