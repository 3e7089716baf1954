//! Sines of the platform.

extern crate std;

use super::Trig;

/// The platform's own sine and cosine. **Not the same bits on every machine**, nor from one compiler to the next: what
/// was simulated is not to the last bit what runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Std;

impl Trig<f64> for Std {
    /// Supposed: Rust states no precision; the usual platforms keep within 1 ulp.
    const ERROR: f64 = 0.5 * f64::EPSILON;
    const RANGE: f64 = f64::MAX;

    fn sin_cos(&self, x: f64) -> (f64, f64) {
        f64::sin_cos(x)
    }
}

impl Trig<f32> for Std {
    /// Supposed: Rust states no precision; the usual platforms keep within 1 ulp.
    const ERROR: f64 = 0.5 * f32::EPSILON as f64;
    const RANGE: f64 = f32::MAX as f64;

    fn sin_cos(&self, x: f32) -> (f32, f32) {
        f32::sin_cos(x)
    }
}
