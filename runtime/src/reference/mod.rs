//! Desired motions: position, velocity and acceleration as functions of time, evaluated on the device.
//!
//! Every reference is a plain struct of public fields that a `const` or `static` can hold. Beside each stands the
//! scalar function that evaluates one joint, for those who do not know their number of joints at compile time.

mod limits;
mod quintic;
mod sinusoids;
mod spline;
mod ticks;

pub use limits::ReferenceLimits;
pub use quintic::{QuinticReference, quintic, quintic_shape};
pub use sinusoids::{Sinusoid, SinusoidReference, sinusoids};
pub use spline::{SplineReference, SplineSegment, cubic};
pub use ticks::{QuinticTicks, SinusoidTick, SinusoidTicks, SplineTick, SplineTicks, TickReference};

use crate::Real;
use crate::vector::first_not_finite;
use crate::{ConfigError, Requirement};

/// What the arm should be doing at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Desired<T, const N: usize> {
    /// q_d, rad or m.
    pub q: [T; N],
    /// q̇_d, rad/s or m/s.
    pub qd: [T; N],
    /// q̈_d, rad/s² or m/s².
    pub qdd: [T; N],
}

impl<T: Real, const N: usize> Desired<T, N> {
    /// Standing still at `q`, rad or m.
    pub const fn at_rest(q: [T; N]) -> Self {
        Self { q, qd: [T::ZERO; N], qdd: [T::ZERO; N] }
    }

    /// Gathers the (q, q̇, q̈) of each joint.
    fn from_joints(joints: [(T, T, T); N]) -> Self {
        Self { q: joints.map(|j| j.0), qd: joints.map(|j| j.1), qdd: joints.map(|j| j.2) }
    }
}

/// A desired motion of `N` joints.
pub trait Reference<T: Real, const N: usize> {
    /// Time for which the motion was planned, s.
    fn duration(&self) -> T;

    /// q_d, q̇_d and q̈_d at time `t`, s, before 0 and after the end too. A time that is NaN gives NaN, which the
    /// controller reports.
    fn at(&self, t: T) -> Desired<T, N>;

    /// Checks the numbers of the motion once, before the loop starts.
    ///
    /// # Errors
    /// Names the first number that the motion cannot be evaluated with.
    fn check(&self) -> Result<(), ConfigError>;
}

impl<T: Real, R: Reference<T, N> + ?Sized, const N: usize> Reference<T, N> for &R {
    fn duration(&self) -> T {
        (**self).duration()
    }

    fn at(&self, t: T) -> Desired<T, N> {
        (**self).at(t)
    }

    fn check(&self) -> Result<(), ConfigError> {
        (**self).check()
    }
}

fn check_duration<T: Real>(duration: T) -> Result<(), ConfigError> {
    if duration > T::ZERO && duration.is_finite() {
        return Ok(());
    }
    Err(ConfigError { parameter: "duration", joint: None, requirement: Requirement::Positive })
}

fn check_finite<T: Real, const N: usize>(
    parameter: &'static str,
    values: &[T; N],
) -> Result<(), ConfigError> {
    match first_not_finite(values) {
        None => Ok(()),
        joint => Err(ConfigError { parameter, joint, requirement: Requirement::Finite }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// q̇ and q̈ are the derivatives of q and q̇: compares with central differences on (0, duration).
    pub(super) fn assert_derivatives<const N: usize>(reference: &impl Reference<f64, N>, tolerance: f64) {
        let h = 1e-5;
        // An odd count keeps the differences off the knots of the splines under test.
        for k in 1..97 {
            let t = reference.duration() * f64::from(k) / 97.0;
            let (before, now, after) = (reference.at(t - h), reference.at(t), reference.at(t + h));
            for i in 0..N {
                let velocity = (after.q[i] - before.q[i]) / (2.0 * h);
                let acceleration = (after.qd[i] - before.qd[i]) / (2.0 * h);
                assert!(
                    (velocity - now.qd[i]).abs() < tolerance,
                    "q̇ of {i} at {t}: {velocity} {}",
                    now.qd[i]
                );
                assert!((acceleration - now.qdd[i]).abs() < tolerance, "q̈ of {i} at {t}");
            }
        }
    }

    #[test]
    fn a_nan_time_reaches_the_controller_as_nan() {
        let quintic = QuinticReference { from: [0.0], to: [1.0], duration: 1.0 };
        let spline = SplineReference {
            segments: &[SplineSegment { start: 0.0, coefficients: [[0.0, 0.0, 3.0, -2.0]] }],
            duration: 1.0,
        };
        let sinusoids = SinusoidReference {
            offset: [0.0],
            terms: [&[Sinusoid { amplitude: 1.0, frequency: 1.0, phase: 0.0 }]],
            duration: 1.0,
        };
        let references: [&dyn Reference<f64, 1>; 3] = [&quintic, &spline, &sinusoids];
        for reference in references {
            assert!(reference.at(f64::NAN).q[0].is_nan());
            assert_eq!(reference.check(), Ok(()));
        }
    }
}
