//! Piecewise cubics whose joints share their knots.

use core::array::from_fn;
use core::cmp::Ordering;

use super::{Desired, Reference, check_duration};
use crate::{ConfigError, Real, Requirement};

/// One piece of a spline: q_i = Σ_k coefficients_ik (t − start)^k from `start` to the start of the next piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineSegment<T, const N: usize> {
    /// Time of the piece's first knot, s.
    pub start: T,
    /// The four coefficients of each joint, constant first, rad/s^k or m/s^k.
    pub coefficients: [[T; 4]; N],
}

/// A motion in cubic pieces; the generator's are C2 and at rest at both ends.
///
/// Before the first knot the arm stands at the first position, from `duration` on at the last one. Without pieces it
/// stands at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineReference<'a, T, const N: usize> {
    /// The pieces, by increasing start.
    pub segments: &'a [SplineSegment<T, N>],
    /// Time of the last knot, s.
    pub duration: T,
}

impl<T: Real, const N: usize> SplineReference<'_, T, N> {
    fn on(segment: &SplineSegment<T, N>, t: T) -> Desired<T, N> {
        let dt = t - segment.start;
        Desired::from_joints(from_fn(|i| cubic(&segment.coefficients[i], dt)))
    }
}

impl<T: Real, const N: usize> Reference<T, N> for SplineReference<'_, T, N> {
    fn duration(&self) -> T {
        self.duration
    }

    fn at(&self, t: T) -> Desired<T, N> {
        let (Some(first), Some(last)) = (self.segments.first(), self.segments.last()) else {
            return Desired::at_rest([T::ZERO; N]);
        };
        if t < first.start {
            return Desired::at_rest(Self::on(first, first.start).q);
        }
        if t >= self.duration {
            return Desired::at_rest(Self::on(last, self.duration).q);
        }
        let later = self.segments.partition_point(|segment| segment.start <= t);
        Self::on(self.segments.get(later.saturating_sub(1)).unwrap_or(first), t)
    }

    fn check(&self) -> Result<(), ConfigError> {
        check_duration(self.duration)?;
        let error = |joint, requirement| Err(ConfigError { parameter: "segments", joint, requirement });
        if self.segments.is_empty() {
            return error(None, Requirement::NotEmpty);
        }
        let ends = self.segments.iter().skip(1).map(|next| next.start).chain([self.duration]);
        for (segment, end) in self.segments.iter().zip(ends) {
            let joint = segment.coefficients.iter().position(|joint| !joint.iter().all(|c| c.is_finite()));
            if joint.is_some() {
                return error(joint, Requirement::Finite);
            }
            if segment.start.partial_cmp(&end) != Some(Ordering::Less) {
                return error(None, Requirement::Increasing);
            }
        }
        Ok(())
    }
}

/// (q, q̇, q̈) of the cubic with these coefficients, constant first, `dt` seconds after its start.
///
/// By Horner's rule; the error is within 6 units in the last place of Σ_k |c_k dt^k|, and likewise for the derivatives.
pub fn cubic<T: Real>(coefficients: &[T; 4], dt: T) -> (T, T, T) {
    let [c0, c1, c2, c3] = *coefficients;
    let two_c2 = c2 + c2;
    let three_c3 = c3 + c3 + c3;
    let six_c3 = three_c3 + three_c3;
    (c0 + dt * (c1 + dt * (c2 + dt * c3)), c1 + dt * (two_c2 + dt * three_c3), two_c2 + dt * six_c3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::assert_derivatives;

    /// The C2 spline through (0, 0), (1, 1), (3, −1) at rest at both ends, solved by hand: q̇(1) = 1/2; beside it, its
    /// negative.
    const SEGMENTS: [SplineSegment<f64, 2>; 2] = {
        let slope = 0.5;
        let first = [0.0, 0.0, 3.0 - slope, slope - 2.0];
        // Over a length of 2 with rise −2: c2 = 3·(−2)/4 − 2·slope/2, c3 = slope/4 − 2·(−2)/8.
        let second = [1.0, slope, -1.5 - slope, slope / 4.0 + 0.5];
        [
            SplineSegment { start: 0.0, coefficients: [first, negative(first)] },
            SplineSegment { start: 1.0, coefficients: [second, negative(second)] },
        ]
    };

    const MOTION: SplineReference<'static, f64, 2> = SplineReference { segments: &SEGMENTS, duration: 3.0 };

    const fn negative(c: [f64; 4]) -> [f64; 4] {
        [-c[0], -c[1], -c[2], -c[3]]
    }

    #[test]
    fn passes_its_waypoints_and_rests_at_the_ends() {
        for (t, q) in [(-1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (3.0, -1.0), (4.0, -1.0)] {
            let now = MOTION.at(t);
            assert!((now.q[0] - q).abs() < 1e-14 && (now.q[1] + q).abs() < 1e-14, "{t}: {now:?}");
        }
        for t in [-1.0, 3.0, 4.0] {
            let now = MOTION.at(t);
            assert_eq!((now.qd, now.qdd), ([0.0; 2], [0.0; 2]));
        }
        let (before_start, before_end) = (MOTION.at(0.0), MOTION.at(3.0 - 1e-9));
        assert!(before_start.qd[0] == 0.0 && before_end.qd[0].abs() < 1e-8);
    }

    #[test]
    fn is_twice_continuously_differentiable() {
        let (before, after) = (MOTION.at(1.0 - 1e-9), MOTION.at(1.0 + 1e-9));
        for i in 0..2 {
            assert!((before.q[i] - after.q[i]).abs() < 1e-8);
            assert!((before.qd[i] - after.qd[i]).abs() < 1e-7);
            assert!((before.qdd[i] - after.qdd[i]).abs() < 1e-7);
        }
        assert!(before.qdd[0].abs() > 1.0, "a straight line would prove nothing");
        assert_derivatives(&MOTION, 1e-7);
    }

    #[test]
    fn names_bad_pieces() {
        let error = |joint, requirement| Err(ConfigError { parameter: "segments", joint, requirement });
        let check = |segments: &[SplineSegment<f64, 2>]| SplineReference { segments, duration: 3.0 }.check();
        assert_eq!(check(&SEGMENTS), Ok(()));
        assert_eq!(check(&[]), error(None, Requirement::NotEmpty));
        assert_eq!(check(&[SEGMENTS[1], SEGMENTS[0]]), error(None, Requirement::Increasing));
        let mut bad = SEGMENTS;
        bad[1].coefficients[1][2] = f64::NAN;
        assert_eq!(check(&bad), error(Some(1), Requirement::Finite));
        let empty: SplineReference<'_, f64, 2> = SplineReference { segments: &[], duration: 3.0 };
        assert_eq!(empty.at(1.0), Desired::at_rest([0.0; 2]));
    }
}
