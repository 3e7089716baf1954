//! The number type: f64 or f32, with every transcendental taken from `libm` so that all machines agree.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number of the controller.
///
/// Own trait rather than `num-traits`: there, another crate's `std` feature silently swaps `libm`'s
/// sine for the platform's, and generated code would differ between machines.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Send
    + Sync
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// The nearest value to `x`.
    fn from_f64(x: f64) -> Self;
    /// The nearest value to `x`; of f32 without f64 on the way.
    fn from_u32(x: u32) -> Self {
        Self::from_f64(f64::from(x))
    }
    /// The nearest value to `x`; of f32 without f64 on the way.
    fn from_i32(x: i32) -> Self {
        Self::from_f64(f64::from(x))
    }
    /// The value as f64, exact.
    fn to_f64(self) -> f64;
    /// (sin x, cos x), x in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// True for every number that is neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

macro_rules! real {
    ($t:ty, $sincos:path, $sqrt:path) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            fn from_u32(x: u32) -> Self {
                x as $t
            }
            fn from_i32(x: i32) -> Self {
                x as $t
            }
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            fn sin_cos(self) -> (Self, Self) {
                $sincos(self)
            }
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
        }
    };
}

real!(f64, libm::sincos, libm::sqrt);
real!(f32, libm::sincosf, libm::sqrtf);
