//! A product and a sum in one operation.

extern crate std;

/// A number that is multiplied and added to in one operation, rounded once.
pub trait MulAdd: crate::Real {
    /// `self` · `by` + `added`, rounded once.
    fn mul_add(self, by: Self, added: Self) -> Self;
}

impl MulAdd for f64 {
    #[inline(always)]
    fn mul_add(self, by: f64, added: f64) -> f64 {
        f64::mul_add(self, by, added)
    }
}

impl MulAdd for f32 {
    #[inline(always)]
    fn mul_add(self, by: f32, added: f32) -> f32 {
        f32::mul_add(self, by, added)
    }
}

/// `x` · `by` + `added`, rounded once: the same bits on every machine.
///
/// Generated modules call it where their specification says `emit.fma`. It is one instruction where the crate that calls it is compiled for
/// a processor that has one, and a slow library call elsewhere. With the feature `std`, as `core` has no such function.
#[inline(always)]
pub fn mul_add<T: MulAdd>(x: T, by: T, added: T) -> T {
    x.mul_add(by, added)
}
