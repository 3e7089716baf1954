//! Sums of sinusoids.

use core::array::from_fn;

use super::{Desired, Reference, check_duration, check_finite};
use crate::{ConfigError, Real, Requirement};

/// One sinusoid of one joint: amplitude · sin(frequency · t + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid<T> {
    /// Amplitude, rad or m.
    pub amplitude: T,
    /// Angular frequency ω, rad/s.
    pub frequency: T,
    /// Phase at t = 0, rad.
    pub phase: T,
}

/// A sum of sinusoids for each joint: q_i = offset_i + Σ_k amplitude_ik sin(ω_ik t + phase_ik).
///
/// It goes on before 0 and after `duration`: stopping there would be a step of velocity. Bounds that were made for the
/// motion hold there only if it repeats itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinusoidReference<'a, T, const N: usize> {
    /// Offset of each joint, rad or m.
    pub offset: [T; N],
    /// The sinusoids of each joint.
    pub terms: [&'a [Sinusoid<T>]; N],
    /// Time for which the motion was planned, s, positive.
    pub duration: T,
}

impl<T: Real, const N: usize> Reference<T, N> for SinusoidReference<'_, T, N> {
    fn duration(&self) -> T {
        self.duration
    }

    fn at(&self, t: T) -> Desired<T, N> {
        Desired::from_joints(from_fn(|i| sinusoids(self.offset[i], self.terms[i], t)))
    }

    fn check(&self) -> Result<(), ConfigError> {
        check_duration(self.duration)?;
        check_finite("offset", &self.offset)?;
        let finite =
            |s: &Sinusoid<T>| s.amplitude.is_finite() && s.frequency.is_finite() && s.phase.is_finite();
        match self.terms.iter().position(|terms| !terms.iter().all(finite)) {
            None => Ok(()),
            joint => Err(ConfigError { parameter: "terms", joint, requirement: Requirement::Finite }),
        }
    }
}

/// (q, q̇, q̈) of one joint at time `t`, s.
///
/// The angle ω t + phase is rounded before the sine, so the error of q grows as |ω t| units in the last place of the
/// amplitude: 1e-13 of it after 1000 rad in f64, 1e-4 in f32.
pub fn sinusoids<T: Real>(offset: T, terms: &[Sinusoid<T>], t: T) -> (T, T, T) {
    terms.iter().fold((offset, T::ZERO, T::ZERO), |(q, qd, qdd), term| {
        let (sin, cos) = (term.frequency * t + term.phase).sin_cos();
        let slope = term.amplitude * term.frequency;
        (q + term.amplitude * sin, qd + slope * cos, qdd - slope * term.frequency * sin)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::assert_derivatives;

    const MOTION: SinusoidReference<'static, f64, 2> = SinusoidReference {
        offset: [0.5, -1.0],
        terms: [
            &[
                Sinusoid { amplitude: 0.4, frequency: 1.5, phase: 0.2 },
                Sinusoid { amplitude: -0.1, frequency: 4.0, phase: 0.0 },
            ],
            &[],
        ],
        duration: 6.0,
    };

    #[test]
    fn derivatives_agree() {
        assert_derivatives(&MOTION, 1e-8);
    }

    #[test]
    fn is_the_sum() {
        let now = MOTION.at(2.0);
        assert!((now.q[0] - (0.5 + 0.4 * f64::sin(3.2) - 0.1 * f64::sin(8.0))).abs() < 1e-15);
        assert_eq!((now.q[1], now.qd[1], now.qdd[1]), (-1.0, 0.0, 0.0));
    }

    #[test]
    fn names_a_bad_number() {
        let terms = [Sinusoid { amplitude: 1.0, frequency: f64::INFINITY, phase: 0.0 }];
        let bad = SinusoidReference { terms: [&[], &terms], ..MOTION };
        let error = ConfigError { parameter: "terms", joint: Some(1), requirement: Requirement::Finite };
        assert_eq!(bad.check(), Err(error));
    }
}
