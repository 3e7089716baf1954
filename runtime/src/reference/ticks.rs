//! Desired motions by the number of the period.
//!
//! A time in f32 loses digits as it grows: after an hour it is off by a tenth of a millisecond. The number of the period is
//! an integer and stays exact. Each motion here makes of it, in integers, a small number that f32 can hold.

use super::{Desired, cubic, quintic_shape};
use crate::Real;
use crate::trig::{Polynomial, Trig};
use crate::vector::for_each_joint;

/// A desired motion of `N` joints, by the number of the control period.
pub trait TickReference<T: Real, const N: usize> {
    /// q_d, q̇_d and q̈_d at the start of period `tick`, counted from 0; after the end of the motion, too.
    fn at(&self, tick: u32) -> Desired<T, N>;
}

/// The quintic of [`QuinticReference`](super::QuinticReference) by periods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuinticTicks<T, const N: usize> {
    /// Start, rad or m.
    pub from: [T; N],
    /// End, rad or m.
    pub to: [T; N],
    /// The first period that starts at the end or after it, below 2²⁴.
    pub end: u32,
    /// Control period over the duration.
    pub step: T,
    /// 1/duration, 1/s.
    pub rate: T,
}

impl<T: Real, const N: usize> TickReference<T, N> for QuinticTicks<T, N> {
    #[inline(always)]
    fn at(&self, tick: u32) -> Desired<T, N> {
        let arrived = tick >= self.end;
        let (position, velocity, acceleration) = if arrived {
            (T::ZERO, T::ZERO, T::ZERO)
        } else {
            quintic_shape(T::from_u32(tick) * self.step, self.rate)
        };
        let (mut q, mut qd, mut qdd) = (self.to, self.to, self.to);
        for_each_joint!(N, i => {
            let span = self.to[i] - self.from[i];
            if !arrived {
                q[i] = self.from[i] + span * position;
            }
            qd[i] = span * velocity;
            qdd[i] = span * acceleration;
        });
        Desired { q, qd, qdd }
    }
}

/// One piece of a [`SplineTicks`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineTick<T, const N: usize> {
    /// The first period that starts at the piece's knot or after it.
    pub tick: u32,
    /// How long after the knot it starts, s.
    pub late: T,
    /// The four coefficients of each joint, constant first, rad/s^k or m/s^k, from the knot on.
    pub coefficients: [[T; 4]; N],
}

/// The cubic pieces of [`SplineReference`](super::SplineReference) by periods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineTicks<'a, T, const N: usize> {
    /// The pieces in which a period starts, by increasing `tick`; the first from 0.
    pub pieces: &'a [SplineTick<T, N>],
    /// The first period that starts at the end or after it.
    pub end: u32,
    /// The last position, rad or m.
    pub to: [T; N],
    /// Control period, s.
    pub period: T,
}

impl<T: Real, const N: usize> TickReference<T, N> for SplineTicks<'_, T, N> {
    fn at(&self, tick: u32) -> Desired<T, N> {
        let later = self.pieces.partition_point(|piece| piece.tick <= tick);
        match self.pieces.get(later.wrapping_sub(1)) {
            Some(piece) if tick < self.end => {
                let dt = piece.late + T::from_u32(tick - piece.tick) * self.period;
                let mut desired = Desired::at_rest(self.to);
                for (i, coefficients) in piece.coefficients.iter().enumerate() {
                    (desired.q[i], desired.qd[i], desired.qdd[i]) = cubic(coefficients, dt);
                }
                desired
            }
            _ => Desired::at_rest(self.to),
        }
    }
}

/// One sinusoid of a [`SinusoidTicks`]: its angle in units of 2⁻⁶⁴ turns, which wrap around as an angle does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinusoidTick<T> {
    /// Amplitude a, rad or m.
    pub amplitude: T,
    /// a ω, rad/s or m/s.
    pub speed: T,
    /// a ω², rad/s² or m/s².
    pub acceleration: T,
    /// Angle at period 0, 2⁻⁶⁴ turns.
    pub phase: u64,
    /// Angle by which it grows in a period, 2⁻⁶⁴ turns.
    pub turn: u64,
}

/// The sums of sinusoids of [`SinusoidReference`](super::SinusoidReference) by periods: as good in the last period as in the
/// first. After period 2³² − 1 the count starts again at 0, and with it the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinusoidTicks<'a, T, const N: usize> {
    /// Offset of each joint, rad or m.
    pub offset: [T; N],
    /// The sinusoids of each joint.
    pub terms: [&'a [SinusoidTick<T>]; N],
}

impl<T: Real, const N: usize> TickReference<T, N> for SinusoidTicks<'_, T, N>
where
    Polynomial: Trig<T>,
{
    fn at(&self, tick: u32) -> Desired<T, N> {
        let mut desired = Desired::at_rest(self.offset);
        // 2π 2⁻³²
        let unit = T::from_f64(1.462_918_079_267_159_6e-9);
        for (i, terms) in self.terms.iter().enumerate() {
            for term in *terms {
                let turns = term.phase.wrapping_add(term.turn.wrapping_mul(u64::from(tick)));
                // The upper half, from half a turn back to half a turn on.
                let (sin, cos) = Polynomial.sin_cos(T::from_i32((turns >> 32) as u32 as i32) * unit);
                desired.q[i] += term.amplitude * sin;
                desired.qd[i] += term.speed * cos;
                desired.qdd[i] -= term.acceleration * sin;
            }
        }
        desired
    }
}

#[cfg(test)]
mod tests {
    use super::super::{
        QuinticReference, Reference, Sinusoid, SinusoidReference, SplineReference, SplineSegment,
    };
    use super::*;

    const PERIOD: f64 = 0.001;

    fn assert_near<const N: usize>(ticks: &Desired<f32, N>, wanted: &Desired<f64, N>, most: f64) {
        let pairs = [(&ticks.q, &wanted.q), (&ticks.qd, &wanted.qd), (&ticks.qdd, &wanted.qdd)];
        for (ticks, wanted) in pairs {
            for (tick, wanted) in ticks.iter().zip(wanted) {
                assert!((f64::from(*tick) - wanted).abs() < most * (1.0 + wanted.abs()), "{tick} {wanted}");
            }
        }
    }

    #[test]
    fn a_quintic_is_that_of_time() {
        let real = QuinticReference { from: [0.25, 1.0], to: [1.5, -0.5], duration: 2.0005 };
        let ticks: QuinticTicks<f32, 2> = QuinticTicks {
            from: [0.25, 1.0],
            to: [1.5, -0.5],
            end: 2001,
            step: (PERIOD / 2.0005) as f32,
            rate: (1.0 / 2.0005) as f32,
        };
        for tick in (0..2100).step_by(7) {
            assert_near(&ticks.at(tick), &real.at(f64::from(tick) * PERIOD), 3e-6);
        }
        assert_eq!(ticks.at(0), Desired::at_rest([0.25, 1.0]));
        assert_eq!(ticks.at(u32::MAX), Desired::at_rest([1.5, -0.5]));
    }

    #[test]
    fn a_spline_changes_its_piece_at_the_knot() {
        let pieces = [[[0.0, 0.0, 2.5, -1.5]], [[1.0, 0.5, -2.0, 0.25]]];
        let real = SplineReference {
            segments: &[
                SplineSegment { start: 0.0, coefficients: pieces[0] },
                SplineSegment { start: 1.0004, coefficients: pieces[1] },
            ],
            duration: 3.0,
        };
        let single = |piece: [[f64; 4]; 1]| piece.map(|joint| joint.map(|c| c as f32));
        let to = [real.at(4.0).q[0] as f32];
        let parts = [
            SplineTick { tick: 0, late: 0.0, coefficients: single(pieces[0]) },
            SplineTick { tick: 1001, late: 0.0006, coefficients: single(pieces[1]) },
        ];
        let ticks = SplineTicks { pieces: &parts, end: 3000, to, period: PERIOD as f32 };
        for tick in [0, 1, 999, 1000, 1001, 1002, 2000, 2999, 3000, 9000] {
            assert_near(&ticks.at(tick), &real.at(f64::from(tick) * PERIOD), 2e-6);
        }
    }

    #[test]
    fn a_sinusoid_is_as_good_after_a_week() {
        let (frequency, phase) = (7.0, 0.25);
        let turns = |x: f64| (x / core::f64::consts::TAU * 18_446_744_073_709_551_616.0) as u64;
        let real = SinusoidReference {
            offset: [0.5],
            terms: [&[Sinusoid { amplitude: 0.3, frequency, phase }]],
            duration: 10.0,
        };
        let term = SinusoidTick {
            amplitude: 0.3_f32,
            speed: 2.1,
            acceleration: 14.7,
            phase: turns(phase),
            turn: turns(frequency * PERIOD),
        };
        let ticks = SinusoidTicks { offset: [0.5], terms: [&[term]] };
        for tick in [0, 1, 1000, 86_400_000, 604_800_000] {
            // f64 itself is good to 1e-9 of a turn then.
            assert_near(&ticks.at(tick), &real.at(f64::from(tick) * PERIOD), 1e-6);
        }
    }
}
