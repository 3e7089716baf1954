//! What a desired motion of one's own must keep.

use super::Desired;
use crate::{Quantity, Real};

/// Limits of a desired motion that is not part of the specification: what is proved of a controller supposes them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ReferenceLimits<T, const N: usize> {
    /// Lowest q_d by joint, rad or m.
    pub lowest: [T; N],
    /// Highest q_d by joint, rad or m.
    pub highest: [T; N],
    /// Largest |q̇_d| by joint, rad/s or m/s.
    pub velocity: [T; N],
    /// Largest |q̈_d| by joint, rad/s² or m/s².
    pub acceleration: [T; N],
}

impl<T: Real, const N: usize> ReferenceLimits<T, N> {
    /// The first quantity of `desired` that is beyond the limits or NaN, and its joint; `None` where all is within. It compares 4N
    /// numbers and takes 2N absolute values.
    #[inline]
    pub fn beyond(&self, desired: &Desired<T, N>) -> Option<(Quantity, usize)> {
        let mut within = true;
        for i in 0..N {
            within &= self.holds_position(desired, i) & self.holds_velocity(desired, i);
            within &= self.holds_acceleration(desired, i);
        }
        if within { None } else { self.first_beyond(desired) }
    }

    #[cold]
    #[inline(never)]
    fn first_beyond(&self, desired: &Desired<T, N>) -> Option<(Quantity, usize)> {
        let first = |quantity, holds: &dyn Fn(usize) -> bool| {
            (0..N).find(|&i| !holds(i)).map(|joint| (quantity, joint))
        };
        first(Quantity::DesiredPosition, &|i| self.holds_position(desired, i))
            .or_else(|| first(Quantity::DesiredVelocity, &|i| self.holds_velocity(desired, i)))
            .or_else(|| first(Quantity::DesiredAcceleration, &|i| self.holds_acceleration(desired, i)))
    }

    #[inline]
    fn holds_position(&self, desired: &Desired<T, N>, i: usize) -> bool {
        (desired.q[i] >= self.lowest[i]) & (desired.q[i] <= self.highest[i])
    }

    #[inline]
    fn holds_velocity(&self, desired: &Desired<T, N>, i: usize) -> bool {
        desired.qd[i].abs() <= self.velocity[i]
    }

    #[inline]
    fn holds_acceleration(&self, desired: &Desired<T, N>, i: usize) -> bool {
        desired.qdd[i].abs() <= self.acceleration[i]
    }
}
