//! Sines of the crate `libm`.

use super::Trig;
use crate::Real;

/// The crate `libm`, a port of musl's: the default.
///
/// In f32 it computes in f64, which costs thousands of instructions where the processor has no double.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Libm;

impl Trig<f64> for Libm {
    /// 1 ulp of a number below 1, musl's promise; not proved here.
    const ERROR: f64 = 0.5 * f64::EPSILON;
    const RANGE: f64 = f64::MAX;

    fn sin_cos(&self, x: f64) -> (f64, f64) {
        Real::sin_cos(x)
    }
}

impl Trig<f32> for Libm {
    /// 1 ulp of a number below 1, musl's promise; not proved here.
    const ERROR: f64 = 0.5 * f32::EPSILON as f64;
    const RANGE: f64 = f32::MAX as f64;

    fn sin_cos(&self, x: f32) -> (f32, f32) {
        Real::sin_cos(x)
    }
}
