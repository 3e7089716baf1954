//! Sines and cosines: how generated code takes one pair a joint.
//!
//! | implementation | error, f64 | error, f32 | range, f64 | range, f32 | instructions, f64 | f32 |
//! |---|---|---|---|---|---|---|
//! | [`Libm`] | 1.2e-16 | 6e-8 | all numbers | all numbers | 100 | 55 |
//! | [`Polynomial`] | 1.8e-16 | 1.2e-7 | 2²⁰ rad | 6400 rad | 49 | 38 |
//! | [`Table`] of N pairs | 1.004 (π/N)³/6 + 9e-16 | 1.004 (π/N)³/6 + 5e-7 | 6.5e6/N rad | 2.5e4/N rad | 25 | 24 |
//! | `Std` (feature `std`) | not stated | not stated | all numbers | all numbers | 130 | 51 |
//!
//! Errors are absolute, of either the sine or the cosine, for all angles in range; those of `Polynomial` and `Table`
//! are proved in their modules and searched for in the tests. Instructions are those of one pair on x86-64 (SSE2),
//! the mean over [−π, π], call and return included, counted by callgrind; `Std` is glibc's. On a processor without
//! double precision `Libm` is dear even in f32, because it computes in f64 inside: there `Polynomial` and `Table` in
//! f32 save most of a control step.
//!
//! `Libm`, `Polynomial` and `Table` give the same bits on every machine: multiplications and additions in a fixed
//! order, never fused. `Polynomial` and `Table` branch on nothing but whether the angle is in range.

mod libm;
mod polynomial;
mod reduction;
#[cfg(feature = "std")]
mod std;
mod table;

pub use self::libm::Libm;
pub use self::polynomial::Polynomial;
#[cfg(feature = "std")]
pub use self::std::Std;
pub use self::table::Table;

/// A way to take sines and cosines of numbers of type `T`.
///
/// Generated code calls the one that its specification chose; [`ERROR`](Trig::ERROR) is part of its bounds.
pub trait Trig<T> {
    /// Neither sine nor cosine of an angle within the range is off by more.
    const ERROR: f64;
    /// The largest |x|, rad, for which [`ERROR`](Trig::ERROR) is a promise.
    const RANGE: f64;
    /// (sin x, cos x), x in rad. Beyond the range, if it ends, two NaN or a pair that is still as good: a controller
    /// reports NaN as a fault.
    fn sin_cos(&self, x: T) -> (T, T);
}
