//! The quintic polynomial that starts and ends at rest.

use super::{Desired, Reference, check_duration, check_finite};
use crate::vector::for_each_joint;
use crate::{ConfigError, Real};

/// Moves every joint from one position to another in the same time, with velocity and acceleration zero at both ends.
///
/// Before 0 the arm stands at `from`, after `duration` at `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuinticReference<T, const N: usize> {
    /// Start, rad or m.
    pub from: [T; N],
    /// End, rad or m.
    pub to: [T; N],
    /// Time from start to end, s, positive.
    pub duration: T,
}

impl<T: Real, const N: usize> Reference<T, N> for QuinticReference<T, N> {
    fn duration(&self) -> T {
        self.duration
    }

    #[inline(always)]
    fn at(&self, t: T) -> Desired<T, N> {
        // What the joints share is computed once.
        let shape = Shape::at(self.duration, t);
        let (mut q, mut qd, mut qdd) = (self.to, self.to, self.to);
        for_each_joint!(N, i => {
            let span = self.to[i] - self.from[i];
            if !shape.arrived {
                q[i] = self.from[i] + span * shape.position;
            }
            qd[i] = span * shape.velocity;
            qdd[i] = span * shape.acceleration;
        });
        Desired { q, qd, qdd }
    }

    fn check(&self) -> Result<(), ConfigError> {
        check_duration(self.duration)?;
        check_finite("from", &self.from)?;
        check_finite("to", &self.to)
    }
}

/// (q, q̇, q̈) at time `t`, s, of q = from + (to − from)(10x³ − 15x⁴ + 6x⁵), x = t/duration held to [0, 1].
///
/// By Horner's rule; the error is a few units in the last place of |from| + |to|, and of the peak of q̇ and q̈.
pub fn quintic<T: Real>(from: T, to: T, duration: T, t: T) -> (T, T, T) {
    Shape::at(duration, t).between(from, to)
}

/// Position, velocity and acceleration of a motion from 0 to 1 at x = t/duration within (0, 1); `rate` is 1/duration, 1/s.
#[inline(always)]
pub fn quintic_shape<T: Real>(x: T, rate: T) -> (T, T, T) {
    let Shape { position, velocity, acceleration, .. } = Shape::within(x, rate);
    (position, velocity, acceleration)
}

/// The motion from 0 to 1.
struct Shape<T> {
    position: T,
    velocity: T,
    acceleration: T,
    arrived: bool,
}

impl<T: Real> Shape<T> {
    #[inline]
    fn at(duration: T, t: T) -> Self {
        let still = |position, arrived| Self { position, velocity: T::ZERO, acceleration: T::ZERO, arrived };
        if t <= T::ZERO {
            return still(T::ZERO, false);
        }
        if t >= duration {
            return still(T::ONE, true);
        }
        // A constant where the duration is one: no division is left.
        let rate = T::ONE / duration;
        Self::within(t * rate, rate)
    }

    /// At x = t/duration within (0, 1); `rate` is 1/duration.
    #[inline(always)]
    fn within(x: T, rate: T) -> Self {
        let c = T::from_f64;
        // The factored forms vanish exactly at x = 1 as well as at 0.
        let rest = T::ONE - x;
        Self {
            position: x * x * x * (c(10.0) + x * (c(6.0) * x - c(15.0))),
            velocity: c(30.0) * rate * (x * x) * (rest * rest),
            acceleration: c(60.0) * (rate * rate) * x * rest * (rest - x),
            arrived: false,
        }
    }

    #[inline]
    fn between(&self, from: T, to: T) -> (T, T, T) {
        let span = to - from;
        // from + span may be off `to` by rounding.
        let position = if self.arrived { to } else { from + span * self.position };
        (position, span * self.velocity, span * self.acceleration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Requirement;
    use crate::reference::tests::assert_derivatives;

    const MOTION: QuinticReference<f64, 3> =
        QuinticReference { from: [0.0, 0.3, -1.2], to: [1.5, 1.2, -2.2], duration: 5.0 };

    #[test]
    fn is_at_rest_at_both_ends_and_beyond() {
        for t in [-1.0, 0.0] {
            assert_eq!(MOTION.at(t), Desired::at_rest(MOTION.from));
        }
        for t in [5.0, 9.0] {
            assert_eq!(MOTION.at(t), Desired::at_rest(MOTION.to));
        }
        // Reached continuously, not only by the clamp.
        for (t, rest) in [(1e-5, MOTION.from), (5.0 - 1e-5, MOTION.to)] {
            let near = MOTION.at(t);
            for (i, end) in rest.iter().enumerate() {
                assert!((near.q[i] - end).abs() < 1e-14);
                assert!(near.qd[i].abs() < 1e-9 && near.qdd[i].abs() < 1e-4);
            }
        }
    }

    #[test]
    fn derivatives_agree() {
        assert_derivatives(&MOTION, 1e-8);
    }

    #[test]
    fn passes_the_middle_at_the_known_speed() {
        let (q, qd, qdd) = quintic(1.0, 3.0, 4.0, 2.0);
        assert!((q - 2.0).abs() < 1e-15 && (qd - 2.0 * 1.875 / 4.0).abs() < 1e-15 && qdd == 0.0);
    }

    #[test]
    fn names_a_bad_number() {
        let bad = QuinticReference { duration: 0.0, ..MOTION };
        let error = ConfigError { parameter: "duration", joint: None, requirement: Requirement::Positive };
        assert_eq!(bad.check(), Err(error));
        let bad = QuinticReference { to: [0.0, f64::NAN, 0.0], ..MOTION };
        let error = ConfigError { parameter: "to", joint: Some(1), requirement: Requirement::Finite };
        assert_eq!(bad.check(), Err(error));
    }
}
